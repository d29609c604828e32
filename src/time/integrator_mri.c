/* ARKODE's explicit multirate schemes: the slow part by MRIStep, the fast part between slow stages
 * by fast.c. */
#include <math.h>
#include <string.h>

#include "fast.h"
#include "integrator_arkode.h"
#include "integrator_kinds.h"
#include "memory.h"
#include "nvector.h"

static const struct {
  const char *name, *coupling;
  double stability;
  int needs;
} row[] = {
#define X(name, coupling, stability, needs) {name, coupling, stability, needs},
#include "integrator_mri.def"
#undef X
};
enum { ROWS = sizeof row / sizeof *row };

const char *sph_integrator_mri_known(int k, int *needs)
{
  if (k >= ROWS) return NULL;
  *needs = row[k].needs;
  return row[k].name;
}

static MRIStepCoupling coupling_of(int k)
{
  return MRIStepCoupling_LoadTableByName(row[k].coupling);
}

int sph_integrator_mri_info(int k, sph_integrator_info *info)
{
  MRIStepCoupling coupling = coupling_of(k);
  if (!coupling) return 0;
  *info = (sph_integrator_info){.order = coupling->q,
                                .stages = coupling->stages - 1,
                                .error_control = coupling->p > 0 && SPH_SUNDIALS_NUMBER >= 70200,
                                .stability = row[k].stability,
                                .wants = SPH_WANTS_FAST};
  MRIStepCoupling_Free(coupling);
  return 1;
}

typedef struct multirate {
  MRIStepInnerStepper inner; /* as MRIStep knows it */
  sph_fast *fast;
  int failed;    /* status of the fast part in this attempt */
  N_Vector from; /* of the last reset: where the next evolve starts, whatever its y; borrowed */
  N_Vector rates[2], piece; /* rates at the ends of a step, for dense output; NULL: ARKODE's own */
  double begin, end;        /* of that step; NAN: of none */
} multirate;

/* In 7.0 and 7.1 what MRIStep interpolates with may lack the fast rates (erk45a). */
#define OWN_DENSE (SPH_SUNDIALS_NUMBER >= 70000 && SPH_SUNDIALS_NUMBER < 70200)

static multirate *of(const sph_integrator *it)
{
  return ((const sph_integrator_arkode *)it->own)->kind;
}

static int slow(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  sph_integrator *it = data;
  int failed = of(it)->failed;
  if (failed) return it->rhs_status = failed;
  return sph_integrator_arkode_piece(it, SPH_PIECE_EXPLICIT, t, y, ydot);
}

static sph_integrator *owner(MRIStepInnerStepper inner)
{
  void *it = NULL;
  MRIStepInnerStepper_GetContent(inner, &it);
  return it;
}

/* A failure is told as one that ARKODE does not try to mend: halving steps is ours.  With error
 * control it is kept until the step is over: SUNDIALS up to 7.5 loses the vector that it was given
 * if it fails in its second last stage, which is for the estimate. */
static int evolve(MRIStepInnerStepper inner, sunrealtype t, sunrealtype t_end, N_Vector y)
{
  sph_integrator *it = owner(inner);
  sph_fast_rates rates = {0};
  multirate *kind = of(it);
  MRIStepInnerStepper_GetForcingData(inner, &rates.shift, &rates.scale, &rates.rate, &rates.n);
  if (kind->from && kind->from != y) N_VScale(1, kind->from, y);
  kind->from = NULL;
  if (!kind->failed) kind->failed = sph_fast_evolve(kind->fast, &rates, t, t_end, y);
  it->rhs_status = kind->failed;
  return kind->failed && !it->adaptive ? -1 : 0;
}

static int evaluate(MRIStepInnerStepper inner, sunrealtype t, N_Vector y, N_Vector ydot, int mode)
{
  (void)mode;
  return sph_fast_rhs(of(owner(inner))->fast, t, y, ydot);
}

static int reset(MRIStepInnerStepper inner, sunrealtype t, N_Vector y)
{
  (void)t;
  of(owner(inner))->from = y;
  return 0;
}

static int make_inner(sph_integrator *it, SUNContext context, multirate *kind)
{
  if (MRIStepInnerStepper_Create(context, &kind->inner)) return -1;
  return MRIStepInnerStepper_SetContent(kind->inner, it) ||
         MRIStepInnerStepper_SetEvolveFn(kind->inner, evolve) ||
         MRIStepInnerStepper_SetFullRhsFn(kind->inner, evaluate) ||
         MRIStepInnerStepper_SetResetFn(kind->inner, reset);
}

static int set_coupling(void *memory, const char *name)
{
  int k = 0;
  while (strcmp(row[k].name, name)) k++;
  MRIStepCoupling coupling = coupling_of(k);
  if (!coupling) return -1;
  int failed = MRIStepSetCoupling(memory, coupling); /* it keeps a copy */
  MRIStepCoupling_Free(coupling);
  return failed;
}

