/* The loops over rows, once per instruction set; the compiler makes a copy of each for the widths
 * 1, 2 and 4, in which the columns of a row are one vector of the processor. */
#include "linear_loops.h"

#define LOOP static inline __attribute__((always_inline)) void
#define COLUMNS(c) for (int c = 0; c < W; c++)

/* The entries of row i times x, in four partial sums, which need not wait for each other. */
#define ENTRIES(W, value)                                                                \
  for (; k + 4 <= end; k += 4) {                                                         \
    const double *x0 = x + (long)column[k] * W, *x1 = x + (long)column[k + 1] * W;       \
    const double *x2 = x + (long)column[k + 2] * W, *x3 = x + (long)column[k + 3] * W;   \
    const double v0 = value[k], v1 = value[k + 1], v2 = value[k + 2], v3 = value[k + 3]; \
    COLUMNS(c) s0[c] += v0 * x0[c];                                                      \
    COLUMNS(c) s1[c] += v1 * x1[c];                                                      \
    COLUMNS(c) s2[c] += v2 * x2[c];                                                      \
    COLUMNS(c) s3[c] += v3 * x3[c];                                                      \
  }                                                                                      \
  for (; k < end; k++) {                                                                 \
    const double v0 = value[k], *x0 = x + (long)column[k] * W;                           \
    COLUMNS(c) s0[c] += v0 * x0[c];                                                      \
  }

/* q = A x of row i */
LOOP row(const sph_linear_rows *A, const int W, const int single, const double *restrict x, long i,
         double *restrict q)
{
  const double *restrict value = A->value;
  const float *restrict small = A->single;
  const int *restrict column = A->column;
  const long end = A->end[i];
  long k = A->begin[i];
  double s0[SPH_LINEAR_WIDTH], s1[SPH_LINEAR_WIDTH], s2[SPH_LINEAR_WIDTH], s3[SPH_LINEAR_WIDTH];
  COLUMNS(c) s0[c] = A->diagonal[i] * x[i * W + c];
  COLUMNS(c) s1[c] = s2[c] = s3[c] = 0;
  if (single) {
    ENTRIES(W, small)
  } else {
    ENTRIES(W, value)
  }
  COLUMNS(c) q[c] = (s0[c] + s1[c]) + (s2[c] + s3[c]);
}

LOOP residual(const sph_linear_vectors *v, const int W, const int single, long from, long to)
{
  const sph_linear_rows A = v->A;
  double *restrict r = v->r;
  for (long i = from; i < to; i++) {
    double q[SPH_LINEAR_WIDTH];
    row(&A, W, single, v->x, i, q);
    COLUMNS(c) r[i * W + c] -= q[c];
  }
}

LOOP product(const sph_linear_vectors *v, const int W, const int single, long from, long to,
             double *restrict sum)
{
  const sph_linear_rows A = v->A;
  const double *restrict p = v->p;
  double *restrict to_q = v->q;
  for (long i = from; i < to; i++) {
    double q[SPH_LINEAR_WIDTH];
    row(&A, W, single, p, i, q);
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

/* Diagonals next to which what single precision cannot hold does not count. */
static const double SMALLEST = 1e-18, LARGEST = 1e30;

/* What rounding takes from the sum of a row: its diagonal gets it.  *high: the largest entry. */
static double rounding(const double *restrict value, long n, double *high)
{
  double lost[4] = {0}, most[4] = {0};
  long k = 0;
  for (; k + 4 <= n; k += 4)
    for (int u = 0; u < 4; u++) {
      lost[u] += value[k + u] - (double)(float)value[k + u];
      most[u] = value[k + u] > most[u] ? value[k + u] : most[u];
    }
  for (; k < n; k++) {
    lost[0] += value[k] - (double)(float)value[k];
    most[0] = value[k] > most[0] ? value[k] : most[0];
  }
  for (int u = 0; u < 4; u++) *high = most[u] > *high ? most[u] : *high;
  return (lost[0] + lost[1]) + (lost[2] + lost[3]);
}

static int copy(const sph_linear_copy *to, const sph_csr *A, long first, long last)
{
  int *restrict column = to->column;
  float *restrict value = to->value;
  long at = A->start[first];
  double high = 0;
  int right = 1;
  for (long i = first; i < last; i++) {
    const long begin = A->start[i], end = A->start[i + 1];
    to->begin[i] = at;
    for (long k = begin; k < end; k++) {
      const float single = (float)A->value[k];
      column[at] = A->column[k];
      value[at] = single;
      at += single != 0;
    }
    to->end[i] = at;
    to->diagonal[i] = A->diagonal[i] + rounding(A->value + begin, end - begin, &high);
    right &= A->diagonal[i] > SMALLEST && A->diagonal[i] < LARGEST;
  }
  return right && high <= 0;
}

#define INSTANCE(loop, W)                                                              \
  static void loop##_##W(const sph_linear_vectors *v, long from, long to, double *sum) \
  {                                                                                    \
    loop(v, W, from, to, sum);                                                         \
  }
#define PRODUCTS(W, single)                                                                        \
  static void residual_##single##_##W(const sph_linear_vectors *v, long from, long to,             \
                                      double *sum)                                                 \
  {                                                                                                \
    (void)sum;                                                                                     \
    residual(v, W, single, from, to);                                                              \
  }                                                                                                \
  static void product_##single##_##W(const sph_linear_vectors *v, long from, long to, double *sum) \
  {                                                                                                \
    product(v, W, single, from, to, sum);                                                          \
  }
#define INSTANCES(W)                                                            \
  PRODUCTS(W, 0)                                                                \
  PRODUCTS(W, 1)                                                                \
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

#define ROW(W)                             \
  [W] = {{residual_0_##W, residual_1_##W}, \
         {product_0_##W, product_1_##W},   \
         step_##W,                         \
         step_jacobi_##W,                  \
         dot_##W,                          \
         turn_##W,                         \
         solve_##W}
const sph_linear_table SPH_ISA_NAME(sph_linear_loops) = {copy, {ROW(1), ROW(2), ROW(4)}};
