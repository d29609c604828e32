/* Discrete adjoints of explicit Runge-Kutta runs.  A step
 *
 *   Y_i = y_n + h sum_j a_ij k_j,  k_i = f(t_n + c_i h, Y_i),  y_n+1 = y_n + h sum_i b_i k_i
 *
 * and J += h sum_i b_i r(Y_i) backwards, i from the last stage to the first:
 *
 *   kappa_i = h (b_i lambda_n+1 + sum_j>i a_ji mu_j)
 *   mu_i    = (df/dy)^T(Y_i) kappa_i + h b_i dr/dy(Y_i)
 *   lambda_n = lambda_n+1 + sum_i mu_i,   dJ/dtheta += kappa_i . df/dtheta(Y_i) */
#include "sphode/adjoint.h"

#include <math.h>
#include <string.h>

#include "integrator_table.h"
#include "memory.h"
#include "sim_prepare.h"
#include "sim_run.h"
#include "sim_transposed.h"

enum { STAGES = 32 };

struct sph_adjoint {
  sph_sim *sim;
  sph_functional functional;
  int n;
  sph_parameter *theta; /* [n] */
  ARKodeButcherTable table;
  double h;             /* [s] */
  int checkpoints;      /* wanted; 0: by the root */
  double value, *slope; /* J; dJ/dtheta [n] */
  N_Vector y, lambda;   /* state; adjoint, at the end of a run that of its start */
  N_Vector Y[STAGES], k[STAGES], mu[STAGES], kappa, work;
  N_Vector gradient;              /* of a callback */
  double *pressure[SPH_SETS_MAX]; /* likewise, [capacity] of fluids */
  int pressed;                    /* pressure is not all zero */
};

/* The steps of one run. */
typedef struct run {
  double t0, h;
  long steps;
  double last; /* size of the last one */
  long every;  /* steps from one state kept to the next */
  long kept;
  double *state;   /* [kept][length] */
  double *segment; /* [every][length] states of the steps between two of them */
} run;

static double time_of(const run *r, long step) { return r->t0 + (double)step * r->h; }
static double size_of(const run *r, long step) { return step + 1 < r->steps ? r->h : r->last; }

/* ---- making ---- */

static int take_table(sph_adjoint *a)
{
  sph_sim *sim = a->sim;
  const sph_integrator_def *def = &sim->integrator_def;
  int row = def->own ? -1 : sph_integrator_table_find(def->method, &sim->error);
  if (row >= 0) a->table = sph_integrator_table_butcher(row);
  if (!a->table || !(def->dt_fixed > 0) || a->table->stages > STAGES)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "adjoint: integrator %s, dt_fixed = %g s; right is an explicit Runge-Kutta "
                        "scheme, as erk:bogacki-shampine-4-2-3, with fixed steps",
                        sph_sim_integrator(sim), def->dt_fixed);
  if (def->relax)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "adjoint: steps relax, which its own do not; right is relax = NULL");
  a->h = def->dt_fixed;
  if (sim->watches || sim->modifiers)
    return sph_sim_fail(sim, SPH_ERR_STATE,
                        "adjoint: %d events and %d modifiers change a run; right is none",
                        sim->watches, sim->modifiers);
  return sim->error.status;
}

static int take_functional(sph_adjoint *a, const sph_adjoint_def *def)
{
  const sph_functional *f = &def->functional;
  a->functional = *f;
  int end = !f->end == !f->end_gradient, running = !f->running == !f->running_gradient;
  if (end && running && (f->end || f->running)) return SPH_OK;
  return sph_sim_fail(a->sim, SPH_ERR_ARGUMENT,
                      "adjoint: the functional has an end %s, a running part %s; right is one of "
                      "them or both, each with its gradient",
                      !f->end && !f->end_gradient ? "missing"
                      : end                       ? "given"
                                                  : "without gradient",
                      !f->running && !f->running_gradient ? "missing"
                      : running                           ? "given"
                                                          : "without gradient");
}

static int take_parameters(sph_adjoint *a, const sph_adjoint_def *def)
{
  sph_sim *sim = a->sim;
  int status = SPH_OK;
  a->theta = SPH_NEW(sph_parameter, def->n, "parameters", &sim->error);
  a->slope = SPH_NEW(double, def->n, "a gradient", &sim->error);
  if (!a->theta || !a->slope) return SPH_ERR_MEMORY;
  for (int k = 0; !status && k < def->n; k++)
    if (def->parameters[k].own)
      sph_sim_parameter_own(def->parameters[k].name ? def->parameters[k].name : "",
                            def->parameters[k].own, &a->theta[k]);
    else
      status = sph_sim_parameter_find(sim, def->parameters[k].name, &a->theta[k]);
  a->n = def->n;
  return status;
}

