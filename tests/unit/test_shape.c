/* Shapes: the foot of each point lies on the surface, surfaces of triangles are the bodies that
 * they were made from, lattices have their neighbours and their density, and what is cut along a
 * surface loses nothing and has nothing twice. */
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
#include "shape_mesh.h"
#include "sphode.h"

static double uniform(double from, double to)
{
  return from + (to - from) * (rand() / (RAND_MAX + 1.0));
}

/* ---- shapes in closed form */

static const double corner[][2] = {{0, 0}, {0.8, 0}, {0.8, 0.6}, {0.3, 0.2}, {0, 0.5}};

static sph_shape *exact_shape(int k, sph_error *e)
{
  static const double lo[] = {0.1, 0.2, -0.3}, hi[] = {0.9, 0.7, 0.6}, c[] = {0.4, 0.5, 0.1},
                      tilted[] = {1, -2, 0.5}, axis[] = {1, 2, -1}, by[] = {0.3, -0.2, 0.1};
  switch (k) {
  case 0: return sph_shape_box(1, lo, hi, e);
  case 1: return sph_shape_box(2, lo, hi, e);
  case 2: return sph_shape_box(3, lo, hi, e);
  case 3: return sph_shape_ball(2, c, 0.4, e);
  case 4: return sph_shape_ball(3, c, 0.4, e);
  case 5: return sph_shape_cylinder(lo, hi, 0.3, e);
  case 6: return sph_shape_cone(lo, hi, 0.4, 0.1, e);
  case 7: return sph_shape_cone(lo, hi, 0, 0.5, e);
  case 8: return sph_shape_half_space(3, c, tilted, e);
  case 9: return sph_shape_polygon(5, corner, e);
  case 10: return sph_shape_prism(5, corner, 1, -0.2, 0.5, e);
  case 11: return sph_shape_rotate(sph_shape_box(3, lo, hi, e), axis, 0.7, c, e);
  case 12: return sph_shape_rotate(sph_shape_polygon(5, corner, e), NULL, -1.1, c, e);
  case 13:
    return sph_shape_scale(sph_shape_translate(sph_shape_box(3, lo, hi, e), by, e), 1.7, c, e);
  case 14: return sph_shape_shell(sph_shape_box(2, lo, hi, e), 0.15, 0, 0.02, e);
  case 15: return sph_shape_shell(sph_shape_ball(3, c, 0.4, e), 0.1, 1, 0.02, e);
  }
  return NULL;
}

/* x - d grad d is on the surface, and |grad d| = 1: d is the distance. */
static void the_foot_of_a_point_is_on_the_surface(void **state)
{
  (void)state;
  srand(1);
  for (int k = 0; k < 16; k++) {
    sph_error error = {0};
    sph_shape *s = exact_shape(k, &error);
    if (!s) fail_msg("shape %d: %s", k, error.text);
    const int dim = sph_shape_dim(s);
    int smooth = 0, sides[2] = {0};
    for (int i = 0; i < 500; i++) {
      double x[3], foot[3], slope[3], norm = 0;
      for (int d = 0; d < dim; d++) x[d] = uniform(-0.6, 1.4);
      const double r = sph_shape_distance(s, x), eps = 1e-6;
      for (int d = 0; d < dim; d++) {
        double more[3] = {x[0], x[1], x[2]}, less[3] = {x[0], x[1], x[2]};
        more[d] += eps;
        less[d] -= eps;
        slope[d] = (sph_shape_distance(s, more) - sph_shape_distance(s, less)) / (2 * eps);
        norm += slope[d] * slope[d];
      }
      sides[r < 0]++;
      if (fabs(norm - 1) > 1e-4) continue; /* a ridge: two feet */
      smooth++;
      for (int d = 0; d < dim; d++) foot[d] = x[d] - r * slope[d];
      if (fabs(sph_shape_distance(s, foot)) > 1e-5)
        fail_msg("shape %d: at (%g %g %g) d = %g, of its foot %g", k, x[0], x[1], x[2], r,
                 sph_shape_distance(s, foot));
    }
    assert_true(smooth > 480);
    assert_true(sides[0] > 20 && sides[1] > 5);
    sph_shape_free(s);
  }
}

