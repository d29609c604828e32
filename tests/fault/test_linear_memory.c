/* Every allocation of matrices and linear solvers fails once, ours and those of CHOLMOD and KLU:
 * it is told, nothing leaks (under ASan or valgrind), the next attempt gives the solution. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <SuiteSparse_config.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/spd.h"
#include "failing.h"
#include "linear.h"

enum { MOST = 256, COLUMNS = 6, FROZEN = 60 /* solves after which auto has factors */ };

static int fails(void) { return ++calls == fail_at; }
static void *failing_malloc(size_t size) { return fails() ? NULL : malloc(size); }
static void *failing_calloc(size_t n, size_t size) { return fails() ? NULL : calloc(n, size); }
static void *failing_realloc(void *p, size_t size) { return fails() ? NULL : realloc(p, size); }

static void make_suitesparse_fail(void)
{
#if SUITESPARSE_MAIN_VERSION >= 6
  SuiteSparse_config_malloc_func_set(failing_malloc);
  SuiteSparse_config_calloc_func_set(failing_calloc);
  SuiteSparse_config_realloc_func_set(failing_realloc);
#else
  SuiteSparse_config.malloc_func = failing_malloc;
  SuiteSparse_config.calloc_func = failing_calloc;
  SuiteSparse_config.realloc_func = failing_realloc;
#endif
}

static sph_csr small, large;
static double b[COLUMNS][MOST], x[COLUMNS][MOST];

static int solve(sph_linear *solver, const sph_csr *A, int columns, sph_error *error)
{
  const double *right[COLUMNS];
  double *left[COLUMNS];
  for (int c = 0; c < columns; c++) {
    for (long i = 0; i < A->n; i++) b[c][i] = sin((double)(3 * i + c));
    right[c] = b[c];
    left[c] = x[c];
    memset(x[c], 0, sizeof x[c]);
  }
  sph_linear_task task = {.A = A,
                          .pattern = A->n,
                          .values = A->n,
                          .columns = columns,
                          .b = right,
                          .x = left,
                          .tolerance = 1e-9};
  return sph_linear_solve(solver, &task, error);
}

/* Two matrices, the second one larger; a memory error, or the last solution's sum in *sum. */
static int live(const char *name, double *sum)
{
  sph_error error = {0};
  sph_linear *solver = sph_linear_create(name, 2, &error);
  int status = error.status;
  if (solver) status = solve(solver, &small, 2, &error);
  for (int k = 0; !status && k < (strcmp(name, "auto") ? 1 : FROZEN); k++)
    status = solve(solver, &large, COLUMNS, &error);
  if (status) {
    assert_int_equal(status, SPH_ERR_MEMORY);
    assert_int_equal(error.status, SPH_ERR_MEMORY);
    assert_non_null(strstr(error.text, "out of memory"));
    fail_at = 0;
    if (solver) assert_int_equal(solve(solver, &large, COLUMNS, NULL), SPH_OK);
  }
  *sum = 0;
  for (int c = 0; c < COLUMNS; c++)
    for (long i = 0; i < large.n; i++) *sum += (c + 1) * x[c][i];
  if (solver) sph_linear_free(solver);
  return status;
}

static void each_allocation_of_a_solver(void **state)
{
  (void)state;
  make_suitesparse_fail();
  spd_make(&small, 2, 6, 1e2, 1);
  spd_make(&large, 2, 12, 1e2, 2);
  for (int m = 0; sph_linear_name(m); m++) {
    double right, sum;
    long told = 0;
    calls = fail_at = 0;
    assert_int_equal(live(sph_linear_name(m), &right), SPH_OK);
    long all = calls;
    assert_true(all >= 10);
    for (long k = 1; k <= all; k++) {
      calls = 0;
      fail_at = k;
      int status = live(sph_linear_name(m), &sum);
      told += status != SPH_OK;
      /* The first two are of create: no solver, no solution. */
      if ((k > 2 || !status) && !(fabs(sum - right) < 1e-6 * fabs(right)))
        fail_msg("%s: after allocation %ld of %ld failed: %g, not %g", sph_linear_name(m), k, all,
                 sum, right);
    }
    if (told < all - 9) /* KLU need not shrink arrays, nor CHOLMOD have an order of METIS */
      fail_msg("%s: of %ld failures %ld were told", sph_linear_name(m), all, told);
  }
  sph_csr_free(&small);
  sph_csr_free(&large);
}

static void each_allocation_of_a_matrix(void **state)
{
  (void)state;
  for (long k = 1; k <= 5; k++) {
    sph_csr A = {0};
    sph_error error = {0};
    calls = 0;
    fail_at = k;
    assert_int_equal(sph_csr_reserve(&A, 10, 100, &error), SPH_ERR_MEMORY);
    assert_int_equal(error.status, SPH_ERR_MEMORY);
    assert_int_equal(sph_csr_reserve(&A, 10, 100, NULL), SPH_OK);
    A.start[10] = 100, A.column[99] = 7, A.floor[9] = 3;
    sph_csr_free(&A);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_allocation_of_a_solver),
      cmocka_unit_test(each_allocation_of_a_matrix),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
