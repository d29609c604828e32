/* The integrators on equations with known solutions: order, dense output, stop times, limits,
 * retries, refusals, threads; and that nothing is ever printed. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <complex.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "integrator_table.h"
#include "ode.h"

static const double TURN = 6.283185307179586;

typedef void (*problem)(ode *o);

/* One of each kind of stepping, for what does not depend on the formulas. */
static const char *const method[] = {"leapfrog", NULL,          "erk:zonneveld-5-3-4", "symplectic",
                                     "dkd",      "verlet-dual", "erk:rdpk3sp35-5-2-3"};
enum { METHODS = sizeof method / sizeof *method };

/* Largest error at `stops` times up to t_end, with n steps between them. */
static double error_of(problem make, const char *name, double t_end, int stops, int n)
{
  ode o;
  double most = 0;
  make(&o);
  ode_start(&o, &(sph_integrator_def){.method = name, .dt_fixed = t_end / (stops * n)});
  for (int k = 1; k <= stops; k++) {
    if (ode_run(&o, k * t_end / stops)) fail_msg("%s: %s", name, o.error.text);
    most = fmax(most, ode_error(&o, k * t_end / stops, o.y));
  }
  assert_int_equal(sph_integrator_stats(o.it)->steps, stops * n);
  ode_end(&o);
  return most;
}

/* Steps are halved until the error nears rounding or n_max is reached: of the last two slopes
 * the better.  Before SUNDIALS 7.3 the coefficients of verner-9-5-6 end behind 14 digits, and are
 * as large as 208. */
static double least = INFINITY; /* order, more than the nominal one */

static void assert_order(problem make, const sph_integrator_info *info, double t_end, int stops,
                         int n_max)
{
  const double floor = strcmp(info->name, "erk:verner-9-5-6") ? 1e-12 : 1e-11;
  double error = error_of(make, info->name, t_end, stops, 2), slope[2] = {0, 0};
  for (int n = 4; n <= n_max; n *= 2) {
    double finer = error_of(make, info->name, t_end, stops, n);
    if (finer < floor && n > 4) break;
    slope[0] = slope[1];
    slope[1] = log2(error / finer);
    error = finer;
  }
  least = fmin(least, fmax(slope[0], slope[1]) - info->order);
  if (!(fmax(slope[0], slope[1]) >= info->order - 0.1))
    fail_msg("%s: order %.2f, %.2f, nominal %d (error %.2e)", info->name, slope[0], slope[1],
             info->order, error);
}

static void every_scheme_has_its_order(void **state)
{
  (void)state;
  sph_integrator_info info;
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (info.wants) continue; /* test_imex.c */
    assert_in_range(info.order, 1, 9);
    /* forward-euler, and its steps in verlet-dual, need small ones */
    int more = info.order == 1 || !strcmp(info.name, "verlet-dual") ? 8 : 1;
    if (info.order <= 4) assert_order(ode_kepler, &info, TURN, 1, more * 2048);
    assert_order(ode_made, &info, 4, 8, more * 256);
    assert_order(ode_drift, &info, 4, 8, more * 256);
  }
  print_message("# least order - nominal: %.2f\n", least);
}

/* Largest error at the ends of steps h (1 + 0.3 sin t) up to t = 6, none cut short. */
static double error_of_varied(problem make, const char *name, double h)
{
  ode o;
  double most = 0;
  make(&o);
  o.limit[SPH_BOUND_FORCE] = h;
  o.breathe = 0.3;
  ode_start(&o, &(sph_integrator_def){.method = name});
  while (sph_integrator_time(o.it) < 6) {
    assert_int_equal(sph_integrator_step(o.it, 100), SPH_OK);
    most = fmax(most, ode_error(&o, sph_integrator_time(o.it), o.y));
  }
  const sph_step_stats *stats = sph_integrator_stats(o.it);
  assert_int_equal(stats->bound_by[SPH_BOUND_FORCE], stats->steps);
  assert_true(fabs(stats->dt_largest / h - 1.3) < 0.01);
  ode_end(&o);
  return most;
}

