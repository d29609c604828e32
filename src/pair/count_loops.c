/* Instances of the counting loop, once per instruction set. */
#include "count_pair.h"

#define COUNT(dim)                                                \
  static void count_##dim(const sph_pair_task *t, long b, long e) \
  {                                                               \
    sph_pair_loop(count_pair, t, b, e, dim, dim, SPH_COUNT_SUMS); \
  }
COUNT(1)
COUNT(2)
COUNT(3)

const sph_count_table SPH_ISA_NAME(sph_count_loops) = {{count_1, count_2, count_3}};
