/* sphode/sundials.h: a simulation as a system of ODEs for somebody else's solver. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "sphode.h"
#include "sphode/sundials.h"

static sph_sim *square(double *vx)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *group = sph_group_box(sim, "square", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(group, sph_eos_tait(1000, 10, 7));
  double *v = sph_group_write(group, "velocity", 0);
  for (long i = 0; v && i < sph_group_count(group); i++) v[i] = *vx * (double)(i % 7);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  return sim;
}

/* The rates through the door are those of sph_sim_evaluate, bit by bit; dx/dt is v. */
static void rates(void **state)
{
  (void)state;
  double vx = 0.3;
  sph_sim *sim = square(&vx);
  N_Vector y = sph_sim_vector(sim), ydot = N_VClone(y);
  assert_non_null(ydot);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  assert_int_equal(sph_sim_rhs(0, y, ydot, sim), SPH_OK);
  const sph_group *group = sph_sim_group(sim, "square");
  const double *start = sph_group_rate(group, "position", 0), *data = N_VGetArrayPointer(ydot);
  long n = sph_group_count(group);
  assert_memory_equal(data, start, (size_t)n * sizeof *data);
  assert_memory_equal(start, sph_group_read(group, "velocity", 0), (size_t)n * sizeof *data);
  double a = 0;
  for (long i = 0; i < n; i++) a += fabs(sph_group_rate(group, "velocity", 0)[i]);
  assert_true(fabs(N_VMaxNorm(ydot)) > 0 && a >= 0);
  N_VDestroy(ydot);
  sph_sim_free(sim);
}

/* Each term is in its part, and f is the sum of the parts: gravity alone is fast, dv_y/dt = -g. */
static void parts(void **state)
{
  (void)state;
  double vx = 0.3, g = 9.81;
  sph_sim *sim = square(&vx);
  sph_group_set_viscosity(sph_sim_group(sim, "square"), 5);
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_gravity((double[]){0, -g, 0}));
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  sph_sim_set_part(sim, "gravity", "fast");
  N_Vector y = sph_sim_vector(sim), f = N_VClone(y), sum = N_VClone(y), part = N_VClone(y);
  const sph_group *group = sph_sim_group(sim, "square");
  long n = sph_group_count(group);
  const double *own = N_VGetArrayPointer(y);
  const double *a =
      N_VGetArrayPointer(part) + (sph_group_read(group, "velocity", 1) - own); /* dv_y/dt */
  assert_int_equal(sph_sim_rhs(0, y, f, sim), 0);
  assert_int_equal(sph_sim_rhs_explicit(0, y, sum, sim), 0);
  assert_int_equal(sph_sim_rhs_implicit(0, y, part, sim), 0);
  assert_true(N_VMaxNorm(part) > 0);
  N_VLinearSum(1, part, 1, sum, sum);
  assert_int_equal(sph_sim_rhs_fast(0, y, part, sim), 0);
  for (long i = 0; i < n; i++) assert_true(a[i] == -g);
  assert_true(N_VMaxNorm(part) == g);
  N_VLinearSum(1, part, 1, sum, sum);
  N_VLinearSum(1, f, -1, sum, sum);
  assert_true(N_VMaxNorm(sum) <= 1e-13 * N_VMaxNorm(f));
  N_VDestroy(f);
  N_VDestroy(sum);
  N_VDestroy(part);
  sph_sim_free(sim);
}

/* The stage that was solved for is met by the implicit part; without one z = known. */
static void stages(void **state)
{
  (void)state;
  double vx = 0.3, gamma = 0.05;
  sph_sim *sim = square(&vx);
  sph_group_set_viscosity(sph_sim_group(sim, "square"), 50);
  sph_sim_add_term(sim, sph_term_viscosity_laminar("mcg"));
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  N_Vector known = sph_sim_vector(sim), z = N_VClone(known), f = N_VClone(known);
  N_VScale(1, known, z);
  assert_int_equal(sph_sim_solve(sim, 0, gamma, 1e-10, known, z), 0);
  assert_int_equal(sph_sim_rhs_implicit(0, z, f, sim), 0);
  N_VLinearSum(1, z, -gamma, f, f);
  N_VLinearSum(1, f, -1, known, f); /* z - gamma f(z) - known */
  N_VLinearSum(1, z, -1, known, z); /* and that is not zero everywhere */
  assert_true(N_VMaxNorm(z) > 0.01 && N_VMaxNorm(f) < 1e-8);
  assert_string_equal(sph_sim_retry_reason(sim), "");
  N_Vector of[] = {z, known};
  for (int k = 0; k < 2; k++) {
    double *first = N_VGetArrayPointer(of[k]), right = *first;
    *first = NAN;
    assert_true(sph_sim_solve(sim, 0, gamma, 1e-10, known, z) > 0);
    assert_non_null(strstr(sph_sim_retry_reason(sim), k ? "number of known" : "number of z"));
    *first = right;
  }
  assert_int_equal(sph_sim_status(sim), SPH_OK);
  assert_true(sph_sim_solve(sim, 0, -gamma, 1e-10, known, z) < 0);
  assert_non_null(strstr(sph_sim_error(sim), "gamma = -0.05 s"));
  N_VDestroy(z);
  N_VDestroy(f);
  sph_sim_free(sim);
  sim = square(&vx);
  known = sph_sim_vector(sim), z = N_VClone(known);
  assert_int_equal(sph_sim_solve(sim, 0, gamma, 1e-10, known, z), 0);
  N_VLinearSum(1, z, -1, known, z);
  assert_true(N_VMaxNorm(z) == 0);
  assert_true(sph_sim_solve(sim, 0, gamma, 1e-10, known, NULL) < 0);
  N_VDestroy(z);
  sph_sim_free(sim);
}

