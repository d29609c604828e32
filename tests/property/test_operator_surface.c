/* Where a body of points ends: the values of lattices, computed elsewhere; all of the outermost
 * layer and nothing deep inside; normals of a disc and a ball. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_eigen.h>
#include <math.h>

#include "cloud.h"
#include "near.h"

typedef struct body {
  cloud c;
  sph_operator *op;
  int *state;
  double *measure, *normal[3];
} body;

static body make(cloud c, const sph_kernel *kernel, double h_over_dx)
{
  body b = {.c = c};
  b.op = cloud_operator(&c, (sph_operator_def){.h = h_over_dx * c.dx,
                                               .kernel = sph_kernel_name(kernel)});
  b.state = calloc((size_t)c.n, sizeof *b.state);
  b.measure = cloud_array(c.n);
  for (int d = 0; d < 3; d++) b.normal[d] = cloud_array(c.n);
  return b;
}

static void drop(body *b)
{
  sph_operator_free(b->op);
  cloud_free(&b->c);
  free(b->state), free(b->measure);
  for (int d = 0; d < 3; d++) free(b->normal[d]);
}

static void look(body *b, const char *method)
{
  sph_error error = {0};
  if (sph_operator_surface(b->op, method, b->state, b->measure, b->normal, &error))
    fail_msg("%s", error.text);
}

/* The divergence of x on square and cubic lattices, Wendland C2, h = 1.5 dx: inside, at a face, in
 * a corner; by a program of its own in numpy. */
static void lattices(void **state)
{
  static const double right[][3] = {{1.9947985368877896, 1.2419171508347355, 0.743217516612788},
                                    {3.00185790041182, 1.9996285844278572, 0.8409511691145036}};
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    const int n = dim == 2 ? 30 : 14;
    body b = make(cloud_make(dim, n, 0, 0, 0), sph_kernel_find("wendland-c2"), 1.5);
    look(&b, "divergence");
    const long half = n / 2, face = dim == 2 ? half : half * n + half;
    const long inside = dim == 2 ? half * n + half : (half * n + half) * n + half;
    assert_near(b.measure[inside], right[dim - 2][0], 1e-12);
    assert_near(b.measure[face], right[dim - 2][1], 1e-12);
    assert_near(b.measure[0], right[dim - 2][2], 1e-12);
    drop(&b);
  }
}

/* Distance from the nearest face of the box [dx]. */
static double depth(const cloud *c, long i)
{
  double face = 1;
  for (int d = 0; d < c->dim; d++) face = fmin(face, 0.5 - fabs(c->x[d][i] - 0.5));
  return face / c->dx;
}

static void layers(void **state)
{
  static const int across[] = {30, 20, 10};
  (void)state;
  for (int k = 0; sph_kernel_get(k); k++)
    for (int dim = 1; dim <= 3; dim++)
      for (int jitter = 0; jitter < 2; jitter++)
        for (int m = 0; sph_operator_surface_method(m); m++) {
          const sph_kernel *kernel = sph_kernel_get(k);
          body b = make(cloud_make(dim, across[dim - 1], 0.1 * jitter, 0, 0), kernel,
                        sph_kernel_h_over_dx(kernel));
          look(&b, sph_operator_surface_method(m));
          for (long i = 0; i < b.c.n; i++) {
            const double face = depth(&b.c, i);
            if (face < 0.7 && b.state[i] == SPH_INSIDE) /* a corner of a cube may be "alone" */
              fail_msg("%s, %s, %dD: %g dx from a face, but not at it: %g", sph_kernel_name(kernel),
                       sph_operator_surface_method(m), dim, face, b.measure[i]);
            if (face > 1.7 && b.state[i] != SPH_INSIDE)
              fail_msg("%s, %s, %dD: %g dx from a face, but at it: %g", sph_kernel_name(kernel),
                       sph_operator_surface_method(m), dim, face, b.measure[i]);
          }
          drop(&b);
        }
}

