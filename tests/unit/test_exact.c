/* Exact solutions against published numbers and against the equations that they solve. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <complex.h>
#include <gsl/gsl_deriv.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_poly.h>
#include <gsl/gsl_sf_erf.h>

#include "exact.h"

static double largest; /* error of assert_near, of its tolerance */

static void assert_near(double found, double expected, double tolerance, const char *what)
{
  largest = fmax(largest, fabs(found - expected) / tolerance);
  if (fabs(found - expected) <= tolerance) return; /* NaN fails */
  fail_msg("%s: %.12g, expected %.12g +- %g", what, found, expected, tolerance);
}

/* Toro (2009), tables 4.1 to 4.3, with one unit of the last digit printed; for the collision the
 * table stops its iteration early (p* 1691.64696, u* 8.689774; see jump_conditions for what is
 * exact).  Sod to ten digits. */
enum { P, U, RHO_LEFT, RHO_RIGHT, STAR };
static const struct {
  const char *name;
  sph_exact_gas left, right;
  double star[STAR], unit[STAR];
} toro[] = {
    {"Sod",
     {1, 0, 1},
     {0.125, 0, 0.1},
     {0.3031301781, 0.9274526200, 0.4263194282, 0.2655737117},
     {1e-10, 1e-10, 1e-10, 1e-10}},
    {"123",
     {1, -2, 0.4},
     {1, 2, 0.4},
     {0.00189387, 0, 0.02185, 0.02185},
     {1e-8, 1e-15, 1e-5, 1e-5}},
    {"left blast",
     {1, 0, 1000},
     {1, 0, 0.01},
     {460.894, 19.5975, 0.57506, 5.99924},
     {1e-3, 1e-4, 1e-5, 1e-5}},
    {"right blast",
     {1, 0, 0.01},
     {1, 0, 100},
     {46.0950, -6.19633, 5.99242, 0.57511},
     {1e-4, 1e-5, 1e-5, 1e-5}},
    {"collision",
     {5.99924, 19.5975, 460.894},
     {5.99242, -6.19633, 46.0950},
     {1691.64, 8.68975, 14.2823, 31.0426},
     {1e-2, 3e-5, 1e-4, 1e-4}},
};
enum { TOROS = sizeof toro / sizeof toro[0] };

static sph_exact_riemann solved(int k, double gamma)
{
  sph_error error = {0};
  sph_exact_riemann r = {.gamma = gamma, .left = toro[k].left, .right = toro[k].right};
  if (sph_exact_riemann_solve(&r, &error)) fail_msg("%s: %s", toro[k].name, error.text);
  return r;
}

static void star_values(void **state)
{
  (void)state;
  largest = 0;
  for (int k = 0; k < TOROS; k++) {
    sph_exact_riemann r = solved(k, 1.4);
    const double star[STAR] = {r.p, r.u, r.rho_left, r.rho_right};
    for (int i = 0; i < STAR; i++)
      assert_near(star[i], toro[k].star[i], toro[k].unit[i], toro[k].name);
  }
  print_message("# star values: error %.2g of the last digit printed (Sod: of 1e-10)\n", largest);
  sph_exact_riemann r = solved(1, 1.4); /* its p*, known in closed form by symmetry */
  double c = sqrt(1.4 * 0.4);
  assert_near(r.p, 0.4 * pow(1 - 0.2 * 2 / c, 7), 1e-14, "123, closed form");
}

static void sod_speeds(void **state)
{
  (void)state;
  sph_exact_riemann r = solved(0, 1.4);
  assert_near(r.left_head, -1.1832159566, 1e-9, "head");
  assert_near(r.left_tail, -0.0702728126, 1e-9, "tail");
  assert_near(r.right_head, 1.7521557320, 1e-9, "shock");
  assert_true(r.right_head == r.right_tail);
  r = solved(0, 5.0 / 3);
  assert_near(r.p, 0.2939451877, 1e-9, "p, 5/3");
  assert_near(r.u, 0.8411948522, 1e-9, "u, 5/3");
  assert_near(r.rho_left, 0.4796890587, 1e-9, "rho left, 5/3");
  assert_near(r.rho_right, 0.2298057493, 1e-9, "rho right, 5/3");
  assert_near(r.right_head, 1.8444733671, 1e-9, "shock, 5/3");
}

/* Mass, momentum and energy through a shock of speed s: relative to the terms. */
static void assert_shock(const sph_exact_gas *a, const sph_exact_gas *b, double s, double gamma)
{
  double flux[2][3];
  const sph_exact_gas *side[] = {a, b};
  for (int k = 0; k < 2; k++) {
    double rho = side[k]->rho, w = side[k]->u - s, p = side[k]->p;
    flux[k][0] = rho * w;
    flux[k][1] = rho * w * w + p;
    flux[k][2] = w * (0.5 * rho * w * w + p * gamma / (gamma - 1));
  }
  for (int i = 0; i < 3; i++) assert_near(flux[0][i] / flux[1][i], 1, 1e-12, "Rankine-Hugoniot");
}

