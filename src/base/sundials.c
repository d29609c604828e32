#include "sundials.h"

#include <stddef.h>

#if SPH_SUNDIALS_NUMBER >= 60700
#include <sundials/sundials_adaptcontroller.h>
#endif
#if SPH_SUNDIALS_NUMBER >= 70000
#include <sundials/sundials_logger.h>
#endif

#if SPH_SUNDIALS_NUMBER >= 70000
#define HANDLER(Step) /* of the context */
#else
#define HANDLER(Step) .set_err_handler_fn = Step##SetErrHandlerFn,
#endif
#if SPH_SUNDIALS_NUMBER >= 60700
#define CONTROLLER(Step) .set_adapt_controller = SPH_SUNDIALS(Step, SetAdaptController),
#else
#define CONTROLLER(Step) \
  .set_error_bias = Step##SetErrorBias, .set_adaptivity_fn = Step##SetAdaptivityFn,
#endif
#define SHARED(Step)                                                           \
  .free = SPH_SUNDIALS(Step, Free), .reset = SPH_SUNDIALS(Step, Reset),        \
  .evolve = SPH_SUNDIALS(Step, Evolve), .get_dky = SPH_SUNDIALS(Step, GetDky), \
  .set_user_data = SPH_SUNDIALS(Step, SetUserData),                            \
  .set_interpolant_type = SPH_SUNDIALS(Step, SetInterpolantType),              \
  .set_interpolant_degree = SPH_SUNDIALS(Step, SetInterpolantDegree),          \
  .set_stop_time = SPH_SUNDIALS(Step, SetStopTime),                            \
  .set_fixed_step = SPH_SUNDIALS(Step, SetFixedStep)
#define WEIGHTS(Step) .wf_tolerances = SPH_SUNDIALS(Step, WFtolerances),
#define ADAPTIVE(Step)                                              \
  .set_init_step = SPH_SUNDIALS(Step, SetInitStep),                 \
  .get_current_step = SPH_SUNDIALS(Step, GetCurrentStep),           \
  .get_last_step = SPH_SUNDIALS(Step, GetLastStep),                 \
  .get_num_err_test_fails = SPH_SUNDIALS(Step, GetNumErrTestFails), \
  .set_stability_fn = SPH_SUNDIALS(Step, SetStabilityFn),           \
  .set_cfl_fraction = SPH_SUNDIALS(Step, SetCFLFraction),           \
  .set_safety_factor = SPH_SUNDIALS(Step, SetSafetyFactor),         \
  .set_max_growth = SPH_SUNDIALS(Step, SetMaxGrowth),               \
  .set_max_first_growth = SPH_SUNDIALS(Step, SetMaxFirstGrowth),    \
  .set_min_reduction = SPH_SUNDIALS(Step, SetMinReduction),         \
  .set_fixed_step_bounds = SPH_SUNDIALS(Step, SetFixedStepBounds),  \
  .set_max_efail_growth = SPH_SUNDIALS(Step, SetMaxEFailGrowth),    \
  .set_small_num_efails = SPH_SUNDIALS(Step, SetSmallNumEFails),    \
  .set_max_err_test_fails = SPH_SUNDIALS(Step, SetMaxErrTestFails)

#if SPH_SUNDIALS_NUMBER >= 60600
#define RELAX(Step)                                        \
  .set_relax_fn = SPH_SUNDIALS(Step, SetRelaxFn),          \
  .set_relax_res_tol = SPH_SUNDIALS(Step, SetRelaxResTol), \
  .set_relax_tol = SPH_SUNDIALS(Step, SetRelaxTol),
#else
#define RELAX(Step)
#endif

const sph_sundials_calls sph_sundials_erk = {HANDLER(ERKStep) SHARED(ERKStep),
                                             WEIGHTS(ERKStep) RELAX(ERKStep) CONTROLLER(ERKStep)
                                                 ADAPTIVE(ERKStep)};
const sph_sundials_calls sph_sundials_ark = {HANDLER(ARKStep) SHARED(ARKStep),
                                             WEIGHTS(ARKStep) RELAX(ARKStep) CONTROLLER(ARKStep)
                                                 ADAPTIVE(ARKStep)};
#if SPH_SUNDIALS_NUMBER >= 70100
const sph_sundials_calls sph_sundials_mri = {SHARED(MRIStep), WEIGHTS(MRIStep) CONTROLLER(MRIStep)
                                                                  ADAPTIVE(MRIStep)};
#else
const sph_sundials_calls sph_sundials_mri = {HANDLER(MRIStep) SHARED(MRIStep), WEIGHTS(MRIStep)};
#endif

