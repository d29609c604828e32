/* What is near a surface: walls of some layers around any shape. */
#include <math.h>

#include "memory.h"
#include "shape_data.h"
#include "shape_sample.h"

typedef struct shell {
  double thickness;
  int inside;
  sph_shape_sample *surface; /* NULL: the part's distance is exact */
} shell;

/* The distance from the part, before its surface (or behind it, inside): exact up to the thickness
 * and a little more, larger beyond that. */
static double depth(const sph_shape *s, const double x[3])
{
  const shell *h = s->ctx;
  const double d = s->part[0]->distance(s->part[0], x), out = h->inside ? -d : d;
  if (!h->surface || out <= 0 || out >= h->thickness) return out;
  return fmax(out, sph_shape_sample_nearest(h->surface, x));
}

static double distance(const sph_shape *s, const double x[3])
{
  const shell *h = s->ctx;
  const double out = depth(s, x);
  return fmax(-out, out - h->thickness);
}

static void release(void *ctx)
{
  shell *h = ctx;
  sph_shape_sample_free(h->surface);
}

static int check(const sph_shape *s, const shell *h, double dx, sph_error *error)
{
  double lower[3], upper[3];
  const sph_shape *part = s->part[0];
  if (!(h->thickness > 0 && isfinite(h->thickness) && dx > 0 && isfinite(dx)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "a shell of thickness %g m for a spacing of %g m; right is > 0",
                         h->thickness, dx);
  if ((h->inside ? part->exact_inside : part->exact_outside) ||
      sph_shape_bounds(part, lower, upper))
    return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "a shell of a shape without end; an intersection with a box has one");
}

sph_shape *sph_shape_shell(sph_shape *part, double thickness, int inside, double dx,
                           sph_error *error)
{
  sph_shape *s = sph_shape_data_of(1, &part, sizeof(shell), "a shell", error);
  if (!s) return NULL;
  shell *h = s->ctx;
  *h = (shell){.thickness = thickness, .inside = inside != 0};
  s->release = release;
  s->distance = distance;
  s->exact_outside = part->exact_inside && part->exact_outside;
  int status = check(s, h, dx, error);
  if (!status && !(inside ? part->exact_inside : part->exact_outside)) {
    h->surface = sph_shape_sample_create(part, dx / 8, thickness, error);
    if (!h->surface) status = error ? error->status : SPH_ERR_MEMORY;
  }
  for (int d = 0; d < s->dim; d++) {
    s->lower[d] = part->lower[d] - (inside ? 0 : thickness);
    s->upper[d] = part->upper[d] + (inside ? 0 : thickness);
  }
  if (!status && (!h->surface == !!(inside ? part->exact_inside : part->exact_outside))) return s;
  sph_shape_free(s);
  return NULL;
}
