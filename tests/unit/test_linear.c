/* Every linear solver against dense Cholesky factors of GSL, on matrices as smoothed particles give
 * them; what must be refused; the same bits for any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <float.h>
#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear.h"
#include "spd.h"

enum { COLUMNS = 5, MOST = 512 };

/* Right-hand sides, guesses, weights and the solutions of GSL. */
typedef struct problem {
  sph_csr A;
  int columns;
  double b[COLUMNS][MOST], x[COLUMNS][MOST], weight[COLUMNS][MOST], exact[COLUMNS][MOST];
} problem;

static problem p;

static gsl_matrix *dense(const sph_csr *A)
{
  gsl_matrix *full = gsl_matrix_calloc((size_t)A->n, (size_t)A->n);
  for (long i = 0; i < A->n; i++) {
    gsl_matrix_set(full, (size_t)i, (size_t)i, A->diagonal[i]);
    for (long k = A->start[i]; k < A->start[i + 1]; k++)
      gsl_matrix_set(full, (size_t)i, (size_t)A->column[k], A->value[k]);
  }
  return full;
}

static void solve_dense(void)
{
  gsl_matrix *full = dense(&p.A);
  assert_int_equal(gsl_linalg_cholesky_decomp1(full), GSL_SUCCESS);
  for (int c = 0; c < p.columns; c++) {
    gsl_vector_view b = gsl_vector_view_array(p.b[c], (size_t)p.A.n);
    gsl_vector_view x = gsl_vector_view_array(p.exact[c], (size_t)p.A.n);
    assert_int_equal(gsl_linalg_cholesky_solve(full, &b.vector, &x.vector), GSL_SUCCESS);
  }
  gsl_matrix_free(full);
}

/* Right-hand sides of solutions that are rough, guesses that are wrong. */
static void fill(int columns, uint64_t seed)
{
  const double *x[COLUMNS] = {0};
  double *b[COLUMNS] = {0};
  p.columns = columns;
  for (int c = 0; c < columns; c++) {
    x[c] = p.x[c], b[c] = p.b[c];
    for (long i = 0; i < p.A.n; i++) {
      p.x[c][i] = spd_chance(&seed);
      p.weight[c][i] = (c + 1) * (1 + 0.5 * spd_chance(&seed));
    }
  }
  sph_csr_multiply(&p.A, columns, x, b);
  for (int c = 0; c < columns; c++)
    for (long i = 0; i < p.A.n; i++) p.x[c][i] += 0.5 * spd_chance(&seed);
}

static int solve(sph_linear *solver, long pattern, long values, double tolerance)
{
  const double *b[COLUMNS], *weight[COLUMNS];
  double *x[COLUMNS];
  sph_error error = {0};
  for (int c = 0; c < p.columns; c++) b[c] = p.b[c], x[c] = p.x[c], weight[c] = p.weight[c];
  int status = sph_linear_solve(solver,
                                &(sph_linear_task){.A = &p.A,
                                                   .pattern = pattern,
                                                   .values = values,
                                                   .columns = p.columns,
                                                   .b = b,
                                                   .x = x,
                                                   .weight = weight,
                                                   .tolerance = tolerance},
                                &error);
  if (status < 0) fail_msg("%s", error.text);
  return status;
}

static double weighted_error(void)
{
  double sum = 0;
  for (int c = 0; c < p.columns; c++)
    for (long i = 0; i < p.A.n; i++) sum += pow(p.weight[c][i] * (p.x[c][i] - p.exact[c][i]), 2);
  return sqrt(sum / (double)p.A.n / p.columns);
}

static sph_linear *create(const char *name, int threads)
{
  sph_error error = {0};
  sph_linear *solver = sph_linear_create(name, threads, &error);
  if (!solver) fail_msg("%s", error.text);
  return solver;
}

