/* columns.h -- a matrix as SuiteSparse wants it: by columns, rows in ascending order, the diagonal
 * among them. */
#ifndef SPH_COLUMNS_H
#define SPH_COLUMNS_H
#include <SuiteSparse_config.h>

#include "csr.h"

/* All zero is empty. */
typedef struct sph_columns {
  SuiteSparse_long n;
  SuiteSparse_long *start; /* [n + 1] */
  SuiteSparse_long *row;   /* [start[n]] */
  double *value;           /* [start[n]] */
  SuiteSparse_long *next;  /* [n] scratch */
  long room_n, room_entries;
  int changed; /* the last set found another matrix than the one before */
} sph_columns;

/* All of A, or with half != 0 its upper half: rows up to the column's. */
int sph_columns_set(sph_columns *to, const sph_csr *A, int half, sph_error *error);
void sph_columns_free(sph_columns *columns); /* empty then */

#endif
