/* Instances of the loop of a density reset, once per instruction set. */
#include "reset_loops.h"

#define RESET(kernel, dim)                                                                    \
  BODY void body_##kernel##_##dim(int d, const void *k, const vec *i, const vec *j, vec *sum) \
  {                                                                                           \
    reset_pair(d, kernel, k, i, j, sum);                                                      \
  }                                                                                           \
  static void reset_##kernel##_##dim(const sph_pair_task *t, long b, long e)                  \
  {                                                                                           \
    sph_pair_loop(body_##kernel##_##dim, t, b, e, dim, 2 * dim + 4, reset_sums(dim));         \
  }
#define KERNEL(kernel) RESET(kernel, 1) RESET(kernel, 2) RESET(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {reset_##kernel##_1, reset_##kernel##_2, reset_##kernel##_3},
const sph_reset_table SPH_ISA_NAME(sph_reset_loops) = {{SPH_KERNEL_LIST(ROW)}};
