/* Linear solvers on the matrices of implicit viscosity and conduction, M + gamma L, L as of
 * Brookshaw's Laplacian: periodic jittered lattices, Wendland C2, h = 1.5 dx, as many right-hand
 * sides as dimensions.  The condition number is bounded by the largest row sum of |A| over m.
 *
 * Three figures a method: `pattern`, the first solve; `values`, one with new values in the same
 * pattern; `solve`, one more with the same matrix.  The guess is the right-hand side over m, the
 * tolerance 1e-5 of the size of the solution.  docs/linear-solvers.md has the table, and what
 * "auto" makes of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "linear.h"

enum { REPEATS = 3, REACH = 4 };

static const double TOO_LONG = 1; /* seconds: larger matrices are not tried */

typedef struct lattice {
  int dim, across;
  long n;
  double *x[3];
} lattice;

typedef struct linear_system {
  lattice lattice;
  sph_csr A;
  double *b[3], *x[3];
} linear_system;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

static void *array(long n, size_t size)
{
  void *memory = calloc((size_t)n, size);
  if (!memory) bench_complain("out of memory"), exit(1);
  return memory;
}

/* ---- the matrix */

static void place(lattice *l)
{
  unsigned state = 1;
  l->n = 1;
  for (int d = 0; d < l->dim; d++) l->n *= l->across;
  for (int d = 0; d < 3; d++) l->x[d] = array(l->n, sizeof(double));
  for (long i = 0; i < l->n; i++)
    for (long d = 0, rest = i; d < l->dim; d++, rest /= l->across)
      l->x[d][i] = (double)(rest % l->across) + 0.4 * noise(&state);
}

/* -F of Wendland C2 at h = 1.5, over its largest value */
static double weight(const lattice *l, long i, long j)
{
  double r2 = 0;
  for (int d = 0; d < l->dim; d++) {
    double gap = fabs(l->x[d][i] - l->x[d][j]);
    gap = fmin(gap, l->across - gap);
    r2 += gap * gap;
  }
  double t = 1 - sqrt(r2) / 3;
  return t > 0 ? (l->dim == 1 ? t * t : t * t * t) : 0;
}

/* The place of a neighbour, `offset` away in steps of the lattice. */
static long neighbor(const lattice *l, long i, const int offset[3])
{
  long j = 0, stride = 1, rest = i;
  for (int d = 0; d < l->dim; d++, rest /= l->across, stride *= l->across)
    j += (rest % l->across + offset[d] + l->across) % l->across * stride;
  return j;
}

static void add_row(sph_csr *A, const lattice *l, long i)
{
  long k = A->start[i];
  int o[3];
  const int ry = l->dim > 1 ? REACH : 0, rz = l->dim > 2 ? REACH : 0;
  for (o[2] = -rz; o[2] <= rz; o[2]++)
    for (o[1] = -ry; o[1] <= ry; o[1]++)
      for (o[0] = -REACH; o[0] <= REACH; o[0]++) {
        long j = neighbor(l, i, o);
        double w = j == i ? 0 : weight(l, i, j);
        if (w == 0) continue;
        A->column[k] = (int)j;
        A->value[k++] = w;
      }
  A->start[i + 1] = k;
}

/* Unit masses: A = I + gamma L. */
static void fill(linear_system *s)
{
  static const long entries[] = {0, 8, 40, 150};
  sph_error error = {0};
  sph_csr *A = &s->A;
  const lattice *l = &s->lattice;
  if (sph_csr_reserve(A, l->n, l->n * entries[l->dim], &error))
    bench_complain("%s", error.text), exit(1);
  A->n = l->n;
  for (long i = 0; i < l->n; i++) add_row(A, l, i);
}

static double row_sum(const sph_csr *A, long i)
{
  double sum = 0;
  for (long k = A->start[i]; k < A->start[i + 1]; k++) sum += fabs(A->value[k]);
  return sum;
}

/* Scales L so that the largest row sum of A is `condition`. */
static void scale(sph_csr *A, double condition)
{
  double most = 0;
  for (long i = 0; i < A->n; i++) most = fmax(most, row_sum(A, i));
  const double gamma = (condition - 1) / (2 * most);
  for (long i = 0; i < A->n; i++) {
    A->floor[i] = 1;
    A->diagonal[i] = 1 + gamma * row_sum(A, i);
    for (long k = A->start[i]; k < A->start[i + 1]; k++) A->value[k] *= -gamma;
  }
}

