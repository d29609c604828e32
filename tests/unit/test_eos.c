/* Equations of state against their definitions: c^2 by differentiation, the inverse, the work that
 * is the elastic energy, the cut, shocks, thermodynamics.  Refusals: test_eos_check.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_deriv.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>

#include "eos_table.h"
#include "sphode/material.h"

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
enum { LIQUIDS = 8 };
static int barotropic(int k, sph_eos *eos)
{
  switch (k) {
  case 0: *eos = sph_eos_tait(1000, 40, 7); break;
  case 1: *eos = sph_eos_tait(998.2, 1482, 7); break;
  case 2: *eos = sph_eos_tait(1.225, 340.3, 1.4); break;
  case 3: *eos = sph_eos_tait(2, 3, 1); break;
  case 4: *eos = sph_eos_linear(1000, 25, -INFINITY); break;
  case 5: *eos = sph_eos_linear(0.5, 1, -INFINITY); break;
  case 6: *eos = sph_eos_murnaghan(8930, 137e9, 5.5); break;
  case 7: *eos = sph_eos_murnaghan(1000, 2.15e9, 1); break;
  case LIQUIDS: *eos = sph_eos_isothermal(1.2, 290); break;
  case LIQUIDS + 1: *eos = sph_eos_polytropic(1.2, 7e4, 1.4); break;
  case LIQUIDS + 2: *eos = sph_eos_polytropic(3, 0.2, 5.0 / 3); break;
  default: return 0;
  }
  if (k % 2 && k < LIQUIDS) eos->p_background = 0.3 * eos->rho0 * eos->c0 * eos->c0;
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
    if (k < LIQUIDS)
      assert_true(pressure_of(&eos, eos.rho0, 0, &c) == eos.p_background);
    else
      assert_relative(pressure_of(&eos, eos.rho0, 0, &c), eos.p_background, 1e-15, "p(rho0)");
    assert_relative(c, eos.c0, 1e-15, "c(rho0)");
    if (strcmp(eos.name, "polytropic")) assert_true(eos.elastic_energy(&eos, eos.rho0) == 0);
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
    for (int k = 0; barotropic(k, &eos) && (!cut || k < LIQUIDS); k++) {
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
      if (e < 1e-5) /* u_el = (c0^2/2) e^2 (1 + 2 e/3 + ...): the power itself has no digits left */
        assert_relative(eos.elastic_energy(&eos, rho) / (800 * rounded * rounded),
                        1 + 2 * rounded / 3, 1e-9, "u_el");
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

/* ---- thermal ones */

/* A state of one: both branches of Mie-Grueneisen, tension, negative and zero energy. */
typedef struct thermal_state {
  sph_eos eos;
  double rho, u;
} thermal_state;

static int thermal(int k, thermal_state *s)
{
  const double x[] = {0.93, 0.999, 1.0003, 1.1, 1.4}, heat[] = {0, 1e4, 8e5};
  sph_eos kind[] = {
      sph_eos_ideal_gas_molar(1.4, 0.0289644),
      sph_eos_ideal_gas(5.0 / 3),
      sph_eos_stiffened_gas(1000, 4.4, 6e8, 0),
      sph_eos_stiffened_gas(1000, 2.35, 1e9, -1.167e6),
      sph_eos_stiffened_gas(1, 1.4, 0, 0),
      sph_eos_mie_grueneisen(8930, 3940, 1.49, 2),
      sph_eos_mie_grueneisen(2785, 5328, 1.338, 2),
      sph_eos_mie_grueneisen(7900, 4570, 1.49, 1.93),
      sph_eos_mie_grueneisen(1000, 1480, 1.75, 0.28),
  };
  int e = k / 15;
  if (e >= (int)(sizeof kind / sizeof *kind)) return 0;
  s->eos = kind[e];
  if (!(s->eos.c_v > 0)) s->eos.c_v = 400 + 50 * e;
  double rho0 = s->eos.rho0 > 0 ? s->eos.rho0 : 1.2;
  s->rho = rho0 * x[k % 5];
  s->u = heat[k / 5 % 3];
  if (!strcmp(s->eos.name, "stiffened-gas")) s->u += s->eos.q + s->eos.p_inf / s->rho;
  if (strcmp(s->eos.name, "mie-grueneisen")) s->u += 1; /* 0 is no state */
  return 1;
}

