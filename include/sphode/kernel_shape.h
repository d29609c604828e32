/* sphode/kernel_shape.h -- the shapes of the kernels, once, for every use: pair loops (vectors),
 * kernel.h (one lane).
 *
 *   W = (sigma_d/h^d) w(q),  F = W'/r = (sigma_d/h^(d+2)) f(q),  f = w'/q,  q = r/h >= 0
 *   laplacian = (sigma_d/h^(d+2)) l(q),  l = w'' + (d - 1) f
 *
 * The functions at the end take kernel and dim as constants and compile to the formulas
 * alone.  They are finite at q = 0 and zero for q >= kappa, without branches: a loop needs no
 * test of the distance.  f never divides by a small q (but that of spiky, which is singular), and
 * does not change sign by rounding at the edge of the support.
 *
 * Literature: Wendland (1995); Dehnen & Aly (2012); Monaghan & Lattanzio (1985); Morris (1996);
 * Monaghan (1992); Desbrun & Gascuel (1996); docs/theory.md, Kernels.
 *
 * A new kernel: its three shapes here and its lines in the two lists; its facts in one row of
 * kernels.def. */
#ifndef SPHODE_KERNEL_SHAPE_H
#define SPHODE_KERNEL_SHAPE_H
#include "sphode/simd.h"

/* X(number): one instance for each kernel. */
#define SPH_KERNEL_LIST(X)       \
  X(SPH_KERNEL_WENDLAND_C2)      \
  X(SPH_KERNEL_WENDLAND_C4)      \
  X(SPH_KERNEL_WENDLAND_C6)      \
  X(SPH_KERNEL_CUBIC_SPLINE)     \
  X(SPH_KERNEL_QUINTIC_SPLINE)   \
  X(SPH_KERNEL_GAUSSIAN)         \
  X(SPH_KERNEL_GAUSSIAN_SHIFTED) \
  X(SPH_KERNEL_SPIKY)

/* X(number, prefix of its shape functions) */
#define SPH_KERNEL_SHAPES(X)                              \
  X(SPH_KERNEL_WENDLAND_C2, kernel_wendland_c2)           \
  X(SPH_KERNEL_WENDLAND_C4, kernel_wendland_c4)           \
  X(SPH_KERNEL_WENDLAND_C6, kernel_wendland_c6)           \
  X(SPH_KERNEL_CUBIC_SPLINE, kernel_cubic_spline)         \
  X(SPH_KERNEL_QUINTIC_SPLINE, kernel_quintic_spline)     \
  X(SPH_KERNEL_GAUSSIAN, kernel_gaussian)                 \
  X(SPH_KERNEL_GAUSSIAN_SHIFTED, kernel_gaussian_shifted) \
  X(SPH_KERNEL_SPIKY, kernel_spiky)

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
/* f for loops: its factor and that of r go into constants: s = -5^(1/3) t, f = s^3 in 2D, 3D. */
BODY vec kernel_wendland_c2_f_at(int dim, vec r, vec_scalar inverse_h)
{
  const vec_scalar root = (vec_scalar)1.709975946676697; /* 5^(1/3) */
  vec s = v_min0(r * (root * inverse_h / 2) - root);
  return dim == 1 ? kernel_wendland_c2_f(dim, r * inverse_h) : s * s * s;
}
BODY vec kernel_wendland_c2_laplacian(int dim, vec q)
{
  vec t = v_max0(1 - 0.5 * q);
  if (dim == 1) return 1.5 * t * (3 * q - 2);
  return dim == 2 ? 2.5 * t * t * (5 * q - 4) : 15 * t * t * (q - 1);
}

/* Wendland (1995), C4, t = 1 - q/2, kappa = 2: w = t^5 (1 + 5q/2 + 2q^2) in 1D,
 * t^6 (1 + 3q + 35q^2/12) in 2D, 3D.  The clamped q: t = 0 beyond, and no 0 * inf. */
