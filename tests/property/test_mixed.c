/* Mixed precision (sim_single.c): far from the origin as near it, over a whole run, across a
 * restart; and what is refused.  Rates against the brute force: test_rhs.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "folder.h"
#include "sphode.h"

static const double dx = 0.02, c0 = 20;

/* A breaking column of water in a tank whose corner is at `at`; terms, groups and integrator go on
 * to be added to.  NULL where this processor or build has no mixed precision. */
static sph_sim *column(const char *precision, double at)
{
  const double lo[3] = {at, at}, water[3] = {at + 0.4, at + 0.4}, tank[3] = {at + 0.8, at + 0.8};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .precision = precision});
  if (strstr(sph_sim_error(sim), "AVX2")) {
    print_message("# %s\n", sph_sim_error(sim));
    sph_sim_free(sim);
    return NULL;
  }
  sph_group *fluid = sph_group_box(sim, "water", lo, water, 1000);
  sph_group *wall = sph_group_create(sim, "tank", "wall");
  sph_group_add_layers(wall, lo, tank, "y+", 1000);
  sph_group_set_eos(fluid, sph_eos_tait(1000, c0, 7));
  sph_group_set_boundary(wall, sph_boundary_adami());
  sph_group_jitter(fluid, 0.1, 3);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[]){0, -9.81, 0}));
  return sim;
}

/* The largest difference of accelerations over their rms; both evaluated. */
static double difference(sph_sim *a, sph_sim *b)
{
  double squares = 0, largest = 0;
  const long n = sph_group_count(sph_sim_group(a, "water"));
  for (int d = 0; d < 2; d++) {
    const double *x = sph_group_rate(sph_sim_group(a, "water"), "velocity", d);
    const double *y = sph_group_rate(sph_sim_group(b, "water"), "velocity", d);
    for (long i = 0; i < n; i++) {
      squares += y[i] * y[i];
      largest = fmax(largest, fabs(x[i] - y[i]));
    }
  }
  return largest / sqrt(squares / (double)n);
}

static void far_away(void **state)
{
  (void)state;
  const double at[] = {0, 1e3, 1e5}; /* the last: 5e6 dx, where floats are 0.4 dx apart */
  for (int k = 0; k < 3; k++) {
    sph_sim *mixed = column("mixed", at[k]), *usual = mixed ? column(NULL, at[k]) : NULL;
    if (!mixed) return;
    assert_int_equal(sph_sim_evaluate(mixed), SPH_OK);
    assert_int_equal(sph_sim_evaluate(usual), SPH_OK);
    assert_non_null(strstr(sph_sim_isa(mixed), "mixed"));
    const double off = difference(mixed, usual);
    print_message("# at %g m: %.2g of the rms acceleration\n", at[k], off);
    assert_true(off > 0 && off < 5e-6);
    sph_sim_free(mixed);
    sph_sim_free(usual);
  }
}

/* Front and energy of the collapse, which is not chaotic yet. */
static void whole_run(void **state)
{
  (void)state;
  double front[2] = {0}, kinetic[2] = {0};
  for (int k = 0; k < 2; k++) {
    sph_sim *sim = column(k ? "mixed" : "double", 0);
    if (!sim) return;
    sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
    assert_int_equal(sph_sim_run(sim, 0.15), SPH_OK);
    const double *x = sph_group_read(sph_sim_group(sim, "water"), "position", 0);
    for (long i = 0; i < sph_group_count(sph_sim_group(sim, "water")); i++)
      front[k] = fmax(front[k], x[i]);
    sph_balance balance;
    sph_sim_balance(sim, &balance);
    kinetic[k] = balance.kinetic;
    sph_sim_free(sim);
  }
  print_message("# front %.9g, %.9g m; kinetic energy %.9g, %.9g\n", front[0], front[1], kinetic[0],
                kinetic[1]);
  assert_true(front[0] > 0.5);
  assert_true(fabs(front[1] - front[0]) < 1e-3 * dx);
  assert_true(fabs(kinetic[1] / kinetic[0] - 1) < 1e-5);
}

