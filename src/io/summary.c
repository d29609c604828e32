/* summary.c -- what a run did, for programs (JSON) and for people. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "file.h"
#include "sphode/event.h"
#include "sphode/measure.h"
#include "sphode/output.h"
#include "sphode/sim.h"
#include "text.h"
#include "units.h"
#include "versions.h"

typedef struct facts {
  sph_sim *sim;
  int dim;
  const sph_balance *start; /* NULL: no drifts */
  sph_balance now;
  double work; /* of walls that move [J/m^(3-dim)] */
  sph_sim_stats stats;
  long fluids, walls; /* particles */
  const sph_comparison *comparison;
  int n; /* comparisons */
} facts;

static facts gather(sph_sim *sim, const sph_balance *start, const sph_comparison *comparison, int n)
{
  const sph_group *group;
  facts f = {.sim = sim, .start = start, .comparison = comparison, .n = n};
  f.dim = sph_sim_dim(sim);
  sph_sim_work(sim, &f.work); /* after a failure: up to the last frame */
  sph_sim_balance(sim, &f.now);
  sph_sim_get_stats(sim, &f.stats);
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    int wall = !strcmp(sph_group_kind(group), "wall");
    *(wall ? &f.walls : &f.fluids) += sph_group_count(group);
  }
  return f;
}