/* A two-step formula in which 2h stands for h' + h is right for constant steps alone. */
static void steps_that_vary_keep_the_order(void **state)
{
  static const char *const name[] = {"verlet-dual", "leapfrog", "dkd", "predictor-corrector",
                                     "symplectic"};
  (void)state;
  for (int k = 0; k < 10; k++) {
    problem make = k % 2 ? ode_drift : ode_made;
    double coarse = error_of_varied(make, name[k / 2], 2e-3);
    double fine = error_of_varied(make, name[k / 2], 1e-3), order = log2(coarse / fine);
    print_message("# %s: %.2e, %.2e, order %.2f\n", name[k / 2], coarse, fine, order);
    if (!(order >= 1.9)) fail_msg("%s, varied steps: order %.2f", name[k / 2], order);
  }
}

static void rows_tell_the_truth(void **state)
{
  (void)state;
  sph_integrator_info info;
  int k = 0;
  for (; sph_integrator_info_get(k, &info); k++) {
    if (info.wants) continue;
    ode o;
    ode_made(&o);
    ode_start(&o, &(sph_integrator_def){.method = info.name, .dt_fixed = 0.01});
    assert_int_equal(ode_run(&o, 1), SPH_OK);
    double calls = (double)sph_integrator_stats(o.it)->rhs_evaluations;
    if (!(calls >= 100 * info.stages && calls <= 102 * info.stages + 2))
      fail_msg("%s: %g evaluations in 100 steps, %d stages", info.name, calls, info.stages);
    assert_int_equal(calls, o.calls);
    assert_true(info.stability > 0.1 && info.stability < 6);
    ode_end(&o);
  }
  assert_true(k >= 17);
  assert_int_equal(sph_integrator_info_get(-1, &info), 0);
  assert_string_equal(sph_bound_name(SPH_BOUND_CFL), "cfl");
  assert_string_equal(sph_bound_name(SPH_BOUND_RETRY), "retry");
  assert_string_equal(sph_bound_name(99), "");
}

/* Largest error of the state inside the steps. */
static double dense_error(problem make, const char *name, int n)
{
  ode o;
  double most = 0;
  make(&o);
  ode_start(&o, &(sph_integrator_def){.method = name, .dt_fixed = 2.0 / n});
  N_Vector at = N_VClone(o.y);
  while (sph_integrator_time(o.it) < 2) {
    assert_int_equal(sph_integrator_step(o.it, 2), SPH_OK);
    double t0 = sph_integrator_previous(o.it), t1 = sph_integrator_time(o.it);
    for (int k = 0; k <= 4; k++) {
      double t = t0 + k * (t1 - t0) / 4;
      assert_int_equal(sph_integrator_interpolate(o.it, t, at), SPH_OK);
      most = fmax(most, ode_error(&o, t, at));
    }
  }
  N_VDestroy(at);
  ode_end(&o);
  return most;
}

static void dense_output_keeps_the_order(void **state)
{
  static const struct {
    const char *method;
    double order;
  } row[] = {{"leapfrog", 2},    {"dkd", 2},
             {"midpoint", 2},    {"predictor-corrector", 2},
             {"symplectic", 2},  {"erk:bogacki-shampine-4-2-3", 3},
             {"verlet-dual", 2}, {"erk:dormand-prince-7-4-5", 4}};
  (void)state;
  for (size_t k = 0; k < 2 * sizeof row / sizeof *row; k++) {
    problem make = k % 2 ? ode_drift : ode_made;
    const char *name = row[k / 2].method;
    int n = strcmp(name, "verlet-dual") ? 80 : 1280;
    double order = log2(dense_error(make, name, n) / dense_error(make, name, 2 * n));
    if (!(order > row[k / 2].order - 0.1)) fail_msg("%s: dense order %.2f", name, order);
  }
}

