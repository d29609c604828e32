/* Stages of implicit terms: z = known + gamma f_I(t, z) holds with the f_I that explicit schemes
 * evaluate, for each term alone and for all of them, with walls, several fluids, every energy. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "scene.h"
#include "sim_data.h"
#include "sim_implicit.h"
#include "sim_rhs.h"
#include "sphode/sundials.h"

/* Terms of a scene, and which are implicit. */
enum { MORRIS = 1, MCG = 2, ARTIFICIAL = 4, CONDUCTION = 8, MOLTENI = 16, ANTUONO = 32, DRAG = 64 };

static void choose(oracle *o, unsigned terms, int k)
{
  o->continuity = o->pressure = ORACLE_C2;
  if (terms & MORRIS) o->laminar = ORACLE_MORRIS;
  if (terms & MCG) o->laminar = ORACLE_MCG;
  if (terms & ARTIFICIAL) o->alpha = 0.5L, o->beta = k % 2;
  if (terms & CONDUCTION) o->conduction = 1;
  if (terms & MOLTENI) o->diffusion = ORACLE_MOLTENI, o->delta = 0.1L;
  if (terms & ANTUONO) o->diffusion = ORACLE_ANTUONO, o->delta = 0.1L;
  o->drag = (terms & DRAG) != 0;
  o->drag_K = k % 2 ? 300 : 0, o->drag_rate = k % 2 ? 0 : 0.5L;
}

static void make_implicit(sph_sim *sim, unsigned terms)
{
  if (terms & (MORRIS | MCG)) sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  if (terms & ARTIFICIAL) sph_sim_set_part(sim, "viscosity-artificial", "implicit");
  if (terms & CONDUCTION) sph_sim_set_part(sim, "conduction", "implicit");
  if (terms & DRAG) sph_sim_set_part(sim, "drag", "implicit");
  if (terms & (MOLTENI | ANTUONO)) sph_sim_set_part(sim, "delta", "implicit");
}

/* Largest |z - known - gamma f_I(z)| of a segment against its largest |z - known|. */
static void check_stage(sph_sim *sim, const sph_stage *stage, double tolerance, int k)
{
  N_Vector f = N_VClone(stage->z);
  assert_int_equal(sph_sim_rhs_piece(SPH_PIECE_IMPLICIT, stage->t, stage->z, f, sim), 0);
  const double *z = N_VGetArrayPointer(stage->z), *known = N_VGetArrayPointer(stage->known);
  const double *rate = N_VGetArrayPointer(f);
  for (int q = 0; q < sim->layout.segments; q++) {
    const sph_segment *segment = &sim->layout.segment[q];
    double error = 0, size = 0;
    for (long i = segment->offset; i < segment->offset + segment->n; i++) {
      double miss = fabs(z[i] - known[i] - stage->gamma * rate[i]);
      if (!(miss <= error)) error = miss;
      size = fmax(size, fmax(fabs(z[i] - known[i]), 1e-3 * fabs(z[i])));
    }
    if (!(error <= tolerance * size))
      fail_msg("scene %d, segment %d (role %d): stage missed by %g of %g", k, q, segment->role,
               error, size);
  }
  N_VDestroy(f);
}

/* Solves a stage whose gamma is `stiff` times the explicit limit. */
static void solve(sph_sim *sim, double stiff, double gamma, int k)
{
  N_Vector y = sph_sim_vector(sim);
  if (!y) fail_msg("scene %d: %s", k, sph_sim_error(sim));
  N_Vector known = N_VClone(y), z = N_VClone(y);
  N_VScale(1, y, known);
  N_VScale(1, y, z);
  /* Positions and velocities of the guess are somewhere else: its positions do not count. */
  for (long i = 0; i < sim->layout.length; i++)
    N_VGetArrayPointer(z)[i] *= 1 + 1e-3 * sin(1.0 + (double)i);
  sph_stage stage = {.t = 0, .gamma = stiff * gamma, .tolerance = 1e-12, .known = known, .z = z};
  int status = sph_sim_implicit_solve(&stage, sim);
  if (status) fail_msg("scene %d: %d %s %s", k, status, sph_sim_error(sim), sim->retry);
  check_stage(sim, &stage, 1e-9, k);
  assert_true(stage.iterations > 0);
  N_VDestroy(known);
  N_VDestroy(z);
}

