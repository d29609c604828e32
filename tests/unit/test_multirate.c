/* Multirate schemes on equations with known solutions: order, whatever the fast part; that fast
 * steps are as told; limits, retries, resets, dense output, refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "ode.h"

/* An equation in two parts.  The ode comes first: its callbacks get a pointer to it. */
typedef struct two {
  ode o;
  double rate;               /* of the fast part [1/s] */
  long slow, fast;           /* evaluations */
  long fail_slow, fail_fast; /* number of the one that fails, and ... */
  int failures;              /* how many do */
  double fast_limit;         /* > 0 [s] */
  int last;                  /* piece that was evaluated last, but the fast one; -1: all of f */
} two;

static const double COUPLING = 0.5, SLOW_RATE = 10; /* [1] and [1/s] */

/* Kvaerno, Prothero & Robinson's problem: x = sqrt(1 + r), r = cos(t)/2, is slow;
 * q = sqrt(2 + s), s = cos(rate t), is fast; both know of each other's error. */
static double r_of(double t) { return cos(t) / 2; }
static double s_of(const two *w, double t) { return cos(w->rate * t); }

static double rate_now; /* of the equation that runs, for its exact solution */

static void kpr_exact(double t, double *y)
{
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_X] = sqrt(1 + r_of(t));
  y[ODE_Q] = sqrt(2 + cos(rate_now * t));
}

static int kpr(int piece, double t, N_Vector state, N_Vector ydot, void *ctx)
{
  two *w = ctx;
  const double *y = sph_nvector_data(state), x = y[ODE_X], q = y[ODE_Q];
  double *f = sph_nvector_data(ydot);
  double error_x = (x * x - 1 - r_of(t)) / (2 * x), error_q = (q * q - 2 - s_of(w, t)) / (2 * q);
  memset(f, 0, ODE_LENGTH * sizeof *f);
  if (piece != SPH_PIECE_FAST)
    f[ODE_X] = -SLOW_RATE * error_x + COUPLING * error_q - sin(t) / (4 * x);
  if (piece != SPH_PIECE_EXPLICIT)
    f[ODE_Q] = COUPLING * error_x - error_q - w->rate * sin(w->rate * t) / (2 * q);
  return SPH_OK;
}

/* A stiff source beside a slow rate of the same quantity, and an oscillator that knows of it:
 * x = sin t, q = 2 + sin 2t; fast is -rate (q - g(t, x)). */
static void source_exact(double t, double *y)
{
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_X] = sin(t);
  y[ODE_U] = cos(t);
  y[ODE_Q] = 2 + sin(2 * t);
}

static int source(int piece, double t, N_Vector state, N_Vector ydot, void *ctx)
{
  two *w = ctx;
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(ydot), e[ODE_LENGTH];
  source_exact(t, e);
  memset(f, 0, ODE_LENGTH * sizeof *f);
  if (piece != SPH_PIECE_FAST) {
    f[ODE_X] = y[ODE_U];
    f[ODE_U] = -y[ODE_X] + (y[ODE_Q] * y[ODE_U] - e[ODE_Q] * e[ODE_U]) / 2;
    f[ODE_Q] = 2 * cos(2 * t) + y[ODE_X] * y[ODE_U] - e[ODE_X] * e[ODE_U];
  }
  if (piece != SPH_PIECE_EXPLICIT)
    f[ODE_Q] -= w->rate * (y[ODE_Q] - e[ODE_Q] * (1 + y[ODE_X] - e[ODE_X]));
  return SPH_OK;
}

typedef int (*parts)(int piece, double t, N_Vector y, N_Vector ydot, void *ctx);
static parts parts_now;

static int rhs_piece(int piece, double t, N_Vector y, N_Vector ydot, void *ctx)
{
  two *w = ctx;
  long *calls = piece == SPH_PIECE_FAST ? &w->fast : &w->slow;
  if (piece != SPH_PIECE_FAST) w->last = piece;
  long number = (*calls)++, from = piece == SPH_PIECE_FAST ? w->fail_fast : w->fail_slow;
  if (from && number >= from && number < from + w->failures) return SPH_RETRY;
  return parts_now(piece, t, y, ydot, ctx);
}

static int rhs(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  ((two *)ctx)->last = -1;
  return parts_now(-1, t, y, ydot, ctx);
}

