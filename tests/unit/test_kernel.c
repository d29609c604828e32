/* Kernels against a table made with 50 digits, against GSL's quadrature and differentiation, and
 * the shapes of every instruction set against the formulas in long double. */
#define SPH_LANES 1
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
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sf_bessel.h>

#include "kernel_lanes.h"
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

static double largest; /* error of assert_near, of its tolerance */

static void assert_near(double found, double expected, double tolerance, const char *what)
{
  largest = fmax(largest, fabs(found - expected) / tolerance);
  if (found == expected || fabs(found - expected) <= tolerance) return; /* NaN fails */
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
  largest = 0;
  double q, w, dwdr, laplacian;
  while (fgets(line, sizeof line, file)) {
    if (sscanf(line, "%63[^,],%d,%lf,%lf,%lf,%lf", name, &dim, &q, &w, &dwdr, &laplacian) != 6)
      continue;
    const sph_kernel *kernel = kernel_of(name);
    if (!kernel) fail_msg("%s is not known", name);
    for (double h = 0.25; h < 5; h *= 4) { /* powers of two: exact scaling */
      double scale = pow(h, dim), r = q * h;
      assert_near(sph_kernel_w(kernel, dim, r, h) * scale, w, 1e-12, line);
      assert_near(sph_kernel_dwdr(kernel, dim, r, h) * scale * h, dwdr, 1e-12, line);
      if (q > 0)
        assert_near(sph_kernel_f(kernel, dim, r, h) * q * scale * h * h, dwdr, 1e-12, line);
      assert_near(sph_kernel_laplacian(kernel, dim, r, h) * scale * h * h, laplacian, 1e-12, line);
    }
    rows++;
  }
  fclose(file);
  assert_int_equal(rows, 3 * (5 * 5 + 3 * 7)); /* 3 dimensions, q = 0, 0.5, ... kappa */
  print_message("# table, %d rows: error %.2g\n", rows, largest * 1e-12);
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
  largest = 0;
  for (at a = {.h = 0.3}; next(&a);) {
    double sum, error, knots[] = {0, a.h, 2 * a.h, 3 * a.h};
    size_t n = (size_t)sph_kernel_support(a.kernel) + 1;
    gsl_function f = {shell, &a};
    gsl_integration_qagp(&f, knots, n, 0, 1e-13, 200, room, &sum, &error);
    assert_near(sum, 1, 1e-10, sph_kernel_name(a.kernel));
  }
  gsl_integration_workspace_free(room);
  print_message("# integrals: error %.2g\n", largest * 1e-10);
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
  largest = 0;
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
      assert_true(fabs(dwdh + (a.dim * w + a.r * dwdr) / a.h) <= 1e-14 * unit);
      assert_near(sph_kernel_laplacian(a.kernel, a.dim, a.r, a.h), laplacian, 1e-8 * unit / a.h,
                  "laplacian");
    }
  }
  print_message("# derivatives: error %.2g\n", largest * 1e-8);
}

/* Zero from the edge on, of one sign up to it; F is finite at 0, but for spiky's. */
static void support(void **state)
{
  (void)state;
  for (at a = {.h = 0.125}; next(&a);) { /* r/h is q, exactly */
    double kappa = sph_kernel_support(a.kernel), h = a.h;
    int jumps = !strcmp(sph_kernel_name(a.kernel), "gaussian"), d = a.dim;
    if (strcmp(sph_kernel_name(a.kernel), "spiky")) {
      assert_true(isfinite(sph_kernel_f(a.kernel, d, 0, h)));
      assert_true(sph_kernel_f(a.kernel, d, 0, h) < 0);
      assert_true(sph_kernel_dwdr(a.kernel, d, 0, h) == 0);
    }
    for (double q = 1e-9; q < kappa * (1 - 1e-9); q += 1e-3) { /* positive, falling to the edge */
      assert_true(sph_kernel_w(a.kernel, d, q * h, h) > 0);
      assert_true(sph_kernel_f(a.kernel, d, q * h, h) < 0);
    }
    for (double gap = 1e-3; gap > 1e-15; gap /= 3) {
      assert_true(sph_kernel_w(a.kernel, d, (kappa - gap) * h, h) >= 0);
      assert_true(sph_kernel_f(a.kernel, d, (kappa - gap) * h, h) <= 0);
    }
    double inside = nextafter(kappa, 0) * h;
    assert_true((sph_kernel_w(a.kernel, d, inside, h) > 1e-5) == jumps);
    for (double r = kappa * h; r < 1e300; r *= 1.01) {
      assert_true(sph_kernel_w(a.kernel, d, r, h) == 0);
      assert_true(sph_kernel_f(a.kernel, d, r, h) == 0);
      assert_true(sph_kernel_dwdr(a.kernel, d, r, h) == 0);
      assert_true(sph_kernel_dwdh(a.kernel, d, r, h) == 0);
      assert_true(sph_kernel_laplacian(a.kernel, d, r, h) == 0);
    }
  }
}

