/* problem.h -- what a stepper needs to know of what it steps: time/ knows no particles.
 *
 * All callbacks return a status: 0, > 0 (SPH_RETRY: a smaller step, please), < 0 failed (see
 * error). */
#ifndef SPH_PROBLEM_H
#define SPH_PROBLEM_H
#include "sphode/base.h"
#include "sphode/integrator.h"
#include "sundials.h"

/* Longest steps by cause, enum sph_bound [s]; INFINITY where there is none.  dt[SPH_BOUND_CFL] is
 * min h/(c + |v|), to which the stepper applies cfl and S; VISCOUS, FORCE, CONDUCTION, USER are
 * final. */
typedef struct sph_step_limit {
  double dt[SPH_BOUND_COUNT];
} sph_step_limit;

typedef struct sph_problem {
  void *ctx;
  int threads;
  int drift; /* dr/dt is not v: what f says of positions counts, also in second-order schemes */
  int (*rhs)(double t, N_Vector y, N_Vector ydot, void *ctx); /* counts itself nothing */
  int (*weights)(N_Vector y, N_Vector weight,
                 void *ctx); /* 1 / scale of each entry (tolerance 1); must be > 0 */
  int (*limits)(double t, N_Vector y, sph_step_limit *limit,
                void *ctx); /* after an evaluation at (t, y); NULL: none */
  int (*admissible)(double t, N_Vector y,
                    void *ctx); /* after a step; SPH_RETRY: repeat with half of it; NULL: always */
  sph_error *error;             /* where failures are recorded; borrowed */
} sph_problem;

#endif
