/* Oil at rest on water in a tank, matched stiffness rho0 c0^2 (Colagrossi & Landrini 2003), from
 * the exact layers of both equations of state: they must stay at rest, and one above the other.
 *
 * H/dx = 20.  Bars: L1(p) = mean |p - p_exact|/(rho_w g H) <= 0.4 %, kinetic energy <= 1e-6 of
 * (rho_w g H^3), at t sqrt(g/H) = 40; SPHODE_TEST_LONG=1: at 120. */
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

static const double H = 1, g = 1, rho_w = 1000, rho_o = 500; /* [m], [m/s^2], [kg/m^3] */

/* Both liquids, each with walls of its own equation of state. */
static sph_sim *tank(sph_exact_layers *layers)
{
  const double dx = H / 20, c_w = 10 * sqrt(2 * g * H), half = H / 2;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = 1.5});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){H, half}, rho_w);
  sph_group *oil = sph_group_box(sim, "oil", (double[]){0, half}, (double[]){H, H}, rho_o);
  sph_group *low = sph_group_create(sim, "low", "wall"),
            *high = sph_group_create(sim, "high", "wall");
  sph_group_add_layers(low, (double[]){0, 0}, (double[]){H, half}, "y+", rho_w);
  sph_group_add_layers(high, (double[]){0, half}, (double[]){H, 1.3 * H}, "y- y+", rho_o);
  sph_group_set_eos(water, sph_eos_tait(rho_w, c_w, 7));
  sph_group_set_eos(low, sph_eos_tait(rho_w, c_w, 7));
  sph_group_set_eos(oil, sph_eos_tait(rho_o, c_w * sqrt(rho_w / rho_o), 7));
  sph_group_set_eos(high, sph_eos_tait(rho_o, c_w * sqrt(rho_w / rho_o), 7));
  sph_group_set_boundary(low, sph_boundary_adami());
  sph_group_set_boundary(high, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -g, 0}));
  assert_string_equal(sph_sim_error(sim), "");
  *layers = (sph_exact_layers){*sph_group_eos(water), *sph_group_eos(oil), half, H, 0, g};
  sph_exact_column column;
  assert_int_equal(sph_exact_layers_column(layers, 0, &column, NULL), SPH_OK);
  sph_group_set_column(water, 1, half, column.p_surface, g);
  sph_group_set_hydrostatic(oil, 1, H, g);
  return sim;
}

/* Sum of |p - p_exact|/(rho_w g H) over a liquid; lowest and highest particle to extent[2]. */
static double pressure_error(const sph_group *liquid, const sph_exact_layers *layers, int upper,
                             double extent[2])
{
  const double *y = sph_group_read(liquid, "position", 1);
  const double *p = sph_group_read(liquid, "pressure", 0);
  sph_exact_column column;
  double sum = 0;
  assert_int_equal(sph_exact_layers_column(layers, upper, &column, NULL), SPH_OK);
  extent[0] = INFINITY, extent[1] = -INFINITY;
  for (long i = 0; i < sph_group_count(liquid); i++) {
    double exact;
    assert_int_equal(sph_exact_column_at(&column, 1, &y[i], NULL, &exact, NULL), SPH_OK);
    sum += fabs(p[i] - exact) / (rho_w * g * H);
    extent[0] = fmin(extent[0], y[i]), extent[1] = fmax(extent[1], y[i]);
  }
  return sum;
}

static double error_of(const sph_sim *sim, const sph_exact_layers *layers)
{
  const sph_group *water = sph_sim_group(sim, "water"), *oil = sph_sim_group(sim, "oil");
  double low[2], high[2];
  double sum = pressure_error(water, layers, 0, low) + pressure_error(oil, layers, 1, high);
  assert_true(low[0] > 0 && low[1] < high[0] && high[1] < H);
  return sum / (double)(sph_group_count(water) + sph_group_count(oil));
}

static void stay_at_rest(void **state)
{
  (void)state;
  const double t_end = (getenv("SPHODE_TEST_LONG") ? 120 : 40) * sqrt(H / g);
  sph_exact_layers layers;
  sph_sim *sim = tank(&layers);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  double start = error_of(sim, &layers);
  if (sph_sim_run(sim, t_end) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  double error = error_of(sim, &layers);
  sph_balance balance;
  sph_sim_balance(sim, &balance);
  double motion = balance.kinetic / (rho_w * g * H * H * H);
  print_message(
      "# t = %g, H/dx = 20: L1(p) = %.3f %% (start %.2g, bar 0.4 %%), kinetic energy %.2g "
      "(bar 1e-6)\n",
      sph_sim_time(sim), 100 * error, start, motion);
  assert_true(start <= 1e-6);
  assert_true(error <= 0.004);
  assert_true(motion <= 1e-6);
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(stay_at_rest)};
  return cmocka_run_group_tests_name("two fluids", tests, NULL, NULL);
}
