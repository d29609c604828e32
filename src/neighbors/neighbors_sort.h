/* neighbors_sort.h -- sorted positions in memory of the caller's.  Internal. */
#ifndef SPH_NEIGHBORS_SORT_H
#define SPH_NEIGHBORS_SORT_H
#include "sphode/neighbors.h"

enum { SPH_LANES_MAX = 8 };

/* The sorted positions of the set go into x[d], d < dim, [n + SPH_LANES_MAX] each, for the largest
 * n that will be sorted: only sorting and building read them, so that in between the arrays are the
 * caller's.  sph_neighbors_find does without this set. */
void sph_neighbors_sort_lend(sph_neighbors *nb, int set, double *const x[]);

#endif