/* The weighted error against GSL is within the tolerance. */
static void expect_solved(sph_linear *solver, long pattern, long values, const char *what)
{
  const double tolerance = 1e-6;
  solve_dense();
  if (solve(solver, pattern, values, tolerance) != SPH_OK)
    fail_msg("%s: %s", what, sph_linear_reason(solver));
  assert_string_equal(sph_linear_reason(solver), "");
  if (!(weighted_error() <= tolerance)) fail_msg("%s: error %g", what, weighted_error());
}

static void same_as_dense(void **state)
{
  static const double condition[] = {1e1, 1e3, 1e5, 1e8};
  static const int across[] = {97, 15, 7};
  (void)state;
  for (int m = 0; sph_linear_name(m); m++) {
    sph_linear *solver = create(sph_linear_name(m), 1);
    for (int k = 0; k < 12; k++) {
      char what[100];
      int dim = k % 3 + 1;
      spd_make(&p.A, dim, across[dim - 1], condition[k / 3], 1 + (uint64_t)k);
      fill(1 + k % COLUMNS, 7);
      snprintf(what, sizeof what, "%s, dimension %d, condition %g, %d columns", sph_linear_name(m),
               dim, condition[k / 3], p.columns);
      expect_solved(solver, k, k, what);
    }
    sph_linear_free(solver);
  }
  sph_csr_free(&p.A);
}

/* Other values in the same pattern, the same matrix again, another right-hand side. */
static void values_change(void **state)
{
  (void)state;
  spd_make(&p.A, 2, 12, 1e3, 3);
  for (int m = 0; sph_linear_name(m); m++) {
    sph_linear *solver = create(sph_linear_name(m), 2);
    sph_linear_stats stats;
    for (int k = 0; k < 6; k++) {
      if (k % 2 == 0) /* more mass: another matrix, and a better one */
        for (long i = 0; i < p.A.n; i++) p.A.diagonal[i] += 0.5, p.A.floor[i] += 0.5;
      fill(1 + k % 3, 20 + (uint64_t)k);
      expect_solved(solver, 1, k / 2, sph_linear_name(m));
    }
    sph_linear_get_stats(solver, &stats);
    assert_true(stats.solves == 6 && stats.analyses <= 1 && stats.factorisations <= 3);
    sph_linear_free(solver);
  }
  sph_csr_free(&p.A);
}

/* Entries between rows more than `apart` apart are zero: they stay in the pattern. */
static void cut(sph_csr *A, long apart)
{
  for (long i = 0; i < A->n; i++)
    for (long k = A->start[i]; k < A->start[i + 1]; k++)
      if (labs(A->column[k] - i) > apart) {
        A->diagonal[i] += A->value[k];
        A->value[k] = 0;
      }
}

/* Tolerances down to rounding, though products may be made in single precision meanwhile; entries
 * that are zero; matrices in any units. */
static void expect_tolerances(const char *name, double unit, int rough)
{
  sph_linear *solver = create(name, 1);
  spd_make(&p.A, 2, 20, 1e6, 4);
  cut(&p.A, 30);
  fill(2, 5);
  for (long i = 0; !rough && i < p.A.n; i++) { /* x = 1, and another smooth one */
    p.b[0][i] = p.A.floor[i];
    p.b[1][i] = p.A.floor[i] * sin(0.1 * (double)i);
  }
  solve_dense();
  for (long i = 0; i < p.A.n; i++) {
    p.A.diagonal[i] *= unit, p.A.floor[i] *= unit;
    for (long k = p.A.start[i]; k < p.A.start[i + 1]; k++) p.A.value[k] *= unit;
    for (int c = 0; c < 2; c++) p.b[c][i] *= unit;
  }
  for (int k = 2; k <= 10; k++) {
    const double tolerance = pow(10, -k);
    for (int c = 0; c < 2; c++)
      for (long i = 0; i < p.A.n; i++) p.x[c][i] = 0;
    if (solve(solver, 1, 1, tolerance)) fail_msg("%s", sph_linear_reason(solver));
    if (!(weighted_error() <= tolerance))
      fail_msg("%s, unit %g, rough %d, tolerance %g: error %g", name, unit, rough, tolerance,
               weighted_error());
  }
  sph_linear_free(solver);
}

