/* ARKODE's explicit Runge-Kutta methods, one step at a call.
 *
 * Nothing is left to a default: they differ between SUNDIALS versions.  With error control the step limit goes through
 * the stability function; without it a fixed step is set before each call (there the function would be ignored). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "memory.h"
#include "stepper.h"

#if SPH_SUNDIALS_NUMBER >= 60700
#include <sunadaptcontroller/sunadaptcontroller_soderlind.h>
#endif

typedef struct memory {
  void *arkode;
  ARKodeButcherTable table;
#if SPH_SUNDIALS_NUMBER >= 60700
  SUNAdaptController controller;
#endif
  double cap;    /* given to ARKODE for the step after the last one */
  long rejected; /* error test failures counted so far since the last reset */
  char message[300];
} memory;

static int rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *ctx)
{
  int status = sph_stepper_rhs(ctx, t, y, ydot);
  return status > 0 ? 1 : status < 0 ? -1 : 0;
}

/* 1/(tolerance scale) */
static int weights(N_Vector y, N_Vector w, void *ctx)
{
  const sph_stepper *s = ctx;
  int status = s->problem->weights(y, w, s->problem->ctx);
  if (status) return -1;
  N_VScale(1 / s->def->tolerance, w, w);
  return 0;
}

/* ARKODE multiplies by the CFL fraction, which must be under 1: undone here. */
static const double FRACTION = 0.5;

static int stability(N_Vector y, sunrealtype t, sunrealtype *h, void *ctx)
{
  sph_stepper *s = ctx;
  memory *m = s->memory;
  int bound;
  (void)y, (void)t;
  int status = s->limit(s, &m->cap, &bound);
  *h = m->cap < 1e300 ? m->cap / FRACTION : 1e300;
  return status ? -1 : 0;
}

/* A post-processing function that does nothing: before SUNDIALS 6.7.0 a table whose last stage is at the end of the
 * step, but is not the next step's first, was taken for such a one and lost its order (LLNL/sundials#311). */
#if SPH_SUNDIALS_NUMBER < 60700
static int nothing(sunrealtype t, N_Vector y, void *ctx)
{
  (void)t, (void)y, (void)ctx;
  return 0;
}
static int work_around(const sph_stepper *s, void *arkode)
{
  return s->method->fsal ? 0 : ERKStepSetPostprocessStepFn(arkode, nothing);
}
static void hush(int code, const char *module, const char *function, char *text, void *ctx)
{
  memory *m = ((sph_stepper *)ctx)->memory;
  (void)module;
  if (code < 0) snprintf(m->message, sizeof m->message, "%s: %.250s", function, text);
}
static int quiet(sph_stepper *s, void *arkode) { return ERKStepSetErrHandlerFn(arkode, hush, s); }
#else
static int work_around(const sph_stepper *s, void *arkode) { return (void)s, (void)arkode, 0; }
static int quiet(sph_stepper *s, void *arkode) { return (void)s, (void)arkode, 0; }
#endif

/* PI controller with Gustafsson's usual gains. */
static int set_controller(sph_stepper *s, memory *m)
{
#if SPH_SUNDIALS_NUMBER >= 60700
  m->controller = SUNAdaptController_PI(s->context);
  if (!m->controller || SUNAdaptController_SetParams_PI(m->controller, 0.8, 0.31)) return -1;
  return SPH_ERK(SetAdaptController)(m->arkode, m->controller);
#else
  sunrealtype gains[3] = {0.8, 0.31, 0};
  (void)s;
  return ERKStepSetAdaptivityMethod(m->arkode, ARK_ADAPT_PI, 0, 0, gains);
#endif
}

static int set_adaptive(sph_stepper *s, memory *m)
{
  int bad = SPH_ERK(WFtolerances)(m->arkode, weights);
  bad |= set_controller(s, m);
  bad |= SPH_ERK(SetSafetyFactor)(m->arkode, 0.9);
  bad |= SPH_ERK(SetErrorBias)(m->arkode, 1.5);
  bad |= SPH_ERK(SetMaxGrowth)(m->arkode, 5);
  bad |= SPH_ERK(SetMaxFirstGrowth)(m->arkode, 5);
  bad |= SPH_ERK(SetMinReduction)(m->arkode, 0.1);
  bad |= SPH_ERK(SetMaxEFailGrowth)(m->arkode, 0.3);
  bad |= SPH_ERK(SetSmallNumEFails)(m->arkode, 2);
  bad |= SPH_ERK(SetMaxErrTestFails)(m->arkode, 20);
  bad |= SPH_ERK(SetFixedStepBounds)(m->arkode, 1, 1);
  bad |= SPH_ERK(SetCFLFraction)(m->arkode, FRACTION);
  bad |= SPH_ERK(SetStabilityFn)(m->arkode, stability, s);
  return bad;
}

