/* sundials.h -- the only door to SUNDIALS, 6.4.1 to 7.x: one name for what its versions call
 * differently. */
#ifndef SPH_SUNDIALS_H
#define SPH_SUNDIALS_H
#include <arkode/arkode.h>
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_butcher_dirk.h>
#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>
#include <arkode/arkode_mristep.h>
#include <limits.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>

#include "sphode/base.h"

/* 60401 is 6.4.1 */
#define SPH_SUNDIALS_NUMBER \
  (SUNDIALS_VERSION_MAJOR * 10000 + SUNDIALS_VERSION_MINOR * 100 + SUNDIALS_VERSION_PATCH)

/* What all steppers share is called ARKode... from 7.1 on, before ERKStep..., ARKStep..., ... */
#if SPH_SUNDIALS_NUMBER >= 70100
#define SPH_SUNDIALS(Step, function) ARKode##function
#else
#define SPH_SUNDIALS(Step, function) Step##function
#endif

/* LSRKStep's flag for a step that would take more stages than it may. */
#if SPH_SUNDIALS_NUMBER >= 70200
#define SPH_SUNDIALS_MANY_STAGES ARK_MAX_STAGE_LIMIT_FAIL
#else
#define SPH_SUNDIALS_MANY_STAGES INT_MIN /* none has that */
#endif

/* These functions, for steppers that differ in nothing else; NULL: that one has none. */
typedef struct sph_sundials_calls {
  void (*free)(void **memory);
  int (*reset)(void *memory, sunrealtype t, N_Vector y);
  int (*evolve)(void *memory, sunrealtype t_out, N_Vector y, sunrealtype *t, int task);
  int (*get_dky)(void *memory, sunrealtype t, int k, N_Vector dky);
  int (*set_user_data)(void *memory, void *data);
  int (*set_interpolant_type)(void *memory, int type);
  int (*set_interpolant_degree)(void *memory, int degree);
  int (*set_stop_time)(void *memory, sunrealtype t);
  int (*set_fixed_step)(void *memory, sunrealtype h);
#if SPH_SUNDIALS_NUMBER < 70000
  int (*set_err_handler_fn)(void *memory, ARKErrHandlerFn hear, void *data);
#endif
  int (*wf_tolerances)(void *memory, ARKEwtFn weigh); /* not of SPRKStep */
  /* adaptive steps: not of SPRKStep, nor of MRIStep up to 7.0 */
  int (*set_init_step)(void *memory, sunrealtype h);
  int (*get_current_step)(void *memory, sunrealtype *h);
  int (*get_last_step)(void *memory, sunrealtype *h);
  int (*get_num_err_test_fails)(void *memory, long *fails);
  int (*set_stability_fn)(void *memory, ARKExpStabFn stable, void *data);
  int (*set_cfl_fraction)(void *memory, sunrealtype fraction);
  int (*set_safety_factor)(void *memory, sunrealtype factor);
  int (*set_max_growth)(void *memory, sunrealtype factor);
  int (*set_max_first_growth)(void *memory, sunrealtype factor);
  int (*set_min_reduction)(void *memory, sunrealtype factor);
  int (*set_fixed_step_bounds)(void *memory, sunrealtype low, sunrealtype high);
  int (*set_max_efail_growth)(void *memory, sunrealtype factor);
  int (*set_small_num_efails)(void *memory, int count);
  int (*set_max_err_test_fails)(void *memory, int count);
#if SPH_SUNDIALS_NUMBER >= 60600 /* of ERKStep and ARKStep */
  int (*set_relax_fn)(void *memory, ARKRelaxFn energy, ARKRelaxJacFn gradient);
  int (*set_relax_res_tol)(void *memory, sunrealtype tolerance);
  int (*set_relax_tol)(void *memory, sunrealtype relative, sunrealtype absolute);
#endif
#if SPH_SUNDIALS_NUMBER >= 60700
  int (*set_adapt_controller)(void *memory, SUNAdaptController controller);
#else
  int (*set_error_bias)(void *memory, sunrealtype bias);
  int (*set_adaptivity_fn)(void *memory, ARKAdaptFn adapt, void *data);
#endif
} sph_sundials_calls;
extern const sph_sundials_calls sph_sundials_erk, sph_sundials_ark, sph_sundials_mri;
extern const sph_sundials_calls sph_sundials_sprk; /* from 6.6 on */
extern const sph_sundials_calls sph_sundials_lsrk; /* from 7.2 on */

/* A context that never prints; NULL on failure (recorded). */
SUNContext sph_sundials_context(sph_error *error);
void sph_sundials_context_free(SUNContext context); /* NULL is fine */

/* What SUNDIALS says of the stepper `memory` goes to listen(text, ctx) until that is freed; from
 * 7.0 on it is what it says in the context, until sph_sundials_deaf.  0 or a failure. */
typedef struct sph_sundials_listener {
  void (*listen)(const char *text, void *ctx);
  void *ctx;
} sph_sundials_listener;
int sph_sundials_listen(const sph_sundials_calls *call, void *memory, SUNContext context,
                        sph_sundials_listener *listener);
void sph_sundials_deaf(SUNContext context);

/* The new step size step(h, error, ctx), in place of SUNDIALS' controllers, whose defaults differ
 * between versions; error is the weighted norm of the estimate: 1 is just right. */
typedef struct sph_sundials_controller {
  double (*step)(double h, double error, void *ctx);
  void *ctx;
  void *object; /* SUNDIALS' part, its own */
} sph_sundials_controller;
int sph_sundials_control(const sph_sundials_calls *call, void *memory, SUNContext context,
                         sph_sundials_controller *controller);
void sph_sundials_control_free(
    sph_sundials_controller *controller); /* after the stepper's memory */

#endif
