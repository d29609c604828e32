/* What is exported is what the snapshot holds: CSV and GADGET's layout read back by other code of
 * the library, VTK's XML by its own rules.  The tools' own readers: test_readers.sh. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <sys/stat.h>

#include "../folder.h"
#include "../near.h"
#include "csv.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode.h"

static char run[FOLDER_MAX], to[FOLDER_MAX];
static const long N = 200; /* of water; its walls: 10 x 3 */

static const char *in(const char *folder, const char *name)
{
  static char path[4][2 * FOLDER_MAX];
  static int turn;
  turn = (turn + 1) % 4;
  snprintf(path[turn], sizeof path[0], "%s/%s", folder, name);
  return path[turn];
}

static double noise(unsigned long *state)
{
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-53 - 0.5;
}

static int fade(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) s->ds[i] -= s->s[i] * s->x[0][i];
  return SPH_OK;
}

/* Two snapshots of 2D water with random velocities and a scalar, over a floor. */
static int make_run(void **state)
{
  (void)state;
  if (folder_make(run, "run") || folder_make(to, "export")) return -1;
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 0}, .length = {1, 0}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 2}, 1000);
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_box(floor, (double[]){0, -0.3}, (double[]){1, 0}, 1000);
  sph_group_set_boundary(floor, sph_boundary_adami());
  sph_group_set_eos(water, sph_eos_tait(1000, 30, 7));
  sph_group_jitter(water, 0.2, 1);
  unsigned long seed = 1;
  for (int d = 0; d < 2; d++)
    for (long i = 0; i < N; i++) sph_group_write(water, "velocity", d)[i] = noise(&seed) * 1e-3;
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, (sph_term){.name = "dye",
                                   .body = fade,
                                   .scalar = {"dye", "kg & <m>", 1, 0.25, 0}});
  sph_sim_add_output(sim, sph_output_hdf5(run, 1e-3));
  int status = sph_sim_run(sim, 1e-3);
  if (status) print_error("%s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return status;
}

static int clean(void **state)
{
  (void)state;
  return folder_remove(run) | folder_remove(to);
}

static int export(const char *format, const char *fields, int single)
{
  sph_error error = {0};
  int count = sph_export(&(sph_export_def){.path = run,
                                           .format = format,
                                           .directory = to,
                                           .fields = fields,
                                           .single = single},
                         &error);
  if (count < 0) fail_msg("%s", error.text);
  return count;
}

static sph_snapshot snapshot(const char *path, const char *field)
{
  sph_error error = {0};
  sph_snapshot s;
  if (sph_snapshot_read(path, field, &s, &error)) fail_msg("%s", error.text);
  return s;
}

/* The column of a CSV beside the field of the snapshot, fluids and walls. */
static void compare_column(const char *field, double tolerance)
{
  sph_snapshot s = snapshot(in(run, "snapshot_0001.hdf"), field);
  static const char *const names[] = {"snapshot_0001.csv", "walls_0001.csv"};
  for (int part = 0; part < SPH_PARTS; part++) {
    char title[128];
    sph_error error = {0};
    double *value = NULL;
    long n = 0;
    int status = sph_csv_read(in(to, names[part]), field, 0, &value, &n, title, &error);
    if (!s.value[part]) {
      assert_true(status < 0); /* walls have no dye */
      continue;
    }
    if (status) fail_msg("%s", error.text);
    assert_int_equal(n, part ? 30 : N);
    assert_int_equal(s.n[part], n);
    for (long i = 0; i < n; i++)
      assert_near(value[i], s.value[part][i], tolerance * fabs(s.value[part][i]));
    assert_non_null(strstr(title, s.unit));
    sph_memory_free(value);
  }
  sph_snapshot_read_free(&s);
}