BODY vec kernel_wendland_c4_w(int dim, vec q)
{
  q = v_min(q, v_set(2));
  vec t = 1 - 0.5 * q, t2 = t * t;
  if (dim == 1) return t2 * t2 * t * (1 + (2.5 + 2 * q) * q);
  return t2 * t2 * t2 * (1 + (3 + (vec_scalar)(35.0 / 12) * q) * q);
}
BODY vec kernel_wendland_c4_f(int dim, vec q)
{
  q = v_min(q, v_set(2));
  vec t = 1 - 0.5 * q, t2 = t * t;
  if (dim == 1) return t2 * t2 * -(3.5 + 7 * q);
  return t2 * t2 * t * -((vec_scalar)(14.0 / 3) + (vec_scalar)(35.0 / 3) * q);
}
BODY vec kernel_wendland_c4_laplacian(int dim, vec q)
{
  q = v_min(q, v_set(2));
  vec t = 1 - 0.5 * q, t3 = t * t * t;
  if (dim == 1) return 1.75 * t3 * ((12 * q - 3) * q - 2);
  return dim == 2 ? (vec_scalar)(28.0 / 3) * t3 * t * ((5 * q - 2) * q - 1)
                  : 3.5 * t3 * t * ((15 * q - 8) * q - 4);
}

/* Wendland (1995), C6: w = t^7 (1 + 7q/2 + 19q^2/4 + 21q^3/8) in 1D,
 * t^8 (1 + 4q + 25q^2/4 + 4q^3) in 2D, 3D. */
BODY vec kernel_wendland_c6_w(int dim, vec q)
{
  q = v_min(q, v_set(2));
  vec t = 1 - 0.5 * q, t2 = t * t, t4 = t2 * t2;
  if (dim == 1) return t4 * t2 * t * (1 + (3.5 + (4.75 + 2.625 * q) * q) * q);
  return t4 * t4 * (1 + (4 + (6.25 + 4 * q) * q) * q);
}
BODY vec kernel_wendland_c6_f(int dim, vec q)
{
  q = v_min(q, v_set(2));
  vec t = 1 - 0.5 * q, t2 = t * t, t4 = t2 * t2;
  if (dim == 1) return t4 * t2 * -(4.5 + (13.5 + 13.125 * q) * q);
  return t4 * t2 * t * -(5.5 + (19.25 + 22 * q) * q);
}
BODY vec kernel_wendland_c6_laplacian(int dim, vec q)
{
  q = v_min(q, v_set(2));
  vec t = 1 - 0.5 * q, t2 = t * t, t4 = t2 * t2;
  if (dim == 1) return 0.5625 * t4 * t * (((105 * q + 26) * q - 20) * q - 8);
  return dim == 2 ? 2.75 * t4 * t2 * (((44 * q + 3) * q - 12) * q - 4)
                  : 4.125 * t4 * t2 * (((32 * q - 1) * q - 12) * q - 4);
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
  return -(vec_scalar)0.75 * (s * s / v_max(q, v_set(1)) + q * u);
}
BODY vec kernel_cubic_spline_laplacian(int dim, vec q)
{
  vec s = v_max0(2 - q), u = v_max0(1 - q);
  return 1.5 * s - 6 * u + (vec_scalar)(dim - 1) * kernel_cubic_spline_f(dim, q);
}

/* Quintic B-spline M6 (Morris 1996), s = (3 - q)+, t = (2 - q)+, u = (1 - q)+, kappa = 3:
 * w = s^5 - 6 t^5 + 15 u^5,  -f/5 = (s^4 - 6 t^4)/q for q >= 1,
 * 24 - 24q^2 + 10q^3 = s^4 - 6 t^4 + u (10 + 18u + 6u^2 + 5u^3) below,
 * w'' = 20 s^3 - 120 t^3 + 300 u^3.  s^4 > 6 t^4 wherever t > 0 and q >= 1. */
BODY vec kernel_quintic_spline_w(int dim, vec q)
{
  (void)dim;
  vec s = v_max0(3 - q), t = v_max0(2 - q), u = v_max0(1 - q);
  vec s2 = s * s, t2 = t * t, u2 = u * u;
  return s2 * s2 * s - 6 * (t2 * t2 * t) + 15 * (u2 * u2 * u);
}
BODY vec kernel_quintic_spline_f(int dim, vec q)
{
  (void)dim;
  vec s = v_max0(3 - q), t = v_max0(2 - q), u = v_max0(1 - q);
  vec s2 = s * s, t2 = t * t;
  vec inner = u * (10 + u * (18 + u * (6 + u * 5)));
  return -5 * ((s2 * s2 - 6 * (t2 * t2)) / v_max(q, v_set(1)) + inner);
}
BODY vec kernel_quintic_spline_laplacian(int dim, vec q)
{
  vec s = v_max0(3 - q), t = v_max0(2 - q), u = v_max0(1 - q);
  return 20 * (s * s * s) - 120 * (t * t * t) + 300 * (u * u * u) +
         (vec_scalar)(dim - 1) * kernel_quintic_spline_f(dim, q);
}

