/* term_viscosity_artificial.h -- artificial viscosity (Monaghan 1992, eq. 4.1 and 4.2).
 *
 *   a_i = - sum_j m_j Pi_ij grad_i W_ij,   du_i = 1/2 sum_j m_j Pi_ij v_ij . grad_i W_ij >= 0
 *   Pi_ij = (-alpha c_ij mu_ij + beta mu_ij^2)/rho_ij  if v_ij . r_ij < 0, else 0
 *   mu_ij = h v_ij . r_ij/(r^2 + eta^2),  eta^2 = 0.01 h^2,  c_ij, rho_ij: means
 *
 * Central and antisymmetric; gas alpha = 1, beta = 2; water alpha = 0.01 .. 0.1, beta = 0: then
 * SPH_QUADRATIC is not set, and what it stands for left out. */
#ifndef SPH_TERM_VISCOSITY_ARTIFICIAL_H
#define SPH_TERM_VISCOSITY_ARTIFICIAL_H
#include "term_switch.h"

BODY void term_viscosity_artificial(unsigned terms, pair *p, const fluid_constants *k,
                                    const particle *i, const particle *j)
{
  vec w = v_min0(p->rv_viscous), e = p->r2 + k->eta2;
  vec above = k->viscosity_1 * (i->c + j->c), below = e * (i->rho + j->rho);
  if (terms & SPH_QUADRATIC) above = above * e + k->viscosity_2 * w, below *= e;
  p->along_r -= term_switch(terms, k, i, j) * (j->rho * w) * above / below;
}

#endif
