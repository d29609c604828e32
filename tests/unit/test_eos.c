/* Equations of state against their definitions: c^2 by differentiation, the inverse, the work that
 * is the elastic energy, the cut, and refusals with a text. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_deriv.h>
#include <gsl/gsl_math.h>

#include "eos_table.h"

static double pressure_of(const sph_eos *eos, double rho, double u, double *c)
{
  double p, c_;
  eos->pressure(eos, 1, &rho, eos->thermal ? &u : NULL, &p, c ? c : &c_);
  return p;
}

static void assert_relative(double found, double expected, double tolerance, const char *what)
{
  if (fabs(found - expected) <= tolerance * fabs(expected)) return; /* NaN fails */
  fail_msg("%s: %.17g, expected %.17g (relative %g)", what, found, expected, tolerance);
}

/* Barotropic ones, stiff and soft, with and without background. */
static int barotropic(int k, sph_eos *eos)
{
  switch (k) {
  case 0: *eos = sph_eos_tait(1000, 40, 7); break;
  case 1: *eos = sph_eos_tait(998.2, 1482, 7); break;
  case 2: *eos = sph_eos_tait(1.225, 340.3, 1.4); break;
  case 3: *eos = sph_eos_tait(2, 3, 1); break;
  case 4: *eos = sph_eos_linear(1000, 25, -INFINITY); break;
  case 5: *eos = sph_eos_linear(0.5, 1, -INFINITY); break;
  default: return 0;
  }
  if (k % 2) eos->p_background = 0.3 * eos->rho0 * eos->c0 * eos->c0;
  return 1;
}

static double p_of_rho(double rho, void *context)
{
  const sph_eos *eos = context;
  return pressure_of(eos, rho, 0, NULL);
}
static double energy_of_rho(double rho, void *context)
{
  const sph_eos *eos = context;
  return eos->elastic_energy(eos, rho);
}
static double derivative(double (*function)(double, void *), sph_eos *eos, double x)
{
  double result, error;
  gsl_function f = {function, eos};
  gsl_deriv_central(&f, x, 1e-3 * x, &result, &error);
  return result;
}

static void reference_state(void **state)
{
  (void)state;
  sph_eos eos;
  for (int k = 0; barotropic(k, &eos); k++) {
    double c;
    assert_true(pressure_of(&eos, eos.rho0, 0, &c) == eos.p_background);
    assert_relative(c, eos.c0, 1e-15, "c(rho0)");
    assert_true(eos.elastic_energy(&eos, eos.rho0) == 0);
    assert_relative(eos.density(&eos, eos.p_background, 0), eos.rho0, 1e-15, "rho(p_b)");
    assert_false(eos.thermal);
  }
}

static void sound_speed(void **state)
{
  (void)state;
  sph_eos eos;
  for (int k = 0; barotropic(k, &eos); k++)
    for (double x = 0.8; x < 1.25; x += 0.0377) {
      double c;
      pressure_of(&eos, x * eos.rho0, 0, &c);
      assert_relative(c * c, derivative(p_of_rho, &eos, x * eos.rho0), 1e-9, "c^2");
    }
}

static void inverse(void **state)
{
  (void)state;
  sph_eos eos;
  for (int k = 0; barotropic(k, &eos); k++)
    for (double x = 0.8; x < 1.25; x += 0.0377) {
      double p = pressure_of(&eos, x * eos.rho0, 0, NULL);
      assert_relative(eos.density(&eos, p, 0), x * eos.rho0, 1e-14, eos.name);
    }
}

/* du_el/drho = p/rho^2; unit: c0^2/rho0. */
static void elastic_energy(void **state)
{
  (void)state;
  sph_eos eos;
  for (int cut = 0; cut < 2; cut++)
    for (int k = 0; barotropic(k, &eos); k++) {
      double unit = eos.c0 * eos.c0 / eos.rho0;
      if (cut) eos.p_min = eos.p_background - 0.03 * unit * eos.rho0 * eos.rho0;
      for (double x = 0.8; x < 1.25; x += 0.0377) {
        double rho = x * eos.rho0, p = pressure_of(&eos, rho, 0, NULL);
        double slope = derivative(energy_of_rho, &eos, rho);
        if (fabs(slope - p / (rho * rho)) > 1e-9 * unit)
          fail_msg("%s: du/drho %.15g, p/rho^2 %.15g", eos.name, slope, p / (rho * rho));
      }
    }
}

