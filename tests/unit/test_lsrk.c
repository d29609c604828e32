/* Stabilised schemes on stiff equations: order, as many stages as the bound of the eigenvalues asks
 * for, errors held, failures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "ode.h"

typedef struct stiff {
  ode o; /* first: callbacks get a pointer to it */
  double rate, bound;
  int asked, dominant_status;
} stiff;

static int dominant(double t, N_Vector y, double *lambda, void *ctx)
{
  stiff *s = ctx;
  (void)t, (void)y;
  s->asked++;
  *lambda = s->bound;
  return s->dominant_status;
}

/* Five quantities relax to cos(t + k) at rates up to `rate`. */
static double rate_of(const stiff *s, int k) { return s->rate * pow(10, -k); }

static void relaxing_exact(double t, double *y)
{
  memset(y, 0, ODE_LENGTH * sizeof *y);
  for (int k = 0; k < 5; k++) y[8 * k] = cos(t + k);
}

static int relaxing(double t, N_Vector state, N_Vector rate, void *ctx)
{
  stiff *s = ctx;
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate);
  for (int k = 0; k < 5; k++) f[8 * k] = -rate_of(s, k) * (y[8 * k] - cos(t + k)) - sin(t + k);
  long n = s->o.calls++ - s->o.fail_from;
  return s->o.fail_count && n >= 0 && n < s->o.fail_count ? s->o.fail_status : SPH_OK;
}

static void make(stiff *s, double rate)
{
  *s = (stiff){.rate = rate, .bound = rate};
  ode_decay(&s->o);
  s->o.problem.ctx = s;
  s->o.problem.rhs = relaxing;
  s->o.problem.dominant = dominant;
  s->o.exact = relaxing_exact;
}

static const char *const method[] = {"lsrk:rkc-2", "lsrk:rkl-2"};

static int have_rows(void)
{
  sph_error error = {0};
  int status = sph_integrator_check(&(sph_integrator_def){.method = method[0]}, &error);
  if (!status) return 1;
  assert_int_equal(status, SPH_ERR_UNBUILT);
  print_message("# skipped: %s\n", error.text);
  return 0;
}

static double error_of(const char *name, int n, double rate)
{
  stiff s;
  double most = 0;
  make(&s, rate);
  ode_start(&s.o, &(sph_integrator_def){.method = name, .dt_fixed = 0.25 / n});
  for (int k = 1; k <= 8; k++) {
    if (ode_run(&s.o, 0.25 * k)) fail_msg("%s: %s", name, s.o.error.text);
    most = fmax(most, ode_error(&s.o, 0.25 * k, s.o.y));
  }
  ode_end(&s.o);
  return most;
}

/* rate dt from 2000 to 30, and from 2 to 0.03. */
static void order_is_kept_where_it_is_stiff(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 4; k++) {
    double rate = k < 2 ? 1e4 : 10, slope[2] = {0, 0}, error = error_of(method[k % 2], 1, rate);
    for (int n = 2; n <= 64; n *= 2) {
      double finer = error_of(method[k % 2], n, rate);
      slope[0] = slope[1];
      slope[1] = log2(error / finer);
      error = finer;
    }
    print_message("# %s, rate %g: order %.2f, %.2f, error %.1e\n", method[k % 2], rate, slope[0],
                  slope[1], error);
    if (!(fmax(slope[0], slope[1]) >= 1.9)) fail_msg("%s: order %.2f", method[k % 2], slope[1]);
  }
}

/* RKC: s^2 = 1 + 1.54 lambda dt; RKL: (s^2 + s - 2)/2 = lambda dt: Verwer, Sommeijer & Hundsdorfer
 * (2004), Meyer, Balsara & Aslam (2014).  An explicit scheme of two stages would take lambda dt of
 * them. */
static void stages_grow_with_the_root_of_the_bound(void **state)
{
  static const double z[] = {1, 10, 100, 1000, 10000};
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 10; k++) {
    double lambda = z[k / 2] / 0.1;
    double stages = k % 2 ? (sqrt(9 + 8 * z[k / 2]) - 1) / 2 : sqrt(1 + 1.54 * z[k / 2]);
    stiff s;
    make(&s, lambda);
    ode_start(&s.o, &(sph_integrator_def){.method = method[k % 2], .dt_fixed = 0.1});
    assert_int_equal(ode_run(&s.o, 10), SPH_OK);
    double calls = (double)s.o.calls / 100;
    print_message("# %s: lambda dt = %g, %.2f evaluations a step\n", method[k % 2], z[k / 2],
                  calls);
    if (!(fabs(calls - fmax(2, ceil(stages))) < 0.1))
      fail_msg("%s: %.2f evaluations a step, %.2f expected", method[k % 2], calls, ceil(stages));
    assert_true(ode_error(&s.o, 10, s.o.y) < 0.05);
    assert_in_range(s.asked, 99, 102); /* once a step */
    ode_end(&s.o);
  }
}