static double p_of_rho_u(double rho, void *context)
{
  const thermal_state *s = context;
  return pressure_of(&s->eos, rho, s->u, NULL);
}
static double p_of_u(double u, void *context)
{
  const thermal_state *s = context;
  return pressure_of(&s->eos, s->rho, u, NULL);
}
static double T_of_rho(double rho, void *context)
{
  const thermal_state *s = context;
  double T;
  sph_eos_temperature(&s->eos, 1, &rho, &s->u, &T);
  return T;
}
static double u_of_rho(double rho, void *context) /* s->u: T */
{
  const thermal_state *s = context;
  double u;
  sph_eos_energy(&s->eos, 1, &rho, &s->u, &u);
  return u;
}
static double slope(double (*function)(double, void *), thermal_state *s, double x, double step)
{
  double result, error;
  gsl_function f = {function, s};
  gsl_deriv_central(&f, x, step, &result, &error);
  return result;
}

static double c_of_rho(double rho, void *context)
{
  thermal_state *s = context;
  double c;
  pressure_of(&s->eos, rho, s->u, &c);
  return c;
}
static double c_of_u(double u, void *context)
{
  thermal_state *s = context;
  double c;
  pressure_of(&s->eos, s->rho, u, &c);
  return c;
}
static double T_of_u(double u, void *context)
{
  const thermal_state *s = context;
  double T;
  sph_eos_temperature(&s->eos, 1, &s->rho, &u, &T);
  return T;
}

/* unit: of the function itself; differences of GSL are right to about 1e-10 of unit/x. */
static void assert_slope(double found, double (*f)(double, void *), thermal_state *s, double x,
                         double scale, double unit)
{
  double expected = slope(f, s, x, 1e-4 * scale);
  if (!(fabs(found - expected) <= 1e-9 * (unit / scale + fabs(expected))))
    fail_msg("%s at %g, %g: slope %.15g, by differences %.15g", s->eos.name, s->rho, s->u, found,
             expected);
}

/* Formulas, and the differences in their place. */
static void slopes_at(thermal_state *s)
{
  double p_rho, p_u, c_rho, c_u, T_rho, T_u, c, p = pressure_of(&s->eos, s->rho, s->u, &c), T = 0;
  double unit = fabs(p) + s->rho * c * c, scale = fabs(s->u) + c * c;
  sph_eos_slopes(&s->eos, 1, &s->rho, &s->u, &p_rho, &p_u, &c_rho, &c_u);
  assert_slope(p_rho, p_of_rho_u, s, s->rho, s->rho, unit);
  assert_slope(c_rho, c_of_rho, s, s->rho, s->rho, c);
  if (s->eos.thermal) {
    assert_slope(p_u, p_of_u, s, s->u, scale, unit);
    assert_slope(c_u, c_of_u, s, s->u, scale, c);
  } else
    assert_true(p_u == 0 && c_u == 0);
  if (!(s->eos.c_v > 0)) return;
  sph_eos_temperature(&s->eos, 1, &s->rho, &s->u, &T);
  sph_eos_slopes_temperature(&s->eos, 1, &s->rho, &s->u, &T_rho, &T_u);
  assert_slope(T_rho, T_of_rho, s, s->rho, s->rho, scale / s->eos.c_v + fabs(T));
  assert_slope(T_u, T_of_u, s, s->u, scale, scale / s->eos.c_v + fabs(T));
}

static void slopes(void **state)
{
  (void)state;
  thermal_state s;
  for (int differences = 0; differences < 2; differences++) {
    for (int k = 0; thermal(k, &s); k++) {
      if (differences) s.eos.slopes = NULL;
      int solid = !strcmp(s.eos.name, "mie-grueneisen"), cold = k / 5 % 3 == 0 && !solid;
      int kink = solid && fabs(s.rho / s.eos.rho0 - 1) < 0.01;
      int near = differences && k / 5 % 3 < 2 && !solid; /* c -> 0 is less than 7 % of rho away */
      if (cold || kink || near) continue; /* no state, or a kink of c, is beside it */
      slopes_at(&s);
    }
    for (int k = 0; barotropic(k, &s.eos); k++) {
      if (differences) s.eos.slopes = NULL;
      for (double x = 0.9; x < 1.15; x += 0.0377) {
        s.rho = x * s.eos.rho0;
        slopes_at(&s);
      }
    }
  }
  s.eos = sph_eos_linear(1000, 20, 0);
  double on_the_cut = 990, u = 0, p_rho, p_u, c_rho, c_u;
  sph_eos_slopes(&s.eos, 1, &on_the_cut, &u, &p_rho, &p_u, &c_rho, &c_u);
  assert_true(p_rho == 0 && c_rho == 0);
}

