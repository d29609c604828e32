/* wall_scene.h -- flows along and against walls of each model, and what they are off by: shared by
 * the tests of walls and bench/walls.c. */
#ifndef WALL_SCENE_H
#define WALL_SCENE_H
#include "sphode.h"

/* A wall of the model that keeps fluid in the box lo .. hi, but at its open sides. */
sph_group *wall_scene_box(sph_sim *sim, const char *name, sph_boundary boundary, const double *lo,
                          const double *hi, const char *open);
/* The boundary of that name; no_slip where viscous terms see it. */
sph_boundary wall_scene_boundary(const char *model, int no_slip);

/* Water at rest in a tank, H/dx = 20, at t sqrt(g/H). */
typedef struct wall_rest {
  double error, motion; /* L1(p)/(rho g H); kinetic over potential energy */
  double seconds;
} wall_rest;
wall_rest wall_scene_rest(const char *model, const char *diffusion, double t);

/* Couette and Poiseuille from rest, n across: rms error over the largest speed at
 * wall_scene_times[0 .. count - 1]. */
enum { WALL_TIMES = 5 };
extern const double wall_scene_times[WALL_TIMES]; /* [L^2/nu] */
void wall_scene_channel(const char *model, int couette, int n, double h_over_dx, int count,
                        double error[WALL_TIMES]);

/* Between cylinders of radius 1 and 2, n across, the inner one turning: rms error over its speed at
 * the steady state.  The particles are on rings around the axis. */
double wall_scene_cylinders(const char *model, int n, double h_over_dx);

/* Heat between two walls, n across, h/dx = 2 at 20 and growing as sqrt(n): rms error over the
 * largest change of temperature.  kind: "dirichlet" (from T = 0 to surfaces of 1), "neumann" (a
 * cosine decays), "flux" (one surface heated, the other adiabatic: mirrors). */
double wall_scene_slab(const char *model, const char *kind, int n);

/* A manufactured solution between plates, n across; h_over_dx 0: 1.5 at 16 across, growing as
 * sqrt(n).  L1 of velocity over U and of pressure over rho0 U^2. */
void wall_scene_manufactured(const char *model, int no_slip, int n, double h_over_dx, double *v,
                             double *p);

/* 10 s of the dam break of cases/dam-break-2d-impact.yml, H/dx = n. */
typedef struct wall_impact {
  long particles, lost; /* behind a wall by more than dx, or above the tank */
  double least;         /* smallest distance to a wall over dx at any frame, < 0: behind */
  double energy;        /* (kinetic + potential at the end)/(at the start) */
  double seconds;
  int status;
  char error[256];
} wall_impact;
wall_impact wall_scene_impact(const char *model, int n, double t_end);

#endif
