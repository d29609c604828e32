/* Cases made of several files, and numbers over time: what is included and joined, tables against
 * the functions that they were made from, walls and forces that follow them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "case_schema.h"
#include "folder.h"
#include "group_data.h"
#include "near.h"
#include "sphode.h"

static char folder[FOLDER_MAX];

static const char *in_folder(const char *name)
{
  static char path[FOLDER_MAX + 40];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void put(const char *name, const char *text)
{
  FILE *f = fopen(in_folder(name), "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static sph_case *read_case(const char *name)
{
  sph_error error = {0};
  sph_case *c = sph_case_read(in_folder(name), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  return c;
}

/* The message without the folder, which is DIR in it. */
static void refused(const char *name, const char *says)
{
  sph_error error = {0};
  char text[1000];
  const char *dir = strstr(says, "DIR");
  if (dir) {
    snprintf(text, sizeof text, "%.*s%s%s", (int)(dir - says), says, folder, dir + 3);
    says = text;
  }
  sph_case *c = sph_case_read(in_folder(name), 0, NULL, &error);
  sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
  assert_null(sim);
  sph_case_free(c);
  if (strncmp(error.text, folder, strlen(folder)) != 0 ||
      strncmp(error.text + strlen(folder) + 1, says, strlen(says)) != 0)
    fail_msg("%s\nwanted %s", error.text, says);
}

static const char water[] =
    "# a preset\n"
    "parameters: {rho: 1000 kg/m^3, c: 10 m/s}\n"
    "groups:\n"
    "  water: {kind: fluid, density: rho, viscosity: 1 mPa s, eos: {tait: {sound_speed: c}}}\n"
    "terms:\n  continuity:\n  pressure:\n  viscosity-artificial: {alpha: 0.1}\n";
static const char rest[] =
    "dimension: 2\nspacing: 0.1\n"
    "groups: {water: {density: 900, shapes: [{box: {lower: [0, 0], upper: [1, 1]}}]}}\n"
    "terms: {viscosity-artificial: {beta: 2}, gravity: {acceleration: [0, -1]}}\n"
    "run: {end: 1}\ntitle: \"a \\\"joined\\\": case\"\n";

static void files_are_joined_and_the_later_wins(void **state)
{
  char text[1000];
  (void)state;
  put("water.yml", water);
  snprintf(text, sizeof text, "include: water.yml\n%s", rest);
  put("a.yml", text);
  sph_case *c = read_case("a.yml");
  const sph_case_node *g = sph_case_reader_find(sph_case_reader_find(c->root, "groups"), "water");
  const sph_case_node *v =
      sph_case_reader_find(sph_case_reader_find(c->root, "terms"), "viscosity-artificial");
  assert_true(sph_case_reader_number(g, "density", 0) == 900);
  assert_true(sph_case_reader_number(g, "viscosity", 0) == 1e-3);
  assert_true(sph_case_reader_number(v, "alpha", 0) == 0.1);
  assert_true(sph_case_reader_number(v, "beta", 0) == 2);
  assert_null(sph_case_reader_find(c->root, "include"));
  /* The text that goes into results is that of all files, and reads as the same case. */
  sph_error error = {0};
  const char *joined = sph_case_text(c);
  sph_case *again = sph_case_read_text("elsewhere.yml", joined, strlen(joined), 0, NULL, &error);
  if (!again) fail_msg("%s\n%s", error.text, joined);
  assert_string_equal(sph_case_title(again), "a \"joined\": case");
  assert_string_equal(sph_case_title(c), sph_case_title(again));
  assert_null(strstr(joined, "include"));
  sph_sim *one = sph_case_build(c, 1, &error), *other = sph_case_build(again, 1, &error);
  assert_true(one && other);
  assert_true(sph_group_viscosity(sph_sim_group(other, "water")) == 1e-3);
  assert_int_equal(sph_group_count(sph_sim_group(one, "water")), 100);
  sph_sim_free(one), sph_sim_free(other);
  sph_case_free(again), sph_case_free(c);
}

