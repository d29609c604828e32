/* The loop over steps: limits, attempts, retries, stop times, statistics. */
#include "integrator.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fast.h"
#include "integrator_data.h"
#include "integrator_table.h"
#include "memory.h"
#include "nvector.h"
#include "relax.h"

static const double CLOSE = 1e-6; /* relative: such step sizes are the same */
/* A run whose steps have become so much shorter than the first limit that there was has blown up:
 * far below what an impact asks for. */
static const double BLOWN_UP = 1e-5;
enum { SMALL_STEPS = 20 };

int sph_integrator_info_get(int k, sph_integrator_info *info)
{
  return info ? sph_integrator_table_info(k, info) : 0;
}

int sph_integrator_missing_get(int k, sph_integrator_missing *missing)
{
  return missing ? sph_integrator_table_missing(k, missing) : 0;
}

static int check_value(const char *name, double value, const char *right, int good,
                       sph_error *error)
{
  if (good && isfinite(value)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "integrator: %s = %g; right is %s", name, value,
                       right);
}

/* Is a scheme of the user's own complete? */
static int check_scheme(const sph_integrator_def *def, sph_error *error)
{
  const sph_scheme *own = def->own;
  const char *name = own->name ? own->name : "", *wrong = NULL;
  sph_error unknown = {0};
  if (def->method)
    wrong = "method is set, too; right is one of both";
  else if (!*name || strlen(name) >= SPH_SCHEME_NAME_MAX)
    wrong = "its name is missing or longer than 63 letters";
  else if (sph_integrator_table_find(name, &unknown) >= 0)
    wrong = "a built-in one has that name";
  else if (!own->step)
    wrong = "it has no step (NULL)";
  else if (own->order < 1 || own->stages < 1)
    wrong = "order and stages are 1 or more";
  else if (!(own->stability > 0 && isfinite(own->stability)))
    wrong = "its stability limit is to be > 0 and finite";
  else if (own->work < 0 || own->work > SPH_SCHEME_WORK_MAX)
    wrong = "work is 0 to 16 arrays";
  if (!wrong) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "own integrator \"%.63s\": %s (order %d, stages %d, stability %g, work %d)",
                       name, wrong, own->order, own->stages, own->stability, own->work);
}

/* Row of the table (-1: own) and what there is to tell of it.  Else recorded. */
static int look_up(const sph_integrator_def *def, int *row, sph_integrator_info *info,
                   sph_error *error)
{
  *row = -1;
  if (def->own) {
    int status = check_scheme(def, error);
    if (!status) *info = sph_integrator_table_scheme_info(def->own);
    return status;
  }
  *row = sph_integrator_table_find(def->method, error);
  if (*row < 0) return *row;
  if (sph_integrator_table_info(*row, info)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: table of %s", def->method);
}

/* A tolerance and a controller need an error estimate. */
static int check_estimate(const sph_integrator_def *def, const sph_integrator_info *info,
                          sph_error *error)
{
  const int late = (info->wants & SPH_WANTS_FAST) && SPH_SUNDIALS_NUMBER < 70200;
  const char *why =
      late ? " (mri: from SUNDIALS 7.2 on; this library has " SUNDIALS_VERSION ")" : "";
  if (info->error_control) return SPH_OK;
  if (def->tolerance > 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator: tolerance = %g, but %s has no error estimate%s; right is "
                         "none (0)",
                         def->tolerance, info->name, why);
  if (def->controller)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator: controller \"%.40s\", but %s has no error estimate%s; right "
                         "is none (NULL)",
                         def->controller, info->name, why);
  return SPH_OK;
}

int sph_integrator_check(const sph_integrator_def *def, sph_error *error)
{
  sph_integrator_info info = {0};
  int row, status = look_up(def, &row, &info, error);
  if (!status) status = check_value("cfl", def->cfl, "0 (default) or more", def->cfl >= 0, error);
  if (!status) status = check_value("tolerance", def->tolerance, "any finite number", 1, error);
  if (!status)
    status = check_value("dt_max", def->dt_max, "0 or more [s]", def->dt_max >= 0, error);
  if (!status)
    status = check_value("dt_min", def->dt_min, "0 or more [s]", def->dt_min >= 0, error);
  if (!status)
    status = check_value("dt_fixed", def->dt_fixed, "0 or more [s]", def->dt_fixed >= 0, error);
  if (!status)
    status = check_value("retries", def->retries, "0 (default) or more", def->retries >= 0, error);
  if (!status)
    status = check_value("stage_tolerance", def->stage_tolerance, "0 (default) or more",
                         def->stage_tolerance >= 0, error);
  if (!status) status = check_estimate(def, &info, error);
  if (!status && def->controller && !sph_controller_find(def->controller, error))
    status = SPH_ERR_ARGUMENT;
  if (!status) status = sph_fast_check(def, info.wants & SPH_WANTS_FAST, error);
  return status ? status : sph_relax_check(def, &info, error);
}

