/* What operators are exact for, whatever the points: constants, linear and quadratic fields,
 * rotations, sums that vanish; and what they answer to what cannot be. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "cloud.h"
#include "near.h"
#include "quick.h"

enum { ARRAYS = 9 };

/* A shaken lattice that ends, with fields of degree 0, 1, 2 on it, and room for results. */
typedef struct scene {
  cloud c;
  sph_operator *op;
  double a, b[3], H[3][3]; /* a + b.x + x.Hx/2 */
  double *field[3];        /* of each degree */
  double *out[ARRAYS];
} scene;

/* Corners of the box have few neighbours: as wide as it takes for a quadratic. */
static const double reach[] = {5.2, 5.2, 4.4}; /* [dx] */

static scene scene_make(int dim, int kernel, int lower_order)
{
  static const int across[] = {30, 14, 11};
  const sph_kernel *k = sph_kernel_get(kernel);
  scene s = {.c = cloud_make(dim, across[dim - 1], 0.2, 0, 1), .a = 1.7, .b = {0.7, -1.1, 0.4}};
  static const double H[3][3] = {{1.3, 0.4, -0.6}, {0.4, -0.2, 0.3}, {-0.6, 0.3, 0.9}};
  memcpy(s.H, H, sizeof H);
  s.op =
      cloud_operator(&s.c, (sph_operator_def){.h = reach[dim - 1] * s.c.dx / sph_kernel_support(k),
                                              .kernel = sph_kernel_name(k),
                                              .lower_order = lower_order});
  for (int p = 0; p < 3; p++) s.field[p] = cloud_array(s.c.n);
  for (int o = 0; o < ARRAYS; o++) s.out[o] = cloud_array(s.c.n);
  for (long i = 0; i < s.c.n; i++) {
    double linear = 0, quadratic = 0;
    for (int d = 0; d < dim; d++) {
      linear += s.b[d] * s.c.x[d][i];
      for (int e = 0; e < dim; e++) quadratic += 0.5 * s.c.x[d][i] * s.H[d][e] * s.c.x[e][i];
    }
    s.field[0][i] = s.a;
    s.field[1][i] = s.a + linear;
    s.field[2][i] = s.a + linear + quadratic;
  }
  return s;
}

static void scene_free(scene *s)
{
  sph_operator_free(s->op);
  cloud_free(&s->c);
  for (int p = 0; p < 3; p++) free(s->field[p]);
  for (int o = 0; o < ARRAYS; o++) free(s->out[o]);
}

#define EACH_SCENE(s)                                                      \
  for (int dim = 1; dim <= 3; dim++)                                       \
    for (int kernel = 0; sph_kernel_get(kernel); kernel += quick_stride()) \
      for (scene s = scene_make(dim, kernel, 0); s.op; scene_free(&s), s.op = NULL)

/* Slope d of the quadratic field at point i. */
static double slope(const scene *s, int d, long i)
{
  double g = s->b[d];
  for (int e = 0; e < s->c.dim; e++) g += s->H[d][e] * s->c.x[e][i];
  return g;
}

static double trace(const scene *s)
{
  double sum = 0;
  for (int d = 0; d < s->c.dim; d++) sum += s->H[d][d];
  return sum;
}

static void constants(void **state)
{
  static const char *const forms[] = {"difference", "density", "corrected"};
  (void)state;
  EACH_SCENE(s)
  {
    assert_int_equal(sph_operator_shepard(s.op, s.field[0], s.out[0], NULL), 0);
    for (long i = 0; i < s.c.n; i++) assert_near(s.out[0][i], s.a, 1e-14);
    for (int f = 0; f < 3; f++) {
      assert_int_equal(sph_operator_gradient(s.op, forms[f], s.field[0], s.out, NULL), 0);
      for (int d = 0; d < dim; d++)
        for (long i = 0; i < s.c.n; i++) assert_near(s.out[d][i], 0, 0);
    }
    for (int f = 0; sph_operator_laplacian_form(f); f++) {
      assert_int_equal(sph_operator_laplacian(s.op, sph_operator_laplacian_form(f), NULL,
                                              s.field[0], s.out[0], NULL),
                       0);
      for (long i = 0; i < s.c.n; i++) assert_near(s.out[0][i], 0, 0);
    }
  }
}

