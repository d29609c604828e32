#include <math.h>

#include "shape_data.h"

typedef struct plane {
  double point[3], normal[3]; /* of length 1 */
} plane;

static double distance(const sph_shape *s, const double x[3])
{
  const plane *p = s->ctx;
  const double w[3] = {x[0] - p->point[0], x[1] - p->point[1], x[2] - p->point[2]};
  return sph_shape_data_dot(w, p->normal);
}

/* One whose normal is that of an axis ends there. */
static void set_bounds(sph_shape *s, const plane *p)
{
  for (int d = 0; d < s->dim; d++) {
    if (p->normal[d] == 1) s->upper[d] = p->point[d];
    if (p->normal[d] == -1) s->lower[d] = p->point[d];
  }
}

sph_shape *sph_shape_half_space(int dim, const double *point, const double *normal,
                                sph_error *error)
{
  sph_shape *s = sph_shape_data_new(dim, sizeof(plane), error);
  if (!s) return NULL;
  plane *p = s->ctx;
  int status = sph_shape_data_finite("point of a half space", dim, point, error);
  if (!status) status = sph_shape_data_finite("normal of a half space", dim, normal, error);
  for (int d = 0; d < dim && !status; d++) {
    p->point[d] = point[d];
    p->normal[d] = normal[d];
  }
  const double length = sqrt(sph_shape_data_dot(p->normal, p->normal));
  if (!status && !(length > 0))
    status = sph_error_set(error, SPH_ERR_ARGUMENT,
                           "a half space with a normal of length %g; right is > 0", length);
  for (int d = 0; d < dim && !status; d++) p->normal[d] /= length;
  set_bounds(s, p);
  s->distance = distance;
  if (!status) return s;
  sph_shape_free(s);
  return NULL;
}
