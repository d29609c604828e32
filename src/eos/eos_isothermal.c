/* Isothermal gas, barotropic:
 *
 *   p = c0^2 rho,  c = c0,  rho = p/c0^2,  u_el = c0^2 ln(rho/rho0) */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  (void)u;
  const double c0 = eos->c0, c2 = c0 * c0;
#pragma omp simd
  for (long i = 0; i < n; i++) {
    p[i] = c2 * rho[i];
    c[i] = c0;
  }
}

static double density(const sph_eos *eos, double p, double u)
{
  (void)u;
  return p / (eos->c0 * eos->c0);
}

static double elastic_energy(const sph_eos *eos, double rho)
{
  return eos->c0 * eos->c0 * log1p((rho - eos->rho0) / eos->rho0);
}

sph_eos sph_eos_isothermal(double rho0, double c0)
{
  return (sph_eos){.name = "isothermal",
                   .rho0 = rho0,
                   .c0 = c0,
                   .gamma = 1,
                   .p_background = rho0 * c0 * c0,
                   .p_min = -INFINITY,
                   .pressure = pressure,
                   .density = density,
                   .slopes = sph_eos_slopes_power,
                   .elastic_energy = elastic_energy};
}

int sph_eos_isothermal_check(const sph_eos *eos, sph_error *error)
{
  return sph_eos_power_check_gas(eos, eos->rho0 * eos->c0 * eos->c0, error);
}
