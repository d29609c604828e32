/* reset_loops.h -- the loops of the density reset, by instruction set. */
#ifndef SPH_RESET_LOOPS_H
#define SPH_RESET_LOOPS_H
#include "cpu.h"
#include "reset_pair.h"

typedef struct sph_reset_table {
  sph_pair_function *loop[SPH_KERNELS][3]; /* [kernel][dim - 1] */
} sph_reset_table;

sph_pair_function *sph_reset_loop(int isa, int kernel, int dim);

#endif