/* Rates are those of the ends of steps, the start of the next being the end of the last. */
static void dense_output_has_no_corners(void **state)
{
  (void)state;
  const double h = 0.02, e = h / 100; /* q'' is 4 at most */
  ode o;
  ode_made(&o);
  ode_start(&o, &(sph_integrator_def){.method = "leapfrog", .dt_fixed = h});
  N_Vector at = N_VClone(o.y);
  for (int k = 1; k < 50; k += 2) {
    double slope[2], end;
    assert_int_equal(sph_integrator_step(o.it, 2), SPH_OK);
    end = sph_nvector_data(o.y)[ODE_Q];
    assert_int_equal(sph_integrator_interpolate(o.it, k * h - e, at), SPH_OK);
    slope[0] = (end - sph_nvector_data(at)[ODE_Q]) / e;
    assert_int_equal(sph_integrator_step(o.it, 2), SPH_OK);
    assert_int_equal(sph_integrator_interpolate(o.it, k * h + e, at), SPH_OK);
    slope[1] = (sph_nvector_data(at)[ODE_Q] - end) / e;
    assert_true(fabs(slope[1] - slope[0]) < 8 * e);
  }
  N_VDestroy(at);
  ode_end(&o);
}

/* A central force of position alone: the energy of the leapfrog orbit comes back, for hundreds
 * of turns. */
static void leapfrog_keeps_the_energy(void **state)
{
  (void)state;
  ode o;
  ode_kepler(&o);
  ode_start(&o, &(sph_integrator_def){.method = "leapfrog", .dt_fixed = TURN / 100});
  const double *y = sph_nvector_data(o.y);
  double worst[2] = {0, 0};
  for (int turn = 0; turn < 200; turn++) {
    assert_int_equal(ode_run(&o, (turn + 1) * TURN), SPH_OK);
    double energy = (y[ODE_U] * y[ODE_U] + y[ODE_V] * y[ODE_V]) / 2 - 1 / hypot(y[ODE_X], y[ODE_Y]);
    worst[turn / 100] = fmax(worst[turn / 100], fabs(energy + 0.5));
  }
  assert_true(worst[0] > 1e-7 && worst[1] < 1.05 * worst[0] && worst[1] < 2e-3);
  ode_end(&o);
}

/* Heun's method amplifies an oscillation by |1 + z + z^2/2| a step, z = i/2: 1.0078.  Leapfrog does
 * not, nor does the predictor-corrector, which moves x with the corrected velocity. */
static void only_heun_amplifies_oscillations(void **state)
{
  static const char *const name[] = {"erk:heun-euler-2-1-2", "leapfrog", "dkd",
                                     "predictor-corrector", "symplectic"};
  (void)state;
  for (int k = 0; k < 5; k++) {
    ode o;
    double most = 0;
    ode_oscillator(&o);
    ode_start(&o, &(sph_integrator_def){.method = name[k], .dt_fixed = 0.5});
    const double *y = sph_nvector_data(o.y);
    for (int n = 1; n <= 1000; n++) {
      assert_int_equal(sph_integrator_step(o.it, 1e4), SPH_OK);
      most = fmax(most, hypot(y[ODE_X], y[ODE_U]));
    }
    if (k == 0)
      assert_float_equal(log(most) / 1000, log(hypot(1 - 0.125, 0.5)), 1e-6);
    else
      assert_true(most < 1.2);
    ode_end(&o);
  }
}

/* y' = -y, one evaluation a step: the two-step formula grows by sqrt(1 + h^2) + h a step in its
 * second solution, (-1)^n, which an Euler step every 40 cuts back. */
