/* What stepping in parts, stabilised stepping and relaxation save: CPU time of a run beside that of
 * an explicit scheme for the same run, and how far both are from a reference with much smaller
 * steps.  Periodic boxes in 2D, one thread.  With --filter only: minutes. */
#include <math.h>
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

static const double pi = 3.14159265358979323846;

/* A run to be made again and again. */
typedef struct scene {
  const char *name;
  long across;
  double t_end;
  void (*fill)(sph_sim *sim, const struct scene *scene); /* group, terms */
  double rate;                                           /* of the source [1/s] */
  double nu;                                             /* [m^2/s] */
  int sources;                                           /* of the expensive force */
  const char *field;                                     /* whose error counts */
} scene;

typedef struct outcome {
  double seconds; /* of CPU */
  double error;   /* largest difference from the reference over its scale */
  sph_step_stats steps;
} outcome;

static sph_group *gas_of(sph_sim *sim) { return sph_sim_group(sim, "gas"); }

static void swirl(sph_sim *sim, double speed)
{
  sph_group *gas = gas_of(sim);
  const double *x = sph_group_read(gas, "position", 0), *y = sph_group_read(gas, "position", 1);
  double *u = sph_group_write(gas, "velocity", 0), *v = sph_group_write(gas, "velocity", 1);
  for (long i = 0; v && i < sph_group_count(gas); i++) {
    u[i] = -speed * cos(2 * pi * x[i]) * sin(2 * pi * y[i]);
    v[i] = speed * sin(2 * pi * x[i]) * cos(2 * pi * y[i]);
  }
}

static void water(sph_sim *sim, double c0)
{
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0, 0}, (double[]){1, 1}, 1);
  sph_group_set_eos(gas, sph_eos_tait(1, c0, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  swirl(sim, 1);
}

static void ideal_gas(sph_sim *sim)
{
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0, 0}, (double[]){1, 1}, 1);
  sph_group_set_eos(gas, sph_eos_ideal_gas(1.4));
  double *u = sph_group_write(gas, "energy", 0);
  for (long i = 0; u && i < sph_group_count(gas); i++) u[i] = 1 / (0.4 * 1.4); /* c = 1 */
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  swirl(sim, 0.1);
}

/* ---- a stiff local source: gas that is held near a temperature of its place */

static int relax_heat(const sph_term *term, const sph_particles *p)
{
  const double rate = *(const double *)term->ctx;
  for (long i = 0; i < p->n; i++) {
    double goal = 1 / (0.4 * 1.4) * (1 + 0.1 * sin(2 * pi * p->x[0][i]) * cos(p->t));
    p->du[i] -= rate * (p->u[i] - goal);
  }
  return SPH_OK;
}

static void with_source(sph_sim *sim, const scene *s)
{
  ideal_gas(sim);
  sph_sim_add_term(sim, (sph_term){.name = "cooling",
                                   .body = relax_heat,
                                   .reads = "",
                                   .ctx = (void *)(uintptr_t)&s->rate});
}

/* ---- an expensive slow force: softened attraction by fixed masses */

enum { SOURCES_MAX = 2000 };

static int attract(const sph_term *term, const sph_particles *p)
{
  const int sources = *(const int *)term->ctx;
  const double soft2 = 0.04, strength = 1.0 / sources;
  static double sx[SOURCES_MAX], sy[SOURCES_MAX];
  for (int k = 0; k < sources; k++) {
    sx[k] = fmod(0.5 + 0.754877666 * k, 1);
    sy[k] = fmod(0.5 + 0.569840291 * k, 1);
  }
  for (long i = 0; i < p->n; i++) {
    double ax = 0, ay = 0;
    for (int k = 0; k < sources; k++) {
      double dx = p->x[0][i] - sx[k], dy = p->x[1][i] - sy[k];
      double r2 = dx * dx + dy * dy + soft2, f = strength / (r2 * sqrt(r2));
      ax -= f * dx;
      ay -= f * dy;
    }
    p->a[0][i] += ax;
    p->a[1][i] += ay;
  }
  return SPH_OK;
}

static void with_attraction(sph_sim *sim, const scene *s)
{
  water(sim, 10);
  sph_sim_add_term(sim, (sph_term){.name = "attraction",
                                   .body = attract,
                                   .reads = "",
                                   .ctx = (void *)(uintptr_t)&s->sources});
}

/* ---- viscosity */

static void with_viscosity(sph_sim *sim, const scene *s)
{
  water(sim, 10);
  sph_group_set_viscosity(gas_of(sim), s->nu);
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
}

static void viscous_gas(sph_sim *sim, const scene *s)
{
  (void)s;
  ideal_gas(sim);
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
}

/* A liquid that carries its heat along: all of its energy is motion and compression. */
static void warm_water(sph_sim *sim, const scene *s)
{
  (void)s;
  water(sim, 10);
  sph_group_set_energy(gas_of(sim), "u");
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.05, 0));
}

/* ---- runs */