/* Errors where 1e-11 is asked, and where less is: the Laplacian of a line, Fatehi & Manzari's in
 * corners of 3D. */
static double largest, largest_else;

#define assert_exact(found, right, tolerance)                    \
  do {                                                           \
    double *of = (tolerance) > 1e-11 ? &largest_else : &largest; \
    *of = fmax(*of, fabs((found) - (right)));                    \
    assert_near(found, right, tolerance);                        \
  } while (0)

static int tell(void **state)
{
  (void)state;
  print_message("# lines and parabolas: error %.2g; where less is asked %.2g\n", largest,
                largest_else);
  return 0;
}

static void linear(void **state)
{
  (void)state;
  EACH_SCENE(s)
  {
    assert_int_equal(sph_operator_gradient(s.op, "corrected", s.field[1], s.out, NULL), 0);
    for (int d = 0; d < dim; d++)
      for (long i = 0; i < s.c.n; i++) assert_exact(s.out[d][i], s.b[d], 1e-11);
    for (int cspm = 0; cspm < 2; cspm++) {
      if (cspm)
        assert_int_equal(sph_operator_cspm(s.op, s.field[1], s.out[3], s.out, NULL), 0);
      else
        assert_int_equal(sph_operator_mls(s.op, 1, s.field[1], s.out[3], s.out, NULL, NULL), 0);
      for (long i = 0; i < s.c.n; i++) assert_exact(s.out[3][i], s.field[1][i], 1e-11);
      for (int d = 0; d < dim; d++)
        for (long i = 0; i < s.c.n; i++) assert_exact(s.out[d][i], s.b[d], 1e-11);
    }
    assert_int_equal(sph_operator_laplacian(s.op, "corrected", NULL, s.field[1], s.out[0], NULL),
                     0);
    for (long i = 0; i < s.c.n; i++) assert_exact(s.out[0][i], 0, 1e-10); /* times 1/dx */
  }
}

/* Is no face of the box within reach? */
static int inside(const scene *s, long i)
{
  double face = 1;
  for (int d = 0; d < s->c.dim; d++) face = fmin(face, 0.5 - fabs(s->c.x[d][i] - 0.5));
  return face > reach[s->c.dim - 1] * s->c.dx;
}

/* B of Fatehi & Manzari is solved for with a matrix that is not definite: in some corners of 3D it
 * is nearly singular, and loses two digits. */
static void quadratic(void **state)
{
  (void)state;
  EACH_SCENE(s)
  {
    int k = 0;
    assert_int_equal(sph_operator_laplacian(s.op, "fatehi-manzari", NULL, s.field[2], s.out[0],
                                            NULL),
                     0);
    for (long i = 0; i < s.c.n; i++)
      assert_exact(s.out[0][i], trace(&s), dim == 3 && !inside(&s, i) ? 1e-9 : 1e-11);
    assert_int_equal(sph_operator_mls(s.op, 2, s.field[2], s.out[6], NULL, s.out, NULL), 0);
    for (long i = 0; i < s.c.n; i++) assert_exact(s.out[6][i], s.field[2][i], 1e-11);
    for (int a = 0; a < dim; a++)
      for (int b = a; b < dim; b++, k++)
        for (long i = 0; i < s.c.n; i++) assert_exact(s.out[k][i], s.H[a][b], 1e-11);
    assert_int_equal(sph_operator_mls(s.op, 2, s.field[2], NULL, s.out, NULL, NULL), 0);
    for (int d = 0; d < dim; d++)
      for (long i = 0; i < s.c.n; i++) assert_exact(s.out[d][i], slope(&s, d, i), 1e-11);
  }
}

