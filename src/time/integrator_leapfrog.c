/* Kick-drift-kick leapfrog, alias velocity Verlet, one evaluation f = (v, a, R) a step h:
 *   drift     r1 = r0 + h (v0 + h/2 a0)
 *   predict   v* = v0 + h a0,  q* = q0 + h R0                 (q: density, energy, ...)
 *   evaluate  f1 = f(t1, r1, v*, q*)
 *   kick      v1 = v0 + h/2 (a0 + a1),  q1 = q0 + h/2 (R0 + R1)
 * v0 + h/2 a0 is the half-step velocity of the staggered leapfrog.  Second order also for forces
 * of v and q, because these are predicted at t1; with half-step values it would be first order.
 * Symplectic for forces of positions alone and constant h (Hairer, Lubich & Wanner 2003). */
#include <math.h>

#include "integrator_data.h"
#include "memory.h"
#include "nvector.h"

enum { PARALLEL_MIN = 32768 };

typedef struct leapfrog {
  N_Vector f0, f1; /* rates at the start and at the end of the last attempt */
  int ended;       /* f1 belongs to it->time once the attempt is accepted */
} leapfrog;

static int create(sph_integrator *it, SUNContext context)
{
  (void)context;
  leapfrog *own = it->own = SPH_NEW(leapfrog, 1, "leapfrog", it->problem.error);
  if (!own) return SPH_ERR_MEMORY;
  own->f0 = sph_nvector_clone(it->y, "rates", it->problem.error);
  own->f1 = sph_nvector_clone(it->y, "rates", it->problem.error);
  return own->f0 && own->f1 ? SPH_OK : SPH_ERR_MEMORY;
}

static void release(sph_integrator *it)
{
  leapfrog *own = it->own;
  if (!own) return;
  if (own->f0) N_VDestroy(own->f0);
  if (own->f1) N_VDestroy(own->f1);
  sph_memory_free(own);
}

static int start(sph_integrator *it)
{
  leapfrog *own = it->own;
  own->ended = 0;
  return sph_integrator_rhs(it, it->time, it->y, own->f0);
}

/* The segment that drives segment k: its velocity's if it is a position, else NULL. */
static const sph_segment *velocity_of(const sph_layout *layout, int k)
{
  const sph_segment *s = &layout->segment[k];
  return s->role == SPH_ROLE_POSITION && s->partner >= 0 ? &layout->segment[s->partner] : NULL;
}

/* y = y0 + h (g + h/2 f): the drift, or the prediction with f == NULL and g the rate. */
static void advance(int threads, long n, double h, double *y, const double *y0, const double *g,
                    const double *f)
{
#pragma omp parallel for simd num_threads(threads) schedule(static) if (n >= PARALLEL_MIN)
  for (long i = 0; i < n; i++) y[i] = y0[i] + h * (f ? g[i] + h / 2 * f[i] : g[i]);
}

/* y = y0 + h/2 (f0 + f1) */
static void kick(int threads, long n, double h, double *y, const double *y0, const double *f0,
                 const double *f1)
{
#pragma omp parallel for simd num_threads(threads) schedule(static) if (n >= PARALLEL_MIN)
  for (long i = 0; i < n; i++) y[i] = y0[i] + h / 2 * (f0[i] + f1[i]);
}

static int attempt(sph_integrator *it, sph_attempt *a, double t_stop)
{
  leapfrog *own = it->own;
  const sph_layout *layout = sph_nvector_layout(it->y);
  int threads = it->problem.threads > 1 ? it->problem.threads : 1;
  if (own->ended) {
    N_Vector f = own->f0;
    own->f0 = own->f1;
    own->f1 = f;
    own->ended = 0;
  }
  double *y = sph_nvector_data(it->y), *y0 = sph_nvector_data(it->before);
  double *f0 = sph_nvector_data(own->f0), *f1 = sph_nvector_data(own->f1);
  a->t = a->h == t_stop - it->time ? t_stop : it->time + a->h;
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *s = &layout->segment[k], *v = velocity_of(layout, k);
    long o = s->offset;
    if (v)
      advance(threads, s->n, a->h, y + o, y0 + o, y0 + v->offset, f0 + v->offset);
    else
      advance(threads, s->n, a->h, y + o, y0 + o, f0 + o, NULL);
  }
  int status = sph_integrator_rhs(it, a->t, it->y, own->f1);
  for (int k = 0; !status && k < layout->segments; k++) {
    long o = layout->segment[k].offset;
    if (!velocity_of(layout, k))
      kick(threads, layout->segment[k].n, a->h, y + o, y0 + o, f0 + o, f1 + o);
  }
  own->ended = !status;
  return status;
}

static int reject(sph_integrator *it)
{
  ((leapfrog *)it->own)->ended = 0;
  return SPH_OK;
}

/* Cubic Hermite interpolation, s = (t - t0)/h, of states y and slopes f at both ends:
 *   y0 + s (y1 - y0) + s (s - 1) ((1 - 2 s)(y1 - y0) + h ((s - 1) f0 + s f1)) */
static void hermite(double *at, double s, double h, long n, const double *y0, const double *y1,
                    const double *f0, const double *f1)
{
  for (long i = 0; i < n; i++) {
    double rise = y1[i] - y0[i];
    at[i] =
        y0[i] + s * rise + s * (s - 1) * ((1 - 2 * s) * rise + h * ((s - 1) * f0[i] + s * f1[i]));
  }
}

static int interpolate(sph_integrator *it, double t, N_Vector at)
{
  const leapfrog *own = it->own;
  const sph_layout *layout = sph_nvector_layout(it->y);
  const double *y0 = sph_nvector_data(it->before), *y1 = sph_nvector_data(it->y);
  const double *f0 = sph_nvector_data(own->f0), *f1 = sph_nvector_data(own->f1);
  double h = it->time - it->previous, s = (t - it->previous) / h;
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *v = velocity_of(layout, k);
    long o = layout->segment[k].offset;
    const double *g0 = v ? y0 + v->offset : f0 + o, *g1 = v ? y1 + v->offset : f1 + o;
    hermite(sph_nvector_data(at) + o, s, h, layout->segment[k].n, y0 + o, y1 + o, g0, g1);
  }
  return SPH_OK;
}

const sph_stepper sph_integrator_leapfrog = {create, release, start, attempt, reject, interpolate};
