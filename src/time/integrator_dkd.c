/* Drift-kick-drift leapfrog, one evaluation f = (v + d, a, R) a step h, in its middle:
 *   half      r_ = r0 + h/2 (v0 + d0),  v_ = v0 + h/2 a0,  q_ = q0 + h/2 R0
 *   evaluate  f1 = f(t0 + h/2, r_, v_, q_)
 *   kick      v1 = v0 + h a1,  q1 = q0 + h R1
 *   drift     r1 = r0 + h/2 (v0 + v1) + h d1
 * a0, R0, d0 are those of the middle of the step before, at the start of a run those of its state:
 * they serve only to predict, where an error of order h keeps the second order.  For
 * forces of positions alone it is the leapfrog with half a step exchanged: symplectic (Hairer,
 * Lubich & Wanner 2003). */
#include <stddef.h>

#include "integrator_data.h"
#include "scheme.h"

static void half(sph_ode *ode, double a, const double *f)
{
  (void)a, (void)f;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = ode->drift ? NULL : sph_scheme_velocity(ode, k);
    long o = s->offset;
    const double *rate = v ? ode->y0 + v->offset : ode->f0 + o;
    sph_scheme_advance(s->n, ode->h / 2, ode->y + o, ode->y0 + o, rate, NULL);
  }
}

static int step(void *ctx, sph_ode *ode)
{
  (void)ctx;
  sph_scheme_sweep(ode, half, 0, NULL);
  int status = sph_ode_rhs(ode, ode->t + ode->h / 2, ode->y, ode->f1);
  if (status) return status;
  sph_scheme_drift(ode);
  sph_scheme_euler(ode, ode->h, ode->f1);
  sph_scheme_positions(ode, 1);
  sph_scheme_undrift(ode);
  return SPH_OK;
}

const sph_scheme sph_integrator_dkd = {
    .name = "dkd", .order = 2, .stages = 1, .stability = 0.62, .carries = 1, .step = step};
