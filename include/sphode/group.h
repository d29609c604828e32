/* sphode/group.h -- a group: a named set of particles of one kind.
 *
 * Groups belong to their simulation.  Setters return nothing: the first failure sticks to the
 * simulation.  A NULL group (from a failed predecessor) flows through. */
#ifndef SPHODE_GROUP_H
#define SPHODE_GROUP_H
#include "sphode/base.h"
#include "sphode/boundary.h"
#include "sphode/eos.h"
#include "sphode/field.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_sim sph_sim;
typedef struct sph_group sph_group;

/* An empty group; kind "fluid" or "wall".  Names are unique, [A-Za-z0-9_-]. */
SPH_API sph_group *sph_group_create(sph_sim *sim, const char *name, const char *kind);

/* Adds particles, before the run only.  rho0: density [kg/m^3], also the mass rho0 dx^dim.
 * Box: the lattice (k + 1/2) dx inside [lo, hi], [dim] each; its sides are rounded to whole dx. */
SPH_API void sph_group_add_box(sph_group *group, const double *lo, const double *hi, double rho0);
/* Ball: the points (k + 1/2) dx of the lattice closer than radius to centre. */
SPH_API void sph_group_add_ball(sph_group *group, const double *centre, double radius, double rho0);
/* Layers as thick as the support around the box [lo, hi], outside it; open names sides left out, as
 * "y+ x-" (NULL or "": none).  Corners belong to the layers. */
SPH_API void sph_group_add_layers(sph_group *group, const double *lo, const double *hi,
                                  const char *open, double rho0);
/* Any points: x[d][n] [m]. */
SPH_API void sph_group_add_points(sph_group *group, long n, const double *const x[], double rho0);

/* Moves each particle that the group has by up to `fraction` of dx, 0 to 0.5, in each direction,
 * uniformly; a number of its particle and the seed alone decide: the same start everywhere. */
SPH_API void sph_group_jitter(sph_group *group, double fraction, unsigned long seed);

/* Create and add in one: a fluid box; walls around a box. */
SPH_API sph_group *sph_group_box(sph_sim *sim, const char *name, const double *lo, const double *hi,
                                 double rho0);
SPH_API sph_group *sph_group_walls(sph_sim *sim, const char *name, const double *lo,
                                   const double *hi, double rho0);

/* The equation of state of a fluid; of a wall: that of the fluid it holds (the default: the first
 * fluid's). */
SPH_API void sph_group_set_eos(sph_group *group, sph_eos eos);
SPH_API void sph_group_set_boundary(sph_group *group, sph_boundary boundary);

/* Dynamic viscosity eta [Pa s] of a fluid (walls take that of each fluid) and conductivity of heat
 * kappa [W/(m K)] of a fluid or a wall (0: that of the fluid), >= 0 and finite; default 0.  Before
 * the run, or between steps and in the change of an event, if a term asked for it at the start. */
SPH_API void sph_group_set_viscosity(sph_group *group, double eta);
SPH_API void sph_group_set_conductivity(sph_group *group, double kappa);
/* Of a wall of boundary adami: liquids are held off by 1/2 epsilon c0^2 (0.8 - r/dx)^2 [J/kg] for
 * each wall particle nearer than 0.8 dx.  Default: 0.4; 0: none, and water creeps in.  Before the
 * run (docs/theory.md, Walls). */
SPH_API void sph_group_set_repulsion(sph_group *group, double epsilon);
/* Which energy a fluid integrates: "u" (internal), "total" (u + v^2/2), "entropy" (A = p/rho^gamma,
 * ideal gas), "temperature" (needs eos.c_v) or "none".  Default: "u" for a thermal equation of
 * state, else "none".  A liquid whose pressure does not depend on it may carry u or temperature
 * along, heated by viscosity, conduction and sources only. */
SPH_API void sph_group_set_energy(sph_group *group, const char *variable);

SPH_API const char *sph_group_name(const sph_group *group);
SPH_API const char *sph_group_kind(const sph_group *group);   /* "fluid" or "wall" */
SPH_API long sph_group_count(const sph_group *group);         /* particles */
SPH_API const sph_eos *sph_group_eos(const sph_group *group); /* NULL: none yet */
SPH_API int sph_group_thermal(const sph_group *group); /* its pressure depends on its energy */
SPH_API const char *sph_group_energy(const sph_group *group); /* "u", "total", ..., "none" */
/* Field k = 0, 1, ... of the group, its scalars behind those of sph_field_get; NULL behind the
 * last. */
SPH_API const sph_field_info *sph_group_field(const sph_group *group, int k);

SPH_API double sph_group_viscosity(const sph_group *group);    /* [Pa s]; NULL: 0 */
SPH_API double sph_group_conductivity(const sph_group *group); /* [W/(m K)]; NULL: 0 */

/* One component of a field, [count]: read it, or write it before the run or between steps (then
 * call sph_sim_changed).  Valid until the next step or, before the
 * run, the first evaluation; NULL: no such field or component.  Derived
 * fields (pressure, sound_speed, energies that are not integrated) are those of the state shown:
 * writing to them changes nothing.  Before the run a group's energy is set by "energy" (u) or
 * sph_group_set_temperature, whichever energy it integrates. */
SPH_API const double *sph_group_read(const sph_group *group, const char *field, int component);
SPH_API double *sph_group_write(sph_group *group, const char *field, int component);
/* Time derivative of an integrated field ("velocity": accelerations) at the last sph_sim_evaluate,
 * [count]. */
SPH_API const double *sph_group_rate(const sph_group *group, const char *field, int component);
/* The scale that errors of an integrated field are measured in, that of the error weights: h, V,
 * rho0 (V/c0)^2, V^2/2, ... in the field's unit; 0: no such field, a wall, or not evaluated yet. */
SPH_API double sph_group_scale(const sph_group *group, const char *field);
/* The number of particle i, unique in the simulation, constant; -1: no such particle.  Those of all
 * as an array, [count], which is made and kept once it is asked for; NULL: no memory, recorded. */
SPH_API long sph_group_id(const sph_group *group, long i);
SPH_API const long *sph_group_ids(const sph_group *group);

/* Sets density (and so pressure) of a fluid at rest under gravity g [m/s^2] below the free surface
 * at height `surface` along axis (0, 1, 2) [m]: the exact column of its equation of state; keeps
 * volumes, scales masses. */
SPH_API void sph_group_set_hydrostatic(sph_group *group, int axis, double surface, double g);
/* The same below a surface that carries p_surface [Pa], as another liquid's weight. */
SPH_API void sph_group_set_column(sph_group *group, int axis, double surface, double p_surface,
                                  double g);
/* Sets the pressure of every particle [count] through the inverse equation of state; keeps volumes,
 * scales masses.  Thermal groups: sets u at the present density instead. */
SPH_API void sph_group_set_pressure(sph_group *group, const double *p);
/* Sets the density of every particle [count] [kg/m^3]; keeps volumes, scales masses, and what the
 * equation of state says of it is the pressure.  Thermal groups: u stays; set the pressure or the
 * temperature behind it. */
SPH_API void sph_group_set_density(sph_group *group, const double *rho);
/* Sets u by the temperature of every particle [count] [K] at the present density; needs eos.c_v. */
SPH_API void sph_group_set_temperature(sph_group *group, const double *T);

#ifdef __cplusplus
}
#endif
#endif
