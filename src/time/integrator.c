/* The loop around one-step calls: limits, retries, records. */
#include "integrator.h"

#include <math.h>
#include <stddef.h>

#include "memory.h"
#include "stepper.h"

struct sph_integrator {
  sph_integrator_def def; /* without zeros: defaults are filled in */
  sph_problem problem;
  sph_method method;
  sph_stepper stepper;
  sph_step_stats stats;
  N_Vector saved;   /* the state before the step */
  int bound;        /* what bound the last step */
  double reduction; /* of the cap, after steps that were not admissible; grows back to 1 */
  double dt_min;
};

static int check_number(const char *name, double value, double least, sph_error *error)
{
  if (isfinite(value) && value >= least) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "integrator: %s = %g; right is a finite number >= %g", name, value, least);
}

int sph_integrator_check(const sph_integrator_def *def, sph_error *error)
{
  sph_method method;
  int status = sph_integrator_table_find(def->method, &method, error);
  if (!status) status = check_number("cfl", def->cfl, 0, error);
  if (!status) status = check_number("tolerance", def->tolerance, -1e300, error);
  if (!status) status = check_number("dt_max", def->dt_max, 0, error);
  if (!status) status = check_number("dt_min", def->dt_min, 0, error);
  if (!status) status = check_number("dt_fixed", def->dt_fixed, 0, error);
  if (!status && def->retries < 0)
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "integrator: retries = %d; right is >= 0",
                           def->retries);
  return status;
}

static void fill_defaults(sph_integrator *in)
{
  sph_integrator_def *def = &in->def;
  if (!in->method.error_control || def->dt_fixed > 0) def->tolerance = -1;
  if (def->tolerance == 0) def->tolerance = 1e-2;
  if (def->cfl == 0) def->cfl = def->tolerance > 0 ? 0.8 : 0.35;
  if (def->dt_max == 0) def->dt_max = INFINITY;
  if (def->retries == 0) def->retries = 12;
  def->method = in->method.name;
}

/* The least of all limits, and which it is. */
static int limit(sph_stepper *s, double *cap, int *bound)
{
  sph_integrator *in = (sph_integrator *)((char *)s - offsetof(sph_integrator, stepper));
  sph_step_limit limits = {{0}};
  for (int k = 0; k < SPH_BOUND_COUNT; k++) limits.dt[k] = INFINITY;
  if (in->problem.limits) {
    int status = in->problem.limits(s->t, s->y, &limits, in->problem.ctx);
    if (status) return status;
  }
  limits.dt[SPH_BOUND_CFL] *= in->def.cfl * in->method.stability;
  limits.dt[SPH_BOUND_USER] = fmin(limits.dt[SPH_BOUND_USER], in->def.dt_max);
  *bound = SPH_BOUND_ERROR;
  *cap = INFINITY;
  for (int k = 0; k < SPH_BOUND_COUNT; k++)
    if (limits.dt[k] < *cap) {
      *cap = limits.dt[k];
      *bound = k;
    }
  if (in->reduction < 1) {
    *cap *= in->reduction;
    *bound = SPH_BOUND_RETRY;
  }
  if (in->def.dt_fixed > 0) {
    *cap = in->def.dt_fixed * in->reduction;
    *bound = in->reduction < 1 ? SPH_BOUND_RETRY : SPH_BOUND_USER;
  }
  return SPH_OK;
}

/* A first step when nothing limits it: small against the stop time. */
static double bounded(double cap, double t, double t_stop)
{
  if (cap < INFINITY) return cap;
  return t_stop < INFINITY ? (t_stop - t) / 100 : 1e-3;
}

sph_integrator *sph_integrator_create(const sph_integrator_def *def, const sph_problem *problem,
                                      double t, N_Vector y, SUNContext context, sph_error *error)
{
  static const sph_integrator_def defaults = {0};
  if (!def) def = &defaults;
  if (sph_integrator_check(def, error)) return NULL;
  sph_integrator *in = SPH_NEW(sph_integrator, 1, "the integrator", error);
  if (!in) return NULL;
  in->def = *def;
  in->problem = *problem;
  if (!in->problem.error) in->problem.error = error;
  in->reduction = 1;
  in->dt_min = def->dt_min;
  in->stats.dt_smallest = INFINITY;
  int status = sph_integrator_table_find(def->method, &in->method, error);
  fill_defaults(in);
  in->stepper = (sph_stepper){.scheme = in->method.scheme,
                              .method = &in->method,
                              .def = &in->def,
                              .problem = &in->problem,
                              .stats = &in->stats,
                              .context = context,
                              .y = y,
                              .t = t,
                              .t_previous = t,
                              .limit = limit};
  in->saved = N_VClone(y);
  if (!in->saved)
    status = sph_error_set(error, SPH_ERR_MEMORY, "out of memory: the state before a step");
  if (!status) status = in->stepper.scheme->create(&in->stepper);
  if (!status) return in;
  sph_integrator_free(in);
  return NULL;
}

