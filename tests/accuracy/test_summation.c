/* Summed density: a lattice at rest has its reference density and stays there; sound is that of the
 * row C1, S, whose continuity is its time derivative; Sod's tube. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "sphode.h"

static const double pi = 3.14159265358979323846, rho0 = 1000, c0 = 20; /* [kg/m^3], [m/s] */

static sph_sim *box(int dim, int calibrate, const char *method)
{
  sph_sim_def def = {.dim = dim, .dx = 0.1, .speed = 1, .h_over_dx = 1.5};
  for (int d = 0; d < dim; d++) def.periodic[d] = 1, def.length[d] = 1;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *water = sph_group_box(sim, "water", (double[3]){0}, (double[]){1, 1, 1}, rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  sph_sim_add_term(sim, sph_term_summation(calibrate));
  sph_sim_add_term(sim, sph_term_pressure_form("s"));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method});
  return sim;
}

/* Without calibration the sum is that of V W over the lattice, 1 + 5.142341e-3 in 2D for Wendland
 * C2 with h = 1.5 dx (computed elsewhere, in two ways). */
static void lattice(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++)
    for (int calibrate = 0; calibrate < 2; calibrate++) {
      sph_sim *sim = box(dim, calibrate, "leapfrog");
      if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
      sph_group *water = sph_sim_group(sim, "water");
      const double *rho = sph_group_read(water, "density", 0);
      for (long i = 0; i < sph_group_count(water); i++) {
        if (calibrate) assert_true(fabs(rho[i] / rho0 - 1) <= 1e-12);
        if (!calibrate && dim == 2) assert_true(fabs(rho[i] / rho0 - 1 - 5.142341e-3) <= 5e-10);
      }
      sph_sim_free(sim);
    }
}

/* Walls count with the same calibrated volume: the liquid beside them is at rest, too. */
static void between_walls(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++) {
    int up = dim - 1;
    const double lo[3] = {0}, hi[] = {1, 1, 1};
    sph_sim_def def = {.dim = dim, .dx = 0.1, .h_over_dx = 1.5};
    for (int d = 0; d < up; d++) def.periodic[d] = 1, def.length[d] = 1;
    sph_sim *sim = sph_sim_create(&def);
    sph_group *water = sph_group_box(sim, "water", lo, hi, rho0);
    sph_group *walls = sph_group_create(sim, "walls", "wall");
    sph_group_add_layers(walls, lo, hi, dim == 3 ? "x- x+ y- y+" : dim == 2 ? "x- x+" : "", rho0);
    sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
    sph_group_set_boundary(walls, sph_boundary_adami());
    sph_sim_add_term(sim, sph_term_summation(1));
    sph_sim_add_term(sim, sph_term_pressure_form("s"));
    if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
    const double *rho = sph_group_read(water, "density", 0);
    for (long i = 0; i < sph_group_count(water); i++)
      if (!(fabs(rho[i] / rho0 - 1) <= 1e-12)) fail_msg("%dD: density %.17g", dim, rho[i]);
    sph_sim_free(sim);
  }
}

static void stays_at_rest(void **state)
{
  (void)state;
  static const char *const method[] = {"leapfrog", "erk:bogacki-shampine-4-2-3"};
  for (int m = 0; m < 2; m++) {
    sph_sim *sim = box(2, 1, method[m]);
    if (sph_sim_run(sim, 1) != SPH_OK) fail_msg("%s", sph_sim_error(sim)); /* 20 crossings */
    sph_group *water = sph_sim_group(sim, "water");
    const double *rho = sph_group_read(water, "density", 0);
    double fastest = 0, off = 0;
    for (long i = 0; i < sph_group_count(water); i++) {
      off = fmax(off, fabs(rho[i] / rho0 - 1));
      for (int d = 0; d < 2; d++)
        fastest = fmax(fastest, fabs(sph_group_read(water, "velocity", d)[i]));
    }
    print_message("# %s: velocity %.2g c0, density off by %.2g\n", method[m], fastest / c0, off);
    assert_true(fastest <= 1e-11 * c0 && off <= 1e-12);
    sph_sim_free(sim);
  }
}

