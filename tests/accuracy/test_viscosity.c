/* What viscosities and conduction amount to on a lattice: the answer of the right-hand side to a
 * wave f = sin kx, transverse or along x, over that of the continuum,
 *
 *   a = - nu k^2 v,   du/dt = - kappa k^2 T/rho,
 *
 * and the decay of a shear wave in a run, v = V sin kx exp(-nu k^2 t).  Artificial viscosities in
 * units of alpha h c:
 *   1/(2 (d + 2)) on all pairs (Monaghan 2005), half of it on those that approach;
 *   (d + 1)/(2 d (d + 2)) integral of r W/h dV on all pairs with the signal velocity. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

static const double pi = 3.14159265358979323846, rho0 = 2, c0 = 10, eta = 0.3, c_v = 4, kappa = 7;

/* A periodic lattice, n dx = 1 m along x, a little more than two supports across. */
static sph_sim *lattice(int dim, int n, double h_over_dx, sph_term term)
{
  const double dx = 1.0 / n, lo[3] = {0};
  const int across = (int)(5 * h_over_dx) + 3;
  sph_sim_def def = {.dim = dim, .dx = dx, .h_over_dx = h_over_dx};
  for (int d = 0; d < dim; d++) def.periodic[d] = 1, def.length[d] = d ? across * dx : 1;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *oil = sph_group_box(sim, "oil", lo, def.length, rho0);
  sph_eos eos = sph_eos_linear(rho0, c0, -INFINITY);
  eos.c_v = c_v;
  sph_group_set_eos(oil, eos);
  sph_group_set_viscosity(oil, eta);
  sph_group_set_conductivity(oil, kappa);
  sph_group_set_energy(oil, "temperature");
  double *u = sph_group_write(oil, "energy", 0);
  for (long i = 0; u && i < sph_group_count(oil); i++) u[i] = 300 * c_v;
  sph_sim_add_term(sim, term);
  return sim;
}

/* Amplitude of the answer in `rate` to a wave of size 1 in component c of `field`. */
static double response(sph_sim *sim, const char *field, int c, double sign)
{
  sph_group *oil = sph_sim_group(sim, "oil");
  const long n = sph_group_count(oil);
  const double *x = sph_group_read(oil, "position", 0), k = 2 * pi;
  double *f = sph_group_write(oil, field, c), sum = 0;
  assert_non_null(f);
  for (long i = 0; i < n; i++)
    f[i] = sign * sin(k * x[i]) + (strcmp(field, "temperature") ? 0 : 300);
  sph_sim_changed(sim);
  if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  x = sph_group_read(oil, "position", 0);
  const double *rate = sph_group_rate(oil, field, c);
  for (long i = 0; i < n; i++) sum += rate[i] * sin(k * x[i]);
  return 2 * sum / (double)n;
}

/* Effective viscosity [m^2/s] for a shear wave (along = 0) or one along x. */
static double viscosity(int dim, int n, double h_over_dx, sph_term term, int along)
{
  sph_sim *sim = lattice(dim, n, h_over_dx, term);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  double a = response(sim, "velocity", along ? 0 : 1, 1);
  sph_sim_free(sim);
  return -a / (4 * pi * pi);
}

static void morris(void **state)
{
  (void)state;
  static const int n[] = {40, 60, 80, 100};
  for (int k = 0; k < 4; k++) {
    double nu = viscosity(2, n[k], 1.5, sph_term_viscosity_laminar("morris"), 0) / (eta / rho0);
    double along = viscosity(2, n[k], 1.5, sph_term_viscosity_laminar("morris"), 1) / (eta / rho0);
    print_message("# 2D, %d across, h = 1.5 dx: Morris %.5f of the nominal, along x %.5f\n", n[k],
                  nu, along);
    if (n[k] < 60) continue;
    assert_true(nu >= 0.995 && nu <= 0.997); /* without r^2/(r^2 + eta^2): 0.982 to 0.985 */
    assert_true(fabs(along - nu) < 1e-12);   /* a Laplacian: no direction */
  }
  double fine = viscosity(3, 80, 2, sph_term_viscosity_laminar("morris"), 0) / (eta / rho0);
  print_message("# 3D, 80 across, h = 2 dx: Morris %.5f of the nominal\n", fine);
  assert_true(fabs(fine - 1) < 0.005);
}