static sph_sim *make(const scene *s, const sph_integrator_def *def, const char *fast)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = 1.0 / (double)s->across,
                                               .speed = 1,
                                               .threads = 1,
                                               .periodic = {1, 1},
                                               .length = {1, 1}});
  s->fill(sim, s);
  if (fast)
    for (const char *const *term = (const char *const[]){"continuity", "pressure", NULL}; *term;
         term++)
      if (!strcmp(fast, "waves")) sph_sim_set_part(sim, *term, "fast");
  if (fast && strcmp(fast, "waves")) sph_sim_set_part(sim, fast, "fast");
  sph_sim_set_integrator(sim, def);
  return sim;
}

/* The field of all particles at the end; reference NULL: none.  Owned by the caller. */
static double *run(const scene *s, const sph_integrator_def *def, const char *fast,
                   const double *reference, outcome *out)
{
  sph_sim *sim = make(s, def, fast);
  sph_sim_stats stats;
  double begin = bench_thread_seconds(), size = 0;
  if (sph_sim_run(sim, s->t_end)) bench_complain("%s: %s", s->name, sph_sim_error(sim));
  out->seconds = bench_thread_seconds() - begin;
  sph_sim_get_stats(sim, &stats);
  out->steps = stats.step;
  const long n = sph_group_count(gas_of(sim));
  const double *field = sph_group_read(gas_of(sim), s->field, 0);
  double *copy = malloc((size_t)n * sizeof *copy);
  out->error = 0;
  for (long i = 0; copy && i < n; i++) {
    copy[i] = field ? field[i] : NAN;
    size = fmax(size, fabs(reference ? reference[i] : 1));
    if (reference && !(fabs(copy[i] - reference[i]) <= out->error))
      out->error = fabs(copy[i] - reference[i]);
  }
  out->error /= size;
  sph_sim_free(sim);
  return copy;
}

static void tell(const scene *s, const char *what, double value, const char *unit)
{
  char name[120];
  snprintf(name, sizeof name, "%s/%s", s->name, what);
  bench_report(name, unit, &value, 1);
}

typedef struct rival {
  const char *what;
  sph_integrator_def def;
  const char *fast;
} rival;

/* The explicit scheme comes first; others may be absent from this SUNDIALS. */
static void compare(const scene *s, const sph_integrator_def *reference, const rival *rivals, int n)
{
  outcome out, first = {0};
  if (!bench_wanted(s->name)) return;
  double *exact = run(s, reference, NULL, NULL, &out);
  for (int k = 0; k < n; k++) {
    char what[80];
    sph_integrator_info info = {0};
    int row = 0;
    while (sph_integrator_info_get(row, &info) && strcmp(info.name, rivals[k].def.method)) row++;
    if (!sph_integrator_info_get(row, &info)) continue;
    free(run(s, &rivals[k].def, rivals[k].fast, exact, &out));
    if (k == 0) first = out;
    snprintf(what, sizeof what, "%s/error", rivals[k].what);
    tell(s, what, out.error, "of scale");
    snprintf(what, sizeof what, "%s/evaluations", rivals[k].what);
    tell(s, what, (double)out.steps.rhs_evaluations, "");
    snprintf(what, sizeof what, "%s/%s", rivals[k].what, k ? "speed-up" : "seconds");
    tell(s, what, k ? first.seconds / out.seconds : out.seconds, k ? "times" : "s");
  }
  free(exact);
}

/* rate dt = 25 for the dt of the slow part: half of an acoustic step. */
static void source(void)
{
  const long across = bench_quick() ? 30 : 60;
  const double h = 1.5 / (double)across, dt = 0.8 * h, rate = 25 / dt;
  const scene s = {.name = "multirate/source",
                   .across = across,
                   .t_end = 24 * dt,
                   .fill = with_source,
                   .rate = rate,
                   .field = "energy"};
  const rival rivals[] = {
      {"explicit", {.method = "erk:bogacki-shampine-4-2-3", .dt_fixed = 2.3 / rate}, NULL},
      {"kw3", {.method = "mri:kw3", .dt_fixed = dt, .fast_tolerance = 1e-3}, "cooling"},
      {"erk33a", {.method = "mri:erk33a", .dt_fixed = dt, .fast_tolerance = 1e-3}, "cooling"},
      {"merk32", {.method = "mri:merk32", .dt_fixed = dt, .fast_tolerance = 1e-3}, "cooling"},
      {"merk43", {.method = "mri:merk43", .dt_fixed = dt, .fast_tolerance = 1e-3}, "cooling"}};
  compare(&s, &(sph_integrator_def){.method = "erk:zonneveld-5-3-4", .dt_fixed = 0.5 / rate},
          rivals, 5);
}

