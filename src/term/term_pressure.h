/* term_pressure.h -- the pressure force (Monaghan 1992; Price 2012, section 2).
 *
 *   C2:  a_i = - sum_j m_j (p_i + p_j)/(rho_i rho_j) grad_i W_ij
 *   S:   a_i = - sum_j m_j (p_i/rho_i^2 + p_j/rho_j^2) grad_i W_ij
 *   phi: a_i = - sum_j m_j (p_i/rho_i^2 phi_i/phi_j + p_j/rho_j^2 phi_j/phi_i) grad_i W_ij
 *
 * Central and antisymmetric: conserves linear and angular momentum exactly. */
#ifndef SPH_TERM_PRESSURE_H
#define SPH_TERM_PRESSURE_H
#include "fluid_pair.h"

BODY void term_pressure(unsigned terms, pair *p, const particle *i, const particle *j)
{
  if (terms & SPH_FORM_C2)
    p->push -= p->VF * (i->p + j->p) * (1 / i->rho);
  else if (terms & SPH_FORM_PHI)
    p->push -= p->mF * (i->p / j->phi + j->p / i->phi); /* the slots hold phi p/rho^2 */
  else
    p->push -= p->mF * (i->p + j->p); /* the slots hold p/rho^2 */
}

#endif
