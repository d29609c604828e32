/* A damped wave y' = lambda y, lambda = omega (-zeta +- i sqrt(1 - zeta^2)), stays bounded if
 *   |R(z)| <= 1,  z = lambda dt,  R(z) = 1 + sum_k z^k b^T A^(k-1) 1.
 * Weakly compressible flow is made of sound waves of all frequencies, damped by viscosity and
 * density diffusion.  The estimate is the smallest limit for damping ratios zeta from 0.1 to 1,
 * scaled by 0.84: then it is nowhere above, and at most 18 % below what bench/bench_stability.c
 * measures for the tables of SUNDIALS 6.4.1.  Without
 * damping half of the schemes would have no stable step at all, and yet they run. */
#include "stability.h"

#include <complex.h>
#include <math.h>

enum { STAGES = 32 };

/* Coefficients of R: [stages + 1]. */
static void polynomial(int stages, const double *const *A, const double *b, double *R)
{
  double v[STAGES], next[STAGES];
  R[0] = 1;
  for (int i = 0; i < stages; i++) v[i] = 1;
  for (int k = 1; k <= stages; k++) {
    R[k] = 0;
    for (int i = 0; i < stages; i++) {
      R[k] += b[i] * v[i];
      next[i] = 0;
      for (int j = 0; j < i; j++) next[i] += A[i][j] * v[j];
    }
    for (int i = 0; i < stages; i++) v[i] = next[i];
  }
}

static double limit(int stages, const double *R, double zeta)
{
  const double step = 0.005;
  double complex direction = -zeta + I * sqrt(1 - zeta * zeta);
  for (int n = 1; n < 4000; n++) {
    double complex z = n * step * direction, value = 0;
    for (int k = stages; k >= 0; k--) value = value * z + R[k];
    if (cabs(value) > 1 + 1e-6) return (n - 1) * step;
  }
  return 4000 * step;
}

double sph_stability(int stages, const double *const *A, const double *b)
{
  const double scale = 0.84;
  double R[STAGES + 1], least = INFINITY;
  if (stages > STAGES) return 0.1;
  polynomial(stages, A, b, R);
  for (int k = 2; k <= 20; k++) least = fmin(least, limit(stages, R, 0.05 * k));
  return scale * least;
}
