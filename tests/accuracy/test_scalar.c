/* The scalar that diffuses (sph_term_scalar_diffusion), and the scalars of case files.
 *
 * Sine in a periodic box, 2D, on a lattice: exp(-D k^2 t) at 1/e, second order in dx with h ~ dx.
 * Slab between walls of s = 1 and 0: the linear profile, and the way there (series).  Two media:
 * the error functions of heat conduction, rho c = rho.  Between walls that give nothing sum m s
 * stays to rounding.  ds/dt = -k s against exp(-k t): order 2 of leapfrog, 4 of a Runge-Kutta
 * method.  D = 0 in Taylor-Green vortices: s is carried along, the same bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "exact.h"
#include "sphode.h"

static const double pi = 3.14159265358979323846;

static const sph_scalar dye = {.name = "dye", .unit = "1", .scale = 1};

static void run_to(sph_sim *sim, double t)
{
  if (sph_sim_run(sim, t) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
}

/* A liquid at rest, slow sound. */
static sph_group *liquid(sph_sim *sim, const char *name, const double *from, const double *to,
                         double rho)
{
  sph_group *group = sph_group_box(sim, name, from, to, rho);
  sph_group_set_eos(group, sph_eos_linear(rho, 1e-2, -INFINITY));
  return group;
}

static void add_terms(sph_sim *sim, sph_term scalar, const char *method)
{
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, scalar);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method});
}

static double total(const sph_sim *sim)
{
  const sph_group *group;
  double sum = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    const double *m = sph_group_read(group, "mass", 0), *s = sph_group_read(group, "dye", 0);
    for (long i = 0; s && i < sph_group_count(group); i++) sum += m[i] * s[i];
  }
  return sum;
}

/* ---- a sine that decays ---- */

static double sine_error(int n)
{
  const double L = 1, D = 0.01, k = 2 * pi / L, dx = L / n, end = 1 / (D * k * k);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = dx,
                                               .h_over_dx = 1.5,
                                               .periodic = {1, 1},
                                               .length = {L, 10 * dx},
                                               .speed = 0.1});
  sph_group *water = liquid(sim, "water", (double[]){0, 0}, (double[]){L, 10 * dx}, 1000);
  add_terms(sim, sph_term_scalar_diffusion(dye, D), "leapfrog");
  const double *x = sph_group_read(water, "position", 0);
  double *s = sph_group_write(water, "dye", 0), error = 0;
  for (long i = 0; i < sph_group_count(water); i++) s[i] = 1 + cos(k * x[i]);
  const double before = total(sim);
  run_to(sim, end);
  const double *now = sph_group_read(water, "dye", 0);
  x = sph_group_read(water, "position", 0);
  for (long i = 0; i < sph_group_count(water); i++)
    error = fmax(error, fabs(now[i] - 1 - cos(k * x[i]) * exp(-1)));
  assert_true(fabs(total(sim) / before - 1) <= 1e-13);
  sph_sim_free(sim);
  return error;
}

static void sine(void **state)
{
  (void)state;
  /* The lattice leaves an error in sum V r^2 F, which does not fall with dx. */
  const double coarse = sine_error(20), fine = sine_error(40), finest = sine_error(80);
  print_message("# sine: errors %.2e %.2e %.2e, order %.2f\n", coarse, fine, finest,
                log2((coarse - fine) / (fine - finest)));
  assert_true(finest <= 2e-3);
  assert_true(log2((coarse - fine) / (fine - finest)) >= 1.8);
}

/* ---- between walls ---- */

