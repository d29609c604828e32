/* Lists target <- source: a share of the blocks for each thread, put together in order. */
#include <string.h>

#include "memory.h"
#include "neighbors_data.h"

enum { PARALLEL_MIN = 256 }; /* blocks */

#define DECLARE(isa, loops) extern const sph_neighbors_table sph_neighbors_loops_##loops;
SPH_ISA_BUILT_LISTS(DECLARE)

/* The fastest instance of that many lanes that this processor runs; else the reference, which
 * takes any number. */
static sph_neighbors_lister *lister_of(int lanes)
{
  sph_neighbors_lister *list = sph_neighbors_loops_reference.list;
#define MATCH(isa, loops)                                      \
  if (sph_cpu_lanes(SPH_ISA_##isa) == lanes &&                 \
      sph_cpu_isa(sph_cpu_isa_name(SPH_ISA_##isa), NULL) >= 0) \
    list = sph_neighbors_loops_##loops.list;
  SPH_ISA_BUILT_LISTS(MATCH)
#undef MATCH
  return list;
}

/* The reference: all sources, in all images. */
static void list_all(const sph_neighbors *nb, int target, int source, long begin, long end,
                     long *first, sph_runs *out)
{
  (void)target;
  for (long b = begin; b < end; b++) {
    first[b] = out->n;
    for (int m = 0; m < nb->images; m++) sph_neighbors_runs_add(out, 0, nb->set[source].n, m);
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

/* The share of thread k > 0 behind those of the threads before. */
static void put(const sph_neighbors *nb, sph_pair_list *list, long blocks, int k)
{
  const sph_runs *share = &nb->scratch[k];
  long begin = list->runs.n;
  for (int before = 1; before < k; before++) begin += nb->scratch[before].n;
  for (long b = blocks * k / nb->def.threads; b < blocks * (k + 1) / nb->def.threads; b++)
    list->first[b] += begin;
  if (share->n) memcpy(list->runs.run + begin, share->run, (size_t)share->n * sizeof(sph_run));
}

/* Puts the shares of threads 1, 2, ... behind that of thread 0, which is in the list already. */
static int join(sph_neighbors *nb, sph_pair_list *list, long blocks, sph_error *error)
{
  int threads = nb->def.threads, status = list->runs.status;
  long more = 0;
  for (int k = 1; k < threads; k++) {
    more += nb->scratch[k].n;
    if (nb->scratch[k].status) status = nb->scratch[k].status;
  }
  if (!status) status = sph_neighbors_runs_reserve(&list->runs, more);
  if (status == SPH_ERR_ARGUMENT)
    return sph_error_set(error, status,
                         "search %s: found stretches that are not 0 .. %d, rising, apart",
                         nb->search.name, SPH_STRETCHES);
  if (status) return sph_error_set(error, status, "out of memory: neighbour runs");
#pragma omp parallel for num_threads(threads) schedule(static) if (blocks > PARALLEL_MIN)
  for (int k = 1; k < threads; k++) put(nb, list, blocks, k);
  list->runs.n += more;
  list->first[blocks] = list->runs.n;
  list->blocks = blocks;
  return SPH_OK;
}

int sph_neighbors_build(sph_neighbors *nb, int target, int source, sph_error *error)
{
  if (!sph_neighbors_order(nb, target) || !sph_neighbors_order(nb, source))
    return sph_error_set(error, SPH_ERR_STATE, "list %d <- %d: sort both sets first", target,
                         source);
  long blocks = (nb->set[target].n + nb->def.lanes - 1) / nb->def.lanes;
  sph_neighbors_lister *lister = nb->brute_force ? list_all : lister_of(nb->def.lanes);
  sph_pair_list *list = open_list(nb, target, source, blocks, error);
  if (!list) return SPH_ERR_MEMORY;
  int threads = nb->def.threads;
#pragma omp parallel for num_threads(threads) schedule(static) if (blocks > PARALLEL_MIN)
  for (int k = 0; k < threads; k++) {
    sph_runs *share = k == 0 ? &list->runs : &nb->scratch[k];
    share->n = share->status = 0;
    lister(nb, target, source, blocks * k / threads, blocks * (k + 1) / threads, list->first,
           share);
  }
  return join(nb, list, blocks, error);
}
