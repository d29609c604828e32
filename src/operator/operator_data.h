/* operator_data.h -- what operators have in common.  Internal: files of operator/ share it.
 *
 * Each operator is a body that works on one row, a place with its neighbours: it reads like its
 * formula, and may go over the row as often as it likes. */
#ifndef SPH_OPERATOR_DATA_H
#define SPH_OPERATOR_DATA_H
#include "operator_loops.h"
#include "sphode/kernel.h"
#include "sphode/operator.h"

enum { SPH_MOMENTS = 10 }; /* of a polynomial of order 2 in 3D */

/* Points or probes. */
typedef struct sph_places {
  long n, room;
  double *x[3];     /* [n] in sorted order, inside the periodic box [m] */
  const int *order; /* [n] number of the one at each sorted place; the search's */
} sph_places;

struct sph_operator {
  sph_operator_def def; /* its strings are not kept */
  const sph_kernel *kernel;
  int isa, number; /* instruction set; that of sph_kernel_get */
  sph_neighbors *neighbors;
  sph_places points, probes;
  int ready, probing; /* there are points; results are wanted at the probes */
  double *V;          /* [points.n] in sorted order */
  double *rho;        /* [points.n] of point i; NULL: 1 */
  double *values;     /* of all rows, one a thread */
  int *numbers;       /* ... */
  sph_row *row;       /* [threads] */
  long row_room;
  long lowered;
};

/* Does one operator at one place.  `rung` counts the simpler forms, from 0.  Returns 1 where its
 * moment matrix is singular, else 0. */
typedef int sph_operator_body(const void *task, const sph_row *row, int rung);

/* Calls the body at each place, on all threads.  `rungs`: how many forms it has, at least one.
 * `name` is what errors call it. */
int sph_operator_each(sph_operator *op, const char *name, sph_operator_body *body, const void *task,
                      int rungs, sph_error *error);

/* An op with points; where the operator needs the field at the place itself, without probes. */
int sph_operator_check(const sph_operator *op, const char *name, int field_there, sph_error *error);
/* n arrays, none of them NULL. */
int sph_operator_need(const char *name, const char *what, int n, const double *const array[],
                      sph_error *error);
#define SPH_WRITTEN(arrays) ((const double *const *)(arrays)) /* of double *const[] */

/* Solves A x = b for `columns` right-hand sides, b[columns][n] in, x out; A[n][n] row by row is
 * lost.  Returns 1 where A is singular: its last pivot below 1e-10 of the first.  n <= 10. */
int sph_operator_solve(int n, double *A, int columns, double *b);

/* Shepard's mean; 1: nobody is near. */
int sph_operator_shepard_row(const sph_row *row, const double *f, double *value);

#endif