/* nu (lap v + 2 grad div v): 1 across, 3 along. */
static void mcg(void **state)
{
  (void)state;
  const sph_term term = sph_term_viscosity_laminar("mcg");
  static const double bar[2][2] = {{0.88, 0.005}, {0.93, 0.005}}; /* h = 1.5 dx, coarse */
  for (int dim = 2; dim <= 3; dim++) {
    double coarse = viscosity(dim, 40, 1.5, term, 0) / (eta / rho0);
    double fine = viscosity(dim, 40, 3, term, 0) / (eta / rho0);
    double along = viscosity(dim, 40, 1.6, term, 1) / (eta / rho0);
    print_message("# %dD: MCG %.4f of the nominal, %.4f with h = 3 dx; along x %.4f\n", dim, coarse,
                  fine, along);
    assert_true(fabs(coarse - bar[dim - 2][0]) <= bar[dim - 2][1]);
    assert_true(fabs(fine - 1) < 0.02 && fabs(along - 3) < 0.1);
  }
}

/* Only pairs that approach take part, half of all: with v and -v all are counted.  Fine enough that
 * what is left of the difference to 1/(2 (d + 2)) is r^2/(r^2 + eta^2). */
static void artificial(void **state)
{
  (void)state;
  static const double expected[] = {0.1233, 0.0974}; /* measured elsewhere on all pairs */
  for (int dim = 2; dim <= 3; dim++) {
    const int n = dim == 2 ? 160 : 40;
    const double h_over_dx = dim == 2 ? 4 : 3, unit = 0.1 * h_over_dx / n * c0;
    sph_sim *sim = lattice(dim, n, h_over_dx, sph_term_viscosity_artificial(0.1, 0));
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    double in = -response(sim, "velocity", 1, 1) / (4 * pi * pi * unit);
    double out = response(sim, "velocity", 1, -1) / (4 * pi * pi * unit);
    sph_sim_free(sim);
    print_message("# %dD: artificial %.4f alpha h c on approaching pairs, %.4f on all; continuum "
                  "%.4f\n",
                  dim, in, in + out, 0.5 / (dim + 2));
    assert_true(fabs(in / (in + out) - 0.5) < 1e-10);
    assert_true(fabs((in + out) / expected[dim - 2] - 1) <= 0.01);
  }
}

/* integral of r W/h dV = 2/3 in 2D, 5/6 in 3D for Wendland C2. */
static void signal_velocity(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    const int n = dim == 2 ? 160 : 80;
    const double h_over_dx = dim == 2 ? 4 : 3, unit = 0.5 * h_over_dx / n * c0;
    double continuum = (dim + 1) * (dim == 2 ? 2.0 / 3 : 5.0 / 6) / (4 * dim * (dim + 2));
    double found = viscosity(dim, n, h_over_dx, sph_term_viscosity_signal(0.5, 0), 0) / unit;
    print_message("# %dD, h = %g dx: signal %.5f alpha h c, continuum %.5f\n", dim, h_over_dx,
                  found, continuum);
    assert_true(fabs(found / continuum - 1) < 0.01);
  }
}

/* The same operator as Morris', on temperature. */
static void conduction(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++) {
    sph_sim *sim = lattice(dim, 40, 1.5, sph_term_conduction());
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    double dT = response(sim, "temperature", 0, 1) / (-4 * pi * pi * kappa / (rho0 * c_v));
    sph_sim_free(sim);
    double nu = viscosity(dim, 40, 1.5, sph_term_viscosity_laminar("morris"), 1) / (eta / rho0);
    print_message("# %dD: conduction %.5f of the nominal\n", dim, dT);
    assert_true(fabs(dT - nu) < 1e-11 && fabs(dT - 1) < 0.02);
  }
}

/* ---- a run ---- */

