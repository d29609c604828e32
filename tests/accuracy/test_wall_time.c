/* Walls that change with time, against exact solutions: a slab between faces whose temperature
 * oscillates (adami, dbc, mirror; the periodic solution of the heat equation), a square between
 * mirrors whose temperature and flux vary along them, liquid that turns with its drum as a rigid
 * body, and what a wall that turns and moves does (kinematics). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <complex.h>
#include <math.h>
#include <string.h>

#include "near.h"
#include "sphode.h"

enum { MOST = 20000 };
static const double T0 = 300, A = 10; /* [K] */

/* ---- heat: L = 1 m, diffusivity 1 m^2/s ---- */

static const double omega = 20; /* [1/s]: the penetration depth sqrt(2/omega) is 0.32 m */

static double complex wave(double x)
{
  const double complex k = csqrt(omega * I);
  return ccosh(k * (x - 0.5)) / ccosh(0.5 * k);
}

static double exact(double x, double t) { return T0 + A * cimag(cexp(I * omega * t) * wave(x)); }

/* kappa dT/dn into the slab, at its faces. */
static double exact_flux(double t)
{
  const double complex k = csqrt(omega * I);
  return A * cimag(cexp(I * omega * t) * k * csinh(0.5 * k) / ccosh(0.5 * k));
}

static void face(void *ctx, double t, long n, const double *const x[3], double *T)
{
  (void)ctx, (void)x;
  for (long i = 0; i < n; i++) T[i] = exact(0, t);
}

static void flux(void *ctx, double t, long n, const double *const x[3], double *q)
{
  (void)ctx, (void)x;
  for (long i = 0; i < n; i++) q[i] = exact_flux(t);
}

static double slab_error(const char *model, int fluxes, int n)
{
  const double L = 1;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = L / n, .h_over_dx = 3});
  sph_group *body = sph_group_box(sim, "body", (double[]){0}, &L, 1);
  sph_eos eos = sph_eos_linear(1, 0.5, -INFINITY);
  sph_boundary b = !strcmp(model, "mirror") ? sph_boundary_mirror()
                   : !strcmp(model, "dbc")  ? sph_boundary_dbc()
                                            : sph_boundary_adami();
  double T[MOST], error = 0;
  eos.c_v = 1;
  sph_group_set_eos(body, eos);
  sph_group_set_conductivity(body, 1);
  sph_group_set_energy(body, "temperature");
  const double *x = sph_group_read(body, "position", 0);
  for (long i = 0; i < n; i++) T[i] = exact(x[i], 0);
  sph_group_set_temperature(body, T);
  sph_group *faces = strcmp(model, "mirror") ? sph_group_walls(sim, "faces", (double[]){0}, &L, 1)
                                             : sph_group_create(sim, "faces", "wall");
  if (!strcmp(model, "mirror")) sph_boundary_mirror_box(&b, (double[]){0}, &L, NULL, 1);
  if (fluxes)
    b.heat_flux_at = flux;
  else
    b.temperature_at = face;
  sph_group_set_boundary(faces, b);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  for (int k = 1; k <= 4; k++) {
    const double t = 0.11 * k; /* up to 1.4 periods */
    double sum = 0;
    if (sph_sim_run(sim, t)) fail_msg("%s: %s", model, sph_sim_error(sim));
    x = sph_group_read(body, "position", 0);
    const double *now = sph_group_read(body, "temperature", 0);
    for (long i = 0; i < n; i++) sum += pow((now[i] - exact(x[i], t)) / A, 2);
    error = fmax(error, sqrt(sum / n));
  }
  sph_sim_free(sim);
  return error;
}

static void heat_over_time(void **state)
{
  const struct {
    const char *model;
    int fluxes;
    double bar, order;
  } row[] = {{"adami", 0, 0.005, 1.5},
             {"mirror", 0, 0.005, 1.5},
             {"mirror", 1, 0.005, 1.5},
             {"dbc", 0, 0.06, 0.8}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    const double coarse = slab_error(row[k].model, row[k].fluxes, 25);
    const double fine = slab_error(row[k].model, row[k].fluxes, 50);
    print_message("# %s, %s over time, 50 across: rms %.3f %% (bar %g %%), order %.2f\n",
                  row[k].model, row[k].fluxes ? "flux" : "temperature", 100 * fine,
                  100 * row[k].bar, log2(coarse / fine));
    assert_true(fine <= row[k].bar);
    assert_true(log2(coarse / fine) >= row[k].order);
  }
}

