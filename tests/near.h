/* near.h -- cmocka's assert_float_equal rounds to float first. */
#ifndef TESTS_NEAR_H
#define TESTS_NEAR_H
#include <math.h>

/* |a - b| <= e, neither of them NaN */
#define assert_near(a, b, e)                                                        \
  do {                                                                              \
    double near_a = (a), near_b = (b);                                              \
    if (!(fabs(near_a - near_b) <= (e)))                                            \
      fail_msg("%s = %.17g, not %.17g within %g", #a, near_a, near_b, (double)(e)); \
  } while (0)

#endif
