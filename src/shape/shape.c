#include "sphode/shape.h"

#include <math.h>

#include "memory.h"
#include "shape_data.h"

double sph_shape_distance(const sph_shape *shape, const double *x)
{
  double point[3] = {0};
  for (int d = 0; shape && d < shape->dim; d++) point[d] = x[d];
  return shape ? shape->distance(shape, point) : NAN;
}

int sph_shape_bounds(const sph_shape *shape, double *lower, double *upper)
{
  int finite = shape != NULL;
  for (int d = 0; d < 3; d++) {
    lower[d] = shape ? shape->lower[d] : 0;
    upper[d] = shape ? shape->upper[d] : 0;
    finite = finite && isfinite(lower[d]) && isfinite(upper[d]);
  }
  return finite;
}

int sph_shape_dim(const sph_shape *shape) { return shape ? shape->dim : 0; }

void sph_shape_free(sph_shape *shape)
{
  if (!shape) return;
  for (int k = 0; k < shape->parts; k++) sph_shape_free(shape->part[k]);
  if (shape->release) shape->release(shape->ctx);
  sph_memory_free(shape->ctx);
  sph_memory_free(shape->part);
  sph_memory_free(shape);
}
