/* ARKODE's explicit Runge-Kutta schemes, one step a call.  Nothing is left to the defaults of
 * ARKODE, which differ between versions: table, controller, growth, interpolation are set here.
 * */
#include <math.h>
#include <stdio.h>

#include "integrator_data.h"
#include "integrator_table.h"
#include "memory.h"
#include "nvector.h"

static const double CLOSE = 1e-6; /* relative: such step sizes are the same */

typedef struct erk {
  void *memory; /* ARKODE's */
  SUNContext context;
  sph_sundials_listener listener;
  sph_sundials_controller controller;
  int listening;
  int used;        /* ARKODE has made a step since its creation */
  int fresh;       /* the next attempt starts anew, with the step size of its plan */
  double error[2]; /* of the last two accepted steps, for controllers with memory; 1 at a start */
  double resume;   /* > 0: start anew with this step, which a stop time had cut short [s] */
  char text[400];  /* what ARKODE said last */
} erk;

/* ARKODE goes on with vectors that got no memory: their operations do nothing, and here it ends.
 * */
static int rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  sph_integrator *it = data;
  if (sph_nvector_lost(y)) return it->rhs_status = SPH_ERR_MEMORY;
  return sph_integrator_rhs(it, t, y, ydot);
}

/* 1 / (tolerance scale); without error control any positive weights do. */
static int weigh(N_Vector y, N_Vector weight, void *data)
{
  sph_integrator *it = data;
  if (sph_nvector_lost(y)) return it->rhs_status = SPH_ERR_MEMORY;
  if (!it->adaptive || !it->problem.weights) {
    N_VConst(it->adaptive ? 1 / it->def.tolerance : 1, weight);
    return 0;
  }
  int status = it->problem.weights(y, weight, it->problem.ctx);
  if (!status) N_VScale(1 / it->def.tolerance, weight, weight);
  return status;
}

/* ARKODE takes the fraction 1/2 of this, an exact number: the limits are ours. */
static int stable(N_Vector y, sunrealtype t, sunrealtype *h, void *data)
{
  sph_integrator *it = data;
  int status = sph_integrator_limit(it, t, y);
  double limit = fmin(it->limit, 2 * it->cap); /* cap is that of the step that just ends */
  *h = limit < INFINITY ? 2 * limit : 0;       /* 0: none */
  return status;
}

/* Ranocha et al. (2022), section 2: from the errors e of this step and of the two accepted before,
 *   h_new = h (1 + arctan(x - 1)),  x = prod_i e_i^(-beta_i/order). */
static double control_pid(double h, double error, sph_integrator *it, const double *beta)
{
  erk *own = it->own;
  const double e[3] = {fmax(error, 1e-10), own->error[0], own->error[1]};
  double x = 1;
  for (int i = 0; i < 3; i++) x *= pow(e[i], -beta[i] / it->info.order);
  if (error <= 1) { /* else the step is repeated */
    own->error[1] = own->error[0];
    own->error[0] = e[0];
  }
  return h * (1 + atan(x - 1));
}

/* Integral controller: error ~ h^(p + 1) with an embedded scheme of order p = order - 1.
 * Without memory, so that a restart changes nothing. */
static double control(double h, double error, void *data)
{
  sph_integrator *it = data;
  const double *beta = sph_integrator_table_control(it->row);
  if (!(error < INFINITY)) return h / 10;
  if (beta) return control_pid(h, error, it, beta);
  return h * pow(fmax(error, 1e-10), -1.0 / it->info.order);
}

static void listen(const char *text, void *data)
{
  erk *own = data;
  snprintf(own->text, sizeof own->text, "%s", text);
}

#if SPH_SUNDIALS_NUMBER < 60700
static int nothing(sunrealtype t, N_Vector y, void *data)
{
  (void)t, (void)y, (void)data;
  return 0;
}

/* SUNDIALS up to 6.6.2 takes any last stage at c = 1 for the rate at the end, and loses order; a
 * hook after the step makes it evaluate anew. */
static int repair(void *memory, ARKodeButcherTable table)
{
  int wrong = fabs(table->c[table->stages - 1] - 1) < 1e-10 && !sph_integrator_table_fsal(table);
  return wrong ? ERKStepSetPostprocessStepFn(memory, nothing) : 0;
}
#else
static int repair(void *memory, ARKodeButcherTable table)
{
  (void)memory, (void)table;
  return 0;
}
#endif

static int set_table(void *memory, int row)
{
  ARKodeButcherTable table = sph_integrator_table_butcher(row);
  if (!table) return -1;
  int failed = ERKStepSetTable(memory, table) || repair(memory, table); /* it keeps a copy */
  ARKodeButcherTable_Free(table);
  return failed;
}

static int configure(sph_integrator *it, erk *own)
{
  void *m = own->memory;
  int failed =
      SPH_ERK(SetUserData)(m, it) || set_table(m, it->row) || SPH_ERK(WFtolerances)(m, weigh) ||
      SPH_ERK(SetInterpolantType)(m, ARK_INTERP_HERMITE) || SPH_ERK(SetInterpolantDegree)(m, 3);
  if (failed || !it->adaptive) return failed;
  own->controller = (sph_sundials_controller){.step = control, .ctx = it};
  return sph_sundials_control(m, own->context, &own->controller) ||
         SPH_ERK(SetStabilityFn)(m, stable, it) || SPH_ERK(SetCFLFraction)(m, 0.5) ||
         SPH_ERK(SetSafetyFactor)(m, 0.9) || SPH_ERK(SetMaxGrowth)(m, 5) ||
         SPH_ERK(SetMaxFirstGrowth)(m, 10) || SPH_ERK(SetMinReduction)(m, 0.1) ||
         SPH_ERK(SetFixedStepBounds)(m, 1, 1) || SPH_ERK(SetMaxEFailGrowth)(m, 0.3) ||
         SPH_ERK(SetSmallNumEFails)(m, 2) || SPH_ERK(SetMaxErrTestFails)(m, 12);
}

