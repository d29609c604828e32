/* What is written, read back by other means: HDF5's own calls, a JSON grammar, exact values of
 * monitors on lattices, and disks that fill up or processes that are killed in between. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#define H5_USE_110_API /* HDF5 1.12 and later: object addresses under their old name */
#include <hdf5.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "csv.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode.h"

static const double dx = 0.1, rho0 = 1000;
static char directory[200]; /* of this process, removed at the end */

/* directory/name; a few at once. */
static const char *in(const char *name)
{
  static char path[4][600];
  static int k;
  k = (k + 1) % 4;
  snprintf(path[k], sizeof path[k], "%s/%s", directory, name);
  return path[k];
}

static int exists(const char *name) { return access(in(name), F_OK) == 0; }

static char *slurp(const char *name)
{
  static char text[100000];
  FILE *file = fopen(in(name), "r");
  assert_non_null(file);
  size_t n = fread(text, 1, sizeof text - 1, file);
  text[n] = '\0';
  fclose(file);
  return text;
}

/* How many files of the directory end so. */
static int count_files(const char *end)
{
  int count = 0;
  DIR *entries = opendir(directory);
  assert_non_null(entries);
  for (struct dirent *entry; (entry = readdir(entries));) {
    size_t n = strlen(entry->d_name), m = strlen(end);
    count += n > m && !strcmp(entry->d_name + n - m, end);
  }
  closedir(entries);
  return count;
}

static int empty_directory(void **state)
{
  (void)state;
  DIR *entries = opendir(directory);
  for (struct dirent *entry; entries && (entry = readdir(entries));) unlink(in(entry->d_name));
  if (entries) closedir(entries);
  return 0;
}

/* Water 2 x 1 at rest in a tank, p = p0 + slope y. */
static sph_sim *tank(double p0, double slope)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){2, 1}, rho0);
  sph_group *walls = sph_group_walls(sim, "tank", (double[]){0, 0}, (double[]){4, 2}, rho0);
  sph_group_set_eos(water, sph_eos_linear(rho0, 100, -INFINITY));
  sph_group_set_boundary(walls, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_pressure());
  long n = sph_group_count(water);
  assert_int_equal(n, 200);
  double p[200];
  const double *y = sph_group_read(water, "position", 1);
  double *u = sph_group_write(water, "velocity", 0);
  for (long i = 0; i < n; i++) p[i] = p0 + slope * y[i];
  for (long i = 0; i < n; i++) u[i] = 0.25 * y[i];
  sph_group_set_pressure(water, p);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  return sim;
}

/* One frame of an output, as the run would call it. */
static int write_frames(sph_output output, sph_sim *sim, int frames, sph_error *error)
{
  int status = output.open ? output.open(output.ctx, sim, error) : SPH_OK;
  for (int k = 0; status == SPH_OK && k < frames; k++)
    status = output.frame(output.ctx, sim, error);
  if (output.close) output.close(output.ctx, sim, error);
  output.free(output.ctx);
  return status;
}

/* ---- snapshots ---- */

static H5O_info_t object(hid_t file, const char *name)
{
  H5O_info_t info;
  assert_true(H5Oget_info_by_name(file, name, &info, H5P_DEFAULT) >= 0);
  return info;
}

static void read_doubles(hid_t file, const char *name, double *values)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  assert_true(set >= 0);
  assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  H5Dclose(set);
}

