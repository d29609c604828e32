/* Drop of an incompressible liquid in 2D under the force -omega^2 r per mass (Monaghan 1994;
 * Monaghan & Rafiee 2013): v = (A x, -A y) keeps it an ellipse of semi-axes a, b,
 *
 *   A' = (A^2 + omega^2) (b^2 - a^2)/(a^2 + b^2),  a' = A a,  b' = -A b
 *   p/rho = p0 (1 - x^2/a^2 - y^2/b^2),  p0 = a^2 (A' + A^2 + omega^2)/2
 *
 * a b is constant; for small A the period is 2 pi/(sqrt(2) omega).  In code: y = (A, a, b). */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <stddef.h>

#include "exact.h"
#include "gsl.h"

static double rate_of_rate(const sph_exact_drop *drop, const double y[3])
{
  double a2 = y[1] * y[1], b2 = y[2] * y[2];
  return (y[0] * y[0] + drop->omega * drop->omega) * (b2 - a2) / (a2 + b2);
}

static int rhs(double t, const double y[], double f[], void *context)
{
  (void)t;
  f[0] = rate_of_rate(context, y);
  f[1] = y[0] * y[1];
  f[2] = -y[0] * y[2];
  return GSL_SUCCESS;
}

static sph_exact_ellipse ellipse(const sph_exact_drop *drop, const double y[3])
{
  double sum = rate_of_rate(drop, y) + y[0] * y[0] + drop->omega * drop->omega;
  return (sph_exact_ellipse){y[1], y[2], y[0], 0.5 * y[1] * y[1] * sum};
}

static int check(const sph_exact_drop *drop, long n, const double *t, sph_error *error)
{
  if (!(drop->radius > 0 && isfinite(drop->radius) && isfinite(drop->rate) && drop->omega >= 0 &&
        isfinite(drop->omega)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "drop: radius = %g m, rate = %g /s, omega = %g /s must be finite, with "
                         "radius > 0 and omega >= 0",
                         drop->radius, drop->rate, drop->omega);
  for (long k = 0; k < n; k++)
    if (!(t[k] >= (k ? t[k - 1] : 0) && isfinite(t[k])))
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "drop: time %ld = %g s must be finite and not below %g s", k, t[k],
                           k ? t[k - 1] : 0);
  return SPH_OK;
}

int sph_exact_drop_at(const sph_exact_drop *drop, long n, const double *t,
                      sph_exact_ellipse *ellipses, sph_error *error)
{
  int status = check(drop, n, t, error);
  if (status) return status;
  /* In units of the radius, so that one tolerance fits all. */
  double y[3] = {drop->rate, 1, 1}, now = 0, fastest = fmax(fabs(drop->rate), drop->omega);
  sph_exact_drop parameters = *drop; /* GSL wants them writable */
  gsl_odeiv2_system system = {rhs, NULL, 3, &parameters};
  sph_gsl_begin();
  gsl_odeiv2_driver *driver =
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd,
                                    fastest > 0 ? 1e-3 / fastest : 1, 1e-14, 1e-13);
  if (!driver) status = GSL_ENOMEM;
  for (long k = 0; !status && k < n; k++) {
    if (t[k] > now) status = gsl_odeiv2_driver_apply(driver, &now, t[k], y);
    ellipses[k] = ellipse(drop, y);
    ellipses[k].a *= drop->radius;
    ellipses[k].b *= drop->radius;
    ellipses[k].p0 *= drop->radius * drop->radius;
  }
  if (driver) gsl_odeiv2_driver_free(driver);
  sph_gsl_end();
  if (!status) return SPH_OK;
  return sph_error_set(error, SPH_ERR_STEP, "drop: integration stopped at t = %g s: %s", now,
                       gsl_strerror(status));
}
