/* wall_pair.h -- what an Adami wall particle sums over its fluid neighbours (Adami, Hu & Adams
 * 2012, eq. 22 to 27).
 *
 *   sum_f W_wf,   sum_f p_f W_wf,   sum_f rho_f r_wf W_wf,   sum_f v_f W_wf,   sum_f u_f W_wf,
 *   sum_f T_f W_wf,   r_wf = r_w - r_f
 *
 * Of a wall that turns v_f + omega x r_wf in place of v_f, so that 2 v_w - <v> mirrors what is left
 * of v_f in the frame of the wall: its surface does not move as the wall particles behind it do.
 *
 * Only ratios of them are used, so W goes without its constant factor. */
#ifndef SPH_WALL_PAIR_H
#define SPH_WALL_PAIR_H
#include "fluid_pair.h"

enum {
  SPH_WALL_W = 0,
  SPH_WALL_P = 1,
  SPH_WALL_RHO_R = 2,
  SPH_WALL_V = 5,
  SPH_WALL_SUMS_COLD = 8, /* without energies */
  SPH_WALL_U = 8,
  SPH_WALL_T = 9,
  SPH_WALL_SUMS = 10
};

/* v + omega x r. */
BODY void wall_turn(int dim, const fluid_constants *k, const vec *r, vec *v)
{
  if (dim < 2) return;
  v[0] -= k->omega[2] * r[1];
  v[1] += k->omega[2] * r[0];
  if (dim < 3) return;
  v[0] += k->omega[1] * r[2];
  v[1] -= k->omega[0] * r[2];
  v[2] += k->omega[0] * r[1] - k->omega[1] * r[0];
}

BODY void wall_pair(int dim, int kernel, int thermal, int turns, const fluid_constants *k,
                    const vec *w, const vec *f, vec *sum)
{
  vec r[3], v[3];
  for (int d = 0; d < dim; d++) r[d] = w[d] - f[d], v[d] = f[slot_v(dim) + d];
  if (turns) wall_turn(dim, k, r, v);
  vec W = kernel_shape_w(kernel, dim, v_sqrt(fluid_dot(dim, r, r)) * k->inverse_h);
  vec rho = f[slot_rho(dim)], p = f[slot_p(dim)];
  if (!(k->terms & SPH_FORM_C2)) p *= rho * rho; /* the slot holds p/rho^2 */
  if (k->terms & SPH_FORM_PHI) p /= f[slot_phi(dim)];
  sum[SPH_WALL_W] += W;
  sum[SPH_WALL_P] += p * W;
  for (int d = 0; d < dim; d++) {
    sum[SPH_WALL_RHO_R + d] += rho * r[d] * W;
    sum[SPH_WALL_V + d] += v[d] * W;
  }
  if (!thermal) return;
  sum[SPH_WALL_U] += f[slot_u(dim)] * W;
  sum[SPH_WALL_T] += f[slot_T(dim)] * W;
}

#endif
