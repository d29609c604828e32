/* switch_pair.h -- the passes of the switches of artificial viscosity (term_switch.h).
 *
 *   M_i = - sum_j V_j r (x) r F,   G_i^ab = sum_j V_j (b_j - b_i)^a r^b F
 *
 * for b = v, behind which v_sig,i = max_j (c_ij - min(0, w_ij)), w_ij = v_ij . r_ij/r, stands; and,
 * once accelerations are known, for b = a, behind which sum_j s_j m_j W and sum_j m_j W stand, s_j
 * the sign of div v.  G M^-1 is the gradient of b, exact for a linear b (Randles & Libersky 1996).
 * F and W go without their constant factors. */
#ifndef SPH_SWITCH_PAIR_H
#define SPH_SWITCH_PAIR_H
#include "fluid_pair.h"

/* Records of the second pass: x[dim] a[dim] V m sign, which its loop reads; v_sig, div v,
 * tr(L L) and tr(S S) are kept there from the first one. */
BODY int switch_slot_a(int dim) { return dim; }
BODY int switch_slot_V(int dim) { return 2 * dim; }
BODY int switch_slot_m(int dim) { return 2 * dim + 1; }
BODY int switch_slot_sign(int dim) { return 2 * dim + 2; }
BODY int switch_slot_kept(int dim) { return 2 * dim + 3; }
BODY int switch_slots(int dim) { return 2 * dim + 7; }

/* Sums: the upper triangle of M by rows, G by rows, then the others. */
BODY int switch_sum_G(int dim) { return dim * (dim + 1) / 2; }
BODY int switch_sum_more(int dim) { return switch_sum_G(dim) + dim * dim; }

/* M and G of the vector that starts at slot b. */
BODY void switch_gradients(int dim, int b, vec VF, const vec *r, const vec *i, const vec *j,
                           vec *sum)
{
  int s = 0;
  for (int a = 0; a < dim; a++)
    for (int c = a; c < dim; c++) sum[s++] -= VF * r[a] * r[c];
  for (int a = 0; a < dim; a++)
    for (int c = 0; c < dim; c++) sum[s++] += VF * (j[b + a] - i[b + a]) * r[c];
}

/* Sums: switch_sum_more(dim) + 1. */
BODY void switch_velocity(int dim, int kernel, const fluid_constants *k, const vec *i, const vec *j,
                          vec *sum)
{
  vec r[3], rv = v_set(0);
  for (int d = 0; d < dim; d++) {
    r[d] = i[d] - j[d];
    rv += r[d] * (i[slot_v(dim) + d] - j[slot_v(dim) + d]);
  }
  const vec distance = v_sqrt(fluid_dot(dim, r, r));
  const vec F = kernel_shape_f(kernel, dim, distance * k->inverse_h);
  const vec signal = 0.5 * (i[slot_c(dim)] + j[slot_c(dim)]) - v_min0(rv) / fluid_apart(distance);
  const int s = switch_sum_more(dim);
  switch_gradients(dim, slot_v(dim), F * j[slot_V(dim)], r, i, j, sum);
  sum[s] = v_max(sum[s], v_and(v_less(F, v_set(0)), signal));
}

/* Sums: switch_sum_more(dim) + 2. */
BODY void switch_acceleration(int dim, int kernel, const fluid_constants *k, const vec *i,
                              const vec *j, vec *sum)
{
  vec r[3];
  for (int d = 0; d < dim; d++) r[d] = i[d] - j[d];
  const vec q = v_sqrt(fluid_dot(dim, r, r)) * k->inverse_h;
  const vec mW = j[switch_slot_m(dim)] * kernel_shape_w(kernel, dim, q);
  const int s = switch_sum_more(dim);
  switch_gradients(dim, switch_slot_a(dim), kernel_shape_f(kernel, dim, q) * j[switch_slot_V(dim)],
                   r, i, j, sum);
  sum[s] += j[switch_slot_sign(dim)] * mW;
  sum[s + 1] += mW;
}

#endif
