/* Equations of state in whole simulations: two that are the same move the same; the zero of energy
 * is free; states that do not exist are refused or asked back. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

enum { STEPS = 20 };

/* A periodic block with a wave of density and velocity, dx = 1/40 in 1D. */
static sph_sim *block(sph_eos eos, double rho0, int viscous)
{
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 1, .dx = 1.0 / 40, .periodic = {1}, .length = {1}, .threads = 1});
  sph_group *group = sph_group_box(sim, "block", (double[]){0}, (double[]){1}, rho0);
  sph_group_set_eos(group, eos);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  if (viscous) sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  return sim;
}

/* c: sound speed; p: pressures at the start, set where p0 is not NAN. */
static void wave(sph_sim *sim, double c, double p0, double amplitude)
{
  sph_group *group = sph_sim_group(sim, "block");
  double *v = sph_group_write(group, "velocity", 0), p[40];
  const double *x = sph_group_read(group, "position", 0);
  assert_int_equal(sph_group_count(group), 40);
  for (int i = 0; i < 40; i++) {
    v[i] = 0.02 * c * sin(2 * M_PI * x[i]);
    p[i] = p0 + amplitude * cos(2 * M_PI * x[i]);
  }
  if (!isnan(p0)) sph_group_set_pressure(group, p);
}

static void run(sph_sim *sim, double c)
{
  sph_sim_set_integrator(sim,
                         &(sph_integrator_def){.method = "leapfrog", .dt_fixed = 0.1 / 40 / c});
  for (int k = 0; k < STEPS; k++)
    if (sph_sim_step(sim)) fail_msg("step %d: %s", k, sph_sim_error(sim));
}

/* Largest difference of a field over its largest value in a; frees neither. */
static double apart(sph_sim *a, sph_sim *b, const char *field, double shift)
{
  const double *one = sph_group_read(sph_sim_group(a, "block"), field, 0);
  const double *other = sph_group_read(sph_sim_group(b, "block"), field, 0);
  double most = 0, size = 0;
  for (int i = 0; i < 40; i++) {
    most = fmax(most, fabs(one[i] - (other[i] - shift)));
    size = fmax(size, fabs(one[i]));
  }
  return most / size;
}

static void assert_same(sph_sim *a, sph_sim *b, const char *field, double tolerance)
{
  double d = apart(a, b, field, 0);
  if (!(d <= tolerance)) fail_msg("%s differs by %g of its size", field, d);
}

/* q moves the zero of energy and nothing else; u < 0 is fine. */
static void zero_of_energy_is_free(void **state)
{
  (void)state;
  const double q = -3e6, c = 1625;
  sph_sim *a = block(sph_eos_stiffened_gas(1000, 4.4, 6e8, 0), 1000, 1);
  sph_sim *b = block(sph_eos_stiffened_gas(1000, 4.4, 6e8, q), 1000, 1);
  wave(a, c, 1e5, 1e7), wave(b, c, 1e5, 1e7);
  run(a, c), run(b, c);
  assert_same(a, b, "velocity", 1e-12);
  assert_same(a, b, "density", 1e-13);
  assert_true(apart(a, b, "energy", q) <= 1e-13);
  assert_true(sph_group_read(sph_sim_group(b, "block"), "energy", 0)[0] < 0);
  sph_sim_free(a), sph_sim_free(b);
}

/* p_inf = 0: an ideal gas. */
static void stiffened_without_stiffness_is_ideal(void **state)
{
  (void)state;
  sph_sim *a = block(sph_eos_ideal_gas(1.4), 1.2, 1);
  sph_sim *b = block(sph_eos_stiffened_gas(1.2, 1.4, 0, 0), 1.2, 1);
  wave(a, 340, 1e5, 3e4), wave(b, 340, 1e5, 3e4);
  run(a, 340), run(b, 340);
  assert_same(a, b, "velocity", 1e-12);
  assert_same(a, b, "energy", 1e-13);
  sph_sim_free(a), sph_sim_free(b);
}

/* Tait with p_b = B is polytropic; without heating an ideal gas of one entropy is, too, and its
 * internal energy is the elastic energy. */
static void polytropic_is_an_isentropic_gas(void **state)
{
  (void)state;
  const double rho0 = 1.2, p0 = 1e5, c = sqrt(1.4 * p0 / rho0);
  sph_eos tait = sph_eos_tait(rho0, c, 1.4);
  tait.p_background = p0;
  sph_sim *a = block(sph_eos_polytropic(rho0, p0 / pow(rho0, 1.4), 1.4), rho0, 0);
  sph_sim *b = block(tait, rho0, 0), *gas = block(sph_eos_ideal_gas(1.4), rho0, 0);
  wave(a, c, NAN, 0), wave(b, c, NAN, 0), wave(gas, c, p0, 0);
  run(a, c), run(b, c), run(gas, c);
  assert_same(a, b, "velocity", 1e-11);
  assert_same(a, b, "density", 1e-13);
  assert_same(a, gas, "density", 1e-6); /* the integrator's error: u is a variable of its own */
  sph_balance one, other;
  sph_sim_balance(a, &one), sph_sim_balance(gas, &other);
  assert_true(fabs(one.internal - other.internal) <= 1e-6 * other.internal);
  sph_sim_free(a), sph_sim_free(b), sph_sim_free(gas);
}

/* A solid starts with u = 0; compression heats it, and energy is kept. */
static void a_solid_starts_cold(void **state)
{
  (void)state;
  sph_sim *sim = block(sph_eos_mie_grueneisen(8930, 3940, 1.49, 2), 8930, 1);
  sph_balance before, after;
  wave(sim, 3940, NAN, 0);
  sph_sim_balance(sim, &before);
  assert_true(before.internal == 0);
  run(sim, 3940);
  sph_sim_balance(sim, &after);
  if (fabs(after.total - before.total) > 1e-4 * before.total)
    fail_msg("energy %.10g, then %.10g", before.total, after.total);
  assert_true(after.internal > 0.01 * before.total);
  sph_sim_free(sim);
}