static void tolerances_hold(void **state)
{
  static const double unit[] = {1, 1e-50, 1e45};
  (void)state;
  for (int k = 0; k < 6; k++) {
    expect_tolerances("pcg-jacobi", unit[k / 2], k % 2);
    expect_tolerances("pcg-ic0", unit[k / 2], k % 2);
  }
  sph_csr_free(&p.A);
}

/* New numbers for the same matrix: direct methods see that it is the same. */
static void numbers_change(void **state)
{
  static const char *const direct[] = {"cholmod-supernodal", "cholmod-simplicial", "klu"};
  (void)state;
  spd_make(&p.A, 2, 12, 1e3, 3);
  for (int m = 0; m < 3; m++) {
    sph_linear *solver = create(direct[m], 1);
    sph_linear_stats stats;
    for (int k = 0; k < 4; k++) {
      fill(1, 20 + (uint64_t)k);
      if (k == 2) p.A.diagonal[7] += 1e-3;
      expect_solved(solver, 1, k, direct[m]);
    }
    sph_linear_get_stats(solver, &stats);
    assert_true(stats.factorisations == 2 && stats.analyses == 1);
    sph_linear_free(solver);
  }
  sph_csr_free(&p.A);
}

/* Blocks without any entry between them, among them single rows; one row; none. */
static void blocks_and_small_ones(void **state)
{
  (void)state;
  for (int m = 0; sph_linear_name(m); m++) {
    sph_linear *solver = create(sph_linear_name(m), 1);
    spd_make_two(&p.A, 2, 14, 1e3, 5);
    fill(2, 8);
    expect_solved(solver, 1, 1, sph_linear_name(m));
    spd_make_two(&p.A, 1, 5, 1e2, 6);
    fill(1, 8);
    expect_solved(solver, 2, 2, sph_linear_name(m));
    spd_make(&p.A, 1, 1, 1e2, 6);
    fill(3, 8);
    expect_solved(solver, 3, 3, sph_linear_name(m));
    p.A.n = 0;
    assert_int_equal(solve(solver, 4, 4, 1e-6), SPH_OK);
    sph_linear_free(solver);
  }
  sph_csr_free(&p.A);
}

/* Positive and negative exchange: entries of any sign. */
static void any_signs(void **state)
{
  (void)state;
  for (int m = 0; sph_linear_name(m); m++) {
    sph_linear *solver = create(sph_linear_name(m), 1);
    spd_make(&p.A, 2, 14, 1e4, 5);
    for (long i = 0; i < p.A.n; i++)
      for (long k = p.A.start[i]; k < p.A.start[i + 1]; k++)
        if ((i + p.A.column[k]) % 3 == 0) p.A.value[k] *= -1;
    fill(3, 8);
    expect_solved(solver, 1, 1, sph_linear_name(m));
    sph_linear_free(solver);
  }
  sph_csr_free(&p.A);
}

/* The smallest matrix without an incomplete factor (Kershaw 1978, J. Comput. Phys. 26). */
static void kershaw(void **state)
{
  static const int column[4][2] = {{1, 3}, {0, 2}, {3, 1}, {2, 0}};
  static const double value[4][2] = {{-2, 2}, {-2, -2}, {-2, -2}, {-2, 2}};
  sph_error error = {0};
  (void)state;
  if (sph_csr_reserve(&p.A, 4, 8, &error)) fail_msg("%s", error.text);
  p.A.n = 4;
  p.A.start[0] = 0;
  for (int i = 0; i < 4; i++) {
    p.A.start[i + 1] = 2 * i + 2;
    p.A.diagonal[i] = 3;
    p.A.floor[i] = 3 - 2 * sqrt(2);
    for (int k = 0; k < 2; k++) p.A.column[2 * i + k] = column[i][k];
    for (int k = 0; k < 2; k++) p.A.value[2 * i + k] = value[i][k];
  }
  fill(2, 3);
  for (int m = 0; sph_linear_name(m); m++) {
    sph_linear *solver = create(sph_linear_name(m), 1);
    expect_solved(solver, 1, 1, sph_linear_name(m));
    sph_linear_free(solver);
  }
  sph_csr_free(&p.A);
}