/* A bound that is too low is not enough: the test above is one of stability. */
static void too_low_a_bound_is_unstable(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 2; k++) {
    stiff s;
    make(&s, 1e4);
    s.bound = 4e3;
    ode_start(&s.o, &(sph_integrator_def){.method = method[k], .dt_fixed = 0.1});
    assert_int_equal(ode_run(&s.o, 10), SPH_OK);
    assert_true(!(fabs(sph_nvector_data(s.o.y)[0]) < 1e6));
    ode_end(&s.o);
  }
}

static void errors_are_held(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 2; k++) {
    double steps[2];
    for (int fine = 0; fine < 2; fine++) {
      double tolerance = fine ? 1e-6 : 1e-3;
      stiff s;
      make(&s, 1e3);
      ode_start(&s.o, &(sph_integrator_def){.method = method[k], .tolerance = tolerance});
      assert_int_equal(ode_run(&s.o, 5), SPH_OK);
      double error = ode_error(&s.o, 5, s.o.y);
      steps[fine] = (double)sph_integrator_stats(s.o.it)->steps;
      print_message("# %s, tolerance %g: error %.1e, %g steps\n", method[k], tolerance, error,
                    steps[fine]);
      assert_true(error < 20 * tolerance && error > 1e-3 * tolerance);
      ode_end(&s.o);
    }
    assert_true(steps[1] > 3 * steps[0] && steps[1] < 40 * steps[0]);
  }
}

static void failures_are_repeated_and_told(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 4; k++) {
    stiff s;
    make(&s, 100);
    s.o.limit[SPH_BOUND_CFL] = 0.1;
    s.o.fail_from = 61;
    s.o.fail_count = 2;
    ode_start(&s.o, &(sph_integrator_def){.method = method[k % 2], .tolerance = k < 2 ? -1 : 1});
    assert_int_equal(ode_run(&s.o, 2), SPH_OK);
    assert_int_equal(sph_integrator_stats(s.o.it)->retries, 2);
    assert_true(ode_error(&s.o, 2, s.o.y) < 1e-2);
    s.dominant_status = SPH_RETRY; /* the bound cannot be had */
    assert_int_equal(ode_run(&s.o, 3), SPH_ERR_STEP);
    assert_non_null(strstr(s.o.error.text, "after 12 halvings"));
    ode_end(&s.o);
  }
}

/* 200 stages serve lambda dt up to 26000 (RKC) or 20100 (RKL): longer steps are halved. */
static void steps_of_too_many_stages_are_halved(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 2; k++) {
    stiff s;
    make(&s, 1e6);
    s.o.limit[SPH_BOUND_CFL] = 1;
    ode_start(&s.o, &(sph_integrator_def){.method = method[k], .tolerance = -1});
    if (ode_run(&s.o, 1)) fail_msg("%s", s.o.error.text);
    const sph_step_stats *stats = sph_integrator_stats(s.o.it);
    assert_true(stats->retries > 0 && stats->dt_largest < (k ? 0.0201 : 0.0261));
    assert_true(ode_error(&s.o, 1, s.o.y) < 1e-3);
    ode_end(&s.o);
    make(&s, 1e6);
    ode_start(&s.o, &(sph_integrator_def){.method = method[k], .dt_fixed = 0.1});
    assert_int_equal(ode_run(&s.o, 1), SPH_ERR_STEP);
    assert_non_null(strstr(s.o.error.text, "more than 200 stages"));
    ode_end(&s.o);
  }
}

