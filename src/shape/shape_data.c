#include "shape_data.h"

#include <math.h>

#include "memory.h"

sph_shape *sph_shape_data_new(int dim, size_t bytes, sph_error *error)
{
  if (dim < 1 || dim > 3) {
    sph_error_set(error, SPH_ERR_ARGUMENT, "a shape of %d dimensions; right is 1, 2 or 3", dim);
    return NULL;
  }
  sph_shape *s = SPH_NEW(sph_shape, 1, "a shape", error);
  if (s) s->ctx = sph_memory_new(1, bytes, "a shape", error);
  if (!s || !s->ctx) {
    sph_memory_free(s);
    return NULL;
  }
  s->dim = dim;
  s->exact_inside = s->exact_outside = 1;
  for (int d = 0; d < 3; d++) {
    s->lower[d] = d < dim ? -INFINITY : 0;
    s->upper[d] = d < dim ? INFINITY : 0;
  }
  return s;
}

static int right_parts(int n, sph_shape *const *part, const char *what, sph_error *error)
{
  if (n < 1 || !part)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%s of no shapes; at least one is right", what);
  for (int k = 0; k < n; k++) {
    if (!part[k]) return sph_error_set(error, SPH_ERR_ARGUMENT, "%s of no shape (NULL)", what);
    if (part[k]->dim != part[0]->dim)
      return sph_error_set(error, SPH_ERR_ARGUMENT, "%s of shapes of %d and %d dimensions", what,
                           part[0]->dim, part[k]->dim);
  }
  return SPH_OK;
}

sph_shape *sph_shape_data_of(int n, sph_shape *const *part, size_t bytes, const char *what,
                             sph_error *error)
{
  sph_shape *s =
      right_parts(n, part, what, error) ? NULL : sph_shape_data_new(part[0]->dim, bytes, error);
  if (s && !(s->part = SPH_NEW(sph_shape *, n, "parts of a shape", error))) {
    sph_shape_free(s);
    s = NULL;
  }
  for (int k = 0; part && k < n; k++) {
    if (s)
      s->part[s->parts++] = part[k];
    else
      sph_shape_free(part[k]);
  }
  return s;
}

int sph_shape_data_finite(const char *what, int n, const double *x, sph_error *error)
{
  if (!x) return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: no numbers (NULL)", what);
  for (int k = 0; k < n; k++)
    if (!isfinite(x[k]))
      return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: found %g; a finite number is right", what,
                           x[k]);
  return SPH_OK;
}

double sph_shape_data_dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double sph_shape_data_segment(const double p[2], const double a[2], const double b[2])
{
  const double e[2] = {b[0] - a[0], b[1] - a[1]}, w[2] = {p[0] - a[0], p[1] - a[1]};
  const double length2 = e[0] * e[0] + e[1] * e[1];
  const double along = length2 > 0 ? fmin(fmax((w[0] * e[0] + w[1] * e[1]) / length2, 0), 1) : 0;
  return hypot(w[0] - along * e[0], w[1] - along * e[1]);
}
