/* The same flow of a gas with u, total energy, entropy or temperature integrated: the equations
 * are the same for exact time integration, so the results differ by its error, which falls with
 * the order of the scheme.  A standing wave of a tenth of the sound speed, with laminar viscosity
 * and conduction. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

enum { N = 50 };
static const double pi = 3.14159265358979323846, gamma_gas = 1.4, c_v = 0.7;

/* Stiffened by p_inf, so that T is not in proportion to u: p + p_inf = 1 Pa, c_v T = 2.5 J/kg. */
static double p_inf;

typedef struct state {
  double p[N], v[N], T[N], e, kinetic;
} state;

static void read(sph_sim *sim, state *s)
{
  sph_group *gas = sph_sim_group(sim, "gas");
  const double *p = sph_group_read(gas, "pressure", 0), *v = sph_group_read(gas, "velocity", 0);
  const double *T = sph_group_read(gas, "temperature", 0),
               *e = sph_group_read(gas, "total_energy", 0);
  assert_true(p && v && T && e);
  s->e = s->kinetic = 0;
  for (int i = 0; i < N; i++) {
    s->p[i] = p[i], s->v[i] = v[i], s->T[i] = T[i];
    s->e += e[i] / N, s->kinetic += v[i] * v[i] / (2 * N);
  }
}

/* Half a period of the wave; row c1 or c2. */
static state run(const char *energy, const char *method, int c2, int steps)
{
  const double c = sqrt(gamma_gas), end = 0.5 / c;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                               .dx = 1.0 / N,
                                               .kernel = "quintic-spline",
                                               .h_over_dx = 1.2,
                                               .periodic = {1},
                                               .length = {1}});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, 1);
  sph_eos eos =
      p_inf > 0 ? sph_eos_stiffened_gas(1, gamma_gas, p_inf, 0) : sph_eos_ideal_gas(gamma_gas);
  eos.c_v = c_v;
  sph_group_set_eos(gas, eos);
  sph_group_set_viscosity(gas, 2e-2), sph_group_set_conductivity(gas, 1e-2);
  sph_group_set_energy(gas, energy);
  sph_sim_add_term(sim, sph_term_continuity_form(c2 ? "c2" : "c1"));
  sph_sim_add_term(sim, sph_term_pressure_form(c2 ? "c2" : "s"));
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .dt_fixed = end / steps});
  const double *x = sph_group_read(gas, "position", 0);
  double *v = sph_group_write(gas, "velocity", 0), *u = sph_group_write(gas, "energy", 0);
  for (int i = 0; i < N; i++) {
    v[i] = 0.1 * c * sin(2 * pi * x[i]);
    u[i] = 2.5 + p_inf + 0.25 * cos(2 * pi * x[i]);
  }
  if (sph_sim_run(sim, end) != SPH_OK) fail_msg("%s, %s: %s", energy, method, sph_sim_error(sim));
  state s;
  read(sim, &s);
  sph_sim_free(sim);
  return s;
}

/* Largest difference of p, v, T, over their swing. */
static double difference(const state *a, const state *b)
{
  double worst = 0;
  for (int i = 0; i < N; i++) {
    worst = fmax(worst, fabs(a->p[i] - b->p[i]) / 0.1);
    worst = fmax(worst, fabs(a->v[i] - b->v[i]) / 0.1);
    worst = fmax(worst, fabs(a->T[i] - b->T[i]) / (0.25 / c_v));
  }
  return worst;
}

static void compare(const char *energy, const char *method, int c2, int steps, double order,
                    double bar)
{
  state u = run("u", method, c2, steps), fine_u = run("u", method, c2, 2 * steps);
  state other = run(energy, method, c2, steps), fine_other = run(energy, method, c2, 2 * steps);
  double coarse = difference(&u, &other), fine = difference(&fine_u, &fine_other);
  print_message("# %s, %s, %s: %.2g from u, %.2g with half the step, order %.2f\n",
                c2 ? "c2" : "c1", method, energy, coarse, fine, log2(coarse / fine));
  assert_true(coarse > 0 && coarse <= bar);
  assert_true(log2(coarse / fine) >= order - 0.2);
  assert_true(fine_u.kinetic < 0.9 * 0.0025 * gamma_gas); /* something was dissipated */
}

static const char erk[] = "erk:bogacki-shampine-4-2-3";

static void of_an_ideal_gas(void **unused)
{
  (void)unused;
  static const char *const energy[] = {"total", "entropy"};
  p_inf = 0;
  for (int k = 0; k < 4; k++) {
    compare(energy[k / 2], "leapfrog", k % 2, 200, 2, 1e-4);
    compare(energy[k / 2], erk, k % 2, 100, 3, 1e-5);
  }
  state u = run("u", erk, 0, 100), T = run("temperature", erk, 0, 100); /* T = u/c_v: the same */
  assert_true(difference(&u, &T) <= 1e-12);
}

static void of_a_stiffened_gas(void **unused)
{
  (void)unused;
  static const char *const energy[] = {"total", "temperature"};
  p_inf = 0.5;
  for (int k = 0; k < 4; k++) {
    compare(energy[k / 2], "leapfrog", k % 2, 200, 2, 1e-4);
    compare(energy[k / 2], erk, k % 2, 100, 3, 1e-5);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(of_an_ideal_gas),
                                     cmocka_unit_test(of_a_stiffened_gas)};
  return cmocka_run_group_tests_name("energies", tests, NULL, NULL);
}