static void lists_of_files_in_their_order(void **state)
{
  (void)state;
  put("one.yml", "parameters: {a: 1, b: 2}\nkernel: {name: cubic-spline}\n");
  put("two.yml", "include: one.yml\nparameters: {a: 3}\n");
  put("three.yml",
      "parameters: {b: a + 1, d: 7}\ngroups: {water: {eos: {linear: {sound_speed: 20}}}}\n");
  char text[1000];
  snprintf(text, sizeof text, "include: [water.yml, two.yml, three.yml]\nparameters: {d: 8}\n%s",
           rest);
  put("list.yml", text);
  sph_case *c = read_case("list.yml");
  static const char *const names[] = {"rho", "c", "a", "b", "d"};
  static const double values[] = {1000, 10, 3, 4, 8};
  assert_int_equal(c->n, 5);
  for (int k = 0; k < 5; k++) {
    assert_string_equal(c->names[k].name, names[k]);
    assert_true(c->names[k].value == values[k]);
  }
  /* Exactly one equation of state belongs there: another one takes its place. */
  const sph_case_node *eos =
      sph_case_reader_find(sph_case_reader_find(sph_case_reader_find(c->root, "groups"), "water"),
                           "eos");
  assert_string_equal(eos->first->key, "linear");
  assert_null(eos->first->next);
  sph_case_free(c);
}

static void what_is_wrong_is_told_in_its_file(void **state)
{
  (void)state;
  put("wrong.yml", "terms:\n  viscosity-artificial: {alpha: 1 m}\n");
  put("w.yml", "include: [a.yml, wrong.yml]\n");
  put("n.yml", "dimension: 2\ninclude: nowhere.yml\n");
  put("self.yml", "include: self.yml\n");
  put("to.yml", "\ninclude: [fro.yml]\n");
  put("fro.yml", "include: to.yml\n");
  put("list-is.yml", "include: alist.yml\n");
  put("alist.yml", "- 1\n");
  put("map.yml", "include: {a: b}\n");
  put("broken.yml", "include: yaml.yml\n");
  put("yaml.yml", "a: [1\n");
  refused("w.yml", "wrong.yml:2:33: alpha: found m, wanted a plain number");
  refused("n.yml", "n.yml:2:10: include: ");
  refused("self.yml", "self.yml:1:10: include: ");
  refused("to.yml", "fro.yml:1:10: include: ");
  refused("list-is.yml", "alist.yml:1:1: wanted a mapping");
  refused("map.yml", "map.yml:1:10: include: wanted the name of a file");
  refused("broken.yml", "yaml.yml:2:1: not YAML");
  const char *const set[] = {"include=water.yml"};
  sph_error error = {0};
  assert_null(sph_case_read(in_folder("a.yml"), 1, set, &error));
  assert_non_null(strstr(error.text, "--set cannot bring it"));
}

/* ---- tables */

/* A case with a wall and a force that follow a table; end of the run 2 s. */
static const char moved[] =
    "dimension: 2\nspacing: 0.1\nparameters: {w: 2 1/s}\n"
    "tables: {push: {file: push.csv%s}}\n"
    "groups:\n"
    "  water: {kind: fluid, density: 1000, eos: {linear: {sound_speed: 10}}, shapes: [{box: "
    "{lower: [0, 0], upper: [1, 1]}}]}\n"
    "  piston: {kind: wall, density: 1000, shapes: [{box: {lower: [3, 0], upper: [3.3, 1]}}],\n"
    "    boundary: {motion: {displacement: [%s, 0 m]}}}\n"
    "terms: {continuity: , pressure: , body-force: {acceleration: [%s, 0]}}\nrun: {end: 2}\n";

static void write_moved(const char *more, const char *displacement, const char *force)
{
  char text[2000];
  snprintf(text, sizeof text, moved, more, displacement, force);
  put("moved.yml", text);
}

