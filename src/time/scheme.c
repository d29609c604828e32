#include "scheme.h"

#include <stddef.h>

enum { PARALLEL_MIN = 65536 }; /* entries */

const sph_segment *sph_scheme_velocity(const sph_ode *ode, int k)
{
  const sph_segment *s = &ode->segment[k];
  return s->role == SPH_ROLE_POSITION && s->partner >= 0 ? &ode->segment[s->partner] : NULL;
}

void sph_scheme_advance(long n, double h, double *y, const double *y0, const double *g,
                        const double *f)
{
#pragma omp for simd schedule(static) nowait
  for (long i = 0; i < n; i++) y[i] = y0[i] + h * (f ? g[i] + h / 2 * f[i] : g[i]);
}

void sph_scheme_kick(long n, double h, double *y, const double *y0, const double *f0,
                     const double *f1)
{
#pragma omp for simd schedule(static) nowait
  for (long i = 0; i < n; i++) y[i] = y0[i] + h / 2 * (f0[i] + f1[i]);
}

void sph_scheme_mean(long n, double h, double *y, const double *y0, const double *f)
{
#pragma omp for simd schedule(static) nowait
  for (long i = 0; i < n; i++) y[i] = 0.5 * (y0[i] + y[i] + h * f[i]);
}

void sph_scheme_slip(long n, double h, double *y, const double *y0, const double *f,
                     const double *v)
{
#pragma omp for simd schedule(static) nowait
  for (long i = 0; i < n; i++) y[i] = y0[i] + h * (f[i] - v[i]);
}

/* Without others: no region at all, which is a call of the system even with one thread. */
void sph_scheme_sweep(sph_ode *ode, sph_scheme_sweeper *sweep, double a, const double *f)
{
  if (ode->threads <= 1 || ode->n < PARALLEL_MIN)
    sweep(ode, a, f);
  else
#pragma omp parallel num_threads(ode->threads)
    sweep(ode, a, f);
}

static void euler(sph_ode *ode, double h, const double *f)
{
  for (int k = 0; k < ode->segments; k++) {
    long o = ode->segment[k].offset;
    sph_scheme_advance(ode->segment[k].n, h, ode->y + o, ode->y0 + o, f + o, NULL);
  }
}

void sph_scheme_euler(sph_ode *ode, double h, const double *f)
{
  sph_scheme_sweep(ode, euler, h, f);
}

/* Rates of positions in f1 by `sign` times the velocities more. */
static void move(sph_ode *ode, double sign, const double *f)
{
  (void)f;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    double *d = ode->f1 + s->offset;
    if (v) sph_scheme_advance(s->n, sign, d, d, ode->y + v->offset, NULL);
  }
}

void sph_scheme_drift(sph_ode *ode)
{
  if (ode->drift) sph_scheme_sweep(ode, move, -1, NULL);
}

void sph_scheme_undrift(sph_ode *ode)
{
  if (ode->drift) sph_scheme_sweep(ode, move, 1, NULL);
}

static void positions(sph_ode *ode, double w, const double *f)
{
  (void)f;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    if (!v) continue;
    double *r = ode->y + s->offset;
    const double *v0 = ode->y0 + v->offset;
    sph_scheme_kick(s->n, ode->h, r, ode->y0 + s->offset, v0, ode->y + v->offset);
    if (!ode->drift) continue;
    sph_scheme_advance(s->n, w * ode->h, r, r, ode->f1 + s->offset, NULL);
    if (w < 1) sph_scheme_slip(s->n, (1 - w) * ode->h, r, r, ode->f0 + s->offset, v0);
  }
}

void sph_scheme_positions(sph_ode *ode, double w) { sph_scheme_sweep(ode, positions, w, NULL); }
