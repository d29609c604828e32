/* case_source.h -- heating and body forces by expressions in x, y, z, t. */
#ifndef SPH_CASE_SOURCE_H
#define SPH_CASE_SOURCE_H
#include "case_schema.h"

/* Is this term one of them? */
int sph_case_source_is(const sph_case_node *map);
/* Adds it; a status, the reason in error or in the simulation. */
int sph_case_source_add(const sph_case *c, sph_sim *sim, const sph_case_node *map,
                        sph_error *error);

#endif
