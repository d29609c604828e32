/* bench_flow.h -- the flows that right-hand sides are measured on. */
#ifndef BENCH_FLOW_H
#define BENCH_FLOW_H
#include <sphode.h>

typedef struct bench_flow {
  const char *name, *kernel;
  int dim;
  long across; /* particles along a side */
  int thermal;
  const char *delta; /* NULL: none */
  double support;    /* [dx] */
} bench_flow;

/* A jittered, unaligned, periodic lattice with a smooth flow: nothing is aligned with the cells of
 * the search. */
sph_sim *bench_flow_make(const bench_flow *flow, double skin, int threads);

/* The dam break of SPHERIC's test 2, n spacings in the height of its column, jittered by that many
 * spacings. */
sph_sim *bench_flow_dam(int n, const char *delta, const char *method, double jitter, int threads);

#endif
