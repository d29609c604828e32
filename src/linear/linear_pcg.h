/* linear_pcg.h -- conjugate gradients, whatever the preconditioner. */
#ifndef SPH_LINEAR_PCG_H
#define SPH_LINEAR_PCG_H
#include "linear_data.h"
#include "linear_rows.h"

typedef struct sph_pcg {
  int threads, isa;
  int d;                         /* columns of the run */
  int width;                     /* numbers a row takes */
  const sph_linear_loops *loops; /* of the width */
  long n, chunks;                /* of the matrix that was prepared */
  long room;                     /* rows that fit into the arrays */
  double mu;                     /* smallest eigenvalue of P^-1 A, or less */
  double *inverse;               /* [n] 1/diagonal */
  sph_linear_vectors v;
  int single; /* the run multiplies by the copy */
  int copied; /* the copy is of the matrix that was prepared */
  sph_linear_copy copy;
  double *part;                    /* [chunks * SPH_LINEAR_WIDTH] */
  const sph_linear_factor *factor; /* P = L L'; NULL: P is the diagonal */
} sph_pcg;

int sph_linear_pcg_create(sph_pcg *s, const sph_linear *solver, sph_error *error);
/* Room for n rows, the inverse of the diagonal, mu for P = the diagonal. */
int sph_linear_pcg_prepare(sph_pcg *s, const sph_csr *A, sph_error *error);
int sph_linear_pcg_solve(sph_pcg *s, sph_linear *solver, const sph_linear_task *task,
                         sph_error *failure);
void sph_linear_pcg_free(sph_pcg *s); /* what it points to */

#endif