/* ---- heat along mirrors: T = T0 + A x y is harmonic, and its images go on with it exactly ---- */

static void xy_face(void *ctx, double t, long n, const double *const x[3], double *T)
{
  (void)ctx, (void)t;
  for (long i = 0; i < n; i++) T[i] = T0 + A * x[0][i] * x[1][i];
}

static void xy_flux(void *ctx, double t, long n, const double *const x[3], double *q)
{
  (void)ctx, (void)t;
  for (long i = 0; i < n; i++) q[i] = x[1][i] > 0.5 ? A * x[0][i] : -A * x[0][i];
}

static void heat_along_mirrors(void **state)
{
  const double lo[2] = {0, 0}, hi[2] = {1, 1};
  enum { N = 400 };
  double T[N], most = 0;
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.05});
  sph_group *body = sph_group_box(sim, "body", lo, hi, 1);
  sph_group *hot = sph_group_create(sim, "hot", "wall");
  sph_group *heated = sph_group_create(sim, "heated", "wall");
  sph_boundary across = sph_boundary_mirror(), along = sph_boundary_mirror();
  sph_eos eos = sph_eos_linear(1, 1, -INFINITY);
  eos.c_v = 1;
  sph_group_set_eos(body, eos);
  sph_group_set_conductivity(body, 1);
  sph_group_set_energy(body, "temperature");
  const double *const x[3] = {sph_group_read(body, "position", 0),
                              sph_group_read(body, "position", 1)};
  assert_int_equal(sph_group_count(body), N);
  xy_face(NULL, 0, N, x, T);
  sph_group_set_temperature(body, T);
  sph_boundary_mirror_box(&across, lo, hi, "y- y+", 2);
  sph_boundary_mirror_box(&along, lo, hi, "x- x+", 2);
  across.temperature_at = xy_face;
  along.heat_flux_at = xy_flux;
  sph_group_set_boundary(hot, across);
  sph_group_set_boundary(heated, along);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_conduction());
  if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
  const double *rate = sph_group_rate(body, "temperature", 0);
  for (long i = 0; i < N; i++) most = fmax(most, fabs(rate[i]));
  print_message("# T0 + A x y between mirrors: |dT/dt| <= %.2g K/s (a step of A would give %g)\n",
                most, A / (0.05 * 0.05));
  assert_true(most <= 1e-12 * T0 / (0.05 * 0.05));
  sph_sim_free(sim);
}

/* ---- a drum of radius 1 m, one radian a second ---- */

static void turn(void *ctx, double t, double turn[3])
{
  (void)ctx;
  turn[0] = t, turn[1] = 1, turn[2] = 0;
}

/* p of the rigid body beside the wall's, over rho omega^2. */
static double column(double r) { return 0.5 * (r * r - 1) + 1; }

static void add_disc(sph_group *group, double from, double to, double dx)
{
  for (double y = -2; y < 2; y += dx)
    for (double x = -2; x < 2; x += dx) {
      const double a = x + 0.5 * dx, b = y + 0.5 * dx, r = hypot(a, b);
      const double *const at[] = {&a, &b};
      if (r >= from && r < to) sph_group_add_points(group, 1, at, 1000);
    }
}

