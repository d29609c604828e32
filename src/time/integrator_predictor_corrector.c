/* Predictor-corrector of Heun, two evaluations f = (v + d, a, R) a step h:
 *   predict   y* = y0 + h f(t0, y0)
 *   correct   v1 = v0 + h/2 (a0 + a*),  q1 = q0 + h/2 (R0 + R*),  f* = f(t1, y*)
 *             r1 = r0 + h/2 (v0 + v1) + h/2 (d0 + d*)
 * Sound, which swings between v and the density, sees Heun's method as printed everywhere: its
 * amplitude grows by |1 + z + z^2/2| = sqrt(1 + (omega h)^4/4) a step, 1.0078 at omega h = 1/2.
 * What swings between r and v does not: positions move with the corrected velocity. */
#include <stddef.h>

#include "integrator_data.h"
#include "scheme.h"

static void correct(sph_ode *ode, double a, const double *f)
{
  (void)a, (void)f;
  for (int k = 0; k < ode->segments; k++) {
    long o = ode->segment[k].offset;
    sph_scheme_kick(ode->segment[k].n, ode->h, ode->y + o, ode->y0 + o, ode->f0 + o, ode->f1 + o);
  }
}

static int step(void *ctx, sph_ode *ode)
{
  (void)ctx;
  sph_scheme_euler(ode, ode->h, ode->f0);
  int status = sph_ode_rhs(ode, ode->t1, ode->y, ode->f1);
  if (status) return status;
  sph_scheme_drift(ode);
  sph_scheme_sweep(ode, correct, 0, NULL);
  sph_scheme_positions(ode, 0.5);
  return SPH_OK;
}

const sph_scheme sph_integrator_predictor_corrector = {
    .name = "predictor-corrector", .order = 2, .stages = 2, .stability = 1.07, .step = step};
