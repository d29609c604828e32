/* case_path.h -- where the files are that a case names. */
#ifndef SPH_CASE_PATH_H
#define SPH_CASE_PATH_H
#include "case_schema.h"

enum { SPH_CASE_PATH = 4096 };

/* The path of a file named by a node: beside the file that the node stands in.  A status. */
int sph_case_path(const sph_case *c, const sph_case_node *node, const char *name,
                  char path[SPH_CASE_PATH], sph_error *error);

#endif
