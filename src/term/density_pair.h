/* density_pair.h -- the density of particle i as a sum, itself included (Lucy 1977; Gingold &
 * Monaghan 1977).
 *
 *   rho_i = sum_j m_j W_ij
 *
 * W goes without its constant factor.  In this pass the slot of V holds m. */
#ifndef SPH_DENSITY_PAIR_H
#define SPH_DENSITY_PAIR_H
#include "fluid_pair.h"

enum { SPH_DENSITY_SUMS = 1 };

BODY void density_pair(int dim, int kernel, const fluid_constants *k, const vec *i, const vec *j,
                       vec *sum)
{
  vec r[3];
  for (int d = 0; d < dim; d++) r[d] = i[d] - j[d];
  vec q = v_sqrt(fluid_dot(dim, r, r)) * k->inverse_h;
  sum[0] += j[slot_V(dim)] * kernel_shape_w(kernel, dim, q);
}

#endif