static void expect_refused(sph_linear *solver, long number, const char *name, const char *reason)
{
  int status = solve(solver, number, number, 1e-8);
  if (status != SPH_RETRY) fail_msg("%s: status %d", name, status);
  if (!strstr(sph_linear_reason(solver), reason))
    fail_msg("%s: \"%s\" does not say \"%s\"", name, sph_linear_reason(solver), reason);
}

/* Eigenvalues < 0, a diagonal < 0, NaN; the solver is good for the next one. */
static void refused(void **state)
{
  (void)state;
  for (int m = 0; sph_linear_name(m); m++) {
    const char *name = sph_linear_name(m);
    sph_linear *solver = create(name, 1);
    spd_make(&p.A, 2, 12, 1e3, 3);
    fill(2, 9);
    p.A.diagonal[77] -= 0.6 * (p.A.diagonal[77] + p.A.diagonal[78]);
    expect_refused(solver, 1, name, "floor");
    spd_make(&p.A, 2, 12, 1e3, 3);
    for (long k = 0; k < p.A.start[p.A.n]; k++) p.A.value[k] *= 1.5;
    expect_refused(solver, 2, name, "positive definite");
    spd_make(&p.A, 2, 12, 1e3, 3);
    p.A.value[5] = NAN;
    expect_refused(solver, 3, name, "");
    spd_make(&p.A, 2, 12, 1e3, 3);
    fill(2, 9);
    expect_solved(solver, 4, 4, name);
    p.b[0][3] = NAN;
    expect_refused(solver, 4, name, "finite");
    fill(2, 9);
    expect_solved(solver, 4, 4, name);
    sph_linear_free(solver);
  }
  sph_csr_free(&p.A);
}

/* I + the Laplacian of a ring with neighbours two away. */
static void make_chain(sph_csr *A, long n)
{
  sph_error error = {0};
  if (sph_csr_reserve(A, n, 4 * n, &error)) fail_msg("%s", error.text);
  A->n = n;
  A->start[0] = 0;
  for (long i = 0; i < n; i++) {
    static const int step[] = {-2, -1, 1, 2};
    A->start[i + 1] = 4 * (i + 1);
    A->floor[i] = 1;
    A->diagonal[i] = 1;
    for (int k = 0; k < 4; k++) {
      A->column[4 * i + k] = (int)((i + step[k] + n) % n);
      A->value[4 * i + k] = -10.0 / (step[k] * step[k]);
      A->diagonal[i] += 10.0 / (step[k] * step[k]);
    }
  }
}

static void same_bits_for_any_number_of_threads(void **state)
{
  enum { N = 20000 };
  static double x[3][2][N], b[2][N];
  uint64_t seed = 4;
  sph_csr A = {0};
  sph_error error = {0};
  (void)state;
  make_chain(&A, N);
  for (int c = 0; c < 2; c++)
    for (long i = 0; i < N; i++) b[c][i] = spd_chance(&seed);
  for (int m = 0; sph_linear_name(m); m++)
    for (int threads = 1; threads <= 3; threads++) {
      double(*to)[N] = x[threads - 1];
      sph_linear *solver = create(sph_linear_name(m), threads);
      memset(to, 0, sizeof x[0]);
      assert_int_equal(sph_linear_solve(solver,
                                        &(sph_linear_task){.A = &A,
                                                           .columns = 2,
                                                           .b = (const double *[]){b[0], b[1]},
                                                           .x = (double *[]){to[0], to[1]},
                                                           .tolerance = 1e-3},
                                        &error),
                       SPH_OK);
      assert_memory_equal(to, x[0], sizeof x[0]);
      assert_true(fabs(to[0][N / 2]) > 1e-3);
      sph_linear_free(solver);
    }
  sph_csr_free(&A);
}