/* The one that was asked for; else that of the table, the integral one where it has none. */
static sph_controller controller_of(const sph_integrator_def *def, int row)
{
  sph_error none = {0};
  sph_controller chosen = *sph_controller_find("i", &none);
  const double *beta = sph_integrator_table_control(row);
  if (def->controller) return *sph_controller_find(def->controller, &none);
  for (int k = 0; beta && k < 3; k++) chosen.beta[k] = beta[k];
  chosen.limited = beta != NULL;
  return chosen;
}

/* Fills in the defaults. */
static void define(sph_integrator *it, const sph_integrator_def *def)
{
  it->scheme = sph_integrator_table_scheme(it->row);
  if (def->own) {
    snprintf(it->name, sizeof it->name, "%s", def->own->name);
    it->user = *def->own;
    it->user.name = it->info.name = it->name;
    it->scheme = &it->user;
  }
  it->stepper = sph_integrator_table_stepper(it->row);
  it->def = *def;
  it->def.method = it->info.name;
  it->adaptive = it->info.error_control && def->tolerance >= 0 && !(def->dt_fixed > 0);
  it->controller = controller_of(def, it->row);
  if (def->tolerance == 0) it->def.tolerance = 1e-2;
  if (def->stage_tolerance == 0)
    it->def.stage_tolerance = it->adaptive ? 1e-2 * it->def.tolerance : 1e-8;
  it->cfl_given = def->cfl;
  it->least_given = def->dt_min > 0;
  if (def->fast_tolerance == 0) it->def.fast_tolerance = 0.1 * it->def.tolerance;
  if (def->cfl == 0) it->def.cfl = sph_integrator_cfl(it->adaptive);
  if (def->retries == 0) it->def.retries = 12;
}

sph_integrator *sph_integrator_create(const sph_integrator_def *def, const sph_problem *problem,
                                      double t, N_Vector y, SUNContext context, sph_error *error)
{
  if (sph_integrator_check(def, error)) return NULL;
  sph_integrator *it = SPH_NEW(sph_integrator, 1, "an integrator", error);
  if (!it) return NULL;
  int status = look_up(def, &it->row, &it->info, error);
  define(it, def);
  it->problem = *problem;
  it->y = y;
  it->time = it->previous = t;
  it->cap = it->next = it->first = INFINITY;
  it->before = sph_nvector_clone(y, "the state before a step", error);
  if (!it->before) status = SPH_ERR_MEMORY;
  if (!status) status = it->stepper->create(it, context);
  if (!status) return it;
  sph_error_set(error, status, "integrator %s: %s", it->info.name, sph_status_text(status));
  sph_integrator_free(it);
  return NULL;
}

void sph_integrator_free(sph_integrator *it)
{
  if (!it) return;
  it->stepper->free(it);
  if (it->before) N_VDestroy(it->before);
  sph_memory_free(it);
}

int sph_integrator_rhs(sph_integrator *it, double t, N_Vector y, N_Vector ydot)
{
  it->stats.rhs_evaluations++;
  it->rhs_status = it->problem.rhs(t, y, ydot, it->problem.ctx);
  return it->rhs_status;
}

int sph_integrator_piece(sph_integrator *it, int piece, double t, N_Vector y, N_Vector ydot)
{
  long *count = piece == SPH_PIECE_IMPLICIT ? &it->stats.implicit_evaluations
                : piece == SPH_PIECE_FAST   ? &it->stats.fast_evaluations
                                            : &it->stats.rhs_evaluations;
  *count += piece != SPH_PIECE_DRIFT; /* next to nothing beside the kick that comes with it */
  it->rhs_status = it->problem.rhs_piece(piece, t, y, ydot, it->problem.ctx);
  return it->rhs_status;
}

