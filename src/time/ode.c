/* The stepper of sph_scheme, built-in ones and users': rates, work arrays, dense output. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>

#include "integrator_data.h"
#include "keep.h"
#include "memory.h"
#include "nvector.h"
#include "scheme.h"

typedef struct stepping {
  sph_ode ode; /* first: the scheme has a pointer to it */
  sph_integrator *it;
  N_Vector f0, f1; /* rates at the start and at the end of the last attempt; leapfrog without drift
                      needs one vector for both */
  N_Vector work[SPH_SCHEME_WORK_MAX];
  double *data[SPH_SCHEME_WORK_MAX]; /* theirs */
  int ended;                         /* f1 belongs to it->time once the attempt is accepted */
  int status;                        /* the first failed evaluation of this attempt */
} stepping;

/* Leapfrog where nothing but velocities moves positions: its rates at the end take the place of
 * those at the start, and it does not read those of positions. */
static int in_place(const sph_integrator *it)
{
  return !it->problem.drift && it->scheme->step == sph_integrator_leapfrog.step;
}

static int create(sph_integrator *it, SUNContext context)
{
  (void)context;
  stepping *own = it->own = SPH_NEW(stepping, 1, it->info.name, it->problem.error);
  if (!own) return SPH_ERR_MEMORY;
  own->it = it;
  own->f0 = sph_nvector_clone(it->y, "rates", it->problem.error);
  own->f1 = in_place(it) ? own->f0 : sph_nvector_clone(it->y, "rates", it->problem.error);
  if (!own->f0 || !own->f1) return SPH_ERR_MEMORY;
  for (int k = 0; k < it->scheme->work; k++) {
    own->work[k] = sph_nvector_clone(it->y, "work arrays", it->problem.error);
    if (!own->work[k]) return SPH_ERR_MEMORY;
    own->data[k] = sph_nvector_data(own->work[k]);
  }
  own->ode = (sph_ode){.work = own->data,
                       .drift = it->problem.drift,
                       .threads = it->problem.threads > 1 ? it->problem.threads : 1};
  return SPH_OK;
}

static void release(sph_integrator *it)
{
  stepping *own = it->own;
  if (!own) return;
  if (own->f0) N_VDestroy(own->f0);
  if (own->f1 && own->f1 != own->f0) N_VDestroy(own->f1);
  for (int k = 0; k < SPH_SCHEME_WORK_MAX; k++)
    if (own->work[k]) N_VDestroy(own->work[k]);
  sph_memory_free(own);
}

/* Rates that the scheme reads. */
static int rates(sph_integrator *it, double t, N_Vector y, N_Vector ydot)
{
  const sph_problem *problem = &it->problem;
  if (!problem->rhs_still || !in_place(it)) return sph_integrator_rhs(it, t, y, ydot);
  it->stats.rhs_evaluations++;
  return it->rhs_status = problem->rhs_still(t, y, ydot, problem->ctx);
}

static int start(sph_integrator *it)
{
  stepping *own = it->own;
  own->ended = 0;
  own->ode.step = 0;
  own->ode.h_last = 0;
  return rates(it, it->time, it->y, own->f0);
}

/* The vector whose entries these are, or NULL. */
static N_Vector vector_of(const stepping *own, const double *data)
{
  const sph_integrator *it = own->it;
  N_Vector known[] = {it->y, it->before, own->f0, own->f1};
  for (int k = 0; k < 4; k++)
    if (data && data == sph_nvector_data(known[k])) return known[k];
  for (int k = 0; k < it->scheme->work; k++)
    if (data && data == own->data[k]) return own->work[k];
  return NULL;
}

int sph_ode_rhs(sph_ode *ode, double t, const double *y, double *f)
{
  if (!ode) return SPH_ERR_ARGUMENT;
  stepping *own = (stepping *)ode; /* whose first member it is */
  N_Vector at = vector_of(own, y), rate = vector_of(own, f);
  int status = SPH_OK;
  if (!at || !rate || at == rate || (rate == own->f0 && rate != own->f1) || rate == own->it->before)
    status = sph_error_set(own->it->problem.error, SPH_ERR_ARGUMENT,
                           "%s: sph_ode_rhs takes two different arrays of the sph_ode, "
                           "and writes to y, f1 or work",
                           own->it->info.name);
  if (!status) status = rates(own->it, t, at, rate);
  if (!own->status) own->status = status;
  return status;
}

