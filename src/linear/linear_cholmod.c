/* Cholesky factors by CHOLMOD (Chen, Davis, Hager & Rajamanickam 2008), supernodal or simplicial.
 *
 * CHOLMOD takes memory by SuiteSparse's functions, and calls the BLAS, which may have threads of
 * its own: an OpenBLAS is kept to one (blas_threads.h). */
#include <cholmod.h>
#include <string.h>

#include "blas_threads.h"
#include "columns.h"
#include "linear_cholmod.h"
#include "linear_data.h"
#include "memory.h"

typedef struct cholesky {
  cholmod_common common;
  cholmod_factor *L;
  int factored;             /* L is the factor of `upper` */
  cholmod_dense *X, *Y, *E; /* workspace of solves, kept */
  cholmod_dense *B;         /* [columns][n] */
  sph_columns upper;
} cholesky;

static int out_of_memory(const cholesky *s, const sph_csr *A, sph_error *error)
{
  return sph_error_set(error, SPH_ERR_MEMORY,
                       "out of memory: Cholesky factors of %ld rows, %ld entries (CHOLMOD's status "
                       "is %d)",
                       A->n, A->start[A->n], s->common.status);
}

static cholmod_sparse view(cholesky *s)
{
  sph_columns *A = &s->upper;
  return (cholmod_sparse){.nrow = (size_t)A->n,
                          .ncol = (size_t)A->n,
                          .nzmax = (size_t)A->start[A->n],
                          .p = A->start,
                          .i = A->row,
                          .x = A->value,
                          .stype = 1, /* symmetric, upper half given */
                          .itype = CHOLMOD_LONG,
                          .xtype = CHOLMOD_REAL,
                          .dtype = CHOLMOD_DOUBLE,
                          .sorted = 1,
                          .packed = 1};
}

static int create(sph_linear *solver, sph_error *error)
{
  cholesky *s = SPH_NEW(cholesky, 1, "Cholesky factors", error);
  if (!s) return SPH_ERR_MEMORY;
  solver->own = s;
  cholmod_l_start(&s->common);
  s->common.print = 0;
  s->common.error_handler = NULL;
  s->common.supernodal = solver->method->kind;
  s->common.final_ll = 1; /* LL', not LDL', which takes indefinite matrices */
  s->common.quick_return_if_not_posdef = 1;
  s->common.useGPU = 0;
#if CHOLMOD_MAIN_VERSION >= 5
  s->common.nthreads_max = 1;
#endif
  return SPH_OK;
}

/* Takes A over and orders it. */
static int analyse(sph_linear *solver, const sph_csr *A, sph_error *error)
{
  cholesky *s = solver->own;
  if (sph_columns_set(&s->upper, A, 1, error)) return SPH_ERR_MEMORY;
  cholmod_sparse upper = view(s);
  s->factored = 0;
  cholmod_l_free_factor(&s->L, &s->common);
  s->L = cholmod_l_analyze(&upper, &s->common);
  if (!s->L) return out_of_memory(s, A, error);
  solver->stats.analyses++;
  return SPH_OK;
}

static int prepare(sph_linear *solver, const sph_csr *A, int change, sph_error *error)
{
  cholesky *s = solver->own;
  int status = change == SPH_LINEAR_PATTERN ? analyse(solver, A, error)
                                            : sph_columns_set(&s->upper, A, 1, error);
  if (status || (s->factored && !s->upper.changed)) return status;
  s->factored = 0;
  cholmod_sparse upper = view(s);
  sph_blas_threads_hold();
  cholmod_l_factorize(&upper, s->L, &s->common);
  sph_blas_threads_release();
  solver->stats.factorisations++;
  if (s->common.status == CHOLMOD_NOT_POSDEF)
    return sph_linear_refuse(solver, "the matrix is not positive definite: pivot %zu of %ld",
                             s->L->minor + 1, A->n);
  if (s->common.status < 0) return out_of_memory(s, A, error);
  s->factored = 1;
  return SPH_OK;
}

static int solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  cholesky *s = solver->own;
  const size_t n = (size_t)task->A->n, columns = (size_t)task->columns;
  int made = cholmod_l_ensure_dense(&s->B, n, columns, n, CHOLMOD_REAL, &s->common) != NULL;
  if (made && s->L->is_super) /* CHOLMOD 3 does not look whether it got this */
    made = cholmod_l_ensure_dense(&s->Y, n, columns, n, CHOLMOD_REAL, &s->common) != NULL;
  for (size_t c = 0; made && c < columns; c++)
    memcpy((double *)s->B->x + c * n, task->b[c], n * sizeof(double));
  sph_blas_threads_hold();
  if (made)
    made = cholmod_l_solve2(CHOLMOD_A, s->L, s->B, NULL, &s->X, NULL, &s->Y, &s->E, &s->common);
  sph_blas_threads_release();
  if (!made) return out_of_memory(s, task->A, error);
  for (size_t c = 0; c < columns; c++)
    memcpy(task->x[c], (double *)s->X->x + c * n, n * sizeof(double));
  return SPH_OK;
}

static void done(sph_linear *solver)
{
  cholesky *s = solver->own;
  if (!s) return;
  cholmod_l_free_factor(&s->L, &s->common);
  cholmod_l_free_dense(&s->X, &s->common);
  cholmod_l_free_dense(&s->Y, &s->common);
  cholmod_l_free_dense(&s->E, &s->common);
  cholmod_l_free_dense(&s->B, &s->common);
  cholmod_l_finish(&s->common);
  sph_columns_free(&s->upper);
  sph_memory_free(s);
}

const sph_linear_method sph_linear_cholmod = {.name = "cholmod",
                                              .kind = CHOLMOD_AUTO,
                                              .create = create,
                                              .prepare = prepare,
                                              .solve = solve,
                                              .free = done};

const sph_linear_method sph_linear_cholmod_supernodal = {.name = "cholmod-supernodal",
                                                         .kind = CHOLMOD_SUPERNODAL,
                                                         .create = create,
                                                         .prepare = prepare,
                                                         .solve = solve,
                                                         .free = done};

const sph_linear_method sph_linear_cholmod_simplicial = {.name = "cholmod-simplicial",
                                                         .kind = CHOLMOD_SIMPLICIAL,
                                                         .create = create,
                                                         .prepare = prepare,
                                                         .solve = solve,
                                                         .free = done};

int sph_linear_cholmod_analyse(sph_linear *solver, const sph_linear_task *task, double *flops,
                               double *entries, sph_error *error)
{
  const cholesky *s = solver->own;
  solver->has_pattern = solver->has_values = 0;
  int status = analyse(solver, task->A, error);
  if (status) return status;
  solver->pattern = task->pattern;
  solver->has_pattern = 1;
  *flops = s->common.fl;
  *entries = s->common.lnz;
  return SPH_OK;
}
