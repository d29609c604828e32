/* Column of liquid at rest under gravity: dp/dz = -rho g.  With p - p_b = B [(rho/rho0)^gamma - 1]
 * (linear: gamma = 1), dp/rho = c0^2 x^(gamma-2) dx, x = rho/rho0, so at depth d below the surface
 *
 *   x^(gamma-1) = x_s^(gamma-1) + (gamma-1) g d/c0^2,  gamma = 1: x = x_s exp(g d/c0^2)
 *
 * The usual start p = rho0 g d is not a solution: it is out of balance by order g d/c0^2. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "exact.h"

static int check(const sph_exact_column *column, sph_error *error)
{
  const sph_eos *eos = &column->eos;
  if (!eos->name || (strcmp(eos->name, "tait") && strcmp(eos->name, "linear")))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "column: no exact solution for the equation of state %s; there is one for "
                         "tait and linear",
                         eos->name ? eos->name : "without a name");
  if (!(isfinite(column->surface) && column->g >= 0 && isfinite(column->g)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "column: surface = %g m, g = %g m/s^2 must be finite, with g >= 0",
                         column->surface, column->g);
  double rho = eos->density(eos, column->p_surface, 0);
  if (rho > 0 && isfinite(rho)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "column: p_surface = %g Pa is below what the equation of state can hold",
                       column->p_surface);
}

int sph_exact_column_at(const sph_exact_column *column, long n, const double *z, double *rho,
                        double *p, sph_error *error)
{
  int status = check(column, error);
  if (status) return status;
  const sph_eos *eos = &column->eos;
  double gamma = eos->gamma, x_s = eos->density(eos, column->p_surface, 0) / eos->rho0;
  double per_metre = column->g / (eos->c0 * eos->c0);
  for (long i = 0; i < n; i++) {
    double depth = column->surface > z[i] ? column->surface - z[i] : 0, s = depth * per_metre, c;
    double x =
        gamma == 1 ? x_s * exp(s) : pow(pow(x_s, gamma - 1) + (gamma - 1) * s, 1 / (gamma - 1));
    double density = eos->rho0 * x;
    if (rho) rho[i] = density;
    if (p) eos->pressure(eos, 1, &density, NULL, &p[i], &c);
  }
  return SPH_OK;
}