/* 1D, n particles from 0 to 1; s = 1, 0 at the walls, or closed. */
static sph_sim *between(int n, double D, int closed)
{
  const double one = 1, zero = 0;
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 1.0 / n, .h_over_dx = 1.5, .speed = 0.1});
  liquid(sim, "water", &zero, &one, 1000);
  sph_group *hot = sph_group_create(sim, "left", "wall");
  sph_group_add_layers(hot, &zero, &one, "x+", 1000);
  sph_group *cold = sph_group_create(sim, "right", "wall");
  sph_group_add_layers(cold, &zero, &one, "x-", 1000);
  sph_group_set_boundary(hot, sph_boundary_adami());
  sph_group_set_boundary(cold, sph_boundary_adami());
  sph_term term = sph_term_scalar_diffusion(dye, D);
  term.by_group = (sph_group_value[]){{"left", 1}, {"right", 0}};
  term.by_groups = closed ? 0 : 2;
  add_terms(sim, term, "leapfrog");
  return sim;
}

/* s = 1 - x - sum 2/(n pi) sin(n pi x) exp(-n^2 pi^2 D t) from s = 0. */
static double slab_exact(double x, double Dt)
{
  double s = 1 - x;
  for (int n = 1; n < 200; n++) s -= 2 / (n * pi) * sin(n * pi * x) * exp(-n * n * pi * pi * Dt);
  return s;
}

static double slab_error(int n, double Dt)
{
  const double D = 0.1;
  sph_sim *sim = between(n, D, 0);
  run_to(sim, Dt / D);
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *s = sph_group_read(water, "dye", 0);
  double most = 0;
  for (long i = 0; i < sph_group_count(water); i++)
    most = fmax(most, fabs(s[i] - slab_exact(x[i], Dt)));
  sph_sim_free(sim);
  return most;
}

static void slab(void **state)
{
  (void)state;
  const double early = slab_error(50, 0.05), late = slab_error(50, 1), fine = slab_error(100, 0.05);
  print_message("# slab, 50: largest error %.2e, at last %.2e; 100: %.2e\n", early, late, fine);
  assert_true(early <= 0.01 && late <= 0.01);
  assert_true(fine <= 0.6 * early);
}

static void closed(void **state)
{
  (void)state;
  sph_sim *sim = between(50, 0.1, 1);
  sph_group *water = sph_sim_group(sim, "water");
  double *s = sph_group_write(water, "dye", 0);
  for (long i = 0; i < 10; i++) s[i] = 1;
  const double before = total(sim);
  run_to(sim, 10);
  print_message("# closed: sum m s changed by %.1e of itself\n", total(sim) / before - 1);
  assert_true(fabs(total(sim) / before - 1) <= 1e-13);
  const double *now = sph_group_read(water, "dye", 0);
  for (long i = 0; i < sph_group_count(water); i++) assert_true(fabs(now[i] - 0.2) <= 1e-3);
  sph_sim_free(sim);
}

/* rho D takes the place of kappa, rho that of rho c. */
static double media_error(int n)
{
  const double D[2] = {0.01, 0.05}, rho[2] = {1000, 800}, end = 0.5;
  const sph_exact_heat_step exact = {{1, rho[0] * D[0], rho[0]}, {0, rho[1] * D[1], rho[1]}};
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 1.0 / n, .h_over_dx = 1.5, .speed = 0.1});
  liquid(sim, "left", (double[]){-1}, (double[]){0}, rho[0]);
  liquid(sim, "right", (double[]){0}, (double[]){1}, rho[1]);
  sph_term term = sph_term_scalar_diffusion(dye, D[0]);
  term.by_group = &(sph_group_value){"right", D[1]};
  term.by_groups = 1;
  add_terms(sim, term, "leapfrog");
  double *s = sph_group_write(sph_sim_group(sim, "left"), "dye", 0);
  for (long i = 0; i < n; i++) s[i] = 1;
  const double before = total(sim);
  run_to(sim, end);
  assert_true(fabs(total(sim) / before - 1) <= 1e-13);
  double most = 0, s_x;
  const sph_group *group;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    const double *x = sph_group_read(group, "position", 0), *now = sph_group_read(group, "dye", 0);
    for (long i = 0; i < sph_group_count(group); i++) {
      if (fabs(x[i]) > 0.5) continue;
      sph_exact_heat_step_at(&exact, end, 1, &x[i], &s_x, NULL);
      most = fmax(most, fabs(now[i] - s_x));
    }
  }
  sph_sim_free(sim);
  return most;
}

