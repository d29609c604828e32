#include "shape_mesh.h"

#include <math.h>
#include <stdlib.h>

#include "memory.h"

/* An edge from the lower to the higher corner; way 1: its triangle goes along it like that. */
typedef struct edge {
  int low, high, way;
} edge;

static int by_corners(const void *a, const void *b)
{
  const edge *e = a, *f = b;
  if (e->low != f->low) return (e->low > f->low) - (e->low < f->low);
  return (e->high > f->high) - (e->high < f->high);
}

static int tell(const sph_shape_mesh *m, const edge *e, const char *path, long open, long turned,
                sph_error *error)
{
  const double *a = m->corner[e->low], *b = m->corner[e->high];
  if (open)
    return sph_error_set(error, SPH_ERR_FILE,
                         "%s: the surface is not closed: %ld edges belong to one triangle only, "
                         "the first from (%g %g %g) to (%g %g %g) m; close it in the program that "
                         "made it, or say holes: true",
                         path, open, a[0], a[1], a[2], b[0], b[1], b[2]);
  return sph_error_set(error, SPH_ERR_FILE,
                       "%s: %ld edges whose triangles go round different ways, the first from (%g "
                       "%g %g) to (%g %g %g) m; make the normals point out of the body in the "
                       "program that made it",
                       path, turned, a[0], a[1], a[2], b[0], b[1], b[2]);
}

int sph_shape_mesh_closed(const sph_shape_mesh *m, const char *path, sph_error *error)
{
  const long n = 3L * m->triangles;
  long open = 0, turned = 0, at = 0;
  edge *edges = SPH_NEW(edge, n, "edges of a surface", error);
  if (!edges) return SPH_ERR_MEMORY;
  for (long k = 0; k < n; k++) {
    const int *t = m->triangle[k / 3], from = t[k % 3], to = t[(k + 1) % 3];
    edges[k] = from < to ? (edge){from, to, 1} : (edge){to, from, -1};
  }
  qsort(edges, (size_t)n, sizeof *edges, by_corners);
  for (long k = 0, end; k < n; k = end) {
    int ways = 0;
    for (end = k; end < n && !by_corners(edges + k, edges + end); end++) ways += edges[end].way;
    const int odd = (end - k) % 2 != 0;
    if (ways && (odd ? !open : !open && !turned)) at = k;
    open += odd;
    turned += ways && !odd;
  }
  int status = open || turned ? tell(m, edges + at, path, open, turned, error) : SPH_OK;
  sph_memory_free(edges);
  return status;
}

double sph_shape_mesh_volume(const sph_shape_mesh *m)
{
  double volume = 0;
  for (int k = 0; k < m->triangles; k++) {
    const double *a = m->corner[m->triangle[k][0]], *b = m->corner[m->triangle[k][1]],
                 *c = m->corner[m->triangle[k][2]];
    volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
              a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return volume / 6;
}

void sph_shape_mesh_turn(sph_shape_mesh *m)
{
  for (int k = 0; k < m->triangles; k++) {
    const int second = m->triangle[k][1];
    m->triangle[k][1] = m->triangle[k][2];
    m->triangle[k][2] = second;
  }
}

void sph_shape_mesh_free(sph_shape_mesh *m)
{
  sph_memory_free(m->corner);
  sph_memory_free(m->triangle);
  sph_memory_free(m->node);
  *m = (sph_shape_mesh){0};
}
