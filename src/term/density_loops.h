/* density_loops.h -- the loops of the summation of density, by instruction set. */
#ifndef SPH_DENSITY_LOOPS_H
#define SPH_DENSITY_LOOPS_H
#include "cpu.h"
#include "density_pair.h"

typedef struct sph_density_table {
  sph_pair_function *loop[SPH_KERNELS][3]; /* [kernel][dim - 1] */
} sph_density_table;

sph_pair_function *sph_density_loop(int isa, int kernel, int dim);

#endif
