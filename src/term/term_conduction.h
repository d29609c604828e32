/* term_conduction.h -- heat conduction (Cleary & Monaghan 1999, eq. 12 and 26), kappa that of the
 * groups.
 *
 *   du_i = sum_j m_j/(rho_i rho_j) 4 kappa_i kappa_j/(kappa_i + kappa_j) (T_i - T_j) F_ij
 *
 * The harmonic mean keeps the flux continuous where kappa jumps.  Keeps sum m u; heat flows from
 * hot to cold. */
#ifndef SPH_TERM_CONDUCTION_H
#define SPH_TERM_CONDUCTION_H
#include "fluid_pair.h"

BODY void term_conduction(const pair *p, int kernel, const fluid_constants *k, const particle *i,
                          const particle *j, vec *sum)
{
  vec flow = k->conduction * p->VF * fluid_regular(kernel, k, p) / i->rho;
  sum[SPH_SUM_HEAT] += flow * (i->T - j->T);
}

#endif
