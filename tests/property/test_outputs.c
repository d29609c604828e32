/* When frames are written, fields read and walls felt: what a program may do between runs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <unistd.h>

#include "csv.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode.h"
#include "table.h"

typedef struct record {
  int frames;
  double time[100];
} record;

static int note(void *ctx, struct sph_sim *sim, sph_error *error)
{
  record *r = ctx;
  (void)error;
  if (r->frames < 100) r->time[r->frames] = sph_sim_time(sim);
  r->frames++;
  return r->frames < 1000 ? SPH_OK : SPH_ERR_STATE; /* no test here has that many */
}

/* Water over a floor, at rest. */
static sph_sim *pool(void)
{
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 0}, .length = {1.2, 0}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1.2, 0.6}, 1000);
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_box(floor, (double[]){0, -0.3}, (double[]){1.2, 0}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 30, 7));
  sph_group_set_boundary(floor, sph_boundary_adami());
  sph_group_set_hydrostatic(water, 1, 0.6, 10);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[]){0, -10, 0}));
  return sim;
}

/* Frames stand at the exact times from the moment an output is first used; steps between runs write
 * none, and none is written twice. */
static void frames_between_runs(void **state)
{
  (void)state;
  record early = {0}, late = {0};
  sph_sim *sim = pool();
  sph_sim_add_output(sim, (sph_output){.interval = 0.02, .frame = note, .ctx = &early});
  assert_int_equal(sph_sim_run(sim, 0.05), SPH_OK);
  assert_int_equal(early.frames, 3); /* 0, 0.02, 0.04 */
  sph_sim_add_output(sim, (sph_output){.interval = 0.02, .frame = note, .ctx = &late});
  while (sph_sim_time(sim) < 0.085) assert_int_equal(sph_sim_step(sim), SPH_OK);
  double begin = sph_sim_time(sim);
  assert_int_equal(sph_sim_run(sim, 0.2), SPH_OK);
  assert_true(late.time[0] == begin);
  for (int k = 1; k < late.frames; k++) assert_true(fabs(late.time[k] - begin - 0.02 * k) < 1e-12);
  assert_true(early.time[3] > begin && early.time[3] < begin + 0.02);
  for (int k = 3; k < early.frames; k++)
    assert_true(fabs(early.time[k] / 0.02 - round(early.time[k] / 0.02)) < 1e-9);
  sph_sim_free(sim);
}

/* An infinite interval: frames at the start and at the end of each run. */
static void frames_at_the_ends(void **state)
{
  (void)state;
  record ends = {0};
  sph_sim *sim = pool();
  sph_sim_add_output(sim, (sph_output){.interval = INFINITY, .frame = note, .ctx = &ends});
  assert_int_equal(sph_sim_run(sim, 0.05), SPH_OK);
  assert_int_equal(sph_sim_run(sim, 0.08), SPH_OK);
  assert_int_equal(ends.frames, 3);
  assert_true(ends.time[0] == 0 && ends.time[1] == 0.05 && ends.time[2] == 0.08);
  sph_sim_free(sim);
}

/* Fields moved far by hand: what is read afterwards belongs to where they are. */
static void moved_by_hand(void **state)
{
  (void)state;
  sph_sim *sim = pool();
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  double *y = sph_group_write(sph_sim_group(sim, "water"), "position", 1);
  for (long i = 0; i < sph_group_count(sph_sim_group(sim, "water")); i++) y[i] += 5;
  sph_sim_changed(sim);
  const sph_group *floor = sph_sim_group(sim, "floor");
  const double *p = sph_group_read(floor, "pressure", 0);
  for (long i = 0; i < sph_group_count(floor); i++) assert_true(p[i] == 0);
  sph_sim_free(sim);
}

/* A gas at rest between walls feels no force, whatever density the walls were given first. */
static void gas_between_walls(void **state)
{
  (void)state;
  static const double density[] = {0.125, 1, 4};
  for (int k = 0; k < 3; k++) {
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.01});
    sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, density[k]);
    sph_group *walls = sph_group_walls(sim, "walls", (double[]){0}, (double[]){1}, 1);
    sph_group_set_eos(gas, sph_eos_ideal_gas(1.4));
    sph_group_set_boundary(walls, sph_boundary_adami());
    double *u = sph_group_write(gas, "energy", 0);
    for (long i = 0; u && i < sph_group_count(gas); i++) u[i] = 2.5 / density[k];
    sph_sim_add_term(sim, sph_term_continuity());
    sph_sim_add_term(sim, sph_term_pressure());
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    const double *a = sph_group_rate(gas, "velocity", 0);
    for (long i = 0; i < sph_group_count(gas); i++)
      assert_true(fabs(a[i]) < 1e-10 / (density[k] * 0.01)); /* p/(rho dx) is the scale */
    sph_sim_free(sim);
  }
}

