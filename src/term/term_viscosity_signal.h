/* term_viscosity_signal.h -- artificial viscosity with a signal velocity (Monaghan 1997, eq. 4.2;
 * Springel 2005).
 *
 *   a_i = - sum_j m_j Pi_ij grad_i W_ij,   du_i = 1/2 sum_j m_j Pi_ij v_ij . grad_i W_ij >= 0
 *   Pi_ij = - alpha/2 v_sig w_ij/rho_ij  if w_ij < 0, else 0,   w_ij = v_ij . r_ij/r
 *   v_sig = c_i + c_j - beta w_ij,   rho_ij: mean
 *
 * Central and antisymmetric; does not depend on h. */
#ifndef SPH_TERM_VISCOSITY_SIGNAL_H
#define SPH_TERM_VISCOSITY_SIGNAL_H
#include "term_switch.h"

BODY void term_viscosity_signal(unsigned terms, pair *p, const fluid_constants *k,
                                const particle *i, const particle *j)
{
  vec w = v_min0(p->rv_viscous) / fluid_apart(p->distance);
  vec v_sig = i->c + j->c - k->signal_2 * w;
  p->along_r -= term_switch(terms, k, i, j) * j->rho * k->signal_1 * v_sig * w / (i->rho + j->rho);
}

#endif