/* Along a rarefaction: entropy and the Riemann invariant of the side; sign +1: running right. */
static void assert_rarefaction(const sph_exact_gas *k, const sph_exact_gas *star, double gamma,
                               int sign)
{
  double c_k = sqrt(gamma * k->p / k->rho), c = sqrt(gamma * star->p / star->rho);
  double invariant = star->u - sign * 2 * c / (gamma - 1),
         before = k->u - sign * 2 * c_k / (gamma - 1);
  assert_near(star->p / pow(star->rho, gamma) / (k->p / pow(k->rho, gamma)), 1, 1e-12, "entropy");
  assert_near((invariant - before) / c_k, 0, 1e-12, "Riemann invariant");
}

static void jump_conditions(void **state)
{
  (void)state;
  largest = 0;
  for (int k = 0; k < TOROS; k++)
    for (double gamma = 1.2; gamma < 1.7; gamma += 0.2) {
      if (k == 1 && gamma > 1.5) continue; /* vacuum is nearer for stiff gases */
      sph_exact_riemann r = solved(k, gamma);
      sph_exact_gas left = {r.rho_left, r.u, r.p}, right = {r.rho_right, r.u, r.p};
      if (r.p > r.left.p)
        assert_shock(&r.left, &left, r.left_head, gamma);
      else
        assert_rarefaction(&r.left, &left, gamma, -1);
      if (r.p > r.right.p)
        assert_shock(&r.right, &right, r.right_head, gamma);
      else
        assert_rarefaction(&r.right, &right, gamma, 1);
    }
  print_message("# shocks and rarefactions: error %.2g of their terms\n", largest * 1e-12);
}

/* Inside a fan: u -+ c = x/t, invariant and entropy of its side; states outside; the contact. */
static void profile(void **state)
{
  (void)state;
  for (int k = 0; k < TOROS; k++) {
    sph_exact_riemann r = solved(k, 1.4);
    for (double x = 0.01; x < 1; x += 0.0313) {
      double left = r.left_head + x * (r.left_tail - r.left_head);
      double right = r.right_head + x * (r.right_tail - r.right_head);
      sph_exact_gas a = sph_exact_riemann_at(&r, left), b = sph_exact_riemann_at(&r, right);
      if (r.left_tail > r.left_head) {
        assert_near(a.u - sqrt(1.4 * a.p / a.rho), left, 1e-12, "left fan");
        assert_rarefaction(&r.left, &a, 1.4, -1);
      }
      if (r.right_tail < r.right_head) {
        assert_near(b.u + sqrt(1.4 * b.p / b.rho), right, 1e-12, "right fan");
        assert_rarefaction(&r.right, &b, 1.4, 1);
      }
    }
    sph_exact_gas far_left = sph_exact_riemann_at(&r, r.left_head - 1);
    sph_exact_gas far_right = sph_exact_riemann_at(&r, r.right_head + 1);
    assert_memory_equal(&far_left, &r.left, sizeof far_left);
    assert_memory_equal(&far_right, &r.right, sizeof far_right);
    double gap = 1e-6 * (r.right_tail - r.left_tail);
    assert_true(sph_exact_riemann_at(&r, r.u - gap).rho == r.rho_left);
    assert_true(sph_exact_riemann_at(&r, r.u + gap).rho == r.rho_right);
    assert_true(sph_exact_riemann_at(&r, r.u + gap).p == r.p);
  }
}

static void refuse_riemann(double gamma, sph_exact_gas left, sph_exact_gas right, const char *word)
{
  sph_error error = {0};
  sph_exact_riemann r = {.gamma = gamma, .left = left, .right = right};
  assert_int_equal(sph_exact_riemann_solve(&r, &error), SPH_ERR_ARGUMENT);
  if (!strstr(error.text, word)) fail_msg("\"%s\" does not tell of \"%s\"", error.text, word);
}

static void riemann_edges(void **state)
{
  (void)state;
  sph_exact_gas a = {1, 0, 1}, bad = {-1, 0, 1}, thin = {1, 0, 0}, fast = {1, NAN, 1};
  refuse_riemann(1, a, a, "gamma");
  refuse_riemann(NAN, a, a, "gamma");
  refuse_riemann(1.4, bad, a, "left state");
  refuse_riemann(1.4, a, thin, "right state");
  refuse_riemann(1.4, a, fast, "right state");
  refuse_riemann(1.4, (sph_exact_gas){1, -20, 0.4}, (sph_exact_gas){1, 20, 0.4}, "vacuum");
  sph_exact_riemann same = {.gamma = 1.4, .left = {2, 3, 4}, .right = {2, 3, 4}};
  assert_int_equal(sph_exact_riemann_solve(&same, NULL), SPH_OK);
  assert_near(same.p, 4, 1e-14, "nothing happens: p");
  assert_near(same.u, 3, 1e-14, "nothing happens: u");
  assert_near(same.rho_left, 2, 1e-14, "nothing happens: rho");
}

static int handled;
static void handler(const char *reason, const char *file, int line, int number)
{
  (void)reason, (void)file, (void)line, (void)number;
  handled++;
}