/* u = A x: gradient A, divergence its trace, curl 2 omega; a rotation has no divergence. */
static void vectors(void **state)
{
  (void)state;
  EACH_SCENE(s)
  {
    double *u[3];
    for (int a = 0; a < 3; a++) {
      u[a] = cloud_array(s.c.n);
      for (long i = 0; i < s.c.n; i++)
        u[a][i] = s.H[a][0] * s.c.x[0][i] + (a == 0 ? -1 : 2) * s.c.x[1][i] + a * s.c.x[2][i];
    }
    const double A[3][3] = {{s.H[0][0], -1, 0}, {s.H[1][0], 2, 1}, {s.H[2][0], 2, 2}};
    const double *const *field = (const double *const *)u;
    assert_int_equal(sph_operator_gradient_vector(s.op, "corrected", field, s.out, NULL), 0);
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++)
        for (long i = 0; i < s.c.n; i++) assert_exact(s.out[a * dim + b][i], A[a][b], 1e-11);
    assert_int_equal(sph_operator_divergence(s.op, "corrected", field, s.out[0], NULL), 0);
    const double divergence = A[0][0] + (dim > 1 ? A[1][1] : 0) + (dim > 2 ? A[2][2] : 0);
    for (long i = 0; i < s.c.n; i++) assert_exact(s.out[0][i], divergence, 1e-11);
    if (dim > 1) {
      assert_int_equal(sph_operator_curl(s.op, "corrected", field, s.out, NULL), 0);
      const double curl[] = {A[2][1] - A[1][2], A[0][2] - A[2][0], A[1][0] - A[0][1]};
      for (long i = 0; i < s.c.n; i++)
        for (int a = dim == 2 ? 2 : 0; a < 3; a++)
          assert_exact(s.out[dim == 2 ? 0 : a][i], curl[a], 1e-11);
    }
    for (int a = 0; a < 3; a++) free(u[a]);
  }
}

/* sum_i V_i a_i over its size. */
static double balance(const scene *s, const double *weight, const double *a)
{
  double sum = 0, size = 0;
  for (long i = 0; i < s->c.n; i++) {
    const double V = s->c.volume[i] * (weight ? weight[i] : 1);
    sum += V * a[i], size += fabs(V * a[i]);
  }
  return fabs(sum) / size;
}

/* sum_i m_i grad f_i/rho_i = 0: forces between pairs; conduction creates no heat, and lap u + 2
 * grad div u is the sum that it says. */
static void pairs(void **state)
{
  (void)state;
  EACH_SCENE(s)
  {
    for (int form = 0; form < 2; form++) {
      assert_int_equal(sph_operator_gradient(s.op, form ? "plus" : "symmetric", s.field[2], s.out,
                                             NULL),
                       0);
      for (int d = 0; d < dim; d++) assert_true(balance(&s, NULL, s.out[d]) < 1e-13);
      assert_int_equal(sph_operator_laplacian(s.op, form ? "arithmetic" : "harmonic", s.c.density,
                                              s.field[2], s.out[0], NULL),
                       0);
      assert_true(balance(&s, NULL, s.out[0]) < 1e-13);
    }
    const double *const u[] = {s.field[2], s.field[1], s.c.volume};
    assert_int_equal(sph_operator_mcg(s.op, u, s.out, NULL), 0);
    assert_int_equal(sph_operator_grad_div(s.op, u, s.out + 3, NULL), 0);
    if (!strcmp(sph_kernel_name(sph_kernel_get(kernel)), "spiky")) continue; /* softened */
    for (int d = 0; d < dim; d++) {
      assert_int_equal(sph_operator_laplacian(s.op, "arithmetic", NULL, u[d], s.out[6], NULL), 0);
      for (long i = 0; i < s.c.n; i++)
        assert_near(s.out[d][i], s.out[6][i] + 2 * s.out[3 + d][i], 1e-11 / s.c.dx);
    }
  }
}

/* ---- what cannot be */

static void refused(int status, sph_error *error, int right, const char *text)
{
  assert_int_equal(status, right);
  assert_int_equal(error->status, right);
  if (!strstr(error->text, text)) fail_msg("\"%s\" should say \"%s\"", error->text, text);
  *error = (sph_error){0};
}

