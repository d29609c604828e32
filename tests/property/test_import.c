/* Particles of a file are the particles of the run that wrote it: the same balances and rates; and
 * what a file must not hold is told. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../folder.h"
#include "../near.h"
#include "sphode.h"

static char folder[FOLDER_MAX];

static const char *in(const char *name)
{
  static char path[2 * FOLDER_MAX];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void write_text(const char *name, const char *text)
{
  FILE *file = fopen(in(name), "w");
  if (!file || fputs(text, file) < 0 || fclose(file)) fail_msg("%s cannot be written", in(name));
}

/* An empty gas on an empty wall, its terms and an output. */
static sph_sim *empty(sph_group **gas, sph_group **wall)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  *gas = sph_group_create(sim, "gas", "fluid");
  *wall = sph_group_create(sim, "wall", "wall");
  sph_group_set_eos(*gas, sph_eos_ideal_gas(1.4));
  sph_group_set_boundary(*wall, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  return sim;
}

/* A drifting gas after some steps, its last snapshot exported: the state to find again. */
static sph_sim *original(void)
{
  sph_group *gas, *wall;
  sph_sim *sim = empty(&gas, &wall);
  sph_group_add_box(gas, (double[]){0, 0}, (double[]){1, 1}, 1);
  sph_group_jitter(gas, 0.2, 1);
  sph_group_add_box(wall, (double[]){0, -0.4}, (double[]){1, 0}, 1);
  double *u = sph_group_write(gas, "energy", 0), *v = sph_group_write(gas, "velocity", 1);
  for (long i = 0; i < sph_group_count(gas); i++) u[i] = 1 + 1e-3 * (double)i, v[i] = -0.2;
  sph_sim_add_output(sim, sph_output_hdf5(folder, INFINITY));
  sph_error error = {0};
  const sph_export_def csv = {.path = folder, .format = "csv", .directory = folder};
  const sph_export_def vtu = {.path = folder, .format = "vtu", .directory = folder};
  if (sph_sim_run(sim, 0.05) || sph_export(&csv, &error) < 0 || sph_export(&vtu, &error) < 0)
    fail_msg("%s%s", sph_sim_error(sim), error.text);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  return sim;
}

static void same(const sph_sim *a, const sph_sim *b, double tolerance)
{
  static const char *const fields[] = {"position", "velocity", "density", "energy"};
  const sph_group *x = sph_sim_group(a, "gas"), *y = sph_sim_group(b, "gas");
  assert_int_equal(sph_group_count(x), sph_group_count(y));
  for (int k = 0; k < 4; k++)
    for (int d = 0; d < (k < 2 ? 2 : 1); d++)
      for (long i = 0; i < sph_group_count(x); i++) {
        const double right = sph_group_read(x, fields[k], d)[i];
        const double rate = sph_group_rate(x, fields[k], d)[i];
        assert_near(sph_group_read(y, fields[k], d)[i], right, tolerance * (1 + fabs(right)));
        assert_near(sph_group_rate(y, fields[k], d)[i], rate, 1e3 * tolerance * (1 + fabs(rate)));
      }
  sph_balance p, q;
  sph_sim_balance(a, &p), sph_sim_balance(b, &q);
  assert_near(p.mass, q.mass, tolerance);
  assert_near(p.total, q.total, 10 * tolerance);
}

static void the_state_comes_back(void **state)
{
  (void)state;
  static const char *const files[][2] = {{"snapshot_0001.hdf", "snapshot_0001.hdf"},
                                         {"snapshot_0001.csv", "walls_0001.csv"}};
  sph_sim *right = original();
  for (int k = 0; k < 2; k++) {
    sph_group *gas, *wall;
    sph_sim *sim = empty(&gas, &wall);
    sph_import(sim, gas, &(sph_import_def){.path = in(files[k][0]), .rho0 = 1});
    sph_import(sim, wall, &(sph_import_def){.path = in(files[k][1]), .part = 1, .rho0 = 1});
    if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
    same(right, sim, 1e-14);
    sph_sim_free(sim);
  }
  sph_sim_free(right);
}

