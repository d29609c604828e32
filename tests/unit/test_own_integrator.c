/* Integrators of the user's own, through sph_integrator_def.own: order, dense output, retries, stop
 * times as with built-in ones; what a scheme sees; refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "ode.h"

static void combine(sph_ode *o, double a, const double *k1, double b, const double *k2)
{
  for (long i = 0; i < o->n; i++) o->y[i] = o->y0[i] + o->h * (a * k1[i] + b * k2[i]);
}

/* Kutta (1901), third order: k1, k2 = f(y + h/2 k1), k3 = f(y - h k1 + 2h k2),
 * y + h/6 (k1 + 4 k2 + k3). */
static int kutta(void *ctx, sph_ode *o)
{
  double *k2 = o->work[0], *k3 = o->work[1];
  int *calls = ctx;
  if (calls) ++*calls;
  combine(o, 0.5, o->f0, 0, o->f0);
  int status = sph_ode_rhs(o, o->t + o->h / 2, o->y, k2);
  if (!status) combine(o, -1, o->f0, 2, k2);
  if (!status) status = sph_ode_rhs(o, o->t1, o->y, k3);
  for (long i = 0; !status && i < o->n; i++)
    o->y[i] = o->y0[i] + o->h / 6 * (o->f0[i] + 4 * k2[i] + k3[i]);
  return status;
}

static const sph_scheme KUTTA = {
    .name = "kutta", .order = 3, .stages = 3, .stability = 1.7, .work = 2, .step = kutta};

/* Largest error at the ends of steps and inside them. */
static double error_of(void (*make)(ode *o), int n, int inside)
{
  ode o;
  double most = 0;
  make(&o);
  ode_start(&o, &(sph_integrator_def){.own = &KUTTA, .dt_fixed = 2.0 / n});
  N_Vector at = N_VClone(o.y);
  while (sph_integrator_time(o.it) < 2) {
    assert_int_equal(sph_integrator_step(o.it, 2), SPH_OK);
    double t0 = sph_integrator_previous(o.it), t1 = sph_integrator_time(o.it);
    double t = inside ? t0 + 0.3 * (t1 - t0) : t1;
    assert_int_equal(sph_integrator_interpolate(o.it, t, at), SPH_OK);
    most = fmax(most, ode_error(&o, t, at));
  }
  assert_int_equal(sph_integrator_stats(o.it)->rhs_evaluations, 3 * n + 1);
  N_VDestroy(at);
  ode_end(&o);
  return most;
}

static void has_its_order(void **state)
{
  (void)state;
  for (int inside = 0; inside < 2; inside++) {
    assert_true(log2(error_of(ode_made, 100, inside) / error_of(ode_made, 200, inside)) > 2.9);
    assert_true(log2(error_of(ode_drift, 100, inside) / error_of(ode_drift, 200, inside)) > 2.9);
  }
}

/* Leapfrog as it is often printed.  HALF: forces see v and q at half the step, order 1 instead of 2
 * where they depend on them.  DOUBLE: positions are moved by h/2 before they are moved by h. */
enum { HALF, DOUBLE };

static int as_printed(void *ctx, sph_ode *o)
{
  const double *y0 = o->y0, h = o->h;
  double *v = o->work[0], *f = o->work[1], *y = o->y;
  int way = *(int *)ctx;
  for (long i = 0; i < o->n; i++) y[i] = v[i] = y0[i] + h / 2 * o->f0[i]; /* half a step */
  for (int k = 0; k < o->segments; k++) {
    const sph_segment *s = &o->segment[k];
    if (s->partner < 0) continue;
    long r = s->offset, u = o->segment[s->partner].offset;
    y[r] = (way == DOUBLE ? y[r] : y0[r]) + h * y[u];
  }
  int status = sph_ode_rhs(o, o->t1, y, f);
  for (int k = 0; !status && k < o->segments; k++) {
    long i = o->segment[k].offset;
    if (o->segment[k].partner < 0) y[i] = v[i] + h / 2 * f[i];
  }
  return status;
}