/* A guess that is good enough stays as it is; weights decide what that is. */
static void guesses_count(void **state)
{
  sph_linear_stats stats;
  (void)state;
  spd_make(&p.A, 2, 10, 1e2, 3);
  fill(1, 2);
  solve_dense();
  sph_linear *solver = create("pcg-jacobi", 1);
  for (long i = 0; i < p.A.n; i++) p.x[0][i] = p.exact[0][i] + 1e-4;
  assert_int_equal(solve(solver, 1, 1, 1e-3), SPH_OK);
  sph_linear_get_stats(solver, &stats);
  assert_int_equal(stats.iterations, 0);
  assert_true(p.x[0][0] == p.exact[0][0] + 1e-4);
  for (long i = 0; i < p.A.n; i++) p.weight[0][i] *= 100;
  assert_int_equal(solve(solver, 1, 1, 1e-3), SPH_OK);
  sph_linear_get_stats(solver, &stats);
  assert_true(stats.iterations > 0 && stats.last == stats.iterations && stats.solves == 2);
  assert_true(weighted_error() <= 1e-3);
  sph_linear_free(solver);
  sph_csr_free(&p.A);
}

/* The bound of the error is 5 times that on average; without the recurrence it is 9 times. */
static void bounds_are_close(void **state)
{
  double sum = 0;
  (void)state;
  sph_linear *solver = create("pcg-jacobi", 1);
  spd_make(&p.A, 2, 20, 1e2, 3);
  for (int k = 1; k <= 6; k++) {
    fill(3, 2);
    for (int c = 0; c < 3; c++)
      for (long i = 0; i < p.A.n; i++) p.weight[c][i] = sqrt(p.A.floor[i]);
    solve_dense();
    const double tolerance = pow(10, -k);
    assert_int_equal(solve(solver, 1, 1, tolerance), SPH_OK);
    assert_true(weighted_error() <= tolerance);
    sum += log10(weighted_error() / tolerance);
  }
  if (pow(10, sum / 6) < 0.15) fail_msg("error / tolerance is %g on average", pow(10, sum / 6));
  sph_linear_free(solver);
  sph_csr_free(&p.A);
}

/* Solves `count` times; each time the values (2: their number alone) or the pattern change. */
static const char *after(sph_linear *solver, int count, int values, int pattern)
{
  static long number = 100;
  number++;
  for (int k = 0; k < count; k++) {
    number += values || pattern;
    if (values == 1) p.A.diagonal[0] += 1e-9;
    for (long i = 0; i < p.A.n; i++) p.x[0][i] = 0;
    if (solve(solver, pattern ? number : 1, number, 1e-6))
      fail_msg("%s", sph_linear_reason(solver));
    if (!(weighted_error() < 1e-6)) fail_msg("%s: error", sph_linear_used(solver));
  }
  return sph_linear_used(solver);
}

/* What "auto" takes for dim, condition and a matrix that stays (0), or changes its values (1), or
 * its pattern (2), or only the number of its values (3). */
static void auto_takes(const char *method, int dim, double condition, int change, int count)
{
  sph_linear *solver = create("auto", 1);
  spd_make(&p.A, dim, dim == 1 ? 300 : 17, condition, 3);
  fill(1, 2);
  solve_dense();
  const char *used = after(solver, count, change == 1 ? 1 : change == 3 ? 2 : 0, change == 2);
  if (strcmp(used, method))
    fail_msg("%dD, condition %g, change %d: %s, not %s", dim, condition, change, used, method);
  sph_linear_free(solver);
}

static void auto_counts(void **state)
{
  (void)state;
  auto_takes("pcg-jacobi", 1, 10, 2, 60);
  auto_takes("pcg-ic0", 1, 1e4, 2, 60);
  auto_takes("pcg-ic0", 1, 1e4, 0, 1);
  auto_takes("cholmod", 1, 1e4, 0, 60);
  auto_takes("pcg-jacobi", 2, 1e2, 2, 60);
  auto_takes("pcg-jacobi", 2, 1e4, 0, 1);
  auto_takes("cholmod", 2, 1e4, 0, 60);
  auto_takes("pcg-jacobi", 2, 1e2, 1, 60);
  auto_takes("cholmod", 2, 1e2, 3, 60);
  sph_csr_free(&p.A);
}