/* What a pair loop adds for a particle with itself: the zero vector, of spiky too. */
static void self(void **state)
{
  (void)state;
  for (int k = 0; k < SPH_KERNELS; k++)
    for (int dim = 1; dim <= 3; dim++) {
      vec zero = v_set(0), f = kernel_shape_f(k, dim, zero), r_f = zero * f;
      assert_true(isfinite(f[0]) && r_f[0] == 0);
    }
}

/* f of a distance, as loops take it: that of q to rounding, not above 0 at the edge, 0 behind. */
static void f_at(void **state)
{
  (void)state;
  for (int k = 0; k < SPH_KERNELS; k++)
    for (int dim = 1; dim <= 3; dim++) {
      const double h = 0.37, edge = sph_kernel_support(sph_kernel_get(k)) * h;
      for (int n = 0; n <= 1000; n++) {
        const double r = edge * n / 1000, q = r / h, t = 1 - r / edge;
        const double f = kernel_shape_f(k, dim, v_set(q))[0];
        const double f_r = kernel_shape_f_at(k, dim, v_set(r), 1 / h)[0];
        /* one rounding of 1 - r/edge is 1e-16/t of t, of which f is a power of at most 7 */
        if (!(fabs(f_r - f) <= 1e-14 * fabs(f) + 2e-15 * fabs(f) / (t + 1e-16) && f_r <= 0))
          fail_msg("kernel %d, %dD, q = %g: %.17g, of q %.17g", k, dim, q, f_r, f);
      }
      const double beyond[] = {edge * (1 + 1e-12), 1.5 * edge, 1e100};
      for (int n = 0; n < 3; n++)
        assert_true(kernel_shape_f_at(k, dim, v_set(beyond[n]), 1 / h)[0] == 0);
    }
}

/* The shapes once more, in long double, by the formulas of the literature: branches, powers, expl.
 * w' = w'(q); s_k = (k - q)+ */
static long double power_of(long double k, long double q, int n)
{
  return q < k ? powl(k - q, n) : 0;
}
static long double long_w(const char *name, int dim, long double q)
{
  long double t = power_of(2, q, 1) / 2;
  if (!strcmp(name, "wendland-c2"))
    return dim == 1 ? powl(t, 3) * (1 + 1.5L * q) : powl(t, 4) * (1 + 2 * q);
  if (!strcmp(name, "wendland-c4"))
    return dim == 1 ? powl(t, 5) * (1 + 2.5L * q + 2 * q * q)
                    : powl(t, 6) * (1 + 3 * q + 35 * q * q / 12);
  if (!strcmp(name, "wendland-c6"))
    return dim == 1 ? powl(t, 7) * (1 + 3.5L * q + 4.75L * q * q + 2.625L * q * q * q)
                    : powl(t, 8) * (1 + 4 * q + 6.25L * q * q + 4 * q * q * q);
  if (!strcmp(name, "cubic-spline")) return power_of(2, q, 3) / 4 - power_of(1, q, 3);
  if (!strcmp(name, "quintic-spline"))
    return power_of(3, q, 5) - 6 * power_of(2, q, 5) + 15 * power_of(1, q, 5);
  if (!strcmp(name, "gaussian")) return q < 3 ? expl(-q * q) : 0;
  if (!strcmp(name, "gaussian-shifted")) return q < 3 ? expl(-q * q) - expl(-9) : 0;
  return power_of(2, q, 3); /* spiky */
}
static long double long_slope(const char *name, int dim, long double q)
{
  long double t = power_of(2, q, 1) / 2;
  if (!strcmp(name, "wendland-c2")) return -(dim == 1 ? 3 * t * t : 5 * t * t * t) * q;
  if (!strcmp(name, "wendland-c4"))
    return dim == 1 ? -3.5L * q * (1 + 2 * q) * powl(t, 4)
                    : -14 * q * (1 + 2.5L * q) * powl(t, 5) / 3;
  if (!strcmp(name, "wendland-c6"))
    return dim == 1 ? -3 * q * (12 + 36 * q + 35 * q * q) * powl(t, 6) / 8
                    : -11 * q * (2 + 7 * q + 8 * q * q) * powl(t, 7) / 4;
  if (!strcmp(name, "cubic-spline")) /* by the middle of each branch: no digits are lost at 0 */
    return q < 1 ? -3 * q + 9 * q * q / 4 : -0.75L * power_of(2, q, 2);
  if (!strcmp(name, "quintic-spline"))
    return q < 1 ? q * (-120 + 120 * q * q - 50 * q * q * q)
                 : -5 * power_of(3, q, 4) + 30 * power_of(2, q, 4);
  if (!strcmp(name, "spiky")) return -3 * power_of(2, q, 2);
  return q < 3 ? -2 * q * expl(-q * q) : 0; /* both Gaussians */
}

