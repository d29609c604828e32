/* sphode.h -- smoothed particle hydrodynamics as a system of ordinary differential equations. */
#ifndef SPHODE_H
#define SPHODE_H
#include <math.h>
#include <stdio.h>

#include "sphode/adjoint.h"
#include "sphode/base.h"
#include "sphode/boundary.h"
#include "sphode/case.h"
#include "sphode/checkpoint.h"
#include "sphode/correction.h"
#include "sphode/eos.h"
#include "sphode/event.h"
#include "sphode/export.h"
#include "sphode/field.h"
#include "sphode/group.h"
#include "sphode/import.h"
#include "sphode/integrator.h"
#include "sphode/jacobian.h"
#include "sphode/kernel.h"
#include "sphode/manufactured.h"
#include "sphode/material.h"
#include "sphode/measure.h"
#include "sphode/neighbors.h"
#include "sphode/operator.h"
#include "sphode/output.h"
#include "sphode/sensitivity.h"
#include "sphode/shape.h"
#include "sphode/sim.h"
#include "sphode/term.h"
#endif