static void check(unsigned terms, unsigned implicit, int k, int thermal, double stiff)
{
  scene_def def = {.dim = 1 + k % 3,
                   .kernel = k % ORACLE_KERNELS,
                   .fluids = 1 + k / 2 % 2,
                   .dusts = terms & DRAG ? 1 + k / 4 % 2 : 0,
                   .thermal = thermal,
                   .laminar = 1,
                   .walls = k / 3 % 3,
                   .no_slip = 1,
                   .random = 0,
                   .seed = (unsigned long)(300 + k)};
  def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : def.dusts ? 8 : 9;
  for (int d = 0; d < def.dim; d++) def.periodic[d] = !def.walls || d < def.dim - 1;
  scene s;
  scene_make(&s, &def);
  choose(&s.o, terms, k);
  if (!thermal && (terms & CONDUCTION)) s.o.energy = k % 2 ? ORACLE_U : ORACLE_TEMPERATURE;
  if (thermal) s.o.energy = (enum oracle_energy)(k % 5);
  sph_sim *sim = scene_sim(&s, (scene_options){0});
  make_implicit(sim, implicit & terms);
  double h = (double)s.o.h;
  solve(sim, stiff, 0.125 * h * h * 1000 / 3, k);
  sph_sim_free(sim);
  scene_free(&s);
}

static void morris(void **state)
{
  (void)state;
  for (int k = 0; k < 12; k++) check(MORRIS, MORRIS, k, 0, 100);
}
static void mcg(void **state)
{
  (void)state;
  for (int k = 0; k < 12; k++) check(MCG, MCG, k, 0, 100);
}
static void conduction(void **state)
{
  (void)state;
  for (int k = 0; k < 12; k++) check(CONDUCTION, CONDUCTION, k, k % 2, 1);
}
static void artificial(void **state)
{
  (void)state;
  for (int k = 0; k < 12; k++) check(ARTIFICIAL, ARTIFICIAL, k, k % 2, 1);
}
static void diffusion(void **state)
{
  (void)state;
  for (int k = 0; k < 12; k++) check(k % 2 ? MOLTENI : ANTUONO, MOLTENI | ANTUONO, k, 0, 0.02);
}
static void drag(void **state)
{
  (void)state;
  for (int k = 0; k < 9; k++) check(DRAG | (k % 3 ? 0 : CONDUCTION), DRAG, k, k % 2, 100);
}
static void everything(void **state)
{
  (void)state;
  for (int k = 0; k < 24; k++)
    check((k % 2 ? MORRIS : MCG) | ARTIFICIAL | CONDUCTION | (k % 4 == 3 ? 0 : MOLTENI) |
              (k % 4 == 1 ? DRAG : 0),
          ~0u, k, k % 4 == 3, 0.02);
}

/* A stage of low accuracy: what the solver misses is spread over those that exchange, a particle
 * out of their reach moves as it did, and momentum is kept to rounding. */
static void who_is_alone_stays_out(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
    const char *const name[] = {"water", "lone"};
    for (int g = 0; g < 2; g++) {
      double high = g ? 3.1 : 1;
      sph_group *group =
          sph_group_box(sim, name[g], (double[]){3.0 * g, 3.0 * g}, (double[]){high, high}, 1000);
      sph_group_jitter(group, 0.1, 1);
      sph_group_set_eos(group, sph_eos_tait(1000, 10, 7));
      sph_group_set_viscosity(group, 100);
      double *v = sph_group_write(group, "velocity", 0);
      for (long i = 0; i < sph_group_count(group); i++) v[i] = g ? 0.3 : (double)(i % 7);
    }
    sph_sim_add_term(sim, sph_term_continuity());
    sph_sim_add_term(sim, sph_term_pressure());
    sph_sim_add_term(sim, sph_term_viscosity_laminar(k ? "mcg" : "morris"));
    sph_sim_set_part(sim, "viscosity-laminar", "implicit");
    if (k == 2) sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 0));
    if (k == 2) sph_sim_set_part(sim, "viscosity-artificial", "implicit");
    N_Vector y = sph_sim_vector(sim), known = N_VClone(y);
    N_VScale(1, y, known);
    sph_balance before, after;
    sph_sim_balance(sim, &before);
    assert_int_equal(sph_sim_solve(sim, 0, 0.1, 1e-2, known, y), SPH_OK);
    sph_sim_changed(sim);
    sph_sim_balance(sim, &after);
    const sph_group *lone = sph_sim_group(sim, "lone");
    assert_int_equal(sph_group_count(lone), 1);
    if (!(fabs(sph_group_read(lone, "velocity", 0)[0] - 0.3) < 1e-15))
      fail_msg("%d: %.17g", k, sph_group_read(lone, "velocity", 0)[0]);
    assert_true(fabs(after.momentum[0] - before.momentum[0]) < 1e-12 * before.momentum[0]);
    assert_true(after.kinetic < 0.8 * before.kinetic);
    N_VDestroy(known);
    sph_sim_free(sim);
  }
}

