/* term_delta.h -- density diffusion of the delta-SPH family, added to d rho_i/dt.
 *
 *   D_i = delta h c0 sum_j V_j psi_ij . grad_i W_ij
 *   Molteni & Colagrossi (2009):  psi_ij = 2 (rho_j - rho_i) (r_j - r_i)/r^2
 *   Antuono et al. (2010):        psi_ij = 2 (rho_j - rho_i) (r_j - r_i)/r^2
 *                                          - (<grad rho>^L_i + <grad rho>^L_j)
 *   Fourtakas et al. (2019):      psi_ij = 2 (rho_j - rho_i - rho^H_ij) (r_j - r_i)/r^2,
 *     rho^H_ij = rho0 [(1 + x)^(1/gamma) - 1],  x = rho0 |g| z_ij/B = -gamma g.r_ij/c0^2
 *
 * rho^H is the difference of density of a column at rest, B = rho0 c0^2/gamma, z up; its power is
 * summed as a series, exact to rounding where |x| < 0.02 and to 1e-9 of itself up to 0.1 within the
 * support; more is refused.
 * sum V D = 0, but for Fourtakas' with gravity and gamma > 1, where rho^H_ij + rho^H_ji = O(x^2);
 * Antuono's vanishes for a linear density, also at free surfaces.  A wall has no
 * gradient of its own: it mirrors that of i.  The factor delta h c0 is applied to the sum
 * (sim_pairs.c). */
#ifndef SPH_TERM_DELTA_H
#define SPH_TERM_DELTA_H
#include "fluid_pair.h"

BODY void term_delta_molteni(const pair *p, const particle *i, const particle *j, vec *sum)
{
  sum[SPH_SUM_DIFFUSION] += 2 * (i->rho - j->rho) * p->VF;
}

BODY void term_delta_fourtakas(int dim, const pair *p, const fluid_constants *k, const particle *i,
                               const particle *j, vec *sum)
{
  vec x = k->column[0] * p->r[0], series = v_set(1);
  for (int d = 1; d < dim; d++) x += k->column[d] * p->r[d];
  for (int n = SPH_FOURTAKAS_TERMS - 1; n > 0; n--) series = 1 + k->series[n] * x * series;
  vec hydrostatic = k->rho0 * k->series[0] * x * series;
  sum[SPH_SUM_DIFFUSION] += 2 * (i->rho - j->rho + hydrostatic) * p->VF;
}

BODY void term_delta_antuono(int dim, unsigned terms, const pair *p, const particle *i,
                             const particle *j, vec *sum)
{
  vec gradients[3];
  for (int d = 0; d < dim; d++)
    gradients[d] = i->extra[d] + (terms & SPH_WALL ? i->extra[d] : j->extra[d]);
  sum[SPH_SUM_DIFFUSION] += (2 * (i->rho - j->rho) - fluid_dot(dim, gradients, p->r)) * p->VF;
}

#endif
