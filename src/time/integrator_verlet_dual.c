/* DualSPHysics' Verlet scheme (Verlet 1967; Dominguez et al. 2022), one evaluation
 * f = (v + d, a, R) a step h; h' is the step before, y' the state at t0 - h':
 *   r1 = r0 + h v0 + h^2/2 a0,  v1 = v' + (h' + h) a0,  q1 = q' + (h' + h) R0
 * and every N = 40 steps, the first included:  v1 = v0 + h a0,  q1 = q0 + h R0.  With drift
 * positions are stepped as q is.  As printed it has 2h for h' + h, right for constant steps only.
 *
 * Second order, also with forces of v and q.  An Euler step makes an error h^2/2 y'', but N is
 * even: it enters the states of odd steps alone, and the next Euler step starts from an even one.
 * (With odd N such errors would add up: order 1.)  What the two-step formula brings along, a second
 * solution (-1)^n that grows where forces damp, the Euler steps cut back. */
#include <string.h>

#include "integrator_data.h"
#include "scheme.h"

enum { N = 40 };

/* From y' over h' + h, or (Euler) from y0. */
static void advance(sph_ode *ode, double h, const double *from)
{
  const int euler = ode->step % N == 0;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    long o = s->offset;
    double *y = ode->y + o;
    const double *y0 = ode->y0, *f0 = ode->f0;
    if (!v || (ode->drift && !euler))
      sph_scheme_advance(s->n, h, y, from + o, f0 + o, NULL);
    else
      sph_scheme_advance(s->n, ode->h, y, y0 + o, y0 + v->offset, f0 + v->offset);
    if (v && ode->drift && euler) sph_scheme_slip(s->n, ode->h, y, y, f0 + o, y0 + v->offset);
  }
}

static int step(void *ctx, sph_ode *ode)
{
  int euler = ode->step % N == 0;
  double *keep = ode->work[ode->step % 2]; /* y0 is y' of the next step */
  const double *from = euler ? ode->y0 : ode->work[(ode->step + 1) % 2];
  (void)ctx;
  memcpy(keep, ode->y0, (size_t)ode->n * sizeof *keep);
  sph_scheme_sweep(ode, advance, euler ? ode->h : ode->h_last + ode->h, from);
  return SPH_OK;
}

const sph_scheme sph_integrator_verlet_dual = {
    .name = "verlet-dual", .order = 2, .stages = 1, .stability = 0.21, .work = 2, .step = step};