static void bad_definitions(void **state)
{
  (void)state;
  const struct {
    sph_operator_def def;
    const char *text;
  } bad[] = {{{.dim = 0, .h = 1}, "dim = 0; right is 1, 2 or 3"},
             {{.dim = 4, .h = 1}, "dim = 4"},
             {{.dim = 2}, "h = 0 m"},
             {{.dim = 2, .h = NAN}, "h = nan m"},
             {{.dim = 2, .h = INFINITY}, "h = inf m"},
             {{.dim = 2, .h = 1, .threads = -1}, "threads = -1"},
             {{.dim = 2, .h = 1, .kernel = "wendland"}, "did you mean 'wendland-c"},
             {{.dim = 2, .h = 1, .search = "oak"}, "search \"oak\""},
             {{.dim = 2, .h = 1, .periodic = {1}, .length = {3.9}}, "at least 2 reach = 4 m"}};
  sph_error error = {0};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    assert_null(sph_operator_create(&bad[k].def, &error));
    refused(error.status, &error, SPH_ERR_ARGUMENT, bad[k].text);
  }
  assert_null(sph_operator_create(NULL, &error));
  refused(error.status, &error, SPH_ERR_ARGUMENT, "no definition");
  assert_null(sph_operator_create(NULL, NULL));
}

static void bad_points(void **state)
{
  (void)state;
  sph_error e = {0};
  sph_operator *op = sph_operator_create(&(sph_operator_def){.dim = 2, .h = 1}, &e);
  double a[] = {0, 1, 2}, b[] = {0, NAN, 0}, V[] = {1, 1, 1}, bad[] = {1, 0, 1}, out[3];
  const double *const x[] = {a, a}, *const lost[] = {a, b}, *const half[] = {a, NULL};
  refused(sph_operator_interpolate(op, a, out, &e), &e, SPH_ERR_STATE, "set_points first");
  refused(sph_operator_set_probes(op, 3, x, &e), &e, SPH_ERR_STATE, "set_points first");
  refused(sph_operator_set_points(op, 3, lost, V, NULL, &e), &e, SPH_ERR_ARGUMENT,
          "coordinate 1 of point 1 is nan m");
  refused(sph_operator_set_points(op, 3, half, V, NULL, &e), &e, SPH_ERR_ARGUMENT, "x[1] is NULL");
  refused(sph_operator_set_points(op, 3, NULL, V, NULL, &e), &e, SPH_ERR_ARGUMENT, "x[0] is NULL");
  refused(sph_operator_set_points(op, 3, x, NULL, NULL, &e), &e, SPH_ERR_ARGUMENT, "volume NULL");
  refused(sph_operator_set_points(op, -1, x, V, NULL, &e), &e, SPH_ERR_ARGUMENT, "-1 points");
  refused(sph_operator_set_points(op, 3, x, bad, NULL, &e), &e, SPH_ERR_ARGUMENT,
          "volume of point 1 is 0 m^dim");
  refused(sph_operator_set_points(op, 3, x, V, bad, &e), &e, SPH_ERR_ARGUMENT,
          "density of point 1 is 0");
  refused(sph_operator_interpolate(op, a, out, &e), &e, SPH_ERR_STATE, "set_points first");
  assert_int_equal(sph_operator_set_points(op, 3, x, V, NULL, &e), 0);
  refused(sph_operator_set_probes(op, -2, x, &e), &e, SPH_ERR_ARGUMENT, "-2 probes");
  refused(sph_operator_set_probes(op, 3, lost, &e), &e, SPH_ERR_ARGUMENT, "is nan m");
  assert_int_equal(sph_operator_interpolate(op, a, out, &e), 0); /* at the points again */
  assert_int_equal(sph_operator_set_points(op, 0, NULL, NULL, NULL, &e), 0);
  assert_int_equal(sph_operator_interpolate(op, a, out, &e), 0);
  sph_operator_free(op);
  sph_operator_free(NULL);
}

