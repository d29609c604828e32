/* shift_pair.h -- the passes behind shifting and the transport velocity (sim/sim_shift.c), by which
 * particles move besides their velocity: dx_i/dt = v_i + dv_i.
 *
 *   concentration  M_i^ab = - sum_j V_j r^a r^b F,   grad C_i = sum_j V_j grad_i W_ij,
 *                  and what dv_i is along:
 *                    fick, delta-plus  sum_j V_j (1 + R (W_ij/W(dx))^4) grad_i W_ij
 *                    transport         1/m_i sum_j (V_i^2 + V_j^2) grad_i W_ij
 *   covered        neighbours in the cone around the normal of i (Marrone et al. 2010)
 *   near           neighbours at the surface, weighed by W, and their normals
 *   advection      dv . grad of density and velocity, which follow the particle (Sun et al. 2019):
 *                    drho_i += sum_j V_j (rho_i (dv_i - dv_j) + rho_i dv_i + rho_j dv_j) . grad W,
 *                              sum_j V_j (rho_j - rho_i) dv_j . grad W with corrected continuity
 *                    a_i    += sum_j V_j (v_j - v_i) dv_i . grad W, j in fluids alone
 *                  transport, a_i: 1/m_i sum_j (V_i^2 + V_j^2)/2 (A_i + A_j) . grad W, A = rho v dv
 *                  (Adami, Hu & Adams 2013)
 *
 * The first drho_i is 2 rho dv_i . grad C_i where rho is uniform: as the kernel sums of continuity
 * rise where a flow disorders particles, so these fall where shifting orders them, and density
 * stays.  Corrected sums do not see order.  Differences of v leave a uniform flow alone.
 *
 * Walls have dv = 0.  F and W go without their constant factors.  Sums of these passes would not
 * fit beside those of a fused loop with tiles, nor dv in its records. */
#ifndef SPH_SHIFT_PAIR_H
#define SPH_SHIFT_PAIR_H
#include "fluid_pair.h"

typedef struct shift_constants {
  double inverse_h;
  double crowd; /* R/w(dx/h)^4 */
  double L2;    /* (kappa h/2)^2 [m^2], of the cone; */
  double L;
  int transport, surface;
  int corrected; /* the gradients of continuity are */
  int wall;      /* the source is one */
  int kernel;    /* for loops that are not compiled for one */
} shift_constants;

/* A record: x v rho V dv normal flag; flag 1: at the surface.  The first pass reads it to V. */
BODY int shift_rho(int dim) { return 2 * dim; }
BODY int shift_V(int dim) { return 2 * dim + 1; }
BODY int shift_drift(int dim) { return 2 * dim + 2; }
BODY int shift_normal(int dim) { return 3 * dim + 2; }
BODY int shift_flag(int dim) { return 4 * dim + 2; }
BODY int shift_slots(int dim) { return 4 * dim + 3; }

/* Sums of concentration: the direction of dv, grad C, the upper triangle of M by rows. */
enum { SHIFT_COVERED_SUMS = 1, SHIFT_NEAR = 0, SHIFT_NORMAL = 1, SHIFT_DRHO = 0, SHIFT_A = 1 };
BODY int shift_concentration_sums(int dim) { return 2 * dim + dim * (dim + 1) / 2; }

BODY void shift_concentration(int dim, int kernel, const shift_constants *k, const vec *i,
                              const vec *j, vec *sum)
{
  vec r[3];
  for (int d = 0; d < dim; d++) r[d] = i[d] - j[d];
  vec q = v_sqrt(fluid_dot(dim, r, r)) * k->inverse_h, F = kernel_shape_f(kernel, dim, q);
  vec V_i = i[shift_V(dim)], V_j = j[shift_V(dim)], VF = F * V_j, along;
  if (k->transport)
    along = F * (V_i * V_i + V_j * V_j) / (V_i * i[shift_rho(dim)]);
  else {
    vec w2 = kernel_shape_w(kernel, dim, q);
    w2 *= w2;
    along = VF * (1 + k->crowd * w2 * w2);
  }
  for (int a = 0; a < dim; a++) sum[a] += along * r[a];
  if (!k->surface) return;
  int s = 2 * dim;
  for (int a = 0; a < dim; a++) sum[dim + a] += VF * r[a];
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++) sum[s++] -= VF * r[a] * r[b];
}

BODY void shift_covered(int dim, int kernel, const shift_constants *k, const vec *i, const vec *j,
                        vec *sum)
{
  vec along = v_set(0), to_top = v_set(0), r2 = v_set(0); /* (x_j - x_i).n, |x_j - x_i - L n|^2 */
  (void)kernel;
  for (int d = 0; d < dim; d++) {
    vec s = j[d] - i[d], n = i[shift_normal(dim) + d], top = s - k->L * n;
    along += s * n;
    to_top += top * top;
    r2 += s * s;
  }
  along = v_max0(along);
  vec in_tip = v_and(v_less(0.5 * r2, along * along), v_set(1));
  vec in_top = v_and(v_less(to_top, v_set(k->L2)), v_set(1));
  sum[0] += v_select(v_less(r2, v_set(2 * k->L2)), in_tip, in_top);
}

BODY void shift_near(int dim, int kernel, const shift_constants *k, const vec *i, const vec *j,
                     vec *sum)
{
  vec r2 = v_set(0);
  for (int d = 0; d < dim; d++) r2 += (i[d] - j[d]) * (i[d] - j[d]);
  vec w = j[shift_flag(dim)] * kernel_shape_w(kernel, dim, v_sqrt(r2) * k->inverse_h);
  sum[SHIFT_NEAR] += w;
  for (int d = 0; d < dim; d++) sum[SHIFT_NORMAL + d] += w * j[shift_normal(dim) + d];
}

BODY void shift_advection(int dim, int kernel, const shift_constants *k, const vec *i, const vec *j,
                          vec *sum)
{
  vec r[3];
  const vec *v_i = i + dim, *v_j = j + dim;
  for (int d = 0; d < dim; d++) r[d] = i[d] - j[d];
  vec F = kernel_shape_f(kernel, dim, v_sqrt(fluid_dot(dim, r, r)) * k->inverse_h);
  vec rho_i = i[shift_rho(dim)], rho_j = j[shift_rho(dim)];
  vec V_i = i[shift_V(dim)], V_j = j[shift_V(dim)], VF = V_j * F;
  vec from_i = fluid_dot(dim, r, i + shift_drift(dim));
  vec from_j = fluid_dot(dim, r, j + shift_drift(dim)), twice = 2 * from_i - from_j;
  sum[SHIFT_DRHO] +=
      VF * (k->corrected ? (rho_j - rho_i) * from_j : rho_i * twice + rho_j * from_j);
  if (k->transport) {
    vec half = 0.5 * F * (V_i * V_i + V_j * V_j) / (V_i * rho_i);
    for (int d = 0; d < dim; d++)
      sum[SHIFT_A + d] += half * (rho_i * v_i[d] * from_i + rho_j * v_j[d] * from_j);
  } else if (!k->wall)
    for (int d = 0; d < dim; d++) sum[SHIFT_A + d] += VF * (v_j[d] - v_i[d]) * from_i;
}

#endif
