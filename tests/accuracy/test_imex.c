/* Runs with implicit viscosity and conduction, with steps far beyond their explicit limits: a shear
 * flow against a tight explicit run, plates and slabs against exact solutions, what is conserved,
 * the same bits for any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "sphode.h"

static const char *const imex = "imex:ark324l2sa-4-2-3", *const erk = "erk:bogacki-shampine-4-2-3";
static const double pi = 3.14159265358979323846;

static void run(sph_sim *sim, double end)
{
  if (sph_sim_run(sim, end) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
}

static long steps_of(const sph_sim *sim)
{
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  return stats.step.steps;
}

/* ---- Kolmogorov's shear flow: v_x = sin(2 pi y), everywhere periodic ---- */

static const double c0 = 10;

/* The acoustic step limit h/c is `ratio` times the viscous one, 0.125 h^2/nu. */
static sph_sim *shear(int n, double ratio, const char *form, const sph_integrator_def *def,
                      int threads)
{
  const double dx = 1.0 / n, h = 1.5 * dx;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = dx, .periodic = {1, 1}, .length = {1, 1}, .speed = 1, .threads = threads});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1);
  sph_group_jitter(water, 0.05, 1);
  sph_group_set_eos(water, sph_eos_tait(1, c0, 7));
  sph_group_set_viscosity(water, ratio * 0.125 * h * c0);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar(form));
  sph_sim_set_integrator(sim, def);
  const double *y = sph_group_read(water, "position", 1);
  double *vx = sph_group_write(water, "velocity", 0), *vy = sph_group_write(water, "velocity", 1);
  for (long i = 0; i < sph_group_count(water); i++)
    vx[i] = sin(2 * pi * y[i]), vy[i] = 0.1 * cos(2 * pi * y[i]);
  return sim;
}

static double difference(const sph_sim *a, const sph_sim *b, const char *field)
{
  const sph_group *left = sph_sim_group(a, "water"), *right = sph_sim_group(b, "water");
  double sum = 0;
  long n = sph_group_count(left);
  for (int d = 0; d < 2; d++) {
    const double *x = sph_group_read(left, field, d), *y = sph_group_read(right, field, d);
    for (long i = 0; i < n; i++) sum += (x[i] - y[i]) * (x[i] - y[i]);
  }
  return sqrt(sum / (double)n);
}

static void shear_flow(void **state)
{
  (void)state;
  static const char *const forms[] = {"morris", "mcg"};
  const double h = 1.5 / 32, dt = 0.5 * h / c0;
  for (int k = 0; k < 2; k++) {
    sph_sim *tight =
        shear(32, 24, forms[k], &(sph_integrator_def){.method = erk, .tolerance = 1e-5}, 1);
    sph_sim *fast =
        shear(32, 24, forms[k], &(sph_integrator_def){.method = imex, .dt_fixed = dt}, 1);
    run(tight, 6 * dt);
    run(fast, 6 * dt);
    double v = difference(tight, fast, "velocity");
    print_message("# %s: %ld and %ld steps, velocities differ by %.2g\n", forms[k], steps_of(tight),
                  steps_of(fast), v);
    assert_true(v <= 5e-4 && steps_of(fast) == 6 && steps_of(tight) > 60);
    sph_sim_free(tight);
    sph_sim_free(fast);
  }
}

static void momentum(void **state)
{
  (void)state;
  sph_sim *sim = shear(32, 100, "morris", &(sph_integrator_def){.method = imex}, 1);
  sph_balance before, after;
  sph_sim_balance(sim, &before);
  run(sim, 20 * 1.5 / 32 / c0);
  sph_sim_balance(sim, &after);
  for (int d = 0; d < 2; d++)
    assert_true(fabs(after.momentum[d] - before.momentum[d]) <= 1e-12); /* of 1 kg and 1 m/s */
  assert_true(after.kinetic < 0.5 * before.kinetic && steps_of(sim) < 100);
  sph_sim_free(sim);
}

/* ---- a gas that heats itself by friction: m (u + v^2/2) is kept ---- */

