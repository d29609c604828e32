/* term_conductivity_artificial.h -- artificial conductivity (Price 2008, eq. 28 and 40).
 *
 *   du_i = sum_j m_j/rho_ij alpha_u v_sig (u_i - u_j) r F_ij,   v_sig = sqrt(|p_i - p_j|/rho_ij),
 *   rho_ij: mean
 *
 * Conserves sum m u; smooths u at contact discontinuities. */
#ifndef SPH_TERM_CONDUCTIVITY_ARTIFICIAL_H
#define SPH_TERM_CONDUCTIVITY_ARTIFICIAL_H
#include "fluid_pair.h"

BODY void term_conductivity_artificial(unsigned terms, const pair *p, const fluid_constants *k,
                                       const particle *i, const particle *j, vec *sum)
{
  vec inverse_rho = 2 / (i->rho + j->rho);
  vec jump = v_abs(fluid_pressure(terms, i) - fluid_pressure(terms, j));
  vec v_sig = v_sqrt(jump * inverse_rho);
  sum[SPH_SUM_HEAT] += p->mF * inverse_rho * k->alpha_u * v_sig * (i->u - j->u) * p->distance;
}

#endif
