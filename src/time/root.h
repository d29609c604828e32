/* root.h -- where a function of time changes its sign. */
#ifndef SPH_ROOT_H
#define SPH_ROOT_H
#include "sphode/base.h"

/* Its value at t: finite.  Returns 0 or a failure (recorded), which ends the search. */
typedef int sph_root_function(void *ctx, double t, double *value);

/* [a, b] with the values at its ends: value_a of one sign, value_b of the other or zero.  *t: in
 * (a, b], not before the change of sign and at most 1e-12 (b - a), or what rounding of t leaves,
 * behind it; the value there has the sign of value_b or is zero.  Brent's method (1973), GSL's; a
 * jump is found as well. */
int sph_root_find(sph_root_function *value, void *ctx, double a, double value_a, double b,
                  double value_b, double *t, sph_error *error);

#endif
