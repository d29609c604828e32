/* Shapes of case files: each key is the shape of sphode/shape.h that it says, and boxes on a
 * lattice are full. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "folder.h"
#include "near.h"
#include "sphode.h"

static char folder[FOLDER_MAX];

static sph_sim *built(int dim, const char *water, const char *tank)
{
  char text[2000], path[FOLDER_MAX + 20];
  sph_error error = {0};
  snprintf(path, sizeof path, "%s/a.yml", folder);
  snprintf(text, sizeof text,
           "dimension: %d\nspacing: 0.1\ngroups:\n  water: {kind: fluid, density: 1000, eos: "
           "{linear: {sound_speed: "
           "10}}, %s}\n  tank: {kind: wall, density: 1000, %s}\nterms: {continuity: , pressure: "
           "}\nrun: {end: 1}\n",
           dim, water, tank);
  sph_case *c = sph_case_read_text(path, text, strlen(text), 0, NULL, &error);
  sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
  if (!sim) fail_msg("%s: %s", water, error.text);
  sph_case_free(c);
  return sim;
}

/* Is each place of the lattice a particle of the group exactly where `inside` says? */
static void check(sph_sim *sim, const char *name, int (*inside)(const double *x))
{
  const sph_group *g = sph_sim_group(sim, name);
  const int dim = sph_sim_dim(sim), n = 40;
  long wanted = 0;
  for (int k = 0; k < (dim == 3 ? n * n * n : n * n); k++) {
    const double x[] = {0.1 * (k % n - n / 2 + 0.5), 0.1 * (k / n % n - n / 2 + 0.5),
                        dim == 3 ? 0.1 * (k / n / n - n / 2 + 0.5) : 0};
    wanted += inside(x);
  }
  for (long i = 0; i < sph_group_count(g); i++) {
    double x[3] = {0};
    for (int d = 0; d < dim; d++) x[d] = sph_group_read(g, "position", d)[i];
    if (!inside(x)) fail_msg("%s: a particle at (%g %g %g)", name, x[0], x[1], x[2]);
  }
  assert_int_equal(sph_group_count(g), wanted);
  assert_true(wanted > 10);
}

static int in_box(const double *x, double lo, double hi)
{
  return x[0] > lo && x[0] < hi && x[1] > lo && x[1] < hi;
}
static int with_hole(const double *x)
{
  return in_box(x, 0, 1) && hypot(x[0] - 0.5, x[1] - 0.5) > 0.3;
}
/* Three layers around the box, below 0.7. */
static int around(const double *x)
{
  const double a = fmax(fmax(-x[0], x[0] - 1), 0), b = fmax(fmax(-x[1], x[1] - 1), 0);
  return !in_box(x, 0, 1) && hypot(a, b) < 0.3 && x[1] < 0.7;
}
static int drop(const double *x) { return hypot(x[0] + 1, x[1] - 0.5) < 0.45; }
static int diamond(const double *x) { return fabs(x[0]) + fabs(x[1]) < 1.02; }
static int triangle(const double *x) { return x[0] > 0 && x[1] > 0 && x[0] + x[1] < 1.02; }

static void shapes_in_2d(void **state)
{
  (void)state;
  sph_sim *sim = built(
      2,
      "shapes: [difference: [{box: {lower: [0, 0], upper: [1, 1]}}, {ball: {centre: [0.5, 0.5], "
      "radius: 0.3}}]]",
      "shapes: [intersection: [{shell: {of: {box: {lower: [0, 0], upper: [1, 1]}}, thickness: "
      "0.3}}, "
      "{half_space: {point: [0, 0.7], normal: [0, 2]}}]]");
  check(sim, "water", with_hole);
  check(sim, "tank", around);
  sph_sim_free(sim);
  sim = built(2,
              "shapes: [translate: {by: [-1, 0.5], of: {scale: {factor: 3, of: {ball: {centre: [0, "
              "0], radius: 0.15}}}}}]",
              "shapes: [polygon: {corners: [[0, 0], [1.02, 0], [0, 1.02]]}]");
  check(sim, "water", drop);
  check(sim, "tank", triangle);
  sph_sim_free(sim);
  sim = built(2,
              "shapes: [rotate: {angle: 45 deg, of: {box: {lower: [-1.02/sqrt(2), -1.02/sqrt(2)], "
              "upper: [1.02/sqrt(2), 1.02/sqrt(2)]}}}]",
              "shapes: [union: [{polygon: {corners: [[0, 0], [1.02, 0], [0, 1.02]]}}]]");
  check(sim, "water", diamond);
  sph_sim_free(sim);
}

