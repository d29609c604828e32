/* Heat conduction in a medium at rest (Carslaw & Jaeger 1959; Cleary & Monaghan 1999):
 * c dT/dt = d/dx (kappa dT/dx), c the heat capacity per volume, alpha = kappa/c.
 *
 *   mode       T = mean + amplitude sin(k x) exp(-alpha k^2 t)
 *   two media  T = T_m + (T_l - T_m) erf(-x/(2 sqrt(alpha_l t))),   x < 0
 *              T = T_m + (T_r - T_m) erf( x/(2 sqrt(alpha_r t))),   x > 0
 *              T_m = (b_l T_l + b_r T_r)/(b_l + b_r),  b = sqrt(kappa c) */
#include <math.h>

#include "exact.h"

static int check(const char *what, const sph_exact_medium *m, double t, sph_error *error)
{
  if (isfinite(m->temperature) && m->conductivity > 0 && isfinite(m->conductivity) &&
      m->capacity > 0 && isfinite(m->capacity) && t >= 0 && isfinite(t))
    return SPH_OK;
  return sph_error_set(
      error, SPH_ERR_ARGUMENT,
      "heat, %s: temperature = %g K, conductivity = %g W/m/K, capacity = %g "
      "J/m^3/K, t = %g s must be finite, with conductivity > 0, capacity > 0, t >= "
      "0",
      what, m->temperature, m->conductivity, m->capacity, t);
}

int sph_exact_heat_mode_at(const sph_exact_heat_mode *mode, double t, long n, const double *x,
                           double *T, sph_error *error)
{
  int status = check("mode", &mode->medium, t, error);
  if (status) return status;
  double k = mode->k, alpha = mode->medium.conductivity / mode->medium.capacity;
  double amplitude = mode->amplitude * exp(-alpha * k * k * t);
  for (long i = 0; i < n; i++) T[i] = mode->medium.temperature + amplitude * sin(k * x[i]);
  return SPH_OK;
}

int sph_exact_heat_step_at(const sph_exact_heat_step *step, double t, long n, const double *x,
                           double *T, sph_error *error)
{
  const sph_exact_medium *l = &step->left, *r = &step->right;
  int status = check("left", l, t, error);
  if (!status) status = check("right", r, t, error);
  if (status) return status;
  double b_l = sqrt(l->conductivity * l->capacity), b_r = sqrt(r->conductivity * r->capacity);
  double middle = (b_l * l->temperature + b_r * r->temperature) / (b_l + b_r);
  for (long i = 0; i < n; i++) {
    const sph_exact_medium *m = x[i] < 0 ? l : r;
    double width = 2 * sqrt(m->conductivity / m->capacity * t);
    double part = x[i] == 0 ? 0 : erf(fabs(x[i]) / width); /* t = 0: erf(inf) */
    T[i] = middle + (m->temperature - middle) * part;
  }
  return SPH_OK;
}