static double error_as_printed(int way, void (*make)(ode *o), double t, int n)
{
  const sph_scheme scheme = {.name = "printed",
                             .order = 2,
                             .stages = 2,
                             .stability = 0.7,
                             .work = 2,
                             .step = as_printed,
                             .ctx = &way};
  ode o;
  make(&o);
  ode_start(&o, &(sph_integrator_def){.own = &scheme, .dt_fixed = t / n});
  assert_int_equal(ode_run(&o, t), SPH_OK);
  double error = ode_error(&o, t, o.y);
  ode_end(&o);
  return error;
}

static void leapfrog_as_printed_lacks_order(void **state)
{
  (void)state;
  double half[2], twice[2], kepler[2];
  for (int k = 0; k < 2; k++) {
    half[k] = error_as_printed(HALF, ode_made, 2, 1000 << k);
    twice[k] = error_as_printed(DOUBLE, ode_made, 2, 1000 << k);
    kepler[k] = error_as_printed(HALF, ode_kepler, 2 * acos(-1), 1000 << k);
  }
  assert_float_equal(log2(half[0] / half[1]), 1, 0.05);
  assert_float_equal(log2(twice[0] / twice[1]), 0, 0.05);
  assert_float_equal(log2(kepler[0] / kepler[1]), 2, 0.05); /* forces of positions alone */
}

/* What a step is given, in a run with a stop time and a retry. */
typedef struct seen {
  double t[64], h[64], h_last[64];
  long step[64];
  int calls;
  sph_segment segment[5];
} seen;

static int look(void *ctx, sph_ode *o)
{
  seen *s = ctx;
  int k = s->calls++;
  assert_in_range(k, 0, 63);
  assert_int_equal(o->n, ODE_LENGTH);
  assert_int_equal(o->segments, 5);
  assert_memory_equal(o->y, o->y0, ODE_LENGTH * sizeof(double));
  assert_true(o->threads == 1 && o->drift == 1);
  memcpy(s->segment, o->segment, sizeof s->segment);
  if (o->step > 0) assert_true(o->work[2][0] == (double)(o->step - 1)); /* kept */
  s->t[k] = o->t;
  s->h[k] = o->t1 - o->t;
  s->h_last[k] = o->h_last;
  s->step[k] = o->step;
  int status = kutta(NULL, o);
  if (!status) o->work[2][0] = (double)o->step;
  return status;
}

static void is_told_what_it_needs(void **state)
{
  (void)state;
  seen s = {.calls = 0};
  sph_scheme scheme = KUTTA;
  scheme.step = look;
  scheme.work = 3;
  scheme.ctx = &s;
  ode o;
  ode_drift(&o);
  o.limit[SPH_BOUND_USER] = 0.125;
  o.fail_from = 2; /* in the first step */
  o.fail_count = 1;
  ode_start(&o, &(sph_integrator_def){.own = &scheme});
  scheme.name = "changed";
  scheme.step = NULL; /* a copy was made */
  assert_int_equal(ode_run(&o, 0.25), SPH_OK);
  const double h[] = {0.125, 0.0625, 0.125, 0.0625};
  const long step[] = {0, 0, 1, 2};
  assert_int_equal(s.calls, 4);
  for (int k = 0; k < 4; k++) {
    assert_true(s.h[k] == h[k] && s.step[k] == step[k]);
    assert_true(s.h_last[k] == (k < 2 ? 0 : h[k - 1]));
    assert_true(s.t[k] == (k < 2 ? 0 : s.t[k - 1] + h[k - 1]));
  }
  for (int k = 0; k < 5; k++) {
    assert_int_equal(s.segment[k].offset, 8 * k);
    assert_int_equal(s.segment[k].partner, k < 2 ? k + 2 : -1);
  }
  assert_int_equal(s.segment[4].role, SPH_ROLE_OTHER);
  assert_int_equal(sph_integrator_stats(o.it)->retries, 1);
  assert_int_equal(sph_integrator_reset(o.it, 0.25), SPH_OK);
  assert_int_equal(ode_run(&o, 0.375), SPH_OK);
  assert_true(s.step[4] == 0 && s.h_last[4] == 0);
  ode_end(&o);
}

