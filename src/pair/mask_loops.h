/* mask_loops.h -- which targets of a block a source is near: a bit each, for what walks over the
 * same pairs again and again (matrices). */
#ifndef SPH_MASK_LOOPS_H
#define SPH_MASK_LOOPS_H
#include "cpu.h"
#include "sphode/pair_loop.h"

/* Of the pairs of a list, in its order: block by block, run by run, source by source. */
typedef struct sph_mask_task {
  const sph_pair_task *pairs; /* its sums and constants are not used */
  long targets;               /* lanes behind the last one get no bit */
  int same;                   /* targets are sources: no particle is its own neighbour */
  double reach2;              /* squared distance [m^2] */
  const long *first;          /* [blocks + 1]: place of a block's first source in mask */
  unsigned char *mask;        /* [first[blocks]] to be filled: bit l for lane l */
} sph_mask_task;

typedef void sph_mask_function(const sph_mask_task *task, long begin, long end); /* blocks */

typedef struct sph_mask_table {
  sph_mask_function *loop[3]; /* [dim - 1] */
} sph_mask_table;

sph_mask_function *sph_mask_loop(int isa, int dim);

#endif