static void read_attribute(hid_t file, const char *group, const char *name, hid_t type, void *value)
{
  hid_t attribute = H5Aopen_by_name(file, group, name, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(attribute >= 0);
  assert_true(H5Aread(attribute, type, value) >= 0);
  H5Aclose(attribute);
}

static void check_water(hid_t file, const sph_sim *sim)
{
  static const char *const scalars[][2] = {{"density", "Density"},
                                           {"pressure", "Pressure"},
                                           {"mass", "Masses"}};
  double values[600], one[200];
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  read_doubles(file, "/PartType0/Coordinates", values);
  for (long i = 0; i < 200; i++) {
    assert_true(values[3 * i] == x[i] && values[3 * i + 1] == y[i] && values[3 * i + 2] == 0);
  }
  for (int k = 0; k < 3; k++) {
    char name[60];
    snprintf(name, sizeof name, "/PartType0/%s", scalars[k][1]);
    read_doubles(file, name, one);
    assert_memory_equal(one, sph_group_read(water, scalars[k][0], 0), sizeof one);
  }
  read_doubles(file, "/PartType0/ParticleIDs", one);
  for (long i = 0; i < 200; i++) assert_true(one[i] == (double)sph_group_id(water, i));
}

static void snapshot_holds_the_state(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_sim *sim = tank(2000, -1000);
  const char text[] = "title: caf\xc3\xa9\n# all of it\n";
  sph_output output = sph_output_hdf5_def(&(sph_hdf5_def){
      .directory = in("."), .interval = 1, .case_text = text, .command = "sphode run a.yml"});
  assert_int_equal(write_frames(output, sim, 2, &error), SPH_OK);
  hid_t file = H5Fopen(in("snapshot_0001.hdf"), H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(file >= 0);
  check_water(file, sim);
  int count[6], version[2];
  read_attribute(file, "/Header", "NumPart_ThisFile", H5T_NATIVE_INT, count);
  assert_int_equal(count[0], 200);
  assert_int_equal(count[1], sph_group_count(sph_sim_group(sim, "tank")));
  read_attribute(file, "/VTKHDF", "Version", H5T_NATIVE_INT, version);
  assert_int_equal(version[0], 1);
  char kept[sizeof text] = "";
  hid_t set = H5Dopen2(file, "/Parameters/Case", H5P_DEFAULT), type = H5Dget_type(set);
  assert_int_equal(H5Tget_size(type), sizeof text - 1);
  assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, kept) >= 0);
  assert_string_equal(kept, text);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(file);
  assert_int_equal(count_files(".tmp"), 0);
  sph_sim_free(sim);
}

static void paraview_sees_the_same_data(void **state)
{
  (void)state;
  static const char *const same[][2] = {
      {"/PartType0/Coordinates", "/VTKHDF/Points"},
      {"/PartType0/Velocities", "/VTKHDF/PointData/Velocities [m per s]"},
      {"/PartType0/Pressure", "/VTKHDF/PointData/Pressure [Pa]"},
      {"/PartType1/Coordinates", "/Walls/Points"},
  };
  sph_error error = {0};
  sph_sim *sim = tank(0, 0);
  long walls = sph_group_count(sph_sim_group(sim, "tank"));
  assert_int_equal(write_frames(sph_output_hdf5(in("."), 1), sim, 1, &error), SPH_OK);
  hid_t file = H5Fopen(in("snapshot_0000.hdf"), H5F_ACC_RDONLY, H5P_DEFAULT);
  for (int k = 0; k < 4; k++) {
    H5O_info_t a = object(file, same[k][0]), b = object(file, same[k][1]);
    assert_true(a.addr == b.addr && a.rc == 2); /* one object with two names */
  }
  double offsets[201], types[200];
  read_doubles(file, "/VTKHDF/Offsets", offsets);
  read_doubles(file, "/VTKHDF/Types", types);
  for (int i = 0; i <= 200; i++) assert_true(offsets[i] == i && (i == 200 || types[i] == 1));
  H5Fclose(file);
  file = H5Fopen(in("walls_0000.hdf"), H5F_ACC_RDONLY, H5P_DEFAULT);
  double points = 0;
  read_doubles(file, "/VTKHDF/NumberOfPoints", &points);
  assert_true(points == (double)walls);
  H5Fclose(file);
  assert_non_null(
      strstr(slurp("snapshot.hdf.series"), "{\"name\": \"snapshot_0000.hdf\", \"time\": 0}"));
  sph_sim_free(sim);
}

