/* Every allocation of vectors and integrators fails once: it is told, and nothing leaks (under
 * ASan or valgrind). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "failing.h"
#include "integrator.h"
#include "nvector.h"

static int decay(double t, N_Vector y, N_Vector rate, void *ctx)
{
  (void)t, (void)ctx;
  N_VScale(-1, y, rate);
  return SPH_OK;
}

/* Seven tenths of it are implicit or fast; none is a position. */
static int decay_piece(int piece, double t, N_Vector y, N_Vector rate, void *ctx)
{
  static const double part[] = {0.3, 0.7, 0.7, 0, 1};
  (void)t, (void)ctx;
  N_VScale(-part[piece], y, rate);
  return SPH_OK;
}

static int dominant(double t, N_Vector y, double *lambda, void *ctx)
{
  (void)t, (void)y, (void)ctx;
  *lambda = 1;
  return SPH_OK;
}

static int solve(sph_stage *stage, void *ctx)
{
  (void)ctx;
  N_VScale(1 / (1 + 0.7 * stage->gamma), stage->known, stage->z);
  return SPH_OK;
}

static int weights(N_Vector y, N_Vector weight, void *ctx)
{
  (void)y, (void)ctx;
  N_VConst(1, weight);
  return SPH_OK;
}

/* y' = -y to t = 1; the status of whatever failed. */
static int run(const sph_integrator_def *def)
{
  sph_segment segment = {.n = 3, .capacity = 8, .role = SPH_ROLE_OTHER, .partner = -1};
  const sph_layout layout = {8, 3, 1, &segment};
  sph_error error = {0};
  const sph_problem problem = {.threads = 1,
                               .rhs = decay,
                               .rhs_piece = decay_piece,
                               .solve = solve,
                               .dominant = dominant,
                               .weights = weights,
                               .error = &error};
  SUNContext context = sph_sundials_context(&error);
  N_Vector y = sph_nvector_create(&layout, 1, context, &error);
  sph_integrator *it = NULL;
  int status = error.status;
  if (y) {
    N_VConst(1, y);
    it = sph_integrator_create(def, &problem, 0, y, context, &error);
    status = error.status;
  }
  while (it && !status && sph_integrator_time(it) < 1) status = sph_integrator_step(it, 1);
  if (!status && !(fabs(sph_nvector_data(y)[2] - exp(-1)) < 1e-2)) status = SPH_RETRY;
  assert_int_equal(error.status, status);
  assert_true(status == SPH_OK || error.text[0]);
  sph_integrator_free(it);
  if (y) N_VDestroy(y);
  sph_sundials_context_free(context);
  return status;
}

static int heun(void *ctx, sph_ode *o)
{
  (void)ctx;
  for (long i = 0; i < o->n; i++) o->y[i] = o->y0[i] + o->h * o->f0[i];
  int status = sph_ode_rhs(o, o->t1, o->y, o->work[1]);
  for (long i = 0; !status && i < o->n; i++)
    o->y[i] = o->y0[i] + o->h / 2 * (o->f0[i] + o->work[1][i]);
  return status;
}

static void each_allocation_fails_once(void **state)
{
  static const sph_scheme own = {
      .name = "own", .order = 2, .stages = 2, .stability = 1, .work = 2, .step = heun};
  static const sph_integrator_def def[] = {{.method = "leapfrog", .dt_max = 0.05},
                                           {.method = "dkd", .dt_max = 0.05},
                                           {.method = "predictor-corrector", .dt_max = 0.05},
                                           {.method = "midpoint", .dt_max = 0.05},
                                           {.method = "symplectic", .dt_max = 0.05},
                                           {.method = "verlet-dual", .dt_max = 0.05},
                                           {.own = &own, .dt_max = 0.05},
                                           {.dt_max = 0.05},
                                           {.tolerance = -1, .dt_max = 0.05},
                                           {.method = "imex:ark324l2sa-4-2-3"},
                                           {.method = "imex:ark436l2sa-6-3-4", .dt_fixed = 0.1},
                                           {.method = "erk:zonneveld-5-3-4"},
                                           {.method = "erk:rdpk3sp35-5-2-3"},
                                           {.method = "erk:rdpk3spfsal49-10-3-4", .dt_max = 0.05},
                                           {.method = "mri:kw3", .dt_max = 0.05},
                                           {.method = "mri:erk33a", .dt_max = 0.05, .fast_step = 1},
                                           {.method = "mri:merk32", .dt_max = 0.05},
                                           {.method = "sprk:mclachlan-4-4", .dt_max = 0.05},
                                           {.method = "lsrk:rkc-2", .dt_max = 0.05},
                                           {.method = "lsrk:ssp-4-3", .dt_max = 0.05}};
  (void)state;
  for (size_t k = 0; k < sizeof def / sizeof *def; k++) {
    sph_error error = {0};
    if (sph_integrator_check(&def[k], &error) == SPH_ERR_UNBUILT) {
      print_message("# skipped: %s\n", error.text);
      continue;
    }
    fail_at = calls = 0;
    assert_int_equal(run(&def[k]), SPH_OK);
    long all = calls;
    assert_true(all >= 10);
    for (fail_at = 1; fail_at <= all; fail_at++) {
      calls = 0;
      assert_int_equal(run(&def[k]), SPH_ERR_MEMORY);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_allocation_fails_once)};
  return cmocka_run_group_tests_name("integrator_memory", tests, NULL, NULL);
}