static int make_rates(sph_integrator *it, multirate *kind)
{
#if OWN_DENSE
  N_Vector *to[3] = {&kind->rates[0], &kind->rates[1], &kind->piece};
  for (int k = 0; k < 3; k++) {
    *to[k] = sph_nvector_clone(it->y, "rates for dense output", it->problem.error);
    if (!*to[k]) return SPH_ERR_MEMORY;
  }
#else
  (void)it;
#endif
  kind->begin = kind->end = NAN;
  return SPH_OK;
}

static int create(sph_integrator *it, SUNContext context)
{
  if (!it->problem.rhs_piece)
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "integrator %s steps the fast part of f apart, and there is none; right "
                         "is a part, or an integrator of all (\"erk:...\")",
                         it->info.name);
  sph_integrator_arkode *own = sph_integrator_arkode_create(it, context, &sph_sundials_mri);
  if (!own) return SPH_ERR_MEMORY;
  multirate *kind = own->kind = SPH_NEW(multirate, 1, "a multirate integrator", it->problem.error);
  if (!kind) return SPH_ERR_MEMORY;
  kind->fast = sph_fast_create(it, it->info.order);
  if (!kind->fast || make_inner(it, context, kind) || make_rates(it, kind)) return SPH_ERR_MEMORY;
  own->memory = MRIStepCreate(slow, NULL, it->time, it->y, kind->inner, context);
  int status = sph_integrator_arkode_configure(it);
  return !status && set_coupling(own->memory, it->info.name) ? SPH_ERR_MEMORY : status;
}

static void release(sph_integrator *it)
{
  sph_integrator_arkode *own = it->own;
  multirate *kind = own ? own->kind : NULL;
  sph_integrator_arkode_free(it);
  if (!kind) return;
  if (kind->inner) MRIStepInnerStepper_Free(&kind->inner);
  sph_fast_free(kind->fast);
  for (int k = 0; k < 2; k++)
    if (kind->rates[k]) N_VDestroy(kind->rates[k]);
  if (kind->piece) N_VDestroy(kind->piece);
  sph_memory_free(kind);
}

static int start(sph_integrator *it)
{
  sph_fast_reset(of(it)->fast);
  return sph_integrator_arkode_start(it);
}

static int attempt(sph_integrator *it, sph_attempt *a, double t_stop)
{
  multirate *kind = of(it);
  kind->failed = SPH_OK;
  int status = sph_integrator_arkode_attempt(it, a, t_stop);
  return status ? status : kind->failed;
}

#if OWN_DENSE

/* f_slow + f_fast */
static int rates(sph_integrator *it, double t, N_Vector y, N_Vector f)
{
  multirate *kind = of(it);
  int failed = sph_integrator_arkode_piece(it, SPH_PIECE_EXPLICIT, t, y, f);
  if (!failed) failed = sph_fast_rhs(kind->fast, t, y, kind->piece);
  if (!failed) N_VLinearSum(1, f, 1, kind->piece, f);
  return failed;
}

/* Cubic Hermite interpolation as in ode.c, s = (t - t0)/h:
 *   y0 + s (y1 - y0) + s (s - 1) ((1 - 2 s)(y1 - y0) + h ((s - 1) f0 + s f1)) */
static int interpolate(sph_integrator *it, double t, N_Vector at)
{
  multirate *kind = of(it);
  int status = SPH_OK;
  if (kind->begin != it->previous || kind->end != it->time) {
    kind->begin = kind->end = NAN;
    status = rates(it, it->previous, it->before, kind->rates[0]);
    if (!status) status = rates(it, it->time, it->y, kind->rates[1]);
    if (status) return status;
    kind->begin = it->previous;
    kind->end = it->time;
  }
  const double h = it->time - it->previous, s = (t - it->previous) / h, q = s * (s - 1);
  const double rise = s + q * (1 - 2 * s);
  N_VLinearSum(1 - rise, it->before, rise, it->y, at);
  N_VLinearSum(1, at, h * q * (s - 1), kind->rates[0], at);
  N_VLinearSum(1, at, h * q * s, kind->rates[1], at);
  return SPH_OK;
}

#else

static int interpolate(sph_integrator *it, double t, N_Vector at)
{
  return sph_integrator_arkode_interpolate(it, t, at);
}

#endif

static int keep(sph_integrator *it, sph_keep *keep)
{
  int status = sph_integrator_arkode_keep(it, keep);
  return status ? status : sph_fast_keep(of(it)->fast, keep);
}

const sph_stepper sph_integrator_mri = {
    create, release, start, attempt, sph_integrator_arkode_reject, interpolate, keep, NULL,
};
