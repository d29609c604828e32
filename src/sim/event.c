/* The types of events: what they measure. */
#include "sphode/event.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "monitor.h"
#include "sim_event.h"
#include "sim_weights.h"

static int measure_front(sph_sim *sim, const sph_watch *w, double *q)
{
  const sph_monitor monitor = {.name = w->name,
                               .type = "front",
                               .group = w->event.group,
                               .axis = w->event.axis};
  return sph_monitor_value(&monitor, sim, q, &sim->error);
}

static int measure_cover(sph_sim *sim, const sph_watch *w, double *q)
{
  sph_monitor monitor = {.name = w->name, .type = "pressure", .group = w->event.group};
  for (int d = 0; d < 3; d++) monitor.x[d] = w->event.x[d];
  return sph_monitor_cover(&monitor, sim, q, &sim->error);
}

static const char *const quantities[] = {"kinetic", "potential", "internal", "total"};
enum { QUANTITIES = sizeof quantities / sizeof *quantities };

static int measure_energy(sph_sim *sim, const sph_watch *w, double *q)
{
  sph_balance b;
  sph_sim_balance(sim, &b);
  const double value[QUANTITIES] = {b.kinetic, b.potential, b.internal, b.total};
  for (int k = 0; k < QUANTITIES; k++)
    if (!strcmp(w->event.quantity, quantities[k])) *q = value[k];
  return sim->error.status;
}

/* No last step, no rates: they are the slopes of its dense output. */
static int measure_steady(sph_sim *sim, const sph_watch *w, double *q)
{
  (void)w;
  *q = NAN;
  if (!sph_integrator_stepped(sim->integrator)) return SPH_OK;
  int status = sph_integrator_rate(sim->integrator, sim->time, sim->slope[0], sim->slope[1]);
  if (!status) *q = sph_sim_weights_rate(sim, sim->slope[0]);
  return status;
}

static int measure_time(sph_sim *sim, const sph_watch *w, double *q)
{
  (void)w;
  *q = sim->time;
  return SPH_OK;
}

static int measure_own(sph_sim *sim, const sph_watch *w, double *q)
{
  *q = w->event.value(w->event.ctx, sim);
  if (sim->error.status || isfinite(*q)) return sim->error.status;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "event %s: its function gave %g at t = %.9g s; right is a finite number",
                      w->name, *q, sim->time);
}

static const struct {
  const char *name, *unit;
  int direction;
  int (*measure)(sph_sim *sim, const sph_watch *w, double *q);
} types[] = {
    {"front", "m", 1, measure_front},      {"wet", "1", 1, measure_cover},
    {"dry", "1", -1, measure_cover},       {"energy", "J", 0, measure_energy},
    {"steady", "1/s", -1, measure_steady}, {"time", "s", 1, measure_time},
};
enum { TYPES = sizeof types / sizeof *types, OWN = -1 };

static int find(const char *type)
{
  for (int k = 0; type && k < TYPES; k++)
    if (!strcmp(types[k].name, type)) return k;
  return OWN;
}

const char *sph_event_type(int k) { return k >= 0 && k < TYPES ? types[k].name : NULL; }

const char *sph_event_unit(const char *type)
{
  int k = find(type);
  return k == OWN ? NULL : types[k].unit;
}

int sph_event_measure(sph_sim *sim, const sph_watch *w, double *quantity)
{
  return w->type == OWN ? measure_own(sim, w, quantity) : types[w->type].measure(sim, w, quantity);
}

static int is(const sph_watch *w, int (*measure)(sph_sim *, const sph_watch *, double *))
{
  return w->type != OWN && types[w->type].measure == measure;
}

double sph_event_threshold(const sph_watch *w)
{
  return is(w, measure_cover) ? sph_monitor_wet : w->event.threshold;
}

int sph_event_known(const sph_watch *w) { return is(w, measure_time); }

int sph_event_steady(const sph_watch *w) { return is(w, measure_steady); }

/* ---- definitions ---- */

static int check_type(const sph_event *event, sph_error *error)
{
  if (!event->type && event->value) return SPH_OK;
  if (event->type && event->value)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "event %s: a type, \"%.40s\", and a function of its own; right is one",
                         event->name, event->type);
  if (find(event->type) != OWN) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "event %s: type \"%.40s\"; front, wet, dry, energy, steady, time are known",
                       event->name, event->type ? event->type : "");
}

