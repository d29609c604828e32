/* Relaxation on orbits: the energy is kept to rounding, the order, stop times and dense output as
 * without it; where the energy falls it falls at its rate; refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "ode.h"

static const double TURN = 6.283185307179586;

static const char *const method[] = {"erk:bogacki-shampine-4-2-3", "erk:zonneveld-5-3-4",
                                     "erk:cash-karp-6-4-5", "erk:rdpk3sp35-5-2-3",
                                     "imex:ark2-3-1-2"};
enum { METHODS = sizeof method / sizeof *method };

static int energy_status;

/* v^2/2 - 1/r, and the magnitudes of both. */
static double energy_of(N_Vector state, double *parts)
{
  const double *y = sph_nvector_data(state);
  double kinetic = (y[ODE_U] * y[ODE_U] + y[ODE_V] * y[ODE_V]) / 2;
  double potential = 1 / hypot(y[ODE_X], y[ODE_Y]);
  *parts = kinetic + potential;
  return kinetic - potential;
}

static int energy(N_Vector from, N_Vector to, double *change, double *rounding, void *ctx)
{
  double parts;
  (void)ctx;
  *change = energy_of(to, &parts) - energy_of(from, &parts);
  *rounding = 4 * DBL_EPSILON * parts;
  return energy_status;
}

static int gradient(N_Vector state, N_Vector slope, void *ctx)
{
  const double *y = sph_nvector_data(state);
  double *g = sph_nvector_data(slope), r = hypot(y[ODE_X], y[ODE_Y]);
  (void)ctx;
  g[ODE_X] = y[ODE_X] / (r * r * r);
  g[ODE_Y] = y[ODE_Y] / (r * r * r);
  g[ODE_U] = y[ODE_U];
  g[ODE_V] = y[ODE_V];
  g[ODE_Q] = 0;
  return SPH_OK;
}

/* All of it explicit. */
static int piece(int number, double t, N_Vector y, N_Vector rate, void *ctx)
{
  ode *o = ctx;
  if (number == SPH_PIECE_EXPLICIT) return o->problem.rhs(t, y, rate, ctx);
  N_VConst(0, rate);
  return SPH_OK;
}

static int solve(sph_stage *stage, void *ctx)
{
  (void)ctx;
  N_VScale(1, stage->known, stage->z);
  return SPH_OK;
}

static void make(ode *o)
{
  ode_kepler(o);
  energy_status = SPH_OK;
  o->problem.energy = energy;
  o->problem.energy_gradient = gradient;
  o->problem.rhs_piece = piece;
  o->problem.solve = solve;
}

static int have_it(void)
{
  sph_error error = {0};
  int status = sph_integrator_check(&(sph_integrator_def){.relax = "energy"}, &error);
  if (!status) return 1;
  assert_int_equal(status, SPH_ERR_UNBUILT);
  assert_non_null(strstr(error.text, "needs SUNDIALS 6.6 or later; this library has "));
  print_message("# skipped: %s\n", error.text);
  return 0;
}

static double drift_of(const char *name, const char *relax, double tolerance)
{
  ode o;
  double first, parts, most = 0;
  make(&o);
  sph_integrator_def def = {.method = name, .relax = relax, .tolerance = tolerance};
  if (tolerance < 0) def.dt_fixed = TURN / 100;
  ode_start(&o, &def);
  first = energy_of(o.y, &parts);
  for (int n = 0; n < 1000; n++) {
    assert_int_equal(sph_integrator_step(o.it, 1000), SPH_OK);
    most = fmax(most, fabs(energy_of(o.y, &parts) - first));
  }
  ode_end(&o);
  return most;
}

static void energy_is_kept_to_rounding(void **state)
{
  (void)state;
  if (!have_it()) return;
  for (int k = 0; k < 2 * METHODS; k++) {
    const char *name = method[k / 2];
    double tolerance = k % 2 ? 1e-4 : -1;
    double free = drift_of(name, NULL, tolerance), relaxed = drift_of(name, "energy", tolerance);
    print_message("# %s, %s: 1000 steps change the energy by %.1e, relaxed by %.1e\n", name,
                  k % 2 ? "error control" : "fixed", free, relaxed);
    if (!(relaxed < 1e-12 && free > 1e-7)) fail_msg("%s: %.1e", name, relaxed);
  }
}

