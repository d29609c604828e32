/* sphode/integrator.h -- the time integrators, chosen by name. */
#ifndef SPHODE_INTEGRATOR_H
#define SPHODE_INTEGRATOR_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What an entry of the ODE vector is: a second-order scheme may treat each kind in its own way. */
enum sph_role { SPH_ROLE_POSITION, SPH_ROLE_VELOCITY, SPH_ROLE_DENSITY, SPH_ROLE_OTHER };

/* Entries of one kind: those of one component of one field of one group. */
typedef struct sph_segment {
  long offset;   /* of the first entry, a multiple of 8 */
  long n;        /* entries that count; the rest up to capacity is padding */
  long capacity; /* a multiple of 8 */
  int role;      /* enum sph_role */
  int partner;   /* POSITION: index of the segment with its velocity; others: -1 */
} sph_segment;

/* One step of a scheme of your own, from y0 at t to y at t1.  All arrays have n entries: those of
 * the segments and padding, which is zero and may be computed with. */
typedef struct sph_ode {
  double t, t1, h;       /* start, end and size of the step [s] */
  double h_last;         /* of the step before; 0: none since the start or a reset [s] */
  long step;             /* steps since the start or the last reset: 0, 1, ... */
  long n;                /* doubles in each array */
  const double *y0, *f0; /* [n] state at t; rates there (see sph_scheme.carries) */
  double *y;             /* [n] comes as y0; to be the state at t1 */
  double *f1;            /* [n] free to use; with carries the f0 of the next step */
  double *const *work;   /* [sph_scheme.work][n]; kept from step to step, repeated ones too */
  int segments;
  const sph_segment *segment; /* [segments] */
  int drift;   /* positions move with more than their velocities: dr/dt, in f, is not v */
  int threads; /* that a loop may use */
} sph_ode;

/* f = f(t, y) inside a step; y and f are arrays of the sph_ode, f none of y0, f0 (and y != f).
 * Returns 0, or a status that the step then returns at once; > 0 (SPH_RETRY): y is not
 * admissible. */
SPH_API int sph_ode_rhs(sph_ode *ode, double t, const double *y, double *f);

enum { SPH_SCHEME_WORK_MAX = 16 };

/* An explicit scheme: the built-in ones, of which `sphode info integrators` tells, and your own
 * use the same struct.  Retries, stop times, limits, dense output, statistics are the library's. */
typedef struct sph_scheme {
  const char *name; /* copied; not that of a built-in one */
  int order;        /* >= 1 */
  int stages;       /* right-hand sides a step, that of f0 included; >= 1 */
  double stability; /* S: dt <= cfl S h/(c + |v|); > 0 */
  int work;         /* arrays wanted, at most SPH_SCHEME_WORK_MAX */
  /* 0: f0 = f(t, y0): the library evaluates it, at the end of the step before.
   * 1: f0 is what the step before left in f1, at first f(t, y0): for schemes with one evaluation a
   *    step that is not at its ends. */
  int carries;
  /* Makes y of y0.  It may be repeated with a smaller h; what it changes in ctx must bear that.
   * Returns 0, or what sph_ode_rhs returned, or a status < 0. */
  int (*step)(void *ctx, sph_ode *ode);
  void *ctx; /* borrowed */
} sph_scheme;

typedef struct sph_integrator_def {
  /* "erk:<table>", "imex:<table>", "mri:<coupling>", "sprk:<table>", "lsrk:<method>", "leapfrog",
   * "verlet" (the same), "dkd", "predictor-corrector", "midpoint", "verlet-dual", "symplectic";
   * NULL: own's, or without one "erk:bogacki-shampine-4-2-3" */
  const char *method;
  /* Fraction of the scheme's stability limit; 0: 0.85 with error control, 0.35 without. */
  double cfl;
  /* Of a step's error, relative to the physical scales of each field; 0: 1e-2, or none where the
   * scheme has no estimate; < 0: no error control (CFL alone). */
  double tolerance;
  /* Of the step size, by the errors of the last steps: "i", "pi", "gustafsson", "pid", "h211"
   * (docs/theory.md, Time integration); NULL: "i", but that of Ranocha et al. for their pairs.
   * Those that remember steps forget at a start, at a reset (sph_sim_changed, events that change,
   * modifiers), at a retry, and where a stop cut a step short.  All have the safety factor 0.9, a
   * step grows by 5 at most (the first by 10), and shrinks to 0.1 at least. */
  const char *controller;
  double dt_max; /* [s]; 0: no limit */
  /* A smaller step is a failure [s]; 0: 1e-5 of the first limit (none with dt_fixed), which error
   * control may go below in 20 steps one after another. */
  double dt_min;
  double dt_fixed; /* > 0: this step always, limits are not obeyed, nothing is halved [s] */
  int retries;     /* halvings after a step that is not admissible before giving up; 0: 12 */
  /* Of the error of an implicit stage, relative to the same scales; 0: 1e-2 of tolerance with error
   * control, else 1e-8. */
  double stage_tolerance;
  /* What solves the linear systems of implicit stages: "pcg-jacobi", "pcg-ic0",
   * "cholmod-supernodal", "cholmod-simplicial", "klu"; NULL: "auto". */
  const char *linear;
  /* mri: how the fast part is stepped between slow stages.  By fast_method, an "erk:<table>" (NULL:
   * one of the order of the coupling), with steps of fast_step [s] or, where that is 0, with error
   * control to fast_tolerance, relative to the same scales, within the limits of the fast part;
   * 0: 0.1 of tolerance; < 0: these limits alone. */
  const char *fast_method;
  double fast_step, fast_tolerance;
  /* "energy": steps of erk and imex are made a bit shorter or longer, so that the energy, kinetic,
   * internal and potential, changes by its rates alone and not by errors of the step; NULL: not.
   * SUNDIALS 6.6 and later. */
  const char *relax;
  const sph_scheme *own; /* instead of method: a scheme of your own, copied; NULL: none */
} sph_integrator_def;

