/* Instances of the loops of shifting, once per instruction set. */
#include "shift_loops.h"

/* The reference reads the kernel at run time: its instances are one to a compiler. */
#if SPH_LANES == 1
#define KERNEL_OF(unused, k) ((const shift_constants *)k)->kernel
#else
#define KERNEL_OF(kernel, k) kernel
#endif

#define SHIFT(pass, kernel, dim, slots, sums)                                                \
  BODY void body_##pass##_##kernel##_##dim(int d, const void *k, const vec *i, const vec *j, \
                                           vec *sum)                                         \
  {                                                                                          \
    shift_##pass(d, KERNEL_OF(kernel, k), k, i, j, sum);                                     \
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