static void reset_is_a_new_start(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 4; k++) {
    const sph_integrator_def def = {.method = method[k % 2], .tolerance = k < 2 ? -1 : 1e-3};
    stiff s, fresh;
    make(&s, 100);
    make(&fresh, 100);
    s.o.limit[SPH_BOUND_CFL] = fresh.o.limit[SPH_BOUND_CFL] = 0.1;
    ode_start(&s.o, &def);
    ode_start(&fresh.o, &def);
    assert_int_equal(ode_run(&s.o, 0.5), SPH_OK);
    s.o.exact(0, sph_nvector_data(s.o.y));
    assert_int_equal(sph_integrator_reset(s.o.it, 0), SPH_OK);
    s.o.time = 0;
    assert_int_equal(ode_run(&s.o, 1), SPH_OK);
    assert_int_equal(ode_run(&fresh.o, 1), SPH_OK);
    assert_memory_equal(sph_nvector_data(s.o.y), sph_nvector_data(fresh.o.y),
                        ODE_LENGTH * sizeof(double));
    ode_end(&s.o);
    ode_end(&fresh.o);
  }
}

static double dense_error(const char *name, int n)
{
  stiff s;
  double most = 0;
  make(&s, 1e4);
  ode_start(&s.o, &(sph_integrator_def){.method = name, .dt_fixed = 2.0 / n});
  N_Vector at = N_VClone(s.o.y);
  while (sph_integrator_time(s.o.it) < 2) {
    assert_int_equal(sph_integrator_step(s.o.it, 2), SPH_OK);
    double t0 = sph_integrator_previous(s.o.it), t1 = sph_integrator_time(s.o.it);
    for (int k = 0; k <= 4; k++) {
      double t = t0 + k * (t1 - t0) / 4;
      assert_int_equal(sph_integrator_interpolate(s.o.it, t, at), SPH_OK);
      most = fmax(most, ode_error(&s.o, t, at));
    }
  }
  N_VDestroy(at);
  ode_end(&s.o);
  return most;
}

/* Errors inside a step are those at its ends: 1.3 times these at most. */
static void dense_output_is_as_good_as_the_steps(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 2; k++) {
    double coarse = dense_error(method[k], 40), fine = dense_error(method[k], 80);
    double ends = error_of(method[k], 10, 1e4);
    print_message("# %s: dense output %.1e, at the ends %.1e, order %.2f\n", method[k], fine, ends,
                  log2(coarse / fine));
    assert_true(fine < 1.3 * ends && log2(coarse / fine) > 1.8);
  }
}

static void stop_times_and_dense_output(void **state)
{
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; k < 4; k++) {
    stiff s;
    make(&s, 1000);
    s.o.limit[SPH_BOUND_CFL] = 0.02;
    ode_start(&s.o, &(sph_integrator_def){.method = method[k % 2], .tolerance = k < 2 ? -1 : 1});
    double stops[] = {0.3, 0.3 + 1e-9, 0.7, 1};
    for (int i = 0; i < 4; i++) {
      assert_int_equal(ode_run(&s.o, stops[i]), SPH_OK);
      assert_true(sph_integrator_time(s.o.it) == stops[i]);
    }
    N_Vector at = N_VClone(s.o.y);
    for (int i = 0; i <= 4; i++) {
      double t = sph_integrator_previous(s.o.it), h = sph_integrator_time(s.o.it) - t;
      assert_int_equal(sph_integrator_interpolate(s.o.it, t + i * h / 4, at), SPH_OK);
      assert_true(ode_error(&s.o, t + i * h / 4, at) < 1e-4);
    }
    N_VDestroy(at);
    ode_end(&s.o);
  }
}

static void no_bound_is_refused(void **state)
{
  (void)state;
  if (!have_rows()) return;
  ode o;
  ode_made(&o);
  o.it = sph_integrator_create(&(sph_integrator_def){.method = "lsrk:rkl-2"}, &o.problem, 0, o.y,
                               o.context, &o.error);
  assert_null(o.it);
  assert_non_null(strstr(o.error.text, "bound of the eigenvalues"));
  ode_end(&o);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(order_is_kept_where_it_is_stiff),
      cmocka_unit_test(stages_grow_with_the_root_of_the_bound),
      cmocka_unit_test(too_low_a_bound_is_unstable),
      cmocka_unit_test(errors_are_held),
      cmocka_unit_test(failures_are_repeated_and_told),
      cmocka_unit_test(steps_of_too_many_stages_are_halved),
      cmocka_unit_test(reset_is_a_new_start),
      cmocka_unit_test(dense_output_is_as_good_as_the_steps),
      cmocka_unit_test(stop_times_and_dense_output),
      cmocka_unit_test(no_bound_is_refused),
  };
  return cmocka_run_group_tests_name("lsrk", tests, NULL, NULL);
}