static void verlet_dual_forgets_every_40_steps(void **state)
{
  (void)state;
  ode o;
  ode_decay(&o);
  ode_start(&o, &(sph_integrator_def){.method = "verlet-dual", .dt_fixed = 0.1});
  double gap[2] = {0, 0}, last = 0;
  for (int n = 1; n <= 41; n++) {
    assert_int_equal(sph_integrator_step(o.it, 100), SPH_OK);
    double error = sph_nvector_data(o.y)[ODE_Q] - exp(-0.1 * n);
    if (n == 40) gap[0] = fabs(error - last);
    if (n == 41) gap[1] = fabs(error - last);
    last = error;
  }
  double growth = sqrt(1 + 0.1 * 0.1) + 0.1, seed = 0.1 * 0.1 / 2;
  assert_true(gap[0] > 0.2 * seed * pow(growth, 40) && gap[0] < 2 * seed * pow(growth, 40));
  assert_true(gap[1] < 0.2 * gap[0]);
  ode_end(&o);
}

static void stop_times_are_exact(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * METHODS; k++) {
    ode o;
    ode_made(&o);
    o.limit[SPH_BOUND_CFL] = 0.1;
    ode_start(&o, &(sph_integrator_def){.method = method[k / 2], .tolerance = k % 2 ? -1 : 0});
    double stops[] = {0.3, 0.3 + 1e-9, 0.7, 1, 1 + 1e-15, 2};
    for (int s = 0; s < 6; s++) {
      assert_int_equal(ode_run(&o, stops[s]), SPH_OK);
      assert_true(sph_integrator_time(o.it) == stops[s]);
    }
    const sph_step_stats *stats = sph_integrator_stats(o.it);
    assert_true(stats->steps <=
                2 / stats->dt_largest + 12); /* a sliver does not slow what follows */
    assert_in_range(stats->bound_by[SPH_BOUND_STOP], 2, 6);
    assert_true(ode_error(&o, 2, o.y) < 0.01);
    ode_end(&o);
  }
}

static void limits_bind_and_are_recorded(void **state)
{
  static const struct {
    const char *method;
    double S;
  } row[] = {{"leapfrog", 0.62}, {NULL, 1.98}, {"erk:heun-euler-2-1-2", 1.07}};
  (void)state;
  for (int k = 0; k < 6; k++) {
    ode o;
    int cfl = k % 2;
    ode_made(&o);
    o.limit[SPH_BOUND_CFL] = 0.02;
    o.limit[SPH_BOUND_FORCE] = cfl ? 1 : 0.003;
    ode_start(&o, &(sph_integrator_def){.method = row[k / 2].method, .cfl = 0.9});
    assert_int_equal(ode_run(&o, 2), SPH_OK);
    const sph_step_stats *stats = sph_integrator_stats(o.it);
    double expected = cfl ? 0.9 * row[k / 2].S * 0.02 : 0.003;
    assert_true(fabs(stats->dt_largest / expected - 1) < 1e-9);
    assert_true(fabs(stats->dt_smallest / expected - 1) < 1e-9);
    int bound = cfl ? SPH_BOUND_CFL : SPH_BOUND_FORCE;
    assert_true(stats->bound_by[bound] >= stats->steps - 1);
    assert_true((double)stats->steps <= 2 / expected + 1);
    ode_end(&o);
  }
}

static void error_control_holds_the_tolerance(void **state)
{
  (void)state;
  double steps[2];
  for (int k = 0; k < 2; k++) {
    double tolerance = k ? 1e-7 : 1e-4;
    ode o;
    ode_kepler(&o);
    o.problem.limits = NULL;
    ode_start(&o, &(sph_integrator_def){.tolerance = tolerance});
    assert_int_equal(ode_run(&o, TURN), SPH_OK);
    double error = ode_error(&o, TURN, o.y);
    assert_true(error > tolerance && error < 100 * tolerance);
    const sph_step_stats *stats = sph_integrator_stats(o.it);
    assert_true(stats->bound_by[SPH_BOUND_ERROR] >= stats->steps - 1);
    steps[k] = (double)stats->steps;
    ode_end(&o);
  }
  assert_float_equal(log(steps[1] / steps[0]) / log(1e3), 1.0 / 3,
                     0.05); /* steps ~ tolerance^(-1/3) */
}

