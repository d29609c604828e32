/* An explicit Runge-Kutta table (A, b, c, embedded b*) on the fast part alone.  The slow rates
 * enter each stage in the same pass over memory as the fast ones:
 *
 *   K_i = f_fast(t + c_i h, z_i)
 *   z_i = y + h sum_j a_ij K_j + sum_k R_ik r_k,   R_ik = h sum_j a_ij theta_j^k
 *
 * and y at the end with b_j for a_ij, the estimate of its error with b_j - b*_j. */
#include "fast.h"

#include <math.h>
#include <string.h>

#include "integrator_table.h"
#include "memory.h"
#include "nvector.h"

enum { STAGES_MAX = 20 };
static const double CLOSE = 1e-9;    /* relative: such times are the same */
static const double SHORTEST = 1e-9; /* a step relative to the way between two slow stages */

struct sph_fast {
  sph_integrator *it; /* borrowed: its problem, its definition */
  ARKodeButcherTable table;
  int adaptive, fsal;
  double cfl, stability;
  double h;                 /* that error control asks for [s]; INFINITY: not known yet */
  double limit;             /* of steps, at the state where this one starts [s] */
  const sph_fast_rates *in; /* those of this call */
  N_Vector z;               /* a stage */
  N_Vector error, weight;   /* only with error control */
  N_Vector K[STAGES_MAX];
};

/* ---- making */

/* Tables whose errors are small for their stages. */
static const char *method_of(const sph_integrator_def *def, int order)
{
  static const char *const usual[] = {"erk:heun-euler-2-1-2", "erk:heun-euler-2-1-2",
                                      "erk:bogacki-shampine-4-2-3", "erk:zonneveld-5-3-4",
                                      "erk:dormand-prince-7-4-5"};
  if (def->fast_method) return def->fast_method;
  return usual[order < 1 ? 0 : order > 5 ? 4 : order - 1];
}

int sph_fast_check(const sph_integrator_def *def, int has_fast, sph_error *error)
{
  const char *name = def->fast_method;
  sph_integrator_info info;
  if (!has_fast && (name || def->fast_step != 0 || def->fast_tolerance != 0))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator %s has no fast part: right are no fast_method, fast_step = 0 "
                         "and fast_tolerance = 0",
                         def->method ? def->method : "of your own");
  if (!(def->fast_step >= 0 && isfinite(def->fast_step)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator: fast_step = %g; right is 0 or more [s]", def->fast_step);
  if (!isfinite(def->fast_tolerance))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator: fast_tolerance = %g; right is any finite number",
                         def->fast_tolerance);
  if (!name) return SPH_OK;
  int row = sph_integrator_table_find(name, error);
  if (row < 0) return row;
  if (strncmp(name, "erk:", 4))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator: fast_method = \"%.60s\"; right is "
                         "erk:<table>",
                         name);
  if (!sph_integrator_table_info(row, &info))
    return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: table of %s", name);
  if (!info.error_control && def->fast_tolerance > 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator: fast_tolerance = %g, but %s has no "
                         "error estimate; right is -1 (limits alone) or fast_step",
                         def->fast_tolerance, name);
  return SPH_OK;
}

static int vectors(sph_fast *fast)
{
  sph_integrator *it = fast->it;
  N_Vector *vector[STAGES_MAX + 3] = {&fast->z, &fast->error, &fast->weight};
  int count = fast->adaptive ? 3 : 1;
  for (int i = 0; i < fast->table->stages; i++) vector[count++] = &fast->K[i];
  for (int k = 0; k < count; k++)
    if (!(*vector[k] = sph_nvector_clone(it->y, "stages of the fast part", it->problem.error)))
      return SPH_ERR_MEMORY;
  return SPH_OK;
}