/* w'' */
static long double long_curvature(const char *name, int dim, long double q)
{
  long double t = power_of(2, q, 1) / 2, q2 = q * q, q3 = q * q * q;
  if (!strcmp(name, "wendland-c2"))
    return dim == 1 ? -3 * t * t + 3 * q * t : -5 * t * t * t + 7.5L * q * t * t;
  if (!strcmp(name, "wendland-c4"))
    return dim == 1 ? -3.5L * ((1 + 4 * q) * powl(t, 4) - 2 * (q + 2 * q2) * powl(t, 3))
                    : -14 * ((1 + 5 * q) * powl(t, 5) - 2.5L * (q + 2.5L * q2) * powl(t, 4)) / 3;
  if (!strcmp(name, "wendland-c6") && dim == 1)
    return -3 *
           ((12 + 72 * q + 105 * q2) * powl(t, 6) - 3 * (12 * q + 36 * q2 + 35 * q3) * powl(t, 5)) /
           8;
  if (!strcmp(name, "wendland-c6"))
    return -11 *
           ((2 + 14 * q + 24 * q2) * powl(t, 7) - 3.5L * (2 * q + 7 * q2 + 8 * q3) * powl(t, 6)) /
           4;
  if (!strcmp(name, "cubic-spline")) return q < 1 ? -3 + 4.5L * q : 1.5L * power_of(2, q, 1);
  if (!strcmp(name, "quintic-spline"))
    return 20 * power_of(3, q, 3) - 120 * power_of(2, q, 3) + 300 * power_of(1, q, 3);
  if (!strcmp(name, "spiky")) return 6 * power_of(2, q, 1);
  return q < 3 ? (4 * q2 - 2) * expl(-q2) : 0;
}

/* Worst relative error of each so far. */
static double worst[SPH_KERNELS];

/* w and f within 1e-14 of themselves (w of the shifted Gaussian: of exp(-q^2)), l within 1e-13 of
 * its parts. */
static void compare(int k, int dim, double q, double w, double f, double l)
{
  const char *name = sph_kernel_name(sph_kernel_get(k));
  double right_w = (double)long_w(name, dim, q), right = (double)(long_slope(name, dim, q) / q);
  double size = strcmp(name, "gaussian-shifted") || q >= 3 ? right_w : exp(-q * q);
  double curvature = (double)long_curvature(name, dim, q);
  worst[k] = fmax(worst[k], size > 0 ? fabs(w - right_w) / size : 0);
  worst[k] = fmax(worst[k], right < 0 ? fabs(f / right - 1) : 0);
  assert_near(w, right_w, 1e-14 * size, name);
  assert_near(f, right, -1e-14 * right, name);
  assert_near(l, curvature + (dim - 1) * right, 1e-13 * (fabs(curvature) - right), "laplacian");
}

/* Roots by every instruction set, by the divider or by Newton's steps: of zero zero, else within
 * two units of the last place. */