/* c^2 = (dp/drho)_u + (p/rho^2) (dp/du)_rho; steps that stay on one branch. */
static void thermal_sound_speed(void **state)
{
  (void)state;
  thermal_state s;
  for (int k = 0; thermal(k, &s); k++) {
    double c, p = pressure_of(&s.eos, s.rho, s.u, &c);
    double p_rho = slope(p_of_rho_u, &s, s.rho, 2e-4 * s.rho);
    double p_u = slope(p_of_u, &s, s.u, 1e-3 * (fabs(s.u) + c * c));
    double unit = fabs(p_rho) + fabs(p / (s.rho * s.rho) * p_u);
    if (!(fabs(c * c - p_rho - p / (s.rho * s.rho) * p_u) <= 1e-9 * unit))
      fail_msg("%s at %g, %g: c %.15g, by differences %.15g", s.eos.name, s.rho, s.u, c,
               sqrt(p_rho + p / (s.rho * s.rho) * p_u));
  }
}

static void thermal_inverse(void **state)
{
  (void)state;
  thermal_state s;
  for (int k = 0; thermal(k, &s); k++) {
    double c, p = pressure_of(&s.eos, s.rho, s.u, &c);
    assert_relative(s.eos.density(&s.eos, p, s.u), s.rho, 1e-13, s.eos.name);
    double u = s.eos.energy_at(&s.eos, s.rho, p);
    if (!(fabs(u - s.u) <= 1e-13 * (fabs(s.u) + c * c)))
      fail_msg("%s: u %.17g, expected %.17g", s.eos.name, u, s.u);
    assert_null(s.eos.elastic_energy);
  }
}

/* (du/drho)_T = (p - T (dp/dT)_rho)/rho^2, and along an isentrope, du = p/rho^2 drho,
 * c_v dT = T (dp/dT)_rho/rho^2 drho.  Units: p + rho c^2; u of one is T of the other. */
static void thermodynamics(void **state)
{
  (void)state;
  thermal_state s;
  for (int k = 0; thermal(k, &s); k++) {
    double c, p = pressure_of(&s.eos, s.rho, s.u, &c), T, u, pT, near;
    double rho2 = s.rho * s.rho, unit = (fabs(p) + s.rho * c * c) / rho2;
    sph_eos_temperature(&s.eos, 1, &s.rho, &s.u, &T);
    sph_eos_energy(&s.eos, 1, &s.rho, &T, &u);
    if (!(fabs(u - s.u) <= 1e-13 * (fabs(s.u) + c * c)))
      fail_msg("%s: u(T(u)) %.17g, expected %.17g", s.eos.name, u, s.u);
    sph_eos_thermal_pressure(&s.eos, 1, &s.rho, &T, &pT);
    thermal_state at_T = {s.eos, s.rho, T}, differences = s;
    double u_rho = slope(u_of_rho, &at_T, s.rho, 2e-4 * s.rho);
    if (!(fabs(u_rho - (p - pT) / rho2) <= 1e-8 * unit))
      fail_msg("%s: (du/drho)_T %.12g, (p - pT)/rho^2 %.12g", s.eos.name, u_rho, (p - pT) / rho2);
    double T_s = slope(T_of_rho, &s, s.rho, 2e-4 * s.rho) + p / rho2 / s.eos.c_v;
    if (!(fabs(T_s - pT / rho2 / s.eos.c_v) <= 1e-8 * unit / s.eos.c_v))
      fail_msg("%s: dT/drho %.12g, pT/(rho^2 c_v) %.12g", s.eos.name, T_s, pT / rho2 / s.eos.c_v);
    differences.eos.thermal_pressure = NULL;
    if (T < 1) continue; /* differences in T say nothing there */
    sph_eos_thermal_pressure(&differences.eos, 1, &s.rho, &T, &near);
    if (!(fabs(near - pT) <= 1e-9 * (fabs(p) + s.rho * c * c)))
      fail_msg("%s: pT %.12g, by differences %.12g", s.eos.name, pT, near);
  }
}

