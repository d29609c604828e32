/* matrix_loops.h -- the loops that fill matrices of implicit stages, by instruction set.
 *
 * Rows are particles in sorted order, or their components; the entries of a row follow the bits of
 * the masks (mask_loops.h) of its interactions one after another. */
#ifndef SPH_MATRIX_LOOPS_H
#define SPH_MATRIX_LOOPS_H
#include "cpu.h"
#include "mask_loops.h"
#include "matrix_pair.h"

typedef struct sph_matrix_task {
  const sph_pair_task *pairs; /* constants: matrix_constants; its sums are not used */
  const long *first;          /* as in sph_mask_task */
  const unsigned char *mask;  /* NULL: of walls, whose sums alone are wanted (tile_matrix.h) */
  int vector;
  long targets;
  /* Of the rows of the targets: where their entries begin, and the diagonal, which is added to.  A
   * vector's row begins with dim - 1 entries of its own particle, added to as well. */
  const long *start;
  double *diagonal;
  int *filled;   /* [targets] neighbours whose entries are there */
  double *value; /* of the whole matrix */
} sph_matrix_task;

typedef void sph_matrix_function(const sph_matrix_task *task, long begin, long end); /* blocks */

/* Sums of the loops over walls: of k; of k I + q r r^T, the upper triangle by rows. */
enum { SPH_MATRIX_WALL_SUMS = 6 };

typedef struct sph_matrix_loops {
  sph_matrix_function *scalar, *vector;
  sph_pair_function *wall_scalar, *wall_vector;
} sph_matrix_loops;

typedef struct sph_matrix_table {
  sph_matrix_loops loops[3]; /* [dim - 1] */
} sph_matrix_table;

/* Their constants name the kernel. */
const sph_matrix_loops *sph_matrix_loop(int isa, int dim);

#endif