static sph_sim *checked(const char *folder)
{
  sph_sim *sim = column("mixed", 0);
  if (!sim) return NULL;
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "erk:bogacki-shampine-4-2-3"});
  sph_checkpoint_set(sim, &(sph_checkpoint_def){.directory = folder, .steps = 20, .keep = 100});
  return sim;
}

static void restart(void **state)
{
  (void)state;
  char folder[FOLDER_MAX], path[FOLDER_MAX + 60];
  assert_int_equal(folder_make(folder, "mixed"), 0);
  sph_sim *whole = checked(folder), *second = whole ? checked(folder) : NULL;
  if (whole) {
    assert_int_equal(sph_sim_run(whole, 0.05), SPH_OK);
    snprintf(path, sizeof path, "%s/checkpoint_00000020.hdf", folder);
    assert_int_equal(sph_checkpoint_read(second, path), SPH_OK);
    assert_int_equal(sph_sim_run(second, 0.05), SPH_OK);
    for (int d = 0; d < 2; d++) {
      const double *a = sph_group_read(sph_sim_group(whole, "water"), "position", d);
      const double *b = sph_group_read(sph_sim_group(second, "water"), "position", d);
      for (long i = 0; i < sph_group_count(sph_sim_group(whole, "water")); i++)
        assert_true(a[i] == b[i]);
    }
  }
  sph_sim_free(whole);
  sph_sim_free(second);
  folder_remove(folder);
}

/* ---- what is refused ---- */

static void smoothed(sph_sim *s) { sph_sim_add_term(s, sph_term_xsph(0.5)); }
static void laminar(sph_sim *s) { sph_sim_add_term(s, sph_term_viscosity_laminar("morris")); }
static void tight(sph_sim *s)
{
  sph_sim_set_integrator(s, &(sph_integrator_def){.method = "erk:bogacki-shampine-4-2-3",
                                                  .tolerance = 1e-7});
}
static void resets(sph_sim *s) { sph_sim_reset_density(s, "shepard", 10); }
static void stray(sph_sim *s)
{
  double *x = sph_group_write(sph_sim_group(s, "water"), "position", 0);
  if (x) x[0] = 1e6;
}

static void refused(void **state)
{
  (void)state;
  static const struct {
    void (*change)(sph_sim *sim);
    const char *words;
  } cases[] = {{smoothed, "xsph"},
               {laminar, "viscosity-laminar"},
               {tight, "tolerance = 1e-07"},
               {resets, "density resets"},
               {stray, "m apart"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    sph_sim *sim = column("mixed", 0);
    if (!sim) return;
    sph_group_set_viscosity(sph_sim_group(sim, "water"), 1e-3);
    cases[k].change(sim);
    assert_int_not_equal(sph_sim_run(sim, 0.01), SPH_OK);
    print_message("# %s\n", sph_sim_error(sim));
    assert_non_null(strstr(sph_sim_error(sim), "precision mixed: "));
    assert_non_null(strstr(sph_sim_error(sim), cases[k].words));
    sph_sim_free(sim);
  }
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .precision = "half"});
  assert_non_null(strstr(sph_sim_error(sim), "known: double, mixed"));
  sph_sim_free(sim);
  sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .precision = "mixed", .isa = "reference"});
  assert_non_null(strstr(sph_sim_error(sim), "AVX2"));
  sph_sim_free(sim);
}

static void no_derivatives(void **state)
{
  (void)state;
  sph_sim *sim = column("mixed", 0);
  if (!sim) return;
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  sph_jacobian *jacobian = sph_jacobian_create(sim, NULL);
  if (jacobian) sph_jacobian_evaluate(jacobian);
  assert_non_null(strstr(sph_sim_error(sim), "derivatives"));
  sph_jacobian_free(jacobian);
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(far_away), cmocka_unit_test(whole_run),
                                     cmocka_unit_test(restart), cmocka_unit_test(refused),
                                     cmocka_unit_test(no_derivatives)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests_name("mixed precision", tests, NULL, NULL);
}
