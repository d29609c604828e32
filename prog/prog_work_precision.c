/* sphode work-precision: what each integrator needs for which temporal error.
 *
 * All runs start from the same particles with the same lists.  An integrator with error control
 * runs with each tolerance; the others with fixed steps, cfl/cfl0 of the smallest step that the
 * limits allowed them by default (cfl0), where cfl is the fraction of the stability limit; at cfl0
 * itself the steps follow the limits.  The reference halves its fixed steps until the difference of
 * its last two runs tells an error a tenth of the least that was found. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "prog_work.h"

enum { HALVINGS = 7 };                  /* of the reference, at most */
static const double PATIENCE = 20;      /* a reference costs at most so many of the longest run */
static const double ROUNDING = 1e-12;   /* no reference needs to be better */
static const double CFL_DEFAULT = 0.35; /* of the library, without error control */

static double cpu_now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- what was asked for */

/* Numbers > 0 between commas; their count, 0: told. */
static int numbers(const char *option, const char *text, double value[WORK_VALUES])
{
  int n = 0;
  for (const char *at = text; n < WORK_VALUES; at++) {
    char *end;
    value[n] = strtod(at, &end);
    if (end == at || !(value[n] > 0 && isfinite(value[n])) || (*end && *end != ',')) break;
    n++;
    at = end;
    if (!*end) return n;
  }
  sph_prog_error(PROG_USAGE, "--%s %s: wanted 1 to %d numbers > 0, as 1e-2,1e-3", option, text,
                 WORK_VALUES);
  return 0;
}

/* Reads the case once more, with the method's own keys: "+linear=cholmod" sets
 * integrator.linear=cholmod, "+terms.delta.part=implicit" what it says. */
static int read_case(const prog_options *o, work_method *m, sph_error *error)
{
  const char *set[PROG_SETS + 8];
  char own[8][160], label[sizeof m->label], until[200];
  int n = 0, keys = 0;
  for (; n < o->sets; n++) set[n] = o->set[n];
  if (o->until) {
    snprintf(until, sizeof until, "run.end=%s", o->until);
    set[n++] = until;
  }
  snprintf(label, sizeof label, "%s", m->label);
  char *rest = label, *word = strsep(&rest, "+");
  snprintf(m->method, sizeof m->method, "%s", word);
  while ((word = strsep(&rest, "+")) && keys < 7) {
    int dotted = memchr(word, '.', strcspn(word, "=")) != NULL;
    snprintf(own[keys], sizeof own[keys], "%s%s", dotted ? "" : "integrator.", word);
    set[n++] = own[keys++];
  }
  m->c = sph_case_read(o->what, n, set, error);
  return m->c ? PROG_OK : PROG_FAILED;
}

static sph_integrator_def definition(const work_method *m)
{
  sph_integrator_def def;
  sph_case_build_integrator(m->c, &def);
  def.method = m->method;
  def.tolerance = def.dt_fixed = 0;
  return def;
}

/* Fails where nothing of this name can be run, told with what is known. */
static int take_method(const prog_options *o, work_method *m, const char *label)
{
  sph_error error = {0};
  sph_integrator_info info;
  snprintf(m->label, sizeof m->label, "%s", label);
  if (read_case(o, m, &error)) return sph_prog_error(PROG_FAILED, "%s", error.text);
  sph_integrator_def def = definition(m);
  sph_sim *sim = sph_case_build(m->c, o->threads, &error);
  sph_sim_set_integrator(sim, &def);
  int status = sim ? sph_sim_status(sim) : error.status;
  if (status && status != SPH_ERR_UNBUILT && sim)
    sph_prog_sim_error(m->c, sim, o->what);
  else if (status && status != SPH_ERR_UNBUILT)
    sph_prog_error(PROG_FAILED, "%s", error.text);
  sph_sim_free(sim);
  for (int k = 0; sph_integrator_info_get(k, &info); k++)
    if (!strcmp(info.name, m->method)) {
      m->error_control = info.error_control && !o->fixed;
      m->wants = info.wants;
    }
  return status && status != SPH_ERR_UNBUILT ? PROG_FAILED : PROG_OK;
}

static int take_methods(work *w)
{
  char list[2000];
  if (snprintf(list, sizeof list, "%s", w->o->integrators) >= (int)sizeof list)
    return sph_prog_error(PROG_USAGE, "--integrators: the list is longer than %d letters",
                          (int)sizeof list - 1);
  int status = PROG_OK;
  for (char *rest = list, *word; !status && (word = strsep(&rest, ","));) {
    if (!*word || strlen(word) >= sizeof w->method->label)
      status = sph_prog_error(PROG_USAGE, "--integrators %s: an empty or too long name",
                              w->o->integrators);
    else if (w->methods == WORK_METHODS)
      status = sph_prog_error(PROG_USAGE, "--integrators: more than %d", WORK_METHODS);
    else
      status = take_method(w->o, &w->method[w->methods++], word);
  }
  if (!status) status = take_method(w->o, &w->reference, w->o->reference);
  return status;
}

