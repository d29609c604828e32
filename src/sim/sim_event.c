/* Events at work: where each function changes its sign in the last step, and what follows.
 *
 * A watch knows on which side of zero its function was when it was looked at last.  Zero itself,
 * reached from one side, is the event; from there the next look tells the side anew: a function
 * that touches zero, or stands on it when a step begins, does not pass it twice. */
#include "sim_event.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "root.h"
#include "sim_run.h"

/* -1, 1; 0: on zero, or undefined. */
static int side(double value) { return (value > 0) - (value < 0); }

static int value_now(sph_sim *sim, const sph_watch *w, double *value)
{
  double quantity = NAN;
  int status = sph_event_measure(sim, w, &quantity);
  *value = quantity - sph_event_threshold(w);
  return status;
}

static int value_at(sph_sim *sim, const sph_watch *w, double t, double *value)
{
  int status = sph_sim_run_show(sim, t);
  return status ? status : value_now(sim, w, value);
}

/* Scratch for the rates: only with an event that looks at them. */
static int make_slopes(sph_sim *sim)
{
  for (int k = 0; k < 2; k++) {
    if (!sim->slope[k]) sim->slope[k] = sph_nvector_clone(sim->y, "rates of events", &sim->error);
    if (!sim->slope[k]) return SPH_ERR_MEMORY;
  }
  return SPH_OK;
}

int sph_sim_event_start(sph_sim *sim)
{
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->watches; k++) {
    sph_watch *w = &sim->watch[k];
    double value = NAN;
    if (sph_event_steady(w)) status = make_slopes(sim);
    if (w->known) continue;
    if (!status) status = value_now(sim, w, &value);
    w->known = !status;
    w->side = side(value);
  }
  return status;
}

void sph_sim_event_stepped(sph_sim *sim, double from)
{
  sim->looked = from;
  for (int k = 0; k < sim->watches; k++) {
    sim->watch[k].piece = 0;
    sim->watch[k].root = INFINITY;
    sim->watch[k].happened = 0;
  }
}

/* ---- where ---- */

/* A step that only brought the time to its stop: no dense output. */
static int nothing(double a, double b)
{
  return b - a <= 16 * DBL_EPSILON * fmax(fabs(a), fabs(b));
}

typedef struct search {
  sph_sim *sim;
  const sph_watch *watch;
  double undefined; /* stands for a value that is not defined */
} search;

static int search_value(void *ctx, double t, double *value)
{
  const search *s = ctx;
  int status = value_at(s->sim, s->watch, t, value);
  if (isnan(*value)) *value = s->undefined;
  return status;
}

/* The passage in (a, b], at whose end the function is value_b. */
static int find(sph_sim *sim, sph_watch *w, double a, double b, double value_b)
{
  search s = {.sim = sim, .watch = w};
  double value_a = NAN;
  w->root = b;
  w->behind = side(value_b);
  if (nothing(a, b)) return SPH_OK;
  if (sph_event_known(w)) {
    w->root = sph_event_threshold(w);
    return SPH_OK;
  }
  int status = value_at(sim, w, a, &value_a);
  s.undefined = value_a;
  if (!status && side(value_a) == w->side)
    return sph_root_find(search_value, &s, a, value_a, b, value_b, &w->root, &sim->error);
  w->root = a; /* it was changed between the steps */
  return status;
}

static int passes(const sph_watch *w, double value)
{
  int now = side(value);
  if (w->side == 0 || now == w->side || isnan(value)) return 0;
  return w->direction == 0 || w->direction == -w->side;
}

/* On to its next passage, or to the end of the step. */
static int look(sph_sim *sim, sph_watch *w, double a, double b)
{
  int pieces = nothing(a, b) ? 1 : w->event.samples + 1, status = SPH_OK;
  double step = (b - a) / pieces;
  for (; !status && !w->over && w->piece < pieces && isinf(w->root); w->piece++) {
    double from = a + w->piece * step, to = w->piece + 1 < pieces ? from + step : b, value = NAN;
    status = value_at(sim, w, to, &value);
    if (status) break;
    if (passes(w, value))
      status = find(sim, w, from, to, value);
    else
      w->side = side(value);
  }
  return status;
}

int sph_sim_event_next(sph_sim *sim, double *t)
{
  double now = sph_integrator_time(sim->integrator);
  int status = SPH_OK;
  *t = INFINITY;
  for (int k = 0; !status && k < sim->watches; k++) {
    status = look(sim, &sim->watch[k], sim->looked, now);
    *t = fmin(*t, sim->watch[k].root);
  }
  return status;
}

/* ---- what follows ---- */

static int tell(sph_sim *sim, const sph_watch *w, double t)
{
  double quantity = NAN;
  int status = sph_event_measure(sim, w, &quantity);
  const sph_event_record record = {.name = w->name,
                                   .t = t,
                                   .value = quantity,
                                   .step = sph_integrator_stats(sim->integrator)->steps};
  for (int k = 0; !status && k < sim->outlets; k++) {
    const sph_output *output = &sim->outlet[k].output;
    if (sim->outlet[k].open && output->event)
      status = output->event(output->ctx, sim, &record, &sim->error);
  }
  return status;
}

static void count(sph_watch *w, double t)
{
  if (w->info.count++ == 0) w->info.first = t;
  w->info.last = t;
  w->over = w->event.once;
  w->happened = 1;
  w->side = w->behind;
  w->root = INFINITY;
}

int sph_sim_event_happen(sph_sim *sim, double t, int *cut)
{
  int snapshot = 0, status = sph_sim_run_show(sim, t);
  for (int k = 0; !status && k < sim->watches; k++) {
    sph_watch *w = &sim->watch[k];
    w->happened = 0;
    if (w->root > t) continue;
    status = tell(sim, w, t);
    if (status) break;
    count(w, t);
    snapshot |= w->event.snapshot;
    *cut |= w->event.stop || w->event.change;
  }
  return !status && snapshot ? sph_sim_run_frame_all(sim) : status;
}

/* Sides are told before the integrator starts anew: then it has no rates until its next step. */
int sph_sim_event_cut(sph_sim *sim, double t)
{
  int status = sph_sim_run_show(sim, t);
  for (int k = 0; !status && k < sim->watches; k++) {
    sph_watch *w = &sim->watch[k];
    double value = NAN;
    int looked_past = isinf(w->root) && !w->happened && !w->over;
    if (looked_past) status = value_now(sim, w, &value);
    if (looked_past || w->happened) w->side = side(value);
  }
  if (status || t >= sph_integrator_time(sim->integrator)) return status;
  N_VScale(1, sim->frame, sim->y);
  status = sph_integrator_go_on(sim->integrator, t);
  return status ? status : sph_sim_run_show(sim, t);
}

static int change(sph_sim *sim, const sph_watch *w)
{
  int status = w->event.change(w->event.ctx, sim);
  if (status)
    sph_sim_fail(sim, status, "event %s: its change at t = %.9g s failed: %s", w->name, sim->time,
                 sph_status_text(status));
  sph_sim_changed(sim);
  return sim->error.status;
}

int sph_sim_event_act(sph_sim *sim)
{
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->watches; k++) {
    const sph_watch *w = &sim->watch[k];
    if (w->happened && w->event.change) status = change(sim, w);
    if (w->happened && w->event.stop && !sim->stopped_by) sim->stopped_by = w->name;
  }
  return status;
}
