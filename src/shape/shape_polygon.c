/* Polygons in 2D, and prisms: polygons drawn out along an axis. */
#include <math.h>
#include <string.h>

#include "memory.h"
#include "shape_data.h"

typedef struct polygon {
  int n;
  double (*corner)[2];  /* [n] owned */
  int axis, across, up; /* of a prism; the directions of the polygon */
  double from, to;      /* of a prism [m] */
} polygon;

/* The nearest edge; inside where a ray along the first direction crosses an odd number of them. */
static double in_plane(const polygon *p, const double x[2])
{
  double least = INFINITY;
  int inside = 0;
  for (int k = 0, before = p->n - 1; k < p->n; before = k++) {
    const double *a = p->corner[before], *b = p->corner[k];
    least = fmin(least, sph_shape_data_segment(x, a, b));
    if ((a[1] > x[1]) != (b[1] > x[1]) &&
        x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      inside = !inside;
  }
  return inside ? -least : least;
}

static double distance(const sph_shape *s, const double x[3]) { return in_plane(s->ctx, x); }

static double prism_distance(const sph_shape *s, const double x[3])
{
  const polygon *p = s->ctx;
  const double flat[2] = {x[p->across], x[p->up]}, side = in_plane(p, flat);
  const double end = fmax(p->from - x[p->axis], x[p->axis] - p->to);
  const double most = fmax(side, end);
  return most > 0 ? hypot(fmax(side, 0), fmax(end, 0)) : most;
}

static double turn(const double *a, const double *b, const double *c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int cross(const double *a, const double *b, const double *c, const double *d)
{
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

static int check_edges(const polygon *p, sph_error *error)
{
  double area = 0;
  for (int k = 0, before = p->n - 1; k < p->n; before = k++) {
    area += turn(p->corner[0], p->corner[before], p->corner[k]);
    for (int m = k + 1; m < p->n; m++)
      if (cross(p->corner[before], p->corner[k], p->corner[m - 1], p->corner[m]))
        return sph_error_set(error, SPH_ERR_ARGUMENT,
                             "a polygon whose edges to the corners %d and %d cross (counted from "
                             "0); corners in order around it are right",
                             k, m);
  }
  if (area != 0) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "a polygon without area; corners in order are right");
}

static void release(void *ctx)
{
  polygon *p = ctx;
  sph_memory_free(p->corner);
}

/* across, up: the directions of the plane. */
static sph_shape *polygon_of(int dim, int n, const double (*corner)[2], int across, int up,
                             sph_error *error)
{
  if (n < 3 || !corner) {
    sph_error_set(error, SPH_ERR_ARGUMENT, "a polygon of %d corners; right is 3 or more",
                  corner ? n : 0);
    return NULL;
  }
  sph_shape *s = sph_shape_data_new(dim, sizeof(polygon), error);
  if (!s) return NULL;
  polygon *p = s->ctx;
  *p = (polygon){.n = n, .across = across, .up = up};
  s->release = release;
  p->corner = sph_memory_new((size_t)n, sizeof *p->corner, "a polygon", error);
  int status = p->corner ? SPH_OK : SPH_ERR_MEMORY;
  if (!status) status = sph_shape_data_finite("corner of a polygon", 2 * n, corner[0], error);
  if (!status) {
    memcpy(p->corner, corner, (size_t)n * sizeof *p->corner);
    status = check_edges(p, error);
  }
  for (int e = 0; e < 2 && !status; e++) {
    const int d = e ? up : across;
    s->lower[d] = INFINITY;
    s->upper[d] = -INFINITY;
    for (int k = 0; k < n; k++) {
      s->lower[d] = fmin(s->lower[d], corner[k][e]);
      s->upper[d] = fmax(s->upper[d], corner[k][e]);
    }
  }
  s->distance = distance;
  if (!status) return s;
  sph_shape_free(s);
  return NULL;
}

sph_shape *sph_shape_polygon(int n, const double (*corner)[2], sph_error *error)
{
  return polygon_of(2, n, corner, 0, 1, error);
}

sph_shape *sph_shape_prism(int n, const double (*corner)[2], int axis, double from, double to,
                           sph_error *error)
{
  if (axis < 0 || axis > 2 || !isfinite(from) || !isfinite(to) || !(to > from)) {
    sph_error_set(error, SPH_ERR_ARGUMENT,
                  "a prism along axis %d from %g to %g m; right are axes 0, 1, 2, and to > from",
                  axis, from, to);
    return NULL;
  }
  sph_shape *s = polygon_of(3, n, corner, axis == 0 ? 1 : 0, axis == 2 ? 1 : 2, error);
  if (!s) return NULL;
  polygon *p = s->ctx;
  p->axis = axis;
  s->lower[axis] = p->from = from;
  s->upper[axis] = p->to = to;
  s->distance = prism_distance;
  return s;
}
