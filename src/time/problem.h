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
 * min h/(c + |v|), to which the stepper applies cfl and S; VISCOUS, FORCE, CONDUCTION, DRAG, USER
 * are final. */
typedef struct sph_step_limit {
  double dt[SPH_BOUND_COUNT];
} sph_step_limit;

/* What of f is evaluated: the parts that add up to f, and two that do so for separable problems. */
enum sph_piece {
  SPH_PIECE_EXPLICIT, /* also the slow part of multirate schemes */
  SPH_PIECE_IMPLICIT,
  SPH_PIECE_FAST,
  SPH_PIECE_DRIFT, /* of a separable f: the rates of positions, others zero */
  SPH_PIECE_KICK,  /* the rates of all others, those of positions zero */
  SPH_PIECE_COUNT
};

/* One implicit stage: z = known + gamma f_implicit(t, z). */
typedef struct sph_stage {
  double t;
  double gamma;     /* > 0 [s] */
  double tolerance; /* of the weighted norm (sph_problem.weights) of the error of z */
  N_Vector known;   /* as given */
  N_Vector z;       /* comes as a guess, to be the solution */
  long iterations;  /* of linear solvers: added to by solve */
} sph_stage;

typedef struct sph_problem {
  void *ctx;
  int threads;
  int drift; /* dr/dt is not v: what f says of positions counts, also in second-order schemes */
  int (*rhs)(double t, N_Vector y, N_Vector ydot, void *ctx); /* counts itself nothing */
  /* The same, but leaves the rates of positions as they are: for schemes that take the velocities
   * for them, so that memory for these rates is never touched.  NULL: rhs.  Only without drift. */
  int (*rhs_still)(double t, N_Vector y, N_Vector ydot, void *ctx);
  int (*weights)(N_Vector y, N_Vector weight,
                 void *ctx); /* 1 / scale of each entry (tolerance 1); must be > 0 */
  int (*limits)(double t, N_Vector y, sph_step_limit *limit,
                void *ctx); /* after an evaluation at (t, y); NULL: none */
  int (*admissible)(double t, N_Vector y,
                    void *ctx); /* after a step; SPH_RETRY: repeat with half of it; NULL: always */
  /* f piece by piece, for schemes that need that; NULL: f is one piece. */
  int (*rhs_piece)(int piece, double t, N_Vector y, N_Vector ydot, void *ctx);
  /* Limits of the inner steps of multirate schemes, after an evaluation of the fast piece; `limits`
   * are then those of the slow piece, or of f without its fast and implicit terms.  NULL: none. */
  int (*limits_fast)(double t, N_Vector y, sph_step_limit *limit, void *ctx);
  /* Solves an implicit stage, to its tolerance; NULL: there is no implicit part. */
  int (*solve)(sph_stage *stage, void *ctx);
  /* A bound of the largest |eigenvalue| of df/dy at (t, y) [1/s], for stabilised schemes. */
  int (*dominant)(double t, N_Vector y, double *lambda, void *ctx);
  /* A quantity that f conserves, for relaxation: how much it is more at y than at y0, and how much
   * of that may be rounding; and its derivative with respect to y. */
  int (*energy)(N_Vector y0, N_Vector y, double *change, double *rounding, void *ctx);
  int (*energy_gradient)(N_Vector y, N_Vector gradient, void *ctx);
  sph_error *error; /* where failures are recorded; borrowed */
} sph_problem;

#endif
