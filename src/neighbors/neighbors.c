#include "sphode/neighbors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"
#include "neighbors_data.h"
#include "searches.h"

static int check(const sph_neighbors_def *def, sph_error *error)
{
  if (def->dim < 1 || def->dim > 3)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "dim = %d; right is 1, 2 or 3", def->dim);
  if (!(def->reach > 0 && def->reach < INFINITY))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "reach = %g m; right is a finite number > 0",
                         def->reach);
  if (!(def->dx >= 0 && def->dx < INFINITY))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "dx = %g m; right is a finite number >= 0",
                         def->dx);
  if (def->lanes != 0 && def->lanes != 1 && def->lanes != 2 && def->lanes != 4 && def->lanes != 8)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "lanes = %d; right is 1, 2, 4 or 8", def->lanes);
  if (def->threads < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "threads = %d; right is >= 0", def->threads);
  if (sph_neighbors_search_check(def->search, def->own, error)) return SPH_ERR_ARGUMENT;
  for (int d = 0; d < def->dim; d++) {
    if (!def->periodic[d]) continue;
    if (!(def->length[d] >= 2 * def->reach && def->length[d] < INFINITY) ||
        !isfinite(def->origin[d]))
      return sph_error_set(
          error, SPH_ERR_ARGUMENT,
          "periodic direction %d: length %g m from %g m; right is at least 2 reach = %g m", d,
          def->length[d], def->origin[d], 2 * def->reach);
  }
  return SPH_OK;
}

/* Image 0 is no shift; then -1 and +1 box in every periodic direction. */
static void make_images(sph_neighbors *nb)
{
  nb->images = 1;
  for (int d = 0; d < nb->def.dim; d++) {
    if (!nb->def.periodic[d]) continue;
    int before = nb->images;
    for (int sign = -1; sign <= 1; sign += 2)
      for (int k = 0; k < before; k++) {
        memcpy(nb->shift[nb->images], nb->shift[k], sizeof nb->shift[k]);
        nb->shift[nb->images++][d] = sign * nb->def.length[d];
      }
  }
}

static void list_bits(sph_bits *list)
{
  for (int k = 0; k < 256; k++)
    for (int bit = 0; bit < 8; bit++)
      if (k >> bit & 1) list->place[k][list->count[k]++] = bit;
}

static int set_search(sph_neighbors *nb, const sph_neighbors_def *def, sph_error *error)
{
  nb->own = !def->search && def->own;
  if (!nb->own) return sph_neighbors_search_make(def->search, &nb->def, &nb->search, error);
  nb->search = *def->own;
  snprintf(nb->name, sizeof nb->name, "%s", def->own->name);
  nb->search.name = nb->name;
  return SPH_OK;
}

sph_neighbors *sph_neighbors_create(const sph_neighbors_def *def, sph_error *error)
{
  if (!def) {
    sph_error_set(error, SPH_ERR_ARGUMENT, "sph_neighbors_create: no definition (NULL)");
    return NULL;
  }
  if (check(def, error)) return NULL;
  sph_neighbors *nb = SPH_NEW(sph_neighbors, 1, "the neighbour search", error);
  if (!nb) return NULL;
  nb->def = *def;
  nb->def.search = NULL;
  nb->def.own = NULL;
  nb->brute_force = def->search && !strcmp(def->search, "brute-force");
  if (def->dx == 0 || def->dx > def->reach) nb->def.dx = def->reach / (def->dx ? 1 : 3);
  if (nb->def.lanes == 0) nb->def.lanes = 1;
  if (nb->def.threads == 0) nb->def.threads = 1;
  make_images(nb);
  list_bits(&nb->bits);
  nb->scratch = SPH_NEW(sph_runs, nb->def.threads, "scratch of the neighbour search", error);
  if (nb->scratch && !set_search(nb, def, error)) return nb;
  sph_neighbors_free(nb);
  return NULL;
}

static void free_list(sph_pair_list *list)
{
  if (!list) return;
  sph_memory_free(list->first);
  sph_memory_free(list->runs.run);
  sph_memory_free(list);
}

void sph_neighbors_free(sph_neighbors *nb)
{
  if (!nb) return;
  if (nb->search.free) nb->search.free(nb->search.ctx);
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    sph_set *set = &nb->set[s];
    sph_memory_free(set->order);
    for (int d = 0; d < 3; d++) {
      sph_memory_free(set->wrap[d]);
      if (!set->lent) sph_memory_free(set->x[d]);
    }
    for (int t = 0; t < SPH_SETS_MAX; t++) free_list(nb->list[s][t]);
  }
  for (int k = 0; nb->scratch && k < nb->def.threads; k++) sph_memory_free(nb->scratch[k].run);
  sph_memory_free(nb->scratch);
  sph_memory_free(nb);
}

static int good_set(const sph_neighbors *nb, int set)
{
  return nb && set >= 0 && set < SPH_SETS_MAX && nb->set[set].sorted;
}