static int limits_fast(double t, N_Vector y, sph_step_limit *limit, void *ctx)
{
  const two *w = ctx;
  (void)t, (void)y;
  if (w->fast_limit > 0) limit->dt[SPH_BOUND_CFL] = w->fast_limit;
  return SPH_OK;
}

static void make(two *w, parts equation, double rate)
{
  *w = (two){0};
  ode_decay(&w->o);
  w->rate = rate_now = rate;
  parts_now = equation;
  w->o.problem.ctx = w;
  w->o.problem.rhs = rhs;
  w->o.problem.rhs_piece = rhs_piece;
  w->o.problem.limits_fast = limits_fast;
  w->o.exact = equation == kpr ? kpr_exact : source_exact;
}

static int multirate(const sph_integrator_info *info) { return !strncmp(info->name, "mri:", 4); }

/* ---- order */

static double error_of(parts equation, double rate, const char *name, double fast_step, int n)
{
  two w;
  double most = 0;
  const int stops = 4;
  const double t_end = 2;
  make(&w, equation, rate);
  ode_start(&w.o, &(sph_integrator_def){.method = name,
                                        .dt_fixed = t_end / (stops * n),
                                        .fast_method = "erk:fehlberg-13-7-8",
                                        .fast_step = fast_step});
  for (int k = 1; k <= stops; k++) {
    if (ode_run(&w.o, k * t_end / stops)) fail_msg("%s: %s", name, w.o.error.text);
    most = fmax(most, ode_error(&w.o, k * t_end / stops, w.o.y));
  }
  ode_end(&w.o);
  return most;
}

/* The better of the last two slopes above rounding. */
static double order_of(parts equation, double rate, const char *name, double fast_step, int from,
                       int to, double *finest)
{
  double slope[2] = {0, 0}, error = error_of(equation, rate, name, fast_step, from);
  for (int n = 2 * from; n <= to; n *= 2) {
    double finer = error_of(equation, rate, name, fast_step, n);
    if (finer < 1e-11) break;
    slope[0] = slope[1];
    slope[1] = log2(error / finer);
    error = finer;
  }
  *finest = error;
  return fmax(slope[0], slope[1]);
}

/* A source that is stiff beside slow steps (rate dt = 125 to 8) takes order from couplings that
 * make rates jump between stages; exponential ones (MERK) keep it. */
static void every_coupling_has_its_order(void **state)
{
  static const struct {
    const char *what;
    parts equation;
    double rate, fast_step;
    int from, to;
  } row[] = {{"smooth", kpr, 5, 0.02, 4, 64},
             {"fast oscillation", kpr, 100, 0.002, 4, 64},
             {"source", source, 2, 0.02, 4, 64},
             {"stiff source", source, 50, 0.01, 4, 512},
             {"stiffer source", source, 1000, 0.001, 4, 64}};
  sph_integrator_info info;
  (void)state;
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (!multirate(&info)) continue;
    for (size_t p = 0; p < sizeof row / sizeof *row; p++) {
      double error = 0, order = order_of(row[p].equation, row[p].rate, info.name, row[p].fast_step,
                                         row[p].from, row[p].to, &error);
      int keeps = row[p].rate < 1000 || !strncmp(info.name, "mri:merk", 8);
      print_message("# %-18s %-18s order %.2f (%d), error %.1e\n", info.name, row[p].what, order,
                    info.order, error);
      if (!(order >= info.order - (keeps ? 0.1 : 2)))
        fail_msg("%s, %s: order %.2f, nominal %d (error %.1e)", info.name, row[p].what, order,
                 info.order, error);
    }
  }
}

/* ---- fast steps */

