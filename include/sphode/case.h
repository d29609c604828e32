/* sphode/case.h -- case files. */
#ifndef SPHODE_CASE_H
#define SPHODE_CASE_H
#include "sphode/base.h"
#endif
