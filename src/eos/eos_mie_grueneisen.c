/* Mie-Grueneisen about the Hugoniot U_s = c0 + s u_p, Gamma rho = Gamma0 rho0 (Meyers 1994;
 * Steinberg 1996), thermal.  chi = 1 - rho0/rho:
 *
 *   p = p_r(chi) + Gamma0 rho0 u
 *   chi >= 0: p_r = p_H (1 - Gamma0 chi/2), p_H = rho0 c0^2 chi/(1 - s chi)^2
 *   chi <  0: p_r = c0^2 (rho - rho0) = rho0 c0^2 chi/(1 - chi)
 *   c^2 = (rho0/rho)^2 [p_r'(chi) + Gamma0 p]/rho0,  dp/drho = c^2 - (p/rho^2) dp/du
 *   rho: at given p, u a quadratic in chi, or linear
 *
 * p_r and p_r' join at rho0.  No state at chi >= 1/s, nor where c^2 <= 0.
 *
 * Temperature with constant c_v: along the isentrope through (rho0, u = 0, T0) du_s = p/rho0 dchi
 * and dT_s = Gamma0 T_s dchi (Walsh & Christian 1955), so
 *
 *   u_s = int_0^chi exp(Gamma0 (chi - x)) p_r(x)/rho0 dx,  T_s = T0 exp(Gamma0 chi)
 *   T = T_s + (u - u_s)/c_v,  T (dp/dT)_rho = Gamma0 rho0 c_v T */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

static const double T0 = 298.15; /* [K] where u = 0 at rho0 */

/* p_r/(rho0 c0^2) and its slope; NaN where there is no state. */
static double reference(const sph_eos *eos, double chi, double *slope)
{
  const double s = eos->slope, G = eos->grueneisen, a = 1 - s * chi, b = 1 - chi;
  double compressed = chi / (a * a) * (1 - 0.5 * G * chi);
  double compressed_slope =
      (1 + s * chi) / (a * a * a) * (1 - 0.5 * G * chi) - 0.5 * G * chi / (a * a);
  *slope = chi < 0 ? 1 / (b * b) : compressed_slope;
  return chi < 0 ? chi / b : a > 0 ? compressed : NAN;
}

/* Second derivative of p_r/(rho0 c0^2). */
static double curvature(const sph_eos *eos, double chi)
{
  const double s = eos->slope, G = eos->grueneisen, a = 1 - s * chi, b = 1 - chi;
  if (chi < 0) return 2 / (b * b * b);
  double steeper = (s + 3 * s * (1 + s * chi) / a) * (1 - 0.5 * G * chi);
  return (steeper - 0.5 * G * (1 + s * chi) - 0.5 * G * a - G * s * chi) / (a * a * a);
}

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  const double rho0 = eos->rho0, c02 = eos->c0 * eos->c0, G = eos->grueneisen;
  for (long i = 0; i < n; i++) {
    double chi = (rho[i] - rho0) / rho[i], slope, p_r = reference(eos, chi, &slope);
    double x = rho0 / rho[i];
    p[i] = rho0 * (c02 * p_r + G * u[i]);
    double c2 = x * x * (c02 * slope + G * p[i] / rho0);
    c[i] = sqrt(c2 > 0 ? c2 : NAN);
  }
}

static void slopes(const sph_eos *eos, long n, const double *rho, const double *u, double *p_rho,
                   double *p_u, double *c_rho, double *c_u)
{
  const double rho0 = eos->rho0, c02 = eos->c0 * eos->c0, G = eos->grueneisen;
  for (long i = 0; i < n; i++) {
    double x = rho0 / rho[i], chi = (rho[i] - rho0) / rho[i], p, c;
    pressure(eos, 1, &rho[i], &u[i], &p, &c);
    p_u[i] = G * rho0;
    p_rho[i] = c * c - p / (rho[i] * rho[i]) * p_u[i];
    double c2_rho = x * x * (c02 * curvature(eos, chi) * x / rho[i] + G * p_rho[i] / rho0);
    c_rho[i] = c2_rho / (2 * c) - c / rho[i];
    c_u[i] = x * x * G * G / (2 * c);
  }
}

