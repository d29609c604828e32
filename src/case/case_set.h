/* case_set.h -- what --set means for a parameter that has a unit. */
#ifndef SPH_CASE_SET_H
#define SPH_CASE_SET_H
#include "case_schema.h"

/* A plain number for a parameter is in SI: behind `given`, which is to replace the parameter `name`
 * of the tree, comes the unit that this has.  SPH_ERR_MEMORY, else SPH_OK. */
int sph_case_set_unit(const sph_case *c, const char *name, sph_case_node *given);

#endif
