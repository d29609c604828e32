/* Energies that a group does not integrate follow from the one that it does, by their definitions:
 *
 *   e = u + v^2/2;  H = u + p/rho, gamma u of an ideal gas, gamma c_v T + q of a stiffened one;
 *   A = p/rho^gamma;  c_v T = u, of a stiffened gas u - q - p_inf/rho
 *
 * read from the groups at the start and after a run, and from a snapshot. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>
#include <unistd.h>

#include "snapshot.h"
#include "sphode.h"

enum { N = 40 };
static const double pi = 3.14159265358979323846;
static const double gamma_gas = 1.4, c_v = 0.7, p_inf = 0.5, q = 0.3; /* [J/(kg K)], [Pa], [J/kg] */

static void near(const char *what, double value, double right)
{
  if (!(fabs(value / right - 1) <= 1e-13)) fail_msg("%s: %.17g, not %.17g", what, value, right);
}

/* Waves of velocity, density and energy in a periodic line. */
static sph_sim *line(int stiff, const char *energy)
{
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 1.0 / N, .periodic = {1}, .length = {1}});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, 1);
  sph_eos eos =
      stiff ? sph_eos_stiffened_gas(1, gamma_gas, p_inf, q) : sph_eos_ideal_gas(gamma_gas);
  eos.c_v = c_v;
  sph_group_set_eos(gas, eos);
  sph_group_set_energy(gas, energy);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  const double *x = sph_group_read(gas, "position", 0);
  double *v = sph_group_write(gas, "velocity", 0), *u = sph_group_write(gas, "energy", 0),
         *rho = sph_group_write(gas, "density", 0);
  for (int i = 0; i < N; i++) {
    v[i] = 0.5 + 0.3 * sin(2 * pi * x[i]);
    u[i] = 2.5 + 0.5 * cos(4 * pi * x[i]);
    rho[i] = 1.2 + 0.3 * cos(2 * pi * x[i]);
  }
  return sim;
}

static double temperature(int stiff, double u, double rho)
{
  return (stiff ? u - q - p_inf / rho : u) / c_v;
}

static double enthalpy(int stiff, double u, double rho)
{
  return stiff ? gamma_gas * c_v * temperature(1, u, rho) + q : gamma_gas * u;
}

static void definitions(sph_sim *sim, int stiff)
{
  const sph_group *gas = sph_sim_group(sim, "gas");
  const double *u = sph_group_read(gas, "energy", 0), *v = sph_group_read(gas, "velocity", 0),
               *rho = sph_group_read(gas, "density", 0), *p = sph_group_read(gas, "pressure", 0),
               *e = sph_group_read(gas, "total_energy", 0),
               *A = sph_group_read(gas, "entropic_function", 0),
               *T = sph_group_read(gas, "temperature", 0), *H = sph_group_read(gas, "enthalpy", 0);
  assert_true(u && v && rho && p && e && T && H && (A == NULL) == stiff);
  assert_null(sph_group_read(gas, "enthalpy", 1));
  for (int i = 0; i < N; i++) {
    near("total energy", e[i], u[i] + v[i] * v[i] / 2);
    near("temperature", T[i], temperature(stiff, u[i], rho[i]));
    near("enthalpy", H[i], enthalpy(stiff, u[i], rho[i]));
    near("u + p/rho", H[i], u[i] + p[i] / rho[i]);
    if (A) near("entropic function", A[i], p[i] / pow(rho[i], gamma_gas));
  }
}

static const char *at(const char *folder, const char *file)
{
  static char path[200];
  snprintf(path, sizeof path, "%s/%s", folder, file);
  return path;
}

static void in_snapshot(const char *folder, const char *file, sph_sim *sim, int stiff)
{
  const sph_group *gas = sph_sim_group(sim, "gas");
  const double *u = sph_group_read(gas, "energy", 0), *rho = sph_group_read(gas, "density", 0);
  sph_snapshot H, T;
  sph_error error = {0};
  assert_int_equal(sph_snapshot_read(at(folder, file), "enthalpy", &H, &error), SPH_OK);
  assert_int_equal(sph_snapshot_read(at(folder, file), "temperature", &T, &error), SPH_OK);
  assert_string_equal(H.unit, "J/kg");
  assert_true(H.n[SPH_FLUIDS] == N && H.value[SPH_FLUIDS] && T.value[SPH_FLUIDS]);
  for (int i = 0; i < N; i++) {
    near("saved enthalpy", H.value[SPH_FLUIDS][i], enthalpy(stiff, u[i], rho[i]));
    near("saved temperature", T.value[SPH_FLUIDS][i], temperature(stiff, u[i], rho[i]));
  }
  sph_snapshot_read_free(&H);
  sph_snapshot_read_free(&T);
}

static void check(int stiff, const char *energy)
{
  char folder[] = "/tmp/sphode-energies-XXXXXX";
  assert_non_null(mkdtemp(folder));
  sph_sim *sim = line(stiff, energy);
  sph_sim_add_output(sim, sph_output_hdf5(folder, INFINITY)); /* at the start and the end */
  if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  definitions(sim, stiff);
  if (sph_sim_run(sim, 0.05) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  definitions(sim, stiff);
  in_snapshot(folder, "snapshot_0001.hdf", sim, stiff);
  sph_sim_free(sim);
  static const char *const files[] = {"snapshot_0000.hdf", "snapshot_0001.hdf",
                                      "snapshot.hdf.series"};
  for (int k = 0; k < 3; k++) assert_int_equal(unlink(at(folder, files[k])), 0);
  assert_int_equal(rmdir(folder), 0);
}

static void of_an_ideal_gas(void **state)
{
  (void)state;
  check(0, "u"), check(0, "total"), check(0, "entropy"), check(0, "temperature");
}

static void of_a_stiffened_gas(void **state)
{
  (void)state;
  check(1, "u"), check(1, "total"), check(1, "temperature");
}

/* A liquid without energy has none of them; nor has a wall. */
static void of_a_liquid(void **state)
{
  static const char *const field[] = {"total_energy", "entropic_function", "temperature",
                                      "enthalpy"};
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0}, (double[]){1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_group *wall = sph_group_walls(sim, "wall", (double[]){0}, (double[]){1}, 1000);
  sph_group_set_boundary(wall, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  for (int k = 0; k < 4; k++) {
    assert_null(sph_group_read(water, field[k], 0));
    assert_null(sph_group_read(wall, field[k], 0));
  }
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(of_an_ideal_gas),
                                     cmocka_unit_test(of_a_stiffened_gas),
                                     cmocka_unit_test(of_a_liquid)};
  return cmocka_run_group_tests_name("energy fields", tests, NULL, NULL);
}