/* kw3: slow stages at 0, 1/3, 3/4, 1 of a step. */
static void fast_steps_are_as_long_as_they_may_be(void **state)
{
  static const double part[] = {1. / 3, 5. / 12, 1. / 4};
  static const double step[] = {1. / 12, 1. / 11, 1. / 4, 1, 3}; /* in slow steps */
  (void)state;
  for (int k = 0; k < 5; k++)
    for (int limited = 0; limited < 2; limited++) { /* as given, or by the limit of the fast part */
      two w;
      double H = 0.1;
      make(&w, source, 2);
      sph_integrator_def def = {.method = "mri:kw3", .dt_fixed = H, .fast_step = H * step[k]};
      if (limited) {
        def.fast_step = 0;
        def.fast_tolerance = -1;
        def.cfl = 0.5;
        w.fast_limit = H * step[k] / (0.5 * 1.98);
      }
      ode_start(&w.o, &def);
      assert_int_equal(ode_run(&w.o, 1), SPH_OK);
      const sph_step_stats *stats = sph_integrator_stats(w.o.it);
      long steps = 0;
      for (int i = 0; i < 3; i++) steps += (long)ceil(part[i] / step[k] - 1e-6);
      assert_int_equal(stats->fast_steps, 10 * steps);
      /* Bogacki & Shampine: 3 and one at each slow stage; one a step for dense output. */
      long calls = 10 * (3 * steps + 3);
      assert_in_range(stats->fast_evaluations, calls, calls + 11);
      assert_int_equal(stats->fast_evaluations, w.fast);
      assert_in_range(stats->rhs_evaluations, 30, 32);
      assert_int_equal(stats->fast_rejected, 0);
      ode_end(&w.o);
    }
}

static void fast_errors_are_held(void **state)
{
  double steps[2];
  (void)state;
  for (int k = 0; k < 2; k++) {
    double tolerance = k ? 1e-8 : 1e-5;
    two w;
    make(&w, kpr, 100);
    ode_start(&w.o, &(sph_integrator_def){.method = "mri:kw3",
                                          .dt_fixed = 0.005,
                                          .fast_tolerance = tolerance});
    assert_int_equal(ode_run(&w.o, 1), SPH_OK);
    double error = ode_error(&w.o, 1, w.o.y);
    const sph_step_stats *stats = sph_integrator_stats(w.o.it);
    print_message("# fast tolerance %g: error %.1e, %ld fast steps, %ld repeated\n", tolerance,
                  error, stats->fast_steps, stats->fast_rejected);
    assert_true(error > 0.1 * tolerance && error < 100 * tolerance);
    assert_true(stats->fast_rejected < stats->fast_steps / 2);
    steps[k] = (double)stats->fast_steps;
    ode_end(&w.o);
  }
  assert_true(steps[1] / steps[0] > 5 && steps[1] / steps[0] < 11); /* 1000^(1/3), rounded up */
}

/* rate dt = 25: all of f at once would take ten steps for one. */
static void stiff_sources_do_not_bind_slow_steps(void **state)
{
  (void)state;
  two w;
  make(&w, source, 500);
  ode_start(&w.o,
            &(sph_integrator_def){.method = "mri:kw3", .dt_fixed = 0.05, .fast_tolerance = 1e-4});
  assert_int_equal(ode_run(&w.o, 2), SPH_OK);
  const sph_step_stats *stats = sph_integrator_stats(w.o.it);
  assert_true(ode_error(&w.o, 2, w.o.y) < 1e-3);
  assert_in_range(stats->rhs_evaluations, 120, 122);
  assert_true(stats->fast_steps > 300 && stats->fast_steps < 1200);
  ode_end(&w.o);
}

/* ---- stepping */

static void slow_steps_obey_limits_of_the_slow_part(void **state)
{
  (void)state;
  two w;
  make(&w, source, 2);
  w.o.limit[SPH_BOUND_CFL] = 0.02;
  w.fast_limit = 1e-3;
  ode_start(&w.o, &(sph_integrator_def){.method = "mri:kw3", .cfl = 0.5, .fast_tolerance = -1});
  assert_int_equal(ode_run(&w.o, 1), SPH_OK);
  const sph_step_stats *stats = sph_integrator_stats(w.o.it);
  assert_true(fabs(stats->dt_largest / (0.5 * 1.98 * 0.02) - 1) < 1e-9);
  assert_true(fabs((double)stats->fast_steps * 0.5 * 1.98 * 1e-3 - 1) < 0.1);
  assert_true(stats->bound_by[SPH_BOUND_CFL] >= stats->steps - 1);
  ode_end(&w.o);
}

