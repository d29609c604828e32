/* Dust in a gas: streams and sound against the exact solutions (Laibe & Price 2011, 2012), with
 * every integrator; drag that is stiff, explicitly and implicitly. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "sphode.h"

static const double pi = 3.14159265358979323846;

/* ---- streams ---- */

typedef struct box {
  int dim;
  const char *kernel, *method;
  double h_over_dx, K, dt; /* dt 0: as the integrator likes */
  int thermal;
} box;

static const double rho_gas = 1, rho_dust = 0.5, speed = 1; /* of the dust; the gas is at rest */

static double stopping_time(double K) { return rho_gas * rho_dust / (K * (rho_gas + rho_dust)); }

/* Lattices of gas and dust on top of each other; c = 1. */
static sph_sim *streams(const box *b)
{
  enum { N = 12 };
  const double dx = 1.0 / N, lo[] = {0, 0, 0}, hi[] = {1, 1, 1};
  sph_sim_def def = {.dim = b->dim, .dx = dx, .kernel = b->kernel, .h_over_dx = b->h_over_dx};
  for (int d = 0; d < b->dim; d++) def.periodic[d] = 1, def.length[d] = 1;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *gas = sph_group_box(sim, "gas", lo, hi, rho_gas);
  sph_group *dust = sph_group_box(sim, "dust", lo, hi, rho_dust);
  sph_group_set_eos(gas, b->thermal ? sph_eos_ideal_gas(1.4) : sph_eos_isothermal(rho_gas, 1));
  sph_group_set_eos(dust, sph_eos_dust());
  for (long i = 0; i < sph_group_count(dust); i++) {
    sph_group_write(dust, "velocity", 0)[i] = speed;
    if (b->thermal) sph_group_write(gas, "energy", 0)[i] = 1 / (1.4 * 0.4);
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 0)); /* holds the lattice */
  sph_sim_add_term(sim, sph_term_drag(b->K));
  sph_integrator_def steps = {.method = b->method, .dt_fixed = b->dt};
  if (b->dt > 0) steps.tolerance = -1;
  sph_sim_set_integrator(sim, &steps);
  return sim;
}

static double mean(const sph_sim *sim, const char *group, const char *field)
{
  const sph_group *g = sph_sim_group(sim, group);
  const double *a = sph_group_read(g, field, 0);
  double sum = 0;
  for (long i = 0; i < sph_group_count(g); i++) sum += a[i];
  return sum / (double)sph_group_count(g);
}

/* Largest distance of both mean velocities from the exact ones, at the times t_s/2, ..., 4 t_s. */
static double error_of(const box *b)
{
  const sph_exact_dusty_box exact = {{rho_gas, 0}, {rho_dust, speed}, b->K, 0};
  sph_sim *sim = streams(b);
  double worst = 0;
  for (int k = 1; k <= 8; k++) {
    sph_exact_streams right;
    const double t = 0.5 * k * stopping_time(b->K);
    if (sph_sim_run(sim, t)) fail_msg("%s: %s", b->method, sph_sim_error(sim));
    assert_int_equal(sph_exact_dusty_box_at(&exact, t, &right, NULL), SPH_OK);
    worst = fmax(worst, fabs(mean(sim, "gas", "velocity") - right.fluid));
    worst = fmax(worst, fabs(mean(sim, "dust", "velocity") - right.dust));
  }
  sph_sim_free(sim);
  return worst;
}

/* 0.2 % in every dimension with what is usual: what the kernel's sum is off by. */
static void streams_of_all_dimensions(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++) {
    const box b = {.dim = dim, .kernel = "wendland-c2", .h_over_dx = 1.5, .K = 1};
    double error = error_of(&b);
    print_message("# %dD: %.2g\n", dim, error);
    assert_true(error < 2e-3);
  }
}

/* On a line with quintic splines, h = dx, the drag is exact: what is left is the integrator's, of
 * its order. */
static void order(void **state)
{
  static const struct {
    const char *method;
    double order;
  } row[] = {{"leapfrog", 2},
             {"dkd", 2},
             {"symplectic", 2},
             {"erk:bogacki-shampine-4-2-3", 3},
             {"erk:zonneveld-5-3-4", 4},
             {"imex:ark324l2sa-4-2-3", 3},
             {"imex:ark436l2sa-6-3-4", 4}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    box b = {.dim = 1, .kernel = "quintic-spline", .method = row[k].method, .h_over_dx = 1, .K = 1};
    double t_s = stopping_time(b.K), error[2];
    for (int half = 0; half < 2; half++) {
      b.dt = t_s / (half ? 16 : 8);
      error[half] = error_of(&b);
    }
    double found = log2(error[0] / error[1]);
    print_message("# %s: %.3g, %.3g, order %.2f\n", row[k].method, error[0], error[1], found);
    assert_true(found > row[k].order - 0.15 && error[1] < 2e-3);
  }
}

