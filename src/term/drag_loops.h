/* drag_loops.h -- the loops of drag, by instruction set. */
#ifndef SPH_DRAG_LOOPS_H
#define SPH_DRAG_LOOPS_H
#include "cpu.h"
#include "drag_pair.h"

typedef struct sph_drag_table {
  sph_pair_function *loop[SPH_KERNELS][3]; /* [kernel][dim - 1] */
} sph_drag_table;

sph_pair_function *sph_drag_loop(int isa, int kernel, int dim);

#endif