/* What `sphode export --vtu` writes comes in with the same bits. */
static void vtu_keeps_the_bits(void **state)
{
  (void)state;
  static const char *const fields[] = {"position", "velocity", "density", "energy", "mass"};
  sph_group *gas, *wall;
  sph_sim *right = original(), *sim = empty(&gas, &wall);
  sph_import(sim, gas, &(sph_import_def){.path = in("snapshot_0001.vtu"), .rho0 = 1});
  sph_import(sim, wall, &(sph_import_def){.path = in("walls_0001.vtu"), .rho0 = 1});
  const int built = sph_sim_status(sim) != SPH_ERR_UNBUILT;
  if (built && sph_sim_status(sim)) fail_msg("%s", sph_sim_error(sim));
  for (int k = 0; k < 5 && built; k++)
    for (int d = 0; d < (k < 2 ? 2 : 1); d++)
      assert_memory_equal(sph_group_read(gas, fields[k], d),
                          sph_group_read(sph_sim_group(right, "gas"), fields[k], d),
                          (size_t)sph_group_count(gas) * sizeof(double));
  assert_int_equal(sph_group_count(wall),
                   built ? sph_group_count(sph_sim_group(right, "wall")) : 0);
  sph_sim_free(sim);
  sph_sim_free(right);
}

/* By hand, in a case file; what `initial` says comes behind. */
static void table_by_hand(void **state)
{
  (void)state;
  static const char text[] =
      "dimension: 2\nspacing: 0.1 m\ngroups:\n  water: {kind: fluid, density: 1000 kg/m^3,\n"
      "    shapes: [box: {lower: [0 m, 0 m], upper: [0.1 m, 0.1 m]}, file: {path: points.csv}],\n  "
      "  eos: {linear: {sound_speed: 10 m/s}}}\n"
      "terms: {pressure: {}}\nrun: {end: 0.1 s}\n";
  sph_error error = {0};
  for (int quoted = 0; quoted < 2; quoted++) { /* as pandas and R do */
    write_text("points.csv",
               quoted ? "\"\",\"y [m]\",\"x [m]\",\"velocity_y [cm/ms]\",\"mass [kg/m]\"\n"
                        "\"1\",0.5,0.25,0.1,10\n\"2\",0.5,0.35,-0.3,20\n\"3\",0.7,0.4,0,5.5\n"
                      : "# made by hand\ny [m], x [m],velocity_y [m/s],mass [kg/m]\n"
                        "0.5,0.25,1,10\n0.5,0.35,-3,20\n0.7,0.4,0,5.5\n");
    sph_case *c = sph_case_read_text(in("case.yml"), text, sizeof text - 1, 0, NULL, &error);
    sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
    if (!sim) fail_msg("%s", error.text);
    const sph_group *water = sph_sim_group(sim, "water");
    assert_int_equal(sph_group_count(water), 4);
    assert_near(sph_group_read(water, "position", 0)[2], 0.35, 0);
    assert_near(sph_group_read(water, "position", 1)[3], 0.7, 0);
    assert_near(sph_group_read(water, "velocity", 1)[2], -3, 1e-15);
    assert_near(sph_group_read(water, "velocity", 0)[2], 0, 0);
    assert_near(sph_group_read(water, "mass", 0)[3], 5.5, 0);
    assert_near(sph_group_read(water, "density", 0)[1], 1000, 0);
    assert_near(sph_group_read(water, "mass", 0)[0], 10, 1e-12); /* of the box, as it was */
    sph_sim_free(sim);
    sph_case_free(c);
  }
}