/* What the motion loses heats the gas: u as the exact solution, total energy to the integrator's
 * error. */
static void heat(void **state)
{
  (void)state;
  const box b = {
      .dim = 2, .kernel = "wendland-c2", .h_over_dx = 2, .K = 1, .dt = 0.01, .thermal = 1};
  const sph_exact_dusty_box exact = {{rho_gas, 0}, {rho_dust, speed}, b.K, 1 / (1.4 * 0.4)};
  sph_exact_streams right;
  sph_balance start, end;
  sph_sim *sim = streams(&b);
  sph_sim_balance(sim, &start);
  const double t = stopping_time(b.K);
  if (sph_sim_run(sim, t)) fail_msg("%s", sph_sim_error(sim));
  sph_sim_balance(sim, &end);
  assert_int_equal(sph_exact_dusty_box_at(&exact, t, &right, NULL), SPH_OK);
  double gained = mean(sim, "gas", "energy") - exact.u;
  print_message("# heat %.6g, exact %.6g, total %.2g\n", gained, right.u - exact.u,
                end.total / start.total - 1);
  assert_true(fabs(gained / (right.u - exact.u) - 1) < 3e-3);
  assert_true(fabs(end.total / start.total - 1) < 1e-5);
  sph_sim_free(sim);
}

/* ---- stiff ---- */

/* Every integrator steps drag 1000 times as fast as sound at its limit, and ends at the common
 * velocity. */
static void every_integrator_is_stable(void **state)
{
  (void)state;
  sph_integrator_info info;
  int tried = 0;
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    int imex = !strncmp(info.name, "imex:", 5);
    if (!imex && strncmp(info.name, "erk:", 4) && strchr(info.name, ':')) continue;
    if (!strcmp(info.name, "verlet-dual")) continue; /* unstable where anything is damped */
    const box b = {.dim = 1,
                   .kernel = "wendland-c2",
                   .method = info.name,
                   .h_over_dx = 1.5,
                   .K = imex ? 1e6 : 1e3};
    sph_sim *sim = streams(&b);
    const double end = imex ? 0.2 : 60 * stopping_time(b.K);
    if (sph_sim_run(sim, end)) fail_msg("%s: %s", info.name, sph_sim_error(sim));
    const double v = rho_dust / (rho_gas + rho_dust) * speed;
    double off =
        fmax(fabs(mean(sim, "gas", "velocity") - v), fabs(mean(sim, "dust", "velocity") - v));
    sph_sim_stats stats;
    sph_sim_get_stats(sim, &stats);
    if (!(off < 1e-3)) fail_msg("%s: off by %g after %ld steps", info.name, off, stats.step.steps);
    tried++;
    sph_sim_free(sim);
  }
  print_message("# %d integrators\n", tried);
  assert_true(tried > 20);
}

/* Drag as fast as 1e-2 to 1e-7 of an acoustic step: the streams are one from the first step on, and
 * steps do not become smaller with t_s. */
static void stiff_limit(void **state)
{
  (void)state;
  long steps[2] = {0, 0};
  for (double K = 1e3; K < 1e10; K *= 100) {
    const box b = {.dim = 2,
                   .kernel = "wendland-c2",
                   .method = "imex:ark324l2sa-4-2-3",
                   .h_over_dx = 1.5,
                   .K = K};
    sph_sim *sim = streams(&b);
    if (sph_sim_run(sim, 0.5)) fail_msg("%s", sph_sim_error(sim));
    sph_balance balance;
    sph_sim_balance(sim, &balance);
    double v = rho_dust / (rho_gas + rho_dust) * speed;
    double off =
        fmax(fabs(mean(sim, "gas", "velocity") - v), fabs(mean(sim, "dust", "velocity") - v));
    sph_sim_stats stats;
    sph_sim_get_stats(sim, &stats);
    double momentum = balance.momentum[0] / (rho_dust * speed) - 1;
    print_message("# K = %g: %ld steps, off by %.2g, momentum %.2g\n", K, stats.step.steps, off,
                  momentum);
    steps[K > 1e4] = stats.step.steps > steps[K > 1e4] ? stats.step.steps : steps[K > 1e4];
    assert_true(off < 1e-4);
    assert_true(fabs(momentum) < 1e-6);
    sph_sim_free(sim);
  }
  assert_true(steps[1] < 2 * steps[0]);
}

