/* Polytropic (isentropic gas, stars of cold matter), barotropic:
 *
 *   p = K rho^gamma,  c^2 = gamma p/rho,  rho = (p/K)^(1/gamma),  u_el = K rho^(gamma-1)/(gamma-1)
 *
 * Kept as rho0, c0, gamma: B = K rho0^gamma = rho0 c0^2/gamma, p = B (rho/rho0)^gamma.  Elastic
 * energy is zero at zero density: the heat of the isentropic gas itself. */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

static double pressure_at_rho0(const sph_eos *eos)
{
  return eos->rho0 * eos->c0 * eos->c0 / eos->gamma;
}

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  (void)u;
  const double B = pressure_at_rho0(eos), gamma = eos->gamma;
  for (long i = 0; i < n; i++) {
    p[i] = B * pow(rho[i] / eos->rho0, gamma);
    c[i] = sqrt(gamma * p[i] / rho[i]);
  }
}

static double density(const sph_eos *eos, double p, double u)
{
  (void)u;
  return eos->rho0 * pow(p / pressure_at_rho0(eos), 1 / eos->gamma);
}

static double elastic_energy(const sph_eos *eos, double rho)
{
  double p, c;
  pressure(eos, 1, &rho, NULL, &p, &c);
  return p / ((eos->gamma - 1) * rho);
}

sph_eos sph_eos_polytropic(double rho0, double K, double gamma)
{
  double B = K * pow(rho0, gamma);
  return (sph_eos){.name = "polytropic",
                   .rho0 = rho0,
                   .c0 = sqrt(gamma * B / rho0),
                   .gamma = gamma,
                   .p_background = B,
                   .p_min = -INFINITY,
                   .pressure = pressure,
                   .density = density,
                   .slopes = sph_eos_slopes_power,
                   .elastic_energy = elastic_energy};
}

int sph_eos_polytropic_check(const sph_eos *eos, sph_error *error)
{
  if (!(eos->gamma > 1 && isfinite(eos->gamma)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos polytropic: gamma = %g must be above 1 and finite (1: isothermal)",
                         eos->gamma);
  return sph_eos_power_check_gas(eos, pressure_at_rho0(eos), error);
}
