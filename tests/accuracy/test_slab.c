/* Heat: a slab between walls of given temperature ends at the straight line between them, in two
 * media at that of a constant flux; walls without temperature keep all heat; sources heat at their
 * power, whether a C function or an expression of a case file. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

static const double c_v = 2, rho0 = 3; /* [J/(kg K)], [kg/m^dim] */

/* A medium that does not flow: no pressure. */
static sph_group *medium(sph_sim *sim, const char *name, double from, double to, double kappa)
{
  double lo[3] = {from, 0, 0}, hi[3] = {to, 1, 1};
  hi[1] = 8 * sph_sim_dx(sim);
  sph_group *group = sph_group_box(sim, name, lo, hi, rho0);
  sph_eos eos = sph_eos_linear(rho0, 10, -INFINITY);
  eos.c_v = c_v;
  sph_group_set_eos(group, eos);
  sph_group_set_conductivity(group, kappa);
  sph_group_set_energy(group, "temperature");
  return group;
}

/* Behind x = 0 (left) or x = 1; T = 0: adiabatic. */
static void wall(sph_sim *sim, int left, double T)
{
  const double dx = sph_sim_dx(sim), thick = 4 * dx;
  double lo[3] = {left ? -thick : 1, 0, 0}, hi[3] = {left ? 0 : 1 + thick, 8 * dx, 0};
  sph_group *group = sph_group_create(sim, left ? "left" : "right", "wall");
  sph_group_add_box(group, lo, hi, rho0);
  sph_boundary boundary = sph_boundary_adami();
  boundary.temperature = T;
  sph_group_set_boundary(group, boundary);
}

/* n across, media kappa and kappa2 halfway (0: one medium), from T(x). */
static sph_sim *slab(int dim, int n, double kappa, double kappa2, double left, double right,
                     double (*T)(double x))
{
  sph_sim_def def = {.dim = dim, .dx = 1.0 / n, .speed = 1};
  if (dim > 1) def.periodic[1] = 1, def.length[1] = 8 * def.dx;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *group[2] = {medium(sim, "a", 0, kappa2 > 0 ? 0.5 : 1, kappa), NULL};
  if (kappa2 > 0) group[1] = medium(sim, "b", 0.5, 1, kappa2);
  wall(sim, 1, left), wall(sim, 0, right);
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-4});
  assert_string_equal(sph_sim_error(sim), "");
  for (int g = 0; g < 2; g++) {
    const double *x = sph_group_read(group[g], "position", 0);
    double *u = sph_group_write(group[g], "energy", 0);
    for (long i = 0; i < sph_group_count(group[g]); i++) u[i] = T(x[i]) * c_v;
  }
  return sim;
}

static double uniform(double x) { return 300 + 0 * x; }
static double line(double x) { return 250 + 100 * x; }
/* kappa = 1 and 10: 10/11 of the difference over the first half. */
static double bent(double x) { return x < 0.5 ? 250 + 2000 * x / 11 : 350 - 200 * (1 - x) / 11; }

