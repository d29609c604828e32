/* Derivatives of the right-hand side against its differences, on random states: every kernel and
 * dimension, every term, walls, energies; along random directions of the state and along every
 * parameter. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "quick.h"
#include "scene.h"
#include "sim_tangent.h"
#include "sim_transposed.h"

static double worst;

/* ---- scenes ---- */

static double dice(unsigned long *state) { return scene_random(state); }
static int one_of(unsigned long *state, int n) { return (int)(n * dice(state)); }

/* Terms by chance, those that go together. */
static void choose_terms(scene *s, unsigned long *state)
{
  oracle *o = &s->o;
  const int gas = s->thermal;
  o->continuity = o->pressure = (enum oracle_row)(ORACLE_C1 + one_of(state, 3));
  if (o->pressure == ORACLE_PHI) o->exponent = 1.5 * dice(state) - 0.5;
  if (dice(state) < 0.2) o->summed = 1, o->continuity = o->pressure = ORACLE_C1;
  if (dice(state) < 0.6) o->alpha = 0.5, o->beta = one_of(state, 2);
  if (dice(state) < 0.3) o->signal_alpha = 0.5, o->signal_beta = 3;
  if (dice(state) < 0.5) o->laminar = (enum oracle_laminar)(1 + one_of(state, 2));
  if (dice(state) < 0.3) o->epsilon = 0.3;
  if (dice(state) < 0.7)
    for (int d = 0; d < o->dim; d++) o->g[d] = 3 - 2 * d;
  if (!gas && !o->summed && dice(state) < 0.7) {
    o->diffusion = (enum oracle_delta)(1 + one_of(state, 3));
    o->delta = 0.15;
  }
  if (gas) {
    o->energy = (enum oracle_energy)one_of(state, 5);
    if (dice(state) < 0.5) o->conductivity = 0.7;
  } else if (dice(state) < 0.5)
    o->energy = dice(state) < 0.5 ? ORACLE_U : ORACLE_TEMPERATURE;
  if ((gas || o->energy) && dice(state) < 0.6) o->conduction = 1;
}

static scene_def choose_scene(int dim, int kernel, unsigned long seed)
{
  unsigned long state = seed;
  scene_def def = {.dim = dim, .kernel = kernel, .laminar = 1, .seed = seed};
  def.n = dim == 1 ? 40 : dim == 2 ? 12 : 8;
  def.walls = one_of(&state, 3);
  if (dim == 3 && def.walls) def.n = 9;
  def.thermal = one_of(&state, 2);
  def.fluids = 1 + one_of(&state, 2);
  def.random = one_of(&state, 2);
  def.no_slip = one_of(&state, 2);
  def.tension = one_of(&state, 2);
  for (int d = 0; d < dim; d++) def.periodic[d] = one_of(&state, 2);
  if (def.walls) def.periodic[dim - 1] = 0;
  def.dusts = seed % 3 == 1 ? 1 + (int)(seed / 3 % 2) : 0;
  return def;
}

static void any_scene(scene *s, int dim, int kernel, unsigned long seed)
{
  scene_def def = choose_scene(dim, kernel, seed);
  unsigned long state = seed + 1;
  scene_make(s, &def);
  choose_terms(s, &state);
  if (def.dusts) {
    s->o.drag = 1;
    s->o.drag_K = seed % 2 ? 300 : 0, s->o.drag_rate = seed % 2 ? 0 : 0.5L;
  }
  for (int d = 0; d < dim; d++)
    if (!def.periodic[d] && one_of(&state, 4) == 0) s->o.omega = 3;
  for (int d = 0; d < dim; d++)
    if (def.periodic[d]) s->o.omega = 0;
}

/* ---- differences of f ---- */

/* Four points: to 1e-11 of its size with the largest step where f is smooth; where a pair is near a
 * kink, as one that begins to approach, smaller ones see the same side of it only. */
static const double steps[] = {0x1p-13, 0x1p-18, 0x1p-20, 0x1p-22};
enum { STEPS = sizeof steps / sizeof *steps };
static const double at[] = {-2, -1, 1, 2};
static const double weight[] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};

