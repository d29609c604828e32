/* Taylor-Green vortices in a periodic box of length L, Re = U L/nu = 100, 50 x 50 particles that
 * start up to 0.2 dx off their lattice, without shifting: the mean length of v - v_exact at t =
 * L/U, bar 5 % of U (the honest baseline: a lattice start clumps on the stagnation lines).  With
 * that, the kinetic energy over that of the solution is told, and momentum stays. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "sphode.h"

static const double L = 1, U = 1, nu = 0.01, rho0 = 1000; /* [m], [m/s], [m^2/s], [kg/m^3] */
static const double pi = 3.14159265358979323846;

static sph_sim *box(const sph_exact_taylor_green *exact, double h_over_dx, unsigned long seed)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = L / 50, .h_over_dx = h_over_dx, .periodic = {1, 1}, .length = {L, L}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){L, L}, rho0);
  sph_group_jitter(water, 0.2, seed);
  sph_group_set_eos(water, sph_eos_tait(rho0, 10 * U, 7));
  sph_group_set_viscosity(water, rho0 * nu);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  long n = sph_group_count(water);
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  double *vx = sph_group_write(water, "velocity", 0), *vy = sph_group_write(water, "velocity", 1);
  double *p = malloc((size_t)n * sizeof *p);
  assert_string_equal(sph_sim_error(sim), "");
  for (long i = 0; i < n; i++) {
    sph_exact_flow flow = sph_exact_taylor_green_at(exact, 0, x[i], y[i]);
    vx[i] = flow.v[0], vy[i] = flow.v[1], p[i] = flow.p;
  }
  sph_group_set_pressure(water, p);
  free(p);
  return sim;
}

static double velocity_error(const sph_sim *sim, const sph_exact_taylor_green *exact)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  const double *vx = sph_group_read(water, "velocity", 0);
  const double *vy = sph_group_read(water, "velocity", 1);
  double sum = 0;
  long n = sph_group_count(water);
  for (long i = 0; i < n; i++) {
    sph_exact_flow flow = sph_exact_taylor_green_at(exact, sph_sim_time(sim), x[i], y[i]);
    sum += hypot(vx[i] - flow.v[0], vy[i] - flow.v[1]) / U;
  }
  return sum / (double)n;
}

static void decay(double h_over_dx, unsigned long seed)
{
  const sph_exact_taylor_green exact = {U, 2 * pi / L, nu, rho0};
  sph_sim *sim = box(&exact, h_over_dx, seed);
  sph_balance start, end;
  sph_sim_balance(sim, &start);
  if (sph_sim_run(sim, L / U) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  double error = velocity_error(sim, &exact);
  sph_sim_balance(sim, &end);
  double energy =
      end.kinetic / (rho0 * L * L * U * U / 4 * exp(-4 * nu * exact.k * exact.k * L / U));
  print_message(
      "# h/dx = %g, seed %lu: mean velocity error %.2f %% of U (bar 5 %%), kinetic energy "
      "%.3f of the exact one\n",
      h_over_dx, seed, 100 * error, energy);
  assert_true(error <= 0.05);
  for (int d = 0; d < 2; d++)
    assert_true(fabs(end.momentum[d] - start.momentum[d]) <= 1e-9 * end.mass * U);
  sph_sim_free(sim);
}

static void vortices_decay(void **state)
{
  (void)state;
  decay(1.5, 1);
  decay(1.5, 2);
  if (getenv("SPHODE_TEST_LONG")) decay(2, 1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(vortices_decay)};
  return cmocka_run_group_tests_name("Taylor-Green", tests, NULL, NULL);
}