/* gamma = 7 has a polynomial of its own: it agrees with the power, and keeps its digits where rho
 * is almost rho0. */
static void polynomial_is_power(void **state)
{
  (void)state;
  sph_eos eos = sph_eos_tait(1000, 40, 7);
  double B = 1000 * 40.0 * 40.0 / 7;
  for (double e = 1e-9; e < 0.3; e *= 1.7)
    for (int sign = -1; sign <= 1; sign += 2) {
      double rho = 1000 * (1 + sign * e), rounded = (rho - 1000) / 1000, c;
      double p = pressure_of(&eos, rho, 0, &c);
      assert_relative(p, B * expm1(7 * log1p(rounded)), 1e-13, "p");
      assert_relative(c, 40 * pow(rho / 1000, 3), 1e-13, "c");
    }
  for (double x = 0.5; x < 1.5; x += 0.05) {
    sph_eos near = sph_eos_tait(1000, 40, nextafter(7, 8)); /* the way of any gamma */
    double c[2], p[2] = {pressure_of(&eos, 1000 * x, 0, c), pressure_of(&near, 1000 * x, 0, c + 1)};
    if (fabs(x - 1) > 0.01) assert_relative(p[0], p[1], 1e-13, "p, any gamma");
    assert_relative(c[0], c[1], 1e-13, "c, any gamma");
    if (fabs(x - 1) > 0.01) assert_relative(p[0], B * (pow(x, 7) - 1), 1e-13, "p by pow");
  }
}

static void cut(void **state)
{
  (void)state;
  sph_eos all[] = {sph_eos_linear(1000, 20, 0), sph_eos_tait(1000, 20, 7), sph_eos_tait(1, 2, 1.4)};
  all[1].p_min = all[2].p_min = 0;
  for (int k = 0; k < 3; k++) {
    const sph_eos *eos = &all[k];
    double c;
    for (double x = 0.5; x < 1; x += 0.0999) {
      assert_true(pressure_of(eos, x * eos->rho0, 0, &c) == 0);
      assert_true(c == 0);
    }
    assert_true(pressure_of(eos, eos->rho0, 0, &c) == 0);
    assert_relative(c, eos->c0, 1e-15, "c at rho0");
    assert_true(pressure_of(eos, 1.001 * eos->rho0, 0, &c) > 0);
    assert_relative(eos->density(eos, -5, 0), eos->rho0, 1e-15, "density at the cut");
    assert_true(eos->elastic_energy(eos, 0.7 * eos->rho0) == 0);
  }
}

/* c^2 = (dp/drho)_u + (p/rho^2) (dp/du)_rho, with arrays of an odd length. */
static void ideal_gas(void **state)
{
  (void)state;
  sph_eos eos = sph_eos_ideal_gas(1.4);
  double rho[7], u[7], p[7], c[7], p_rho[7], p_u[7], drho[7], du[7], c_[7];
  for (int i = 0; i < 7; i++) rho[i] = 0.1 + 0.3 * i, u[i] = 2.5 / (1 + i);
  for (int i = 0; i < 7; i++) drho[i] = 2 * rho[i], du[i] = 2 * u[i];
  eos.pressure(&eos, 7, rho, u, p, c);
  eos.pressure(&eos, 7, drho, u, p_rho, c_); /* p is linear in each: differences are exact */
  eos.pressure(&eos, 7, rho, du, p_u, c_);
  for (int i = 0; i < 7; i++) {
    double dp_drho = (p_rho[i] - p[i]) / rho[i], dp_du = (p_u[i] - p[i]) / u[i];
    assert_relative(c[i] * c[i], dp_drho + p[i] / (rho[i] * rho[i]) * dp_du, 1e-14, "c^2");
    assert_relative(eos.density(&eos, p[i], u[i]), rho[i], 1e-15, "rho(p, u)");
    assert_relative(p[i], 0.4 * rho[i] * u[i], 1e-14, "p");
  }
  assert_true(eos.thermal);
  assert_null(eos.elastic_energy);
}

