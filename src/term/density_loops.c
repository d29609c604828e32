/* Instances of the density loop, once per instruction set. */
#include "density_loops.h"

#define DENSITY(kernel, dim)                                                                  \
  BODY void body_##kernel##_##dim(int d, const void *k, const vec *i, const vec *j, vec *sum) \
  {                                                                                           \
    density_pair(d, kernel, k, i, j, sum);                                                    \
  }                                                                                           \
  static void density_##kernel##_##dim(const sph_pair_task *t, long b, long e)                \
  {                                                                                           \
    sph_pair_loop(body_##kernel##_##dim, t, b, e, dim, 2 * dim + 4, SPH_DENSITY_SUMS);        \
  }
#define KERNEL(kernel) DENSITY(kernel, 1) DENSITY(kernel, 2) DENSITY(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {density_##kernel##_1, density_##kernel##_2, density_##kernel##_3},
const sph_density_table SPH_ISA_NAME(sph_density_loops) = {{SPH_KERNEL_LIST(ROW)}};
