/* shift_loops.h -- the loops of shifting, by instruction set. */
#ifndef SPH_SHIFT_LOOPS_H
#define SPH_SHIFT_LOOPS_H
#include "cpu.h"
#include "shift_pair.h"

/* X(name, kernel, dim, slots, sums) */
#define SPH_SHIFT_PASSES(X, kernel, dim)                                    \
  X(concentration, kernel, dim, 2 * dim + 2, 2 * dim + dim * (dim + 1) / 2) \
  X(covered, kernel, dim, 4 * dim + 3, SHIFT_COVERED_SUMS)                  \
  X(near, kernel, dim, 4 * dim + 3, dim + 1)                                \
  X(advection, kernel, dim, 4 * dim + 3, dim + 1)

enum {
#define SPH_SHIFT_PASS(name, kernel, dim, slots, sums) SPH_SHIFT_##name,
  SPH_SHIFT_PASSES(SPH_SHIFT_PASS, , )
#undef SPH_SHIFT_PASS
      SPH_SHIFT_PASS_COUNT
};

typedef struct sph_shift_table {
  sph_pair_function *loop[SPH_KERNELS][3][SPH_SHIFT_PASS_COUNT]; /* [kernel][dim - 1][pass] */
} sph_shift_table;

sph_pair_function *sph_shift_loop(int isa, int kernel, int dim, int pass);

#endif