static void add_runs(work *w, int method, const char *setting, int n, const double *value)
{
  for (int k = 0; k < n; k++)
    w->run[w->runs++] = (work_run){.method = method, .setting = setting, .value = value[k]};
}

static int take_runs(work *w)
{
  double tolerance[WORK_VALUES], cfl[WORK_VALUES];
  int tolerances = numbers("tolerances", w->o->tolerances, tolerance);
  int cfls = tolerances ? numbers("cfl", w->o->cfl, cfl) : 0;
  if (!cfls) return PROG_USAGE;
  int status = take_methods(w);
  for (int m = 0; !status && m < w->methods; m++)
    if (w->method[m].error_control)
      add_runs(w, m, "tolerance", tolerances, tolerance);
    else
      add_runs(w, m, "cfl", cfls, cfl);
  w->end = status ? 0 : sph_case_end(w->reference.c);
  return status;
}

/* ---- one run */

static void forget(work_run *r)
{
  free(r->state);
  r->state = NULL;
}

static int failed(work_run *r, int status, const char *why)
{
  r->status = status;
  snprintf(r->reason, sizeof r->reason, "%s", why);
  return PROG_OK;
}

/* With its place in the case, where there is one. */
static int sim_failed(work_run *r, const work_method *m, const sph_sim *sim)
{
  char place[200], why[sizeof r->reason];
  const int known = sph_case_place(m->c, sph_sim_error(sim), place, sizeof place);
  snprintf(why, sizeof why, "%s%s%.190s", known ? place : "", known ? ": " : "",
           sph_sim_error(sim));
  return failed(r, sph_sim_status(sim), why);
}

/* A method that steps all terms alike leaves aside which parts they belong to. */
static void attach(sph_sim *sim, const work_method *m, const sph_integrator_def *def)
{
  if (!(m->wants & (SPH_WANTS_IMPLICIT | SPH_WANTS_FAST))) sph_sim_set_part(sim, NULL, "explicit");
  sph_sim_set_integrator(sim, def);
}

/* From the case to its end; an exit status where the whole command is to stop. */
static int go(work *w, work_run *r, sph_sim *sim, const work_method *m,
              const sph_integrator_def *def)
{
  prog_progress progress;
  attach(sim, m, def);
  if (sph_sim_evaluate(sim)) return sim_failed(r, m, sim);
  if (!w->fields.n) sph_prog_work_state_fields(sim, &w->fields);
  sph_prog_progress_start(&progress, sim, w->end, 1);
  if (w->o->timeout > 0 && r->method >= 0) progress.deadline = progress.start + w->o->timeout;
  double cpu = cpu_now(), wall = sph_prog_progress_now();
  r->status = sph_sim_run(sim, w->end);
  cpu = cpu_now() - cpu;
  wall = sph_prog_progress_now() - wall;
  if (!(r->cpu > 0 && r->cpu < cpu)) {
    r->cpu = cpu;
    r->wall = wall;
  }
  sph_sim_get_stats(sim, &r->stats);
  if (r->status == SPH_ERR_STOPPED && !sph_prog_progress_signal())
    return failed(r, r->status, "it took longer than --timeout");
  if (r->status == SPH_ERR_STOPPED)
    return sph_prog_error(128 + sph_prog_progress_signal(), "stopped; nothing is written");
  if (r->status) return sim_failed(r, m, sim);
  if (!r->state) r->state = sph_prog_work_state_take(sim, &w->fields);
  return r->state ? PROG_OK : sph_prog_error(PROG_FAILED, "out of memory: the state of a run");
}

static int run_once(work *w, work_run *r, const work_method *m, const sph_integrator_def *def)
{
  sph_error error = {0};
  sph_sim *sim = sph_case_build(m->c, w->o->threads, &error);
  if (!sim) return sph_prog_error(PROG_FAILED, "%s", error.text);
  int status = go(w, r, sim, m, def);
  sph_sim_free(sim);
  return status;
}

static void tell(const work *w, const work_run *r, const work_method *m)
{
  if (w->o->quiet) return;
  fprintf(stderr, "%-34s %-9s %-8.3g ", m->label, r->setting, r->value);
  if (r->status)
    fprintf(stderr, "failed: %s\n", r->reason);
  else
    fprintf(stderr, "%7ld evaluations  %.3g s\n", r->stats.step.rhs_evaluations, r->cpu);
}

