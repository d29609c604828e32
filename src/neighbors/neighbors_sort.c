/* One counting sort into the cells of a grid: stable, so that ties go by the point's index. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "memory.h"
#include "neighbors_data.h"

enum { CELLS_MAX = 1000000000, SAMPLE = 16384 };
static const double FAR_AWAY = 1e150; /* [m]; its square is still finite */

static int reserve(sph_neighbors *nb, sph_set *set, long n, sph_error *error)
{
  if (n <= set->room && set->order) return SPH_OK;
  size_t room = (size_t)n + (size_t)n / 8 + 16;
  int status = sph_memory_grow((void **)&set->order, 0, room, sizeof(int), "sorted order", error);
  if (!status) status = sph_memory_grow((void **)&set->cell, 0, room, sizeof(int), "cells", error);
  for (int d = 0; d < nb->def.dim; d++) {
    if (!status)
      status = sph_memory_grow((void **)&set->x[d], 0, room + SPH_LANES_MAX, sizeof(double),
                               "sorted positions", error);
    if (!status && nb->def.periodic[d])
      status =
          sph_memory_grow((void **)&set->wrap[d], 0, room, sizeof(double), "periodic wraps", error);
  }
  if (!status) set->room = (long)room;
  return status;
}

/* Coordinate d of point i inside the periodic box; its wrap is kept. */
static double wrapped(const sph_neighbors *nb, const sph_set *set, const double *const x[], int d,
                      long i)
{
  if (!nb->def.periodic[d]) return x[d][i];
  return x[d][i] - set->wrap[d][i] * nb->def.length[d];
}

static void wrap(const sph_neighbors *nb, sph_set *set, const double *const x[])
{
  for (int d = 0; d < nb->def.dim; d++)
    for (long i = 0; nb->def.periodic[d] && i < set->n; i++)
      set->wrap[d][i] = floor((x[d][i] - nb->def.origin[d]) / nb->def.length[d]);
}

/* Not finite, or so far away that double precision cannot place it. */
static int lost(const sph_neighbors *nb, const sph_set *set, const double *const x[], int d, long i)
{
  if (nb->def.periodic[d]) return !(fabs(set->wrap[d][i]) < 1e12);
  return !(fabs(x[d][i]) < FAR_AWAY);
}

