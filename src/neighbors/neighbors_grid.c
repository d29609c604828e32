/* The sorted column grid: one counting sort into the cells of a grid, stable, so that ties go by
 * the point's index.  Near a box: the columns that it reaches, each narrowed by its distance. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "memory.h"
#include "searches.h"

enum { CELLS_MAX = 1000000000, SAMPLE = 16384, COLUMNS = 64 };

typedef struct grids {
  sph_neighbors_def def;
  sph_grid set[SPH_SETS_MAX];
} grids;

/* Number k of a sample that is spread over all points as if by chance, always the same (multiples
 * of the golden section). */
static long sample(long k, long n)
{
  if (n <= SAMPLE) return k;
  uint64_t fraction = (uint64_t)k * 0x9e3779b97f4a7c15u >> 32; /* of 2^32 */
  return (long)(fraction * (uint64_t)n >> 32);
}

/* The interval of direction d that leaves out about one in `share` points at either end, by
 * zooming histograms. */
static void core(const sph_points *p, int d, long share, double *lo, double *hi)
{
  enum { BINS = 512, ZOOMS = 40 };
  long samples = p->n < SAMPLE ? p->n : SAMPLE, out = samples / share + 1;
  long below = 0, above = 0; /* left out already */
  for (int zoom = 0; zoom < ZOOMS; zoom++) {
    long count[BINS] = {0}, a = 0, b = BINS - 1;
    double width = (*hi - *lo) / BINS, scale = 1 / width;
    if (!(scale < INFINITY)) return;
    for (long k = 0; k < samples; k++) {
      double at = (p->x[d][sample(k, p->n)] - *lo) * scale;
      if (at >= 0 && at <= BINS) count[at < BINS ? (int)at : BINS - 1]++;
    }
    while (a < b && below + count[a] <= out) below += count[a++];
    while (b > a && above + count[b] <= out) above += count[b--];
    *hi = *lo + (double)(b + 1) * width;
    *lo += (double)a * width;
    if (b - a >= BINS / 2) return;
  }
}

/* The widest stretch of direction d that is empty between points in [lo, hi] takes no cells. */
static void fold(double reach, const sph_points *p, int d, double lo, double hi, sph_grid *grid)
{
  enum { BINS = 512 };
  double least[BINS], most[BINS], scale = BINS / (hi - lo), last = lo;
  for (int b = 0; b < BINS; b++) least[b] = INFINITY, most[b] = -INFINITY;
  for (long k = 0; scale < INFINITY && k < p->n && k < SAMPLE; k++) {
    double a = p->x[d][sample(k, p->n)], at = (a - lo) * scale;
    if (!(at >= 0 && at <= BINS)) continue;
    int b = at < BINS ? (int)at : BINS - 1;
    least[b] = fmin(least[b], a);
    most[b] = fmax(most[b], a);
  }
  grid->skip[d] = 0;
  for (int b = 0; b < BINS; b++) {
    if (most[b] < least[b]) continue;
    double skip = least[b] - last - 2 * reach;
    if (skip > grid->skip[d]) {
      grid->skip[d] = skip;
      grid->cut[d] = last + reach;
    }
    last = most[b];
  }
}

/* Lays cells over [lo, hi], fine ones `coarser` times as large, columns no narrower than those;
 * returns how many (it may be a huge number). */
static double lay(const sph_neighbors_def *def, sph_grid *grid, const double *lo, const double *hi,
                  double coarser)
{
  const double column = sph_neighbors_search_column(def);
  double total = 1;
  for (int d = 0; d < 3; d++) {
    grid->cells[d] = 1;
    if (d >= def->dim) continue;
    double size = fmax(d < def->dim - 1 ? column : 0, coarser * def->dx / 4);
    double count = floor((hi[d] - lo[d] - grid->skip[d]) / size) + 1;
    total *= count;
    grid->origin[d] = lo[d];
    grid->size[d] = size;
    grid->inverse[d] = 1 / size;
    grid->rounding[d] = 8 * DBL_EPSILON * (fabs(lo[d]) + fabs(hi[d]) + size);
    if (count <= CELLS_MAX) grid->cells[d] = (long)count;
  }
  return total;
}

/* At most a few cells per point: far flyers are clamped into the cells at the edge, the space
 * between two heaps is left out, and if that does not help (points thinly spread over a large
 * space) the cells become coarser. */
static void choose(const sph_neighbors_def *def, const sph_points *p, sph_grid *grid)
{
  double most = fmin(8 * (double)p->n + 4096, CELLS_MAX), lo[3], hi[3];
  memcpy(lo, p->lo, sizeof lo);
  memcpy(hi, p->hi, sizeof hi);
  for (int d = 0; d < 3; d++) {
    grid->cut[d] = INFINITY;
    grid->skip[d] = 0;
  }
  double total = lay(def, grid, lo, hi, 1);
  for (long share = 256; total > most && share >= 4; share /= 4) {
    for (int d = 0; d < def->dim; d++) {
      if (!def->periodic[d]) core(p, d, share, &lo[d], &hi[d]);
      fold(def->reach, p, d, lo[d], hi[d], grid);
    }
    total = lay(def, grid, lo, hi, 1);
  }
  for (double coarser = 2; total > most; coarser *= 2) total = lay(def, grid, lo, hi, coarser);
}

/* ---- sort */

static int reserve(sph_grid *grid, long n, sph_error *error)
{
  long cells = grid->cells[0] * grid->cells[1] * grid->cells[2] + 1;
  if (cells > grid->start_room) {
    int status = sph_memory_grow((void **)&grid->start, 0, (size_t)(cells + cells / 4), sizeof(int),
                                 "cell starts", error);
    if (status) return status;
    grid->start_room = cells + cells / 4;
  }
  memset(grid->start, 0, (size_t)cells * sizeof *grid->start);
  if (n <= grid->room && grid->cell) return SPH_OK;
  long room = n + n / 8 + 16;
  int status = sph_memory_grow((void **)&grid->cell, 0, (size_t)room, sizeof(int), "cells", error);
  if (!status) grid->room = room;
  return status;
}