#if SPH_SUNDIALS_NUMBER >= 60600 /* steps of SPRKStep have no error: no weights */
const sph_sundials_calls sph_sundials_sprk = {HANDLER(SPRKStep) SHARED(SPRKStep)};
#endif
#if SPH_SUNDIALS_NUMBER >= 70200
const sph_sundials_calls sph_sundials_lsrk = {SHARED(LSRKStep), WEIGHTS(LSRKStep) CONTROLLER(
                                                                    LSRKStep) ADAPTIVE(LSRKStep)};
#endif

#if SPH_SUNDIALS_NUMBER >= 70000

static int create(SUNContext *context)
{
  SUNLogger logger = NULL;
  if (SUNContext_Create(SUN_COMM_NULL, context)) return -1;
  int failed = SUNContext_ClearErrHandlers(*context) || SUNContext_GetLogger(*context, &logger);
  if (!failed && logger) /* warnings and errors of its logger go to stderr by default */
    failed = SUNLogger_SetWarningFilename(logger, "/dev/null") ||
             SUNLogger_SetErrorFilename(logger, "/dev/null");
  if (failed) SUNContext_Free(context);
  return failed;
}

static void hear(int line, const char *function, const char *file, const char *text,
                 SUNErrCode code, void *data, SUNContext context)
{
  const sph_sundials_listener *listener = data;
  (void)line, (void)function, (void)file, (void)code, (void)context;
  listener->listen(text, listener->ctx);
}

int sph_sundials_listen(const sph_sundials_calls *call, void *memory, SUNContext context,
                        sph_sundials_listener *listener)
{
  (void)call, (void)memory;
  return SUNContext_PushErrHandler(context, hear, listener);
}

void sph_sundials_deaf(SUNContext context) { SUNContext_PopErrHandler(context); }

#else

static int create(SUNContext *context) { return SUNContext_Create(NULL, context); }

static void hear(int code, const char *module, const char *function, char *text, void *data)
{
  const sph_sundials_listener *listener = data;
  (void)code, (void)module, (void)function;
  listener->listen(text, listener->ctx);
}

int sph_sundials_listen(const sph_sundials_calls *call, void *memory, SUNContext context,
                        sph_sundials_listener *listener)
{
  (void)context;
  return call->set_err_handler_fn(memory, hear, listener);
}

void sph_sundials_deaf(SUNContext context) { (void)context; }

#endif

#if SPH_SUNDIALS_NUMBER >= 60700

#if SPH_SUNDIALS_NUMBER < 70000
#define SUNErrCode int
#endif

static SUNAdaptController_Type type(SUNAdaptController object)
{
  (void)object;
  return SUN_ADAPTCONTROLLER_H;
}

static SUNErrCode estimate(SUNAdaptController object, sunrealtype h, int order, sunrealtype error,
                           sunrealtype *h_new)
{
  const sph_sundials_controller *controller = object->content;
  (void)order;
  *h_new = controller->step(h, error, controller->ctx);
  return 0;
}

static SUNErrCode nothing(SUNAdaptController object)
{
  (void)object;
  return 0;
}

int sph_sundials_control(const sph_sundials_calls *call, void *memory, SUNContext context,
                         sph_sundials_controller *controller)
{
  SUNAdaptController object = SUNAdaptController_NewEmpty(context);
  if (!object) return -1;
  object->content = controller;
  object->ops->gettype = type;
  object->ops->estimatestep = estimate;
  object->ops->reset = nothing;
  controller->object = object;
  return call->set_adapt_controller(memory, object);
}

void sph_sundials_control_free(sph_sundials_controller *controller)
{
  if (controller->object) SUNAdaptController_DestroyEmpty(controller->object);
  controller->object = NULL;
}

#else

static int adapt(N_Vector y, sunrealtype t, sunrealtype h1, sunrealtype h2, sunrealtype h3,
                 sunrealtype e1, sunrealtype e2, sunrealtype e3, int q, int p, sunrealtype *h_new,
                 void *data)
{
  const sph_sundials_controller *controller = data;
  (void)y, (void)t, (void)h2, (void)h3, (void)e2, (void)e3, (void)q, (void)p;
  *h_new = controller->step(h1, e1, controller->ctx);
  return 0;
}

int sph_sundials_control(const sph_sundials_calls *call, void *memory, SUNContext context,
                         sph_sundials_controller *controller)
{
  (void)context;
  return call->set_error_bias(memory, 1) || call->set_adaptivity_fn(memory, adapt, controller);
}

void sph_sundials_control_free(sph_sundials_controller *controller) { controller->object = NULL; }

#endif

SUNContext sph_sundials_context(sph_error *error)
{
  SUNContext context = NULL;
  if (create(&context)) {
    sph_error_set(error, SPH_ERR_MEMORY, "SUNDIALS made no context: out of memory?");
    return NULL;
  }
  return context;
}

void sph_sundials_context_free(SUNContext context)
{
  if (context) SUNContext_Free(&context);
}