/* All of f would limit steps to a thousandth, as waves in the fast part do. */
static int limits_of_the_last(double t, N_Vector y, sph_step_limit *limit, void *ctx)
{
  const two *w = ctx;
  (void)t, (void)y;
  limit->dt[SPH_BOUND_CFL] = w->last == SPH_PIECE_EXPLICIT ? 0.02 : 2e-5;
  return SPH_OK;
}

static void first_steps_obey_no_others(void **state)
{
  (void)state;
  two w;
  make(&w, source, 2);
  w.o.problem.limits = limits_of_the_last;
  ode_start(&w.o, &(sph_integrator_def){.method = "mri:kw3", .cfl = 0.5, .fast_step = 0.01});
  for (int start = 0; start < 3; start++) {
    if (ode_run(&w.o, start + 1)) fail_msg("%s", w.o.error.text);
    assert_int_equal(sph_integrator_reset(w.o.it, start + 1), SPH_OK);
  }
  const sph_step_stats *stats = sph_integrator_stats(w.o.it);
  if (!(fabs(stats->dt_smallest / (0.5 * 1.98 * 0.02) - 1) < 1e-9))
    fail_msg("a step of %g", stats->dt_smallest);
  ode_end(&w.o);
}

static void stop_times_are_exact(void **state)
{
  (void)state;
  two w;
  make(&w, source, 100);
  w.o.limit[SPH_BOUND_CFL] = 0.1;
  ode_start(&w.o, &(sph_integrator_def){.method = "mri:erk33a"});
  double stops[] = {0.3, 0.3 + 1e-9, 0.7, 1, 1 + 1e-15, 2};
  for (int s = 0; s < 6; s++) {
    assert_int_equal(ode_run(&w.o, stops[s]), SPH_OK);
    assert_true(sph_integrator_time(w.o.it) == stops[s]);
  }
  assert_true(ode_error(&w.o, 2, w.o.y) < 0.01);
  ode_end(&w.o);
}

static double dense_error(const char *name, int n)
{
  two w;
  double most = 0;
  make(&w, source, 20);
  ode_start(&w.o, &(sph_integrator_def){.method = name, .dt_fixed = 2.0 / n, .fast_step = 0.01});
  N_Vector at = N_VClone(w.o.y);
  while (sph_integrator_time(w.o.it) < 2) {
    assert_int_equal(sph_integrator_step(w.o.it, 2), SPH_OK);
    double t0 = sph_integrator_previous(w.o.it), t1 = sph_integrator_time(w.o.it);
    for (int k = 0; k <= 4; k++) {
      double t = t0 + k * (t1 - t0) / 4;
      assert_int_equal(sph_integrator_interpolate(w.o.it, t, at), SPH_OK);
      most = fmax(most, ode_error(&w.o, t, at));
    }
  }
  N_VDestroy(at);
  ode_end(&w.o);
  return most;
}

static void dense_output_keeps_the_order(void **state)
{
  static const char *const name[] = {"mri:kw3", "mri:erk33a", "mri:erk45a"};
  (void)state;
  for (int k = 0; k < 3; k++) {
    double order = log2(dense_error(name[k], 160) / dense_error(name[k], 320));
    print_message("# %s: dense output of order %.2f\n", name[k], order);
    if (!(order > (k < 2 ? 3 : 4) - 0.15)) fail_msg("%s: dense order %.2f", name[k], order);
  }
}

/* With error control a fast step is repeated, smaller; else the slow one is. */
static void failed_evaluations_are_repeated(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    two w;
    make(&w, source, 20);
    w.o.limit[SPH_BOUND_CFL] = 0.01;
    w.failures = 2;
    *(k ? &w.fail_fast : &w.fail_slow) = 41;
    ode_start(&w.o, &(sph_integrator_def){.method = "mri:erk33a", .fast_step = k == 2 ? 0 : 2e-3});
    assert_int_equal(ode_run(&w.o, 2), SPH_OK);
    const sph_step_stats *stats = sph_integrator_stats(w.o.it);
    assert_int_equal(stats->retries, k == 2 ? 0 : 2);
    assert_int_equal(stats->fast_rejected, k == 2 ? 2 : 0);
    assert_true(ode_error(&w.o, 2, w.o.y) < 1e-3);
    ode_end(&w.o);
  }
}