/* |sum_k (ih)^k (b - d)^T A^(k-1) 1| */
static double estimate_of(ARKodeButcherTable t, double h)
{
  double complex sum = 0, z = 1;
  double v[32], next[32];
  for (int i = 0; i < t->stages; i++) v[i] = 1;
  for (int k = 1; k <= t->stages; k++) {
    z *= I * h;
    for (int i = 0; i < t->stages; i++) {
      sum += z * (t->b[i] - t->d[i]) * v[i];
      next[i] = 0;
      for (int j = 0; j < t->stages; j++) next[i] += t->A[i][j] * v[j];
    }
    memcpy(v, next, sizeof v);
  }
  return cabs(sum);
}

/* The estimate of Bogacki & Shampine (1989) for y' = z/h y is y (z^3 + z^4)/48, so that for the
 * oscillator its rms over five entries is h^3 sqrt(1 + h^2)/(48 sqrt 5); the controller settles
 * at 0.9^3 of the tolerance. */
static void the_step_size_settles_where_it_should(void **state)
{
  const double tolerance = 1e-6;
  (void)state;
  ode o;
  ode_oscillator(&o);
  o.problem.limits = NULL;
  ode_start(&o, &(sph_integrator_def){.tolerance = tolerance});
  assert_int_equal(ode_run(&o, 5), SPH_OK);
  for (int k = 0; k < 100; k++) {
    assert_int_equal(sph_integrator_step(o.it, 100), SPH_OK);
    double h = sph_integrator_stats(o.it)->dt_last;
    double estimate = h * h * h * sqrt(1 + h * h) / (48 * sqrt(5));
    if (k > 20) assert_float_equal(estimate / tolerance, 0.9 * 0.9 * 0.9, 0.01);
  }
  ode_end(&o);
}

/* The same for the controllers with memory: 0.9 (1 + arctan(x - 1)) = 1 with x = e^(-sum beta/p)
 * where the estimate e, |R(ih) - Rhat(ih)| of the oscillator, stays. */
static void controllers_with_memory_settle(void **state)
{
  static const struct {
    const char *method;
    double beta;
  } row[] = {{"erk:rdpk3sp35-5-2-3", 0.64 - 0.31 + 0.04},
             {"erk:rdpk3sp49-9-3-4", 0.25 - 0.12},
             {"erk:rdpk3spfsal35-6-2-3", 0.70 - 0.23},
             {"erk:rdpk3spfsal49-10-3-4", 0.38 - 0.18 + 0.01}};
  const double tolerance = 1e-6, x = 1 + tan(1 / 0.9 - 1);
  (void)state;
  for (int k = 0; k < 4; k++) {
    ode o;
    ode_oscillator(&o);
    o.problem.limits = NULL;
    ode_start(&o, &(sph_integrator_def){.method = row[k].method, .tolerance = tolerance});
    ARKodeButcherTable t =
        sph_integrator_table_butcher(sph_integrator_table_find(row[k].method, NULL));
    for (int n = 0; n < 400; n++) {
      assert_int_equal(sph_integrator_step(o.it, 1000), SPH_OK);
      double e = estimate_of(t, sph_integrator_stats(o.it)->dt_last) / sqrt(5) / tolerance;
      if (n > 300) assert_float_equal(e / pow(x, -t->q / row[k].beta), 1, 0.01);
    }
    ARKodeButcherTable_Free(t);
    ode_end(&o);
  }
}

