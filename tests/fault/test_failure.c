/* A run that blows up ends soon, with the particle that did it, what acts on it, the last good
 * state in its outputs and the neighbourhood in a table; nothing that is not finite is written. */
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

enum { ID = 37 };
static const double dx = 0.1, c0 = 20;

/* What pushes particle ID. */
typedef struct push {
  double from;  /* [s] */
  double force; /* [m/s^2], grows with (t - from)/from */
} push;

static int pushed(const sph_term *term, const sph_particles *p)
{
  const push *it = term->ctx;
  if (p->t >= it->from && p->n > ID) p->a[0][ID] += it->force * (p->t - it->from) / it->from;
  return 0;
}

static sph_sim *make(const char *method, push *it, const char *directory)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, c0, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, (sph_term){.name = "push", .body = pushed, .ctx = it});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method});
  sph_sim_add_output(sim, sph_output_hdf5(directory, INFINITY));
  sph_sim_add_output(sim, sph_output_series_def(
                              &(sph_series_def){.directory = directory, .interval = INFINITY}));
  return sim;
}

static char *read_all(const char *directory, const char *name)
{
  static char text[200000];
  char path[FOLDER_MAX + 64];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  return text;
}

static void assert_told(const sph_sim *sim, const char *word)
{
  if (!strstr(sph_sim_error(sim), word)) fail_msg("\"%s\" lacks \"%s\"", sph_sim_error(sim), word);
}

/* Forces that grow without end, or are no numbers from some moment on. */
static void blown_up(const char *method, double force, const char *why)
{
  char directory[FOLDER_MAX], path[FOLDER_MAX + 64];
  push it = {.from = 0.01, .force = force};
  sph_error error = {0};
  sph_sim_stats stats;
  assert_int_equal(folder_make(directory, "failure"), 0);
  snprintf(path, sizeof path, "%s/failure.csv", directory);
  sph_sim *sim = make(method, &it, directory);
  assert_int_equal(sph_failure_write(sim, path, &error), SPH_ERR_STATE);
  error = (sph_error){0};
  assert_int_equal(sph_sim_run(sim, 1e6), SPH_ERR_STEP);
  assert_told(sim, why);
  assert_told(sim, "particle 37 of water (id 37) is at (");
  assert_told(sim, "What helps: ");
  sph_sim_get_stats(sim, &stats);
  assert_true(stats.step.steps < 3000);
  const sph_group *water = sph_sim_group(sim, "water");
  for (long i = 0; i < sph_group_count(water); i++)
    assert_true(isfinite(sph_group_read(water, "position", 0)[i]) &&
                isfinite(sph_group_read(water, "density", 0)[i]));

  assert_int_equal(sph_failure_write(sim, path, &error), SPH_OK);
  const char *table = read_all(directory, "failure.csv");
  assert_non_null(strstr(table, "group,id,distance [m],x [m],y [m],velocity_x [m/s]"));
  assert_non_null(strstr(table, "pressure_x [m/s^2],pressure_y [m/s^2],push_x [m/s^2]"));
  for (int k = 0; k < 3; k++) /* nothing that is always zero */
    assert_null(strstr(table, ((const char *[]){"energy", "continuity", "delta"})[k]));
  assert_non_null(strstr(table, "\nwater,37,0,"));
  assert_null(strstr(table, "nan"));
  assert_null(strstr(table, "inf"));
  assert_null(strstr(read_all(directory, "series.csv"), "nan"));
  char *series = read_all(directory, "snapshot.hdf.series");
  assert_non_null(strstr(series, "snapshot_0001.hdf")); /* the last good state */
  sph_sim_free(sim);
  assert_int_equal(folder_remove(directory), 0);
}

static void forces_without_end(void **state)
{
  (void)state;
  blown_up("leapfrog", 1e12, "the run has blown up");
  blown_up("erk:bogacki-shampine-4-2-3", 1e12, "the run has blown up");
}

static void rates_that_are_no_numbers(void **state)
{
  (void)state;
  blown_up("leapfrog", NAN, "rates of 1 particles are not finite, 37 of water first");
  blown_up("erk:bogacki-shampine-4-2-3", NAN,
           "rates of 1 particles are not finite, 37 of water first");
}

/* Two drops that meet at the speed of sound, and tiny steps at the start, are no reason to stop. */
static void what_may_go_on(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    char directory[FOLDER_MAX];
    push none = {.from = INFINITY};
    assert_int_equal(folder_make(directory, "failure"), 0);
    sph_sim *sim = make("erk:bogacki-shampine-4-2-3", &none, directory);
    sph_group *drop = sph_group_box(sim, "drop", (double[]){0, 1}, (double[]){1, 1.5}, 1000);
    sph_group_set_eos(drop, sph_eos_tait(1000, c0, 7));
    for (long i = 0; i < sph_group_count(drop); i++) sph_group_write(drop, "velocity", 1)[i] = -c0;
    if (k) sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-11});
    if (sph_sim_run(sim, k ? 1e-4 : 0.05)) fail_msg("%s", sph_sim_error(sim));
    if (k) {
      sph_sim_stats stats;
      sph_sim_get_stats(sim, &stats);
      assert_true(stats.step.dt_smallest < 1e-6); /* of a limit of 3 ms */
    }
    sph_sim_free(sim);
    assert_int_equal(folder_remove(directory), 0);
  }
}

static void nothing_is_told(void **state)
{
  (void)state;
  sph_error error = {0};
  assert_int_equal(sph_failure_write(NULL, "x", &error), SPH_ERR_ARGUMENT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_without_end),
      cmocka_unit_test(rates_that_are_no_numbers),
      cmocka_unit_test(what_may_go_on),
      cmocka_unit_test(nothing_is_told),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
