/* case_scalar.h -- scalars of a case: what is carried along, diffuses and reacts. */
#ifndef SPH_CASE_SCALAR_H
#define SPH_CASE_SCALAR_H
#include "case_schema.h"

/* Behind the schema: names, units, groups; a status, the reason in c->error. */
int sph_case_scalar_check(sph_case *c);
/* Their terms and what they are at the start, behind all other terms; a status, the reason in
 * error. */
int sph_case_scalar_add(const sph_case *c, sph_sim *sim, sph_error *error);

#endif
