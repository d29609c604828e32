/* Roots of functions of time, and of functions of the state in the last step: beside ARKODE's own
 * search, which finds them in the same dense output. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "ode.h"
#include "root.h"
#include "sundials.h"

/* ---- functions of time ---- */

typedef struct function {
  const char *name;
  double (*f)(double t);
  double a, b, root;
  int most; /* evaluations */
  int calls;
} function;

static double cubic(double t) { return t * t * t - 2 * t - 5; }
static double flat(double t) { return pow(t - 0.3, 9); }
static double steep(double t) { return tanh(1e6 * (t - 0.61803)); }
static double jump(double t) { return t < 0.7 ? -1e-30 : 1e30; }
static double falling(double t) { return 1e200 * (2 - t); }
static double late(double t) { return t - 1e6 - 1e-7; }
static double thrice(double t) { return sin(3 * acos(-1) * t + 0.1); }
static double left(double t) { return t > 0 ? 1 : -1; }

static int value(void *ctx, double t, double *v)
{
  function *k = ctx;
  assert_true(t > k->a && t < k->b);
  k->calls++;
  *v = k->f(t);
  return SPH_OK;
}

static void roots_of_functions(void **state)
{
  function row[] = {
      {"cubic", cubic, 2, 3, 2.0945514815423265, 15, 0},
      {"flat", flat, 0, 1, 0.3, 120, 0},
      {"steep", steep, 0, 1, 0.61803, 60, 0},
      {"jump", jump, 0, 1, 0.7, 120, 0},
      {"falling", falling, -1, 4, 2, 15, 0},
      {"late", late, 1e6, 1e6 + 1e-6, 1e6 + 1e-7, 20, 0},
      {"thrice", thrice, 0, 1, NAN, 20, 0},
      {"left", left, 0, 1, 0, 200, 0},
      {"at the end", falling, -1, 2, 2, 0, 0},
  };
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    function *f = &row[k];
    sph_error error = {0};
    double t = NAN, fa = f->f(f->a), fb = f->f(f->b);
    assert_int_equal(sph_root_find(value, f, f->a, fa, f->b, fb, &t, &error), SPH_OK);
    double near = fmax(1e-12 * (f->b - f->a), 4e-16 * fabs(f->b));
    if (f->calls > f->most) fail_msg("%s: %d evaluations", f->name, f->calls);
    if (!(isnan(f->root) || fabs(t - f->root) <= 2 * near))
      fail_msg("%s: %.17g, not %.17g", f->name, t, f->root);
    /* behind the change of sign, and close to it */
    assert_true(t > f->a && t <= f->b && (f->f(t) == 0 || (f->f(t) > 0) == (fb > 0) || fb == 0));
    double before = t - 2 * near;
    assert_true(before <= f->a || fb == 0 || f->f(t) == 0 || (f->f(before) > 0) == (fa > 0) ||
                f->f == thrice);
  }
}

static int breaks(void *ctx, double t, double *v)
{
  *v = t * t * t - 0.343;
  return ++*(int *)ctx == 3 ? SPH_ERR_STATE : SPH_OK;
}

static void a_failure_ends_the_search(void **state)
{
  (void)state;
  int calls = 0;
  double t;
  sph_error error = {0};
  assert_int_equal(sph_root_find(breaks, &calls, 0, -0.343, 1, 0.657, &t, &error), SPH_ERR_STATE);
  assert_int_equal(calls, 3);
}

/* ---- functions of the state ---- */

typedef struct crossing {
  ode *o;
  N_Vector at;
  int entry;
  double level;
} crossing;

static int level_at(void *ctx, double t, double *v)
{
  crossing *c = ctx;
  int status = sph_integrator_interpolate(c->o->it, t, c->at);
  *v = sph_nvector_data(c->at)[c->entry] - c->level;
  return status;
}

/* Passages of y[entry] through level up to t_end. */
static int ours(const char *method, double h, double t_end, int entry, double level, double root[])
{
  ode o;
  int n = 0;
  ode_made(&o);
  ode_start(&o, &(sph_integrator_def){.method = method, .dt_fixed = h});
  crossing c = {&o, N_VClone(o.y), entry, level};
  double before = sph_nvector_data(o.y)[entry] - level;
  while (sph_integrator_time(o.it) < t_end) {
    assert_int_equal(sph_integrator_step(o.it, 2 * t_end), SPH_OK);
    double now = sph_nvector_data(o.y)[entry] - level, b = sph_integrator_time(o.it);
    if ((now > 0) != (before > 0))
      assert_int_equal(sph_root_find(level_at, &c, sph_integrator_previous(o.it), before, b, now,
                                     &root[n++], &o.error),
                       SPH_OK);
    before = now;
  }
  N_VDestroy(c.at);
  ode_end(&o);
  return n;
}

static int crossed(sunrealtype t, N_Vector y, sunrealtype *g, void *data)
{
  const crossing *c = data;
  (void)t;
  *g = sph_nvector_data(y)[c->entry] - c->level;
  return 0;
}

static int rates(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  ode *o = ((crossing *)data)->o;
  return o->problem.rhs(t, y, ydot, o->problem.ctx);
}

#define ERK(function) SPH_SUNDIALS(ERKStep, function)

