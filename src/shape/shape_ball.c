#include <math.h>

#include "shape_data.h"

typedef struct ball {
  double centre[3], radius;
} ball;

static double distance(const sph_shape *s, const double x[3])
{
  const ball *b = s->ctx;
  const double r[3] = {x[0] - b->centre[0], x[1] - b->centre[1], x[2] - b->centre[2]};
  return sqrt(sph_shape_data_dot(r, r)) - b->radius;
}

sph_shape *sph_shape_ball(int dim, const double *centre, double radius, sph_error *error)
{
  sph_shape *s = sph_shape_data_new(dim, sizeof(ball), error);
  if (!s) return NULL;
  ball *b = s->ctx;
  int status = sph_shape_data_finite("centre of a ball", dim, centre, error);
  if (!status && !(radius > 0 && isfinite(radius)))
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "a ball of radius %g m; right is > 0", radius);
  for (int d = 0; d < dim && !status; d++) {
    b->centre[d] = centre[d];
    s->lower[d] = centre[d] - radius;
    s->upper[d] = centre[d] + radius;
  }
  b->radius = radius;
  s->distance = distance;
  if (!status) return s;
  sph_shape_free(s);
  return NULL;
}
