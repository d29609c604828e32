/* sphode/measure.h -- what is read off a simulation besides its fields: forces on walls, their
 * work, the power of each term.
 *
 * All are of the state that the simulation shows (sphode/output.h), from the pair sums of f with
 * the lists as they are: to measure changes no result.  A call costs about as much as one to three
 * right-hand sides; call them between steps or in the frames of outputs. */
#ifndef SPHODE_MEASURE_H
#define SPHODE_MEASURE_H
#include "sphode/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of the fluids on a wall: F = - sum over fluid particles i of m_i times the acceleration of i by
 * pairs with the wall, so that d(momentum of the fluids)/dt = m g - sum of F over all walls, to
 * rounding (what shifting and transport-velocity carry along is no force, and not in it).  Per
 * metre of depth in 2D, per square metre in 1D. */
typedef struct sph_force {
  double force[3];    /* by all pair terms [N/m^(3-dim)] */
  double pressure[3]; /* of it: by the pressure term, */
  double viscous[3];  /* by viscosity, artificial and laminar; the rest is artificial stress
                         and users' own pair terms */
  double torque[3];   /* of `force` [N m/m^(3-dim)]: sum of (x_i - about) x F_i at the fluid
                         particles, where it balances their angular momentum; 1D: 0 */
} sph_force;
/* about[dim] [m] (NULL: the origin); in periodic directions x_i is the one inside the box.  Returns
 * a status; what is wrong sticks to the simulation. */
SPH_API int sph_sim_force(sph_sim *sim, const sph_group *wall, const double *about,
                          sph_force *force);

/* Work of all walls that move on the fluids [J/m^(3-dim)], - int (F.v + omega.T) dt, by the
 * trapezoidal rule over the moments at which this was called, as each frame of a time series does;
 * 0 at the first of them, and where no wall moves.  With it the energy balances: the total of
 * sph_sim_balance changes by this work and what is dissipated.  Returns a status. */
SPH_API int sph_sim_work(sph_sim *sim, double *work);

/* How fast one term of f changes the energies of the fluids [W/m^(3-dim)]:
 *
 *   kinetic    sum m v.a
 *   internal   sum m du/dt, for fluids whose internal energy is elastic sum m p/rho^2 drho/dt
 *
 * with the rates a, du/dt, drho/dt of this term alone.  The sum over all terms is d/dt of kinetic
 * and internal of sph_sim_balance; the power of gravity is what potential energy loses (unless the
 * term xsph moves particles with another velocity than their own). */
typedef struct sph_power {
  const char *term; /* "pressure", ... */
  double kinetic, internal;
} sph_power;
/* Name of term k = 0, 1, ... that has a power; NULL behind the last.  Which they are is known once
 * all terms were added. */
SPH_API const char *sph_sim_power_term(const sph_sim *sim, int k);
/* The power of term k.  Returns a status: SPH_ERR_ARGUMENT behind the last one, and where density
 * is a sum (term summation) of fluids whose energy is elastic: its rate is no part of f. */
SPH_API int sph_sim_power(sph_sim *sim, int k, sph_power *power);

#ifdef __cplusplus
}
#endif
#endif
