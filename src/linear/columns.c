#include "columns.h"

#include "memory.h"

static int reserve(sph_columns *to, long n, long entries, sph_error *error)
{
  if (n <= to->room_n && entries <= to->room_entries) return SPH_OK;
  sph_columns_free(to);
  n += n / 8;
  entries += entries / 8;
  to->start = SPH_NEW(SuiteSparse_long, n + 1, "a matrix by columns", error);
  to->next = SPH_NEW(SuiteSparse_long, n, "a matrix by columns", error);
  to->row = SPH_NEW(SuiteSparse_long, entries, "a matrix by columns", error);
  to->value = SPH_NEW(double, entries, "a matrix by columns", error);
  if (!to->start || !to->next || !to->row || !to->value) {
    sph_columns_free(to);
    return SPH_ERR_MEMORY;
  }
  to->room_n = n;
  to->room_entries = entries;
  return SPH_OK;
}

static void add(sph_columns *to, SuiteSparse_long row, SuiteSparse_long column, double value)
{
  SuiteSparse_long k = to->next[column]++;
  to->changed |= to->row[k] != row || !(to->value[k] == value);
  to->row[k] = row;
  to->value[k] = value;
}

int sph_columns_set(sph_columns *to, const sph_csr *A, int half, sph_error *error)
{
  const long n = A->n;
  int status = reserve(to, n, A->start[n] + n, error);
  if (status) return status;
  to->changed = to->n != n;
  to->n = n;
  to->start[0] = 0;
  for (long i = 0; i < n; i++) { /* column i is as long as row i, and its half, too */
    SuiteSparse_long count = 1;
    for (long k = A->start[i]; k < A->start[i + 1]; k++) count += !half || A->column[k] < i;
    to->next[i] = to->start[i];
    to->changed |= to->start[i + 1] != to->start[i] + count;
    to->start[i + 1] = to->start[i] + count;
  }
  for (long i = 0; i < n; i++) { /* row after row, so that each column is filled in order */
    for (long k = A->start[i]; k < A->start[i + 1]; k++)
      if (!half || A->column[k] > i) add(to, i, A->column[k], A->value[k]);
    add(to, i, i, A->diagonal[i]);
  }
  return SPH_OK;
}

void sph_columns_free(sph_columns *columns)
{
  sph_memory_free(columns->start);
  sph_memory_free(columns->row);
  sph_memory_free(columns->value);
  sph_memory_free(columns->next);
  *columns = (sph_columns){0};
}
