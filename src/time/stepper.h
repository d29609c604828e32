/* stepper.h -- one scheme behind an integrator: takes single steps; integrator.c retries, limits and counts. */
#ifndef SPH_STEPPER_H
#define SPH_STEPPER_H
#include "integrator.h"
#include "integrator_table.h"

typedef struct sph_stepper sph_stepper;

/* What a scheme does.  step: from (t, y) by one accepted step of at most `cap`, not past t_stop; y and *t move only on
 * success.  Returns 0, SPH_RETRY (the right-hand side asked for a smaller step) or a failure (recorded). */
typedef struct sph_scheme {
  int (*create)(sph_stepper *s);
  int (*step)(sph_stepper *s, double cap, double t_stop);
  int (*interpolate)(sph_stepper *s, double t, N_Vector at);
  int (*reset)(sph_stepper *s); /* (t, y) were set anew */
  void (*free)(sph_stepper *s);
} sph_scheme;

struct sph_stepper {
  const sph_scheme *scheme;
  const sph_method *method;
  const sph_integrator_def *def;
  const sph_problem *problem;
  sph_step_stats *stats;
  SUNContext context;
  N_Vector y;           /* the state, borrowed */
  double t, t_previous; /* of y; of the state one step before */
  double next;          /* a first guess of the next step after a reset [s]; 0: none */
  int error_bound;      /* the last step was chosen by error control, not by the cap */
  void *memory;         /* the scheme's own */
  /* The step limit at (t, y): cap and what it comes from (integrator.c). */
  int (*limit)(sph_stepper *s, double *cap, int *bound);
  int stage_status; /* of the last right-hand side that did not return 0 */
};

/* Counts and evaluates the right-hand side. */
int sph_stepper_rhs(sph_stepper *s, double t, N_Vector y, N_Vector ydot);
/* Cubic Hermite interpolation between (t0, y0, f0) and (t1, y1, f1). */
void sph_stepper_hermite(double t0, double t1, double t, N_Vector y0, N_Vector f0, N_Vector y1,
                         N_Vector f1, N_Vector at);

extern const sph_scheme sph_integrator_erk, sph_integrator_leapfrog, sph_integrator_verlet;

#endif