/* What a scheme asks of the right-hand side f besides its value: bits. */
enum sph_integrator_wants {
  SPH_WANTS_IMPLICIT = 1,  /* terms of part "implicit" are solved for (sph_sim_set_part) */
  SPH_WANTS_FAST = 2,      /* terms of part "fast" have steps of their own */
  SPH_WANTS_SEPARABLE = 4, /* positions move with their velocities, which change with positions */
  SPH_WANTS_DOMINANT = 8   /* a bound of the eigenvalues of df/dy */
};

/* What one integrator is: a row of the table that `sphode info integrators` prints. */
typedef struct sph_integrator_info {
  const char *name;
  int order;
  int stages;        /* right-hand sides a step; imex, mri: explicit parts; 0: as many as needed */
  int error_control; /* has an embedded error estimate */
  double stability;  /* limit S of explicit parts, measured: dt <= S h/(c + |v|) */
  int wants;         /* enum sph_integrator_wants; 0: nothing */
} sph_integrator_info;

/* Row k = 0, 1, ...; returns 0 behind the last. */
SPH_API int sph_integrator_info_get(int k, sph_integrator_info *info);

/* Integrators that the SUNDIALS of this library lacks: asking for one is SPH_ERR_UNBUILT. */
typedef struct sph_integrator_missing {
  const char *name;
  char needs[64]; /* "SUNDIALS 7.2 or later; this library has 6.4.1" */
} sph_integrator_missing;

/* Row k = 0, 1, ...; returns 0 behind the last. */
SPH_API int sph_integrator_missing_get(int k, sph_integrator_missing *missing);

/* What bounds a step. */
enum sph_bound {
  SPH_BOUND_CFL,     /* acoustic limit */
  SPH_BOUND_VISCOUS, /* laminar viscosity */
  SPH_BOUND_FORCE,
  SPH_BOUND_CONDUCTION,
  SPH_BOUND_DIFFUSION, /* of scalars */
  SPH_BOUND_DRAG,      /* between dust and fluids */
  SPH_BOUND_SWITCH,    /* alpha of an artificial viscosity that rises */
  SPH_BOUND_ERROR,     /* error control */
  SPH_BOUND_STOP,      /* an exact stop time */
  SPH_BOUND_USER,      /* dt_max, dt_fixed or a user's term */
  SPH_BOUND_RETRY,     /* halved after a step that was not admissible */
  SPH_BOUND_COUNT
};
SPH_API const char *sph_bound_name(int bound); /* "cfl", "viscous", ... */

/* What happened so far. */
typedef struct sph_step_stats {
  long steps;                     /* accepted */
  long rejected;                  /* failed error tests */
  long retries;                   /* attempts repeated with half the step after SPH_RETRY */
  long rhs_evaluations;           /* also of the explicit part alone */
  long fast_evaluations;          /* of the fast part alone */
  long fast_steps;                /* of the fast part */
  long fast_rejected;             /* of them: repeated with a smaller one */
  long implicit_evaluations;      /* of the implicit part alone */
  long solves;                    /* of implicit stages */
  long solve_iterations;          /* of linear solvers in them */
  long bound_by[SPH_BOUND_COUNT]; /* accepted steps by what bound them */
  double dt_last, dt_smallest, dt_largest; /* [s] */
} sph_step_stats;

/* ---- linear stability ----
 * Of y' = lambda y with steps dt, z = lambda dt.  The amplification of an explicit Runge-Kutta
 * scheme is |R(z)|, R its stability function; of the schemes of this library that of velocity and
 * another field that exchange, measured over 96 steps.  "erk:..." and those; others depend on which
 * terms they take implicitly: NaN, as for an unknown name. */

/* Largest |z| on the ray arg z = angle [rad], pi/2 to pi, up to which no |z| is amplified by more
 * than 1.001 a step. */
SPH_API double sph_stability_extent(const char *method, double angle);
/* The longest dt [s] for n eigenvalues re[k] + i im[k] [1/s]; growing ones count as if they were on
 * the imaginary axis; INFINITY if all are zero. */
SPH_API double sph_stability_step(const char *method, long n, const double *re, const double *im);

#ifdef __cplusplus
}
#endif
#endif
