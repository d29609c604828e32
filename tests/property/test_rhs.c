/* The right-hand side against an independent brute force in long double, on random states; and what
 * it must not depend on to the last bit: threads, skin, the way neighbours are found. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "cpu.h"
#include "quick.h"
#include "scene.h"

/* Rounding: worst seen is told at the end of each test. */
static const double in_double = 1e-14, in_mixed = 2e-6;
static double tolerance = in_double, worst;

static void same(const char *what, const scene_def *def, long i, double found, real expected,
                 real size)
{
  double error = size > 0 ? (double)(fabsl(found - expected) / size) : fabs(found);
  if (error > worst) worst = error;
  if (error <= tolerance) return; /* NaN fails */
  fail_msg("%s of particle %ld (seed %lu, %dD): %.17g, oracle %.17Lg, error %g of size %Lg", what,
           i, def->seed, def->dim, found, expected, error, size);
}

static void compare(const scene *s, const scene_def *def, const scene_rates *r)
{
  for (long i = 0; i < s->o.n; i++) {
    const oracle_particle *it = &s->o.particle[i];
    int wall = s->o.group[it->group].wall;
    same(wall ? "wall p" : "p", def, i, r->p[i], it->p, it->p_size);
    same(wall ? "wall rho" : "rho", def, i, r->rho[i], it->rho, it->rho * it->condition);
    if (wall) continue;
    same("c", def, i, r->c[i], it->c, it->c);
    for (int k = 0; k < def->dim; k++) same("a", def, i, r->a[k][i], it->a[k], it->a_size);
    same("drho", def, i, r->drho[i], it->drho, it->drho_size);
    if (s->thermal) same("du", def, i, r->du[i], it->du, it->du_size);
  }
}

/* Terms number `mix`, rows matched. */
static void choose_terms(scene *s, int mix)
{
  oracle *o = &s->o;
  o->continuity = o->pressure = mix % 2 ? ORACLE_C1 : ORACLE_C2;
  if (mix % 3) o->alpha = mix % 3 == 1 ? 0.1 : 1, o->beta = mix % 3 == 1 ? 0 : 2;
  if (s->thermal && mix % 2) o->conductivity = 0.7;
  if (!s->thermal) o->diffusion = (enum oracle_delta)(mix % 3), o->delta = 0.15;
  if (mix % 5 == 4) o->diffusion = ORACLE_OFF;
  for (int k = 0; k < o->dim && mix % 4; k++) o->g[k] = k ? -9.81 * k : 2.5;
  if (mix % 4 == 1 && !o->periodic[0] && !o->periodic[1] && !o->periodic[2]) o->omega = 3;
}

/* Scene number k of a kind; every combination of choices turns up over the numbers. */
static scene_def choose_scene(int dim, int k, int walls, int thermal)
{
  scene_def def = {.dim = dim,
                   .kernel = (k + k / ORACLE_KERNELS) % ORACLE_KERNELS,
                   .walls = walls,
                   .thermal = thermal};
  def.n = dim == 1 ? 40 : dim == 2 ? 14 : walls ? 9 : 8;
  def.seed = (unsigned long)(1000 * dim + 100 * walls + 50 * thermal + k);
  unsigned long state = def.seed;
  for (int d = 0; d < dim; d++) def.periodic[d] = k > 1 && scene_random(&state) < 0.5;
  if (walls) def.periodic[dim - 1] = 0;
  def.random = scene_random(&state) < 0.5;
  def.fluids = 1 + (scene_random(&state) < 0.5);
  def.outside = scene_random(&state) < 0.5;
  def.no_slip = k / 2 % 2;
  def.tension = k / 4 % 2;
  return def;
}

static void check(const scene_def *def, int mix)
{
  static const char *const isa[] = {NULL, "reference", SPH_ISA_TWO_LANES, NULL, NULL, NULL};
  static const char *const method[] = {NULL, NULL, NULL, "brute-force", "hash", "tree"};
  scene s;
  scene_make(&s, def);
  choose_terms(&s, mix);
  oracle_evaluate(&s.o);
  for (int k = 0; k < 6; k++) {
    if (k == 4 + mix % 2) continue; /* hash and tree by turns */
    sph_sim *sim = scene_sim(&s, (scene_options){.isa = isa[k], .neighbors = method[k]});
    assert_true(sph_sim_h(sim) == (double)s.o.h);
    scene_rates rates = scene_evaluate(&s, sim);
    compare(&s, def, &rates);
    scene_rates_free(&rates);
    sph_sim_free(sim);
  }
  scene_free(&s);
}