static void rigid_body(void **state)
{
  const double dx = 0.05, c0 = 20, rho0 = 1000;
  double speed = 0, p_error = 0, mean = 0, swing = 0;
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .speed = 1});
  sph_group *water = sph_group_create(sim, "water", "fluid");
  sph_group *drum = sph_group_create(sim, "drum", "wall");
  sph_boundary b = sph_boundary_adami_no_slip();
  b.rotation = turn;
  add_disc(water, 0, 1, dx);
  add_disc(drum, 1, 1.2, dx);
  sph_group_set_eos(water, sph_eos_linear(rho0, c0, -INFINITY));
  sph_group_set_viscosity(water, 10);
  sph_group_set_boundary(drum, b);
  const long n = sph_group_count(water);
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  double *u = sph_group_write(water, "velocity", 0), *v = sph_group_write(water, "velocity", 1);
  double *rho = sph_group_write(water, "density", 0);
  for (long i = 0; i < n; i++) {
    u[i] = -y[i], v[i] = x[i];
    rho[i] = rho0 * (1 + column(hypot(x[i], y[i])) / (c0 * c0));
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  if (sph_sim_run(sim, 1.5)) fail_msg("%s", sph_sim_error(sim));
  x = sph_group_read(water, "position", 0), y = sph_group_read(water, "position", 1);
  const double *vx = sph_group_read(water, "velocity", 0),
               *p = sph_group_read(water, "pressure", 0);
  const double *vy = sph_group_read(water, "velocity", 1);
  for (long i = 0; i < n; i++) {
    speed += pow(vx[i] + y[i], 2) + pow(vy[i] - x[i], 2);
    mean += (p[i] / rho0 - column(hypot(x[i], y[i]))) / (double)n;
  }
  for (long i = 0; i < n; i++) { /* a disc of squares has not quite the area of the disc */
    p_error += pow(p[i] / rho0 - column(hypot(x[i], y[i])) - mean, 2);
    swing += pow(column(hypot(x[i], y[i])) - 0.75, 2);
  }
  speed = sqrt(speed / (double)n);
  print_message("# drum, R/dx = 20, after 1.5 rad: rms of velocity %.2f %% of the wall's, rms of "
                "pressure %.1f %% of its swing\n",
                100 * speed, 100 * sqrt(p_error / swing));
  assert_true(speed <= 0.02);
  assert_true(sqrt(p_error / swing) <= 0.06);
  sph_sim_free(sim);
}

/* ---- what turns with its wall feels no viscosity ---- */

static void spin(void *ctx, double t, double turn[3])
{
  (void)ctx;
  turn[0] = 3 * t, turn[1] = 3, turn[2] = 0;
}

/* A block in the middle of walls, all of it shaken off the lattice, w x (r - c) everywhere. */
static sph_sim *rigid(int dim, double eta, const double w[3], const double c[3])
{
  const double dx = 0.1, lo[3] = {0}, hi[3] = {0.5, 0.4, 0.5};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = dim, .dx = dx});
  sph_group *water = sph_group_box(sim, "water", lo, hi, 1000);
  sph_group *wall = sph_group_walls(sim, "wall", lo, hi, 1000);
  sph_boundary b = sph_boundary_adami_no_slip();
  b.rotation = spin;
  for (int d = 0; d < 3; d++) b.centre[d] = c[d], b.axis[d] = dim == 3 ? w[d] / 3 : 0;
  sph_group_jitter(water, 0.2, 1);
  sph_group_set_eos(water, sph_eos_linear(1000, 10, -INFINITY));
  sph_group_set_viscosity(water, eta);
  sph_group_set_boundary(wall, b);
  for (long i = 0; i < sph_group_count(water); i++) {
    double r[3] = {0};
    for (int d = 0; d < dim; d++) r[d] = sph_group_read(water, "position", d)[i] - c[d];
    for (int d = 0; d < dim; d++)
      sph_group_write(water, "velocity", d)[i] =
          w[(d + 1) % 3] * r[(d + 2) % 3] - w[(d + 2) % 3] * r[(d + 1) % 3];
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("mcg"));
  if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
  return sim;
}

/* The central form sees no r_ij.v_ij in the fluid; nor is there any to what walls are seen as. */
static void turns_along(void **state)
{
  (void)state;
  const double w[2][3] = {{0, 0, 3}, {1, 2, -2}}, c[3] = {0.3, 0.1, 0.2};
  for (int dim = 2; dim <= 3; dim++) {
    sph_sim *with = rigid(dim, 1000, w[dim - 2], c), *without = rigid(dim, 1, w[dim - 2], c);
    const sph_group *a = sph_sim_group(with, "water"), *b = sph_sim_group(without, "water");
    for (int d = 0; d < dim; d++)
      for (long i = 0; i < sph_group_count(a); i++)
        assert_near(sph_group_rate(a, "velocity", d)[i], sph_group_rate(b, "velocity", d)[i],
                    1e-10); /* a surface half a spacing off would be felt with 100 m/s^2 */
    sph_sim_free(with), sph_sim_free(without);
  }
}

