/* matrix_pair.h -- what pairs give to the matrices of implicit stages.
 *
 * A term that lets a pair exchange an unknown x in proportion to its difference,
 *
 *   m_i dx_i/dt = - sum_j k_ij (x_i - x_j),   k_ij = k_ji >= 0,
 *
 * has the stage z = known + gamma f(z) solved by (M + gamma L) z = M known: off the diagonal
 * - gamma k_ij, on it m_i + gamma sum_j k_ij.
 *
 *   scalar   k_ij = C V_i V_j |F_ij|:  Morris' viscosity, C = eta_i + eta_j, x each component of v;
 *            conduction, C = 4 kappa_i kappa_j/(kappa_i + kappa_j), x = T;
 *            density diffusion, C = 2 delta h c0, x = rho, m_i = V_i
 *   vector   k_ij I + q_ij r r^T for the velocity,
 *            mcg: q_ij = 2 (d + 2) 2 eta_i eta_j/(eta_i + eta_j) V_i V_j |F_ij|/r^2;
 *            artificial, of a pair that approaches: q_ij = - d(force)/d(v.r) =
 *              m_i m_j |F_ij| h (alpha c_ij - 2 beta mu_ij)/(rho_ij (r^2 + eta^2))
 *            drag, of dust and a fluid (drag_pair.h): q_ij = K_ij V_i V_j W_ij/(sigma_k h)^2
 *
 * F as in the loops of f; its factor sigma/h^(d+2), and gamma, are in the constants. */
#ifndef SPH_MATRIX_PAIR_H
#define SPH_MATRIX_PAIR_H
#include "drag_pair.h"

typedef struct matrix_constants {
  fluid_constants fluid; /* its terms: those in the matrix */
  double scalar;         /* gamma sigma/h^(d+2) C */
  double vector;         /* gamma sigma/h^(d+2) */
  int regular;           /* F of a singular kernel is made finite */
  double drag;           /* gamma between dust and a fluid, else 0 */
} matrix_constants;

typedef struct matrix_pair {
  vec r[3], r2, F; /* |F| without its constant factor */
} matrix_pair;

BODY matrix_pair matrix_pair_common(int dim, int kernel, const fluid_constants *k, const vec *i,
                                    const vec *j)
{
  matrix_pair p = {0};
  for (int d = 0; d < dim; d++) p.r[d] = i[d] - j[d];
  p.r2 = fluid_dot(dim, p.r, p.r);
  p.F = -kernel_shape_f(kernel, dim, v_sqrt(p.r2) * k->inverse_h);
  return p;
}

BODY vec matrix_regular(int kernel, int regular, const fluid_constants *k, const matrix_pair *p)
{
  return kernel_shape_singular(kernel) && regular ? p->r2 / (p->r2 + k->eta2) : v_set(1);
}

BODY vec matrix_scalar(int dim, int kernel, const matrix_constants *k, const vec *i, const vec *j)
{
  const matrix_pair p = matrix_pair_common(dim, kernel, &k->fluid, i, j);
  return k->scalar * i[slot_V(dim)] * j[slot_V(dim)] * p.F *
         matrix_regular(kernel, k->regular, &k->fluid, &p);
}

/* Artificial viscosity: q of a pair.  v: that it sees. */
BODY vec matrix_artificial(int dim, const fluid_constants *k, const matrix_pair *p, const vec *i,
                           const vec *j, const vec *v)
{
  const int rho = slot_rho(dim), c = slot_c(dim);
  vec w = fluid_dot(dim, p->r, v), e = p->r2 + k->eta2;
  vec slope =
      (k->viscosity_1 * (i[c] + j[c]) * e + 2 * k->viscosity_2 * w) / (e * e * (i[rho] + j[rho]));
  return v_and((vec_mask)(w < 0), -slope * i[rho] * j[rho]);
}

/* Drag: q of a pair. */
BODY vec matrix_drag(int dim, int kernel, const matrix_constants *k, const matrix_pair *p,
                     const vec *i, const vec *j)
{
  const int V = slot_V(dim);
  vec W = kernel_shape_w(kernel, dim, v_sqrt(p->r2) * k->fluid.inverse_h);
  return k->drag * drag_coefficient(dim, &k->fluid, i, j) * i[V] * j[V] * W;
}

/* k and q of a pair. */
BODY void matrix_vector(int dim, int kernel, const matrix_constants *k, const vec *i, const vec *j,
                        matrix_pair *p, vec *along_v, vec *along_r)
{
  const unsigned terms = k->fluid.terms;
  const int velocity = terms & SPH_NO_SLIP ? slot_extra(dim) : slot_v(dim);
  *p = matrix_pair_common(dim, kernel, &k->fluid, i, j);
  vec VVF = k->vector * i[slot_V(dim)] * j[slot_V(dim)] * p->F, q = v_set(0), v[3];
  vec laminar = VVF * k->fluid.laminar * matrix_regular(kernel, k->regular, &k->fluid, p);
  if (terms & SPH_MCG) q += laminar / fluid_apart(p->r2);
  if (terms & SPH_ARTIFICIAL) {
    for (int d = 0; d < dim; d++) v[d] = i[slot_v(dim) + d] - j[velocity + d];
    q += VVF * matrix_artificial(dim, &k->fluid, p, i, j, v);
  }
  if (k->drag > 0) q += matrix_drag(dim, kernel, k, p, i, j);
  *along_v = terms & SPH_MORRIS ? laminar : v_set(0);
  *along_r = q;
}

#endif
