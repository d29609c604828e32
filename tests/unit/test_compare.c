/* Distances between curves, against values that are known without the code. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "case_curve.h"
#include "folder.h"
#include "sphode.h"

enum { RUN = 1001, POINTS = 7 };

/* A run y = x^2 on [0, 10]; a reference with the same law, late by `late`, above by `above`. */
static double run_x[RUN], run_y[RUN], ref_x[POINTS], ref_y[POINTS];
static const sph_case_curve run = {RUN, run_x, run_y}, reference = {POINTS, ref_x, ref_y};

static void make(double late, double above)
{
  for (int k = 0; k < RUN; k++) {
    run_x[k] = 0.01 * k;
    run_y[k] = run_x[k] * run_x[k];
  }
  for (int k = 0; k < POINTS; k++) {
    ref_x[k] = 1 + k;
    ref_y[k] = (ref_x[k] - late) * (ref_x[k] - late) + above;
  }
}

static sph_case_distance plain(const char *norm)
{
  return (sph_case_distance){.norm = norm,
                             .window = {-INFINITY, INFINITY},
                             .up_to = INFINITY,
                             .threshold = 0.5};
}

static void compare(sph_case_distance *d)
{
  sph_error error = {0};
  assert_int_equal(sph_case_curve_compare(&run, &reference, d, &error), SPH_OK);
}

static void near(double found, double expected, double tolerance)
{
  if (!(fabs(found - expected) <= tolerance))
    fail_msg("%.12g, expected %.12g +- %g", found, expected, tolerance);
}

static void a_constant_distance_is_found_by_all_norms(void **state)
{
  static const char *const norms[] = {"rms", "l1", "max"};
  (void)state;
  make(0, 0.25);
  for (int k = 0; k < 3; k++) {
    sph_case_distance d = plain(norms[k]);
    compare(&d);
    near(d.value, 0.25, 1e-9);
    near(d.unshifted, d.value, 0);
    assert_int_equal(d.used, POINTS);
    near(d.largest, 49.25, 1e-12);
  }
}

/* One point off by 7: rms 7/sqrt 7, l1 1, max 7. */
static void norms_differ_as_they_should(void **state)
{
  (void)state;
  make(0, 0);
  ref_y[3] += 7;
  sph_case_distance rms = plain("rms"), l1 = plain("l1"), max = plain("max");
  compare(&rms);
  compare(&l1);
  compare(&max);
  near(rms.value, sqrt(7), 1e-9);
  near(l1.value, 1, 1e-9);
  near(max.value, 7, 1e-9);
}

/* Weight: time.  Points at 1, 2, 3, 3.1, 3.2, 7: the middle ones stand for little time; the one at
 * 3.2 that is off by 7 for (7 - 3.1)/2 of 6. */
static void points_count_for_their_time(void **state)
{
  static const double crowded[POINTS] = {1, 2, 3, 3.1, 3.2, 7, 7};
  (void)state;
  make(0, 0);
  for (int k = 0; k < POINTS; k++) ref_x[k] = crowded[k], ref_y[k] = ref_x[k] * ref_x[k];
  ref_y[4] += 7;
  sph_case_distance rms = plain("rms"), l1 = plain("l1");
  rms.by_time = l1.by_time = 1;
  compare(&rms);
  compare(&l1);
  near(rms.value, 7 * sqrt(1.95 / 6), 1e-6);
  near(l1.value, 7 * 1.95 / 6, 1e-6);
  rms.window[0] = 3.15, rms.window[1] = 3.25; /* one point alone */
  compare(&rms);
  near(rms.value, 7, 1e-6);
}

static void the_offset_is_found_and_told(void **state)
{
  (void)state;
  make(0.3141, 0);
  sph_case_distance d = plain("rms");
  d.offset = 0.5;
  compare(&d);
  near(d.shift, 0.3141, 1e-4);
  assert_true(d.value < 1e-3);
  /* Without: mean of (x^2 - (x - t)^2)^2 over x = 1 ... 7. */
  double sum = 0;
  for (int x = 1; x <= 7; x++) sum += pow(x * x - (x - 0.3141) * (x - 0.3141), 2);
  near(d.unshifted, sqrt(sum / 7), 1e-6);
}

