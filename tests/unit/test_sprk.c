/* Symplectic partitioned schemes on separable problems: order, energy, stability, dense output. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "ode.h"

static const double TURN = 6.283185307179586;

/* Force (px, py) at (t, x, y), for problems with dr/dt = v. */
typedef void (*force)(double t, const double *y, double *px, double *py);
static force force_now;

static void gravitation(double t, const double *y, double *px, double *py)
{
  double r = hypot(y[ODE_X], y[ODE_Y]);
  (void)t;
  *px = -y[ODE_X] / (r * r * r);
  *py = -y[ODE_Y] / (r * r * r);
}

static void spring(double t, const double *y, double *px, double *py)
{
  (void)t;
  *px = -y[ODE_X];
  *py = -y[ODE_Y];
}

/* x = sin 2t is forced, y = cos t is free. */
static void driven(double t, const double *y, double *px, double *py)
{
  spring(t, y, px, py);
  *px -= 3 * sin(2 * t);
}

static void driven_exact(double t, double *y)
{
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_X] = sin(2 * t);
  y[ODE_Y] = cos(t);
  y[ODE_U] = 2 * cos(2 * t);
  y[ODE_V] = -sin(t);
}

/* Every other entry of the rates is zero, as sph_problem says. */
static int piece(int number, double t, N_Vector state, N_Vector rate, void *ctx)
{
  ode *o = ctx;
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate);
  memset(f, 0, ODE_LENGTH * sizeof *f);
  if (number == SPH_PIECE_DRIFT) {
    f[ODE_X] = y[ODE_U];
    f[ODE_Y] = y[ODE_V];
    return SPH_OK;
  }
  force_now(t, y, &f[ODE_U], &f[ODE_V]);
  long k = o->calls++ - o->fail_from;
  return o->fail_count && k >= 0 && k < o->fail_count ? o->fail_status : SPH_OK;
}

static int rhs(double t, N_Vector y, N_Vector rate, void *ctx)
{
  const double *at = sph_nvector_data(y);
  int status = piece(SPH_PIECE_KICK, t, y, rate, ctx);
  sph_nvector_data(rate)[ODE_X] = at[ODE_U];
  sph_nvector_data(rate)[ODE_Y] = at[ODE_V];
  return status;
}

static void make(ode *o, force f)
{
  if (f == gravitation)
    ode_kepler(o);
  else
    ode_oscillator(o);
  force_now = f;
  o->problem.rhs = rhs;
  o->problem.rhs_piece = piece;
  if (f == driven) o->exact = driven_exact;
}

/* Rows "sprk:"; without any the test is skipped, with the reason. */
static int row(int k, sph_integrator_info *info)
{
  while (sph_integrator_info_get(k, info)) {
    if (info->wants & SPH_WANTS_SEPARABLE) return k + 1;
    k++;
  }
  return 0;
}

static int have_rows(void)
{
  sph_integrator_info info;
  sph_error error = {0};
  if (row(0, &info)) return 1;
  int status = sph_integrator_check(&(sph_integrator_def){.method = "sprk:mclachlan-4-4"}, &error);
  assert_int_equal(status, SPH_ERR_UNBUILT);
  print_message("# skipped: %s\n", error.text);
  return 0;
}

/* The largest at `stops` times; the orbit is known after whole turns. */
static double error_of(force f, const char *name, int n)
{
  ode o;
  double t_end = f == driven ? 4 : TURN, most = 0;
  int stops = f == driven ? 4 : 1;
  make(&o, f);
  ode_start(&o, &(sph_integrator_def){.method = name, .dt_fixed = t_end / (stops * n)});
  for (int k = 1; k <= stops; k++) {
    if (ode_run(&o, k * t_end / stops)) fail_msg("%s: %s", name, o.error.text);
    most = fmax(most, ode_error(&o, k * t_end / stops, o.y));
  }
  ode_end(&o);
  return most;
}

static void every_table_has_its_order(void **state)
{
  sph_integrator_info info;
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; (k = row(k, &info));)
    for (int p = 0; p < 2; p++) {
      force f = p ? driven : gravitation;
      int from = p ? 1 : 16, to = p ? 1024 : 8192;
      double error = error_of(f, info.name, from), slope[2] = {0, 0};
      for (int n = 2 * from; n <= to; n *= 2) {
        double finer = error_of(f, info.name, n);
        if (finer < 3e-12 && n > 2 * from) break;
        slope[0] = slope[1];
        slope[1] = log2(error / finer);
        error = finer;
      }
      double order = fmax(slope[0], slope[1]);
      print_message("# %-26s %-6s order %.2f (%d)\n", info.name, p ? "driven" : "orbit", order,
                    info.order);
      if (!(order >= info.order - 0.1))
        fail_msg("%s: order %.2f, nominal %d (error %.1e)", info.name, order, info.order, error);
    }
}

static void rows_tell_the_truth(void **state)
{
  sph_integrator_info info;
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; (k = row(k, &info));) {
    ode o;
    make(&o, gravitation);
    ode_start(&o, &(sph_integrator_def){.method = info.name, .dt_fixed = 0.01});
    assert_int_equal(ode_run(&o, 1), SPH_OK);
    assert_int_equal(info.error_control, 0);
    assert_in_range(sph_integrator_stats(o.it)->rhs_evaluations, 100 * info.stages,
                    100 * info.stages + 1);
    assert_int_equal(sph_integrator_stats(o.it)->rhs_evaluations, o.calls);
    ode_end(&o);
  }
}