static int make_vectors(sph_adjoint *a)
{
  sph_sim *sim = a->sim;
  N_Vector *one[] = {&a->y, &a->lambda, &a->kappa, &a->work, &a->gradient};
  for (int k = 0; k < 5; k++)
    if (!(*one[k] = sph_nvector_clone(sim->y, "an adjoint", &sim->error))) return SPH_ERR_MEMORY;
  for (int i = 0; i < a->table->stages; i++) {
    N_Vector *stage[] = {&a->Y[i], &a->k[i], &a->mu[i]};
    for (int k = 0; k < 3; k++)
      if (!(*stage[k] = sph_nvector_clone(sim->y, "stages of an adjoint", &sim->error)))
        return SPH_ERR_MEMORY;
  }
  for (int g = 0; g < sim->groups; g++)
    if (!sim->group[g]->wall)
      a->pressure[g] =
          SPH_NEW(double, sim->group[g]->capacity, "a gradient by pressure", &sim->error);
  return sim->error.status;
}

sph_adjoint *sph_adjoint_create(sph_sim *sim, const sph_adjoint_def *def)
{
  if (!sph_sim_data_ok(sim) || sph_sim_prepare(sim) || sph_sim_tangent_fit(sim)) return NULL;
  if (!def || def->n < 0 || (def->n && !def->parameters) || def->checkpoints < 0) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                 "adjoint: definition %s, %d parameters, %d checkpoints; right are 0 or more",
                 def ? "given" : "NULL", def ? def->n : 0, def ? def->checkpoints : 0);
    return NULL;
  }
  sph_adjoint *a = SPH_NEW(sph_adjoint, 1, "an adjoint", &sim->error);
  if (!a) return NULL;
  a->sim = sim;
  a->checkpoints = def->checkpoints;
  int status = take_table(a);
  if (!status) status = take_functional(a, def);
  if (!status) status = take_parameters(a, def);
  if (!status) status = make_vectors(a);
  if (!status) return a;
  sph_adjoint_free(a);
  return NULL;
}

void sph_adjoint_free(sph_adjoint *a)
{
  if (!a) return;
  N_Vector all[] = {a->y, a->lambda, a->kappa, a->work, a->gradient};
  for (int k = 0; k < 5; k++)
    if (all[k]) N_VDestroy(all[k]);
  for (int i = 0; i < STAGES; i++) {
    if (a->Y[i]) N_VDestroy(a->Y[i]);
    if (a->k[i]) N_VDestroy(a->k[i]);
    if (a->mu[i]) N_VDestroy(a->mu[i]);
  }
  for (int g = 0; g < SPH_SETS_MAX; g++) sph_memory_free(a->pressure[g]);
  if (a->table) ARKodeButcherTable_Free(a->table);
  sph_memory_free(a->theta);
  sph_memory_free(a->slope);
  sph_memory_free(a);
}

/* ---- the functional ---- */

/* Callbacks see this state. */
static void show(const sph_adjoint *a, double t, N_Vector y)
{
  a->sim->shown = y;
  a->sim->time = t;
  a->sim->derived = 0;
}

/* The gradient of a part at (t, y), to a->gradient and a->pressure. */
static int find_gradient(sph_adjoint *a, double t, N_Vector y,
                         void (*gradient)(void *ctx, sph_sim *sim, sph_adjoint *adjoint))
{
  sph_sim *sim = a->sim;
  N_VConst(0, a->gradient);
  for (int g = 0; g < sim->groups && a->pressed; g++)
    if (a->pressure[g]) memset(a->pressure[g], 0, (size_t)sim->group[g]->capacity * sizeof(double));
  a->pressed = 0;
  show(a, t, y);
  gradient(a->functional.ctx, sim, a);
  return sim->error.status;
}

double *sph_adjoint_gradient(sph_adjoint *a, const sph_group *group, const char *field,
                             int component)
{
  if (!a || !group || group->sim != a->sim || group->wall) return NULL;
  if (field && !strcmp(field, "pressure") && component == 0) {
    a->pressed = 1;
    return a->pressure[group->index];
  }
  const double *rate = sph_group_rate(group, field, component);
  if (!rate) return NULL;
  return sph_nvector_data(a->gradient) + (rate - sph_nvector_data(a->sim->ydot));
}

/* sum of that gradient by pressure times dp/dtheta, as the last tangent along theta left it. */
static double by_pressure(const sph_adjoint *a)
{
  const sph_sim *sim = a->sim;
  double sum = 0;
  for (int g = 0; g < sim->groups && a->pressed; g++)
    for (long i = 0; a->pressure[g] && i < sim->group[g]->n; i++)
      sum += a->pressure[g][i] * sim->tangent->group[g].point[i].p;
  return sum;
}

/* ---- forwards ---- */

