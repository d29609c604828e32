/* Manufactured solutions: the sources against formulas written by hand, and the order of whole
 * runs, in a periodic box and between walls of Adami.
 *
 * All fields have rho(x), rho v = curl psi(x, t): no source of density, particles fill their
 * volumes.  U = L = 1, Re = 20, c0 = 10 U, amplitude of rho 1 %. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "near.h"
#include "sphode.h"

static const double pi = 3.14159265358979323846;
static const double L = 1, U = 1, nu = 0.05, rho0 = 1000, c0 = 10; /* SI */
static const double amplitude = 0.01, t_end = 0.1;

/* ---- the fields ---- */

static double density(void *ctx, const double x[3], double t)
{
  (void)ctx, (void)t;
  const double k = 2 * pi / L;
  return rho0 * (1 + amplitude * cos(k * x[0]) * cos(k * x[1]));
}

/* psi = rho0 U/k sin kx sin ky cos wt. */
static void swirl(void *ctx, const double x[3], double t, double v[3])
{
  const double k = 2 * pi / L, s = rho0 / density(ctx, x, t) * U * cos(2 * pi * t);
  v[0] = s * sin(k * x[0]) * cos(k * x[1]);
  v[1] = -s * cos(k * x[0]) * sin(k * x[1]);
}

/* psi = rho0 U (F + f cos kx cos wt): F' = 4 y (1 - y), f = 2 y^2 (1 - y)^2: at rest at y = 0, 1,
 * where its second derivative is not zero. */
static void sticking(void *ctx, const double x[3], double t, double v[3])
{
  const double k = 2 * pi / L, y = x[1] / L, s = rho0 / density(ctx, x, t) * U, c = cos(2 * pi * t);
  v[0] = s * (4 * y * (1 - y) + 4 * y * (1 - y) * (1 - 2 * y) * cos(k * x[0]) * c);
  v[1] = s * k * L * 2 * y * y * (1 - y) * (1 - y) * sin(k * x[0]) * c;
}

/* psi = rho0 U/pi sin(pi y) (1 + cos(kx) cos(wt)/2): slides along y = 0, 1 without shear. */
static void sliding(void *ctx, const double x[3], double t, double v[3])
{
  const double k = 2 * pi / L, s = rho0 / density(ctx, x, t) * U, c = cos(2 * pi * t) / 2;
  v[0] = s * cos(pi * x[1]) * (1 + cos(k * x[0]) * c);
  v[1] = s * sin(pi * x[1]) * k / pi * sin(k * x[0]) * c;
}

/* ---- sources ---- */

static double exponential(void *ctx, const double x[3], double t)
{
  (void)ctx;
  return rho0 * (1 + 0.01 * sin(x[0] + 2 * x[1] - x[2] + t));
}

static void compressive(void *ctx, const double x[3], double t, double v[3])
{
  (void)ctx;
  v[0] = sin(x[0]) * cos(x[1]) * cos(t);
  v[1] = sin(x[0] + x[2]);
  v[2] = x[0] * x[1] * x[2] * exp(-t);
}

/* By hand, in 3D: v of `compressive`, rho of `exponential`, linear equation of state. */
static void by_hand(const double x[3], double t, int mcg, double s_v[3], double *s_rho)
{
  const double e = exp(-t), phase = x[0] + 2 * x[1] - x[2] + t, r = 10 * cos(phase);
  const double rho = rho0 * (1 + 0.01 * sin(phase)), grad[3] = {r, 2 * r, -r};
  double v[3];
  compressive(NULL, x, t, v);
  const double sx = sin(x[0]), cx = cos(x[0]), sy = sin(x[1]), cy = cos(x[1]), ct = cos(t);
  const double s = sin(x[0] + x[2]), c = cos(x[0] + x[2]);
  const double dv[3][3] = {{cx * cy * ct, -sx * sy * ct, 0},
                           {c, 0, c},
                           {x[1] * x[2] * e, x[0] * x[2] * e, x[0] * x[1] * e}};
  const double dt[3] = {-sx * cy * sin(t), 0, -v[2]};
  const double laplacian[3] = {-2 * sx * cy * ct, -2 * s, 0};
  const double grad_div[3] = {-sx * cy * ct + x[1] * e, -cx * sy * ct + x[0] * e, 0};
  const double g[3] = {0.5, -9.81, 0.25};
  *s_rho = r + rho * (dv[0][0] + dv[1][1] + dv[2][2]);
  for (int a = 0; a < 3; a++) {
    s_v[a] = dt[a] + c0 * c0 * grad[a] / rho - g[a];
    s_v[a] -= rho0 * nu / rho * (laplacian[a] + (mcg ? 2 * grad_div[a] : 0));
    for (int d = 0; d < 3; d++) s_v[a] += v[d] * dv[a][d];
    *s_rho += v[a] * grad[a];
  }
}

static void sources(void **state)
{
  (void)state;
  for (int mcg = 0; mcg < 2; mcg++) {
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 3, .dx = 0.1});
    sph_group *water =
        sph_group_box(sim, "water", (double[]){0, 0, 0}, (double[]){0.5, 0.5, 0.5}, rho0);
    sph_group_set_eos(water, sph_eos_linear(rho0, c0, -INFINITY));
    sph_group_set_viscosity(water, rho0 * nu);
    sph_sim_add_term(sim, sph_term_viscosity_laminar(mcg ? "mcg" : "morris"));
    sph_manufactured_attach(water, &(sph_manufactured){.velocity = compressive,
                                                       .density = exponential,
                                                       .length = 2,
                                                       .time = 2});
    sph_sim_add_term(sim, sph_term_gravity((double[]){0.5, -9.81, 0.25}));
    for (int k = 0; k < 5; k++) {
      const double x[3] = {0.3 + k, 0.7 - 0.4 * k, -0.2 + 0.3 * k}, t = 0.1 * k;
      double s_v[3], s_rho, right_v[3], right_rho;
      assert_int_equal(sph_manufactured_source(water, x, t, s_v, &s_rho), SPH_OK);
      by_hand(x, t, mcg, right_v, &right_rho);
      for (int d = 0; d < 3; d++) assert_near(s_v[d], right_v[d], 1e-9);
      assert_near(s_rho, right_rho, 1e-9 * rho0);
    }
    assert_string_equal(sph_sim_error(sim), "");
    sph_sim_free(sim);
  }
}

