#include "memory.h"
#include "neighbors_data.h"

enum { LONGEST = (1 << 24) - 1 };

void sph_neighbors_runs_add(sph_runs *runs, long first, long start, long count, int image)
{
  if (runs->n > first) {
    sph_run *last = &runs->run[runs->n - 1];
    if ((int)last->image == image && last->start + (long)last->count == start &&
        last->count + count <= LONGEST) {
      last->count = (unsigned)(last->count + count) & LONGEST;
      return;
    }
  }
  while (count > 0) {
    if (runs->n == runs->room) {
      long room = 2 * runs->room + 1024;
      if (sph_memory_grow((void **)&runs->run, (size_t)runs->n, (size_t)room, sizeof *runs->run,
                          "neighbour runs", NULL)) {
        runs->status = SPH_ERR_MEMORY;
        return;
      }
      runs->room = room;
    }
    long part = count < LONGEST ? count : LONGEST;
    runs->run[runs->n++] = (sph_run){(int)start, (unsigned)part & LONGEST, (unsigned)image & 255u};
    start += part;
    count -= part;
  }
}
