#include "sphode/sim.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "clock.h"
#include "controller.h"
#include "cpu.h"
#include "linear.h"
#include "memory.h"
#include "searches.h"
#include "sim_data.h"
#include "sim_event.h"
#include "sim_implicit.h"
#include "sim_keep.h"
#include "sim_parts.h"
#include "sim_prepare.h"
#include "sim_rhs.h"
#include "sim_run.h"

static int positive(sph_error *error, const char *name, double value)
{
  if (isfinite(value) && value > 0) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "%s = %g; right is a finite number > 0", name,
                       value);
}

static void set_kernel(sph_sim *sim, const sph_sim_def *def)
{
  const char *name = def->kernel ? def->kernel : "wendland-c2";
  char known[200] = "";
  for (int k = 0; sph_kernel_get(k); k++) {
    size_t used = strlen(known);
    const char *other = sph_kernel_name(sph_kernel_get(k));
    snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", other);
    if (strcmp(name, other)) continue;
    sim->kernel = sph_kernel_get(k);
    sim->kernel_number = k;
  }
  if (!sim->kernel)
    sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "kernel \"%s\"; known: %s", name, known);
}

/* Stability limits S are measured with Wendland C2.  The fastest waves of a lattice go as
 * 1/sigma_k, the deviation of the kernel: a narrower one needs a smaller step. */
static double narrow(const sph_kernel *kernel, int dim)
{
  return sph_kernel_deviation(kernel, dim) /
         sph_kernel_deviation(sph_kernel_find("wendland-c2"), dim);
}

static void set_lengths(sph_sim *sim, const sph_sim_def *def)
{
  if (positive(&sim->error, "dx", def->dx) || !sim->kernel) return;
  double h_over_dx = def->h_over_dx == 0 ? sph_kernel_h_over_dx(sim->kernel) : def->h_over_dx;
  if (positive(&sim->error, "h_over_dx", h_over_dx)) return;
  sim->dx = def->dx;
  sim->volume = sim->wall_volume = pow(def->dx, sim->dim);
  sim->h = h_over_dx * def->dx;
  sim->H = sph_kernel_support(sim->kernel) * sim->h;
  sim->h_sound = sim->h * fmin(1, narrow(sim->kernel, sim->dim));
  if (!isfinite(def->skin)) {
    sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "skin = %g is not finite", def->skin);
    return;
  }
  sim->skin = (def->skin < 0 ? 0 : def->skin == 0 ? 0.2 : def->skin) * sim->h;
  if (!(def->speed >= 0 && def->speed < INFINITY))
    sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "speed = %g; right is a finite number >= 0",
                  def->speed);
  sim->speed = def->speed;
}

static void set_box(sph_sim *sim, const sph_sim_def *def)
{
  for (int d = 0; d < sim->dim; d++) {
    sim->periodic[d] = def->periodic[d] != 0;
    sim->origin[d] = def->origin[d];
    sim->length[d] = def->length[d];
    if (!sim->periodic[d]) continue;
    if (!isfinite(def->origin[d]))
      sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "origin[%d] = %g is not finite", d,
                    def->origin[d]);
    double least = 2 * (sim->H + sim->skin);
    if (!(def->length[d] >= least && def->length[d] < INFINITY))
      sph_error_set(
          &sim->error, SPH_ERR_ARGUMENT,
          "length[%d] = %g m of the periodic box; right is at least twice the support and the "
          "skin, %g m",
          d, def->length[d], least);
  }
}

static void set_search(sph_sim *sim, const sph_sim_def *def)
{
  sim->isa = sph_cpu_isa(def->isa, &sim->error);
  sim->single = def->precision && !strcmp(def->precision, "mixed");
  if (def->precision && !sim->single && strcmp(def->precision, "double"))
    sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "precision \"%.60s\"; known: double, mixed",
                  def->precision);
  if (sim->single && sim->isa >= 0) sim->isa = sph_cpu_isa_mixed(sim->isa, &sim->error);
  sph_neighbors_search_check(def->search, def->own_search, &sim->error);
  sim->uses_own_search = !def->search && def->own_search;
  const char *name = sim->uses_own_search ? def->own_search->name : def->search;
  snprintf(sim->search, sizeof sim->search, "%s", name ? name : "grid");
}

