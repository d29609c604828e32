/* linear_rows.h -- a matrix as products read it. */
#ifndef SPH_LINEAR_ROWS_H
#define SPH_LINEAR_ROWS_H
#include "linear_loops.h"

/* Copies: values in single precision and no zeros, half as large or less; only of matrices whose
 * entries off the diagonal are <= 0.  Sums of rows are those of A.  All zero is empty. */

/* The solution with the copy is off by less than this, relative, in the norm of A. */
#define SPH_LINEAR_COPY_ERROR 6e-8

/* Sets copy->right: whether A is such a matrix; else the copy is not to be used. */
int sph_linear_rows_copy(sph_linear_copy *copy, const sph_csr *A, int isa, int threads,
                         sph_error *error);
void sph_linear_rows_free(sph_linear_copy *copy); /* empty then */

/* What the loops read: of A itself, of a copy. */
sph_linear_rows sph_linear_rows_exact(const sph_csr *A);
sph_linear_rows sph_linear_rows_single(const sph_linear_copy *copy);

#endif
