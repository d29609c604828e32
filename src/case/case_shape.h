/* case_shape.h -- the shapes of a case, and particles in them. */
#ifndef SPH_CASE_SHAPE_H
#define SPH_CASE_SHAPE_H
#include "case_schema.h"
#include "sphode/shape.h"

/* Is this shape filled by sph_case_shape_add, rather than by a function of sphode/group.h? */
int sph_case_shape_is(const sph_case_node *group, const sph_case_node *shape);
/* The shape of a checked node (its key says which); for a spacing dx, walls as thick as `support`
 * [m].  NULL: told. */
sph_shape *sph_case_shape_of(const sph_case *c, const sph_case_node *node, double dx,
                             double support, sph_error *error);
/* Fills it with particles of the group as its node says.  A status, the reason in error or in the
 * simulation. */
int sph_case_shape_add(const sph_case *c, sph_sim *sim, sph_group *group, const sph_case_node *map,
                       const sph_case_node *shape, double density, sph_error *error);

#endif
