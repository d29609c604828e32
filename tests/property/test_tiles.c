/* Terms registered at run time: built-in terms written again as users would, tile by tile, give the
 * rates of the fused loops; a scalar of a term obeys its equation; same bits for any threads. */
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
#include "scene.h"

static const double delta = 0.15, alpha = 0.3, beta = 0.7;

/* ---- built-in terms again, as a user writes them ---- */

/* c2: drho_i = rho_i sum V_j v.grad W;  a_i = - sum m_j (p_i + p_j)/(rho_i rho_j) grad W; heating
 * by compression of an ideal gas. */
static void water(const sph_term *term, const sph_tile *t)
{
  const double *rho_i = t->i[0], *rho_j = t->j[0], *p_i = t->i[1], *p_j = t->j[1];
  (void)term;
  for (long k = 0; k < t->n; k++) {
    t->drho[k] += rho_i[k] * t->V[k] * t->rv[k] * t->F[k];
    t->push[k] -= t->m[k] * (p_i[k] + p_j[k]) / (rho_i[k] * rho_j[k]) * t->F[k];
    t->du[k] += p_i[k] / rho_i[k] * t->V[k] * t->rv[k] * t->F[k];
  }
}

/* Monaghan (1992); walls only where they are no-slip, which this scene's are. */
static void artificial(const sph_term *term, const sph_tile *t)
{
  const double *rho_i = t->i[0], *rho_j = t->j[0], *c_i = t->i[1], *c_j = t->j[1];
  (void)term;
  for (long k = 0; k < t->n; k++) {
    double mu = t->h * fmin(t->rv_viscous[k], 0) / (t->r2[k] + 0.01 * t->h * t->h);
    double c = (c_i[k] + c_j[k]) / 2, rho = (rho_i[k] + rho_j[k]) / 2;
    t->along_r[k] -= t->m[k] * (-alpha * c * mu + beta * mu * mu) / rho * t->F[k];
  }
}

/* Morris, Fox & Zhu (1997); ctx: eta. */
static void morris(const sph_term *term, const sph_tile *t)
{
  const double eta = *(const double *)term->ctx;
  for (long k = 0; k < t->n; k++)
    t->along_v[k] += t->m[k] * 2 * eta / (t->i[0][k] * t->j[0][k]) * t->F[k];
}

/* Molteni & Colagrossi (2009); ctx: c0. */
static void molteni(const sph_term *term, const sph_tile *t)
{
  const double factor = 2 * delta * t->h * *(const double *)term->ctx;
  for (long k = 0; k < t->n; k++)
    t->drho[k] += factor * t->V[k] * (t->i[0][k] - t->j[0][k]) * t->F[k];
}

/* Cleary & Monaghan (1999); walls: adiabatic below, with a temperature above; ctx: kappa. */
static void conduction(const sph_term *term, const sph_tile *t)
{
  const double kappa = *(const double *)term->ctx;
  const double *rho_i = t->i[0], *T_i = t->i[1], *T_j = t->j[1];
  for (long k = 0; k < t->n; k++)
    t->du[k] += t->V[k] / rho_i[k] * 2 * kappa * (T_i[k] - T_j[k]) * t->F[k];
}

/* ---- both ways ---- */

static const double eta = 2, c0 = 10, kappa = 15;

typedef struct both {
  const char *name, *reads, *named, *adds; /* named: with what is read of the pair */
  void (*pair)(const sph_term *term, const sph_tile *tile);
  const double *ctx;
  int thermal;
} both;

static const both all[] = {
    {"water", "density pressure", "density rv F pressure V m", "push drho du", water, NULL, -1},
    {"artificial", "density,sound_speed", "density sound_speed rv_viscous r2 m F", "along_r",
     artificial, NULL, -1},
    {"morris", "density", "density m F", "along_v", morris, &eta, -1},
    {"molteni", "density", "V F density", NULL, molteni, &c0, 0},
    {"conduction", "density temperature", "V,density,temperature,F", "du", conduction, &kappa, 1},
};
enum { TERMS = sizeof all / sizeof *all };

