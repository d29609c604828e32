/* sphode/kernel_shape.h -- the shapes of the kernels, once, for every use: pair loops (vectors),
 * kernel.h (one lane).
 *
 *   W = (sigma_d/h^d) w(q),  F = W'/r = (sigma_d/h^(d+2)) f(q),  f = w'/q,  q = r/h >= 0
 *   laplacian = (sigma_d/h^(d+2)) l(q),  l = w'' + (d - 1) f
 *
 * The three functions at the end take kernel and dim as constants and compile to the formulas
 * alone.  They are finite at q = 0 and zero for q >= kappa, without branches: a loop needs no
 * test of the distance.  f never divides by a small q, and is a sum of terms of one sign: it
 * does not change sign by rounding at the edge of the support.
 *
 * A new kernel: its three shapes here and its lines in the two lists; its facts in one row of
 * kernels.def. */
#ifndef SPHODE_KERNEL_SHAPE_H
#define SPHODE_KERNEL_SHAPE_H
#include "sphode/simd.h"

/* X(number): one instance for each kernel. */
#define SPH_KERNEL_LIST(X)  \
  X(SPH_KERNEL_WENDLAND_C2) \
  X(SPH_KERNEL_CUBIC_SPLINE)

/* X(number, prefix of its shape functions) */
#define SPH_KERNEL_SHAPES(X)                    \
  X(SPH_KERNEL_WENDLAND_C2, kernel_wendland_c2) \
  X(SPH_KERNEL_CUBIC_SPLINE, kernel_cubic_spline)

#define SPH_KERNEL_NUMBER(number) number,
enum { SPH_KERNEL_LIST(SPH_KERNEL_NUMBER) SPH_KERNELS }; /* that of sph_kernel_get; how many */
#undef SPH_KERNEL_NUMBER

/* Wendland (1995), C2, t = 1 - q/2, kappa = 2: w = t^3 (1 + 3q/2) in 1D, t^4 (1 + 2q) in 2D, 3D. */
BODY vec kernel_wendland_c2_w(int dim, vec q)
{
  vec t = v_max0(1 - 0.5 * q);
  return dim == 1 ? t * t * t * (1 + 1.5 * q) : (t * t) * (t * t) * (1 + 2 * q);
}
BODY vec kernel_wendland_c2_f(int dim, vec q)
{
  vec t = v_max0(1 - 0.5 * q);
  return dim == 1 ? -3 * t * t : -5 * t * t * t;
}
BODY vec kernel_wendland_c2_laplacian(int dim, vec q)
{
  vec t = v_max0(1 - 0.5 * q);
  if (dim == 1) return 1.5 * t * (3 * q - 2);
  return dim == 2 ? 2.5 * t * t * (5 * q - 4) : 15 * t * t * (q - 1);
}

/* Cubic B-spline M4 (Monaghan & Lattanzio 1985), s = (2 - q)+, u = (1 - q)+, kappa = 2:
 * w = (s^3 - 4 u^3)/4,  -(4/3) f = s^2/q for q >= 1, 4 - 3q = s^2 + q u below,  w'' = 3s/2 - 6u */
BODY vec kernel_cubic_spline_w(int dim, vec q)
{
  (void)dim;
  vec s = v_max0(2 - q), u = v_max0(1 - q);
  return 0.25 * s * s * s - u * u * u;
}
BODY vec kernel_cubic_spline_f(int dim, vec q)
{
  (void)dim;
  vec s = v_max0(2 - q), u = v_max0(1 - q);
  return -0.75 * (s * s / v_max(q, v_set(1)) + q * u);
}
BODY vec kernel_cubic_spline_laplacian(int dim, vec q)
{
  vec s = v_max0(2 - q), u = v_max0(1 - q);
  return 1.5 * s - 6 * u + (dim - 1) * kernel_cubic_spline_f(dim, q);
}

#define SPH_KERNEL_W(number, shape) \
  if (kernel == number) return shape##_w(dim, q);
#define SPH_KERNEL_F(number, shape) \
  if (kernel == number) return shape##_f(dim, q);
#define SPH_KERNEL_LAPLACIAN(number, shape) \
  if (kernel == number) return shape##_laplacian(dim, q);

/* Does f grow without bound towards q = 0? */
BODY int kernel_shape_singular(int kernel)
{
  (void)kernel;
  return 0;
}

/* Of an unknown kernel: NaN. */
BODY vec kernel_shape_w(int kernel, int dim, vec q)
{
  SPH_KERNEL_SHAPES(SPH_KERNEL_W)
  return v_set(NAN);
}
BODY vec kernel_shape_f(int kernel, int dim, vec q)
{
  SPH_KERNEL_SHAPES(SPH_KERNEL_F)
  return v_set(NAN);
}
BODY vec kernel_shape_laplacian(int kernel, int dim, vec q)
{
  SPH_KERNEL_SHAPES(SPH_KERNEL_LAPLACIAN)
  return v_set(NAN);
}
#undef SPH_KERNEL_W
#undef SPH_KERNEL_F
#undef SPH_KERNEL_LAPLACIAN

#endif