static void an_offset_is_never_negative_nor_too_large(void **state)
{
  (void)state;
  make(-0.2, 0);
  sph_case_distance d = plain("rms");
  d.offset = 0.5;
  compare(&d);
  near(d.shift, 0, 1e-6);
  near(d.value, d.unshifted, 1e-5);
  make(0.8, 0);
  d = plain("rms");
  d.offset = 0.5;
  compare(&d);
  near(d.shift, 0.5, 1e-6);
}

static void windows_choose_the_points(void **state)
{
  (void)state;
  make(0, 0);
  ref_y[6] = 1e6;
  sph_case_distance d = plain("max");
  d.up_to = 36;
  compare(&d);
  near(d.value, 0, 1e-9);
  assert_int_equal(d.used, 6);
  near(d.largest, 36, 1e-12);
  d = plain("max");
  d.window[0] = 1.5;
  d.window[1] = 3.5;
  compare(&d);
  assert_int_equal(d.used, 2);
  near(d.largest, 9, 1e-12);
}

static void a_run_that_is_too_short_says_so(void **state)
{
  (void)state;
  make(0, 0);
  sph_case_distance d = plain("rms");
  sph_error error = {0};
  const sph_case_curve first_half = {351, run_x, run_y}; /* to x = 3.5 */
  assert_int_equal(sph_case_curve_compare(&first_half, &reference, &d, &error), SPH_OK);
  assert_int_equal(d.used, 3);
  assert_int_equal(d.wanted, POINTS);
  const sph_case_curve nothing = {0, run_x, run_y};
  d = plain("rms");
  assert_int_equal(sph_case_curve_compare(&nothing, &reference, &d, &error), SPH_OK);
  assert_true(isnan(d.value) && d.used == 0);
}

static void a_run_without_a_value_is_not_near(void **state)
{
  (void)state;
  make(0, 0);
  for (int k = 250; k < 350; k++) run_y[k] = NAN; /* around one point of the reference */
  static const char *const norms[] = {"rms", "l1", "max"};
  for (int k = 0; k < 3; k++) {
    sph_case_distance d = plain(norms[k]);
    d.offset = 0.5;
    compare(&d);
    assert_true(isnan(d.value));
  }
}

/* The mean of x^2 over [x - w/2, x + w/2] is x^2 + w^2/12. */
static void the_moving_average_is_the_mean(void **state)
{
  double integral[RUN];
  (void)state;
  make(0, 0);
  sph_case_curve_integrate(&run, integral);
  near(sph_case_curve_mean(&run, integral, 5, 1.5), 25 + 1.5 * 1.5 / 12, 1e-4);
  near(sph_case_curve_mean(&run, integral, 5.0037, 0), 5.0037 * 5.0037, 1e-4);
  near(sph_case_curve_mean(&run, integral, 0, 1), 0.25 / 3, 1e-4); /* cut at the start */
  near(sph_case_curve_mean(&run, integral, -3, 0), 0, 0);
}

static void the_mean_of_a_plateau(void **state)
{
  (void)state;
  make(0, 0);
  const sph_case_curve none = {0, NULL, NULL};
  sph_error error = {0};
  sph_case_distance d = plain("mean");
  d.window[0] = 2;
  d.window[1] = 4;
  d.one = 9; /* the mean of x^2 over 2 ... 4 is 28/3 */
  assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
  near(d.value, 1.0 / 3, 1e-4);
  near(d.largest, 9, 0);
  d.window[1] = 12; /* the run ends at 10 */
  assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
  assert_true(isnan(d.value));
}

static void the_arrival_is_the_first_passage(void **state)
{
  (void)state;
  make(0.5, 0); /* passes 4 at x = 2, the reference between 2 (2.25) and 3 (6.25) */
  sph_case_distance d = plain("arrival");
  d.threshold = 4;
  compare(&d);
  double expected = 2 + (4 - 2.25) / 4;
  near(d.largest, expected, 1e-12);
  near(d.value, expected - 2, 1e-9);
  d.threshold = 1e9;
  compare(&d);
  assert_true(isnan(d.value) && d.used == 0);
}

/* exp(-0.3 x) cos(2 pi x/1.7 + 0.4): period and rate whatever the phase; noise around zero makes no
 * passages. */
