/* Adjoint gradients against forward sensitivities and against differences of whole runs, with
 * respect to parameters and to the start; any number of checkpoints gives the same bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

enum { PARAMETERS = 8, N = 48 };
static const char *const names[PARAMETERS] = {"water.viscosity",   "viscosity-artificial.alpha",
                                              "delta.delta",       "h",
                                              "water.c0",          "gravity.y",
                                              "floor.temperature", "k"};
static const double values[PARAMETERS] = {0.4, 0.1, 0.1, 1.5, 12, -9.81, 310, 0.3};
static const double dt = 3e-3, t_end = 0.0325; /* ten steps and a shorter one */

/* A drag of our own: a = -k v |v|. */
static int drag(const sph_term *term, const sph_particles *p)
{
  const double *k = term->ctx;
  for (long i = 0; i < p->n; i++) {
    double v = sqrt(p->v[0][i] * p->v[0][i] + p->v[1][i] * p->v[1][i]);
    for (int d = 0; d < p->dim; d++) p->a[d][i] -= *k * v * p->v[d][i];
  }
  return SPH_OK;
}

/* A block of warm water on a floor; moved: its start beside the usual one, by e times a pattern. */
static sph_sim *block(double theta[PARAMETERS], const char *method, double moved)
{
  const double rho0 = 1000;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .h_over_dx = theta[3]});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){0.6, 0.8}, rho0);
  sph_eos eos = sph_eos_tait(rho0, theta[4], 7);
  eos.c_v = 20;
  sph_group_set_eos(water, eos);
  sph_group_set_energy(water, "temperature");
  double T[N];
  for (int i = 0; i < N; i++) T[i] = 290 + i;
  sph_group_set_temperature(water, T);
  sph_group_set_viscosity(water, theta[0]);
  sph_group_set_conductivity(water, 30);
  sph_group_jitter(water, 0.1, 3);
  double *x = sph_group_write(water, "position", 0), *v = sph_group_write(water, "velocity", 1);
  double *rho = sph_group_write(water, "density", 0);
  for (int i = 0; x && v && rho && i < N; i++) {
    x[i] += moved * 0.1 * sin(i), v[i] += 0.3 * cos(i) + moved * sin(2 * i);
    rho[i] += moved * 20 * cos(3 * i);
  }
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_box(floor, (double[]){-0.8, -0.3}, (double[]){1.4, 0}, rho0);
  sph_boundary boundary = sph_boundary_adami_no_slip();
  boundary.temperature = theta[6];
  boundary.tension = 1;
  sph_group_set_boundary(floor, boundary);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(theta[1], 0));
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_add_term(sim, sph_term_delta("antuono", theta[2]));
  sph_sim_add_term(sim, sph_term_gravity((double[]){0, theta[5], 0}));
  if (theta[7] > 0)
    sph_sim_add_term(sim, (sph_term){.name = "drag", .body = drag, .ctx = &theta[7]});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .dt_fixed = dt});
  return sim;
}

/* ---- functionals: phi = sum a x^2 + b v^3 + c rho + d T, r = sum w(x) p + v^2 ---- */

static double end(void *ctx, sph_sim *sim)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *v = sph_group_read(water, "velocity", 1);
  const double *rho = sph_group_read(water, "density", 0);
  const double *T = sph_group_read(water, "temperature", 0);
  double sum = 0;
  (void)ctx;
  for (int i = 0; i < N; i++)
    sum += x[i] * x[i] + 3 * v[i] * v[i] * v[i] + 0.1 * i * (rho[i] - 1000) + T[i] / 100;
  return sum;
}

static void end_gradient(void *ctx, sph_sim *sim, sph_adjoint *a)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *v = sph_group_read(water, "velocity", 1);
  double *gx = sph_adjoint_gradient(a, water, "position", 0);
  double *gv = sph_adjoint_gradient(a, water, "velocity", 1);
  double *grho = sph_adjoint_gradient(a, water, "density", 0);
  double *gT = sph_adjoint_gradient(a, water, "temperature", 0);
  (void)ctx;
  for (int i = 0; i < N; i++) {
    gx[i] += 2 * x[i];
    gv[i] += 9 * v[i] * v[i];
    grho[i] += 0.1 * i;
    gT[i] += 1 / 100.0;
  }
}

static double probe(void *ctx, sph_sim *sim)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *v = sph_group_read(water, "velocity", 1);
  const double *p = sph_group_read(water, "pressure", 0);
  double sum = 0;
  (void)ctx;
  for (int i = 0; i < N; i++) sum += exp(-10 * x[i] * x[i]) * p[i] / 100 + v[i] * v[i];
  return sum;
}