static void lasting_failures_stop_at_the_last_good_state(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    two w;
    make(&w, source, 20);
    w.o.limit[SPH_BOUND_CFL] = 0.01;
    w.failures = 1000000;
    *(k ? &w.fail_fast : &w.fail_slow) = 60;
    ode_start(&w.o, &(sph_integrator_def){.method = "mri:erk33a",
                                          .fast_step = k == 2 ? 0 : 2e-3,
                                          .retries = 5});
    assert_int_equal(ode_run(&w.o, 2), SPH_ERR_STEP);
    assert_non_null(strstr(w.o.error.text, "after 5 halvings"));
    double t = sph_integrator_time(w.o.it);
    assert_true(t > 0.01 && ode_error(&w.o, t, w.o.y) < 1e-4);
    ode_end(&w.o);
  }
}

static void reset_is_a_new_start(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    const sph_integrator_def def = {.method = "mri:erk33a", .fast_step = k * 1e-3};
    two w, fresh;
    make(&w, source, 20);
    make(&fresh, source, 20);
    w.o.limit[SPH_BOUND_CFL] = fresh.o.limit[SPH_BOUND_CFL] = 0.1;
    ode_start(&w.o, &def);
    ode_start(&fresh.o, &def);
    assert_int_equal(ode_run(&w.o, 0.5), SPH_OK);
    w.o.exact(0, sph_nvector_data(w.o.y));
    assert_int_equal(sph_integrator_reset(w.o.it, 0), SPH_OK);
    w.o.time = 0;
    assert_int_equal(ode_run(&w.o, 1), SPH_OK);
    assert_int_equal(ode_run(&fresh.o, 1), SPH_OK);
    assert_memory_equal(sph_nvector_data(w.o.y), sph_nvector_data(fresh.o.y),
                        ODE_LENGTH * sizeof(double));
    ode_end(&w.o);
    ode_end(&fresh.o);
  }
}

/* From 7.2 on slow steps follow their error, too. */
static void slow_errors_are_held(void **state)
{
  sph_integrator_info info;
  int adaptive = 0;
  (void)state;
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (!multirate(&info) || !info.error_control) continue;
    double error[2], steps[2];
    for (int fine = 0; fine < 2; fine++) {
      two w;
      make(&w, kpr, 20);
      ode_start(&w.o, &(sph_integrator_def){.method = info.name, .tolerance = fine ? 1e-6 : 1e-4});
      if (ode_run(&w.o, 2)) fail_msg("%s: %s", info.name, w.o.error.text);
      error[fine] = ode_error(&w.o, 2, w.o.y);
      steps[fine] = (double)sph_integrator_stats(w.o.it)->steps;
      ode_end(&w.o);
    }
    print_message("# %s: error %.1e, %.1e in %g, %g steps\n", info.name, error[0], error[1],
                  steps[0], steps[1]);
    if (!(error[0] < 3e-3 && error[1] < 3e-5 && steps[1] > steps[0]))
      fail_msg("%s: error %.1e, %.1e", info.name, error[0], error[1]);
    adaptive++;
  }
  if (!adaptive)
    print_message("# skipped: SUNDIALS %s has no adaptive slow steps, 7.2 has\n", SUNDIALS_VERSION);
}

/* ---- refusals */

