/* csr.h -- a symmetric sparse matrix by rows, as pair sums give them: linear/ knows matrices only.
 *
 * The diagonal stands apart.  Both halves are stored: entry (i, j) stands in row i and, equal, in
 * row j, so that rows are made and multiplied without looking at others. */
#ifndef SPH_CSR_H
#define SPH_CSR_H
#include "sphode/base.h"

/* All zero is an empty matrix. */
typedef struct sph_csr {
  long n;           /* rows */
  long *start;      /* [n + 1]: row i has the entries start[i] to start[i + 1] - 1; start[0] = 0 */
  int *column;      /* [start[n]]: not i, each at most once, in any order */
  double *value;    /* [start[n]] */
  double *diagonal; /* [n]: > 0 */
  /* [n]: > 0, the matrix less diag(floor) is positive semidefinite: the smaller it is, the worse
   * may errors be, given the residual.  Of M + gamma L, where M is diagonal and L > 0: M. */
  double *floor;
  long room_rows, room_entries; /* that fit */
} sph_csr;

/* Makes room; what is there stays.  Else SPH_ERR_MEMORY, recorded, and nothing changes. */
int sph_csr_reserve(sph_csr *A, long rows, long entries, sph_error *error);

/* y = A x for `columns` vectors at once, each an array [n]. */
void sph_csr_multiply(const sph_csr *A, int columns, const double *const *x, double *const *y);

void sph_csr_free(sph_csr *A); /* empty then */

#endif
