/* The sparse Jacobian: its product with random vectors against tangents, its entries against
 * differences of the right-hand side, its pattern, and steady states by Newton's method with it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <klu.h>
#include <math.h>

#include "scene.h"
#include "sim_tangent.h"
#include "sphode/jacobian.h"

static void random_vector(const sph_jacobian *J, unsigned long seed, double *v)
{
  for (long r = 0; r < J->n; r++) v[r] = 2 * scene_random(&seed) - 1;
}

/* J v of both; the largest difference over the largest entry, field by field. */
static double product_error(sph_sim *sim, const sph_jacobian *J, int lagged, unsigned long seed)
{
  const size_t length = (size_t)sim->layout.length;
  double *v = test_calloc((size_t)J->n, 8), *s = test_calloc(length, 8);
  double *expected = test_calloc(length, 8), *size = test_calloc(length, 8), worst = 0;
  N_Vector w = N_VClone(sim->y);
  random_vector(J, seed, v);
  sph_sim_weights(sim->y, w, sim);
  for (long r = 0; r < J->n; r++) {
    v[r] /= N_VGetArrayPointer(w)[J->place[r]];
    s[J->place[r]] = v[r];
  }
  assert_int_equal(sph_sim_tangent(sim, SPH_WHOLE, sim->time, N_VGetArrayPointer(sim->y), s, NULL,
                                   lagged, expected),
                   SPH_OK);
  for (int k = 0; k < sim->layout.segments; k++) {
    const sph_segment *segment = &sim->layout.segment[k];
    for (long i = 0; i < segment->n; i++)
      size[k] = fmax(size[k], fabs(expected[segment->offset + i]));
  }
  for (long r = 0, k = 0; r < J->n; r++) {
    while (J->place[r] >= sim->layout.segment[k].offset + sim->layout.segment[k].capacity) k++;
    double sum = -expected[J->place[r]];
    for (long e = J->first[r]; e < J->first[r + 1]; e++) sum += J->value[e] * v[J->column[e]];
    worst = fmax(worst, fabs(sum) / size[k]);
  }
  N_VDestroy(w);
  test_free(v), test_free(s), test_free(expected), test_free(size);
  return worst;
}

/* Rows in order, columns rising, places those of the vector. */
static void check_form(const sph_sim *sim, const sph_jacobian *J)
{
  assert_int_equal(J->n, sim->layout.entries);
  assert_int_equal(J->first[0], 0);
  for (long r = 0; r < J->n; r++) {
    assert_true(J->first[r] < J->first[r + 1]);
    for (long e = J->first[r]; e < J->first[r + 1]; e++) {
      assert_in_range(J->column[e], 0, J->n - 1);
      assert_true(e == J->first[r] || J->column[e] > J->column[e - 1]);
    }
    assert_true(r == 0 || J->place[r] > J->place[r - 1]);
  }
}

static const scene_def defs[] = {
    {.dim = 1, .n = 60, .walls = 2, .fluids = 2, .no_slip = 1, .laminar = 1},
    {.dim = 1, .n = 60, .thermal = 1, .fluids = 2, .periodic = {1}},
    {.dim = 2, .n = 14, .walls = 2, .no_slip = 1, .laminar = 1, .periodic = {1}},
    {.dim = 2, .n = 14, .walls = 1, .random = 1},
    {.dim = 2, .n = 16, .thermal = 1, .fluids = 2, .laminar = 1},
    {.dim = 3, .n = 5, .fluids = 2},
    {.dim = 2, .n = 12, .thermal = 1, .dusts = 2, .periodic = {1}},
};
enum { DEFS = sizeof defs / sizeof *defs };

static sph_sim *simulation(scene *s, int k)
{
  scene_def def = defs[k];
  def.seed = 700 + (unsigned long)k;
  scene_make(s, &def);
  s->o.continuity = s->o.pressure = k % 2 ? ORACLE_C1 : ORACLE_C2;
  s->o.alpha = 0.2;
  if (def.laminar) s->o.laminar = ORACLE_MORRIS;
  if (!def.thermal) s->o.diffusion = ORACLE_ANTUONO, s->o.delta = 0.1;
  if (k == 3) s->o.summed = 1, s->o.diffusion = ORACLE_OFF, s->o.epsilon = 0.3;
  if (def.dusts) s->o.drag = 1, s->o.drag_rate = 0.5;
  if (k == 4) s->o.conduction = 1, s->o.energy = ORACLE_TOTAL;
  sph_sim *sim = scene_sim(s, (scene_options){.threads = 1});
  if (!sph_sim_vector(sim)) fail_msg("%s", sph_sim_error(sim));
  return sim;
}

