/* gradient_pair.h -- the prepare pass of the Antuono diffusion: gradient matrix and density
 * gradient.
 *
 *   M_i^ab = - sum_j V_j r^a r^b F,   b_i = sum_j V_j (rho_j - rho_i) grad_i W_ij,
 *   <grad rho>^L_i = M_i^-1 b_i
 *
 * (Randles & Libersky 1996; exact for a linear density, also at surfaces).  F goes without its
 * constant factor. */
#ifndef SPH_GRADIENT_PAIR_H
#define SPH_GRADIENT_PAIR_H
#include "fluid_pair.h"

/* Sums: the upper triangle of M by rows, then b. */
BODY int gradient_sums(int dim) { return dim * (dim + 1) / 2 + dim; }

BODY void gradient_pair(int dim, int kernel, const fluid_constants *k, const vec *i, const vec *j,
                        vec *sum)
{
  vec r[3];
  for (int d = 0; d < dim; d++) r[d] = i[d] - j[d];
  vec F = kernel_shape_f_at(kernel, dim, v_sqrt(fluid_dot(dim, r, r)), k->inverse_h);
  vec VF = F * j[slot_V(dim)], jump = j[slot_rho(dim)] - i[slot_rho(dim)], VFr[3];
  int s = 0;
  for (int a = 0; a < dim; a++) VFr[a] = VF * r[a];
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++) sum[s++] -= VFr[a] * r[b];
  for (int a = 0; a < dim; a++) sum[s++] += jump * VFr[a];
}

#endif
