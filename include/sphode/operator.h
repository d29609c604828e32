/* sphode/operator.h -- interpolation and derivatives of fields on any set of points;
 * docs/theory.md, Operators.
 *
 *   sph_operator *op = sph_operator_create(&(sph_operator_def){.dim = 2, .h = 0.015}, &error);
 *   sph_operator_set_points(op, n, x, volume, NULL, &error);
 *   sph_operator_gradient(op, "corrected", f, gradient, &error);
 *
 * A field is an array f[n] in the order of the points; a vector is dim of them, u[dim][n]; a tensor
 * dim * dim, row by row.  Results are the same bits for any number of threads.  What is read must
 * not be what is written.  A field that is not finite somewhere makes what is near it so.
 *
 * All operators return 0 or a failure, which is recorded in error (NULL is allowed).  Corrected
 * ones solve with a moment matrix of the neighbours of each point: where it is singular (too few
 * neighbours, or all of them on a line) they fail and name the point, or, with lower_order, take
 * the next simpler form there. */
#ifndef SPHODE_OPERATOR_H
#define SPHODE_OPERATOR_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_operator sph_operator;

typedef struct sph_operator_def {
  int dim;            /* 1, 2, 3 */
  double h;           /* smoothing length [m], > 0 */
  const char *kernel; /* NULL: "wendland-c2"; sphode info kernels */
  int threads;        /* 0: 1 */
  int lower_order;    /* 1: a simpler form where a moment matrix is singular; 0: an error */
  int periodic[3];    /* direction is periodic */
  double origin[3];   /* lower corner of the periodic box [m] */
  double length[3];   /* its lengths [m], at least 2 kappa h where periodic */
  const char *search; /* as sph_neighbors_def.search */
} sph_operator_def;

/* NULL: error says why. */
SPH_API sph_operator *sph_operator_create(const sph_operator_def *def, sph_error *error);
SPH_API void sph_operator_free(sph_operator *op); /* NULL is fine */

/* The points that fields are given at: x[dim][n] [m], volume[n] [m^dim] > 0, density[n] [kg/m^dim]
 * > 0 (NULL: 1 everywhere; only "symmetric" and "density" know it).  All are copied.  Results are
 * then wanted at the points themselves.  After a failure there are none. */
SPH_API int sph_operator_set_points(sph_operator *op, long n, const double *const x[],
                                    const double *volume, const double *density, sph_error *error);
/* Results are wanted at other places, x[dim][n] [m], copied: interpolation, Shepard, CSPM, MLS, the
 * plain gradient and what is made of it; others need the field at the place itself.  x NULL: at the
 * points again. */
SPH_API int sph_operator_set_probes(sph_operator *op, long n, const double *const x[],
                                    sph_error *error);
/* At how many places the last call took a simpler form (lower_order). */
SPH_API long sph_operator_lowered(const sph_operator *op);

/* ---- values.  Sums over j hold the point itself; V_j is its volume, r_ij = x_i - x_j. */

/* sum_j V_j f_j W_ij. */
SPH_API int sph_operator_interpolate(sph_operator *op, const double *f, double *value,
                                     sph_error *error);
/* sum_j V_j f_j W_ij/sum_j V_j W_ij: exact for constants.  Simpler: 0, where nobody is near. */
SPH_API int sph_operator_shepard(sph_operator *op, const double *f, double *value,
                                 sph_error *error);
/* Corrective smoothed particle method (Chen & Beraun 2000), value and gradient solved for together
 * (Liu & Liu 2006): exact for linear fields.  gradient[dim] NULL: not wanted.  Simpler: Shepard,
 * no gradient. */
SPH_API int sph_operator_cspm(sph_operator *op, const double *f, double *value,
                              double *const gradient[], sph_error *error);
/* Moving least squares: the polynomial of order 1 or 2 that fits f_j near the place best, with
 * weights V_j W_ij (Lancaster & Salkauskas 1981): value, gradient[dim] and second derivatives
 * hessian[dim (dim + 1)/2] (xx, xy, xz, yy, yz, zz); NULL: not wanted.  Exact for linear or
 * quadratic fields.  Simpler: one order less; order 0 is Shepard, and derivatives are 0. */
SPH_API int sph_operator_mls(sph_operator *op, int order, const double *f, double *value,
                             double *const gradient[], double *const hessian[], sph_error *error);

/* ---- first derivatives, by the form of the gradient:
 *
 *   "plain"       sum_j V_j f_j grad_i W_ij
 *   "difference"  sum_j V_j (f_j - f_i) grad_i W_ij, exact for constants
 *   "density"     1/rho_i sum_j m_j (f_j - f_i) grad_i W_ij, m_j = rho_j V_j
 *   "symmetric"   rho_i sum_j m_j (f_i/rho_i^2 + f_j/rho_j^2) grad_i W_ij, conserves momentum
 *   "plus"        sum_j V_j (f_i + f_j) grad_i W_ij
 *   "corrected"   M_i^-1 times "difference", M_i = sum_j V_j (x_j - x_i) (x) grad_i W_ij (Randles &
 *                 Libersky 1996), exact for linear fields.  Simpler: "difference" */