static void numbers_of_stages(void **state)
{
  (void)state;
  const double bad[][3] = {{0, INFINITY, 1e-6}, {0, NAN, 1e-6}, {0, 0, 1e-6},
                           {NAN, 0.05, 1e-6},   {0, 0.05, NAN}, {INFINITY, 0.05, 1},
                           {0, 0.05, 0}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    double vx = 0;
    sph_sim *sim = square(&vx);
    N_Vector known = sph_sim_vector(sim), z = N_VClone(known);
    N_VScale(1, known, z);
    assert_int_equal(sph_sim_solve(sim, bad[k][0], bad[k][1], bad[k][2], known, z),
                     SPH_ERR_ARGUMENT);
    assert_non_null(strstr(sph_sim_error(sim), "sph_sim_solve: t = "));
    N_VDestroy(z);
    sph_sim_free(sim);
  }
}

/* Not admissible: > 0 and no error that sticks; a failed simulation has no vector. */
static void refusals(void **state)
{
  (void)state;
  double vx = 0;
  sph_sim *sim = square(&vx);
  N_Vector y = sph_sim_vector(sim), bad = N_VClone(y), ydot = N_VClone(y);
  N_VConst(-1, bad);
  assert_true(sph_sim_rhs(0, bad, ydot, sim) > 0);
  assert_true(sph_sim_retry_reason(sim)[0]);
  assert_int_equal(sph_sim_status(sim), SPH_OK);
  N_VDestroy(bad);
  N_VDestroy(ydot);
  sph_sim_free(sim);
  assert_null(sph_sim_vector(NULL));
  sim = sph_sim_create(&(sph_sim_def){.dim = 4});
  assert_null(sph_sim_vector(sim));
  sph_sim_free(sim);
}

/* All weights are positive and those of a field are equal. */
static void weights(void **state)
{
  (void)state;
  double vx = 1;
  sph_sim *sim = square(&vx);
  N_Vector y = sph_sim_vector(sim), w = N_VClone(y);
  assert_int_equal(sph_sim_weights(y, w, sim), 0);
  assert_true(N_VMin(w) > 0);
  assert_true(N_VGetArrayPointer(w)[0] == 1 / sph_sim_h(sim));
  N_VDestroy(w);
  sph_sim_free(sim);
}

/* A state from elsewhere is shown like the simulation's own: its pressure, its time, and runs go on
 * from it; particles have moved by more than the lists bear. */
static void state_from_elsewhere(void **state)
{
  (void)state;
  double vx = 0.02, t = 0.05;
  sph_sim *a = square(&vx), *b = square(&vx);
  const sph_integrator_def fixed = {.dt_fixed = 2e-3}; /* else a's first step anew knows its last */
  sph_sim_set_integrator(a, &fixed), sph_sim_set_integrator(b, &fixed);
  assert_int_equal(sph_sim_run(a, t), SPH_OK);
  N_Vector y = sph_sim_vector(a), copy = N_VClone(sph_sim_vector(b));
  double *plain = calloc((size_t)N_VGetLength(y), sizeof *plain);
  assert_non_null(plain);
  N_VBufPack(y, plain);
  N_VBufUnpack(copy, plain);
  assert_int_equal(sph_sim_set_vector(b, t, copy), SPH_OK);
  assert_true(sph_sim_time(b) == t);
  const sph_group *of_a = sph_sim_group(a, "square"), *of_b = sph_sim_group(b, "square");
  size_t bytes = (size_t)sph_group_count(of_a) * sizeof(double);
  assert_memory_equal(sph_group_read(of_a, "position", 0), sph_group_read(of_b, "position", 0),
                      bytes);
  assert_memory_equal(sph_group_read(of_a, "pressure", 0), sph_group_read(of_b, "pressure", 0),
                      bytes);
  sph_sim_changed(a); /* it starts anew from there, like b */
  if (sph_sim_step(a)) fail_msg("%s", sph_sim_error(a));
  assert_int_equal(sph_sim_step(b), SPH_OK);
  assert_true(sph_sim_time(b) > t && sph_sim_time(a) == sph_sim_time(b));
  assert_memory_equal(sph_group_read(of_a, "velocity", 0), sph_group_read(of_b, "velocity", 0),
                      bytes);
  N_VDestroy(copy);
  free(plain);
  assert_true(sph_sim_set_vector(b, NAN, sph_sim_vector(b)) < 0);
  assert_non_null(strstr(sph_sim_error(b), "t = nan s, y given"));
  assert_true(sph_sim_set_vector(a, 1, NULL) < 0);
  assert_true(sph_sim_set_vector(NULL, 1, NULL) < 0);
  sph_sim_free(a);
  sph_sim_free(b);
}

