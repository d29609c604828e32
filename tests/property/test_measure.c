/* Forces on walls, powers of terms: what is measured is what f does.
 *
 *   momentum   sum m a = m g - sum of the forces on all walls, to rounding; the same for torques
 *   weight     water at rest weighs on the floor what it weighs, and pushes at the side
 *              rho g H^2/2; a block in it loses the weight of the water in its place (Archimedes)
 *   powers     dK/dt and dU/dt along f, from sph_sim_balance by central differences */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../near.h"
#include "nvector.h"
#include "sphode.h"
#include "sphode/sundials.h"

static const double g = 9.81, rho0 = 1000; /* [m/s^2], [kg/m^3] */

/* ---- a tank in motion ---- */

/* Attraction, the same for both of a pair. */
static void push(const sph_term *term, const sph_tile *tile)
{
  (void)term;
  for (long k = 0; k < tile->n; k++) tile->push[k] += 1e-2 * tile->F[k] * tile->m[k];
}

static double noise(unsigned long *state)
{
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-53 - 0.5;
}

static void stir(sph_group *water, int dim)
{
  unsigned long state = 7;
  double *rho = sph_group_write(water, "density", 0);
  for (long i = 0; i < sph_group_count(water); i++) rho[i] *= 1 + 0.02 * noise(&state);
  for (int d = 0; d < dim; d++) {
    double *v = sph_group_write(water, "velocity", d);
    for (long i = 0; i < sph_group_count(water); i++) v[i] = noise(&state);
  }
}

typedef struct kind {
  int dim, periodic, laminar, own;
} kind;

/* Water of random velocities on a floor, under a lid. */
static sph_sim *stirred(const kind *k)
{
  const double top[3] = {1.2, 1.2, 1.2}, dx = 0.1;
  sph_sim_def def = {.dim = k->dim, .dx = dx};
  if (k->periodic) def.periodic[0] = 1, def.length[0] = 1.2;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *water = sph_group_create(sim, "water", "fluid");
  sph_group_add_box(water, (double[3]){0}, top, rho0);
  sph_group_jitter(water, 0.2, 3);
  sph_group_set_eos(water, sph_eos_tait(rho0, 20, 7));
  for (int w = 0; w < 2; w++) {
    sph_group *wall = sph_group_create(sim, w ? "lid" : "floor", "wall");
    double low[3] = {0}, high[3] = {1.2, 1.2, 1.2};
    low[k->dim - 1] = w ? 1.2 : -4 * dx;
    high[k->dim - 1] = w ? 1.2 + 4 * dx : 0;
    sph_group_add_box(wall, low, high, rho0);
    sph_boundary boundary = sph_boundary_adami();
    boundary.no_slip = w;
    sph_group_set_boundary(wall, boundary);
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.3, 0.1));
  if (k->laminar) sph_sim_add_term(sim, sph_term_viscosity_laminar("mcg"));
  if (k->laminar) sph_group_set_viscosity(water, 5);
  if (k->own) sph_sim_add_term(sim, (sph_term){.name = "push", .pair = push, .adds = "push"});
  sph_sim_add_term(sim, sph_term_gravity((double[3]){1, -g, 2}));
  stir(water, k->dim);
  return sim;
}

/* sum m a, and sum (x - about) x m a, of the fluid; size: of what cancels in it. */
static void fluid_forces(const sph_sim *sim, const double about[3], double force[3],
                         double torque[3], double *size)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *m = sph_group_read(water, "mass", 0), *x[3], *a[3];
  const int dim = sph_sim_dim(sim);
  for (int d = 0; d < dim; d++) {
    x[d] = sph_group_read(water, "position", d);
    a[d] = sph_group_rate(water, "velocity", d);
  }
  *size = 0;
  for (long i = 0; i < sph_group_count(water); i++) {
    double f[3] = {0}, arm[3] = {0}, gravity[3] = {1, -g, 2};
    for (int d = 0; d < dim; d++) {
      f[d] = m[i] * (a[d][i] - gravity[d]);
      arm[d] = x[d][i] - about[d];
      force[d] += f[d];
      *size += fabs(f[d]);
    }
    for (int d = 0; d < 3; d++)
      torque[d] += arm[(d + 1) % 3] * f[(d + 2) % 3] - arm[(d + 2) % 3] * f[(d + 1) % 3];
  }
}

