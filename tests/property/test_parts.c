/* Parts of f: whatever terms belong to them, they add up to f; each depends on (t, y) alone and
 * evaluates only what its terms need; wrong parts are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "scene.h"
#include "sim_data.h"
#include "sim_tangent.h"
#include "sim_weights.h"

/* ---- sums of the parts ---- */

static const char *const terms[] = {"continuity",
                                    "pressure",
                                    "viscosity-artificial",
                                    "viscosity-signal",
                                    "viscosity-laminar",
                                    "conductivity-artificial",
                                    "conduction",
                                    "xsph",
                                    "delta",
                                    "drag",
                                    "gravity",
                                    "harmonic",
                                    "dye",
                                    "burn"};
enum { TERMS = sizeof terms / sizeof *terms };

static void diffusion(const sph_term *term, const sph_tile *t)
{
  (void)term;
  for (long k = 0; k < t->n; k++) {
    t->ds[k] += t->V[k] * (t->s_i[k] - t->s_j[k]) * t->F[k];
    t->along_v[k] += t->m[k] / (t->i[0][k] * t->j[0][k]) * t->F[k];
    t->push[k] -= t->V[k] * (t->i[1][k] + t->j[1][k]) * t->F[k] / 1e6;
  }
}

static int burn(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) {
    if (s->du) s->du[i] += 0.1 * s->u[i] + s->p[i] / s->rho[i];
    s->a[0][i] += s->c[i];
  }
  return SPH_OK;
}

static sph_term dye(void)
{
  return (sph_term){.name = "dye",
                    .pair = diffusion,
                    .reads = "density pressure",
                    .adds = "along_v ds push",
                    .scalar = {.name = "dye", .unit = "1", .scale = 1, .initial = 2}};
}

/* Scene k: every kernel, dimension, row, model, energy in turn. */
static void any_scene(scene *s, scene_def *def, int k)
{
  *def = (scene_def){.dim = 1 + k % 3,
                     .kernel = k % ORACLE_KERNELS,
                     .fluids = 1 + k / 2 % 2,
                     .thermal = k % 4 == 1,
                     .laminar = 1,
                     .walls = k / 3 % 3,
                     .no_slip = k % 5 != 4,
                     .dusts = k % 6 == 5,
                     .random = k / 6 % 2,
                     .seed = (unsigned long)(700 + k)};
  def->n = def->dim == 1 ? 40 : def->dim == 2 ? 14 : 9;
  def->periodic[0] = def->dim > 1 && k % 4 < 2;
  scene_make(s, def);
  oracle *o = &s->o;
  o->continuity = o->pressure = (enum oracle_row[]){ORACLE_C2, ORACLE_C1, ORACLE_PHI}[k / 2 % 3];
  o->exponent = 0.5L;
  o->alpha = 0.3L, o->beta = 0.2L * (k % 2);
  if (k % 3 == 1) o->signal_alpha = 0.5L, o->signal_beta = 3;
  o->laminar = k % 2 ? ORACLE_MORRIS : ORACLE_MCG;
  o->conduction = 1;
  o->epsilon = k % 3 == 0 ? 0.4L : 0;
  o->drag = def->dusts, o->drag_K = 300;
  if (def->thermal) o->conductivity = 1, o->energy = (enum oracle_energy)(k / 4 % 5);
  if (!def->thermal) {
    o->energy = k % 2 ? ORACLE_U : ORACLE_TEMPERATURE;
    o->diffusion = k % 3 == 0 ? ORACLE_ANTUONO : ORACLE_MOLTENI, o->delta = 0.1L;
  }
  if (k % 7 == 6) { /* density is a sum */
    o->summed = 1, o->diffusion = ORACLE_OFF;
    o->continuity = o->pressure = ORACLE_C1;
  }
  for (int d = 0; d < o->dim; d++) o->g[d] = 3 - d;
  o->omega = k % 2;
}

static int has(const oracle *o, int term)
{
  const int there[TERMS] = {!o->summed,
                            1,
                            o->alpha > 0,
                            o->signal_alpha > 0,
                            o->laminar > 0,
                            o->conductivity > 0,
                            o->conduction > 0,
                            o->epsilon > 0,
                            o->diffusion > 0,
                            o->drag,
                            1,
                            o->omega > 0,
                            1,
                            1};
  return there[term];
}

static sph_sim *simulation(scene *s, scene_options options)
{
  sph_sim *sim = scene_sim(s, options);
  sph_sim_add_term(sim, dye());
  sph_sim_add_term(sim, (sph_term){.name = "burn", .body = burn});
  for (int g = 0; g < 2; g++) {
    double *c = sph_group_write(sph_sim_group(sim, g ? "oil" : "water"), "dye", 0);
    for (long i = 0; c && i < sph_group_count(sph_sim_group_get(sim, g)); i++)
      c[i] = sin(3.0 * (double)i);
  }
  return sim;
}

