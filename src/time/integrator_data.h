/* integrator_data.h -- what the loop over steps and the steppers share. */
#ifndef SPH_INTEGRATOR_DATA_H
#define SPH_INTEGRATOR_DATA_H
#include "controller.h"
#include "integrator.h"
#include "sundials.h"

/* Default fraction of the stability limit: error control repeats a step that was too long. */
static inline double sph_integrator_cfl(int adaptive) { return adaptive ? 0.85 : 0.35; }

/* One try of a step. */
typedef struct sph_attempt {
  double
      limit; /* longest step by all limits, before the stop time shortens it [s]; may be INFINITY */
  double h;  /* to be tried, then what was tried [s] */
  double t;  /* where it ends: set by the stepper */
  int bound; /* what binds it: enum sph_bound */
} sph_attempt;

/* How one kind of scheme steps.  All return a status. */
typedef struct sph_stepper {
  int (*create)(sph_integrator *it, SUNContext context);
  void (*free)(sph_integrator *it); /* also after a failed create */
  /* y at it->time is new: one evaluation there. */
  int (*start)(sph_integrator *it);
  /* From y = it->before at it->time towards t_stop; y then holds the state at attempt->t. */
  int (*attempt)(sph_integrator *it, sph_attempt *attempt, double t_stop);
  /* The attempt does not count; y is it->before again. */
  int (*reject)(sph_integrator *it);
  int (*interpolate)(sph_integrator *it, double t, N_Vector at);
  /* What it remembers between steps, once it was started; when reading y is there. */
  int (*keep)(sph_integrator *it, sph_keep *keep);
  /* Before `reject`, while y is still what the attempt made of it; NULL: nothing. */
  void (*undo)(sph_integrator *it);
} sph_stepper;

enum { SPH_SCHEME_NAME_MAX = 64 };

struct sph_integrator {
  sph_problem problem;
  sph_integrator_def def; /* defaults filled in; method: the table's name */
  sph_integrator_info info;
  int row;                        /* of the table; -1: the user's own scheme */
  const sph_scheme *scheme;       /* NULL: ARKODE's */
  sph_scheme user;                /* copy of def.own */
  char name[SPH_SCHEME_NAME_MAX]; /* and of its name */
  int adaptive;                   /* the step size follows the error estimate */
  sph_controller controller;      /* how, if it does */
  double cfl_given;               /* def.cfl before its default: also that of a fast part */
  const sph_stepper *stepper;
  void *own;             /* the stepper's */
  N_Vector y;            /* borrowed */
  N_Vector before;       /* y at the start of the last step */
  double time, previous; /* [s] */
  int started;           /* evaluated at (time, y) since the last reset */
  int stepped;           /* there is a last step to interpolate in */
  double limit;          /* of the next step by the problem's limits [s] */
  double next;           /* the step that error control would take [s]; INFINITY: it does not say */
  double first;          /* longest first step after a start [s]; INFINITY: any */
  double cap;            /* of the next step after a retry, else INFINITY [s] */
  int cause;             /* of limit: enum sph_bound */
  int rhs_status;        /* of the last evaluation */
  const char *reason;    /* why the attempt is to be repeated, where no evaluation tells; or NULL */
  int bound;
  int least_given; /* def.dt_min is the user's */
  int small;       /* steps below it one after another, where it is not */
  sph_step_stats stats;
  long rejected; /* of them: before the checkpoint that it goes on from */
};

/* f(t, y), counted. */
int sph_integrator_rhs(sph_integrator *it, double t, N_Vector y, N_Vector ydot);
/* A piece of it (enum sph_piece), counted. */
int sph_integrator_piece(sph_integrator *it, int piece, double t, N_Vector y, N_Vector ydot);
/* Asks the problem for its limits and sets it->limit and it->cause. */
int sph_integrator_limit(sph_integrator *it, double t, N_Vector y);
/* An attempt that error control has made shorter: below dt_min, or too often below its default?
 * Else recorded. */
int sph_integrator_controlled(sph_integrator *it, const sph_attempt *a);
/* Records a failure of the step that starts at it->time. */
int sph_integrator_fail(sph_integrator *it, int status, const char *why);

extern const sph_stepper sph_ode_stepper, sph_integrator_erk, sph_integrator_imex;
extern const sph_scheme sph_integrator_leapfrog, sph_integrator_dkd,
    sph_integrator_predictor_corrector, sph_integrator_midpoint, sph_integrator_verlet_dual,
    sph_integrator_symplectic;

/* Where its f1 has taken the place of f0: f0 once more (to rounding), from an attempt that was
 * kicked or only predicted. */
void sph_integrator_leapfrog_undo(const sph_ode *ode, int kicked);

#endif
