/* sphode/neighbors.h -- who is near whom.
 *
 * Sets of points are sorted so that those near each other stand near each other; the neighbours of
 * a target set in a source set are, per block of `lanes` consecutive sorted targets, a list of
 * runs: consecutive places in the sorted order of the source.  A list is a superset: every pair
 * closer than `reach` is in it, and others may be (kernels vanish there, so they add zero).
 *
 * How points are sorted and found again is a struct of two functions (sph_search): a grid, a hash
 * or a tree (docs/neighbors.md says which pays where), or one of your own.  What they find is
 * tested point by point, so that all of them list the same pairs, each in its own order. */
#ifndef SPHODE_NEIGHBORS_H
#define SPHODE_NEIGHBORS_H
#include <stdint.h>

#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_neighbors sph_neighbors;

typedef struct sph_neighbors_def {
  int dim;      /* 1, 2, 3 */
  double reach; /* every pair with r < reach is found [m], > 0 */
  double dx;    /* particle spacing, sets the cell sizes [m]; 0: reach / 3 */
  int lanes;    /* targets in a block: 1, 2, 4 or 8; 0: 1 */
  int threads;  /* 0: 1; the lists do not depend on it */
  /* "grid" (NULL: own's, or without one this), "hash", "tree", or "brute-force", the reference: in
   * the order of "grid", all sources for all targets */
  const char *search;
  const struct sph_search *own; /* instead: a search of your own, copied; NULL: none */
  int periodic[3];              /* direction is periodic */
  double origin[3];             /* lower corner of the periodic box [m] */
  double length[3];             /* its lengths [m], at least 2 reach where periodic */
} sph_neighbors_def;

/* Runs of one block: targets first[b] .. first[b + 1] - 1 index runs[].  Six bytes: of all that
 * pairs need, lists are the most.  What is longer than a run can tell is several. */
typedef struct sph_run {
  uint16_t low, high;       /* of the first source, in the sorted order of the source set */
  uint16_t count_and_image; /* 11 bits, 5 bits */
} sph_run;

/* The first source; how many consecutive ones, at least 1; the index of the periodic shift to
 * subtract from the target's position. */
static inline long sph_run_start(sph_run run) { return (long)(run.low | (uint32_t)run.high << 16); }
static inline long sph_run_count(sph_run run) { return run.count_and_image & 2047; }
static inline int sph_run_image(sph_run run) { return run.count_and_image >> 11; }

typedef struct sph_list {
  long blocks;         /* ceil(n_target / lanes) */
  const long *first;   /* [blocks + 1] */
  const sph_run *runs; /* [first[blocks]] */
} sph_list;

enum { SPH_SETS_MAX = 64 };

/* Points to be sorted, valid during the call. */
typedef struct sph_points {
  long n;
  const double *x[3];  /* [n], not sorted, inside the box in periodic directions [m]; d < dim */
  double lo[3], hi[3]; /* the least box around them [m]; n == 0: zero */
} sph_points;

/* Places begin .. end - 1 of a sorted order. */
typedef struct sph_stretch {
  int begin, end;
} sph_stretch;

/* A search: the built-in ones and your own use the same struct. */
typedef struct sph_search {
  const char *name; /* for messages; copied */
  /* Finds an order of the points of a set, order[s] = the point in place s, a permutation of
   * 0 .. n - 1 that follows from the points alone (where they coincide: by their index), and
   * remembers in ctx what `near` needs.  Returns 0 or a status that it has put into error. */
  int (*sort)(void *ctx, int set, const sph_points *points, int *order, sph_error *error);
  /* Where in the sorted order of the set the points within `reach` of the box lo .. hi stand:
   * stretches rising, not empty, apart, at most max >= 8, with every such point in one of them;
   * others may be, too, at a price.  Returns how many.  Called by several threads at once. */
  int (*near)(const void *ctx, int set, const double *lo, const double *hi, double reach, int max,
              sph_stretch *stretch);
  double (*bytes)(const void *ctx); /* that ctx holds; NULL: not known */
  /* Called once with ctx, at the end of what was made with it; where that failed, ctx is still
   * yours.  NULL: it is yours anyhow. */
  void (*free)(void *ctx);
  void *ctx;
} sph_search;

/* Adds begin .. end - 1, behind all of stretch[*n], for `near`: joined with the last one where it
 * goes on there, and where there is no room for another. */
static inline void sph_stretch_add(sph_stretch *stretch, int *n, int max, int begin, int end)
{
  if (begin >= end) return;
  if (*n > 0 && (*n >= max || stretch[*n - 1].end == begin))
    stretch[*n - 1].end = end;
  else {
    stretch[*n].begin = begin;
    stretch[(*n)++].end = end;
  }
}

/* Name of search k = 0, 1, ...; NULL behind the last.  One line about it; NULL: unknown. */
SPH_API const char *sph_neighbors_search_name(int k);
SPH_API const char *sph_neighbors_search_about(const char *name);

SPH_API sph_neighbors *sph_neighbors_create(const sph_neighbors_def *def, sph_error *error);
SPH_API void sph_neighbors_free(sph_neighbors *neighbors);

/* Sorts set number `set` (0 .. SPH_SETS_MAX - 1) of n points x[d][n], d < dim [m].  Reads x only
 * during the call.  Points may lie anywhere (periodic directions are wrapped inside); not finite:
 * SPH_RETRY.  Ends all lists of the set. */
SPH_API int sph_neighbors_sort(sph_neighbors *neighbors, int set, long n, const double *const x[],
                               sph_error *error);
/* Makes the list target <- source of two sorted sets (may be the same one). */
SPH_API int sph_neighbors_build(sph_neighbors *neighbors, int target, int source, sph_error *error);

/* The sorted order of a set: order[s] = index of the point in sorted place s, [n]. */
SPH_API const int *sph_neighbors_order(const sph_neighbors *neighbors, int set);
/* Multiples of length[d] that wrapping subtracts from coordinate d of point i (not sorted):
 * wrap[i]; NULL where direction d is not periodic. */
SPH_API const double *sph_neighbors_wrap(const sph_neighbors *neighbors, int set, int d);
/* The list; blocks == 0 where none was built.  Valid until the next sort or build of these sets. */
SPH_API sph_list sph_neighbors_list(const sph_neighbors *neighbors, int target, int source);
/* Shifts of the images: [count][3] [m]; image 0 is no shift. */
SPH_API const double (*sph_neighbors_shifts(const sph_neighbors *neighbors, int *count))[3];
/* Bytes held. */
SPH_API double sph_neighbors_bytes(const sph_neighbors *neighbors);

/* For people: the sources closer than reach to target point i (its index as given to sort), in
 * rising order, without i itself where target == source and image 0.  Fills at most max indices and
 * distances (NULL: not wanted); returns how many there are, < 0: a status. */
SPH_API long sph_neighbors_find(const sph_neighbors *neighbors, int target, int source, long i,
                                long max, long *index, double *distance);

#ifdef __cplusplus
}
#endif
#endif
