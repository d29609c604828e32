/* Preconditioned conjugate gradients (Hestenes & Stiefel 1952) for several right-hand sides at
 * once: each has its own iteration, they share the products with A, and their vectors are stored
 * side by side.
 *
 * The error is bounded as it falls: for mu below the smallest eigenvalue of P^-1 A,
 *
 *   |e_k|_A^2 <= g_k r_k.z_k,   g_0 = 1/mu,   g_k+1 = D/(mu D + beta_k+1),   D = g_k - alpha_k
 *
 * (Gauss-Radau quadrature: Meurant & Tichy 2013, Numer. Algorithms 62), and with F = diag(floor)
 * <= A the sum of (w e)^2 is at most max(w^2/F) |e|_A^2.
 *
 * Rows go in chunks; sums are made chunk by chunk, then added in order. */
#include "linear_pcg.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "memory.h"

enum {
  CHUNK = 1024,        /* rows */
  PARALLEL_MIN = 4096, /* rows from which on threads pay */
  MOST = SPH_PCG_COLUMNS
};
/* mu is somewhat less than the bound of the eigenvalue: uniform x may attain that, and D is to
 * stay > 0. */
static const double BELOW = 0.9;

/* ---- kernels over rows from..to; the compiler makes a copy for each d; sum[d] is added to */

#define KERNEL static inline __attribute__((always_inline)) void
#define COLUMNS(c) for (int c = 0; c < d; c++)

/* q = A x of one row */
KERNEL row(const sph_csr *A, const int d, const double *x, long i, double q[MOST])
{
  COLUMNS(c) q[c] = A->diagonal[i] * x[i * d + c];
  for (long k = A->start[i]; k < A->start[i + 1]; k++)
    COLUMNS(c) q[c] += A->value[k] * x[(long)A->column[k] * d + c];
}

/* r = b - A x, b being where r will be */
KERNEL residual(const sph_pcg *s, const int d, long from, long to, double *sum)
{
  (void)sum;
  for (long i = from; i < to; i++) {
    double q[MOST];
    row(s->A, d, s->x, i, q);
    COLUMNS(c) s->r[i * d + c] -= q[c];
  }
}

/* q = A p; sum of p.q */
KERNEL product(const sph_pcg *s, const int d, long from, long to, double *sum)
{
  for (long i = from; i < to; i++) {
    double q[MOST];
    row(s->A, d, s->p, i, q);
    COLUMNS(c) s->q[i * d + c] = q[c];
    COLUMNS(c) sum[c] += s->p[i * d + c] * q[c];
  }
}

/* x += alpha p, r -= alpha q */
KERNEL step(const sph_pcg *s, const int d, long from, long to, double *sum)
{
  (void)sum;
  for (long i = from; i < to; i++) {
    COLUMNS(c) s->x[i * d + c] += s->alpha[c] * s->p[i * d + c];
    COLUMNS(c) s->r[i * d + c] -= s->alpha[c] * s->q[i * d + c];
  }
}

/* sum of r.z; four partial sums, which need not wait for each other */
KERNEL dot(const sph_pcg *s, const int d, long from, long to, double *sum)
{
  double part[4][MOST] = {{0}};
  long i = from;
  for (; i + 4 <= to; i += 4)
    for (int u = 0; u < 4; u++)
      COLUMNS(c) part[u][c] += s->r[(i + u) * d + c] * s->z[(i + u) * d + c];
  for (int u = 0; i + u < to; u++)
    COLUMNS(c) part[u][c] += s->r[(i + u) * d + c] * s->z[(i + u) * d + c];
  COLUMNS(c) sum[c] += (part[0][c] + part[2][c]) + (part[1][c] + part[3][c]);
}

/* z = r/diagonal; sum of r.z */
KERNEL jacobi(const sph_pcg *s, const int d, long from, long to, double *sum)
{
  for (long i = from; i < to; i++) COLUMNS(c) s->z[i * d + c] = s->inverse[i] * s->r[i * d + c];
  dot(s, d, from, to, sum);
}

KERNEL step_jacobi(const sph_pcg *s, const int d, long from, long to, double *sum)
{
  step(s, d, from, to, sum);
  jacobi(s, d, from, to, sum);
}

/* p = z + beta p */
KERNEL turn(const sph_pcg *s, const int d, long from, long to, double *sum)
{
  (void)sum;
  for (long i = from; i < to; i++)
    COLUMNS(c) s->p[i * d + c] = s->z[i * d + c] + s->beta[c] * s->p[i * d + c];
}