static void temperature_defaults(void **state)
{
  (void)state;
  sph_eos water = sph_eos_tait(1000, 40, 7), gas = sph_eos_ideal_gas_molar(1.4, 0.0289644);
  double rho[3] = {1000, 1.2, 7}, u[3] = {0, 1e5, -3}, T[3], back[3], pT[3], R = 8.31446261815324;
  sph_eos_temperature(&water, 3, rho, u, T);
  sph_eos_energy(&water, 3, rho, u, back);
  sph_eos_thermal_pressure(&water, 3, rho, u, pT);
  for (int i = 0; i < 3; i++) assert_true(isnan(T[i]) && isnan(back[i]) && isnan(pT[i]));
  assert_int_equal(sph_eos_has_temperature(&water), 0);
  assert_int_equal(sph_eos_has_temperature(NULL), 0);
  water.c_v = 4157;
  assert_int_equal(sph_eos_has_temperature(&water), 1);
  sph_eos_temperature(&water, 3, rho, u, T);
  sph_eos_energy(&water, 3, rho, T, back);
  sph_eos_thermal_pressure(&water, 3, rho, T, pT);
  for (int i = 0; i < 3; i++) {
    assert_relative(T[i], u[i] / 4157, 1e-15, "T of a liquid");
    assert_relative(back[i], u[i], 1e-15, "u(T(u))");
    assert_true(pT[i] == 0);
  }
  for (double t = 100; t < 1000; t *= 1.3) { /* p = rho R T/M */
    sph_eos_energy(&gas, 1, &rho[1], &t, &u[0]);
    assert_relative(pressure_of(&gas, rho[1], u[0], NULL), rho[1] * R * t / 0.0289644, 1e-14, "p");
    sph_eos_thermal_pressure(&gas, 1, &rho[1], &t, &pT[0]);
    assert_relative(pT[0], rho[1] * R * t / 0.0289644, 1e-14, "T dp/dT");
  }
}

static void stiffened_water(void **state)
{
  (void)state;
  const double expected[][4] = {{4.4, 6e8, 0, 1625},
                                {2.35, 1e9, -1.167e6, 1533},
                                {7.15, 3e8, 0, 1465}};
  for (int k = 0; k < 3; k++) {
    sph_eos eos = sph_eos_stiffened_gas(1000, expected[k][0], expected[k][1], expected[k][2]);
    double c, p = pressure_of(&eos, 1000, eos.energy_at(&eos, 1000, 1e5), &c);
    assert_true(fabs(p - 1e5) < 1e-15 * 7.15 * 1e9 * 4);
    if (fabs(c - expected[k][3]) > 0.5) fail_msg("c = %g, expected %g", c, expected[k][3]);
    assert_relative(eos.c0, c, 2e-4, "c0");
  }
  sph_eos gas = sph_eos_ideal_gas(1.4), same = sph_eos_stiffened_gas(1, 1.4, 0, 0);
  double c[2];
  assert_relative(pressure_of(&same, 1.3, 2e5, &c[0]), pressure_of(&gas, 1.3, 2e5, &c[1]), 1e-15,
                  "p_inf = 0 is an ideal gas");
  assert_relative(c[0], c[1], 1e-15, "c of it");
}

/* Behind a shock U = c0 + s u_p: rho = rho0 U/(U - u_p), p = rho0 U u_p, u = u_p^2/2; and the same
 * as a function of m = rho/rho0 - 1. */
static void hugoniot(void **state)
{
  (void)state;
  const double solid[][4] = {{8930, 3940, 1.49, 2},
                             {2785, 5328, 1.338, 2},
                             {7900, 4570, 1.49, 1.93}};
  for (int k = 0; k < 3; k++) {
    double rho0 = solid[k][0], c0 = solid[k][1], s = solid[k][2];
    sph_eos eos = sph_eos_mie_grueneisen(rho0, c0, s, solid[k][3]);
    for (double u_p = 10; u_p < 8000; u_p *= 1.5) {
      double U = c0 + s * u_p, rho = rho0 * U / (U - u_p), m = u_p / (U - u_p), b = 1 - (s - 1) * m;
      double p = pressure_of(&eos, rho, 0.5 * u_p * u_p, NULL);
      assert_relative(p, rho0 * U * u_p, 1e-12, "p behind the shock");
      assert_relative(p, rho0 * c0 * c0 * m * (1 + m) / (b * b), 1e-12, "p(m)");
    }
  }
}