static void roots(void **state)
{
  (void)state;
  static kernel_roots *const roots_of[SPH_ISA_COUNT] = {
#define LANES(isa, loops) [SPH_ISA_##isa] = kernel_roots_##loops,
      SPH_ISA_BUILT_DOUBLE(LANES, x86_64_v4_newton)};
#undef LANES
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  for (int isa = 0; isa < SPH_ISA_COUNT; isa++) {
    if (sph_cpu_isa(sph_cpu_isa_name(isa), NULL) != isa) continue;
    double off = 0;
    for (int n = 0; n < 20000; n++) {
      double a[KERNEL_LANES] = {0}, root[KERNEL_LANES];
      for (int lane = 1; lane < KERNEL_LANES; lane++)
        a[lane] = exp((n % 2 ? 600 : 3) * (2 * gsl_rng_uniform(random) - 1));
      roots_of[isa](a, root);
      assert_true(root[0] == 0);
      for (int lane = 1; lane < KERNEL_LANES; lane++)
        off = fmax(off, fabs(root[lane] / sqrt(a[lane]) - 1));
    }
    print_message("# roots, %s: %.2g\n", sph_cpu_isa_name(isa), off);
    assert_true(off <= 4.5e-16);
  }
  gsl_rng_free(random);
}

/* Random q of [0, 4), half of them near 0, 1, 2, 3, by every instruction set. */
static void at_random(void **state)
{
  (void)state;
  static kernel_lanes *const lanes[SPH_ISA_COUNT] = {
#define LANES(isa, loops) [SPH_ISA_##isa] = kernel_lanes_##loops,
      SPH_ISA_BUILT_DOUBLE(LANES, x86_64_v4_newton)};
#undef LANES
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  int tried = 0;
  for (int isa = 0; isa < SPH_ISA_COUNT; isa++) {
    if (sph_cpu_isa(sph_cpu_isa_name(isa), NULL) != isa) continue;
    tried++;
    for (int n = 0; n < 6000; n++) {
      int k = n % SPH_KERNELS, dim = 1 + n / SPH_KERNELS % 3;
      double q[KERNEL_LANES], w[KERNEL_LANES], f[KERNEL_LANES], l[KERNEL_LANES];
      for (int lane = 0; lane < KERNEL_LANES; lane++)
        q[lane] = n / 24 % 2 ? 4 * gsl_rng_uniform_pos(random)
                             : fabs(floor(4 * gsl_rng_uniform(random)) +
                                    (lane % 2 ? 1 : -1) * exp(-30 * gsl_rng_uniform(random)));
      lanes[isa](k, dim, q, w, f, l);
      for (int lane = 0; lane < KERNEL_LANES; lane++)
        compare(k, dim, q[lane], w[lane], f[lane], l[lane]);
    }
  }
  for (int k = 0; k < SPH_KERNELS; k++)
    print_message("# %s: %.2g\n", sph_kernel_name(sph_kernel_get(k)), worst[k]);
  assert_in_range(tried, 2, SPH_ISA_COUNT);
  gsl_rng_free(random);
}

/* int q^2 W dV at h = 1 */
static double second_moment(double r, void *context) { return r * r * shell(r, context); }

static void deviation(void **state)
{
  (void)state;
  gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(64);
  for (at a = {.h = 1}; next(&a);) {
    gsl_function f = {second_moment, &a};
    double sum = 0, sigma_k = sph_kernel_deviation(a.kernel, a.dim);
    for (int n = 0; n < (int)sph_kernel_support(a.kernel); n++)
      sum += gsl_integration_glfixed(&f, n, n + 1, rule);
    assert_near(sigma_k * sigma_k, sum / a.dim, 1e-13, sph_kernel_name(a.kernel));
  }
  gsl_integration_glfixed_table_free(rule);
}

/* The Fourier transform of W at wave number k: int W cos, J0, sin(kr)/(kr) dV. */
static double wave(double r, void *context)
{
  const at *a = context;
  double kr = a->r * r; /* a->r: k */
  return shell(r, context) * (a->dim == 1   ? cos(kr)
                              : a->dim == 2 ? gsl_sf_bessel_J0(kr)
                                            : gsl_sf_bessel_j0(kr));
}