/* The user's own handler of GSL's errors is back afterwards. */
static void gsl_handler_restored(void **state)
{
  (void)state;
  double t = 0.1;
  sph_exact_ellipse ellipse;
  gsl_error_handler_t *before = gsl_set_error_handler(handler);
  solved(0, 1.4);
  sph_exact_drop_at(&(sph_exact_drop){1, 1, 1}, 1, &t, &ellipse, NULL);
  assert_ptr_equal(gsl_set_error_handler(before), handler);
  assert_int_equal(handled, 0);
}

static void drop(void **state)
{
  (void)state;
  sph_error error = {0};
  const double t = 0.0076;
  sph_exact_ellipse e;
  assert_int_equal(sph_exact_drop_at(&(sph_exact_drop){1, 100, 0}, 1, &t, &e, &error), SPH_OK);
  assert_near(e.a, 1.9445172, 5e-8, "a, Monaghan (1994)");
  assert_near(e.b, 0.5142665, 5e-8, "b, Monaghan (1994)");
  assert_int_equal(sph_exact_drop_at(&(sph_exact_drop){3, 100, 0}, 1, &t, &e, &error), SPH_OK);
  assert_near(e.a, 3 * 1.9445172, 15e-8, "scales with the radius");

  const double omega = 2, period = 2 * M_PI / (sqrt(2) * omega); /* small */
  const double quarters[] = {0, period / 4, period / 2, 3 * period / 4, period};
  sph_exact_ellipse five[5];
  sph_exact_drop small = {1, 1e-5, omega};
  assert_int_equal(sph_exact_drop_at(&small, 5, quarters, five, &error), SPH_OK);
  for (int k = 0; k < 5; k++) assert_near(five[k].rate, 1e-5 * cos(k * M_PI / 2), 1e-9, "rate");
  assert_near(five[0].p0, 0.5 * omega * omega, 1e-9, "p0 at rest");

  const double large = 4.8274 / omega; /* period for a rate of omega at t = 0 */
  assert_int_equal(sph_exact_drop_at(&(sph_exact_drop){1, omega, omega}, 1, &large, &e, &error),
                   SPH_OK);
  assert_near(e.rate, omega, 1e-3, "large period: rate");
  assert_near(e.a, 1, 1e-3, "large period: a");
}

/* a b is constant and so is the energy: (a^2 + b^2) (A^2 + omega^2). */
static void drop_invariants(void **state)
{
  (void)state;
  enum { N = 200 };
  double t[N];
  sph_exact_ellipse e[N];
  for (int k = 0; k < N; k++) t[k] = 0.11 * k;
  const sph_exact_drop parameters = {0.5, 1.3, 1};
  assert_int_equal(sph_exact_drop_at(&parameters, N, t, e, NULL), SPH_OK);
  for (int k = 0; k < N; k++) {
    double energy = (e[k].a * e[k].a + e[k].b * e[k].b) * (e[k].rate * e[k].rate + 1);
    assert_near(e[k].a * e[k].b, 0.25, 1e-11, "a b");
    assert_near(energy, 0.5 * (1.3 * 1.3 + 1), 1e-10, "energy");
    /* both axes ask for the same pressure */
    double rise = 2 * e[k].p0 / (e[k].a * e[k].a) - e[k].rate * e[k].rate - 1;
    double other = 0.5 * e[k].b * e[k].b * (-rise + e[k].rate * e[k].rate + 1);
    assert_near(other, e[k].p0, 1e-12, "p0");
  }
}

static void drop_refusals(void **state)
{
  (void)state;
  const double back[] = {0.2, 0.1}, negative = -1;
  sph_exact_ellipse e[2];
  sph_error error = {0};
  assert_int_equal(sph_exact_drop_at(&(sph_exact_drop){1, 1, 1}, 2, back, e, &error),
                   SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "time 1 = 0.1"));
  assert_int_equal(sph_exact_drop_at(&(sph_exact_drop){1, 1, 1}, 1, &negative, e, NULL),
                   SPH_ERR_ARGUMENT);
  assert_int_equal(sph_exact_drop_at(&(sph_exact_drop){0, 1, 1}, 1, back, e, NULL),
                   SPH_ERR_ARGUMENT);
  assert_int_equal(sph_exact_drop_at(&(sph_exact_drop){1, NAN, 1}, 1, back, e, NULL),
                   SPH_ERR_ARGUMENT);
}

static double pressure_at(double z, void *context)
{
  double p = NAN;
  sph_exact_column_at(context, 1, &z, NULL, &p, NULL);
  return p;
}

