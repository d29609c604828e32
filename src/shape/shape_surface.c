#include <math.h>
#include <string.h>

#include "shape_data.h"
#include "shape_mesh.h"

/* More than half of all directions meet the surface from behind: inside. */
static double distance(const sph_shape *s, const double x[3])
{
  const sph_shape_mesh *m = s->ctx;
  const double r = sph_shape_mesh_tree_distance(m, x);
  for (int d = 0; d < 3; d++)
    if (x[d] < s->lower[d] || x[d] > s->upper[d]) return r;
  return sph_shape_mesh_tree_winding(m, x) > 0.5 ? -r : r;
}

static void release(void *ctx) { sph_shape_mesh_free(ctx); }

static int make(sph_shape_mesh *m, const char *path, double unit, int holes, sph_error *error)
{
  if (!path) return sph_error_set(error, SPH_ERR_ARGUMENT, "a surface of no path (NULL)");
  if (!(unit > 0 && isfinite(unit)))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: unit of %g m; right is > 0", path, unit);
  int status = sph_shape_mesh_read(m, path, unit, error);
  if (!status && !holes) status = sph_shape_mesh_closed(m, path, error);
  const double volume = status ? 1 : sph_shape_mesh_volume(m);
  if (!status && !holes && volume == 0)
    status = sph_error_set(error, SPH_ERR_FILE, "%s: a surface without volume", path);
  if (volume < 0) sph_shape_mesh_turn(m);
  return status ? status : sph_shape_mesh_tree(m, error);
}

sph_shape *sph_shape_surface(const char *path, double unit, int holes, sph_error *error)
{
  sph_shape *s = sph_shape_data_new(3, sizeof(sph_shape_mesh), error);
  if (!s) return NULL;
  s->distance = distance;
  s->release = release;
  if (make(s->ctx, path, unit, holes, error)) {
    sph_shape_free(s);
    return NULL;
  }
  const sph_shape_mesh *m = s->ctx;
  memcpy(s->lower, m->node[0].lower, sizeof s->lower);
  memcpy(s->upper, m->node[0].upper, sizeof s->upper);
  return s;
}
