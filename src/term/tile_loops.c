/* Instances of the loop with tiles, once per instruction set; those of matrices for any kernel. */
#include "tile_loops.h"
#include "tile_matrix.h"

#define DIM(dim)                                                                                  \
  static __attribute__((noinline)) void blocks_##dim(tile_kernel *kernel, const sph_pair_task *t, \
                                                     long b, long e)                              \
  {                                                                                               \
    tile_blocks(dim, kernel, t, b, e);                                                            \
  }                                                                                               \
  static void F_any_##dim(const tile_constants *k, tile_rows *rows, int n)                        \
  {                                                                                               \
    tile_F(dim, k->fluid.kernel, k, rows, n);                                                     \
  }                                                                                               \
  static void matrix_##dim(const sph_matrix_task *t, long b, long e)                              \
  {                                                                                               \
    tile_matrix_blocks(dim, F_any_##dim, t, b, e);                                                \
  }
DIM(1)
DIM(2)
DIM(3)

#define TILE(kernel, dim)                                                         \
  static void F_##kernel##_##dim(const tile_constants *k, tile_rows *rows, int n) \
  {                                                                               \
    tile_F(dim, kernel, k, rows, n);                                              \
  }                                                                               \
  static void tile_##kernel##_##dim(const sph_pair_task *t, long b, long e)       \
  {                                                                               \
    blocks_##dim(F_##kernel##_##dim, t, b, e);                                    \
  }
#define KERNEL(kernel) TILE(kernel, 1) TILE(kernel, 2) TILE(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {tile_##kernel##_1, tile_##kernel##_2, tile_##kernel##_3},
const sph_tile_table SPH_ISA_NAME(sph_tile_loops) = {{SPH_KERNEL_LIST(ROW)},
                                                     {matrix_1, matrix_2, matrix_3}};