/* All stages of a step from y. */
static int stages(sph_adjoint *a, double t, double h, N_Vector y)
{
  int status = SPH_OK;
  for (int i = 0; !status && i < a->table->stages; i++) {
    N_VScale(1, y, a->Y[i]);
    for (int j = 0; j < i; j++)
      if (a->table->A[i][j] != 0) N_VLinearSum(1, a->Y[i], h * a->table->A[i][j], a->k[j], a->Y[i]);
    status = sph_sim_rhs(t + a->table->c[i] * h, a->Y[i], a->k[i], a->sim);
  }
  if (status <= 0) return status;
  return sph_sim_fail(a->sim, SPH_ERR_STEP, "adjoint: step of %g s at t = %g s: %s", h, t,
                      a->sim->retry);
}

/* y = the end of the step from it; value, if not NULL, gets its share of J. */
static int step(sph_adjoint *a, double t, double h, N_Vector y, double *value)
{
  int status = stages(a, t, h, y);
  for (int i = 0; !status && i < a->table->stages; i++) {
    if (a->table->b[i] == 0) continue;
    N_VLinearSum(1, y, h * a->table->b[i], a->k[i], y);
    if (!value || !a->functional.running) continue;
    show(a, t + a->table->c[i] * h, a->Y[i]);
    *value += h * a->table->b[i] * a->functional.running(a->functional.ctx, a->sim);
    status = a->sim->error.status;
  }
  return status;
}

static void keep(const sph_adjoint *a, double *states, long k)
{
  const long length = a->sim->layout.length;
  memcpy(states + k * length, sph_nvector_data(a->y), (size_t)length * sizeof(double));
}

static void recall(const sph_adjoint *a, const double *states, long k)
{
  const long length = a->sim->layout.length;
  memcpy(sph_nvector_data(a->y), states + k * length, (size_t)length * sizeof(double));
}

static int forwards(sph_adjoint *a, const run *r)
{
  int status = SPH_OK;
  for (long n = 0; !status && n < r->steps; n++) {
    if (r->state && n % r->every == 0) keep(a, r->state, n / r->every);
    status = step(a, time_of(r, n), size_of(r, n), a->y, &a->value);
  }
  return status;
}

/* ---- backwards ---- */

/* What stage i hands back: mu_i, and its share of dJ/dtheta. */
static int stage_back(sph_adjoint *a, double t, double h, int i)
{
  const double b = a->table->b[i], t_i = t + a->table->c[i] * h;
  sph_sim *sim = a->sim;
  int status = SPH_OK, running = a->functional.running && b != 0;
  N_VScale(h * b, a->lambda, a->kappa);
  for (int j = i + 1; j < a->table->stages; j++)
    if (a->table->A[j][i] != 0)
      N_VLinearSum(1, a->kappa, h * a->table->A[j][i], a->mu[j], a->kappa);
  if (running) status = find_gradient(a, t_i, a->Y[i], a->functional.running_gradient);
  const double *y = sph_nvector_data(a->Y[i]);
  const sph_pressure_bars bars = {h * b, (const double *const *)a->pressure};
  if (!status)
    status =
        sph_sim_transposed(sim, SPH_WHOLE, t_i, y, sph_nvector_data(a->kappa),
                           running && a->pressed ? &bars : NULL, 0, sph_nvector_data(a->mu[i]));
  if (running) N_VLinearSum(1, a->mu[i], h * b, a->gradient, a->mu[i]);
  for (int k = 0; !status && k < a->n; k++) {
    status =
        sph_sim_tangent(sim, SPH_WHOLE, t_i, y, NULL, &a->theta[k], 0, sph_nvector_data(a->work));
    a->slope[k] += N_VDotProd(a->kappa, a->work) + (running ? h * b * by_pressure(a) : 0);
  }
  return status;
}

/* Does anything that J depends on come out of stage i? */
static int counts(const struct ARKodeButcherTableMem *table, int i)
{
  int used = table->b[i] != 0;
  for (int j = i + 1; j < table->stages; j++) used |= table->A[j][i] != 0;
  return used;
}

static int step_back(sph_adjoint *a, double t, double h)
{
  int status = stages(a, t, h, a->y);
  for (int i = a->table->stages - 1; !status && i >= 0; i--) {
    N_VConst(0, a->mu[i]);
    if (counts(a->table, i)) status = stage_back(a, t, h, i);
  }
  for (int i = 0; !status && i < a->table->stages; i++)
    N_VLinearSum(1, a->lambda, 1, a->mu[i], a->lambda);
  return status;
}

