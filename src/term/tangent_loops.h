/* tangent_loops.h -- the bodies of all passes over pairs once more, with derivatives
 * (tangent_loop.h): one instance for each dimension, for any kernel and any set of terms, which are
 * read at run time. */
#ifndef SPH_TANGENT_LOOPS_H
#define SPH_TANGENT_LOOPS_H
#include "tangent_loop.h"

/* X(name): fluid_pair.h, boundary/wall_pair.h, gradient_pair.h, density_pair.h, drag_pair.h */
#define SPH_TANGENT_PASSES(X) X(fluid) X(wall) X(gradient) X(density) X(drag)

enum sph_tangent_pass {
#define SPH_TANGENT_PASS(name) SPH_TANGENT_##name,
  SPH_TANGENT_PASSES(SPH_TANGENT_PASS)
#undef SPH_TANGENT_PASS
      SPH_TANGENT_PASS_COUNT
};

extern sph_tangent_function
    *const sph_tangent_loops[SPH_TANGENT_PASS_COUNT][3]; /* [pass][dim - 1] */
extern sph_tangent_function *const sph_tangent_loops_transposed[SPH_TANGENT_PASS_COUNT][3];

#endif