/* ---- kinematics: a wall that turns about a tilted axis and moves ---- */

static void swing(void *ctx, double t, double turn[3])
{
  (void)ctx;
  turn[0] = sin(t), turn[1] = cos(t), turn[2] = -sin(t);
}

static void glide(void *ctx, double t, double x[3], double v[3], double a[3])
{
  (void)ctx;
  x[0] = t * t, v[0] = 2 * t, a[0] = 2;
  x[1] = x[2] = v[1] = v[2] = a[1] = a[2] = 0;
}

/* Rotation by angle q about (1, 1, 1) takes x to y where q is 2 pi/3. */
static void turns_and_moves(void **state)
{
  const double dx = 0.1, t = 0.7, q = sin(t), n = 1 / sqrt(3);
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 3, .dx = dx});
  sph_group *water =
      sph_group_box(sim, "water", (double[]){5, 5, 5}, (double[]){5.5, 5.5, 5.5}, 1000);
  sph_group *wall = sph_group_create(sim, "wall", "wall");
  const double at[3] = {1, 0.1, 0};
  const double *const points[] = {at, at + 1, at + 2};
  sph_group_add_points(wall, 1, points, 1000);
  sph_boundary b = sph_boundary_adami();
  b.motion = glide, b.rotation = swing;
  for (int d = 0; d < 3; d++) b.centre[d] = 0.1, b.axis[d] = 7;
  sph_group_set_boundary(wall, b);
  sph_group_set_eos(water, sph_eos_linear(1000, 10, -INFINITY));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  if (sph_sim_run(sim, t)) fail_msg("%s", sph_sim_error(sim));
  /* the circulant matrix of such a rotation: diagonal, and the two others */
  const double r[3] = {0.9, 0, -0.1};
  const double m0 = (1 + 2 * cos(q)) / 3, m1 = (1 - cos(q)) / 3 - n * sin(q),
               m2 = (1 - cos(q)) / 3 + n * sin(q);
  double R[3];
  for (int d = 0; d < 3; d++) R[d] = m0 * r[d] + m1 * r[(d + 1) % 3] + m2 * r[(d + 2) % 3];
  for (int d = 0; d < 3; d++) {
    const double spin = cos(t) * n * (R[(d + 2) % 3] - R[(d + 1) % 3]);
    assert_near(sph_group_read(wall, "position", d)[0], 0.1 + R[d] + (d == 0 ? t * t : 0), 1e-12);
    assert_near(sph_group_read(wall, "velocity", d)[0], spin + (d == 0 ? 2 * t : 0), 1e-12);
  }
  sph_sim_free(sim);
}

static void refused(sph_boundary b, int dim, const char *says)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = dim, .dx = 0.1});
  sph_group_set_boundary(sph_group_create(sim, "wall", "wall"), b);
  assert_non_null(strstr(sph_sim_error(sim), says));
  sph_sim_free(sim);
}

static void refusals(void **state)
{
  (void)state;
  sph_boundary b = sph_boundary_adami(), m = sph_boundary_mirror();
  b.rotation = m.rotation = turn;
  refused(b, 1, "a rotation in 1D");
  b.axis[0] = 1;
  refused(b, 2, "a rotation in 2D about the axis (1, 0, 0)");
  b.axis[0] = INFINITY;
  refused(b, 3, "all finite");
  sph_boundary_mirror_plane(&m, (double[]){0, 0}, (double[]){0, 1}, 2);
  refused(m, 2, "mirrors do not turn");
  m.rotation = NULL;
  m.heat_flux_at = m.temperature_at = face;
  refused(m, 2, "a heat flux and a temperature");
  b = sph_boundary_adami();
  b.heat_flux_at = flux;
  refused(b, 2, "planes and a heat flux are of boundary mirror");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(heat_over_time),  cmocka_unit_test(heat_along_mirrors),
      cmocka_unit_test(rigid_body),      cmocka_unit_test(turns_along),
      cmocka_unit_test(turns_and_moves), cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