static linear_system make(int dim, int across)
{
  linear_system s = {.lattice = {.dim = dim, .across = across}};
  place(&s.lattice);
  for (int d = 0; d < dim; d++) {
    s.b[d] = array(s.lattice.n, sizeof(double));
    s.x[d] = array(s.lattice.n, sizeof(double));
  }
  return s;
}

static void release(linear_system *s)
{
  for (int d = 0; d < 3; d++) free(s->lattice.x[d]), free(s->b[d]), free(s->x[d]);
  sph_csr_free(&s->A);
}

/* A smooth flow of unit size with some noise, as it stands before viscosity acts. */
static void start(linear_system *s)
{
  unsigned state = 7;
  const double k = 2 * acos(-1) / s->lattice.across;
  for (int d = 0; d < s->lattice.dim; d++)
    for (long i = 0; i < s->A.n; i++) {
      double along = s->lattice.x[(d + 1) % s->lattice.dim][i];
      s->b[d][i] = sin(k * along) + 0.1 * noise(&state);
    }
}

/* ---- measuring */

/* Seconds of a solve; < 0: it failed. */
static double solve(sph_linear *solver, linear_system *s, long pattern, long values)
{
  sph_error error = {0};
  for (int d = 0; d < s->lattice.dim; d++)
    memcpy(s->x[d], s->b[d], (size_t)s->A.n * sizeof(double));
  sph_linear_task task = {.A = &s->A,
                          .pattern = pattern,
                          .values = values,
                          .columns = s->lattice.dim,
                          .b = (const double *const *)s->b,
                          .x = s->x,
                          .tolerance = 1e-5};
  double begin = bench_thread_seconds();
  int status = sph_linear_solve(solver, &task, &error);
  double seconds = bench_thread_seconds() - begin;
  if (!status) return seconds;
  bench_complain("%s", status > 0 ? sph_linear_reason(solver) : error.text);
  return -1;
}

static void report(const char *name, const char *what, double *seconds)
{
  char text[120];
  snprintf(text, sizeof text, "%s/%s", name, what);
  for (int k = 0; k < REPEATS; k++) seconds[k] *= 1e3;
  bench_report(text, "ms", seconds, REPEATS);
}

/* Returns the seconds of the first solve. */
static double measure(const char *name, const char *method, linear_system *s)
{
  double pattern[REPEATS], values[REPEATS], same[REPEATS], iterations;
  sph_error error = {0};
  sph_linear *solver = sph_linear_create(method, 1, &error);
  long number = 0;
  if (!solver) bench_complain("%s", error.text), exit(1);
  for (int k = 0; k < REPEATS; k++) {
    pattern[k] = solve(solver, s, number, number);
    values[k] = solve(solver, s, number, number + 1);
    same[k] = solve(solver, s, number, number + 1);
    number += 2;
  }
  sph_linear_stats stats;
  sph_linear_get_stats(solver, &stats);
  double first = pattern[0];
  report(name, "pattern", pattern);
  report(name, "values", values);
  report(name, "solve", same);
  char text[120];
  snprintf(text, sizeof text, "%s/iterations", name);
  iterations = (double)stats.last;
  if (stats.last) bench_report(text, "", &iterations, 1);
  sph_linear_free(solver);
  return first;
}

static const int across[4][4] = {{0}, {1000, 10000, 100000, 0}, {50, 100, 200, 0}, {13, 20, 30, 0}};
static const double condition[] = {1e1, 1e2, 1e3, 1e4, 1e6};

/* One method on all sizes and conditions of one dimension. */
static void measure_method(const char *method, int dim)
{
  const int iterative = !strncmp(method, "pcg", 3);
  double seconds = 0;
  for (int k = 0; k < 4 && across[dim][k] && seconds < TOO_LONG; k++) {
    if (bench_quick() && k > 0) break;
    for (int c = 0; c < (iterative ? 5 : 1); c++) {
      char name[100];
      long n = lround(pow(across[dim][k], dim));
      snprintf(name, sizeof name, "linear/%dd/%ld/%.0e/%s", dim, n, condition[c], method);
      if (!bench_wanted(name)) continue;
      linear_system s = make(dim, across[dim][k]);
      fill(&s);
      scale(&s.A, condition[c]);
      start(&s);
      seconds = measure(name, method, &s);
      release(&s);
    }
  }
}

void bench_linear(void)
{
  if (!bench_filtered()) return; /* minutes */
  for (int dim = 1; dim <= 3; dim++)
    for (int m = 0; sph_linear_name(m); m++) measure_method(sph_linear_name(m), dim);
}
