/* Instances of the loop with tiles, once per instruction set; those that many use, in two and three
 * dimensions, for one kernel and constant terms. */
#include "tile_loops.h"
#include "tile_matrix.h"

#define LOOP(name, dim, kernel, fused)                                    \
  static void tile_##name##_##dim(const sph_pair_task *t, long b, long e) \
  {                                                                       \
    const tile_constants *k = t->constants;                               \
    (void)k;                                                              \
    tile_blocks(dim, kernel, fused, take_##dim, t, b, e);                 \
  }

#define DIM(dim)                                                                                 \
  static __attribute__((noinline)) void take_##dim(const tile_constants *k, tile_work *w, int n) \
  {                                                                                              \
    tile_take(dim, k, w, n);                                                                     \
  }                                                                                              \
  static void matrix_##dim(const sph_matrix_task *t, long b, long e)                             \
  {                                                                                              \
    tile_matrix_blocks(dim, t, b, e);                                                            \
  }                                                                                              \
  LOOP(none_of, dim, k->fluid.kernel, 0)                                                         \
  LOOP(any_of, dim, k->fluid.kernel, k->fused & ~(unsigned)SPH_RARE)
DIM(1)
DIM(2)
DIM(3)

#if SPH_LANES > 2
#define CONSTANT(dim, name, fused) LOOP(name, dim, SPH_KERNEL_WENDLAND_C2, fused)
SPH_TILE_SETS(CONSTANT, 2)
SPH_TILE_SETS(CONSTANT, 3)
#define ROW(dim, name, fused) tile_##name##_##dim,
#define CONSTANTS                                              \
  {                                                            \
    {NULL}, {SPH_TILE_SETS(ROW, 2)}, { SPH_TILE_SETS(ROW, 3) } \
  }
#else
#define CONSTANTS \
  {               \
    {             \
      NULL        \
    }             \
  }
#endif

const sph_tile_table SPH_ISA_NAME(sph_tile_loops) = {CONSTANTS,
                                                     {tile_none_of_1, tile_none_of_2,
                                                      tile_none_of_3},
                                                     {tile_any_of_1, tile_any_of_2, tile_any_of_3},
                                                     {matrix_1, matrix_2, matrix_3}};
