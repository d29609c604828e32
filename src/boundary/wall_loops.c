/* Instances of the wall <- fluid loop, once per instruction set. */
#include "wall_loops.h"

#define WALL(kernel, dim, thermal, turns, name)                                              \
  BODY void body_##kernel##_##dim##_##name(int d, const void *k, const vec *i, const vec *j, \
                                           vec *sum)                                         \
  {                                                                                          \
    wall_pair(d, kernel, thermal, turns, k, i, j, sum);                                      \
  }                                                                                          \
  static void wall_##kernel##_##dim##_##name(const sph_pair_task *t, long b, long e)         \
  {                                                                                          \
    sph_pair_loop(body_##kernel##_##dim##_##name, t, b, e, dim, 3 * dim + 7, SPH_WALL_SUMS); \
  }
#define WALLS(kernel, dim)         \
  WALL(kernel, dim, 0, 0, 0)       \
  WALL(kernel, dim, 1, 0, 1)       \
  WALL(kernel, dim, 0, 1, 0_turns) \
  WALL(kernel, dim, 1, 1, 1_turns)
#define KERNEL(kernel) WALLS(kernel, 1) WALLS(kernel, 2) WALLS(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define PAIRS(kernel, dim)                                                  \
  {                                                                         \
    {wall_##kernel##_##dim##_0, wall_##kernel##_##dim##_1},                 \
        {wall_##kernel##_##dim##_0_turns, wall_##kernel##_##dim##_1_turns}, \
  }
#define ROW(kernel) [kernel] = {PAIRS(kernel, 1), PAIRS(kernel, 2), PAIRS(kernel, 3)},
const sph_wall_table SPH_ISA_NAME(sph_wall_loops) = {{SPH_KERNEL_LIST(ROW)}};
