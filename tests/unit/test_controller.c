/* The controllers of step sizes: their published formulas, where they settle, what they remember,
 * and what they are for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "controller.h"
#include "near.h"
#include "ode.h"

/* Soederlind (2003), table III, and Soederlind & Wang (2006), Gustafsson (1991): exponents of the
 * errors e_n, e_(n-1), e_(n-2) times -k, and of h_n/h_(n-1) times -1. */
static const struct {
  const char *name;
  double beta[3], alpha;
} published[] = {{"i", {1, 0, 0}, 0},
                 {"pi", {3.0 / 5, -1.0 / 5, 0}, 0},
                 {"gustafsson", {7.0 / 10, -4.0 / 10, 0}, 0},
                 {"pid", {1.0 / 18, 1.0 / 9, 1.0 / 18}, 0},
                 {"h211", {1.0 / 4, 1.0 / 4, 0}, 1.0 / 4}};
enum { PUBLISHED = sizeof published / sizeof *published };

static void formulas(void **state)
{
  static const double h[] = {0.1, 0.12, 0.2, 0.15, 0.15}, e[] = {0.5, 0.9, 3, 0.25, 0.7};
  (void)state;
  assert_null(sph_controller_name(PUBLISHED));
  for (int k = 0; k < PUBLISHED; k++) {
    sph_error error = {0};
    const sph_controller *c = sph_controller_find(published[k].name, &error);
    assert_non_null(c);
    const double *b = published[k].beta, a = published[k].alpha;
    for (int order = 2; order <= 5; order += 3) {
      double known[3] = {1, 1, 1}, last = 0;
      sph_controller_past past;
      sph_controller_forget(&past);
      for (int n = 0; n < 5; n++) {
        known[0] = e[n];
        double expected = h[n], ratio = last > 0 ? h[n] / last : 1;
        for (int i = 0; i < 3; i++) expected *= exp(-b[i] / order * log(known[i]));
        expected *= exp(-a * log(ratio));
        double next = sph_controller_next(c, order, h[n], e[n], &past);
        if (!(fabs(next / expected - 1) < 1e-13))
          fail_msg("%s, step %d: %.16g, not %.16g", published[k].name, n, next, expected);
        if (e[n] > 1) continue; /* repeated: not remembered */
        known[2] = known[1];
        known[1] = e[n];
        last = h[n];
      }
    }
    sph_controller_past past = {{1, 1}, 0};
    assert_near(sph_controller_next(c, 3, 2, NAN, &past), 0.2, 1e-15);
  }
}

/* Bogacki & Shampine's estimate for the oscillator (see test_integrator.c) settles where
 * 0.9 e^(-sum beta/k) = 1. */
static void they_settle(void **state)
{
  const double tolerance = 1e-6;
  (void)state;
  for (int k = 0; k < PUBLISHED; k++) {
    ode o;
    const double *b = published[k].beta, sum = b[0] + b[1] + b[2];
    ode_oscillator(&o);
    o.problem.limits = NULL;
    ode_start(&o, &(sph_integrator_def){.tolerance = tolerance, .controller = published[k].name});
    for (int n = 0; n < 400; n++) {
      assert_int_equal(sph_integrator_step(o.it, 1000), SPH_OK);
      double h = sph_integrator_stats(o.it)->dt_last;
      double e = h * h * h * sqrt(1 + h * h) / (48 * sqrt(5)) / tolerance;
      if (n > 300 && !(fabs(e / pow(0.9, 3 / sum) - 1) < 0.01))
        fail_msg("%s: %g, not %g", published[k].name, e, pow(0.9, 3 / sum));
    }
    ode_end(&o);
  }
}

