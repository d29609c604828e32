#include "csr.h"

#include "memory.h"

#define GROW(array, old, new, what) \
  sph_memory_grow((void **)&(array), (size_t)(old), (size_t)(new), sizeof *(array), what, error)

static int reserve_rows(sph_csr *A, long rows, sph_error *error)
{
  const long old = A->room_rows;
  if (rows <= old && A->start) return SPH_OK;
  if (GROW(A->start, A->start ? old + 1 : 0, rows + 1, "rows of a matrix") ||
      GROW(A->diagonal, old, rows, "diagonal of a matrix") ||
      GROW(A->floor, old, rows, "floor of a matrix"))
    return SPH_ERR_MEMORY;
  A->room_rows = rows;
  return SPH_OK;
}

static int reserve_entries(sph_csr *A, long entries, sph_error *error)
{
  const long old = A->room_entries;
  if (entries <= old && A->column) return SPH_OK;
  if (GROW(A->column, old, entries, "columns of a matrix") ||
      GROW(A->value, old, entries, "values of a matrix"))
    return SPH_ERR_MEMORY;
  A->room_entries = entries;
  return SPH_OK;
}

int sph_csr_reserve(sph_csr *A, long rows, long entries, sph_error *error)
{
  int status = reserve_rows(A, rows, error);
  return status ? status : reserve_entries(A, entries, error);
}

void sph_csr_multiply(const sph_csr *A, int columns, const double *const *x, double *const *y)
{
  for (int c = 0; c < columns; c++)
    for (long i = 0; i < A->n; i++) {
      double sum = A->diagonal[i] * x[c][i];
      for (long k = A->start[i]; k < A->start[i + 1]; k++) sum += A->value[k] * x[c][A->column[k]];
      y[c][i] = sum;
    }
}

void sph_csr_free(sph_csr *A)
{
  sph_memory_free(A->start);
  sph_memory_free(A->column);
  sph_memory_free(A->value);
  sph_memory_free(A->diagonal);
  sph_memory_free(A->floor);
  *A = (sph_csr){0};
}
