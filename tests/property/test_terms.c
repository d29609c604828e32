/* Every term beyond those of test_rhs.c against the independent brute force in long double, on
 * random states with and without walls: rows of density, viscosities, conduction, XSPH, diffusion,
 * summed densities, every energy. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>

#include "cpu.h"
#include "scene.h"

static const double tolerance = 1e-14;
static double worst;

static void same(const char *what, const scene_def *def, long i, double found, real expected,
                 real size)
{
  double error = size > 0 ? (double)(fabsl(found - expected) / size) : fabs(found);
  if (error > worst) worst = error;
  if (error <= tolerance) return; /* NaN fails */
  fail_msg("%s of particle %ld (seed %lu, %dD, kernel %d): %.17g, oracle %.17Lg, error %g of size "
           "%Lg",
           what, i, def->seed, def->dim, def->kernel, found, expected, error, size);
}

static void compare(const scene *s, const scene_def *def, const scene_rates *r)
{
  int energy = s->thermal || s->o.energy != ORACLE_DEFAULT;
  for (long i = 0; i < s->o.n; i++) {
    const oracle_particle *it = &s->o.particle[i];
    int wall = s->o.group[it->group].wall;
    same(wall ? "wall p" : "p", def, i, r->p[i], it->p, it->p_size);
    same(wall ? "wall rho" : "rho", def, i, r->rho[i], it->rho, it->rho * it->condition);
    if (wall) continue;
    for (int k = 0; k < def->dim; k++) {
      same("dx", def, i, r->dx[k][i], it->dx[k], it->dx_size);
      same("a", def, i, r->a[k][i], it->a[k], it->a_size);
    }
    if (!s->o.summed) same("drho", def, i, r->drho[i], it->drho, it->drho_size);
    if (energy && !s->o.group[it->group].dust) same("du", def, i, r->du[i], it->du, it->du_size);
  }
}

typedef void choose(oracle *o, int k);

/* A scene of every dimension and kernel, with and without walls, liquid and gas as asked. */
static void check(int k, int thermal, int fluids, int dusts, choose *terms)
{
  static const char *const isa[] = {NULL, "reference", SPH_ISA_TWO_LANES};
  scene_def def = {.dim = 1 + k % 3,
                   .kernel = k % ORACLE_KERNELS,
                   .fluids = fluids,
                   .dusts = dusts,
                   .thermal = thermal,
                   .laminar = 1,
                   .walls = k / 2 % 3,
                   .no_slip = k % 4 != 3,
                   .random = k / 3 % 2};
  def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : dusts ? 8 : 9;
  def.seed = (unsigned long)(9000 + 10 * k + thermal);
  def.periodic[0] = def.dim > 1 && k % 5 == 1;
  scene s;
  scene_make(&s, &def);
  s.o.continuity = s.o.pressure = ORACLE_C2;
  terms(&s.o, k);
  oracle_evaluate(&s.o);
  for (int q = 0; q < 3; q++) {
    sph_sim *sim = scene_sim(&s, (scene_options){.isa = isa[q]});
    scene_rates rates = scene_evaluate(&s, sim);
    compare(&s, &def, &rates);
    scene_rates_free(&rates);
    sph_sim_free(sim);
  }
  scene_free(&s);
}

static void run(int first, int thermal, choose *terms)
{
  worst = 0;
  for (int k = first; k < first + 12; k++) check(k, thermal, 1 + k % 2, 0, terms);
  print_message("# largest error: %.2g of size\n", worst);
}

static void any_phi(oracle *o, int k)
{
  o->continuity = o->pressure = ORACLE_PHI;
  o->exponent = 0.25L * (k % 7) - 0.5L;
  int gas = o->group[0].eos.kind == ORACLE_IDEAL_GAS;
  if (k % 3 == 0) o->alpha = 0.5, o->beta = 1, o->conductivity = gas && k % 2;
}
static void phi_of_liquids(void **state) { (void)state, run(0, 0, any_phi); }
static void phi_of_gases(void **state) { (void)state, run(4, 1, any_phi); }

static void any_signal(oracle *o, int k) { o->signal_alpha = 0.5L + k % 2, o->signal_beta = k % 3; }
static void signal_viscosity(void **state)
{
  (void)state;
  run(0, 0, any_signal);
  run(7, 1, any_signal);
}

static void any_laminar(oracle *o, int k)
{
  o->laminar = k % 2 ? ORACLE_MORRIS : ORACLE_MCG;
  o->laminar_corrected = (enum oracle_correction)(k / 2 % 3);
  if (k % 3 == 0) o->continuity = o->pressure = ORACLE_C1;
}
static void laminar_viscosity(void **state)
{
  (void)state;
  run(0, 0, any_laminar);
  run(5, 1, any_laminar);
}

static void any_conduction(oracle *o, int k)
{
  o->conduction = 1;
  if (k % 2) o->laminar = ORACLE_MORRIS;
}
static void conduction_in_gases(void **state) { (void)state, run(2, 1, any_conduction); }