static void run(const sph_pcg *s, void (*chunk)(const sph_pcg *, long, long, double *),
                double total[MOST])
{
#pragma omp parallel for num_threads(s->threads) schedule(static) if (s->n >= PARALLEL_MIN)
  for (long k = 0; k < s->chunks; k++) {
    double sum[MOST] = {0};
    long end = (k + 1) * CHUNK < s->n ? (k + 1) * CHUNK : s->n;
    chunk(s, k * CHUNK, end, sum);
    for (int c = 0; c < s->d; c++) s->part[k * MOST + c] = sum[c];
  }
  for (int c = 0; c < s->d; c++) total[c] = 0;
  for (long k = 0; k < s->chunks; k++)
    for (int c = 0; c < s->d; c++) total[c] += s->part[k * MOST + c];
}

/* run_<kernel>: over all chunks, with the sums of all rows in total[d]. */
#define RUN(kernel)                                                             \
  static void chunk_##kernel(const sph_pcg *s, long from, long to, double *sum) \
  {                                                                             \
    switch (s->d) {                                                             \
    case 1: kernel(s, 1, from, to, sum); break;                                 \
    case 2: kernel(s, 2, from, to, sum); break;                                 \
    case 3: kernel(s, 3, from, to, sum); break;                                 \
    default: kernel(s, MOST, from, to, sum); break;                             \
    }                                                                           \
  }                                                                             \
  static void run_##kernel(const sph_pcg *s, double *total) { run(s, chunk_##kernel, total); }

RUN(residual)
RUN(product)
RUN(step)
RUN(dot)
RUN(jacobi)
RUN(step_jacobi)
RUN(turn)

/* z = P^-1 r and rho = r.z */
static void precondition(const sph_pcg *s, double rho[MOST])
{
  if (!s->apply) {
    run_jacobi(s, rho);
    return;
  }
  s->apply(s);
  run_dot(s, rho);
}

static void step_and_precondition(const sph_pcg *s, double rho[MOST])
{
  if (!s->apply) {
    run_step_jacobi(s, rho);
    return;
  }
  run_step(s, rho);
  precondition(s, rho);
}

/* ---- one run: up to SPH_PCG_COLUMNS columns */

typedef struct estimate {
  double scale[MOST]; /* max w^2/F */
  double g[MOST];
  double allowed; /* sum over columns of scale |e|_A^2 */
} estimate;

static double estimate_get(const estimate *error, const double rho[MOST], int d)
{
  double sum = 0;
  COLUMNS(c) sum += error->scale[c] * error->g[c] * rho[c];
  return sum;
}

static void estimate_start(estimate *error, const sph_pcg *s, const sph_linear_task *task,
                           int first)
{
  const double *F = s->A->floor;
  for (int c = 0; c < s->d; c++) {
    const double *w = task->weight ? task->weight[first + c] : NULL;
    double most = 0;
    for (long i = 0; i < s->n; i++) most = fmax(most, w ? w[i] * w[i] / F[i] : 1 / F[i]);
    error->scale[c] = most;
    error->g[c] = 1 / s->mu;
  }
  error->allowed = task->tolerance * task->tolerance * (double)s->n * s->d;
}

/* Twice the iterations after which theory has the error below tolerance, for eigenvalues of P^-1 A
 * up to 4, and rounding. */
static long most_iterations(const sph_pcg *s, double factor)
{
  double most = 50 + 2 / sqrt(s->mu) * log(2 * sqrt(factor));
  return (long)fmin(most, 50 + 10 * (double)s->n);
}

static int not_definite(sph_linear *solver, double pq, double rho, int column)
{
  return sph_linear_refuse(solver,
                           "the matrix is not positive definite, or not finite: p.Ap = %g, "
                           "r.z = %g in iteration %ld, column %d",
                           pq, rho, solver->stats.last, column);
}