static void add_fused(sph_sim *sim, int k)
{
  const char *name = all[k].name;
  if (!strcmp(name, "water")) {
    sph_sim_add_term(sim, sph_term_continuity());
    sph_sim_add_term(sim, sph_term_pressure());
  }
  if (!strcmp(name, "artificial"))
    sph_sim_add_term(sim, sph_term_viscosity_artificial(alpha, beta));
  if (!strcmp(name, "morris")) sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  if (!strcmp(name, "molteni")) sph_sim_add_term(sim, sph_term_delta("molteni", delta));
  if (!strcmp(name, "conduction")) sph_sim_add_term(sim, sph_term_conduction());
}

/* Terms whose bit is set as tiles, which name what they read of pairs or not, the others fused. */
static scene_rates rates_of(scene *s, unsigned tiles, int named, scene_options options)
{
  s->o.group[3].conductivity = 0; /* the lid takes the fluid's: conduction here knows one kappa */
  s->o.group[2].repulsion = s->o.group[3].repulsion = 0; /* of the fused pressure alone */
  sph_sim *sim = scene_sim(s, options);
  for (int k = 0; k < TERMS; k++) {
    if (all[k].thermal >= 0 && all[k].thermal != s->thermal) continue;
    if (!(tiles >> k & 1)) {
      add_fused(sim, k);
      continue;
    }
    sph_sim_add_term(sim, (sph_term){.name = all[k].name,
                                     .pair = all[k].pair,
                                     .reads = named ? all[k].named : all[k].reads,
                                     .adds = all[k].adds,
                                     .ctx = (void *)(size_t)all[k].ctx});
  }
  assert_string_equal(sph_sim_error(sim), "");
  scene_rates r = scene_evaluate(s, sim);
  sph_sim_free(sim);
  return r;
}

static scene_rates rates(scene *s, unsigned tiles, scene_options options)
{
  return rates_of(s, tiles, 0, options);
}

static double largest(const double *a, long n)
{
  double most = 0;
  for (long i = 0; i < n; i++) most = fmax(most, fabs(a[i]));
  return most;
}

static void alike(const char *what, const double *a, const double *b, long n)
{
  double size = largest(a, n);
  for (long i = 0; i < n; i++)
    if (!(fabs(a[i] - b[i]) <= 1e-13 * size)) /* NaN fails */
      fail_msg("%s of particle %ld: fused %.17g, tile %.17g", what, i, a[i], b[i]);
}

static void compare(const scene_rates *fused, const scene_rates *tile, int dim)
{
  for (int d = 0; d < dim; d++) alike("a", fused->a[d], tile->a[d], fused->n);
  alike("drho", fused->drho, tile->drho, fused->n);
  alike("du", fused->du, tile->du, fused->n);
}

static scene_def scene_number(int k, int thermal)
{
  scene_def def = {.dim = 1 + k % 3,
                   .kernel = k % ORACLE_KERNELS == ORACLE_SPIKY ? 0 : k % ORACLE_KERNELS,
                   .thermal = thermal,
                   .laminar = 1,
                   .fluids = 1,
                   .no_slip = 1,
                   .walls = k % 3,
                   .random = k / 3 % 2,
                   .seed = (unsigned long)(40 + k)};
  def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : 9;
  def.periodic[0] = def.dim > 1 && k % 5 == 1;
  return def;
}

static void equal_to_fused(void **state)
{
  static const char *const isa[] = {NULL, "reference", SPH_ISA_TWO_LANES};
  (void)state;
  for (int k = 0; k < 24; k++) {
    scene_def def = scene_number(k, k % 4 == 3);
    scene s;
    scene_make(&s, &def);
    scene_options options = {.isa = isa[k % 3]};
    scene_rates fused = rates(&s, 0, options);
    assert_true(largest(fused.a[0], fused.n) > 0);
    for (int q = 0; q < 3; q++) { /* all by tile, some, one */
      scene_rates tile = rates(&s,
                               q == 0   ? ~0u
                               : q == 1 ? 5 + (unsigned)k % 16
                                        : 1u << k % TERMS,
                               options);
      compare(&fused, &tile, def.dim);
      scene_rates_free(&tile);
    }
    scene_rates_free(&fused);
    scene_free(&s);
  }
}