/* d f(y + e s, theta + e)/de, theta moving by its scale; either may be NULL. */
static void differences(sph_sim *sim, const double *s, const sph_parameter *theta, double step,
                        double *out)
{
  N_Vector y = sph_sim_vector(sim), beside = N_VClone(y), f = N_VClone(y);
  const double value = theta ? *theta->value : 0, *start = N_VGetArrayPointer(y);
  memset(out, 0, (size_t)sim->layout.length * sizeof *out);
  for (int k = 0; k < 4; k++) {
    for (long i = 0; i < sim->layout.length; i++)
      N_VGetArrayPointer(beside)[i] = start[i] + (s ? at[k] * step * s[i] : 0);
    if (theta) sph_sim_parameter_set(sim, theta, value + at[k] * step * theta->scale);
    if (sph_sim_rhs(sim->time, beside, f, sim)) fail_msg("%s%s", sph_sim_error(sim), sim->retry);
    for (long i = 0; i < sim->layout.length; i++)
      out[i] += weight[k] / step * N_VGetArrayPointer(f)[i] / (theta ? theta->scale : 1);
  }
  if (theta) sph_sim_parameter_set(sim, theta, value);
  N_VDestroy(beside);
  N_VDestroy(f);
}

/* Each field on its own: the largest difference over the largest entry; a hundredth of f over the
 * scale of what moves counts as large. */
static double distance(const sph_sim *sim, const double *found, const double *expected,
                       double scale)
{
  const double *f = sim->tangent->rate;
  double worst_field = 0;
  for (int k = 0; k < sim->layout.segments; k++) {
    const sph_segment *segment = &sim->layout.segment[k];
    double most = 0, error = 0;
    for (long i = segment->offset; i < segment->offset + segment->n; i++) {
      most = fmax(most, fmax(fabs(expected[i]), 1e-2 * fabs(f[i]) / scale));
      error = fmax(error, isnan(found[i]) ? INFINITY : fabs(found[i] - expected[i]));
    }
    worst_field = fmax(worst_field, error > 0 ? error / most : 0);
  }
  return worst_field;
}

static double error_of(sph_sim *sim, const double *s, const sph_parameter *theta)
{
  const size_t n = (size_t)sim->layout.length;
  double *found = test_calloc(n, 8), *expected = test_calloc(n, 8), least = INFINITY;
  int status =
      sph_sim_tangent(sim, SPH_WHOLE, sim->time, N_VGetArrayPointer(sim->y), s, theta, 0, found);
  if (status) fail_msg("%s%s", sph_sim_error(sim), sim->retry);
  for (int k = 0; k < STEPS && least > 1e-9; k++) {
    differences(sim, s, theta, steps[k], expected);
    least = fmin(least, distance(sim, found, expected, theta ? theta->scale : 1));
  }
  test_free(found), test_free(expected);
  return least;
}

/* A random direction: every field moves by up to its scale. */
static void direction(sph_sim *sim, unsigned long seed, double *s)
{
  N_Vector w = N_VClone(sim->y);
  unsigned long state = seed + 17;
  sph_sim_weights(sim->y, w, sim);
  for (long i = 0; i < sim->layout.length; i++) {
    double scale = N_VGetArrayPointer(w)[i];
    s[i] = scale > 0 ? (2 * dice(&state) - 1) / scale : 0;
  }
  N_VDestroy(w);
}

/* Of three directions the best: a pair may cross the edge of the Gaussian, where f jumps. */
static void along_the_state(sph_sim *sim, unsigned long seed)
{
  double *s = test_calloc((size_t)sim->layout.length, 8), least = INFINITY;
  for (unsigned long k = 0; k < 3 && least > 1e-6; k++) {
    direction(sim, seed + k, s);
    least = fmin(least, error_of(sim, s, NULL));
  }
  worst = fmax(worst, least);
  if (!(least <= 1e-6)) fail_msg("seed %lu: error %.3g", seed, least);
  test_free(s);
}

/* ---- the tests ---- */

static void states(void **state)
{
  (void)state;
  worst = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int kernel = 0; kernel < ORACLE_KERNELS; kernel += quick_stride())
      for (unsigned long k = 0; k < (dim == 3 ? 2 : 4); k++) {
        unsigned long seed = 100 * (unsigned long)(10 * dim + kernel) + k;
        scene s;
        any_scene(&s, dim, kernel, seed);
        sph_sim *sim = scene_sim(&s, (scene_options){.threads = 1});
        if (!sph_sim_vector(sim)) fail_msg("%s", sph_sim_error(sim));
        along_the_state(sim, seed);
        sph_sim_free(sim);
        scene_free(&s);
      }
  print_message("# largest error: %.2g\n", worst);
}