/* Each term to a part by chance. */
static void deal(sph_sim *sim, const oracle *o, unsigned long seed)
{
  static const char *const names[] = {"explicit", "slow", "fast", "implicit"};
  for (int k = 0; k < TERMS; k++) {
    int may = !strcmp(terms[k], "viscosity-artificial") || !strcmp(terms[k], "viscosity-laminar") ||
              !strcmp(terms[k], "conduction") || !strcmp(terms[k], "delta") ||
              !strcmp(terms[k], "drag");
    if (has(o, k))
      sph_sim_set_part(sim, terms[k], names[(int)(scene_random(&seed) * (may ? 4 : 3))]);
  }
  assert_string_equal(sph_sim_error(sim), "");
}

/* Every piece, in any order; [pieces + 1], the last one is f. */
typedef struct pieces {
  N_Vector f[SPH_PARTS];
} pieces;

static pieces evaluate(sph_sim *sim, N_Vector y, unsigned long seed)
{
  pieces all;
  N_Vector scrap = N_VClone(y);
  N_VScale(1.001, y, scrap);
  for (int p = 0; p < SPH_PARTS; p++) all.f[p] = N_VClone(y);
  for (int q = 0, first = (int)(scene_random(&seed) * SPH_PARTS); q < SPH_PARTS; q++) {
    int p = (first + q) % SPH_PARTS;
    /* Between them f of another state, from which nothing may stay. */
    N_VConst(NAN, all.f[p]);
    assert_int_equal(sph_sim_rhs(0, scrap, all.f[p], sim), 0);
    N_VConst(NAN, all.f[p]);
    int status = p == SPH_WHOLE ? sph_sim_rhs(0, y, all.f[p], sim)
                                : sph_sim_rhs_piece(p, 0, y, all.f[p], sim);
    if (status) fail_msg("piece %d: status %d: %s %s", p, status, sph_sim_error(sim), sim->retry);
  }
  N_VDestroy(scrap);
  return all;
}

static void release(pieces *all)
{
  for (int p = 0; p < SPH_PARTS; p++) N_VDestroy(all->f[p]);
}

/* Of every segment: the largest sum of magnitudes of the parts. */
static void compare(const sph_sim *sim, const pieces *all, const int *parts, int n,
                    double tolerance, int k)
{
  const double *f = N_VGetArrayPointer(all->f[SPH_WHOLE]);
  for (int q = 0; q < sim->layout.segments; q++) {
    const sph_segment *segment = &sim->layout.segment[q];
    double size = 0, error = 0;
    for (long i = segment->offset; i < segment->offset + segment->n; i++) {
      double sum = 0, here = 0;
      for (int p = 0; p < n; p++) {
        double value = N_VGetArrayPointer(all->f[parts[p]])[i];
        sum += value, here += fabs(value);
      }
      size = fmax(size, here);
      if (!(fabs(sum - f[i]) <= error)) error = fabs(sum - f[i]); /* NaN stays */
    }
    if (!(error <= tolerance * size))
      fail_msg("scene %d, segment %d: parts differ from f by %g of %g", k, q, error, size);
  }
}

