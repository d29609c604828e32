/* Every allocation of the outputs fails once: the failure is told, nothing is left half written,
 * nothing leaks (under ASan or valgrind). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "failing.h"
#include "sphode.h"

static char directory[200];
static sph_sim *sim;

static sph_sim *pool(void)
{
  sph_sim *made = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_box(made, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group *walls = sph_group_walls(made, "tank", (double[]){0, 0}, (double[]){2, 1}, 1000);
  sph_group_set_boundary(walls, sph_boundary_adami());
  sph_group_set_eos(water, sph_eos_linear(1000, 100, -INFINITY));
  sph_sim_add_term(made, sph_term_pressure());
  return made;
}

static int run(sph_output output, sph_error *error)
{
  int status = output.open(output.ctx, sim, error);
  for (int k = 0; status == SPH_OK && k < 2; k++) status = output.frame(output.ctx, sim, error);
  if (output.close) output.close(output.ctx, sim, error);
  output.free(output.ctx);
  return status;
}

static int snapshots(sph_error *error)
{
  return run(sph_output_hdf5_def(&(sph_hdf5_def){.directory = directory,
                                                 .interval = 1,
                                                 .case_text = "a: 1\n",
                                                 .command = "sphode run"}),
             error);
}

static int series(sph_error *error)
{
  static const sph_monitor monitors[] = {{.name = "f", .type = "front", .group = "water"},
                                         {.name = "p", .type = "pressure"}};
  return run(sph_output_series(directory, 1, monitors, 2), error);
}

static int events(sph_error *error)
{
  sph_output output = sph_output_events(directory);
  const sph_event_record record = {.name = "wet", .t = 1};
  int status = output.open(output.ctx, sim, error);
  for (int k = 0; status == SPH_OK && k < 2; k++)
    status = output.event(output.ctx, sim, &record, error);
  output.close(output.ctx, sim, error);
  output.free(output.ctx);
  return status;
}

/* Of a simulation of its own, which a failure sticks to. */
static int measured(sph_output (*make)(void), sph_error *error)
{
  sph_sim *kept = sim;
  const long at = fail_at;
  fail_at = 0;
  sim = pool();
  sph_sim_evaluate(sim);
  fail_at = at, calls = 0;
  int status = run(make(), error);
  fail_at = 0;
  sph_sim_free(sim);
  fail_at = at;
  sim = kept;
  return status;
}

static sph_output make_forces(void)
{
  static const sph_series_force force = {"tank", {0}};
  return sph_output_series_def(&(sph_series_def){
      .directory = directory, .interval = 1, .forces = 1, .force = &force, .powers = 1});
}

static int forces(sph_error *error) { return measured(make_forces, error); }

static int probe(sph_error *error)
{
  return run(sph_output_probe(&(sph_probe_def){
                 .directory = directory, .name = "p", .group = "water", .along = {1, 1}, .n = {4}}),
             error);
}

/* The snapshots that are there by then. */
static int exported(const char *format, sph_error *error)
{
  int count = sph_export(&(sph_export_def){.path = directory,
                                           .format = format,
                                           .directory = directory,
                                           .fields = "velocity density"},
                         error);
  return count < 0 ? count : SPH_OK;
}

static int csv(sph_error *error) { return exported("csv", error); }

static int vtu(sph_error *error) { return exported("vtu", error); }

static int gadget(sph_error *error) { return exported("gadget", error); }

/* Into a simulation of its own. */
static int imported(const char *name, sph_error *error)
{
  char path[240];
  const long at = fail_at;
  fail_at = 0;
  sph_sim *own = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *group = sph_group_create(own, "water", "fluid");
  snprintf(path, sizeof path, "%s/%s", directory, name);
  fail_at = at, calls = 0;
  sph_import(own, group, &(sph_import_def){.path = path, .rho0 = 1000});
  fail_at = 0;
  const int status = sph_sim_status(own);
  if (status) sph_error_set(error, status, "%s", sph_sim_error(own));
  sph_sim_free(own);
  fail_at = at;
  return status;
}

static int import_csv(sph_error *error) { return imported("snapshot_0000.csv", error); }

