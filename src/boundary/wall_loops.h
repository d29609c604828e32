/* wall_loops.h -- the loops wall <- fluid, by instruction set. */
#ifndef SPH_WALL_LOOPS_H
#define SPH_WALL_LOOPS_H
#include "cpu.h"
#include "wall_pair.h"

typedef struct sph_wall_table {
  sph_pair_function *loop[SPH_KERNELS][3][2][2]; /* [kernel][dim - 1][turns][thermal] */
} sph_wall_table;

sph_pair_function *sph_wall_loop(int isa, int kernel, int dim, int turns, int thermal);

#endif
