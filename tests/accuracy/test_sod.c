/* Sod's shock tube (1978), gamma = 1.4, 400 particles on [-1/2, 1/2] at equal distances (masses
 * 8:1), constant h: against the exact solution at t = 0.2.  h = 2.75 dx: the gas thins to 2.35 dx
 * between particles, and with fewer than two neighbours on each side the fan breaks into steps (h =
 * 1.5 dx: L1(rho) = 0.022).
 *
 * The box is periodic and twice as long: the second pair of waves, from its ends, does not reach
 * the part that is compared.  Bars: L1(rho) <= 0.01, plateaus 2 %. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "sphode.h"

static const double gamma_gas = 1.4, t_end = 0.2;

static sph_sim *tube(int n, double conductivity, int summed)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                               .dx = 1.0 / n,
                                               .kernel = summed ? "cubic-spline" : NULL,
                                               .h_over_dx = 2.75,
                                               .periodic = {1},
                                               .origin = {-1},
                                               .length = {2},
                                               .speed = 1});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){-1}, (double[]){1}, 1);
  sph_group_set_eos(gas, sph_eos_ideal_gas(gamma_gas));
  sph_sim_add_term(sim, summed ? sph_term_summation(0) : sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure_form(summed ? "s" : "c2"));
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  sph_sim_add_term(sim, sph_term_conductivity_artificial(conductivity));
  const double *x = sph_group_read(gas, "position", 0);
  double *m = sph_group_write(gas, "mass", 0), *rho = sph_group_write(gas, "density", 0);
  double *u = sph_group_write(gas, "energy", 0);
  assert_string_equal(sph_sim_error(sim), "");
  for (long i = 0; i < sph_group_count(gas); i++) {
    double p = x[i] < 0 ? 1 : 0.1;
    rho[i] = x[i] < 0 ? 1 : 0.125;
    m[i] = rho[i] / n;
    u[i] = p / ((gamma_gas - 1) * rho[i]);
  }
  return sim;
}

static sph_exact_riemann exact(void)
{
  sph_exact_riemann riemann = {.gamma = gamma_gas, .left = {1, 0, 1}, .right = {0.125, 0, 0.1}};
  assert_int_equal(sph_exact_riemann_solve(&riemann, NULL), SPH_OK);
  assert_true(fabs(riemann.p - 0.3031301781) < 1e-9); /* Toro (2009), table 4.3, to more digits */
  return riemann;
}

/* Mean of a field between two speeds x/t, with what it should be. */
static void plateau(const sph_group *gas, const char *field, double from, double to, double right,
                    double bar)
{
  const double *x = sph_group_read(gas, "position", 0), *f = sph_group_read(gas, field, 0);
  double sum = 0;
  long n = 0;
  for (long i = 0; i < sph_group_count(gas); i++)
    if (x[i] > from * t_end && x[i] < to * t_end) sum += f[i], n++;
  double error = fabs(sum / (double)n / right - 1);
  print_message("# %s between %.2f and %.2f: %.5f, exact %.5f, %.2f %% off (%ld particles)\n",
                field, from, to, sum / (double)n, right, 100 * error, n);
  assert_true(n > 5 && error <= bar);
}

static double l1(const sph_group *gas, const sph_exact_riemann *riemann)
{
  const double *x = sph_group_read(gas, "position", 0), *rho = sph_group_read(gas, "density", 0);
  const double *m = sph_group_read(gas, "mass", 0);
  double sum = 0, volume = 0;
  for (long i = 0; i < sph_group_count(gas); i++) {
    if (fabs(x[i]) > 0.5) continue;
    sum += m[i] / rho[i] * fabs(rho[i] - sph_exact_riemann_at(riemann, x[i] / t_end).rho);
    volume += m[i] / rho[i];
  }
  return sum / volume;
}

/* Largest u over the exact one between contact and shock, which is the largest of all: - 1. */
static double overshoot(double conductivity)
{
  sph_exact_riemann riemann = exact();
  sph_sim *sim = tube(400, conductivity, 0);
  if (sph_sim_run(sim, t_end) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  const sph_group *gas = sph_sim_group(sim, "gas");
  const double *x = sph_group_read(gas, "position", 0), *u = sph_group_read(gas, "energy", 0);
  double most = 0;
  for (long i = 0; i < sph_group_count(gas); i++)
    if (fabs(x[i]) < 0.5) most = fmax(most, u[i]);
  sph_sim_free(sim);
  return most * (gamma_gas - 1) * riemann.rho_right / riemann.p - 1;
}

/* The start heats the gas at the contact too much; conductivity spreads that. */
static void contact(void **state)
{
  (void)state;
  double with = overshoot(1), without = overshoot(0);
  print_message("# overshoot of u: %.3f, without conductivity %.3f\n", with, without);
  assert_true(with <= 0.015 && without >= 2 * with);
}

static void shock_tube(void **state)
{
  (void)state;
  sph_exact_riemann riemann = exact();
  sph_sim *sim = tube(400, 1, 0);
  sph_balance start, end;
  sph_sim_balance(sim, &start);
  int status = sph_sim_run(sim, t_end);
  if (status != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  sph_sim_balance(sim, &end);
  const sph_group *gas = sph_sim_group(sim, "gas");
  double error = l1(gas, &riemann), drift = fabs(end.total / start.total - 1);
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  print_message("# L1(rho) = %.4f (bar 0.01), energy drift %.2g, %ld steps\n", error, drift,
                stats.step.steps);
  assert_true(error <= 0.01);
  assert_true(drift <= 2e-5); /* of the integrator: the right-hand side keeps energy exactly */
  plateau(gas, "velocity", riemann.left_tail + 0.15, riemann.u - 0.15, riemann.u, 0.02);
  plateau(gas, "density", riemann.left_tail + 0.15, riemann.u - 0.25, riemann.rho_left, 0.02);
  plateau(gas, "density", riemann.u + 0.25, riemann.right_head - 0.15, riemann.rho_right, 0.02);
  plateau(gas, "pressure", riemann.left_tail + 0.15, riemann.right_head - 0.15, riemann.p, 0.02);
  sph_sim_free(sim);
}

/* Summed density is smeared over the jump at the start, by h; masses 8:1 as before. */
static void summed_density(void **state)
{
  (void)state;
  sph_exact_riemann riemann = exact();
  sph_sim *sim = tube(400, 1, 1);
  sph_balance start, end;
  if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  sph_sim_balance(sim, &start);
  if (sph_sim_run(sim, t_end) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  sph_sim_balance(sim, &end);
  const sph_group *gas = sph_sim_group(sim, "gas");
  double error = l1(gas, &riemann), drift = fabs(end.total / start.total - 1);
  print_message("# summed density: L1(rho) = %.4f, energy drift %.2g\n", error, drift);
  plateau(gas, "velocity", riemann.left_tail + 0.15, riemann.u - 0.15, riemann.u, 0.02);
  plateau(gas, "pressure", riemann.left_tail + 0.15, riemann.right_head - 0.15, riemann.p, 0.02);
  assert_true(error <= 0.01 && drift <= 2e-5);
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(shock_tube), cmocka_unit_test(contact),
                                     cmocka_unit_test(summed_density)};
  return cmocka_run_group_tests_name("Sod", tests, NULL, NULL);
}