/* Name of form k = 0, 1, ..., or NULL behind the last. */
SPH_API const char *sph_operator_gradient_form(int k);
/* grad f: gradient[dim][n]. */
SPH_API int sph_operator_gradient(sph_operator *op, const char *form, const double *f,
                                  double *const gradient[], sph_error *error);
/* du^a/dx^b: gradient[a dim + b][n]. */
SPH_API int sph_operator_gradient_vector(sph_operator *op, const char *form,
                                         const double *const u[], double *const gradient[],
                                         sph_error *error);
/* div u: divergence[n]. */
SPH_API int sph_operator_divergence(sph_operator *op, const char *form, const double *const u[],
                                    double *divergence, sph_error *error);
/* d s^ab/dx^b of a tensor s[a dim + b][n]: divergence[a][n]. */
SPH_API int sph_operator_divergence_tensor(sph_operator *op, const char *form,
                                           const double *const s[], double *const divergence[],
                                           sph_error *error);
/* curl u: curl[3][n] in 3D; curl[1][n], du^y/dx - du^x/dy, in 2D. */
SPH_API int sph_operator_curl(sph_operator *op, const char *form, const double *const u[],
                              double *const curl[], sph_error *error);

/* ---- second derivatives, F_ij = (dW/dr)/r:
 *
 *   "arithmetic"      sum_j V_j (k_i + k_j) (f_i - f_j) F_ij (Brookshaw 1985)
 *   "harmonic"        sum_j V_j 4 k_i k_j/(k_i + k_j) (f_i - f_j) F_ij, for k that jumps (Cleary &
 *                     Monaghan 1999)
 *   "corrected"       2 sum_j V_j (f_i - f_j - r_ij . <grad f>_i) F_ij, <grad f> "corrected".
 *                     Simpler: "arithmetic"
 *   "fatehi-manzari"  the same with (r_ij . B_i r_ij/r^2) F_ij in place of F_ij, B_i such that it
 *                     is exact for quadratic fields (Fatehi & Manzari 2011).  Simpler: "corrected"
 *
 * With kernels whose F is singular, F_ij r^2/(r^2 + 0.01 h^2) stands for F_ij in the first three.
 */

/* Name of form k = 0, 1, ..., or NULL behind the last. */
SPH_API const char *sph_operator_laplacian_form(int k);
/* div(k grad f): laplacian[n].  k[n] >= 0; NULL: 1, and the only one that the last two know. */
SPH_API int sph_operator_laplacian(sph_operator *op, const char *form, const double *k,
                                   const double *f, double *laplacian, sph_error *error);
/* grad div u = sum_j V_j F_ij ((d + 2) (e.u_ij) e - u_ij), e = r_ij/r (Espanol & Revenga 2003):
 * out[dim][n]. */
SPH_API int sph_operator_grad_div(sph_operator *op, const double *const u[], double *const out[],
                                  sph_error *error);
/* lap u + 2 grad div u = 2 (d + 2) sum_j V_j F_ij (e.u_ij) e, the viscous force of Monaghan, Cleary
 * and Gingold, which conserves angular momentum (Monaghan 2005): out[dim][n]. */
SPH_API int sph_operator_mcg(sph_operator *op, const double *const u[], double *const out[],
                             sph_error *error);

/* ---- where a body of points ends */

enum sph_surface_state { SPH_INSIDE, SPH_SURFACE, SPH_ALONE };

/* Name of method k = 0, 1, ..., or NULL behind the last:
 *
 *   "divergence"  div x = tr M_i under 0.75, 1.5, 2.4 in 1D, 2D, 3D (Lee et al. 2008)
 *   "cone"        least eigenvalue of M_i: under 0.2 alone, over 0.75 inside; between, at the
 *                 surface unless a neighbour stands in the cone around the normal (Marrone et al.
 *                 2010) */
SPH_API const char *sph_operator_surface_method(int k);
/* state[n]: enum sph_surface_state ("divergence" tells no SPH_ALONE; "cone" also of the corner of a
 * cube); measure[n]: the number that is compared; normal[dim][n]: outward, of length 1, along
 * -M_i^-1 sum_j V_j grad_i W_ij (without M_i where it is singular), zero of a point alone; inside
 * it means nothing.  measure, normal NULL: not wanted. */
SPH_API int sph_operator_surface(sph_operator *op, const char *method, int *state, double *measure,
                                 double *const normal[], sph_error *error);

#ifdef __cplusplus
}
#endif
#endif
