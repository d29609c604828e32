/* Forward sensitivities against central differences of whole runs with fixed steps: every kind of
 * parameter, monitors, integrators, the start; and a closed form. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

enum { PARAMETERS = 9 };
static const char *const names[PARAMETERS] = {
    "water.viscosity", "viscosity-artificial.alpha", "delta.delta",       "h", "water.c0",
    "gravity.y",       "water.conductivity",         "floor.temperature", "k"};
static const double values[PARAMETERS] = {0.4, 0.1, 0.1, 1.5, 12, -9.81, 30, 310, 0.3};

/* A drag of our own: a = -k v. */
static int drag(const sph_term *term, const sph_particles *p)
{
  const double *k = term->ctx;
  for (int d = 0; d < p->dim; d++)
    for (long i = 0; i < p->n; i++) p->a[d][i] -= *k * p->v[d][i];
  return SPH_OK;
}

/* A block of warm water that falls a little, spreads over a floor and is heated there; h: h/dx. */
static sph_sim *block(double theta[PARAMETERS], const char *method)
{
  const double dx = 0.1, rho0 = 1000;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = theta[3]});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){0.6, 0.8}, rho0);
  sph_eos eos = sph_eos_tait(rho0, theta[4], 7);
  eos.c_v = 20;
  sph_group_set_eos(water, eos);
  sph_group_set_energy(water, "temperature");
  double T[48];
  for (int i = 0; i < 48; i++) T[i] = 290 + i;
  sph_group_set_temperature(water, T);
  sph_group_set_viscosity(water, theta[0]);
  sph_group_set_conductivity(water, theta[6]);
  sph_group_jitter(water, 0.1, 3);
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_box(floor, (double[]){-0.8, -0.3}, (double[]){1.4, 0}, rho0);
  sph_boundary boundary = sph_boundary_adami_no_slip();
  boundary.temperature = theta[7];
  boundary.tension = 1; /* no cut: the run depends on parameters smoothly */
  sph_group_set_boundary(floor, boundary);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(theta[1], 0));
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_add_term(sim, sph_term_delta("antuono", theta[2]));
  sph_sim_add_term(sim, sph_term_gravity((double[]){0, theta[5], 0}));
  sph_sim_add_term(sim, (sph_term){.name = "drag", .body = drag, .ctx = &theta[8]});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .dt_fixed = 2e-3});
  return sim;
}

static const sph_monitor monitors[] = {
    {.name = "front", .type = "front", .axis = 0},
    {.name = "probe", .type = "pressure", .x = {0.3, 0.05}},
    {.name = "height", .type = "height"},
    {.name = "axis", .type = "semi-axis", .axis = 1},
};
enum { MONITORS = sizeof monitors / sizeof *monitors, WATCHED = MONITORS + 3 };

/* Monitors, and three entries of the state. */
static void look(sph_sim *sim, double q[WATCHED])
{
  const sph_group *water = sph_sim_group(sim, "water");
  for (int m = 0; m < MONITORS; m++) {
    sph_error error = {0};
    if (sph_monitor_value(&monitors[m], sim, &q[m], &error)) fail_msg("%s", error.text);
  }
  q[MONITORS] = sph_group_read(water, "velocity", 0)[5];
  q[MONITORS + 1] = sph_group_read(water, "density", 0)[20];
  q[MONITORS + 2] = sph_group_read(water, "temperature", 0)[3];
}

/* Of a run with parameter k moved by e of itself. */
static void run_beside(int k, double e, const char *method, double t_end, double q[WATCHED])
{
  double theta[PARAMETERS];
  memcpy(theta, values, sizeof theta);
  theta[k] *= 1 + e;
  sph_sim *sim = block(theta, method);
  if (sph_sim_run(sim, t_end)) fail_msg("%s", sph_sim_error(sim));
  look(sim, q);
  sph_sim_free(sim);
}

/* d/dtheta_k, four points; h is 0.1 times h/dx. */
static void differences(int k, double e, const char *method, double t_end, double d[WATCHED])
{
  static const double at[] = {-2, -1, 1, 2}, weight[] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
  const double unit = k == 3 ? 0.1 : 1;
  memset(d, 0, WATCHED * sizeof *d);
  for (int p = 0; p < 4; p++) {
    double q[WATCHED];
    run_beside(k, at[p] * e, method, t_end, q);
    for (int m = 0; m < WATCHED; m++) d[m] += weight[p] * q[m] / (e * values[k] * unit);
  }
}