static void column(void **state)
{
  (void)state;
  sph_exact_column columns[] = {
      {sph_eos_tait(1000, 40, 7), 1, 0, 9.81},
      {sph_eos_tait(1000, 40, 1.4), 1, 3000, 9.81},
      {sph_eos_tait(1000, 40, 1), 1, 0, 9.81},
      {sph_eos_linear(1000, 40, -INFINITY), 1, -500, 9.81},
  };
  columns[0].eos.p_background = columns[0].p_surface = 1e4;
  for (int k = 0; k < 4; k++) {
    sph_exact_column *c = &columns[k];
    for (double z = 0; z < 0.98; z += 0.0777) {
      double rho, slope, error;
      gsl_function f = {pressure_at, c};
      assert_int_equal(sph_exact_column_at(c, 1, &z, &rho, NULL, NULL), SPH_OK);
      gsl_deriv_central(&f, z, 1e-2, &slope, &error);
      assert_near(slope / (rho * c->g), -1, 1e-8, "dp/dz = -rho g");
    }
    assert_near(pressure_at(1, c), c->p_surface, 1e-9, "p at the surface");
    assert_near(pressure_at(2, c), c->p_surface, 1e-9, "p above the surface");
  }
  sph_error error = {0};
  double z = 0, rho;
  sph_exact_column gas = {sph_eos_ideal_gas(1.4), 1, 0, 9.81};
  assert_int_equal(sph_exact_column_at(&gas, 1, &z, &rho, NULL, &error), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "ideal-gas"));
  columns[0].p_surface = -1e9;
  assert_int_equal(sph_exact_column_at(&columns[0], 1, &z, &rho, NULL, NULL), SPH_ERR_ARGUMENT);
  columns[1].g = -1;
  assert_int_equal(sph_exact_column_at(&columns[1], 1, &z, &rho, NULL, NULL), SPH_ERR_ARGUMENT);
}

/* ---- what diffuses: the equation by differences of the solution, its limits, other series */

typedef double field_1d(double t, double x, const void *what);

/* df/dt and d2f/dx2 by central differences of order 4. */
static void derivatives(field_1d *f, const void *what, double t, double x, double dt, double dx,
                        double *f_t, double *f_xx)
{
  *f_t = (8 * (f(t + dt, x, what) - f(t - dt, x, what)) - f(t + 2 * dt, x, what) +
          f(t - 2 * dt, x, what)) /
         (12 * dt);
  *f_xx = (16 * (f(t, x + dx, what) + f(t, x - dx, what)) - f(t, x + 2 * dx, what) -
           f(t, x - 2 * dx, what) - 30 * f(t, x, what)) /
          (12 * dx * dx);
}

static double channel_velocity(double t, double y, const void *what)
{
  double v = NAN;
  assert_int_equal(sph_exact_channel_at(what, t, 1, &y, &v, NULL), SPH_OK);
  return v;
}

/* Couette flow of unit width, nu and speed as a sum of images of the moving wall: no series of
 * sines. */
static double couette_by_images(double t, double y)
{
  double sum = 0, width = 2 * sqrt(t);
  for (int k = 0; k < 40; k++)
    sum += gsl_sf_erfc((2 * k + 1 - y) / width) - gsl_sf_erfc((2 * k + 1 + y) / width);
  return sum;
}

static void channel(void **state)
{
  (void)state;
  const sph_exact_channel both = {0.5, 0.3, 2, 4}; /* of all, and of no unit value */
  for (double t = 0.02; t < 0.8; t *= 1.7)
    for (double y = 0.05; y < 0.5; y += 0.049) {
      double v_t, v_yy;
      derivatives(channel_velocity, &both, t, y, 1e-3 * t, 2e-3, &v_t, &v_yy);
      assert_near(v_t - both.nu * v_yy, both.force, 1e-5, "dv/dt - nu v'' = force");
    }
  for (double y = 0; y <= 0.5; y += 0.05) {
    double steady = 2 * y / 0.5 + 4 * y * (0.5 - y) / (2 * 0.3);
    assert_near(channel_velocity(100, y, &both), steady, 1e-14, "steady state");
  }
  assert_near(channel_velocity(1e-4, 0.25, &both), 4e-4, 1e-15, "start: force t, far from walls");
  assert_near(channel_velocity(0, 0.25, &both), 0, 0, "at rest");
  assert_near(channel_velocity(0.3, 0, &both), 0, 0, "lower wall");
  assert_near(channel_velocity(0.3, 0.5, &both), 2, 0, "upper wall");
  assert_near(channel_velocity(0.3, 0.6, &both), 2, 0, "inside the upper wall");
  const sph_exact_channel couette = {1, 1, 1, 0};
  for (double t = 1e-5; t < 2; t *= 3)
    for (double y = 0.02; y < 1; y += 0.07)
      assert_near(channel_velocity(t, y, &couette), couette_by_images(t, y), 1e-14, "images");
  const sph_exact_channel morris = {1e-3, 1e-6, 0, 1e-4}; /* V_max = 1.25e-5 m/s (1997) */
  assert_near(channel_velocity(10, 0.5e-3, &morris), 1.25e-5, 1e-9, "Morris (1997)");
}

static void channel_refusals(void **state)
{
  (void)state;
  const sph_exact_channel bad[] = {{0, 1, 1, 1},
                                   {1, -1, 1, 1},
                                   {1, 1, NAN, 1},
                                   {1, 1, 1, INFINITY}};
  const sph_exact_channel good = {1, 1, 1, 1};
  sph_error error = {0};
  double y = 0.5, v;
  for (int k = 0; k < 4; k++)
    assert_int_equal(sph_exact_channel_at(&bad[k], 1, 1, &y, &v, NULL), SPH_ERR_ARGUMENT);
  assert_int_equal(sph_exact_channel_at(&good, -1, 1, &y, &v, &error), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "t = -1 s"));
}