static void momentum(void **state)
{
  (void)state;
  static const kind kinds[] = {{1, 0, 0, 0}, {2, 0, 0, 0}, {2, 0, 1, 0}, {2, 1, 1, 0},
                               {2, 0, 1, 1}, {3, 0, 1, 0}, {3, 1, 0, 0}};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    sph_sim *sim = stirred(&kinds[k]);
    const double about[3] = {0.3, -0.2, 0.1};
    double force[3] = {0}, torque[3] = {0}, size, parts = 0, viscous = 0, total = 0;
    if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
    fluid_forces(sim, about, force, torque, &size);
    for (int w = 0; w < 2; w++) {
      sph_force f;
      if (sph_sim_force(sim, sph_sim_group(sim, w ? "lid" : "floor"), about, &f) != SPH_OK)
        fail_msg("%s", sph_sim_error(sim));
      for (int d = 0; d < 3; d++) {
        force[d] += f.force[d], torque[d] += f.torque[d];
        parts += fabs(f.force[d] - f.pressure[d] - f.viscous[d]);
        viscous += fabs(f.viscous[d]), total += fabs(f.force[d]);
        if (w == 0 && !kinds[k].own) assert_near(f.viscous[d], 0, 0); /* free slip */
      }
    }
    print_message("# %dD: forces %.3g, of them viscous %.3g, of %.3g N/m^%d\n", kinds[k].dim, total,
                  viscous, size, 3 - kinds[k].dim);
    assert_true(total > 1e-3 * size);
    if (kinds[k].dim > 1) assert_true(viscous > 1e-6 * size); /* in 1D none approaches */
    if (kinds[k].own)
      assert_true(parts > 1e-6 * size);
    else
      assert_true(parts <= 1e-13 * size);
    for (int d = 0; d < kinds[k].dim; d++) assert_near(force[d], 0, 1e-13 * size);
    /* Across a periodic boundary the arms of a pair differ by the box: then there is no balance. */
    for (int d = 0; d < 3 && !kinds[k].periodic; d++) assert_near(torque[d], 0, 1e-13 * size);
    sph_sim_free(sim);
  }
}

/* ---- water at rest ---- */

/* A tank 2 H wide with water to H at rest, walls apart, and a block H/2 wide and high in it. */
static sph_sim *at_rest(double dx, int block)
{
  const double H = 1, c0 = 30 * sqrt(g * H);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx});
  sph_group *water = sph_group_create(sim, "water", "fluid");
  const double low[4][2] = {{0, 0}, {0, .75}, {0, .25}, {1.25, .25}};
  const double high[4][2] = {{2, .25}, {2, H}, {.75, .75}, {2, .75}};
  for (int k = 0; k < 4; k++) sph_group_add_box(water, low[k], high[k], rho0);
  sph_group *middle = sph_group_create(sim, "block", block ? "wall" : "fluid");
  sph_group_add_box(middle, (double[]){0.75, 0.25}, (double[]){1.25, 0.75}, rho0);
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_box(floor, (double[]){-4 * dx, -4 * dx}, (double[]){2 + 4 * dx, 0}, rho0);
  sph_group *left = sph_group_create(sim, "left", "wall");
  sph_group_add_box(left, (double[]){-4 * dx, 0}, (double[]){0, 1.5}, rho0);
  sph_group *right = sph_group_create(sim, "right", "wall");
  sph_group_add_box(right, (double[]){2, 0}, (double[]){2 + 4 * dx, 1.5}, rho0);
  sph_group_set_boundary(floor, sph_boundary_adami());
  sph_group_set_boundary(left, sph_boundary_adami());
  sph_group_set_boundary(right, sph_boundary_adami());
  if (block) sph_group_set_boundary(middle, sph_boundary_adami());
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  if (!block) sph_group_set_eos(middle, sph_eos_tait(rho0, c0, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_gravity((double[]){0, -g, 0}));
  sph_group_set_hydrostatic(water, 1, H, g);
  if (!block) sph_group_set_hydrostatic(middle, 1, H, g);
  return sim;
}