static void compare(const char *method, double t_end, double tolerance)
{
  double theta[PARAMETERS], q[WATCHED], worst = 0;
  memcpy(theta, values, sizeof theta);
  sph_sim *sim = block(theta, method);
  sph_sensitivity_parameter parameters[PARAMETERS];
  for (int k = 0; k < PARAMETERS; k++)
    parameters[k] = (sph_sensitivity_parameter){names[k], k == PARAMETERS - 1 ? &theta[k] : NULL};
  sph_sensitivity *s = sph_sensitivity_create(sim, PARAMETERS, parameters);
  if (!s || sph_sensitivity_run(s, t_end / 2) || sph_sensitivity_run(s, t_end))
    fail_msg("%s", sph_sim_error(sim));
  look(sim, q);
  const sph_group *water = sph_sim_group(sim, "water");
  for (int k = 0; k < PARAMETERS; k++) {
    double d[WATCHED], found[WATCHED], error = INFINITY;
    for (int m = 0; m < MONITORS; m++)
      if (sph_sensitivity_of_monitor(s, k, &monitors[m], &found[m]))
        fail_msg("%s", sph_sim_error(sim));
    found[MONITORS] = sph_sensitivity_read(s, k, water, "velocity", 0)[5];
    found[MONITORS + 1] = sph_sensitivity_read(s, k, water, "density", 0)[20];
    found[MONITORS + 2] = sph_sensitivity_read(s, k, water, "temperature", 0)[3];
    for (double e = 1e-3; e > 1e-6 && error > tolerance; e /= 10) { /* kinks: see test_tangent.c */
      double most = 0;
      differences(k, e, method, t_end, d);
      for (int m = 0; m < WATCHED; m++) {
        /* rounding of a run is 1e-13 of what it shows; a hundredth of it over theta is large */
        double size = fmax(fabs(d[m]), 1e-2 * fabs(q[m] / values[k] / (k == 3 ? 0.1 : 1)));
        most = fmax(most, fabs(found[m] - d[m]) / size);
      }
      error = fmin(error, most);
    }
    if (!(error <= tolerance)) fail_msg("%s, d/d %s: error %.3g", method, names[k], error);
    worst = fmax(worst, error);
  }
  assert_true(theta[PARAMETERS - 1] == values[PARAMETERS - 1]);
  print_message("# %s: largest error %.2g\n", method, worst);
  sph_sensitivity_free(s);
  sph_sim_free(sim);
}

static void runge_kutta(void **state)
{
  (void)state, compare("erk:bogacki-shampine-4-2-3", 0.1, 1e-6);
}
static void leapfrog(void **state) { (void)state, compare("leapfrog", 0.1, 1e-6); }
static void others(void **state)
{
  (void)state;
  compare("erk:rdpk3sp35-5-2-3", 0.04, 1e-6);
  compare("predictor-corrector", 0.04, 1e-6);
}

/* ---- closed forms ---- */

/* Free fall with a start velocity v0: x = v0 t + g t^2/2, whatever particles do to each other. */
static sph_sim *falling(const char *method, double dt)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *drop = sph_group_create(sim, "drop", "fluid");
  sph_group_add_ball(drop, (double[]){0, 0}, 0.35, 1000);
  sph_group_set_eos(drop, sph_eos_tait(1000, 10, 7));
  double *v = sph_group_write(drop, "velocity", 0), *y = sph_group_write(drop, "position", 1);
  for (long i = 0; v && y && i < sph_group_count(drop); i++) v[i] = 0.3 * y[i];
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  sph_sim_add_term(sim, sph_term_gravity((double[]){1, -9.81, 0}));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .dt_fixed = dt});
  return sim;
}

static void fall(void **state)
{
  (void)state;
  static const char *const method[] = {"erk:bogacki-shampine-4-2-3", "leapfrog", "dkd",
                                       "symplectic"};
  for (int m = 0; m < 4; m++) {
    double v0 = 0, t = 0.1;
    sph_sim *sim = falling(method[m], 2e-3);
    sph_sensitivity *s =
        sph_sensitivity_create(sim, 2,
                               (sph_sensitivity_parameter[]){{"gravity.y", NULL}, {"v0", &v0}});
    const sph_group *drop = sph_sim_group(sim, "drop");
    double *start = sph_sensitivity_write(s, 1, drop, "velocity", 0);
    if (!start) fail_msg("%s", sph_sim_error(sim));
    for (long i = 0; i < sph_group_count(drop); i++) start[i] = 1;
    assert_int_equal(sph_sensitivity_run(s, t), SPH_OK);
    double found[2];
    const sph_monitor front[] = {{.name = "y", .type = "front", .axis = 1},
                                 {.name = "x", .type = "front", .axis = 0}};
    for (int k = 0; k < 2; k++)
      assert_int_equal(sph_sensitivity_of_monitor(s, k, &front[k], &found[k]), SPH_OK);
    if (!(fabs(found[0] / (t * t / 2) - 1) < 1e-8 && fabs(found[1] / t - 1) < 1e-8))
      fail_msg("%s: %.12g, %.12g", method[m], found[0], found[1]);
    const double *x = sph_sensitivity_read(s, 1, drop, "position", 0);
    const double *rho = sph_sensitivity_read(s, 1, drop, "density", 0);
    for (long i = 0; i < sph_group_count(drop); i++)
      assert_true(fabs(x[i] / t - 1) < 1e-12 && fabs(rho[i]) < 1e-8);
    sph_sensitivity_free(s);
    sph_sim_free(sim);
  }
}

