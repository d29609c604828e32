/* Conjugate gradients preconditioned by an incomplete Cholesky factor P = L L' with the pattern of
 * A (Meijerink & van der Vorst 1977).  It exists where all entries off the diagonal are <= 0; for
 * other matrices the diagonal is raised until it does (Manteuffel 1980).
 *
 * The solves with L go row by row, in one thread; products with A take all. */
#include <math.h>

#include "linear_pcg.h"
#include "memory.h"

typedef struct ic0 {
  sph_pcg pcg;
  sph_linear_factor L;
  long room_rows, room_entries;
  long *next;   /* [n] scratch */
  double *work; /* [n] zero between rows */
} ic0;

static void factor_free(ic0 *s)
{
  sph_memory_free(s->L.start);
  sph_memory_free(s->L.column);
  sph_memory_free(s->L.value);
  sph_memory_free(s->L.diagonal);
  sph_memory_free(s->next);
  sph_memory_free(s->work);
  s->L = (sph_linear_factor){0};
  s->next = NULL;
  s->work = NULL;
  s->room_rows = s->room_entries = 0;
}

static int reserve(ic0 *s, long rows, long entries, sph_error *error)
{
  sph_linear_factor *L = &s->L;
  if (rows <= s->room_rows && entries <= s->room_entries) return SPH_OK;
  factor_free(s);
  rows += rows / 8;
  entries += entries / 8;
  L->start = SPH_NEW(long, rows + 1, "incomplete factors", error);
  L->column = SPH_NEW(int, entries, "incomplete factors", error);
  L->value = SPH_NEW(double, entries, "incomplete factors", error);
  L->diagonal = SPH_NEW(double, rows, "incomplete factors", error);
  s->next = SPH_NEW(long, rows, "incomplete factors", error);
  s->work = SPH_NEW(double, rows, "incomplete factors", error);
  if (!L->start || !L->column || !L->value || !L->diagonal || !s->next || !s->work) {
    factor_free(s);
    return SPH_ERR_MEMORY;
  }
  s->room_rows = rows;
  s->room_entries = entries;
  return SPH_OK;
}

/* The lower half of A into L, taken column by column, as which its rows serve: so the columns of
 * each row come in order. */
static void copy_lower(ic0 *s, const sph_csr *A)
{
  sph_linear_factor *L = &s->L;
  L->n = A->n;
  L->start[0] = 0;
  for (long i = 0; i < A->n; i++) {
    long count = 0;
    for (long k = A->start[i]; k < A->start[i + 1]; k++) count += A->column[k] < i;
    s->next[i] = L->start[i];
    L->start[i + 1] = L->start[i] + count;
  }
  for (long j = 0; j < A->n; j++)
    for (long k = A->start[j]; k < A->start[j + 1]; k++)
      if (A->column[k] > j) {
        long to = s->next[A->column[k]]++;
        L->column[to] = (int)j;
        L->value[to] = A->value[k];
      }
}

/* Row i of L, in place of that of A, from the rows above; 0 if its pivot is not > 0. */
static int factor_row(sph_linear_factor *L, double *w, long i, double diagonal)
{
  const long from = L->start[i], to = L->start[i + 1];
  for (long k = from; k < to; k++) w[L->column[k]] = L->value[k];
  for (long k = from; k < to; k++) {
    const long j = L->column[k];
    double sum = w[j];
    for (long l = L->start[j]; l < L->start[j + 1]; l++) sum -= L->value[l] * w[L->column[l]];
    w[j] = sum * L->diagonal[j];
    diagonal -= w[j] * w[j];
  }
  for (long k = from; k < to; k++) {
    L->value[k] = w[L->column[k]];
    w[L->column[k]] = 0;
  }
  L->diagonal[i] = 1 / sqrt(diagonal);
  return diagonal > 0 && isfinite(diagonal);
}

static int factor_make(ic0 *s, const sph_csr *A, double raise)
{
  copy_lower(s, A);
  for (long i = 0; i < A->n; i++)
    if (!factor_row(&s->L, s->work, i, (1 + raise) * A->diagonal[i])) return 0;
  return 1;
}

/* A number not above the smallest eigenvalue of P^-1 A: as F <= A, that of (F^-1/2 L)(F^-1/2 L)',
 * inverted, and that is bounded by the largest sums of the rows and of the columns of F^-1/2 L. */
static double eigenvalue_bound(ic0 *s, const double *F)
{
  const sph_linear_factor *L = &s->L;
  double rows = 0, columns = 0, *column = s->work;
  for (long i = 0; i < L->n; i++) {
    const double f = 1 / sqrt(F[i]);
    double sum = f / L->diagonal[i];
    column[i] += sum;
    for (long k = L->start[i]; k < L->start[i + 1]; k++) {
      const double l = f * fabs(L->value[k]);
      sum += l;
      column[L->column[k]] += l;
    }
    rows = fmax(rows, sum);
  }
  for (long i = 0; i < L->n; i++) {
    columns = fmax(columns, column[i]);
    column[i] = 0;
  }
  return 1 / (rows * columns);
}

static int create(sph_linear *solver, sph_error *error)
{
  ic0 *s = SPH_NEW(ic0, 1, "incomplete factors", error);
  if (!s) return SPH_ERR_MEMORY;
  solver->own = s;
  s->pcg.factor = &s->L;
  return sph_linear_pcg_create(&s->pcg, solver, error);
}

static int prepare(sph_linear *solver, const sph_csr *A, int change, sph_error *error)
{
  ic0 *s = solver->own;
  int made = 0;
  (void)change;
  int status = sph_linear_pcg_prepare(&s->pcg, A, error);
  if (!status) status = reserve(s, A->n, A->start[A->n] / 2, error);
  if (status) return status;
  solver->stats.factorisations++;
  for (double raise = 0; !made && raise<2; raise = raise> 0 ? 4 * raise : 1e-2)
    made = factor_make(s, A, raise);
  if (!made)
    return sph_linear_refuse(solver, "no incomplete factor exists: the matrix is not finite, or "
                                     "far from positive definite");
  s->pcg.mu = 0.9 * eigenvalue_bound(s, A->floor);
  return SPH_OK;
}

static int solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  ic0 *s = solver->own;
  return sph_linear_pcg_solve(&s->pcg, solver, task, error);
}

static void done(sph_linear *solver)
{
  ic0 *s = solver->own;
  if (!s) return;
  sph_linear_pcg_free(&s->pcg);
  factor_free(s);
  sph_memory_free(s);
}

const sph_linear_method sph_linear_ic0 = {
    .name = "pcg-ic0", .create = create, .prepare = prepare, .solve = solve, .free = done};
