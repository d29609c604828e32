/* Stiffened gas (Harlow & Amsden 1971; Le Metayer, Massoni & Saurel 2004), thermal:
 *
 *   p = (gamma - 1) rho (u - q) - gamma p_inf,  c^2 = gamma (p + p_inf)/rho
 *   rho = (p + gamma p_inf)/((gamma - 1) (u - q)),  u = (p + gamma p_inf)/((gamma - 1) rho) + q
 *   c_v T = u - q - p_inf/rho = (p + p_inf)/((gamma - 1) rho),  T (dp/dT)_rho = p + p_inf
 *
 * It bears tension down to p = -p_inf, where T = 0; no state lies there or beyond.  q moves the
 * zero of energy: u may have either sign. */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  const double g1 = eos->gamma - 1, gamma = eos->gamma, p_inf = eos->p_inf, q = eos->q;
#pragma omp simd
  for (long i = 0; i < n; i++) {
    p[i] = g1 * rho[i] * (u[i] - q) - gamma * p_inf;
    double c2 = gamma * (p[i] + p_inf) / rho[i];
    c[i] = sqrt(c2 > 0 ? c2 : NAN);
  }
}

static double density(const sph_eos *eos, double p, double u)
{
  return (p + eos->gamma * eos->p_inf) / ((eos->gamma - 1) * (u - eos->q));
}

static double energy_at(const sph_eos *eos, double rho, double p)
{
  return (p + eos->gamma * eos->p_inf) / ((eos->gamma - 1) * rho) + eos->q;
}

void sph_eos_stiffened_gas_slopes(const sph_eos *eos, long n, const double *rho, const double *u,
                                  double *p_rho, double *p_u, double *c_rho, double *c_u)
{
  const double g1 = eos->gamma - 1;
  for (long i = 0; i < n; i++) {
    double p = g1 * rho[i] * (u[i] - eos->q) - eos->gamma * eos->p_inf;
    double c2 = eos->gamma * (p + eos->p_inf) / rho[i], c = sqrt(c2);
    p_rho[i] = g1 * (u[i] - eos->q);
    p_u[i] = g1 * rho[i];
    c_rho[i] = (eos->gamma * p_rho[i] - c2) / (2 * c * rho[i]);
    c_u[i] = eos->gamma * g1 / (2 * c);
  }
}

static void temperature(const sph_eos *eos, long n, const double *rho, const double *u, double *T)
{
  for (long i = 0; i < n; i++) T[i] = (u[i] - eos->q - eos->p_inf / rho[i]) / eos->c_v;
}

static void energy(const sph_eos *eos, long n, const double *rho, const double *T, double *u)
{
  for (long i = 0; i < n; i++) u[i] = eos->c_v * T[i] + eos->p_inf / rho[i] + eos->q;
}

static void thermal_pressure(const sph_eos *eos, long n, const double *rho, const double *T,
                             double *pT)
{
  for (long i = 0; i < n; i++) pT[i] = (eos->gamma - 1) * rho[i] * (eos->c_v * T[i]);
}

sph_eos sph_eos_stiffened_gas(double rho0, double gamma, double p_inf, double q)
{
  return (sph_eos){.name = "stiffened-gas",
                   .rho0 = rho0,
                   .c0 = sqrt(gamma * p_inf / rho0),
                   .gamma = gamma,
                   .p_min = -INFINITY,
                   .p_inf = p_inf,
                   .q = q,
                   .thermal = 1,
                   .pressure = pressure,
                   .density = density,
                   .slopes = sph_eos_stiffened_gas_slopes,
                   .energy_at = energy_at,
                   .temperature = temperature,
                   .energy = energy,
                   .thermal_pressure = thermal_pressure};
}

int sph_eos_stiffened_gas_check(const sph_eos *eos, sph_error *error)
{
  if (!(eos->gamma > 1 && isfinite(eos->gamma)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos %s: gamma = %g must be above 1 and finite (1.4 for air)", eos->name,
                         eos->gamma);
  if (!(eos->p_inf >= 0 && isfinite(eos->p_inf)) || !isfinite(eos->q))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos %s: p_inf = %g Pa, q = %g J/kg must be finite, p_inf not negative",
                         eos->name, eos->p_inf, eos->q);
  if (eos->p_inf > 0 && sph_eos_check_reference(eos, error)) return SPH_ERR_ARGUMENT;
  return sph_eos_check_thermal(eos, error);
}