/* Gas at speed v runs into a wall: the shock that comes back leaves rest behind it, at the density
 * of Rankine & Hugoniot, v = 2c/(gamma + 1) (M - 1/M); and the wall lets nothing through. */
static void gas_hits_a_wall(void **state)
{
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.005, .h_over_dx = 2});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, 1);
  sph_group *walls = sph_group_create(sim, "wall", "wall");
  sph_group_add_layers(walls, (double[]){0}, (double[]){1}, "x+", 1);
  sph_group_set_eos(gas, sph_eos_ideal_gas(1.4));
  sph_group_set_boundary(walls, sph_boundary_adami());
  double *u = sph_group_write(gas, "energy", 0), *v = sph_group_write(gas, "velocity", 0);
  for (long i = 0; u && i < sph_group_count(gas); i++) u[i] = 1, v[i] = -0.3;
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  assert_int_equal(sph_sim_run(sim, 0.2), SPH_OK);
  const double *x = sph_group_read(gas, "position", 0), *rho = sph_group_read(gas, "density", 0);
  for (long i = 0; i < sph_group_count(gas); i++) assert_true(x[i] > 0);
  double half = 0.3 * 2.4 / (4 * sqrt(1.4 * 0.4)), M = half + sqrt(half * half + 1), mean = 0;
  for (long i = 8; i < 18; i++) mean += rho[i] / 10; /* off the wall, behind the shock */
  assert_true(fabs(mean / (2.4 * M * M / (0.4 * M * M + 2)) - 1) < 0.02);
  sph_sim_free(sim);
}

/* A term that would do nothing is refused. */
static void silent_terms(void **state)
{
  (void)state;
  sph_sim *sim = pool();
  sph_sim_add_term(sim, sph_term_conductivity_artificial(1));
  assert_int_equal(sph_sim_evaluate(sim), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "conductivity-artificial"));
  sph_sim_free(sim);
}

static int ageing(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) s->ds[i] += 1;
  return SPH_OK;
}

static const char *at(const char *folder, const char *file)
{
  static char path[200];
  snprintf(path, sizeof path, "%s/%s", folder, file);
  return path;
}

static void near(double value, double right, double tolerance)
{
  assert_true(fabs(value - right) <= tolerance); /* NaN fails */
}

/* A gas that drifts through a periodic box: snapshots have it inside, at the places it has moved
 * to; and its scalar with its unit, in the snapshot and in the series. */
static void periodic_and_scalars(void **state)
{
  const double L = 1, dx = 0.05, v0 = 0.7;
  char folder[] = "/tmp/sphode-outputs-XXXXXX";
  (void)state;
  assert_non_null(mkdtemp(folder));
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 1, .dx = dx, .periodic = {1}, .origin = {-0.3}, .length = {L}});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){-0.3}, (double[]){L - 0.3}, 1);
  sph_group_set_eos(gas, sph_eos_linear(1, 10, -INFINITY));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, (sph_term){.name = "age",
                                   .body = ageing,
                                   .scalar = {.name = "age", .unit = "s", .scale = 1}});
  double *v = sph_group_write(gas, "velocity", 0);
  for (long i = 0; v && i < 20; i++) v[i] = v0;
  sph_sim_add_output(sim, sph_output_hdf5(folder, 3));
  sph_sim_add_output(sim, sph_output_series(folder, 3, NULL, 0));
  assert_int_equal(sph_sim_run(sim, 3), SPH_OK);
  sph_snapshot s;
  sph_error error = {0};
  assert_int_equal(sph_snapshot_read(at(folder, "snapshot_0001.hdf"), "age", &s, &error), SPH_OK);
  assert_string_equal(s.unit, "s");
  for (long i = 0; i < 20; i++) {
    double x = -0.3 + dx * ((double)i + 0.5) + 3 * v0;
    assert_true(s.x[SPH_FLUIDS][3 * i] >= -0.3 && s.x[SPH_FLUIDS][3 * i] < L - 0.3);
    near(s.x[SPH_FLUIDS][3 * i], x - L * floor((x + 0.3) / L), 1e-9);
    near(s.value[SPH_FLUIDS][i], 3, 1e-9);
    near(sph_group_read(gas, "position", 0)[i], x, 1e-9);
  }
  sph_snapshot_read_free(&s);
  sph_sim_free(sim);
  double *mean = NULL;
  long n = 0;
  char title[128];
  assert_int_equal(sph_csv_read(at(folder, "series.csv"), "age_mean", 0, &mean, &n, title, &error),
                   SPH_OK);
  assert_int_equal(n, 2);
  near(mean[1], 3, 1e-9);
  sph_memory_free(mean);
  static const char *const files[] = {"snapshot_0000.hdf", "snapshot_0001.hdf",
                                      "snapshot.hdf.series", "series.csv"};
  for (int k = 0; k < 4; k++) assert_int_equal(unlink(at(folder, files[k])), 0);
  assert_int_equal(rmdir(folder), 0);
}

