/* Error weights, entry by entry, against the scales of docs/theory.md, Time integration:
 *
 *   x: h;  v: V;  rho: rho0 min(1, (V/c0)^2);  u, e: V^2/2;  A: (gamma - 1) rho^(1-gamma) V^2/2;
 *   T: V^2/(2 c_v);  scalars: their own
 *
 * V = max(user's, sqrt(|g| height), largest |v|, 0.01 c0); of a gas mean c for c0, mean rho for
 * rho0, and V at least mean c where it has no c0.  An energy that a liquid carries along: the range
 * of u, if that is more than V^2/2. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"
#include "sphode/sundials.h"

enum { N = 60 }; /* 10 x 6 particles */
static const double dx = 0.1, h_over_dx = 1.5;

static sph_sim *box(double speed, double rho0, sph_eos eos, const char *energy)
{
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = h_over_dx, .speed = speed});
  sph_group *fluid = sph_group_box(sim, "fluid", (double[]){0, 0}, (double[]){1, 0.6}, rho0);
  sph_group_set_eos(fluid, eos);
  if (energy) sph_group_set_energy(fluid, energy);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  assert_int_equal(sph_group_count(fluid), N);
  return sim;
}

/* The weights of all entries of one component are 1/scale. */
static void scale_is(sph_sim *sim, const char *field, int component, double scale)
{
  N_Vector y = sph_sim_vector(sim);
  if (!y) fail_msg("%s", sph_sim_error(sim));
  N_Vector weight = N_VClone(y);
  assert_non_null(weight);
  N_VConst(0, weight);
  assert_int_equal(sph_sim_weights(y, weight, sim), 0);
  const double *at = sph_group_read(sph_sim_group(sim, "fluid"), field, component);
  assert_non_null(at);
  const double *w = N_VGetArrayPointer(weight) + (at - N_VGetArrayPointer(y));
  for (int i = 0; i < N; i++)
    if (!(fabs(w[i] * scale - 1) <= 1e-12))
      fail_msg("%s %d: scale %.17g, not %.17g", field, component, 1 / w[i], scale);
  N_VDestroy(weight);
}

/* Those of motion: V, and the ratio of densities that it makes. */
static void motion_is(sph_sim *sim, double V, double rho, double c)
{
  for (int d = 0; d < 2; d++) {
    scale_is(sim, "position", d, h_over_dx * dx);
    scale_is(sim, "velocity", d, V);
  }
  scale_is(sim, "density", 0, V < c ? rho * V * V / (c * c) : rho);
}

/* What V a liquid has: the largest of four. */
static void speed_of_a_liquid(void **state)
{
  static const struct {
    double user, g[2], v[2], V;
  } cases[] = {{.V = 0.2},
               {.user = 0.5, .V = 0.5},
               {.user = 0.5, .v = {0.6, 0.8}, .V = 1},
               {.user = 0.5, .g = {0, -10}, .v = {0.6, 0.8}, .V = 2.23606797749978970}, /* 0.5 m */
               {.user = 0.5, .g = {40, 0}, .v = {0.6, 0.8}, .V = 6},                    /* 0.9 m */
               {.user = 3, .g = {0, -10}, .v = {0.6, 0.8}, .V = 3},
               {.user = 30, .V = 30}}; /* more than c0: density at most by rho0 */
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    sph_sim *sim = box(cases[k].user, 1000, sph_eos_tait(1000, 20, 7), NULL);
    sph_sim_add_term(sim, sph_term_gravity((double[]){cases[k].g[0], cases[k].g[1], 0}));
    for (int d = 0; d < 2; d++)
      sph_group_write(sph_sim_group(sim, "fluid"), "velocity", d)[7] = cases[k].v[d];
    motion_is(sim, cases[k].V, 1000, 20);
    sph_sim_free(sim);
  }
}

/* u of a liquid between 5 and 25 J/kg: a range of 20 against V^2/2. */
static void carried_energy(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    sph_eos eos = sph_eos_tait(1000, 20, 7);
    eos.c_v = 4;
    sph_sim *sim = box(k < 2 ? 2 : 10, 1000, eos, k % 2 ? "temperature" : "u");
    double *u = sph_group_write(sph_sim_group(sim, "fluid"), "energy", 0);
    for (int i = 0; i < N; i++) u[i] = 5 + 20.0 * i / (N - 1);
    scale_is(sim, k % 2 ? "temperature" : "energy", 0, (k < 2 ? 20 : 50) / (k % 2 ? 4.0 : 1.0));
    sph_sim_free(sim);
  }
}

static int nothing(const sph_term *term, const sph_particles *particles)
{
  (void)term, (void)particles;
  return SPH_OK;
}

static void scalars(void **state)
{
  (void)state;
  sph_sim *sim = box(1, 1000, sph_eos_tait(1000, 20, 7), NULL);
  sph_sim_add_term(sim,
                   (sph_term){.name = "a", .body = nothing, .scalar = {.name = "age", .scale = 3}});
  sph_sim_add_term(sim, (sph_term){.name = "b",
                                   .body = nothing,
                                   .scalar = {.name = "dye", .scale = 0.01}});
  scale_is(sim, "age", 0, 3);
  scale_is(sim, "dye", 0, 0.01);
  sph_sim_free(sim);
}

/* ---- gases ---- */

static const struct {
  const char *name, *field;
} energies[] = {{"u", "energy"},
                {"total", "total_energy"},
                {"temperature", "temperature"},
                {"entropy", "entropic_function"}};

