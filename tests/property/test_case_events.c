/* Events of case files: what each key becomes, what a change changes, and the rows and frames that
 * are left of them. */
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
#include "near.h"
#include "sim_data.h"
#include "sphode.h"

/* A block that falls in the box of a wall, too far away to be felt. */
static const char head[] =
    "dimension: 2\nspacing: 0.1\nparameters: {g: 10 m/s^2}\n"
    "groups:\n"
    "  block: {kind: fluid, density: 1000, eos: {tait: {sound_speed: 10}}, viscosity: 1,\n"
    "    scales: {velocity: 3 m/s, density: 20},\n"
    "    shapes: [{box: {lower: [0, 1], upper: [0.4, 1.4]}}]}\n"
    "  gate: {kind: wall, density: 1000, shapes: [{box: {lower: [9, 9], upper: [9.5, 9.5]}}],\n"
    "    boundary: {motion: {velocity: [1, 2]}}}\n"
    "  belt: {kind: wall, density: 1000, shapes: [{box: {lower: [-9, 9], upper: [-8, 9.5]}}],\n"
    "    boundary: {motion: {velocity: [1, 0], slide: true}}}\n"
    "terms: {continuity: , pressure: , viscosity-laminar: , gravity: {acceleration: [0, -g]},\n"
    "  viscosity-artificial: {alpha: 0.02, beta: 0.3}, viscosity-signal: {alpha: 0.5, beta: 2},\n"
    "  delta: {model: molteni, delta: 0.1}, xsph: {epsilon: 0.5}, harmonic: {omega: 0}}\n"
    "integrator: {controller: pi}\nrun: {end: 1}\noutput: {snapshots: 1, series: 0.5}\n";

