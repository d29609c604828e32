/* sphode/kernel.h -- smoothing kernels W(r, h) and their derivatives; docs/theory.md, Kernels.
 *
 *   W = (sigma_d/h^d) w(q),  q = r/h,  W = 0 for q >= kappa;  all kernels integrate to 1. */
#ifndef SPHODE_KERNEL_H
#define SPHODE_KERNEL_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_kernel sph_kernel; /* one row of kernels.def; never freed */

/* The kernel of that name ("wendland-c2"; sphode info kernels lists them), or NULL. */
SPH_API const sph_kernel *sph_kernel_find(const char *name);
/* Kernel number k = 0, 1, ... or NULL behind the last. */
SPH_API const sph_kernel *sph_kernel_get(int k);
SPH_API const char *sph_kernel_name(const sph_kernel *kernel);
SPH_API const char *sph_kernel_formula(const sph_kernel *kernel,
                                       int dim); /* one line, for people */
/* "C2"; where it is less than C1: where, as "C0 at r=0", "jump at 3h". */
SPH_API const char *sph_kernel_smoothness(const sph_kernel *kernel);
SPH_API double sph_kernel_support(const sph_kernel *kernel);        /* kappa = support radius / h */
SPH_API double sph_kernel_sigma(const sph_kernel *kernel, int dim); /* sigma_d */
SPH_API double sph_kernel_h_over_dx(const sph_kernel *kernel);      /* recommended h/dx */

/* The h/dx between which it is good in dim dimensions (docs/theory.md, Kernels); in 1D, where
 * particles do not pair, 1 to 3 for all.  NULL: not wanted.  SPH_ERR_ARGUMENT: bad kernel, dim. */
SPH_API int sph_kernel_range(const sph_kernel *kernel, int dim, double *low, double *high);

/* Facts for choosing; docs/theory.md, Kernels.  NaN for a bad kernel, dim (1, 2, 3) or h/dx. */

/* sigma_k = sqrt((1/d) int q^2 W dV) [h]: kernels of equal sigma_k h resolve alike. */
SPH_API double sph_kernel_deviation(const sph_kernel *kernel, int dim);
/* Least value of the Fourier transform over that at wave number 0: 0 where it is nowhere negative,
 * and particles do not pair, whatever their number of neighbours (Dehnen & Aly 2012). */
SPH_API double sph_kernel_least_transform(const sph_kernel *kernel, int dim);
/* Pairs per second over those of "wendland-c2", right-hand side in 3D, measured once. */
SPH_API double sph_kernel_rate(const sph_kernel *kernel);
/* On a cubic lattice of spacing dx, 0 < h/dx <= 20: points inside the support without the particle
 * itself; sum_j V W_ij - 1 with it.  Computed on each call, in 3D with (2 kappa h/dx)^3 W. */
SPH_API double sph_kernel_neighbors(const sph_kernel *kernel, int dim, double h_over_dx);
SPH_API double sph_kernel_lattice_error(const sph_kernel *kernel, int dim, double h_over_dx);

/* All with dim = 1, 2, 3, r >= 0 [m], h > 0 [m]; NaN for a bad dim or h <= 0.  At r = 0 those of
 * "spiky" are limits: dW/dr is not zero, F and in 2D, 3D the Laplacian are -infinity. */
SPH_API double sph_kernel_w(const sph_kernel *kernel, int dim, double r, double h); /* W [m^-d] */
SPH_API double sph_kernel_dwdr(const sph_kernel *kernel, int dim, double r,
                               double h); /* dW/dr [m^-(d+1)] */
SPH_API double sph_kernel_f(const sph_kernel *kernel, int dim, double r,
                            double h); /* F = (dW/dr)/r [m^-(d+2)] */
SPH_API double sph_kernel_laplacian(const sph_kernel *kernel, int dim, double r,
                                    double h); /* [m^-(d+2)] */
SPH_API double sph_kernel_dwdh(const sph_kernel *kernel, int dim, double r,
                               double h); /* dW/dh [m^-(d+1)] */

#ifdef __cplusplus
}
#endif
#endif
