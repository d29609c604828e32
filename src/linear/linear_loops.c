/* The loops over rows, once per instruction set; the compiler makes a copy of each for the widths
 * 1, 2 and 4, in which the columns of a row are one vector of the processor. */
#include "linear_loops.h"

#define LOOP static inline __attribute__((always_inline)) void
#define COLUMNS(c) for (int c = 0; c < W; c++)

/* q = A x of row i; two partial sums, which need not wait for each other */
LOOP row(const sph_csr *A, const int W, const double *restrict x, long i, double *restrict q)
{
  const double *restrict value = A->value;
  const int *restrict column = A->column;
  const long end = A->start[i + 1];
  long k = A->start[i];
  double a[SPH_LINEAR_WIDTH], b[SPH_LINEAR_WIDTH];
  COLUMNS(c) a[c] = A->diagonal[i] * x[i * W + c];
  COLUMNS(c) b[c] = 0;
  for (; k + 2 <= end; k += 2) {
    const double *x0 = x + (long)column[k] * W, *x1 = x + (long)column[k + 1] * W;
    COLUMNS(c) a[c] += value[k] * x0[c];
    COLUMNS(c) b[c] += value[k + 1] * x1[c];
  }
  if (k < end) COLUMNS(c) a[c] += value[k] * x[(long)column[k] * W + c];
  COLUMNS(c) q[c] = a[c] + b[c];
}

LOOP residual(const sph_linear_vectors *v, const int W, long from, long to, double *sum)
{
  double *restrict r = v->r;
  (void)sum;
  for (long i = from; i < to; i++) {
    double q[SPH_LINEAR_WIDTH];
    row(v->A, W, v->x, i, q);
    COLUMNS(c) r[i * W + c] -= q[c];
  }
}

LOOP product(const sph_linear_vectors *v, const int W, long from, long to, double *restrict sum)
{
  const double *restrict p = v->p;
  double *restrict to_q = v->q;
  for (long i = from; i < to; i++) {
    double q[SPH_LINEAR_WIDTH];
    row(v->A, W, p, i, q);
    COLUMNS(c) to_q[i * W + c] = q[c];
    COLUMNS(c) sum[c] += p[i * W + c] * q[c];
  }
}

LOOP step(const sph_linear_vectors *v, const int W, long from, long to, double *sum)
{
  const double *restrict p = v->p, *restrict q = v->q;
  double *restrict x = v->x, *restrict r = v->r;
  double alpha[SPH_LINEAR_WIDTH];
  (void)sum;
  COLUMNS(c) alpha[c] = v->alpha[c];
  for (long i = from; i < to; i++) {
    COLUMNS(c) x[i * W + c] += alpha[c] * p[i * W + c];
    COLUMNS(c) r[i * W + c] -= alpha[c] * q[i * W + c];
  }
}

LOOP dot(const sph_linear_vectors *v, const int W, long from, long to, double *restrict sum)
{
  const double *restrict r = v->r, *restrict z = v->z;
  double a[SPH_LINEAR_WIDTH] = {0}, b[SPH_LINEAR_WIDTH] = {0};
  long i = from;
  for (; i + 2 <= to; i += 2) {
    COLUMNS(c) a[c] += r[i * W + c] * z[i * W + c];
    COLUMNS(c) b[c] += r[i * W + W + c] * z[i * W + W + c];
  }
  if (i < to) COLUMNS(c) a[c] += r[i * W + c] * z[i * W + c];
  COLUMNS(c) sum[c] += a[c] + b[c];
}

LOOP step_jacobi(const sph_linear_vectors *v, const int W, long from, long to, double *sum)
{
  const double *restrict r = v->r, *restrict inverse = v->inverse;
  double *restrict z = v->z;
  step(v, W, from, to, sum);
  for (long i = from; i < to; i++) COLUMNS(c) z[i * W + c] = inverse[i] * r[i * W + c];
  dot(v, W, from, to, sum);
}

LOOP turn(const sph_linear_vectors *v, const int W, long from, long to, double *sum)
{
  const double *restrict z = v->z;
  double *restrict p = v->p;
  double beta[SPH_LINEAR_WIDTH];
  (void)sum;
  COLUMNS(c) beta[c] = v->beta[c];
  for (long i = from; i < to; i++) COLUMNS(c) p[i * W + c] = z[i * W + c] + beta[c] * p[i * W + c];
}

LOOP solve(const sph_linear_factor *L, const int W, const double *restrict r, double *z)
{
  const double *restrict value = L->value;
  const int *restrict column = L->column;
  for (long i = 0; i < L->n; i++) {
    double a[SPH_LINEAR_WIDTH];
    COLUMNS(c) a[c] = r[i * W + c];
    for (long k = L->start[i]; k < L->start[i + 1]; k++)
      COLUMNS(c) a[c] -= value[k] * z[(long)column[k] * W + c];
    COLUMNS(c) z[i * W + c] = a[c] * L->diagonal[i];
  }
  for (long i = L->n - 1; i >= 0; i--) {
    double a[SPH_LINEAR_WIDTH];
    COLUMNS(c) a[c] = z[i * W + c] * L->diagonal[i];
    for (long k = L->start[i]; k < L->start[i + 1]; k++)
      COLUMNS(c) z[(long)column[k] * W + c] -= value[k] * a[c];
    COLUMNS(c) z[i * W + c] = a[c];
  }
}

#define INSTANCE(loop, W)                                                              \
  static void loop##_##W(const sph_linear_vectors *v, long from, long to, double *sum) \
  {                                                                                    \
    loop(v, W, from, to, sum);                                                         \
  }
#define INSTANCES(W)                                                            \
  INSTANCE(residual, W)                                                         \
  INSTANCE(product, W)                                                          \
  INSTANCE(step, W)                                                             \
  INSTANCE(step_jacobi, W)                                                      \
  INSTANCE(dot, W)                                                              \
  INSTANCE(turn, W)                                                             \
  static void solve_##W(const sph_linear_factor *L, const double *r, double *z) \
  {                                                                             \
    solve(L, W, r, z);                                                          \
  }
INSTANCES(1)
INSTANCES(2)
INSTANCES(4)

#define ROW(W) \
  [W] = {residual_##W, product_##W, step_##W, step_jacobi_##W, dot_##W, turn_##W, solve_##W}
const sph_linear_table SPH_ISA_NAME(sph_linear_loops) = {{ROW(1), ROW(2), ROW(4)}};
