/* Shock tubes on 400 particles, h = 2.75 dx, as in test_sod.c, with the switches of artificial
 * viscosity: L1(rho) against the exact solution beside that with constant alpha, and where alpha is
 * large.
 *
 * Of Morris & Monaghan's switch more is known.  d ln(alpha_max - alpha) = d ln(1/rho) where nothing
 * decays: alpha behind a shock is at most alpha_max - (alpha_max - alpha_min) rho_1/rho_2.  Behind
 * it the gas is uniform, and what the shock passed t seconds ago has decayed by exp(- 0.2 c t/h): a
 * particle d behind the shock, D - u being its speed relative to the gas, by
 * exp(- 0.2 c d/(h (D - u))). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "near.h"
#include "sphode.h"

static const double gamma_gas = 1.4;
enum { N = 400 };

typedef struct states {
  sph_exact_riemann riemann;
  double t_end;
} states;

/* Sod (1978); a strong shock, Mach 22. */
static const states sod = {{.gamma = 1.4, .left = {1, 0, 1}, .right = {0.125, 0, 0.1}}, 0.2};
static const states strong = {{.gamma = 1.4, .left = {1, 0, 1000}, .right = {1, 0, 1}}, 0.008};

static sph_sim *tube(const states *s, sph_term viscosity)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                               .dx = 1.0 / N,
                                               .h_over_dx = 2.75,
                                               .periodic = {1},
                                               .origin = {-1},
                                               .length = {2},
                                               .speed = 1});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){-1}, (double[]){1}, 1);
  sph_group_set_eos(gas, sph_eos_ideal_gas(gamma_gas));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, viscosity);
  sph_sim_add_term(sim, sph_term_conductivity_artificial(1));
  const double *x = sph_group_read(gas, "position", 0);
  double *m = sph_group_write(gas, "mass", 0), *rho = sph_group_write(gas, "density", 0);
  double *u = sph_group_write(gas, "energy", 0);
  assert_string_equal(sph_sim_error(sim), "");
  for (long i = 0; i < sph_group_count(gas); i++) {
    const int left = x[i] < 0;
    rho[i] = left ? s->riemann.left.rho : s->riemann.right.rho;
    m[i] = rho[i] / N;
    u[i] = (left ? s->riemann.left.p : s->riemann.right.p) / ((gamma_gas - 1) * rho[i]);
  }
  return sim;
}

static double l1(const sph_group *gas, const sph_exact_riemann *riemann, double t_end)
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

/* Largest alpha within 3 h of the shock, and where it is. */
static double peak(const sph_group *gas, double shock, double h, double *at)
{
  const double *x = sph_group_read(gas, "position", 0), *alpha = sph_group_read(gas, "alpha", 0);
  double most = 0;
  for (long i = 0; i < sph_group_count(gas); i++)
    if (fabs(x[i] - shock) < 3 * h && alpha[i] > most) most = alpha[i], *at = x[i];
  return most;
}

/* Mean of alpha over an interval. */
static double mean(const sph_group *gas, double from, double to)
{
  const double *x = sph_group_read(gas, "position", 0), *alpha = sph_group_read(gas, "alpha", 0);
  double sum = 0;
  long n = 0;
  for (long i = 0; i < sph_group_count(gas); i++)
    if (x[i] > from && x[i] < to) sum += alpha[i], n++;
  assert_true(n > 2);
  return sum / (double)n;
}

typedef struct result {
  double l1, peak, mean[2], fan; /* mean of alpha 3 h and 7 h behind the shock */
  long steps;
} result;

