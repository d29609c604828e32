/* Kernels, one r at a time: the same shapes as in the pair loops, in one lane. */
#define SPH_LANES 1
#include "sphode/kernel.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "sphode/kernel_shape.h"

struct sph_kernel {
  int number; /* its place in the table */
  const char *name;
  double support;
  const char *smoothness;
  double h_over_dx, low, high; /* recommended, and its range in 2D and 3D */
  double slope_at_0;           /* limit of w' at q -> 0 */
  double sigma[3];             /* [dim - 1] */
  double variance[3];          /* sigma_k^2 [dim - 1] */
  double least[3];             /* value of the Fourier transform [dim - 1] */
  double rate;                 /* over that of Wendland C2 */
  const char *formula[3];      /* [dim - 1] */
};

static const sph_kernel table[] = {
#define X(number, name, support, smoothness, h_over_dx, low, high, slope, s1, s2, s3, v1, v2, v3, \
          l1, l2, l3, rate, f1, f2, f3)                                                           \
  [number] = {number, name,         support,      smoothness,   h_over_dx, low,         high,     \
              slope,  {s1, s2, s3}, {v1, v2, v3}, {l1, l2, l3}, rate,      {f1, f2, f3}},
#include "kernels.def"
#undef X
};
_Static_assert(sizeof table / sizeof table[0] == SPH_KERNELS,
               "a row of kernels.def for each kernel");

const sph_kernel *sph_kernel_find(const char *name)
{
  for (int k = 0; name && k < SPH_KERNELS; k++)
    if (!strcmp(name, table[k].name)) return &table[k];
  return NULL;
}

const sph_kernel *sph_kernel_get(int k) { return k >= 0 && k < SPH_KERNELS ? &table[k] : NULL; }

static int usable(const sph_kernel *kernel, int dim) { return kernel && dim >= 1 && dim <= 3; }

const char *sph_kernel_name(const sph_kernel *kernel) { return kernel ? kernel->name : NULL; }
const char *sph_kernel_formula(const sph_kernel *kernel, int dim)
{
  return usable(kernel, dim) ? kernel->formula[dim - 1] : NULL;
}
const char *sph_kernel_smoothness(const sph_kernel *kernel)
{
  return kernel ? kernel->smoothness : NULL;
}
double sph_kernel_support(const sph_kernel *kernel) { return kernel ? kernel->support : NAN; }
double sph_kernel_sigma(const sph_kernel *kernel, int dim)
{
  return usable(kernel, dim) ? kernel->sigma[dim - 1] : NAN;
}
double sph_kernel_h_over_dx(const sph_kernel *kernel) { return kernel ? kernel->h_over_dx : NAN; }
int sph_kernel_range(const sph_kernel *kernel, int dim, double *low, double *high)
{
  if (!usable(kernel, dim)) return SPH_ERR_ARGUMENT;
  if (low) *low = dim == 1 ? 1 : kernel->low;
  if (high) *high = dim == 1 ? 3 : kernel->high;
  return SPH_OK;
}
double sph_kernel_rate(const sph_kernel *kernel) { return kernel ? kernel->rate : NAN; }
double sph_kernel_deviation(const sph_kernel *kernel, int dim)
{
  return usable(kernel, dim) ? sqrt(kernel->variance[dim - 1]) : NAN;
}
double sph_kernel_least_transform(const sph_kernel *kernel, int dim)
{
  return usable(kernel, dim) ? kernel->least[dim - 1] : NAN;
}

/* sigma_d/h^(d + more); NaN for what is not usable. */
static double scale(const sph_kernel *kernel, int dim, double h, int more)
{
  if (!usable(kernel, dim) || !(h > 0)) return NAN;
  double power = 1;
  for (int k = 0; k < dim + more; k++) power *= h;
  return kernel->sigma[dim - 1] / power;
}

/* kernel == NULL: scale() is NaN, whatever the shape. */
static int number(const sph_kernel *kernel) { return kernel ? kernel->number : 0; }

static double shape_w(const sph_kernel *kernel, int dim, double q)
{
  return kernel_shape_w(number(kernel), dim, v_set(q))[0];
}
/* f, and l in 2D and 3D, are infinite at q = 0 where w' is not zero. */
static int singular(const sph_kernel *kernel, double q)
{
  return q == 0 && kernel && kernel->slope_at_0 < 0;
}
static double shape_f(const sph_kernel *kernel, int dim, double q)
{
  if (singular(kernel, q)) return -INFINITY;
  return kernel_shape_f(number(kernel), dim, v_set(q))[0];
}
/* w' = q f */
static double shape_slope(const sph_kernel *kernel, int dim, double q)
{
  return singular(kernel, q) ? kernel->slope_at_0 : q * shape_f(kernel, dim, q);
}
static double shape_laplacian(const sph_kernel *kernel, int dim, double q)
{
  if (dim > 1 && singular(kernel, q)) return -INFINITY;
  return kernel_shape_laplacian(number(kernel), dim, v_set(q))[0];
}

double sph_kernel_w(const sph_kernel *kernel, int dim, double r, double h)
{
  return scale(kernel, dim, h, 0) * shape_w(kernel, dim, r / h);
}

double sph_kernel_dwdr(const sph_kernel *kernel, int dim, double r, double h)
{
  return scale(kernel, dim, h, 1) * shape_slope(kernel, dim, r / h) + 0.0; /* no minus zero */
}

double sph_kernel_f(const sph_kernel *kernel, int dim, double r, double h)
{
  return scale(kernel, dim, h, 2) * shape_f(kernel, dim, r / h);
}

double sph_kernel_laplacian(const sph_kernel *kernel, int dim, double r, double h)
{
  return scale(kernel, dim, h, 2) * shape_laplacian(kernel, dim, r / h);
}

/* dW/dh = -(sigma_d/h^(d+1)) (d w + q w') */
double sph_kernel_dwdh(const sph_kernel *kernel, int dim, double r, double h)
{
  double q = r / h;
  double shape = dim * shape_w(kernel, dim, q) + q * shape_slope(kernel, dim, q);
  return -scale(kernel, dim, h, 1) * shape;
}

/* Sums over the points of the cubic lattice of spacing 1 around a particle, h = h_over_dx. */
typedef struct lattice {
  double neighbors, sum_w;
} lattice;

static lattice lattice_sums(const sph_kernel *kernel, int dim, double h_over_dx)
{
  if (!usable(kernel, dim) || !(h_over_dx > 0 && h_over_dx <= 20)) return (lattice){NAN, NAN};
  lattice sums = {0, 0};
  const double reach = kernel->support * h_over_dx;
  const long n = (long)reach, ny = dim > 1 ? n : 0, nz = dim > 2 ? n : 0;
  for (long z = -nz; z <= nz; z++)
    for (long y = -ny; y <= ny; y++)
      for (long x = -n; x <= n; x++) {
        double r = sqrt((double)(x * x + y * y + z * z));
        sums.neighbors += r > 0 && r < reach;
        sums.sum_w += sph_kernel_w(kernel, dim, r, h_over_dx);
      }
  return sums;
}

double sph_kernel_neighbors(const sph_kernel *kernel, int dim, double h_over_dx)
{
  return lattice_sums(kernel, dim, h_over_dx).neighbors;
}

double sph_kernel_lattice_error(const sph_kernel *kernel, int dim, double h_over_dx)
{
  return lattice_sums(kernel, dim, h_over_dx).sum_w - 1;
}
