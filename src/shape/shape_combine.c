/* Several shapes together: the sign is exact, the size a bound on one side of the surface. */
#include <math.h>

#include "shape_data.h"

static double of_union(const sph_shape *s, const double x[3])
{
  double least = INFINITY;
  for (int k = 0; k < s->parts; k++) least = fmin(least, s->part[k]->distance(s->part[k], x));
  return least;
}

static double of_intersection(const sph_shape *s, const double x[3])
{
  double most = -INFINITY;
  for (int k = 0; k < s->parts; k++) most = fmax(most, s->part[k]->distance(s->part[k], x));
  return most;
}

static double of_difference(const sph_shape *s, const double x[3])
{
  double most = s->part[0]->distance(s->part[0], x);
  for (int k = 1; k < s->parts; k++) most = fmax(most, -s->part[k]->distance(s->part[k], x));
  return most;
}

sph_shape *sph_shape_union(int n, sph_shape *const *part, sph_error *error)
{
  sph_shape *s = sph_shape_data_of(n, part, 1, "a union", error);
  if (!s) return NULL;
  s->distance = of_union;
  s->exact_inside = n == 1 && s->part[0]->exact_inside;
  for (int d = 0; d < s->dim; d++) s->lower[d] = INFINITY, s->upper[d] = -INFINITY;
  for (int k = 0; k < n; k++) {
    s->exact_outside = s->exact_outside && s->part[k]->exact_outside;
    for (int d = 0; d < s->dim; d++) {
      s->lower[d] = fmin(s->lower[d], s->part[k]->lower[d]);
      s->upper[d] = fmax(s->upper[d], s->part[k]->upper[d]);
    }
  }
  return s;
}

sph_shape *sph_shape_intersection(int n, sph_shape *const *part, sph_error *error)
{
  sph_shape *s = sph_shape_data_of(n, part, 1, "an intersection", error);
  if (!s) return NULL;
  s->distance = of_intersection;
  s->exact_outside = n == 1 && s->part[0]->exact_outside;
  for (int k = 0; k < n; k++) {
    s->exact_inside = s->exact_inside && s->part[k]->exact_inside;
    for (int d = 0; d < s->dim; d++) {
      s->lower[d] = fmax(s->lower[d], s->part[k]->lower[d]);
      s->upper[d] = fmin(s->upper[d], s->part[k]->upper[d]);
    }
  }
  return s;
}

sph_shape *sph_shape_difference(int n, sph_shape *const *part, sph_error *error)
{
  sph_shape *s = sph_shape_data_of(n, part, 1, "a difference", error);
  if (!s) return NULL;
  s->distance = of_difference;
  s->exact_outside = n == 1 && s->part[0]->exact_outside;
  s->exact_inside = s->part[0]->exact_inside;
  for (int k = 1; k < n; k++) s->exact_inside = s->exact_inside && s->part[k]->exact_outside;
  for (int d = 0; d < s->dim; d++) {
    s->lower[d] = s->part[0]->lower[d];
    s->upper[d] = s->part[0]->upper[d];
  }
  return s;
}