/* Temperature is as good a variable as u; the difference is the integrator's. */
static void temperature_or_energy(void **state)
{
  (void)state;
  sph_eos eos[] = {sph_material_preset("water-stiffened", 0).eos,
                   sph_material_preset("copper", 0).eos, sph_material_preset("air", 0).eos};
  const double c[] = {1533, 3940, 340}, amplitude[] = {3e7, 3e9, 3e4};
  for (int k = 0; k < 3; k++) {
    sph_sim *a = block(eos[k], eos[k].rho0, 1), *b = block(eos[k], eos[k].rho0, 1);
    sph_group_set_energy(sph_sim_group(b, "block"), "temperature");
    wave(a, c[k], 1e5, amplitude[k]), wave(b, c[k], 1e5, amplitude[k]);
    run(a, c[k]), run(b, c[k]);
    assert_same(a, b, "density", 1e-7);
    assert_same(a, b, "velocity", 1e-5);
    assert_same(a, b, "temperature", 2e-6);
    sph_sim_free(a), sph_sim_free(b);
  }
}

static void states_that_do_not_exist(void **state)
{
  (void)state;
  sph_sim *sim = block(sph_eos_stiffened_gas(1000, 4.4, 6e8, 0), 1000, 0);
  assert_int_equal(sph_sim_evaluate(sim), SPH_ERR_ARGUMENT); /* u = 0 */
  assert_non_null(strstr(sph_sim_error(sim), "no state of equation of state stiffened-gas"));
  sph_sim_free(sim);

  double p[40];
  for (int i = 0; i < 40; i++) p[i] = i == 7 ? -6.1e8 : -1e8; /* tension up to p_inf = 6e8 */
  sim = block(sph_eos_stiffened_gas(1000, 4.4, 6e8, 0), 1000, 0);
  sph_group_set_pressure(sph_sim_group(sim, "block"), p);
  assert_int_equal(sph_sim_status(sim), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "particle 7: no state"));
  sph_sim_free(sim);
  p[7] = -1e8;
  sim = block(sph_eos_stiffened_gas(1000, 4.4, 6e8, 0), 1000, 0);
  sph_group_set_pressure(sph_sim_group(sim, "block"), p);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  assert_true(fabs(sph_group_read(sph_sim_group(sim, "block"), "pressure", 0)[3] + 1e8) < 1e-5);
  sph_sim_free(sim);

  sim = block(sph_eos_mie_grueneisen(8930, 3940, 1.49, 2), 8930, 0);
  sph_group_write(sph_sim_group(sim, "block"), "density", 0)[5] = 3.2 * 8930; /* limit: 3.04 */
  assert_int_equal(sph_sim_evaluate(sim), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "particle 5: no state"));
  sph_sim_free(sim);

  /* in the run: the step is made smaller until it gives up, and says why */
  sim = block(sph_eos_mie_grueneisen(8930, 3940, 1.49, 2), 8930, 0);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog", .retries = 3});
  assert_int_equal(sph_sim_step(sim), SPH_OK);
  sph_group_write(sph_sim_group(sim, "block"), "density", 0)[5] = 3.2 * 8930;
  sph_sim_changed(sim);
  assert_true(sph_sim_step(sim) < 0);
  assert_non_null(strstr(sph_sim_error(sim), "1 particles are in no state"));
  sph_sim_free(sim);
}

/* Between walls that do not slip, some of them out of the fluid's reach: the walls find a density,
 * and an energy that is none leaves no NaN behind. */
static void between_walls(sph_material material, double c_most)
{
  const double lo[] = {0, 0}, hi[] = {1, 1}, rho0 = material.eos.rho0;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .threads = 1});
  sph_group *fluid = sph_group_box(sim, "fluid", lo, hi, rho0);
  sph_group *walls = sph_group_walls(sim, "walls", lo, (double[]){1, 1.6}, rho0);
  sph_boundary boundary = sph_boundary_adami();
  double p[100];
  for (int i = 0; i < 100; i++) p[i] = 1e5;
  boundary.no_slip = 1;
  sph_group_set_boundary(walls, boundary);
  sph_group_set_material(fluid, material);
  sph_group_set_pressure(fluid, p);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
  const double *rho = sph_group_read(walls, "density", 0);
  const double *c = sph_group_read(walls, "sound_speed", 0);
  for (long i = 0; i < sph_group_count(walls); i++)
    if (!(fabs(rho[i] - rho0) <= 1e-12 * rho0 && c[i] >= 0 && c[i] <= c_most))
      fail_msg("%s: wall %ld: density %g, c %g", material.name, i, rho[i], c[i]);
  sph_sim_free(sim);
}

static void walls(void **state)
{
  (void)state;
  between_walls(sph_material_preset("water-stiffened", 0), 1600);
  between_walls(sph_material_preset("water-shock", 0), 1700);
  between_walls(sph_material_preset("air", 0), 345);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(zero_of_energy_is_free),
      cmocka_unit_test(stiffened_without_stiffness_is_ideal),
      cmocka_unit_test(polytropic_is_an_isentropic_gas),
      cmocka_unit_test(a_solid_starts_cold),
      cmocka_unit_test(temperature_or_energy),
      cmocka_unit_test(states_that_do_not_exist),
      cmocka_unit_test(walls),
  };
  return cmocka_run_group_tests_name("materials", tests, NULL, NULL);
}