/* lambda = dphi/dy at the end. */
static int end(sph_adjoint *a, double t, int back)
{
  sph_sim *sim = a->sim;
  N_VConst(0, a->lambda);
  if (!a->functional.end) return SPH_OK;
  show(a, t, a->y);
  a->value += a->functional.end(a->functional.ctx, sim);
  if (!back) return sim->error.status;
  int status = find_gradient(a, t, a->y, a->functional.end_gradient);
  if (!status && a->pressed) {
    const sph_pressure_bars bars = {1, (const double *const *)a->pressure};
    const double *y = sph_nvector_data(a->y);
    N_VConst(0, a->kappa);
    status = sph_sim_transposed(sim, SPH_WHOLE, t, y, sph_nvector_data(a->kappa), &bars, 0,
                                sph_nvector_data(a->lambda));
    for (int k = 0; !status && k < a->n; k++) {
      status =
          sph_sim_tangent(sim, SPH_WHOLE, t, y, NULL, &a->theta[k], 0, sph_nvector_data(a->work));
      a->slope[k] += by_pressure(a);
    }
  }
  if (!status) N_VLinearSum(1, a->lambda, 1, a->gradient, a->lambda);
  return status;
}

static int backwards(sph_adjoint *a, const run *r)
{
  int status = SPH_OK;
  for (long k = r->kept - 1; !status && k >= 0; k--) {
    const long first = k * r->every, behind = first + r->every,
               last = behind < r->steps ? behind : r->steps;
    recall(a, r->state, k);
    for (long n = first; !status && n < last; n++) {
      keep(a, r->segment, n - first);
      if (n + 1 < last) status = step(a, time_of(r, n), size_of(r, n), a->y, NULL);
    }
    for (long n = last - 1; !status && n >= first; n--) {
      recall(a, r->segment, n - first);
      status = step_back(a, time_of(r, n), size_of(r, n));
    }
  }
  return status;
}

/* ---- a run ---- */

static int plan(sph_adjoint *a, double t_end, int back, run *r)
{
  sph_sim *sim = a->sim;
  const long length = sim->layout.length;
  const double steps = ceil((t_end - sim->time) / a->h * (1 - 1e-6)); /* as fixed steps elsewhere */
  *r = (run){.t0 = sim->time, .h = a->h, .steps = (long)steps};
  r->last = t_end - time_of(r, r->steps - 1);
  long kept = a->checkpoints ? a->checkpoints : (long)ceil(sqrt(steps));
  r->every = (r->steps + kept - 1) / kept;
  r->kept = (r->steps + r->every - 1) / r->every;
  if (!back) return SPH_OK;
  r->state = SPH_NEW(double, r->kept *length, "states of an adjoint", &sim->error);
  r->segment = SPH_NEW(double, r->every *length, "states between those of an adjoint", &sim->error);
  return sim->error.status;
}

/* The simulation at the end of the run. */
static void arrive(sph_adjoint *a, double t, N_Vector y)
{
  sph_sim *sim = a->sim;
  N_VScale(1, y, sim->y);
  sim->shown = sim->y;
  sim->time = t;
  sph_sim_changed(sim);
}

static int run_to(sph_adjoint *a, double t_end, int back)
{
  if (!a || !sph_sim_data_ok(a->sim)) return a ? sph_sim_status(a->sim) : SPH_ERR_ARGUMENT;
  sph_sim *sim = a->sim;
  run r = {0};
  if (!(isfinite(t_end) && t_end > sim->time && (t_end - sim->time) / a->h < 1e9))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "adjoint: run to %g s; right is finite and > %g s",
                        t_end, sim->time);
  if (sph_sim_run_enter(sim)) return sim->error.status;
  N_VScale(1, sim->y, a->y);
  a->value = 0;
  for (int k = 0; k < a->n; k++) a->slope[k] = back ? 0 : NAN;
  int status = plan(a, t_end, back, &r);
  if (!status) status = forwards(a, &r);
  if (!status) N_VScale(1, a->y, sim->frame); /* the end */
  if (!status) status = end(a, t_end, back);
  if (!status && back) status = backwards(a, &r);
  if (!status) arrive(a, t_end, sim->frame);
  sim->shown = sim->y;
  if (status) sim->time = r.t0;
  sph_sim_run_leave(sim);
  sph_memory_free(r.state);
  sph_memory_free(r.segment);
  return status;
}

int sph_adjoint_run(sph_adjoint *a, double t_end) { return run_to(a, t_end, 1); }
int sph_adjoint_evaluate(sph_adjoint *a, double t_end) { return run_to(a, t_end, 0); }

double sph_adjoint_value(const sph_adjoint *a) { return a ? a->value : NAN; }

double sph_adjoint_parameter(const sph_adjoint *a, int k)
{
  return a && k >= 0 && k < a->n ? a->slope[k] : NAN;
}

const double *sph_adjoint_start(const sph_adjoint *a, const sph_group *group, const char *field,
                                int component)
{
  if (!a || !group || group->sim != a->sim) return NULL;
  const double *rate = sph_group_rate(group, field, component);
  return rate ? sph_nvector_data(a->lambda) + (rate - sph_nvector_data(a->sim->ydot)) : NULL;
}