sph_sim *sph_sim_create(const sph_sim_def *def)
{
  sph_sim *sim = sph_memory_take(1, sizeof *sim);
  if (!sim) return NULL;
  static const sph_sim_def nothing = {0};
  if (!def) {
    sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "sph_sim_create: no definition (NULL)");
    def = &nothing;
  }
  if (def->own_search) sim->own_search = *def->own_search; /* to be freed, whatever follows */
  sim->own_search.name = sim->search;
  sim->dim = def->dim;
  if (def->dim < 1 || def->dim > 3)
    sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "dim = %d; right is 1, 2 or 3", def->dim);
  sim->threads = def->threads ? def->threads : 1;
  if (def->threads < 0 || def->threads > 1024)
    sph_error_set(&sim->error, SPH_ERR_ARGUMENT, "threads = %d; right is 0 (one) to 1024",
                  def->threads);
  if (!sim->error.status) set_kernel(sim, def);
  if (!sim->error.status) set_lengths(sim, def);
  if (!sim->error.status) set_box(sim, def);
  if (!sim->error.status) set_search(sim, def);
  return sim;
}

int sph_sim_data_ok(const sph_sim *sim) { return sim && sim->error.status == SPH_OK; }

const char *sph_sim_error(const sph_sim *sim)
{
  return sim ? sim->error.text : "out of memory: the simulation itself";
}

int sph_sim_status(const sph_sim *sim) { return sim ? sim->error.status : SPH_ERR_MEMORY; }

int sph_sim_fail(sph_sim *sim, int status, const char *format, ...)
{
  if (!sim) return SPH_ERR_MEMORY;
  char text[sizeof sim->error.text];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return sph_error_set(&sim->error, status < 0 ? status : SPH_ERR_ARGUMENT, "%s", text);
}

void sph_sim_add_term(sph_sim *sim, sph_term term)
{
  int kept = sph_sim_data_ok(sim);
  if (kept && sim->prepared) {
    sph_sim_fail(sim, SPH_ERR_STATE, "term %s: terms are added before the run",
                 term.name ? term.name : "");
    kept = 0;
  }
  const int between = term.name && !strcmp(term.name, "shifting") && term.steps > 0;
  if (kept && sph_term_set_add(&sim->terms, &term, &sim->error) == SPH_OK)
    for (int g = 0; g < sim->groups; g++) sph_group_scalars_added(sim->group[g]);
  if (!kept && term.free) term.free(term.ctx);
  if (kept && between)
    sph_sim_add_modifier(sim, (sph_modifier){.name = "shifting",
                                             .steps = term.steps,
                                             .modify = sph_sim_shift_step});
}

void sph_sim_set_scale(sph_sim *sim, const sph_group *group, const char *field, double scale)
{
  if (!sph_sim_data_ok(sim)) return;
  int number = sph_field_find(field), scalar = sph_term_set_scalar(&sim->terms, field);
  if (number < 0 && scalar >= 0) number = SPH_SCALAR + scalar;
  if (sim->prepared)
    sph_sim_fail(sim, SPH_ERR_STATE, "scales of error weights are set before the run");
  else if (group && group->sim != sim)
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "scale: group %s is of another simulation", group->name);
  else if (number < 0)
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "scale of \"%.60s\": no such field", field ? field : "");
  else if (!(scale > 0 && scale < INFINITY))
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "scale of %s: %g; right is finite and > 0", field, scale);
  else
    sim->set_scale[group ? group->index : SPH_SETS_MAX][number] = scale;
}

/* Terms that did nothing at the start have no loop. */
void sph_sim_change_term(sph_sim *sim, sph_term term)
{
  if (!sph_sim_data_ok(sim)) return;
  unsigned bits = term.name ? sph_term_set_bits(term.name) : 0;
  int unused = sim->prepared && (sim->terms.bits & bits) && !(sim->loop_terms & bits);
  if (sim->prepared && sim->shown != sim->y)
    sph_sim_fail(sim, SPH_ERR_STATE, "term %s: terms change between steps",
                 term.name ? term.name : "");
  else if (unused)
    sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                 "term %s: its strength was 0 at the start; right is a small one there", term.name);
  else if (sph_term_set_change(&sim->terms, &term, &sim->error) == SPH_OK)
    sph_sim_changed(sim);
}

