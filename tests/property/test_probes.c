/* Probes, gauges, columns of forces and powers: the right numbers in files that other tools read,
 * which change nothing in the run, and go on over a restart without a gap. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../folder.h"
#include "../near.h"
#include "csv.h"
#include "memory.h"
#include "sphode.h"

static const double g = 9.81, rho0 = 1000, H = 1, dx = 0.05; /* [m/s^2], [kg/m^3], [m] */
static char directory[FOLDER_MAX];

static const char *in(const char *name)
{
  static char path[2][FOLDER_MAX + 100];
  static int turn;
  snprintf(path[turn ^= 1], sizeof path[0], "%s/%s", directory, name);
  return path[turn];
}

static long column(const char *file, const char *name, double **values, char title[128])
{
  sph_error error = {0};
  long n = 0;
  *values = NULL;
  if (sph_csv_read(in(file), name, 0, values, &n, title, &error)) fail_msg("%s", error.text);
  return n;
}

static char *slurp(const char *name)
{
  FILE *file = fopen(in(name), "rb");
  char *text = calloc(1, 1 << 20);
  if (!file || !text) fail_msg("%s cannot be read", in(name));
  size_t n = fread(text, 1, (1 << 20) - 1, file);
  text[n] = 0;
  fclose(file);
  return text;
}

/* Water 2 H wide at rest in a tank; `tall`: H, in its right half `tall` H. */
static sph_sim *tank(double tall)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .speed = 0.1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){2, H}, rho0);
  if (tall > 1) sph_group_add_box(water, (double[]){1, H}, (double[]){2, tall * H}, rho0);
  sph_group *walls = sph_group_create(sim, "walls", "wall");
  sph_group_add_layers(walls, (double[]){0, 0}, (double[]){2, 1.6}, "y+", rho0);
  sph_group_set_boundary(walls, sph_boundary_adami());
  sph_group_set_eos(water, sph_eos_tait(rho0, 30 * sqrt(g * H), 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.05, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[]){0, -g, 0}));
  sph_group_set_hydrostatic(water, 1, H, g);
  return sim;
}

/* A frame of the state as it is. */
static void write_once(sph_sim *sim, sph_output output)
{
  sph_sim_add_output(sim, output);
  if (sph_sim_run(sim, 0) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  sph_sim_free(sim);
}

/* Pressure rho g depth within 1 % of rho g H away from floor and surface; dry above. */
static void pressure_over_depth(void **state)
{
  (void)state;
  double *y, *p, *cover, *v;
  char title[128];
  sph_probe_def def = {.directory = directory,
                       .name = "depth",
                       .fields = "pressure, velocity",
                       .from = {1, 0},
                       .along = {0, 1.3},
                       .n = {27, 0}};
  write_once(tank(1), sph_output_probe(&def));
  assert_int_equal(column("probe_depth.csv", "y", &y, title), 27);
  assert_int_equal(column("probe_depth.csv", "velocity_y", &v, title), 27);
  assert_string_equal(title, "velocity_y [m/s]");
  assert_int_equal(column("probe_depth.csv", "cover", &cover, title), 27);
  assert_int_equal(column("probe_depth.csv", "pressure", &p, title), 27);
  assert_string_equal(title, "pressure [Pa]");
  int dry = 0;
  for (int k = 0; k < 27; k++) {
    assert_near(y[k], 0.05 * k, 1e-12);
    dry += isnan(p[k]) && isnan(v[k]);
    assert_int_equal(isnan(p[k]), cover[k] < 0.15);
    if (y[k] >= 3 * dx && y[k] <= H - 3 * dx) {
      assert_near(p[k], rho0 * g * (H - y[k]), 0.01 * rho0 * g * H);
      assert_near(cover[k], 1, 0.01);
    }
  }
  assert_in_range(dry, 3, 6);
  sph_memory_free(y), sph_memory_free(p), sph_memory_free(cover), sph_memory_free(v);
}

/* A plane in a periodic box that lies partly outside of it: a constant is found, exactly. */
static void plane_of_a_constant(void **state)
{
  (void)state;
  double *value;
  char title[128];
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 3, .dx = 0.1, .periodic = {1, 1, 1}, .length = {0.8, 0.8, 0.8}});
  sph_group *gas = sph_group_box(sim, "gas", (double[3]){0}, (double[]){.8, .8, .8}, 1);
  sph_group_jitter(gas, 0.2, 1);
  sph_group_set_eos(gas, sph_eos_isothermal(1, 1));
  for (int d = 0; d < 3; d++) {
    double *v = sph_group_write(gas, "velocity", d), *x = sph_group_write(gas, "position", d);
    for (long i = 0; i < sph_group_count(gas); i++) v[i] = d + 2, x[i] += 0.8 * (double)(i % 3 - 1);
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_probe_def def = {.directory = directory,
                       .name = "plane",
                       .fields = "velocity",
                       .from = {-0.4, 0, 0.3},
                       .along = {1.6, 0, 0},
                       .across = {0, 0.4, 0.1},
                       .n = {5, 3}};
  write_once(sim, sph_output_probe(&def));
  for (int d = 0; d < 3; d++) {
    const char *const names[] = {"velocity_x", "velocity_y", "velocity_z"};
    assert_int_equal(column("probe_plane.csv", names[d], &value, title), 15);
    for (int k = 0; k < 15; k++) assert_near(value[k], d + 2, 1e-12);
    sph_memory_free(value);
  }
  assert_int_equal(column("probe_plane.csv", "cover", &value, title), 15);
  for (int k = 0; k < 15; k++) assert_near(value[k], 1, 0.1);
  sph_memory_free(value);
  assert_int_equal(column("probe_plane.csv", "z", &value, title), 15);
  assert_near(value[4], 0.3, 1e-12); /* the first edge first */
  assert_near(value[14], 0.4, 1e-12);
  sph_memory_free(value);
  char *text = slurp("probe_plane.csv");
  assert_memory_equal(text, "time [s],x [m],y [m],z [m],cover [1],velocity_x [m/s],", 50);
  free(text);
}

