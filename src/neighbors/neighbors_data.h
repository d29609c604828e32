/* neighbors_data.h -- what a neighbour search holds.  Internal: files of neighbors/ share it. */
#ifndef SPH_NEIGHBORS_DATA_H
#define SPH_NEIGHBORS_DATA_H
#include <math.h>

#include "cpu.h"
#include "neighbors_sort.h"

enum {
  SPH_IMAGES_MAX = 27,
  SPH_RUN_LONGEST = (1 << 11) - 1,
  SPH_STRETCHES = 512 /* that are asked for at once */
};

typedef struct sph_set {
  int sorted, lent;    /* lent: x is the caller's (neighbors_sort.h) */
  long n, room;        /* points; room for */
  int *order;          /* [room] */
  double *wrap[3];     /* [room] not sorted; NULL unless periodic */
  double *x[3];        /* [room + SPH_LANES_MAX] sorted, wrapped; loads go beyond n */
  double lo[3], hi[3]; /* the least box around them */
} sph_set;

typedef struct sph_runs {
  sph_run *run;
  long n, room;
  int status; /* SPH_ERR_MEMORY: a run did not fit; _ARGUMENT: stretches of a user's search */
} sph_runs;

typedef struct sph_pair_list {
  long blocks, first_room;
  long *first;
  sph_runs runs;
} sph_pair_list;

/* Of each number below 256: which bits are set, from the lowest on, and how many. */
typedef struct sph_bits {
  int place[256][8], count[256];
} sph_bits;

struct sph_neighbors {
  sph_bits bits;
  sph_neighbors_def def; /* without pointers */
  sph_search search;
  char name[40];                /* of the user's own */
  int own, brute_force, images; /* own: the search is the user's */
  double shift[SPH_IMAGES_MAX][3];
  sph_set set[SPH_SETS_MAX];
  sph_pair_list *list[SPH_SETS_MAX][SPH_SETS_MAX]; /* [target][source]; NULL: never built */
  sph_runs *scratch;                               /* [threads]; thread 0 writes into the list */
};

/* Finds the runs of blocks [begin, end): first[b] counts from the start of out. */
typedef void sph_neighbors_lister(const sph_neighbors *nb, int target, int source, long begin,
                                  long end, long *first, sph_runs *out);
typedef struct sph_neighbors_table {
  sph_neighbors_lister *list;
} sph_neighbors_table;

static inline sph_run sph_neighbors_run(long start, long count, int image)
{
  return (sph_run){(uint16_t)start, (uint16_t)(start >> 16), (uint16_t)(count | image << 11)};
}
/* Makes room for more runs; once it failed, runs->status stays. */
int sph_neighbors_runs_reserve(sph_runs *runs, long more);
/* Appends sources start .. start + count - 1: one run, or several where it is too long for one. */
void sph_neighbors_runs_add(sph_runs *runs, long start, long count, int image);

#endif