static void csv_is_the_snapshot(void **state)
{
  (void)state;
  static const char *const fields[] = {"velocity_x", "velocity_y", "density",
                                       "pressure",   "mass",       "dye"};
  double *t, *x;
  char title[128];
  long n;
  sph_error error = {0};
  assert_int_equal(export("csv", NULL, 0), 2);
  for (int k = 0; k < 6; k++) compare_column(fields[k], 1e-14);
  sph_snapshot s = snapshot(in(run, "snapshot_0001.hdf"), "mass");
  if (sph_csv_read(in(to, "snapshot_0001.csv"), "y", 0, &x, &n, title, &error))
    fail_msg("%s", error.text);
  for (long i = 0; i < n; i++) assert_near(x[i], s.x[0][3 * i + 1], 1e-14);
  sph_memory_free(x);
  sph_snapshot_read_free(&s);
  assert_true(sph_csv_read(in(to, "snapshot_0001.csv"), "z", 0, &x, &n, title, &error) < 0);
  if (sph_csv_read(in(to, "times.csv"), "time", 0, &t, &n, title, &(sph_error){0}))
    fail_msg("times.csv");
  assert_int_equal(n, 4);
  assert_near(t[0], 0, 0);
  assert_near(t[3], 1e-3, 1e-15);
  sph_memory_free(t);
  export("csv", "velocity", 1);
  compare_column("velocity_x", 1e-7);
  assert_true(sph_csv_read(in(to, "snapshot_0001.csv"), "mass", 0, &x, &n, title, &error) < 0);
}

static void gadget_is_the_snapshot(void **state)
{
  (void)state;
  static const char *const fields[] = {"velocity_x", "density", "mass", "dye"};
  struct stat whole, half;
  for (int single = 0; single < 2; single++) {
    assert_int_equal(export("gadget", single ? "velocity density mass dye" : NULL, single), 2);
    for (int k = 0; k < 4; k++) {
      sph_snapshot a = snapshot(in(run, "snapshot_0001.hdf"), fields[k]);
      sph_snapshot b = snapshot(in(to, "snapshot_0001.hdf5"), fields[k]);
      assert_near(a.time, b.time, 0);
      assert_string_equal(a.unit, b.unit);
      for (int part = 0; part < SPH_PARTS; part++) {
        assert_int_equal(a.n[part], b.n[part]);
        assert_int_equal(a.value[part] != NULL, b.value[part] != NULL);
        for (long i = 0; a.value[part] && i < a.n[part]; i++) {
          const double x = a.value[part][i];
          assert_near(b.value[part][i], single ? (float)x : x, 0);
        }
      }
      sph_snapshot_read_free(&a), sph_snapshot_read_free(&b);
    }
    assert_int_equal(stat(in(to, "snapshot_0001.hdf5"), single ? &half : &whole), 0);
  }
  assert_true(half.st_size < whole.st_size);
}

/* The bytes behind the declaration of an array; its length must be that of n numbers. */
static const void *array(const char *file, size_t size, const char *declared, size_t bytes)
{
  const char *at = strstr(file, declared), *data = strstr(file, "encoding=\"raw\">\n_");
  if (!at || !data) fail_msg("no %s", declared);
  const size_t offset = strtoul(strstr(at, "offset=\"") + 8, NULL, 10);
  data += strlen("encoding=\"raw\">\n_") + offset;
  uint64_t length;
  memcpy(&length, data, sizeof length);
  assert_int_equal(length, bytes);
  assert_true((size_t)(data - file) + 8 + bytes <= size);
  return data + 8;
}

static void vtu_is_the_snapshot(void **state)
{
  (void)state;
  static char file[1 << 20];
  for (int single = 0; single < 2; single++) {
    assert_int_equal(export("vtu", NULL, single), 2);
    FILE *from = fopen(in(to, "snapshot_0001.vtu"), "rb");
    assert_non_null(from);
    const size_t size = fread(file, 1, sizeof file - 1, from), one = single ? 4 : 8;
    file[size] = 0;
    fclose(from);
    char declared[200];
    snprintf(declared, sizeof declared,
             "<DataArray type=\"Float%d\" Name=\"velocity [m/s]\" NumberOfComponents=\"3\"",
             single ? 32 : 64);
    sph_snapshot s = snapshot(in(run, "snapshot_0001.hdf"), "velocity_y");
    const char *v = array(file, size, declared, 3 * one * (size_t)N);
    const char *x = array(file, size, "Name=\"Points\"", 3 * one * (size_t)N);
    for (long i = 0; i < N; i++)
      for (int k = 0; k < 2; k++) {
        const double right = k ? s.x[0][3 * i + 1] : s.value[0][i];
        const char *at = (k ? x : v) + (size_t)(3 * i + 1) * one;
        double found;
        float half;
        memcpy(&found, at, sizeof found < one ? sizeof found : one);
        memcpy(&half, at, sizeof half);
        assert_near(single ? half : found, single ? (float)right : right, 0);
      }
    const char *types = array(file, size, "Name=\"types\"", (size_t)N);
    for (long i = 0; i < N; i++) assert_int_equal(types[i], 1);
    array(file, size, "Name=\"dye [kg &amp; &lt;m>]\"", one * (size_t)N);
    sph_snapshot_read_free(&s);
  }
}