/* Surfaces at H and 1.4 H, and a drop of one particle above, which no gauge sees. */
static void gauges(void **state)
{
  (void)state;
  static const struct {
    double x, right;
  } at[] = {{0.4, 1}, {1.6, 1.4}, {0.6, 1}, {9, NAN}};
  sph_sim *sim = tank(1.4);
  const double drop_x = 0.6, drop_y = 1.3, *drop[] = {&drop_x, &drop_y};
  sph_group_add_points(sph_sim_group(sim, "water"), 1, drop, rho0);
  for (int k = 0; k < 4; k++) {
    const sph_monitor gauge = {.name = "h", .type = "gauge", .x = {at[k].x, -77}};
    double h = 0;
    sph_error error = {0};
    if (sph_monitor_value(&gauge, sim, &h, &error)) fail_msg("%s", error.text);
    assert_int_equal(isnan(h), isnan(at[k].right));
    if (!isnan(h)) assert_near(h, at[k].right, 0.02 * dx);
  }
  sph_sim_free(sim);
}

/* ---- in a run ---- */

static void add_all(sph_sim *sim)
{
  static const sph_monitor monitor = {.name = "wave", .type = "gauge", .x = {0.5}};
  static const sph_series_force force = {"walls", {1, 0.5}};
  static const double points[] = {0.5, 0.5, 0, 0.3, 1.5, 0};
  sph_sim_add_output(sim, sph_output_series_def(&(sph_series_def){.directory = directory,
                                                                  .interval = 0.004,
                                                                  .monitors = 1,
                                                                  .monitor = &monitor,
                                                                  .forces = 1,
                                                                  .force = &force,
                                                                  .powers = 1}));
  sph_sim_add_output(sim, sph_output_probe(&(sph_probe_def){.directory = directory,
                                                            .name = "two",
                                                            .interval = 0.003,
                                                            .points = 2,
                                                            .x = points}));
}

/* What falls pushes at the walls: momentum gained over the run is the integral of weight and force,
 * up to the trapezoidal rule over rows.  The state at the end has the bits of a run without. */