/* What a snapshot of the pool with these fields holds, of its fluids or walls: "position ...". */
static void holds(const char *folder, const char *fields, int part, char *found, size_t size)
{
  sph_table table;
  sph_error error = {0};
  sph_sim *sim = pool();
  size_t length = 0;
  sph_sim_add_output(sim, sph_output_hdf5_def(&(sph_hdf5_def){.directory = folder,
                                                              .interval = INFINITY,
                                                              .fields = fields}));
  assert_int_equal(sph_sim_run(sim, 1e-3), SPH_OK);
  sph_sim_free(sim);
  assert_int_equal(sph_table_read(&table, at(folder, "snapshot_0000.hdf"), part, NULL, &error), 0);
  for (int k = 0; k < table.fields; k++)
    length +=
        (size_t)snprintf(found + length, size - length, "%s%s", k ? " " : "", table.field[k].name);
  sph_table_free(&table);
}

/* Those that are asked for and those that every reader needs; all others are not there. */
static void chosen_fields(void **state)
{
  char folder[] = "/tmp/sphode-outputs-XXXXXX", found[400];
  (void)state;
  assert_non_null(mkdtemp(folder));
  holds(folder, "velocity, pressure", SPH_FLUIDS, found, sizeof found);
  assert_string_equal(found, "position velocity density group id mass pressure smoothing_length");
  holds(folder, "pressure", SPH_FLUIDS, found, sizeof found);
  assert_string_equal(found, "position density group id mass pressure smoothing_length");
  assert_string_equal(sph_snapshot_read_default(at(folder, "snapshot_0000.hdf")), "density");
  holds(folder, "", SPH_WALLS, found, sizeof found);
  assert_string_equal(found, "position density group id mass smoothing_length");
  holds(folder, NULL, SPH_FLUIDS, found, sizeof found);
  assert_string_equal(
      found,
      "position velocity density energy group id mass pressure smoothing_length sound_speed");
  assert_string_equal(sph_snapshot_read_default(at(folder, "snapshot_0000.hdf")), "velocity");
  sph_sim *sim = pool();
  sph_error error = {0};
  const sph_hdf5_def few = {.directory = folder, .fields = "velocity"},
                     wrong = {.fields = "velocty"};
  assert_int_equal(sph_sim_run(sim, 1e-3), SPH_OK);
  assert_true(sph_output_hdf5_size(sim, &few, &error) < sph_output_hdf5_size(sim, NULL, &error));
  assert_int_equal(sph_output_hdf5_size(sim, &wrong, &error), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "no group has a field \"velocty\"; did you mean 'velocity'?"));
  sph_sim_add_output(sim, sph_output_hdf5_def(&wrong));
  assert_int_equal(sph_sim_run(sim, 2e-3), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "there are: position, velocity"));
  sph_sim_free(sim);
  static const char *const files[] = {"snapshot_0000.hdf",   "snapshot_0001.hdf",
                                      "snapshot.hdf.series", "walls_0000.hdf",
                                      "walls_0001.hdf",      "walls.hdf.series"};
  for (int k = 0; k < 6; k++) assert_int_equal(unlink(at(folder, files[k])), 0);
  assert_int_equal(rmdir(folder), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_between_runs),  cmocka_unit_test(frames_at_the_ends),
      cmocka_unit_test(moved_by_hand),        cmocka_unit_test(gas_between_walls),
      cmocka_unit_test(gas_hits_a_wall),      cmocka_unit_test(silent_terms),
      cmocka_unit_test(periodic_and_scalars), cmocka_unit_test(chosen_fields)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