/* The last attempt was accepted: its end is the start of this one. */
static void go_on(stepping *own)
{
  N_Vector f = own->f0;
  own->f0 = own->f1;
  own->f1 = f;
  own->ended = 0;
  own->ode.h_last = own->ode.h;
  own->ode.step++;
}

static int attempt(sph_integrator *it, sph_attempt *a, double t_stop)
{
  stepping *own = it->own;
  const sph_layout *layout = sph_nvector_layout(it->y);
  sph_ode *ode = &own->ode;
  if (own->ended) go_on(own);
  a->t = a->h == t_stop - it->time ? t_stop : it->time + a->h;
  ode->t = it->time;
  ode->t1 = a->t;
  ode->h = a->h;
  ode->n = layout->length;
  ode->segments = layout->segments;
  ode->segment = layout->segment;
  ode->y = sph_nvector_data(it->y);
  ode->y0 = sph_nvector_data(it->before);
  ode->f0 = sph_nvector_data(own->f0);
  ode->f1 = sph_nvector_data(own->f1);
  own->status = SPH_OK;
  int status = it->scheme->step(it->scheme->ctx, ode);
  if (!status) status = own->status; /* if the scheme went on all the same */
  if (!status && !it->scheme->carries) status = sph_integrator_rhs(it, a->t, it->y, own->f1);
  own->ended = !status;
  return status;
}

static void undo(sph_integrator *it)
{
  const stepping *own = it->own;
  if (own->f0 == own->f1) sph_integrator_leapfrog_undo(&own->ode, own->ended);
}

static int reject(sph_integrator *it)
{
  ((stepping *)it->own)->ended = 0;
  return SPH_OK;
}

/* Cubic Hermite interpolation, s = (t - t0)/h, of states y and slopes f at both ends:
 *   y0 + s (y1 - y0) + s (s - 1) ((1 - 2 s)(y1 - y0) + h ((s - 1) f0 + s f1)).
 * Where f1 took the place of f0 (f0 = f1), the step was y1 - y0 = h/2 (f0 + f1). */
static void hermite(double *at, double s, double h, long n, const double *y0, const double *y1,
                    const double *f0, const double *f1)
{
  for (long i = 0; i < n; i++) {
    const double rise = y1[i] - y0[i], first = f0 == f1 ? 2 * rise / h - f1[i] : f0[i];
    at[i] =
        y0[i] + s * rise + s * (s - 1) * ((1 - 2 * s) * rise + h * ((s - 1) * first + s * f1[i]));
  }
}

/* Third order where f0 and f1 are rates of the ends, second where a scheme carries others. */
static int interpolate(sph_integrator *it, double t, N_Vector at)
{
  const stepping *own = it->own;
  const sph_ode *ode = &own->ode;
  const double *y0 = ode->y0, *y1 = ode->y;
  double h = it->time - it->previous, s = (t - it->previous) / h;
  for (int k = 0; k < ode->segments; k++) {
    const sph_segment *v = ode->drift ? NULL : sph_scheme_velocity(ode, k);
    long o = ode->segment[k].offset;
    const double *g0 = v ? y0 + v->offset : ode->f0 + o, *g1 = v ? y1 + v->offset : ode->f1 + o;
    hermite(sph_nvector_data(at) + o, s, h, ode->segment[k].n, y0 + o, y1 + o, g0, g1);
  }
  return SPH_OK;
}

/* The rates that the next step starts with, and what the scheme left in its work arrays. */
static int keep(sph_integrator *it, sph_keep *keep)
{
  stepping *own = it->own;
  sph_ode *ode = &own->ode;
  const long n = sph_nvector_layout(it->y)->length;
  sph_keep_integer(keep, "step", 1, &ode->step);
  sph_keep_real(keep, "h", 1, &ode->h);
  sph_keep_real(keep, "h_last", 1, &ode->h_last);
  int status = sph_keep_int(keep, "ended", &own->ended);
  if (!status)
    status = sph_keep_real(keep, "rates", n, sph_nvector_data(own->ended ? own->f1 : own->f0));
  for (int k = 0; k < it->scheme->work; k++) {
    char name[32];
    snprintf(name, sizeof name, "work_%d", k);
    status = sph_keep_real(keep, name, n, own->data[k]);
  }
  return status;
}

const sph_stepper sph_ode_stepper = {create, release,     start, attempt,
                                     reject, interpolate, keep,  undo};