static void reader_reads_components_and_magnitudes(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_snapshot s;
  sph_sim *sim = tank(0, 0);
  const double *u = sph_group_read(sph_sim_group(sim, "water"), "velocity", 0);
  assert_int_equal(write_frames(sph_output_hdf5(in("."), 1), sim, 1, &error), SPH_OK);
  assert_int_equal(sph_snapshot_read(in("snapshot_0000.hdf"), "velocity", &s, &error), SPH_OK);
  assert_string_equal(s.unit, "m/s");
  assert_true(s.dim == 2 && s.spacing == dx && s.n[SPH_FLUIDS] == 200);
  for (int i = 0; i < 200; i++) assert_true(s.value[SPH_FLUIDS][i] == fabs(u[i]));
  sph_snapshot_read_free(&s);
  assert_int_equal(sph_snapshot_read(in("snapshot_0000.hdf"), "velocity_y", &s, &error), SPH_OK);
  for (int i = 0; i < 200; i++) assert_true(s.value[SPH_FLUIDS][i] == 0);
  sph_snapshot_read_free(&s);
  assert_int_equal(sph_snapshot_read(in("snapshot_0000.hdf"), "colour", &s, &error),
                   SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "pressure")); /* tells the known ones */
  error = (sph_error){0};
  FILE *junk = fopen(in("junk.hdf"), "w");
  fputs("not HDF5", junk);
  fclose(junk);
  assert_int_equal(sph_snapshot_read(in("junk.hdf"), "density", &s, &error), SPH_ERR_FILE);
  sph_sim_free(sim);
}

/* ---- disks and deaths ---- */

/* In a child: files may have no more than `limit` bytes from now on. */
static void limit_files(rlim_t limit)
{
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &(struct rlimit){limit, RLIM_INFINITY});
}