/* Several times, the quickest counts. */
static int measure(work *w, work_run *r, const work_method *m)
{
  sph_integrator_def def = definition(m);
  if (!strcmp(r->setting, "tolerance"))
    def.tolerance = r->value;
  else {
    def.tolerance = -1;
    def.dt_fixed = r->dt_fixed;
  }
  int status = PROG_OK;
  for (int k = 0; !status && !r->status && k < w->o->repeat; k++) status = run_once(w, r, m, &def);
  if (!status) tell(w, r, m);
  return status;
}

static double cfl_of(const work_method *m)
{
  sph_integrator_def def = definition(m);
  return def.cfl > 0 ? def.cfl : CFL_DEFAULT;
}

/* Steps that divide the whole run. */
static double whole_steps(double end, double dt) { return end / ceil(end / dt * (1 - 1e-9)); }

/* A run whose steps follow the limits: its smallest step is what fixed ones are fractions of. */
static int measure_limits(work *w, work_run *r, work_method *m)
{
  int status = measure(w, r, m);
  m->dt = r->status ? 0 : r->stats.step.dt_smallest;
  return status;
}

static int by_limits(const work_run *r, const work_method *m)
{
  return fabs(r->value / cfl_of(m) - 1) < 1e-9;
}

/* The sweep of one integrator without error control, which ends in front of run `end`. */
static int sweep_fixed(work *w, work_method *m, int begin, int end)
{
  work_run extra = {.method = begin, .setting = "cfl", .value = cfl_of(m)}, *limits = &extra;
  for (int k = begin; k < end; k++)
    if (by_limits(&w->run[k], m)) limits = &w->run[k];
  int status = measure_limits(w, limits, m);
  for (int k = begin; !status && k < end; k++) {
    work_run *r = &w->run[k];
    if (r == limits) continue;
    r->dt_fixed = whole_steps(w->end, m->dt * r->value / cfl_of(m));
    status = m->dt > 0 ? measure(w, r, m) : failed(r, limits->status, limits->reason);
  }
  forget(&extra);
  return status;
}

/* Would a run with this tolerance be the one that was made with a smaller one?  It would, where no
 * error bound a step of that. */
static int is_same(const work_run *r, const work_run *made, const work_method *m)
{
  const sph_step_stats *s = &made->stats.step;
  return !m->wants && made->state && made->value < r->value && !s->rejected &&
         !s->bound_by[SPH_BOUND_ERROR];
}

static int copy(const work *w, work_run *r, const work_run *made)
{
  size_t bytes = (size_t)(w->fields.columns * w->fields.particles + 1) * sizeof *r->state;
  double value = r->value, *state = malloc(bytes);
  if (!state) return sph_prog_error(PROG_FAILED, "out of memory: the state of a run");
  memcpy(state, made->state, bytes);
  *r = *made;
  r->value = value;
  r->state = state;
  return PROG_OK;
}

/* The sweep of one with error control, from the smallest tolerance on if they are in order. */
static int sweep_tolerances(work *w, const work_method *m, int begin, int end)
{
  int status = PROG_OK;
  for (int k = end - 1; !status && k >= begin; k--) {
    work_run *r = &w->run[k], *made = k + 1 < end ? &w->run[k + 1] : NULL;
    status = made && is_same(r, made, m) ? copy(w, r, made) : measure(w, r, m);
  }
  return status;
}

static int sweep(work *w)
{
  int status = PROG_OK;
  for (int k = 0, end; !status && k < w->runs; k = end) {
    work_method *m = &w->method[w->run[k].method];
    for (end = k; end < w->runs && w->run[end].method == w->run[k].method;) end++;
    status = m->error_control ? sweep_tolerances(w, m, k, end) : sweep_fixed(w, m, k, end);
  }
  return status;
}

/* ---- the reference */

static void errors(work *w)
{
  for (int k = 0; k < w->runs; k++) {
    work_run *r = &w->run[k];
    if (r->state)
      sph_prog_work_state_distance(&w->fields, r->state, w->best.state, r->error);
    else
      for (int f = 0; f < WORK_FIELDS; f++) r->error[f] = NAN;
  }
}

/* Is the reference ten times better than the best run, or as good as rounding lets it be? */
static int good_enough(const work *w)
{
  double least = INFINITY;
  for (int k = 0; k < w->runs; k++)
    if (w->run[k].error[w->shown] > 0) least = fmin(least, w->run[k].error[w->shown]);
  return w->floor_of[w->shown] <= fmax(0.1 * least, ROUNDING);
}

/* The next finer reference; its error from the differences of three runs: with each halving they
 * shrink by a ratio, by 2 if that is not known yet, never by more than the order allows. */
