/* A shape elsewhere: x is moved back, x' = M^T (x - about - by)/scale + about. */
#include <math.h>

#include "shape_data.h"

typedef struct move {
  double by[3], about[3], scale;
  double turn[3][3]; /* rotation matrix M */
} move;

static double distance(const sph_shape *s, const double x[3])
{
  const move *m = s->ctx;
  double w[3], back[3] = {m->about[0], m->about[1], m->about[2]};
  for (int d = 0; d < 3; d++) w[d] = (x[d] - m->about[d] - m->by[d]) / m->scale;
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) back[d] += m->turn[e][d] * w[e];
  return m->scale * s->part[0]->distance(s->part[0], back);
}

/* The box around the corners of the part's, moved; without end where that has none. */
static void set_bounds(sph_shape *s)
{
  const move *m = s->ctx;
  const sph_shape *part = s->part[0];
  double lower[3], upper[3];
  if (!sph_shape_bounds(part, lower, upper)) return;
  for (int d = 0; d < s->dim; d++) s->lower[d] = INFINITY, s->upper[d] = -INFINITY;
  for (int corner = 0; corner < 8; corner++)
    for (int d = 0; d < s->dim; d++) {
      double x = m->about[d] + m->by[d];
      for (int e = 0; e < 3; e++)
        x += m->scale * m->turn[d][e] * ((corner >> e & 1 ? upper : lower)[e] - m->about[e]);
      s->lower[d] = fmin(s->lower[d], x);
      s->upper[d] = fmax(s->upper[d], x);
    }
}

static sph_shape *moved(sph_shape *part, const char *what, const double *about, sph_error *error)
{
  sph_shape *s = sph_shape_data_of(1, &part, sizeof(move), what, error);
  if (!s) return NULL;
  move *m = s->ctx;
  *m = (move){.scale = 1, .turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  s->distance = distance;
  s->exact_inside = part->exact_inside;
  s->exact_outside = part->exact_outside;
  if (about && sph_shape_data_finite(what, s->dim, about, error)) {
    sph_shape_free(s);
    return NULL;
  }
  for (int d = 0; about && d < s->dim; d++) m->about[d] = about[d];
  return s;
}

sph_shape *sph_shape_translate(sph_shape *part, const double *by, sph_error *error)
{
  sph_shape *s = moved(part, "a translation", NULL, error);
  if (!s) return NULL;
  move *m = s->ctx;
  if (sph_shape_data_finite("a translation", s->dim, by, error)) {
    sph_shape_free(s);
    return NULL;
  }
  for (int d = 0; d < s->dim; d++) m->by[d] = by[d];
  set_bounds(s);
  return s;
}

sph_shape *sph_shape_scale(sph_shape *part, double by, const double *about, sph_error *error)
{
  sph_shape *s = moved(part, "a scaled shape", about, error);
  if (!s) return NULL;
  move *m = s->ctx;
  if (!(by > 0 && isfinite(by))) {
    sph_error_set(error, SPH_ERR_ARGUMENT, "a shape scaled by %g; right is > 0", by);
    sph_shape_free(s);
    return NULL;
  }
  m->scale = by;
  set_bounds(s);
  return s;
}

/* Rodrigues' formula: M = cos 1 + sin [n]x + (1 - cos) n n^T. */
static void set_turn(move *m, const double n[3], double angle)
{
  const double c = cos(angle), s = sin(angle);
  const double cross[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++)
      m->turn[d][e] = c * (d == e) + s * cross[d][e] + (1 - c) * n[d] * n[e];
}

sph_shape *sph_shape_rotate(sph_shape *part, const double *axis, double angle, const double *about,
                            sph_error *error)
{
  static const double up[3] = {0, 0, 1};
  sph_shape *s = moved(part, "a rotation", about, error);
  if (!s) return NULL;
  if (s->dim < 3) axis = up;
  int status = sph_shape_data_finite("axis of a rotation", 3, axis, error);
  if (!status) status = sph_shape_data_finite("angle of a rotation", 1, &angle, error);
  const double length = status ? 1 : sqrt(sph_shape_data_dot(axis, axis));
  if (!status && (!(length > 0) || s->dim == 1))
    status = sph_error_set(error, SPH_ERR_ARGUMENT,
                           s->dim == 1 ? "a rotation in 1 dimension; right is 2 or 3"
                                       : "a rotation around an axis of length 0");
  if (!status) {
    const double n[3] = {axis[0] / length, axis[1] / length, axis[2] / length};
    set_turn(s->ctx, n, angle);
    set_bounds(s);
    return s;
  }
  sph_shape_free(s);
  return NULL;
}
