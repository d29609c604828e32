/* sphode/sensitivity.h -- forward sensitivities: what a run's result owes to its parameters.
 *
 *   s_k = dy/dtheta_k,   ds_k/dt = (df/dy) s_k + df/dtheta_k,
 *
 * integrated with y by the integrator of the simulation (Hindmarsh et al. 2005, section 2.6).  With
 * fixed steps the result is the derivative of the numerical result itself, up to rounding; only
 * schemes that are not linear in the rates of density (symplectic) differ by their own error.
 * Explicit integrators that step all terms alike: erk:... and those of this library. */
#ifndef SPHODE_SENSITIVITY_H
#define SPHODE_SENSITIVITY_H
#include "sphode/group.h"
#include "sphode/output.h"
#include "sphode/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A parameter by name:
 *   h                       smoothing length [m], at fixed spacing and masses
 *   TERM.NUMBER             viscosity-artificial.alpha, .beta, viscosity-signal.alpha, .beta,
 *                           conductivity-artificial.alpha, delta.delta, xsph.epsilon, drag.K or
 *                           drag.rate (1/stopping time), harmonic.omega, gravity.x, .y, .z
 *   GROUP.viscosity, GROUP.conductivity, GROUP.temperature (of a wall)
 *   GROUP.c0, .rho0, .gamma, .p_background, .p_inf, .q, .slope, .grueneisen, .c_v
 *                           of its equation of state, in all groups that have the same one
 * Those of terms that do nothing (alpha = 0) are not there.  c0 acts by pressure, artificial
 * viscosity and density diffusion alike; what the start owes to a parameter, as a column at rest
 * to c0, is the user's to tell: sph_sensitivity_write. */
typedef struct sph_sensitivity_parameter {
  const char *name; /* copied */
  /* A number of yours that callbacks read (terms, equations of state, motions of walls): changed
   * and restored while they are differenced; then any name.  NULL: one of the above. */
  double *own;
} sph_sensitivity_parameter;

typedef struct sph_sensitivity sph_sensitivity;

/* Of a simulation, which must outlive it and has neither events nor modifiers.  NULL: the error,
 * with the known parameters, is the simulation's. */
SPH_API sph_sensitivity *sph_sensitivity_create(sph_sim *sim, int n,
                                                const sph_sensitivity_parameter *parameters);
SPH_API void sph_sensitivity_free(sph_sensitivity *sensitivity); /* NULL is fine */

/* Parameter k = 0, 1, ... that a simulation has, to name[size]; 0 behind the last. */
SPH_API int sph_sensitivity_known(sph_sim *sim, int k, char *name, size_t size);

/* Runs simulation and sensitivities from the state of the simulation to t_end [s]; may be called
 * again to go on, also from fields that were written (sensitivities stay), but not behind a run
 * without them.  Outputs of the simulation are not written. */
SPH_API int sph_sensitivity_run(sph_sensitivity *sensitivity, double t_end);

/* d(field)/dtheta_k of an integrated field of a fluid, [count]; to be written before the first run
 * where the start depends on theta_k, else it begins with zeros.  NULL: no such field. */
SPH_API const double *sph_sensitivity_read(const sph_sensitivity *sensitivity, int k,
                                           const sph_group *group, const char *field,
                                           int component);
SPH_API double *sph_sensitivity_write(sph_sensitivity *sensitivity, int k, const sph_group *group,
                                      const char *field, int component);

/* dQ/dtheta_k of any quantity of the state that the simulation shows: by differences of it along
 * dy/dtheta_k and theta_k, to about 1e-9 where it is smooth.  quantity returns 0 or a failure. */
SPH_API int sph_sensitivity_of(sph_sensitivity *sensitivity, int k,
                               int (*quantity)(void *ctx, sph_sim *sim, double *value), void *ctx,
                               double *derivative);
/* ... of a monitor: front position, pressure at a probe, ... [its unit / that of theta_k]. */
SPH_API int sph_sensitivity_of_monitor(sph_sensitivity *sensitivity, int k,
                                       const sph_monitor *monitor, double *derivative);

#ifdef __cplusplus
}
#endif
#endif
