/* Every allocation of operators fails once: a clean error, nothing lost, and the next attempt gives
 * what it would have been. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "failing.h"
#include "sphode/operator.h"

enum { POINTS = 400 };

static double x[2][POINTS], volume[POINTS], f[POINTS], out[POINTS], slope[2][POINTS];

/* Few points, then many, then probes; the sum of a result at each, or a status < 0. */
static double live(sph_operator *op, sph_error *error)
{
  static const double *const at[] = {x[0], x[1]};
  static double *const gradient[] = {slope[0], slope[1]};
  double sum = 0;
  int status = SPH_OK;
  for (long n = POINTS / 4; !status && n <= POINTS; n *= 4) {
    status = sph_operator_set_points(op, n, at, volume, volume, error);
    if (!status) status = sph_operator_gradient(op, "symmetric", f, gradient, error);
    for (long i = 0; !status && i < n; i++) sum += slope[0][i] + slope[1][i] + 1e3;
  }
  if (!status) status = sph_operator_set_probes(op, POINTS / 3, at, error);
  if (!status) status = sph_operator_mls(op, 2, f, out, NULL, NULL, error);
  for (long i = 0; !status && i < POINTS / 3; i++) sum += out[i];
  return status ? status : sum;
}

static double all(int threads)
{
  sph_error error = {0};
  sph_operator *op = sph_operator_create(&(sph_operator_def){.dim = 2,
                                                             .h = 2,
                                                             .threads = threads,
                                                             .lower_order = 1,
                                                             .periodic = {1},
                                                             .length = {21}},
                                         &error);
  const double sum = op ? live(op, &error) : SPH_ERR_MEMORY;
  if (sum < 0) {
    assert_true(sum == SPH_ERR_MEMORY);
    assert_int_equal(error.status, SPH_ERR_MEMORY);
    assert_non_null(strstr(error.text, "out of memory"));
  }
  if (sum < 0 && op) {
    fail_at = 0;
    assert_true(live(op, NULL) > 0); /* it can go on */
  }
  sph_operator_free(op);
  return sum;
}

static void each_allocation(void **state)
{
  (void)state;
  for (long i = 0; i < POINTS; i++) {
    for (long d = 0; d < 2; d++) x[d][i] = (double)((i * (d ? 7919 : 104729)) % 1009) / 50;
    volume[i] = 1 + (double)(i % 3), f[i] = (double)(i % 7);
  }
  for (int threads = 1; threads <= 3; threads += 2) {
    calls = fail_at = 0;
    const double right = all(threads);
    const long count = calls;
    assert_true(right > 0 && count > 20);
    for (long k = 1; k <= count; k++) {
      calls = 0, fail_at = k;
      assert_true(all(threads) == SPH_ERR_MEMORY);
    }
    calls = fail_at = 0;
    assert_true(all(threads) == right);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_allocation)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