/* Its least value for k h <= 40, over that at 0, which is 1: on a grid of 0.02, whose error is
 * second order; zeros of it (the splines in 1D) are zeros within 1e-14. */
static void transform(void **state)
{
  (void)state;
  gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(64);
  for (at a = {.h = 1}; next(&a);) {
    gsl_function f = {wave, &a};
    double least = 1, expected = sph_kernel_least_transform(a.kernel, a.dim);
    for (a.r = 0.02; a.r < 40; a.r += 0.02) {
      double sum = 0;
      for (int n = 0; n < (int)sph_kernel_support(a.kernel); n++)
        sum += gsl_integration_glfixed(&f, n, n + 1, rule);
      least = fmin(least, sum);
    }
    assert_true(expected <= 0);
    if (expected == 0 && least < -1e-14)
      fail_msg("%s: %g in %dD", sph_kernel_name(a.kernel), least, a.dim);
    if (expected < 0) assert_near(least, expected, 1e-3 * -expected, sph_kernel_name(a.kernel));
  }
  gsl_integration_glfixed_table_free(rule);
}

/* Neighbours and sum V W - 1 on lattices, as counted and summed elsewhere. */
static void lattices(void **state)
{
  (void)state;
  static const struct {
    const char *name;
    double h_over_dx, neighbors[2], error[2], digits; /* 2D, 3D */
  } row[] = {
      {"wendland-c2", 1.5, {24, 92}, {5.1e-3, 3.1e-3}, 0.05e-3},
      {"wendland-c2", 1.3, {20, 80}, {1.0e-2, 9.5e-3}, 0.5e-3},
      {"wendland-c2", 2.0, {44, 250}, {1.2e-3, 5.5e-4}, 0.5e-4},
      {"wendland-c4", 1.7, {36, 170}, {1.2e-3, 9.0e-4}, 0.5e-4},
      {"wendland-c6", 2.0, {44, 250}, {2.5e-4, 2.1e-4}, 0.05e-4},
      {"cubic-spline", 1.2, {20, 56}, {-2.4e-4, 8.1e-4}, 0.05e-4},
      {"quintic-spline", 1.0, {24, 92}, {6.3e-5, -2.0e-5}, 0.05e-5},
      {"gaussian", 1.33, {44, 250}, {-1.1e-4, -6.7e-5}, 0.05e-4},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++)
    for (int dim = 2; dim <= 3; dim++) {
      const sph_kernel *kernel = sph_kernel_find(row[k].name);
      double n = sph_kernel_neighbors(kernel, dim, row[k].h_over_dx);
      double error = sph_kernel_lattice_error(kernel, dim, row[k].h_over_dx);
      assert_near(n, row[k].neighbors[dim - 2], 0, row[k].name);
      assert_near(error, row[k].error[dim - 2], row[k].digits, row[k].name);
    }
  const sph_kernel *usual = sph_kernel_find("wendland-c2");
  assert_true(sph_kernel_neighbors(usual, 1, 1.5) == 4);
  assert_true(isnan(sph_kernel_neighbors(usual, 2, 0)));
  assert_true(isnan(sph_kernel_neighbors(usual, 3, 1e6)));
  assert_true(isnan(sph_kernel_lattice_error(NULL, 2, 1.5)));
  assert_true(isnan(sph_kernel_lattice_error(usual, 4, 1.5)));
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
    assert_true(strlen(sph_kernel_smoothness(a.kernel)) >= 2);
    assert_true(sph_kernel_h_over_dx(a.kernel) >= 1);
    assert_true(sph_kernel_rate(a.kernel) >= 0.5 && sph_kernel_rate(a.kernel) <= 1.2);
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
  assert_true(isnan(sph_kernel_deviation(NULL, 2)));
  assert_true(isnan(sph_kernel_least_transform(NULL, 2)));
  assert_true(isnan(sph_kernel_rate(NULL)));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(table),     cmocka_unit_test(integral), cmocka_unit_test(derivatives),
      cmocka_unit_test(support),   cmocka_unit_test(self),     cmocka_unit_test(f_at),
      cmocka_unit_test(at_random), cmocka_unit_test(roots),    cmocka_unit_test(deviation),
      cmocka_unit_test(transform), cmocka_unit_test(lattices), cmocka_unit_test(facts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