static double mode_temperature(double t, double x, const void *what)
{
  double T = NAN;
  assert_int_equal(sph_exact_heat_mode_at(what, t, 1, &x, &T, NULL), SPH_OK);
  return T;
}

static double step_temperature(double t, double x, const void *what)
{
  double T = NAN;
  assert_int_equal(sph_exact_heat_step_at(what, t, 1, &x, &T, NULL), SPH_OK);
  return T;
}

static void heat(void **state)
{
  (void)state;
  const sph_exact_heat_mode mode = {{300, 2, 5}, 7, 3}; /* alpha = 0.4 */
  const sph_exact_heat_step step = {{400, 3, 2}, {290, 0.5, 8}};
  const double alpha[] = {3 / 2.0, 0.5 / 8};
  double T_t, T_xx;
  for (double t = 0.1; t < 2; t *= 1.9)
    for (double x = -1.03; x < 1.1; x += 0.1) {
      derivatives(mode_temperature, &mode, t, x, 1e-3 * t, 4e-3, &T_t, &T_xx);
      assert_near(T_t, 0.4 * T_xx, 1e-5, "mode: dT/dt = alpha T''");
      derivatives(step_temperature, &step, t, x, 1e-3 * t, 4e-3, &T_t, &T_xx);
      assert_near(T_t, alpha[x > 0] * T_xx, 1e-4, "two media: dT/dt = alpha T''");
      double eta = x / (2 * sqrt(alpha[x > 0] * t));
      double far = x > 0 ? 290 : 400, middle = step_temperature(t, 0, &step);
      assert_near(step_temperature(t, x, &step), far + (middle - far) * gsl_sf_erfc(fabs(eta)),
                  1e-12 * far, "two media: GSL's erfc");
    }
  assert_near(mode_temperature(0, 0.2, &mode), 300 + 7 * sin(0.6), 1e-12, "mode: start");
  /* Where the media meet, temperature and heat flux are continuous. */
  const double t = 0.3, d = 1e-6;
  double left = (step_temperature(t, -d, &step) - step_temperature(t, -2 * d, &step)) / d;
  double right = (step_temperature(t, 2 * d, &step) - step_temperature(t, d, &step)) / d;
  assert_near(step_temperature(t, -1e-12, &step), step_temperature(t, 1e-12, &step), 1e-9, "T");
  assert_near(3 * left / (0.5 * right), 1, 1e-6, "flux");
  assert_near(step_temperature(0, -0.1, &step), 400, 0, "two media: start, left");
  assert_near(step_temperature(0, 0.1, &step), 290, 0, "two media: start, right");
  /* What one side loses the other gains: heat = capacity times the integral of T - T(0). */
  double lost = 0, gained = 0, dx = 2e-4;
  for (double x = dx / 2; x < 12; x += dx) {
    lost += 2 * (400 - step_temperature(t, -x, &step)) * dx;
    gained += 8 * (step_temperature(t, x, &step) - 290) * dx;
  }
  assert_near(lost / gained, 1, 1e-6, "energy");
}

static void heat_refusals(void **state)
{
  (void)state;
  sph_exact_heat_step step = {{400, 3, 2}, {290, 0.5, 0}};
  sph_exact_heat_mode mode = {{300, -2, 5}, 7, 3};
  sph_error error = {0};
  double x = 0.5, T;
  assert_int_equal(sph_exact_heat_step_at(&step, 1, 1, &x, &T, &error), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "right"));
  assert_int_equal(sph_exact_heat_mode_at(&mode, 1, 1, &x, &T, NULL), SPH_ERR_ARGUMENT);
  mode.medium.conductivity = 2;
  assert_int_equal(sph_exact_heat_mode_at(&mode, NAN, 1, &x, &T, NULL), SPH_ERR_ARGUMENT);
}

/* ---- flow and sound: the equations that they solve, by differences */

/* Navier and Stokes: dv/dt + v grad v + grad p/rho - nu laplacian v = 0, div v = 0. */
static void taylor_green(void **state)
{
  (void)state;
  const sph_exact_taylor_green f = {1.3, 2.1, 0.07, 900};
  const double e = 1e-3;
#define AT(t, x, y) sph_exact_taylor_green_at(&f, t, x, y)
  for (double x = 0.1; x < 3; x += 0.37)
    for (double y = 0.2; y < 3; y += 0.41) {
      const double t = 0.6;
      sph_exact_flow here = AT(t, x, y), east = AT(t, x + e, y), west = AT(t, x - e, y),
                     north = AT(t, x, y + e), south = AT(t, x, y - e), late = AT(t + e, x, y),
                     early = AT(t - e, x, y);
      const double p_of[2] = {east.p - west.p, north.p - south.p};
      assert_near((east.v[0] - west.v[0] + north.v[1] - south.v[1]) / (2 * e), 0, 1e-9, "div v");
      for (int d = 0; d < 2; d++) {
        double change = (late.v[d] - early.v[d]) / (2 * e);
        double advection =
            (here.v[0] * (east.v[d] - west.v[d]) + here.v[1] * (north.v[d] - south.v[d])) / (2 * e);
        double laplacian =
            (east.v[d] + west.v[d] + north.v[d] + south.v[d] - 4 * here.v[d]) / (e * e);
        assert_near(change + advection + p_of[d] / (2 * e * f.rho) - f.nu * laplacian, 0, 2e-5,
                    "momentum");
      }
    }
  assert_near(AT(0, M_PI / (2 * 2.1), 0).v[1], 1.3, 1e-15, "largest speed");
#undef AT
}

