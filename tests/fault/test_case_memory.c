/* Every allocation of reading and building a case, and of comparing a run with an exact solution,
 * fails once, the k-th for every k: the answer is "out of memory", and nothing leaks (run under
 * valgrind or with -fsanitize=address). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "failing.h"
#include "folder.h"
#include "sphode.h"

static const char text[] =
    "dimension: 2\nspacing: 5 cm\nparameters: {H: 0.2 m, T: 2 s}\n"
    "groups:\n"
    "  water: {kind: fluid, density: 1000, eos: {tait: {sound_speed: 10}}, shapes:\n"
    "    [{box: {lower: [0, 0], upper: [H, H]}}], initial: {velocity: [x/T, -y/T]}}\n"
    "  tank: {kind: wall, density: 1000, packing: {iterations: 2}, shapes: [{layers: {lower: [0, "
    "0], upper: [H, H]}},\n"
    "    {shell: {thickness: 5 cm, of: {translate: {by: [2*H, 0], of: {difference: [\n"
    "      {polygon: {corners: [[0, 0], [H, 0], [0, H]]}}, {ball: {centre: [0, 0], radius: "
    "H/2}}]}}}}}],\n"
    "    boundary: {motion: {velocity: [1, 0], slide: true}}}\n"
    "terms: {continuity: , pressure: , gravity: {acceleration: [0, -1]}}\nrun: {end: 1}\n"
    "events: {e: {when: {front: {at: 1, group: water}}, change: {gravity: [0, 0],\n"
    "  walls: {tank: {velocity: [0, 0]}}}}}\n"
    "compare: [{name: n, quantity: front, norm: mean, reference: {value: 1}}]\n";

/* Whether the case was read and its simulation made. */
static int read_and_build(sph_error *error)
{
  const char *const set[] = {"spacing=H/4", "kernel.h_over_dx=1.3"};
  sph_case *c = sph_case_read_text("case.yml", text, strlen(text), 2, set, error);
  sph_sim *sim = c ? sph_case_build(c, 1, error) : NULL;
  int made = sim != NULL;
  sph_sim_free(sim);
  sph_case_free(c);
  return made;
}

static void every_allocation_may_fail(void **state)
{
  (void)state;
  for (fail_at = 1;; fail_at++) {
    sph_error error = {0};
    calls = 0;
    int made = read_and_build(&error);
    if (calls < fail_at) {
      if (!made) fail_msg("%s", error.text);
      break;
    }
    if (made) fail_msg("allocation %ld failed, and nobody told", fail_at);
    if (!strstr(error.text, "out of memory")) fail_msg("allocation %ld: %s", fail_at, error.text);
  }
  assert_true(fail_at > 100);
}

static void put(const char *directory, const char *name, const char *content)
{
  char path[FOLDER_MAX + 20];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(content, file);
  fclose(file);
}

/* A case of two files, with a table that a wall and a force follow. */
static void every_allocation_of_joined_files_may_fail(void **state)
{
  char directory[FOLDER_MAX], path[FOLDER_MAX + 20];
  (void)state;
  fail_at = 0;
  assert_int_equal(folder_make(directory, "memory"), 0);
  put(directory, "t.csv", "t,x\n0,0\n1,1\n2,1\n");
  put(directory, "b.yml",
      "dimension: 1\nspacing: 1\nrun: {end: 1}\ntables: {x_w: {file: t.csv}}\ngroups:\n"
      "  w: {kind: fluid, density: 1, eos: {linear: {sound_speed: 1}}, shapes: [{box: {lower: "
      "[0],\n"
      "    upper: [4]}}]}\n");
  put(directory, "a.yml",
      "include: [b.yml]\nterms: {continuity: , pressure: , body-force: {acceleration: [x_w]}}\n"
      "scalars: {dye: {diffusivity: 1, source: -dye*x_w, walls: {t: {value: 1}}}}\n"
      "groups: {t: {kind: wall, density: 1, shapes: [{box: {lower: [-4], upper: [0]}}],\n"
      "  boundary: {motion: {displacement: [x_w*1 m]}}}}\n");
  snprintf(path, sizeof path, "%s/a.yml", directory);
  for (fail_at = 1;; fail_at++) {
    sph_error error = {0};
    calls = 0;
    sph_case *c = sph_case_read(path, 0, NULL, &error);
    sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
    const int made = sim != NULL;
    sph_sim_free(sim);
    sph_case_free(c);
    if (calls < fail_at) {
      if (!made) fail_msg("%s", error.text);
      break;
    }
    if (made) fail_msg("allocation %ld failed, and nobody told", fail_at);
    if (!strstr(error.text, "out of memory")) fail_msg("allocation %ld: %s", fail_at, error.text);
  }
  assert_true(fail_at > 100);
  fail_at = 0;
  assert_int_equal(folder_remove(directory), 0);
}