/* Every instruction set of this processor, and so every width of a tile. */
static void every_width(void **state)
{
  (void)state;
  scene_def def = scene_number(1, 0);
  scene s;
  scene_make(&s, &def);
  scene_rates fused = rates(&s, 0, (scene_options){0});
  for (int isa = 0; isa < SPH_ISA_COUNT; isa++) {
    if (sph_cpu_isa(sph_cpu_isa_name(isa), NULL) != isa) continue;
    scene_rates tile = rates(&s, ~0u, (scene_options){.isa = sph_cpu_isa_name(isa)});
    compare(&fused, &tile, def.dim);
    scene_rates_free(&tile);
  }
  scene_rates_free(&fused);
  scene_free(&s);
}

/* Built-in terms: 1 without viscosity, 2 Molteni's, 3 Antuono's, 0 none; with a term by tile. */
static scene_rates rates_beside(scene *s, int set, int tile, const char *isa)
{
  sph_sim *sim = scene_sim(s, (scene_options){.isa = isa});
  if (set) {
    sph_sim_add_term(sim, sph_term_continuity());
    sph_sim_add_term(sim, sph_term_pressure());
    sph_sim_add_term(sim, sph_term_delta(set == 3 ? "antuono" : "molteni", delta));
  }
  if (set > 1) sph_sim_add_term(sim, sph_term_viscosity_artificial(alpha, 0));
  if (tile)
    sph_sim_add_term(sim, (sph_term){.name = "own",
                                     .pair = morris,
                                     .reads = "density m F",
                                     .adds = "along_v",
                                     .ctx = (void *)(size_t)&eta});
  assert_string_equal(sph_sim_error(sim), "");
  scene_rates r = scene_evaluate(s, sim);
  sph_sim_free(sim);
  return r;
}

static void add(double *to, const double *a, long n)
{
  for (long i = 0; i < n; i++) to[i] += a[i];
}

/* Rates of a set in the loop with tiles are those of the set and of the tile, each alone: every set
 * that has a loop of its own, in every width. */
static void beside_built_in(void **state)
{
  (void)state;
  for (int k = 0; k < 9 * SPH_ISA_COUNT; k++) {
    const char *isa = sph_cpu_isa_name(k / 9);
    if (sph_cpu_isa(isa, NULL) != k / 9) continue;
    scene_def def = scene_number(k % 3, 0);
    def.kernel = 0; /* Wendland C2 */
    scene s;
    scene_make(&s, &def);
    scene_rates sum = rates_beside(&s, 1 + k % 9 / 3, 0, isa);
    scene_rates own = rates_beside(&s, 0, 1, isa);
    scene_rates together = rates_beside(&s, 1 + k % 9 / 3, 1, isa);
    assert_true(largest(own.a[0], own.n) > 0 && largest(sum.drho, sum.n) > 0);
    for (int d = 0; d < def.dim; d++) add(sum.a[d], own.a[d], sum.n);
    add(sum.drho, own.drho, sum.n);
    compare(&sum, &together, def.dim);
    scene_rates_free(&sum);
    scene_rates_free(&own);
    scene_rates_free(&together);
    scene_free(&s);
  }
}

/* What is not named is not filled in, and changes nothing. */
static void named_pairs(void **state)
{
  (void)state;
  for (int k = 0; k < 6; k++) {
    scene_def def = scene_number(k, k % 2);
    scene s;
    scene_make(&s, &def);
    for (unsigned tiles = 1; tiles <= 31; tiles = tiles < 16 ? 2 * tiles : tiles + 15) {
      scene_rates plain = rates(&s, tiles, (scene_options){0});
      scene_rates named = rates_of(&s, tiles, 1, (scene_options){0});
      assert_true(scene_rates_same(&plain, &named));
      scene_rates_free(&plain);
      scene_rates_free(&named);
    }
    scene_free(&s);
  }
}