static int check_numbers(const sph_event *event, sph_error *error)
{
  int cover = event->type && (!strcmp(event->type, "wet") || !strcmp(event->type, "dry"));
  for (int d = 0; cover && d < 3; d++)
    if (!isfinite(event->x[d]))
      return sph_error_set(error, SPH_ERR_ARGUMENT, "event %s: x[%d] = %g m is not finite",
                           event->name, d, event->x[d]);
  if (!isfinite(event->threshold))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "event %s: threshold = %g is not finite",
                         event->name, event->threshold);
  if (event->type && !strcmp(event->type, "steady") && !(event->threshold > 0))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "event %s: threshold of the rates %g 1/s; right is > 0", event->name,
                         event->threshold);
  if (event->samples < 0 || event->samples > SPH_EVENT_SAMPLES_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "event %s: samples = %d; right is 0 to %d",
                         event->name, event->samples, SPH_EVENT_SAMPLES_MAX);
  return SPH_OK;
}

/* 1, -1, 0: both. */
static int check_direction(const sph_event *event, int *direction, sph_error *error)
{
  static const char *const words[] = {"falling", "both", "rising"};
  int type = find(event->type);
  *direction = type == OWN ? 0 : types[type].direction;
  if (!event->direction) return SPH_OK;
  for (int k = 0; k < 3; k++)
    if (!strcmp(event->direction, words[k])) {
      *direction = k - 1;
      return SPH_OK;
    }
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "event %s: direction \"%.40s\"; rising, falling, both are known",
                       event->name, event->direction);
}

static int check_quantity(const sph_event *event, const char **quantity, sph_error *error)
{
  const char *name = event->quantity ? event->quantity : "total";
  for (int k = 0; k < QUANTITIES; k++)
    if (!strcmp(name, quantities[k])) {
      *quantity = quantities[k];
      return SPH_OK;
    }
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "event %s: quantity \"%.40s\"; kinetic, potential, internal, total are "
                       "known",
                       event->name, name);
}

/* Groups and axes are those of monitors. */
static int check_place(const sph_event *event, const sph_sim *sim, sph_error *error)
{
  const sph_monitor monitor = {.name = event->name,
                               .type = "front",
                               .group = event->group,
                               .axis = event->axis};
  sph_error wrong = {0};
  if (!event->type || sph_monitor_check(&monitor, sim, &wrong) == SPH_OK) return SPH_OK;
  const char *colon = strchr(wrong.text, ':'); /* behind "monitor NAME" */
  return sph_error_set(error, wrong.status, "event %s%s", event->name, colon ? colon : "");
}

static int check_name(const sph_event *event, const sph_sim *sim, sph_error *error)
{
  int status = sph_monitor_check_name("event", event->name, error);
  for (int k = 0; !status && k < sim->watches; k++)
    if (!strcmp(sim->watch[k].name, event->name))
      status = sph_error_set(error, SPH_ERR_ARGUMENT, "event %s exists already", event->name);
  return status;
}

int sph_event_take(sph_watch *w, const sph_event *event, const sph_sim *sim, sph_error *error)
{
  int direction = 0;
  const char *quantity = NULL;
  int status = check_name(event, sim, error);
  if (!status) status = check_type(event, error);
  if (!status) status = check_numbers(event, error);
  if (!status) status = check_direction(event, &direction, error);
  if (!status) status = check_quantity(event, &quantity, error);
  if (!status) status = check_place(event, sim, error);
  if (status) return status;
  *w = (sph_watch){.event = *event, .type = find(event->type), .direction = direction};
  snprintf(w->name, sizeof w->name, "%s", event->name);
  snprintf(w->group, sizeof w->group, "%s", event->group ? event->group : "");
  w->event.name = w->info.name = w->name;
  w->event.group = event->group ? w->group : NULL;
  w->event.quantity = quantity;
  w->event.type = w->event.direction = NULL; /* told by type and direction */
  w->info.first = w->info.last = NAN;
  w->root = INFINITY;
  return SPH_OK;
}
