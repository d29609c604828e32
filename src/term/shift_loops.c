/* Instances of the loops of shifting, once per instruction set. */
#include "shift_loops.h"

#define SHIFT(pass, kernel, dim, slots, sums)                                                \
  BODY void body_##pass##_##kernel##_##dim(int d, const void *k, const vec *i, const vec *j, \
                                           vec *sum)                                         \
  {                                                                                          \
    shift_##pass(d, kernel, k, i, j, sum);                                                   \
  }                                                                                          \
  static void pass##_##kernel##_##dim(const sph_pair_task *t, long b, long e)                \
  {                                                                                          \
    sph_pair_loop(body_##pass##_##kernel##_##dim, t, b, e, dim, slots, sums);                \
  }
#define KERNEL(kernel)               \
  SPH_SHIFT_PASSES(SHIFT, kernel, 1) \
  SPH_SHIFT_PASSES(SHIFT, kernel, 2) \
  SPH_SHIFT_PASSES(SHIFT, kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define NAME(pass, kernel, dim, slots, sums) pass##_##kernel##_##dim,
#define ROW(kernel)                                \
  [kernel] = {{SPH_SHIFT_PASSES(NAME, kernel, 1)}, \
              {SPH_SHIFT_PASSES(NAME, kernel, 2)}, \
              {SPH_SHIFT_PASSES(NAME, kernel, 3)}},
const sph_shift_table SPH_ISA_NAME(sph_shift_loops) = {{SPH_KERNEL_LIST(ROW)}};