/* The double series that the single one sums up, and laplace p = 2 rho omega^2. */
static double square_series(const sph_exact_square *s, double x, double y)
{
  const double L = s->side, w = M_PI / L;
  double sum = 0;
  for (int m = 1; m < 600; m += 2)
    for (int n = 1; n < 600; n += 2)
      sum -= 32 / (m * n * M_PI * M_PI * (m * m + n * n) * w * w) * sin(m * w * (x + L / 2)) *
             sin(n * w * (y + L / 2));
  return s->rho * s->omega * s->omega * sum;
}

static void square(void **state)
{
  (void)state;
  const sph_exact_square s = {1.4, 0.7, 900};
  const double unit = s.rho * s.omega * s.omega * s.side * s.side, e = 1e-3;
#define AT(t, x, y) sph_exact_square_pressure(&s, t, x, y)
  assert_near(AT(0, 0, 0) / unit, -0.1473427, 5e-8, "centre");
  for (double x = -0.6; x < 0.7; x += 0.23)
    for (double y = -0.55; y < 0.7; y += 0.27) {
      double laplacian = (AT(0, x + e, y) + AT(0, x - e, y) + AT(0, x, y + e) + AT(0, x, y - e) -
                          4 * AT(0, x, y)) /
                         (e * e);
      assert_near(AT(0, x, y) / unit, square_series(&s, x, y) / unit, 2e-6, "double series");
      assert_near(laplacian / (2 * s.rho * s.omega * s.omega), 1, 1e-3, "laplacian");
      double a = s.omega * 0.9; /* clockwise: (x, y) has come to where v = omega (y, -x) leads */
      assert_near(AT(0.9, x * cos(a) + y * sin(a), y * cos(a) - x * sin(a)), AT(0, x, y),
                  1e-10 * unit, "turned");
    }
  assert_near(AT(0, 0.7, 0.2), 0, 0, "side");
  assert_near(AT(0, 0.2, -0.71), 0, 0, "outside");
  assert_near(AT(0, 0.6999999, 0.2) / unit, 0, 5e-6, "near a side");
#undef AT
}

/* d rho/dt = -rho0 dv/dx, rho0 dv/dt = -dp/dx, dp = c^2 d rho. */
static void wave(void **state)
{
  (void)state;
  const double e = 1e-4, a = 1e-3;
  for (int standing = 0; standing < 2; standing++) {
    const sph_exact_wave w = {1.2, 5, 3, a, 2.2, standing};
#define AT(t, x) sph_exact_wave_at(&w, t, x)
    for (double x = 0; x < 3; x += 0.17)
      for (double t = 0.1; t < 2; t += 0.23) {
        sph_exact_gas late = AT(t + e, x), early = AT(t - e, x), east = AT(t, x + e),
                      west = AT(t, x - e), here = AT(t, x);
        assert_near((late.rho - early.rho + 1.2 * (east.u - west.u)) / (2 * e), 0, 1e-6 * a,
                    "continuity");
        assert_near((1.2 * (late.u - early.u) + east.p - west.p) / (2 * e), 0, 1e-5 * a,
                    "momentum");
        assert_near(here.p - 5, 9 * (here.rho - 1.2), 1e-14, "c^2");
        assert_near(AT(t + 2 * M_PI / (3 * 2.2), x).rho, here.rho, 1e-15, "period");
      }
    assert_near(AT(0, 0).rho, 1.2 * (1 + a), 1e-15, "crest");
    assert_near(AT(0, 0.3).u, standing ? 0 : 3 * a * cos(0.66), 1e-17, "velocity at the start");
#undef AT
  }
}

/* ---- a fluid with dust */

/* Laibe & Price (2012), section 4.1: v_d = (1 + e^-2t)/2 for densities 1, K = 1, and v_d = 1, v_f =
 * 0 at the start; else momentum, energy and the equations by differences. */
