/* LU factors by KLU (Davis & Palamadai Natarajan 2010), pivots from the diagonal: of a symmetric
 * positive definite matrix these are all > 0, and only of such a one.
 *
 * KLU takes memory by SuiteSparse's functions. */
#include <klu.h>
#include <string.h>

#include "columns.h"
#include "linear_data.h"
#include "memory.h"

typedef struct lu {
  klu_l_common common;
  klu_l_symbolic *symbolic;
  klu_l_numeric *numeric;
  sph_columns A;
  double *x; /* [columns][n] */
  size_t room;
} lu;

static int out_of_memory(const lu *s, const sph_csr *A, sph_error *error)
{
  return sph_error_set(error, SPH_ERR_MEMORY,
                       "out of memory: LU factors of %ld rows, %ld entries (KLU's status is %ld)",
                       A->n, A->start[A->n], (long)s->common.status);
}

static int create(sph_linear *solver, sph_error *error)
{
  lu *s = SPH_NEW(lu, 1, "LU factors", error);
  if (!s) return SPH_ERR_MEMORY;
  solver->own = s;
  klu_l_defaults(&s->common);
  s->common.ordering = 0; /* AMD */
  s->common.btf = 0;      /* would pair rows with other columns, scaling changes pivots: */
  s->common.scale = 0;    /* they are to be those of the symmetric matrix */
  s->common.tol = 0;
  s->common.halt_if_singular = 1;
  return SPH_OK;
}

static void forget(lu *s)
{
  klu_l_free_numeric(&s->numeric, &s->common);
  klu_l_free_symbolic(&s->symbolic, &s->common);
}

static int factorise(lu *s)
{
  sph_columns *A = &s->A;
  if (s->numeric)
    return (int)klu_l_refactor(A->start, A->row, A->value, s->symbolic, s->numeric, &s->common);
  s->numeric = klu_l_factor(A->start, A->row, A->value, s->symbolic, &s->common);
  return s->numeric != NULL;
}

static int check_pivots(sph_linear *solver, const lu *s, long n)
{
  const double *pivot = s->numeric ? s->numeric->Udiag : NULL;
  if (!pivot || s->common.status == KLU_SINGULAR || s->common.noffdiag > 0)
    return sph_linear_refuse(solver, "the matrix is not positive definite: pivot %ld of %ld is 0",
                             (long)s->common.singular_col + 1, n);
  for (long i = 0; i < n; i++)
    if (!(pivot[i] > 0))
      return sph_linear_refuse(solver,
                               "the matrix is not positive definite: pivot %ld of %ld is %g", i + 1,
                               n, pivot[i]);
  return SPH_OK;
}

static int prepare(sph_linear *solver, const sph_csr *A, int change, sph_error *error)
{
  lu *s = solver->own;
  if (sph_columns_set(&s->A, A, 0, error)) return SPH_ERR_MEMORY;
  if (change == SPH_LINEAR_PATTERN || !s->symbolic) {
    forget(s);
    s->symbolic = klu_l_analyze(A->n, s->A.start, s->A.row, &s->common);
    if (!s->symbolic) return out_of_memory(s, A, error);
    solver->stats.analyses++;
  }
  if (s->numeric && !s->A.changed) return SPH_OK;
  int made = factorise(s);
  solver->stats.factorisations++;
  if (!made && s->common.status < 0) return out_of_memory(s, A, error);
  int status = check_pivots(solver, s, A->n);
  if (status) klu_l_free_numeric(&s->numeric, &s->common);
  return status;
}

static int solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  lu *s = solver->own;
  const size_t n = (size_t)task->A->n, columns = (size_t)task->columns;
  if (n * columns > s->room) {
    if (sph_memory_grow((void **)&s->x, 0, n * columns, sizeof(double), "right-hand sides", error))
      return SPH_ERR_MEMORY;
    s->room = n * columns;
  }
  for (size_t c = 0; c < columns; c++) memcpy(s->x + c * n, task->b[c], n * sizeof *s->x);
  if (!klu_l_solve(s->symbolic, s->numeric, task->A->n, task->columns, s->x, &s->common))
    return out_of_memory(s, task->A, error);
  for (size_t c = 0; c < columns; c++) memcpy(task->x[c], s->x + c * n, n * sizeof *s->x);
  return SPH_OK;
}

static void done(sph_linear *solver)
{
  lu *s = solver->own;
  if (!s) return;
  forget(s);
  sph_columns_free(&s->A);
  sph_memory_free(s->x);
  sph_memory_free(s);
}

const sph_linear_method sph_linear_klu = {
    .name = "klu", .create = create, .prepare = prepare, .solve = solve, .free = done};
