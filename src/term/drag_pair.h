/* drag_pair.h -- drag between dust and a fluid (Monaghan & Kocharyan 1995; Laibe & Price 2012).
 *
 *   a_i = - d sum_j m_j K_ij/(rho_i rho_j) (v_ij . e) e D_ij,   e = r_ij/r
 *   du_i = d sum_j m_j K_ij/(rho_i rho_j) (v_ij . e)^2 D_ij     of fluids: all the heat is theirs
 *
 * i in one of them, j in the other; K_ij is the same for both ends of a pair: a constant, or the
 * density of the dust over its stopping time.  D = q^2 W/(d sigma_k^2) has the integral 1, since
 * sigma_k^2 = (1/d) int q^2 W dV, and with it
 *
 *   d D e e^T = W r r^T/(sigma_k h)^2
 *
 * needs no division by r.  Momentum and angular momentum are kept: the force is central.  The
 * constants hold K_ij = drag + drag_i rho_i + drag_j rho_j times what is constant in W/(sigma_k
 * h)^2: the sums are rates. */
#ifndef SPH_DRAG_PAIR_H
#define SPH_DRAG_PAIR_H
#include "fluid_pair.h"

/* rate: sum_j m_j K_ij/(rho_i rho_j) D_ij [1/s]; those of both ends add up to 1/t_s. */
enum { SPH_DRAG_A = 0, SPH_DRAG_HEAT = 3, SPH_DRAG_RATE, SPH_DRAG_SUMS };

/* K_ij sigma/h^d/(sigma_k h)^2. */
BODY vec drag_coefficient(int dim, const fluid_constants *k, const vec *i, const vec *j)
{
  return k->drag + k->drag_i * i[slot_rho(dim)] + k->drag_j * j[slot_rho(dim)];
}

BODY void drag_pair(int dim, int kernel, const fluid_constants *k, const vec *i, const vec *j,
                    vec *sum)
{
  vec r[3], v[3];
  for (int d = 0; d < dim; d++) {
    r[d] = i[d] - j[d];
    v[d] = i[slot_v(dim) + d] - j[slot_v(dim) + d];
  }
  vec rv = fluid_dot(dim, r, v), r2 = fluid_dot(dim, r, r);
  vec W = kernel_shape_w(kernel, dim, v_sqrt(r2) * k->inverse_h);
  vec weight = drag_coefficient(dim, k, i, j) * j[slot_V(dim)] / i[slot_rho(dim)] * W;
  for (int d = 0; d < dim; d++) sum[SPH_DRAG_A + d] -= weight * rv * r[d];
  sum[SPH_DRAG_HEAT] += weight * rv * rv;
  sum[SPH_DRAG_RATE] += weight * r2 * (1.0 / dim);
}

#endif