static void products(void **state)
{
  (void)state;
  for (int k = 0; k < DEFS; k++)
    for (int lagged = 0; lagged < (k % 2 ? 1 : 2); lagged++) {
      scene s;
      sph_sim *sim = simulation(&s, k);
      sph_jacobian *J = sph_jacobian_create(sim, &(sph_jacobian_def){.lagged = lagged});
      assert_int_equal(sph_jacobian_evaluate(J), SPH_OK);
      check_form(sim, J);
      double error = product_error(sim, J, lagged, 5);
      print_message("# %dD%s: n %ld, %ld entries, %ld products, error %.2g\n", defs[k].dim,
                    lagged ? ", lagged" : "", J->n, J->first[J->n], J->products, error);
      assert_true(error < 1e-12);
      assert_true(J->products <= J->n);
      assert_int_equal(J->patterns, 1);
      assert_int_equal(sph_jacobian_evaluate(J), SPH_OK);
      assert_int_equal(J->patterns, 1);
      sph_jacobian_free(J);
      sph_sim_free(sim);
      scene_free(&s);
    }
}

/* ---- entries against differences ---- */

/* Column c of a small one, by differences of f. */
static void entries(void **state)
{
  (void)state;
  static const double at[] = {-2, -1, 1, 2}, weight[] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
  for (int k = 0; k < 2; k++) {
    scene s;
    sph_sim *sim = simulation(&s, k);
    sph_jacobian *J = sph_jacobian_create(sim, NULL);
    assert_int_equal(sph_jacobian_evaluate(J), SPH_OK);
    N_Vector beside = N_VClone(sim->y), f = N_VClone(sim->y), w = N_VClone(sim->y);
    double *column = test_calloc((size_t)J->n, 8), *dense = test_calloc((size_t)J->n, 8), worst = 0;
    sph_sim_weights(sim->y, w, sim);
    for (long c = 0; c < J->n; c++) {
      const double step = 0x1p-18 / N_VGetArrayPointer(w)[J->place[c]];
      double most = 0;
      memset(column, 0, (size_t)J->n * 8), memset(dense, 0, (size_t)J->n * 8);
      for (int q = 0; q < 4; q++) {
        N_VScale(1, sim->y, beside);
        N_VGetArrayPointer(beside)[J->place[c]] += at[q] * step;
        assert_int_equal(sph_sim_rhs(sim->time, beside, f, sim), SPH_OK);
        for (long r = 0; r < J->n; r++)
          column[r] += weight[q] / step * N_VGetArrayPointer(f)[J->place[r]];
      }
      for (long r = 0; r < J->n; r++)
        for (long e = J->first[r]; e < J->first[r + 1]; e++)
          if (J->column[e] == c) dense[r] = J->value[e];
      /* rates over their scales, the change over its own */
      for (long r = 0; r < J->n; r++) {
        double scale = N_VGetArrayPointer(w)[J->place[r]];
        most = fmax(most, scale * fabs(dense[r]));
      }
      for (long r = 0; r < J->n; r++) {
        double scale = N_VGetArrayPointer(w)[J->place[r]];
        worst = fmax(worst, scale * fabs(dense[r] - column[r]) / most);
      }
    }
    print_message("# entries: %.2g of the largest in their column\n", worst);
    assert_true(worst < 1e-6);
    long row = sph_jacobian_row(J, sph_sim_group(sim, "oil"), "density", 0);
    assert_true(row > 0 &&
                J->place[row] == sph_group_read(sph_sim_group(sim, "oil"), "density", 0) -
                                     N_VGetArrayPointer(sim->y));
    assert_int_equal(sph_jacobian_row(J, sph_sim_group(sim, "oil"), "mass", 0), -1);
    N_VDestroy(beside), N_VDestroy(f), N_VDestroy(w);
    test_free(column), test_free(dense);
    sph_jacobian_free(J);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* ---- a steady state ---- */

/* Flow between plates, driven by a force along them, that heats itself: velocity and temperature in
 * balance, positions and density held,
 *   v = g y (L - y)/(2 nu),  T = T_w + eta (g/nu)^2 [(L/2)^4 - (y - L/2)^4]/(12 kappa). */
static const double L = 1, nu = 0.2, kappa = 5, T_wall = 300, force = 8, rho0 = 10; /* SI */

static sph_sim *channel(int ny)
{
  const double dx = L / ny;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = dx, .periodic = {1}, .length = {10 * dx}, .speed = force * L * L / (8 * nu)});
  sph_group *oil = sph_group_box(sim, "oil", (double[]){0, 0}, (double[]){10 * dx, L}, rho0);
  sph_eos eos = sph_eos_linear(rho0, 50, -INFINITY);
  eos.c_v = 100;
  sph_group_set_eos(oil, eos);
  sph_group_set_viscosity(oil, rho0 * nu);
  sph_group_set_conductivity(oil, kappa);
  sph_group_set_energy(oil, "temperature");
  double T[4000];
  for (long i = 0; i < sph_group_count(oil); i++) T[i] = T_wall;
  sph_group_set_temperature(oil, T);
  sph_group *plates = sph_group_create(sim, "plates", "wall");
  sph_group_add_layers(plates, (double[]){0, 0}, (double[]){10 * dx, L}, "x- x+", rho0);
  sph_boundary boundary = sph_boundary_adami_no_slip();
  boundary.temperature = T_wall;
  sph_group_set_boundary(plates, boundary);
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_add_term(sim, sph_term_gravity((double[]){force, 0, 0}));
  return sim;
}

