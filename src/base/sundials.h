/* sundials.h -- the only door to SUNDIALS, 6.4.1 to 7.x: one name for what its versions call
 * differently. */
#ifndef SPH_SUNDIALS_H
#define SPH_SUNDIALS_H
#include <arkode/arkode.h>
#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>

#include "sphode/base.h"

/* 60401 is 6.4.1 */
#define SPH_SUNDIALS_NUMBER \
  (SUNDIALS_VERSION_MAJOR * 10000 + SUNDIALS_VERSION_MINOR * 100 + SUNDIALS_VERSION_PATCH)

/* From 7.1 on, what all steppers share is called ARKode..., not ERKStep... */
#if SPH_SUNDIALS_NUMBER >= 70100
#define SPH_ERK(function) ARKode##function
#else
#define SPH_ERK(function) ERKStep##function
#endif

/* A context that never prints; NULL on failure (recorded). */
SUNContext sph_sundials_context(sph_error *error);
void sph_sundials_context_free(SUNContext context); /* NULL is fine */

/* What SUNDIALS says of the stepper `memory` goes to listen(text, ctx) until that is freed; from
 * 7.0 on it is what it says in the context, until sph_sundials_deaf.  0 or a failure. */
typedef struct sph_sundials_listener {
  void (*listen)(const char *text, void *ctx);
  void *ctx;
} sph_sundials_listener;
int sph_sundials_listen(void *memory, SUNContext context, sph_sundials_listener *listener);
void sph_sundials_deaf(SUNContext context);

/* The new step size step(h, error, ctx), in place of SUNDIALS' controllers, whose defaults differ
 * between versions; error is the weighted norm of the estimate: 1 is just right. */
typedef struct sph_sundials_controller {
  double (*step)(double h, double error, void *ctx);
  void *ctx;
  void *object; /* SUNDIALS' part, its own */
} sph_sundials_controller;
int sph_sundials_control(void *memory, SUNContext context, sph_sundials_controller *controller);
void sph_sundials_control_free(
    sph_sundials_controller *controller); /* after the stepper's memory */

#endif
