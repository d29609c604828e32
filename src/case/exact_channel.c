/* Channel flow that starts from rest (Morris, Fox & Zhu 1997):
 *
 *   dv/dt = nu d2v/dy2 + force,  v(0) = 0,  v(width) = speed
 *
 * In units of the width and of width^2/nu:
 *
 *   v = speed [y + sum_n 2/(n pi) (-1)^n sin(n pi y) exp(-n^2 pi^2 t)]              n = 1, 2, ...
 *     + force/nu [y (1 - y)/2 - sum_n 4/(n pi)^3 sin(n pi y) exp(-n^2 pi^2 t)]      n odd
 *
 * Terms are added until the exponential is below 1e-18.  Near t = 0 that would be many: a layer at
 * the wall thinner than 1e-5 of the width is taken as not yet there. */
#include <math.h>

#include "exact.h"

static const double pi = 3.14159265358979323846;

static int check(const sph_exact_channel *c, double t, sph_error *error)
{
  if (c->width > 0 && c->nu > 0 && isfinite(c->width) && isfinite(c->nu) && isfinite(c->speed) &&
      isfinite(c->force) && t >= 0 && isfinite(t))
    return SPH_OK;
  return sph_error_set(
      error, SPH_ERR_ARGUMENT,
      "channel: width = %g m, nu = %g m^2/s, speed = %g m/s, force = %g m/s^2, t = "
      "%g s must be finite, with width > 0, nu > 0, t >= 0",
      c->width, c->nu, c->speed, c->force, t);
}

int sph_exact_channel_at(const sph_exact_channel *c, double t, long n, const double *y, double *v,
                         sph_error *error)
{
  int status = check(c, t, error);
  if (status) return status;
  double tau = t * c->nu / (c->width * c->width);
  double parabola = c->force * c->width * c->width / c->nu;
  long terms = (long)ceil(sqrt(41.5 / fmax(tau, 1e-10)) / pi);
  for (long i = 0; i < n; i++) {
    double s = fmin(fmax(y[i] / c->width, 0), 1);
    int inside = s > 0 && s < 1 && tau > 1e-10;
    v[i] = s >= 1 ? c->speed : inside ? c->speed * s + parabola * s * (1 - s) / 2 : 0;
    for (long k = terms; k >= 1 && inside; k--) { /* small ones first */
      double a = (double)k * pi, term = sin(a * s) * exp(-a * a * tau) / a;
      v[i] += k % 2 ? -(2 * c->speed + 4 * parabola / (a * a)) * term : 2 * c->speed * term;
    }
  }
  return SPH_OK;
}