static sph_case *read_case(const char *events)
{
  char text[4000];
  sph_error error = {0};
  snprintf(text, sizeof text, "%sevents:\n%s", head, events);
  sph_case *c = sph_case_read_text("case.yml", text, strlen(text), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  return c;
}

static sph_sim *build(const sph_case *c)
{
  sph_error error = {0};
  sph_sim *sim = sph_case_build(c, 1, &error);
  if (!sim) fail_msg("%s", error.text);
  return sim;
}

static void keys_become_events(void **state)
{
  static const char events[] =
      "  a: {when: {front: {at: 30 cm, axis: y, group: block}}, direction: falling, once: true}\n"
      "  b: {when: {wet: [1, 2]}, snapshot: true}\n"
      "  c: {when: {dry: [3, 4]}, stop: true}\n"
      "  d: {when: {energy: {quantity: kinetic, level: 5 J/m}}, samples: 7}\n"
      "  e: {when: {energy: {level: 6}}, direction: rising}\n"
      "  f: {when: {steady: 20 Hz}}\n"
      "  g: {when: {time: 4 ms}}\n";
  static const struct {
    const char *name, *group, *quantity;
    int direction, axis, samples, once, snapshot, stop;
    double threshold, x[2];
  } row[] = {
      {"a", "block", "total", -1, 1, 0, 1, 0, 0, 0.3, {0, 0}},
      {"b", NULL, "total", 1, 0, 0, 0, 1, 0, 0, {1, 2}},
      {"c", NULL, "total", -1, 0, 0, 0, 0, 1, 0, {3, 4}},
      {"d", NULL, "kinetic", 0, 0, 7, 0, 0, 0, 5, {0, 0}},
      {"e", NULL, "total", 1, 0, 0, 0, 0, 0, 6, {0, 0}},
      {"f", NULL, "total", -1, 0, 0, 0, 0, 0, 20, {0, 0}},
      {"g", NULL, "total", 1, 0, 0, 0, 0, 0, 0.004, {0, 0}},
  };
  (void)state;
  sph_case *c = read_case(events);
  sph_sim *sim = build(c);
  sph_case_free(c); /* the simulation needs it no more */
  assert_int_equal(sim->watches, 7);
  for (int k = 0; k < 7; k++) {
    const sph_watch *w = &sim->watch[k];
    assert_string_equal(w->name, row[k].name);
    assert_int_equal(w->direction, row[k].direction);
    assert_int_equal(w->event.axis, row[k].axis);
    assert_int_equal(w->event.samples, row[k].samples);
    assert_int_equal(w->event.once, row[k].once);
    assert_int_equal(w->event.snapshot, row[k].snapshot);
    assert_int_equal(w->event.stop, row[k].stop);
    assert_true(fabs(w->event.threshold - row[k].threshold) < 1e-15);
    assert_true(w->event.x[0] == row[k].x[0] && w->event.x[1] == row[k].x[1]);
    assert_true(!!w->event.group == !!row[k].group);
    assert_string_equal(w->event.quantity, row[k].quantity);
  }
  assert_string_equal(sim->integrator_def.controller, "pi");
  assert_int_equal(sph_sim_run(sim, 0.01), SPH_OK);
  assert_true(sim->scale[0][SPH_VELOCITY] == 3 && sim->scale[0][SPH_DENSITY] == 20);
  assert_true(sim->scale[0][SPH_POSITION] == sph_sim_h(sim));
  sph_sim_free(sim);
}

/* Terms keep what is not changed; walls go on from where they are. */
static void changes(void **state)
{
  static const char events[] =
      "  a: {when: {time: 0.1}, change: {gravity: [1, 2], harmonic: 3 Hz, xsph: 0.25,\n"
      "    viscosity-artificial: 0.04, viscosity-signal: 0.75, delta: 0.2,\n"
      "    walls: {gate: {velocity: [0, -4]}, belt: {velocity: [2, 0], slide: true}}}}\n"
      "  b: {when: {time: 0.2}, change: {gravity: [0, 0], groups: {block: {viscosity: 3}}, walls: "
      "{gate: {velocity: [0, 0]}}}}\n";
  (void)state;
  sph_case *c = read_case(events);
  sph_sim *sim = build(c);
  sph_case_free(c);
  const sph_group *gate = sph_sim_group(sim, "gate"), *belt = sph_sim_group(sim, "belt");
  const double x0 = sph_group_read(gate, "position", 0)[0];
  const double y0 = sph_group_read(gate, "position", 1)[0];
  const double x1 = sph_group_read(belt, "position", 0)[0];
  assert_int_equal(sph_sim_run(sim, 0.15), SPH_OK);
  const sph_term_set *t = &sim->terms;
  assert_true(t->g[0] == 1 && t->g[1] == 2 && t->epsilon == 0.25 && t->delta == 0.2);
  assert_true(t->alpha == 0.04 && t->beta == 0.3);
  assert_true(t->signal_alpha == 0.75 && t->signal_beta == 2);
  assert_true(t->bits & SPH_MOLTENI);
  int harmonic = 0;
  for (int k = 0; k < t->called; k++)
    harmonic += !strcmp(t->call[k].name, "harmonic") && t->call[k].term.omega == 3;
  assert_int_equal(harmonic, 1);
  assert_near(sph_group_read(gate, "position", 0)[0] - x0, 0.1, 1e-12);
  assert_near(sph_group_read(gate, "position", 1)[0] - y0, 0.2 - 4 * 0.05, 1e-12);
  assert_true(sph_group_read(gate, "velocity", 1)[0] == -4);
  assert_true(sph_group_read(belt, "position", 0)[0] == x1);
  assert_true(sph_group_read(belt, "velocity", 0)[0] == 2);
  assert_true(sph_group_viscosity(sph_sim_group(sim, "block")) == 1);
  if (sph_sim_run(sim, 0.3)) fail_msg("%s", sph_sim_error(sim));
  assert_true(sph_group_viscosity(sph_sim_group(sim, "block")) == 3);
  assert_true(t->g[0] == 0 && t->g[1] == 0 && t->epsilon == 0.25);
  assert_near(sph_group_read(gate, "position", 1)[0] - y0, 0.2 - 4 * 0.1, 1e-12);
  sph_sim_free(sim);
}

static char directory[] = "/tmp/sphode-events-XXXXXX";

static const char *in(const char *name)
{
  static char path[100];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  return path;
}

static double cell(const char *file, const char *column, long row, long *rows)
{
  sph_error error = {0};
  double *value;
  char title[128];
  if (sph_csv_read(in(file), column, 0, &value, rows, title, &error)) fail_msg("%s", error.text);
  assert_true(row < *rows);
  double v = value[row];
  sph_memory_free(value);
  return v;
}

/* The block falls by 0.3 and then moves on uniformly, by 0.2 to the stop. */
static void files_of_a_run(void **state)
{
  static const char events[] =
      "  off: {when: {front: {at: 1.1, axis: y}}, direction: falling, snapshot: true,\n"
      "    change: {gravity: [0, 0]}}\n"
      "  end: {when: {front: {at: 0.9, axis: y}}, direction: falling, stop: true}\n"
      "  never: {when: {wet: [5, 5]}}\n";
  const double t1 = sqrt(2 * 0.3 / 10), t2 = t1 + 0.2 / (10 * t1);
  long rows;
  (void)state;
  sph_case *c = read_case(events);
  sph_sim *sim = build(c);
  sph_case_build_outputs(c, sim, directory, NULL);
  if (sph_sim_run(sim, sph_case_end(c))) fail_msg("%s", sph_sim_error(sim));
  assert_string_equal(sph_sim_stopped_by(sim), "end");
  assert_near(sph_sim_time(sim), t2, 1e-9);
  assert_near(cell("events.csv", "time", 0, &rows), t1, 1e-9);
  assert_int_equal(rows, 2);
  assert_near(cell("events.csv", "time", 1, &rows), t2, 1e-9);
  assert_near(cell("events.csv", "value", 1, &rows), 0.9, 1e-9);
  assert_true(cell("events.csv", "step", 1, &rows) > cell("events.csv", "step", 0, &rows));
  assert_near(cell("series.csv", "time", 1, &rows), t1, 1e-9);
  assert_int_equal(rows, 2);
  char text[4000];
  sph_summary_text(text, sizeof text, sim, NULL, NULL, 0);
  assert_non_null(strstr(text, "events       off: 1 time, at 0.2449489"));
  assert_non_null(strstr(text, "             never: 0 times\n"));
  assert_non_null(strstr(text, "stopped by   end\n"));
  sph_error error = {0};
  assert_int_equal(sph_plot_count(directory, &error), 2); /* the start and `off` */
  sph_sim_free(sim);
  sph_case_free(c);
}

static int set_up(void **state)
{
  (void)state;
  return mkdtemp(directory) ? 0 : -1;
}

static int tear_down(void **state)
{
  char command[100];
  (void)state;
  snprintf(command, sizeof command, "rm -r %s", directory);
  return system(command);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(keys_become_events),
      cmocka_unit_test(changes),
      cmocka_unit_test(files_of_a_run),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
