/* Instances of the loop with tiles, once per instruction set. */
#include "tile_loops.h"
#include "tile_matrix.h"

#define TILE(kernel, dim)                                                   \
  static void tile_##kernel##_##dim(const sph_pair_task *t, long b, long e) \
  {                                                                         \
    tile_loop(dim, kernel, t, b, e);                                        \
  }
#define MATRIX(kernel, dim)                                                     \
  static void matrix_##kernel##_##dim(const sph_matrix_task *t, long b, long e) \
  {                                                                             \
    tile_matrix_blocks(dim, kernel, t, b, e);                                   \
  }
#define TILES(kernel, dim) TILE(kernel, dim) MATRIX(kernel, dim)
#define KERNEL(kernel) TILES(kernel, 1) TILES(kernel, 2) TILES(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {tile_##kernel##_1, tile_##kernel##_2, tile_##kernel##_3},
#define MATRIX_ROW(kernel) \
  [kernel] = {matrix_##kernel##_1, matrix_##kernel##_2, matrix_##kernel##_3},
const sph_tile_table SPH_ISA_NAME(sph_tile_loops) = {{SPH_KERNEL_LIST(ROW)},
                                                     {SPH_KERNEL_LIST(MATRIX_ROW)}};
