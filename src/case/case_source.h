/* case_source.h -- heating, body forces and sources of scalars by expressions in x, y, z, t. */
#ifndef SPH_CASE_SOURCE_H
#define SPH_CASE_SOURCE_H
#include "case_motion.h"
#include "case_schema.h"

enum { SPH_CASE_SOURCE_NAMES = SPH_CASE_NAMES + 8 };

/* "file:line:column: body-force: acceleration 'sqrt(t)'", for messages of a run. */
void sph_case_source_describe(const sph_case *c, const char *of, const char *key,
                              const sph_case_node *node, char what[SPH_CASE_WHAT]);
/* Is this term one of them? */
int sph_case_source_is(const sph_case_node *map);
/* Adds it; a status, the reason in error or in the simulation. */
int sph_case_source_add(const sph_case *c, sph_sim *sim, const sph_case_node *map,
                        sph_error *error);

/* What the source of a scalar may name: fields of the fluid, the scalar, parameters, tables; their
 * number.  power: the unit of the scalar. */
int sph_case_source_names(const sph_case *c, const char *scalar, const double power[SPH_SI_BASES],
                          sph_case_name names[SPH_CASE_SOURCE_NAMES]);
/* Makes the source of a scalar the body of its term, which is added next. */
int sph_case_source_react(const sph_case *c, sph_sim *sim, const char *scalar,
                          const sph_case_node *node, sph_term *term, sph_error *error);

#endif
