/* Instances of the loop with tiles, once per instruction set. */
#include "tile_loops.h"

#define TILE(kernel, dim)                                                   \
  static void tile_##kernel##_##dim(const sph_pair_task *t, long b, long e) \
  {                                                                         \
    tile_loop(dim, kernel, t, b, e);                                        \
  }
#define KERNEL(kernel) TILE(kernel, 1) TILE(kernel, 2) TILE(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {tile_##kernel##_1, tile_##kernel##_2, tile_##kernel##_3},
const sph_tile_table SPH_ISA_NAME(sph_tile_loops) = {{SPH_KERNEL_LIST(ROW)}};
