/* sphode/correction.h -- corrections of sums that lack neighbours or find them in disorder.
 * docs/theory.md, Corrections. */
#ifndef SPHODE_CORRECTION_H
#define SPHODE_CORRECTION_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

struct sph_sim;

/* Density is made anew from that of the neighbours after every `steps` accepted steps, > 0, usually
 * 20 to 50: where it is integrated, noise goes, and with it that of the pressure.  kind:
 *
 *   "shepard"  rho_i = sum m_j W_ij/sum V_j W_ij, exact for a constant density
 *   "mls"      rho_i = sum m_j (b0 + b.r_ij) W_ij (Colagrossi & Landrini 2003), exact for a linear
 *              one, as in a column at rest, also at surfaces; "shepard" where neighbours lack
 *
 * Itself included; within each fluid and, except dust, at walls of its equation of state, as the
 * term delta.  Masses, velocities and the energy that is integrated stay: what density says of
 * volume and pressure changes.  A modifier (sphode/event.h) of the name "density-reset", at its
 * place among them; once only.  Before the run or between steps; not where density is a sum. */
SPH_API void sph_sim_reset_density(struct sph_sim *sim, const char *kind, long steps);

#ifdef __cplusplus
}
#endif
#endif