/* exp(-q^2), 0 <= q <= 3, within 1e-14 of itself: (exp(-q^2/16))^16, the inner one by a polynomial
 * of degree 10 in x = q^2 that meets it at eleven Chebyshev nodes of [0, 9], stretched so that the
 * first is 0: it is within 3.4e-17, and 1 at 0; four squarings make that 16 times as much, and
 * rounding adds. */
BODY vec kernel_exp(vec q)
{
  static const vec_scalar c[] = {-0.0624999999999997,    0.0019531249999983856,
                                 -4.069010416364146e-05, 6.357828747946291e-07,
                                 -7.947284469057803e-09, 8.278373201656546e-11,
                                 -7.39039479690877e-13,  5.760171434960874e-15,
                                 -3.887035525677299e-17, 1.8977527031337512e-19};
  vec x = q * q, e = v_set(c[9]);
#pragma GCC unroll 9
  for (int k = 8; k >= 0; k--) e = e * x + c[k];
  e = e * x + 1;
  e *= e, e *= e, e *= e;
  return e * e;
}

/* Gaussian (Monaghan 1992), cut at kappa = 3, where it jumps by exp(-9): w = exp(-q^2) */
BODY vec kernel_gaussian_w(int dim, vec q)
{
  (void)dim;
  return v_and(v_less(q, v_set(3)), kernel_exp(v_min(q, v_set(3))));
}
BODY vec kernel_gaussian_f(int dim, vec q) { return -2 * kernel_gaussian_w(dim, q); }
BODY vec kernel_gaussian_laplacian(int dim, vec q)
{
  vec near = v_min(q, v_set(3));
  return (4 * near * near - (vec_scalar)(2 * dim)) * kernel_gaussian_w(dim, q);
}

/* The same lowered to w(3) = 0: w = exp(-q^2) - exp(-9), continuous; w' is that of the Gaussian. */
BODY vec kernel_gaussian_shifted_w(int dim, vec q)
{
  return v_max0(kernel_gaussian_w(dim, q) - (vec_scalar)1.2340980408667956e-4);
}
BODY vec kernel_gaussian_shifted_f(int dim, vec q) { return kernel_gaussian_f(dim, q); }
BODY vec kernel_gaussian_shifted_laplacian(int dim, vec q)
{
  return kernel_gaussian_laplacian(dim, q);
}

/* Spiky (Desbrun & Gascuel 1996), s = (2 - q)+, kappa = 2: w = s^3,  f = -3 s^2/q,  w'' = 6 s.
 * grad W = r F has a size at r = 0 but no direction: there it is 0, F being finite. */
BODY vec kernel_spiky_w(int dim, vec q)
{
  (void)dim;
  vec s = v_max0(2 - q);
  return s * s * s;
}
BODY vec kernel_spiky_f(int dim, vec q)
{
  (void)dim;
  vec s = v_max0(2 - q);
  return -3 * s * s / v_max(q, v_tiny());
}
BODY vec kernel_spiky_laplacian(int dim, vec q)
{
  return 6 * v_max0(2 - q) + (vec_scalar)(dim - 1) * kernel_spiky_f(dim, q);
}

#define SPH_KERNEL_W(number, shape) \
  if (kernel == number) return shape##_w(dim, q);
#define SPH_KERNEL_F(number, shape) \
  if (kernel == number) return shape##_f(dim, q);
#define SPH_KERNEL_LAPLACIAN(number, shape) \
  if (kernel == number) return shape##_laplacian(dim, q);

/* Does f grow without bound towards q = 0? */
BODY int kernel_shape_singular(int kernel) { return kernel == SPH_KERNEL_SPIKY; }

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
/* f(r/h), to rounding, with fewer operations where there is a way. */
BODY vec kernel_shape_f_at(int kernel, int dim, vec r, vec_scalar inverse_h)
{
  if (kernel == SPH_KERNEL_WENDLAND_C2) return kernel_wendland_c2_f_at(dim, r, inverse_h);
  return kernel_shape_f(kernel, dim, r * inverse_h);
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