static void sees_little(const sph_term *term, const sph_tile *t)
{
  int *seen = term->ctx;
  *seen = t->V && t->i[0] && !t->F && !t->r2 && !t->v[0] && !t->rv && !t->rv_viscous && !t->m;
}

static void the_rest_is_null(void **state)
{
  (void)state;
  int seen = 0;
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1, 1}});
  sph_group *group = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(group, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, (sph_term){.name = "look",
                                   .pair = sees_little,
                                   .reads = "density V",
                                   .adds = "drho",
                                   .ctx = &seen});
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  assert_true(seen);
  sph_sim_free(sim);
}

static void any_threads(void **state)
{
  (void)state;
  scene_def def = scene_number(1, 0);
  def.n = 80;
  scene s;
  scene_make(&s, &def);
  scene_rates one = rates(&s, ~0u, (scene_options){.threads = 1});
  scene_rates three = rates(&s, ~0u, (scene_options){.threads = 3});
  assert_true(scene_rates_same(&one, &three));
  scene_rates_free(&one);
  scene_rates_free(&three);
  scene_free(&s);
}

static void spring(const sph_term *term, const sph_tile *t)
{
  (void)term;
  for (long k = 0; k < t->n; k++) t->push[k] -= 1e3 * t->V[k] / t->i[0][k] * t->F[k];
}

/* Dust among a fluid, which drag ties to it: pair terms act within the fluid alone. */
static void dust_is_left_alone(void **state)
{
  (void)state;
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1, 1}});
  for (int g = 0; g < 2; g++) {
    sph_group *group =
        sph_group_box(sim, g ? "dust" : "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
    sph_group_jitter(group, 0.3, (unsigned long)(g + 1));
    sph_group_set_eos(group, g ? sph_eos_dust() : sph_eos_tait(1000, 10, 7));
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_drag(1));
  sph_sim_add_term(
      sim, (sph_term){.name = "spring", .pair = spring, .reads = "density", .adds = "push"});
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  for (int g = 0; g < 2; g++) {
    const sph_group *group = sph_sim_group_get(sim, g);
    const double *a = sph_group_rate(group, "velocity", 0);
    double sum = 0, size = 0;
    for (long i = 0; i < sph_group_count(group); i++) sum += a[i], size += fabs(a[i]);
    assert_true(g ? size == 0 : size > 0);
    if (!(fabs(sum) <= 1e-13 * size)) fail_msg("%d: %g of %g", g, sum, size);
  }
  sph_sim_free(sim);
}

/* ---- scalars ---- */

/* ds/dt = 2 D sum V (s_i - s_j) F: diffusion (Brookshaw 1985); ctx: D. */
static void diffusion(const sph_term *term, const sph_tile *t)
{
  const double D = *(const double *)term->ctx;
  for (long k = 0; k < t->n; k++) t->ds[k] += 2 * D * t->V[k] * (t->s_i[k] - t->s_j[k]) * t->F[k];
}

static int source(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) s->ds[i] += 3 + s->s[i];
  return SPH_OK;
}

static const double diffusivity = 0.02;

static sph_term dye(double scale)
{
  return (sph_term){.name = "dye",
                    .pair = diffusion,
                    .scalar = {.name = "dye", .unit = "kg/m^3", .scale = scale, .initial = 2},
                    .ctx = (void *)(size_t)&diffusivity};
}