static int create(sph_integrator *it, SUNContext context)
{
  erk *own = it->own = SPH_NEW(erk, 1, "a Runge-Kutta integrator", it->problem.error);
  if (!own) return SPH_ERR_MEMORY;
  own->context = context;
  own->fresh = 1;
  own->error[0] = own->error[1] = 1;
  own->memory = ERKStepCreate(rhs, it->time, it->y, context);
  if (!own->memory || sph_nvector_lost(it->y)) return SPH_ERR_MEMORY;
  own->listener = (sph_sundials_listener){.listen = listen, .ctx = own};
  own->listening = !sph_sundials_listen(own->memory, context, &own->listener);
  return own->listening && !configure(it, own) && !sph_nvector_lost(it->y) ? SPH_OK
                                                                           : SPH_ERR_MEMORY;
}

static void release(sph_integrator *it)
{
  erk *own = it->own;
  if (!own) return;
  if (own->memory) SPH_ERK(Free)(&own->memory);
  sph_sundials_control_free(&own->controller);
  if (own->listening) sph_sundials_deaf(own->context);
  sph_memory_free(own);
}

/* What ARKODE's flag means; an evaluation that failed knows better. */
static int outcome(sph_integrator *it, int flag)
{
  const erk *own = it->own;
  if (sph_nvector_lost(it->y)) return sph_integrator_fail(it, SPH_ERR_MEMORY, "out of memory");
  if (flag >= 0) return SPH_OK;
  if (it->rhs_status) return it->rhs_status;
  int status = flag == ARK_MEM_FAIL ? SPH_ERR_MEMORY : SPH_ERR_STEP;
  return sph_integrator_fail(it, status, own->text[0] ? own->text : "SUNDIALS failed");
}

static int restart(sph_integrator *it)
{
  erk *own = it->own;
  own->fresh = 1;
  own->resume = 0;
  own->error[0] = own->error[1] = 1;
  it->rhs_status = 0;
  return outcome(it, SPH_ERK(Reset)(own->memory, it->time, it->y));
}

/* The problem's limits need rates at (time, y); `before` is free at that moment. */
static int start(sph_integrator *it)
{
  erk *own = it->own;
  int status = it->problem.limits ? sph_integrator_rhs(it, it->time, it->y, it->before) : SPH_OK;
  if (!status && own->used) status = restart(it);
  return status;
}

/* The step that ARKODE will try, and what it needs for it. */
static int prepare(sph_integrator *it, const sph_attempt *a, double *h)
{
  erk *own = it->own;
  *h = a->h;
  if (!it->adaptive) return SPH_ERK(SetFixedStep)(own->memory, a->h);
  if (own->resume > 0) {
    *h = fmin(*h, own->resume);
    int status = restart(it);
    if (status) return status;
  }
  if (own->fresh) return SPH_ERK(SetInitStep)(own->memory, *h < INFINITY ? *h : 0);
  return SPH_ERK(GetCurrentStep)(own->memory, h);
}

static int attempt(sph_integrator *it, sph_attempt *a, double t_stop)
{
  erk *own = it->own;
  double t = it->time, left = t_stop - it->time, h = 0;
  own->text[0] = 0;
  it->rhs_status = 0;
  int flag = prepare(it, a, &h);
  if (flag >= 0) flag = SPH_ERK(SetStopTime)(own->memory, t_stop);
  if (flag >= 0) flag = SPH_ERK(Evolve)(own->memory, t_stop, it->y, &t, ARK_ONE_STEP);
  if (flag < 0 || sph_nvector_lost(it->y)) {
    a->h = fmin(h, left);
    return outcome(it, flag);
  }
  own->used = 1;
  own->fresh = 0;
  a->t = flag == ARK_TSTOP_RETURN ? t_stop : t;
  a->h = a->t - it->time;
  if (!it->adaptive) return SPH_OK;
  SPH_ERK(GetNumErrTestFails)(own->memory, &it->stats.rejected);
  if (a->h < a->limit * (1 - CLOSE))
    a->bound = flag == ARK_TSTOP_RETURN ? SPH_BOUND_STOP : SPH_BOUND_ERROR;
  /* A controller that grows steps slowly should not see the one that was cut short. */
  double short_step = sph_integrator_table_control(it->row) ? 0.9 : 0.2;
  if (a->bound == SPH_BOUND_STOP && a->h < short_step * it->stats.dt_last)
    own->resume = it->stats.dt_last;
  return a->bound != SPH_BOUND_STOP && a->h < it->def.dt_min
             ? sph_integrator_fail(it, SPH_ERR_STEP, "error control asks for less than dt_min")
             : SPH_OK;
}

static int interpolate(sph_integrator *it, double t, N_Vector at)
{
  erk *own = it->own;
  it->rhs_status = 0;
  return outcome(it, SPH_ERK(GetDky)(own->memory, t, 0, at));
}

const sph_stepper sph_integrator_erk = {create, release, start, attempt, restart, interpolate};