/* ---- whole runs ---- */

typedef void velocity(void *ctx, const double x[3], double t, double v[3]);

/* boundary.name NULL: periodic. */
static sph_sim *box(int n, double h_over_dx, velocity *v, sph_boundary boundary)
{
  const double lo[] = {0, 0}, hi[] = {L, L};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = L / n,
                                               .h_over_dx = h_over_dx,
                                               .periodic = {1, !boundary.name},
                                               .length = {L, L},
                                               .speed = U});
  sph_group *water = sph_group_box(sim, "water", lo, hi, rho0);
  sph_group_set_eos(water, sph_eos_linear(rho0, c0, -INFINITY));
  sph_group_set_viscosity(water, rho0 * nu);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_manufactured_attach(
      water, &(sph_manufactured){.velocity = v, .density = density, .length = L, .time = 1});
  if (boundary.name) {
    sph_group *plates = sph_group_create(sim, "plates", "wall");
    sph_group_add_layers(plates, lo, hi, "x- x+", rho0);
    sph_group_set_boundary(plates, boundary);
  }
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  return sim;
}

enum { COUNT = 3 };
typedef struct bars {
  double v, p;           /* least orders in dx */
  double most_v, most_p; /* largest L1 at the finest, [U], [rho0 U^2] */
} bars;

/* h/dx grows from 1.5 as dx^(-1/2), so that h is halved where dx is quartered: order 1 in dx is
 * order 2 in h. */
static void converges(const char *name, velocity *v, sph_boundary boundary, bars bar)
{
  const int fine = getenv("SPHODE_TEST_LONG") != NULL;
  const int across[2][COUNT] = {{16, 24, 36}, {16, 32, 64}};
  double dx[COUNT], of_v[COUNT], of_p[COUNT];
  for (int k = 0; k < COUNT; k++) {
    const int n = across[fine][k];
    const double ratio = 1.5 * sqrt(n / 16.);
    sph_manufactured_error e;
    sph_sim *sim = box(n, ratio, v, boundary);
    const sph_group *water = sph_sim_group(sim, "water");
    if (sph_sim_run(sim, t_end) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
    dx[k] = L / n;
    assert_int_equal(sph_manufactured_error_of(water, "velocity", &e), SPH_OK);
    of_v[k] = e.L1 / U;
    print_message("# %s, %d across, h/dx = %.2f: velocity L1 %.2e, L2 %.2e, max %.2e U", name, n,
                  ratio, e.L1, e.L2, e.max);
    assert_int_equal(sph_manufactured_error_of(water, "pressure", &e), SPH_OK);
    of_p[k] = e.L1 / (rho0 * U * U);
    print_message("; pressure %.2e, %.2e, %.2e rho0 U^2\n", e.L1 / rho0, e.L2 / rho0, e.max / rho0);
    sph_sim_free(sim);
  }
  const double order_v = sph_manufactured_order(COUNT, dx, of_v);
  const double order_p = sph_manufactured_order(COUNT, dx, of_p);
  print_message("# %s: order in dx of velocity %.2f (bar %.2f), of pressure %.2f (bar %.2f)\n",
                name, order_v, bar.v, order_p, bar.p);
  assert_true(order_v >= bar.v && order_p >= bar.p);
  assert_true(of_v[COUNT - 1] <= bar.most_v && of_p[COUNT - 1] <= bar.most_p);
}

static sph_boundary wall(sph_boundary boundary)
{
  boundary.tension = 1;
  return boundary;
}

static void periodic(void **state)
{
  (void)state;
  converges("periodic", swirl, (sph_boundary){0}, (bars){1.3, 1.8, 0.008, 0.12});
}

static void no_slip(void **state)
{
  (void)state;
  converges("no slip", sticking, wall(sph_boundary_adami_no_slip()),
            (bars){0.9, 0.9, 0.0035, 0.035});
}

/* Half of a Laplacian is missing within a support of the wall: all the order there is. */
static void free_slip(void **state)
{
  (void)state;
  converges("free slip", sliding, wall(sph_boundary_adami()), (bars){0.5, 0.7, 0.01, 0.12});
}

/* Order of a power law, and where there is none. */
static void orders(void **state)
{
  (void)state;
  const double dx[] = {1, 0.5, 0.25, 0.1}, e[] = {3, 0.75, 0.1875, 0.03}, bad[] = {1, 0.5, 0, 1};
  assert_near(sph_manufactured_order(4, dx, e), 2, 1e-12);
  assert_true(isnan(sph_manufactured_order(1, dx, e)));
  assert_true(isnan(sph_manufactured_order(4, dx, bad)));
  assert_true(isnan(sph_manufactured_order(2, NULL, e)));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(sources), cmocka_unit_test(orders),
                                     cmocka_unit_test(periodic), cmocka_unit_test(no_slip),
                                     cmocka_unit_test(free_slip)};
  return cmocka_run_group_tests_name("manufactured", tests, NULL, NULL);
}
