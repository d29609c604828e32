/* Every allocation of a small simulation fails once, from sph_sim_create to the end of the run:
 * SPH_ERR_MEMORY every time, no crash, no leak (under ASan or valgrind), and what was attached is
 * let go of exactly once. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <math.h>

#include "failing.h"
#include "sphode.h"

/* ---- things of the user, with counters of how often they were let go of ---- */

enum { TERM, EOS, BOUNDARY, OUTPUT, OWNED };
static int let_go[OWNED];
static void count(void *ctx) { (*(int *)ctx)++; }

static int push(const sph_term *term, const sph_particles *particles)
{
  (void)term;
  for (long i = 0; i < particles->n; i++) particles->a[0][i] += 0.1;
  return SPH_OK;
}

static void slide(void *ctx, double t, double displacement[3], double velocity[3],
                  double acceleration[3])
{
  (void)ctx, (void)displacement, (void)acceleration;
  velocity[0] = 0.1 * t;
}

static int frame(void *ctx, sph_sim *sim, sph_error *error)
{
  (void)ctx, (void)sim, (void)error;
  return SPH_OK;
}

typedef struct variant {
  const char *method, *neighbors;
  int periodic, thermal;
} variant;

static int attach_and_run(sph_sim *sim, const variant *v)
{
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 0.5}, 1000);
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_layers(floor, (double[]){0, 0}, (double[]){1, 0.8}, v->periodic ? "x- x+ y+" : "y+",
                       1000);
  sph_eos eos = v->thermal ? sph_eos_ideal_gas(1.4) : sph_eos_tait(1000, 20, 7);
  eos.ctx = &let_go[EOS], eos.free = count;
  sph_group_set_eos(water, eos);
  sph_boundary boundary = sph_boundary_adami_no_slip();
  boundary.motion = slide, boundary.ctx = &let_go[BOUNDARY], boundary.free = count;
  sph_group_set_boundary(floor, boundary);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  if (!v->thermal) sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  if (v->thermal) sph_sim_add_term(sim, sph_term_conductivity_artificial(1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -9.81, 0}));
  sph_sim_add_term(sim, (sph_term){"push", .body = push, .ctx = &let_go[TERM], .free = count});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = v->method});
  sph_sim_add_output(sim, (sph_output){"nothing", 0.002, .frame = frame, .ctx = &let_go[OUTPUT],
                                       .free = count});
  long n = sph_group_count(water);
  double *u = v->thermal ? sph_group_write(water, "energy", 0) : NULL;
  for (long i = 0; u && i < n; i++) u[i] = 100;
  if (!v->thermal) sph_group_set_hydrostatic(water, 1, 0.5, 9.81);
  int status = sph_sim_run(sim, 0.01);
  if (status == SPH_OK) status = sph_sim_step(sim);
  if (status == SPH_OK) status = sph_sim_evaluate(sim);
  return status;
}

static int simulate(const variant *v, char *text, size_t size)
{
  memset(let_go, 0, sizeof let_go);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = 0.1,
                                               .threads = 2,
                                               .neighbors = v->neighbors,
                                               .periodic = {v->periodic},
                                               .length = {v->periodic}});
  int status = attach_and_run(sim, v);
  snprintf(text, size, "%s", sph_sim_error(sim));
  sph_sim_free(sim);
  return status;
}

static void each_allocation_fails(const variant *v)
{
  char text[1000];
  fail_at = 0, calls = 0;
  if (simulate(v, text, sizeof text) != SPH_OK) fail_msg("%s", text);
  long all = calls;
  for (fail_at = 1; fail_at <= all; fail_at++) {
    calls = 0;
    int status = simulate(v, text, sizeof text);
    if (status != SPH_ERR_MEMORY)
      fail_msg("allocation %ld of %ld fails: status %d, \"%s\"", fail_at, all, status, text);
    if (!strstr(text, "memory")) fail_msg("allocation %ld: \"%s\"", fail_at, text);
    for (int k = 0; k < OWNED; k++)
      if (let_go[k] != 1)
        fail_msg("allocation %ld of %ld fails (%s): thing %d let go of %d times", fail_at, all,
                 text, k, let_go[k]);
  }
  print_message("# %s: %ld allocations\n", v->method, all);
  assert_true(all > 50);
}

static void all(void **state)
{
  (void)state;
  static const variant variants[] = {
      {"erk:bogacki-shampine-4-2-3", NULL, 0, 0},
      {"leapfrog", "brute-force", 1, 0},
      {"verlet", NULL, 1, 1},
  };
  for (int k = 0; k < 3; k++) each_allocation_fails(&variants[k]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(all)};
  return cmocka_run_group_tests_name("out of memory", tests, NULL, NULL);
}
