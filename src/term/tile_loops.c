/* Instances of the loop with tiles, once per instruction set; those of matrices for any kernel. */
#include "tile_loops.h"
#include "tile_matrix.h"

#define MATRIX(dim)                                                  \
  static void matrix_##dim(const sph_matrix_task *t, long b, long e) \
  {                                                                  \
    const tile_constants *k = t->pairs->constants;                   \
    tile_matrix_blocks(dim, k->fluid.kernel, t, b, e);               \
  }
MATRIX(1)
MATRIX(2)
MATRIX(3)

#define TILE(kernel, dim)                                                   \
  static void tile_##kernel##_##dim(const sph_pair_task *t, long b, long e) \
  {                                                                         \
    tile_blocks(dim, kernel, t, b, e);                                      \
  }
#define KERNEL(kernel) TILE(kernel, 1) TILE(kernel, 2) TILE(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {tile_##kernel##_1, tile_##kernel##_2, tile_##kernel##_3},
const sph_tile_table SPH_ISA_NAME(sph_tile_loops) = {{SPH_KERNEL_LIST(ROW)},
                                                     {matrix_1, matrix_2, matrix_3}};