static int exit_status(pid_t child)
{
  int status = 0;
  assert_int_equal(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void full_disk_is_told_and_harmless(void **state)
{
  (void)state;
  sph_snapshot s;
  sph_error error = {0};
  sph_sim *sim = tank(0, 0);
  pid_t child = fork();
  if (child == 0) {
    sph_output output = sph_output_hdf5(in("."), 1);
    int right = output.open(output.ctx, sim, &error) == SPH_OK;
    right = right && output.frame(output.ctx, sim, &error) == SPH_OK;
    limit_files(3000);
    right = right && output.frame(output.ctx, sim, &error) == SPH_ERR_FILE;
    right = right && strstr(error.text, "snapshot_0001.hdf") && strstr(error.text, "large");
    /* Begun anew, it would replace the first one: that stays as it is. */
    right = right && output.open(output.ctx, sim, NULL) == SPH_OK;
    right = right && output.frame(output.ctx, sim, NULL) == SPH_ERR_FILE;
    _exit(right ? 0 : 1);
  }
  assert_int_equal(exit_status(child), 0);
  assert_true(exists("snapshot_0000.hdf") && !exists("snapshot_0001.hdf"));
  assert_int_equal(count_files(".tmp"), 0);
  assert_int_equal(sph_snapshot_read(in("snapshot_0000.hdf"), "density", &s, &error), SPH_OK);
  sph_snapshot_read_free(&s);
  sph_sim_free(sim);
}

static void full_disk_leaves_whole_rows(void **state)
{
  (void)state;
  sph_error error = {0};
  double *t = NULL;
  char title[128];
  long n = 0;
  sph_sim *sim = tank(0, 0);
  pid_t child = fork();
  if (child == 0) {
    sph_output output = sph_output_series(in("."), 1, NULL, 0);
    int status = output.open(output.ctx, sim, &error);
    limit_files(500); /* the header and some rows */
    for (int k = 0; status == SPH_OK && k < 100; k++)
      status = output.frame(output.ctx, sim, &error);
    _exit(status == SPH_ERR_FILE && strstr(error.text, "series.csv") ? 0 : 1);
  }
  assert_int_equal(exit_status(child), 0);
  assert_int_equal(sph_csv_read(in("series.csv"), "total", 0, &t, &n, title, &error), SPH_OK);
  assert_true(n > 0);
  const char *text = slurp("series.csv");
  assert_int_equal(text[strlen(text) - 1], '\n');
  sph_memory_free(t);
  sph_sim_free(sim);
}

/* A device, which cannot be cut back to whole rows. */
static void full_device_tells_why(void **state)
{
  (void)state;
  if (access("/dev/full", W_OK) != 0) return;
  sph_error error = {0};
  sph_sim *sim = tank(0, 0);
  assert_int_equal(symlink("/dev/full", in("series.csv")), 0);
  assert_int_equal(write_frames(sph_output_series(in("."), 1, NULL, 0), sim, 1, &error),
                   SPH_ERR_FILE);
  if (!strstr(error.text, strerror(ENOSPC))) fail_msg("\"%s\"", error.text);
  sph_sim_free(sim);
}

static void killed_run_leaves_whole_files(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_sim *sim = tank(0, 0);
  int whole = 0;
  for (int try = 0; try < 5; try++) {
    empty_directory(NULL);
    pid_t child = fork();
    if (child == 0) _exit(write_frames(sph_output_hdf5(in("."), 1), sim, 10000, &error) ? 1 : 0);
    while (!exists("snapshot_0000.hdf")) nanosleep(&(struct timespec){0, 1000000}, NULL);
    nanosleep(&(struct timespec){0, 7300000 * try}, NULL);
    kill(child, SIGKILL);
    exit_status(child);
    for (int k = 0;; k++) {
      char name[60];
      sph_snapshot s;
      snprintf(name, sizeof name, "snapshot_%04d.hdf", k);
      if (!exists(name)) break;
      assert_int_equal(sph_snapshot_read(in(name), "pressure", &s, &error), SPH_OK);
      sph_snapshot_read_free(&s);
      whole++;
    }
  }
  assert_true(whole > 0);
  fclose(fopen(in("snapshot_0099.hdf.tmp"), "w")); /* one is surely left now */
  assert_int_equal(write_frames(sph_output_hdf5(in("."), 1), sim, 0, &error), SPH_OK);
  assert_int_equal(count_files(".tmp"), 0);
  sph_sim_free(sim);
}

static void impossible_directory_is_told(void **state)
{
  (void)state;
  sph_error error = {0}, second = {0}, third = {0};
  sph_sim *sim = tank(0, 0);
  fclose(fopen(in("file"), "w"));
  assert_int_equal(write_frames(sph_output_hdf5(in("file/sub"), 1), sim, 1, &error), SPH_ERR_FILE);
  assert_non_null(strstr(error.text, "file"));
  assert_int_equal(write_frames(sph_output_series(in("file"), 1, NULL, 0), sim, 1, &second),
                   SPH_ERR_FILE);
  assert_int_equal(write_frames(sph_output_hdf5(NULL, 1), sim, 1, &third), SPH_ERR_ARGUMENT);
  sph_sim_free(sim);
}

static void *write_in_a_thread(void *path)
{
  sph_error error = {0};
  sph_sim *sim = tank(0, 0);
  int status = write_frames(sph_output_hdf5(path, 1), sim, 8, &error);
  sph_sim_free(sim);
  return status == SPH_OK ? path : NULL;
}

/* HDF5 as packaged is not thread-safe: the library must see to it. */
static void two_threads_write_at_once(void **state)
{
  (void)state;
  char path[2][600];
  pthread_t thread[2];
  for (int k = 0; k < 2; k++) {
    snprintf(path[k], sizeof path[k], "%s/thread%d", directory, k);
    assert_int_equal(pthread_create(&thread[k], NULL, write_in_a_thread, path[k]), 0);
  }
  for (int k = 0; k < 2; k++) {
    void *result = NULL;
    assert_int_equal(pthread_join(thread[k], &result), 0);
    assert_ptr_equal(result, path[k]);
    for (int frame = 0; frame < 8; frame++) {
      char name[64];
      sph_snapshot s;
      sph_error error = {0};
      snprintf(name, sizeof name, "thread%d/snapshot_%04d.hdf", k, frame);
      assert_int_equal(sph_snapshot_read(in(name), "pressure", &s, &error), SPH_OK);
      sph_snapshot_read_free(&s);
      unlink(in(name));
      snprintf(name, sizeof name, "thread%d/walls_%04d.hdf", k, frame);
      assert_int_equal(unlink(in(name)), 0);
    }
    unlink(in(k ? "thread1/snapshot.hdf.series" : "thread0/snapshot.hdf.series"));
    unlink(in(k ? "thread1/walls.hdf.series" : "thread0/walls.hdf.series"));
    assert_int_equal(rmdir(path[k]), 0); /* nothing else was there */
  }
}

/* ---- monitors ---- */

static double monitor(sph_sim *sim, sph_monitor m)
{
  double value = NAN;
  sph_error error = {0};
  m.name = "m";
  assert_int_equal(sph_monitor_value(&m, sim, &value, &error), SPH_OK);
  return value;
}

static void assert_near(double value, double right, double tolerance)
{
  if (!(fabs(value - right) <= tolerance)) fail_msg("%.17g is not %.17g", value, right);
}

static void front_ignores_spray(void **state)
{
  (void)state;
  sph_sim *sim = tank(0, 0);
  double *x = sph_group_write(sph_sim_group(sim, "water"), "position", 0);
  double *y = sph_group_write(sph_sim_group(sim, "water"), "position", 1);
  assert_near(monitor(sim, (sph_monitor){.type = "front"}), 2, 1e-12);
  assert_near(monitor(sim, (sph_monitor){.type = "height"}), 1, 1e-12);
  assert_near(monitor(sim, (sph_monitor){.type = "front", .axis = 1}), 1, 1e-12);
  for (int i = 0; i < 3; i++) { /* three together have two neighbours each */
    x[i] = 3 + 0.9 * dx * i;
    y[i] = 0.5;
  }
  assert_near(monitor(sim, (sph_monitor){.type = "front"}), 2, 1e-12);
  x[3] = 3 + 0.5 * dx; /* a fourth, and all have three */
  y[3] = 0.5 + 0.9 * dx;
  assert_near(monitor(sim, (sph_monitor){.type = "front"}), 3 + 1.8 * dx + dx / 2, 1e-12);
  sph_sim_free(sim);
}

/* The definition, written plainly. */
static double front_plain(const double *x, const double *y, int n, double spacing)
{
  double best = -INFINITY;
  for (int i = 0; i < n; i++) {
    int near = 0;
    for (int j = 0; j < n; j++) near += j != i && hypot(x[i] - x[j], y[i] - y[j]) <= 2 * spacing;
    if (near >= 3) best = fmax(best, x[i] + spacing / 2);
  }
  return best;
}

static void front_of_random_points(void **state)
{
  (void)state;
  srand(1);
  for (int try = 0; try < 50; try++) {
    double x[300], y[300];
    int n = 20 + rand() % 280;
    for (int i = 0; i < n; i++) {
      x[i] = 3 * pow(rand() / (double)RAND_MAX, 3);
      y[i] = rand() / (double)RAND_MAX;
    }
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.06});
    sph_group *cloud = sph_group_create(sim, "cloud", "fluid");
    sph_group_add_points(cloud, n, (const double *[]){x, y}, rho0);
    double right = front_plain(x, y, n, 0.06), value = monitor(sim, (sph_monitor){.type = "front"});
    if (isinf(right))
      assert_true(isnan(value));
    else
      assert_true(value == right);
    sph_sim_free(sim);
  }
}