static void bad_arguments(void **state)
{
  (void)state;
  sph_error e = {0};
  scene s = scene_make(2, 0, 0);
  double *f = s.field[0], *hole[] = {s.out[0], NULL};
  const double *const u[] = {f, NULL}, *const x[] = {f, f};
  refused(sph_operator_gradient(s.op, "symetric", f, s.out, &e), &e, SPH_ERR_ARGUMENT,
          "form \"symetric\"; did you mean 'symmetric'? known: plain, difference, density");
  refused(sph_operator_gradient(s.op, NULL, f, s.out, &e), &e, SPH_ERR_ARGUMENT, "known: plain");
  refused(sph_operator_gradient(s.op, "plain", NULL, s.out, &e), &e, SPH_ERR_ARGUMENT,
          "f[0] is NULL");
  refused(sph_operator_gradient(s.op, "plain", f, hole, &e), &e, SPH_ERR_ARGUMENT,
          "gradient[1] is NULL; right are 2 arrays");
  refused(sph_operator_divergence(s.op, "plain", u, s.out[0], &e), &e, SPH_ERR_ARGUMENT,
          "u[1] is NULL");
  refused(sph_operator_curl(s.op, "plain", NULL, s.out, &e), &e, SPH_ERR_ARGUMENT, "u[0] is NULL");
  refused(sph_operator_laplacian(s.op, "fatehi", NULL, f, s.out[0], &e), &e, SPH_ERR_ARGUMENT,
          "known: arithmetic, harmonic, corrected, fatehi-manzari");
  refused(sph_operator_laplacian(s.op, "corrected", f, f, s.out[0], &e), &e, SPH_ERR_ARGUMENT,
          "takes no k");
  f[7] = -1;
  refused(sph_operator_laplacian(s.op, "harmonic", f, f, s.out[0], &e), &e, SPH_ERR_ARGUMENT,
          "k of point 7 is -1");
  f[7] = s.a;
  refused(sph_operator_mls(s.op, 3, f, s.out[0], NULL, NULL, &e), &e, SPH_ERR_ARGUMENT,
          "order = 3; right is 1 or 2");
  refused(sph_operator_mls(s.op, 1, f, s.out[0], NULL, s.out, &e), &e, SPH_ERR_ARGUMENT,
          "no second derivatives");
  refused(sph_operator_grad_div(s.op, u, s.out, &e), &e, SPH_ERR_ARGUMENT, "u[1] is NULL");
  refused(sph_operator_mcg(s.op, x, NULL, &e), &e, SPH_ERR_ARGUMENT, "out[0] is NULL");
  assert_int_equal(sph_operator_set_probes(s.op, 1, x, &e), 0);
  refused(sph_operator_gradient(s.op, "corrected", f, s.out, &e), &e, SPH_ERR_STATE,
          "needs the field at the place itself");
  refused(sph_operator_mcg(s.op, x, s.out, &e), &e, SPH_ERR_STATE, "needs the field");
  refused(sph_operator_interpolate(NULL, f, s.out[0], &e), &e, SPH_ERR_STATE, "set_points first");
  refused(sph_operator_curl(NULL, "plain", x, s.out, &e), &e, SPH_ERR_STATE, "set_points first");
  scene_free(&s);
  sph_operator *line = sph_operator_create(&(sph_operator_def){.dim = 1, .h = 1}, NULL);
  refused(sph_operator_curl(line, "plain", x, hole, &e), &e, SPH_ERR_ARGUMENT, "dim = 1");
  sph_operator_free(line);
}

