/* Ideal gas with constant specific heats, thermal:
 *
 *   p = (gamma - 1) rho u,  c^2 = gamma (gamma - 1) u,  rho = p/((gamma - 1) u)
 *
 * rho0, c0, p_background and p_min are not used. */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  const double g1 = eos->gamma - 1, g = eos->gamma * g1;
#pragma omp simd
  for (long i = 0; i < n; i++) {
    p[i] = g1 * rho[i] * u[i];
    c[i] = sqrt(g * u[i]);
  }
}

static double density(const sph_eos *eos, double p, double u) { return p / ((eos->gamma - 1) * u); }

sph_eos sph_eos_ideal_gas(double gamma)
{
  return (sph_eos){.name = "ideal-gas",
                   .gamma = gamma,
                   .p_min = -INFINITY,
                   .thermal = 1,
                   .pressure = pressure,
                   .density = density};
}

int sph_eos_ideal_gas_check(const sph_eos *eos, sph_error *error)
{
  if (!(eos->gamma > 1 && isfinite(eos->gamma)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos ideal-gas: gamma = %g must be above 1 and finite (1.4 for air)",
                         eos->gamma);
  if (!eos->thermal)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "eos ideal-gas: thermal = 0 must be 1");
  if (eos->p_background != 0 || eos->p_min > 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos ideal-gas: p_background = %g Pa, p_min = %g Pa are not used: leave "
                         "them 0 and -INFINITY",
                         eos->p_background, eos->p_min);
  return SPH_OK;
}
