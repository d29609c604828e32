/* Every allocation of the neighbour search fails once: a clean error, nothing lost, and the next
 * attempt gives the list that it would have been. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "failing.h"
#include "sphode/neighbors.h"

enum { POINTS = 500 };

static double x[2][POINTS];

/* Sorts, builds and counts all neighbours of point 7; < 0: a status. */
static long count(sph_neighbors *nb, long n, sph_error *error)
{
  const double *const at[] = {x[0], x[1]};
  int status = sph_neighbors_sort(nb, 0, n, at, error);
  if (!status) status = sph_neighbors_sort(nb, 1, n / 2, at, error);
  if (!status) status = sph_neighbors_build(nb, 0, 1, error);
  if (!status) status = sph_neighbors_build(nb, 0, 0, error);
  if (status) return status;
  return sph_neighbors_find(nb, 0, 0, 7, 0, NULL, NULL);
}

/* The whole life of a search, which grows once; all in one, `fail_at` counts through it. */
static long live(const sph_neighbors_def *def)
{
  sph_error error = {0};
  sph_neighbors *nb = sph_neighbors_create(def, &error);
  if (!nb) {
    assert_int_equal(error.status, SPH_ERR_MEMORY);
    assert_non_null(strstr(error.text, "out of memory"));
    return SPH_ERR_MEMORY;
  }
  long small = count(nb, 9, &error), large = small < 0 ? small : count(nb, POINTS, &error);
  if (large < 0) {
    assert_int_equal(large, SPH_ERR_MEMORY);
    if (error.status) assert_non_null(strstr(error.text, "out of memory"));
    long again = count(nb, POINTS, NULL);
    fail_at = 0;
    assert_int_equal(again, count(nb, POINTS, NULL));
  }
  sph_neighbors_free(nb);
  return large;
}

static void each_allocation(void **state)
{
  (void)state;
  for (int d = 0; d < 2; d++)
    for (long i = 0; i < POINTS; i++) x[d][i] = (double)((i * (d ? 7919 : 104729)) % 1009) / 50;
  static const char *const searches[] = {"grid", "hash", "tree"};
  for (int k = 0; k < 6; k++) {
    const int threads = 1 + 2 * (k % 2);
    const sph_neighbors_def def = {.dim = 2,
                                   .search = searches[k / 2],
                                   .reach = 3,
                                   .lanes = 4,
                                   .threads = threads,
                                   .periodic = {1, 0, 0},
                                   .length = {21, 0, 0}};
    calls = fail_at = 0;
    long right = live(&def), all = calls;
    assert_true(right > 5 && all > 15);
    for (long at = 1; at <= all; at++) {
      calls = 0;
      fail_at = at;
      assert_int_equal(live(&def), SPH_ERR_MEMORY);
    }
    calls = fail_at = 0;
    assert_int_equal(live(&def), right);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_allocation)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
