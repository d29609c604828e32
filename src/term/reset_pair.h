/* reset_pair.h -- what a density reset sums over the neighbours of particle i, itself included.
 *
 *   A = sum_j V_j W_ij p p^T,   b = sum_j V_j W_ij p (rho_j - rho_i),   p = (1, r_ij/h)
 *
 * V_j = m_j/rho_j.  Only ratios of them are used, so W goes without its constant factor. */
#ifndef SPH_RESET_PAIR_H
#define SPH_RESET_PAIR_H
#include "fluid_pair.h"

/* Sums: the upper triangle of A by rows, then b. */
BODY int reset_sums(int dim) { return (dim + 1) * (dim + 2) / 2 + dim + 1; }

BODY void reset_pair(int dim, int kernel, const fluid_constants *k, const vec *i, const vec *j,
                     vec *sum)
{
  vec r[3], p[4] = {v_set(1)};
  for (int d = 0; d < dim; d++) {
    r[d] = i[d] - j[d];
    p[1 + d] = r[d] * k->inverse_h;
  }
  vec W = kernel_shape_w(kernel, dim, v_sqrt(fluid_dot(dim, r, r)) * k->inverse_h);
  vec VW = W * j[slot_V(dim)], jump = j[slot_rho(dim)] - i[slot_rho(dim)];
  int s = 0;
  for (int a = 0; a <= dim; a++)
    for (int b = a; b <= dim; b++) sum[s++] += VW * p[a] * p[b];
  for (int a = 0; a <= dim; a++) sum[s++] += VW * jump * p[a];
}

#endif