static double error_of(const char *name, int n)
{
  ode o;
  make(&o);
  ode_start(&o, &(sph_integrator_def){.method = name, .dt_fixed = TURN / n, .relax = "energy"});
  if (ode_run(&o, TURN)) fail_msg("%s: %s", name, o.error.text);
  double error = ode_error(&o, TURN, o.y);
  ode_end(&o);
  return error;
}

static void order_is_kept(void **state)
{
  static const int order[] = {3, 4, 5, 3, 2};
  (void)state;
  if (!have_it()) return;
  for (int k = 0; k < METHODS; k++) {
    double coarse = error_of(method[k], 200), fine = error_of(method[k], 400);
    double slope = log2(coarse / fine);
    print_message("# %s: %.2e, %.2e, order %.2f\n", method[k], coarse, fine, slope);
    if (!(slope > order[k] - 0.1)) fail_msg("%s: order %.2f", method[k], slope);
  }
}

/* Longer or shorter steps end beside where they were to end; stop times are exact all the same,
 * and the energy is kept there, too. */
static void stop_times_are_exact(void **state)
{
  (void)state;
  if (!have_it()) return;
  for (int k = 0; k < 2 * METHODS; k++) {
    ode o;
    double first, parts;
    make(&o);
    o.limit[SPH_BOUND_CFL] = 0.1;
    ode_start(&o, &(sph_integrator_def){.method = method[k / 2],
                                        .relax = "energy",
                                        .tolerance = k % 2 ? -1 : 0});
    first = energy_of(o.y, &parts);
    N_Vector at = N_VClone(o.y);
    for (int s = 1; s <= 50; s++) {
      double stop = s * TURN / 50;
      assert_int_equal(ode_run(&o, stop), SPH_OK);
      assert_true(sph_integrator_time(o.it) == stop);
      assert_true(fabs(energy_of(o.y, &parts) - first) < 1e-12);
      double t = sph_integrator_previous(o.it);
      assert_int_equal(sph_integrator_interpolate(o.it, stop - 1e-12 * (stop - t), at), SPH_OK);
    }
    N_VDestroy(at);
    const sph_step_stats *stats = sph_integrator_stats(o.it);
    assert_true(stats->bound_by[SPH_BOUND_STOP] >= 45 && stats->steps < 400);
    assert_true(ode_error(&o, TURN, o.y) < 0.05);
    ode_end(&o);
  }
}

static double dense_error(const char *name, int n)
{
  ode o;
  make(&o);
  double most = 0;
  ode_start(&o, &(sph_integrator_def){.method = name, .dt_fixed = TURN / n, .relax = "energy"});
  N_Vector at = N_VClone(o.y);
  while (sph_integrator_time(o.it) < TURN) {
    assert_int_equal(sph_integrator_step(o.it, TURN), SPH_OK);
    double t0 = sph_integrator_previous(o.it), t1 = sph_integrator_time(o.it);
    for (int k = 1; k < 4; k++) {
      double parts;
      assert_int_equal(sph_integrator_interpolate(o.it, t0 + k * (t1 - t0) / 4, at), SPH_OK);
      most = fmax(most, fabs(energy_of(at, &parts) + 0.5));
    }
  }
  N_VDestroy(at);
  ode_end(&o);
  return most;
}

/* The energy between steps tells how exact the state is there: fourth order in each step. */
static void dense_output_knows_of_it(void **state)
{
  (void)state;
  if (!have_it()) return;
  double order = log2(dense_error(method[1], 200) / dense_error(method[1], 400));
  print_message("# dense output: order %.2f\n", order);
  assert_true(order > 3.8);
}

/* x' = u, u' = -x - u: the energy falls; E'(y) f says how fast. */
static int damped(double t, N_Vector state, N_Vector rate, void *ctx)
{
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate);
  (void)t, (void)ctx;
  N_VConst(0, rate);
  f[ODE_X] = y[ODE_U];
  f[ODE_U] = -y[ODE_X] - y[ODE_U];
  return SPH_OK;
}