static void free_memory(sph_stepper *s)
{
  memory *m = s->memory;
  if (!m) return;
#if SPH_SUNDIALS_NUMBER >= 70100
  if (m->arkode) ARKodeFree(&m->arkode);
#else
  if (m->arkode) ERKStepFree(&m->arkode);
#endif
#if SPH_SUNDIALS_NUMBER >= 60700
  if (m->controller) SUNAdaptController_Destroy(m->controller);
#endif
  if (m->table) ARKodeButcherTable_Free(m->table);
  sph_memory_free(m);
  s->memory = NULL;
}

static int adaptive(const sph_stepper *s) { return s->def->tolerance > 0; }

static int create(sph_stepper *s)
{
  sph_error *error = s->problem->error;
  memory *m = s->memory = SPH_NEW(memory, 1, "the integrator", error);
  if (!m) return SPH_ERR_MEMORY;
  m->table = ARKodeButcherTable_LoadERKByName(s->method->table);
  m->arkode = m->table ? ERKStepCreate(rhs, s->t, s->y, s->context) : NULL;
  int bad = !m->arkode;
  if (!bad) bad |= quiet(s, m->arkode) | SPH_ERK(SetUserData)(m->arkode, s);
  if (!bad) bad |= ERKStepSetTable(m->arkode, m->table);
  if (!bad) bad |= SPH_ERK(SetInterpolantType)(m->arkode, ARK_INTERP_HERMITE);
  if (!bad) bad |= SPH_ERK(SetInterpolantDegree)(m->arkode, 3);
  if (!bad) bad |= SPH_ERK(SetMaxNumSteps)(m->arkode, -1);
  if (!bad) bad |= work_around(s, m->arkode);
  if (!bad && adaptive(s)) bad |= set_adaptive(s, m);
  if (bad)
    return sph_error_set(error, SPH_ERR_MEMORY, "ARKODE could not be set up with %s: %s",
                         s->method->name, m->message[0] ? m->message : "out of memory");
  s->next = 0;
  return SPH_OK;
}

/* Sets what ARKODE needs to know for this one step. */
static int prepare(sph_stepper *s, double cap, double t_stop)
{
  memory *m = s->memory;
  int bad = 0;
  if (!adaptive(s)) {
    double h = s->t + cap * (1 + 1e-10) >= t_stop ? t_stop - s->t : cap;
    bad |= SPH_ERK(SetFixedStep)(m->arkode, h);
  } else if (s->next > 0)
    bad |= SPH_ERK(SetInitStep)(m->arkode, fmin(s->next, t_stop - s->t));
  s->next = 0;
  if (t_stop < INFINITY) bad |= SPH_ERK(SetStopTime)(m->arkode, t_stop);
  return bad;
}

static int step(sph_stepper *s, double cap, double t_stop)
{
  memory *m = s->memory;
  double cap_now = m->cap > 0 ? m->cap : cap; /* ARKODE chose this step's size under this cap */
  m->message[0] = 0;
  s->stage_status = 0;
  if (prepare(s, cap, t_stop))
    return sph_error_set(s->problem->error, SPH_ERR_STEP, "ARKODE: %s", m->message);
  sunrealtype t = s->t, h = 0;
  double before = s->t;
  int flag =
      SPH_ERK(Evolve)(m->arkode, t_stop < INFINITY ? t_stop : s->t + 1e30, s->y, &t, ARK_ONE_STEP);
  if (flag < 0 && s->stage_status > 0)
    return SPH_RETRY; /* also explicit methods take it for fatal */
  if (flag < 0)
    return sph_error_set(s->problem->error, SPH_ERR_STEP, "ARKODE failed at t = %g s (%d): %s",
                         before, flag, m->message);
  long rejected = 0;
  SPH_ERK(GetNumErrTestFails)(m->arkode, &rejected);
  s->stats->rejected += rejected - m->rejected;
  m->rejected = rejected;
  SPH_ERK(GetLastStep)(m->arkode, &h);
  s->t_previous = before;
  s->t = flag == ARK_TSTOP_RETURN ? t_stop : t;
  s->error_bound = adaptive(s) && h < cap_now * (1 - 1e-9);
  return SPH_OK;
}

static int interpolate(sph_stepper *s, double t, N_Vector at)
{
  memory *m = s->memory;
  int flag = SPH_ERK(GetDky)(m->arkode, t, 0, at);
  if (flag)
    return sph_error_set(s->problem->error, SPH_ERR_STEP, "no dense output at t = %g s in [%g, %g]",
                         t, s->t_previous, s->t);
  return SPH_OK;
}

static int reset(sph_stepper *s)
{
  memory *m = s->memory;
  int flag = SPH_ERK(Reset)(m->arkode, s->t, s->y);
  long rejected = 0;
  SPH_ERK(GetNumErrTestFails)(m->arkode, &rejected);
  m->rejected = rejected;
  m->cap = 0;
  if (flag)
    return sph_error_set(s->problem->error, SPH_ERR_STEP, "ARKODE could not be reset (%d)", flag);
  return SPH_OK;
}

const sph_scheme sph_integrator_erk = {create, step, interpolate, reset, free_memory};