static void sums(sph_group *gas, double *kinetic, double *heat)
{
  const long n = sph_group_count(gas);
  const double *m = sph_group_read(gas, "mass", 0), *u = sph_group_read(gas, "energy", 0);
  const double *v[2] = {sph_group_read(gas, "velocity", 0), sph_group_read(gas, "velocity", 1)};
  *kinetic = *heat = 0;
  for (long i = 0; i < n; i++) {
    *kinetic += m[i] * (v[0][i] * v[0][i] + v[1][i] * v[1][i]) / 2;
    *heat += m[i] * (u[i] - 0.01);
  }
}

typedef struct decay {
  double rate, loss; /* of the nominal rate; |kinetic lost - heat gained| over the start */
} decay;

/* A gas of u = 0.01 J/kg, nu = 0.02 m^2/s, V = 1 mm/s, over one e-fold of the velocity. */
static decay run(const char *energy, const char *method, const char *form, int n)
{
  enum { ACROSS = 10 };
  const double V = 1e-3, u0 = 0.01, nu = 0.02, k = 2 * pi, dx = 1.0 / n, end = 1 / (nu * k * k);
  sph_sim *sim = sph_sim_create(&(
      sph_sim_def){.dim = 2, .dx = dx, .periodic = {1, 1}, .length = {1, ACROSS * dx}, .speed = V});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0, 0}, (double[]){1, ACROSS * dx}, 1);
  sph_eos eos = sph_eos_ideal_gas(1.4);
  eos.c_v = 2;
  sph_group_set_eos(gas, eos);
  sph_group_set_viscosity(gas, nu);
  sph_group_set_energy(gas, energy);
  sph_sim_add_term(sim, sph_term_continuity_form("c1"));
  sph_sim_add_term(sim, sph_term_pressure_form("s"));
  sph_sim_add_term(sim, sph_term_viscosity_laminar(form));
  const double tolerance = strcmp(method, "leapfrog") ? 1e-6 : 0;
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .tolerance = tolerance});
  assert_string_equal(sph_sim_error(sim), "");
  const double *x = sph_group_read(gas, "position", 0);
  double *v = sph_group_write(gas, "velocity", 1), *u = sph_group_write(gas, "energy", 0);
  for (long i = 0; i < sph_group_count(gas); i++) v[i] = V * sin(k * x[i]), u[i] = u0;
  double before, after, cold, hot;
  sums(gas, &before, &cold);
  if (sph_sim_run(sim, end) != SPH_OK) fail_msg("%s: %s", energy, sph_sim_error(sim));
  sums(gas, &after, &hot);
  sph_sim_free(sim);
  return (decay){log(before / after) / 2, fabs(before - after - (hot - cold)) / before};
}

static void shear_wave(void **state)
{
  (void)state;
  static const char *const energy[] = {"u", "total", "entropy", "temperature"};
  static const char *const method[] = {"erk:bogacki-shampine-4-2-3", "leapfrog"};
  for (int m = 0; m < 2; m++)
    for (int e = 0; e < 4; e++) {
      decay d = run(energy[e], method[m], "morris", 40);
      print_message("# %s, %s: rate %.5f of the nominal, energy lost %.2g\n", method[m], energy[e],
                    d.rate, d.loss);
      double bar = e == 1 ? 1e-10 : m ? 1e-4 : 1e-6; /* a linear sum; order 2, 3 */
      assert_true(fabs(d.rate - 1) <= 0.01 && d.loss <= bar);
    }
  decay d = run("u", method[0], "mcg", 40);
  print_message("# MCG: rate %.4f of the nominal, energy lost %.2g\n", d.rate, d.loss);
  assert_true(fabs(d.rate - 0.88) <= 0.01 && d.loss <= 1e-6);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(morris),          cmocka_unit_test(mcg),        cmocka_unit_test(artificial),
      cmocka_unit_test(signal_velocity), cmocka_unit_test(conduction), cmocka_unit_test(shear_wave),
  };
  return cmocka_run_group_tests_name("viscosity", tests, NULL, NULL);
}