static void every_allocation_of_a_surface_may_fail(void **state)
{
  char directory[FOLDER_MAX], path[FOLDER_MAX + 20];
  (void)state;
  fail_at = 0;
  assert_int_equal(folder_make(directory, "memory"), 0);
  snprintf(path, sizeof path, "%s/a.obj", directory);
  put(directory, "a.obj",
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  for (fail_at = 1;; fail_at++) {
    sph_error error = {0};
    calls = 0;
    sph_shape *s = sph_shape_surface(path, 1, 0, &error);
    s = s ? sph_shape_shell(sph_shape_union(1, &s, &error), 0.1, 1, 0.1, &error) : NULL;
    sph_shape_free(s);
    if (calls < fail_at) {
      if (!s) fail_msg("%s", error.text);
      break;
    }
    if (s) fail_msg("allocation %ld failed, and nobody told", fail_at);
    if (!strstr(error.text, "out of memory")) fail_msg("allocation %ld: %s", fail_at, error.text);
  }
  assert_true(fail_at > 12);
  fail_at = 0;
  assert_int_equal(folder_remove(directory), 0);
}

/* Compared at a snapshot and at the end. */
static void every_allocation_of_a_comparison_may_fail(void **state)
{
  static const char wave[] =
      "dimension: 1\nspacing: 0.1\nperiodic: {axes: [x], lower: [0], upper: [1]}\n"
      "groups: {w: {kind: fluid, density: 1, eos: {linear: {sound_speed: 1}},\n"
      "  shapes: [{box: {lower: [0], upper: [1]}}]}}\n"
      "terms: {continuity: , pressure: }\nrun: {end: 0.02}\noutput: {snapshots: 0.01}\n"
      "compare: [{name: n, quantity: velocity, at: [0.01, 0.02], reference:\n"
      "  {wave: {density: 1, sound_speed: 1, length: 1, amplitude: 0}}},\n"
      "  {name: p, quantity: kinetic, norm: period, reference: {value: 1}}]\n";
  char directory[FOLDER_MAX];
  sph_error error = {0};
  sph_comparison *list;
  int n, status = SPH_OK;
  (void)state;
  fail_at = 0;
  assert_int_equal(folder_make(directory, "memory"), 0);
  sph_case *c = sph_case_read_text("case.yml", wave, strlen(wave), 0, NULL, &error);
  sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
  if (!sim) fail_msg("%s", error.text);
  sph_case_build_outputs(c, sim, directory, NULL);
  if (sph_sim_run(sim, sph_case_end(c))) fail_msg("%s", sph_sim_error(sim));
  for (fail_at = 1;; fail_at++) {
    error = (sph_error){0};
    calls = 0;
    status = sph_case_compare(c, sim, directory, &list, &n, &error);
    if (calls < fail_at) break;
    if (!status) fail_msg("allocation %ld failed, and nobody told", fail_at);
    if (!strstr(error.text, "out of memory")) fail_msg("allocation %ld: %s", fail_at, error.text);
    assert_null(list);
  }
  if (status) fail_msg("%s", error.text);
  assert_true(list[0].value == 0 && fail_at > 10);
  fail_at = 0;
  sph_case_compare_free(list, n);
  sph_sim_free(sim);
  sph_case_free(c);
  assert_int_equal(folder_remove(directory), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_allocation_may_fail),
      cmocka_unit_test(every_allocation_of_joined_files_may_fail),
      cmocka_unit_test(every_allocation_of_a_surface_may_fail),
      cmocka_unit_test(every_allocation_of_a_comparison_may_fail),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