static void misuse_is_refused_with_a_reason(void **state)
{
  static const struct {
    sph_integrator_def def;
    const char *text;
  } row[] = {
      {{.method = "mri:kw3", .fast_step = -1}, "fast_step = -1"},
      {{.method = "mri:kw3", .fast_step = NAN}, "fast_step = nan"},
      {{.method = "mri:kw3", .fast_tolerance = INFINITY}, "fast_tolerance = inf"},
      {{.method = "mri:kw3", .fast_method = "leapfrog"}, "right is erk:<table>"},
      {{.method = "mri:kw3", .fast_method = "erk:bogacki"}, "the nearest is"},
      {{.method = "mri:kw3", .fast_method = "erk:knoth-wolke-3-3", .fast_tolerance = 1e-3},
       "no error estimate"},
      {{.method = "mri:kw3", .tolerance = 1e-3},
       SPH_SUNDIALS_NUMBER < 70200 ? "mri: from SUNDIALS 7.2 on; this library has"
                                   : "no error estimate; right is none (0)"},
      {{.method = "mri:kw", .fast_step = 1}, "nearest is \"mri:kw3\""},
      {{.fast_step = 1}, "no fast part"},
      {{.method = "leapfrog", .fast_method = "erk:zonneveld-5-3-4"}, "no fast part"},
  };
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    sph_error error = {0};
    assert_int_equal(sph_integrator_check(&row[k].def, &error), SPH_ERR_ARGUMENT);
    if (!strstr(error.text, row[k].text)) fail_msg("\"%s\" lacks \"%s\"", error.text, row[k].text);
  }
  two w;
  make(&w, source, 20);
  w.o.limit[SPH_BOUND_CFL] = 0.1;
  ode_start(&w.o, &(sph_integrator_def){.method = "mri:kw3", .fast_tolerance = -1});
  assert_int_equal(ode_run(&w.o, 1), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(w.o.error.text, "nothing limits steps of the fast part"));
  ode_end(&w.o);
  ode o; /* one piece */
  ode_made(&o);
  o.it = sph_integrator_create(&(sph_integrator_def){.method = "mri:kw3"}, &o.problem, 0, o.y,
                               o.context, &o.error);
  assert_null(o.it);
  assert_non_null(strstr(o.error.text, "fast part of f"));
  ode_end(&o);
}

/* By the headers of the releases 6.5.1 to 7.3.0. */
static const char *first_with(const char *name)
{
  static const struct {
    const char *part, *version;
  } row[] = {{"lsrk:", "7.2"},          {":merk", "7.2"},         {"sprk:", "6.6"},
             {"mri:", "7.1"},           {":ark2-", "6.6"},        {"tsitouras", "7.3"},
             {"ralston-3", "7.3"},      {"forward-euler", "7.1"}, {"ralston-euler", "7.1"},
             {"midpoint-euler", "7.1"}, {"erk:", "6.7"}};
  size_t k = 0;
  while (k < sizeof row / sizeof *row - 1 && !strstr(name, row[k].part)) k++;
  return row[k].version;
}

static void what_a_newer_sundials_has_is_told(void **state)
{
  sph_integrator_missing missing;
  sph_integrator_info info;
  int k = 0;
  (void)state;
  for (; sph_integrator_missing_get(k, &missing); k++) {
    sph_error error = {0};
    char text[80];
    snprintf(text, sizeof text, "needs SUNDIALS %s or later; this library has %s",
             first_with(missing.name), SUNDIALS_VERSION);
    assert_int_equal(sph_integrator_check(&(sph_integrator_def){.method = missing.name}, &error),
                     SPH_ERR_UNBUILT);
    if (!strstr(error.text, text)) fail_msg("\"%s\" lacks \"%s\"", error.text, text);
    for (int row = 0; sph_integrator_info_get(row, &info); row++)
      assert_true(strcmp(info.name, missing.name));
  }
  assert_int_equal(sph_integrator_missing_get(-1, &missing), 0);
  assert_int_equal(k > 0, SPH_SUNDIALS_NUMBER < 70300);
  sph_error error = {0}; /* a name that none of a kind has, before there is any */
  assert_int_equal(sph_integrator_check(&(sph_integrator_def){.method = "lsrk:rkc"}, &error),
                   SPH_SUNDIALS_NUMBER < 70200 ? SPH_ERR_UNBUILT : SPH_ERR_ARGUMENT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_coupling_has_its_order),
      cmocka_unit_test(fast_steps_are_as_long_as_they_may_be),
      cmocka_unit_test(fast_errors_are_held),
      cmocka_unit_test(stiff_sources_do_not_bind_slow_steps),
      cmocka_unit_test(slow_steps_obey_limits_of_the_slow_part),
      cmocka_unit_test(first_steps_obey_no_others),
      cmocka_unit_test(stop_times_are_exact),
      cmocka_unit_test(dense_output_keeps_the_order),
      cmocka_unit_test(failed_evaluations_are_repeated),
      cmocka_unit_test(lasting_failures_stop_at_the_last_good_state),
      cmocka_unit_test(reset_is_a_new_start),
      cmocka_unit_test(slow_errors_are_held),
      cmocka_unit_test(misuse_is_refused_with_a_reason),
      cmocka_unit_test(what_a_newer_sundials_has_is_told),
  };
  return cmocka_run_group_tests_name("multirate", tests, NULL, NULL);
}
