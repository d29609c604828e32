/* sim_overlap.h -- how near the particles of one group are to those of another, as they are. */
#ifndef SPH_SIM_OVERLAP_H
#define SPH_SIM_OVERLAP_H
#include "sim_data.h"

typedef struct sph_overlap {
  long n;       /* particles of the target nearer than `near` to one of the source */
  double least; /* the smallest distance [m]; INFINITY: none within reach */
  double x[3];  /* of the first of the n; without them, of the nearest [m] */
} sph_overlap;

/* All groups, sorted, for sph_neighbors_free; NULL: no memory, or a place that is not finite. */
sph_neighbors *sph_sim_overlap_search(const sph_sim *sim, double reach);
/* Group `target` against group `source`; they may be the same, each particle but itself. */
sph_overlap sph_sim_overlap_find(const sph_sim *sim, sph_neighbors *search, int target, int source,
                                 double near);

/* Puts "(0.14 0 -0.01) m" into text and returns it. */
const char *sph_sim_overlap_place(const sph_sim *sim, const double x[3], char *text, size_t size);

#endif