/* Cell of coordinate x of direction d, clamped into the grid: monotone, so that no pair is lost. */
static inline long cell_of(const sph_grid *grid, int d, double x)
{
  if (x > grid->cut[d]) x = fmax(x - grid->skip[d], grid->cut[d]);
  double k = (x - grid->origin[d]) * grid->inverse[d];
  if (!(k > 0)) return 0;
  return k < (double)grid->cells[d] ? (long)k : grid->cells[d] - 1;
}

static void counting_sort(int dim, const sph_points *p, sph_grid *grid, int *order)
{
  long cells = grid->cells[0] * grid->cells[1] * grid->cells[2];
  for (long i = 0; i < p->n; i++) {
    long cell = 0;
    for (int d = 0; d < dim; d++) cell = cell * grid->cells[d] + cell_of(grid, d, p->x[d][i]);
    grid->cell[i] = (int)cell;
    grid->start[cell]++;
  }
  int sum = 0;
  for (long c = 0; c <= cells; c++) { /* counts become starts */
    int count = c < cells ? grid->start[c] : 0;
    grid->start[c] = sum;
    sum += count;
  }
  for (long i = 0; i < p->n; i++) order[grid->start[grid->cell[i]]++] = (int)i;
  memmove(grid->start + 1, grid->start, (size_t)cells * sizeof *grid->start); /* ends: starts */
  grid->start[0] = 0;
}

static int sort(void *ctx, int set, const sph_points *points, int *order, sph_error *error)
{
  grids *all = ctx;
  sph_grid *grid = &all->set[set];
  choose(&all->def, points, grid);
  int status = reserve(grid, points->n, error);
  if (!status) counting_sort(all->def.dim, points, grid, order);
  return status;
}

/* ---- near */

/* Squared distances from [lo, hi] to the columns of direction d that it reaches, *from .. *from +
 * count - 1; columns at the edge of the grid go on without end.  Returns count, 0: too many. */
static int across(const sph_grid *grid, int d, double lo, double hi, double reach, long *from,
                  double *gap2)
{
  long first = cell_of(grid, d, lo - reach), last = cell_of(grid, d, hi + reach);
  if (last - first >= COLUMNS) return 0;
  for (long k = first; k <= last; k++) {
    double left = grid->origin[d] + (double)k * grid->size[d], right = left + grid->size[d];
    if (left > grid->cut[d] + grid->rounding[d]) left += grid->skip[d];
    if (right > grid->cut[d] - grid->rounding[d]) right += grid->skip[d];
    double below = k > 0 ? left - hi : 0, above = k < grid->cells[d] - 1 ? lo - right : 0;
    double gap = (below > above ? below : above) - grid->rounding[d];
    gap2[k - first] = gap > 0 ? gap * gap : 0;
  }
  *from = first;
  return (int)(last - first + 1);
}

/* Column after column, in sorted order; too many of them: all points. */
static int near(const void *ctx, int set, const double *lo, const double *hi, double reach, int max,
                sph_stretch *stretch)
{
  const grids *all = ctx;
  const sph_grid *grid = &all->set[set];
  const int z = all->def.dim - 1;
  const long cells = grid->cells[0] * grid->cells[1] * grid->cells[2];
  const double reach2 = reach * reach * (1 + 1e-12);
  double gap2[2][COLUMNS] = {{0}};
  long from[2] = {0, 0};
  int count[2] = {1, 1}, n = 0;
  for (int d = 0; d < z; d++)
    if (!(count[d] = across(grid, d, lo[d], hi[d], reach, &from[d], gap2[d]))) {
      sph_stretch_add(stretch, &n, max, 0, grid->start[cells]);
      return n;
    }
  for (int a = 0; a < count[0]; a++)
    for (int b = 0; b < count[1]; b++) {
      double rest = reach2 - gap2[0][a] - gap2[1][b];
      if (rest <= 0) continue;
      rest = sqrt(rest) * (1 + 1e-12);
      long column = z == 0 ? 0 : from[0] + a;
      if (z == 2) column = column * grid->cells[1] + from[1] + b;
      const int *start = grid->start + column * grid->cells[z];
      sph_stretch_add(stretch, &n, max, start[cell_of(grid, z, lo[z] - rest)],
                      start[cell_of(grid, z, hi[z] + rest) + 1]);
    }
  return n;
}

/* ---- the search */

static double bytes(const void *ctx)
{
  const grids *all = ctx;
  double sum = sizeof *all;
  for (int s = 0; s < SPH_SETS_MAX; s++)
    sum += sizeof(int) * (double)(all->set[s].start_room + all->set[s].room);
  return sum;
}

static void release(void *ctx)
{
  grids *all = ctx;
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    sph_memory_free(all->set[s].start);
    sph_memory_free(all->set[s].cell);
  }
  sph_memory_free(all);
}

const sph_grid *sph_neighbors_grid_of(const sph_search *search, int set)
{
  const grids *all = search->ctx;
  return &all->set[set];
}

int sph_neighbors_grid(const sph_neighbors_def *def, sph_search *search, sph_error *error)
{
  grids *all = SPH_NEW(grids, 1, "the grid of neighbours", error);
  if (!all) return SPH_ERR_MEMORY;
  all->def = *def;
  *search = (sph_search){"grid", sort, near, bytes, release, all};
  return SPH_OK;
}