static sph_force force_on(sph_sim *sim, const char *wall)
{
  sph_force f;
  if (sph_sim_force(sim, sph_sim_group(sim, wall), NULL, &f) != SPH_OK)
    fail_msg("%s", sph_sim_error(sim));
  return f;
}

/* At the start, of the exact column, where nothing has settled yet.  0.2 % is what sums over a
 * lattice are off at any dx; the thrust on the side falls with dx, it is missing half a layer at
 * the surface. */
static void weight(void **state)
{
  (void)state;
  double last = 0.04;
  for (int fine = 1; fine <= 2; fine++) {
    sph_sim *sim = at_rest(0.05 / fine, 1), *full = at_rest(0.05 / fine, 0);
    sph_balance b;
    if (sph_sim_evaluate(full) != SPH_OK) fail_msg("%s", sph_sim_error(full));
    sph_sim_balance(full, &b);
    sph_force floor = force_on(full, "floor"), left = force_on(full, "left");
    sph_force right = force_on(full, "right"), block = force_on(sim, "block");
    const double error[3] = {fabs(floor.force[1] / (-g * b.mass) - 1),
                             fabs(right.force[0] / (rho0 * g / 2) - 1),
                             fabs(block.force[1] / (rho0 * g * 0.25) - 1)};
    print_message("# dx = H/%d: weight %.2f %%, side %.2f %%, buoyancy %.2f %%\n", 20 * fine,
                  100 * error[0], 100 * error[1], 100 * error[2]);
    assert_true(error[0] < 0.005 && error[2] < 0.005 && error[1] < 0.75 * last);
    last = error[1];
    assert_near(left.force[0], -right.force[0], 1e-9 * rho0 * g);
    assert_near(block.force[0], 0, 1e-9 * rho0 * g);
    /* About the origin the buoyancy turns the block by its arm, the middle of the tank. */
    assert_near(block.torque[2], 1 * block.force[1], 1e-9 * rho0 * g);
    sph_sim_free(full);
    sph_sim_free(sim);
  }
}

/* ---- powers ---- */

static sph_balance balance_at(sph_sim *sim, double t, N_Vector y)
{
  sph_balance b;
  assert_int_equal(sph_sim_set_vector(sim, t, y), SPH_OK);
  sph_sim_balance(sim, &b);
  return b;
}

/* The sums over all terms beside (E(y + s f) - E(y - s f))/2s. */
static void check_powers(sph_sim *sim, const char *name)
{
  sph_error error = {0};
  if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s: %s", name, sph_sim_error(sim));
  double kinetic = 0, internal = 0, size = 0;
  const double s = 1e-7;
  for (int k = 0; sph_sim_power_term(sim, k); k++) {
    sph_power power;
    if (sph_sim_power(sim, k, &power) != SPH_OK) fail_msg("%s: %s", name, sph_sim_error(sim));
    assert_string_equal(power.term, sph_sim_power_term(sim, k));
    kinetic += power.kinetic, internal += power.internal;
    size += fabs(power.kinetic) + fabs(power.internal);
  }
  N_Vector y = sph_nvector_clone(sph_sim_vector(sim), "y", &error), f = N_VClone(y);
  N_Vector z = N_VClone(y);
  N_VScale(1, sph_sim_vector(sim), y);
  assert_int_equal(sph_sim_rhs(0, y, f, sim), SPH_OK);
  N_VLinearSum(1, y, s, f, z);
  sph_balance up = balance_at(sim, 0, z);
  N_VLinearSum(1, y, -s, f, z);
  sph_balance down = balance_at(sim, 0, z);
  print_message("# %s: dK/dt %.6g, dU/dt %.6g\n", name, kinetic, internal);
  assert_true(size > 0 && internal != 0 && kinetic != 0);
  assert_near((up.kinetic - down.kinetic) / (2 * s), kinetic, 1e-6 * size);
  assert_near((up.internal - down.internal) / (2 * s), internal, 1e-6 * size);
  N_VDestroy(y), N_VDestroy(f), N_VDestroy(z);
  sph_sim_free(sim);
}

static int body(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) s->a[0][i] += 3 * s->x[1][i];
  return SPH_OK;
}

static int heat(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; s->du && i < s->n; i++) s->du[i] += 2 + s->x[0][i];
  return SPH_OK;
}