static int halve(work *w, double difference[WORK_FIELDS])
{
  work_run finer = {.method = -1, .setting = "cfl", .value = w->best.value / 2};
  finer.dt_fixed =
      whole_steps(w->end, w->best.dt_fixed > 0 ? w->best.dt_fixed / 2 : w->reference.dt / 2);
  int status = measure(w, &finer, &w->reference);
  if (!status && finer.status)
    status = sph_prog_error(PROG_FAILED, "the reference: %s", finer.reason);
  if (status) return status;
  double change[WORK_FIELDS] = {0};
  sph_prog_work_state_distance(&w->fields, w->best.state, finer.state, change);
  for (int f = 0; f < w->fields.n; f++) {
    double ratio = w->halvings ? difference[f] / change[f] : 2;
    w->floor_of[f] = change[f] > 0 ? change[f] / (fmin(fmax(ratio, 2), 32) - 1) : 0;
    difference[f] = change[f];
  }
  forget(&w->best);
  w->best = finer;
  w->halvings++;
  errors(w);
  return PROG_OK;
}

static int refer(work *w)
{
  double difference[WORK_FIELDS] = {0}, longest = 0;
  w->best = (work_run){.method = -1, .setting = "cfl", .value = cfl_of(&w->reference)};
  for (int k = 0; k < w->runs; k++) longest = fmax(longest, w->run[k].cpu);
  int status = measure_limits(w, &w->best, &w->reference);
  if (!status && w->best.status)
    status = sph_prog_error(PROG_FAILED, "the reference: %s", w->best.reason);
  do {
    if (!status) status = halve(w, difference);
    w->poor = status ? 0 : !good_enough(w);
  } while (!status && w->poor && w->halvings < HALVINGS &&
           2 * w->best.cpu < fmax(PATIENCE * longest, 2));
  return status;
}

/* ---- the command */

/* --output, or the name of the case file with "-work" instead of what is behind its last dot. */
static void name_directory(work *w)
{
  const char *slash = strrchr(w->o->what, '/'), *name = slash ? slash + 1 : w->o->what;
  const char *dot = strrchr(name, '.');
  int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
  if (w->o->output)
    snprintf(w->directory, sizeof w->directory, "%s", w->o->output);
  else
    snprintf(w->directory, sizeof w->directory, "%.*s-work", length, name);
}

static int choose_field(work *w)
{
  const char *wanted = w->o->field ? w->o->field : "velocity";
  for (int f = 0; f < w->fields.n; f++)
    if (!strcmp(wanted, w->fields.name[f])) {
      w->shown = f;
      return PROG_OK;
    }
  char known[400] = "";
  for (int f = 0; f < w->fields.n; f++)
    snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", f ? ", " : "",
             w->fields.name[f]);
  return sph_prog_error(PROG_USAGE, "--field %s: known are %s", wanted, known);
}

/* The fields, before hours of runs. */
static int first_look(work *w)
{
  sph_error error = {0};
  sph_integrator_def def = definition(&w->reference);
  sph_sim *sim = sph_case_build(w->reference.c, w->o->threads, &error);
  int status = PROG_OK;
  attach(sim, &w->reference, &def);
  if (!sim)
    status = sph_prog_error(PROG_FAILED, "%s", error.text);
  else if (sph_sim_evaluate(sim))
    status = sph_prog_sim_error(w->reference.c, sim, w->o->what);
  else
    sph_prog_work_state_fields(sim, &w->fields);
  sph_sim_free(sim);
  return status ? status : choose_field(w);
}

static void release(work *w, int held)
{
  for (int k = 0; k < w->runs; k++) forget(&w->run[k]);
  forget(&w->best);
  for (int m = 0; m < w->methods; m++) sph_case_free(w->method[m].c);
  sph_case_free(w->reference.c);
  if (held >= 0) close(held);
  free(w);
}

int sph_prog_work_precision(const prog_options *given)
{
  prog_options o = *given;
  work *w = calloc(1, sizeof *w);
  if (!w) return sph_prog_error(PROG_FAILED, "out of memory");
  if (!o.integrators) o.integrators = "erk:bogacki-shampine-4-2-3,leapfrog";
  if (!o.tolerances) o.tolerances = "1e-1,1e-2,1e-3,1e-4,1e-5";
  if (!o.cfl) o.cfl = "1,0.7,0.5,0.35,0.175,0.0875,0.04375";
  if (!o.reference) o.reference = "erk:dormand-prince-7-4-5";
  if (o.repeat < 1) o.repeat = 1;
  w->o = &o;
  name_directory(w);
  int held = -1, status = take_runs(w);
  if (!status) status = first_look(w);
  if (!status && (held = sph_prog_directory_take(w->directory, o.force)) < 0) status = PROG_FAILED;
  if (!status) status = sweep(w);
  if (!status) status = refer(w);
  if (!status) status = sph_prog_work_report(w);
  release(w, held);
  return status;
}
