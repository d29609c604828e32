/* case_path.h -- where the files are that a case names. */
#ifndef SPH_CASE_PATH_H
#define SPH_CASE_PATH_H
#include "case_schema.h"

enum { SPH_CASE_PATH = 4096 };

/* The path of a file that stands beside the case; first of all the copy of it that results have,
 * if the case is the text of results.  A status. */
int sph_case_path(const sph_case *c, const char *name, char path[SPH_CASE_PATH], sph_error *error);
/* Where results in that directory keep it.  A status. */
int sph_case_path_kept(const char *directory, const char *name, char path[SPH_CASE_PATH],
                       sph_error *error);

#endif