static void pressure_of_a_linear_field(void **state)
{
  (void)state;
  sph_sim *sim = tank(2000, -1000);
  /* Symmetric about a particle, and about the middle of four: a linear field is exact. */
  assert_near(monitor(sim, (sph_monitor){.type = "pressure", .x = {1.05, 0.55}}), 1450, 1e-8);
  assert_near(monitor(sim, (sph_monitor){.type = "pressure", .x = {1, 0.5}}), 1500, 1e-8);
  assert_near(monitor(sim, (sph_monitor){.type = "pressure", .x = {1, 0.5}, .extent = {0, 0.14}}),
              1500, 1e-8);
  assert_near(monitor(sim, (sph_monitor){.type = "pressure", .x = {1, 0.5}, .extent = {.2, .1}}),
              1500, 1e-8);
  /* On the wall only the side of the water counts, above it none. */
  double p = monitor(sim, (sph_monitor){.type = "pressure", .x = {0, 0.5}});
  assert_near(p, 1500, 1e-8);
  assert_true(monitor(sim, (sph_monitor){.type = "pressure", .x = {3, 0.5}}) == 0);
  assert_true(monitor(sim, (sph_monitor){.type = "pressure", .x = {1, 1.2}}) == 0);
  /* The mean over a dry and a wet half: the dry samples count as zero. */
  p = monitor(sim, (sph_monitor){.type = "pressure", .x = {0, 1}, .extent = {0, 0.9}});
  assert_true(p > 100 && p < 1500 * 0.6);
  sph_sim_free(sim);
}