static void fixed_largest_and_smallest_steps(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    ode o;
    ode_made(&o);
    o.limit[SPH_BOUND_CFL] = 1e-3; /* recorded, not obeyed */
    ode_start(&o, &(sph_integrator_def){.method = k ? "verlet" : NULL, .dt_fixed = 0.01});
    assert_int_equal(ode_run(&o, 1), SPH_OK);
    assert_int_equal(sph_integrator_stats(o.it)->bound_by[SPH_BOUND_USER], 100);
    ode_end(&o);
    ode_made(&o);
    ode_start(&o, &(sph_integrator_def){.method = k ? "verlet" : NULL, .dt_max = 0.02});
    assert_int_equal(ode_run(&o, 1), SPH_OK);
    assert_int_equal(sph_integrator_stats(o.it)->steps, 50);
    ode_end(&o);
    ode_made(&o);
    o.limit[SPH_BOUND_CFL] = 1e-3;
    ode_start(&o, &(sph_integrator_def){.method = k ? "verlet" : NULL, .dt_min = 0.01});
    assert_int_equal(ode_run(&o, 1), SPH_ERR_STEP);
    assert_non_null(strstr(o.error.text, "bound by cfl) is below dt_min"));
    ode_end(&o);
  }
}

/* A rate that cannot be had at one moment costs one retry and nothing else. */
static void a_failed_evaluation_is_repeated(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * METHODS; k++) {
    ode o;
    ode_made(&o);
    o.limit[SPH_BOUND_CFL] = 0.01;
    o.fail_from = 41;
    o.fail_count = 2;
    ode_start(&o, &(sph_integrator_def){.method = method[k / 2], .tolerance = k % 2 ? -1 : 0});
    assert_int_equal(ode_run(&o, 2), SPH_OK);
    const sph_step_stats *stats = sph_integrator_stats(o.it);
    assert_int_equal(stats->retries, 2);
    assert_true(stats->bound_by[SPH_BOUND_RETRY] >= 1);
    assert_true(fabs(stats->dt_smallest * 4 / stats->dt_largest - 1) < 1e-6);
    assert_true(ode_error(&o, 2, o.y) < 1e-3);
    ode_end(&o);
  }
}

/* What goes on failing ends at the last good state, with a text that says all. */
static void lasting_failure_stops_at_the_last_good_state(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    ode o;
    ode_made(&o);
    o.limit[SPH_BOUND_CFL] = 0.01;
    o.fail_from = 60;
    o.fail_count = 1000;
    if (k >= 2) o.fail_status = SPH_ERR_STATE;
    ode_start(&o, &(sph_integrator_def){.method = k % 2 ? NULL : "leapfrog", .retries = 5});
    assert_int_equal(ode_run(&o, 2), k < 2 ? SPH_ERR_STEP : SPH_ERR_STATE);
    if (k < 2) assert_non_null(strstr(o.error.text, "after 5 halvings"));
    assert_int_equal(sph_integrator_stats(o.it)->retries, k < 2 ? 5 : 0);
    double t = sph_integrator_time(o.it);
    assert_true(t > 0.1 && ode_error(&o, t, o.y) < 1e-4);
    ode_end(&o);
  }
}

static void inadmissible_states_are_stepped_anew(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * METHODS; k++) {
    ode o;
    ode_made(&o);
    o.limit[SPH_BOUND_USER] = 0.04;
    o.reject_above = 0.021;
    ode_start(&o, &(sph_integrator_def){.method = method[k / 2], .tolerance = k % 2 ? -1 : 0});
    assert_int_equal(ode_run(&o, 1), SPH_OK);
    const sph_step_stats *stats = sph_integrator_stats(o.it);
    assert_true(stats->retries > 10 && stats->dt_largest <= 0.021);
    assert_true(stats->bound_by[SPH_BOUND_RETRY] > 10);
    assert_true(ode_error(&o, 1, o.y) < 1e-3);
    ode_end(&o);
  }
}

/* Steps up to t, at most `most`, each as long as h says, where it does; their lengths go there. */
static void steps_of(ode *o, double t, int most, const double *given, double *h)
{
  for (int k = 0; k < most && sph_integrator_time(o->it) < t; k++) {
    if (given) o->limit[SPH_BOUND_USER] = given[k + 1]; /* asked for where step k ends */
    assert_int_equal(sph_integrator_step(o->it, t), SPH_OK);
    if (h) h[k] = sph_integrator_stats(o->it)->dt_last;
  }
}

