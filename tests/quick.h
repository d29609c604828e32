/* quick.h -- SPHODE_TEST_QUICK=1, for sanitizers, ten times as slow: one of five scenes. */
#ifndef TESTS_QUICK_H
#define TESTS_QUICK_H
#include <stdlib.h>

static inline int quick_stride(void) { return getenv("SPHODE_TEST_QUICK") ? 5 : 1; }

#endif