static void parts_add_up(void **state)
{
  (void)state;
  static const int parted[] = {SPH_PIECE_EXPLICIT, SPH_PIECE_IMPLICIT, SPH_PIECE_FAST};
  static const int separable[] = {SPH_PIECE_DRIFT, SPH_PIECE_KICK};
  for (int k = 0; k < 84; k++) {
    scene s;
    scene_def def;
    any_scene(&s, &def, k);
    sph_sim *sim = simulation(&s, (scene_options){.isa = k % 2 ? "reference" : NULL});
    deal(sim, &s.o, (unsigned long)k);
    N_Vector y = sph_sim_vector(sim);
    if (!y) fail_msg("scene %d: %s", k, sph_sim_error(sim));
    pieces all = evaluate(sim, y, (unsigned long)k);
    compare(sim, &all, parted, 3, 2e-14, k);
    compare(sim, &all, separable, 2, 2e-14, k);
    release(&all);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* So do their tangents; between them those of another state. */
static void tangents_add_up(void **state)
{
  (void)state;
  static const int parted[] = {SPH_PIECE_EXPLICIT, SPH_PIECE_IMPLICIT, SPH_PIECE_FAST};
  for (int k = 0; k < 84; k += 5) {
    scene s;
    scene_def def;
    any_scene(&s, &def, k);
    sph_sim *sim = simulation(&s, (scene_options){0});
    deal(sim, &s.o, (unsigned long)k);
    N_Vector y = sph_sim_vector(sim), direction = N_VClone(y), beside = N_VClone(y);
    pieces all;
    if (!y) fail_msg("scene %d: %s", k, sph_sim_error(sim));
    N_VScale(1.001, y, beside);
    assert_int_equal(sph_sim_weights(y, direction, sim), 0);
    for (long i = 0; i < sim->layout.length; i++)
      N_VGetArrayPointer(direction)[i] = sin((double)i) / N_VGetArrayPointer(direction)[i];
    for (int p = 0; p < SPH_PARTS; p++) {
      const double *s_of = N_VGetArrayPointer(direction), *at = N_VGetArrayPointer(beside);
      double *out = N_VGetArrayPointer(all.f[p] = N_VClone(y));
      assert_int_equal(sph_sim_tangent(sim, SPH_WHOLE, 0, at, s_of, NULL, 0, out), 0);
      assert_int_equal(sph_sim_tangent(sim, p, 0, N_VGetArrayPointer(y), s_of, NULL, 0, out), 0);
    }
    compare(sim, &all, parted, 3, 1e-9, k); /* tiles and body terms are differenced */
    release(&all);
    N_VDestroy(direction), N_VDestroy(beside);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* ---- what a part costs ---- */

/* A local source costs no pair loop and no list, and does not look at what it does not need. */
static void local_parts_are_cheap(void **state)
{
  (void)state;
  scene s;
  scene_make(&s, &(scene_def){.dim = 2, .n = 14, .fluids = 1, .walls = 1, .seed = 3});
  s.o.continuity = s.o.pressure = ORACLE_C2;
  s.o.omega = 1;
  sph_sim *sim = scene_sim(&s, (scene_options){0});
  sph_sim_set_part(sim, "harmonic", "fast");
  N_Vector y = sph_sim_vector(sim);
  assert_non_null(y);
  N_Vector far = N_VClone(y), f = N_VClone(y);
  N_VScale(2, y, far); /* lists of y do not do for that */
  double pairs = sim->pairs;
  long builds = sim->list_builds;
  double limit = sim->limit[SPH_BOUND_CFL];
  const sph_group *water = sph_sim_group(sim, "water");
  const double p = sph_group_read(water, "pressure", 0)[0];
  assert_int_equal(sph_sim_rhs_piece(SPH_PIECE_FAST, 0, far, f, sim), 0);
  assert_int_equal(sph_sim_rhs_piece(SPH_PIECE_DRIFT, 0, far, f, sim), 0);
  assert_true(sim->pairs == pairs && sim->list_builds == builds);
  assert_true(p == sph_group_read(water, "pressure", 0)[0]);
  assert_true(limit == sim->limit[SPH_BOUND_CFL] && isinf(sim->limit_fast[SPH_BOUND_CFL]));
  assert_true(sim->limit_fast[SPH_BOUND_FORCE] < INFINITY);
  assert_int_equal(sph_sim_rhs_piece(SPH_PIECE_KICK, 0, far, f, sim), 0);
  assert_true(sim->list_builds == builds + 1);
  N_VDestroy(far);
  N_VDestroy(f);
  sph_sim_free(sim);
  scene_free(&s);
}

/* ---- step limits ---- */

static double user_limit(const sph_term *term, const sph_particles *s)
{
  (void)term, (void)s;
  return 1e-5;
}

/* Implicit terms limit no step; fast ones that of the fast part alone. */
static void limits_of_parts(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    scene s;
    scene_make(&s,
               &(scene_def){.dim = 2, .n = 14, .fluids = 2, .thermal = 1, .laminar = 1, .seed = 9});
    s.o.continuity = s.o.pressure = ORACLE_C2;
    s.o.alpha = 1, s.o.beta = 2, s.o.laminar = ORACLE_MORRIS, s.o.conduction = 1;
    sph_sim *sim = scene_sim(&s, (scene_options){0});
    sph_sim_add_term(sim, (sph_term){.name = "burn", .body = burn, .dt_max = user_limit});
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    double whole[SPH_BOUND_COUNT], *limit = sim->limit;
    memcpy(whole, sim->limit, sizeof whole);
    sph_sim_free(sim);
    sim = scene_sim(&s, (scene_options){0});
    sph_sim_add_term(sim, (sph_term){.name = "burn", .body = burn, .dt_max = user_limit});
    if (k == 0) sph_sim_set_part(sim, "viscosity-laminar", "implicit");
    if (k == 1) sph_sim_set_part(sim, "conduction", "implicit");
    if (k == 2) sph_sim_set_part(sim, "viscosity-artificial", "implicit");
    if (k == 3) {
      sph_sim_set_part(sim, "burn", "fast");
      sph_sim_set_part(sim, "pressure", "fast");
      sph_sim_set_part(sim, "conduction", "fast");
    }
    N_Vector y = sph_sim_vector(sim), f = N_VClone(y);
    for (int p = SPH_PARTS - 1; p >= 0; p--)
      if (p != SPH_PIECE_DRIFT && p != SPH_PIECE_KICK) sph_sim_rhs_piece(p, 0, y, f, sim);
    limit = sim->limit;
    assert_true((limit[SPH_BOUND_VISCOUS] == whole[SPH_BOUND_VISCOUS]) == (k != 0));
    assert_true((limit[SPH_BOUND_CONDUCTION] == whole[SPH_BOUND_CONDUCTION]) == (k == 0 || k == 2));
    assert_true((limit[SPH_BOUND_CFL] == whole[SPH_BOUND_CFL]) == (k < 2));
    if (k == 0) assert_true(isinf(limit[SPH_BOUND_VISCOUS]));
    if (k == 1) assert_true(isinf(limit[SPH_BOUND_CONDUCTION]));
    if (k == 2) assert_true(limit[SPH_BOUND_CFL] > 1.5 * whole[SPH_BOUND_CFL]);
    assert_true(limit[SPH_BOUND_USER] == (k == 3 ? INFINITY : 1e-5));
    if (k == 3) {
      assert_true(sim->limit_fast[SPH_BOUND_USER] == 1e-5);
      assert_true(sim->limit_fast[SPH_BOUND_CONDUCTION] == whole[SPH_BOUND_CONDUCTION]);
      assert_true(limit[SPH_BOUND_CFL] > whole[SPH_BOUND_CFL]); /* artificial viscosity alone */
      assert_true(sim->limit_fast[SPH_BOUND_CFL] > whole[SPH_BOUND_CFL]);
    }
    N_VDestroy(f);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* ---- refused ---- */

static sph_sim *tank(void)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_group_set_viscosity(water, 1);
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar(NULL));
  return sim;
}

static void refused(sph_sim *sim, const char *text)
{
  if (!strstr(sph_sim_error(sim), text)) fail_msg("\"%s\" is not \"%s\"", sph_sim_error(sim), text);
  assert_true(sph_sim_status(sim) < 0);
  sph_sim_free(sim);
}

static void wrong_parts(void **state)
{
  (void)state;
  static const struct {
    const char *term, *part, *text;
  } wrong[] = {
      {"viscosity-lamina", "implicit", "did you mean 'viscosity-laminar'?"},
      {"conduction", "implicit", "it has: pressure, viscosity-laminar"},
      {"pressure", "quick", "part \"quick\"; known: explicit, implicit, fast, slow"},
      {"pressure", "implict", "did you mean 'implicit'?"},
      {"pressure", NULL, "part \"\""},
      {NULL, "fast", "term \"\""},
      {"pressure", "implicit",
       "pressure cannot be implicit; these can be: viscosity-artificial, viscosity-laminar"},
      {"viscosity-laminar", "implicit", "is implicit, but integrator"},
      {"viscosity-laminar", "fast", "is fast, but integrator"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    sph_sim *sim = tank();
    sph_sim_set_part(sim, wrong[k].term, wrong[k].part);
    if (k >= 7) sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
    if (k >= 7) assert_int_equal(sph_sim_evaluate(sim), SPH_ERR_ARGUMENT);
    refused(sim, wrong[k].text);
  }
  sph_sim *sim = tank();
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK); /* who steps it is not known yet */
  sph_sim_set_part(sim, "viscosity-laminar", "explicit");
  refused(sim, "before the run");
  sim = tank(); /* what was set is forgotten, so that any integrator steps it */
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  sph_sim_set_part(sim, "pressure", "fast");
  sph_sim_set_part(sim, NULL, "explicit");
  assert_int_equal(sph_sim_step(sim), SPH_OK);
  sph_sim_free(sim);
  sim = tank();
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  sph_sim_step(sim);
  refused(sim, "steps all terms alike");
}

/* Names are copied: what they stood in may be gone when the run begins. */
static void names_are_copied(void **state)
{
  (void)state;
  char method[] = "mri:kw3", fast[] = "erk:zonneveld-5-3-4", term[] = "pressure", part[] = "fast";
  sph_sim *sim = tank();
  sph_sim_set_part(sim, term, part);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .fast_method = fast});
  memset(method, 'x', sizeof method - 1);
  memset(fast, 'x', sizeof fast - 1);
  memset(term, 'x', sizeof term - 1);
  memset(part, 'x', sizeof part - 1);
  if (sph_sim_step(sim)) fail_msg("%s", sph_sim_error(sim));
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_add_up),          cmocka_unit_test(tangents_add_up),
      cmocka_unit_test(local_parts_are_cheap), cmocka_unit_test(limits_of_parts),
      cmocka_unit_test(wrong_parts),           cmocka_unit_test(names_are_copied),
  };
  return cmocka_run_group_tests_name("parts", tests, NULL, NULL);
}
