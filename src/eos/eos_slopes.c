/* Derivatives of p, c, T and T (dp/dT)_rho with respect to rho and u (or T): formulas where an
 * equation of state gives them, else differences
 *
 *   f'(x) = [8 (f(x + e) - f(x - e)) - (f(x + 2e) - f(x - 2e))]/(12 e) + O(e^4),
 *
 * e = x/2048: 1e-11 of a smooth f, and wrong within 2e of a kink. */
#include <math.h>
#include <stddef.h>

#include "eos_table.h"

enum { POINTS = 4 };
static const double at[POINTS] = {-2, -1, 1, 2};
static const double weight[POINTS] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
static const double STEP = 0x1p-11;

static double stiffness(const sph_eos *eos, double rho, double u)
{
  double p, c;
  eos->pressure(eos, 1, &rho, &u, &p, &c);
  return c * c;
}

/* p and c of one state along d rho = a, du = b. */
static void along(const sph_eos *eos, double rho, double u, double a, double b, double *p_slope,
                  double *c_slope)
{
  *p_slope = *c_slope = 0;
  for (int k = 0; k < POINTS; k++) {
    double rho_k = rho + at[k] * STEP * a, u_k = u + at[k] * STEP * b, p, c;
    eos->pressure(eos, 1, &rho_k, eos->thermal ? &u_k : NULL, &p, &c);
    *p_slope += weight[k] / STEP * p;
    *c_slope += weight[k] / STEP * c;
  }
}

void sph_eos_slopes(const sph_eos *eos, long n, const double *rho, const double *u, double *p_rho,
                    double *p_u, double *c_rho, double *c_u)
{
  if (eos->slopes) {
    eos->slopes(eos, n, rho, u, p_rho, p_u, c_rho, c_u);
    return;
  }
  for (long i = 0; i < n; i++) {
    p_u[i] = c_u[i] = 0;
    along(eos, rho[i], u ? u[i] : 0, rho[i], 0, &p_rho[i], &c_rho[i]);
    p_rho[i] /= rho[i];
    c_rho[i] /= rho[i];
    if (!eos->thermal || !u) continue;
    double scale = stiffness(eos, rho[i], u[i]) / 4; /* of the heat in u */
    along(eos, rho[i], u[i], 0, scale, &p_u[i], &c_u[i]);
    p_u[i] /= scale;
    c_u[i] /= scale;
  }
}

/* Barotropic: dp/drho = c^2, also on the cut, where c = 0; c ~ rho^((gamma-1)/2). */
void sph_eos_slopes_power(const sph_eos *eos, long n, const double *rho, const double *u,
                          double *p_rho, double *p_u, double *c_rho, double *c_u)
{
  eos->pressure(eos, n, rho, u, p_u, c_u); /* c, for the moment */
  for (long i = 0; i < n; i++) {
    p_rho[i] = c_u[i] * c_u[i];
    c_rho[i] = (eos->gamma - 1) / 2 * c_u[i] / rho[i];
    p_u[i] = c_u[i] = 0;
  }
}

typedef void function(const sph_eos *eos, long n, const double *rho, const double *y, double *f);

/* Of f(rho, y), where y is of the size of `scale`. */
static void slopes_of(function *f, const sph_eos *eos, double rho, double y, double scale,
                      double *f_rho, double *f_y)
{
  double step_rho = STEP * rho, step_y = STEP * scale, value;
  *f_rho = *f_y = 0;
  for (int k = 0; k < POINTS; k++) {
    double rho_k = rho + at[k] * step_rho, y_k = y + at[k] * step_y;
    f(eos, 1, &rho_k, &y, &value);
    *f_rho += weight[k] / step_rho * value;
    f(eos, 1, &rho, &y_k, &value);
    *f_y += weight[k] / step_y * value;
  }
}

void sph_eos_slopes_temperature(const sph_eos *eos, long n, const double *rho, const double *u,
                                double *T_rho, double *T_u)
{
  for (long i = 0; i < n; i++) {
    double T;
    T_rho[i] = 0;
    T_u[i] = eos->c_v > 0 ? 1 / eos->c_v : 0;
    if (!(eos->c_v > 0) || !eos->temperature) continue;
    eos->temperature(eos, 1, &rho[i], &u[i], &T);
    slopes_of(eos->temperature, eos, rho[i], u[i], fabs(u[i]) + eos->c_v * fabs(T), &T_rho[i],
              &T_u[i]);
  }
}

void sph_eos_slopes_thermal_pressure(const sph_eos *eos, long n, const double *rho, const double *T,
                                     double *pT_rho, double *pT_T)
{
  for (long i = 0; i < n; i++)
    slopes_of(sph_eos_thermal_pressure, eos, rho[i], T[i], fabs(T[i]), &pT_rho[i], &pT_T[i]);
}
