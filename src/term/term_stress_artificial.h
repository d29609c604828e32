/* term_stress_artificial.h -- what keeps fluids under tension from clumping (Monaghan 2000, eqs.
 * 4.1 to 4.4).
 *
 *   a_i = - sum_j m_j R_ij (W_ij/W(dx))^4 grad_i W_ij,
 *   R_ij = R_i + R_j,  R_i = alpha |p_i|/rho_i^2 where p_i < 0, else 0;
 *   where both pressures are positive  beta (p_i/rho_i^2 + p_j/rho_j^2)
 *
 * A repulsion of near neighbours, central and the same for both ends: momentum and angular momentum
 * are kept.  Its work heats fluids with an energy, half of it each end.  W and W(dx) both go
 * without their constant factor. */
#ifndef SPH_TERM_STRESS_ARTIFICIAL_H
#define SPH_TERM_STRESS_ARTIFICIAL_H
#include "fluid_pair.h"

BODY void term_stress_artificial(int dim, int kernel, unsigned terms, pair *p,
                                 const fluid_constants *k, const particle *i, const particle *j,
                                 vec *sum)
{
  const vec zero = v_set(0), p_i = fluid_pressure(terms, i), p_j = fluid_pressure(terms, j);
  vec s_i = p_i / (i->rho * i->rho), s_j = p_j / (j->rho * j->rho);
  vec pulled = -k->stress_tension * (v_min(s_i, zero) + v_min(s_j, zero));
  vec pressed = k->stress_pressure * (s_i + s_j);
  vec least = v_min(p_i, p_j); /* > 0: both are positive */
  vec near = kernel_shape_w(kernel, dim, p->distance * k->inverse_h) * k->inverse_w_dx;
  near *= near;
  vec stress = v_select(v_less(zero, least), pressed, pulled) * near * near * j->rho;
  p->push -= stress;
  if (terms & SPH_THERMAL) sum[SPH_SUM_HEAT] += 0.5 * p->VF * stress * p->rv;
}

#endif