static double norm(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static double distance(const double a[3], const double b[3])
{
  return norm((double[3]){a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

static double pairs_per_second(const facts *f)
{
  return f->stats.seconds > 0 ? f->stats.pairs / f->stats.seconds : 0;
}

/* Steps that error control looked at. */
static double tried(const sph_step_stats *s) { return (double)(s->steps + s->rejected); }

static double a_step(const sph_step_stats *s)
{
  return s->steps ? (double)s->rhs_evaluations / (double)s->steps : 0;
}

static int judged(const sph_comparison *c) { return !isnan(c->bar); }

/* ---- JSON: one member a line ---- */

/* Spaces before the name are its indentation. */
static void member(sph_text *t, const char *name)
{
  int indent = (int)strspn(name, " ");
  sph_text_add(t, ",\n  %*s\"%s\": ", indent, "", name + indent);
}

static void real(sph_text *t, const char *name, double value)
{
  member(t, name);
  sph_text_json_number(t, value);
}

static void string(sph_text *t, const char *name, const char *value)
{
  member(t, name);
  sph_text_json_string(t, value);
}

static void json_who(sph_text *t, const facts *f)
{
  char text[200];
  sph_text_add(t, "{\n  \"program\": \"sphode\"");
  string(t, "version", sph_version());
  string(t, "sundials", sph_versions_sundials());
  string(t, "hdf5", sph_versions_hdf5(text, sizeof text));
  string(t, "compiler", sph_versions_compiler());
  string(t, "machine", sph_versions_machine(text, sizeof text));
  string(t, "instruction_set", sph_sim_isa(f->sim));
  real(t, "threads", sph_sim_threads(f->sim));
  real(t, "status", sph_sim_status(f->sim));
  string(t, "error", sph_sim_error(f->sim));
}

static void json_what(sph_text *t, const facts *f)
{
  const sph_step_stats *s = &f->stats.step;
  real(t, "dimension", f->dim);
  real(t, "spacing_m", sph_sim_dx(f->sim));
  real(t, "smoothing_length_m", sph_sim_h(f->sim));
  string(t, "kernel", sph_sim_kernel(f->sim));
  string(t, "integrator", sph_sim_integrator(f->sim));
  real(t, "fluid_particles", (double)f->fluids);
  real(t, "wall_particles", (double)f->walls);
  real(t, "time_s", sph_sim_time(f->sim));
  real(t, "steps", (double)s->steps);
  real(t, "rejected", (double)s->rejected);
  real(t, "retries", (double)s->retries);
  real(t, "rhs_evaluations", (double)s->rhs_evaluations);
  real(t, "implicit_evaluations", (double)s->implicit_evaluations);
  real(t, "solves", (double)s->solves);
  real(t, "solve_iterations", (double)s->solve_iterations);
  real(t, "list_builds", (double)f->stats.list_builds);
  real(t, "dt_smallest_s", s->dt_smallest);
  real(t, "dt_largest_s", s->dt_largest);
  member(t, "steps_bound_by");
  sph_text_add(t, "{");
  for (int k = 0; k < SPH_BOUND_COUNT; k++)
    sph_text_add(t, "%s\"%s\": %ld", k ? ", " : "", sph_bound_name(k), s->bound_by[k]);
  sph_text_add(t, "}");
  member(t, "fraction_bound_by");
  sph_text_add(t, "{");
  for (int k = 0; k < SPH_BOUND_COUNT; k++)
    sph_text_add(t, "%s\"%s\": %.6g", k ? ", " : "", sph_bound_name(k),
                 (double)s->bound_by[k] / fmax(1, (double)s->steps));
  sph_text_add(t, "}");
  real(t, "rhs_per_step", a_step(s));
  real(t, "wall_seconds", f->stats.seconds);
  real(t, "pairs", f->stats.pairs);
  real(t, "pairs_per_second", pairs_per_second(f));
  real(t, "memory_bytes", f->stats.bytes);
  real(t, "mach_largest", f->stats.mach);
  real(t, "density_deviation_largest", f->stats.density);
  real(t, "strayed_particles", (double)f->stats.strayed);
  real(t, "strayed_by_m", f->stats.strayed_by);
}

static void json_events(sph_text *t, const facts *f)
{
  sph_event_info event;
  member(t, "events");
  sph_text_add(t, "[");
  for (int k = 0; sph_sim_event_get(f->sim, k, &event); k++) {
    sph_text_add(t, "%s\n    {\"name\": ", k ? "," : "");
    sph_text_json_string(t, event.name);
    real(t, "  count", (double)event.count);
    real(t, "  first_s", event.first);
    real(t, "  last_s", event.last);
    sph_text_add(t, "}");
  }
  sph_text_add(t, "]");
  string(t, "stopped_by", sph_sim_stopped_by(f->sim));
}

static void json_vector(sph_text *t, const char *name, const double v[3])
{
  member(t, name);
  for (int d = 0; d < 3; d++) {
    sph_text_add(t, d ? ", " : "[");
    sph_text_json_number(t, v[d]);
  }
  sph_text_add(t, "]");
}

static void json_balance(sph_text *t, const char *name, const sph_balance *b)
{
  member(t, name);
  sph_text_add(t, "{\"mass\": ");
  sph_text_json_number(t, b->mass);
  json_vector(t, "  momentum", b->momentum);
  json_vector(t, "  angular_momentum", b->angular_momentum);
  real(t, "  kinetic", b->kinetic);
  real(t, "  potential", b->potential);
  real(t, "  internal", b->internal);
  real(t, "  total", b->total);
  sph_text_add(t, "}");
}

static void json_balances(sph_text *t, const facts *f)
{
  string(t, "energy_unit", sph_units_get(SPH_UNIT_ENERGY, f->dim));
  json_balance(t, "balance_end", &f->now);
  if (!f->start) return;
  json_balance(t, "balance_start", f->start);
  real(t, "drift_mass", f->now.mass - f->start->mass);
  real(t, "drift_momentum", distance(f->now.momentum, f->start->momentum));
  real(t, "drift_angular_momentum", distance(f->now.angular_momentum, f->start->angular_momentum));
  real(t, "work_of_walls", f->work);
  real(t, "drift_total_energy", f->now.total - f->start->total - f->work);
}

static void json_comparisons(sph_text *t, const facts *f)
{
  member(t, "comparisons");
  sph_text_add(t, "[");
  for (int k = 0; k < f->n; k++) {
    const sph_comparison *c = &f->comparison[k];
    sph_text_add(t, "%s\n    {\"name\": ", k ? "," : "");
    sph_text_json_string(t, c->name);
    string(t, "  reference", c->reference);
    string(t, "  quantity", c->quantity);
    string(t, "  norm", c->norm);
    real(t, "  value", c->value);
    real(t, "  bar", c->bar);
    member(t, "  pass");
    sph_text_add(t, "%s", !judged(c) ? "null" : c->pass ? "true" : "false");
    string(t, "  note", c->note);
    sph_text_add(t, "}");
  }
  sph_text_add(t, "]\n}\n");
}

/* ---- for people ---- */

static void line(sph_text *t, const char *name) { sph_text_add(t, "%-13s", name); }

/* Which limit bound which part of the steps, and what they cost. */
static void text_steps(sph_text *t, const sph_sim *sim, const sph_step_stats *s)
{
  int listed = 0;
  line(t, "bound by");
  for (int k = 0; k < SPH_BOUND_COUNT; k++)
    if (s->bound_by[k])
      sph_text_add(t, "%s%s %.3g %%", listed++ ? ", " : "", sph_sim_bound_name(sim, k),
                   100.0 * (double)s->bound_by[k] / (double)s->steps);
  sph_text_add(t, "%s\n", listed ? "" : "nothing yet");
  line(t, "repeated");
  sph_text_add(t, "%ld by error control (%.2g %% of the steps tried), %ld not admissible\n",
               s->rejected, 100.0 * (double)s->rejected / fmax(1, tried(s)), s->retries);
  line(t, "evaluations");
  sph_text_add(t, "%ld right-hand sides, %.3g a step", s->rhs_evaluations, a_step(s));
  if (s->solves)
    sph_text_add(t, ", %ld implicit stages (%ld iterations)", s->solves, s->solve_iterations);
  sph_text_add(t, "\n");
}

/* A liquid whose Mach number is above this is no longer nearly incompressible. */
static const double FAST = 0.3;

/* Did liquids stay what they are meant to be: slow, dense, inside? */
static void text_extremes(sph_text *t, const sph_sim_stats *s)
{
  if (s->mach == 0 && s->density == 0) return; /* none */
  line(t, "liquids");
  sph_text_add(t, "Mach number up to %.2g, density up to %.2g %% off the reference\n", s->mach,
               100 * s->density);
  if (s->mach > FAST) {
    line(t, "warning");
    sph_text_add(t,
                 "a liquid was faster than %g of its sound speed, as one should never be: "
                 "something drives it wildly, or the sound speed is too small\n",
                 FAST);
  }
  if (s->strayed > 0) {
    line(t, "warning");
    sph_text_add(
        t,
        "%ld particles are far outside of where everything was at the start, up to %.3g m: "
        "no wall held them\n",
        s->strayed, s->strayed_by);
  }
}

static void text_events(sph_text *t, const facts *f)
{
  sph_event_info event;
  for (int k = 0; sph_sim_event_get(f->sim, k, &event); k++) {
    line(t, k ? "" : "events");
    sph_text_add(t, "%s: %ld time%s", event.name, event.count, event.count == 1 ? "" : "s");
    if (event.count == 1) sph_text_add(t, ", at %.9g s", event.first);
    if (event.count > 1) sph_text_add(t, ", from %.9g to %.9g s", event.first, event.last);
    sph_text_add(t, "\n");
  }
  const char *name = sph_sim_stopped_by(f->sim);
  if (!name) return;
  line(t, "stopped by");
  sph_text_add(t, "%s\n", name);
}

static void text_run(sph_text *t, const facts *f)
{
  const sph_step_stats *s = &f->stats.step;
  line(t, "particles");
  sph_text_add(t, "%ld fluid, %ld wall; %dD, dx = %.4g m, h = %.4g m, %s\n", f->fluids, f->walls,
               f->dim, sph_sim_dx(f->sim), sph_sim_h(f->sim), sph_sim_kernel(f->sim));
  line(t, "time");
  sph_text_add(t, "%.6g s in %ld steps of %.3g to %.3g s, %s\n", sph_sim_time(f->sim), s->steps,
               s->dt_smallest, s->dt_largest, sph_sim_integrator(f->sim));
  text_steps(t, f->sim, s);
  line(t, "work");
  sph_text_add(t, "%.3g pairs in %.3g s: %.3g million pairs/s; %.3g MB\n", f->stats.pairs,
               f->stats.seconds, 1e-6 * pairs_per_second(f), 1e-6 * f->stats.bytes);
}

static void text_balance(sph_text *t, const facts *f)
{
  const char *unit = sph_units_get(SPH_UNIT_ENERGY, f->dim);
  const sph_balance *b = &f->now, *start = f->start;
  line(t, "energy");
  sph_text_add(t, "kinetic %.5g, potential %.5g, internal %.5g, total %.5g %s\n", b->kinetic,
               b->potential, b->internal, b->total, unit);
  line(t, "drift");
  if (!start) {
    sph_text_add(t, "not known: no start balance\n");
    return;
  }
  if (f->work != 0) sph_text_add(t, "beside %.5g %s of work by walls: ", f->work, unit);
  sph_text_add(t, "total energy %+.3g %s, mass %+.3g %s, momentum %.3g %s\n",
               b->total - start->total - f->work, unit, b->mass - start->mass,
               sph_units_get(SPH_UNIT_MASS, f->dim), distance(b->momentum, start->momentum),
               sph_units_get(SPH_UNIT_MOMENTUM, f->dim));
}

static void text_comparisons(sph_text *t, const facts *f)
{
  int name = 10, reference = 9;
  for (int k = 0; k < f->n; k++) {
    name = (int)fmax(name, (double)strlen(f->comparison[k].name ? f->comparison[k].name : ""));
    const char *from = f->comparison[k].reference;
    reference = (int)fmax(reference, (double)strlen(from ? from : ""));
  }
  if (f->n)
    sph_text_add(t, "\n%-*s  %-*s  %-8s %10s %10s\n", name, "comparison", reference, "reference",
                 "norm", "value", "bar");
  for (int k = 0; k < f->n; k++) {
    const sph_comparison *c = &f->comparison[k];
    sph_text_add(t, "%-*s  %-*s  %-8s %10.4g ", name, c->name ? c->name : "", reference,
                 c->reference ? c->reference : "", c->norm ? c->norm : "", c->value);
    if (judged(c))
      sph_text_add(t, "%10.4g  %s", c->bar, c->pass ? "pass" : "FAIL");
    else
      sph_text_add(t, "%10s  reported", "-");
    sph_text_add(t, "%s%s\n", c->note ? "  " : "", c->note ? c->note : "");
  }
}

static void text_who(sph_text *t, const facts *f)
{
  char machine[200];
  line(t, "machine");
  sph_text_add(t, "%s; %s, %d thread%s\n", sph_versions_machine(machine, sizeof machine),
               sph_sim_isa(f->sim), sph_sim_threads(f->sim),
               sph_sim_threads(f->sim) == 1 ? "" : "s");
  line(t, "made with");
  sph_text_add(t, "sphode %s, SUNDIALS %s, %s\n", sph_version(), sph_versions_sundials(),
               sph_versions_compiler());
  if (sph_sim_status(f->sim) == SPH_OK) return;
  line(t, "ended with");
  sph_text_add(t, "%s\n", sph_sim_error(f->sim));
}

static void text_all(sph_text *t, const facts *f)
{
  text_run(t, f);
  text_extremes(t, &f->stats);
  text_events(t, f);
  text_balance(t, f);
  text_who(t, f);
  text_comparisons(t, f);
}

int sph_summary_text(char *buffer, size_t size, sph_sim *sim, const sph_balance *start,
                     const sph_comparison *comparison, int n)
{
  if (!sim || (n > 0 && !comparison)) return SPH_ERR_ARGUMENT;
  facts f = gather(sim, start, comparison, n);
  sph_text t = {0};
  text_all(&t, &f);
  int length = t.error.status != SPH_OK ? t.error.status : (int)t.length;
  if (buffer && size) snprintf(buffer, size, "%s", t.data ? t.data : "");
  sph_text_free(&t);
  return length;
}

static int write_text(const char *directory, const char *name, sph_text *t, sph_error *error)
{
  char path[SPH_PATH];
  int status = sph_error_set(error, t->error.status, "%s", t->error.text);
  if (status == SPH_OK) status = sph_file_path(path, directory, name, error);
  if (status == SPH_OK) status = sph_file_replace(path, t->data, t->length, error);
  sph_text_free(t);
  return status;
}

int sph_summary_write(const char *directory, sph_sim *sim, const sph_balance *start,
                      const sph_comparison *comparison, int n, sph_error *error)
{
  if (!sim) return sph_error_set(error, SPH_ERR_ARGUMENT, "a summary needs a simulation");
  if (n > 0 && !comparison)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a summary: %d comparisons at NULL", n);
  facts f = gather(sim, start, comparison, n);
  sph_text json = {0}, text = {0};
  json_who(&json, &f);
  json_what(&json, &f);
  json_events(&json, &f);
  json_balances(&json, &f);
  json_comparisons(&json, &f);
  text_all(&text, &f);
  int status = sph_file_make_directory(directory, error);
  if (status == SPH_OK) status = write_text(directory, "summary.json", &json, error);
  if (status == SPH_OK) status = write_text(directory, "summary.txt", &text, error);
  sph_text_free(&json);
  sph_text_free(&text);
  return status;
}