static int tube(const double *x) { return hypot(x[1], x[2]) < 0.5 && x[0] > 0 && x[0] < 1; }
static int funnel(const double *x)
{
  return hypot(x[1], x[2]) < 1 - x[0] / 2 && x[0] > 0 && x[0] < 1;
}
static int wedge(const double *x)
{
  return x[1] > -1 && x[1] < 1 && x[0] > 0 && x[2] > 0 && x[0] + x[2] < 1.02;
}
static int cube(const double *x) { return in_box(x, 0, 1) && x[2] > 0 && x[2] < 1; }

static void shapes_in_3d(void **state)
{
  char path[FOLDER_MAX + 20];
  (void)state;
  snprintf(path, sizeof path, "%s/cube.obj", folder);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  for (int k = 0; k < 8; k++)
    fprintf(f, "v %d %d %d\n", 1000 * (k & 1), 500 * (k & 2), 250 * (k & 4));
  fputs("f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n", f);
  fclose(f);
  sph_sim *sim =
      built(3, "shapes: [cylinder: {from: [0, 0, 0], to: [1, 0, 0], radius: 0.5}]",
            "shapes: [cone: {from: [0, 0, 0], to: [1, 0, 0], radius: 1, radius_to: 0.5}]");
  check(sim, "water", tube);
  check(sim, "tank", funnel);
  sph_sim_free(sim);
  sim =
      built(3, "shapes: [surface: {file: cube.obj, unit: 1 mm}]",
            "shapes: [prism: {corners: [[0, 0], [1.02, 0], [0, 1.02]], axis: y, from: -1, to: 1}]");
  check(sim, "water", cube);
  check(sim, "tank", wedge);
  sph_sim_free(sim);
}

/* A periodic box has whole cells, so the lattice goes on in its images; walls take the kernel's
 * support. */
static void boxes_on_a_lattice(void **state)
{
  (void)state;
  sph_sim *sim = built(2, "lattice: hexagonal, shapes: [box: {lower: [0, 0], upper: [1, 2]}]",
                       "shapes: [shell: {of: {box: {lower: [0, 0], upper: [1, 2]}}}]");
  const sph_group *g = sph_sim_group(sim, "water");
  const long n = sph_group_count(g);
  double mass = 0, most = 0;
  for (long i = 0; i < n; i++) {
    mass += sph_group_read(g, "mass", 0)[i];
    most = fmax(most, sph_group_read(g, "position", 1)[i]);
  }
  assert_int_equal(n, 9 * 11 * 2); /* 1/(1.0746 dx) and 2/(1.8612 dx) rounded, two in a cell */
  assert_near(mass, 2000, 1e-9);
  assert_near(2 - most, 0.25 * 2 / 11, 1e-9);
  assert_int_equal(sph_group_count(sph_sim_group(sim, "tank")),
                   2 * 3 * 30 + 4 * 8); /* h = 1.5 dx: three layers */
  sph_sim_free(sim);
}

static int make_folder(void **state)
{
  (void)state;
  return folder_make(folder, "case-shapes");
}

static int remove_folder(void **state)
{
  (void)state;
  return folder_remove(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_in_2d),
      cmocka_unit_test(shapes_in_3d),
      cmocka_unit_test(boxes_on_a_lattice),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
