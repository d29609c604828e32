/* neighbors_data.h -- what a neighbour search holds.  Internal: files of neighbors/ share it.
 *
 * Sorted axes: the last coordinate is cut into fine cells, the others into columns; cell numbers
 * run fastest along the fine axis, so that a stretch of a column is one stretch of the sorted
 * order. */
#ifndef SPH_NEIGHBORS_DATA_H
#define SPH_NEIGHBORS_DATA_H
#include <math.h>

#include "cpu.h"
#include "sphode/neighbors.h"

enum { SPH_LANES_MAX = 8, SPH_IMAGES_MAX = 27 };

typedef struct sph_grid {
  long cells[3];          /* per direction; 1 for d >= dim */
  double origin[3];       /* lower corner [m] */
  double size[3];         /* of a cell [m] */
  double inverse[3];      /* 1/size [1/m] */
  double rounding[3];     /* points may lie this far outside of their cell [m] */
  double cut[3], skip[3]; /* cut .. cut + skip, between two heaps of points, takes no cells [m] */
  double lo[3], hi[3];    /* where the points really are: some may lie outside of the cells */
} sph_grid;

typedef struct sph_set {
  int sorted;
  long n, room;    /* points; room for */
  int *order;      /* [room] */
  int *cell;       /* [room] of point i, not sorted */
  double *wrap[3]; /* [room] not sorted; NULL unless periodic */
  double *x[3];    /* [room + SPH_LANES_MAX] sorted, wrapped; loads go beyond n */
  sph_grid grid;
  int *start; /* [cells + 1] first sorted place of each cell */
  long start_room;
} sph_set;

typedef struct sph_runs {
  sph_run *run;
  long n, room;
  int status; /* SPH_ERR_MEMORY: a run did not fit */
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
  sph_neighbors_def def;
  int brute_force, images;
  double shift[SPH_IMAGES_MAX][3];
  sph_set set[SPH_SETS_MAX];
  sph_pair_list *list[SPH_SETS_MAX][SPH_SETS_MAX]; /* [target][source]; NULL: never built */
  sph_runs *scratch;                               /* [threads]; thread 0 writes into the list */
};

/* Finds the runs of blocks [begin, end): first[b] counts from the start of out. */
typedef void sph_neighbors_search(const sph_neighbors *nb, const sph_set *target,
                                  const sph_set *source, long begin, long end, long *first,
                                  sph_runs *out);
typedef struct sph_neighbors_table {
  sph_neighbors_search *search;
} sph_neighbors_table;

/* Cell of coordinate x of direction d, clamped into the grid: monotone, so that no pair is lost. */
static inline long sph_grid_cell(const sph_grid *grid, int d, double x)
{
  if (x > grid->cut[d]) x = fmax(x - grid->skip[d], grid->cut[d]);
  double k = (x - grid->origin[d]) * grid->inverse[d];
  if (!(k > 0)) return 0;
  return k < (double)grid->cells[d] ? (long)k : grid->cells[d] - 1;
}

/* Makes room for more runs; once it failed, runs->status stays. */
int sph_neighbors_runs_reserve(sph_runs *runs, long more);
/* Appends sources start .. start + count - 1: one run, or several where it is too long for one. */
void sph_neighbors_runs_add(sph_runs *runs, long start, long count, int image);

#endif
