/* Stability regions of integrators against those known in closed form. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode/integrator.h"

static const double pi = 3.14159265358979323846;

/* Where |R| = 1.001 on the negative real axis and on the imaginary one, R = sum z^k/k! up to the
 * order of a scheme with as many stages. */
static void least_stages(void **state)
{
  (void)state;
  static const struct {
    const char *method;
    double real, imaginary; /* of |R| = 1: exact or to 1e-4 */
    double slack;           /* what 1.001 adds */
  } scheme[] = {
      {"erk:heun-euler-2-1-2", 2, 0.2991, 3e-3}, /* R(iy): y^4/4 = 1.001^2 - 1 */
      {"predictor-corrector", 2, 0.2991, 3e-3},
      {"midpoint", 2, 0.2991, 3e-3},
      {"erk:bogacki-shampine-4-2-3", 2.5127, 1.7321, 3e-3},
      {"erk:knoth-wolke-3-3", 2.5127, 1.7321, 3e-3},
      {"erk:zonneveld-5-3-4", 2.7853, 2.8284, 3e-3},
  };
  for (size_t k = 0; k < sizeof scheme / sizeof *scheme; k++) {
    double real = sph_stability_extent(scheme[k].method, pi);
    double imaginary = sph_stability_extent(scheme[k].method, pi / 2);
    if (!(fabs(real - scheme[k].real) < scheme[k].slack &&
          fabs(imaginary - scheme[k].imaginary) < scheme[k].slack))
      fail_msg("%s: %.6g, %.6g", scheme[k].method, real, imaginary);
  }
}

/* A step scales with the spectrum, the least of all binds, conjugates and growth do not count. */
static void steps(void **state)
{
  (void)state;
  const char *method = "erk:bogacki-shampine-4-2-3";
  const double re[] = {-1, 0, -3, 0.5}, im[] = {0, 4, -1, -2};
  double step = sph_stability_step(method, 4, re, im), least = INFINITY;
  for (int k = 0; k < 4; k++) {
    double one = sph_stability_step(method, 1, &re[k], &im[k]);
    double exact = sph_stability_extent(method, atan2(fabs(im[k]), fmin(re[k], 0)));
    assert_true(one * hypot(re[k], im[k]) <= exact * (1 + 1e-12));
    assert_true(one * hypot(re[k], im[k]) >= exact * 0.98); /* rays of a degree */
    least = fmin(least, one);
  }
  assert_true(step == least);
  double twice_re[4], twice_im[4];
  for (int k = 0; k < 4; k++) twice_re[k] = 2 * re[k], twice_im[k] = -2 * im[k];
  assert_true(fabs(sph_stability_step(method, 4, twice_re, twice_im) / step - 0.5) < 1e-12);
  assert_true(sph_stability_step(method, 0, re, im) == INFINITY);
}

static void unknown(void **state)
{
  (void)state;
  const double re = -1, im = 0;
  assert_true(isnan(sph_stability_extent("erk:none", pi)));
  assert_true(isnan(sph_stability_extent("imex:ark324l2sa-4-2-3", pi)));
  assert_true(isnan(sph_stability_extent("leapfrog", NAN)));
  assert_true(isnan(sph_stability_step("erk:none", 1, &re, &im)));
  sph_integrator_info info;
  for (int k = 0; sph_integrator_info_get(k, &info); k++)
    if (!strncmp(info.name, "erk:", 4)) assert_true(sph_stability_extent(info.name, pi) > 1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(least_stages),
      cmocka_unit_test(steps),
      cmocka_unit_test(unknown),
  };
  return cmocka_run_group_tests_name("stability", tests, NULL, NULL);
}