static sph_sim *hot(int n, const char *energy, int threads, double tolerance)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = 1.0 / n, .periodic = {1, 1}, .length = {1, 1}, .threads = threads});
  sph_group *gas = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1);
  sph_group_jitter(gas, 0.1, 2);
  sph_eos eos = sph_eos_ideal_gas(1.4);
  eos.c_v = 1;
  sph_group_set_eos(gas, eos);
  sph_group_set_energy(gas, energy);
  sph_group_set_viscosity(gas, 2);
  sph_group_set_conductivity(gas, 1);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  sph_sim_set_part(sim, "viscosity-artificial", "implicit");
  sph_sim_set_part(sim, "conduction", "implicit");
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = imex, .tolerance = tolerance});
  const double *y = sph_group_read(gas, "position", 1);
  double *v = sph_group_write(gas, "velocity", 0), *u = sph_group_write(gas, "energy", 0);
  for (long i = 0; i < sph_group_count(gas); i++)
    v[i] = sin(2 * pi * y[i]), u[i] = 2 + cos(2 * pi * y[i]);
  return sim;
}

static void energy(void **state)
{
  (void)state;
  static const char *const energies[] = {"total", "u", "entropy", "temperature"};
  /* Linear invariants are kept to rounding, v^2/2 beside another energy to the step's error. */
  static const double bar[] = {1e-12, 1e-4, 1e-4, 1e-4};
  for (int k = 0; k < 4; k++) {
    sph_sim *sim = hot(24, energies[k], 1, k == 0 ? 0 : 1e-4);
    sph_balance before, after;
    sph_sim_balance(sim, &before);
    run(sim, 0.1);
    sph_sim_balance(sim, &after);
    double drift = fabs(after.total / before.total - 1);
    print_message("# %s: %ld steps, energy to %.2g, heated by %.2g of motion\n", energies[k],
                  steps_of(sim), drift, (before.kinetic - after.kinetic) / before.kinetic);
    assert_true(drift <= bar[k] && after.kinetic < 0.1 * before.kinetic);
    sph_sim_free(sim);
  }
}

/* So many particles that every loop over them has its threads. */
static void threads(void **state)
{
  (void)state;
  static const char *const fields[] = {"position", "velocity", "density", "energy"};
  sph_sim *one = hot(72, "u", 1, 1e-3);
  run(one, 0.02);
  for (int n = 2; n <= 3; n++) {
    sph_sim *more = hot(72, "u", n, 1e-3);
    run(more, 0.02);
    for (int k = 0; k < 4; k++)
      for (int d = 0; d < (k < 2 ? 2 : 1); d++) {
        const sph_group *a = sph_sim_group(one, "water"), *b = sph_sim_group(more, "water");
        assert_memory_equal(sph_group_read(a, fields[k], d), sph_group_read(b, fields[k], d),
                            (size_t)sph_group_count(a) * sizeof(double));
      }
    sph_sim_free(more);
  }
  assert_true(steps_of(one) > 1);
  sph_sim_free(one);
}

/* ---- Couette at Re = 0.01 ---- */

static void slide(void *ctx, double t, double displacement[3], double velocity[3],
                  double acceleration[3])
{
  (void)ctx, (void)t;
  for (int d = 0; d < 3; d++) displacement[d] = velocity[d] = acceleration[d] = 0;
  velocity[0] = 1;
}

static sph_sim *channel(int n, double nu, const char *method, double tolerance)
{
  const double dx = 1.0 / n, width = 12 * dx, lo[] = {0, 0}, hi[] = {width, 1};
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 2, .dx = dx, .periodic = {1}, .length = {width, 1}, .speed = 1});
  sph_group *water = sph_group_box(sim, "water", lo, hi, 1000);
  sph_group *lower = sph_group_create(sim, "lower", "wall");
  sph_group *upper = sph_group_create(sim, "upper", "wall");
  sph_group_add_layers(lower, lo, hi, "x- x+ y+", 1000);
  sph_group_add_layers(upper, lo, hi, "x- x+ y-", 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, c0, 7));
  sph_group_set_viscosity(water, 1000 * nu);
  sph_boundary plate = sph_boundary_adami_no_slip();
  plate.tension = 1;
  sph_group_set_boundary(lower, plate);
  plate.motion = slide;
  sph_group_set_boundary(upper, plate);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .tolerance = tolerance});
  return sim;
}

static double couette_error(const sph_sim *sim, double nu)
{
  const sph_exact_channel exact = {1, nu, 1, 0};
  const sph_group *water = sph_sim_group(sim, "water");
  const double *y = sph_group_read(water, "position", 1);
  const double *vx = sph_group_read(water, "velocity", 0);
  double sum = 0, v;
  long n = sph_group_count(water);
  for (long i = 0; i < n; i++) {
    assert_int_equal(sph_exact_channel_at(&exact, sph_sim_time(sim), 1, &y[i], &v, NULL), SPH_OK);
    sum += (vx[i] - v) * (vx[i] - v);
  }
  return sqrt(sum / (double)n);
}

