/* Forward sensitivities: one vector holds the state and, behind it, as many copies of its layout as
 * there are parameters. */
#include "sphode/sensitivity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "integrator_table.h"
#include "memory.h"
#include "sim_prepare.h"
#include "sim_run.h"
#include "sim_tangent.h"

enum { POINTS = 4 };
static const double at[POINTS] = {-2, -1, 1, 2};
static const double weight[POINTS] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
static const double STEP = 0x1p-14;

struct sph_sensitivity {
  sph_sim *sim;
  int n;
  sph_parameter *theta; /* [n] */
  sph_problem problem;  /* that of the simulation */
  sph_layout layout;
  N_Vector y; /* state, sensitivities */
  sph_integrator *integrator;
  int started;
};

static double *part(const sph_sensitivity *s, int k)
{
  return sph_nvector_data(s->y) + (k + 1) * s->sim->layout.length;
}

/* ---- the problem ---- */

static int rhs(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  sph_sensitivity *s = ctx;
  const long length = s->sim->layout.length;
  const double *at_y = sph_nvector_data(y);
  double *rate = sph_nvector_data(ydot);
  int status = sph_sim_rhs(t, y, ydot, s->sim); /* sees the first part alone */
  for (int k = 0; !status && k < s->n; k++)
    status = sph_sim_tangent(s->sim, SPH_WHOLE, t, at_y, at_y + (k + 1) * length, &s->theta[k], 0,
                             rate + (k + 1) * length);
  return status;
}

/* Errors are those of the state: the others do not count in the mean square over all entries. */
static int weights(N_Vector y, N_Vector w, void *ctx)
{
  const sph_sensitivity *s = ctx;
  const long length = s->sim->layout.length;
  double *to = sph_nvector_data(w);
  int status = sph_sim_weights(y, w, s->sim);
  for (long i = 0; i < length; i++) to[i] *= sqrt(1.0 + s->n);
  for (long i = length; i < s->layout.length; i++) to[i] = 1e-200;
  return status;
}

static int limits(double t, N_Vector y, sph_step_limit *limit, void *ctx)
{
  const sph_sensitivity *s = ctx;
  return s->problem.limits(t, y, limit, s->sim);
}

static int admissible(double t, N_Vector y, void *ctx)
{
  const sph_sensitivity *s = ctx;
  return s->problem.admissible(t, y, s->sim);
}

/* ---- making ---- */

/* Copies of the state's segments; a density's sensitivity is no density. */
static int make_layout(sph_sensitivity *s)
{
  const sph_layout *one = &s->sim->layout;
  s->layout.segment =
      SPH_NEW(sph_segment, (s->n + 1) * one->segments, "a layout of sensitivities", &s->sim->error);
  if (!s->layout.segment) return SPH_ERR_MEMORY;
  for (int k = 0; k <= s->n; k++)
    for (int q = 0; q < one->segments; q++) {
      sph_segment *to = &s->layout.segment[k * one->segments + q];
      *to = one->segment[q];
      to->offset += k * one->length;
      if (to->partner >= 0) to->partner += k * one->segments;
      if (k > 0 && to->role == SPH_ROLE_DENSITY) to->role = SPH_ROLE_OTHER;
    }
  s->layout.segments = (s->n + 1) * one->segments;
  s->layout.length = (s->n + 1) * one->length;
  s->layout.entries = (s->n + 1) * one->entries;
  return SPH_OK;
}

static int check_integrator(sph_sim *sim)
{
  const sph_integrator_def *def = &sim->integrator_def;
  sph_integrator_info info = {0};
  int row = def->own ? -1 : sph_integrator_table_find(def->method, &sim->error);
  if (row >= 0) sph_integrator_table_info(row, &info);
  if (info.wants)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "sensitivities: integrator %s; right is one that steps all terms alike, as "
                        "erk:bogacki-shampine-4-2-3",
                        sph_sim_integrator(sim));
  if (def->relax)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "sensitivities: steps relax, and how much depends on the parameters; right "
                        "is relax = NULL");
  if (sim->watches || sim->modifiers)
    return sph_sim_fail(sim, SPH_ERR_STATE,
                        "sensitivities: %d events and %d modifiers change a run; right is none",
                        sim->watches, sim->modifiers);
  return sim->error.status;
}