static void refuse(const char *name, const char *text, const char *why)
{
  sph_group *gas, *wall;
  sph_sim *sim = empty(&gas, &wall);
  if (text) write_text(name, text);
  sph_import(sim, gas, &(sph_import_def){.path = in(name), .rho0 = 1});
  assert_true(sph_sim_status(sim) < 0);
  if (!strstr(sph_sim_error(sim), why)) fail_msg("\"%s\" not in: %s", why, sph_sim_error(sim));
  sph_sim_free(sim);
}

static void refused(void **state)
{
  (void)state;
  refuse("nothing.csv", NULL, "cannot read");
  refuse("nothing.hdf", NULL, "no such HDF5 file");
  refuse("a.txt", "1 2", "known are .csv, .hdf, .hdf5, .vtu, .vtp");
  refuse("a.hdf5", "not HDF5", "is no HDF5 file, or is cut short");
  refuse("a.csv", "x,z\n1,2\n", "no column \"y\"");
  refuse("a.csv", "x,y\n", "no particles");
  refuse("a.csv", "x,y,velocty_x\n1,2,3\n",
         "a.csv: column 3 is \"velocty_x\"; right are x, y, z, ");
  refuse("a.csv", "x,y, rho [kg/m^3]\n1,2,3\n", "column 3 is \"rho\"");
  refuse("a.csv", "x,y,\n1,2,\n", "column 3 is \"\"");
  refuse("a.csv", "x,y\n1,two\n", "a.csv:2: \"two\"");
  refuse("a.csv", "x,y\n1\n", "a.csv:2: ");
  refuse("a.csv", "x [s],y [mm]\n1,2\n", "position in s; right is m");
  refuse("a.csv", "x,y,mass\n1,2,3\n1,2,0\n", "mass of particle 1 is 0; right is finite and > 0");
  refuse("a.csv", "x,y,density\n1,2,nan\n", "density of particle 0 is nan");
  refuse("a.csv", "x,y,velocity_x\n1,2,inf\n", "velocity_x of particle 0 is inf");
  sph_import(NULL, NULL, NULL);
}

static int make(void **state)
{
  (void)state;
  return folder_make(folder, "import");
}

static int clean(void **state)
{
  (void)state;
  return folder_remove(folder);
}

/* In the order in which they were added, whatever group they went to; an array once asked for. */
static void particles_are_numbered(void **state)
{
  (void)state;
  const long of_a[] = {0, 2, 3, 4, 5}, of_b[] = {1, 6, 7};
  const double at[] = {0, 1, 2};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 1});
  sph_group *a = sph_group_create(sim, "a", "fluid"), *b = sph_group_create(sim, "b", "fluid");
  sph_group_add_points(a, 1, (const double *const[]){at}, 1);
  sph_group_add_points(b, 1, (const double *const[]){at}, 1);
  assert_int_equal(sph_group_id(b, 0), 1);
  assert_memory_equal(sph_group_ids(b), of_b, sizeof *of_b);
  sph_group_add_points(a, 3, (const double *const[]){at}, 1);
  assert_int_equal(sph_group_id(a, 1), 2);
  sph_group_add_points(a, 1, (const double *const[]){at}, 1);
  sph_group_add_points(b, 2, (const double *const[]){at}, 1);
  for (long i = 0; i < 5; i++) assert_int_equal(sph_group_id(a, i), of_a[i]);
  for (long i = 0; i < 3; i++) assert_int_equal(sph_group_id(b, i), of_b[i]);
  assert_memory_equal(sph_group_ids(a), of_a, sizeof of_a);
  assert_int_equal(sph_group_id(a, 5), -1);
  assert_int_equal(sph_group_id(a, -1), -1);
  assert_int_equal(sph_sim_status(sim), SPH_OK);
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(particles_are_numbered),
                                     cmocka_unit_test(the_state_comes_back),
                                     cmocka_unit_test(vtu_keeps_the_bits),
                                     cmocka_unit_test(table_by_hand), cmocka_unit_test(refused)};
  return cmocka_run_group_tests_name("import", tests, make, clean);
}
