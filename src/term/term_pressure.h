/* term_pressure.h -- the pressure force (Monaghan 1992; Price 2012, section 2).
 *
 *   C2:  a_i = - sum_j m_j (p_i + p_j)/(rho_i rho_j) grad_i W_ij
 *   S:   a_i = - sum_j m_j (p_i/rho_i^2 + p_j/rho_j^2) grad_i W_ij
 *   phi: a_i = - sum_j m_j (p_i/rho_i^2 phi_i/phi_j + p_j/rho_j^2 phi_j/phi_i) grad_i W_ij
 *
 * Central and antisymmetric: conserves linear and angular momentum exactly.  With B = M^-1, the
 * inverse gradient matrix (gradient_pair.h), corrected:
 *
 *   mean       B_i and B_j at p_i and p_j: p_i/rho_i^2 B_i + p_j/rho_j^2 B_j, ... (Bonet & Lok
 *              1999); antisymmetric, not central: conserves linear momentum, energy with continuity
 *              that is corrected, and in row C2 (sum V_j r B_i r F = -1) angular momentum
 *   one-sided  a_i = - 1/rho_i sum_j V_j (p_j - p_i) B_i grad_i W_ij, of no row; exact for a linear
 *              pressure, also at surfaces; conserves nothing
 *
 * A wall of particles has the B of i, an image behind a mirror that of its particle, reflected. */
#ifndef SPH_TERM_PRESSURE_H
#define SPH_TERM_PRESSURE_H
#include "fluid_pair.h"

BODY void term_pressure(unsigned terms, pair *p, const particle *i, const particle *j)
{
  if (terms & SPH_FORM_C2)
    p->push -= i->p * (1 / i->rho) + j->p * (1 / i->rho); /* of i alone: once a block */
  else if (terms & SPH_FORM_PHI)
    p->push -= j->rho * (i->p / j->phi + j->p / i->phi); /* the slots hold phi p/rho^2 */
  else
    p->push -= j->rho * (i->p + j->p); /* the slots hold p/rho^2 */
}

BODY void term_pressure_corrected(int dim, unsigned terms, const pair *p, const particle *i,
                                  const particle *j, const vec *Br_i, const vec *Br_j, vec *sum)
{
  vec of_i = i->p, of_j = j->p, weight = p->mF;
  if (terms & SPH_PRESSURE_ONE_SIDED) {
    of_i = fluid_pressure(terms, j) - fluid_pressure(terms, i);
    of_j = v_set(0);
  } else if (terms & SPH_FORM_PHI) {
    of_i /= j->phi;
    of_j /= i->phi;
  }
  if (terms & (SPH_FORM_C2 | SPH_PRESSURE_ONE_SIDED)) weight = p->VF / i->rho;
  for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] -= weight * (of_i * Br_i[d] + of_j * Br_j[d]);
}

#endif
