/* Points where a shape's distance changes its sign along the edges of a fine grid.  The grid is
 * never made: a cube whose middle is farther from the surface than its corners holds none of it,
 * others are halved.  Nearest points are looked for in cells as large as the reach. */
#include "shape_sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"

enum { BISECTIONS = 30 };
static const double MOST = 1e8; /* points: 2.4 GB */

struct sph_shape_sample {
  const sph_shape *shape; /* while it is made */
  int dim;
  long n, room;
  double (*x)[3];
  double reach, origin[3];
  long cells[3], *first; /* [cells + 1] points of a cell, in order */
  sph_error *error;
};

static int add(sph_shape_sample *s, const double x[3])
{
  if (s->n == s->room) {
    const long room = 2 * s->room + 1024;
    if ((double)room > MOST)
      return sph_error_set(s->error, SPH_ERR_ARGUMENT,
                           "a shell whose surface has more than %g points; a coarser spacing is "
                           "right",
                           MOST);
    int status = sph_memory_grow((void **)&s->x, (size_t)s->room, (size_t)room, sizeof *s->x,
                                 "points of a surface", s->error);
    if (status) return status;
    s->room = room;
  }
  memcpy(s->x[s->n++], x, sizeof *s->x);
  return SPH_OK;
}

/* The place between a and b, along direction d, where the sign changes. */
static int add_crossing(sph_shape_sample *s, const double a[3], int d, double length, int inside)
{
  double low = 0, high = length, x[3] = {a[0], a[1], a[2]};
  for (int k = 0; k < BISECTIONS; k++) {
    const double middle = (low + high) / 2;
    x[d] = a[d] + middle;
    if ((s->shape->distance(s->shape, x) < 0) == inside)
      low = middle;
    else
      high = middle;
  }
  x[d] = a[d] + (low + high) / 2;
  return add(s, x);
}

static int add_edges(sph_shape_sample *s, const double corner[3], double size)
{
  const int inside = s->shape->distance(s->shape, corner) < 0;
  int status = SPH_OK;
  for (int d = 0; d < s->dim && d < 3 && !status; d++) {
    double end[3] = {corner[0], corner[1], corner[2]};
    end[d] += size;
    if ((s->shape->distance(s->shape, end) < 0) != inside)
      status = add_crossing(s, corner, d, size, inside);
  }
  return status;
}

static int descend(sph_shape_sample *s, const double corner[3], double size, int levels)
{
  double middle[3] = {0};
  for (int d = 0; d < s->dim; d++) middle[d] = corner[d] + size / 2;
  if (fabs(s->shape->distance(s->shape, middle)) > 0.51 * sqrt(s->dim) * size) return SPH_OK;
  if (levels == 0) return add_edges(s, corner, size);
  int status = SPH_OK;
  for (int k = 0; k < 1 << s->dim && !status; k++) {
    double child[3] = {0};
    for (int d = 0; d < s->dim; d++) child[d] = corner[d] + (k >> d & 1 ? size / 2 : 0);
    status = descend(s, child, size / 2, levels - 1);
  }
  return status;
}

static long cell_of(const sph_shape_sample *s, const double x[3])
{
  long cell = 0;
  for (int d = s->dim - 1; d >= 0; d--) {
    long k = (long)floor((x[d] - s->origin[d]) / s->reach);
    k = k < 0 ? 0 : k >= s->cells[d] ? s->cells[d] - 1 : k;
    cell = cell * s->cells[d] + k;
  }
  return cell;
}

/* Points in the order of their cells. */
static int sort(sph_shape_sample *s)
{
  long cells = 1;
  for (int d = 0; d < s->dim; d++) cells *= s->cells[d];
  s->first = SPH_NEW(long, cells + 1, "points of a surface", s->error);
  double(*sorted)[3] =
      sph_memory_new((size_t)s->n, sizeof *sorted, "points of a surface", s->error);
  if (!s->first || !sorted) {
    sph_memory_free(sorted);
    return SPH_ERR_MEMORY;
  }
  for (long i = 0; i < s->n; i++) s->first[cell_of(s, s->x[i]) + 1]++;
  for (long k = 0; k < cells; k++) s->first[k + 1] += s->first[k];
  for (long i = s->n - 1; i >= 0; i--) { /* from behind: first[k + 1] becomes the begin of k + 1 */
    const long k = cell_of(s, s->x[i]);
    memcpy(sorted[--s->first[k + 1]], s->x[i], sizeof *sorted);
  }
  for (long k = 0; k < cells; k++) s->first[k] = s->first[k + 1];
  s->first[cells] = s->n;
  sph_memory_free(s->x);
  s->x = sorted;
  return SPH_OK;
}

static int make(sph_shape_sample *s, double apart)
{
  double lower[3], upper[3], side = 0, corner[3] = {0};
  sph_shape_bounds(s->shape, lower, upper);
  for (int d = 0; d < s->dim; d++) side = fmax(side, upper[d] - lower[d]);
  side += 2 * apart;
  const int levels = (int)fmax(0, ceil(log2(side / apart)));
  if (levels > 20)
    return sph_error_set(s->error, SPH_ERR_ARGUMENT,
                         "a shell of a shape of %g m for points %g m apart: too fine", side, apart);
  for (int d = 0; d < s->dim; d++) { /* off the places where faces use to be */
    corner[d] = lower[d] - (0.5 + 0.01 * (d + 1)) * apart;
    s->origin[d] = corner[d];
    s->cells[d] = (long)fmax(1, ceil((upper[d] - lower[d] + 2 * apart) / s->reach));
  }
  int status = descend(s, corner, apart * (double)(1L << levels), levels);
  if (!status && s->n == 0)
    status = sph_error_set(s->error, SPH_ERR_ARGUMENT,
                           "a shell of a shape that is empty, or thinner than %g m", apart);
  return status ? status : sort(s);
}

sph_shape_sample *sph_shape_sample_create(const sph_shape *shape, double apart, double reach,
                                          sph_error *error)
{
  sph_error own = {0};
  sph_shape_sample *s = SPH_NEW(sph_shape_sample, 1, "points of a surface", error);
  if (!s) return NULL;
  *s = (sph_shape_sample){.shape = shape,
                          .dim = shape->dim,
                          .reach = reach + apart,
                          .cells = {1, 1, 1},
                          .error = error ? error : &own};
  if (!make(s, apart)) return s;
  sph_shape_sample_free(s);
  return NULL;
}

double sph_shape_sample_nearest(const sph_shape_sample *s, const double x[3])
{
  long from[3] = {0}, to[3] = {0};
  double least = s->reach * s->reach;
  for (int d = 0; d < s->dim; d++) {
    const double k = floor((x[d] - s->origin[d]) / s->reach);
    from[d] = (long)fmin(fmax(k - 1, 0), (double)s->cells[d]);
    to[d] = (long)fmin(k + 1, (double)s->cells[d] - 1);
  }
  for (long c = from[2]; c <= to[2]; c++)
    for (long b = from[1]; b <= to[1]; b++) {
      const long row = (c * s->cells[1] + b) * s->cells[0];
      if (from[0] > to[0]) continue;
      for (long i = s->first[row + from[0]]; i < s->first[row + to[0] + 1]; i++) {
        const double r[3] = {x[0] - s->x[i][0], x[1] - s->x[i][1], x[2] - s->x[i][2]};
        least = fmin(least, sph_shape_data_dot(r, r));
      }
    }
  return sqrt(least);
}

void sph_shape_sample_free(sph_shape_sample *s)
{
  if (!s) return;
  sph_memory_free(s->x);
  sph_memory_free(s->first);
  sph_memory_free(s);
}