/* Points of the lattice in a disc or ball of radius 0.4; normals are radii. */
static void round_ones(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    cloud c = cloud_make(dim, dim == 2 ? 40 : 20, 0.1, 0, 0);
    long n = 0;
    for (long i = 0; i < c.n; i++) {
      double r2 = 0;
      for (int d = 0; d < dim; d++) r2 += pow(c.x[d][i] - 0.5, 2);
      if (r2 > 0.16) continue;
      for (int d = 0; d < dim; d++) c.x[d][n] = c.x[d][i];
      n++;
    }
    c.n = n;
    body b = make(c, sph_kernel_find("wendland-c2"), 1.5);
    for (int m = 0; sph_operator_surface_method(m); m++) {
      double worst = 1;
      long count = 0;
      look(&b, sph_operator_surface_method(m));
      for (long i = 0; i < n; i++) {
        double r = 0, along = 0, length = 0;
        for (int d = 0; d < dim; d++) r += pow(c.x[d][i] - 0.5, 2);
        r = sqrt(r);
        for (int d = 0; d < dim; d++) {
          along += b.normal[d][i] * (c.x[d][i] - 0.5) / r;
          length += pow(b.normal[d][i], 2);
        }
        assert_near(length, 1, 1e-14);
        if (0.4 - r < 0.5 * c.dx) assert_int_equal(b.state[i], SPH_SURFACE);
        if (0.4 - r > 2.2 * c.dx) assert_int_equal(b.state[i], SPH_INSIDE);
        if (b.state[i] == SPH_SURFACE) worst = fmin(worst, along), count++;
      }
      print_message("# %dD, %s: %ld of %ld at the surface, normals within %.1f degrees\n", dim,
                    sph_operator_surface_method(m), count, n, acos(worst) * 180 / acos(-1));
      assert_true(worst > cos(25 * acos(-1) / 180));
    }
    drop(&b);
  }
}

/* Least eigenvalues of M, which is the difference gradient of x, by another algorithm of GSL. */
static void eigenvalues(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++) {
    body b = make(cloud_make(dim, dim == 3 ? 7 : 12, 0.3, 0, 1), sph_kernel_get(0), 1.4);
    double *M[9];
    for (int k = 0; k < 9; k++) M[k] = cloud_array(b.c.n);
    const double *const x[] = {b.c.x[0], b.c.x[1], b.c.x[2]};
    look(&b, "cone");
    assert_int_equal(sph_operator_gradient_vector(b.op, "difference", x, M, NULL), 0);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc((size_t)dim);
    gsl_matrix *A = gsl_matrix_alloc((size_t)dim, (size_t)dim);
    gsl_vector *lambda = gsl_vector_alloc((size_t)dim);
    for (long i = 0; i < b.c.n; i++) {
      for (int k = 0; k < dim * dim; k++)
        gsl_matrix_set(A, (size_t)(k / dim), (size_t)(k % dim), M[k][i]);
      gsl_eigen_symm(A, lambda, work);
      assert_near(b.measure[i], gsl_vector_min(lambda), 1e-13);
    }
    gsl_eigen_symm_free(work), gsl_matrix_free(A), gsl_vector_free(lambda);
    for (int k = 0; k < 9; k++) free(M[k]);
    drop(&b);
  }
}

/* One point alone, and what is refused. */
static void odd_ones(void **state)
{
  (void)state;
  sph_error e = {0};
  double x[] = {0.5}, V[] = {1}, measure[1], nx[1], ny[1];
  const double *const at[] = {x, x};
  double *const normal[] = {nx, ny}, *const half[] = {nx, NULL};
  int is[1];
  sph_operator *op = sph_operator_create(&(sph_operator_def){.dim = 2, .h = 1}, &e);
  assert_int_equal(sph_operator_surface(op, "cone", is, NULL, NULL, &e), SPH_ERR_STATE);
  e = (sph_error){0};
  assert_int_equal(sph_operator_set_points(op, 1, at, V, NULL, &e), 0);
  assert_int_equal(sph_operator_surface(op, "cone", is, measure, normal, &e), 0);
  assert_int_equal(is[0], SPH_ALONE);
  assert_near(measure[0], 0, 0);
  assert_near(fabs(nx[0]) + fabs(ny[0]), 0, 0);
  assert_int_equal(sph_operator_surface(op, "divergence", is, NULL, NULL, &e), 0);
  assert_int_equal(is[0], SPH_SURFACE);
  assert_int_equal(sph_operator_surface(op, "cones", is, NULL, NULL, &e), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(e.text, "method \"cones\"; did you mean 'cone'? known: divergence, cone"));
  e = (sph_error){0};
  assert_int_equal(sph_operator_surface(op, "cone", NULL, NULL, NULL, &e), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(e.text, "state is NULL"));
  e = (sph_error){0};
  assert_int_equal(sph_operator_surface(op, "cone", is, NULL, half, &e), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(e.text, "normal[1] is NULL"));
  sph_operator_free(op);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(lattices), cmocka_unit_test(layers),
                                     cmocka_unit_test(round_ones), cmocka_unit_test(eigenvalues),
                                     cmocka_unit_test(odd_ones)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
