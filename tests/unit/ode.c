#include "ode.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

static int broken(ode *o)
{
  long k = o->calls++ - o->fail_from;
  return o->fail_count && k >= 0 && k < o->fail_count ? o->fail_status : SPH_OK;
}

static int kepler(double t, N_Vector state, N_Vector rate, void *ctx)
{
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate), r = hypot(y[ODE_X], y[ODE_Y]);
  (void)t;
  f[ODE_X] = y[ODE_U];
  f[ODE_Y] = y[ODE_V];
  f[ODE_U] = -y[ODE_X] / (r * r * r);
  f[ODE_V] = -y[ODE_Y] / (r * r * r);
  f[ODE_Q] = 0;
  return broken(ctx);
}

static void kepler_exact(double t, double *y)
{
  (void)t; /* whole periods */
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_Q] = 1;
  y[ODE_X] = 0.7;
  y[ODE_V] = sqrt(1.3 / 0.7);
}

static void made_exact(double t, double *y)
{
  y[ODE_X] = sin(t);
  y[ODE_Y] = cos(t);
  y[ODE_U] = cos(t);
  y[ODE_V] = -sin(t);
  y[ODE_Q] = 2 + sin(2 * t);
}

static int made(double t, N_Vector state, N_Vector rate, void *ctx)
{
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate), e[ODE_LENGTH];
  made_exact(t, e);
  double drag = (pow(y[ODE_U], 3) - pow(e[ODE_U], 3)) * y[ODE_Q];
  double turn = y[ODE_U] * y[ODE_Q] - e[ODE_U] * e[ODE_Q];
  f[ODE_X] = y[ODE_U];
  f[ODE_Y] = y[ODE_V];
  f[ODE_U] = -y[ODE_X] - 0.3 * drag;
  f[ODE_V] = -y[ODE_Y] + 0.5 * turn;
  f[ODE_Q] = 2 * cos(2 * t) + (e[ODE_Q] - y[ODE_Q]) * (1 + y[ODE_X] * y[ODE_V]) +
             0.5 * (y[ODE_V] - e[ODE_V]);
  return broken(ctx);
}

static void drift_exact(double t, double *y)
{
  made_exact(t, y);
  y[ODE_U] -= 0.3 * cos(2 * t);
  y[ODE_V] -= 0.2 * sin(3 * t);
}

static int drift(double t, N_Vector state, N_Vector rate, void *ctx)
{
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate), e[ODE_LENGTH];
  drift_exact(t, e);
  double mix = y[ODE_Y] * y[ODE_Q] - e[ODE_Y] * e[ODE_Q];
  double turn = y[ODE_U] * y[ODE_X] - e[ODE_U] * e[ODE_X];
  f[ODE_X] = y[ODE_U] + 0.3 * cos(2 * t) + 0.4 * mix;
  f[ODE_Y] = y[ODE_V] + 0.2 * sin(3 * t) + 0.5 * turn;
  f[ODE_U] = -sin(t) + 0.6 * sin(2 * t) - (y[ODE_X] - e[ODE_X]) - 0.3 * mix * y[ODE_U];
  f[ODE_V] = -cos(t) - 0.6 * cos(3 * t) - (y[ODE_Y] - e[ODE_Y]) + 0.5 * turn;
  f[ODE_Q] = 2 * cos(2 * t) + (e[ODE_Q] - y[ODE_Q]) * (1 + y[ODE_X] * y[ODE_V]) +
             0.5 * (y[ODE_V] - e[ODE_V]);
  return broken(ctx);
}

static void oscillator_exact(double t, double *y)
{
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_Q] = 1;
  y[ODE_X] = cos(t);
  y[ODE_U] = -sin(t);
}

static int oscillator(double t, N_Vector state, N_Vector rate, void *ctx)
{
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate);
  (void)t;
  N_VConst(0, rate);
  f[ODE_X] = y[ODE_U];
  f[ODE_U] = -y[ODE_X];
  return broken(ctx);
}

static void decay_exact(double t, double *y)
{
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_Q] = exp(-t);
}

static int decay(double t, N_Vector y, N_Vector rate, void *ctx)
{
  (void)t;
  N_VScale(-1, y, rate);
  return broken(ctx);
}

static int weights(N_Vector y, N_Vector weight, void *ctx)
{
  (void)y, (void)ctx;
  N_VConst(1, weight);
  return SPH_OK;
}

static int limits(double t, N_Vector y, sph_step_limit *limit, void *ctx)
{
  const ode *o = ctx;
  (void)y;
  for (int k = 0; k < SPH_BOUND_COUNT; k++)
    if (o->limit[k] > 0) limit->dt[k] = o->limit[k] * (1 + o->breathe * sin(t));
  return SPH_OK;
}

static int admissible(double t, N_Vector y, void *ctx)
{
  ode *o = ctx;
  (void)y;
  if (o->reject_above > 0 && t - o->time > o->reject_above) return SPH_RETRY;
  o->time = t;
  return SPH_OK;
}

static void make(ode *o)
{
  *o = (ode){.fail_status = SPH_RETRY};
  for (int k = 0; k < 5; k++)
    o->segment[k] = (sph_segment){.offset = 8 * k,
                                  .n = 1,
                                  .capacity = 8,
                                  .role = k < 2   ? SPH_ROLE_POSITION
                                          : k < 4 ? SPH_ROLE_VELOCITY
                                                  : SPH_ROLE_DENSITY,
                                  .partner = k < 2 ? k + 2 : -1};
  o->layout = (sph_layout){ODE_LENGTH, 5, 5, o->segment};
  o->context = sph_sundials_context(&o->error);
  o->y = sph_nvector_create(&o->layout, 1, o->context, &o->error);
  assert_non_null(o->y);
  o->problem = (sph_problem){.ctx = o,
                             .threads = 1,
                             .weights = weights,
                             .limits = limits,
                             .admissible = admissible,
                             .error = &o->error};
}

void ode_kepler(ode *o)
{
  make(o);
  o->problem.rhs = kepler;
  o->exact = kepler_exact;
}

void ode_made(ode *o)
{
  make(o);
  o->problem.rhs = made;
  o->exact = made_exact;
}

void ode_drift(ode *o)
{
  make(o);
  o->segment[4].role = SPH_ROLE_OTHER;
  o->problem.drift = 1;
  o->problem.rhs = drift;
  o->exact = drift_exact;
}

void ode_oscillator(ode *o)
{
  make(o);
  o->problem.rhs = oscillator;
  o->exact = oscillator_exact;
}

void ode_decay(ode *o)
{
  make(o);
  o->problem.rhs = decay;
  o->exact = decay_exact;
}

void ode_start(ode *o, const sph_integrator_def *def)
{
  o->exact(0, sph_nvector_data(o->y));
  o->it = sph_integrator_create(def, &o->problem, 0, o->y, o->context, &o->error);
  if (!o->it) fail_msg("no integrator: %s", o->error.text);
}

int ode_run(ode *o, double t)
{
  int status = SPH_OK;
  while (!status && sph_integrator_time(o->it) < t) status = sph_integrator_step(o->it, t);
  return status;
}

void ode_end(ode *o)
{
  sph_integrator_free(o->it);
  N_VDestroy(o->y);
  sph_sundials_context_free(o->context);
}

double ode_error(const ode *o, double t, N_Vector y)
{
  double e[ODE_LENGTH], most = 0;
  o->exact(t, e);
  for (int k = 0; k < ODE_LENGTH; k += 8) most = fmax(most, fabs(sph_nvector_data(y)[k] - e[k]));
  return most;
}