/* What a solver evaluates elsewhere is not what the simulation shows. */
static void evaluations_elsewhere(void **state)
{
  (void)state;
  double vx = 0.3;
  sph_sim *sim = square(&vx);
  const sph_group *group = sph_sim_group(sim, "square");
  N_Vector y = sph_sim_vector(sim), beside = N_VClone(y), out = N_VClone(y);
  const size_t n = (size_t)sph_group_count(group);
  N_VScale(1.001, y, beside);
  N_VConst(0, out);
  for (int k = 0; k < 4; k++) {
    double *pressure = calloc(n, sizeof *pressure);
    assert_non_null(pressure);
    memcpy(pressure, sph_group_read(group, "pressure", 0), n * sizeof *pressure);
    int status = k == 0   ? sph_sim_rhs(0, beside, out, sim)
                 : k == 1 ? sph_sim_rhs_explicit(0, beside, out, sim)
                 : k == 2 ? sph_sim_jacobian_times(y, out, 0, beside, NULL, sim, NULL)
                          : sph_sim_jacobian_transposed_times(y, out, 0, beside, NULL, sim, NULL);
    assert_int_equal(status, 0);
    assert_memory_equal(sph_group_read(group, "pressure", 0), pressure, n * sizeof *pressure);
    free(pressure);
  }
  N_VDestroy(beside), N_VDestroy(out);
  sph_sim_free(sim);
}

/* Vectors of another kind, of a smaller simulation, none. */
static void foreign_vectors(void **state)
{
  (void)state;
  double vx = 0;
  sph_sim *small = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.5});
  sph_group *few = sph_group_box(small, "few", (double[]){0}, (double[]){1}, 1000);
  sph_group_set_eos(few, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(small, sph_term_pressure());
  N_Vector of_small = sph_sim_vector(small), other = N_VNewEmpty(of_small->sunctx);
  N_Vector bad[] = {NULL, other, of_small};
  for (int k = 0; k < 3; k++)
    for (int call = 0; call < 7; call++) {
      sph_sim *sim = square(&vx);
      N_Vector y = sph_sim_vector(sim), good = N_VClone(y);
      int status = call == 0   ? sph_sim_rhs(0, bad[k], good, sim)
                   : call == 1 ? sph_sim_rhs_fast(0, y, bad[k], sim)
                   : call == 2 ? sph_sim_jacobian_times(bad[k], good, 0, y, NULL, sim, NULL)
                   : call == 3 ? sph_sim_jacobian_times_implicit(y, bad[k], 0, y, NULL, sim, NULL)
                   : call == 4
                       ? sph_sim_jacobian_transposed_times(y, good, 0, bad[k], NULL, sim, NULL)
                   : call == 5 ? sph_sim_solve(sim, 0, 1, 1e-6, y, bad[k])
                               : sph_sim_set_vector(sim, 0, bad[k]);
      assert_int_equal(status, SPH_ERR_ARGUMENT);
      if (k || call < 5) assert_non_null(strstr(sph_sim_error(sim), "none of this simulation"));
      N_VDestroy(good);
      sph_sim_free(sim);
    }
  N_VFreeEmpty(other);
  sph_sim_free(small);
}

/* Viscosity is linear in the velocities: what it makes of them is its derivative times them. */
static void implicit_products(void **state)
{
  (void)state;
  double vx = 0.3;
  sph_sim *sim = square(&vx);
  sph_group *group = sph_sim_group(sim, "square");
  sph_group_set_viscosity(group, 5);
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_set_part(sim, "viscosity-laminar", "implicit");
  N_Vector y = sph_sim_vector(sim), v = N_VClone(y), f = N_VClone(y), Jv = N_VClone(y);
  long at = sph_group_read(group, "velocity", 0) - N_VGetArrayPointer(y);
  N_VConst(0, v);
  for (long i = at; i < at + sph_group_count(group); i++)
    N_VGetArrayPointer(v)[i] = N_VGetArrayPointer(y)[i];
  assert_int_equal(sph_sim_rhs_implicit(0, y, f, sim), 0);
  assert_int_equal(sph_sim_jacobian_times_implicit(v, Jv, 0, y, f, sim, NULL), 0);
  N_VLinearSum(1, f, -1, Jv, Jv);
  assert_true(N_VMaxNorm(f) > 0.1 && N_VMaxNorm(Jv) < 1e-13 * N_VMaxNorm(f));
  N_VDestroy(v), N_VDestroy(f), N_VDestroy(Jv);
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(rates),
                                     cmocka_unit_test(evaluations_elsewhere),
                                     cmocka_unit_test(implicit_products),
                                     cmocka_unit_test(foreign_vectors),
                                     cmocka_unit_test(parts),
                                     cmocka_unit_test(stages),
                                     cmocka_unit_test(numbers_of_stages),
                                     cmocka_unit_test(refusals),
                                     cmocka_unit_test(weights),
                                     cmocka_unit_test(state_from_elsewhere)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