static void all_scenes(int walls, int thermal)
{
  worst = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int k = 0; k < 2 * ORACLE_KERNELS; k += quick_stride()) {
      scene_def def = choose_scene(dim, k, walls, thermal);
      check(&def, k);
    }
  print_message("# largest error: %.2g of size\n", worst);
}

static void liquids(void **state) { (void)state, all_scenes(0, 0); }
static void gases(void **state) { (void)state, all_scenes(0, 1); }
static void liquids_over_a_wall(void **state) { (void)state, all_scenes(1, 0); }
static void liquids_between_walls(void **state) { (void)state, all_scenes(2, 0); }

static void gases_between_walls(void **state) { (void)state, all_scenes(2, 1); }

/* Every instruction set that this processor runs. */
static void instruction_sets(int dim, int kernel)
{
  scene_def def = {.dim = dim, .kernel = kernel, .n = dim == 3 ? 9 : 14, .walls = 2, .fluids = 2};
  def.no_slip = 1, def.seed = 5, def.periodic[0] = dim > 1;
  scene s;
  scene_make(&s, &def);
  choose_terms(&s, 2);
  oracle_evaluate(&s.o);
  int tried = 0;
  for (int isa = 0; isa < SPH_ISA_COUNT; isa++) {
    if (sph_cpu_isa(sph_cpu_isa_name(isa), NULL) != isa) continue;
    sph_sim *sim = scene_sim(&s, (scene_options){.isa = sph_cpu_isa_name(isa)});
    scene_rates rates = scene_evaluate(&s, sim);
    compare(&s, &def, &rates);
    scene_rates_free(&rates);
    sph_sim_free(sim);
    tried++;
  }
  assert_in_range(tried, 2, SPH_ISA_COUNT);
  scene_free(&s);
}

static void all_instruction_sets(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++)
    for (int k = 0; k < ORACLE_KERNELS; k += quick_stride()) instruction_sets(dim, k);
}

/* Mixed precision, by each instruction set that has it: 24 bits a pair, positions in quanta of
 * 2^-30 of the box. */
static void check_mixed(const scene_def *def, int mix, int *tried)
{
  scene s;
  scene_make(&s, def);
  choose_terms(&s, mix);
  oracle_evaluate(&s.o);
  for (int isa = SPH_ISA_x86_64_v3; isa < SPH_ISA_COUNT; isa++) {
    if (sph_cpu_isa(sph_cpu_isa_name(isa), NULL) != isa) continue;
    sph_sim *sim =
        scene_sim(&s, (scene_options){.isa = sph_cpu_isa_name(isa), .precision = "mixed"});
    scene_rates rates = scene_evaluate(&s, sim);
    compare(&s, def, &rates);
    scene_rates_free(&rates);
    sph_sim_free(sim);
    ++*tried;
  }
  scene_free(&s);
}

static void mixed_precision(void **state)
{
  (void)state;
  int tried = 0;
  worst = 0, tolerance = in_mixed;
  for (int thermal = 0; thermal <= 1; thermal++)
    for (int walls = 0; walls <= 2; walls += 2)
      for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < 2 * ORACLE_KERNELS; k += quick_stride()) {
          scene_def def = choose_scene(dim, k, walls, thermal);
          check_mixed(&def, k, &tried);
        }
  print_message("# %d scenes, largest error: %.2g of size\n", tried, worst);
  tolerance = in_double;
}

/* What the library shows after a step, for the oracle. */
static void read_back(scene *s, const char *name, int g, sph_sim *sim)
{
  sph_group *group = sph_sim_group(sim, name);
  const double *rho = sph_group_read(group, "density", 0), *x[3], *v[3];
  for (int k = 0; k < s->o.dim; k++) {
    x[k] = sph_group_read(group, "position", k);
    v[k] = sph_group_read(group, "velocity", k);
  }
  for (long i = 0, n = 0; i < s->o.n; i++) {
    oracle_particle *it = &s->o.particle[i];
    if (it->group != g) continue;
    for (int k = 0; k < s->o.dim; k++) it->x[k] = x[k][n], it->v[k] = v[k][n];
    it->rho = rho[n++];
  }
}

/* Steps move particles under lists that are older: every pair is still found, and forces are those
 * of the new places. */