/* After a reset the steps are those of a new start; a retry forgets, too. */
static void a_reset_forgets(void **state)
{
  (void)state;
  for (int k = 0; k < PUBLISHED; k++) {
    const sph_integrator_def def = {.tolerance = 1e-6, .controller = published[k].name};
    ode o, fresh;
    ode_made(&o);
    ode_made(&fresh);
    o.limit[SPH_BOUND_CFL] = fresh.limit[SPH_BOUND_CFL] = 1;
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

/* Where stability binds, as Dormand & Prince's pair for q' = -q at rest, the integral controller
 * grows the step until the error jumps, rejects it, and grows it again; a proportional part holds
 * it at the limit, 3.307 (Gustafsson 1991; Hairer & Wanner 1996, IV.2). */
static void at_the_limit_of_stability(void **state)
{
  (void)state;
  for (int k = 0; k < PUBLISHED; k++) {
    ode o;
    double rough = 0, last = 0;
    long rejected = 0;
    ode_decay(&o);
    o.problem.limits = NULL;
    ode_start(&o, &(sph_integrator_def){.method = "erk:dormand-prince-7-4-5",
                                        .tolerance = 1e-3,
                                        .controller = published[k].name});
    const sph_step_stats *stats = sph_integrator_stats(o.it);
    for (int n = 0; n < 500; n++) {
      assert_int_equal(sph_integrator_step(o.it, 1e6), SPH_OK);
      if (n == 99) rejected = stats->rejected;
      if (n >= 100) rough = fmax(rough, fabs(log(stats->dt_last / last)));
      last = stats->dt_last;
    }
    rejected = stats->rejected - rejected;
    print_message("# %-10s last step %.3f, largest change %.2g, rejected %ld of 400\n",
                  published[k].name, last, rough, rejected);
    int holds = !strcmp(published[k].name, "pi") || !strcmp(published[k].name, "gustafsson");
    assert_true(holds ? rejected == 0 && rough < 1e-3 && fabs(last - 3.307) < 1e-3 : rejected > 40);
    ode_end(&o);
  }
}

/* Errors that alternate, e = h^3 (1 + (-1)^n/2): those with beta_1 = beta_2, or 1 : 2 : 1, have a
 * zero there, and their steps do not. */
static void filters_of_noise(void **state)
{
  (void)state;
  for (int k = 0; k < PUBLISHED; k++) {
    sph_error error = {0};
    const sph_controller *c = sph_controller_find(published[k].name, &error);
    sph_controller_past past;
    double h = 0.5, change = 0;
    sph_controller_forget(&past);
    for (int n = 0; n < 300; n++) {
      double next =
          0.9 * sph_controller_next(c, 3, h, h * h * h * (1 + (n % 2 ? 0.5 : -0.5)), &past);
      change = fabs(log(next / h));
      h = next;
    }
    print_message("# %-10s changes of steps %.2g\n", published[k].name, change);
    int filters = !strcmp(published[k].name, "pid") || !strcmp(published[k].name, "h211");
    assert_true(filters ? change < 1e-6 : change > 0.1);
  }
}

/* Reset after every step: steps that go on stay those that error control has found; with limits far
 * above, a new start tries these first, and fails. */
static void going_on_keeps_the_step(void **state)
{
  long steps[3], rejected[3];
  (void)state;
  for (int k = 0; k < 3; k++) {
    ode o;
    ode_kepler(&o);
    o.limit[SPH_BOUND_CFL] = 0.2;
    ode_start(&o, &(sph_integrator_def){.tolerance = 1e-6});
    while (sph_integrator_time(o.it) < 20) {
      assert_int_equal(sph_integrator_step(o.it, 20), SPH_OK);
      double t = sph_integrator_time(o.it);
      if (k == 1) assert_int_equal(sph_integrator_go_on(o.it, t), SPH_OK);
      if (k == 2) assert_int_equal(sph_integrator_reset(o.it, t), SPH_OK);
    }
    steps[k] = sph_integrator_stats(o.it)->steps;
    rejected[k] = sph_integrator_stats(o.it)->rejected;
    print_message("# %s: %ld steps, %ld repeated\n",
                  k == 0   ? "no reset"
                  : k == 1 ? "goes on"
                           : "reset",
                  steps[k], rejected[k]);
    ode_end(&o);
  }
  assert_true(labs(steps[1] - steps[0]) <= 2 && labs(rejected[1] - rejected[0]) <= 2);
  assert_true(rejected[2] > steps[2]);
}

static void unknown_ones_are_refused(void **state)
{
  static const struct {
    sph_integrator_def def;
    const char *text;
  } row[] = {{{.controller = "pie"}, "did you mean 'pi'? known: i, pi, gustafsson, pid, h211"},
             {{.controller = ""}, "known: i, pi"},
             {{.method = "leapfrog", .controller = "pi"}, "leapfrog has no error estimate"}};
  (void)state;
  for (int k = 0; k < 3; k++) {
    sph_error error = {0};
    assert_int_equal(sph_integrator_check(&row[k].def, &error), SPH_ERR_ARGUMENT);
    if (!strstr(error.text, row[k].text)) fail_msg("\"%s\" lacks \"%s\"", error.text, row[k].text);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(formulas),
      cmocka_unit_test(they_settle),
      cmocka_unit_test(a_reset_forgets),
      cmocka_unit_test(at_the_limit_of_stability),
      cmocka_unit_test(filters_of_noise),
      cmocka_unit_test(going_on_keeps_the_step),
      cmocka_unit_test(unknown_ones_are_refused),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