/* d f/d theta of all parameters that the terms of a scene have; h moves pairs over the edge of the
 * Gaussian, where f jumps.  Artificial conductivity goes as sqrt|p_i - p_j|, whose differences are
 * off wherever two pressures are nearly equal: 1e-5 there, 1e-6 without it. */
static void parameters(void **state)
{
  (void)state;
  int tried = 0;
  double smooth = 0, kinked = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int kernel = 0; kernel < ORACLE_KERNELS; kernel += dim == 3 ? 3 : quick_stride())
      for (unsigned long k = 0; k < (dim == 3 ? 1 : 2); k++) {
        unsigned long seed = 100 * (unsigned long)(10 * dim + kernel) + 50 + k;
        scene s;
        any_scene(&s, dim, kernel, seed);
        sph_sim *sim = scene_sim(&s, (scene_options){.threads = 1});
        sph_parameter theta;
        for (int n = 0; sph_sim_parameter_get(sim, n, &theta); n++) {
          int jumps = theta.is_h && (kernel == ORACLE_GAUSSIAN || kernel == ORACLE_SHIFTED);
          double error = jumps ? 0 : error_of(sim, NULL, &theta);
          double *of = s.o.conductivity > 0 ? &kinked : &smooth;
          *of = fmax(*of, error);
          tried++;
          if (!(error <= (s.o.conductivity > 0 ? 1e-5 : 1e-6)))
            fail_msg("seed %lu, %s: error %.3g", seed, theta.name, error);
        }
        assert_string_equal(sph_sim_error(sim), "");
        sph_sim_free(sim);
        scene_free(&s);
      }
  print_message("# %d parameters: error %.2g, %.2g with artificial conductivity\n", tried, smooth,
                kinked);
  assert_true(smooth > 0 && kinked > 0);
}

/* ---- the transposed product: w . (J s) = (J^T w) . s ---- */

static double transposed_error(sph_sim *sim, unsigned long seed, int lagged)
{
  const long n = sim->layout.length;
  double *s = test_calloc((size_t)n, 8), *w = test_calloc((size_t)n, 8);
  double *Js = test_calloc((size_t)n, 8), *Jw = test_calloc((size_t)n, 8);
  const double *y = N_VGetArrayPointer(sim->y);
  double one = 0, other = 0, size = 0;
  direction(sim, seed, s);
  direction(sim, seed + 1, w);
  N_Vector scale = N_VClone(sim->y); /* every field's share of w . J s in the same unit */
  sph_sim_weights(sim->y, scale, sim);
  for (long i = 0; i < n; i++) w[i] *= pow(N_VGetArrayPointer(scale)[i], 2);
  N_VDestroy(scale);
  int status = sph_sim_tangent(sim, SPH_WHOLE, sim->time, y, s, NULL, lagged, Js);
  if (!status) status = sph_sim_transposed(sim, SPH_WHOLE, sim->time, y, w, NULL, lagged, Jw);
  if (status) fail_msg("seed %lu: %s%s", seed, sph_sim_error(sim), sim->retry);
  for (long i = 0; i < n; i++) {
    one += w[i] * Js[i];
    other += Jw[i] * s[i];
    size += fabs(w[i] * Js[i]) + fabs(Jw[i] * s[i]);
  }
  test_free(s), test_free(w), test_free(Js), test_free(Jw);
  return isnan(one - other) ? INFINITY : fabs(one - other) / size;
}

static void transposed(void **state)
{
  (void)state;
  worst = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int kernel = dim == 3 ? 1 : 0; kernel < ORACLE_KERNELS;
         kernel += dim == 3 ? 3 : quick_stride())
      for (unsigned long k = 0; k < (dim == 3 ? 1 : 4); k++) {
        unsigned long seed = 100 * (unsigned long)(10 * dim + kernel) + 70 + k;
        scene s;
        any_scene(&s, dim, kernel, seed);
        sph_sim *sim = scene_sim(&s, (scene_options){.threads = 1});
        if (!sph_sim_vector(sim)) fail_msg("%s", sph_sim_error(sim));
        for (int lagged = 0; lagged < 2; lagged++) {
          double error = transposed_error(sim, seed, lagged);
          worst = fmax(worst, error);
          /* body terms are differenced, along other directions */
          if (!(error <= (s.o.omega > 0 ? 1e-10 : 1e-12)))
            fail_msg("seed %lu, lagged %d: error %.3g", seed, lagged, error);
        }
        sph_sim_free(sim);
        scene_free(&s);
      }
  print_message("# largest error: %.2g\n", worst);
}