typedef struct means {
  double rho, c;
} means;

/* Density and energy that differ from particle to particle. */
static means vary(sph_sim *sim, double rho0, double u0, double p_inf, double q)
{
  double *rho = sph_group_write(sph_sim_group(sim, "fluid"), "density", 0),
         *u = sph_group_write(sph_sim_group(sim, "fluid"), "energy", 0);
  means mean = {0, 0};
  for (int i = 0; i < N; i++) {
    rho[i] = rho0 * (1 + 0.01 * i), u[i] = u0 * (1 + 0.02 * (i % 7));
    mean.rho += rho[i] / N;
    mean.c += sqrt(1.4 * 0.4 * (u[i] - q - p_inf / rho[i])) / N;
  }
  return mean;
}

static void energy_is(sph_sim *sim, int k, double V, double rho, double c_v)
{
  double u = V * V / 2;
  const double scale[] = {u, u, u / c_v, 0.4 * pow(rho, -0.4) * u};
  scale_is(sim, energies[k].field, 0, scale[k]);
}

/* At rest, and with a user's speed beyond that of sound. */
static void ideal_gas(void **state)
{
  (void)state;
  for (int k = 0; k < 8; k++) {
    sph_eos eos = sph_eos_ideal_gas(1.4);
    eos.c_v = 0.7;
    sph_sim *sim = box(k / 4 ? 9 : 0.1, 2, eos, energies[k % 4].name);
    means mean = vary(sim, 2, 2.5, 0, 0);
    double V = k / 4 ? 9 : mean.c;
    motion_is(sim, V, mean.rho, mean.c);
    energy_is(sim, k % 4, V, mean.rho, 0.7);
    sph_sim_free(sim);
  }
}

/* It has a c0: as slow as a liquid may be; but rho and c are those of the start. */
static void stiffened_gas(void **state)
{
  (void)state;
  for (int k = 0; k < 6; k++) {
    sph_eos eos = sph_eos_stiffened_gas(2, 1.4, 3, 0.3);
    eos.c_v = 0.7;
    sph_sim *sim = box(k / 3 ? 1 : 0, 2, eos, energies[k % 3].name);
    means mean = vary(sim, 2, 4, 3, 0.3);
    double V = k / 3 ? 1 : 0.01 * mean.c;
    motion_is(sim, V, mean.rho, mean.c);
    energy_is(sim, k % 3, V, mean.rho, 0.7);
    sph_sim_free(sim);
  }
}

/* What the user sets comes first, of a group before that of all; the others stay. */
static void set_by_hand(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    sph_sim *sim = box(2, 1000, sph_eos_tait(1000, 20, 7), "u");
    sph_sim_add_term(sim, (sph_term){.name = "rest",
                                     .body = nothing,
                                     .scalar = {.name = "q", .scale = 3, .initial = 1}});
    sph_sim_set_scale(sim, NULL, "velocity", 7);
    sph_sim_set_scale(sim, NULL, "q", 0.25);
    if (k) sph_sim_set_scale(sim, sph_sim_group(sim, "fluid"), "velocity", 5);
    if (k == 2) sph_sim_set_scale(sim, NULL, "velocity", 9);
    for (int d = 0; d < 2; d++) {
      scale_is(sim, "velocity", d, k ? 5 : 7);
      scale_is(sim, "position", d, h_over_dx * dx);
    }
    scale_is(sim, "density", 0, 1000 * 0.1 * 0.1);
    scale_is(sim, "energy", 0, 2);
    scale_is(sim, "q", 0, 0.25);
    sph_sim_free(sim);
  }
}

/* Twice all scales and half of the tolerance: the same steps, which errors bind. */
static void scales_times_tolerance(void **state)
{
  (void)state;
  double steps[2], v[2];
  for (int k = 0; k < 2; k++) {
    sph_sim *sim = box(2, 1000, sph_eos_tait(1000, 20, 7), NULL);
    sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-6 / (1 + k)});
    if (k) {
      sph_sim_set_scale(sim, NULL, "position", 2 * h_over_dx * dx);
      sph_sim_set_scale(sim, NULL, "velocity", 4);
      sph_sim_set_scale(sim, NULL, "density", 2 * 1000 * 0.1 * 0.1);
    }
    double *vx = sph_group_write(sph_sim_group(sim, "fluid"), "velocity", 0);
    for (int i = 0; i < N; i++) vx[i] = 2 * sin(i);
    assert_int_equal(sph_sim_run(sim, 0.05), SPH_OK);
    sph_sim_stats stats;
    sph_sim_get_stats(sim, &stats);
    steps[k] = (double)stats.step.steps;
    v[k] = sph_group_read(sph_sim_group(sim, "fluid"), "velocity", 0)[7];
    assert_true(stats.step.bound_by[SPH_BOUND_ERROR] > stats.step.steps / 2);
    sph_sim_free(sim);
  }
  assert_true(steps[0] == steps[1]);
  assert_true(fabs(v[0] - v[1]) < 1e-9);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(speed_of_a_liquid),
      cmocka_unit_test(carried_energy),
      cmocka_unit_test(scalars),
      cmocka_unit_test(ideal_gas),
      cmocka_unit_test(stiffened_gas),
      cmocka_unit_test(set_by_hand),
      cmocka_unit_test(scales_times_tolerance),
  };
  return cmocka_run_group_tests_name("weights", tests, NULL, NULL);
}
