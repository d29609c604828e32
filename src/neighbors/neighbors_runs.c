#include "memory.h"
#include "neighbors_data.h"

int sph_neighbors_runs_reserve(sph_runs *runs, long more)
{
  if (runs->n + more <= runs->room) return runs->status;
  long room = 2 * runs->room + more + 1024;
  if (!runs->status)
    runs->status = sph_memory_grow((void **)&runs->run, (size_t)runs->n, (size_t)room,
                                   sizeof *runs->run, "neighbour runs", NULL);
  if (!runs->status) runs->room = room;
  return runs->status;
}

void sph_neighbors_runs_add(sph_runs *runs, long start, long count, int image)
{
  while (count > 0 && !sph_neighbors_runs_reserve(runs, 1)) {
    const long part = count < SPH_RUN_LONGEST ? count : SPH_RUN_LONGEST;
    runs->run[runs->n++] = sph_neighbors_run(start, part, image);
    start += part;
    count -= part;
  }
}