/* ---- what users bring along ---- */

/* A drag that grows with speed and density, a source of a scalar that depends on place. */
static int own_body(const sph_term *term, const sph_particles *p)
{
  const double *k = term->ctx;
  for (long i = 0; i < p->n; i++) {
    double v2 = 0;
    for (int d = 0; d < p->dim; d++) v2 += p->v[d][i] * p->v[d][i];
    for (int d = 0; d < p->dim; d++)
      p->a[d][i] -= *k * p->rho[i] / 1000 * sqrt(1 + v2) * p->v[d][i];
    if (p->drho) p->drho[i] += *k * p->s[i] * p->rho[i];
    p->ds[i] += sin(*k * p->x[0][i]) * p->s[i] * p->s[i];
  }
  return SPH_OK;
}

/* A force between particles and a diffusion of that scalar. */
static void own_pair(const sph_term *term, const sph_tile *tile)
{
  const double k = *(const double *)term->ctx;
  for (long n = 0; n < tile->n; n++) {
    tile->push[n] += k * (tile->i[0][n] + tile->j[0][n]) * tile->V[n] * tile->F[n] / 1000;
    tile->along_v[n] += k * tile->m[n] * tile->F[n] / 100 * (1 + tile->s_i[n] * tile->s_j[n]);
    tile->ds[n] += tile->V[n] * tile->F[n] * (tile->s_i[n] - tile->s_j[n]) *
                   sqrt(1 + tile->rv[n] * tile->rv[n]);
  }
}

static void own_phi(const sph_term *term, const sph_particles *p, double *phi)
{
  const double k = *(const double *)term->ctx;
  for (long i = 0; i < p->n; i++) phi[i] = 1 + k * p->rho[i] / 1000 + 0.1 * sin(p->x[0][i]);
}

/* A wall that swings. */
static void own_motion(void *ctx, double t, double displacement[3], double velocity[3],
                       double acceleration[3])
{
  const double k = *(const double *)ctx;
  for (int d = 0; d < 3; d++) {
    displacement[d] = 0.01 * k * sin(t + d + 1);
    velocity[d] = k * k * cos(t + d + 1);
    acceleration[d] = -10 * k * sin(t + d + 1);
  }
}

/* ... and turns. */
static void own_turn(void *ctx, double t, double turn[3])
{
  const double k = *(const double *)ctx;
  turn[0] = 0.01 * k * sin(t + 1), turn[1] = 2 * k * k * cos(t + 1), turn[2] = -3 * k * sin(t + 1);
}

/* Tait's, without its slopes. */
static sph_eos own_eos(void)
{
  sph_eos eos = sph_eos_tait(1000, 10, 7);
  eos.name = "own";
  eos.slopes = NULL;
  return eos;
}

static void callbacks(void **state)
{
  (void)state;
  static double k = 0.7;
  worst = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int walls = 0; walls < 3; walls++) {
      scene_def def = {.dim = dim, .walls = walls, .laminar = 1, .no_slip = 1, .fluids = 2};
      def.n = dim == 1 ? 40 : dim == 2 ? 14 : 9;
      def.seed = (unsigned long)(10 * dim + walls);
      scene s;
      scene_make(&s, &def);
      s.o.pressure = walls == 1 ? ORACLE_PHI : ORACLE_C2;
      s.o.continuity = walls == 1 ? ORACLE_NONE : ORACLE_C2;
      s.o.laminar = ORACLE_MORRIS;
      sph_sim *sim = scene_sim(&s, (scene_options){.threads = 1});
      sph_group_set_eos(sph_sim_group(sim, "water"), own_eos());
      sph_boundary boundary = sph_boundary_adami_no_slip();
      boundary.motion = own_motion, boundary.ctx = &k, boundary.tension = 1;
      if (dim > 1) boundary.rotation = own_turn;
      if (walls) sph_group_set_boundary(sph_sim_group(sim, "floor"), boundary);
      if (walls == 1)
        sph_sim_add_term(
            sim, (sph_term){.name = "continuity", .form = "phi", .phi = own_phi, .ctx = &k});
      sph_sim_add_term(sim, (sph_term){.name = "own",
                                       .body = own_body,
                                       .pair = own_pair,
                                       .reads = "density",
                                       .ctx = &k,
                                       .scalar = {.name = "salt", .scale = 1, .initial = 0.5}});
      if (!sph_sim_vector(sim)) fail_msg("%s", sph_sim_error(sim));
      along_the_state(sim, def.seed);
      sph_parameter theta;
      for (int n = 0; sph_sim_parameter_get(sim, n, &theta); n++)
        worst = fmax(worst, error_of(sim, NULL, &theta));
      sph_sim_parameter_own("k", &k, &theta);
      worst = fmax(worst, error_of(sim, NULL, &theta));
      assert_true(k == 0.7);
      if (!(worst <= 1e-6)) fail_msg("%dD, %d walls: error %.3g", dim, walls, worst);
      sph_sim_free(sim);
      scene_free(&s);
    }
  print_message("# largest error: %.2g\n", worst);
}

