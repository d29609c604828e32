/* gradient_loops.h -- the loops of the gradient pass, by instruction set. */
#ifndef SPH_GRADIENT_LOOPS_H
#define SPH_GRADIENT_LOOPS_H
#include "cpu.h"
#include "gradient_pair.h"

typedef struct sph_gradient_table {
  sph_pair_function *loop[SPH_KERNELS][3]; /* [kernel][dim - 1] */
} sph_gradient_table;

sph_pair_function *sph_gradient_loop(int isa, int kernel, int dim);

#endif
