/* Conjugate gradients preconditioned by an incomplete Cholesky factor P = L L' with the pattern of
 * A (Meijerink & van der Vorst 1977).  It exists where all entries off the diagonal are <= 0; for
 * other matrices the diagonal is raised until it does (Manteuffel 1980).
 *
 * The solves with L go row by row, in one thread; products with A take all. */
#include <math.h>

#include "linear_pcg.h"
#include "memory.h"

/* L by rows: columns in ascending order, the diagonal apart. */
typedef struct factor {
  long n, room_rows, room_entries;
  long *start; /* [n + 1] */
  long *next;  /* [n] scratch */
  int *column;
  double *value;    /* as long; the entries of A until L is made of them */
  double *diagonal; /* [n] 1/L_ii */
  double *work;     /* [n] zero between rows */
} factor;

typedef struct ic0 {
  sph_pcg pcg;
  factor L;
} ic0;

static void factor_free(factor *L)
{
  sph_memory_free(L->start);
  sph_memory_free(L->next);
  sph_memory_free(L->column);
  sph_memory_free(L->value);
  sph_memory_free(L->diagonal);
  sph_memory_free(L->work);
  *L = (factor){0};
}

static int reserve(factor *L, long rows, long entries, sph_error *error)
{
  if (rows <= L->room_rows && entries <= L->room_entries) return SPH_OK;
  factor_free(L);
  rows += rows / 8;
  entries += entries / 8;
  L->start = SPH_NEW(long, rows + 1, "incomplete factors", error);
  L->next = SPH_NEW(long, rows, "incomplete factors", error);
  L->column = SPH_NEW(int, entries, "incomplete factors", error);
  L->value = SPH_NEW(double, entries, "incomplete factors", error);
  L->diagonal = SPH_NEW(double, rows, "incomplete factors", error);
  L->work = SPH_NEW(double, rows, "incomplete factors", error);
  if (!L->start || !L->next || !L->column || !L->value || !L->diagonal || !L->work) {
    factor_free(L);
    return SPH_ERR_MEMORY;
  }
  L->room_rows = rows;
  L->room_entries = entries;
  return SPH_OK;
}

/* The lower half of A, taken column by column (which are rows, too), so that rows come in order. */
static void copy_lower(factor *L, const sph_csr *A)
{
  L->n = A->n;
  L->start[0] = 0;
  for (long i = 0; i < A->n; i++) {
    long count = 0;
    for (long k = A->start[i]; k < A->start[i + 1]; k++) count += A->column[k] < i;
    L->next[i] = L->start[i];
    L->start[i + 1] = L->start[i] + count;
  }
  for (long j = 0; j < A->n; j++)
    for (long k = A->start[j]; k < A->start[j + 1]; k++)
      if (A->column[k] > j) {
        long to = L->next[A->column[k]]++;
        L->column[to] = (int)j;
        L->value[to] = A->value[k];
      }
}

/* Row i of L from the rows above; 0 if its pivot is not > 0. */
static int factor_row(factor *L, long i, double diagonal)
{
  double *w = L->work;
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

static int factor_make(factor *L, const sph_csr *A, double raise)
{
  copy_lower(L, A);
  for (long i = 0; i < L->n; i++)
    if (!factor_row(L, i, (1 + raise) * A->diagonal[i])) return 0;
  return 1;
}

/* A number not above the smallest eigenvalue of P^-1 A: as F <= A, that of (F^-1/2 L)(F^-1/2 L)',
 * inverted, and that is bounded by the largest sums of the rows and of the columns of F^-1/2 L. */
static double eigenvalue_bound(factor *L, const double *F)
{
  double rows = 0, columns = 0, *column = L->work;
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

/* z = (L L')^-1 r */
static inline __attribute__((always_inline)) void solve_columns(const sph_pcg *s, const int d)
{
  const factor *L = s->preconditioner;
  double *z = s->z;
  for (long i = 0; i < L->n; i++) {
    double sum[SPH_PCG_COLUMNS];
    for (int c = 0; c < d; c++) sum[c] = s->r[i * d + c];
    for (long k = L->start[i]; k < L->start[i + 1]; k++)
      for (int c = 0; c < d; c++) sum[c] -= L->value[k] * z[(long)L->column[k] * d + c];
    for (int c = 0; c < d; c++) z[i * d + c] = sum[c] * L->diagonal[i];
  }
  for (long i = L->n - 1; i >= 0; i--) {
    for (int c = 0; c < d; c++) z[i * d + c] *= L->diagonal[i];
    for (long k = L->start[i]; k < L->start[i + 1]; k++)
      for (int c = 0; c < d; c++) z[(long)L->column[k] * d + c] -= L->value[k] * z[i * d + c];
  }
}

static void apply(const sph_pcg *s)
{
  switch (s->d) {
  case 1: solve_columns(s, 1); break;
  case 2: solve_columns(s, 2); break;
  case 3: solve_columns(s, 3); break;
  default: solve_columns(s, SPH_PCG_COLUMNS); break;
  }
}

static int create(sph_linear *solver, sph_error *error)
{
  ic0 *s = SPH_NEW(ic0, 1, "incomplete factors", error);
  if (!s) return SPH_ERR_MEMORY;
  s->pcg.threads = solver->threads;
  s->pcg.apply = apply;
  s->pcg.preconditioner = &s->L;
  solver->own = s;
  return SPH_OK;
}

static int prepare(sph_linear *solver, const sph_csr *A, int change, sph_error *error)
{
  ic0 *s = solver->own;
  int made = 0;
  (void)change;
  int status = sph_linear_pcg_prepare(&s->pcg, A, error);
  if (!status) status = reserve(&s->L, A->n, A->start[A->n] / 2, error);
  if (status) return status;
  solver->stats.factorisations++;
  for (double raise = 0; !made && raise<2; raise = raise> 0 ? 4 * raise : 1e-2)
    made = factor_make(&s->L, A, raise);
  if (!made)
    return sph_linear_refuse(solver, "no incomplete factor exists: the matrix is not finite, or "
                                     "far from positive definite");
  s->pcg.mu = 0.9 * eigenvalue_bound(&s->L, A->floor);
  return SPH_OK;
}

static int solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  ic0 *s = solver->own;
  (void)error;
  return sph_linear_pcg_solve(&s->pcg, solver, task);
}

static void done(sph_linear *solver)
{
  ic0 *s = solver->own;
  if (!s) return;
  sph_linear_pcg_free(&s->pcg);
  factor_free(&s->L);
  sph_memory_free(s);
}

const sph_linear_method sph_linear_pcg_ic0 = {
    .name = "pcg-ic0", .create = create, .prepare = prepare, .solve = solve, .free = done};