static void run_changes_nothing(void **state)
{
  (void)state;
  sph_sim *plain = tank(1.4), *sim = tank(1.4);
  double *t, *py, *f, *pk, *gk, *mass;
  char title[128];
  add_all(sim);
  if (sph_sim_run(plain, 0.1) != SPH_OK) fail_msg("%s", sph_sim_error(plain));
  if (sph_sim_run(sim, 0.1) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  for (int d = 0; d < 2; d++) {
    const sph_group *a = sph_sim_group(plain, "water"), *b = sph_sim_group(sim, "water");
    const size_t bytes = (size_t)sph_group_count(a) * sizeof(double);
    assert_memory_equal(sph_group_read(a, "position", d), sph_group_read(b, "position", d), bytes);
    assert_memory_equal(sph_group_read(a, "velocity", d), sph_group_read(b, "velocity", d), bytes);
  }
  sph_balance b;
  sph_sim_balance(sim, &b);
  sph_sim_free(plain), sph_sim_free(sim);
  long n = column("series.csv", "time", &t, title);
  assert_int_equal(column("series.csv", "momentum_y", &py, title), n);
  assert_int_equal(column("series.csv", "walls_force_y", &f, title), n);
  assert_string_equal(title, "walls_force_y [N/m]");
  assert_int_equal(column("series.csv", "pressure_kinetic", &pk, title), n);
  assert_string_equal(title, "pressure_kinetic [W/m]");
  assert_int_equal(column("series.csv", "gravity_kinetic", &gk, title), n);
  assert_int_equal(column("series.csv", "wave", &mass, title), n);
  double gained = 0, size = 0;
  for (long k = 1; k < n; k++) {
    gained += (t[k] - t[k - 1]) * (-g * b.mass - (f[k] + f[k - 1]) / 2);
    size += (t[k] - t[k - 1]) * fabs(f[k]);
    assert_near(gk[k], -g * py[k], 1e-9 * g * fabs(py[k]) + 1e-9);
    assert_near(mass[k], H, 0.2);
  }
  print_message("# momentum %g, by forces %g kg/s\n", py[n - 1] - py[0], gained);
  assert_near(py[n - 1] - py[0], gained, 0.01 * fabs(gained));
  assert_true(fabs(gained) > 0.01 * size);
  sph_memory_free(t), sph_memory_free(py), sph_memory_free(f);
  sph_memory_free(pk), sph_memory_free(gk), sph_memory_free(mass);
}

static int stop(void *ctx, sph_sim *sim)
{
  (void)ctx;
  return sph_sim_time(sim) > 0.05;
}

static void restart_leaves_no_gap(void **state)
{
  (void)state;
  char path[4096];
  char *series = slurp("series.csv"), *probe = slurp("probe_two.csv"); /* of the run before */
  for (int part = 0; part < 2; part++) {
    sph_sim *sim = tank(1.4);
    add_all(sim);
    sph_checkpoint_set(sim, &(sph_checkpoint_def){.directory = directory, .keep = 1});
    if (part == 0) sph_sim_set_progress(sim, stop, NULL);
    if (part == 1) {
      assert_int_equal(sph_checkpoint_find(directory, 0, path, sizeof path), 1);
      if (sph_checkpoint_read(sim, path)) fail_msg("%s", sph_sim_error(sim));
    }
    assert_int_equal(sph_sim_run(sim, 0.1), part ? SPH_OK : SPH_ERR_STOPPED);
    sph_sim_free(sim);
  }
  char *again = slurp("series.csv"), *probe_again = slurp("probe_two.csv");
  assert_string_equal(again, series);
  assert_string_equal(probe_again, probe);
  assert_non_null(strstr(probe, ",nan")); /* the second point is dry */
  free(series), free(probe), free(again), free(probe_again);
}

/* ---- what is refused ---- */

static void refuse(sph_output output, const char *why)
{
  sph_sim *sim = tank(1);
  sph_sim_add_output(sim, output);
  assert_true(sph_sim_run(sim, 0.01) < 0);
  if (!strstr(sph_sim_error(sim), why)) fail_msg("\"%s\" not in: %s", why, sph_sim_error(sim));
  sph_sim_free(sim);
}

static void mistakes(void **state)
{
  (void)state;
  static const sph_probe_def right = {.directory = directory, .name = "p", .from = {1, 0.5}};
  const double nowhere[] = {0, NAN, 0};
  static const sph_series_force force[] = {{"water", {0}}, {"wall", {0}}};
#define REFUSE(why, ...)                 \
  do {                                   \
    sph_probe_def def = right;           \
    __VA_ARGS__;                         \
    refuse(sph_output_probe(&def), why); \
  } while (0)
  REFUSE("has no field \"presure\"; did you mean 'pressure'?", def.fields = "presure");
  REFUSE("has no field \"temperature\"", def.fields = "density temperature");
  REFUSE("no fields", def.fields = " ");
  REFUSE("no fluid group \"walls\"", def.group = "walls");
  REFUSE("its places lie between x = 1000 and 1000 m", def.from[0] = 1000);
  REFUSE("along a line of no length", def.n[0] = 5);
  REFUSE("-3 x 1 places", def.n[0] = -3);
  REFUSE("2 points at NULL", def.points = 2);
  REFUSE("not finite", def.points = 1, def.x = nowhere);
  REFUSE("probe name \"a/b\"", def.name = "a/b");
  REFUSE("cannot", def.directory = "/proc/nowhere");
  refuse(sph_output_probe(NULL), "probe");
  for (int k = 0; k < 2; k++)
    refuse(sph_output_series_def(
               &(sph_series_def){.directory = directory, .forces = 1, .force = &force[k]}),
           k ? "there is no such group; right is a wall" : "it is a fluid; right is a wall");
  refuse(sph_output_series_def(&(sph_series_def){.directory = directory, .forces = 1}), "at NULL");
}

/* ---- in a case file ---- */

static const char case_head[] =
    "dimension: 1\nspacing: 0.02 m\ngroups:\n"
    "  water: {kind: fluid, density: 1000 kg/m^3, shapes: [box: {lower: [0 m], upper: [1 m]}],\n"
    "    eos: {linear: {sound_speed: 30 m/s}}, initial: {hydrostatic: {surface: 1 m, gravity: 10 "
    "m/s^2}}}\n"
    "  floor: {kind: wall, density: 1000 kg/m^3, shapes: [box: {lower: [-0.2 m], upper: [0 m]}]}\n"
    "terms: {continuity: {}, pressure: {}, gravity: {acceleration: [-10 m/s^2]}}\n"
    "run: {end: 0.01 s}\noutput:\n  series: 0.01 s\n";

/* The status of a run of the case with these outputs; why: of a failure. */
static int run_case(const char *outputs, sph_error *error)
{
  char text[4096];
  int n = snprintf(text, sizeof text, "%s%s\n", case_head, outputs);
  sph_case *c = sph_case_read_text("case.yml", text, (size_t)n, 0, NULL, error);
  sph_sim *sim = c ? sph_case_build(c, 1, error) : NULL;
  int status = error->status;
  if (sim) {
    sph_case_build_outputs(c, sim, directory, "");
    status = sph_sim_run(sim, sph_case_end(c));
    if (status) sph_error_set(error, status, "%s", sph_sim_error(sim));
  }
  sph_sim_free(sim);
  sph_case_free(c);
  return status;
}

static void case_file(void **state)
{
  (void)state;
  static const struct {
    const char *outputs, *why;
  } wrong[] = {{"  probes: {p: {fields: pressure}}", "case.yml:11:12: "},
               {"  probes: {p: {at: [0.1 m], line: {from: [0 m], to: [1 m], n: 3}}}",
                "probe p: found several places; exactly one"},
               {"  probes: {p: {points: []}}", "points"},
               {"  probes: {p: {line: {from: [0 m], to: [1 m], n: 1}}}", "must be from 2"},
               {"  probes: {p: {at: [100 m]}}", "all particles between"},
               {"  probes: {p: {at: [0 m], fields: presure}}", "did you mean 'pressure'?"},
               {"  forces: {water: {}}",
                "case.yml:11:12: forces: 'water' is a fluid; right is the name of a wall"},
               {"  forces: {flor: {}}", "forces: 'flor' is no group"}};
  sph_error error = {0};
  double *value;
  char title[128];
  if (run_case("  monitors: {h: {type: gauge}}\n  forces: {floor: {}}\n  powers: true\n"
               "  probes: {p: {points: [{at: [0.5 m]}, {at: [2 m]}], interval: 0.005 s},\n"
               "    q: {line: {from: [0.2 m], to: [0.8 m], n: 4}, fields: pressure}}",
               &error))
    fail_msg("%s", error.text);
  assert_int_equal(column("series.csv", "floor_force_x", &value, title), 2);
  assert_string_equal(title, "floor_force_x [N/m^2]");
  assert_near(value[0], -1000 * 10, 100);
  sph_memory_free(value);
  assert_int_equal(column("series.csv", "h", &value, title), 2);
  assert_near(value[1], 1, 0.001);
  sph_memory_free(value);
  assert_int_equal(column("probe_p.csv", "pressure", &value, title), 6);
  assert_near(value[4], 5000, 100);
  assert_true(isnan(value[5]));
  sph_memory_free(value);
  assert_int_equal(column("probe_q.csv", "pressure", &value, title), 8);
  for (int k = 0; k < 4; k++) assert_near(value[k], 8000 - 2000 * k, 100);
  sph_memory_free(value);
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    error = (sph_error){0};
    assert_true(run_case(wrong[k].outputs, &error) < 0);
    if (!strstr(error.text, wrong[k].why)) fail_msg("\"%s\" not in: %s", wrong[k].why, error.text);
  }
}