static void arrays(void **state)
{
  (void)state;
  enum { N = 67 };
  sph_eos eos;
  for (int k = 0; barotropic(k, &eos); k++) {
    double rho[N], p[N + 1], c[N + 1], one;
    for (int i = 0; i < N; i++) rho[i] = eos.rho0 * (0.9 + 0.003 * i);
    p[N] = c[N] = 17;
    eos.pressure(&eos, N, rho, NULL, p, c);
    for (int i = 0; i < N; i++) {
      assert_relative(p[i] + eos.rho0 * eos.c0 * eos.c0,
                      pressure_of(&eos, rho[i], 0, &one) + eos.rho0 * eos.c0 * eos.c0, 1e-15,
                      "p[i]");
      assert_relative(c[i], one, 1e-15, "c[i]");
    }
    assert_true(p[N] == 17 && c[N] == 17);
    eos.pressure(&eos, 0, NULL, NULL, NULL, NULL);
  }
}

static void refuse(sph_eos eos, const char *word)
{
  sph_error error = {0};
  assert_int_equal(sph_eos_check(&eos, &error), SPH_ERR_ARGUMENT);
  if (!strstr(error.text, word)) fail_msg("\"%s\" does not tell of \"%s\"", error.text, word);
  assert_true(strlen(error.text) > 20);
}

static void refusals(void **state)
{
  (void)state;
  const double bad[] = {0, -1, NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 5; k++) {
    refuse(sph_eos_tait(bad[k], 40, 7), "rho0");
    refuse(sph_eos_tait(1000, bad[k], 7), "c0");
    refuse(sph_eos_tait(1000, 40, bad[k]), "gamma");
    refuse(sph_eos_linear(bad[k], 40, 0), "rho0");
    refuse(sph_eos_linear(1000, bad[k], 0), "c0");
    refuse(sph_eos_ideal_gas(bad[k]), "gamma");
  }
  refuse(sph_eos_tait(1000, 40, 0.99), "gamma");
  refuse(sph_eos_ideal_gas(1), "gamma");
  refuse(sph_eos_linear(1000, 40, NAN), "p_min");
  refuse(sph_eos_linear(1000, 40, INFINITY), "p_min");
  refuse(sph_eos_linear(1000, 1, -1000), "p_min"); /* cut at rho = 0 */
  sph_eos eos = sph_eos_tait(1000, 40, 7);
  eos.p_background = NAN, refuse(eos, "p_background"), eos.p_background = 0;
  eos.pressure = NULL, refuse(eos, "pressure"), eos = sph_eos_tait(1000, 40, 7);
  eos.density = NULL, refuse(eos, "density"), eos = sph_eos_tait(1000, 40, 7);
  eos.thermal = 2, refuse(eos, "thermal"), eos = sph_eos_tait(1000, 40, 7);
  eos.name = NULL, refuse(eos, "name");
  eos = sph_eos_ideal_gas(1.4), eos.p_background = 5, refuse(eos, "p_background");
  assert_int_equal(sph_eos_check(NULL, NULL), SPH_ERR_ARGUMENT);
}

static void accepted(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_eos eos, own = sph_eos_tait(1000, 40, 7);
  for (int k = 0; barotropic(k, &eos); k++) assert_int_equal(sph_eos_check(&eos, &error), SPH_OK);
  eos = sph_eos_ideal_gas(5.0 / 3);
  assert_int_equal(sph_eos_check(&eos, &error), SPH_OK);
  own.name = "murnaghan", own.gamma = 0,
  own.elastic_energy = NULL; /* not a built-in one: no gamma */
  assert_int_equal(sph_eos_check(&own, &error), SPH_OK);
  assert_string_equal(error.text, "");
}

static void names(void **state)
{
  (void)state;
  const char *expected[] = {"tait", "linear", "ideal-gas"}, *name;
  int k = 0;
  for (; (name = sph_eos_name(k)); k++) {
    assert_string_equal(name, expected[k]);
    assert_non_null(strstr(sph_eos_formula(name), "p = "));
  }
  assert_int_equal(k, 3);
  assert_null(sph_eos_name(-1));
  assert_null(sph_eos_formula("van-der-waals"));
  assert_null(sph_eos_formula(NULL));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reference_state),
      cmocka_unit_test(sound_speed),
      cmocka_unit_test(inverse),
      cmocka_unit_test(elastic_energy),
      cmocka_unit_test(polynomial_is_power),
      cmocka_unit_test(cut),
      cmocka_unit_test(ideal_gas),
      cmocka_unit_test(arrays),
      cmocka_unit_test(refusals),
      cmocka_unit_test(accepted),
      cmocka_unit_test(names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