static int quadratic(N_Vector from, N_Vector to, double *change, double *rounding, void *ctx)
{
  (void)ctx;
  *change = (N_VDotProd(to, to) - N_VDotProd(from, from)) / 2;
  *rounding = DBL_EPSILON * N_VDotProd(from, from);
  return SPH_OK;
}

static int quadratic_gradient(N_Vector y, N_Vector slope, void *ctx)
{
  (void)ctx;
  N_VScale(1, y, slope);
  return SPH_OK;
}

static void damped_exact(double t, double *y)
{
  double w = sqrt(3) / 2;
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_X] = exp(-t / 2) * (cos(w * t) + sin(w * t) / (2 * w));
  y[ODE_U] = -exp(-t / 2) * sin(w * t) / w;
}

static void energy_falls_at_its_rate(void **state)
{
  (void)state;
  if (!have_it()) return;
  double error[2];
  for (int fine = 0; fine < 2; fine++) {
    ode o;
    ode_oscillator(&o);
    o.problem.rhs = damped;
    o.problem.energy = quadratic;
    o.problem.energy_gradient = quadratic_gradient;
    o.exact = damped_exact;
    ode_start(&o, &(sph_integrator_def){.dt_fixed = fine ? 0.05 : 0.1, .relax = "energy"});
    assert_int_equal(ode_run(&o, 5), SPH_OK);
    error[fine] = ode_error(&o, 5, o.y);
    ode_end(&o);
  }
  assert_true(log2(error[0] / error[1]) > 2.9 && error[1] < 1e-5);
}

/* Steps so long that no relaxation keeps the energy are tried again, halved. */
static void steps_without_one_are_halved(void **state)
{
  (void)state;
  if (!have_it()) return;
  for (int k = 0; k < 2; k++) {
    ode o;
    make(&o);
    o.limit[SPH_BOUND_CFL] = 2;
    ode_start(&o, &(sph_integrator_def){.relax = "energy", .tolerance = k ? 1e3 : -1});
    assert_int_equal(ode_run(&o, TURN), SPH_OK);
    assert_true(k || sph_integrator_stats(o.it)->retries > 0);
    double parts;
    assert_true(fabs(energy_of(o.y, &parts) + 0.5) < 1e-12);
    energy_status = SPH_ERR_STATE; /* and one that cannot be evaluated ends the run */
    assert_int_equal(ode_run(&o, 2 * TURN), SPH_ERR_STATE);
    ode_end(&o);
  }
}

static void misuse_is_refused_with_a_reason(void **state)
{
  static const struct {
    sph_integrator_def def;
    const char *text;
  } row[] = {
      {{.relax = "entropy"}, "right are \"energy\" and none"},
      {{.method = "leapfrog", .relax = "energy"}, "those that do are"},
      {{.method = "mri:kw3", .relax = "energy"}, "those that do are"},
      {{.method = "imex:ark324l2sa-4-2-3", .relax = "energy"}, "negative weight"},
      {{.method = "erk:dormand-prince-7-4-5", .relax = "energy"}, "negative weight"},
  };
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    sph_error error = {0};
    assert_int_equal(sph_integrator_check(&row[k].def, &error), SPH_ERR_ARGUMENT);
    if (!strstr(error.text, row[k].text)) fail_msg("\"%s\" lacks \"%s\"", error.text, row[k].text);
  }
  if (!have_it()) return;
  ode o;
  ode_made(&o);
  o.it = sph_integrator_create(&(sph_integrator_def){.relax = "energy"}, &o.problem, 0, o.y,
                               o.context, &o.error);
  assert_null(o.it);
  assert_non_null(strstr(o.error.text, "there is no energy"));
  ode_end(&o);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(energy_is_kept_to_rounding),
      cmocka_unit_test(order_is_kept),
      cmocka_unit_test(stop_times_are_exact),
      cmocka_unit_test(dense_output_knows_of_it),
      cmocka_unit_test(energy_falls_at_its_rate),
      cmocka_unit_test(steps_without_one_are_halved),
      cmocka_unit_test(misuse_is_refused_with_a_reason),
  };
  return cmocka_run_group_tests_name("relax", tests, NULL, NULL);
}