sph_fast *sph_fast_create(sph_integrator *it, int order)
{
  sph_fast *fast = SPH_NEW(sph_fast, 1, "the stepper of the fast part", it->problem.error);
  sph_integrator_info info = {0};
  if (!fast) return NULL;
  int row = sph_integrator_table_find(method_of(&it->def, order), it->problem.error);
  fast->it = it;
  fast->h = INFINITY;
  fast->table = sph_integrator_table_butcher(row);
  if (fast->table && sph_integrator_table_info(row, &info)) {
    fast->fsal = sph_integrator_table_fsal(fast->table);
    fast->stability = info.stability;
    fast->adaptive = info.error_control && it->def.fast_tolerance >= 0 && !(it->def.fast_step > 0);
    fast->cfl = it->cfl_given > 0 ? it->cfl_given : sph_integrator_cfl(fast->adaptive);
    if (!vectors(fast)) return fast;
  }
  sph_error_set(it->problem.error, SPH_ERR_MEMORY, "out of memory: table of the fast part");
  sph_fast_free(fast);
  return NULL;
}

void sph_fast_free(sph_fast *fast)
{
  if (!fast) return;
  for (int i = 0; i < STAGES_MAX; i++)
    if (fast->K[i]) N_VDestroy(fast->K[i]);
  if (fast->z) N_VDestroy(fast->z);
  if (fast->error) N_VDestroy(fast->error);
  if (fast->weight) N_VDestroy(fast->weight);
  if (fast->table) ARKodeButcherTable_Free(fast->table);
  sph_memory_free(fast);
}

void sph_fast_reset(sph_fast *fast) { fast->h = INFINITY; }

int sph_fast_keep(sph_fast *fast, sph_keep *keep)
{
  return sph_keep_real(keep, "fast_step", 1, &fast->h);
}

/* ---- one step */

int sph_fast_rhs(sph_fast *fast, double t, N_Vector y, N_Vector ydot)
{
  if (sph_nvector_lost(y)) return fast->it->rhs_status = SPH_ERR_MEMORY;
  return sph_integrator_piece(fast->it, SPH_PIECE_FAST, t, y, ydot);
}

/* z = y + h sum of w_j K_j (j < n), with what the slow rates do meanwhile; y NULL: zero. */
static void combine(const sph_fast *fast, double t, double h, const double *w, int n, N_Vector y,
                    N_Vector z)
{
  const sph_fast_rates *in = fast->in;
  double c[STAGES_MAX + SPH_FAST_RATES_MAX + 1], slow[SPH_FAST_RATES_MAX] = {0};
  N_Vector X[STAGES_MAX + SPH_FAST_RATES_MAX + 1];
  int count = 0;
  if (y) c[count] = 1, X[count++] = y;
  for (int j = 0; j < n; j++) {
    if (w[j] == 0) continue;
    double theta = (t + fast->table->c[j] * h - in->shift) / in->scale, power = h * w[j];
    c[count] = power;
    X[count++] = fast->K[j];
    for (int k = 0; k < in->n; k++, power *= theta) slow[k] += power;
  }
  for (int k = 0; k < in->n; k++)
    if (slow[k] != 0) c[count] = slow[k], X[count++] = in->rate[k];
  N_VLinearCombination(count, c, X, z);
}

/* All K but the first; z is the last stage. */
static int stages(sph_fast *fast, double t, double h, N_Vector y)
{
  const ARKodeButcherTable table = fast->table;
  int status = SPH_OK;
  for (int i = 1; !status && i < table->stages; i++) {
    combine(fast, t, h, table->A[i], i, y, fast->z);
    status = sph_fast_rhs(fast, t + table->c[i] * h, fast->z, fast->K[i]);
  }
  return status;
}

/* The error of these stages, in units of the tolerance. */
static double estimate(const sph_fast *fast, double t, double h)
{
  const ARKodeButcherTable table = fast->table;
  double w[STAGES_MAX];
  if (!fast->adaptive) return 0;
  for (int j = 0; j < table->stages; j++) w[j] = table->b[j] - table->d[j];
  combine(fast, t, h, w, table->stages, NULL, fast->error);
  return N_VWrmsNorm(fast->error, fast->weight);
}

/* ---- from one slow stage to the next */

