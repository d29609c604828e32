/* sphode/integrator.h -- the time integrators, chosen by name. */
#ifndef SPHODE_INTEGRATOR_H
#define SPHODE_INTEGRATOR_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_integrator_def {
  /* "erk:<ARKODE table>", "leapfrog", "verlet" (the same); NULL: "erk:bogacki-shampine-4-2-3" */
  const char *method;
  /* Fraction of the scheme's stability limit; 0: 0.8 with error control, 0.35 without. */
  double cfl;
  /* Of a step's error, relative to the physical scales of each field; 0: 1e-2, or none where the
   * scheme has no estimate; < 0: no error control (CFL alone). */
  double tolerance;
  double dt_max;   /* [s]; 0: no limit */
  double dt_min;   /* a smaller step is a failure [s]; 0: 1e-9 of the first limit */
  double dt_fixed; /* > 0: this step always, limits are not obeyed, nothing is halved [s] */
  int retries;     /* halvings after a step that is not admissible before giving up; 0: 12 */
} sph_integrator_def;

/* What one integrator is: a row of the table that `sphode info integrators` prints. */
typedef struct sph_integrator_info {
  const char *name;
  int order;
  int stages;        /* right-hand sides a step */
  int error_control; /* has an embedded error estimate */
  double stability;  /* limit S, measured or estimated: dt <= S h/(c + |v|) */
} sph_integrator_info;

/* Row k = 0, 1, ...; returns 0 behind the last. */
SPH_API int sph_integrator_info_get(int k, sph_integrator_info *info);

/* What happened so far. */
typedef struct sph_step_stats {
  long steps;    /* accepted */
  long rejected; /* failed error tests */
  long retries;  /* attempts repeated with half the step after SPH_RETRY */
  long rhs_evaluations;
  long bound_by[8];                        /* accepted steps by what bound them: enum sph_bound */
  double dt_last, dt_smallest, dt_largest; /* [s] */
} sph_step_stats;

enum sph_bound {
  SPH_BOUND_CFL,     /* acoustic limit */
  SPH_BOUND_VISCOUS, /* and CONDUCTION: for terms to come, no built-in one sets them yet */
  SPH_BOUND_FORCE,
  SPH_BOUND_CONDUCTION,
  SPH_BOUND_ERROR, /* error control */
  SPH_BOUND_STOP,  /* an exact stop time */
  SPH_BOUND_USER,  /* dt_max, dt_fixed or a user's term */
  SPH_BOUND_RETRY, /* halved after a step that was not admissible */
  SPH_BOUND_COUNT
};
SPH_API const char *sph_bound_name(int bound); /* "cfl", "viscous", ... */

#ifdef __cplusplus
}
#endif
#endif
