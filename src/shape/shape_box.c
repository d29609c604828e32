#include <math.h>

#include "shape_data.h"

/* q: how far x is beyond the sides; outside |max(q, 0)|, inside the largest of q. */
static double distance(const sph_shape *s, const double x[3])
{
  double beyond2 = 0, most = -INFINITY;
  for (int d = 0; d < s->dim; d++) {
    const double q = fmax(s->lower[d] - x[d], x[d] - s->upper[d]);
    beyond2 += q > 0 ? q * q : 0;
    most = fmax(most, q);
  }
  return most > 0 ? sqrt(beyond2) : most;
}

sph_shape *sph_shape_box(int dim, const double *lower, const double *upper, sph_error *error)
{
  sph_shape *s = sph_shape_data_new(dim, 1, error);
  if (!s) return NULL;
  int status = sph_shape_data_finite("lower corner of a box", dim, lower, error);
  if (!status) status = sph_shape_data_finite("upper corner of a box", dim, upper, error);
  for (int d = 0; d < dim && !status; d++) {
    s->lower[d] = lower[d];
    s->upper[d] = upper[d];
    if (!(upper[d] > lower[d]))
      status = sph_error_set(error, SPH_ERR_ARGUMENT,
                             "a box from %g to %g m; upper above lower in each direction is right",
                             lower[d], upper[d]);
  }
  s->distance = distance;
  if (!status) return s;
  sph_shape_free(s);
  return NULL;
}