/* Transposed: of the body term; tiles and phi are refused. */
static void callbacks_transposed(void **state)
{
  (void)state;
  static double k = 0.7;
  scene_def def = {.dim = 2, .n = 14, .walls = 1, .laminar = 1, .thermal = 1, .seed = 8};
  for (int pairs = 0; pairs < 2; pairs++) {
    scene s;
    scene_make(&s, &def);
    s.o.pressure = s.o.continuity = ORACLE_C2;
    sph_sim *sim = scene_sim(&s, (scene_options){.threads = 1});
    sph_sim_add_term(sim, (sph_term){.name = "own",
                                     .body = own_body,
                                     .pair = pairs ? own_pair : NULL,
                                     .reads = "density",
                                     .ctx = &k,
                                     .scalar = {.name = "salt", .scale = 1, .initial = 0.5}});
    if (!sph_sim_vector(sim)) fail_msg("%s", sph_sim_error(sim));
    if (pairs) {
      double *w = test_calloc((size_t)sim->layout.length, 8), *y = N_VGetArrayPointer(sim->y);
      assert_int_equal(sph_sim_transposed(sim, SPH_WHOLE, 0, y, w, NULL, 0, w), SPH_ERR_ARGUMENT);
      assert_non_null(strstr(sph_sim_error(sim), "tiles"));
      test_free(w);
    } else {
      double error = transposed_error(sim, 3, 0);
      if (!(error <= 1e-9)) fail_msg("error %.3g", error);
    }
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* ---- the same bits ---- */

static double *product(int threads, int transposed, long *n)
{
  scene_def def = {.dim = 2, .n = 30, .walls = 2, .fluids = 2, .no_slip = 1, .seed = 5};
  scene s;
  scene_make(&s, &def);
  s.o.pressure = s.o.continuity = ORACLE_C2;
  s.o.alpha = 0.1, s.o.diffusion = ORACLE_ANTUONO, s.o.delta = 0.1;
  sph_sim *sim = scene_sim(&s, (scene_options){.threads = threads});
  N_Vector y = sph_sim_vector(sim), Jv = N_VClone(y), v = N_VClone(y);
  direction(sim, 5, N_VGetArrayPointer(v));
  if (transposed)
    assert_int_equal(sph_sim_transposed(sim, SPH_WHOLE, 0, N_VGetArrayPointer(y),
                                        N_VGetArrayPointer(v), NULL, 0, N_VGetArrayPointer(Jv)),
                     SPH_OK);
  else
    assert_int_equal(sph_sim_jacobian_times(v, Jv, 0, y, NULL, sim, NULL), SPH_OK);
  *n = sim->layout.length;
  double *copy = test_calloc((size_t)*n, sizeof *copy);
  memcpy(copy, N_VGetArrayPointer(Jv), (size_t)*n * sizeof *copy);
  N_VDestroy(Jv);
  N_VDestroy(v);
  sph_sim_free(sim);
  scene_free(&s);
  return copy;
}

static void threads(void **state)
{
  (void)state;
  for (int which = 0; which < 2; which++) {
    long n = 0;
    double *one = product(1, which, &n);
    for (int k = 2; k <= 3; k++) {
      double *other = product(k, which, &n);
      assert_memory_equal(one, other, (size_t)n * sizeof *one);
      test_free(other);
    }
    test_free(one);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(states),
      cmocka_unit_test(parameters),
      cmocka_unit_test(transposed),
      cmocka_unit_test(callbacks),
      cmocka_unit_test(callbacks_transposed),
      cmocka_unit_test(threads),
  };
  return cmocka_run_group_tests_name("tangent", tests, NULL, NULL);
}
