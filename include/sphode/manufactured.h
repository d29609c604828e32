/* sphode/manufactured.h -- manufactured solutions: the order of a whole scheme, walls and steps
 * included (Roache 2002, J. Fluids Eng. 124, 4; Salari & Knupp 2000, SAND2000-1444).
 *
 * Any smooth v(x, t) and rho(x, t) or p(x, t) solve the equations of a weakly compressible liquid
 * once these have a force per mass and a source of density:
 *
 *   s_v   = dv/dt + (v.grad) v + (1/rho) grad p - f_laminar - g,   p = p(rho)
 *   s_rho = drho/dt + v.grad rho + rho div v
 *
 * f_laminar is that of the simulation's viscosity-laminar ("morris": nu lap v; "mcg": nu (lap v +
 * 2 grad div v)), g its gravity.  All other terms are taken for part of the scheme: what they do is
 * error.  A source of density is no source of mass: particles keep theirs, so that volumes m/rho
 * drift from those of the particles by (s_rho/rho) t.  Fields with rho v = curl psi(x, t) and
 * rho(x) have none.  Walls are right where the fields are: v there that of the wall (no slip) or
 * along it (free slip); Adami's walls hydrostatic, so that their dp/dn is rho g_n. */
#ifndef SPHODE_MANUFACTURED_H
#define SPHODE_MANUFACTURED_H
#include "sphode/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The fields, at x[3] [m] (0 behind the dimension; positions may be whole periods outside) and t
 * [s]; defined and smooth also length/25 beyond the domain and time/25 before the start:
 * derivatives are central differences of order 8, right to about 1e-11.  Called from one thread at
 * a time. */
typedef struct sph_manufactured {
  void (*velocity)(void *ctx, const double x[3], double t, double v[3]); /* [m/s] */
  /* One of both, the other follows by the equation of state: */
  double (*density)(void *ctx, const double x[3], double t);  /* [kg/m^3] > 0 */
  double (*pressure)(void *ctx, const double x[3], double t); /* [Pa] */
  /* Shortest wave length [m] and period [s] of the fields, > 0: differences take hundredths. */
  double length, time;
  void *ctx; /* the user's; borrowed until the simulation is freed */
} sph_manufactured;

/* Gives a liquid, before the run and once it has particles and an equation of state, the fields at
 * t = 0 (masses rho dx^dim) and their sources, a term "manufactured".  def is copied. */
SPH_API void sph_manufactured_attach(sph_group *group, const sph_manufactured *def);

/* s_v [m/s^2] and s_rho [kg/m^3/s] at x[3] and t, with the terms that the simulation has now;
 * either may be NULL.  Returns a status. */
SPH_API int sph_manufactured_source(const sph_group *group, const double x[3], double t,
                                    double s_v[3], double *s_rho);

/* Of "velocity", "density" or "pressure" in the state shown: mean |f - f_exact|, root of the mean
 * square, and the largest, in the unit of the field.  Returns a status. */
typedef struct sph_manufactured_error {
  double L1, L2, max;
} sph_manufactured_error;
SPH_API int sph_manufactured_error_of(const sph_group *group, const char *field,
                                      sph_manufactured_error *error);

/* The order that n >= 2 resolutions dx[n] with errors error[n] > 0 show: the slope of the straight
 * line through (ln dx, ln error), by least squares; NaN where there is none. */
SPH_API double sph_manufactured_order(long n, const double *dx, const double *error);

#ifdef __cplusplus
}
#endif
#endif