/* Water, and fields of dust far away if there are any. */
static sph_sim *pool(int fields, const char *laminar)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  for (int g = 0; g <= fields; g++) {
    char name[16];
    snprintf(name, sizeof name, "g%d", g);
    sph_group *group = sph_group_box(sim, name, (double[]){3.0 * g, 0},
                                     (double[]){3.0 * g + (g ? 2 : 1), g ? 3 : 1}, 1000);
    sph_group_jitter(group, 0.2, 1);
    sph_eos eos = sph_eos_tait(1000, 10, 7);
    eos.c_v = 4000;
    sph_group_set_eos(group, g ? sph_eos_dust() : eos);
    if (g) continue;
    sph_group_set_viscosity(group, 100);
    sph_group_set_conductivity(group, 1e6);
    sph_group_set_energy(group, "temperature");
    for (long i = 0; i < sph_group_count(group); i++) {
      sph_group_write(group, "velocity", 0)[i] = sin(1.0 + (double)i);
      sph_group_write(group, "energy", 0)[i] = 300 + cos(1.0 + (double)i);
    }
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar(laminar));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  sph_sim_set_part(sim, "conduction", "implicit");
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "imex:ark324l2sa-4-2-3",
                                                    .linear = "pcg-jacobi"});
  return sim;
}

/* Means are over those that take part: dust on which nothing acts lets nobody be less accurate. */
static void dust_loosens_nothing(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    long iterations[2];
    for (int fields = 0; fields < 2; fields++) {
      sph_sim *sim = pool(4 * fields, k ? "mcg" : "morris");
      N_Vector y = sph_sim_vector(sim);
      if (!y) fail_msg("%s", sph_sim_error(sim));
      N_Vector known = N_VClone(y);
      N_VScale(1, y, known);
      sph_stage stage = {.gamma = 0.1, .tolerance = 1e-6, .known = known, .z = y};
      assert_int_equal(sph_sim_implicit_solve(&stage, sim), 0);
      iterations[fields] = stage.iterations;
      N_VDestroy(known);
      sph_sim_free(sim);
    }
    if (iterations[0] != iterations[1])
      fail_msg("%d: %ld iterations, with dust %ld", k, iterations[0], iterations[1]);
  }
}

/* Pairs that are apart when the matrices get their pattern, and come back before the next list
 * build. */
static void pairs_come_back(void **state)
{
  (void)state;
  sph_sim *sim = pool(0, "mcg");
  N_Vector y = sph_sim_vector(sim), known = N_VClone(y), z = N_VClone(y), rate = N_VClone(y);
  assert_int_equal(sph_sim_rhs(0, y, rate, sim), 0);
  const long builds = sim->list_builds;
  for (int turn = 0; turn < 2; turn++) {
    sph_view view = sph_group_data_view(sim->group[0], sph_nvector_data(known), NULL);
    N_VScale(1, y, known);
    for (long i = 0; i < view.n; i++)
      for (int d = 0; d < 2; d++)
        view.x[d][i] += (turn ? -0.35 : 0.35) * sim->skin * (sin(7.0 * (double)i + d) > 0 ? 1 : -1);
    N_VScale(1, known, z);
    sph_stage stage = {.gamma = 0.1, .tolerance = 1e-12, .known = known, .z = z};
    assert_int_equal(sph_sim_implicit_solve(&stage, sim), 0);
    assert_int_equal(sim->list_builds, builds);
    check_stage(sim, &stage, 1e-9, turn);
  }
  N_VDestroy(known), N_VDestroy(z), N_VDestroy(rate);
  sph_sim_free(sim);
}

