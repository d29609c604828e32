/* The sorted column grid: a counting sort into the cells of a grid, stable, so that ties go by the
 * point's index.  Near a box: the columns that it reaches, each narrowed by its distance. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "memory.h"
#include "searches.h"

enum { CELLS_MAX = 1000000000, SAMPLE = 16384, COLUMNS = 64, HEAPS = 1024, PARALLEL_MIN = 4096 };

typedef struct grids {
  sph_neighbors_def def;
  int *place; /* [threads * HEAPS] of one sort (struct sorting) */
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

static int reserve(sph_grid *grid, long n, int threads, sph_error *error)
{
  long cells = grid->cells[0] * grid->cells[1] * grid->cells[2] + 1;
  if (cells > grid->start_room) {
    int status = sph_memory_grow((void **)&grid->start, 0, (size_t)(cells + cells / 4), sizeof(int),
                                 "cell starts", error);
    if (status) return status;
    grid->start_room = cells + cells / 4;
  }
  if (n <= grid->room && grid->cell) return SPH_OK;
  grid->room = 0;
  const long room = n + n / 8 + 16;
  int status = sph_memory_grow((void **)&grid->cell, 0, (size_t)room, sizeof(int), "cells", error);
  if (!status && threads > 1)
    status = sph_memory_grow((void **)&grid->heaped, 0, (size_t)room, sizeof(int), "cells", error);
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

/* One sort of n points, which share k of `shares` takes from n k/shares on.  First into heaps of
 * 2^shift cells each, then heap by heap into their cells: what a thread writes stays in its cache.
 * Both are stable, so that the order is the same for any number of shares. */
typedef struct sorting {
  const sph_points *p;
  sph_grid *grid;
  int dim, shift, shares;
  long cells, heaps;
  int *place; /* [shares][heaps]: points of each share in each heap, then where its next one goes */
} sorting;

static inline void find_cells(const sorting *s, int dim, int share)
{
  const sph_grid grid = *s->grid;
  const long end = s->p->n * (share + 1) / s->shares;
  int *count = s->place + share * s->heaps;
  memset(count, 0, (size_t)s->heaps * sizeof *count);
  for (long i = s->p->n * share / s->shares; i < end; i++) {
    long cell = 0;
    for (int d = 0; d < dim; d++) cell = cell * grid.cells[d] + cell_of(&grid, d, s->p->x[d][i]);
    grid.cell[i] = (int)cell;
    count[cell >> s->shift]++;
  }
}

static void find_cells_of(const sorting *s, int share)
{
  if (s->dim == 3)
    find_cells(s, 3, share);
  else if (s->dim == 2)
    find_cells(s, 2, share);
  else
    find_cells(s, 1, share);
}

/* Counts become places: heap after heap, in each the points of one share after the other. */
static void find_places(const sorting *s)
{
  int sum = 0;
  for (long h = 0; h < s->heaps; h++)
    for (int k = 0; k < s->shares; k++) {
      int *place = &s->place[k * s->heaps + h], count = *place;
      *place = sum;
      sum += count;
    }
}

static void fill_heaps(const sorting *s, int share)
{
  const sph_grid *grid = s->grid;
  const long end = s->p->n * (share + 1) / s->shares;
  int *place = s->place + share * s->heaps;
  for (long i = s->p->n * share / s->shares; i < end; i++)
    grid->heaped[place[grid->cell[i] >> s->shift]++] = (int)i;
}

/* Point k of all heaps; one heap has them as they are. */
static inline int heaped(const sorting *s, int k) { return s->heaps > 1 ? s->grid->heaped[k] : k; }

/* A heap into its cells, from behind: ends of cells become their starts. */
static void sort_heap(const sorting *s, long heap, int *order)
{
  const sph_grid *grid = s->grid;
  const int *ends = s->place + (s->shares - 1) * s->heaps; /* of the heaps by now */
  const int begin = heap > 0 ? ends[heap - 1] : 0;
  const int end = heap < s->heaps - 1 ? ends[heap] : (int)s->p->n;
  const long first = heap << s->shift, last = (heap + 1) << s->shift;
  int *start = grid->start, sum = begin;
  for (long c = first; c < last && c < s->cells; c++) start[c] = 0;
  for (int k = begin; k < end; k++) start[grid->cell[heaped(s, k)]]++;
  for (long c = first; c < last && c < s->cells; c++) {
    sum += start[c];
    start[c] = sum;
  }
  for (int k = end - 1; k >= begin; k--) {
    const int i = heaped(s, k);
    order[--start[grid->cell[i]]] = i;
  }
}

static void counting_sort(const grids *all, const sph_points *p, sph_grid *grid, int *order)
{
  const int threads = all->def.threads;
  sorting s = {.p = p,
               .grid = grid,
               .dim = all->def.dim,
               .shift = 8,
               .shares = p->n > PARALLEL_MIN ? threads : 1,
               .cells = grid->cells[0] * grid->cells[1] * grid->cells[2],
               .place = all->place};
  while ((s.cells - 1) >> s.shift >= (s.shares > 1 ? HEAPS : 1)) s.shift++;
  s.heaps = ((s.cells - 1) >> s.shift) + 1;
#pragma omp parallel for num_threads(threads) schedule(static) if (s.shares > 1)
  for (int k = 0; k < s.shares; k++) find_cells_of(&s, k);
  find_places(&s);
#pragma omp parallel for num_threads(threads) schedule(static) if (s.shares > 1)
  for (int k = 0; k < (s.heaps > 1 ? s.shares : 0); k++) fill_heaps(&s, k);
#pragma omp parallel for num_threads(threads) schedule(dynamic) if (s.shares > 1)
  for (long h = 0; h < s.heaps; h++) sort_heap(&s, h, order);
  grid->start[s.cells] = (int)p->n;
}

static int sort(void *ctx, int set, const sph_points *points, int *order, sph_error *error)
{
  grids *all = ctx;
  sph_grid *grid = &all->set[set];
  choose(&all->def, points, grid);
  int status = reserve(grid, points->n, all->def.threads, error);
  if (!status) counting_sort(all, points, grid, order);
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
  const int arrays = all->def.threads > 1 ? 2 : 1;
  double sum = sizeof *all + sizeof(int) * (double)HEAPS * all->def.threads;
  for (int s = 0; s < SPH_SETS_MAX; s++)
    sum += sizeof(int) * ((double)all->set[s].start_room + arrays * (double)all->set[s].room);
  return sum;
}

static void release(void *ctx)
{
  grids *all = ctx;
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    sph_memory_free(all->set[s].start);
    sph_memory_free(all->set[s].cell);
    sph_memory_free(all->set[s].heaped);
  }
  sph_memory_free(all->place);
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
  all->place = SPH_NEW(int, (long)def->threads *HEAPS, "the grid of neighbours", error);
  if (!all->place) {
    sph_memory_free(all);
    return SPH_ERR_MEMORY;
  }
  *search = (sph_search){"grid", sort, near, bytes, release, all};
  return SPH_OK;
}