const int *sph_neighbors_order(const sph_neighbors *nb, int set)
{
  return good_set(nb, set) ? nb->set[set].order : NULL;
}

const double *sph_neighbors_wrap(const sph_neighbors *nb, int set, int d)
{
  return good_set(nb, set) && d >= 0 && d < 3 ? nb->set[set].wrap[d] : NULL;
}

sph_list sph_neighbors_list(const sph_neighbors *nb, int target, int source)
{
  if (!good_set(nb, target) || !good_set(nb, source) || !nb->list[target][source])
    return (sph_list){0};
  const sph_pair_list *list = nb->list[target][source];
  return (sph_list){list->blocks, list->first, list->runs.run};
}

const double (*sph_neighbors_shifts(const sph_neighbors *nb, int *count))[3]
{
  if (count) *count = nb ? nb->images : 0;
  return nb ? nb->shift : NULL;
}

static double set_bytes(const sph_set *set)
{
  double bytes = sizeof(int) * (double)set->room;
  for (int d = 0; d < 3; d++) {
    if (set->x[d] && !set->lent) bytes += sizeof(double) * (double)(set->room + SPH_LANES_MAX);
    if (set->wrap[d]) bytes += sizeof(double) * (double)set->room;
  }
  return bytes;
}

double sph_neighbors_bytes(const sph_neighbors *nb)
{
  if (!nb) return 0;
  double bytes = (double)sizeof *nb + (double)nb->def.threads * sizeof *nb->scratch;
  if (nb->search.bytes) bytes += nb->search.bytes(nb->search.ctx);
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    bytes += set_bytes(&nb->set[s]);
    for (int t = 0; t < SPH_SETS_MAX; t++) {
      const sph_pair_list *list = nb->list[s][t];
      if (!list) continue;
      bytes += (double)sizeof *list + sizeof(long) * (double)list->first_room +
               sizeof(sph_run) * (double)list->runs.room;
    }
  }
  for (int k = 0; k < nb->def.threads; k++) bytes += sizeof(sph_run) * (double)nb->scratch[k].room;
  return bytes;
}

typedef struct found {
  long index;
  double distance;
} found;

static int by_index(const void *a, const void *b)
{
  const found *x = a, *y = b;
  if (x->index != y->index) return x->index > y->index ? 1 : -1;
  return (x->distance > y->distance) - (x->distance < y->distance);
}

/* Sorted place of point i; -1: there is none. */
static long place_of(const sph_set *set, long i)
{
  for (long s = 0; s < set->n; s++)
    if (set->order[s] == i) return s;
  return -1;
}

/* Writes the sources in [begin, end) within reach of sorted place t; to NULL: only counts. */
static long collect(const sph_neighbors *nb, int target, int source, long t, int image, long begin,
                    long end, found *to)
{
  const sph_set *set = &nb->set[source];
  long n = 0;
  for (long s = begin; s < end; s++) {
    double r2 = 0;
    for (int d = 0; d < nb->def.dim; d++) {
      double r = nb->set[target].x[d][t] - nb->shift[image][d] - set->x[d][s];
      r2 += r * r;
    }
    int itself = target == source && image == 0 && s == t;
    if (itself || !(r2 < nb->def.reach * nb->def.reach)) continue;
    if (to) to[n] = (found){set->order[s], sqrt(r2)};
    n++;
  }
  return n;
}

/* All of them: from the list, or from all sources where there is none. */
static long collect_all(const sph_neighbors *nb, int target, int source, long t, found *to)
{
  const sph_list list = sph_neighbors_list(nb, target, source);
  long n = 0, b = t / nb->def.lanes;
  for (int m = 0; !list.blocks && m < nb->images; m++)
    n += collect(nb, target, source, t, m, 0, nb->set[source].n, to ? to + n : NULL);
  for (long r = list.blocks ? list.first[b] : 0; list.blocks && r < list.first[b + 1]; r++) {
    const sph_run run = list.runs[r];
    n += collect(nb, target, source, t, sph_run_image(run), sph_run_start(run),
                 sph_run_start(run) + sph_run_count(run), to ? to + n : NULL);
  }
  return n;
}

long sph_neighbors_find(const sph_neighbors *nb, int target, int source, long i, long max,
                        long *index, double *distance)
{
  if (!good_set(nb, target) || !good_set(nb, source)) return SPH_ERR_STATE;
  if (nb->set[target].lent || nb->set[source].lent) return SPH_ERR_STATE;
  long place = place_of(&nb->set[target], i);
  if (place < 0 || max < 0) return SPH_ERR_ARGUMENT;
  long n = collect_all(nb, target, source, place, NULL);
  found *all = sph_memory_take((size_t)n, sizeof *all);
  if (!all) return SPH_ERR_MEMORY;
  collect_all(nb, target, source, place, all);
  qsort(all, (size_t)n, sizeof *all, by_index);
  for (long k = 0; k < n && k < max; k++) {
    if (index) index[k] = all[k].index;
    if (distance) distance[k] = all[k].distance;
  }
  sph_memory_free(all);
  return n;
}
