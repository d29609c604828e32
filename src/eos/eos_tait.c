/* Tait-Cole (Cole 1948; Monaghan 1994), barotropic:
 *
 *   p = max(B [(rho/rho0)^gamma - 1] + p_b, p_min),  B = rho0 c0^2/gamma
 *   c = c0 (rho/rho0)^((gamma-1)/2), 0 on the cut
 *
 * Inverse and elastic energy: eos_power.c.  gamma = 7 (water) is a polynomial in e = rho/rho0 - 1
 * without cancellation, and much faster than pow; other exponents go through expm1 and log1p. */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

/* (1 + e)^7 - 1 = e (7 + 21 e + 35 e^2 + 35 e^3 + 21 e^4 + 7 e^5 + e^6),  c/c0 = (1 + e)^3 */
static void pressure_7(const sph_eos *eos, long n, const double *rho, double *p, double *c)
{
  const double rho0 = eos->rho0, c0 = eos->c0, B = rho0 * c0 * c0 / 7, inverse = 1 / rho0;
  const double p_b = eos->p_background, p_min = eos->p_min;
#pragma omp simd
  for (long i = 0; i < n; i++) {
    double e = (rho[i] - rho0) * inverse, x = 1 + e;
    double power = e * (7 + e * (21 + e * (35 + e * (35 + e * (21 + e * (7 + e))))));
    double all = B * power + p_b;
    p[i] = all < p_min ? p_min : all;
    c[i] = all < p_min ? 0 : c0 * (x * x * x);
  }
}

static void pressure_any(const sph_eos *eos, long n, const double *rho, double *p, double *c)
{
  const double gamma = eos->gamma, B = eos->rho0 * eos->c0 * eos->c0 / gamma;
  for (long i = 0; i < n; i++) {
    double e = (rho[i] - eos->rho0) / eos->rho0, power = expm1(gamma * log1p(e));
    double all = B * power + eos->p_background;
    p[i] = all < eos->p_min ? eos->p_min : all;
    c[i] = all < eos->p_min ? 0 : eos->c0 * sqrt((1 + power) / (1 + e));
  }
}

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  (void)u;
  if (eos->gamma == 7)
    pressure_7(eos, n, rho, p, c);
  else
    pressure_any(eos, n, rho, p, c);
}

static double density(const sph_eos *eos, double p, double u)
{
  (void)u;
  return sph_eos_power_density(eos, eos->gamma, p);
}

static double elastic_energy(const sph_eos *eos, double rho)
{
  return sph_eos_power_elastic_energy(eos, eos->gamma, rho);
}

sph_eos sph_eos_tait(double rho0, double c0, double gamma)
{
  return (sph_eos){.name = "tait",
                   .rho0 = rho0,
                   .c0 = c0,
                   .gamma = gamma,
                   .p_min = -INFINITY,
                   .pressure = pressure,
                   .density = density,
                   .slopes = sph_eos_slopes_power,
                   .elastic_energy = elastic_energy};
}

sph_eos sph_eos_tait_matched(const sph_eos *other, double rho0, double gamma)
{
  double c0 = NAN;
  if (other && !other->thermal && other->gamma > 0)
    c0 = other->c0 * sqrt(other->rho0 / rho0 * (gamma / other->gamma));
  sph_eos eos = sph_eos_tait(rho0, c0, gamma);
  if (other) eos.p_background = other->p_background;
  return eos;
}

int sph_eos_tait_check(const sph_eos *eos, sph_error *error)
{
  if (eos->gamma >= 1 && isfinite(eos->gamma)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "eos tait: gamma = %g must be 1 or more and finite (7 for water)",
                       eos->gamma);
}