static void semi_axis_of_a_lattice(void **state)
{
  (void)state;
  sph_sim *sim = tank(0, 0); /* variance of n points dx apart: dx^2 (n^2 - 1)/12 */
  assert_near(monitor(sim, (sph_monitor){.type = "semi-axis"}), 2 * dx * sqrt(399 / 12.0), 1e-12);
  assert_near(monitor(sim, (sph_monitor){.type = "semi-axis", .axis = 1}), 2 * dx * sqrt(99 / 12.0),
              1e-12);
  sph_sim_free(sim);
}

static void wrong_monitors_are_refused(void **state)
{
  (void)state;
  static const sph_monitor wrong[] = {
      {.name = "a b", .type = "front"},
      {.name = "", .type = "front"},
      {.name = "a", .type = "fronts"},
      {.name = "a", .type = "front", .group = "tank"},
      {.name = "a", .type = "front", .axis = 2},
      {.name = "a", .type = "pressure", .x = {NAN}},
      {.name = "a", .type = "pressure", .extent = {-1}},
  };
  sph_sim *sim = tank(0, 0);
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    sph_error error = {0};
    assert_int_equal(write_frames(sph_output_series(in("."), 1, &wrong[k], 1), sim, 1, &error),
                     SPH_ERR_ARGUMENT);
    assert_true(strlen(error.text) > 10);
  }
  assert_false(exists("series.csv"));
  sph_sim_free(sim);
}

static void series_round_trip(void **state)
{
  (void)state;
  static const sph_monitor monitors[] = {
      {.name = "front", .type = "front"},
      {.name = "p1", .type = "pressure", .group = "water", .x = {1, 0.5}},
  };
  sph_error error = {0};
  sph_balance balance;
  double *value = NULL;
  char title[128];
  long n = 0;
  sph_sim *sim = tank(2000, -1000);
  sph_sim_balance(sim, &balance);
  assert_int_equal(write_frames(sph_output_series(in("."), 0, monitors, 2), sim, 3, &error),
                   SPH_OK);
  assert_int_equal(sph_csv_read(in("series.csv"), "p1", 0, &value, &n, title, &error), SPH_OK);
  assert_string_equal(title, "p1 [Pa]");
  assert_int_equal(n, 3);
  assert_near(value[2], 1500, 1e-8);
  sph_memory_free(value);
  assert_int_equal(sph_csv_read(in("series.csv"), "total", 0, &value, &n, title, &error), SPH_OK);
  assert_string_equal(title, "total [J/m]");
  assert_near(value[0], balance.total, 1e-14 * fabs(balance.total));
  sph_memory_free(value);
  assert_true(sph_csv_read(in("series.csv"), "nothing", 0, &value, &n, title, &error) < 0);
  sph_sim_free(sim);
}

/* Rows of one word among others; a picture with logarithmic axes. */
static void rows_by_a_word(void **state)
{
  (void)state;
  sph_error error = {0};
  double *value = NULL;
  char title[128], csv[300];
  long n = 0;
  snprintf(csv, sizeof csv, "%s", in("rows.csv"));
  FILE *file = fopen(in("rows.csv"), "w");
  assert_non_null(file);
  fputs("name, x [s],y\nleapfrog ,1,9\nleap,2,3\nleapfrog,30,nan\nleapfrog,300,40\n", file);
  fclose(file);
  sph_csv_rows which = {"name", "leapfrog"};
  assert_int_equal(sph_csv_read_rows(in("rows.csv"), which, "x", 0, &value, &n, title, &error),
                   SPH_OK);
  assert_int_equal(n, 3);
  assert_string_equal(title, "x [s]");
  assert_true(value[0] == 1 && value[1] == 30 && value[2] == 300);
  sph_memory_free(value);
  which.column = "nam";
  assert_true(sph_csv_read_rows(in("rows.csv"), which, "x", 0, &value, &n, title, &error) < 0);
  assert_non_null(strstr(error.text, "no column \"nam\""));
  error = (sph_error){0};
  sph_plot_curve curve = {.csv = csv, .x = "x", .y = "y", .where = "name", .is = "leap"};
  sph_plot_curve curves[2] = {curve, curve};
  curves[1].is = "leapfrog";
  curves[1].points = 2;
  sph_plot_def def = {.log_x = 1, .log_y = 1, .y_min = 1, .y_max = 50};
  int status = sph_plot_series(curves, 2, &def, in("rows.png"), &error);
  assert_true(status == SPH_OK || status == SPH_ERR_UNBUILT); /* the script is there */
  const char *script = slurp("rows.gp");
  assert_non_null(strstr(script, "set logscale x\nset format x '10^{%T}'\nset mxtics 10"));
  assert_non_null(strstr(script, "set ytics (1, 2, 5, '' 3 1, '' 4 1,"));
  assert_non_null(strstr(script, "with linespoints"));
}