static result run(const states *s, const char *switches, double alpha, double alpha_min)
{
  states own = *s;
  result r = {0};
  assert_int_equal(sph_exact_riemann_solve(&own.riemann, NULL), SPH_OK);
  const sph_term viscosity = sph_term_viscosity_artificial(alpha, 2 * alpha);
  sph_sim *sim = tube(s, sph_term_switched(viscosity, switches, alpha_min));
  if (sph_sim_run(sim, s->t_end) != SPH_OK) fail_msg("%s: %s", switches, sph_sim_error(sim));
  const sph_group *gas = sph_sim_group(sim, "gas");
  const double h = sph_sim_h(sim), shock = own.riemann.right_head * s->t_end;
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  r.l1 = l1(gas, &own.riemann, s->t_end), r.steps = stats.step.steps;
  print_message("# %s, alpha %g to %g: L1(rho) = %.5f, %ld steps", switches, alpha_min, alpha, r.l1,
                r.steps);
  if (sph_group_read(gas, "alpha", 0)) {
    double at = 0;
    r.peak = peak(gas, shock, h, &at);
    for (int k = 0; k < 2; k++)
      r.mean[k] = mean(gas, shock - (4 * k + 4) * h, shock - (4 * k + 2) * h);
    r.fan = mean(gas, own.riemann.left_head * s->t_end, own.riemann.left_tail * s->t_end);
    print_message("; alpha %.3f at the shock, %.3f and %.3f 3 h and 7 h behind it, %.4f in the fan",
                  r.peak, r.mean[0], r.mean[1], r.fan);
  }
  print_message("\n");
  sph_sim_free(sim);
  return r;
}

/* Where nothing decays. */
static double most(const states *s, double alpha, double alpha_min)
{
  states own = *s;
  assert_int_equal(sph_exact_riemann_solve(&own.riemann, NULL), SPH_OK);
  return alpha - (alpha - alpha_min) * s->riemann.right.rho / own.riemann.rho_right;
}

/* Four h farther behind Sod's shock alpha has decayed by this. */
static double decay(void)
{
  states own = sod;
  assert_int_equal(sph_exact_riemann_solve(&own.riemann, NULL), SPH_OK);
  const double c = sqrt(gamma_gas * own.riemann.p / own.riemann.rho_right);
  return exp(-4 * 0.2 * c / (own.riemann.right_head - own.riemann.u));
}

/* Sod: constant alpha is better by a tenth (it has nothing to wait for), MM's decays as it must. */
static void sod_tube(void **state)
{
  (void)state;
  const result none = run(&sod, "none", 1, 0), balsara = run(&sod, "balsara", 1, 0);
  const result mm = run(&sod, "morris-monaghan", 2, 0.1), cd = run(&sod, "cullen-dehnen", 2, 0);
  const double share = mm.peak / most(&sod, 2, 0.1);
  const double fall = (mm.mean[1] - 0.1) / (mm.mean[0] - 0.1);
  print_message("# morris-monaghan: %.2f of the largest alpha; decay over 4 h %.3f, exact %.3f\n",
                share, fall, decay());
  assert_true(none.l1 <= 0.01 && mm.l1 <= 0.01 && cd.l1 <= 0.012);
  assert_true(fabs(balsara.l1 / none.l1 - 1) <= 1e-3); /* no curl in 1D */
  assert_true(share > 0.6 && share <= 1);
  assert_near(fall, decay(), 0.1 * decay());
  assert_near(mm.fan, 0.1, 1e-3);
  assert_true(cd.fan < 0.01 && cd.peak > 30 * cd.fan);
}

/* A strong shock compresses to nearly (gamma + 1)/(gamma - 1) = 6: alpha nearly reaches its top. */
static void strong_shock(void **state)
{
  (void)state;
  const result none = run(&strong, "none", 1, 0);
  const result mm = run(&strong, "morris-monaghan", 2, 0.1);
  const result cd = run(&strong, "cullen-dehnen", 2, 0);
  assert_true(mm.peak > 0.7 * most(&strong, 2, 0.1) && mm.peak <= most(&strong, 2, 0.1));
  assert_true(mm.l1 <= 1.05 * none.l1 && cd.l1 <= 1.25 * none.l1);
  assert_true(cd.peak > 0.5 && cd.fan < 1e-3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(sod_tube), cmocka_unit_test(strong_shock)};
  return cmocka_run_group_tests_name("shock switches", tests, NULL, NULL);
}
