/* What the page index.html asks for: the library's own kernels, and their sums over a disordered
 * patch of particles.  Compiled to WebAssembly by ./build, and by itself for the test, where
 * main() prints what the page must show. */
#include <math.h>
#include <stdint.h>

#include "sphode/kernel.h"

enum { SIDE = 48, MOST = SIDE * SIDE, RESULTS = 8 };

/* A periodic square lattice of spacing 1, SIDE a side (2D), or SIDE^(2/3) a side (3D), each
 * particle moved by up to `disorder` in each direction. */
static int dim, n;
static double side, x[3][MOST], density[MOST], results[RESULTS];

static double chance(uint64_t *seed) /* -1 to 1; xorshift (Marsaglia 2003) */
{
  *seed ^= *seed << 13, *seed ^= *seed >> 7, *seed ^= *seed << 17;
  return (double)(*seed >> 11) * 0x1p-52 - 1;
}

int widget_place(int dimensions, double disorder, int number)
{
  const int m = dimensions == 3 ? 13 : SIDE;
  uint64_t seed = 88172645463325252u + (uint64_t)number * 7919;
  dim = dimensions, side = m, n = dim == 3 ? m * m * m : m * m;
  for (int i = 0; i < n; i++)
    for (int d = 0, rest = i; d < dim; d++, rest /= m)
      x[d][i] = rest % m + 0.5 + disorder * chance(&seed);
  return n;
}
const double *widget_position(int axis) { return x[axis]; }
const double *widget_density(void) { return density; }

/* Of i: sum V W; sum V grad W, which should be 0; sum V (x_j - x_i) dW/dx, which should be 1. */
typedef struct sums {
  double density, drift[3], slope, neighbors, nearest;
} sums;

static sums sums_of(const sph_kernel *kernel, double h, int i)
{
  const double reach = sph_kernel_support(kernel) * h;
  sums s = {.density = sph_kernel_w(kernel, dim, 0, h), .nearest = side};
  for (int j = 0; j < n; j++) {
    double e[3] = {0}, rr = 0;
    for (int d = 0; d < dim; d++) {
      e[d] = x[d][i] - x[d][j];
      e[d] -= side * round(e[d] / side);
      rr += e[d] * e[d];
    }
    if (j == i || !(rr < reach * reach)) continue;
    const double r = sqrt(rr), F = r > 0 ? sph_kernel_f(kernel, dim, r, h) : 0;
    s.density += sph_kernel_w(kernel, dim, r, h);
    for (int d = 0; d < dim; d++) s.drift[d] += F * e[d];
    s.slope -= F * e[0] * e[0];
    s.neighbors++;
    s.nearest = fmin(s.nearest, r);
  }
  return s;
}

/* Over all particles (3D: every seventh), V = 1.  [0]: mean of sum V W - 1; [1]: its standard
 * deviation; [2]: rms of h |sum V grad W|; [3]: rms error of the difference gradient of a line;
 * [4]: mean number of neighbours; [5]: least distance; [6]: [4]/rate, the cost of a right-hand side
 * in pairs of Wendland C2.  NULL: the support is larger than half the box. */
const double *widget_sums(int k, double h_over_dx)
{
  const sph_kernel *kernel = sph_kernel_get(k);
  if (!(sph_kernel_support(kernel) * h_over_dx < side / 2)) return 0;
  double mean = 0, square = 0, drift = 0, slope = 0, neighbors = 0, nearest = side;
  const int every = dim == 3 ? 7 : 1;
  int count = 0;
  for (int i = 0; i < n; i += every, count++) {
    sums s = sums_of(kernel, h_over_dx, i);
    density[i] = s.density;
    mean += s.density - 1;
    square += (s.density - 1) * (s.density - 1);
    for (int d = 0; d < dim; d++) drift += h_over_dx * h_over_dx * s.drift[d] * s.drift[d];
    slope += (s.slope - 1) * (s.slope - 1);
    neighbors += s.neighbors;
    nearest = fmin(nearest, s.nearest);
  }
  mean /= count;
  results[0] = mean, results[1] = sqrt(fmax(square / count - mean * mean, 0));
  results[2] = sqrt(drift / count), results[3] = sqrt(slope / count);
  results[4] = neighbors / count, results[5] = nearest;
  results[6] = results[4] / sph_kernel_rate(kernel);
  return results;
}

/* By number, for the page. */
const char *widget_name(int k) { return sph_kernel_name(sph_kernel_get(k)); }
double widget_support(int k) { return sph_kernel_support(sph_kernel_get(k)); }
double widget_best(int k) { return sph_kernel_h_over_dx(sph_kernel_get(k)); }
double widget_low(int k)
{
  double low = NAN;
  sph_kernel_range(sph_kernel_get(k), dim, &low, 0);
  return low;
}
double widget_high(int k)
{
  double high = NAN;
  sph_kernel_range(sph_kernel_get(k), dim, 0, &high);
  return high;
}
double widget_w(int k, int d, double q) { return sph_kernel_w(sph_kernel_get(k), d, q, 1); }
double widget_dwdr(int k, int d, double q) { return sph_kernel_dwdr(sph_kernel_get(k), d, q, 1); }
double widget_pairing(int k) { return sph_kernel_least_transform(sph_kernel_get(k), dim); }
double widget_deviation(int k) { return sph_kernel_deviation(sph_kernel_get(k), dim); }

#ifdef WIDGET_MAIN
#include <stdio.h>
/* A line each of what index.html#test must print: name, then numbers. */
int main(void)
{
  for (int k = 0; sph_kernel_get(k); k++)
    for (int d = 1; d <= 3; d++)
      for (int i = 0; i <= 20; i++)
        printf("w %s %d %g %.17g %.17g\n", widget_name(k), d, i * 0.125, widget_w(k, d, i * 0.125),
               widget_dwdr(k, d, i * 0.125));
  for (int d = 2; d <= 3; d++)
    for (int k = 0; sph_kernel_get(k); k++) {
      widget_place(d, 0.25, 1);
      const double *s = widget_sums(k, widget_best(k));
      printf("sums %s %d", widget_name(k), d);
      for (int i = 0; i < 7; i++) printf(" %.17g", s[i]);
      printf("\n");
    }
  return 0;
}
#endif