/* P (1 - s chi)^2 = chi (1 - Gamma0 chi/2) with P = (p - Gamma0 rho0 u)/(rho0 c0^2): the root that
 * grows from chi = 0 with P. */
static double density(const sph_eos *eos, double p, double u)
{
  const double s = eos->slope, G = eos->grueneisen;
  double P = (p / eos->rho0 - G * u) / (eos->c0 * eos->c0);
  if (P < 0) return eos->rho0 * (1 + P);
  double chi = 2 * P / (1 + 2 * P * s + sqrt(1 + 2 * P * (2 * s - G)));
  return eos->rho0 / (1 - chi);
}

static double energy_at(const sph_eos *eos, double rho, double p)
{
  double slope, p_r = reference(eos, (rho - eos->rho0) / rho, &slope);
  return (p / eos->rho0 - eos->c0 * eos->c0 * p_r) / eos->grueneisen;
}

/* u_s by the Gauss-Legendre rule of 5 points in 16 panels: to 1e-12 where chi is below 0.8/s. */
static double isentrope(const sph_eos *eos, double chi)
{
  enum { PANELS = 16 };
  static const double at[] = {0, 0.538469310105683091, 0.906179845938663993};
  static const double weight[] = {0.568888888888888889, 0.478628670499366468, 0.236926885056189088};
  double sum = 0, half = 0.5 * chi / PANELS, slope;
  for (int panel = 0; panel < PANELS; panel++)
    for (int k = -2; k <= 2; k++) {
      int side = k < 0 ? -k : k;
      double x = half * (2 * panel + 1 + (k < 0 ? -at[side] : at[side]));
      sum += weight[side] * exp(eos->grueneisen * (chi - x)) * reference(eos, x, &slope);
    }
  return eos->c0 * eos->c0 * half * sum;
}

static void temperature(const sph_eos *eos, long n, const double *rho, const double *u, double *T)
{
  for (long i = 0; i < n; i++) {
    double chi = (rho[i] - eos->rho0) / rho[i];
    T[i] = T0 * exp(eos->grueneisen * chi) + (u[i] - isentrope(eos, chi)) / eos->c_v;
  }
}

static void energy(const sph_eos *eos, long n, const double *rho, const double *T, double *u)
{
  for (long i = 0; i < n; i++) {
    double chi = (rho[i] - eos->rho0) / rho[i];
    u[i] = isentrope(eos, chi) + eos->c_v * (T[i] - T0 * exp(eos->grueneisen * chi));
  }
}

static void thermal_pressure(const sph_eos *eos, long n, const double *rho, const double *T,
                             double *pT)
{
  (void)rho;
  for (long i = 0; i < n; i++) pT[i] = eos->grueneisen * eos->rho0 * (eos->c_v * T[i]);
}

sph_eos sph_eos_mie_grueneisen(double rho0, double c0, double slope, double grueneisen)
{
  return (sph_eos){.name = "mie-grueneisen",
                   .rho0 = rho0,
                   .c0 = c0,
                   .p_min = -INFINITY,
                   .slope = slope,
                   .grueneisen = grueneisen,
                   .thermal = 1,
                   .pressure = pressure,
                   .density = density,
                   .slopes = slopes,
                   .energy_at = energy_at,
                   .temperature = temperature,
                   .energy = energy,
                   .thermal_pressure = thermal_pressure};
}

int sph_eos_mie_grueneisen_check(const sph_eos *eos, sph_error *error)
{
  if (!(eos->slope >= 0 && isfinite(eos->slope)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos mie-grueneisen: slope = %g must be finite and not negative (1.49 for "
                         "copper)",
                         eos->slope);
  if (!(eos->grueneisen > 0 && isfinite(eos->grueneisen)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos mie-grueneisen: grueneisen = %g must be positive and finite (2 for "
                         "copper)",
                         eos->grueneisen);
  int status = sph_eos_check_reference(eos, error);
  return status ? status : sph_eos_check_thermal(eos, error);
}
