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
  MOST = SPH_LINEAR_WIDTH
};
/* mu is somewhat less than the bound of the eigenvalue: uniform x may attain that, and D is to
 * stay > 0. */
static const double BELOW = 0.9;

#define COLUMNS(c) for (int c = 0; c < d; c++)

/* A loop over all chunks; the sums of all rows, if it has some, in total. */
static void run(const sph_pcg *s, sph_linear_loop *loop, double total[MOST])
{
#pragma omp parallel for num_threads(s->threads) schedule(static) if (s->n >= PARALLEL_MIN)
  for (long k = 0; k < s->chunks; k++) {
    double sum[MOST] = {0};
    long end = (k + 1) * CHUNK < s->n ? (k + 1) * CHUNK : s->n;
    loop(&s->v, k * CHUNK, end, sum);
    for (int c = 0; c < MOST; c++) s->part[k * MOST + c] = sum[c];
  }
  for (int c = 0; c < MOST; c++) total[c] = 0;
  for (long k = 0; k < s->chunks; k++)
    for (int c = 0; c < MOST; c++) total[c] += s->part[k * MOST + c];
}

/* x += alpha p, r -= alpha q, z = P^-1 r, rho = r.z */
static void step(const sph_pcg *s, double rho[MOST])
{
  if (!s->factor) {
    run(s, s->loops->step_jacobi, rho);
    return;
  }
  run(s, s->loops->step, rho);
  s->loops->solve(s->factor, s->v.r, s->v.z);
  run(s, s->loops->dot, rho);
}

/* ---- one run: up to SPH_LINEAR_WIDTH columns */

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

/* *size: the square of the largest error that x = 0 can have, as bounded. */
static void estimate_start(estimate *error, const sph_pcg *s, const sph_linear_task *task,
                           int first, double *size)
{
  const double *F = task->A->floor;
  *size = 0;
  for (int c = 0; c < s->d; c++) {
    const double *w = task->weight ? task->weight[first + c] : NULL, *b = task->b[first + c];
    double most = 0, sum = 0;
    for (long i = 0; i < s->n; i++) {
      most = fmax(most, w ? w[i] * w[i] / F[i] : 1 / F[i]);
      sum += b[i] * b[i] / F[i];
    }
    error->scale[c] = most;
    error->g[c] = 1 / s->mu;
    *size += most * sum;
  }
  error->allowed = task->tolerance * task->tolerance * (double)s->n * s->d;
}

/* Takes the copy for what comes, if it is exact enough for an x that is bounded by `size`: it may
 * have a tenth of the error that is allowed. */