static void period_and_decay_of_a_swing(void **state)
{
  const sph_case_curve none = {0, ref_x, ref_y};
  sph_error error = {0};
  (void)state;
  make(0, 0);
  for (int noisy = 0; noisy < 2; noisy++) {
    for (int k = 0; k < RUN; k++)
      run_y[k] = exp(-0.3 * run_x[k]) *
                 (cos(2 * M_PI * run_x[k] / 1.7 + 0.4) + noisy * 0.03 * (k % 2 ? 1 : -1));
    sph_case_distance d = plain("period");
    d.one = 1.5;
    assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
    near(d.found, 1.7, noisy ? 5e-3 : 1e-4);
    near(d.value, 0.2, noisy ? 5e-3 : 1e-4);
    assert_true(d.used == 1 && d.wanted == 1 && d.largest == 1.5);
    d = plain("decay");
    d.one = 0.3;
    assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
    near(d.value, 0, noisy ? 5e-3 : 2e-4);
    d.window[1] = 1.5; /* less than two swings */
    assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
    assert_true(isnan(d.value) && d.used == 0);
  }
}

/* 2 exp(-0.3 x), and the same below zero; not where it passes through zero once. */
static void decay_without_zeros(void **state)
{
  const sph_case_curve none = {0, ref_x, ref_y};
  sph_error error = {0};
  (void)state;
  make(0, 0);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < RUN; i++)
      run_y[i] = (k == 1 ? -1 : k == 2 && run_x[i] > 2 ? -1 : 1) * 2 * exp(-0.3 * run_x[i]);
    sph_case_distance d = plain("decay");
    d.one = 0.25;
    assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
    if (k == 2)
      assert_true(isnan(d.value) && d.used == 0);
    else
      near(d.value, 0.05, 1e-12);
  }
}

static void the_drift_is_the_largest_change(void **state)
{
  const sph_case_curve none = {0, ref_x, ref_y};
  sph_error error = {0};
  (void)state;
  make(0, 0); /* y = x^2 */
  for (int k = 0; k < RUN; k++) run_y[k] = 5 - fabs(run_x[k] - 3) + 3;
  sph_case_distance d = plain("drift"); /* 5 at the start, 8 at x = 3, 1 at the end */
  assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
  near(d.value, 4, 1e-12);
  d.window[1] = 4;
  assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
  near(d.value, 3, 1e-12);
  run_y[10] = NAN;
  assert_int_equal(sph_case_curve_compare(&run, &none, &d, &error), SPH_OK);
  assert_true(isnan(d.value) && d.used == 0);
}

static void weights_count(void **state)
{
  const double a[] = {1, 2, 3}, b[] = {1, 2, 5}, w[] = {1, 1, 2};
  (void)state;
  near(sph_case_curve_norm("l1", 3, w, a, b), 1, 1e-15);
  near(sph_case_curve_norm("rms", 3, w, a, b), sqrt(2), 1e-15);
  near(sph_case_curve_norm("l1", 3, NULL, a, b), 2.0 / 3, 1e-15);
  assert_true(isnan(sph_case_curve_norm("l1", 0, NULL, a, b)));
}