static int linear_is_known(sph_sim *sim, const char *name)
{
  sph_linear *solver = sph_linear_create(name, 1, &sim->error);
  sph_linear_free(solver);
  return solver != NULL;
}

void sph_sim_set_integrator(sph_sim *sim, const sph_integrator_def *def)
{
  if (!sph_sim_data_ok(sim)) return;
  if (!def)
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "sph_sim_set_integrator: no definition (NULL)");
  else if (sim->prepared)
    sph_sim_fail(sim, SPH_ERR_STATE, "the integrator is set before the run");
  else if (sph_integrator_check(def, &sim->error) == SPH_OK && linear_is_known(sim, def->linear)) {
    sim->integrator_def = *def;
    const char *name = def->own ? def->own->name : def->method;
    if (name) snprintf(sim->method, sizeof sim->method, "%s", name);
    sim->integrator_def.method = def->method ? sim->method : NULL;
    if (def->linear) snprintf(sim->linear, sizeof sim->linear, "%s", def->linear);
    sim->integrator_def.linear = def->linear ? sim->linear : NULL;
    if (def->fast_method) snprintf(sim->fast, sizeof sim->fast, "%s", def->fast_method);
    sim->integrator_def.fast_method = def->fast_method ? sim->fast : NULL;
    sim->integrator_def.relax = def->relax ? "energy" : NULL; /* there is no other */
    if (def->controller)
      sim->integrator_def.controller = sph_controller_find(def->controller, &sim->error)->name;
    if (def->own) {
      sim->scheme = *def->own;
      sim->scheme.name = sim->method;
      sim->integrator_def.own = &sim->scheme;
    }
    sim->has_integrator = 1;
  }
}

void sph_sim_add_output(sph_sim *sim, sph_output output)
{
  int kept = sph_sim_data_ok(sim);
  if (kept && !output.frame)
    kept = !sph_sim_fail(sim, SPH_ERR_ARGUMENT, "an output without a frame function");
  if (kept && !(output.interval >= 0))
    kept = !sph_sim_fail(sim, SPH_ERR_ARGUMENT, "output %s: interval = %g s; right is >= 0",
                         output.name ? output.name : "", output.interval);
  if (kept && sim->outlets == SPH_OUTPUTS_MAX)
    kept = !sph_sim_fail(sim, SPH_ERR_ARGUMENT, "more than %d outputs", SPH_OUTPUTS_MAX);
  if (kept)
    sim->outlet[sim->outlets++] = (sph_outlet){.output = output};
  else if (output.free)
    output.free(output.ctx);
}

void sph_sim_set_progress(sph_sim *sim, int (*progress)(void *ctx, sph_sim *sim), void *ctx)
{
  if (!sph_sim_data_ok(sim)) return;
  sim->progress = progress;
  sim->progress_ctx = ctx;
}

void sph_sim_add_event(sph_sim *sim, const sph_event *event)
{
  int kept = sph_sim_data_ok(sim);
  if (kept && !event)
    kept = !sph_sim_fail(sim, SPH_ERR_ARGUMENT, "sph_sim_add_event: no definition (NULL)");
  if (kept && sim->watches == SPH_EVENTS_MAX)
    kept = !sph_sim_fail(sim, SPH_ERR_ARGUMENT, "more than %d events", SPH_EVENTS_MAX);
  if (kept && sph_event_take(&sim->watch[sim->watches], event, sim, &sim->error) == SPH_OK)
    sim->watches++;
  else if (event && event->free)
    event->free(event->ctx);
}

int sph_sim_event_get(const sph_sim *sim, int k, sph_event_info *info)
{
  if (!sim || !info || k < 0 || k >= sim->watches) return 0;
  *info = sim->watch[k].info;
  return 1;
}

