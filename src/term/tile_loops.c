/* Instances of the loop with tiles, once per instruction set.  Those with rare terms, and those of
 * matrices, are for any kernel. */
#include "tile_loops.h"
#include "tile_matrix.h"

BODY const tile_constants *constants_of(const sph_pair_task *t) { return t->constants; }

#define ANY(dim)                                                                           \
  static __attribute__((noinline)) void rare_##dim(const sph_pair_task *t, long b, long e) \
  {                                                                                        \
    const fluid_constants *k = &constants_of(t)->fluid;                                    \
    tile_blocks(dim, k->kernel, k->terms, 1, t, b, e);                                     \
  }                                                                                        \
  static void matrix_##dim(const sph_matrix_task *t, long b, long e)                       \
  {                                                                                        \
    tile_matrix_blocks(dim, constants_of(t->pairs)->fluid.kernel, t, b, e);                \
  }
ANY(1)
ANY(2)
ANY(3)

/* The built-in terms run faster where the rare ones are known to be absent. */
#define TILE(kernel, dim)                                                   \
  static void tile_##kernel##_##dim(const sph_pair_task *t, long b, long e) \
  {                                                                         \
    const unsigned terms = constants_of(t)->fluid.terms;                    \
    if (terms & SPH_RARE)                                                   \
      rare_##dim(t, b, e);                                                  \
    else                                                                    \
      tile_blocks(dim, kernel, terms & ~(unsigned)SPH_RARE, 0, t, b, e);    \
  }
#define KERNEL(kernel) TILE(kernel, 1) TILE(kernel, 2) TILE(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {tile_##kernel##_1, tile_##kernel##_2, tile_##kernel##_3},
const sph_tile_table SPH_ISA_NAME(sph_tile_loops) = {{SPH_KERNEL_LIST(ROW)},
                                                     {matrix_1, matrix_2, matrix_3}};