/* A matrix is filled anew where anything that it depends on is, and only there. */
static void matrices_are_kept(void **state)
{
  (void)state;
  scene_def def = {
      .dim = 2, .n = 14, .fluids = 2, .laminar = 1, .walls = 2, .no_slip = 1, .seed = 7};
  scene s;
  scene_make(&s, &def);
  choose(&s.o, CONDUCTION, 0);
  s.o.energy = ORACLE_TEMPERATURE;
  sph_sim *sim = scene_sim(&s, (scene_options){0});
  make_implicit(sim, CONDUCTION);
  N_Vector y = sph_sim_vector(sim), known = N_VClone(y), z = N_VClone(y);
  N_VScale(1, y, known);
  sph_view view = sph_group_data_view(sim->group[0], sph_nvector_data(known), NULL);
  sph_stage stage = {.gamma = 1, .tolerance = 1e-12, .known = known, .z = z};
  static const long filled[] = {1, 1, 2, 3, 3, 4, 5, 6};
  for (int k = 0; k < 8; k++) {
    if (k == 2) stage.gamma = 0.5;
    if (k == 3) view.x[0][5] += 1e-9;
    if (k == 4) view.v[0][5] += 1, view.energy[7] += 3;
    if (k == 5) view.rho[5] *= 1 + 1e-9;
    if (k == 6) sph_group_set_conductivity(sim->group[1], 41);
    if (k == 7) sph_sim_changed(sim); /* new lists */
    N_VScale(1, known, z);
    assert_int_equal(sph_sim_implicit_solve(&stage, sim), 0);
    if (sim->matrices != filled[k]) fail_msg("%d: %ld matrices", k, sim->matrices);
    check_stage(sim, &stage, 1e-9, k);
  }
  N_VDestroy(known), N_VDestroy(z);
  sph_sim_free(sim);
  scene_free(&s);
}

/* ---- terms of the user's own ---- */

/* Dye that diffuses, ds_i = 2 D sum V_j (s_i - s_j) F, and reacts, ds = - k s^3. */
typedef struct dye {
  double D, k;      /* [m^2/s], [1/s] */
  int exact;        /* jacobian_body gives 3 k s^2, not half as much again */
  long evaluations; /* of body */
} dye;

static void diffuse(const sph_term *term, const sph_tile *t)
{
  const dye *it = term->ctx;
  for (long k = 0; k < t->n; k++)
    t->ds[k] += 2 * it->D * t->V[k] * (t->s_i[k] - t->s_j[k]) * t->F[k];
}

static void diffuse_jacobian(const sph_term *term, const sph_tile *t,
                             const sph_term_jacobian *jacobian)
{
  const dye *it = term->ctx;
  for (long k = 0; k < t->n; k++) jacobian->s[k] -= 2 * it->D * t->V[k] * t->F[k];
}

static int react(const sph_term *term, const sph_particles *p)
{
  dye *it = term->ctx;
  it->evaluations++;
  for (long i = 0; i < p->n; i++) p->ds[i] -= it->k * p->s[i] * p->s[i] * p->s[i];
  return SPH_OK;
}

static void react_jacobian(const sph_term *term, const sph_particles *p,
                           const sph_term_jacobian *jacobian)
{
  const dye *it = term->ctx;
  for (long i = 0; i < p->n; i++)
    jacobian->s[i] += (it->exact ? 3 : 4.5) * it->k * p->s[i] * p->s[i];
}

static sph_term dye_term(dye *it)
{
  return (sph_term){.name = "dye",
                    .body = react,
                    .pair = diffuse,
                    .adds = "ds",
                    .scalar = {.name = "dye", .scale = 1, .initial = 1, .per_volume = 1},
                    .implicit = "scalar",
                    .jacobian_body = react_jacobian,
                    .jacobian_pair = diffuse_jacobian,
                    .ctx = it};
}

/* A wind that drags and cools, friction between particles that heats, radiation. */
static const double pull = 40, wind = 3, friction = 900, cooling = 60, ambient = 20;

