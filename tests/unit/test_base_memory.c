/* Memory: zeros at a line's start whatever was there before, growth that keeps what there was, and
 * pages that cost nothing before they are touched. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../../bench/resident.h"
#include "memory.h"

enum { LINE = 64, LARGE = 1 << 20 };
static const size_t sizes[] = {0, 1, 64, 4097, LARGE - 64, LARGE - 1, LARGE, LARGE + 1, 3 * LARGE};
enum { SIZES = sizeof sizes / sizeof *sizes };

static void all_zero(const unsigned char *at, size_t from, size_t to)
{
  for (size_t k = from; k < to; k++)
    if (at[k]) fail_msg("byte %zu of %zu is %d", k, to, at[k]);
}

static void zeros(void **state)
{
  (void)state;
  for (int again = 0; again < 3; again++)
    for (int k = 0; k < SIZES; k++) {
      unsigned char *at = sph_memory_take(sizes[k], 1);
      assert_non_null(at);
      assert_int_equal((uintptr_t)at % LINE, 0);
      all_zero(at, 0, sizes[k]);
      memset(at, 255, sizes[k]);
      sph_memory_free(at);
    }
}

/* Bytes that are not zero at the ends of pieces, alone in them, and in none. */
static void growth(void **state)
{
  (void)state;
  for (int k = 1; k < SIZES; k++) {
    const size_t n = sizes[k], more = 2 * n + 5;
    unsigned char *at = sph_memory_take(n, 1), *was = malloc(n);
    for (size_t i = 0; i < n; i += 4096 * (1 + i % 3)) at[i] = 1, at[n - 1 - i] = 2;
    memcpy(was, at, n);
    assert_int_equal(sph_memory_grow((void **)&at, n, more, 1, "bytes", NULL), SPH_OK);
    assert_memory_equal(at, was, n);
    all_zero(at, n, more);
    free(was);
    sph_memory_free(at);
  }
}

static void untouched(void **state)
{
  (void)state;
  if (getenv("SPHODE_TEST_QUICK")) return; /* sanitizers, valgrind: shadows of what is freed stay */
  const size_t n = 8 * (size_t)LARGE;
  const double before = resident();
  unsigned char *at;
  for (int again = 0; again < 3; again++) { /* given back at once: free may keep it */
    at = sph_memory_take(n, 1);
    memset(at, 1, n);
    sph_memory_free(at);
  }
  at = sph_memory_take(n, 1);
  assert_int_equal(sph_memory_grow((void **)&at, n, 2 * n, 1, "bytes", NULL), SPH_OK);
  assert_true(resident() - before < LARGE);
  sph_memory_free(at);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(zeros), cmocka_unit_test(growth),
                                     cmocka_unit_test(untouched)};
  return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