static void branches_join(void **state)
{
  (void)state;
  sph_eos eos = sph_eos_mie_grueneisen(8930, 3940, 1.49, 2);
  double below = nextafter(8930, 0), above = nextafter(8930, INFINITY), c[3];
  for (double u = 0; u < 2e6; u += 3e5) {
    double p[] = {pressure_of(&eos, below, u, &c[0]), pressure_of(&eos, 8930, u, &c[1]),
                  pressure_of(&eos, above, u, &c[2])};
    for (int k = 0; k < 3; k++) {
      assert_true(fabs(p[k] - 2 * 8930 * u) <= 1e-14 * 8930 * 3940.0 * 3940.0);
      assert_relative(c[k], sqrt(3940.0 * 3940.0 + 4 * u), 1e-14, "c at rho0");
    }
  }
}

/* p/(rho0 c0^2) at u = 0, and the integrand of u_s with it. */
typedef struct isentrope {
  sph_eos eos;
  double chi;
} isentrope;
static double heat_of(double x, void *context)
{
  const isentrope *i = context;
  double p = pressure_of(&i->eos, i->eos.rho0 / (1 - x), 0, NULL);
  return exp(i->eos.grueneisen * (i->chi - x)) * p / i->eos.rho0;
}

/* On the isentrope through rho0, u = 0: T = 298.15 K exp(Gamma0 chi), u by adaptive integration. */
static void isentrope_of_a_solid(void **state)
{
  (void)state;
  gsl_integration_workspace *room = gsl_integration_workspace_alloc(1000);
  isentrope i = {.eos = sph_eos_mie_grueneisen(8930, 3940, 1.49, 2)};
  i.eos.c_v = 383;
  for (i.chi = -0.4; i.chi < 0.8 / 1.49; i.chi += 0.0313) {
    gsl_function f = {heat_of, &i};
    double u, error, T, rho = 8930 / (1 - i.chi);
    gsl_integration_qag(&f, 0, i.chi, 0, 1e-13, 1000, GSL_INTEG_GAUSS61, room, &u, &error);
    sph_eos_temperature(&i.eos, 1, &rho, &u, &T);
    double expected = 298.15 * exp(2 * i.chi);
    if (!(fabs(T - expected) <= 1e-12 * u / 383 + 1e-12 * expected))
      fail_msg("chi %g: T %.15g, expected %.15g", i.chi, T, expected);
  }
  gsl_integration_workspace_free(room);
}

static void no_such_state(void **state)
{
  (void)state;
  sph_eos gas = sph_eos_ideal_gas(1.4), water = sph_eos_stiffened_gas(1000, 4.4, 6e8, 0);
  sph_eos copper = sph_eos_mie_grueneisen(8930, 3940, 1.49, 2);
  double c, rho[] = {1, 1, 1, 1}, u[] = {1, 2, -1, 0}, limit = 8930 / (1 - 1 / 1.49);
  const double bad[] = {0, -1, NAN, INFINITY};
  for (int k = 0; k < 4; k++) {
    pressure_of(&gas, 1, bad[k], &c);
    assert_false(c < INFINITY);
  }
  assert_int_equal(sph_eos_find_bad(&gas, 4, rho, u), 2);
  assert_int_equal(sph_eos_find_bad(&gas, 2, rho, u), -1);
  assert_int_equal(sph_eos_find_bad(&gas, 0, NULL, NULL), -1);
  pressure_of(&water, 1000, 6e5 * (1 + 1e-9), &c); /* p_inf/rho: p = -p_inf */
  assert_true(c > 0 && c < 1);
  pressure_of(&water, 1000, 6e5 * (1 - 1e-9), &c);
  assert_true(isnan(c));
  pressure_of(&copper, limit * (1 - 1e-6), 0, &c);
  assert_true(c > 0);
  pressure_of(&copper, limit * (1 + 1e-6), 0, &c);
  assert_true(isnan(c));
  pressure_of(&copper, 1.5 * limit, 1e9, &c);
  assert_true(isnan(c));
  pressure_of(&copper, 4000, 0, &c); /* torn */
  assert_true(isnan(c));
}

