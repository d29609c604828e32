/* Every allocation of Jacobians, eigenvalues, sensitivities and adjoints fails once: told, nothing
 * leaks (under ASan or valgrind), parameters are what they were. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>

#include "failing.h"
#include "sphode.h"
#include "sphode/sundials.h"

/* A puddle with walls, gradients, a body term. */
static sph_sim *puddle(void)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){0.5, 0.3}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_box(floor, (double[]){-0.3, -0.3}, (double[]){0.8, 0}, 1000);
  sph_group_set_boundary(floor, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_harmonic(1));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.dt_fixed = 1e-3});
  return sim;
}

static void eigenvalues(sph_sim *sim)
{
  double re[75], im[75];
  sph_jacobian *J = sph_jacobian_create(sim, NULL);
  if (!sph_jacobian_evaluate(J)) sph_jacobian_eigenvalues(J, 0, re, im);
  sph_jacobian_free(J);
}

static const sph_sensitivity_parameter parameters[] = {{"h", NULL}, {"water.c0", NULL}};

static void forwards(sph_sim *sim)
{
  double value;
  sph_sensitivity *s = sph_sensitivity_create(sim, 2, parameters);
  if (!sph_sensitivity_run(s, 2e-3))
    sph_sensitivity_of_monitor(s, 1,
                               &(sph_monitor){.name = "p", .type = "pressure", .x = {0.2, 0.1}},
                               &value);
  sph_sensitivity_free(s);
}

static double weight(void *ctx, sph_sim *sim)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *p = sph_group_read(water, "pressure", 0);
  double sum = 0;
  (void)ctx;
  for (long i = 0; p && i < sph_group_count(water); i++) sum += p[i];
  return sum;
}

static void weight_gradient(void *ctx, sph_sim *sim, sph_adjoint *adjoint)
{
  const sph_group *water = sph_sim_group(sim, "water");
  double *p = sph_adjoint_gradient(adjoint, water, "pressure", 0);
  (void)ctx;
  for (long i = 0; i < sph_group_count(water); i++) p[i] += 1;
}

static void backwards(sph_sim *sim)
{
  const sph_adjoint_def def = {.functional = {.end = weight, .end_gradient = weight_gradient},
                               .n = 2,
                               .parameters = parameters};
  sph_adjoint *a = sph_adjoint_create(sim, &def);
  sph_adjoint_run(a, 2e-3);
  sph_adjoint_free(a);
}

static void products(sph_sim *sim)
{
  N_Vector y = sph_sim_vector(sim);
  sph_sim_jacobian_transposed_times(y, y, 0, y, y, sim, y);
}

static void every_allocation(void (*act)(sph_sim *sim), const char *what)
{
  long failures = 0;
  for (int failed = 1; failed; failures++) {
    sph_sim *sim = puddle();
    if (!sph_sim_vector(sim)) fail_msg("%s", sph_sim_error(sim));
    const double h = sph_sim_h(sim), c0 = sph_group_eos(sph_sim_group(sim, "water"))->c0;
    fail_at = calls + failures + 1;
    act(sim);
    failed = calls >= fail_at;
    fail_at = 0;
    if (sph_sim_status(sim) != (failed ? SPH_ERR_MEMORY : SPH_OK))
      fail_msg("%s, allocation %ld: %s", what, failures, sph_sim_error(sim));
    assert_true(sph_sim_h(sim) == h && sph_group_eos(sph_sim_group(sim, "water"))->c0 == c0);
    sph_sim_free(sim);
  }
  print_message("# %s: %ld allocations\n", what, failures - 1);
  assert_true(failures > 10);
}

static void all(void **state)
{
  (void)state;
  every_allocation(eigenvalues, "Jacobian and eigenvalues");
  every_allocation(forwards, "sensitivities");
  every_allocation(backwards, "adjoint");
  every_allocation(products, "transposed product");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(all)};
  return cmocka_run_group_tests_name("memory of derivatives", tests, NULL, NULL);
}
