/* term_viscosity_laminar.h -- laminar viscosity, eta that of the groups.
 *
 *   Morris, Fox & Zhu (1997), eq. 22:
 *     a_i = sum_j m_j (eta_i + eta_j)/(rho_i rho_j) F_ij v_ij                 -> eta/rho lap v
 *   Monaghan, Cleary & Gingold (Cleary 1998; Monaghan 2005, eq. 8.9):
 *     a_i = 2 (d + 2) sum_j m_j 2 eta_i eta_j/(eta_i + eta_j)/(rho_i rho_j)
 *           (v_ij . r_ij)/r^2 grad_i W_ij                    -> eta/rho (lap v + 2 grad div v)
 *
 * Both keep linear momentum and heat both ends by half of what motion loses; the second is central,
 * keeps angular momentum and leaves a rigid rotation alone, the first does not.  F as it is: with
 * r^2/(r^2 + eta^2) the viscosity would come out 1.5 % too small; only a kernel whose F is singular
 * needs that.
 *
 * Corrected: F_ij (e.B e), e = r_ij/r, with B of i (one-sided) or the mean of those of both (mean),
 * B = M^-1 (gradient_pair.h): the second moment of the sum, 0.3 % off on a lattice and cut in half
 * at a surface, is what it should be.  As central as before, and with `mean` as antisymmetric; B is
 * positive definite: it still heats. */
#ifndef SPH_TERM_VISCOSITY_LAMINAR_H
#define SPH_TERM_VISCOSITY_LAMINAR_H
#include "fluid_pair.h"

BODY void term_viscosity_morris(pair *p, int kernel, const fluid_constants *k, const particle *i)
{
  p->along_v += k->laminar * p->stretch * fluid_regular(kernel, k, p) / i->rho;
}

BODY void term_viscosity_mcg(pair *p, int kernel, const fluid_constants *k, const particle *i)
{
  vec rate = p->rv_viscous / fluid_apart(p->r2) * p->stretch;
  p->along_r += k->laminar * rate * fluid_regular(kernel, k, p) / i->rho;
}

#endif