static void matched(void **state)
{
  (void)state;
  sph_eos water = sph_eos_tait(1000, 40, 7), linear = sph_eos_linear(800, 30, 0);
  water.p_background = 1e4;
  sph_eos air = sph_eos_tait_matched(&water, 1.225, 1.4),
          oil = sph_eos_tait_matched(&linear, 900, 7);
  assert_relative(air.c0, 40 * sqrt(1000 / 1.225 * 0.2), 1e-15, "c0 of the air");
  assert_relative(air.rho0 * air.c0 * air.c0 / air.gamma, 1000 * 40.0 * 40.0 / 7, 1e-14, "B");
  assert_relative(oil.rho0 * oil.c0 * oil.c0 / oil.gamma, 800 * 30.0 * 30.0, 1e-14, "B");
  assert_true(air.p_background == 1e4 && air.gamma == 1.4 && air.rho0 == 1.225);
  assert_int_equal(sph_eos_check(&air, NULL), SPH_OK);
  /* equal relative compression, equal pressure */
  assert_relative(pressure_of(&air, 1.225 * pow(1.1, 1 / 1.4), 0, NULL),
                  pressure_of(&water, 1000 * pow(1.1, 1 / 7.0), 0, NULL), 1e-13, "p");
}

/* ---- presets */

/* U.S. Standard Atmosphere 1976, eqs. 51 and 53, at 288.15 K; Ramires et al. 1995, eq. 5, at
 * 293.15 K. */
static const double air_T = 288.15;
static double air_viscosity(void) { return 1.458e-6 * pow(air_T, 1.5) / (air_T + 110.4); }
static double air_conductivity(void)
{
  return 2.64638e-3 * pow(air_T, 1.5) / (air_T + 245.4 * pow(10, -12 / air_T));
}
static double water_conductivity(void)
{
  double t = 293.15 / 298.15;
  return 0.6065 * (-1.48445 + 4.12292 * t - 1.63866 * t * t);
}

static void presets(void **state)
{
  (void)state;
  const struct {
    const char *name, *eos;
    double rho, p, c, viscosity, conductivity, c_v, exact; /* p, c at rho; relative */
  } row[] = {
      {"water", "tait", 998.207, 0, 1482.35, 1.0016e-3, water_conductivity(), 4156.7, 5e-4},
      {"water-stiffened", "stiffened-gas", 1000, 1e5, 1533, 0, 0, 1816, 2e-4},
      {"water-shock", "stiffened-gas", 1000, 1e5, 1625, 0, 0, 0, 2e-4},
      {"air", "ideal-gas", 1.225, 101325, 340.294, air_viscosity(), air_conductivity(),
       8.31432 / 0.0289644 / 0.4, 1e-4},
      {"air-tait", "tait", 1.225, 0, 340.294, air_viscosity(), air_conductivity(), 717.6, 1e-4},
      {"copper", "mie-grueneisen", 8930, 0, 3940, 0, 0, 383, 1e-3},
      {"aluminium", "mie-grueneisen", 2785, 0, 5328, 0, 0, 875, 1e-3},
      {"steel", "mie-grueneisen", 7900, 0, 4570, 0, 0, 477, 1e-3},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    sph_material m = sph_material_preset(row[k].name, 0);
    double c, u = 0;
    assert_string_equal(m.eos.name, row[k].eos);
    assert_int_equal(sph_eos_check(&m.eos, NULL), SPH_OK);
    assert_relative(m.eos.rho0, row[k].rho, row[k].exact, "density");
    if (m.eos.thermal) u = m.eos.energy_at(&m.eos, row[k].rho, row[k].p);
    pressure_of(&m.eos, row[k].rho, u, &c);
    assert_relative(c, row[k].c, row[k].exact, row[k].name);
    assert_relative(m.viscosity, row[k].viscosity, row[k].exact, "viscosity");
    assert_relative(m.conductivity, row[k].conductivity, row[k].exact, "conductivity");
    assert_relative(m.eos.c_v, row[k].c_v, row[k].exact, "c_v");
    assert_true(m.source && strlen(m.source) > 10);
  }
  sph_material air = sph_material_preset("air", 0), tait = sph_material_preset("air-tait", 0);
  double u, T = air_T;
  sph_eos_energy(&air.eos, 1, &air.eos.rho0, &T, &u);
  assert_relative(pressure_of(&air.eos, air.eos.rho0, u, NULL), 101325, 3e-5, "1 atm");
  assert_relative(tait.eos.rho0 * tait.eos.c0 * tait.eos.c0 / 1.4, 101325, 1e-4, "B of air");
}

