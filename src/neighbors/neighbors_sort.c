/* What all searches share: points are wrapped, looked at, sorted by the search, and copied in their
 * new order. */
#include <math.h>
#include <string.h>

#include "memory.h"
#include "neighbors_data.h"

enum { SHARES = 64, PARALLEL_MIN = 4096 }; /* of the points; points */
static const double FAR_AWAY = 1e150;      /* [m]; its square is still finite */

void sph_neighbors_sort_lend(sph_neighbors *nb, int set_number, double *const x[])
{
  sph_set *set = &nb->set[set_number];
  for (int d = 0; d < nb->def.dim; d++) {
    if (!set->lent) sph_memory_free(set->x[d]);
    set->x[d] = x[d];
  }
  set->lent = 1;
}

static int reserve(sph_neighbors *nb, sph_set *set, long n, sph_error *error)
{
  if (n <= set->room && set->order) return SPH_OK;
  size_t room = (size_t)n + (size_t)n / 8 + 16;
  int status = sph_memory_grow((void **)&set->order, 0, room, sizeof(int), "sorted order", error);
  for (int d = 0; d < nb->def.dim; d++) {
    if (!status && !set->lent)
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

/* Not finite, or so far away that double precision cannot place it. */
static int lost(const sph_neighbors *nb, const sph_set *set, const double *const x[], int d, long i)
{
  if (nb->def.periodic[d]) return !(fabs(set->wrap[d][i]) < 1e12);
  return !(fabs(x[d][i]) < FAR_AWAY);
}

/* What a share of the points says of coordinate d. */
typedef struct bounds {
  double lo[3], hi[3];
  long lost[3]; /* the first that is nowhere; -1: none */
} bounds;

/* Of points begin .. end - 1, which are wrapped.  Where a direction is periodic, x[d] of the set
 * holds them in their order for a while. */
static bounds look(const sph_neighbors *nb, sph_set *set, const double *const x[], long begin,
                   long end)
{
  bounds b = {.lost = {-1, -1, -1}};
  for (int d = 0; d < nb->def.dim; d++) {
    const int periodic = nb->def.periodic[d];
    double lo = INFINITY, hi = -INFINITY;
    for (long i = begin; i < end; i++) {
      if (periodic) set->wrap[d][i] = floor((x[d][i] - nb->def.origin[d]) / nb->def.length[d]);
      if (b.lost[d] < 0 && lost(nb, set, x, d, i)) b.lost[d] = i;
      const double a = wrapped(nb, set, x, d, i);
      if (periodic) set->x[d][i] = a;
      lo = a < lo ? a : lo;
      hi = a > hi ? a : hi;
    }
    b.lo[d] = lo;
    b.hi[d] = hi;
  }
  return b;
}

static int find_bounds(const sph_neighbors *nb, sph_set *set, const double *const x[],
                       sph_error *error)
{
  bounds of[SHARES];
  const long n = set->n;
#pragma omp parallel for num_threads(nb->def.threads) schedule(static) if (n > PARALLEL_MIN)
  for (int k = 0; k < SHARES; k++) of[k] = look(nb, set, x, n * k / SHARES, n * (k + 1) / SHARES);
  for (int d = 0; d < nb->def.dim; d++) {
    double lo = INFINITY, hi = -INFINITY;
    for (int k = 0; k < SHARES; k++) {
      const long i = of[k].lost[d];
      if (i >= 0)
        return sph_error_set(error, SPH_RETRY,
                             "coordinate %d of point %ld is %g m; right is a finite number not "
                             "extremely far away",
                             d, i, x[d][i]);
      lo = fmin(lo, of[k].lo[d]);
      hi = fmax(hi, of[k].hi[d]);
    }
    set->lo[d] = n ? lo : 0;
    set->hi[d] = n ? hi : 0;
  }
  return SPH_OK;
}

/* Each point once?  Only a user's search can fail.  Its positions are not used yet: marks. */
static int permutes(const sph_set *set)
{
  double *mark = set->x[0];
  for (long i = 0; i < set->n; i++) mark[i] = 0;
  for (long s = 0; s < set->n; s++) {
    const int i = set->order[s];
    if (i < 0 || i >= set->n || mark[i] != 0) return 0;
    mark[i] = 1;
  }
  return 1;
}

static int find_order(sph_neighbors *nb, int set_number, const double *const x[], sph_error *error)
{
  sph_set *set = &nb->set[set_number];
  const sph_search *search = &nb->search;
  sph_points points = {.n = set->n};
  for (int d = 0; d < nb->def.dim; d++) {
    points.x[d] = x[d];
    points.lo[d] = set->lo[d];
    points.hi[d] = set->hi[d];
    if (nb->def.periodic[d]) points.x[d] = set->x[d];
  }
  sph_error own = {0};
  int status = search->sort(search->ctx, set_number, &points, set->order, &own);
  if (status)
    return sph_error_set(error, status, "search %s: %s", search->name,
                         own.text[0] ? own.text : sph_status_text(status));
  if (nb->own && !permutes(set))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "search %s: its order of set %d is no permutation of 0 .. %ld",
                         search->name, set_number, set->n - 1);
  return SPH_OK;
}

/* Positions in the new order. */
static void copy(const sph_neighbors *nb, sph_set *set, const double *const x[])
{
  const long n = set->n;
#pragma omp parallel for num_threads(nb->def.threads) schedule(static) if (n > PARALLEL_MIN)
  for (int k = 0; k < SHARES; k++)
    for (int d = 0; d < nb->def.dim; d++)
      for (long s = n * k / SHARES; s < n * (k + 1) / SHARES; s++)
        set->x[d][s] = wrapped(nb, set, x, d, set->order[s]);
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
  status = find_bounds(nb, set, x, error);
  if (!status) status = find_order(nb, set_number, x, error);
  if (!status) copy(nb, set, x);
  set->sorted = !status;
  return status;
}
