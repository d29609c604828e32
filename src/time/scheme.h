/* scheme.h -- what the built-in schemes share: combinations of states and rates, and the positions.
 *
 * d = dr/dt - v is what moves positions besides their velocities; without drift it is zero and not
 * looked at. */
#ifndef SPH_SCHEME_H
#define SPH_SCHEME_H
#include "sphode/integrator.h"

/* The segment with the velocity of segment k if that is a position, else NULL. */
const sph_segment *sph_scheme_velocity(const sph_ode *ode, int k);

/* What a thread does for its share of all segments; a, f: as given to sph_scheme_sweep, which calls
 * it, in as many threads as pay: one region for all segments, not one each. */
typedef void sph_scheme_sweeper(sph_ode *ode, double a, const double *f);
void sph_scheme_sweep(sph_ode *ode, sph_scheme_sweeper *sweep, double a, const double *f);

/* In a sweep; what one of these writes, the next may read at the same place, of as many entries.
 * y = y0 + h (g + h/2 f), without f y0 + h g; y0 may be y.  Arrays: [n], n >= 0. */
void sph_scheme_advance(long n, double h, double *y, const double *y0, const double *g,
                        const double *f);
/* y = y0 + h/2 (f0 + f1) */
void sph_scheme_kick(long n, double h, double *y, const double *y0, const double *f0,
                     const double *f1);
/* y = (y0 + y + h f)/2 */
void sph_scheme_mean(long n, double h, double *y, const double *y0, const double *f);
/* y = y0 + h (f - v); y0 may be y */
void sph_scheme_slip(long n, double h, double *y, const double *y0, const double *f,
                     const double *v);

/* All of y = y0 + h f, positions included. */
void sph_scheme_euler(sph_ode *ode, double h, const double *f);
/* Takes the velocities of y, at which f1 was evaluated, from the rates of positions in f1: d is
 * left. */
void sph_scheme_drift(sph_ode *ode);
/* Positions from old and new velocities: r = r0 + h/2 (v0 + v) + h [(1 - w) d0 + w d], d in f1. */
void sph_scheme_positions(sph_ode *ode, double w);
/* d in f1 becomes dr/dt again, with the velocities of y. */
void sph_scheme_undrift(sph_ode *ode);

#endif
