/* Kick-drift-kick leapfrog, alias velocity Verlet, one evaluation f = (v + d, a, R) a step h:
 *   drift     r* = r0 + h (v0 + h/2 a0) + h d0
 *   predict   v* = v0 + h a0,  q* = q0 + h R0                 (q: density, energy, ...)
 *   evaluate  f1 = f(t1, r*, v*, q*)
 *   kick      v1 = (v0 + v* + h a1)/2,  q1 = (q0 + q* + h R1)/2,  r1 = r* + h/2 (d1 - d0)
 * so that v1 = v0 + h/2 (a0 + a1), and without drift f1 may take the place of f0 (src/time/ode.c).
 * v0 + h/2 a0 is the half-step velocity of the staggered leapfrog; d = dr/dt - v, zero without
 * drift.  Second order also for forces of v and q, because these are predicted at t1; with
 * half-step values it would be first order.  Symplectic for forces of positions alone and constant
 * h (Hairer, Lubich & Wanner 2003). */
#include "integrator_data.h"
#include "scheme.h"

static void predict(sph_ode *ode, double a, const double *f)
{
  (void)a, (void)f;
  double *y = ode->y;
  const double *y0 = ode->y0, *f0 = ode->f0;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    long o = s->offset;
    if (v)
      sph_scheme_advance(s->n, ode->h, y + o, y0 + o, y0 + v->offset, f0 + v->offset);
    else
      sph_scheme_advance(s->n, ode->h, y + o, y0 + o, f0 + o, NULL);
    if (v && ode->drift) sph_scheme_slip(s->n, ode->h, y + o, y + o, f0 + o, y0 + v->offset);
  }
}

static void correct(sph_ode *ode, double a, const double *f)
{
  (void)a, (void)f;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    double *r = ode->y + s->offset;
    if (!v) sph_scheme_mean(s->n, ode->h, r, ode->y0 + s->offset, ode->f1 + s->offset);
    if (!v || !ode->drift) continue;
    sph_scheme_advance(s->n, ode->h / 2, r, r, ode->f1 + s->offset, NULL);
    sph_scheme_slip(s->n, -ode->h / 2, r, r, ode->f0 + s->offset, ode->y0 + v->offset);
  }
}

static int step(void *ctx, sph_ode *ode)
{
  (void)ctx;
  sph_scheme_sweep(ode, predict, 0, NULL);
  int status = sph_ode_rhs(ode, ode->t1, ode->y, ode->f1);
  if (status) return status;
  sph_scheme_drift(ode);
  sph_scheme_sweep(ode, correct, 0, NULL);
  sph_scheme_undrift(ode);
  return SPH_OK;
}

void sph_integrator_leapfrog_undo(const sph_ode *ode, int kicked)
{
  for (int k = 0; k < ode->segments; k++) {
    const long o = ode->segment[k].offset;
    double *f = ode->f1 + o;
    const double *y = ode->y + o, *y0 = ode->y0 + o;
    for (long i = 0; !sph_scheme_velocity(ode, k) && i < ode->segment[k].n; i++)
      f[i] = kicked ? 2 * (y[i] - y0[i]) / ode->h - f[i] : (y[i] - y0[i]) / ode->h;
  }
}

const sph_scheme sph_integrator_leapfrog = {
    .name = "leapfrog", .order = 2, .stages = 1, .stability = 0.62, .carries = 1, .step = step};