const char *sph_sim_stopped_by(const sph_sim *sim) { return sim ? sim->stopped_by : NULL; }

static int check_modifier(sph_sim *sim, const sph_modifier *m)
{
  const char *name = m->name ? m->name : "";
  if (!*name || strlen(name) >= SPH_NAME_MAX)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "modifier name \"%.80s\"; right is 1 to %d letters",
                        name, SPH_NAME_MAX - 1);
  if (!m->modify)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "modifier %s: no function (NULL)", name);
  if (m->steps < 0 || (m->steps > 0) == (m->interval != 0) ||
      !(m->interval >= 0 && m->interval < INFINITY))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "modifier %s: steps = %ld, interval = %g s; right is one of them, > 0",
                        name, m->steps, m->interval);
  if (sim->modifiers == SPH_MODIFIERS_MAX)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "modifier %s: more than %d modifiers", name,
                        SPH_MODIFIERS_MAX);
  return SPH_OK;
}

void sph_sim_add_modifier(sph_sim *sim, sph_modifier modifier)
{
  if (!sph_sim_data_ok(sim) || check_modifier(sim, &modifier)) {
    if (modifier.free) modifier.free(modifier.ctx);
    return;
  }
  sph_modifying *m = &sim->modifier[sim->modifiers++];
  *m = (sph_modifying){.modifier = modifier, .start = sim->time, .done = modifier.steps == 0};
  snprintf(m->name, sizeof m->name, "%s", modifier.name);
  m->modifier.name = m->name;
}

const char *sph_sim_bound_name(const sph_sim *sim, int bound)
{
  const int fixed = sim && sim->integrator_def.dt_fixed > 0;
  return fixed && bound == SPH_BOUND_USER ? "dt_fixed" : sph_bound_name(bound);
}

void sph_sim_set_stop(sph_sim *sim, const char *why)
{
  if (sim) sim->why = why;
}

double sph_sim_time(const sph_sim *sim) { return sim ? sim->time : 0; }
int sph_sim_dim(const sph_sim *sim) { return sim ? sim->dim : 0; }
double sph_sim_dx(const sph_sim *sim) { return sim ? sim->dx : 0; }
double sph_sim_h(const sph_sim *sim) { return sim ? sim->h : 0; }
int sph_sim_threads(const sph_sim *sim) { return sim ? sim->threads : 0; }
long sph_sim_revision(const sph_sim *sim) { return sim ? sim->revision : 0; }

int sph_sim_periodic(const sph_sim *sim, int d, double *origin, double *length)
{
  if (!sim || d < 0 || d >= sim->dim || !sim->periodic[d]) return 0;
  if (origin) *origin = sim->origin[d];
  if (length) *length = sim->length[d];
  return 1;
}

const char *sph_sim_kernel(const sph_sim *sim)
{
  return sim && sim->kernel ? sph_kernel_name(sim->kernel) : "";
}

const char *sph_sim_isa(const sph_sim *sim) { return sim ? sph_cpu_isa_name(sim->isa) : ""; }

const char *sph_sim_integrator(const sph_sim *sim)
{
  const sph_integrator_def *def = sim ? &sim->integrator_def : NULL;
  return def && (def->method || def->own) ? sim->method : "erk:bogacki-shampine-4-2-3";
}

sph_group *sph_sim_group(const sph_sim *sim, const char *name)
{
  for (int g = 0; sim && name && g < sim->groups; g++)
    if (!strcmp(sim->group[g]->name, name)) return sim->group[g];
  return NULL;
}

sph_group *sph_sim_group_get(const sph_sim *sim, int k)
{
  return sim && k >= 0 && k < sim->groups ? sim->group[k] : NULL;
}