/* 40 rows of sin(2 t) in millimetres, at times in milliseconds, 0 ... 2 pi/2. */
static void write_table(void)
{
  FILE *f = fopen(in_folder("push.csv"), "w");
  assert_non_null(f);
  fprintf(f, "# a sine\nt [ms],other,x [mm]\n");
  for (int k = 0; k <= 40; k++)
    fprintf(f, "%.17g,7,%.17g\n", 1e3 * M_PI * k / 40, k == 40 ? 0 : 1e3 * sin(2 * M_PI * k / 40));
  fclose(f);
}

/* Where the piston is at t, its velocity and acceleration, by its boundary. */
static void motion_at(const sph_sim *sim, double t, double x[3])
{
  double displacement[3], velocity[3], acceleration[3];
  const sph_boundary *b = &sph_sim_group(sim, "piston")->boundary;
  b->motion(b->ctx, t, displacement, velocity, acceleration);
  x[0] = displacement[0], x[1] = velocity[0], x[2] = acceleration[0];
  assert_true(displacement[1] == 0 && velocity[1] == 0);
}

static sph_sim *build_moved(void)
{
  sph_error error = {0};
  sph_case *c = read_case("moved.yml");
  sph_sim *sim = sph_case_build(c, 1, &error);
  if (!sim) fail_msg("%s", error.text);
  sph_case_free(c); /* its tables live on */
  return sim;
}

static void walls_follow_expressions(void **state)
{
  double x[3];
  (void)state;
  write_table();
  write_moved("", "0.3 m + 0.2 m*sin(w*t)", "0");
  sph_sim *sim = build_moved();
  for (double t = 0; t < 2; t += 0.17) {
    motion_at(sim, t, x);
    assert_near(x[0], 0.2 * sin(2 * t), 1e-15);
    assert_near(x[1], 0.4 * cos(2 * t), 1e-10);
    assert_near(x[2], -0.8 * sin(2 * t), 1e-5);
  }
  sph_sim_free(sim);
}

/* A wall that turns and whose surface is warmed, by expressions. */
static const char drum[] =
    "dimension: 2\nspacing: 0.1\nparameters: {w: 2 1/s}\n"
    "groups:\n"
    "  water: {kind: fluid, density: 1000, energy: temperature, specific_heat: 4000, conductivity: "
    "1,\n"
    "    eos: {linear: {sound_speed: 10}}, initial: {temperature: 300 K},\n"
    "    shapes: [{box: {lower: [0, 0], upper: [1, 1]}}]}\n"
    "  drum: {kind: wall, density: 1000, shapes: [{box: {lower: [3, 0], upper: [3.3, 1]}}],\n"
    "    boundary: {temperature: %s,\n"
    "      motion: {velocity: [1, 0], rotation: {centre: [3, 0], %s}}}}\n"
    "terms: {continuity: , pressure: , conduction: }\nrun: {end: 2}\n";

static void write_drum(const char *temperature, const char *rotation)
{
  char text[2000];
  snprintf(text, sizeof text, drum, temperature, rotation);
  put("moved.yml", text);
}

static void walls_turn(void **state)
{
  double turn[3], T[2];
  const double at[2][2] = {{1, 2}, {3, 4}}, *const x[3] = {at[0], at[1]};
  (void)state;
  write_drum("300 K + 5 K/m*x*sin(w*t)", "angle: 30 deg + 1*sin(w*t)");
  sph_sim *sim = build_moved();
  const sph_boundary *b = &sph_sim_group(sim, "drum")->boundary;
  assert_true(b->centre[0] == 3 && b->centre[1] == 0 && b->axis[2] == 1);
  for (double t = 0; t < 2; t += 0.17) {
    b->rotation(b->ctx, t, turn);
    assert_near(turn[0], sin(2 * t), 1e-15);
    assert_near(turn[1], 2 * cos(2 * t), 1e-10);
    assert_near(turn[2], -4 * sin(2 * t), 1e-5);
    b->temperature_at(b->ctx, t, 2, x, T);
    assert_near(T[0], 300 + 5 * sin(2 * t), 1e-12);
    assert_near(T[1], 300 + 10 * sin(2 * t), 1e-12);
  }
  sph_sim_free(sim);
  write_drum("310 K", "angular_velocity: -w");
  sim = build_moved();
  b = &sph_sim_group(sim, "drum")->boundary;
  b->rotation(b->ctx, 1.5, turn);
  assert_true(turn[0] == -3 && turn[1] == -2 && turn[2] == 0);
  assert_true(!b->temperature_at && b->temperature == 310);
  sph_sim_free(sim);
  write_drum("310 K", "angle: 1/t");
  refused("moved.yml", "moved.yml:10:68: angle: found 1/s, wanted a plain number");
  write_drum("-w*3 K*1 s", "angle: t*w");
  refused("moved.yml", "moved.yml:9:29: temperature: found -6 K; must be > 0");
  write_drum("310 K", "angle: t*w, axis: [1, 0]");
  refused("moved.yml", "moved.yml:10:73: rotation: the axis is z in 2D; leave it out");
  write_drum("310 K", "angle: t*w, angular_velocity: w");
  refused("moved.yml", "moved.yml:10:61: rotation: found both angular_velocity and angle");
}