/* ---- JSON: RFC 8259, by recursive descent; each returns what follows, NULL for no JSON ---- */

static const char *after_blanks(const char *s)
{
  while (s && *s && strchr(" \t\n\r", *s)) s++;
  return s;
}

static const char *json_string(const char *s)
{
  if (*s++ != '"') return NULL;
  for (; *s != '"'; s++) {
    if ((unsigned char)*s < 0x20) return NULL; /* the end, too */
    if (*s == '\\' && !strchr("\"\\/bfnrtu", *++s)) return NULL;
  }
  return s + 1;
}

static const char *json_number(const char *s)
{
  char *end = NULL;
  if (*s != '-' && !isdigit((unsigned char)*s)) return NULL; /* no nan, no inf */
  strtod(s, &end);
  return end;
}

static const char *json(const char *s);

static const char *json_members(const char *s, char close)
{
  s = after_blanks(s + 1);
  if (*s == close) return s + 1;
  while (s) {
    if (close == '}') {
      s = after_blanks(json_string(s));
      if (!s || *s++ != ':') return NULL;
    }
    s = after_blanks(json(s));
    if (!s || *s == close) return s ? s + 1 : NULL;
    if (*s++ != ',') return NULL;
    s = after_blanks(s);
  }
  return NULL;
}

static const char *json(const char *s)
{
  s = after_blanks(s);
  if (*s == '{') return json_members(s, '}');
  if (*s == '[') return json_members(s, ']');
  if (*s == '"') return json_string(s);
  if (!strncmp(s, "null", 4) || !strncmp(s, "true", 4)) return s + 4;
  if (!strncmp(s, "false", 5)) return s + 5;
  return json_number(s);
}

static double member(const char *text, const char *name)
{
  char key[100];
  snprintf(key, sizeof key, "\"%s\": ", name);
  const char *at = strstr(text, key);
  assert_non_null(at);
  return strtod(at + strlen(key), NULL);
}

static void assert_json(const char *name)
{
  const char *end = json(slurp(name));
  assert_true(end && *after_blanks(end) == '\0');
}

static void summary_tells_the_truth(void **state)
{
  (void)state;
  static const sph_comparison comparisons[] = {
      {"front", "Someone \"quoted\" \\ and\nso on \x01", "front", "rms", 0.013, 0.02, 1, "note"},
      {"p", NULL, "pressure", "l1", 0.3, 0.1, 0, NULL},
      {"only told", "x", "y", "max", NAN, NAN, 0, NULL},
  };
  char text[8000];
  sph_error error = {0};
  sph_balance start;
  sph_sim *sim = tank(0, 0);
  sph_sim_balance(sim, &start);
  double total = start.total;
  start.total += 0.1;
  start.momentum[1] -= 0.5;
  assert_int_equal(sph_summary_write(in("."), sim, &start, comparisons, 3, &error), SPH_OK);
  assert_json("summary.json");
  const char *json_text = slurp("summary.json");
  assert_true(member(json_text, "drift_total_energy") == total - start.total);
  assert_near(member(json_text, "drift_momentum"), 0.5, 1e-12);
  assert_true(member(json_text, "fluid_particles") == 200);
  assert_non_null(strstr(json_text, "\"pass\": true"));
  assert_non_null(strstr(json_text, "\"pass\": false"));
  assert_non_null(strstr(json_text, "\"pass\": null"));
  assert_non_null(strstr(json_text, "\\\"quoted\\\" \\\\ and\\u000aso on \\u0001"));
  int length = sph_summary_text(text, sizeof text, sim, &start, comparisons, 3);
  assert_int_equal(length, strlen(text));
  assert_string_equal(text, slurp("summary.txt"));
  assert_true(strstr(text, "FAIL") && strstr(text, "pass") && strstr(text, "reported"));
  assert_int_equal(sph_summary_text(text, 10, sim, &start, comparisons, 3), length);
  assert_int_equal(strlen(text), 9);
  assert_int_equal(sph_summary_write(in("."), sim, NULL, NULL, 0, &error), SPH_OK);
  assert_json("summary.json");
  sph_sim_free(sim);
}