/* x'' = -x with omega dt just inside and just outside the limit: S is the limit of waves with
 * omega = 1.16 c/h. */
static void stability_is_that_of_the_shortest_waves(void **state)
{
  sph_integrator_info info;
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; (k = row(k, &info));)
    for (int out = 0; out < 2; out++) {
      ode o;
      double limit = 1.16 * info.stability, most = 0;
      make(&o, spring);
      ode_start(&o, &(sph_integrator_def){.method = info.name,
                                          .dt_fixed = limit * (0.98 + 0.04 * out)});
      for (int n = 0; n < 2000 && most < 1e6; n++) {
        assert_int_equal(sph_integrator_step(o.it, 1e5), SPH_OK);
        most = fmax(most, fabs(sph_nvector_data(o.y)[ODE_X]));
      }
      if (out ? most < 1e6 : most > 100) fail_msg("%s: amplitude %.1e", info.name, most);
      ode_end(&o);
    }
}

static void energy_comes_back(void **state)
{
  sph_integrator_info info;
  (void)state;
  if (!have_rows()) return;
  for (int k = 0; (k = row(k, &info));) {
    ode o;
    double worst[2] = {0, 0};
    make(&o, gravitation);
    ode_start(&o, &(sph_integrator_def){.method = info.name, .dt_fixed = TURN / 101.3});
    const double *y = sph_nvector_data(o.y);
    for (int n = 0; n < 20000; n++) {
      assert_int_equal(sph_integrator_step(o.it, 1e9), SPH_OK);
      double e = (y[ODE_U] * y[ODE_U] + y[ODE_V] * y[ODE_V]) / 2 - 1 / hypot(y[ODE_X], y[ODE_Y]);
      worst[n / 10000] = fmax(worst[n / 10000], fabs(e + 0.5));
    }
    print_message("# %-26s energy within %.1e, then %.1e\n", info.name, worst[0], worst[1]);
    assert_true(worst[1] < 1.1 * worst[0] + 1e-12 && worst[1] < 0.1);
    ode_end(&o);
  }
}

static void stepping_is_that_of_all_schemes(void **state)
{
  (void)state;
  if (!have_rows()) return;
  ode o, fresh;
  const sph_integrator_def def = {.method = "sprk:mclachlan-4-4"};
  for (int k = 0; k < 2; k++) {
    ode *p = k ? &fresh : &o;
    make(p, driven);
    p->limit[SPH_BOUND_CFL] = 0.01;
    ode_start(p, &def);
  }
  o.fail_from = 41; /* two failures: two retries */
  o.fail_count = 2;
  double stops[] = {0.3, 0.3 + 1e-9, 0.7, 1};
  for (int s = 0; s < 4; s++) {
    assert_int_equal(ode_run(&o, stops[s]), SPH_OK);
    assert_true(sph_integrator_time(o.it) == stops[s]);
  }
  const sph_step_stats *stats = sph_integrator_stats(o.it);
  assert_int_equal(stats->retries, 2);
  assert_true(fabs(stats->dt_largest / (0.35 * 0.01 * 3.03 / 1.16) - 1) < 1e-9);
  assert_true(ode_error(&o, 1, o.y) < 1e-8);
  N_Vector at = N_VClone(o.y); /* cubic between steps */
  for (int k = 0; k <= 4; k++) {
    double t = sph_integrator_previous(o.it), h = sph_integrator_time(o.it) - t;
    assert_int_equal(sph_integrator_interpolate(o.it, t + k * h / 4, at), SPH_OK);
    assert_true(ode_error(&o, t + k * h / 4, at) < 2e-8 + 0.1 * h * h * h);
  }
  N_VDestroy(at);
  o.exact(0, sph_nvector_data(o.y)); /* a reset is a new start */
  assert_int_equal(sph_integrator_reset(o.it, 0), SPH_OK);
  o.time = 0;
  assert_int_equal(ode_run(&o, 1), SPH_OK);
  assert_int_equal(ode_run(&fresh, 1), SPH_OK);
  assert_memory_equal(sph_nvector_data(o.y), sph_nvector_data(fresh.y),
                      ODE_LENGTH * sizeof(double));
  ode_end(&o);
  ode_end(&fresh);
}

static void one_piece_is_refused(void **state)
{
  (void)state;
  if (!have_rows()) return;
  ode o;
  ode_made(&o);
  o.it = sph_integrator_create(&(sph_integrator_def){.method = "sprk:leapfrog-2-2"}, &o.problem, 0,
                               o.y, o.context, &o.error);
  assert_null(o.it);
  assert_non_null(strstr(o.error.text, "positions and velocities apart"));
  ode_end(&o);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_table_has_its_order),
      cmocka_unit_test(rows_tell_the_truth),
      cmocka_unit_test(stability_is_that_of_the_shortest_waves),
      cmocka_unit_test(energy_comes_back),
      cmocka_unit_test(stepping_is_that_of_all_schemes),
      cmocka_unit_test(one_piece_is_refused),
  };
  return cmocka_run_group_tests_name("sprk", tests, NULL, NULL);
}