static void probe_gradient(void *ctx, sph_sim *sim, sph_adjoint *a)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *v = sph_group_read(water, "velocity", 1);
  const double *p = sph_group_read(water, "pressure", 0);
  double *gx = sph_adjoint_gradient(a, water, "position", 0);
  double *gv = sph_adjoint_gradient(a, water, "velocity", 1);
  double *gp = sph_adjoint_gradient(a, water, "pressure", 0);
  (void)ctx;
  for (int i = 0; i < N; i++) {
    double w = exp(-10 * x[i] * x[i]) / 100;
    gx[i] += -20 * x[i] * w * p[i];
    gv[i] += 2 * v[i];
    gp[i] += w;
  }
}

static const sph_functional functionals[] = {
    {.end = end, .end_gradient = end_gradient},
    {.running = probe, .running_gradient = probe_gradient},
    {.end = probe,
     .end_gradient = probe_gradient,
     .running = end,
     .running_gradient = end_gradient},
};
enum { FUNCTIONALS = sizeof functionals / sizeof *functionals };

static sph_adjoint *adjoint(sph_sim *sim, double theta[PARAMETERS], int which, int checkpoints)
{
  sph_sensitivity_parameter p[PARAMETERS];
  for (int k = 0; k < PARAMETERS; k++)
    p[k] = (sph_sensitivity_parameter){names[k], k == PARAMETERS - 1 ? &theta[k] : NULL};
  sph_adjoint *a = sph_adjoint_create(sim, &(sph_adjoint_def){.functional = functionals[which],
                                                              .n = theta ? PARAMETERS : 0,
                                                              .parameters = p,
                                                              .checkpoints = checkpoints});
  if (!a) fail_msg("%s", sph_sim_error(sim));
  return a;
}

/* J of a run with a parameter, or the start (k < 0), moved by e. */
static double value_beside(const char *method, int which, int k, double e)
{
  double theta[PARAMETERS];
  memcpy(theta, values, sizeof theta);
  if (k >= 0) theta[k] *= 1 + e;
  sph_sim *sim = block(theta, method, k < 0 ? e : 0);
  sph_adjoint *a = sph_adjoint_create(sim, &(sph_adjoint_def){.functional = functionals[which]});
  if (!a || sph_adjoint_evaluate(a, t_end)) fail_msg("%s", sph_sim_error(sim));
  double value = sph_adjoint_value(a);
  sph_adjoint_free(a);
  sph_sim_free(sim);
  return value;
}

static double difference(const char *method, int which, int k, double e)
{
  static const double at[] = {-2, -1, 1, 2}, weight[] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
  double sum = 0, unit = k < 0 ? 1 : values[k] * (k == 3 ? 0.1 : 1);
  for (int p = 0; p < 4; p++)
    sum += weight[p] * value_beside(method, which, k, at[p] * e) / (e * unit);
  return sum;
}

/* lambda_0 times the pattern that block() moves the start by. */
static double along_the_start(const sph_adjoint *a, const sph_sim *sim)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *gx = sph_adjoint_start(a, water, "position", 0);
  const double *gv = sph_adjoint_start(a, water, "velocity", 1);
  const double *grho = sph_adjoint_start(a, water, "density", 0);
  double sum = 0;
  for (int i = 0; i < N; i++)
    sum += gx[i] * 0.1 * sin(i) + gv[i] * sin(2 * i) + grho[i] * 20 * cos(3 * i);
  return sum;
}

static void against_differences(void **state)
{
  (void)state;
  static const char *const methods[] = {"erk:bogacki-shampine-4-2-3", "erk:zonneveld-5-3-4",
                                        "erk:heun-euler-2-1-2"};
  double worst = 0;
  for (int which = 0; which < FUNCTIONALS; which++) {
    double theta[PARAMETERS];
    memcpy(theta, values, sizeof theta);
    sph_sim *sim = block(theta, methods[which], 0);
    sph_adjoint *a = adjoint(sim, theta, which, 0);
    if (sph_adjoint_run(a, t_end)) fail_msg("%s", sph_sim_error(sim));
    assert_true(sph_sim_time(sim) == t_end);
    for (int k = -1; k < PARAMETERS; k++) {
      double found = k < 0 ? along_the_start(a, sim) : sph_adjoint_parameter(a, k),
             error = INFINITY;
      double size = 1e-3 * fabs(sph_adjoint_value(a) / (k < 0 ? 1 : values[k]));
      for (double e = 1e-3; e > 1e-6 && error > 1e-6; e /= 10) { /* kinks: see test_tangent.c */
        double expected = difference(methods[which], which, k, e);
        error = fmin(error, fabs(found - expected) / fmax(fabs(expected), size));
      }
      worst = fmax(worst, error);
      if (!(error <= 1e-6))
        fail_msg("functional %d, %s: %.12g, error %.3g", which, k < 0 ? "start" : names[k], found,
                 error);
    }
    sph_adjoint_free(a);
    sph_sim_free(sim);
  }
  print_message("# largest error %.2g\n", worst);
}