static int take_parameters(sph_sensitivity *s, const sph_sensitivity_parameter *parameters)
{
  int status = SPH_OK;
  s->theta = SPH_NEW(sph_parameter, s->n, "parameters", &s->sim->error);
  if (!s->theta) return SPH_ERR_MEMORY;
  for (int k = 0; !status && k < s->n; k++)
    if (parameters[k].own)
      sph_sim_parameter_own(parameters[k].name ? parameters[k].name : "", parameters[k].own,
                            &s->theta[k]);
    else
      status = sph_sim_parameter_find(s->sim, parameters[k].name, &s->theta[k]);
  return status;
}

static int make_integrator(sph_sensitivity *s)
{
  sph_sim *sim = s->sim;
  const sph_problem problem = {.ctx = s,
                               .threads = sim->threads,
                               .drift = s->problem.drift,
                               .rhs = rhs,
                               .weights = weights,
                               .limits = limits,
                               .admissible = admissible,
                               .error = &sim->error};
  s->y = sph_nvector_create(&s->layout, sim->threads, sim->context, &sim->error);
  if (!s->y) return SPH_ERR_MEMORY;
  memcpy(sph_nvector_data(s->y), sph_nvector_data(sim->y),
         (size_t)sim->layout.length * sizeof(double));
  s->integrator = sph_integrator_create(&sim->integrator_def, &problem, sim->time, s->y,
                                        sim->context, &sim->error);
  return sim->error.status;
}

sph_sensitivity *sph_sensitivity_create(sph_sim *sim, int n,
                                        const sph_sensitivity_parameter *parameters)
{
  if (!sph_sim_data_ok(sim) || sph_sim_prepare(sim) || sph_sim_tangent_fit(sim)) return NULL;
  if (n < 1 || !parameters) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "sensitivities to %d parameters; right is 1 or more", n);
    return NULL;
  }
  sph_sensitivity *s = SPH_NEW(sph_sensitivity, 1, "sensitivities", &sim->error);
  if (!s) return NULL;
  s->sim = sim;
  s->n = n;
  s->problem = sph_sim_prepare_problem(sim);
  int status = check_integrator(sim);
  if (!status) status = take_parameters(s, parameters);
  if (!status) status = make_layout(s);
  if (!status) status = make_integrator(s);
  if (!status) return s;
  sph_sensitivity_free(s);
  return NULL;
}

void sph_sensitivity_free(sph_sensitivity *s)
{
  if (!s) return;
  sph_integrator_free(s->integrator);
  if (s->y) N_VDestroy(s->y);
  sph_memory_free(s->layout.segment);
  sph_memory_free(s->theta);
  sph_memory_free(s);
}

/* ---- the run ---- */

/* The simulation shows the state at the time of the integrator. */
static void show(sph_sensitivity *s)
{
  sph_sim *sim = s->sim;
  memcpy(sph_nvector_data(sim->y), sph_nvector_data(s->y),
         (size_t)sim->layout.length * sizeof(double));
  sim->shown = sim->y;
  sim->time = sph_integrator_time(s->integrator);
  sph_sim_changed(sim);
}

/* A run begins with the state of the simulation: what was written since the last one, or since
 * this was made, counts. */
static int take_state(sph_sensitivity *s)
{
  const sph_sim *sim = s->sim;
  const size_t bytes = (size_t)sim->layout.length * sizeof(double);
  const double t = sph_integrator_time(s->integrator);
  if (s->started && sim->time != t)
    return sph_sim_fail(s->sim, SPH_ERR_STATE,
                        "sensitivities: of t = %g s, but the simulation went on to %g s without "
                        "them",
                        t, sim->time);
  if (sim->time == t && !memcmp(sph_nvector_data(s->y), sph_nvector_data(sim->y), bytes))
    return SPH_OK;
  memcpy(sph_nvector_data(s->y), sph_nvector_data(sim->y), bytes);
  return sph_integrator_reset(s->integrator, sim->time);
}

int sph_sensitivity_run(sph_sensitivity *s, double t_end)
{
  if (!s || !sph_sim_data_ok(s->sim) || take_state(s))
    return s ? sph_sim_status(s->sim) : SPH_ERR_ARGUMENT;
  sph_sim *sim = s->sim;
  double t = sph_integrator_time(s->integrator);
  if (!(isfinite(t_end) && t_end >= t))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "sensitivities: run to %g s; right is >= %g s",
                        t_end, t);
  int status = sph_sim_run_enter(sim);
  if (status) return status;
  s->started = 1;
  while (!status && sph_integrator_time(s->integrator) < t_end)
    status = sph_integrator_step(s->integrator, t_end);
  sph_sim_run_leave(sim);
  show(s);
  return status;
}