int sph_integrator_limit(sph_integrator *it, double t, N_Vector y)
{
  sph_step_limit limit;
  for (int k = 0; k < SPH_BOUND_COUNT; k++) limit.dt[k] = INFINITY;
  int status = it->problem.limits ? it->problem.limits(t, y, &limit, it->problem.ctx) : SPH_OK;
  limit.dt[SPH_BOUND_CFL] *= it->def.cfl * it->info.stability;
  if (it->info.wants & SPH_WANTS_DOMINANT) /* stages do what shorter steps would */
    limit.dt[SPH_BOUND_VISCOUS] = limit.dt[SPH_BOUND_CONDUCTION] = limit.dt[SPH_BOUND_DIFFUSION] =
        limit.dt[SPH_BOUND_DRAG] = INFINITY;
  if (it->def.dt_max > 0) limit.dt[SPH_BOUND_USER] = fmin(limit.dt[SPH_BOUND_USER], it->def.dt_max);
  it->limit = INFINITY;
  it->cause = SPH_BOUND_USER;
  for (int k = 0; k < SPH_BOUND_COUNT; k++)
    if (!(limit.dt[k] >= it->limit)) { /* a limit that is no number binds, and fails below dt_min */
      it->limit = limit.dt[k];
      it->cause = k;
    }
  if (it->def.dt_min == 0 && it->limit < INFINITY && !(it->def.dt_fixed > 0))
    it->def.dt_min = BLOWN_UP * it->limit;
  return status;
}

int sph_integrator_fail(sph_integrator *it, int status, const char *why)
{
  return sph_error_set(it->problem.error, status < 0 ? status : SPH_ERR_STEP,
                       "%s: step at t = %.9g s: %s", it->info.name, it->time, why);
}

/* One evaluation at (time, y), then the first limits. */
static int start(sph_integrator *it)
{
  int status = it->stepper->start(it);
  if (!status) status = sph_integrator_limit(it, it->time, it->y);
  if (status) return sph_integrator_fail(it, status, "no rates and limits at its start");
  if (!it->adaptive && !(it->def.dt_fixed > 0) && !(it->limit < INFINITY))
    return sph_integrator_fail(it, SPH_ERR_ARGUMENT,
                               "nothing limits it; right is a limit, dt_max or dt_fixed");
  it->started = 1;
  return SPH_OK;
}

static sph_attempt plan(const sph_integrator *it, double t_stop)
{
  sph_attempt a = {.limit = it->limit, .bound = it->cause};
  double left = t_stop - it->time;
  if (it->def.dt_fixed > 0) {
    a.limit = it->def.dt_fixed;
    a.bound = SPH_BOUND_USER;
  } else if (it->cap < it->limit) {
    a.limit = it->cap;
    a.bound = SPH_BOUND_RETRY;
  }
  a.h = a.limit;
  if (!it->adaptive && left < a.limit * (1 - CLOSE)) a.bound = SPH_BOUND_STOP;
  if (!it->adaptive && left < a.limit * (1 + CLOSE)) a.h = left;
  return a;
}

static int accept(sph_integrator *it, const sph_attempt *a)
{
  sph_step_stats *stats = &it->stats;
  it->previous = it->time;
  it->time = a->t;
  it->stepped = 1;
  it->bound = a->bound;
  stats->bound_by[a->bound]++;
  stats->dt_last = a->h;
  stats->dt_largest = fmax(stats->dt_largest, a->h);
  if (stats->steps == 0 || (a->bound != SPH_BOUND_STOP && a->h < stats->dt_smallest))
    stats->dt_smallest = a->h;
  stats->steps++;
  int status = it->adaptive ? SPH_OK : sph_integrator_limit(it, it->time, it->y);
  it->cap = 2 * it->cap < it->limit ? 2 * it->cap : INFINITY;
  return status ? sph_integrator_fail(it, status, "no limits at its end") : SPH_OK;
}

/* The attempt failed: back to the last good state, with half of its step.  0: try again. */
static int retry(sph_integrator *it, const sph_attempt *a, int halvings, int status)
{
  if (it->stepper->undo) it->stepper->undo(it);
  N_VScale(1, it->before, it->y);
  if (status < 0) return sph_integrator_fail(it, status, "it failed"); /* unless it was recorded */
  it->bound = SPH_BOUND_RETRY;
  if (halvings >= it->def.retries || it->def.dt_fixed > 0)
    return sph_error_set(
        it->problem.error, SPH_ERR_STEP,
        "%s: step at t = %.9g s is not admissible with dt = %.3g s after %d halvings%s%s%s",
        it->info.name, it->time, a->h, halvings,
        it->def.dt_fixed > 0 ? " (dt_fixed allows none)" : "", it->reason ? ": " : "",
        it->reason ? it->reason : "");
  it->cap = a->h / 2;
  it->stats.retries++;
  status = it->stepper->reject(it);
  return status ? sph_integrator_fail(it, status, "it cannot be repeated") : SPH_OK;
}

static int fail_small(sph_integrator *it, const sph_attempt *a)
{
  it->bound = a->bound;
  return sph_error_set(
      it->problem.error, SPH_ERR_STEP,
      "%s: step at t = %.9g s: dt = %.3g s (bound by %s) is below dt_min = %.3g s%s", it->info.name,
      it->time, a->h, sph_bound_name(a->bound), it->def.dt_min,
      it->least_given ? "" : ", 1e-5 of the first limit: the run has blown up");
}

