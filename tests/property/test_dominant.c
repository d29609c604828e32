/* The bound of the eigenvalues that stabilised schemes step by, beside the spectral radius of small
 * systems: never below, and not far above where pairs exchange something. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "scene.h"
#include "sim_data.h"
#include "sim_dominant.h"
#include "sim_rhs.h"
#include "sim_weights.h"
#include "sphode/sundials.h"

/* Terms of a scene. */
enum { MORRIS = 1, MCG = 2, ARTIFICIAL = 4, CONDUCTION = 8, MOLTENI = 16, DRAG = 32 };

static void choose(oracle *o, unsigned terms)
{
  o->continuity = o->pressure = ORACLE_C2;
  if (terms & MORRIS) o->laminar = ORACLE_MORRIS;
  if (terms & MCG) o->laminar = ORACLE_MCG;
  if (terms & ARTIFICIAL) o->alpha = 1, o->beta = 2;
  if (terms & CONDUCTION) o->conduction = 1;
  if (terms & MOLTENI) o->diffusion = ORACLE_MOLTENI, o->delta = 0.1L;
  if (terms & DRAG) o->drag = 1, o->drag_K = 300000;
}

/* Entries of positions are zero from now on: these are held. */
static void hold(const sph_sim *sim, N_Vector x)
{
  for (int k = 0; k < sim->layout.segments; k++) {
    const sph_segment *s = &sim->layout.segment[k];
    for (long i = 0; s->role == SPH_ROLE_POSITION && i < s->n; i++)
      sph_nvector_data(x)[s->offset + i] = 0;
  }
}

/* Largest |eigenvalue| of df/dy, positions held: how a vector grows that differences of f multiply
 * with it again and again, over the second half of 400 times (pairs of eigenvalues turn it, it does
 * not grow evenly).  Vectors are measured in scales of the state. */
static double radius(sph_sim *sim)
{
  enum { TIMES = 400 };
  N_Vector y = sph_sim_vector(sim), v[4];
  double grown = 0;
  if (!y) fail_msg("%s", sph_sim_error(sim));
  for (int k = 0; k < 4; k++) v[k] = N_VClone(y);
  N_Vector x = v[0], moved = v[1], f = v[2], weight = v[3];
  assert_int_equal(sph_sim_weights(y, weight, sim), SPH_OK);
  for (long i = 0; i < sim->layout.length; i++)
    sph_nvector_data(x)[i] = sin(1 + 0.7 * (double)i * (double)i);
  N_VDiv(x, weight, x);
  hold(sim, x);
  for (int k = 0; k < TIMES; k++) {
    const double step = 1e-5;
    N_VLinearSum(1, y, step, x, moved);
    assert_int_equal(sph_sim_rhs(0, moved, f, sim), SPH_OK);
    N_VLinearSum(1, y, -step, x, moved);
    assert_int_equal(sph_sim_rhs(0, moved, x, sim), SPH_OK);
    N_VLinearSum(0.5 / step, f, -0.5 / step, x, x);
    hold(sim, x);
    N_VProd(x, weight, f);
    double size = N_VMaxNorm(f);
    N_VScale(1 / size, x, x);
    if (k >= TIMES / 2) grown += log(size) / (TIMES / 2);
  }
  for (int k = 0; k < 4; k++) N_VDestroy(v[k]);
  return exp(grown);
}

static double bound(sph_sim *sim)
{
  double lambda = NAN;
  N_Vector y = sph_sim_vector(sim);
  if (!y) fail_msg("%s", sph_sim_error(sim));
  assert_int_equal(sph_sim_dominant(0, y, &lambda, sim), SPH_OK);
  return lambda;
}

static void check(const char *what, unsigned terms, int k, double most)
{
  scene_def def = {.dim = 1 + k % 3,
                   .kernel = k % ORACLE_KERNELS,
                   .fluids = 1 + k / 2 % 2,
                   .dusts = terms & DRAG ? 1 : 0,
                   .thermal = 0,
                   .laminar = 1,
                   .walls = k / 3 % 3,
                   .no_slip = 1,
                   .seed = (unsigned long)(900 + k)};
  def.n = def.dim == 1 ? 40 : def.dim == 2 ? 10 : 8;
  if (def.dim == 3 && (terms & DRAG)) def.dim = 2, def.n = 10;
  for (int d = 0; d < def.dim; d++) def.periodic[d] = !def.walls || d < def.dim - 1;
  scene s;
  scene_make(&s, &def);
  choose(&s.o, terms);
  if (terms & CONDUCTION) s.o.energy = k % 2 ? ORACLE_U : ORACLE_TEMPERATURE;
  sph_sim *sim = scene_sim(&s, (scene_options){.threads = 1 + k % 2});
  for (int g = 0; g < sim->groups; g++) { /* stiff, and not the same everywhere */
    sph_group *group = sim->group[g];
    double factor = 1 + (double)g;
    if (group->wall) continue;
    if (terms & (MORRIS | MCG)) sph_group_set_viscosity(group, 3e4 * factor);
    if (terms & CONDUCTION) sph_group_set_conductivity(group, 3e7 * factor);
  }
  double true_radius = radius(sim), lambda = bound(sim);
  print_message("# %s, %dD, %s, %d walls: bound/radius = %.2f\n", what, def.dim,
                sph_kernel_name(sim->kernel), def.walls, lambda / true_radius);
  if (!(lambda >= true_radius && lambda <= most * true_radius))
    fail_msg("%s, scene %d: bound %g, radius %g", what, k, lambda, true_radius);
  sph_sim_free(sim);
  scene_free(&s);
}

/* Nine scenes: one to three dimensions, one and two fluids, no, one and two walls, all kernels;
 * SPHODE_TEST_QUICK=1, for sanitizers: three of them. */
static void scenes(const char *what, unsigned terms, double most)
{
  for (int k = 0; k < 9; k += getenv("SPHODE_TEST_QUICK") ? 4 : 1) check(what, terms, k, most);
}

static void waves(void **state) { (void)state, scenes("waves", 0, 4); }
static void morris(void **state) { (void)state, scenes("morris", MORRIS, 2); }
static void mcg(void **state) { (void)state, scenes("mcg", MCG, 2); }
static void conduction(void **state) { (void)state, scenes("conduction", CONDUCTION, 2); }
/* Where waves are as fast as what is damped, both bounds are added. */
static void others(void **state)
{
  (void)state;
  scenes("artificial", ARTIFICIAL, 5); /* half of all pairs approach, at most */
  scenes("diffusion", MOLTENI, 4);
  scenes("drag", DRAG, 3);
  scenes("all", MORRIS | ARTIFICIAL | CONDUCTION | MOLTENI, 3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(waves),      cmocka_unit_test(morris), cmocka_unit_test(mcg),
      cmocka_unit_test(conduction), cmocka_unit_test(others),
  };
  return cmocka_run_group_tests_name("dominant", tests, NULL, NULL);
}