static void walls_follow_tables(void **state)
{
  double x[3];
  (void)state;
  write_table();
  write_moved(", column: x, outside: repeat", "push", "0");
  sph_sim *sim = build_moved();
  for (double t = 0; t < 9; t += 0.17) { /* a period is pi */
    motion_at(sim, t, x);
    assert_near(x[0], sin(2 * t), 5e-6); /* (pi/40)^4 2^4/384: that of a cubic spline */
    assert_near(x[1], 2 * cos(2 * t), 5e-4);
    assert_near(x[2], -4 * sin(2 * t), 2e-2);
  }
  sph_sim_free(sim);
  write_moved(", column: x, interpolation: linear", "2*push", "0");
  sim = build_moved();
  const double between = 2 * sin(2 * M_PI * 3 / 40), behind = 2 * sin(2 * M_PI * 4 / 40);
  motion_at(sim, M_PI * 3.25 / 40, x);
  assert_near(x[0], 0.75 * between + 0.25 * behind, 1e-12);
  assert_near(x[1], (behind - between) / (M_PI / 40), 1e-8);
  motion_at(sim, 100, x); /* it stays where it was last */
  assert_near(x[0], 0, 1e-12);
  assert_near(x[1], 0, 1e-12);
  sph_sim_free(sim);
}

static void forces_follow_tables(void **state)
{
  (void)state;
  write_table();
  write_moved(", column: x, unit: 1 m/s^2", "0 m", "w*w*x + push*3");
  sph_sim *sim = build_moved();
  const sph_group *g = sph_sim_group(sim, "water");
  for (int step = 0; step < 2; step++) {
    if (step && sph_sim_run(sim, 0.05)) fail_msg("%s", sph_sim_error(sim));
    if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
    const double t = sph_sim_time(sim);
    double mean = 0, wanted = 0;
    for (long i = 0; i < 100; i++) {
      mean += sph_group_rate(g, "velocity", 0)[i] / 100;
      wanted += (4 * sph_group_read(g, "position", 0)[i] + 3 * 1e3 * sin(2 * t)) / 100;
    }
    assert_near(mean, wanted, 1e-6 * fmax(1, fabs(wanted))); /* pressures act in pairs */
  }
  sph_sim_free(sim);
}