/* ---- what came out ---- */

static double *find(const sph_sensitivity *s, int k, const sph_group *group, const char *field,
                    int component)
{
  if (!s || k < 0 || k >= s->n || !group || group->sim != s->sim) return NULL;
  const double *rate = sph_group_rate(group, field, component);
  return rate ? part(s, k) + (rate - sph_nvector_data(s->sim->ydot)) : NULL;
}

const double *sph_sensitivity_read(const sph_sensitivity *s, int k, const sph_group *group,
                                   const char *field, int component)
{
  return find(s, k, group, field, component);
}

double *sph_sensitivity_write(sph_sensitivity *s, int k, const sph_group *group, const char *field,
                              int component)
{
  if (!s || !s->started) return find(s, k, group, field, component);
  sph_sim_fail(s->sim, SPH_ERR_STATE, "sensitivities are written before the first run");
  return NULL;
}

int sph_sensitivity_known(sph_sim *sim, int k, char *name, size_t size)
{
  sph_parameter theta;
  if (!sim || !name || !sph_sim_parameter_get(sim, k, &theta)) return 0;
  snprintf(name, size, "%s", theta.name);
  return 1;
}

/* The quantity with state and parameter moved by e. */
static int beside(sph_sensitivity *s, int k, double e,
                  int (*quantity)(void *ctx, sph_sim *sim, double *value), void *ctx, double *value)
{
  sph_sim *sim = s->sim;
  const sph_parameter *theta = &s->theta[k];
  const double theta_0 = *theta->value, *y = sph_nvector_data(s->y), *d = part(s, k);
  double *to = sph_nvector_data(sim->frame);
  for (long i = 0; i < sim->layout.length; i++) to[i] = y[i] + e * d[i];
  sph_sim_parameter_set(sim, theta, theta_0 + e);
  sim->shown = sim->frame;
  sim->derived = 0;
  int status = sph_sim_run_derived(sim);
  if (!status) status = quantity(ctx, sim, value);
  sph_sim_parameter_set(sim, theta, theta_0);
  sim->shown = sim->y;
  sim->derived = 0;
  return status;
}

/* The largest change of any entry over its scale, and that of the parameter. */
static double size_of(const sph_sensitivity *s, int k)
{
  const sph_sim *sim = s->sim;
  double most = 1 / s->theta[k].scale;
  N_Vector w = sph_nvector_clone(sim->y, "weights", &s->sim->error);
  if (!w) return NAN;
  sph_sim_weights(sim->y, w, s->sim);
  for (int q = 0; q < sim->layout.segments; q++) {
    const sph_segment *segment = &sim->layout.segment[q];
    for (long i = segment->offset; i < segment->offset + segment->n; i++)
      most = fmax(most, fabs(part(s, k)[i]) * sph_nvector_data(w)[i]);
  }
  N_VDestroy(w);
  return most;
}

int sph_sensitivity_of(sph_sensitivity *s, int k,
                       int (*quantity)(void *ctx, sph_sim *sim, double *value), void *ctx,
                       double *derivative)
{
  if (!s || !sph_sim_data_ok(s->sim)) return s ? sph_sim_status(s->sim) : SPH_ERR_ARGUMENT;
  if (k < 0 || k >= s->n || !quantity || !derivative)
    return sph_sim_fail(s->sim, SPH_ERR_ARGUMENT,
                        "sensitivity of a quantity to parameter %d of %d, quantity %s, place %s", k,
                        s->n, quantity ? "given" : "NULL", derivative ? "given" : "NULL");
  const double size = size_of(s, k);
  int status = s->sim->error.status;
  double sum = 0;
  for (int p = 0; !status && p < POINTS; p++) {
    double value = 0;
    status = beside(s, k, at[p] * STEP / size, quantity, ctx, &value);
    sum += weight[p] * value * size / STEP;
  }
  *derivative = status ? NAN : sum;
  return status;
}

static int monitored(void *ctx, sph_sim *sim, double *value)
{
  sph_error error = {0};
  int status = sph_monitor_value(ctx, sim, value, &error);
  return status ? sph_sim_fail(sim, status, "%s", error.text) : SPH_OK;
}

int sph_sensitivity_of_monitor(sph_sensitivity *s, int k, const sph_monitor *monitor,
                               double *derivative)
{
  return sph_sensitivity_of(s, k, monitored, (void *)monitor, derivative);
}