static void presets_with_a_numerical_sound_speed(void **state)
{
  (void)state;
  const char *name, *weak[] = {"water", "air-tait", "oil"};
  int n = 0;
  for (int k = 0; k < 3; k++) {
    sph_material m = sph_material_preset(weak[k], 25);
    assert_true(m.eos.c0 == 25 && m.eos.rho0 > 0 && m.eos.gamma > 1 && m.viscosity > 0);
    assert_int_equal(sph_eos_check(&m.eos, NULL), SPH_OK);
    assert_null(sph_material_preset(weak[k], -1).eos.name);
    assert_null(sph_material_preset(weak[k], NAN).eos.name);
  }
  sph_material oil = sph_material_preset("oil", 20);
  assert_relative(oil.viscosity / oil.eos.rho0, 1.16e-4, 3e-3, "nu of oil");
  assert_null(sph_material_preset("oil", 0).eos.name);
  assert_null(sph_material_preset("copper", 20).eos.name);
  assert_null(sph_material_preset("plutonium", 0).eos.name);
  assert_null(sph_material_preset(NULL, 0).eos.name);
  for (; (name = sph_material_name(n)); n++) assert_non_null(sph_material_about(name));
  assert_int_equal(n, 9);
  assert_null(sph_material_name(-1));
  assert_null(sph_material_about("plutonium"));
  assert_null(sph_material_about(NULL));
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

static void accepted(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_eos eos, own = sph_eos_tait(1000, 40, 7);
  for (int k = 0; barotropic(k, &eos); k++) assert_int_equal(sph_eos_check(&eos, &error), SPH_OK);
  eos = sph_eos_ideal_gas(5.0 / 3);
  assert_int_equal(sph_eos_check(&eos, &error), SPH_OK);
  own.name = "my-own", own.gamma = 0, own.elastic_energy = NULL; /* not a built-in one: no gamma */
  assert_int_equal(sph_eos_check(&own, &error), SPH_OK);
  assert_string_equal(error.text, "");
}

static void dust(void **state)
{
  sph_eos eos = sph_eos_dust();
  double rho[] = {0.1, 1e9}, p[] = {1, 1}, c[] = {1, 1};
  (void)state;
  assert_int_equal(sph_eos_check(&eos, NULL), SPH_OK);
  eos.pressure(&eos, 2, rho, NULL, p, c);
  assert_true(p[0] == 0 && p[1] == 0 && c[0] == 0 && c[1] == 0 && isnan(eos.density(&eos, 0, 0)));
}

static void names(void **state)
{
  (void)state;
  const char *expected[] = {"tait",          "linear",         "murnaghan",
                            "isothermal",    "polytropic",     "ideal-gas",
                            "stiffened-gas", "mie-grueneisen", "dust"};
  const char *name;
  int k = 0;
  for (; (name = sph_eos_name(k)); k++) {
    assert_string_equal(name, expected[k]);
    assert_non_null(strstr(sph_eos_formula(name), "p = "));
  }
  assert_int_equal(k, 9);
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
      cmocka_unit_test(slopes),
      cmocka_unit_test(dust),
      cmocka_unit_test(thermal_sound_speed),
      cmocka_unit_test(thermal_inverse),
      cmocka_unit_test(thermodynamics),
      cmocka_unit_test(temperature_defaults),
      cmocka_unit_test(stiffened_water),
      cmocka_unit_test(hugoniot),
      cmocka_unit_test(branches_join),
      cmocka_unit_test(isentrope_of_a_solid),
      cmocka_unit_test(no_such_state),
      cmocka_unit_test(matched),
      cmocka_unit_test(presets),
      cmocka_unit_test(presets_with_a_numerical_sound_speed),
      cmocka_unit_test(arrays),
      cmocka_unit_test(accepted),
      cmocka_unit_test(names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
