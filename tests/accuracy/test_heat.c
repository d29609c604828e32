/* Heat conduction at rest in 1D (Cleary & Monaghan 1999).
 *
 * Slab: faces of constant temperature, T = T0 + A sin(pi x/L) keeps its shape and decays; 100
 * particles, h/dx = 2, until it has fallen to 0.14 A.  Two media: glass touches steel, error
 * functions; 100 particles each.  Error: rms of T over A or over the difference of temperatures;
 * bar 0.5 %.  Between two media no heat is lost; a wall without a temperature lets none through. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "sphode.h"

enum { MOST = 400 };
static const double L = 0.01, T0 = 300, pi = 3.14159265358979323846; /* [m], [K] */

typedef struct medium {
  double rho, kappa, c; /* [kg/m^3], [W/m/K], [J/kg/K] */
} medium;
static const medium water = {1000, 0.6, 4182}, glass = {2500, 1, 840}, steel = {7900, 15, 500};

/* A liquid that does not move, so that slow sound may allow long steps. */
static sph_group *add(sph_sim *sim, const char *name, const medium *m, double from, double to)
{
  sph_group *group = sph_group_box(sim, name, &from, &to, m->rho);
  sph_eos eos = sph_eos_linear(m->rho, 1e-4, -INFINITY);
  eos.c_v = m->c;
  sph_group_set_eos(group, eos);
  sph_group_set_conductivity(group, m->kappa);
  sph_group_set_energy(group, "temperature");
  return group;
}

static sph_sim *begin(int n, double h_over_dx)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = L / n, .h_over_dx = h_over_dx});
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  return sim;
}

/* T = T0 + rise + A sin(pi x/L) */
static void set_temperature(sph_group *group, double rise, double A)
{
  const double *x = sph_group_read(group, "position", 0);
  double T[MOST];
  assert_in_range(sph_group_count(group), 1, MOST);
  for (long i = 0; i < sph_group_count(group); i++) T[i] = T0 + rise + A * sin(pi * x[i] / L);
  sph_group_set_temperature(group, T);
}

static void run_to(sph_sim *sim, double t)
{
  if (sph_sim_run(sim, t) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
}

static sph_sim *slab_between(int n, double wall_temperature, double A)
{
  sph_sim *sim = begin(n, 2);
  set_temperature(add(sim, "water", &water, 0, L), 0, A);
  sph_group *faces = sph_group_walls(sim, "faces", (double[]){0}, &L, water.rho);
  sph_boundary boundary = sph_boundary_adami();
  boundary.temperature = wall_temperature;
  sph_group_set_boundary(faces, boundary);
  return sim;
}

static void slab(void **state)
{
  (void)state;
  const double A = 10, unit = water.rho * water.c * L * L / water.kappa;
  const sph_exact_heat_mode exact = {{T0, water.kappa, water.rho * water.c}, A, pi / L};
  sph_sim *sim = slab_between(100, T0, A);
  const sph_group *group = sph_sim_group(sim, "water");
  for (double t = 0.025; t <= 0.2; t *= 2) {
    run_to(sim, t * unit);
    const double *x = sph_group_read(group, "position", 0);
    const double *T = sph_group_read(group, "temperature", 0);
    double sum = 0, T_x;
    long n = sph_group_count(group);
    for (long i = 0; i < n; i++) {
      assert_int_equal(sph_exact_heat_mode_at(&exact, t * unit, 1, &x[i], &T_x, NULL), SPH_OK);
      sum += (T[i] - T_x) * (T[i] - T_x) / (A * A);
    }
    print_message("# slab, t = %g rho c L^2/kappa: rms %.3f %% (bar 0.5 %%)\n", t,
                  100 * sqrt(sum / (double)n));
    assert_true(sqrt(sum / (double)n) <= 0.005);
  }
  sph_sim_free(sim);
}

/* Heat in the fluids [J/m^2]. */
static double heat_of(const sph_sim *sim)
{
  sph_balance balance;
  sph_sim_balance(sim, &balance);
  return balance.internal;
}

static void adiabatic_walls(void **state)
{
  (void)state;
  sph_sim *sim = slab_between(50, 0, 10);
  double before = heat_of(sim);
  run_to(sim, 0.02 * water.rho * water.c * L * L / water.kappa);
  assert_true(fabs(heat_of(sim) / before - 1) <= 1e-12);
  const double *T = sph_group_read(sph_sim_group(sim, "water"), "temperature", 0);
  assert_true(T[0] > T0 + 1); /* the cold ends are warmed */
  sph_sim_free(sim);
}

static double error_of(const sph_sim *sim, const sph_exact_heat_step *exact)
{
  double sum = 0, count = 0, difference = exact->left.temperature - exact->right.temperature;
  const sph_group *group;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    const double *x = sph_group_read(group, "position", 0);
    const double *T = sph_group_read(group, "temperature", 0);
    for (long i = 0; i < sph_group_count(group); i++, count++) {
      double T_x;
      assert_int_equal(sph_exact_heat_step_at(exact, sph_sim_time(sim), 1, &x[i], &T_x, NULL),
                       SPH_OK);
      sum += pow((T[i] - T_x) / difference, 2);
    }
  }
  return sqrt(sum / count);
}

static double two_media_at(int n)
{
  const sph_exact_heat_step exact = {{T0 + 50, glass.kappa, glass.rho * glass.c},
                                     {T0, steel.kappa, steel.rho * steel.c}};
  sph_sim *sim = begin(n, 1.5);
  set_temperature(add(sim, "glass", &glass, -L, 0), 50, 0);
  set_temperature(add(sim, "steel", &steel, 0, L), 0, 0);
  double before = heat_of(sim), most = 0;
  for (double t = 0.125; t <= 0.5; t *= 2) {
    run_to(sim, t);
    double error = error_of(sim, &exact);
    print_message("# two media, %d particles each, t = %g s: rms %.3f %%\n", n, t, 100 * error);
    most = fmax(most, error);
  }
  assert_true(fabs(heat_of(sim) / before - 1) <= 1e-12);
  sph_sim_free(sim);
  return most;
}

static void two_media(void **state)
{
  (void)state;
  double fine = two_media_at(100), coarse = two_media_at(50);
  print_message("# two media: order %.2f between 50 and 100 (bar 1)\n", log2(coarse / fine));
  assert_true(fine <= 0.005);
  assert_true(log2(coarse / fine) >= 1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(slab), cmocka_unit_test(adiabatic_walls),
                                     cmocka_unit_test(two_media)};
  return cmocka_run_group_tests_name("heat", tests, NULL, NULL);
}
