/* Cylinders and cones: in the half plane of the coordinate along the axis and the distance from it,
 * a trapezoid that rests on the axis. */
#include <math.h>

#include "shape_data.h"

typedef struct cone {
  double from[3], axis[3], length; /* axis: of length 1 */
  double radius[2];                /* at from, at its other end */
} cone;

static double distance(const sph_shape *s, const double x[3])
{
  const cone *c = s->ctx;
  const double w[3] = {x[0] - c->from[0], x[1] - c->from[1], x[2] - c->from[2]};
  const double along = sph_shape_data_dot(w, c->axis);
  const double off[3] = {w[0] - along * c->axis[0], w[1] - along * c->axis[1],
                         w[2] - along * c->axis[2]};
  const double p[2] = {along, sqrt(sph_shape_data_dot(off, off))};
  const double corner[4][2] = {{0, 0},
                               {0, c->radius[0]},
                               {c->length, c->radius[1]},
                               {c->length, 0}};
  double least = INFINITY;
  for (int k = 0; k < 3; k++)
    least = fmin(least, sph_shape_data_segment(p, corner[k], corner[k + 1]));
  const double edge = c->radius[0] + along / c->length * (c->radius[1] - c->radius[0]);
  return along > 0 && along < c->length && p[1] < edge ? -least : least;
}

/* A disc around a point of the axis reaches so far along direction d. */
static double reach(const cone *c, int end, int d)
{
  return c->radius[end] * sqrt(fmax(0, 1 - c->axis[d] * c->axis[d]));
}

sph_shape *sph_shape_cone(const double *from, const double *to, double radius_from,
                          double radius_to, sph_error *error)
{
  sph_shape *s = sph_shape_data_new(3, sizeof(cone), error);
  if (!s) return NULL;
  cone *c = s->ctx;
  int status = sph_shape_data_finite("axis of a cylinder or cone", 3, from, error);
  if (!status) status = sph_shape_data_finite("axis of a cylinder or cone", 3, to, error);
  *c = (cone){.radius = {radius_from, radius_to}};
  for (int d = 0; d < 3 && !status; d++) {
    c->from[d] = from[d];
    c->axis[d] = to[d] - from[d];
  }
  c->length = sqrt(sph_shape_data_dot(c->axis, c->axis));
  if (!status && !(c->length > 0))
    status = sph_error_set(error, SPH_ERR_ARGUMENT,
                           "a cylinder or cone from a point to itself; two points are right");
  if (!status && !(radius_from >= 0 && radius_to >= 0 && radius_from + radius_to > 0 &&
                   isfinite(radius_from + radius_to)))
    status = sph_error_set(error, SPH_ERR_ARGUMENT,
                           "a cylinder or cone of radii %g and %g m; right is >= 0, and one > 0",
                           radius_from, radius_to);
  for (int d = 0; d < 3; d++) c->axis[d] /= c->length;
  for (int d = 0; d < 3 && !status; d++) {
    s->lower[d] = fmin(from[d] - reach(c, 0, d), to[d] - reach(c, 1, d));
    s->upper[d] = fmax(from[d] + reach(c, 0, d), to[d] + reach(c, 1, d));
  }
  s->distance = distance;
  if (!status) return s;
  sph_shape_free(s);
  return NULL;
}

sph_shape *sph_shape_cylinder(const double *from, const double *to, double radius, sph_error *error)
{
  return sph_shape_cone(from, to, radius, radius, error);
}