/* u or T of a liquid, which its pressure does not see. */
static void carried(oracle *o, int k)
{
  o->energy = k % 2 ? ORACLE_U : ORACLE_TEMPERATURE;
  o->conduction = 1;
  o->alpha = 0.1L * (k % 3);
  if (k % 4 == 0) o->laminar = ORACLE_MCG;
}
static void heat_in_liquids(void **state) { (void)state, run(3, 0, carried); }

static void any_energy(oracle *o, int k)
{
  o->energy = (enum oracle_energy)(k % 5);
  o->alpha = 1, o->beta = 2;
  o->conduction = k % 3 == 0;
  if (k / 5 % 2) o->continuity = o->pressure = ORACLE_C1;
  for (int d = 0; d < o->dim; d++) o->g[d] = 3 - d;
}
static void energies_of_gases(void **state) { (void)state, run(0, 1, any_energy); }

static void any_sum(oracle *o, int k)
{
  o->summed = 1;
  o->continuity = o->pressure = ORACLE_C1;
  o->alpha = k % 2;
  o->energy =
      k % 3 == 2 && o->group[0].eos.kind == ORACLE_IDEAL_GAS ? ORACLE_ENTROPY : ORACLE_DEFAULT;
}
static void summed_liquids(void **state) { (void)state, run(1, 0, any_sum); }
static void summed_gases(void **state) { (void)state, run(2, 1, any_sum); }

static void any_drift(oracle *o, int k)
{
  o->epsilon = 0.1L + 0.1L * (k % 5);
  if (k % 2) o->diffusion = ORACLE_MOLTENI, o->delta = 0.1;
}
static void drift(void **state) { (void)state, run(0, 0, any_drift); }

static void any_fourtakas(oracle *o, int k)
{
  o->diffusion = ORACLE_FOURTAKAS, o->delta = 0.1L + 0.1L * (k % 2);
  for (int d = 0; d < o->dim; d++) o->g[d] = k % 3 ? 1 - 2 * d : 0; /* gamma g H/c0^2 up to 0.09 */
  if (k % 4 == 1) o->alpha = 0.1;
}
static void fourtakas(void **state) { (void)state, run(0, 0, any_fourtakas); }

/* One dust or two in liquids and gases, between walls, which do not hold them; density of any row,
 * every energy.  1/drag_rate has no rounding. */
static void any_drag(oracle *o, int k)
{
  o->drag = 1;
  o->drag_K = k % 2 ? 0 : 700;
  o->drag_rate = k % 2 ? 0.25L : 0;
  if (k / 2 % 3 == 1) any_sum(o, k - k % 2); /* without viscosity */
  if (k / 2 % 3 == 2) any_phi(o, k);
  if (k % 5 == 3) o->laminar = ORACLE_MORRIS;
  if (k % 4 == 1) o->epsilon = 0.3L;
  if (o->group[0].eos.kind == ORACLE_IDEAL_GAS)
    o->energy = (enum oracle_energy)(k % 5);
  else if (!o->summed)
    o->diffusion = ORACLE_ANTUONO, o->delta = 0.1;
}
static void drag_of_dust(void **state)
{
  (void)state;
  worst = 0;
  for (int k = 0; k < 18; k++) check(k, k / 9, 1 + k % 2, 1 + k / 3 % 2, any_drag);
  print_message("# largest error: %.2g of size\n", worst);
}

/* Corrected gradients: each form, rows, fluids of two kinds, dust beside them. */
static void any_correction(oracle *o, int k)
{
  static const enum oracle_row row[] = {ORACLE_C2, ORACLE_C1, ORACLE_PHI};
  o->continuity = o->pressure = row[k / 2 % 3];
  o->exponent = 0.5L;
  o->pressure_corrected = (enum oracle_correction)(1 + k % 2);
  o->continuity_corrected = k % 4 ? ORACLE_ONE_SIDED : ORACLE_PLAIN;
  if (o->pressure_corrected == ORACLE_MEAN) o->continuity_corrected = ORACLE_ONE_SIDED;
  o->laminar = k / 3 % 2 ? ORACLE_MORRIS : ORACLE_MCG;
  o->laminar_corrected = (enum oracle_correction)(k % 3);
  if (o->group[0].eos.kind != ORACLE_IDEAL_GAS && k % 3 == 1)
    o->diffusion = ORACLE_ANTUONO, o->delta = 0.1;
  if (k % 5 == 1) o->alpha = 0.3;
}
static void corrected_gradients(void **state)
{
  (void)state;
  run(0, 0, any_correction);
  run(2, 1, any_correction);
  for (int k = 0; k < 6; k++) check(k, 0, 1 + k % 2, 1, any_correction);
  print_message("# with dust: %.2g of size\n", worst);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(phi_of_liquids),      cmocka_unit_test(phi_of_gases),
      cmocka_unit_test(signal_viscosity),    cmocka_unit_test(laminar_viscosity),
      cmocka_unit_test(conduction_in_gases), cmocka_unit_test(heat_in_liquids),
      cmocka_unit_test(energies_of_gases),   cmocka_unit_test(summed_liquids),
      cmocka_unit_test(summed_gases),        cmocka_unit_test(drift),
      cmocka_unit_test(fourtakas),           cmocka_unit_test(drag_of_dust),
      cmocka_unit_test(corrected_gradients),
  };
  return cmocka_run_group_tests_name("terms", tests, NULL, NULL);
}