/* What an attempt that did not count has overwritten is there again. */
static void repeated_steps_are_those_of_the_shorter_length(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * METHODS; k++) {
    enum { MOST = 200 };
    double h[MOST + 1] = {0};
    ode o, other;
    ode_made(&o);
    o.limit[SPH_BOUND_USER] = 0.04;
    if (k % 2) o.reject_above = 0.021;
    o.fail_from = k % 2 ? 0 : 12;
    o.fail_count = k % 2 ? 0 : 2;
    ode_start(&o, &(sph_integrator_def){.method = method[k / 2], .tolerance = -1});
    steps_of(&o, 1, MOST, NULL, h);
    assert_true(sph_integrator_stats(o.it)->retries > 1);
    ode_made(&other);
    other.limit[SPH_BOUND_USER] = h[0];
    ode_start(&other, &(sph_integrator_def){.method = method[k / 2], .tolerance = -1});
    steps_of(&other, 1, MOST, h, NULL);
    assert_int_equal(sph_integrator_stats(other.it)->retries, 0);
    for (long i = 0; i < ODE_LENGTH; i++)
      assert_true(fabs(sph_nvector_data(o.y)[i] - sph_nvector_data(other.y)[i]) < 1e-13);
    ode_end(&o);
    ode_end(&other);
  }
}

/* y is changed between steps, then a reset: the same as a new start from there. */
static void reset_is_a_new_start(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * METHODS; k++) {
    int control = k == 2 * (METHODS - 1); /* errors, not limits, bind: the controller's memory */
    const sph_integrator_def def = {.method = method[k / 2],
                                    .tolerance = k % 2 ? -1 : control * 1e-6};
    ode o, fresh;
    ode_made(&o);
    ode_made(&fresh);
    o.limit[SPH_BOUND_CFL] = fresh.limit[SPH_BOUND_CFL] = control ? 1 : 0.02;
    ode_start(&o, &def);
    ode_start(&fresh, &def);
    assert_int_equal(ode_run(&o, 0.5), SPH_OK);
    o.exact(0, sph_nvector_data(o.y));
    assert_int_equal(sph_integrator_reset(o.it, 0), SPH_OK);
    o.time = 0;
    assert_int_equal(ode_run(&o, 1), SPH_OK);
    assert_int_equal(ode_run(&fresh, 1), SPH_OK);
    assert_memory_equal(sph_nvector_data(o.y), sph_nvector_data(fresh.y),
                        ODE_LENGTH * sizeof(double));
    ode_end(&o);
    ode_end(&fresh);
  }
}

static void misuse_is_refused_with_a_reason(void **state)
{
  static const struct {
    sph_integrator_def def;
    const char *text;
  } row[] = {
      {{.method = "erk:bogacki"}, "the nearest is"},
      {{.method = "verlett"}, "nearest is \"verlet\""},
      {{.method = "erk:bogacki-shampine-4-2-4"}, "nearest is \"erk:bogacki-shampine-4-2-3\""},
      {{.cfl = -1}, "cfl = -1"},
      {{.cfl = NAN}, "cfl = nan"},
      {{.tolerance = INFINITY}, "tolerance = inf"},
      {{.dt_max = -1}, "dt_max = -1"},
      {{.dt_min = -1}, "dt_min = -1"},
      {{.dt_fixed = -1}, "dt_fixed = -1"},
      {{.retries = -1}, "retries = -1"},
      {{.method = "leapfrog", .tolerance = 1e-3}, "no error estimate"},
  };
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    sph_error error = {0};
    assert_int_equal(sph_integrator_check(&row[k].def, &error), SPH_ERR_ARGUMENT);
    if (!strstr(error.text, row[k].text)) fail_msg("\"%s\" lacks \"%s\"", error.text, row[k].text);
  }
  ode o;
  ode_made(&o);
  ode_start(&o, &(sph_integrator_def){.method = "leapfrog"});
  assert_int_equal(sph_integrator_interpolate(o.it, 0.1, o.y), SPH_ERR_STATE);
  o.error = (sph_error){0};
  assert_int_equal(sph_integrator_step(o.it, 0), SPH_ERR_ARGUMENT);
  o.error = (sph_error){0};
  assert_int_equal(sph_integrator_step(o.it, NAN), SPH_ERR_ARGUMENT);
  o.error = (sph_error){0};
  assert_int_equal(sph_integrator_step(o.it, 1), SPH_ERR_ARGUMENT); /* nothing limits the step */
  ode_end(&o);
}