static int quantity(void *ctx, sph_sim *sim, double *value)
{
  const sph_functional *f = ctx;
  *value = f->end(f->ctx, sim);
  return SPH_OK;
}

/* sum over the state of dphi/dy times dy/dtheta; size: of what is added up. */
static double by_fields(sph_sim *sim, const sph_sensitivity *s, int k, double *size)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *v = sph_group_read(water, "velocity", 1);
  const double *sx = sph_sensitivity_read(s, k, water, "position", 0);
  const double *sv = sph_sensitivity_read(s, k, water, "velocity", 1);
  const double *srho = sph_sensitivity_read(s, k, water, "density", 0);
  const double *sT = sph_sensitivity_read(s, k, water, "temperature", 0);
  double sum = *size = 0;
  for (int i = 0; i < N; i++) {
    const double part[] = {2 * x[i] * sx[i], 9 * v[i] * v[i] * sv[i], 0.1 * i * srho[i],
                           sT[i] / 100};
    for (int q = 0; q < 4; q++) sum += part[q], *size += fabs(part[q]);
  }
  return sum;
}

/* Both are derivatives of the same numbers: forward and backward agree to rounding (what parameters
 * do outside of pairs is differenced, by both in the same way). */
static void against_forward(void **state)
{
  (void)state;
  double theta[PARAMETERS], unused = 0, worst = 0;
  memcpy(theta, values, sizeof theta);
  theta[PARAMETERS - 1] = 0; /* no term of the user's */
  const char *method = "erk:bogacki-shampine-4-2-3";
  sph_sim *sim = block(theta, method, 0), *other = block(theta, method, 0);
  enum { START = PARAMETERS - 1 };
  sph_sensitivity_parameter p[START + 1];
  for (int k = 0; k <= START; k++)
    p[k] = (sph_sensitivity_parameter){k < START ? names[k] : "start", k < START ? NULL : &unused};
  sph_sensitivity *s = sph_sensitivity_create(other, START + 1, p);
  const sph_group *water = sph_sim_group(other, "water");
  double *x = sph_sensitivity_write(s, START, water, "position", 0);
  double *v = sph_sensitivity_write(s, START, water, "velocity", 1);
  double *rho = sph_sensitivity_write(s, START, water, "density", 0);
  if (!rho) fail_msg("%s", sph_sim_error(other));
  for (int i = 0; i < N; i++) x[i] = 0.1 * sin(i), v[i] = sin(2 * i), rho[i] = 20 * cos(3 * i);
  sph_adjoint *a = adjoint(sim, theta, 0, 0);
  if (sph_sensitivity_run(s, t_end)) fail_msg("%s", sph_sim_error(other));
  if (sph_adjoint_run(a, t_end)) fail_msg("%s", sph_sim_error(sim));
  for (int k = 0; k <= START; k++) {
    double back = k < START ? sph_adjoint_parameter(a, k) : along_the_start(a, sim);
    double size, forward = by_fields(other, s, k, &size), by_quantity;
    assert_int_equal(sph_sensitivity_of(s, k, quantity, (void *)&functionals[0], &by_quantity),
                     SPH_OK);
    print_message("# %s: %.12g, forward %.3g of size, of the quantity %.3g\n", p[k].name, back,
                  fabs(back - forward) / size, fabs(back - by_quantity) / size);
    if (size > 0) worst = fmax(worst, fabs(back - forward) / size);
    assert_true(fabs(back - by_quantity) <= 1e-6 * size);
  }
  print_message("# largest difference %.2g of size\n", worst);
  assert_true(worst < 5e-12);
  sph_adjoint_free(a), sph_sensitivity_free(s);
  sph_sim_free(sim), sph_sim_free(other);
}