/* Points on a line in 2D, a pair, and a lone one: first what is told, then what is done instead. */
static void singular(void **state)
{
  (void)state;
  double x[] = {0, 0.5, 1, 1.5, 9, 9.3, 30}, y[] = {0, 0, 0, 0, 0, 0.4, 0}, V[7], f[7], out[3][7];
  const double *const at[] = {x, y};
  double *const gradient[] = {out[1], out[2]};
  for (int i = 0; i < 7; i++) V[i] = 0.25, f[i] = 3 + 2 * x[i];
  sph_error e = {0};
  for (int lower = 0; lower < 2; lower++) {
    sph_operator *op =
        sph_operator_create(&(sph_operator_def){.dim = 2, .h = 1, .lower_order = lower}, &e);
    assert_int_equal(sph_operator_set_points(op, 7, at, V, NULL, &e), 0);
    int status[] = {sph_operator_gradient(op, "corrected", f, gradient, lower ? &e : NULL),
                    sph_operator_mls(op, 1, f, out[0], gradient, NULL, lower ? &e : NULL),
                    sph_operator_mls(op, 2, f, out[0], gradient, NULL, lower ? &e : NULL),
                    sph_operator_cspm(op, f, out[0], gradient, lower ? &e : NULL),
                    sph_operator_laplacian(op, "corrected", NULL, f, out[0], lower ? &e : NULL),
                    sph_operator_laplacian(op, "fatehi-manzari", NULL, f, out[0],
                                           lower ? &e : NULL)};
    for (int k = 0; k < 6; k++) assert_int_equal(status[k], lower ? 0 : SPH_ERR_ARGUMENT);
    assert_int_equal(sph_operator_lowered(op), lower ? 7 : 0);
    if (!lower)
      refused(sph_operator_mls(op, 1, f, out[0], NULL, NULL, &e), &e, SPH_ERR_ARGUMENT,
              "mls of order 1: singular moment matrix at point 0, (0, 0) m, which has 3 neighbours "
              "within 2 m; right are more");
    if (lower) {
      assert_int_equal(sph_operator_mls(op, 2, f, out[0], gradient, NULL, &e), 0);
      assert_near(out[0][6], f[6], 1e-14); /* alone: Shepard, its own value */
      assert_near(out[1][6], 0, 0);
      double difference[7], *const other[] = {difference, out[0]};
      assert_int_equal(sph_operator_gradient(op, "corrected", f, gradient, &e), 0);
      assert_int_equal(sph_operator_gradient(op, "difference", f, other, &e), 0);
      assert_memory_equal(difference, out[1], sizeof difference);
      const double far[] = {100, 0.1}, *const probe[] = {far, far + 1};
      assert_int_equal(sph_operator_set_probes(op, 1, probe, &e), 0);
      assert_int_equal(sph_operator_shepard(op, f, out[0], &e), 0);
      assert_near(out[0][0], 0, 0);
      assert_int_equal(sph_operator_lowered(op), 1);
    }
    sph_operator_free(op);
  }
  sph_operator *op = sph_operator_create(&(sph_operator_def){.dim = 2, .h = 1}, &e);
  for (int i = 0; i < 4; i++) y[i] = i % 2 ? 1e-7 : 0; /* nearly on a line */
  assert_int_equal(sph_operator_set_points(op, 4, at, V, NULL, &e), 0);
  refused(sph_operator_gradient(op, "corrected", f, gradient, &e), &e, SPH_ERR_ARGUMENT,
          "gradient \"corrected\": singular moment matrix at point 0");
  for (int i = 0; i < 4; i++) y[i] = i % 2 ? 1e-3 : 0; /* not quite so */
  assert_int_equal(sph_operator_set_points(op, 4, at, V, NULL, &e), 0);
  assert_int_equal(sph_operator_gradient(op, "corrected", f, gradient, &e), 0);
  for (int i = 0; i < 4; i++) assert_near(out[1][i], 2, 1e-9);
  assert_int_equal(sph_operator_set_points(op, 7, at, V, NULL, &e), 0);
  const double far[] = {100, 0.1}, *const probe[] = {far, far + 1};
  assert_int_equal(sph_operator_set_probes(op, 1, probe, &e), 0);
  refused(sph_operator_shepard(op, f, out[0], &e), &e, SPH_ERR_ARGUMENT,
          "shepard: singular moment matrix at probe 0, (100, 0.1) m, which has 0 neighbours");
  assert_int_equal(sph_operator_set_probes(op, 0, NULL, &e), 0); /* at the points again */
  assert_int_equal(sph_operator_shepard(op, f, out[0], &e), 0);
  sph_operator_free(op);
}

