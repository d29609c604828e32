/* count_pair.h -- how many pairs lie inside the support, and whether any is too close: knows
 * positions only. */
#ifndef SPH_COUNT_PAIR_H
#define SPH_COUNT_PAIR_H
#include "cpu.h"
#include "sphode/pair_loop.h"

typedef struct count_constants {
  double H2;    /* support radius squared [m^2] */
  double near2; /* a squared distance under this one is too close [m^2] */
} count_constants;

/* Sums of a target: sources inside the support without itself; > 0 where one is nearer than
 * allowed; at distance zero (one, itself, in its own group). */
enum { SPH_COUNT_PAIRS, SPH_COUNT_NEAR, SPH_COUNT_ZERO, SPH_COUNT_SUMS };

typedef struct sph_count_table {
  sph_pair_function *loop[3]; /* [dim - 1] */
} sph_count_table;

sph_pair_function *sph_count_loop(int isa, int dim);

BODY void count_pair(int dim, const void *constants, const vec *i, const vec *j, vec *sum)
{
  const count_constants *k = constants;
  vec r2 = v_set(0);
  for (int d = 0; d < dim; d++) r2 += (i[d] - j[d]) * (i[d] - j[d]);
  vec one = v_set(1), apart = v_and((vec_mask)(r2 > 0), one);
  sum[SPH_COUNT_PAIRS] += v_and((vec_mask)(r2 < k->H2), apart);
  sum[SPH_COUNT_NEAR] = v_max(sum[SPH_COUNT_NEAR], (k->near2 - r2) * apart);
  sum[SPH_COUNT_ZERO] += one - apart;
}

#endif
