/* 01_kernel -- the smoothing kernels: a table of W and dW/dr, what tells them apart, and the
 * integral that must be 1.
 *
 * Equations  W = (sigma_d/h^d) w(r/h), W = 0 for r >= kappa h;  the integral of W over space is 1:
 *            int_0^(kappa h) W A_d dr = 1,  A_1 = 2, A_2 = 2 pi r, A_3 = 4 pi r^2
 *            on a lattice sum_j V W_ij is almost 1, too;  sigma_k^2 = (1/d) int q^2 W dV
 * Reference  H. Wendland (1995), Adv. Comput. Math. 4, 389;
 *            J. J. Monaghan & J. C. Lattanzio (1985), Astron. Astrophys. 149, 135;
 *            W. Dehnen & H. Aly (2012), Mon. Not. R. Astron. Soc. 425, 1068
 * Run        ./01_kernel
 * See        the table: W falls to zero at the edge of the support, with zero slope but for the
 *            Gaussians; the smoother the kernel, the more neighbors it wants
 * Check      the integrals, by Simpson's rule over each h, are 1 within 1e-12 */
#include <math.h>
#include <sphode.h>
#include <stdio.h>

static double integrand(const sph_kernel *kernel, int dim, double r, double h)
{
  const double pi = acos(-1), area[] = {2, 2 * pi * r, 4 * pi * r * r};
  return area[dim - 1] * sph_kernel_w(kernel, dim, r, h);
}

/* The shapes are polynomials between multiples of h: no step of Simpson's rule crosses a knot. */
static double integral(const sph_kernel *kernel, int dim, double h)
{
  const int steps = 1000 * (int)ceil(sph_kernel_support(kernel));
  double dr = h / 1000, sum = 0;
  double edge = sph_kernel_support(kernel) * h * (1 - 1e-15); /* inside: the Gaussian jumps there */
  for (int k = 0; k <= steps; k++) {
    double weight = k == 0 || k == steps ? 1 : k % 2 ? 4 : 2;
    sum += weight * dr / 3 * integrand(kernel, dim, fmin(k * dr, edge), h);
  }
  return sum;
}

static int show(const sph_kernel *kernel, int dim, double h)
{
  double sum = integral(kernel, dim, h);
  printf("\n%s in %dD: %s\n", sph_kernel_name(kernel), dim, sph_kernel_formula(kernel, dim));
  double h_over_dx = sph_kernel_h_over_dx(kernel);
  printf("  smoothness %s, sigma_k = %.3f h, integral 1 %+.1e\n", sph_kernel_smoothness(kernel),
         sph_kernel_deviation(kernel, dim), sum - 1);
  printf("  recommended h/dx %g: %.0f neighbors, sum V W = 1 %+.1e on a lattice; particles %s\n",
         h_over_dx, sph_kernel_neighbors(kernel, dim, h_over_dx),
         sph_kernel_lattice_error(kernel, dim, h_over_dx),
         sph_kernel_least_transform(kernel, dim) < 0 ? "can pair" : "do not pair");
  printf("  %6s %14s %14s\n", "r/h", "W h^d", "dW/dr h^(d+1)");
  for (double q = 0; q <= sph_kernel_support(kernel); q += 0.25)
    printf("  %6.2f %14.10f %14.10f\n", q, sph_kernel_w(kernel, dim, q * h, h) * pow(h, dim),
           sph_kernel_dwdr(kernel, dim, q * h, h) * pow(h, dim + 1) + 0.0); /* no -0 */
  return fabs(sum - 1) < 1e-12;
}

int main(void)
{
  const double h = 0.02; /* [m]; any */
  const sph_kernel *kernel;
  int good = 1;
  for (int k = 0; (kernel = sph_kernel_get(k)); k++)
    for (int dim = 1; dim <= 3; dim++) good &= show(kernel, dim, h);
  printf("\n%s\n", good ? "All integrals are 1." : "An integral is not 1.");
  return !good;
}