/* Two times of 3 x 2 places in a plane y = 5, a metre apart along z, two along x. */
static void planes_are_maps(void **state)
{
  (void)state;
  sph_error error = {0};
  FILE *file = fopen(in("plane.csv"), "w");
  fprintf(file, "time [s],x [m],y [m],z [m],p [Pa]\n");
  for (int k = 0; k < 12; k++)
    fprintf(file, "%d,%d,5,%d,%s\n%s", k / 6, 2 * (k % 3), k / 3 % 2, k == 8 ? "nan" : "1.5",
            k == 5 ? "\n" : "");
  fclose(file);
  char csv[FOLDER_MAX + 100];
  snprintf(csv, sizeof csv, "%s", in("plane.csv"));
  int status = sph_plot_plane(csv, "p", 2, in("plane.png"), &error);
  assert_true(status == SPH_OK || status == SPH_ERR_UNBUILT); /* the script is there */
  char *script = slurp("plane.gp");
  assert_non_null(strstr(script, "set ylabel 'z [m]'"));
  assert_non_null(strstr(script, "set xlabel 'x [m]'"));
  assert_non_null(strstr(script, "cell_x = 1.04/length"));
  assert_non_null(strstr(script, "cell_y = 0.52/length"));
  char *data = slurp("plane.dat");
  assert_non_null(strstr(data, "t = 1 s"));
  assert_non_null(strstr(data, "\n4 1 1.5\n"));
  assert_non_null(strstr(data, "\n4 0 nan\n"));
  free(script);
  free(data);
  error = (sph_error){0};
  assert_int_equal(sph_plot_plane(csv, "p", 17, in("plane.png"), &error), SPH_ERR_ARGUMENT);
  file = fopen(csv, "a");
  fprintf(file, "2,0,5,0,1\n");
  fclose(file);
  error = (sph_error){0};
  assert_int_equal(sph_plot_plane(csv, "p", 1, in("plane.png"), &error), SPH_ERR_FILE);
  assert_non_null(strstr(error.text, "13 rows, 6 at the first time"));
  assert_int_equal(sph_plot_plane(NULL, "p", 1, in("plane.png"), NULL), SPH_ERR_ARGUMENT);
}