static int arkodes(ARKODE_ERKTableID table, double h, double t_end, int entry, double level,
                   double root[])
{
  ode o;
  int n = 0;
  double t = 0;
  ode_made(&o);
  o.exact(0, sph_nvector_data(o.y));
  crossing c = {&o, NULL, entry, level};
  void *m = ERKStepCreate(rates, 0, o.y, o.context);
  assert_non_null(m);
  assert_int_equal(ERK(SetUserData)(m, &c), 0);
  assert_int_equal(ERK(SStolerances)(m, 1e-4, 1e-4), 0);
  assert_int_equal(ERKStepSetTableNum(m, table), 0);
  assert_int_equal(ERK(SetFixedStep)(m, h), 0);
  assert_int_equal(ERK(SetInterpolantType)(m, ARK_INTERP_HERMITE), 0);
  assert_int_equal(ERK(SetInterpolantDegree)(m, 3), 0);
  assert_int_equal(ERK(SetMaxNumSteps)(m, 100000), 0);
  assert_int_equal(ERK(RootInit)(m, 1, crossed), 0);
  while (ERK(Evolve)(m, t_end, o.y, &t, ARK_NORMAL) == ARK_ROOT_RETURN) root[n++] = t;
  ERK(Free)(&m);
  ode_end(&o);
  return n;
}

/* The same steps and the same dense output: the same moments. */
static void arkode_finds_the_same(void **state)
{
  static const struct {
    const char *method;
    ARKODE_ERKTableID table;
  } row[] = {{"erk:bogacki-shampine-4-2-3", ARKODE_BOGACKI_SHAMPINE_4_2_3},
             {"erk:dormand-prince-7-4-5", ARKODE_DORMAND_PRINCE_7_4_5},
             {"erk:cash-karp-6-4-5", ARKODE_CASH_KARP_6_4_5}};
  const double h = 0.037, end = 12;
  double largest = 0;
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int entry = ODE_X; entry <= ODE_Q; entry += 8) {
      double level = entry == ODE_Q ? 2.3 : 0.3, a[20], b[20];
      int n = ours(row[k].method, h, end, entry, level, a);
      int m = arkodes(row[k].table, h, end, entry, level, b);
      assert_in_range(n, 3, 19);
      assert_int_equal(n, m);
      for (int i = 0; i < n; i++) {
        largest = fmax(largest, fabs(a[i] - b[i]) / h);
        if (!(fabs(a[i] - b[i]) <= 1e-10 * h))
          fail_msg("%s, root %d: %.17g, ARKODE %.17g", row[k].method, i, a[i], b[i]);
      }
    }
  print_message("# roots: %.2g of a step from ARKODE's\n", largest);
}

/* x = sin t: roots of sin t = 0.3 to the order of the method, of any integrator. */
static void roots_have_the_order_of_the_dense_output(void **state)
{
  static const struct {
    const char *method;
    double order;
  } row[] = {{"leapfrog", 2},   {"dkd", 2}, {"midpoint", 2},
             {"symplectic", 2}, {NULL, 3},  {"erk:zonneveld-5-3-4", 4},
             {"verlet-dual", 2}};
  (void)state;
  for (int k = 0; k < 7; k++) {
    double error[2] = {0, 0};
    for (int fine = 0; fine < 2; fine++) {
      double root[20], h = (k == 6 ? 0.001 : 0.05) / (1 + fine);
      int n = ours(row[k].method, h, 12, ODE_X, 0.3, root);
      assert_int_equal(n, 4);
      for (int i = 0; i < n; i++) error[fine] = fmax(error[fine], fabs(sin(root[i]) - 0.3));
    }
    double order = log2(error[0] / error[1]);
    if (!(order > row[k].order - 0.1)) fail_msg("%s: order %.2f", row[k].method, order);
  }
}

/* Slopes of the dense output, which is cubic, but quadratic with tables of order three. */
static void slopes(void **state)
{
  static const struct {
    const char *method;
    double order;
  } row[] = {{NULL, 2}, {"erk:zonneveld-5-3-4", 3}, {"predictor-corrector", 2}, {"leapfrog", 1}};
  (void)state;
  for (int k = 0; k < 4; k++) {
    double error[2] = {0, 0};
    for (int fine = 0; fine < 2; fine++) {
      ode o;
      ode_made(&o);
      ode_start(&o, &(sph_integrator_def){.method = row[k].method, .dt_fixed = 0.02 / (1 + fine)});
      N_Vector rate = N_VClone(o.y), work = N_VClone(o.y);
      const double *r = sph_nvector_data(rate);
      assert_int_equal(sph_integrator_stepped(o.it), 0);
      while (sph_integrator_time(o.it) < 2) {
        assert_int_equal(sph_integrator_step(o.it, 3), SPH_OK);
        assert_int_equal(sph_integrator_stepped(o.it), 1);
        for (int i = 0; i <= 4; i++) {
          double t0 = sph_integrator_previous(o.it),
                 t = t0 + i * (sph_integrator_time(o.it) - t0) / 4;
          assert_int_equal(sph_integrator_rate(o.it, t, rate, work), SPH_OK);
          error[fine] = fmax(error[fine], fabs(r[ODE_X] - cos(t)));
          error[fine] = fmax(error[fine], fabs(r[ODE_Q] - 2 * cos(2 * t)));
        }
      }
      N_VDestroy(rate);
      N_VDestroy(work);
      ode_end(&o);
    }
    double order = log2(error[0] / error[1]);
    print_message("# slope of %s: %.2e, order %.2f\n", row[k].method ? row[k].method : "default",
                  error[1], order);
    if (!(order > row[k].order - 0.1)) fail_msg("%s: order %.2f", row[k].method, order);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(roots_of_functions),
      cmocka_unit_test(a_failure_ends_the_search),
      cmocka_unit_test(arkode_finds_the_same),
      cmocka_unit_test(roots_have_the_order_of_the_dense_output),
      cmocka_unit_test(slopes),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
