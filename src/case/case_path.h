/* case_path.h -- where the files are that a case names. */
#ifndef SPH_CASE_PATH_H
#define SPH_CASE_PATH_H
#include "case_schema.h"

enum { SPH_CASE_PATH = 4096 };

/* The path of a file that stands beside the case.  A status. */
int sph_case_path(const sph_case *c, const char *name, char path[SPH_CASE_PATH], sph_error *error);

#endif