static int find_bounds(const sph_neighbors *nb, sph_set *set, const double *const x[],
                       sph_error *error)
{
  for (int d = 0; d < nb->def.dim; d++) {
    double lo = INFINITY, hi = -INFINITY;
    for (long i = 0; i < set->n; i++) {
      if (lost(nb, set, x, d, i))
        return sph_error_set(error, SPH_RETRY,
                             "coordinate %d of point %ld is %g m; right is a finite number not "
                             "extremely far away",
                             d, i, x[d][i]);
      double a = wrapped(nb, set, x, d, i);
      lo = a < lo ? a : lo;
      hi = a > hi ? a : hi;
    }
    set->grid.lo[d] = set->n ? lo : 0;
    set->grid.hi[d] = set->n ? hi : 0;
  }
  return SPH_OK;
}

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
static void core(const sph_neighbors *nb, const sph_set *set, const double *const x[], int d,
                 long share, double *lo, double *hi)
{
  enum { BINS = 512, ZOOMS = 40 };
  long samples = set->n < SAMPLE ? set->n : SAMPLE, out = samples / share + 1;
  long below = 0, above = 0; /* left out already */
  for (int zoom = 0; zoom < ZOOMS; zoom++) {
    long count[BINS] = {0}, a = 0, b = BINS - 1;
    double width = (*hi - *lo) / BINS, scale = 1 / width;
    if (!(scale < INFINITY)) return;
    for (long k = 0; k < samples; k++) {
      double at = (wrapped(nb, set, x, d, sample(k, set->n)) - *lo) * scale;
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
static void fold(const sph_neighbors *nb, sph_set *set, const double *const x[], int d, double lo,
                 double hi)
{
  enum { BINS = 512 };
  double least[BINS], most[BINS], scale = BINS / (hi - lo), last = lo;
  for (int b = 0; b < BINS; b++) least[b] = INFINITY, most[b] = -INFINITY;
  for (long k = 0; scale < INFINITY && k < set->n && k < SAMPLE; k++) {
    double a = wrapped(nb, set, x, d, sample(k, set->n)), at = (a - lo) * scale;
    if (!(at >= 0 && at <= BINS)) continue;
    int b = at < BINS ? (int)at : BINS - 1;
    least[b] = fmin(least[b], a);
    most[b] = fmax(most[b], a);
  }
  set->grid.skip[d] = 0;
  for (int b = 0; b < BINS; b++) {
    if (most[b] < least[b]) continue;
    double skip = least[b] - last - 2 * nb->def.reach;
    if (skip > set->grid.skip[d]) {
      set->grid.skip[d] = skip;
      set->grid.cut[d] = last + nb->def.reach;
    }
    last = most[b];
  }
}

/* Cell sizes: columns of 2 dx in 3D, 3 dx in 2D, fine cells of dx/4; not too many within reach. */
static double cell_size(const sph_neighbors *nb, int d)
{
  if (d == nb->def.dim - 1) return nb->def.dx / 4;
  return fmax((nb->def.dim == 3 ? 2 : 3) * nb->def.dx, nb->def.reach / 8);
}

/* Lays cells over [lo, hi], fine ones `coarser` times as large, columns no narrower than those;
 * returns how many (it may be a huge number). */
static double lay(const sph_neighbors *nb, sph_grid *grid, const double *lo, const double *hi,
                  double coarser)
{
  double total = 1;
  for (int d = 0; d < 3; d++) {
    grid->cells[d] = 1;
    if (d >= nb->def.dim) continue;
    double size = fmax(cell_size(nb, d), coarser * cell_size(nb, nb->def.dim - 1));
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
static void choose_grid(const sph_neighbors *nb, sph_set *set, const double *const x[])
{
  double most = fmin(8 * (double)set->n + 4096, CELLS_MAX), lo[3] = {0}, hi[3] = {0};
  memcpy(lo, set->grid.lo, sizeof lo);
  memcpy(hi, set->grid.hi, sizeof hi);
  for (int d = 0; d < 3; d++) {
    set->grid.cut[d] = INFINITY;
    set->grid.skip[d] = 0;
  }
  double total = lay(nb, &set->grid, lo, hi, 1);
  for (long share = 256; total > most && share >= 4; share /= 4) {
    for (int d = 0; d < nb->def.dim; d++) {
      if (!nb->def.periodic[d]) core(nb, set, x, d, share, &lo[d], &hi[d]);
      fold(nb, set, x, d, lo[d], hi[d]);
    }
    total = lay(nb, &set->grid, lo, hi, 1);
  }
  for (double coarser = 2; total > most; coarser *= 2) total = lay(nb, &set->grid, lo, hi, coarser);
}

static int reserve_cells(sph_set *set, sph_error *error)
{
  long cells = set->grid.cells[0] * set->grid.cells[1] * set->grid.cells[2] + 1;
  if (cells > set->start_room) {
    int status = sph_memory_grow((void **)&set->start, 0, (size_t)(cells + cells / 4), sizeof(int),
                                 "cell starts", error);
    if (status) return status;
    set->start_room = cells + cells / 4;
  }
  memset(set->start, 0, (size_t)cells * sizeof *set->start);
  return SPH_OK;
}

static void counting_sort(const sph_neighbors *nb, sph_set *set, const double *const x[])
{
  const sph_grid *grid = &set->grid;
  long cells = grid->cells[0] * grid->cells[1] * grid->cells[2];
  for (long i = 0; i < set->n; i++) {
    long cell = 0;
    for (int d = 0; d < nb->def.dim; d++)
      cell = cell * grid->cells[d] + sph_grid_cell(grid, d, wrapped(nb, set, x, d, i));
    set->cell[i] = (int)cell;
    set->start[cell]++;
  }
  int sum = 0;
  for (long c = 0; c <= cells; c++) { /* counts become starts */
    int count = c < cells ? set->start[c] : 0;
    set->start[c] = sum;
    sum += count;
  }
  for (long i = 0; i < set->n; i++) set->order[set->start[set->cell[i]]++] = (int)i;
  memmove(set->start + 1, set->start, (size_t)cells * sizeof *set->start); /* ends become starts */
  set->start[0] = 0;
  for (int d = 0; d < nb->def.dim; d++)
    for (long s = 0; s < set->n; s++) set->x[d][s] = wrapped(nb, set, x, d, set->order[s]);
}

static void end_lists(sph_neighbors *nb, int set)
{
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    if (nb->list[set][s]) nb->list[set][s]->blocks = 0;
    if (nb->list[s][set]) nb->list[s][set]->blocks = 0;
  }
}

int sph_neighbors_sort(sph_neighbors *nb, int set_number, long n, const double *const x[],
                       sph_error *error)
{
  if (!nb) return sph_error_set(error, SPH_ERR_STATE, "sph_neighbors_sort: no search (NULL)");
  if (set_number < 0 || set_number >= SPH_SETS_MAX || n < 0 || n > 2000000000L || !x)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "set %d of %ld points; right is 0 .. %d, 0 .. 2e9", set_number, n,
                         SPH_SETS_MAX - 1);
  sph_set *set = &nb->set[set_number];
  set->sorted = 0;
  end_lists(nb, set_number);
  int status = reserve(nb, set, n, error);
  if (status) return status;
  set->n = n;
  wrap(nb, set, x);
  status = find_bounds(nb, set, x, error);
  if (!status) {
    choose_grid(nb, set, x);
    status = reserve_cells(set, error);
  }
  if (!status) counting_sort(nb, set, x);
  set->sorted = !status;
  return status;
}