static void distances_of_known_points(void **state)
{
  static const struct {
    int shape;
    double x[3], distance;
  } known[] = {
      {1, {0.5, 0.3}, -0.1},      {1, {1.2, 1.1}, 0.5},
      {2, {0.5, 0.45, 0.9}, 0.3}, {3, {0.4, 0.8}, -0.1},
      {4, {0.4, 0.5, 1}, 0.5},    {9, {0.1, -0.2}, 0.2},
      {9, {0.7, 0.1}, -0.1},      {9, {0.3, 0.5}, 0.2121320343559643}, /* in the notch */
      {10, {0.7, 0.9, 0.1}, 0.4}, {10, {0.7, 0.45, 0.2}, -0.05},
      {14, {0.5, 0.75}, -0.05},   {15, {0.4, 0.5, 0.1}, 0.3},
  };
  (void)state;
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    sph_error error = {0};
    sph_shape *s = exact_shape(known[k].shape, &error);
    const double found = sph_shape_distance(s, known[k].x);
    if (!(fabs(found - known[k].distance) < 1e-12))
      fail_msg("%zu, shape %d: %.15g, wanted %.15g", k, known[k].shape, found, known[k].distance);
    sph_shape_free(s);
  }
}

static void combinations_are_what_they_say(void **state)
{
  static const double lo[] = {0, 0}, hi[] = {1, 1}, c[] = {1, 0.5};
  (void)state;
  srand(2);
  for (int k = 0; k < 3; k++) {
    sph_error error = {0};
    sph_shape *part[] = {sph_shape_box(2, lo, hi, &error), sph_shape_ball(2, c, 0.4, &error)};
    sph_shape *s = k == 0   ? sph_shape_union(2, part, &error)
                   : k == 1 ? sph_shape_intersection(2, part, &error)
                            : sph_shape_difference(2, part, &error);
    assert_non_null(s);
    double lower[3], upper[3];
    assert_true(sph_shape_bounds(s, lower, upper));
    for (int i = 0; i < 2000; i++) {
      const double x[] = {uniform(-0.5, 2), uniform(-0.5, 1.5)};
      const int box = x[0] > 0 && x[0] < 1 && x[1] > 0 && x[1] < 1;
      const int ball = hypot(x[0] - 1, x[1] - 0.5) < 0.4;
      const int wanted = k == 0 ? box || ball : k == 1 ? box && ball : box && !ball;
      assert_int_equal(sph_shape_distance(s, x) < 0, wanted);
      for (int d = 0; d < 2 && wanted; d++) assert_true(x[d] >= lower[d] && x[d] <= upper[d]);
    }
    sph_shape_free(s);
  }
}

static void what_is_no_shape_says_so(void **state)
{
  static const double lo[] = {0, 0, 0}, hi[] = {1, -1, 1}, bad[] = {0, NAN, 0},
                      crossed[][2] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}},
                      flat[][2] = {{0, 0}, {1, 1}, {2, 2}};
  (void)state;
  for (int k = 0; k < 14; k++) {
    static const char *const says[] = {"upper above lower", "finite",         "radius 0",
                                       "a point to itself", "radii -1 and 1", "length 0",
                                       "2 corners",         "cross",          "without area",
                                       "to > from",         "no shapes",      "2 and 3 dim",
                                       "scaled by 0",       "without end"};
    sph_error e = {0};
    sph_shape *s = NULL, *two[] = {NULL, NULL};
    if (k == 0) s = sph_shape_box(2, lo, hi, &e);
    if (k == 1) s = sph_shape_box(2, bad, hi, &e);
    if (k == 2) s = sph_shape_ball(2, lo, 0, &e);
    if (k == 3) s = sph_shape_cylinder(lo, lo, 1, &e);
    if (k == 4) s = sph_shape_cone(lo, hi, -1, 1, &e);
    if (k == 5) s = sph_shape_half_space(2, lo, lo, &e);
    if (k == 6) s = sph_shape_polygon(2, crossed, &e);
    if (k == 7) s = sph_shape_polygon(4, crossed, &e);
    if (k == 8) s = sph_shape_polygon(3, flat, &e);
    if (k == 9) s = sph_shape_prism(5, corner, 2, 1, 0, &e);
    if (k == 10) s = sph_shape_union(0, NULL, &e);
    if (k == 11) two[0] = sph_shape_ball(2, lo, 1, &e), two[1] = sph_shape_ball(3, lo, 1, &e);
    if (k == 11) s = sph_shape_difference(2, two, &e);
    if (k == 12) s = sph_shape_scale(sph_shape_ball(2, lo, 1, &e), 0, NULL, &e);
    if (k == 13)
      two[0] = sph_shape_half_space(2, lo, hi, &e), two[1] = sph_shape_half_space(2, lo, hi, &e);
    if (k == 13) s = sph_shape_shell(sph_shape_union(2, two, &e), 0.1, 1, 0.01, &e);
    assert_null(s);
    if (!strstr(e.text, says[k])) fail_msg("%d: '%s', wanted '%s'", k, e.text, says[k]);
  }
  assert_true(isnan(sph_shape_distance(NULL, lo)));
}