static void old_lists(void **state)
{
  (void)state;
  scene_def def = {.dim = 2, .n = 14, .walls = 2, .fluids = 1, .seed = 77, .periodic = {1}};
  scene s;
  scene_make(&s, &def);
  choose_terms(&s, 2);
  sph_sim *sim = scene_sim(&s, (scene_options){.skin = 0.3});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog", .dt_fixed = 1e-3});
  for (int step = 0; step < 30; step++) {
    assert_int_equal(sph_sim_step(sim), SPH_OK);
    read_back(&s, "water", 0, sim);
    oracle_evaluate(&s.o);
    scene_rates rates = scene_evaluate(&s, sim);
    compare(&s, &def, &rates);
    scene_rates_free(&rates);
  }
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  assert_in_range(stats.list_builds, 2, stats.step.rhs_evaluations / 3);
  print_message("# %ld lists for %ld evaluations\n", stats.list_builds, stats.step.rhs_evaluations);
  sph_sim_free(sim);
  scene_free(&s);
}

/* ---- the same bits ---- */

static void large_scene(scene *s, int dim)
{
  scene_def def = {
      .dim = dim, .n = dim == 2 ? 90 : 20, .walls = 2, .fluids = 2, .no_slip = 1, .seed = 9};
  def.periodic[0] = 1;
  scene_make(s, &def);
  choose_terms(s, 2);
}

static scene_rates rates_of(scene *s, scene_options options)
{
  sph_sim *sim = scene_sim(s, options);
  scene_rates rates = scene_evaluate(s, sim);
  sph_sim_free(sim);
  return rates;
}

static void same_bits(scene *s, const scene_options *options, int n, const char *what)
{
  scene_rates first = rates_of(s, options[0]);
  for (int k = 1; k < n; k++) {
    scene_rates other = rates_of(s, options[k]);
    if (!scene_rates_same(&first, &other)) fail_msg("%s: option %d has other bits", what, k);
    scene_rates_free(&other);
  }
  scene_rates_free(&first);
}

static void any_threads(void **state)
{
  (void)state;
  static const char *const search[] = {NULL, "hash", "tree"};
  for (int dim = 2; dim <= 3; dim++) {
    scene s;
    large_scene(&s, dim);
    for (int k = 0; k < 3; k++) {
      const scene_options options[] = {{.threads = 1, .neighbors = search[k]},
                                       {.threads = 2, .neighbors = search[k]},
                                       {.threads = 3, .neighbors = search[k]}};
      same_bits(&s, options, 3, "threads");
    }
    scene_free(&s);
  }
}

static void any_threads_mixed(void **state)
{
  (void)state;
  const int isa = sph_cpu_isa(NULL, NULL);
  for (int dim = 2; dim <= 3 && sph_cpu_isa_mixed(isa, NULL) >= 0; dim++) {
    scene s;
    large_scene(&s, dim);
    const scene_options options[] = {{.threads = 1, .precision = "mixed"},
                                     {.threads = 2, .precision = "mixed"},
                                     {.threads = 3, .precision = "mixed"}};
    same_bits(&s, options, 3, "threads, mixed");
    scene_free(&s);
  }
}

static void any_skin(void **state)
{
  (void)state;
  static const scene_options options[] = {{.skin = 0}, {.skin = -1}, {.skin = 0.05}, {.skin = 0.4}};
  for (int dim = 2; dim <= 3; dim++) {
    scene s;
    large_scene(&s, dim);
    same_bits(&s, options, 4, "skin");
    scene_free(&s);
  }
}

static void any_search(void **state)
{
  (void)state;
  static const scene_options options[] = {{.neighbors = "grid"}, {.neighbors = "brute-force"}};
  scene s;
  large_scene(&s, 3);
  same_bits(&s, options, 2, "neighbors");
  scene_free(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(liquids),
      cmocka_unit_test(gases),
      cmocka_unit_test(liquids_over_a_wall),
      cmocka_unit_test(liquids_between_walls),
      cmocka_unit_test(gases_between_walls),
      cmocka_unit_test(all_instruction_sets),
      cmocka_unit_test(mixed_precision),
      cmocka_unit_test(old_lists),
      cmocka_unit_test(any_threads),
      cmocka_unit_test(any_threads_mixed),
      cmocka_unit_test(any_skin),
      cmocka_unit_test(any_search),
  };
  return cmocka_run_group_tests_name("right-hand side", tests, NULL, NULL);
}