/* Snapshots of single precision, and of other compression: the same numbers, other sizes. */
static void snapshots_of_other_sizes(void **state)
{
  (void)state;
  static const sph_hdf5_def kinds[] = {{.compression = 0},
                                       {.compression = 9},
                                       {.compression = -1},
                                       {.single = 1},
                                       {.compression = 10}};
  off_t bytes[5] = {0};
  for (int k = 0; k < 5; k++) {
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.01});
    sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
    sph_group_set_eos(water, sph_eos_tait(1000, 30, 7));
    sph_group_jitter(water, 0.2, 1);
    sph_sim_add_term(sim, sph_term_pressure());
    sph_hdf5_def def = kinds[k];
    def.directory = to;
    def.interval = 1;
    sph_sim_add_output(sim, sph_output_hdf5_def(&def));
    assert_int_equal(sph_sim_run(sim, 0), k == 4 ? SPH_ERR_ARGUMENT : SPH_OK);
    if (k == 4) assert_non_null(strstr(sph_sim_error(sim), "compression 10; right is 1 to 9"));
    if (k < 4) {
      struct stat info;
      sph_snapshot s = snapshot(in(to, "snapshot_0000.hdf"), "mass");
      const double *x = sph_group_read(water, "position", 0);
      for (long i = 0; i < s.n[0]; i++)
        assert_near(s.x[0][3 * i], kinds[k].single ? (float)x[i] : x[i], 0);
      sph_snapshot_read_free(&s);
      assert_int_equal(stat(in(to, "snapshot_0000.hdf"), &info), 0);
      bytes[k] = info.st_size;
    }
    sph_sim_free(sim);
  }
  print_message("# %ld bytes, smallest %ld, as they are %ld, single %ld\n", (long)bytes[0],
                (long)bytes[1], (long)bytes[2], (long)bytes[3]);
  assert_true(bytes[1] < bytes[0] && bytes[0] < 0.7 * bytes[2] && bytes[3] < 0.8 * bytes[0]);
}

static void refused(void **state)
{
  (void)state;
  static const struct {
    sph_export_def def;
    const char *why;
  } wrong[] = {{{run, "vtk", to, NULL, 0, {NULL, NULL}}, "format \"vtk\"; did you mean 'vtu'?"},
               {{run, NULL, to, NULL, 0, {NULL, NULL}}, "known: csv, vtu, gadget"},
               {{"", "csv", to, NULL, 0, {NULL, NULL}}, "of no file"},
               {{to, "csv", to, "velocty", 0, {NULL, NULL}}, "no snapshots"},
               {{run, "csv", to, "velocty", 0, {NULL, NULL}},
                "no field \"velocty\"; did you mean 'velocity'?"},
               {{run, "csv", "/proc/no/where", NULL, 0, {NULL, NULL}}, "/proc/no"},
               {{"nothing.hdf", "csv", to, NULL, 0, {NULL, NULL}},
                "nothing.hdf: no such HDF5 file"}};
  char empty[FOLDER_MAX];
  assert_int_equal(folder_make(empty, "empty"), 0);
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    sph_error error = {0};
    sph_export_def def = wrong[k].def;
    if (k == 3) def.path = empty;
    assert_true(sph_export(&def, &error) < 0);
    if (!strstr(error.text, wrong[k].why)) fail_msg("\"%s\" not in: %s", wrong[k].why, error.text);
  }
  assert_true(sph_export(NULL, NULL) < 0);
  assert_int_equal(folder_remove(empty), 0); /* nothing was left there */
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(csv_is_the_snapshot),
                                     cmocka_unit_test(gadget_is_the_snapshot),
                                     cmocka_unit_test(vtu_is_the_snapshot),
                                     cmocka_unit_test(snapshots_of_other_sizes),
                                     cmocka_unit_test(refused)};
  return cmocka_run_group_tests_name("export", tests, make_run, clean);
}
