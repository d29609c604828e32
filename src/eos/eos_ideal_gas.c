/* Ideal gas with constant specific heats, thermal:
 *
 *   p = (gamma - 1) rho u,  c^2 = gamma (gamma - 1) u,  rho = p/((gamma - 1) u)
 *   c_v T = u,  c_v = R/(M (gamma - 1)):  p = rho R T/M,  T (dp/dT)_rho = p
 *
 * No state has u <= 0.  c0, p_background and p_min are not used. */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

static const double R = 8.31446261815324; /* [J/(mol K)], exact in the SI of 2019 */

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  const double g1 = eos->gamma - 1, g = eos->gamma * g1;
#pragma omp simd
  for (long i = 0; i < n; i++) {
    p[i] = g1 * rho[i] * u[i];
    c[i] = sqrt(u[i] > 0 ? g * u[i] : NAN);
  }
}

static double density(const sph_eos *eos, double p, double u) { return p / ((eos->gamma - 1) * u); }

static double energy_at(const sph_eos *eos, double rho, double p)
{
  return p / ((eos->gamma - 1) * rho);
}

static void thermal_pressure(const sph_eos *eos, long n, const double *rho, const double *T,
                             double *pT)
{
  for (long i = 0; i < n; i++) pT[i] = (eos->gamma - 1) * rho[i] * (eos->c_v * T[i]);
}

sph_eos sph_eos_ideal_gas(double gamma)
{
  return (sph_eos){.name = "ideal-gas",
                   .gamma = gamma,
                   .p_min = -INFINITY,
                   .thermal = 1,
                   .pressure = pressure,
                   .density = density,
                   .slopes = sph_eos_stiffened_gas_slopes,
                   .energy_at = energy_at,
                   .thermal_pressure = thermal_pressure};
}

sph_eos sph_eos_ideal_gas_molar(double gamma, double M)
{
  sph_eos eos = sph_eos_ideal_gas(gamma);
  eos.c_v = M > 0 && isfinite(M) ? R / (M * (gamma - 1)) : NAN;
  return eos;
}

int sph_eos_ideal_gas_check(const sph_eos *eos, sph_error *error)
{
  if (eos->p_inf == 0 && eos->q == 0) return sph_eos_stiffened_gas_check(eos, error);
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "eos ideal-gas: p_inf = %g Pa, q = %g J/kg must be 0; see stiffened-gas",
                       eos->p_inf, eos->q);
}
