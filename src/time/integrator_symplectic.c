/* DualSPHysics' symplectic scheme (Dominguez et al. 2022, after Leimkuhler & Matthews 2015), two
 * evaluations f = (v + d, a, R) a step h:
 *   half      r_ = r0 + h/2 (v0 + d0),  v_ = v0 + h/2 a0,  q_ = q0 + h/2 R0
 *   evaluate  f_ = f(t0 + h/2, r_, v_, q_)
 *   end       v1 = v0 + h a_,  r1 = r0 + h/2 (v0 + v1) + h d_
 *             rho1 = rho0 (2 - e)/(2 + e),  e = -(R_/rho_) h,     other q1 = q0 + h R_
 * Second order; symplectic for forces of positions alone. */
#include <stddef.h>

#include "integrator_data.h"
#include "scheme.h"

/* rho comes as its value at half the step. */
static void density(long n, double h, double *rho, const double *rho0, const double *R)
{
#pragma omp for schedule(static) nowait
  for (long i = 0; i < n; i++) {
    double e = -R[i] / rho[i] * h;
    rho[i] = rho0[i] * (2 - e) / (2 + e);
  }
}

static void correct(sph_ode *ode, double a, const double *f)
{
  (void)a, (void)f;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k];
    long o = s->offset;
    if (s->role == SPH_ROLE_DENSITY)
      density(s->n, ode->h, ode->y + o, ode->y0 + o, ode->f1 + o);
    else
      sph_scheme_advance(s->n, ode->h, ode->y + o, ode->y0 + o, ode->f1 + o, NULL);
  }
}

static int step(void *ctx, sph_ode *ode)
{
  (void)ctx;
  sph_scheme_euler(ode, ode->h / 2, ode->f0);
  int status = sph_ode_rhs(ode, ode->t + ode->h / 2, ode->y, ode->f1);
  if (status) return status;
  sph_scheme_drift(ode);
  sph_scheme_sweep(ode, correct, 0, NULL);
  sph_scheme_positions(ode, 1);
  return SPH_OK;
}

const sph_scheme sph_integrator_symplectic = {
    .name = "symplectic", .order = 2, .stages = 2, .stability = 1.07, .step = step};