/* A force of ten right-hand sides, with eight steps of the waves in one of its own. */
static void slow_force(void)
{
  const long across = bench_quick() ? 30 : 60;
  const double h = 1.5 / (double)across, dt = 0.5 * h / 10;
  scene s = {.name = "multirate/slow-force",
             .across = across,
             .t_end = 64 * dt,
             .fill = with_attraction,
             .sources = 1,
             .field = "velocity"};
  outcome cheap, dear;
  if (!bench_wanted(s.name)) return;
  const sph_integrator_def plain_def = {.method = "erk:bogacki-shampine-4-2-3", .dt_fixed = dt};
  free(run(&s, &plain_def, NULL, NULL, &cheap));
  s.sources = 201;
  free(run(&s, &plain_def, NULL, NULL, &dear));
  s.sources = (int)(1 + 10 * 200 * cheap.seconds / (dear.seconds - cheap.seconds));
  if (s.sources > SOURCES_MAX) s.sources = SOURCES_MAX;
  tell(&s, "sources", s.sources, "");
  const rival rivals[] = {
      {"explicit", plain_def, NULL},
      {"kw3", {.method = "mri:kw3", .dt_fixed = 8 * dt, .fast_step = dt}, "waves"},
      {"erk33a", {.method = "mri:erk33a", .dt_fixed = 8 * dt, .fast_step = dt}, "waves"},
      {"merk32", {.method = "mri:merk32", .dt_fixed = 8 * dt, .fast_step = dt}, "waves"}};
  compare(&s, &(sph_integrator_def){.method = "erk:zonneveld-5-3-4", .dt_fixed = dt / 4}, rivals,
          4);
}

/* Viscous steps are `ratio` times as short as half an acoustic one. */
static void stabilised(double ratio)
{
  const long across = bench_quick() ? 40 : 100;
  const double h = 1.5 / (double)across, acoustic = 0.5 * h / 10, lambda = ratio * 2.3 / acoustic;
  char name[60];
  snprintf(name, sizeof name, "stabilised/ratio-%g", ratio);
  const scene s = {.name = name,
                   .across = across,
                   .t_end = 10 * acoustic,
                   .fill = with_viscosity,
                   .nu = lambda * h * h / 6.5, /* docs/theory.md, step limits */
                   .field = "velocity"};
  const rival rivals[] = {{"explicit",
                           {.method = "erk:bogacki-shampine-4-2-3", .dt_fixed = 2.2 / lambda},
                           NULL},
                          {"rkc-2", {.method = "lsrk:rkc-2"}, NULL},
                          {"rkl-2", {.method = "lsrk:rkl-2"}, NULL},
                          {"rkc-2-fixed", {.method = "lsrk:rkc-2", .dt_fixed = acoustic}, NULL},
                          {"rkl-2-fixed", {.method = "lsrk:rkl-2", .dt_fixed = acoustic}, NULL}};
  compare(&s, &(sph_integrator_def){.method = "erk:zonneveld-5-3-4", .dt_fixed = 0.5 / lambda},
          rivals, 5);
}

/* 300 steps of h/c: the energy's drift over the kinetic energy at the start, and what it costs. */
static void relaxation(const scene *s, const char *method, double c)
{
  enum { STEPS = 300 };
  double seconds[2], drift[2];
  char what[80];
  if (!bench_wanted(s->name)) return;
  for (int k = 0; k < 2; k++) {
    const sph_integrator_def def = {.method = method,
                                    .dt_fixed = 1.5 / (double)s->across / c,
                                    .relax = k ? "energy" : NULL};
    sph_sim *sim = make(s, &def, NULL);
    sph_balance first, last;
    sph_sim_evaluate(sim);
    sph_sim_balance(sim, &first);
    double begin = bench_thread_seconds();
    for (int step = 0; step < STEPS; step++) sph_sim_step(sim);
    seconds[k] = bench_thread_seconds() - begin;
    if (sph_sim_status(sim)) {
      printf("# %s: %s\n", s->name, sph_sim_error(sim));
      sph_sim_free(sim);
      return;
    }
    sph_sim_balance(sim, &last);
    drift[k] = fabs(last.total - first.total) / first.kinetic;
    sph_sim_free(sim);
  }
  snprintf(what, sizeof what, "%s/drift", method);
  tell(s, what, drift[0], "of kinetic");
  snprintf(what, sizeof what, "%s/relaxed-drift", method);
  tell(s, what, drift[1], "of kinetic");
  snprintf(what, sizeof what, "%s/cost", method);
  tell(s, what, 100 * (seconds[1] / seconds[0] - 1), "%");
}

void bench_multirate(void)
{
  if (!bench_filtered()) return;
  source();
  slow_force();
  stabilised(3);
  stabilised(10);
  stabilised(30);
  const long across = bench_quick() ? 40 : 100;
  const scene gas = {.name = "relaxation/gas", .across = across, .fill = viscous_gas};
  const scene liquid = {.name = "relaxation/liquid", .across = across, .fill = warm_water};
  relaxation(&gas, "erk:bogacki-shampine-4-2-3", 1);
  relaxation(&gas, "erk:zonneveld-5-3-4", 1);
  relaxation(&liquid, "erk:bogacki-shampine-4-2-3", 10);
  relaxation(&liquid, "erk:zonneveld-5-3-4", 10);
}
