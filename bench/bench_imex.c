/* Implicit-explicit integrators against explicit ones, where viscosity or conduction is stiff.
 *
 * Flow: Kolmogorov's, u = U sin(ky) held up by a body force, with a second wave across it that
 * decays, on a periodic lattice off its places by up to 0.1 dx; Wendland C2, h = 1.5 dx, c0 = 10 U,
 * Morris' viscosity, over 3 h/c0.  `ratio` is that of the steps: 0.5 h/c0 of the implicit-explicit
 * run over 2.3/lambda, where Bogacki and Shampine's pair is just stable, lambda = 6.5 nu/h^2 (3D:
 * 6.9) the largest rate of the viscosity of a lattice.
 *
 * Slab: two media at rest, conductivities 1 : 10, between walls of given temperatures.
 *
 * Errors are those of velocities (temperatures), rms over U (the range), against Dormand and
 * Prince's pair of order 5 in the explicit run's steps.  Seconds are those of one thread. */
#include <math.h>
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

enum { REPEATS = 5 };

static const double PI = 3.14159265358979323846;

/* What is run, and how; values of one run. */
typedef struct problem {
  const char *name;
  int dim, across;
  double ratio;
  double dt_explicit, dt_implicit, end, scale; /* [s]; of the errors */
  sph_sim *(*make)(const struct problem *p, const sph_integrator_def *def);
  const char *field;
  int components;
  double viscosity; /* nu [m^2/s] */
  double tolerance; /* of the adaptive run; 0: the default */
} problem;

typedef struct result {
  double seconds;
  long n, steps, iterations;
  double *field; /* [n] */
} result;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

/* ---- the flow */

static const double U = 1, c0 = 10, rho0 = 1000; /* [m/s], [m/s], [kg/m^3] */

static int push(const sph_term *term, const sph_particles *p)
{
  const double nu = *(const double *)term->ctx, k = 2 * PI;
  for (long i = 0; i < p->n; i++) p->a[0][i] += nu * k * k * U * sin(k * p->x[1][i]);
  return SPH_OK;
}

static sph_sim *make_flow(const problem *p, const sph_integrator_def *def)
{
  const double dx = 1.0 / p->across, k = 2 * PI, hi[3] = {1, 1, 1};
  unsigned state = 1;
  sph_sim_def sim_def = {.dim = p->dim, .dx = dx, .h_over_dx = 1.5, .speed = U};
  for (int d = 0; d < p->dim; d++) sim_def.periodic[d] = 1, sim_def.length[d] = 1;
  sph_sim *sim = sph_sim_create(&sim_def);
  sph_group *fluid = sph_group_box(sim, "fluid", (double[3]){0}, hi, rho0);
  sph_group_set_eos(fluid, sph_eos_tait(rho0, c0, 7));
  sph_group_set_viscosity(fluid, rho0 * p->viscosity);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(
      sim, (sph_term){.name = "push", .body = push, .reads = "", .ctx = (void *)&p->viscosity});
  sph_sim_set_integrator(sim, def);
  double *x[3], *v[3];
  for (int d = 0; d < p->dim; d++) {
    x[d] = sph_group_write(fluid, "position", d);
    v[d] = sph_group_write(fluid, "velocity", d);
  }
  for (long i = 0; !sph_sim_status(sim) && i < sph_group_count(fluid); i++) {
    v[0][i] = U * sin(k * x[1][i]);
    v[1][i] = 0.3 * U * sin(k * x[0][i]);
    for (int d = 0; d < p->dim; d++) x[d][i] += 0.2 * dx * noise(&state);
  }
  return sim;
}

static problem flow(const char *name, int dim, int across, double ratio)
{
  const double h = 1.5 / across, largest = dim == 3 ? 6.9 : 6.5; /* of nu/h^2 */
  problem p = {.name = name, .dim = dim, .across = across, .ratio = ratio, .scale = U};
  p.make = make_flow;
  p.field = "velocity";
  p.components = dim;
  p.dt_implicit = 0.5 * h / c0;
  p.dt_explicit = p.dt_implicit / ratio;
  p.end = 3 * h / c0;
  p.viscosity = 2.3 * h * h / largest / p.dt_explicit;
  return p;
}

/* ---- the slab */

static const double kappa[] = {1, 10}, c_v = 2, rho_slab = 3, cold = 250, hot = 350;

static void add_medium(sph_sim *sim, const char *name, double from, double T)
{
  sph_group *group =
      sph_group_box(sim, name, (double[]){from, 0}, (double[]){from + 0.5, 1}, rho_slab);
  sph_eos eos = sph_eos_linear(rho_slab, 10, -INFINITY);
  eos.c_v = c_v;
  sph_group_set_eos(group, eos);
  sph_group_set_conductivity(group, kappa[from > 0]);
  sph_group_set_energy(group, "temperature");
  double *u = sph_group_write(group, "energy", 0);
  for (long i = 0; u && i < sph_group_count(group); i++) u[i] = c_v * T;
}

static void add_wall(sph_sim *sim, const char *name, double from, double T)
{
  const double thick = 4 * sph_sim_dx(sim);
  sph_group *group = sph_group_create(sim, name, "wall");
  sph_group_add_box(group, (double[]){from, 0}, (double[]){from + thick, 1}, rho_slab);
  sph_boundary boundary = sph_boundary_adami();
  boundary.temperature = T;
  sph_group_set_boundary(group, boundary);
}