static void tables_that_are_none(void **state)
{
  static const struct {
    const char *csv, *more, *displacement, *says;
  } bad[] = {
      {"t,x\n0,0\n1,1\n", ", unit: 1 s", "push", "moved.yml:8:"},
      {"t,x\n0,0\n0,1\n", "", "push",
       "moved.yml:4:23: DIR/push.csv: row 2 is of t = 0, the one before it of 0; times that rise"},
      {"t,x\n0,0\n", "", "push",
       "moved.yml:4:23: DIR/push.csv: a table of 1 row; right is 2 or more"},
      {"t,x\n0,0\n1,a\n", "", "push",
       "moved.yml:4:23: DIR/push.csv:3: \"a\" in column 2 is not a number"},
      {"t,x\n0,0\n1\n", "", "push", "moved.yml:4:23: DIR/push.csv:3: it has no column 2"},
      {"0,0\n1,1\n", "", "push",
       "moved.yml:4:23: DIR/push.csv:1: found numbers; the first line names the columns"},
      {"", "", "push", "moved.yml:4:23: DIR/push.csv: an empty table"},
      {"t;x\n0;0\n1;1\n", "", "push",
       "moved.yml:4:23: DIR/push.csv:1: columns with a semicolon between them; right are commas"},
      {"t\tx\n0\t0\n1\t1\n", "", "push",
       "moved.yml:4:23: DIR/push.csv:1: columns with a tabulator between them; right are commas"},
      {"t,x\n0,0\n0,5,1,2\n", "", "push",
       "moved.yml:4:23: DIR/push.csv:3: it has 4 columns, the first line names 2"},
      {"t,x\n0,0\n1,inf\n", "", "push",
       "moved.yml:4:23: DIR/push.csv: row 2 holds 1, inf; finite numbers are right"},
      {"t [m],x\n0,0\n1,1\n", "", "push",
       "moved.yml:4:23: DIR/push.csv: the column 't [m]' is no time; s, ms, min are right"},
      {"t [K s],x\n0,0\n1,1\n", "", "push",
       "moved.yml:4:23: DIR/push.csv: the column 't [K s]' is no time"},
      {"t,x [foo]\n0,0\n1,1\n", "", "push",
       "moved.yml:4:23: DIR/push.csv: unit of the column 'x [foo]': 'foo' is not a unit"},
      {"t,x\n0,0\n1,1\n", ", outside: repeat", "push",
       "moved.yml:4:23: DIR/push.csv: begins with 0, ends with 1; with outside: repeat"},
      {"t,x\n0,0\n1,1\n", ", column: y", "push",
       "moved.yml:4:23: DIR/push.csv: no column \"y\" among t,x"},
      {"t,x\n0,0\n1,1\n", ", outside: zero", "push",
       "moved.yml:4:42: outside: found 'zero'; known: hold, repeat"},
      {"t,x\n0,0\n1,1\n", "", "w*x",
       "moved.yml:8:42: displacement: 'x' is not known here; right is an expression in t"},
      {"t,x\n0,0\n1,1\n", "", "1 m, 1 m", "moved.yml:8:39: displacement: found 3 values"},
      {"t,x\n0,0\n1,1\n", "", "log(t/1 s)*1 m",
       "moved.yml:8:25: displacement: not finite at t = 0"},
  };
  (void)state;
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    put("push.csv", bad[k].csv);
    write_moved(bad[k].more, bad[k].displacement, "0");
    refused("moved.yml", bad[k].says);
  }
  char line[9000]; /* longer than any table's */
  snprintf(line, sizeof line, "t,x\n0,0\n1,%0*d\n", 8500, 1);
  put("push.csv", line);
  write_moved("", "push", "0");
  refused("moved.yml", "moved.yml:4:23: DIR/push.csv:3: a line of more than 8190 characters");
  put("push.csv", "t,x\n0,0\n1,1\n");
  put("moved.yml",
      "dimension: 2\nspacing: push*1 m\ntables: {push: {file: push.csv}}\n"); /* no number */
  refused("moved.yml", "moved.yml:2:10: spacing: 'push' is no parameter");
}

static int make_folder(void **state)
{
  (void)state;
  return folder_make(folder, "case-files");
}

static int remove_folder(void **state)
{
  (void)state;
  return folder_remove(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(files_are_joined_and_the_later_wins),
      cmocka_unit_test(lists_of_files_in_their_order),
      cmocka_unit_test(what_is_wrong_is_told_in_its_file),
      cmocka_unit_test(walls_follow_expressions),
      cmocka_unit_test(walls_turn),
      cmocka_unit_test(walls_follow_tables),
      cmocka_unit_test(forces_follow_tables),
      cmocka_unit_test(tables_that_are_none),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
