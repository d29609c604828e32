/* linear_pcg.h -- conjugate gradients, whatever the preconditioner. */
#ifndef SPH_LINEAR_PCG_H
#define SPH_LINEAR_PCG_H
#include "linear_data.h"

enum { SPH_PCG_COLUMNS = 4 }; /* right-hand sides of one run; more take several */

typedef struct sph_pcg {
  int threads, d;            /* d: columns of the run */
  const sph_csr *A;          /* of the run */
  long n, chunks;            /* of the matrix that was prepared */
  long room;                 /* rows that fit into the arrays */
  double mu;                 /* smallest eigenvalue of P^-1 A, or less */
  double *inverse;           /* [n] 1/diagonal */
  double *x, *r, *z, *p, *q; /* [n * d] */
  double *part;              /* [chunks * d] */
  double alpha[SPH_PCG_COLUMNS], beta[SPH_PCG_COLUMNS];
  /* z = P^-1 r for d columns; NULL: P is the diagonal */
  void (*apply)(const struct sph_pcg *s);
  void *preconditioner; /* what apply knows */
} sph_pcg;

/* Room for n rows, the inverse of the diagonal, mu for P = the diagonal. */
int sph_linear_pcg_prepare(sph_pcg *s, const sph_csr *A, sph_error *error);
int sph_linear_pcg_solve(sph_pcg *s, sph_linear *solver, const sph_linear_task *task);
void sph_linear_pcg_free(sph_pcg *s); /* what it points to */

#endif
