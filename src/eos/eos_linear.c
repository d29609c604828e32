/* Linear (isothermal liquid; Morris, Fox & Zhu 1997), barotropic:
 *
 *   p = max(c0^2 (rho - rho0) + p_b, p_min),  c = c0, 0 on the cut
 *
 * Inverse and elastic energy: eos_power.c with exponent 1. */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  (void)u;
  const double rho0 = eos->rho0, c0 = eos->c0, c2 = c0 * c0;
  const double p_b = eos->p_background, p_min = eos->p_min;
#pragma omp simd
  for (long i = 0; i < n; i++) {
    double all = c2 * (rho[i] - rho0) + p_b;
    p[i] = all < p_min ? p_min : all;
    c[i] = all < p_min ? 0 : c0;
  }
}

static double density(const sph_eos *eos, double p, double u)
{
  (void)u;
  return sph_eos_power_density(eos, 1, p);
}

static double elastic_energy(const sph_eos *eos, double rho)
{
  return sph_eos_power_elastic_energy(eos, 1, rho);
}

sph_eos sph_eos_linear(double rho0, double c0, double p_min)
{
  return (sph_eos){.name = "linear",
                   .rho0 = rho0,
                   .c0 = c0,
                   .gamma = 1,
                   .p_min = p_min,
                   .pressure = pressure,
                   .density = density,
                   .slopes = sph_eos_slopes_power,
                   .elastic_energy = elastic_energy};
}

/* The cut must lie at a positive density: below, there is nothing to hold. */
int sph_eos_linear_check(const sph_eos *eos, sph_error *error)
{
  double lowest = eos->p_background - eos->rho0 * eos->c0 * eos->c0;
  if (eos->p_min == -INFINITY || eos->p_min > lowest) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "eos linear: p_min = %g Pa must be above p_background - rho0 c0^2 = %g Pa, "
                       "or -INFINITY for no cut-off",
                       eos->p_min, lowest);
}