static int iterate(sph_pcg *s, sph_linear *solver, estimate *error)
{
  const int d = s->d;
  double rho[MOST], pq[MOST], next[MOST], now;
  run_residual(s, next);
  COLUMNS(c) s->beta[c] = 0;
  precondition(s, rho);
  long most = most_iterations(s, fmax(1, estimate_get(error, rho, d) / error->allowed));
  for (long k = 0; !((now = estimate_get(error, rho, d)) <= error->allowed); k++) {
    if (!isfinite(now))
      return sph_linear_refuse(solver, "a number is not finite: the error is bounded by %g", now);
    if (k == most)
      return sph_linear_refuse(
          solver, "%ld iterations were not enough: the error is bounded by %g times the tolerance",
          k, sqrt(now / error->allowed));
    run_turn(s, next);
    run_product(s, pq);
    COLUMNS(c)
    {
      int done = rho[c] <= DBL_MIN; /* of this column there is nothing left to improve */
      if (!done && !(pq[c] > 0 && isfinite(pq[c]))) return not_definite(solver, pq[c], rho[c], c);
      s->alpha[c] = done ? 0 : rho[c] / pq[c];
    }
    step_and_precondition(s, next);
    solver->stats.iterations++;
    solver->stats.last++;
    COLUMNS(c)
    {
      double D = fmax(error->g[c] - s->alpha[c], 0);
      s->beta[c] = rho[c] <= DBL_MIN ? 0 : next[c] / rho[c];
      error->g[c] = D > 0 ? D / (s->mu * D + s->beta[c]) : 0;
      rho[c] = next[c];
    }
  }
  return SPH_OK;
}

static void interleave(const sph_pcg *s, double *to, const double *const *from)
{
  for (long i = 0; i < s->n; i++)
    for (int c = 0; c < s->d; c++) to[i * s->d + c] = from[c][i];
}

int sph_linear_pcg_solve(sph_pcg *s, sph_linear *solver, const sph_linear_task *task)
{
  int status = SPH_OK;
  s->A = task->A;
  for (int first = 0; !status && first < task->columns; first += MOST) {
    estimate error;
    double *const *x = task->x + first;
    s->d = task->columns - first < MOST ? task->columns - first : MOST;
    memset(s->p, 0, (size_t)(s->n * s->d) * sizeof *s->p);
    interleave(s, s->r, task->b + first);
    interleave(s, s->x, (const double *const *)x);
    estimate_start(&error, s, task, first);
    status = iterate(s, solver, &error);
    for (long i = 0; !status && i < s->n; i++)
      for (int c = 0; c < s->d; c++) x[c][i] = s->x[i * s->d + c];
  }
  return status;
}

static int reserve(sph_pcg *s, long rows, sph_error *error)
{
  if (rows <= s->room) return SPH_OK;
  sph_linear_pcg_free(s);
  rows += rows / 8;
  s->inverse = SPH_NEW(double, rows, "inverse of a diagonal", error);
  s->x = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->r = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->z = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->p = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->q = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->part = SPH_NEW(double, (rows / CHUNK + 1) * MOST, "partial sums", error);
  if (!s->inverse || !s->x || !s->r || !s->z || !s->p || !s->q || !s->part) {
    sph_linear_pcg_free(s);
    return SPH_ERR_MEMORY;
  }
  s->room = rows;
  return SPH_OK;
}

int sph_linear_pcg_prepare(sph_pcg *s, const sph_csr *A, sph_error *error)
{
  int status = reserve(s, A->n, error);
  if (status) return status;
  s->n = A->n;
  s->chunks = (A->n + CHUNK - 1) / CHUNK;
  s->mu = 1;
  for (long i = 0; i < A->n; i++) {
    s->inverse[i] = 1 / A->diagonal[i];
    s->mu = fmin(s->mu, A->floor[i] * s->inverse[i]);
  }
  s->mu *= BELOW;
  return SPH_OK;
}

void sph_linear_pcg_free(sph_pcg *s)
{
  sph_memory_free(s->inverse);
  sph_memory_free(s->x);
  sph_memory_free(s->r);
  sph_memory_free(s->z);
  sph_memory_free(s->p);
  sph_memory_free(s->q);
  sph_memory_free(s->part);
  s->inverse = s->x = s->r = s->z = s->p = s->q = s->part = NULL;
  s->room = 0;
}

/* ---- the method with P = the diagonal */

static int create(sph_linear *solver, sph_error *error)
{
  sph_pcg *s = SPH_NEW(sph_pcg, 1, "conjugate gradients", error);
  if (!s) return SPH_ERR_MEMORY;
  s->threads = solver->threads;
  solver->own = s;
  return SPH_OK;
}

static int prepare(sph_linear *solver, const sph_csr *A, int change, sph_error *error)
{
  (void)change;
  return sph_linear_pcg_prepare(solver->own, A, error);
}

static int solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  (void)error;
  return sph_linear_pcg_solve(solver->own, solver, task);
}

static void done(sph_linear *solver)
{
  if (solver->own) sph_linear_pcg_free(solver->own);
  sph_memory_free(solver->own);
}

const sph_linear_method sph_linear_pcg_jacobi = {
    .name = "pcg-jacobi", .create = create, .prepare = prepare, .solve = solve, .free = done};
