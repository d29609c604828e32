/* Lists target <- source: static shares of the blocks, one for each thread, put together in order. */
#include <string.h>

#include "memory.h"
#include "neighbors_data.h"

#define DECLARE(isa) extern const sph_neighbors_table sph_neighbors_loops_##isa;
SPH_ISA_BUILT(DECLARE)

static sph_neighbors_search *search_of(int lanes)
{
#define MATCH(isa) \
  if (sph_cpu_lanes(SPH_ISA_##isa) == lanes) return sph_neighbors_loops_##isa.search;
  SPH_ISA_BUILT(MATCH)
#undef MATCH
  return NULL;
}

/* The reference: all sources, in all images. */
static void search_all(const sph_neighbors *nb, const sph_set *target, const sph_set *source,
                       long begin, long end, long *first, sph_runs *out)
{
  (void)target;
  for (long b = begin; b < end; b++) {
    first[b] = out->n;
    for (int m = 0; m < nb->images; m++) sph_neighbors_runs_add(out, out->n, 0, source->n, m);
  }
}

static sph_pair_list *open_list(sph_neighbors *nb, int target, int source, long blocks,
                                sph_error *error)
{
  sph_pair_list **list = &nb->list[target][source];
  if (!*list) *list = SPH_NEW(sph_pair_list, 1, "a neighbour list", error);
  if (!*list) return NULL;
  (*list)->blocks = 0;
  if (blocks + 1 > (*list)->first_room) {
    if (sph_memory_grow((void **)&(*list)->first, 0, (size_t)(blocks + blocks / 8 + 8),
                        sizeof(long), "neighbour blocks", error))
      return NULL;
    (*list)->first_room = blocks + blocks / 8 + 8;
  }
  return *list;
}

/* Puts the threads' shares one behind the other. */
static int join(sph_neighbors *nb, sph_pair_list *list, long blocks, sph_error *error)
{
  int threads = nb->def.threads;
  long total = 0;
  for (int k = 0; k < threads; k++) total += nb->scratch[k].n;
  if (total > list->runs.room) {
    list->runs.n = 0;
    if (sph_memory_grow((void **)&list->runs.run, 0, (size_t)(total + total / 4), sizeof(sph_run),
                        "neighbour runs", error))
      return SPH_ERR_MEMORY;
    list->runs.room = total + total / 4;
  }
  long offset = 0;
  for (int k = 0; k < threads; k++) {
    const sph_runs *share = &nb->scratch[k];
    if (share->n) memcpy(list->runs.run + offset, share->run, (size_t)share->n * sizeof(sph_run));
    for (long b = blocks * k / threads; b < blocks * (k + 1) / threads; b++)
      list->first[b] += offset;
    offset += share->n;
  }
  list->first[blocks] = list->runs.n = offset;
  list->blocks = blocks;
  return SPH_OK;
}

int sph_neighbors_build(sph_neighbors *nb, int target, int source, sph_error *error)
{
  if (!sph_neighbors_order(nb, target) || !sph_neighbors_order(nb, source))
    return sph_error_set(error, SPH_ERR_STATE, "list %d <- %d: sort both sets first", target,
                         source);
  const sph_set *t = &nb->set[target], *s = &nb->set[source];
  long blocks = (t->n + nb->def.lanes - 1) / nb->def.lanes;
  sph_neighbors_search *search = nb->brute_force ? search_all : search_of(nb->def.lanes);
  if (!search)
    return sph_error_set(error, SPH_ERR_UNBUILT, "no neighbour search with %d lanes in this build",
                         nb->def.lanes);
  sph_pair_list *list = open_list(nb, target, source, blocks, error);
  if (!list) return SPH_ERR_MEMORY;
  int threads = nb->def.threads, status = SPH_OK;
#pragma omp parallel for num_threads(threads) schedule(static) if (blocks > 256)
  for (int k = 0; k < threads; k++) {
    nb->scratch[k].n = nb->scratch[k].status = 0;
    if (s->n)
      search(nb, t, s, blocks * k / threads, blocks * (k + 1) / threads, list->first,
             &nb->scratch[k]);
    else
      memset(list->first + blocks * k / threads, 0,
             (size_t)(blocks * (k + 1) / threads - blocks * k / threads) * sizeof(long));
  }
  for (int k = 0; k < threads; k++)
    if (nb->scratch[k].status) status = nb->scratch[k].status;
  if (status) return sph_error_set(error, status, "out of memory: neighbour runs");
  return join(nb, list, blocks, error);
}
