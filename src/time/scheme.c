#include "scheme.h"

#include <stddef.h>

enum { PARALLEL_MIN = 32768 };

const sph_segment *sph_scheme_velocity(const sph_ode *ode, int k)
{
  const sph_segment *s = &ode->segment[k];
  return s->role == SPH_ROLE_POSITION && s->partner >= 0 ? &ode->segment[s->partner] : NULL;
}

void sph_scheme_advance(const sph_ode *ode, long n, double h, double *y, const double *y0,
                        const double *g, const double *f)
{
#pragma omp parallel for simd num_threads(ode->threads) schedule(static) if (n >= PARALLEL_MIN)
  for (long i = 0; i < n; i++) y[i] = y0[i] + h * (f ? g[i] + h / 2 * f[i] : g[i]);
}

void sph_scheme_kick(const sph_ode *ode, long n, double h, double *y, const double *y0,
                     const double *f0, const double *f1)
{
#pragma omp parallel for simd num_threads(ode->threads) schedule(static) if (n >= PARALLEL_MIN)
  for (long i = 0; i < n; i++) y[i] = y0[i] + h / 2 * (f0[i] + f1[i]);
}

void sph_scheme_mean(const sph_ode *ode, long n, double h, double *y, const double *y0,
                     const double *f)
{
#pragma omp parallel for simd num_threads(ode->threads) schedule(static) if (n >= PARALLEL_MIN)
  for (long i = 0; i < n; i++) y[i] = 0.5 * (y0[i] + y[i] + h * f[i]);
}

void sph_scheme_slip(const sph_ode *ode, long n, double h, double *y, const double *y0,
                     const double *f, const double *v)
{
#pragma omp parallel for simd num_threads(ode->threads) schedule(static) if (n >= PARALLEL_MIN)
  for (long i = 0; i < n; i++) y[i] = y0[i] + h * (f[i] - v[i]);
}

void sph_scheme_euler(sph_ode *ode, double h, const double *f)
{
  for (int k = 0; k < ode->segments; k++) {
    long o = ode->segment[k].offset;
    sph_scheme_advance(ode, ode->segment[k].n, h, ode->y + o, ode->y0 + o, f + o, NULL);
  }
}

void sph_scheme_drift(sph_ode *ode)
{
  for (int k = 0; ode->drift && k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    double *d = ode->f1 + s->offset;
    if (v) sph_scheme_advance(ode, s->n, -1, d, d, ode->y + v->offset, NULL);
  }
}

void sph_scheme_positions(sph_ode *ode, double w)
{
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    if (!v) continue;
    double *r = ode->y + s->offset;
    const double *v0 = ode->y0 + v->offset;
    sph_scheme_kick(ode, s->n, ode->h, r, ode->y0 + s->offset, v0, ode->y + v->offset);
    if (!ode->drift) continue;
    sph_scheme_advance(ode, s->n, w * ode->h, r, r, ode->f1 + s->offset, NULL);
    if (w < 1) sph_scheme_slip(ode, s->n, (1 - w) * ode->h, r, r, ode->f0 + s->offset, v0);
  }
}

void sph_scheme_undrift(sph_ode *ode)
{
  for (int k = 0; ode->drift && k < ode->segments; k++) {
    const sph_segment *s = &ode->segment[k], *v = sph_scheme_velocity(ode, k);
    double *d = ode->f1 + s->offset;
    if (v) sph_scheme_advance(ode, s->n, 1, d, d, ode->y + v->offset, NULL);
  }
}