/* Sensitivities along do not change the steps that error control takes. */
static void error_control(void **state)
{
  (void)state;
  double theta[PARAMETERS], q[2][WATCHED];
  memcpy(theta, values, sizeof theta);
  for (int along = 0; along < 2; along++) {
    sph_sim *sim = block(theta, NULL);
    sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-3});
    sph_sensitivity *s =
        along
            ? sph_sensitivity_create(sim, 2,
                                     (sph_sensitivity_parameter[]){{"h", NULL}, {"water.c0", NULL}})
            : NULL;
    int status = along ? sph_sensitivity_run(s, 0.2) : sph_sim_run(sim, 0.2);
    if (status) fail_msg("%s", sph_sim_error(sim));
    assert_true(sph_sim_time(sim) == 0.2);
    look(sim, q[along]);
    sph_sensitivity_free(s);
    sph_sim_free(sim);
  }
  for (int m = 0; m < WATCHED; m++) assert_true(fabs(q[1][m] - q[0][m]) < 1e-8 * fabs(q[0][m]));
}

/* A run begins with the fields as they are, whenever they were written. */
static void fields_that_are_written(void **state)
{
  (void)state;
  const sph_sensitivity_parameter g = {"gravity.y", NULL};
  double rho[2], slope[2];
  for (int late = 0; late < 2; late++) {
    sph_sim *sim = falling(NULL, 2e-3);
    sph_group *drop = sph_sim_group(sim, "drop");
    sph_sensitivity *s = late ? sph_sensitivity_create(sim, 1, &g) : NULL;
    for (int part = 0; part < 2; part++) { /* before the first run, and between runs */
      double *v = sph_group_write(drop, "velocity", 0);
      for (long i = 0; i < sph_group_count(drop); i++) v[i] *= 2;
      sph_sim_changed(sim);
      if (!s) s = sph_sensitivity_create(sim, 1, &g);
      if (sph_sensitivity_run(s, 0.02 * (1 + part))) fail_msg("%s", sph_sim_error(sim));
    }
    rho[late] = sph_group_read(drop, "density", 0)[5];
    slope[late] = sph_sensitivity_read(s, 0, drop, "position", 1)[5];
    assert_int_equal(sph_sim_run(sim, 0.05), SPH_OK);
    assert_int_equal(sph_sensitivity_run(s, 0.06), SPH_ERR_STATE);
    assert_non_null(strstr(sph_sim_error(sim), "went on to 0.05 s without them"));
    sph_sensitivity_free(s);
    sph_sim_free(sim);
  }
  assert_true(rho[0] == rho[1] && slope[0] == slope[1]);
}

/* ---- refusals ---- */

static void refuse(sph_sim *sim, const char *parameter, const char *what)
{
  sph_sensitivity_parameter p = {parameter, NULL};
  assert_null(sph_sensitivity_create(sim, 1, &p));
  if (!strstr(sph_sim_error(sim), what)) fail_msg("\"%s\": not \"%s\"", sph_sim_error(sim), what);
  sph_sim_free(sim);
}

static void refusals(void **state)
{
  (void)state;
  double theta[PARAMETERS];
  memcpy(theta, values, sizeof theta);
  refuse(block(theta, NULL), "water.viscocity", "did you mean 'water.viscosity'");
  refuse(block(theta, NULL), NULL, "known: h, viscosity-artificial.alpha");
  refuse(falling(NULL, 1e-3), "delta.delta", "unknown here");
  sph_sim *sim = block(theta, NULL);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "imex:ark324l2sa-4-2-3"});
  refuse(sim, "h", "steps all terms alike");
  sim = falling(NULL, 1e-3);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.relax = "energy"});
  refuse(sim, "h", "relax"); /* SUNDIALS before 6.6 has none */
  sim = falling(NULL, 1e-3);
  sph_sim_add_event(sim, &(sph_event){.name = "far", .type = "front", .threshold = 5});
  refuse(sim, "h", "events");
  sim = falling(NULL, 1e-3);
  sph_sensitivity *s = sph_sensitivity_create(sim, 1, &(sph_sensitivity_parameter){"h", NULL});
  const sph_group *drop = sph_sim_group(sim, "drop");
  assert_null(sph_sensitivity_read(s, 1, drop, "density", 0));
  assert_null(sph_sensitivity_read(s, 0, drop, "pressure", 0));
  assert_int_equal(sph_sensitivity_run(s, -1), SPH_ERR_ARGUMENT);
  assert_null(sph_sensitivity_write(s, 0, drop, "density", 0));
  sph_sensitivity_free(s);
  sph_sim_free(sim);
  assert_null(sph_sensitivity_create(NULL, 1, NULL));
  sph_sensitivity_free(NULL);
  char name[64];
  sim = falling(NULL, 1e-3);
  int n = 0, found = 0;
  for (; sph_sensitivity_known(sim, n, name, sizeof name); n++)
    found += !strcmp(name, "drop.gamma") || !strcmp(name, "gravity.x");
  assert_true(n >= 7 && found == 2);
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(runge_kutta),   cmocka_unit_test(leapfrog),
      cmocka_unit_test(others),        cmocka_unit_test(fall),
      cmocka_unit_test(error_control), cmocka_unit_test(fields_that_are_written),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests_name("sensitivity", tests, NULL, NULL);
}
