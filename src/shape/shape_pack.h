/* shape_pack.h -- particles that fit a body: as many as its volume says, spread evenly, the
 * outermost half a spacing from its surface. */
#ifndef SPH_SHAPE_PACK_H
#define SPH_SHAPE_PACK_H
#include "sphode/shape.h"

#define SPH_PACK_UNIFORMITY 0.005 /* wanted unless told */

/* x[d][*n] [m]: places of a lattice whose distance from the shape is at most dx; *n becomes the
 * number of those that are kept, and x where they are then.  Follows from its input alone.  A
 * status, the reason in error; one that has not settled is none (see info). */
int sph_shape_pack(const sph_shape *shape, double dx, const sph_pack *pack, long *n,
                   double *const x[3], sph_packing *info, sph_error *error);

#endif