/* 1/(tolerance scale), at the start. */
static int weigh(sph_fast *fast, N_Vector y)
{
  const sph_problem *problem = &fast->it->problem;
  int status = SPH_OK;
  if (!fast->adaptive) return SPH_OK;
  if (problem->weights)
    status = problem->weights(y, fast->weight, problem->ctx);
  else
    N_VConst(1, fast->weight);
  if (!status) N_VScale(1 / fast->it->def.fast_tolerance, fast->weight, fast->weight);
  return status;
}

/* After an evaluation at (t, y). */
static int look(sph_fast *fast, double t, N_Vector y)
{
  const sph_integrator *it = fast->it;
  sph_step_limit limit;
  int status = SPH_OK;
  for (int k = 0; k < SPH_BOUND_COUNT; k++) limit.dt[k] = INFINITY;
  if (it->problem.limits_fast) status = it->problem.limits_fast(t, y, &limit, it->problem.ctx);
  limit.dt[SPH_BOUND_CFL] *= fast->cfl * fast->stability;
  fast->limit = INFINITY;
  for (int k = 0; k < SPH_BOUND_COUNT; k++)
    if (!(limit.dt[k] >= fast->limit)) fast->limit = limit.dt[k];
  if (status || fast->limit < INFINITY || fast->adaptive || it->def.fast_step > 0) return status;
  return sph_integrator_fail(fast->it, SPH_ERR_ARGUMENT,
                             "nothing limits steps of the fast part; right is a limit, fast_step "
                             "or fast_tolerance");
}

/* K_0 at (t, y), and the limits there. */
static int begin(sph_fast *fast, double t, N_Vector y)
{
  int status = sph_fast_rhs(fast, t, y, fast->K[0]);
  return status ? status : look(fast, t, y);
}

/* y at the end of a step, and with a table whose last stage is there K_0 of the next one. */
static int finish(sph_fast *fast, double t, double h, N_Vector y, int *begun)
{
  const int last = fast->table->stages - 1;
  fast->it->stats.fast_steps++;
  *begun = fast->fsal;
  if (!fast->fsal) {
    combine(fast, t, h, fast->table->b, last + 1, y, y);
    return SPH_OK;
  }
  N_Vector K = fast->K[0];
  fast->K[0] = fast->K[last];
  fast->K[last] = K;
  N_VScale(1, fast->z, y);
  return look(fast, t + h, y);
}

/* Steps left, all equal, none longer than it may be. */
static double steps(const sph_fast *fast, double left)
{
  double given = fast->it->def.fast_step;
  double longest = given > 0 ? given : fmin(fast->h, fast->limit);
  return ceil(fmax(1, left / longest * (1 - CLOSE)));
}

/* Integral controller with the bounds of the slow one. */
static void control(sph_fast *fast, double h, double error)
{
  double factor = 0.1;
  if (error < INFINITY) factor = 0.9 * pow(fmax(error, 1e-10), -1.0 / fast->table->q);
  fast->h = h * fmin(fmax(factor, 0.1), 5);
}

int sph_fast_evolve(sph_fast *fast, const sph_fast_rates *rates, double t0, double t1, N_Vector y)
{
  double t = t0, length = t1 - t0;
  int begun = 0, refused = 0, status = weigh(fast, y);
  fast->in = rates;
  while (!status && t < t1) {
    if (!begun) status = begin(fast, t, y);
    if (status) break;
    begun = 1;
    double left = t1 - t, n = steps(fast, left), h = left / n, error = 0;
    if (!(h > SHORTEST * length)) { /* a shorter slow step may do */
      fast->it->reason = "the fast part wants ever shorter steps";
      return SPH_RETRY;
    }
    refused = stages(fast, t, h, y);
    if (!refused) error = estimate(fast, t, h);
    if (fast->adaptive) control(fast, h, refused ? INFINITY : error);
    if (refused < 0 || (refused && !fast->adaptive)) return refused;
    if (refused || !(error <= 1)) {
      fast->it->stats.fast_rejected++;
      continue;
    }
    status = finish(fast, t, h, y, &begun);
    t = n > 1 ? t + h : t1;
  }
  return status;
}