static int too_small(sph_integrator *it, const sph_attempt *a)
{
  if (a->bound == SPH_BOUND_STOP || a->h >= it->def.dt_min) return SPH_OK;
  return fail_small(it, a);
}

/* Error control may begin with tiny steps, and take some where f jumps; it does not stay there. */
int sph_integrator_controlled(sph_integrator *it, const sph_attempt *a)
{
  if (a->bound == SPH_BOUND_STOP) return SPH_OK;
  it->small = a->h < it->def.dt_min ? it->small + 1 : 0;
  return it->small > (it->least_given ? 0 : SMALL_STEPS) ? fail_small(it, a) : SPH_OK;
}

int sph_integrator_step(sph_integrator *it, double t_stop)
{
  int status = SPH_OK;
  if (!(isfinite(t_stop) && t_stop > it->time))
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "stop time %g s; right is finite and > %g s", t_stop, it->time);
  if (!it->started) status = start(it);
  if (status) return status;
  if (t_stop - it->time <= 8 * DBL_EPSILON * fmax(fabs(t_stop), fabs(it->time))) {
    it->time = t_stop; /* nothing happens in a rounding error */
    return SPH_OK;
  }
  N_VScale(1, it->y, it->before);
  for (int halvings = 0;; halvings++) {
    sph_attempt a = plan(it, t_stop);
    status = too_small(it, &a);
    if (status) return status;
    it->reason = NULL;
    status = it->stepper->attempt(it, &a, t_stop);
    if (!status && it->problem.admissible)
      status = it->problem.admissible(a.t, it->y, it->problem.ctx);
    if (!status) return accept(it, &a);
    status = retry(it, &a, halvings, status);
    if (status) return status;
  }
}

double sph_integrator_time(const sph_integrator *it) { return it->time; }
double sph_integrator_previous(const sph_integrator *it) { return it->previous; }
const sph_step_stats *sph_integrator_stats(const sph_integrator *it) { return &it->stats; }
int sph_integrator_bound(const sph_integrator *it) { return it->bound; }

int sph_integrator_interpolate(sph_integrator *it, double t, N_Vector at)
{
  double slack = 100 * DBL_EPSILON * fmax(fabs(it->previous), fabs(it->time));
  if (t == it->time) {
    N_VScale(1, it->y, at);
    return SPH_OK;
  }
  if (!it->stepped)
    return sph_error_set(it->problem.error, SPH_ERR_STATE,
                         "no state at t = %g s: there is no last step since the start or a reset",
                         t);
  if (!(t >= it->previous - slack && t <= it->time + slack))
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "no state at t = %g s; right is in the last step, %g to %g s", t,
                         it->previous, it->time);
  int status = it->stepper->interpolate(it, fmin(fmax(t, it->previous), it->time), at);
  return status ? sph_integrator_fail(it, status, "no dense output") : SPH_OK;
}

int sph_integrator_stepped(const sph_integrator *it) { return it->stepped; }

/* Dense output is cubic at most: the slope of the cubic through its values at s = 0, 1/3, 2/3, 1 of
 * the step. */
int sph_integrator_rate(sph_integrator *it, double t, N_Vector rate, N_Vector work)
{
  double h = it->time - it->previous, s = (t - it->previous) / h;
  int status = SPH_OK;
  N_VConst(0, rate);
  for (int k = 0; !status && k < 4; k++) {
    double slope = 0; /* of Lagrange's polynomial: 1 at k/3, 0 at the others */
    for (int m = 0; m < 4; m++) {
      double part = m == k ? 0 : 3.0 / (k - m);
      for (int n = 0; n < 4; n++)
        if (n != k && n != m) part *= (3 * s - n) / (k - n);
      slope += part;
    }
    double node = k == 3 ? it->time : it->previous + k * h / 3;
    status = sph_integrator_interpolate(it, node, work);
    if (!status) N_VLinearSum(1, rate, slope / h, work, rate);
  }
  return status;
}

int sph_integrator_reset(sph_integrator *it, double t)
{
  if (!isfinite(t))
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT, "reset to t = %g s; right is finite",
                         t);
  it->time = it->previous = t;
  it->started = it->stepped = 0;
  it->cap = it->first = INFINITY;
  return SPH_OK;
}

int sph_integrator_go_on(sph_integrator *it, double t)
{
  double next = fmin(it->next, it->first); /* twice in a row: the first says more */
  int status = sph_integrator_reset(it, t);
  it->first = next;
  return status;
}
