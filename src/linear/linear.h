/* linear.h -- A x = b for symmetric positive definite sparse matrices, by a method chosen by name.
 *
 * A solver keeps what it learned of a matrix: symbolic factors while the pattern is the same,
 * numeric ones while the values are. */
#ifndef SPH_LINEAR_H
#define SPH_LINEAR_H
#include "csr.h"
#include "sphode/checkpoint.h"

typedef struct sph_linear sph_linear;

/* One matrix, one or several right-hand sides. */
typedef struct sph_linear_task {
  const sph_csr *A;
  long pattern;                /* a number that changes when the pattern of A does */
  long values;                 /* one that changes when its values do */
  int columns;                 /* right-hand sides */
  const double *const *b;      /* [columns][n] */
  double *const *x;            /* [columns][n]: come as guesses, to be the solutions */
  const double *const *weight; /* [columns][n]: 1 / scale of each entry of x, >= 0; NULL: 1 */
  double tolerance; /* > 0: of sqrt(mean over entries and columns of (weight * error of x)^2) */
} sph_linear_task;

typedef struct sph_linear_stats {
  long solves;         /* tasks done */
  long iterations;     /* of conjugate gradients: products with A, of all columns at once */
  long analyses;       /* symbolic factorisations */
  long factorisations; /* numeric ones, incomplete ones too */
  long last;           /* iterations of the last solve */
} sph_linear_stats;

/* The k-th name that sph_linear_create knows, NULL behind the last. */
const char *sph_linear_name(int k);

/* A solver by its name (NULL: "auto").  NULL: recorded, with the known names and the nearest. */
sph_linear *sph_linear_create(const char *name, int threads, sph_error *error);

/* Solves.  Iterative methods stop where a bound of the error falls below the tolerance, direct ones
 * do not look at it.  The bits are the same for any number of threads (CHOLMOD's, with another BLAS
 * than OpenBLAS that has threads of its own: for any but those, which its environment sets).
 *
 * SPH_RETRY: no solution, since A is not positive definite, a number is not finite or iterations
 * ran out; sph_linear_reason tells, x is arbitrary.  < 0: recorded. */
int sph_linear_solve(sph_linear *solver, const sph_linear_task *task, sph_error *error);

/* The method of the last solve: that of create, or the one that "auto" took. */
const char *sph_linear_used(const sph_linear *solver);

/* Why the last solve returned SPH_RETRY, with its numbers; "" if it did not.  Never NULL. */
const char *sph_linear_reason(const sph_linear *solver);

/* What it learned that changes which bits come next, for checkpoints: a choice of methods; factors
 * are made again. */
int sph_linear_keep(sph_linear *solver, sph_keep *keep);

void sph_linear_get_stats(const sph_linear *solver, sph_linear_stats *stats);
void sph_linear_free(sph_linear *solver); /* NULL is fine */

#endif
