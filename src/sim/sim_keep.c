/* What a simulation remembers between steps.  One walk writes it and reads it, so that both name
 * the same things. */
#include "sim_keep.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "clock.h"
#include "keep.h"
#include "sim_implicit.h"
#include "sim_prepare.h"
#include "sim_rhs.h"
#include "sim_work.h"
#include "sphode/checkpoint.h"

/* ---- groups ---- */

static int keep_field(const sph_group *group, int field, const double *y, sph_keep *keep)
{
  const sph_sim *sim = group->sim;
  const int components = sph_group_data_components(sim->dim, field);
  const char *name =
      field < SPH_SCALAR ? sph_field_get(field)->name : sim->terms.scalar[field - SPH_SCALAR].name;
  for (int c = 0; c < components; c++) {
    char component[SPH_NAME_MAX + 4];
    double *value = sph_group_data_component(group, y, field, c);
    snprintf(component, sizeof component, components > 1 ? "%s_%c" : "%s", name, "xyz"[c]);
    if (!value) continue;
    /* What follows from the rest may not have been wanted then. */
    if (keep->reading && group->offset[field][c] < 0 && !sph_keep_has(keep, component)) continue;
    sph_keep_real(keep, component, group->n, value);
  }
  return keep->error->status;
}

static int keep_group(const sph_group *group, sph_keep *keep)
{
  const double *y = sph_nvector_data(group->sim->y);
  if (group->model == SPH_MODEL_MIRROR) return SPH_OK; /* images of what is kept */
  sph_keep_enter(keep, group->name);
  int status = sph_keep_match(keep, "particles", group->n);
  for (int field = 0; !status && field < SPH_SCALAR + group->scalars; field++)
    status = keep_field(group, field, y, keep);
  sph_keep_leave(keep);
  return status;
}

static int keep_groups(sph_sim *sim, sph_keep *keep)
{
  int status = sph_keep_match(keep, "dimension", sim->dim);
  if (!status) status = sph_keep_match(keep, "groups", sim->groups);
  sph_keep_enter(keep, "group");
  for (int g = 0; !status && g < sim->groups; g++) status = keep_group(sim->group[g], keep);
  sph_keep_leave(keep);
  return status;
}

/* ---- parameters that events change ---- */

/* Each of them: their number; at: where, [SPH_CHANGEABLE]. */
static int changeable(sph_sim *sim, double **at)
{
  sph_term_set *t = &sim->terms;
  double *const numbers[] = {&t->g[0],  &t->g[1],         &t->g[2],        &t->alpha,
                             &t->beta,  &t->signal_alpha, &t->signal_beta, &t->alpha_u,
                             &t->delta, &t->epsilon,      &t->drag_K,      &t->drag_rate};
  int n = sizeof numbers / sizeof *numbers;
  memcpy(at, numbers, sizeof numbers);
  for (int k = 0; k < t->called; k++) at[n++] = &t->call[k].term.omega;
  for (int g = 0; g < sim->groups; g++) {
    at[n++] = &sim->group[g]->viscosity;
    at[n++] = &sim->group[g]->conductivity;
  }
  return n;
}

void sph_sim_keep_start(sph_sim *sim)
{
  double *at[SPH_CHANGEABLE];
  int n = changeable(sim, at);
  for (int k = 0; k < n; k++) sim->given[k] = *at[k];
}

/* Those that were changed since the start are what they had become; the others stay as they are
 * given now, which may be anew. */
static int keep_parameters(sph_sim *sim, sph_keep *keep)
{
  double *at[SPH_CHANGEABLE], given[SPH_CHANGEABLE], now[SPH_CHANGEABLE];
  int n = changeable(sim, at), status = sph_keep_match(keep, "parameters", n);
  for (int k = 0; k < n; k++) {
    given[k] = sim->given[k];
    now[k] = *at[k];
  }
  sph_keep_real(keep, "given", n, given);
  if (!status) status = sph_keep_real(keep, "present", n, now);
  for (int k = 0; !status && keep->reading && k < n; k++)
    if (now[k] != given[k]) *at[k] = now[k];
  return status;
}