enum { SAME = 1, FOREIGN, START, NOTHING, DEAF, FAILS };

/* One step that goes wrong in the way of ctx. */
static int wrong(void *ctx, sph_ode *o)
{
  double mine[ODE_LENGTH] = {0};
  switch (*(int *)ctx) {
  case SAME: return sph_ode_rhs(o, o->t, o->y, o->y);
  case FOREIGN: return sph_ode_rhs(o, o->t, mine, o->f1);
  case START: return sph_ode_rhs(o, o->t, o->y, (double *)o->f0);
  case NOTHING: return sph_ode_rhs(o, o->t, NULL, NULL);
  case DEAF: sph_ode_rhs(o, o->t, o->y, o->f1); return SPH_OK; /* deaf to the status */
  default: return SPH_ERR_FILE;
  }
}

static void errors_inside_a_step_are_told(void **state)
{
  (void)state;
  for (int way = SAME; way <= FAILS; way++) {
    const sph_scheme scheme = {
        .name = "bad", .order = 1, .stages = 2, .stability = 1, .step = wrong, .ctx = &way};
    ode o;
    ode_made(&o);
    o.fail_from = way == DEAF; /* all but the first evaluation */
    o.fail_count = way == DEAF ? 1000 : 0;
    ode_start(&o, &(sph_integrator_def){.own = &scheme, .dt_max = 0.1, .retries = 3});
    int status = way == DEAF ? SPH_ERR_STEP : way == FAILS ? SPH_ERR_FILE : SPH_ERR_ARGUMENT;
    assert_int_equal(ode_run(&o, 1), status);
    assert_non_null(strstr(o.error.text, "bad"));
    assert_true(sph_integrator_time(o.it) == 0 && ode_error(&o, 0, o.y) == 0);
    ode_end(&o);
  }
  double a[8] = {0};
  assert_int_equal(sph_ode_rhs(NULL, 0, a, a), SPH_ERR_ARGUMENT);
}

static void refused(sph_scheme scheme, sph_integrator_def def, const char *word)
{
  sph_error error = {0};
  def.own = &scheme;
  assert_int_equal(sph_integrator_check(&def, &error), SPH_ERR_ARGUMENT);
  if (!strstr(error.text, word)) fail_msg("\"%s\" lacks \"%s\"", error.text, word);
}

static void incomplete_ones_are_refused(void **state)
{
  char name[65];
  (void)state;
  memset(name, 'x', 64);
  name[64] = 0;
  const sph_integrator_def def = {.cfl = 0};
  sph_scheme s = KUTTA;
  refused(s, (sph_integrator_def){.method = "leapfrog"}, "right is one of both");
  refused(s, (sph_integrator_def){.tolerance = 1e-3}, "no error estimate");
  const char *const names[] = {NULL, "", name, "verlet"};
  const char *const names_text[] = {"missing", "missing", "longer than 63", "a built-in one has"};
  for (int k = 0; k < 4; k++, s = KUTTA) s.name = names[k], refused(s, def, names_text[k]);
  s.step = NULL;
  refused(s, def, "no step");
  s = KUTTA, s.order = 0;
  refused(s, def, "order 0");
  s = KUTTA, s.stages = -1;
  refused(s, def, "stages -1");
  const double limits[] = {0, -1, NAN, INFINITY};
  const char *const limits_text[] = {"stability 0", "stability -1", "stability nan",
                                     "stability inf"};
  s = KUTTA;
  for (int k = 0; k < 4; k++) s.stability = limits[k], refused(s, def, limits_text[k]);
  s = KUTTA;
  for (int k = -1; k < 18; k += 18) s.work = k, refused(s, def, k < 0 ? "work -1" : "work 17");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(has_its_order),
      cmocka_unit_test(leapfrog_as_printed_lacks_order),
      cmocka_unit_test(is_told_what_it_needs),
      cmocka_unit_test(errors_inside_a_step_are_told),
      cmocka_unit_test(incomplete_ones_are_refused),
  };
  return cmocka_run_group_tests_name("own integrator", tests, NULL, NULL);
}
