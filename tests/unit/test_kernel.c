/* Kernels against a table made with 50 digits, against GSL's quadrature and differentiation, and
 * the shapes of four lanes against those of one. */
#define SPH_LANES 4
#pragma GCC diagnostic ignored "-Wpsabi" /* all is inlined: no call passes a vector */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_deriv.h>
#include <gsl/gsl_integration.h>

#include "sphode/kernel.h"
#include "sphode/kernel_shape.h"

typedef struct at {
  const sph_kernel *kernel;
  int dim;
  double r, h;
} at;

/* Every kernel in every dimension. */
static int next(at *a)
{
  static int k;
  if (!a->kernel) k = 0, a->dim = 0;
  if (a->dim == 3) k++, a->dim = 0;
  a->kernel = sph_kernel_get(k);
  a->dim++;
  return a->kernel != NULL;
}

static void assert_near(double found, double expected, double tolerance, const char *what)
{
  if (fabs(found - expected) <= tolerance) return; /* NaN fails */
  fail_msg("%s: %.17g, expected %.17g +- %g", what, found, expected, tolerance);
}

/* "wendland_c2" of the table is "wendland-c2". */
static const sph_kernel *kernel_of(char *name)
{
  for (char *c = name; *c; c++)
    if (*c == '_') *c = '-';
  return sph_kernel_find(name);
}

static void table(void **state)
{
  (void)state;
  const char *folder = getenv("srcdir");
  char path[4096], line[256], name[64];
  snprintf(path, sizeof path, "%s/tests/data/kernel_table.csv", folder ? folder : ".");
  FILE *file = fopen(path, "r");
  if (!file) fail_msg("%s: cannot be read", path);
  int rows = 0, dim;
  double q, w, dwdr, laplacian;
  while (fgets(line, sizeof line, file)) {
    if (sscanf(line, "%63[^,],%d,%lf,%lf,%lf,%lf", name, &dim, &q, &w, &dwdr, &laplacian) != 6)
      continue;
    const sph_kernel *kernel = kernel_of(name);
    if (!kernel) continue;
    for (double h = 0.25; h < 5; h *= 4) { /* powers of two: exact scaling */
      double scale = pow(h, dim), r = q * h;
      assert_near(sph_kernel_w(kernel, dim, r, h) * scale, w, 1e-12, line);
      assert_near(sph_kernel_dwdr(kernel, dim, r, h) * scale * h, dwdr, 1e-12, line);
      assert_near(sph_kernel_f(kernel, dim, r, h) * q * scale * h * h, dwdr, 1e-12, line);
      assert_near(sph_kernel_laplacian(kernel, dim, r, h) * scale * h * h, laplacian, 1e-12, line);
    }
    rows++;
  }
  fclose(file);
  assert_int_equal(rows, 15 * SPH_KERNELS); /* 3 dimensions, 5 q */
}

static double shell(double r, void *context) /* W times the area of the sphere of radius r */
{
  const at *a = context;
  const double area[] = {2, 2 * M_PI * r, 4 * M_PI * r * r};
  return area[a->dim - 1] * sph_kernel_w(a->kernel, a->dim, r, a->h);
}

static void integral(void **state)
{
  (void)state;
  gsl_integration_workspace *room = gsl_integration_workspace_alloc(200);
  for (at a = {.h = 0.3}; next(&a);) {
    double sum, error, knots[] = {0, a.h, 2 * a.h, 3 * a.h};
    size_t n = (size_t)sph_kernel_support(a.kernel) + 1;
    gsl_function f = {shell, &a};
    gsl_integration_qagp(&f, knots, n, 0, 1e-13, 200, room, &sum, &error);
    assert_near(sum, 1, 1e-10, sph_kernel_name(a.kernel));
  }
  gsl_integration_workspace_free(room);
}

static double of_r(double r, void *context)
{
  const at *a = context;
  return sph_kernel_w(a->kernel, a->dim, r, a->h);
}
static double of_h(double h, void *context)
{
  const at *a = context;
  return sph_kernel_w(a->kernel, a->dim, a->r, h);
}
static double slope(double r, void *context)
{
  const at *a = context;
  return sph_kernel_dwdr(a->kernel, a->dim, r, a->h);
}

static double derivative(double (*function)(double, void *), at *a, double x)
{
  double result, error;
  gsl_function f = {function, a};
  gsl_deriv_central(&f, x, 1e-3 * a->h, &result, &error);
  return result;
}

/* Relative to the size that each has at h: W(0)/h, W(0)/h^2. */
static void derivatives(void **state)
{
  (void)state;
  for (at a = {.h = 0.7}; next(&a);) {
    double unit = sph_kernel_w(a.kernel, a.dim, 0, a.h) / a.h;
    for (double q = 0.05; q < sph_kernel_support(a.kernel) + 0.2; q += 0.1) { /* never at a knot */
      a.r = q * a.h;
      double w = sph_kernel_w(a.kernel, a.dim, a.r, a.h);
      double dwdr = sph_kernel_dwdr(a.kernel, a.dim, a.r, a.h);
      double dwdh = sph_kernel_dwdh(a.kernel, a.dim, a.r, a.h);
      double laplacian = derivative(slope, &a, a.r) + (a.dim - 1) * dwdr / a.r;
      assert_near(dwdr, derivative(of_r, &a, a.r), 1e-8 * unit, "dW/dr");
      assert_near(dwdh, derivative(of_h, &a, a.h), 1e-8 * unit, "dW/dh");
      assert_near(dwdh, -(a.dim * w + a.r * dwdr) / a.h, 1e-14 * unit, "dW/dh identity");
      assert_near(sph_kernel_laplacian(a.kernel, a.dim, a.r, a.h), laplacian, 1e-8 * unit / a.h,
                  "laplacian");
    }
  }
}

