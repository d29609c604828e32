/* What the power laws share (Cole 1948; gamma = 1: linear), e = rho/rho0 - 1, B = rho0 c0^2/gamma:
 *
 *   p     = B [(1 + e)^gamma - 1] + p_b, cut: max(p, p_min)
 *   rho   = rho0 [1 + (p - p_b)/B]^(1/gamma)
 *   u_el  = int p/rho^2 drho from rho0
 *         = (c0^2/gamma) { [(1 + e)^(gamma-1) - 1]/(gamma - 1) - e/(1 + e) } + (p_b/rho0) e/(1 + e)
 *
 * Weakly compressible: e is 1e-2 and smaller, so powers go through log1p and expm1 of e.
 * Relaxation sums the energy several times a step: water, gamma = 7, has a polynomial. */
#include <math.h>

#include "eos_table.h"

double sph_eos_power_density(const sph_eos *eos, double gamma, double p)
{
  double B = eos->rho0 * eos->c0 * eos->c0 / gamma, held = p < eos->p_min ? eos->p_min : p;
  double x = (held - eos->p_background) / B;
  return eos->rho0 * (gamma == 1 ? 1 + x : exp(log1p(x) / gamma));
}

/* [(1 + e)^6 - 1]/6 - e/(1 + e) as one fraction: without cancellation, and without powers. */
static double bracket_7(double e)
{
  return e * e * (21 + e * (35 + e * (35 + e * (21 + e * (7 + e))))) / (6 * (1 + e));
}

static double bracket(double e, double gamma)
{
  double log_x = log1p(e);
  double power = gamma == 1 ? log_x : expm1((gamma - 1) * log_x) / (gamma - 1);
  return power - e / (1 + e);
}

static double uncut_energy(const sph_eos *eos, double gamma, double rho)
{
  double e = (rho - eos->rho0) / eos->rho0;
  return eos->c0 * eos->c0 / gamma * (gamma == 7 ? bracket_7(e) : bracket(e, gamma)) +
         eos->p_background / eos->rho0 * (e / (1 + e));
}

/* On the cut the pressure is p_min from rho_cut on. */
double sph_eos_power_elastic_energy(const sph_eos *eos, double gamma, double rho)
{
  double rho_cut = eos->p_min > -INFINITY ? sph_eos_power_density(eos, gamma, eos->p_min) : 0;
  if (!(rho < rho_cut)) return uncut_energy(eos, gamma, rho);
  return uncut_energy(eos, gamma, rho_cut) + eos->p_min * (1 / rho_cut - 1 / rho);
}

int sph_eos_power_check_gas(const sph_eos *eos, double p0, sph_error *error)
{
  if (fabs(eos->p_background - p0) <= 1e-12 * p0 && !(eos->p_min > 0)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "eos %s: p_background = %g Pa, p_min = %g Pa are not used: leave them %g (p "
                       "at rho0) and -INFINITY",
                       eos->name, eos->p_background, eos->p_min, p0);
}
