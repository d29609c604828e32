/* Taylor-Green vortices as in test_taylor_green.c, Re = 100, h/dx = 2, c0 = 20 U, from a start up
 * to 0.2 dx off the lattice, with corrected gradients, and shifting or the transport velocity.  At
 * t = L/U the mean length of v - v_exact is at most 0.3 % of U with 50 x 50 particles, 0.1 % with
 * 100 x 100 (SPHODE_TEST_LONG), the order at least 1.7.
 *
 * The rate of decay, of the part of v that is along the solution, is right to 0.5 % with 100 x 100.
 * With fewer the kernel shows: fourth moments of F make the Laplacian of exp(i k.x), |k|^2 = 2 k^2
 * here, too small by the factor 1 - sigma_k^2 h^2 |k|^2/4, sigma_k^2 = 5/18 of Wendland C2 in 2D:
 * 0.9912 with 50 x 50.  0.5 % from that is asserted, and how far v is from the solution that decays
 * so: a sixth of the error, and what sees the terms that follow a shift (0.04 %; 0.09 % without
 * dv.grad v, 0.16 % with its other sign). */
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
#include "long.h"
#include "sphode.h"

static const double L = 1, U = 1, nu = 0.01, rho0 = 1000; /* [m], [m/s], [m^2/s], [kg/m^3] */
static const double c0 = 20, h_over_dx = 2;               /* [m/s] */
static const double pi = 3.14159265358979323846;

typedef struct found {
  double error, decay; /* mean |v - v_exact|/U; rate of decay over 2 nu k^2 */
  double smoothed;     /* that of the Laplacian of the kernel */
  double beside;       /* as error, from the solution that decays so */
} found;

static void add_terms(sph_sim *sim, int corrected)
{
  const char *one_sided = corrected ? "one-sided" : NULL, *mean = corrected ? "mean" : NULL;
  sph_sim_add_term(sim, sph_term_corrected(sph_term_continuity(), one_sided));
  sph_sim_add_term(sim, sph_term_corrected(sph_term_pressure(), mean));
  sph_sim_add_term(sim, sph_term_corrected(sph_term_viscosity_laminar("morris"), mean));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
}

static sph_sim *box(const sph_exact_taylor_green *exact, int n, int corrected)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = L / n, .h_over_dx = h_over_dx, .periodic = {1, 1}, .length = {L, L}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){L, L}, rho0);
  sph_group_jitter(water, 0.2, 1);
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  sph_group_set_viscosity(water, rho0 * nu);
  add_terms(sim, corrected);
  assert_string_equal(sph_sim_error(sim), "");
  long many = sph_group_count(water);
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  double *vx = sph_group_write(water, "velocity", 0), *vy = sph_group_write(water, "velocity", 1);
  double *p = malloc((size_t)many * sizeof *p);
  for (long i = 0; i < many; i++) {
    sph_exact_flow flow = sph_exact_taylor_green_at(exact, 0, x[i], y[i]);
    vx[i] = flow.v[0], vy[i] = flow.v[1], p[i] = flow.p;
  }
  sph_group_set_pressure(water, p);
  free(p);
  return sim;
}

/* v along the solution of t = 0, over it; and how far it is from `decay` times the exact one. */
static double amplitude(const sph_sim *sim, const sph_exact_taylor_green *exact, double decay,
                        double *error)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  const double *vx = sph_group_read(water, "velocity", 0);
  const double *vy = sph_group_read(water, "velocity", 1);
  const long n = sph_group_count(water);
  double sum = 0, along = 0, squares = 0;
  for (long i = 0; i < n; i++) {
    sph_exact_flow start = sph_exact_taylor_green_at(exact, 0, x[i], y[i]);
    sph_exact_flow now = sph_exact_taylor_green_at(exact, sph_sim_time(sim), x[i], y[i]);
    sum += hypot(vx[i] - decay * now.v[0], vy[i] - decay * now.v[1]) / U;
    along += vx[i] * start.v[0] + vy[i] * start.v[1];
    squares += start.v[0] * start.v[0] + start.v[1] * start.v[1];
  }
  *error = sum / (double)n;
  return along / squares;
}

static found run(const char *what, int n, sph_term term, int corrected)
{
  const sph_exact_taylor_green exact = {U, 2 * pi / L, nu, rho0};
  sph_sim *sim = box(&exact, n, corrected);
  if (term.name) sph_sim_add_term(sim, term);
  found f;
  const double start = amplitude(sim, &exact, 1, &f.error), h = h_over_dx * L / n;
  const double rate = 2 * nu * exact.k * exact.k;
  if (sph_sim_run(sim, L / U) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  const double end = amplitude(sim, &exact, 1, &f.error);
  f.decay = log(start / end) / (rate * L / U);
  f.smoothed = 1 - 5. / 18 * h * h * 2 * exact.k * exact.k / 4;
  amplitude(sim, &exact, exp((1 - f.smoothed) * rate * L / U), &f.beside);
  print_message("# %s, %d x %d: mean velocity error %.3f %% of U, rate of decay %.4f of the exact "
                "one, of the kernel's Laplacian %.4f; error beside that %.4f %%\n",
                what, n, n, 100 * f.error, f.decay, f.smoothed, 100 * f.beside);
  sph_sim_free(sim);
  return f;
}

static sph_term shifting(const char *form)
{
  sph_term term = sph_term_shifting(form, U);
  term.surface = 0;
  return term;
}

static double order_between(found coarse, found fine)
{
  const double order = log(coarse.error / fine.error) / log(2);
  print_message("# order %.2f (bar 1.7)\n", order);
  return order;
}

static void shifted(void **state)
{
  (void)state;
  const found coarse = run("delta-plus", 25, shifting("delta-plus"), 1);
  const found fine = run("delta-plus", 50, shifting("delta-plus"), 1);
  assert_true(fine.error <= 0.003);
  assert_true(coarse.beside <= 0.0018 && fine.beside <= 0.0006);
  assert_true(fabs(fine.decay / fine.smoothed - 1) <= 0.005);
  assert_true(order_between(coarse, fine) >= 1.7);
  if (!getenv("SPHODE_TEST_LONG")) return;
  const found finest = run("delta-plus", 100, shifting("delta-plus"), 1);
  assert_true(finest.error <= 0.001);
  assert_true(fabs(finest.decay - 1) <= 0.005);
  assert_true(order_between(fine, finest) >= 1.7);
}

static void transport_velocity(void **state)
{
  (void)state;
  const found f = run("transport velocity", 50, sph_term_transport_velocity(0, 0), 1);
  assert_true(f.error <= 0.003 && f.beside <= 0.0016);
  assert_true(fabs(f.decay / f.smoothed - 1) <= 0.005);
}

static void others(void **state)
{
  (void)state;
  if (test_is_short()) return;
  sph_term between = shifting("delta-plus"), alone = between;
  between.steps = 1;
  alone.advection = 0;
  assert_true(run("delta-plus, between steps", 50, between, 1).error <= 0.003);
  assert_true(run("fick", 50, shifting("fick"), 1).error <= 0.003);
  run("delta-plus, nothing follows", 50, alone, 1);
  run("without shifting", 50, (sph_term){0}, 1);
  run("delta-plus, gradients not corrected", 50, shifting("delta-plus"), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shifted),
      cmocka_unit_test(transport_velocity),
      cmocka_unit_test(others),
  };
  return cmocka_run_group_tests_name("Taylor-Green, shifted", tests, NULL, NULL);
}