static void *work(void *ctx)
{
  ode *o = ctx;
  for (int k = 1; k <= 50; k++)
    if (ode_run(o, 0.1 * k)) return o;
  return NULL;
}

static void two_threads_do_not_meet(void **state)
{
  (void)state;
  ode o[3];
  pthread_t thread[2];
  void *failed;
  for (int k = 0; k < 3; k++) {
    ode_made(&o[k]);
    o[k].limit[SPH_BOUND_CFL] = 0.01;
    ode_start(&o[k], &(sph_integrator_def){.tolerance = 1e-5});
  }
  for (int k = 0; k < 2; k++) assert_int_equal(pthread_create(&thread[k], NULL, work, &o[k]), 0);
  assert_null(work(&o[2]));
  for (int k = 0; k < 2; k++) {
    pthread_join(thread[k], &failed);
    assert_null(failed);
    assert_memory_equal(sph_nvector_data(o[k].y), sph_nvector_data(o[2].y),
                        ODE_LENGTH * sizeof(double));
  }
  for (int k = 0; k < 3; k++) ode_end(&o[k]);
}

/* Failures of all kinds write nothing to stdout and stderr. */
static void nothing_is_printed(void **state)
{
  FILE *said = tmpfile();
  int keep[2];
  assert_non_null(said);
  fflush(NULL);
  for (int k = 0; k < 2; k++) {
    keep[k] = dup(k + 1);
    dup2(fileno(said), k + 1);
  }
  misuse_is_refused_with_a_reason(state);
  lasting_failure_stops_at_the_last_good_state(state);
  a_failed_evaluation_is_repeated(state);
  fflush(NULL);
  for (int k = 0; k < 2; k++) {
    dup2(keep[k], k + 1);
    close(keep[k]);
  }
  long bytes = lseek(fileno(said), 0, SEEK_END);
  fclose(said);
  assert_int_equal(bytes, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_scheme_has_its_order),
      cmocka_unit_test(steps_that_vary_keep_the_order),
      cmocka_unit_test(rows_tell_the_truth),
      cmocka_unit_test(dense_output_keeps_the_order),
      cmocka_unit_test(dense_output_has_no_corners),
      cmocka_unit_test(leapfrog_keeps_the_energy),
      cmocka_unit_test(only_heun_amplifies_oscillations),
      cmocka_unit_test(verlet_dual_forgets_every_40_steps),
      cmocka_unit_test(stop_times_are_exact),
      cmocka_unit_test(limits_bind_and_are_recorded),
      cmocka_unit_test(error_control_holds_the_tolerance),
      cmocka_unit_test(the_step_size_settles_where_it_should),
      cmocka_unit_test(controllers_with_memory_settle),
      cmocka_unit_test(fixed_largest_and_smallest_steps),
      cmocka_unit_test(a_failed_evaluation_is_repeated),
      cmocka_unit_test(lasting_failure_stops_at_the_last_good_state),
      cmocka_unit_test(inadmissible_states_are_stepped_anew),
      cmocka_unit_test(repeated_steps_are_those_of_the_shorter_length),
      cmocka_unit_test(reset_is_a_new_start),
      cmocka_unit_test(misuse_is_refused_with_a_reason),
      cmocka_unit_test(two_threads_do_not_meet),
      cmocka_unit_test(nothing_is_printed),
  };
  return cmocka_run_group_tests_name("integrator", tests, NULL, NULL);
}