static int breathe(const sph_term *term, const sph_particles *p)
{
  const double c_v = *(const double *)term->ctx;
  for (long i = 0; i < p->n; i++) {
    double T = p->u[i] / c_v;
    for (int d = 0; d < p->dim; d++) p->a[d][i] -= pull * (p->v[d][i] - wind);
    p->du[i] -= cooling * (T * T / ambient - ambient);
  }
  return SPH_OK;
}

static void breathe_jacobian(const sph_term *term, const sph_particles *p,
                             const sph_term_jacobian *jacobian)
{
  const double c_v = *(const double *)term->ctx;
  for (long i = 0; i < p->n; i++) {
    if (jacobian->v) jacobian->v[i] += pull;
    if (jacobian->T) jacobian->T[i] += cooling * 2 * p->u[i] / c_v / ambient;
  }
}

static void rub(const sph_term *term, const sph_tile *t)
{
  (void)term;
  for (long k = 0; k < t->n; k++)
    t->along_v[k] += friction * t->m[k] / (t->i[0][k] * t->j[0][k]) * t->F[k];
}

static void rub_jacobian(const sph_term *term, const sph_tile *t, const sph_term_jacobian *jacobian)
{
  (void)term;
  for (long k = 0; jacobian->v && k < t->n; k++)
    jacobian->v[k] -= friction * t->m[k] / (t->i[0][k] * t->j[0][k]) * t->F[k];
}

static sph_term air(double *c_v)
{
  return (sph_term){.name = "air",
                    .body = breathe,
                    .pair = rub,
                    .reads = "density",
                    .adds = "along_v",
                    .implicit = "velocity, energy",
                    .jacobian_body = breathe_jacobian,
                    .jacobian_pair = rub_jacobian,
                    .ctx = c_v};
}