static void support(void **state)
{
  (void)state;
  for (at a = {.h = 0.1}; next(&a);) {
    double kappa = sph_kernel_support(a.kernel);
    assert_true(isfinite(sph_kernel_f(a.kernel, a.dim, 0, a.h)));
    assert_true(sph_kernel_f(a.kernel, a.dim, 0, a.h) < 0);
    assert_true(sph_kernel_dwdr(a.kernel, a.dim, 0, a.h) == 0);
    for (double q = 1e-9; q < kappa * (1 - 1e-9); q += 1e-3) { /* positive, falling to the edge */
      assert_true(sph_kernel_w(a.kernel, a.dim, q * a.h, a.h) > 0);
      assert_true(sph_kernel_f(a.kernel, a.dim, q * a.h, a.h) < 0);
    }
    for (double gap = 1e-3; gap > 1e-15; gap /= 3)
      assert_true(sph_kernel_f(a.kernel, a.dim, (kappa - gap) * a.h, a.h) <= 0);
    for (double q = kappa; q < 1e100; q *= 1.01) {
      double r = q * (1 + 1e-15) * a.h;
      assert_true(sph_kernel_w(a.kernel, a.dim, r, a.h) == 0);
      assert_true(sph_kernel_f(a.kernel, a.dim, r, a.h) == 0);
      assert_true(sph_kernel_dwdr(a.kernel, a.dim, r, a.h) == 0);
      assert_true(sph_kernel_dwdh(a.kernel, a.dim, r, a.h) == 0);
      assert_true(sph_kernel_laplacian(a.kernel, a.dim, r, a.h) == 0);
    }
  }
}

static void lanes(void **state)
{
  (void)state;
  for (at a = {.h = 1}; next(&a);) {
    double sigma = sph_kernel_sigma(a.kernel, a.dim);
    int k = 0;
    while (sph_kernel_get(k) != a.kernel) k++;
    for (double q = 0; q < sph_kernel_support(a.kernel) + 1; q += 0.0371) {
      double four[4] = {q, q + 0.01, q + 0.02, q + 0.03}, w[4], f[4], l[4];
      v_store(w, kernel_shape_w(k, a.dim, v_load(four)));
      v_store(f, kernel_shape_f(k, a.dim, v_load(four)));
      v_store(l, kernel_shape_laplacian(k, a.dim, v_load(four)));
      for (int lane = 0; lane < 4; lane++) {
        double r = four[lane];
        assert_near(sigma * w[lane], sph_kernel_w(a.kernel, a.dim, r, 1), 4e-16, "w");
        assert_near(sigma * f[lane], sph_kernel_f(a.kernel, a.dim, r, 1), 4e-15, "f");
        assert_near(sigma * l[lane], sph_kernel_laplacian(a.kernel, a.dim, r, 1), 1e-14, "l");
      }
    }
  }
}

static void facts(void **state)
{
  (void)state;
  assert_null(sph_kernel_get(-1));
  assert_null(sph_kernel_get(SPH_KERNELS));
  assert_null(sph_kernel_find("wendland"));
  assert_null(sph_kernel_find(NULL));
  for (at a = {0}; next(&a);) {
    assert_ptr_equal(sph_kernel_find(sph_kernel_name(a.kernel)), a.kernel);
    assert_non_null(strstr(sph_kernel_formula(a.kernel, a.dim), "q = r/h"));
    assert_int_equal(sph_kernel_smoothness(a.kernel)[0], 'C');
    assert_true(sph_kernel_h_over_dx(a.kernel) >= 1);
    assert_true(isnan(sph_kernel_w(a.kernel, 0, 0, 1)));
    assert_true(isnan(sph_kernel_f(a.kernel, 4, 0, 1)));
    assert_true(isnan(sph_kernel_w(a.kernel, a.dim, 0.1, 0)));
    assert_true(isnan(sph_kernel_dwdr(a.kernel, a.dim, 0.1, -1)));
    assert_true(isnan(sph_kernel_dwdh(a.kernel, a.dim, 0.1, NAN)));
    assert_null(sph_kernel_formula(a.kernel, 4));
  }
  assert_true(isnan(sph_kernel_w(NULL, 2, 0.1, 1)));
  assert_true(isnan(sph_kernel_sigma(NULL, 2)));
  assert_null(sph_kernel_name(NULL));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(table),   cmocka_unit_test(integral), cmocka_unit_test(derivatives),
      cmocka_unit_test(support), cmocka_unit_test(lanes),    cmocka_unit_test(facts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