static void two_media(void **state)
{
  (void)state;
  const double coarse = media_error(50), fine = media_error(100);
  print_message("# two media: largest errors %.2e, %.2e\n", coarse, fine);
  assert_true(fine <= 0.01 && fine <= 0.6 * coarse);
}

/* ---- a source, and nothing but the flow ---- */

static int decays(const sph_term *term, const sph_particles *particles)
{
  const double rate = *(const double *)term->ctx;
  for (long i = 0; i < particles->n; i++) particles->ds[i] -= rate * particles->s[i];
  return SPH_OK;
}

static double source_error(const char *method, double dt)
{
  static double rate = 2;
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 1, .dx = 0.1, .periodic = {1}, .length = {1}, .speed = 0.1});
  sph_group *water = liquid(sim, "water", (double[]){0}, (double[]){1}, 1000);
  sph_term term = sph_term_scalar_diffusion(dye, 0);
  term.body = decays;
  term.ctx = &rate;
  add_terms(sim, term, method);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .dt_fixed = dt});
  double *s = sph_group_write(water, "dye", 0);
  for (long i = 0; i < sph_group_count(water); i++) s[i] = 1;
  run_to(sim, 1);
  const double error = fabs(sph_group_read(water, "dye", 0)[3] - exp(-rate));
  sph_sim_free(sim);
  return error;
}

static void source(void **state)
{
  (void)state;
  static const struct {
    const char *method;
    double order;
  } row[] = {{"leapfrog", 2}, {"erk:bogacki-shampine-4-2-3", 3}, {"erk:zonneveld-5-3-4", 4}};
  for (int k = 0; k < 3; k++) {
    const double order = log2(source_error(row[k].method, 0.1) / source_error(row[k].method, 0.05));
    print_message("# ds/dt = -k s, %s: order %.2f\n", row[k].method, order);
    assert_true(fabs(order - row[k].order) <= 0.3);
  }
}

static void carried(void **state)
{
  (void)state;
  const int n = 24;
  const double L = 1, k = 2 * pi, dx = L / n;
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 2, .dx = dx, .periodic = {1, 1}, .length = {L, L}, .speed = 1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){L, L}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_group_jitter(water, 0.2, 1);
  add_terms(sim, sph_term_scalar_diffusion(dye, 0), "leapfrog");
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  double *vx = sph_group_write(water, "velocity", 0), *vy = sph_group_write(water, "velocity", 1);
  double *s = sph_group_write(water, "dye", 0), at_start[24 * 24];
  for (long i = 0; i < n * n; i++) {
    vx[i] = -cos(k * x[i]) * sin(k * y[i]);
    vy[i] = sin(k * x[i]) * cos(k * y[i]);
    at_start[i] = s[i] = x[i] < L / 2 ? 0.1 : 0.7;
  }
  const double x_start = x[0];
  run_to(sim, 0.3);
  assert_true(fabs(sph_group_read(water, "position", 0)[0] - x_start) > dx / 10);
  assert_memory_equal(sph_group_read(water, "dye", 0), at_start, sizeof at_start);
  sph_sim_free(sim);
}

/* ---- of a case file ---- */

