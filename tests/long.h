/* long.h -- what SPHODE_TEST_LONG=1 alone runs.  Include cmocka.h before it. */
#ifndef TESTS_LONG_H
#define TESTS_LONG_H
#include <stdlib.h>

/* Says so where a test then does nothing: validation/validate does not count that as passed. */
static inline int test_is_short(void)
{
  if (getenv("SPHODE_TEST_LONG")) return 0;
  print_message("# not run: needs SPHODE_TEST_LONG=1\n");
  return 1;
}

#endif