static void series_files_are_json(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_sim *sim = tank(0, 0);
  assert_int_equal(write_frames(sph_output_hdf5(in("."), 1), sim, 3, &error), SPH_OK);
  assert_json("snapshot.hdf.series");
  assert_json("walls.hdf.series");
  sph_sim_free(sim);
}

/* ---- pictures ---- */

static void pictures_are_drawn_or_refused(void **state)
{
  (void)state;
  const char *name = "a'b `touch x` $(touch x) |x \".png"; /* no shell sees it */
  sph_error error = {0};
  sph_sim *sim = tank(2000, -1000);
  assert_int_equal(sph_plot_frames(in("."), "pressure", 2, in("p.png"), &error), SPH_ERR_FILE);
  error = (sph_error){0};
  assert_int_equal(write_frames(sph_output_hdf5(in("."), 1), sim, 3, &error), SPH_OK);
  assert_int_equal(sph_plot_count(in("."), &error), 3);
  assert_int_equal(sph_plot_particles(in("."), "pressure", in("p.jpg"), &error), SPH_ERR_ARGUMENT);
  error = (sph_error){0};
  int status = sph_plot_frames(in("."), "pressure", 2, in(name), &error);
  if (status == SPH_OK) {
    assert_true(exists(name) && !exists("x"));
    assert_memory_equal(slurp(name), "\x89PNG", 4);
  } else {
    assert_int_equal(status, SPH_ERR_UNBUILT); /* no gnuplot here: says what to install */
    assert_non_null(strstr(error.text, "gnuplot-nox"));
  }
  char *path = strdup(getenv("PATH"));
  error = (sph_error){0};
  setenv("PATH", directory, 1);
  assert_int_equal(sph_plot_particles(in("."), NULL, in("v.png"), &error), SPH_ERR_UNBUILT);
  assert_true(exists("v.gp") && exists("v.dat"));
  setenv("PATH", path, 1);
  free(path);
  sph_sim_free(sim);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup(name, empty_directory)
  const struct CMUnitTest tests[] = {
      TEST(snapshot_holds_the_state),
      TEST(paraview_sees_the_same_data),
      TEST(reader_reads_components_and_magnitudes),
      TEST(full_disk_is_told_and_harmless),
      TEST(full_disk_leaves_whole_rows),
      TEST(full_device_tells_why),
      TEST(killed_run_leaves_whole_files),
      TEST(impossible_directory_is_told),
      TEST(two_threads_write_at_once),
      TEST(front_ignores_spray),
      TEST(front_of_random_points),
      TEST(pressure_of_a_linear_field),
      TEST(semi_axis_of_a_lattice),
      TEST(wrong_monitors_are_refused),
      TEST(series_round_trip),
      TEST(rows_by_a_word),
      TEST(summary_tells_the_truth),
      TEST(series_files_are_json),
      TEST(pictures_are_drawn_or_refused),
  };
  const char *temporary = getenv("TMPDIR");
  snprintf(directory, sizeof directory, "%s/sphode_io_XXXXXX", temporary ? temporary : "/tmp");
  if (!mkdtemp(directory)) return 99;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  empty_directory(NULL);
  rmdir(directory);
  return failed;
}