/* ---- sound ---- */

enum { N = 40 };
typedef struct wave {
  double rho[N], v[N];
} wave;

/* A displaced 1D lattice, for a third of a period; continuity c1 starts from `start`, the sum. */
static wave sound(const wave *start, const char *method, int steps)
{
  const double end = 1 / (3 * c0);
  double xs[N];
  const double *const points[] = {xs};
  for (int i = 0; i < N; i++) xs[i] = (i + 0.5) / N + 0.01 * sin(2 * pi * (i + 0.5) / N);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                               .dx = 1.0 / N,
                                               .kernel = "quintic-spline",
                                               .h_over_dx = 1,
                                               .speed = 1,
                                               .periodic = {1},
                                               .length = {1}});
  sph_group *water = sph_group_create(sim, "water", "fluid");
  sph_group_add_points(water, N, points, rho0);
  sph_group_set_eos(water, sph_eos_linear(rho0, c0, -INFINITY));
  sph_sim_add_term(sim, start ? sph_term_continuity_form("c1") : sph_term_summation(0));
  sph_sim_add_term(sim, sph_term_pressure_form("s"));
  double *rho = sph_group_write(water, "density", 0);
  for (int i = 0; start && i < N; i++) rho[i] = start->rho[i];
  if (steps) {
    sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .dt_fixed = end / steps});
    if (sph_sim_run(sim, end) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  } else if (sph_sim_evaluate(sim) != SPH_OK)
    fail_msg("%s", sph_sim_error(sim));
  wave w;
  const double *r = sph_group_read(water, "density", 0), *v = sph_group_read(water, "velocity", 0);
  for (int i = 0; i < N; i++) w.rho[i] = r[i], w.v[i] = v[i];
  sph_sim_free(sim);
  return w;
}

/* Largest difference of both, over the swing. */
static double apart(const wave *start, const char *method, int steps)
{
  wave summed = sound(NULL, method, steps), integrated = sound(start, method, steps);
  double worst = 0, swing_rho = 0, swing_v = 0;
  for (int i = 0; i < N; i++) {
    swing_rho = fmax(swing_rho, fabs(summed.rho[i] - rho0));
    swing_v = fmax(swing_v, fabs(summed.v[i]));
  }
  assert_true(swing_v > 0.02 * c0 && swing_rho > 0.02 * rho0);
  for (int i = 0; i < N; i++) {
    worst = fmax(worst, fabs(summed.rho[i] - integrated.rho[i]) / swing_rho);
    worst = fmax(worst, fabs(summed.v[i] - integrated.v[i]) / swing_v);
  }
  return worst;
}

static void sound_wave(void **state)
{
  (void)state;
  static const struct {
    const char *method;
    double order, bar;
  } scheme[] = {{"leapfrog", 2, 0.01}, {"erk:bogacki-shampine-4-2-3", 3, 1e-5}};
  wave start = sound(NULL, NULL, 0);
  for (int m = 0; m < 2; m++) {
    double coarse = apart(&start, scheme[m].method, 50),
           fine = apart(&start, scheme[m].method, 100);
    print_message("# %s: summed and c1 differ by %.2g, %.2g with half the step, order %.2f\n",
                  scheme[m].method, coarse, fine, log2(coarse / fine));
    assert_true(coarse > 0 && coarse <= scheme[m].bar);
    assert_true(log2(coarse / fine) >= scheme[m].order - 0.2);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lattice),
      cmocka_unit_test(between_walls),
      cmocka_unit_test(stays_at_rest),
      cmocka_unit_test(sound_wave),
  };
  return cmocka_run_group_tests_name("summation", tests, NULL, NULL);
}