/* A whole comparison: files in a directory, a case beside its table. */
static void write_text(const char *path, const char *text)
{
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static void files_are_read_and_scaled(void **state)
{
  static const char text[] =
      "dimension: 2\nspacing: 1 cm\nparameters: {a: 0.5 m, T: 2 s}\n"
      "groups: {w: {kind: fluid, density: 1, eos: {tait: {sound_speed: 1}}, shapes:\n"
      "  [{box: {lower: [0, 0], upper: [1, 1]}}]}}\n"
      "terms: {pressure: }\nrun: {end: 1}\n"
      "compare:\n"
      "  - {name: n, quantity: front, reference: {csv: {file: ref.csv}}, norm: max,\n"
      "     time_scale: T, value_scale: a, divide_by: largest - 1, bar: 0.06}\n";
  char directory[FOLDER_MAX], path[FOLDER_MAX + 20];
  sph_error error = {0};
  sph_comparison *list;
  int n;
  (void)state;
  assert_int_equal(folder_make(directory, "compare"), 0);
  snprintf(path, sizeof path, "%s/series.csv", directory);
  write_text(path, "# a comment\ntime [s],front [m]\n0,0.5\n2,1\n4,1.5\n"); /* scaled: x, 1 + x */
  snprintf(path, sizeof path, "%s/ref.csv", directory);
  write_text(path, "t,z\n0.5,1.5\n1,2\n2,3.1\n"); /* off by 0.1 of 3.1 - 1 */
  snprintf(path, sizeof path, "%s/case.yml", directory);
  sph_case *c = sph_case_read_text(path, text, strlen(text), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  assert_int_equal(sph_case_compare(c, NULL, directory, &list, &n, &error), SPH_OK);
  assert_int_equal(n, 1);
  near(list[0].value, 0.1 / 2.1, 1e-12);
  assert_true(list[0].pass && list[0].bar == 0.06);
  sph_case_compare_free(list, n);
  sph_case_free(c);
  assert_int_equal(folder_remove(directory), 0);
}

/* ---- solutions in space: a wave of amplitude e, compared with one of another amplitude */

#define WAVE                                                                             \
  "dimension: 1\nspacing: 0.025\nspeed: 3\nkernel: {name: cubic-spline, h_over_dx: 2}\n" \
  "periodic: {axes: [x], lower: [0], upper: [1]}\n"                                      \
  "groups: {w: {kind: fluid, density: 2, shapes: [{box: {lower: [0], upper: [1]}}],\n"   \
  "  eos: {linear: {sound_speed: 3}}, initial: {velocity: [3e-6*cos(2*pi*x)],\n"         \
  "  pressure: 18e-6*cos(2*pi*x)}}}\n"                                                   \
  "terms: {continuity: {form: c1}, pressure: {form: s}}\nrun: {end: 1/3}\n"              \
  "output: {snapshots: 1/12}\ncompare:\n"
#define REFERENCE "reference: {wave: {density: 2, sound_speed: 3, length: 1, amplitude: "

typedef struct wave_run {
  sph_case *c;
  sph_sim *sim;
  char directory[FOLDER_MAX];
} wave_run;

static wave_run run_wave(const char *text)
{
  sph_error error = {0};
  wave_run w;
  assert_int_equal(folder_make(w.directory, "compare"), 0);
  w.c = sph_case_read_text("wave.yml", text, strlen(text), 0, NULL, &error);
  w.sim = w.c ? sph_case_build(w.c, 1, &error) : NULL;
  if (!w.sim) fail_msg("%s", error.text);
  sph_case_build_outputs(w.c, w.sim, w.directory, NULL);
  if (sph_sim_run(w.sim, sph_case_end(w.c))) fail_msg("%s", sph_sim_error(w.sim));
  return w;
}

static void end_wave(wave_run *w)
{
  sph_sim_free(w->sim);
  sph_case_free(w->c);
  assert_int_equal(folder_remove(w->directory), 0);
}

/* A wave of amplitude e against none: rms e/sqrt 2, mean 2 e/pi, largest e; at every time, from
 * snapshots and from the end. */
static void fields_are_compared_at_several_times(void **state)
{
  static const char text[] =
      WAVE "  - {name: v, quantity: velocity, value_scale: 3e-6, norm: rms, at: [0, 1/12, 1/3],\n"
           "     " REFERENCE "0}}}\n"
           "  - {name: p, quantity: pressure, value_scale: 18e-6, norm: max, at: [1/6],\n"
           "     " REFERENCE "0}}}\n"
           "  - {name: l1, quantity: velocity_x, value_scale: 3e-6, norm: l1,\n"
           "     " REFERENCE "2e-6}}}\n"
           "  - {name: part, quantity: density, value_scale: 2e-6, norm: l1, at: [0],\n"
           "     window: [0, 0.1], " REFERENCE "0}}}\n"
           "  - {name: itself, quantity: density, value_scale: 2e-6, norm: max, at: [0],\n"
           "     " REFERENCE "1e-6}}}\n";
  const double pi = 3.14159265358979323846;
  sph_error error = {0};
  sph_comparison *list;
  char path[FOLDER_MAX + 20];
  int n;
  (void)state;
  wave_run w = run_wave(text);
  if (sph_case_compare(w.c, w.sim, w.directory, &list, &n, &error)) fail_msg("%s", error.text);
  assert_int_equal(n, 5);
  near(list[0].value, sqrt(0.5), 1e-6); /* the start is the largest */
  assert_non_null(strstr(list[0].note, "at 0 s, "));
  assert_non_null(strstr(list[0].note, "at 0.333 s"));
  near(list[1].value, 1, 0.03);     /* a crest between particles, and what time steps lose */
  near(list[2].value, 2 / pi, 0.1); /* 2 e - e, and what the lattice is late */
  double expected = 0;              /* four particles, below x = 0.1 */
  for (int k = 0; k < 4; k++) expected += cos(2 * pi * 0.025 * (k + 0.5)) / 4;
  near(list[3].value, expected, 1e-5);
  near(list[4].value, 0, 1e-9);
  snprintf(path, sizeof path, "%s/compare_0.csv", w.directory);
  FILE *table = fopen(path, "r");
  assert_non_null(table);
  fclose(table);
  sph_case_compare_free(list, n);
  end_wave(&w);
}

/* Dust of 3 m/s in a gas of 1 m/s, compared with both at 1 m/s: alone and together. */
static void one_fluid_of_several_is_compared(void **state)
{
#define STREAMS                                                                 \
  "reference: {dusty-box: {coefficient: 0, fluid: {density: 2, velocity: 1},\n" \
  "  dust: {density: 2, velocity: 1}}}, at: [0, 1/12, 1/3]}\n"
  static const char text[] =
      "dimension: 1\nspacing: 0.025\nperiodic: {axes: [x], lower: [0], upper: [1]}\n"
      "groups: {dust: {kind: fluid, density: 2, shapes: [{box: {lower: [0], upper: [1]}}],\n"
      "  eos: {dust: }, initial: {velocity: [3]}}, gas: {kind: fluid, density: 2,\n"
      "  shapes: [{box: {lower: [0], upper: [1]}}], eos: {linear: {sound_speed: 3}},\n"
      "  initial: {velocity: [1]}}}\n"
      "terms: {continuity: , pressure: , drag: {coefficient: 0}}\nrun: {end: 1/3}\n"
      "output: {snapshots: 1/12}\ncompare:\n"
      "  - {name: gas, quantity: velocity, group: gas, " STREAMS
      "  - {name: dust, quantity: velocity, group: dust, " STREAMS
      "  - {name: both, quantity: velocity, " STREAMS;
#undef STREAMS
  const double right[] = {0, 2, sqrt(2)};
  sph_error error = {0};
  sph_comparison *list;
  int n;
  (void)state;
  wave_run w = run_wave(text);
  if (sph_case_compare(w.c, w.sim, w.directory, &list, &n, &error)) fail_msg("%s", error.text);
  assert_int_equal(n, 3);
  for (int k = 0; k < n; k++) near(list[k].value, right[k], 1e-9);
  sph_case_compare_free(list, n);
  end_wave(&w);
}

static void refused(const char *comparison, const char *part)
{
  char text[2000];
  sph_error error = {0};
  sph_comparison *list;
  int n;
  snprintf(text, sizeof text, "%s%s", WAVE, comparison);
  wave_run w = run_wave(text);
  assert_true(sph_case_compare(w.c, w.sim, w.directory, &list, &n, &error) < 0);
  if (!strstr(error.text, part)) fail_msg("found '%s', expected '%s'", error.text, part);
  end_wave(&w);
}

static void what_cannot_be_compared_is_told(void **state)
{
  (void)state;
  refused("  - {name: v, quantity: velocity, at: [0.1], " REFERENCE "0}}}\n",
          "at: there is no snapshot at t = 0.1 s, the nearest is at 0.0833333 s; see output: "
          "snapshots");
  refused("  - {name: v, quantity: kinetic, norm: mean, at: [0.1], reference: {value: 0}}\n",
          "at: belongs to solutions in space");
  refused("  - {name: v, quantity: colour, " REFERENCE "0}}}\n", "no such field");
  refused("  - {name: v, quantity: sound_speed, " REFERENCE "0}}}\n",
          "a wave has density, velocity, pressure");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_constant_distance_is_found_by_all_norms),
      cmocka_unit_test(norms_differ_as_they_should),
      cmocka_unit_test(the_offset_is_found_and_told),
      cmocka_unit_test(an_offset_is_never_negative_nor_too_large),
      cmocka_unit_test(windows_choose_the_points),
      cmocka_unit_test(a_run_that_is_too_short_says_so),
      cmocka_unit_test(a_run_without_a_value_is_not_near),
      cmocka_unit_test(points_count_for_their_time),
      cmocka_unit_test(the_moving_average_is_the_mean),
      cmocka_unit_test(the_mean_of_a_plateau),
      cmocka_unit_test(the_arrival_is_the_first_passage),
      cmocka_unit_test(period_and_decay_of_a_swing),
      cmocka_unit_test(decay_without_zeros),
      cmocka_unit_test(the_drift_is_the_largest_change),
      cmocka_unit_test(weights_count),
      cmocka_unit_test(files_are_read_and_scaled),
      cmocka_unit_test(fields_are_compared_at_several_times),
      cmocka_unit_test(one_fluid_of_several_is_compared),
      cmocka_unit_test(what_cannot_be_compared_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