static void dusty_box(void **state)
{
  (void)state;
  const sph_exact_dusty_box one = {{1, 0}, {1, 1}, 1, 0}, b = {{1.3, -0.4}, {0.2, 2}, 3, 7};
  sph_exact_streams s, late, early;
  for (double t = 0; t < 3; t += 0.25) {
    assert_int_equal(sph_exact_dusty_box_at(&one, t, &s, NULL), SPH_OK);
    assert_near(s.dust, (1 + exp(-2 * t)) / 2, 1e-15, "v_d");
    assert_near(s.fluid, (1 - exp(-2 * t)) / 2, 1e-15, "v_f");
    const double e = 1e-4;
    assert_int_equal(sph_exact_dusty_box_at(&b, t + e, &early, NULL), SPH_OK);
    assert_int_equal(sph_exact_dusty_box_at(&b, t + 2 * e, &s, NULL), SPH_OK);
    assert_int_equal(sph_exact_dusty_box_at(&b, t + 3 * e, &late, NULL), SPH_OK);
    assert_near(0.2 * (late.dust - early.dust) / (2 * e), 3 * (s.fluid - s.dust), 2e-5, "dust");
    assert_near(1.3 * s.fluid + 0.2 * s.dust, 1.3 * -0.4 + 0.2 * 2, 1e-15, "momentum");
    assert_near(1.3 * (s.u + s.fluid * s.fluid / 2) + 0.1 * s.dust * s.dust, 1.3 * (7 + 0.08) + 0.4,
                1e-14, "energy");
  }
  sph_error error = {0};
  const sph_exact_dusty_box bad[] = {{{0, 1}, {1, 1}, 1, 0},
                                     {{1, 1}, {NAN, 1}, 1, 0},
                                     {{1, 1}, {1, 1}, -1, 0}};
  for (int k = 0; k < 3; k++)
    assert_int_equal(sph_exact_dusty_box_at(&bad[k], 1, &s, NULL), SPH_ERR_ARGUMENT);
  assert_int_equal(sph_exact_dusty_box_at(&one, -1, &s, &error), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "t = -1 s"));
}

typedef struct dusty {
  double rho[2], v[2]; /* of the fluid, of the dust */
} dusty;

static dusty dusty_at(const sph_exact_dusty_wave *w, double t, double x)
{
  dusty it;
  for (int d = 0; d < 2; d++)
    assert_int_equal(sph_exact_dusty_wave_at(w, t, d, 1, &x, &it.rho[d], &it.v[d], NULL), SPH_OK);
  return it;
}

/* The linear equations of both, by differences. */
static void dusty_wave(void **state)
{
  (void)state;
  const double e = 1e-4, a = 1e-3, rho[2] = {1.2, 0.4};
  const sph_exact_dusty_wave w = {1.2, 0.4, 3, 0.7, a, 2.2};
  for (double x = 0; x < 3; x += 0.17)
    for (double t = 0.1; t < 4; t += 0.23) {
      dusty here = dusty_at(&w, t, x), late = dusty_at(&w, t + e, x),
            early = dusty_at(&w, t - e, x);
      dusty east = dusty_at(&w, t, x + e), west = dusty_at(&w, t, x - e);
      for (int d = 0; d < 2; d++) {
        double force = (d ? 1 : -1) * 0.7 * (here.v[0] - here.v[1]);
        if (!d) force -= 9 * (east.rho[0] - west.rho[0]) / (2 * e);
        assert_near((late.rho[d] - early.rho[d] + rho[d] * (east.v[d] - west.v[d])) / (2 * e), 0,
                    1e-6 * a, "continuity");
        assert_near(rho[d] * (late.v[d] - early.v[d]) / (2 * e), force, 1e-5 * a, "momentum");
      }
    }
  dusty start = dusty_at(&w, 0, 0.3);
  for (int d = 0; d < 2; d++) {
    assert_near(start.rho[d], rho[d] * (1 + a * cos(0.66)), 1e-15, "density at the start");
    assert_near(start.v[d], 3 * a * cos(0.66), 1e-17, "velocity at the start");
  }
}

/* Without drag each goes its way; with much, both go together, with c sqrt(rho_f/rho). */
static void dusty_wave_limits(void **state)
{
  (void)state;
  const sph_exact_dusty_wave none = {1.2, 0.4, 3, 0, 1e-3, 2.2},
                             much = {1.2, 0.4, 3, 1e7, 1e-3, 2.2};
  const sph_exact_wave alone = {1.2, 0, 3, 1e-3, 2.2, 0};
  const double slow = sqrt(1.2 / 1.6);
  for (double t = 0; t < 5; t += 0.31)
    for (double x = 0; x < 3; x += 0.29) {
      dusty free = dusty_at(&none, t, x), bound = dusty_at(&much, t, x);
      sph_exact_gas gas = sph_exact_wave_at(&alone, t, x);
      double kx = 2.2 * x, wt = 2.2 * 3 * t, swt = slow * wt;
      assert_near(free.rho[0], gas.rho, 1e-14, "fluid alone, density");
      assert_near(free.v[0], gas.u, 1e-15, "fluid alone, velocity");
      assert_near(free.v[1], 3e-3 * cos(kx), 1e-16, "dust alone, velocity");
      assert_near(free.rho[1], 0.4 * (1 + 1e-3 * (cos(kx) + wt * sin(kx))), 1e-15,
                  "dust alone, density");
      for (int d = 0; d < 2; d++) {
        assert_near(bound.v[d], 3e-3 * (cos(kx) * cos(swt) + slow * sin(kx) * sin(swt)), 1e-8,
                    "bound, velocity");
        assert_near(bound.rho[d] / much.amplitude, /* relative to the crest, by continuity */
                    (d ? 0.4 : 1.2) * (1e3 + cos(kx) * cos(swt) + sin(kx) * sin(swt) / slow), 1e-5,
                    "bound, density");
      }
    }
}