/* ---- events, modifiers, outputs, users ---- */

static int keep_event(sph_watch *w, sph_keep *keep)
{
  sph_keep_int(keep, "known", &w->known);
  sph_keep_int(keep, "side", &w->side);
  sph_keep_int(keep, "over", &w->over);
  sph_keep_integer(keep, "count", 1, &w->info.count);
  sph_keep_real(keep, "first", 1, &w->info.first);
  return sph_keep_real(keep, "last", 1, &w->info.last);
}

/* New events begin here, those that are no more are forgotten. */
static int keep_events(sph_sim *sim, sph_keep *keep)
{
  for (int k = 0; k < sim->watches; k++) {
    sph_keep_enter(keep, sim->watch[k].name);
    if (!keep->reading || sph_keep_has(keep, "known")) keep_event(&sim->watch[k], keep);
    sph_keep_leave(keep);
  }
  return keep->error->status;
}

static int keep_modifiers(sph_sim *sim, sph_keep *keep)
{
  for (int k = 0; k < sim->modifiers; k++) {
    sph_modifying *m = &sim->modifier[k];
    sph_keep_enter(keep, m->name);
    if (!keep->reading || sph_keep_has(keep, "start")) {
      sph_keep_real(keep, "start", 1, &m->start);
      sph_keep_real(keep, "done", 1, &m->done);
    }
    sph_keep_leave(keep);
  }
  return keep->error->status;
}

/* With another interval the next frame is the first multiple of it that is still to come. */
static int keep_outlet(sph_sim *sim, sph_outlet *outlet, sph_keep *keep)
{
  const sph_output *output = &outlet->output;
  double interval = output->interval;
  sph_keep_integer(keep, "frames", 1, &outlet->frames);
  sph_keep_real(keep, "start", 1, &outlet->start);
  sph_keep_real(keep, "last", 1, &outlet->last);
  int status = sph_keep_real(keep, "interval", 1, &interval);
  if (interval != output->interval && output->interval > 0 && output->interval < INFINITY)
    outlet->frames = (long)fmin(1e15, floor((sim->time - outlet->start) / output->interval) + 1);
  if (!status && output->keep) status = output->keep(output->ctx, sim, keep, keep->error);
  if (keep->reading) outlet->open = !status;
  return status;
}

/* Those that cannot keep are opened anew, where the run goes on. */
static int keep_outlets(sph_sim *sim, sph_keep *keep)
{
  for (int k = 0; k < sim->outlets; k++) {
    sph_outlet *outlet = &sim->outlet[k];
    char name[SPH_NAME_MAX];
    snprintf(name, sizeof name, "%d-%.40s", k, outlet->output.name ? outlet->output.name : "own");
    sph_keep_enter(keep, name);
    if (outlet->output.keep && (keep->reading ? sph_keep_has(keep, "frames") : outlet->open))
      keep_outlet(sim, outlet, keep);
    sph_keep_leave(keep);
  }
  return keep->error->status;
}

static int keep_users(sph_sim *sim, sph_keep *keep)
{
  int status = keep->error->status;
  for (int k = 0; !status && k < sim->kepts; k++) {
    sph_kept *kept = &sim->kept[k].kept;
    sph_keep_enter(keep, kept->name);
    status = kept->keep(kept->ctx, sim, keep, keep->error);
    if (status) sph_error_set(keep->error, status, "%s: it cannot be kept", kept->name);
    sph_keep_leave(keep);
  }
  return keep->error->status;
}

/* ---- the walk ---- */