/* Rates of two scalars against their definitions over all pairs; walls mirror. */
static void scalar_rates(void **state)
{
  (void)state;
  scene_def def = scene_number(1, 0);
  def.periodic[0] = 0;
  scene s;
  scene_make(&s, &def);
  oracle_evaluate(&s.o);
  sph_sim *sim = scene_sim(&s, (scene_options){0});
  sph_sim_add_term(sim, dye(1));
  sph_sim_add_term(sim, (sph_term){.name = "growth",
                                   .body = source,
                                   .scalar = {.name = "age", .scale = 1}});
  sph_group *group = sph_sim_group(sim, "water");
  double *c = sph_group_write(group, "dye", 0), *age = sph_group_write(group, "age", 0);
  assert_non_null(c);
  assert_true(c[0] == 2 && age[0] == 0);
  long n = sph_group_count(group), first = 0;
  unsigned long random = 5;
  for (long i = 0; i < n; i++) c[i] = scene_random(&random), age[i] = (double)i;
  double *kept = malloc((size_t)n * sizeof *kept);
  memcpy(kept, c, (size_t)n * sizeof *kept);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  const double *dc = sph_group_rate(group, "dye", 0), *dage = sph_group_rate(group, "age", 0);
  while (s.o.particle[first].group != 0) first++;
  for (long i = 0; i < n; i++) {
    real sum = 0, size = 0;
    for (long j = 0; j < n; j++) {
      const oracle_particle *a = &s.o.particle[first + i], *b = &s.o.particle[first + j];
      real x = a->x[0] - b->x[0], y = a->x[1] - b->x[1], r = sqrtl(x * x + y * y);
      if (i == j || r > 3 * s.o.h) continue;
      sum += 2 * diffusivity * b->m / b->rho * (kept[i] - kept[j]) * oracle_f(&s.o, r);
      size += 2 * diffusivity * b->m / b->rho * fabsl(oracle_f(&s.o, r));
    }
    assert_true(fabsl(dc[i] - sum) <= 1e-14 * size);
    assert_true(dage[i] == 3 + (double)i);
  }
  free(kept);
  sph_sim_free(sim);
  scene_free(&s);
}

/* A cosine of dye in a periodic box at rest decays at 2 D sum V F (1 - cos kx). */
static void scalar_decays(void **state)
{
  (void)state;
  for (int method = 0; method < 2; method++) {
    const double L = 1, dx = L / 32;
    sph_sim *sim = sph_sim_create(
        &(sph_sim_def){.dim = 1, .dx = dx, .periodic = {1}, .length = {L}, .speed = 1});
    sph_group *water = sph_group_box(sim, "water", (double[]){0}, (double[]){L}, 1000);
    sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
    sph_sim_add_term(sim, dye(1));
    sph_sim_set_integrator(sim,
                           &(sph_integrator_def){.method = method ? "leapfrog"
                                                                  : "erk:bogacki-shampine-4-2-3",
                                                 .tolerance = method ? 0 : 1e-6});
    const double *x = sph_group_read(water, "position", 0);
    double *c = sph_group_write(water, "dye", 0), rate = 0, h = sph_sim_h(sim),
           k = 2 * acos(-1) / L;
    for (long i = 0; i < 32; i++) c[i] = 1 + cos(k * x[i]);
    for (long j = -8; j <= 8; j++)
      rate -= 2 * diffusivity * dx * (1 - cos(k * (double)j * dx)) *
              sph_kernel_f(sph_kernel_find("wendland-c2"), 1, fabs((double)j) * dx, h);
    assert_int_equal(sph_sim_run(sim, 1), SPH_OK);
    x = sph_group_read(water, "position", 0);
    const double *now = sph_group_read(water, "dye", 0);
    for (long i = 0; i < 32; i++)
      assert_true(fabs(now[i] - 1 - exp(-rate) * cos(k * x[i])) < (method ? 1e-4 : 1e-5));
    sph_sim_free(sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_to_fused),     cmocka_unit_test(beside_built_in),
      cmocka_unit_test(every_width),        cmocka_unit_test(named_pairs),
      cmocka_unit_test(the_rest_is_null),   cmocka_unit_test(any_threads),
      cmocka_unit_test(dust_is_left_alone), cmocka_unit_test(scalar_rates),
      cmocka_unit_test(scalar_decays),
  };
  return cmocka_run_group_tests_name("tiles", tests, NULL, NULL);
}