static sph_sim *make_slab(const problem *p, const sph_integrator_def *def)
{
  const double dx = 1.0 / p->across;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = dx, .h_over_dx = 1.5, .periodic = {0, 1}, .length = {0, 1}, .speed = 1});
  add_medium(sim, "a", 0, cold);
  add_medium(sim, "b", 0.5, hot);
  add_wall(sim, "left", -4 * dx, cold);
  add_wall(sim, "right", 1, hot);
  sph_sim_set_scale(sim, NULL, "temperature", hot - cold);
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_integrator(sim, def);
  return sim;
}

static problem slab(const char *name, int across)
{
  const double h = 1.5 / across, alpha = kappa[1] / (rho_slab * c_v);
  problem p = {.name = name, .dim = 2, .across = across, .scale = hot - cold};
  p.make = make_slab;
  p.field = "temperature";
  p.components = 1;
  p.dt_explicit = 2.3 * h * h / (6.5 * alpha);
  p.end = 0.1;
  p.dt_implicit = p.end / 10;
  p.ratio = p.dt_implicit / p.dt_explicit;
  p.tolerance = 5e-4;
  return p;
}

/* ---- running */

static void copy_field(sph_sim *sim, const problem *p, result *r)
{
  sph_group *group;
  long n = 0;
  for (int g = 0; (group = sph_sim_group_get(sim, g)); g++) n += sph_group_count(group);
  r->field = calloc((size_t)(3 * n), sizeof(double));
  for (int g = 0; r->field && (group = sph_sim_group_get(sim, g)); g++)
    for (int d = 0; d < 3; d++) {
      const double *from = d < p->components ? sph_group_read(group, p->field, d) : NULL;
      for (long i = 0; from && i < sph_group_count(group); i++) r->field[r->n++] = from[i];
    }
}

static result run(const problem *p, const sph_integrator_def *def)
{
  result r = {0};
  sph_sim *sim = p->make(p, def);
  double begin = bench_thread_seconds();
  if (sph_sim_run(sim, p->end)) bench_complain("%s", sph_sim_error(sim));
  r.seconds = bench_thread_seconds() - begin;
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  r.steps = stats.step.steps;
  if (getenv("DBG")) {
    fprintf(stderr, "rej %ld rhs %ld impl %ld solves %ld dt %g..%g last %g bounds",
            stats.step.rejected, stats.step.rhs_evaluations, stats.step.implicit_evaluations,
            stats.step.solves, stats.step.dt_smallest / p->dt_implicit,
            stats.step.dt_largest / p->dt_implicit, stats.step.dt_last / p->dt_implicit);
    for (int q = 0; q < 8; q++) fprintf(stderr, " %ld", stats.step.bound_by[q]);
    fprintf(stderr, " builds %ld\n", stats.list_builds);
  }
  r.iterations = stats.step.solve_iterations;
  copy_field(sim, p, &r);
  sph_sim_free(sim);
  return r;
}

static double distance(const problem *p, const result *a, const result *b)
{
  double sum = 0;
  for (long i = 0; i < a->n && i < b->n; i++) sum += pow(a->field[i] - b->field[i], 2);
  return sqrt(sum * p->components / (double)a->n) / p->scale;
}

static void report(const problem *p, const char *what, const char *unit, double *values, int n)
{
  char text[120];
  snprintf(text, sizeof text, "%s/%.0f/%s", p->name, p->ratio, what);
  bench_report(text, unit, values, n);
}

static void measure_one(const problem *p, const char *what, const sph_integrator_def *def,
                        const result *explicit, const result *reference)
{
  double seconds[REPEATS];
  char text[60];
  result r = {0};
  for (int k = 0; k < REPEATS; k++) {
    free(r.field);
    r = run(p, def);
    seconds[k] = r.seconds;
  }
  report(p, what, "s", seconds, REPEATS);
  for (int k = 0; k < REPEATS; k++) seconds[k] = explicit->seconds / seconds[k];
  snprintf(text, sizeof text, "%s/times", what);
  report(p, text, "", seconds, REPEATS);
  double figure[] = {distance(p, &r, reference), (double)r.steps, (double)r.iterations};
  static const char *const name[] = {"error", "steps", "iterations"};
  for (int k = 0; k < 3; k++) {
    snprintf(text, sizeof text, "%s/%s", what, name[k]);
    report(p, text, "", &figure[k], 1);
  }
  free(r.field);
}

static void measure(const problem *p)
{
  char name[100];
  snprintf(name, sizeof name, "%s/%.0f/", p->name, p->ratio);
  if (!bench_wanted(name)) return;
  const char *pair = "imex:ark324l2sa-4-2-3";
  result reference = run(p, &(sph_integrator_def){.method = "erk:dormand-prince-7-4-5",
                                                  .dt_fixed = p->dt_explicit});
  result explicit = run(p, &(sph_integrator_def){.method = "erk:bogacki-shampine-4-2-3",
                                                 .dt_fixed = p->dt_explicit});
  double error = distance(p, &explicit, &reference);
  report(p, "explicit", "s", &explicit.seconds, 1);
  report(p, "explicit/error", "", &error, 1);
  measure_one(p, "adaptive", &(sph_integrator_def){.method = pair, .tolerance = p->tolerance},
              &explicit, &reference);
  measure_one(p, "fixed",
              &(sph_integrator_def){.method = pair,
                                    .dt_fixed = p->dt_implicit,
                                    .stage_tolerance = 5e-5},
              &explicit, &reference);
  free(reference.field), free(explicit.field);
}

void bench_imex(void)
{
  if (!bench_filtered()) return; /* minutes */
  static const double ratio[] = {24, 118, 590};
  for (int k = 0; k < 3; k++) {
    problem p = flow("imex/2d/10000", 2, 100, ratio[k]);
    measure(&p);
  }
  problem p = flow("imex/3d/27000", 3, 30, 118);
  measure(&p);
  p = slab("imex/slab/10000", 100);
  measure(&p);
}
