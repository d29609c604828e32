/* The spatial hash: columns as those of the grid, but only those that hold points, found by a hash
 * of their numbers (Teschner et al. 2003); along the last coordinate points are in order, and found
 * by halving.  Memory and time follow the points, however large their space is. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"
#include "searches.h"

typedef struct column {
  int64_t at[2];       /* its numbers, in directions before the last; 0 where there is none */
  double lo[2], hi[2]; /* the least box around its points there */
  int begin, n;        /* sorted places */
} column;

/* One set. */
typedef struct hashed {
  long points, columns, slots; /* slots: a power of two, at least twice the columns */
  long points_room, columns_room, slots_room;
  column *column; /* [columns] rising by their numbers */
  int *slot;      /* [slots] a column; -1: none */
  int *home;      /* [points] column of each, not sorted */
  double *z;      /* [points] last coordinate, sorted */
  sph_item *item; /* [points] work */
} hashed;

typedef struct hashes {
  sph_neighbors_def def;
  double inverse; /* 1/width of a column [1/m] */
  hashed set[SPH_SETS_MAX];
} hashes;

/* Rises with x, or stays: no pair is lost where it ends. */
static int64_t number_of(const hashes *all, double x)
{
  const double most = 4e18, k = x * all->inverse;
  if (!(fabs(k) < most)) return (int64_t)(k > 0 ? most : -most);
  return (int64_t)k - (k < (double)(int64_t)k);
}

static long slot_of(const hashed *h, const int64_t *at)
{
  uint64_t key = (uint64_t)at[0] * 0x9e3779b97f4a7c15u ^ (uint64_t)at[1] * 0xd1342543de82ef95u;
  key = (key ^ key >> 29) * 0xbf58476d1ce4e5b9u;
  return (long)((key ^ key >> 32) & (uint64_t)(h->slots - 1));
}

/* The slot of that column, or the free one where it would be. */
static long seek(const hashed *h, const int64_t *at)
{
  long s = slot_of(h, at);
  while (h->slot[s] >= 0 && memcmp(h->column[h->slot[s]].at, at, sizeof h->column->at))
    s = (s + 1) & (h->slots - 1);
  return s;
}

/* ---- sort */

static int reserve_points(hashed *h, long n, sph_error *error)
{
  h->points = n;
  if (n <= h->points_room && h->home) return SPH_OK;
  const size_t room = (size_t)n + (size_t)n / 8 + 16;
  int status = sph_memory_grow((void **)&h->home, 0, room, sizeof *h->home, "columns", error);
  if (!status) status = sph_memory_grow((void **)&h->z, 0, room, sizeof *h->z, "columns", error);
  if (!status)
    status = sph_memory_grow((void **)&h->item, 0, room, sizeof *h->item, "columns", error);
  if (!status) h->points_room = (long)room;
  return status;
}

static void fill_slots(hashed *h)
{
  for (long s = 0; s < h->slots; s++) h->slot[s] = -1;
  for (long c = 0; c < h->columns; c++) h->slot[seek(h, h->column[c].at)] = (int)c;
}

/* Room for one more column. */
static int reserve_columns(hashed *h, sph_error *error)
{
  int status = SPH_OK;
  if (h->columns >= h->columns_room) {
    const long room = 2 * h->columns_room + 64;
    status = sph_memory_grow((void **)&h->column, (size_t)h->columns, (size_t)room,
                             sizeof *h->column, "columns", error);
    if (status) return status;
    h->columns_room = room;
  }
  if (2 * (h->columns + 1) <= h->slots) return SPH_OK;
  const long slots = h->slots ? 2 * h->slots : 256;
  if (slots > h->slots_room) {
    status =
        sph_memory_grow((void **)&h->slot, 0, (size_t)slots, sizeof *h->slot, "columns", error);
    if (status) return status;
    h->slots_room = slots;
  }
  h->slots = slots;
  fill_slots(h);
  return SPH_OK;
}

/* Columns as they come, with their boxes and numbers of points. */
static int find_columns(const hashes *all, hashed *h, const sph_points *p, sph_error *error)
{
  const int across = all->def.dim - 1;
  h->columns = h->slots = 0;
  for (long i = 0; i < p->n; i++) {
    int64_t at[2] = {0, 0};
    int status = reserve_columns(h, error);
    if (status) return status;
    for (int d = 0; d < across; d++) at[d] = number_of(all, p->x[d][i]);
    const long s = seek(h, at);
    if (h->slot[s] < 0) {
      h->column[h->columns] =
          (column){.at = {at[0], at[1]}, .lo = {INFINITY, INFINITY}, .hi = {-INFINITY, -INFINITY}};
      h->slot[s] = (int)h->columns++;
    }
    column *c = &h->column[h->slot[s]];
    for (int d = 0; d < across; d++) {
      c->lo[d] = fmin(c->lo[d], p->x[d][i]);
      c->hi[d] = fmax(c->hi[d], p->x[d][i]);
    }
    c->begin = h->slot[s]; /* its number so far */
    c->n++;
    h->home[i] = h->slot[s];
  }
  return SPH_OK;
}