static void checkpoints(void **state)
{
  (void)state;
  double theta[PARAMETERS], first[PARAMETERS + 2];
  memcpy(theta, values, sizeof theta);
  for (int kept = 1; kept <= 12; kept += kept < 4 ? 1 : 4) {
    double found[PARAMETERS + 2];
    sph_sim *sim = block(theta, NULL, 0);
    sph_adjoint *a = adjoint(sim, theta, 2, kept);
    if (sph_adjoint_run(a, t_end)) fail_msg("%s", sph_sim_error(sim));
    for (int k = 0; k < PARAMETERS; k++) found[k] = sph_adjoint_parameter(a, k);
    found[PARAMETERS] = along_the_start(a, sim);
    found[PARAMETERS + 1] = sph_adjoint_value(a);
    if (kept == 1) memcpy(first, found, sizeof first);
    /* lists are made at other places: sums in another order */
    for (int k = 0; k < PARAMETERS + 2; k++) assert_true(fabs(found[k] / first[k] - 1) < 1e-9);
    sph_adjoint_free(a);
    sph_sim_free(sim);
  }
}

/* Its run is that of the simulation alone. */
static void same_run(void **state)
{
  (void)state;
  double theta[PARAMETERS], q[2];
  memcpy(theta, values, sizeof theta);
  for (int k = 0; k < 2; k++) {
    sph_sim *sim = block(theta, NULL, 0);
    sph_adjoint *a = k ? adjoint(sim, theta, 0, 0) : NULL;
    int status = k ? sph_adjoint_run(a, t_end) : sph_sim_run(sim, t_end);
    if (status) fail_msg("%s", sph_sim_error(sim));
    q[k] = end(NULL, sim);
    if (k) assert_true(fabs(sph_adjoint_value(a) / q[1] - 1) < 1e-14);
    assert_int_equal(sph_sim_run(sim, 2 * t_end), SPH_OK); /* and goes on */
    sph_adjoint_free(a);
    sph_sim_free(sim);
  }
  assert_true(fabs(q[1] / q[0] - 1) < 1e-12);
}

static void refuse(sph_sim *sim, sph_adjoint_def def, const char *what)
{
  sph_adjoint *a = sph_adjoint_create(sim, &def);
  if (a) {
    assert_true(sph_adjoint_run(a, 0.01) < 0);
    sph_adjoint_free(a);
  }
  if (!strstr(sph_sim_error(sim), what)) fail_msg("\"%s\": not \"%s\"", sph_sim_error(sim), what);
  sph_sim_free(sim);
}

static void refusals(void **state)
{
  (void)state;
  double theta[PARAMETERS];
  memcpy(theta, values, sizeof theta);
  const sph_adjoint_def good = {.functional = functionals[0]};
  refuse(block(theta, "leapfrog", 0), good, "explicit Runge-Kutta");
  sph_sim *sim = block(theta, NULL, 0);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-3});
  refuse(sim, good, "dt_fixed = 0");
  sim = block(theta, NULL, 0);
  sph_group_set_energy(sph_sim_group(sim, "water"), "u"); /* temperature does not relax */
  sph_sim_set_integrator(sim, &(sph_integrator_def){.dt_fixed = dt, .relax = "energy"});
  refuse(sim, good, "relax"); /* SUNDIALS before 6.6 has none */
  refuse(block(theta, NULL, 0), (sph_adjoint_def){0}, "end missing, a running part missing");
  refuse(block(theta, NULL, 0), (sph_adjoint_def){.functional.end = end}, "without gradient");
  refuse(block(theta, NULL, 0), (sph_adjoint_def){.functional = functionals[0], .n = 1},
         "1 parameters");
  sph_sensitivity_parameter unknown = {"water.colour", NULL};
  refuse(block(theta, NULL, 0),
         (sph_adjoint_def){.functional = functionals[0], .n = 1, .parameters = &unknown},
         "unknown here");
  sim = block(theta, NULL, 0);
  sph_adjoint *a = sph_adjoint_create(sim, &good);
  assert_true(isnan(sph_adjoint_parameter(a, 0)));
  assert_null(sph_adjoint_gradient(a, sph_sim_group(sim, "floor"), "pressure", 0));
  assert_null(sph_adjoint_start(a, sph_sim_group(sim, "water"), "pressure", 0));
  assert_int_equal(sph_adjoint_run(a, 0), SPH_ERR_ARGUMENT);
  sph_adjoint_free(a);
  sph_sim_free(sim);
  assert_null(sph_adjoint_create(NULL, &good));
  sph_adjoint_free(NULL);
  assert_true(isnan(sph_adjoint_value(NULL)));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(against_differences),
      cmocka_unit_test(against_forward),
      cmocka_unit_test(checkpoints),
      cmocka_unit_test(same_run),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests_name("adjoint", tests, NULL, NULL);
}