static const char salt[] = "dimension: 1\n"
                           "parameters: {k: 3 1/s, start: 0.2 mol/kg}\n"
                           "spacing: 0.02 m\n"
                           "groups:\n"
                           "  left: {kind: fluid, density: 1000 kg/m^3,\n"
                           "    eos: {linear: {sound_speed: 1e-2 m/s}},\n"
                           "    shapes: [box: {lower: [-1 m], upper: [0 m]}]}\n"
                           "  right: {kind: fluid, density: 800 kg/m^3,\n"
                           "    eos: {linear: {sound_speed: 1e-2 m/s}},\n"
                           "    shapes: [box: {lower: [0 m], upper: [1 m]}]}\n"
                           "  end: {kind: wall, density: 1000 kg/m^3,\n"
                           "    shapes: [layers: {lower: [-1 m], upper: [1 m], open: [x+]}]}\n"
                           "terms: {continuity: , pressure: }\n"
                           "scalars:\n"
                           "  salt:\n"
                           "    unit: mol/kg\n"
                           "    diffusivity: 0.01 m^2/s\n"
                           "    initial: start*x^2/(1 m^2)\n"
                           "    source: k*(start - salt)*density/(900 kg/m^3) + speed*0 mol/kg/m\n"
                           "    fluids: {right: {diffusivity: 0.05 m^2/s, initial: start}}\n"
                           "    walls: {end: {value: 0.3 mol/kg}}\n"
                           "integrator: {dt_fixed: 2 ms, method: leapfrog}\n"
                           "run: {end: 1 s}\n";

static int sinks(const sph_term *term, const sph_particles *p)
{
  (void)term;
  for (long i = 0; i < p->n; i++) p->ds[i] += 3 * (0.2 - p->s[i]) * p->rho[i] / 900;
  return SPH_OK;
}

static sph_sim *salt_in_c(void)
{
  const double from = -1, zero = 0, to = 1;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.02});
  sph_group *left = liquid(sim, "left", &from, &zero, 1000);
  sph_group *right = liquid(sim, "right", &zero, &to, 800);
  sph_group *end = sph_group_create(sim, "end", "wall");
  sph_group_add_layers(end, &from, &to, "x+", 1000);
  sph_group_set_boundary(end, sph_boundary_adami());
  sph_term term =
      sph_term_scalar_diffusion((sph_scalar){.name = "salt", .unit = "mol/kg", .scale = 0.3}, 0.01);
  term.by_group = (sph_group_value[]){{"right", 0.05}, {"end", 0.3}};
  term.by_groups = 2;
  term.body = sinks;
  add_terms(sim, term, "leapfrog");
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog", .dt_fixed = 2e-3});
  double *s = sph_group_write(left, "salt", 0), *other = sph_group_write(right, "salt", 0);
  const double *x = sph_group_read(left, "position", 0);
  for (long i = 0; i < 50; i++) s[i] = 0.2 * x[i] * x[i], other[i] = 0.2;
  return sim;
}

static void of_a_case(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_case *c = sph_case_read_text("salt.yml", salt, strlen(salt), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  sph_sim *sim[2] = {sph_case_build(c, 1, &error), salt_in_c()};
  if (!sim[0]) fail_msg("%s", error.text);
  for (int k = 0; k < 2; k++) run_to(sim[k], 1);
  for (int g = 0; g < 2; g++) {
    const char *name = g ? "right" : "left";
    const double *a = sph_group_read(sph_sim_group(sim[0], name), "salt", 0);
    const double *b = sph_group_read(sph_sim_group(sim[1], name), "salt", 0);
    for (long i = 0; i < 50; i++)
      if (!(fabs(a[i] - b[i]) <= 1e-14)) fail_msg("%s %ld: %.17g, %.17g", name, i, a[i], b[i]);
  }
  const double *s = sph_group_read(sph_sim_group(sim[0], "left"), "salt", 0);
  assert_true(s[0] > 0.25 && s[49] < 0.2);
  sph_sim_free(sim[0]), sph_sim_free(sim[1]);
  sph_case_free(c);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sine),      cmocka_unit_test(slab),   cmocka_unit_test(closed),
      cmocka_unit_test(two_media), cmocka_unit_test(source), cmocka_unit_test(carried),
      cmocka_unit_test(of_a_case),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