/* Largest |T - T_exact|/100 K after a run towards the steady state, walls of 250 K and 350 K. */
static double steady(int dim, int n, double kappa2, double (*start)(double x), double end)
{
  sph_sim *sim = slab(dim, n, 1, kappa2, 250, 350, start);
  double worst = 0;
  if (sph_sim_run(sim, end * rho0 * c_v) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  for (int g = 0; g < 1 + (kappa2 > 0); g++) {
    sph_group *group = sph_sim_group(sim, g ? "b" : "a");
    const double *x = sph_group_read(group, "position", 0);
    const double *T = sph_group_read(group, "temperature", 0);
    for (long i = 0; i < sph_group_count(group); i++)
      worst = fmax(worst, fabs(T[i] - (kappa2 > 0 ? bent(x[i]) : line(x[i]))) / 100);
  }
  print_message("# %dD, %d across, %d media: steady to %.2g of the difference\n", dim, n,
                1 + (kappa2 > 0), worst);
  sph_sim_free(sim);
  return worst;
}

/* The mean of wall and fluid lies on the surface to first order.  Two media with kappa 1:10: 2e-3
 * by the harmonic mean, 1.7e-2 by the arithmetic one (measured elsewhere). */
static void steady_slab(void **state)
{
  (void)state;
  double coarse = steady(1, 20, 0, uniform, 1.5), fine = steady(1, 40, 0, uniform, 1.5);
  double wide = steady(2, 20, 0, uniform, 1.5);
  assert_true(coarse <= 2e-3 && fine <= 0.6 * coarse && wide <= 2e-3);
  assert_true(steady(1, 80, 10, bent, 0.3) <= 2.5e-3);
}

/* Walls without a temperature take nothing, and T evens out. */
static double step(double x) { return x < 0.5 ? 250 : 350; }
static void adiabatic(void **state)
{
  (void)state;
  sph_sim *sim = slab(2, 20, 1, 3, 0, 0, step);
  if (sph_sim_run(sim, 2 * rho0 * c_v) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  double heat = 0, worst = 0;
  long n = 0;
  for (int g = 0; g < 2; g++) {
    sph_group *group = sph_sim_group(sim, g ? "b" : "a");
    const double *T = sph_group_read(group, "temperature", 0);
    for (long i = 0; i < sph_group_count(group); i++, n++)
      heat += T[i] / 300 - 1, worst = fmax(worst, fabs(T[i] - 300));
  }
  print_message("# adiabatic: mean T off by %.2g, all within %.2g K\n", heat / (double)n, worst);
  assert_true(fabs(heat) / (double)n <= 1e-12 && worst < 1e-3);
  sph_sim_free(sim);
}

/* ---- sources ---- */

static double constant(void *ctx, const double x[3], double t)
{
  (void)x, (void)t;
  return *(const double *)ctx;
}

static double varying(void *ctx, const double x[3], double t)
{
  (void)ctx;
  return 5 + 3 * sin(2 * x[0]) * cos(x[1]) + 7 * t * t;
}

/* Every energy rises by Q t, T by Q t/c_v: liquids and gases, in a run. */
static void uniform_source(void **state)
{
  (void)state;
  static const char *const energy[] = {"u", "temperature", "u", "total", "entropy", "temperature"};
  for (int k = 0; k < 6; k++) {
    double Q = 40, worst = 0;
    const double lo[] = {0, 0}, hi[] = {1, 1};
    sph_sim *sim = sph_sim_create(
        &(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1, 1}, .speed = 1});
    sph_group *box = sph_group_box(sim, "box", lo, hi, rho0);
    sph_eos eos = k < 2 ? sph_eos_linear(rho0, 10, -INFINITY) : sph_eos_ideal_gas(1.4);
    eos.c_v = c_v;
    sph_group_set_eos(box, eos);
    sph_group_set_energy(box, energy[k]);
    sph_sim_add_term(sim, sph_term_continuity_form("c1"));
    sph_sim_add_term(sim, sph_term_pressure_form("s"));
    sph_sim_add_term(sim, sph_term_heat_source(constant, &Q));
    double *u = sph_group_write(box, "energy", 0);
    for (long i = 0; u && i < sph_group_count(box); i++) u[i] = 10;
    if (sph_sim_run(sim, 0.25) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
    const double *end = sph_group_read(box, "energy", 0),
                 *T = sph_group_read(box, "temperature", 0);
    for (long i = 0; i < sph_group_count(box); i++)
      worst = fmax(worst, fmax(fabs(end[i] / 20 - 1), fabs(T[i] * c_v / 20 - 1)));
    if (!(worst <= 1e-12)) fail_msg("%s: off by %g", energy[k], worst);
    sph_sim_free(sim);
  }
}

static const char heated[] = "dimension: 2\n"
                             "spacing: 0.1 m\n"
                             "groups:\n"
                             "  box:\n"
                             "    kind: fluid\n"
                             "    density: 3 kg/m^3\n"
                             "    eos: {linear: {sound_speed: 10 m/s}}\n"
                             "    energy: u\n"
                             "    shapes: [box: {lower: [0, 0], upper: [1, 1]}]\n"
                             "terms:\n"
                             "  heat-source: {power: 5 W/kg + 3 W/kg*sin(2*x/(1 m))*cos(y/(1 m)) + "
                             "7 W/kg*(t/(1 s))^2}\n"
                             "run: {end: 1 s}\n";

/* The same expression in C and in a case file: the same heat in a run, and that of the integral
 * over t where nothing moves. */
static void source_of_a_case(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_case *c = sph_case_read_text("heated.yml", heated, strlen(heated), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  sph_sim *sim[2] = {sph_case_build(c, 1, &error),
                     sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1})};
  if (!sim[0]) fail_msg("%s", error.text);
  sph_group *box = sph_group_box(sim[1], "box", (double[]){0, 0}, (double[]){1, 1}, rho0);
  sph_group_set_eos(box, sph_eos_linear(rho0, 10, -INFINITY));
  sph_group_set_energy(box, "u");
  sph_sim_add_term(sim[1], sph_term_heat_source(varying, NULL));
  const double *u[2] = {NULL, NULL};
  for (int k = 0; k < 2; k++) {
    sph_sim_set_integrator(sim[k], &(sph_integrator_def){.dt_fixed = 1.0 / 64});
    if (sph_sim_run(sim[k], 1) != SPH_OK) fail_msg("%s", sph_sim_error(sim[k]));
    u[k] = sph_group_read(sph_sim_group(sim[k], "box"), "energy", 0);
  }
  const double *x = sph_group_read(box, "position", 0), *y = sph_group_read(box, "position", 1);
  for (long i = 0; i < 100; i++) {
    double exact = 5 + 3 * sin(2 * x[i]) * cos(y[i]) + 7.0 / 3; /* order 3 takes t^2 exactly */
    assert_true(fabs(u[0][i] - u[1][i]) <= 1e-14 * exact && fabs(u[1][i] - exact) <= 1e-12 * exact);
  }
  sph_sim_free(sim[0]), sph_sim_free(sim[1]);
  sph_case_free(c);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(steady_slab),
      cmocka_unit_test(adiabatic),
      cmocka_unit_test(uniform_source),
      cmocka_unit_test(source_of_a_case),
  };
  return cmocka_run_group_tests_name("slabs and sources", tests, NULL, NULL);
}
