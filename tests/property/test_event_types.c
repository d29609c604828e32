/* Events: what some types look at. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "near.h"
#include "sphode.h"

static const double dx = 0.1; /* [m] */

static long count_of(const sph_sim *sim, int k, double *first, double *last)
{
  sph_event_info info = {0};
  assert_int_equal(sph_sim_event_get(sim, k, &info), 1);
  if (first) *first = info.first;
  if (last) *last = info.last;
  return info.count;
}

static void good(sph_sim *sim, int status)
{
  if (status) fail_msg("%s", sph_sim_error(sim));
}

/* A uniform stream through a periodic box: its points stay wet, whatever went by and wherever they
 * are, and have its pressure. */
static void points_of_periodic_boxes(void **state)
{
  (void)state;
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .periodic = {1, 1}, .length = {1, 1}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  double *v = sph_group_write(water, "velocity", 0), *rho = sph_group_write(water, "density", 0);
  for (long i = 0; i < sph_group_count(water); i++) v[i] = 1, rho[i] = 1010;
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  for (int k = 0; k < 2; k++)
    sph_sim_add_event(sim, &(sph_event){.name = k ? "dry" : "wet",
                                        .type = k ? "dry" : "wet",
                                        .x = {0.02, 0.98}});
  for (int k = 0; k < 5; k++) {
    const sph_monitor at = {.name = "p",
                            .type = "pressure",
                            .x = {0.02, 0.98},
                            .extent = {0.1 * k, 0.1 * k}};
    double value;
    good(sim, sph_sim_run(sim, 0.65 * k));
    good(sim, sph_monitor_value(&at, sim, &value, &(sph_error){0}));
    assert_near(value, sph_group_read(water, "pressure", 0)[0], 1e-6 * value);
    assert_true(value > 1000);
  }
  assert_int_equal(count_of(sim, 0, NULL, NULL) + count_of(sim, 1, NULL, NULL), 0);
  sph_sim_free(sim);
}

static int drag(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) s->a[0][i] -= 3 * s->v[0][i];
  return SPH_OK;
}

static int nothing(void *ctx, sph_sim *sim)
{
  (void)ctx, (void)sim;
  return SPH_OK;
}

/* v = V e^(-3t): of two velocities and a density one rate, 3 V e^(-3t), is not zero.  The moment
 * may lie in the first step behind another event's change, at 0.41356 s of steps of 1 ms. */
static void steady(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    const double V = 1, rate = 0.5, rest = log(3 * V / rate / sqrt(3)) / 3;
    double first;
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx});
    sph_group *block = sph_group_box(sim, "block", (double[]){0, 1}, (double[]){0.4, 1.4}, 1000);
    sph_group_set_eos(block, sph_eos_tait(1000, 10, 7));
    double *v = sph_group_write(block, "velocity", 0);
    for (long i = 0; i < sph_group_count(block); i++) v[i] = V;
    sph_sim_add_term(sim, sph_term_continuity());
    sph_sim_add_term(sim, sph_term_pressure());
    sph_sim_add_term(sim, (sph_term){.name = "drag", .body = drag});
    const char *name = k % 2 ? "predictor-corrector" : "erk:zonneveld-5-3-4";
    sph_sim_set_integrator(sim, &(sph_integrator_def){.method = name, .dt_fixed = 1e-3});
    sph_sim_add_event(sim,
                      &(sph_event){.name = "rest", .type = "steady", .threshold = rate, .stop = 1});
    if (k > 1)
      sph_sim_add_event(sim, &(sph_event){.name = "cut",
                                          .type = "time",
                                          .threshold = rest - 6e-4,
                                          .change = nothing});
    good(sim, sph_sim_run(sim, 10));
    assert_int_equal(count_of(sim, 0, &first, NULL), 1);
    assert_near(first, rest, 1e-6);
    sph_sim_free(sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_of_periodic_boxes),
      cmocka_unit_test(steady),
  };
  return cmocka_run_group_tests_name("types of events", tests, NULL, NULL);
}