static int by_numbers(const void *a, const void *b)
{
  const column *x = a, *y = b;
  for (int d = 0; d < 2; d++)
    if (x->at[d] != y->at[d]) return x->at[d] > y->at[d] ? 1 : -1;
  return 0;
}

/* Columns in the order of their numbers; points into their columns, in the order of their index. */
static void fill_columns(const hashes *all, hashed *h, const sph_points *p)
{
  const int z = all->def.dim - 1;
  int place = 0, *renamed = h->slot; /* at least as many */
  qsort(h->column, (size_t)h->columns, sizeof *h->column, by_numbers);
  for (long c = 0; c < h->columns; c++) {
    renamed[h->column[c].begin] = (int)c;
    h->column[c].begin = place;
    place += h->column[c].n;
    h->column[c].n = 0;
  }
  for (long i = 0; i < p->n; i++) {
    column *c = &h->column[renamed[h->home[i]]];
    h->item[c->begin + c->n++] = (sph_item){{p->x[z][i]}, (int)i};
  }
  fill_slots(h);
}

static int sort(void *ctx, int set, const sph_points *points, int *order, sph_error *error)
{
  hashes *all = ctx;
  hashed *h = &all->set[set];
  int status = reserve_points(h, points->n, error);
  if (!status) status = find_columns(all, h, points, error);
  if (status) return status;
  if (points->n) fill_columns(all, h, points);
  for (long c = 0; c < h->columns; c++)
    sph_neighbors_rank_sort(h->item + h->column[c].begin, h->column[c].n, 0);
  for (long s = 0; s < points->n; s++) {
    order[s] = h->item[s].id;
    h->z[s] = h->item[s].x[0];
  }
  return SPH_OK;
}

/* ---- near */

/* First place in [begin, end) whose z is >= least. */
static int first_from(const double *z, int begin, int end, double least)
{
  while (begin < end) {
    const int middle = begin + (end - begin) / 2;
    if (z[middle] >= least)
      end = middle;
    else
      begin = middle + 1;
  }
  return begin;
}

/* First place in [begin, end) whose z is > most. */
static int first_beyond(const double *z, int begin, int end, double most)
{
  while (begin < end) {
    const int middle = begin + (end - begin) / 2;
    if (z[middle] > most)
      end = middle;
    else
      begin = middle + 1;
  }
  return begin;
}

static void near_column(const hashes *all, const hashed *h, const column *c, const double *lo,
                        const double *hi, double reach, int max, sph_stretch *stretch, int *n)
{
  const int z = all->def.dim - 1, end = c->begin + c->n;
  double rest = reach * reach * (1 + 1e-12);
  for (int d = 0; d < z; d++) {
    const double below = c->lo[d] - hi[d], above = lo[d] - c->hi[d];
    const double gap = below > above ? below : above;
    rest -= gap > 0 ? gap * gap : 0;
  }
  if (rest <= 0) return;
  rest = sqrt(rest) * (1 + 1e-12);
  const int begin = first_from(h->z, c->begin, end, lo[z] - rest);
  sph_stretch_add(stretch, n, max, begin, first_beyond(h->z, begin, end, hi[z] + rest));
}

static int near(const void *ctx, int set, const double *lo, const double *hi, double reach, int max,
                sph_stretch *stretch)
{
  const hashes *all = ctx;
  const hashed *h = &all->set[set];
  int64_t from[2] = {0, 0}, to[2] = {0, 0};
  int n = 0;
  for (int d = 0; d < all->def.dim - 1; d++) {
    from[d] = number_of(all, lo[d] - reach * (1 + 1e-12));
    to[d] = number_of(all, hi[d] + reach * (1 + 1e-12));
  }
  for (int64_t a = from[0]; h->columns && a <= to[0]; a++)
    for (int64_t b = from[1]; b <= to[1]; b++) {
      const int c = h->slot[seek(h, (const int64_t[2]){a, b})];
      if (c >= 0) near_column(all, h, &h->column[c], lo, hi, reach, max, stretch, &n);
    }
  return n;
}

/* ---- the search */

static double bytes(const void *ctx)
{
  const hashes *all = ctx;
  double sum = sizeof *all;
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    const hashed *h = &all->set[s];
    sum += (double)(sizeof *h->home + sizeof *h->z + sizeof *h->item) * (double)h->points_room;
    sum += (double)sizeof *h->column * (double)h->columns_room;
    sum += (double)sizeof *h->slot * (double)h->slots_room;
  }
  return sum;
}

static void release(void *ctx)
{
  hashes *all = ctx;
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    sph_memory_free(all->set[s].column);
    sph_memory_free(all->set[s].slot);
    sph_memory_free(all->set[s].home);
    sph_memory_free(all->set[s].z);
    sph_memory_free(all->set[s].item);
  }
  sph_memory_free(all);
}

int sph_neighbors_hash(const sph_neighbors_def *def, sph_search *search, sph_error *error)
{
  hashes *all = SPH_NEW(hashes, 1, "the hash of neighbours", error);
  if (!all) return SPH_ERR_MEMORY;
  all->def = *def;
  all->inverse = 1 / sph_neighbors_search_column(def);
  *search = (sph_search){"hash", sort, near, bytes, release, all};
  return SPH_OK;
}
