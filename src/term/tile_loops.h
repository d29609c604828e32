/* tile_loops.h -- the loops with tiles for registered pair terms, by instruction set. */
#ifndef SPH_TILE_LOOPS_H
#define SPH_TILE_LOOPS_H
#include "cpu.h"
#include "matrix_loops.h"
#include "tile_pair.h"

typedef struct sph_tile_table {
  sph_pair_function *loop[SPH_KERNELS][3]; /* [kernel][dim - 1] */
  sph_matrix_function *matrix[3];
} sph_tile_table;

sph_pair_function *sph_tile_loop(int isa, int kernel, int dim);
/* Adds what they give to a matrix (tile_matrix.h). */
sph_matrix_function *sph_tile_loop_matrix(int isa, int dim);

#endif
