/* Instances of the loop of drag, once per instruction set. */
#include "drag_loops.h"

#define DRAG(kernel, dim)                                                                     \
  BODY void body_##kernel##_##dim(int d, const void *k, const vec *i, const vec *j, vec *sum) \
  {                                                                                           \
    drag_pair(d, kernel, k, i, j, sum);                                                       \
  }                                                                                           \
  static void drag_##kernel##_##dim(const sph_pair_task *t, long b, long e)                   \
  {                                                                                           \
    sph_pair_loop(body_##kernel##_##dim, t, b, e, dim, 2 * dim + 4, SPH_DRAG_SUMS);           \
  }
#define KERNEL(kernel) DRAG(kernel, 1) DRAG(kernel, 2) DRAG(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {drag_##kernel##_1, drag_##kernel##_2, drag_##kernel##_3},
const sph_drag_table SPH_ISA_NAME(sph_drag_loops) = {{SPH_KERNEL_LIST(ROW)}};
