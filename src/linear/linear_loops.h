/* linear_loops.h -- the loops over rows of conjugate gradients, instances for each instruction set
 * and width.
 *
 * Vectors are stored row by row, `width` numbers each: the columns, three and a zero. */
#ifndef SPH_LINEAR_LOOPS_H
#define SPH_LINEAR_LOOPS_H
#include "cpu.h"
#include "csr.h"

enum { SPH_LINEAR_WIDTH = 4 }; /* right-hand sides at once, at most */

/* A matrix, its values in one of both. */
typedef struct sph_linear_rows {
  const long *begin, *end; /* [n] of the entries of each row */
  const int *column;
  const double *value;
  const float *single;
  const double *diagonal; /* [n] */
} sph_linear_rows;

/* What the loops work on; P: the preconditioner. */
typedef struct sph_linear_vectors {
  sph_linear_rows A;
  const double *inverse;     /* [n] 1/diagonal of A */
  double *x, *r, *z, *p, *q; /* [n * width] */
  double alpha[SPH_LINEAR_WIDTH], beta[SPH_LINEAR_WIDTH];
} sph_linear_vectors;

/* Rows from..to; sum[width] is added to where the loop has one. */
typedef void sph_linear_loop(const sph_linear_vectors *v, long from, long to, double *sum);

/* L, an incomplete factor by rows: columns in ascending order, the diagonal apart. */
typedef struct sph_linear_factor {
  long n;
  long *start;      /* [n + 1] */
  int *column;      /* [start[n]] */
  double *value;    /* [start[n]] */
  double *diagonal; /* [n] 1/L_ii */
} sph_linear_factor;

typedef struct sph_linear_loops {
  sph_linear_loop *residual[2]; /* r -= A x; [1]: values in single precision */
  sph_linear_loop *product[2];  /* q = A p; sum of p.q */
  sph_linear_loop *step;        /* x += alpha p, r -= alpha q */
  sph_linear_loop *step_jacobi; /* as step, then z = r/diagonal; sum of r.z */
  sph_linear_loop *dot;         /* sum of r.z */
  sph_linear_loop *turn;        /* p = z + beta p */
  void (*solve)(const sph_linear_factor *L, const double *r, double *z); /* L L' z = r */
} sph_linear_loops;

/* A copy of a matrix with values in single precision, without zeros. */
typedef struct sph_linear_copy {
  int right; /* see linear_rows.h */
  long room_rows, room_entries;
  long *begin, *end; /* [n] */
  int *column;       /* [A->start[n]] */
  float *value;
  double *diagonal; /* [n] */
} sph_linear_copy;

typedef struct sph_linear_table {
  /* Rows from..to, packed from where their entries of A begin; returns whether all these are <= 0
   * and have diagonals that single precision can stand beside. */
  int (*copy)(const sph_linear_copy *copy, const sph_csr *A, long from, long to);
  sph_linear_loops width[SPH_LINEAR_WIDTH + 1]; /* 1, 2, 4 */
} sph_linear_table;

/* The width that d columns take, and its loops. */
int sph_linear_loop_width(int d);
const sph_linear_loops *sph_linear_loop_get(int isa, int width);
int sph_linear_loop_copy(int isa, const sph_linear_copy *copy, const sph_csr *A, long from,
                         long to);

#endif
