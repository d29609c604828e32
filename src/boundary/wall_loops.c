/* Instances of the wall <- fluid loop, once per instruction set. */
#include "wall_loops.h"

#define WALL(kernel, dim, thermal)                                                              \
  BODY void body_##kernel##_##dim##_##thermal(int d, const void *k, const vec *i, const vec *j, \
                                              vec *sum)                                         \
  {                                                                                             \
    wall_pair(d, kernel, thermal, k, i, j, sum);                                                \
  }                                                                                             \
  static void wall_##kernel##_##dim##_##thermal(const sph_pair_task *t, long b, long e)         \
  {                                                                                             \
    sph_pair_loop(body_##kernel##_##dim##_##thermal, t, b, e, dim, 3 * dim + 7, SPH_WALL_SUMS); \
  }
#define WALLS(kernel, dim) WALL(kernel, dim, 0) WALL(kernel, dim, 1)
#define KERNEL(kernel) WALLS(kernel, 1) WALLS(kernel, 2) WALLS(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define PAIR(kernel, dim)                                \
  {                                                      \
    wall_##kernel##_##dim##_0, wall_##kernel##_##dim##_1 \
  }
#define ROW(kernel) [kernel] = {PAIR(kernel, 1), PAIR(kernel, 2), PAIR(kernel, 3)},
const sph_wall_table SPH_ISA_NAME(sph_wall_loops) = {{SPH_KERNEL_LIST(ROW)}};
