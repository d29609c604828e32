/* Midpoint predictor-corrector (Monaghan 1989), two evaluations a step h:
 *   predict   y_ = y0 + h/2 f(t0, y0)
 *   correct   y_ = y0 + h/2 f(t0 + h/2, y_)
 *   end       y1 = 2 y_ - y0
 * which is the explicit midpoint rule y1 = y0 + h f(t0 + h/2, y0 + h/2 f(t0, y0)): second order. */
#include "integrator_data.h"
#include "scheme.h"

static int step(void *ctx, sph_ode *ode)
{
  (void)ctx;
  sph_scheme_euler(ode, ode->h / 2, ode->f0);
  int status = sph_ode_rhs(ode, ode->t + ode->h / 2, ode->y, ode->f1);
  if (!status) sph_scheme_euler(ode, ode->h, ode->f1);
  return status;
}

const sph_scheme sph_integrator_midpoint = {
    .name = "midpoint", .order = 2, .stages = 2, .stability = 1.07, .step = step};
