/* bench_flow.h -- the flows that right-hand sides are measured on. */
#ifndef BENCH_FLOW_H
#define BENCH_FLOW_H
#include <sphode.h>

typedef struct bench_flow {
  const char *name, *kernel;
  int dim;
  long across; /* particles along a side */
  int thermal;
  const char *delta;     /* NULL: none */
  double support;        /* [dx] */
  const char *precision; /* NULL: double */
} bench_flow;

/* A jittered, unaligned, periodic lattice with a smooth flow: nothing is aligned with the cells of
 * the search. */
sph_sim *bench_flow_make(const bench_flow *flow, double skin, int threads);

/* The dam break of SPHERIC's test 2. */
typedef struct bench_dam_def {
  int n; /* spacings in the height of the column */
  double h_over_dx;
  const char *delta, *method;
  double jitter; /* of the water at the start [dx] */
  int threads;   /* 0: 1 */
} bench_dam_def;
sph_sim *bench_flow_dam(const bench_dam_def *def);

#endif