/* Maps of a field that is known: its numbers at the places of the plane, at each time asked for. */
static void maps_have_the_numbers_of_a_field(void **state)
{
  (void)state;
  sph_error error = {0};
  char csv[FOLDER_MAX + 100];
  FILE *file = fopen(in("field.csv"), "w");
  fprintf(file, "time [s],x [m],y [m],p [Pa]\n");
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 4; j++)
      for (int i = 0; i < 5; i++)
        fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", 0.5 * k, 0.1 * i, 0.2 * j,
                1000 * (0.6 - 0.2 * j) * (1 + k) + 7 * i);
  fclose(file);
  snprintf(csv, sizeof csv, "%s", in("field.csv"));
  const double times[] = {0.9, 0.1, 0.6};
  int status = sph_plot_plane_at(csv, "p", times, 3, in("field.png"), &error);
  assert_true(status == SPH_OK || status == SPH_ERR_UNBUILT);
  char *data = slurp("field.dat"), *rest = NULL;
  int rows = 0, frame = -1;
  static const int order[] = {2, 0, 1};
  for (char *line = strtok_r(data, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
    double t, x, y, p;
    if (sscanf(line, "# t = %lf s", &t) == 1) {
      assert_in_range(++frame, 0, 2);
      assert_near(t, 0.5 * order[frame], 1e-12);
      assert_int_equal(rows, 20 * frame);
    } else if (frame >= 0 && sscanf(line, "%lf %lf %lf", &x, &y, &p) == 3) {
      assert_near(x, 0.1 * (rows % 5), 1e-6);
      assert_near(y, 0.2 * (rows / 5 % 4), 1e-6);
      assert_near(p, 1000 * (0.6 - y) * (1 + order[frame]) + 70 * x, 1e-2);
      rows++;
    }
  }
  assert_int_equal(rows, 60);
  free(data);
  assert_int_equal(sph_plot_plane_at(csv, "p", NULL, 3, in("field.png"), NULL), SPH_ERR_ARGUMENT);
}

static int make(void **state)
{
  (void)state;
  return folder_make(directory, "probes");
}

static int clean(void **state)
{
  (void)state;
  return folder_remove(directory);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(pressure_over_depth),
                                     cmocka_unit_test(plane_of_a_constant),
                                     cmocka_unit_test(gauges),
                                     cmocka_unit_test(run_changes_nothing),
                                     cmocka_unit_test(restart_leaves_no_gap),
                                     cmocka_unit_test(mistakes),
                                     cmocka_unit_test(planes_are_maps),
                                     cmocka_unit_test(maps_have_the_numbers_of_a_field),
                                     cmocka_unit_test(case_file)};
  return cmocka_run_group_tests_name("probes", tests, make, clean);
}