/* ---- sound ---- */

/* rms of the velocities of gas and dust from the exact ones, over the amplitude, at t = L/c. */
static double wave_error(long n, double K, const char *method, long *steps)
{
  const double e = 1e-6, k = 2 * pi;
  const sph_exact_dusty_wave exact = {rho_gas, rho_dust, 1, K, e, k};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                               .dx = 1.0 / (double)n,
                                               .kernel = "cubic-spline",
                                               .h_over_dx = 2,
                                               .periodic = {1},
                                               .length = {1},
                                               .speed = 1});
  double sum = 0, right[1024];
  assert_true(n <= 1024);
  for (int g = 0; g < 2; g++) {
    sph_group *group = sph_group_box(sim, g ? "dust" : "gas", (double[]){0}, (double[]){1},
                                     g ? rho_dust : rho_gas);
    sph_group_set_eos(group, g ? sph_eos_dust() : sph_eos_linear(rho_gas, 1, -INFINITY));
    const double *x = sph_group_read(group, "position", 0);
    double *v = sph_group_write(group, "velocity", 0), *rho = sph_group_write(group, "density", 0);
    double *m = sph_group_write(group, "mass", 0);
    for (long i = 0; i < n; i++) {
      v[i] = e * cos(k * x[i]);
      rho[i] *= 1 + e * cos(k * x[i]);
      m[i] *= 1 + e * cos(k * x[i]);
    }
  }
  sph_sim_add_term(sim, sph_term_continuity_form("c1"));
  sph_sim_add_term(sim, sph_term_pressure_form("s"));
  sph_sim_add_term(sim, sph_term_drag(K));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .tolerance = 1e-8});
  if (sph_sim_run(sim, 1)) fail_msg("%s", sph_sim_error(sim));
  for (int g = 0; g < 2; g++) {
    const sph_group *group = sph_sim_group(sim, g ? "dust" : "gas");
    const double *x = sph_group_read(group, "position", 0),
                 *v = sph_group_read(group, "velocity", 0);
    assert_int_equal(sph_exact_dusty_wave_at(&exact, 1, g, n, x, NULL, right, NULL), SPH_OK);
    for (long i = 0; i < n; i++) sum += (v[i] - right[i]) * (v[i] - right[i]);
  }
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  if (steps) *steps = stats.step.steps;
  sph_sim_free(sim);
  return sqrt(sum / (double)(2 * n)) / e;
}

/* Second order in dx at fixed h/dx, for weak and for strong drag that is resolved. */
static void sound(void **state)
{
  (void)state;
  for (double K = 0.3; K < 20; K *= 6) {
    double coarse = wave_error(64, K, NULL, NULL), fine = wave_error(256, K, NULL, NULL);
    print_message("# K = %g: %.3g, %.3g, order %.2f\n", K, coarse, fine, log2(coarse / fine) / 2);
    assert_true(fine < 5e-3 && log2(coarse / fine) / 2 > 1.8);
  }
}

/* Stiff, and h > c t_s: both damp far too much (Laibe & Price 2012, section 4.2), implicit steps as
 * explicit ones do, in far fewer. */
static void implicit_sound(void **state)
{
  (void)state;
  long many, few;
  double explicit_one = wave_error(64, 300, NULL, &many);
  double implicit_one = wave_error(64, 300, "imex:ark324l2sa-4-2-3", &few);
  print_message("# K = 300: explicit %.4g in %ld steps, implicit %.4g in %ld\n", explicit_one, many,
                implicit_one, few);
  assert_true(fabs(implicit_one / explicit_one - 1) < 1e-2 && few * 4 < many);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(streams_of_all_dimensions),
      cmocka_unit_test(order),
      cmocka_unit_test(heat),
      cmocka_unit_test(every_integrator_is_stable),
      cmocka_unit_test(stiff_limit),
      cmocka_unit_test(sound),
      cmocka_unit_test(implicit_sound),
  };
  return cmocka_run_group_tests_name("drag", tests, NULL, NULL);
}
