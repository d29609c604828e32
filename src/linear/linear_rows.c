/* Of A = F + L, where x'Lx = sum w_ij (x_i - x_j)^2 with w_ij >= 0, a copy with (1 + e_ij) w_ij in
 * place of w_ij, |e_ij| <= e, has x off by |dx|_A <= e |x|_L/(1 - e), since
 * |y'(L~ - L)x| <= e |y|_L |x|_L: whatever the condition. */
#include "linear_rows.h"

#include "memory.h"

enum { CHUNK = 1024 }; /* rows: each chunk is packed from where its entries of A begin */

void sph_linear_rows_free(sph_linear_copy *copy)
{
  sph_memory_free(copy->begin);
  sph_memory_free(copy->end);
  sph_memory_free(copy->column);
  sph_memory_free(copy->value);
  sph_memory_free(copy->diagonal);
  *copy = (sph_linear_copy){0};
}

static int reserve(sph_linear_copy *copy, long rows, long entries, sph_error *error)
{
  if (rows <= copy->room_rows && entries <= copy->room_entries) return SPH_OK;
  sph_linear_rows_free(copy);
  rows += rows / 8;
  entries += entries / 8;
  copy->begin = SPH_NEW(long, rows, "copy of a matrix", error);
  copy->end = SPH_NEW(long, rows, "copy of a matrix", error);
  copy->diagonal = SPH_NEW(double, rows, "copy of a matrix", error);
  copy->column = SPH_NEW(int, entries, "copy of a matrix", error);
  copy->value = SPH_NEW(float, entries, "copy of a matrix", error);
  if (!copy->begin || !copy->end || !copy->diagonal || !copy->column || !copy->value) {
    sph_linear_rows_free(copy);
    return SPH_ERR_MEMORY;
  }
  copy->room_rows = rows;
  copy->room_entries = entries;
  return SPH_OK;
}

int sph_linear_rows_copy(sph_linear_copy *copy, const sph_csr *A, int isa, int threads,
                         sph_error *error)
{
  int status = reserve(copy, A->n, A->start[A->n], error), right = 1;
  if (status) return status;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(&& : right)
  for (long from = 0; from < A->n; from += CHUNK) {
    const long to = from + CHUNK < A->n ? from + CHUNK : A->n;
    right = sph_linear_loop_copy(isa, copy, A, from, to) && right;
  }
  copy->right = right;
  return SPH_OK;
}

sph_linear_rows sph_linear_rows_exact(const sph_csr *A)
{
  return (sph_linear_rows){.begin = A->start,
                           .end = A->start + 1,
                           .column = A->column,
                           .value = A->value,
                           .diagonal = A->diagonal};
}

sph_linear_rows sph_linear_rows_single(const sph_linear_copy *copy)
{
  return (sph_linear_rows){.begin = copy->begin,
                           .end = copy->end,
                           .column = copy->column,
                           .single = copy->value,
                           .diagonal = copy->diagonal};
}