static int choose_rows(sph_pcg *s, const sph_linear_task *task, estimate *error, double size,
                       sph_error *failure)
{
  const double share = 0.1, lost = SPH_LINEAR_COPY_ERROR * SPH_LINEAR_COPY_ERROR * size;
  s->single = lost < share * share * error->allowed;
  if (s->single && !s->copied) {
    int status = sph_linear_rows_copy(&s->copy, task->A, s->isa, s->threads, failure);
    if (status) return status;
    s->copied = 1;
  }
  s->single = s->single && s->copy.right;
  s->v.A = s->single ? sph_linear_rows_single(&s->copy) : sph_linear_rows_exact(task->A);
  if (s->single) error->allowed *= (1 - share) * (1 - share);
  return SPH_OK;
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

/* r = b - A x, z = P^-1 r.  The copy serves from here on, or behind this, where only the change of
 * x is left to find. */
static int begin(sph_pcg *s, const sph_linear_task *task, estimate *error, double size,
                 double rho[MOST], sph_error *failure)
{
  int status = choose_rows(s, task, error, size, failure);
  if (status) return status;
  run(s, s->loops->residual[s->single], rho);
  step(s, rho); /* with alpha = 0 */
  const double now = estimate_get(error, rho, s->d);
  if (s->single || now <= error->allowed) return SPH_OK;
  return choose_rows(s, task, error, now, failure);
}

static int iterate(sph_pcg *s, sph_linear *solver, estimate *error, double rho[MOST])
{
  const int d = s->d;
  double pq[MOST], next[MOST], now;
  const long most = most_iterations(s, fmax(1, estimate_get(error, rho, d) / error->allowed));
  for (long k = 0; !((now = estimate_get(error, rho, d)) <= error->allowed); k++) {
    if (!isfinite(now))
      return sph_linear_refuse(solver, "a number is not finite: the error is bounded by %g", now);
    if (k == most)
      return sph_linear_refuse(
          solver, "%ld iterations were not enough: the error is bounded by %g times the tolerance",
          k, sqrt(now / error->allowed));
    run(s, s->loops->turn, next);
    run(s, s->loops->product[s->single], pq);
    COLUMNS(c)
    {
      int done = rho[c] <= DBL_MIN; /* of this column there is nothing left to improve */
      if (!done && !(pq[c] > 0 && isfinite(pq[c]))) return not_definite(solver, pq[c], rho[c], c);
      s->v.alpha[c] = done ? 0 : rho[c] / pq[c];
    }
    step(s, next);
    solver->stats.iterations++;
    solver->stats.last++;
    COLUMNS(c)
    {
      double D = fmax(error->g[c] - s->v.alpha[c], 0);
      s->v.beta[c] = rho[c] <= DBL_MIN ? 0 : next[c] / rho[c];
      error->g[c] = D > 0 ? D / (s->mu * D + s->v.beta[c]) : 0;
      rho[c] = next[c];
    }
  }
  return SPH_OK;
}

static void interleave(const sph_pcg *s, double *to, const double *const *from)
{
  for (long i = 0; i < s->n; i++) {
    for (int c = 0; c < s->d; c++) to[i * s->width + c] = from[c][i];
    for (int c = s->d; c < s->width; c++) to[i * s->width + c] = 0;
  }
}

/* Columns first .. first + d - 1, into the vectors; p and q are zero. */
static void load(sph_pcg *s, const sph_linear_task *task, int first)
{
  s->d = task->columns - first < MOST ? task->columns - first : MOST;
  s->width = sph_linear_loop_width(s->d);
  s->loops = sph_linear_loop_get(s->isa, s->width);
  interleave(s, s->v.r, task->b + first);
  interleave(s, s->v.x, (const double *const *)task->x + first);
  memset(s->v.p, 0, (size_t)(s->n * s->width) * sizeof *s->v.p);
  memset(s->v.q, 0, (size_t)(s->n * s->width) * sizeof *s->v.q);
  for (int c = 0; c < MOST; c++) s->v.alpha[c] = s->v.beta[c] = 0;
}

int sph_linear_pcg_solve(sph_pcg *s, sph_linear *solver, const sph_linear_task *task,
                         sph_error *failure)
{
  int status = SPH_OK;
  for (int first = 0; !status && first < task->columns; first += MOST) {
    estimate error = {.allowed = 0};
    double size, rho[MOST] = {0};
    load(s, task, first);
    estimate_start(&error, s, task, first, &size);
    status = begin(s, task, &error, size, rho, failure);
    if (!status) status = iterate(s, solver, &error, rho);
    for (long i = 0; !status && i < s->n; i++)
      for (int c = 0; c < s->d; c++) task->x[first + c][i] = s->v.x[i * s->width + c];
  }
  return status;
}

static int reserve(sph_pcg *s, long rows, sph_error *error)
{
  if (rows <= s->room) return SPH_OK;
  sph_linear_pcg_free(s);
  rows += rows / 8;
  s->inverse = SPH_NEW(double, rows, "inverse of a diagonal", error);
  s->v.x = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->v.r = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->v.z = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->v.p = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->v.q = SPH_NEW(double, rows *MOST, "conjugate gradients", error);
  s->part = SPH_NEW(double, (rows / CHUNK + 1) * MOST, "partial sums", error);
  if (!s->inverse || !s->v.x || !s->v.r || !s->v.z || !s->v.p || !s->v.q || !s->part) {
    sph_linear_pcg_free(s);
    return SPH_ERR_MEMORY;
  }
  s->v.inverse = s->inverse;
  s->room = rows;
  return SPH_OK;
}

int sph_linear_pcg_create(sph_pcg *s, const sph_linear *solver, sph_error *error)
{
  s->threads = solver->threads;
  s->isa = sph_cpu_isa(NULL, error);
  return s->isa < 0 ? SPH_ERR_ARGUMENT : SPH_OK;
}

int sph_linear_pcg_prepare(sph_pcg *s, const sph_csr *A, sph_error *error)
{
  int status = reserve(s, A->n, error);
  if (status) return status;
  s->n = A->n;
  s->copied = 0;
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
  sph_memory_free(s->v.x);
  sph_memory_free(s->v.r);
  sph_memory_free(s->v.z);
  sph_memory_free(s->v.p);
  sph_memory_free(s->v.q);
  sph_memory_free(s->part);
  sph_linear_rows_free(&s->copy);
  s->v = (sph_linear_vectors){0};
  s->inverse = s->part = NULL;
  s->room = 0;
}

/* ---- the method with P = the diagonal */

static int create(sph_linear *solver, sph_error *error)
{
  sph_pcg *s = SPH_NEW(sph_pcg, 1, "conjugate gradients", error);
  if (!s) return SPH_ERR_MEMORY;
  solver->own = s;
  return sph_linear_pcg_create(s, solver, error);
}

static int prepare(sph_linear *solver, const sph_csr *A, int change, sph_error *error)
{
  (void)change;
  return sph_linear_pcg_prepare(solver->own, A, error);
}

static int solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  return sph_linear_pcg_solve(solver->own, solver, task, error);
}

static void done(sph_linear *solver)
{
  if (solver->own) sph_linear_pcg_free(solver->own);
  sph_memory_free(solver->own);
}

const sph_linear_method sph_linear_pcg_jacobi = {
    .name = "pcg-jacobi", .create = create, .prepare = prepare, .solve = solve, .free = done};
