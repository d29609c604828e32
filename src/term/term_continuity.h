/* term_continuity.h -- the continuity equation (Monaghan 1992; Price 2012, section 2).
 *
 *   C2:  d rho_i/dt = rho_i sum_j V_j v_ij . grad_i W_ij
 *   C1:  d rho_i/dt =       sum_j m_j v_ij . grad_i W_ij
 *   phi: d rho_i/dt = phi_i sum_j m_j/phi_j v_ij . grad_i W_ij,  any phi > 0
 *
 * Corrected: B_i grad_i W_ij, B_i = M_i^-1, in place of grad_i W_ij (gradient_pair.h): exact for a
 * linear velocity in row C2, also at surfaces; the partner of the pressure of correction `mean`
 * (Bonet & Lok 1999).
 *
 * Exact time derivative of the summation density (C1); better across jumps of density (C2).  The
 * sum without its factor also gives the heating by compression, du_i = p_i/rho_i^2 d rho_i/dt:
 * partner of the pressure force of the same row, so that sum m (v^2/2 + u) is conserved and the
 * entropy of each particle too. */
#ifndef SPH_TERM_CONTINUITY_H
#define SPH_TERM_CONTINUITY_H
#include "fluid_pair.h"

/* rv: r.v or, corrected, B_i r.v. */
BODY void term_continuity(unsigned terms, const pair *p, vec rv, const particle *j, vec *sum)
{
  vec weight = terms & SPH_FORM_C2 ? p->VF : p->mF;
  if (terms & SPH_FORM_PHI) weight /= j->phi;
  sum[SPH_SUM_COMPRESSION] += weight * rv;
}

#endif
