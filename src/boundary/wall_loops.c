/* Instances of the wall <- fluid loop, once per instruction set.  Walls that turn are rare: theirs
 * read the kernel at run time, as all of the reference do. */
#include "wall_loops.h"

#include "single_loop.h"

#define WALL(name, kernel, dim, turns, thermal)                                             \
  BODY void name##_body(int d, const void *constants, const vec *i, const vec *j, vec *sum) \
  {                                                                                         \
    const fluid_constants *k = constants;                                                   \
    wall_pair(d, kernel, thermal, turns, k, i, j, sum);                                     \
  }                                                                                         \
  static void name(const sph_pair_task *t, long b, long e)                                  \
  {                                                                                         \
    fluid_task_single own;                                                                  \
    sph_pair_loop(name##_body, fluid_task(t, &own), b, e, dim, 3 * dim + 7,                 \
                  thermal ? SPH_WALL_SUMS : SPH_WALL_SUMS_COLD);                            \
  }

#define ANY_KERNEL(name, dim, turns)               \
  WALL(name##_##dim##_0, k->kernel, dim, turns, 0) \
  WALL(name##_##dim##_1, k->kernel, dim, turns, 1)
ANY_KERNEL(wall_turning, 1, 1)
ANY_KERNEL(wall_turning, 2, 1)
ANY_KERNEL(wall_turning, 3, 1)

#if SPH_LANES == 1
ANY_KERNEL(wall, 1, 0)
ANY_KERNEL(wall, 2, 0)
ANY_KERNEL(wall, 3, 0)
#define NAME(kernel, dim, thermal) wall_##dim##_##thermal
#else
#define RESTING(kernel, dim)                         \
  WALL(wall_##kernel##_##dim##_0, kernel, dim, 0, 0) \
  WALL(wall_##kernel##_##dim##_1, kernel, dim, 0, 1)
#define KERNEL(kernel) RESTING(kernel, 1) RESTING(kernel, 2) RESTING(kernel, 3)
SPH_KERNEL_LIST(KERNEL)
#define NAME(kernel, dim, thermal) wall_##kernel##_##dim##_##thermal
#endif

#define NAMES(kernel, dim)                                \
  {                                                       \
    {NAME(kernel, dim, 0), NAME(kernel, dim, 1)},         \
        {wall_turning_##dim##_0, wall_turning_##dim##_1}, \
  }
#define ROW(kernel) [kernel] = {NAMES(kernel, 1), NAMES(kernel, 2), NAMES(kernel, 3)},
const sph_wall_table SPH_ISA_NAME(sph_wall_loops) = {{SPH_KERNEL_LIST(ROW)}};