static void couette(void **state)
{
  (void)state;
  static const double times[] = {0.0225, 0.045, 0.1125, 0.225, 0.5}; /* [L^2/nu] */
  const double nu = 100;
  sph_sim *sim = channel(32, nu, imex, 1e-3), *explicit_one = channel(32, nu, erk, 0);
  for (int k = 0; k < 5; k++) {
    run(sim, times[k] / nu);
    run(explicit_one, times[k] / nu);
    double error = couette_error(sim, nu), other = couette_error(explicit_one, nu);
    print_message("# Couette, t nu/L^2 = %.4f: off by %.2g in %ld steps; explicit %.2g in %ld\n",
                  times[k], error, steps_of(sim), other, steps_of(explicit_one));
    assert_true(error <= 2e-3 && error <= other + 5e-4);
  }
  sph_sim_free(sim);
  sph_sim_free(explicit_one);
}

/* ---- a slab of two media ---- */

static sph_sim *slab(const char *method, double T_left, double T_right)
{
  static const double rho0 = 3, kappa[] = {1, 10};
  const double dx = 1.0 / 40, thick = 4 * dx;
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 2, .dx = dx, .periodic = {0, 1}, .length = {0, 8 * dx}, .speed = 1});
  for (int g = 0; g < 2; g++) {
    sph_group *group = sph_group_box(sim, g ? "b" : "a", (double[]){0.5 * g, 0},
                                     (double[]){0.5 * (g + 1), 8 * dx}, rho0);
    sph_eos eos = sph_eos_linear(rho0, 10, -INFINITY);
    eos.c_v = 2;
    sph_group_set_eos(group, eos);
    sph_group_set_conductivity(group, kappa[g]);
    sph_group_set_energy(group, g ? "u" : "temperature");
    const double *x = sph_group_read(group, "position", 0);
    double *u = sph_group_write(group, "energy", 0);
    for (long i = 0; i < sph_group_count(group); i++) u[i] = 2 * (x[i] < 0.5 ? 250 : 350);
  }
  for (int g = 0; g < 2; g++) {
    sph_group *wall = sph_group_create(sim, g ? "right" : "left", "wall");
    sph_group_add_box(wall, (double[]){g ? 1 : -thick, 0}, (double[]){g ? 1 + thick : 0, 8 * dx},
                      rho0);
    sph_boundary boundary = sph_boundary_adami();
    boundary.temperature = g ? T_right : T_left;
    sph_group_set_boundary(wall, boundary);
  }
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .tolerance = 1e-4});
  return sim;
}

/* Sum of T over the particles, the largest distance from 10/11 of the difference over the first
 * half, or from 300 K. */
static double look(const sph_sim *sim, int insulated, double *sum)
{
  double worst = 0;
  *sum = 0;
  for (int g = 0; g < 2; g++) {
    sph_group *group = sph_sim_group(sim, g ? "b" : "a");
    const double *x = sph_group_read(group, "position", 0);
    const double *T = sph_group_read(group, "temperature", 0);
    for (long i = 0; i < sph_group_count(group); i++) {
      double exact = x[i] < 0.5 ? 250 + 2000 * x[i] / 11 : 350 - 200 * (1 - x[i]) / 11;
      worst = fmax(worst, fabs(T[i] - (insulated ? 300 : exact)));
      *sum += T[i];
    }
  }
  return worst;
}

static void heat(void **state)
{
  (void)state;
  for (int insulated = 0; insulated < 2; insulated++) {
    sph_sim *sim = slab(imex, insulated ? 0 : 250, insulated ? 0 : 350);
    run(sim, 15);
    double sum, worst = look(sim, insulated, &sum);
    print_message("# slab %d: %ld steps, off by %.2g K\n", insulated, steps_of(sim), worst);
    assert_true(worst <= (insulated ? 1e-3 : 0.5) && steps_of(sim) < 200);
    if (insulated) assert_true(fabs(sum / (40 * 8 * 300) - 1) <= 1e-12);
    sph_sim_free(sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shear_flow), cmocka_unit_test(momentum), cmocka_unit_test(energy),
      cmocka_unit_test(threads),    cmocka_unit_test(couette),  cmocka_unit_test(heat),
  };
  return cmocka_run_group_tests_name("imex", tests, NULL, NULL);
}