static sph_sim *gas(const char *energy, int summed)
{
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1.2, 1.2}});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0, 0}, (double[]){1.2, 1.2}, 1);
  sph_group_jitter(gas, 0.2, 5);
  sph_eos eos = sph_eos_stiffened_gas(1, 1.4, 0.3, 0);
  if (!strcmp(energy, "entropy")) eos = sph_eos_ideal_gas(1.4);
  eos.c_v = 0.7;
  sph_group_set_eos(gas, eos);
  sph_group_set_energy(gas, energy);
  sph_group_set_conductivity(gas, 0.05);
  double *u = sph_group_write(gas, "energy", 0);
  unsigned long state = 11;
  for (long i = 0; i < sph_group_count(gas); i++) u[i] = 3 + noise(&state);
  stir(gas, 2);
  if (summed)
    sph_sim_add_term(sim, sph_term_summation(0));
  else
    sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, summed ? sph_term_pressure_form("s") : sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  sph_sim_add_term(sim, sph_term_conductivity_artificial(0.5));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_add_term(sim, (sph_term){.name = "heat-source", .body = heat, .reads = ""});
  sph_sim_add_term(sim, (sph_term){.name = "shear", .body = body});
  return sim;
}

/* Water in a periodic box with what moves particles aside. */
static sph_sim *shifted(sph_term shift)
{
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1.2, 1.2}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1.2, 1.2}, rho0);
  sph_group_jitter(water, 0.2, 5);
  sph_group_set_eos(water, sph_eos_tait(rho0, 20, 7));
  stir(water, 2);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_stress_artificial(0.2, 0.01));
  sph_sim_add_term(sim, shift);
  return sim;
}

static void powers(void **state)
{
  (void)state;
  static const kind kinds[] = {{2, 0, 1, 1}, {2, 1, 0, 0}, {3, 0, 0, 0}};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
    check_powers(stirred(&kinds[k]), "water");
  static const char *const energies[] = {"u", "total", "entropy", "temperature"};
  for (int k = 0; k < 4; k++) check_powers(gas(energies[k], 0), energies[k]);
  check_powers(gas("u", 1), "u, density summed");
  sph_term shift = sph_term_shifting("fick", 1);
  shift.surface = 0;
  check_powers(shifted(shift), "stress, shifting");
  shift.steps = 3; /* no part of f */
  check_powers(shifted(shift), "stress");
  check_powers(shifted(sph_term_transport_velocity(0, 0)), "stress, transport velocity");
}

/* ---- what is refused ---- */

static void refused(void **state)
{
  (void)state;
  static const kind two = {2, 0, 0, 0};
  sph_force f;
  sph_power p;
  sph_sim *sim = stirred(&two);
  assert_int_equal(sph_sim_force(sim, sph_sim_group(sim, "water"), NULL, &f), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "right is a wall"));
  sph_sim_free(sim);
  sim = stirred(&two);
  assert_int_equal(sph_sim_force(sim, sph_sim_group(sim, "lid"), (double[]){0, NAN}, &f),
                   SPH_ERR_ARGUMENT);
  sph_sim_free(sim);
  sim = stirred(&two);
  assert_int_equal(sph_sim_power(sim, 99, &p), SPH_ERR_ARGUMENT);
  assert_null(sph_sim_power_term(sim, 99));
  sph_sim_free(sim);
  sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.1});
  sph_group_set_eos(sph_group_box(sim, "w", (double[]){0}, (double[]){1}, 1),
                    sph_eos_tait(1, 9, 7));
  sph_sim_add_term(sim, sph_term_summation(0));
  sph_sim_add_term(sim, sph_term_pressure_form("s"));
  assert_int_equal(sph_sim_power(sim, 0, &p), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "right is term continuity"));
  sph_sim_free(sim);
  assert_int_equal(sph_sim_force(NULL, NULL, NULL, &f), SPH_ERR_MEMORY);
  assert_int_equal(sph_sim_power(NULL, 0, &p), SPH_ERR_MEMORY);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(momentum), cmocka_unit_test(weight),
                                     cmocka_unit_test(powers), cmocka_unit_test(refused)};
  return cmocka_run_group_tests_name("measure", tests, NULL, NULL);
}