static int keep_numbers(sph_sim *sim, sph_keep *keep)
{
  double seconds = sim->seconds + (sim->begun > 0 ? sph_clock() - sim->begun : 0);
  sph_keep_real(keep, "time", 1, &sim->time);
  sph_keep_real(keep, "start", 1, &sim->start);
  sph_keep_real(keep, "limit", SPH_BOUND_COUNT, sim->limit);
  sph_keep_real(keep, "limit_fast", SPH_BOUND_COUNT, sim->limit_fast);
  sph_keep_real(keep, "pairs", 1, &sim->pairs);
  sph_keep_real(keep, "seconds", 1, &seconds);
  sph_keep_real(keep, "rhs_seconds", 1, &sim->rhs_seconds);
  sph_keep_real(keep, "solve_seconds", 1, &sim->solve_seconds);
  if (!keep->reading || sph_keep_has(keep, "mach")) {
    sph_keep_real(keep, "mach", 1, &sim->extremes.mach);
    sph_keep_real(keep, "density", 1, &sim->extremes.density);
  }
  if (keep->reading) sim->seconds = seconds;
  return sph_keep_integer(keep, "matrices", 1, &sim->matrices);
}

typedef int walk(sph_sim *sim, sph_keep *keep);

static int keep_integrator(sph_sim *sim, sph_keep *keep)
{
  return sph_integrator_keep(sim->integrator, keep);
}

int sph_sim_keep(sph_sim *sim, sph_keep *keep)
{
  static const struct {
    const char *name;
    walk *keep;
  } part[] = {
      {"state", keep_groups},          {"simulation", keep_numbers},
      {"lists", sph_sim_lists_keep},   {"parameters", keep_parameters},
      {"integrator", keep_integrator}, {"implicit", sph_sim_implicit_keep},
      {"events", keep_events},         {"modifiers", keep_modifiers},
      {"work", sph_sim_work_keep},     {"outputs", keep_outlets},
      {"users", keep_users},
  };
  int status = keep->error->status;
  for (size_t k = 0; !status && k < sizeof part / sizeof *part; k++) {
    sph_keep_enter(keep, part[k].name);
    status = part[k].keep(sim, keep);
    sph_keep_leave(keep);
  }
  if (status || !keep->reading) return status;
  sim->shown = sim->y;
  sim->derived = 0;
  sim->stopped_by = NULL;
  sim->revision++;
  return SPH_OK;
}

/* ---- who is asked ---- */

static int good_name(const sph_sim *sim, const char *name)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  if (!name || !*name || strlen(name) >= SPH_KEPT_NAME || strspn(name, letters) != strlen(name))
    return 0;
  for (int k = 0; k < sim->kepts; k++)
    if (!strcmp(sim->kept[k].name, name)) return 0;
  return 1;
}

void sph_sim_keep_add(sph_sim *sim, sph_kept kept)
{
  int right = sph_sim_data_ok(sim);
  if (right && !good_name(sim, kept.name))
    right = !sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "kept name \"%.80s\"; right is 1 to %d of A-Z a-z 0-9 _ . -, and no "
                          "other one's",
                          kept.name ? kept.name : "", SPH_KEPT_NAME - 1);
  if (right && !kept.keep)
    right = !sph_sim_fail(sim, SPH_ERR_ARGUMENT, "kept %s: no function (NULL)", kept.name);
  if (right && sim->kepts == SPH_KEPT_MAX)
    right = !sph_sim_fail(sim, SPH_ERR_ARGUMENT, "kept %s: more than %d", kept.name, SPH_KEPT_MAX);
  if (!right) {
    if (kept.free) kept.free(kept.ctx);
    return;
  }
  sph_keeping *k = &sim->kept[sim->kepts++];
  snprintf(k->name, sizeof k->name, "%s", kept.name);
  k->kept = kept;
  k->kept.name = k->name;
}

void sph_sim_keep_saver(sph_sim *sim, sph_saver saver)
{
  if (sim->saver.free) sim->saver.free(sim->saver.ctx);
  sim->saver = saver;
}

int sph_sim_keep_save(sph_sim *sim, int last)
{
  return sim->saver.save ? sim->saver.save(sim->saver.ctx, sim, last, &sim->error) : SPH_OK;
}

void sph_sim_keep_free(sph_sim *sim)
{
  sph_sim_keep_saver(sim, (sph_saver){0});
  for (int k = 0; k < sim->kepts; k++)
    if (sim->kept[k].kept.free) sim->kept[k].kept.free(sim->kept[k].kept.ctx);
}