/* Damped as the roots of lambda^3 + K (1/rho_f + 1/rho_d) lambda^2 + w^2 lambda + w^2 K/rho_d = 0
 * say (Laibe & Price 2011): of three exponentials at equal intervals each is a fixed combination of
 * the last three. */
static void dusty_wave_roots(void **state)
{
  (void)state;
  for (double K = 1e-3; K < 1e4; K *= 3) {
    const sph_exact_dusty_wave w = {1.2, 0.4, 3, K, 1, 2.2};
    const double w2 = 36 * 1.21, tau = 0.05;
    gsl_complex root[3];
    double complex z[3];
    gsl_poly_complex_solve_cubic(K / 1.2 + K / 0.4, w2, w2 * K / 0.4, &root[0], &root[1], &root[2]);
    for (int k = 0; k < 3; k++) z[k] = cexp(tau * (GSL_REAL(root[k]) + I * GSL_IMAG(root[k])));
    double one = creal(z[0] + z[1] + z[2]), three = creal(z[0] * z[1] * z[2]);
    double two = creal(z[0] * z[1] + z[1] * z[2] + z[2] * z[0]);
    for (double t = 0; t < 3; t += 0.7)
      for (int d = 0; d < 2; d++) {
        double v[4];
        for (int k = 0; k < 4; k++) v[k] = dusty_at(&w, t + k * tau, 0.1).v[d];
        assert_near(v[3], one * v[2] - two * v[1] + three * v[0], 1e-12 * (10 + K), "roots");
      }
  }
}

static void dusty_wave_refusals(void **state)
{
  (void)state;
  const sph_exact_dusty_wave bad[] = {{0, 1, 1, 1, 1, 1},   {1, -1, 1, 1, 1, 1},
                                      {1, 1, 0, 1, 1, 1},   {1, 1, 1, NAN, 1, 1},
                                      {1, 1, 1, 1, NAN, 1}, {1, 1, 1, 1, 1, 0}};
  const sph_exact_dusty_wave good = {1, 1, 1, 1, 1, 1};
  double x = 0, v;
  sph_error error = {0};
  for (int k = 0; k < 6; k++)
    assert_int_equal(sph_exact_dusty_wave_at(&bad[k], 1, 0, 1, &x, NULL, &v, NULL),
                     SPH_ERR_ARGUMENT);
  assert_int_equal(sph_exact_dusty_wave_at(&good, -1, 0, 1, &x, NULL, &v, &error),
                   SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "t = -1 s"));
}

/* ---- two layers: balance in each, one pressure where they meet */

static void layers(void **state)
{
  (void)state;
  sph_exact_layers l = {sph_eos_tait(1000, 40, 7), sph_eos_tait(800, 45, 1.4), 0.5, 1, 0, 9.81};
  sph_exact_column lower, upper;
  assert_int_equal(sph_exact_layers_column(&l, 0, &lower, NULL), SPH_OK);
  assert_int_equal(sph_exact_layers_column(&l, 1, &upper, NULL), SPH_OK);
  assert_near(pressure_at(1, &upper), 0, 0, "at the surface");
  assert_near(pressure_at(0.5, &lower), pressure_at(0.5, &upper), 1e-9, "where they meet");
  assert_near(pressure_at(0.5, &upper), 800 * 9.81 * 0.5, 5, "weight of the upper one");
  assert_near(pressure_at(0, &lower), 1800 * 9.81 * 0.5, 30, "weight of both");
  for (int k = 0; k < 2; k++)
    for (double z = 0.5 * k + 0.03; z < 0.5 * k + 0.48; z += 0.06) {
      double rho, slope, error;
      sph_exact_column *c = k ? &upper : &lower;
      gsl_function f = {pressure_at, c};
      assert_int_equal(sph_exact_column_at(c, 1, &z, &rho, NULL, NULL), SPH_OK);
      gsl_deriv_central(&f, z, 1e-2, &slope, &error);
      assert_near(slope / (rho * c->g), -1, 1e-8, "dp/dz = -rho g");
      assert_near(rho, k ? 800 : 1000, 8, "density");
    }
  sph_error error = {0};
  l.surface = 0.4;
  assert_int_equal(sph_exact_layers_column(&l, 0, &lower, &error), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(error.text, "0.4"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(star_values),
      cmocka_unit_test(sod_speeds),
      cmocka_unit_test(jump_conditions),
      cmocka_unit_test(profile),
      cmocka_unit_test(riemann_edges),
      cmocka_unit_test(gsl_handler_restored),
      cmocka_unit_test(drop),
      cmocka_unit_test(drop_invariants),
      cmocka_unit_test(drop_refusals),
      cmocka_unit_test(column),
      cmocka_unit_test(channel),
      cmocka_unit_test(channel_refusals),
      cmocka_unit_test(heat),
      cmocka_unit_test(heat_refusals),
      cmocka_unit_test(taylor_green),
      cmocka_unit_test(square),
      cmocka_unit_test(wave),
      cmocka_unit_test(dusty_box),
      cmocka_unit_test(dusty_wave),
      cmocka_unit_test(dusty_wave_limits),
      cmocka_unit_test(dusty_wave_roots),
      cmocka_unit_test(dusty_wave_refusals),
      cmocka_unit_test(layers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