static int import_hdf5(sph_error *error) { return imported("snapshot_0000.hdf", error); }

static int summary(sph_error *error)
{
  static const sph_comparison comparison = {.name = "x", .value = 1, .bar = 2, .pass = 1};
  return sph_summary_write(directory, sim, NULL, &comparison, 1, error);
}

/* There is no gnuplot on this PATH: all but its own work is done. */
static int pictures(sph_error *error)
{
  char png[220];
  snprintf(png, sizeof png, "%s/a.png", directory);
  return sph_plot_frames(directory, "pressure", 2, png, error);
}

static int curves(sph_error *error)
{
  char png[220], csv[220];
  snprintf(png, sizeof png, "%s/b.png", directory);
  snprintf(csv, sizeof csv, "%s/series.csv", directory);
  return sph_plot_series(&(sph_plot_curve){.csv = csv, .y = "total"}, 1, NULL, png, error);
}

static void each_allocation_fails(int (*what)(sph_error *error), int right)
{
  for (fail_at = 1; fail_at < 1000; fail_at++) {
    sph_error error = {0};
    calls = 0;
    int status = what(&error);
    if (calls < fail_at) {
      assert_int_equal(status, right);
      break;
    }
    assert_int_equal(status, SPH_ERR_MEMORY);
    assert_int_equal(error.status, SPH_ERR_MEMORY);
    assert_true(strlen(error.text) > 5);
  }
  assert_in_range(fail_at, 2, 999);
  fail_at = 0;
}

static void all(void **state)
{
  (void)state;
  each_allocation_fails(snapshots, SPH_OK);
  each_allocation_fails(csv, SPH_OK);
  each_allocation_fails(vtu, SPH_OK);
  each_allocation_fails(import_csv, SPH_OK);
  each_allocation_fails(import_hdf5, SPH_OK);
  each_allocation_fails(gadget, SPH_OK);
  each_allocation_fails(series, SPH_OK);
  each_allocation_fails(forces, SPH_OK);
  each_allocation_fails(probe, SPH_OK);
  each_allocation_fails(events, SPH_OK);
  each_allocation_fails(summary, SPH_OK);
  each_allocation_fails(pictures, SPH_ERR_UNBUILT);
  each_allocation_fails(curves, SPH_ERR_UNBUILT);
}

static int set_up(void **state)
{
  (void)state;
  const char *temporary = getenv("TMPDIR");
  snprintf(directory, sizeof directory, "%s/sphode_io_XXXXXX", temporary ? temporary : "/tmp");
  if (!mkdtemp(directory)) return -1;
  setenv("PATH", directory, 1);
  sim = pool();
  if (sph_sim_evaluate(sim) == SPH_OK) return 0;
  print_error("%s\n", sph_sim_error(sim));
  return -1;
}

static int tear_down(void **state)
{
  static const char *const left[] = {"snapshot_0000.hdf",
                                     "snapshot_0001.hdf",
                                     "walls_0000.hdf",
                                     "walls_0001.hdf",
                                     "snapshot.hdf.series",
                                     "walls.hdf.series",
                                     "series.csv",
                                     "events.csv",
                                     "probe_p.csv",
                                     "snapshot_0000.csv",
                                     "snapshot_0001.csv",
                                     "walls_0000.csv",
                                     "walls_0001.csv",
                                     "times.csv",
                                     "snapshot_0000.vtu",
                                     "snapshot_0001.vtu",
                                     "walls_0000.vtu",
                                     "walls_0001.vtu",
                                     "snapshot.pvd",
                                     "walls.pvd",
                                     "snapshot_0000.hdf5",
                                     "snapshot_0001.hdf5",
                                     "summary.json",
                                     "summary.txt",
                                     "a.gp",
                                     "a.dat",
                                     "b.gp",
                                     "b.dat"};
  char path[400];
  (void)state;
  sph_sim_free(sim);
  for (size_t k = 0; k < sizeof left / sizeof *left; k++) {
    snprintf(path, sizeof path, "%s/%s", directory, left[k]);
    unlink(path);
  }
  return rmdir(directory); /* fails if anything else was left */
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(all)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