/* x of A x = b by KLU, rows given as columns of the transposed. */
static void solve_by_klu(long n, SuiteSparse_long *first, SuiteSparse_long *column, double *value,
                         double *x)
{
  klu_l_common common;
  klu_l_defaults(&common);
  klu_l_symbolic *symbolic = klu_l_analyze(n, first, column, &common);
  klu_l_numeric *numeric = klu_l_factor(first, column, value, symbolic, &common);
  assert_non_null(numeric);
  assert_true(klu_l_tsolve(symbolic, numeric, n, 1, x, &common));
  klu_l_free_numeric(&numeric, &common);
  klu_l_free_symbolic(&symbolic, &common);
}

/* One Newton step for the rows and columns of velocity and temperature. */
static double newton(sph_sim *sim, sph_jacobian *J, long from, long n)
{
  SuiteSparse_long *first = test_calloc((size_t)n + 1, sizeof *first), count = 0;
  assert_int_equal(sph_jacobian_evaluate(J), SPH_OK);
  SuiteSparse_long *column = test_calloc((size_t)J->first[J->n], sizeof *column);
  double *value = test_calloc((size_t)J->first[J->n], sizeof *value),
         *x = test_calloc((size_t)n, 8);
  double *y = N_VGetArrayPointer(sim->y), step = 0;
  N_Vector f = N_VClone(sim->y);
  assert_int_equal(sph_sim_rhs(sim->time, sim->y, f, sim), SPH_OK);
  /* unknowns: rows from `from` on, but those of the density */
  long density = sph_jacobian_row(J, sph_sim_group(sim, "oil"), "density", 0), particles = n / 3;
  for (long u = 0; u < n; u++) {
    long r = from + u + (from + u >= density ? particles : 0);
    x[u] = -N_VGetArrayPointer(f)[J->place[r]];
    for (long e = J->first[r]; e < J->first[r + 1]; e++) {
      long c = J->column[e] - from;
      if (c >= 0 && c >= density - from) c -= J->column[e] < density + particles ? n : particles;
      if (c < 0) continue;
      column[count] = c;
      value[count++] = J->value[e];
    }
    first[u + 1] = count;
  }
  solve_by_klu(n, first, column, value, x);
  for (long u = 0; u < n; u++) {
    long r = from + u + (from + u >= density ? particles : 0);
    y[J->place[r]] += x[u];
    step = fmax(step, fabs(x[u]));
  }
  N_VDestroy(f);
  test_free(first), test_free(column), test_free(value), test_free(x);
  return step;
}

static double profile_error(const sph_sim *sim)
{
  const sph_group *oil = sph_sim_group(sim, "oil");
  const double *y = sph_group_read(oil, "position", 1), *v = sph_group_read(oil, "velocity", 0);
  const double *T = sph_group_read(oil, "temperature", 0);
  const double V = force * L * L / (8 * nu), eta = rho0 * nu;
  const double hot = eta * force * force / (nu * nu) * pow(L / 2, 4) / (12 * kappa);
  double worst = 0;
  for (long i = 0; i < sph_group_count(oil); i++) {
    double speed = force * y[i] * (L - y[i]) / (2 * nu), s = (y[i] - L / 2) / (L / 2);
    worst = fmax(worst, fabs(v[i] - speed) / V);
    worst = fmax(worst, fabs(T[i] - T_wall - hot * (1 - s * s * s * s)) / hot);
  }
  return worst;
}

static void steady_flow(void **state)
{
  (void)state;
  double error[2];
  for (int k = 0; k < 2; k++) {
    const int ny = 20 << k;
    sph_sim *sim = channel(ny);
    sph_jacobian *J = sph_jacobian_create(sim, NULL);
    if (!J || sph_jacobian_evaluate(J)) fail_msg("%s", sph_sim_error(sim));
    long from = sph_jacobian_row(J, sph_sim_group(sim, "oil"), "velocity", 0), n = 30L * ny;
    double step[4];
    for (int q = 0; q < 4; q++) step[q] = newton(sim, J, from, n);
    error[k] = profile_error(sim);
    print_message("# %d rows: steps of Newton's method %.2g %.2g %.2g %.2g; error %.3g\n", ny,
                  step[0], step[1], step[2], step[3], error[k]);
    assert_true(step[3] < 1e-9 * step[0]);
    sph_jacobian_free(J);
    sph_sim_free(sim);
  }
  assert_true(error[1] < 0.02 && error[1] < 0.6 * error[0]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(products),
      cmocka_unit_test(entries),
      cmocka_unit_test(steady_flow),
  };
  return cmocka_run_group_tests_name("Jacobian", tests, NULL, NULL);
}