void sph_sim_free(sph_sim *sim)
{
  if (!sim) return;
  sph_sim_run_close(sim);
  sph_sim_prepare_undo(sim);
  for (int g = 0; g < sim->groups; g++) sph_group_data_free(sim->group[g]);
  for (int k = 0; k < sim->outlets; k++)
    if (sim->outlet[k].output.free) sim->outlet[k].output.free(sim->outlet[k].output.ctx);
  for (int k = 0; k < sim->watches; k++)
    if (sim->watch[k].event.free) sim->watch[k].event.free(sim->watch[k].event.ctx);
  for (int k = 0; k < sim->modifiers; k++)
    if (sim->modifier[k].modifier.free)
      sim->modifier[k].modifier.free(sim->modifier[k].modifier.ctx);
  if (sim->own_search.free) sim->own_search.free(sim->own_search.ctx);
  sph_sim_keep_free(sim);
  sph_term_set_free(&sim->terms);
  sph_memory_free(sim);
}

int sph_sim_step(sph_sim *sim)
{
  double begin = sph_clock();
  int status = sph_sim_run_enter(sim);
  if (status) return status;
  status = sph_sim_prepare(sim);
  if (!status) status = sph_sim_parts_fit(sim);
  if (!status)
    status = sph_sim_run_step(sim, sim->time + 1e9 * fmin(sim->limit[SPH_BOUND_CFL], 1e9), 0);
  sph_sim_run_leave(sim);
  if (sim) sim->seconds += sph_clock() - begin;
  return status;
}

void sph_sim_changed(sph_sim *sim)
{
  if (!sph_sim_data_ok(sim) || !sim->prepared) return;
  sim->derived = sim->listed = 0; /* fields may have moved any distance */
  sph_integrator_go_on(sim->integrator, sim->time);
}

int sph_sim_evaluate(sph_sim *sim)
{
  int status = sph_sim_prepare(sim);
  if (status) return status;
  status = sph_sim_rhs(sim->time, sim->shown, sim->ydot, sim);
  if (status > 0)
    status = sph_sim_fail(sim, SPH_ERR_ARGUMENT, "the state is not admissible: %s", sim->retry);
  sim->derived = !status;
  return status;
}

int sph_sim_set_vector(sph_sim *sim, double t, N_Vector y)
{
  int status = sph_sim_prepare(sim);
  if (status) return status;
  if (!y || !isfinite(t))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "sph_sim_set_vector: t = %g s, y %s; right is a finite time and a vector",
                        t, y ? "given" : "NULL");
  if (sph_sim_rhs_vectors(sim, y, sim->y)) return sim->error.status;
  if (y != sim->y) N_VScale(1, y, sim->y);
  sim->shown = sim->y;
  sim->time = t;
  sph_sim_changed(sim);
  return SPH_OK;
}

int sph_sim_solve(sph_sim *sim, double t, double gamma, double tolerance, N_Vector known,
                  N_Vector z)
{
  int status = sph_sim_prepare(sim);
  if (status) return status;
  const int numbers = gamma > 0 && tolerance > 0 && isfinite(t + gamma + tolerance);
  if (!known || !z || known == z || !numbers)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "sph_sim_solve: t = %g s, gamma = %g s, tolerance = %g, known %s, z %s; "
                        "right is finite, > 0, > 0, two vectors",
                        t, gamma, tolerance, known ? "given" : "NULL",
                        !z           ? "NULL"
                        : known == z ? "the same"
                                     : "given");
  if (sph_sim_rhs_vectors(sim, known, z)) return sim->error.status;
  if (!isfinite(N_VL1Norm(known)) || !isfinite(N_VL1Norm(z)))
    return sph_sim_admit_retry(sim, "sph_sim_solve: a number of %s is not finite",
                               isfinite(N_VL1Norm(known)) ? "z" : "known");
  if (!sim->implicit) { /* f_implicit = 0 */
    N_VScale(1, known, z);
    return SPH_OK;
  }
  sph_stage stage = {.t = t, .gamma = gamma, .tolerance = tolerance, .known = known, .z = z};
  status = sph_sim_implicit_solve(&stage, sim);
  sim->derived = 0;
  return status;
}

const char *sph_sim_retry_reason(const sph_sim *sim) { return sim ? sim->retry : ""; }

N_Vector sph_sim_vector(sph_sim *sim) { return sph_sim_prepare(sim) == SPH_OK ? sim->y : NULL; }