/* ---- surfaces of triangles */

static char folder[FOLDER_MAX];

static const char *in_folder(const char *name)
{
  static char path[FOLDER_MAX + 40];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static FILE *open_in(const char *name)
{
  FILE *file = fopen(in_folder(name), "wb");
  assert_non_null(file);
  return file;
}

static void put_u32(FILE *f, uint32_t n)
{
  for (int k = 0; k < 4; k++) fputc((int)(n >> 8 * k & 255), f);
}

static void put_float(FILE *f, double x)
{
  const float value = (float)x;
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  put_u32(f, bits);
}

/* Triangles tri[n][3][3] as binary (kind 0) or ASCII STL (kind 1). */
static void write_stl(const char *name, int kind, int n, double (*tri)[3][3])
{
  FILE *f = open_in(name);
  if (kind == 0) {
    char head[80] = "solid, as some binary files begin, too";
    fwrite(head, 1, sizeof head, f);
    put_u32(f, (uint32_t)n);
  } else {
    fprintf(f, "solid a\n");
  }
  for (int t = 0; t < n; t++) {
    if (kind == 1) fprintf(f, " facet normal 0 0 0\n  outer loop\n");
    for (int d = 0; d < 3 && kind == 0; d++) put_float(f, 0);
    for (int c = 0; c < 3; c++) {
      if (kind == 1)
        fprintf(f, "   vertex %.9g %.9g %.9g\n", tri[t][c][0], tri[t][c][1], tri[t][c][2]);
      for (int d = 0; d < 3 && kind == 0; d++) put_float(f, tri[t][c][d]);
    }
    if (kind == 1)
      fprintf(f, "  endloop\n endfacet\n");
    else
      fputc(0, f), fputc(0, f);
  }
  if (kind == 1) fprintf(f, "endsolid a\n");
  fclose(f);
}

/* A cube of side 2 from -1 to 1, 12 triangles, as tri[12]. */
static void cube(double (*tri)[3][3])
{
  int n = 0;
  for (int d = 0; d < 3; d++)
    for (int side = -1; side <= 1; side += 2)
      for (int half = 0; half < 2; half++, n++)
        for (int c = 0; c < 3; c++) {
          static const double square[][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
          const int at = half ? (c + 2) % 4 : c, k = side > 0 ? c : 2 - c;
          tri[n][k][d] = side;
          tri[n][k][(d + 1) % 3] = square[at][0];
          tri[n][k][(d + 2) % 3] = square[at][1];
        }
}

static void a_cube_of_triangles_is_a_cube(void **state)
{
  static const char *const names[] = {"cube.stl", "ascii.STL", "cube.obj", "turned.stl"};
  static const double lo[] = {-0.5, -0.5, -0.5}, hi[] = {0.5, 0.5, 0.5};
  double tri[12][3][3];
  (void)state;
  cube(tri);
  write_stl(names[0], 0, 12, tri);
  write_stl(names[1], 1, 12, tri);
  FILE *f = open_in(names[2]);
  fprintf(f, "# faces of four corners, counted from either end\no cube\n");
  for (int k = 0; k < 8; k++)
    fprintf(f, "v %d %d %d\n", k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
  fprintf(f, "vn 0 0 1\nf 1 3 4 2\nf 5/1 6/1 8/1 7/1\nf 1//1 2//1 6//1 5//1\nf -6 -2 -1 -5\nf 1 5 "
             "7 3\nf 2 4 8 6 # end\n");
  fclose(f);
  for (int t = 0; t < 12; t++)
    for (int d = 0; d < 3; d++) {
      const double x = tri[t][1][d];
      tri[t][1][d] = tri[t][2][d];
      tri[t][2][d] = x;
    }
  write_stl(names[3], 0, 12, tri); /* all normals point in: turned round */
  sph_error error = {0};
  sph_shape *box = sph_shape_box(3, lo, hi, &error);
  for (int k = 0; k < 4; k++) {
    sph_shape *s = sph_shape_surface(in_folder(names[k]), 0.5, 0, &error);
    if (!s) fail_msg("%s: %s", names[k], error.text);
    srand(3);
    for (int i = 0; i < 2000; i++) {
      const double x[] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      assert_near(sph_shape_distance(s, x), sph_shape_distance(box, x), 1e-12);
    }
    sph_shape_free(s);
  }
  sph_shape_free(box);
}

enum { LONGS = 48, LATS = 24, BALL = 2 * LONGS * (LATS - 1) };

static void on_sphere(int i, int j, double x[3])
{
  const double theta = M_PI * j / LATS, phi = 2 * M_PI * (i % LONGS) / LONGS;
  x[0] = j % LATS ? sin(theta) * cos(phi) : 0;
  x[1] = j % LATS ? sin(theta) * sin(phi) : 0;
  x[2] = cos(theta);
}

static int ball(double (*tri)[3][3])
{
  int n = 0;
  for (int j = 0; j < LATS; j++)
    for (int i = 0; i < LONGS; i++) {
      if (j > 0) {
        on_sphere(i, j, tri[n][0]), on_sphere(i + 1, j + 1, tri[n][1]);
        on_sphere(i + 1, j, tri[n++][2]);
      }
      if (j < LATS - 1) {
        on_sphere(i, j, tri[n][0]), on_sphere(i, j + 1, tri[n][1]);
        on_sphere(i + 1, j + 1, tri[n++][2]);
      }
    }
  return n;
}

static void a_ball_of_triangles_is_a_ball(void **state)
{
  double(*tri)[3][3] = calloc(BALL, sizeof *tri);
  (void)state;
  assert_int_equal(ball(tri), BALL);
  write_stl("ball.stl", 0, BALL, tri);
  sph_error error = {0};
  sph_shape_mesh mesh;
  assert_int_equal(sph_shape_mesh_read(&mesh, in_folder("ball.stl"), 1, &error), 0);
  assert_int_equal(mesh.corners, LONGS * (LATS - 1) + 2);
  assert_int_equal(sph_shape_mesh_closed(&mesh, "ball", &error), 0);
  assert_near(sph_shape_mesh_volume(&mesh), 4 * M_PI / 3, 0.05);
  assert_int_equal(sph_shape_mesh_tree(&mesh, &error), 0);
  srand(4);
  for (int i = 0; i < 4000; i++) {
    const double x[] = {uniform(-1.5, 1.5), uniform(-1.5, 1.5), uniform(-1.5, 1.5)};
    const double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    if (r > 0.99 && r < 1) continue; /* between the ball and its triangles */
    const double w = sph_shape_mesh_tree_winding(&mesh, x);
    if (!(fabs(w - (r < 1)) < 0.02)) fail_msg("winding number %g at r = %g", w, r);
    assert_near(sph_shape_mesh_tree_distance(&mesh, x), fabs(r - 1), 0.01);
  }
  sph_shape_mesh_free(&mesh);
  free(tri);
}

static void an_open_surface_is_an_error_or_a_hole(void **state)
{
  double(*tri)[3][3] = calloc(BALL, sizeof *tri);
  sph_error error = {0};
  (void)state;
  ball(tri);
  write_stl("open.stl", 0, BALL - 1, tri); /* at the south pole */
  assert_null(sph_shape_surface(in_folder("open.stl"), 1, 0, &error));
  assert_non_null(strstr(error.text, "not closed: 3 edges belong to one triangle only"));
  assert_non_null(strstr(error.text, "holes: true"));
  error.status = 0;
  sph_shape *s = sph_shape_surface(in_folder("open.stl"), 1, 1, &error);
  assert_non_null(s);
  srand(5);
  for (int i = 0; i < 1000; i++) {
    const double x[] = {uniform(-1.5, 1.5), uniform(-1.5, 1.5), uniform(-0.8, 1.5)};
    const double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    if (fabs(r - 1) > 0.02) assert_int_equal(sph_shape_distance(s, x) < 0, r < 1);
  }
  sph_shape_free(s);
  for (int d = 0; d < 3; d++) {
    const double x = tri[7][0][d];
    tri[7][0][d] = tri[7][1][d];
    tri[7][1][d] = x;
  }
  write_stl("twisted.stl", 1, BALL, tri);
  assert_null(sph_shape_surface(in_folder("twisted.stl"), 1, 0, &error));
  assert_non_null(strstr(error.text, "3 edges whose triangles go round different ways"));
  free(tri);
}

static void files_that_are_no_surface(void **state)
{
  static const struct {
    const char *name, *text, *says;
  } bad[] = {
      {"none.stl", NULL, "cannot open"},
      {"short.stl", "abc", "3 bytes are no STL file"},
      {"a.ply", "ply", "known are .stl, .obj"},
      {"empty.stl", "solid\nendsolid\n", "holds no triangles"},
      {"number.stl", "solid\nvertex 0 0 x\n", ":2: three coordinates are right"},
      {"cut.stl", "solid\nvertex 0 0 1\n", "1 lines 'vertex': cut short"},
      {"face.obj", "v 0 0 0\nf 1 2 3\n", ":2: found '2 3'"},
      {"two.obj", "v 0 0 0\nv 0 1 0\nf 1 2\n", ":3: a face of 2 corners"},
      {"far.obj", "v 0 0 0\nv 0 1 1e999\nf 1 2 1\n", "coordinate 2 of corner 1 is inf"},
      {"head.stl",
       "012345678901234567890123456789012345678901234567890123456789012345678901234567890123456789"
       "0",
       "no STL file, or cut short"},
  };
  (void)state;
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    sph_error error = {0};
    if (bad[k].text) {
      FILE *f = open_in(bad[k].name);
      fputs(bad[k].text, f);
      fclose(f);
    }
    assert_null(sph_shape_surface(in_folder(bad[k].name), 1, 0, &error));
    if (!strstr(error.text, bad[k].says)) fail_msg("'%s', wanted '%s'", error.text, bad[k].says);
  }
}

/* ---- particles */

static sph_sim *sim_of(int dim, double dx)
{
  return sph_sim_create(&(sph_sim_def){.dim = dim, .dx = dx});
}

static void lattices_have_their_neighbors_and_density(void **state)
{
  static const struct {
    const char *name;
    double distance; /* of the nearest ones, over dx */
    int count;
  } known[] = {{"square", 1, 4},
               {"hexagonal", 1.0745699318235418, 6}, /* a^2 sqrt(3)/2 = 1 */
               {"cubic", 1, 6},
               {"bcc", 1.0911236359717214, 8},  /* sqrt(3)/2 2^(1/3) */
               {"fcc", 1.1224620483093730, 12}, /* 4^(1/3)/sqrt(2) */
               {"hcp", 1.1224620483093730, 12}};
  (void)state;
  for (int k = 0; sph_shape_lattice_name(k); k++) {
    static const double lo[] = {0, 0, 0}, hi[] = {1, 1, 1};
    const int dim = sph_shape_lattice_dim(known[k].name);
    const double dx = dim == 2 ? 0.01 : 0.05;
    sph_error error = {0};
    assert_string_equal(sph_shape_lattice_name(k), known[k].name);
    sph_sim *sim = sim_of(dim, dx);
    sph_group *g = sph_group_create(sim, "g", "fluid");
    sph_shape *box = sph_shape_box(dim, lo, hi, &error);
    sph_group_add_shape(g, box, &(sph_fill){.rho0 = 2, .lattice = known[k].name});
    const long n = sph_group_count(g);
    const double *x[3] = {NULL};
    for (int d = 0; d < dim; d++) x[d] = sph_group_read(g, "position", d);
    assert_near((double)n * pow(dx, dim), 1, dim == 2 ? 0.02 : 0.1);
    long middle = 0;
    double best = INFINITY, nearest = INFINITY;
    for (long i = 0; i < n; i++) {
      double r2 = 0;
      for (int d = 0; d < dim; d++) r2 += (x[d][i] - 0.5) * (x[d][i] - 0.5);
      if (r2 < best) best = r2, middle = i;
    }
    int count = 0;
    for (int pass = 0; pass < 2; pass++)
      for (long i = 0; i < n; i++) {
        double r2 = 0;
        for (int d = 0; d < dim; d++) r2 += (x[d][i] - x[d][middle]) * (x[d][i] - x[d][middle]);
        if (i == middle) continue;
        if (pass == 0) nearest = fmin(nearest, sqrt(r2));
        if (pass == 1) count += sqrt(r2) < nearest * (1 + 1e-9);
      }
    assert_near(nearest / dx, known[k].distance, 1e-9);
    assert_int_equal(count, known[k].count);
    sph_shape_free(box);
    sph_sim_free(sim);
  }
}

static long count_in(const sph_shape *s, double dx, double origin)
{
  sph_sim *sim = sim_of(sph_shape_dim(s), dx);
  sph_group *g = sph_group_create(sim, "g", "fluid");
  sph_group_add_shape(g, s, &(sph_fill){.rho0 = 1, .origin = {origin, origin, origin}});
  const long n = sph_group_count(g);
  if (sph_sim_status(sim)) fail_msg("%s", sph_sim_error(sim));
  sph_sim_free(sim);
  return n;
}

/* The surface goes through places of the lattice: each is of one shape and one only. */
static void nothing_is_lost_or_twice_along_a_surface(void **state)
{
  static const double lo[] = {0, 0}, hi[] = {1, 0.6}, wide_lo[] = {-0.3, -0.3},
                      wide_hi[] = {1.3, 0.9};
  (void)state;
  for (int shifted = 0; shifted < 2; shifted++) {
    const double dx = 0.1, origin = shifted ? dx / 2 : 0;
    sph_error e = {0};
    sph_shape *in = sph_shape_box(2, lo, hi, &e), *out = sph_shape_box(2, wide_lo, wide_hi, &e);
    const long inner = count_in(in, dx, origin), all = count_in(out, dx, origin);
    sph_shape *rest = sph_shape_difference(2, (sph_shape *[]){out, in}, &e);
    assert_int_equal(inner, 60);
    assert_int_equal(all, 16 * 12);
    assert_int_equal(count_in(rest, dx, origin), all - inner);
    sph_shape_free(rest);
  }
}

/* Two boxes side by side are one box, and what is cut off flush has no wall. */
static void shells_know_the_whole_surface(void **state)
{
  static const double a[] = {0, 0}, b[] = {0.5, 1}, c[] = {0.5, 0}, d[] = {1, 1}, far[] = {1.5, 1};
  (void)state;
  for (int inside = 0; inside < 2; inside++) {
    sph_error e = {0};
    sph_shape *one = sph_shape_shell(sph_shape_box(2, a, d, &e), 0.15, inside, 0.05, &e);
    sph_shape *two[] = {sph_shape_box(2, a, b, &e), sph_shape_box(2, c, d, &e)};
    sph_shape *both = sph_shape_shell(sph_shape_union(2, two, &e), 0.15, inside, 0.05, &e);
    sph_shape *cut[] = {sph_shape_box(2, a, far, &e), sph_shape_box(2, d, (double[]){2, 2}, &e),
                        sph_shape_box(2, (double[]){1, 0}, (double[]){2, 1}, &e)};
    sph_shape *flush = sph_shape_shell(sph_shape_difference(3, cut, &e), 0.15, inside, 0.05, &e);
    assert_non_null(flush);
    const long wanted = count_in(one, 0.05, 0);
    assert_int_equal(count_in(both, 0.05, 0), wanted);
    assert_int_equal(count_in(flush, 0.05, 0), wanted);
    /* Three layers: 20 a side, and at the corners outside those within 3 dx of them. */
    assert_int_equal(wanted, inside ? 20 * 20 - 14 * 14 : 4 * 3 * 20 + 4 * 8);
    sph_shape_free(one), sph_shape_free(both), sph_shape_free(flush);
  }
}

static void stretched_lattices_fill_a_box(void **state)
{
  static const double lo[] = {0, 0}, hi[] = {1, 1};
  sph_error e = {0};
  (void)state;
  sph_sim *sim = sim_of(2, 0.1);
  sph_group *g = sph_group_create(sim, "g", "fluid");
  sph_shape *box = sph_shape_box(2, lo, hi, &e);
  double side[3];
  assert_true(sph_shape_lattice_cell("hexagonal", side));
  const sph_fill fill = {.rho0 = 1000,
                         .lattice = "hexagonal",
                         .stretch = {1 / (9 * 0.1 * side[0]), 1 / (5 * 0.1 * side[1])}};
  sph_group_add_shape(g, box, &fill);
  assert_int_equal(sph_group_count(g), 90);
  double mass = 0;
  for (int i = 0; i < 90; i++) mass += sph_group_read(g, "mass", 0)[i];
  assert_near(mass, 1000, 1e-9);
  sph_shape_free(box);
  sph_sim_free(sim);
}

static void failures_stick_to_the_simulation(void **state)
{
  static const double lo[] = {0, 0, 0}, hi[] = {1, 1, 1}, tiny[] = {0.01, 0.01, 0.01};
  (void)state;
  for (int k = 0; k < 5; k++) {
    static const char *const says[] = {"without end", "of 3 dimensions; right is 2",
                                       "known are square, hexagonal", "no place of the lattice",
                                       "apart; a coarser spacing is right, or another unit"};
    sph_error e = {0};
    sph_sim *sim = sim_of(2, k == 4 ? 1e-7 : 0.1);
    sph_group *g = sph_group_create(sim, "g", "fluid");
    sph_shape *s = k == 0   ? sph_shape_half_space(2, lo, hi, &e)
                   : k == 1 ? sph_shape_box(3, lo, hi, &e)
                   : k == 3 ? sph_shape_box(2, lo, tiny, &e)
                            : sph_shape_box(2, lo, hi, &e);
    sph_group_add_shape(g, s, &(sph_fill){.rho0 = 1, .lattice = k == 2 ? "bcc" : NULL});
    if (!strstr(sph_sim_error(sim), says[k]))
      fail_msg("'%s', wanted '%s'", sph_sim_error(sim), says[k]);
    sph_shape_free(s);
    sph_sim_free(sim);
  }
}

static int make_folder(void **state)
{
  (void)state;
  return folder_make(folder, "shape");
}

static int remove_folder(void **state)
{
  (void)state;
  return folder_remove(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_foot_of_a_point_is_on_the_surface),
      cmocka_unit_test(distances_of_known_points),
      cmocka_unit_test(combinations_are_what_they_say),
      cmocka_unit_test(what_is_no_shape_says_so),
      cmocka_unit_test(a_cube_of_triangles_is_a_cube),
      cmocka_unit_test(a_ball_of_triangles_is_a_ball),
      cmocka_unit_test(an_open_surface_is_an_error_or_a_hole),
      cmocka_unit_test(files_that_are_no_surface),
      cmocka_unit_test(lattices_have_their_neighbors_and_density),
      cmocka_unit_test(nothing_is_lost_or_twice_along_a_surface),
      cmocka_unit_test(shells_know_the_whole_surface),
      cmocka_unit_test(stretched_lattices_fill_a_box),
      cmocka_unit_test(failures_stick_to_the_simulation),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