void sph_integrator_free(sph_integrator *in)
{
  if (!in) return;
  if (in->stepper.memory) in->stepper.scheme->free(&in->stepper);
  if (in->saved) N_VDestroy(in->saved);
  sph_memory_free(in);
}

static int admissible(sph_integrator *in)
{
  sph_stepper *s = &in->stepper;
  return in->problem.admissible ? in->problem.admissible(s->t, s->y, in->problem.ctx) : SPH_OK;
}

/* One attempt; afterwards (t, y) is the new state, or the old one and the scheme is ready to try again. */
static int attempt(sph_integrator *in, double cap, double t_stop)
{
  sph_stepper *s = &in->stepper;
  double t = s->t, t_previous = s->t_previous;
  int status = s->scheme->step(s, cap, t_stop);
  if (!status) status = admissible(in);
  if (!status) return SPH_OK;
  N_VScale(1, in->saved, s->y);
  s->t = t;
  s->t_previous = t_previous;
  if (status > 0 && s->scheme->reset(s)) status = in->problem.error->status;
  return status;
}

static void record(sph_integrator *in, int bound, double t_stop)
{
  const sph_stepper *s = &in->stepper;
  sph_step_stats *stats = &in->stats;
  double dt = s->t - s->t_previous;
  if (s->error_bound) bound = SPH_BOUND_ERROR;
  if (s->t == t_stop) bound = SPH_BOUND_STOP;
  in->bound = bound;
  stats->bound_by[bound]++;
  stats->steps++;
  stats->dt_last = dt;
  stats->dt_smallest = fmin(stats->dt_smallest, dt);
  stats->dt_largest = fmax(stats->dt_largest, dt);
  in->reduction = fmin(1, 2 * in->reduction);
}

static int give_up(sph_integrator *in, double dt, int halvings)
{
  return sph_error_set(
      in->problem.error, SPH_ERR_STEP,
      "t = %.9g s: no admissible step, the last try was %g s after %d halvings (dt_min = %g s)",
      in->stepper.t, dt, halvings, in->dt_min);
}

int sph_integrator_step(sph_integrator *in, double t_stop)
{
  sph_stepper *s = &in->stepper;
  if (!(t_stop > s->t))
    return sph_error_set(in->problem.error, SPH_ERR_ARGUMENT,
                         "stop time %g s is not after t = %g s", t_stop, s->t);
  N_VScale(1, s->y, in->saved);
  for (int halvings = 0;; halvings++) {
    double cap;
    int bound, status = limit(s, &cap, &bound);
    if (status) return status < 0 ? status : give_up(in, 0, halvings);
    cap = bounded(cap, s->t, t_stop);
    if (in->dt_min == 0) in->dt_min = 1e-9 * cap;
    if (cap < in->dt_min) return give_up(in, cap, halvings);
    if (halvings || in->stats.steps == 0) s->next = halvings ? cap : 0.25 * cap;
    status = attempt(in, cap, t_stop);
    if (status == SPH_OK) {
      record(in, bound, t_stop);
      return SPH_OK;
    }
    if (status < 0) return sph_error_set(in->problem.error, status, "the right-hand side failed");
    in->stats.retries++;
    if (halvings == in->def.retries) return give_up(in, cap, halvings);
    in->reduction *= 0.5;
  }
}

double sph_integrator_time(const sph_integrator *in) { return in->stepper.t; }
double sph_integrator_previous(const sph_integrator *in) { return in->stepper.t_previous; }

int sph_integrator_interpolate(sph_integrator *in, double t, N_Vector at)
{
  sph_stepper *s = &in->stepper;
  if (!(t >= s->t_previous && t <= s->t))
    return sph_error_set(in->problem.error, SPH_ERR_ARGUMENT,
                         "no dense output at t = %g s outside [%g, %g]", t, s->t_previous, s->t);
  if (t == s->t) {
    N_VScale(1, s->y, at);
    return SPH_OK;
  }
  return s->scheme->interpolate(s, t, at);
}

int sph_integrator_reset(sph_integrator *in, double t)
{
  in->stepper.t = in->stepper.t_previous = t;
  return in->stepper.scheme->reset(&in->stepper);
}

const sph_step_stats *sph_integrator_stats(const sph_integrator *in) { return &in->stats; }
int sph_integrator_bound(const sph_integrator *in) { return in->bound; }