static void names(void **state)
{
  sph_error error = {0};
  (void)state;
  assert_null(sph_linear_create("pcg-jakobi", 1, &error));
  assert_int_equal(error.status, SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "the nearest is \"pcg-jacobi\", known are "));
  for (int m = 0; sph_linear_name(m); m++) assert_non_null(strstr(error.text, sph_linear_name(m)));
  assert_null(sph_linear_name(-1));
  sph_linear_free(NULL);
}

static void bad_tasks(void **state)
{
  sph_linear *solver = create("pcg-jacobi", 1);
  static const double tolerance[] = {0, -1, NAN, INFINITY};
  (void)state;
  spd_make(&p.A, 1, 5, 1e2, 3);
  for (int k = 0; k < 4; k++) {
    sph_error error = {0};
    sph_linear_task task = {.A = &p.A, .tolerance = tolerance[k]};
    assert_int_equal(sph_linear_solve(solver, &task, &error), SPH_ERR_ARGUMENT);
    assert_non_null(strstr(error.text, "tolerance"));
  }
  sph_linear_free(solver);
  sph_csr_free(&p.A);
}

/* What is there stays when a matrix grows. */
static void matrices_grow(void **state)
{
  sph_csr A = {0};
  sph_error error = {0};
  (void)state;
  spd_make(&A, 1, 9, 10, 3);
  long entries = A.start[9], column = A.column[entries - 1];
  double value = A.value[entries - 1], diagonal = A.diagonal[8], floor = A.floor[8];
  assert_int_equal(sph_csr_reserve(&A, 10000, 100000, &error), SPH_OK);
  assert_true(A.room_rows >= 10000 && A.room_entries >= 100000 && A.n == 9);
  assert_true(A.start[9] == entries && A.column[entries - 1] == column);
  assert_true(A.value[entries - 1] == value && A.diagonal[8] == diagonal && A.floor[8] == floor);
  const long *start = A.start;
  assert_int_equal(sph_csr_reserve(&A, 5, 5, &error), SPH_OK);
  assert_true(A.start == start);
  sph_csr_free(&A);
  assert_true(!A.start && !A.room_rows);
}

/* In place of those of an OpenBLAS. */
static int blas_threads = 7, least_threads = 7;
void openblas_set_num_threads(int threads);
int openblas_get_num_threads(void);
void openblas_set_num_threads(int threads)
{
  blas_threads = threads;
  if (threads < least_threads) least_threads = threads;
}
int openblas_get_num_threads(void) { return blas_threads; }

/* Factors are made with one thread of the BLAS, which has all of its own again behind that. */
static void blas_has_one_thread(void **state)
{
  (void)state;
  least_threads = blas_threads = 7;
  spd_make(&p.A, 2, 12, 1e3, 3);
  sph_linear *solver = create("cholmod-supernodal", 2);
  fill(2, 20);
  expect_solved(solver, 1, 1, "cholmod-supernodal");
  assert_int_equal(least_threads, 1);
  assert_int_equal(blas_threads, 7);
  sph_linear_free(solver);
  sph_csr_free(&p.A);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(same_as_dense),
      cmocka_unit_test(values_change),
      cmocka_unit_test(tolerances_hold),
      cmocka_unit_test(numbers_change),
      cmocka_unit_test(blocks_and_small_ones),
      cmocka_unit_test(any_signs),
      cmocka_unit_test(kershaw),
      cmocka_unit_test(refused),
      cmocka_unit_test(same_bits_for_any_number_of_threads),
      cmocka_unit_test(guesses_count),
      cmocka_unit_test(bounds_are_close),
      cmocka_unit_test(auto_counts),
      cmocka_unit_test(names),
      cmocka_unit_test(bad_tasks),
      cmocka_unit_test(matrices_grow),
      cmocka_unit_test(blas_has_one_thread),
  };
  gsl_set_error_handler_off();
  return cmocka_run_group_tests(tests, NULL, NULL);
}