/* All points at one place, some in twos, some far away: finite, whatever the operator. */
static void hostile(void **state)
{
  (void)state;
  enum { N = 60 };
  double x[3][N], V[N], f[N], out[9][N];
  double *to[9];
  const double *const at[] = {x[0], x[1], x[2]}, *const u[] = {f, x[0], f};
  for (int o = 0; o < 9; o++) to[o] = out[o];
  for (int kind = 0; kind < 3; kind++)
    for (int dim = 1; dim <= 3; dim++)
      for (int kernel = 0; sph_kernel_get(kernel); kernel++) {
        cloud noise = {.state = 5};
        for (int i = 0; i < N; i++) {
          for (int d = 0; d < 3; d++)
            x[d][i] = kind == 0   ? 0.1
                      : kind == 1 ? (i % 2 ? x[d][i - 1] : 2 * cloud_noise(&noise))
                                  : cloud_noise(&noise) * pow(10, i % 5 * 3);
          V[i] = pow(10, cloud_noise(&noise)), f[i] = cloud_noise(&noise);
        }
        sph_error e = {0};
        const sph_operator_def def = {.dim = dim,
                                      .h = 1,
                                      .kernel = sph_kernel_name(sph_kernel_get(kernel)),
                                      .lower_order = 1};
        sph_operator *op = sph_operator_create(&def, &e);
        assert_int_equal(sph_operator_set_points(op, N, at, V, NULL, &e), 0);
        for (int k = 0; sph_operator_gradient_form(k); k++)
          sph_operator_gradient_vector(op, sph_operator_gradient_form(k), u, to, &e);
        for (int k = 0; sph_operator_laplacian_form(k); k++)
          sph_operator_laplacian(op, sph_operator_laplacian_form(k), NULL, f, to[k], &e);
        sph_operator_mls(op, 2, f, to[4], NULL, NULL, &e);
        sph_operator_cspm(op, f, to[5], NULL, &e);
        sph_operator_grad_div(op, u, to + 6, &e);
        if (e.status) fail_msg("%s", e.text);
        for (int o = 0; o < 6 + dim; o++)
          for (int i = 0; i < N; i++)
            if (!isfinite(out[o][i])) fail_msg("result %d of point %d: %g", o, i, out[o][i]);
        sph_operator_free(op);
      }
}

/* What is not finite stays where it is: within the support. */
static void spreads_no_further(void **state)
{
  (void)state;
  scene s = scene_make(2, 0, 0);
  const long bad = s.c.n / 2;
  s.field[2][bad] = NAN;
  assert_int_equal(sph_operator_gradient(s.op, "corrected", s.field[2], s.out, NULL), 0);
  assert_int_equal(sph_operator_mls(s.op, 2, s.field[2], s.out[2], NULL, NULL, NULL), 0);
  assert_int_equal(sph_operator_laplacian(s.op, "fatehi-manzari", NULL, s.field[2], s.out[3], NULL),
                   0);
  for (long i = 0; i < s.c.n; i++) {
    const double r = hypot(s.c.x[0][i] - s.c.x[0][bad], s.c.x[1][i] - s.c.x[1][bad]);
    for (int o = 0; o < 4; o++)
      assert_int_equal(isfinite(s.out[o][i]) != 0, r >= reach[1] * s.c.dx);
  }
  scene_free(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(constants),
                                     cmocka_unit_test(linear),
                                     cmocka_unit_test(quadratic),
                                     cmocka_unit_test(vectors),
                                     cmocka_unit_test(pairs),
                                     cmocka_unit_test(bad_definitions),
                                     cmocka_unit_test(bad_points),
                                     cmocka_unit_test(bad_arguments),
                                     cmocka_unit_test(spreads_no_further),
                                     cmocka_unit_test(singular),
                                     cmocka_unit_test(hostile)};
  return cmocka_run_group_tests(tests, NULL, tell);
}