static void registered_scalar(void **state)
{
  (void)state;
  for (int k = 0; k < 12; k++) {
    scene_def def = {.dim = 1 + k % 3,
                     .fluids = 1 + k / 2 % 2,
                     .walls = k / 3 % 3,
                     .no_slip = 1,
                     .seed = (unsigned long)(800 + k)};
    def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : 9;
    for (int d = 0; d < def.dim; d++) def.periodic[d] = !def.walls || d < def.dim - 1;
    scene s;
    scene_make(&s, &def);
    dye it = {.D = 5, .k = 300, .exact = k % 2};
    sph_sim *sim = scene_sim(&s, (scene_options){.threads = 1 + k % 2});
    sph_sim_add_term(sim, dye_term(&it));
    sph_sim_set_part(sim, "dye", "implicit");
    for (int g = 0; g < def.fluids; g++) {
      double *c = sph_group_write(sph_sim_group_get(sim, g), "dye", 0);
      long n = sph_group_count(sph_sim_group_get(sim, g));
      for (long i = 0; i < n; i++) c[i] = 1 + 0.5 * sin((double)i);
    }
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    it.evaluations = 0;
    solve(sim, 1, 0.05, k);
    /* Newton: a few; half as much again leaves a third of what is missed. */
    long most = it.exact ? 9 : 32;
    if (it.evaluations > def.fluids * most)
      fail_msg("scene %d: %ld evaluations", k, it.evaluations);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

static void registered_wind(void **state)
{
  (void)state;
  for (int k = 0; k < 24; k++) {
    scene_def def = {.dim = 1 + k % 3,
                     .fluids = 1,
                     .laminar = 1,
                     .thermal = k % 4 == 3,
                     .walls = k / 3 % 3,
                     .no_slip = 1,
                     .seed = (unsigned long)(900 + k)};
    def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : 9;
    for (int d = 0; d < def.dim; d++) def.periodic[d] = !def.walls || d < def.dim - 1;
    scene s;
    scene_make(&s, &def);
    unsigned terms = (unsigned[]){0, MORRIS | CONDUCTION, MCG, MORRIS | ARTIFICIAL}[k / 2 % 4];
    choose(&s.o, terms, k);
    s.o.energy = def.thermal ? (enum oracle_energy)(1 + k / 4 % 4) : ORACLE_U;
    double c_v = (double)s.o.group[0].eos.c_v;
    sph_sim *sim = scene_sim(&s, (scene_options){0});
    sph_sim_add_term(sim, air(&c_v));
    make_implicit(sim, terms);
    sph_sim_set_part(sim, "air", "implicit");
    solve(sim, 1, 0.02, k);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* In a box at rest a cosine of dye decays at the rate of its Laplacian and of the reaction, in
 * steps far longer than explicit ones could be. */
static int decay(const sph_term *term, const sph_particles *p)
{
  const dye *it = term->ctx;
  for (long i = 0; i < p->n; i++) p->ds[i] -= it->k * p->s[i];
  return SPH_OK;
}

static void decay_jacobian(const sph_term *term, const sph_particles *p,
                           const sph_term_jacobian *jacobian)
{
  const dye *it = term->ctx;
  for (long i = 0; i < p->n; i++) jacobian->s[i] += it->k;
}

static void scalar_decays(void **state)
{
  (void)state;
  const double L = 1, dx = L / 32, k = 2 * acos(-1) / L;
  dye it = {.D = 2, .k = 1};
  sph_term term = dye_term(&it);
  term.body = decay, term.jacobian_body = decay_jacobian;
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 1, .dx = dx, .periodic = {1}, .length = {L}, .speed = 1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0}, (double[]){L}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, term);
  sph_sim_set_part(sim, "dye", "implicit");
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "imex:ark436l2sa-6-3-4",
                                                    .dt_fixed = 0.01});
  const double *x = sph_group_read(water, "position", 0);
  double *c = sph_group_write(water, "dye", 0), rate = it.k, h = sph_sim_h(sim);
  for (long i = 0; i < 32; i++) c[i] = 1 + cos(k * x[i]);
  for (long j = -8; j <= 8; j++)
    rate -= 2 * it.D * dx * (1 - cos(k * (double)j * dx)) *
            sph_kernel_f(sph_kernel_find("wendland-c2"), 1, fabs((double)j) * dx, h);
  if (sph_sim_run(sim, 0.1) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  x = sph_group_read(water, "position", 0);
  const double *now = sph_group_read(water, "dye", 0);
  for (long i = 0; i < 32; i++) {
    double exact = exp(-it.k * 0.1) + exp(-rate * 0.1) * cos(k * x[i]);
    if (!(fabs(now[i] - exact) < 2e-5)) fail_msg("%ld: %g is not %g", i, now[i], exact);
  }
  sph_sim_free(sim);
}

static void refused(sph_term term, const char *part, const char *text)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, term);
  if (part) sph_sim_set_part(sim, term.name, part);
  sph_sim_vector(sim);
  if (!strstr(sph_sim_error(sim), text)) fail_msg("\"%s\" is not \"%s\"", sph_sim_error(sim), text);
  sph_sim_free(sim);
}

static void refusals(void **state)
{
  (void)state;
  dye it = {0};
  sph_term term = dye_term(&it);
  term.implicit = "scalar heat";
  refused(term, NULL, "implicit \"heat\"; known: velocity, energy, scalar");
  term = dye_term(&it);
  term.jacobian_body = NULL, term.jacobian_pair = NULL;
  refused(term, NULL, "without jacobian_body and jacobian_pair");
  term = dye_term(&it);
  term.implicit = NULL;
  refused(term, "implicit", "dye cannot be implicit: it says neither what it changes");
  term = dye_term(&it);
  term.scalar.name = NULL;
  refused(term, NULL, "implicit scalar, but it has none");
  double c_v = 1;
  refused(air(&c_v), "implicit", "changes the energy of water, which has not both");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(morris),
      cmocka_unit_test(mcg),
      cmocka_unit_test(conduction),
      cmocka_unit_test(artificial),
      cmocka_unit_test(diffusion),
      cmocka_unit_test(drag),
      cmocka_unit_test(everything),
      cmocka_unit_test(who_is_alone_stays_out),
      cmocka_unit_test(dust_loosens_nothing),
      cmocka_unit_test(pairs_come_back),
      cmocka_unit_test(matrices_are_kept),
      cmocka_unit_test(registered_scalar),
      cmocka_unit_test(registered_wind),
      cmocka_unit_test(scalar_decays),
      cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests_name("implicit", tests, NULL, NULL);
}
