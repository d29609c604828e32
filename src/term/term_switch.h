/* term_switch.h -- how much of an artificial viscosity acts: Balsara's factor and a coefficient
 * alpha of each particle.
 *
 *   Pi_ij -> (f_i + f_j)/2 (alpha_i + alpha_j)/(2 alpha) Pi_ij,   alpha: that of the term,
 *
 * beta with it; at a wall of particles, which has neither, f_i alpha_i/alpha of the fluid particle;
 * images behind mirrors have those of theirs.  Symmetric and >= 0: momentum is conserved and
 * heating is >= 0 as before.
 *
 * Balsara (1995):  f = |div v|/(|div v| + |curl v| + 1e-4 c/h)
 * Morris & Monaghan (1997), source of Rosswog et al. (2000):
 *   d alpha/dt = - (alpha - alpha_min)/tau + max(- div v, 0) (alpha_max - alpha),
 *   tau = h/(0.2 c)
 * Cullen & Dehnen (2010), as an ODE, without their jump to alpha_loc:
 *   d alpha/dt = (alpha_loc - alpha)/tau,  tau = 10 h/v_sig, and 0.1 h/v_sig where alpha rises,
 *   alpha_loc = alpha_max h^2 A/(v_sig^2 + h^2 A), not below alpha_min,
 *   A = xi max(- d(div v)/dt, 0),   d(div v)/dt = div a - tr(L L),  L = grad v,
 *   xi = b^2/(b^2 + tr(S S)),  b = 2 (1 - R)^4 div v,  S: the traceless symmetric part of L,
 *   R = sum_j sign(div v_j) m_j W/sum_j m_j W,   v_sig = max_j (c_ij - min(0, w_ij))
 *
 * Gradients are corrected ones over fluid particles (switch_pair.h); plain ones where the
 * least eigenvalue of M is under 0.4. */
#ifndef SPH_TERM_SWITCH_H
#define SPH_TERM_SWITCH_H
#include "fluid_pair.h"

static const double SPH_SWITCH_DECAY = 0.2; /* Morris & Monaghan: h/(c tau) */
static const double SPH_SWITCH_FALL = 10;   /* Cullen & Dehnen: tau v_sig/h, 1/(2 l), l = 0.05, */
static const double SPH_SWITCH_RISE = 0.1;  /* and where alpha rises */

/* The part of Pi_ij that acts. */
BODY vec term_switch(unsigned terms, const fluid_constants *k, const particle *i, const particle *j)
{
  if (!(terms & SPH_SWITCHES)) return v_set(1);
  return (k->own * i->f + k->other * j->f) * (k->own * i->alpha + k->other * j->alpha);
}

#endif
