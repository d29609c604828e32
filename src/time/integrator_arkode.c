#include "integrator_arkode.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "integrator_table.h"
#include "keep.h"
#include "memory.h"
#include "nvector.h"
#include "relax.h"

static const double CLOSE = 1e-6; /* relative: such step sizes are the same */
static const double GROWTH = 5, FIRST_GROWTH = 10;

/* ARKODE goes on with vectors that got no memory: their operations do nothing, and here it ends.
 * */
int sph_integrator_arkode_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  sph_integrator *it = data;
  sph_integrator_arkode *own = it->own;
  if (sph_nvector_lost(y)) return it->rhs_status = SPH_ERR_MEMORY;
  own->rates = ydot;
  own->rates_t = t;
  if (!own->use_kept) return sph_integrator_rhs(it, t, y, ydot);
  own->use_kept = 0;
  N_VScale(1, own->kept, ydot);
  return it->rhs_status = SPH_OK;
}

int sph_integrator_arkode_piece(sph_integrator *it, int piece, double t, N_Vector y, N_Vector ydot)
{
  if (sph_nvector_lost(y)) return it->rhs_status = SPH_ERR_MEMORY;
  return sph_integrator_piece(it, piece, t, y, ydot);
}

/* 1 / (tolerance scale); without error control any positive weights do. */
static int weigh(N_Vector y, N_Vector weight, void *data)
{
  sph_integrator *it = data;
  if (sph_nvector_lost(y)) return it->rhs_status = SPH_ERR_MEMORY;
  if (!it->adaptive || !it->problem.weights) {
    N_VConst(it->adaptive ? 1 / it->def.tolerance : 1, weight);
    return 0;
  }
  int status = it->problem.weights(y, weight, it->problem.ctx);
  if (!status) N_VScale(1 / it->def.tolerance, weight, weight);
  return status;
}

/* ARKODE takes the fraction 1/2 of this, an exact number: the limits are ours. */
static int stable(N_Vector y, sunrealtype t, sunrealtype *h, void *data)
{
  sph_integrator *it = data;
  int status = sph_integrator_limit(it, t, y);
  double limit = fmin(it->limit, 2 * it->cap); /* cap is that of the step that just ends */
  *h = limit < INFINITY ? 2 * limit : 0;       /* 0: none */
  return status;
}

static double control(double h, double error, void *data)
{
  sph_integrator *it = data;
  sph_integrator_arkode *own = it->own;
  return sph_controller_next(&it->controller, it->info.order, h, error, &own->past);
}

static void listen(const char *text, void *data)
{
  sph_integrator_arkode *own = data;
  snprintf(own->text, sizeof own->text, "%s", text);
}

/* Nothing is left to the defaults of ARKODE, which differ between versions. */
static int configure(sph_integrator *it, sph_integrator_arkode *own)
{
  const sph_sundials_calls *call = own->call;
  void *m = own->memory;
  int failed =
      call->set_user_data(m, it) || (call->wf_tolerances && call->wf_tolerances(m, weigh)) ||
      call->set_interpolant_type(m, ARK_INTERP_HERMITE) || call->set_interpolant_degree(m, 3);
  if (failed || !it->adaptive) return failed;
  own->controller = (sph_sundials_controller){.step = control, .ctx = it};
  return sph_sundials_control(call, m, own->context, &own->controller) ||
         call->set_stability_fn(m, stable, it) || call->set_cfl_fraction(m, 0.5) ||
         call->set_safety_factor(m, 0.9) || call->set_max_growth(m, GROWTH) ||
         call->set_max_first_growth(m, FIRST_GROWTH) || call->set_min_reduction(m, 0.1) ||
         call->set_fixed_step_bounds(m, 1, 1) || call->set_max_efail_growth(m, 0.3) ||
         call->set_small_num_efails(m, 2) || call->set_max_err_test_fails(m, 12);
}

sph_integrator_arkode *sph_integrator_arkode_create(sph_integrator *it, SUNContext context,
                                                    const sph_sundials_calls *call)
{
  sph_integrator_arkode *own = it->own =
      SPH_NEW(sph_integrator_arkode, 1, "an integrator of ARKODE", it->problem.error);
  if (!own) return NULL;
  *own = (sph_integrator_arkode){.context = context, .call = call, .fresh = 1};
  sph_controller_forget(&own->past);
  return own;
}

int sph_integrator_arkode_configure(sph_integrator *it)
{
  sph_integrator_arkode *own = it->own;
  if (!own->memory || sph_nvector_lost(it->y)) return SPH_ERR_MEMORY;
  own->listener = (sph_sundials_listener){.listen = listen, .ctx = own};
  own->listening = !sph_sundials_listen(own->call, own->memory, own->context, &own->listener);
  if (!own->listening || configure(it, own) || sph_nvector_lost(it->y)) return SPH_ERR_MEMORY;
  return sph_relax_attach(it);
}

void sph_integrator_arkode_free(sph_integrator *it)
{
  sph_integrator_arkode *own = it->own;
  if (!own) return;
  if (own->memory) own->call->free(&own->memory);
  sph_sundials_control_free(&own->controller);
  if (own->listening) sph_sundials_deaf(own->context);
  if (own->kept) N_VDestroy(own->kept);
  sph_memory_free(own);
}

/* What ARKODE's flag means; an evaluation that failed knows better. */
static int outcome(sph_integrator *it, int flag)
{
  const sph_integrator_arkode *own = it->own;
  if (sph_nvector_lost(it->y)) return sph_integrator_fail(it, SPH_ERR_MEMORY, "out of memory");
  if (flag >= 0) return SPH_OK;
  if (it->rhs_status) return it->rhs_status;
  if (sph_relax_failed(flag)) {
    it->reason = "no step near it keeps the energy";
    return SPH_RETRY;
  }
  if (flag == SPH_SUNDIALS_MANY_STAGES) {
    it->reason = "it takes more than 200 stages";
    return SPH_RETRY;
  }
  int status = flag == ARK_MEM_FAIL ? SPH_ERR_MEMORY : SPH_ERR_STEP;
  return sph_integrator_fail(it, status, own->text[0] ? own->text : "SUNDIALS failed");
}

int sph_integrator_arkode_reject(sph_integrator *it)
{
  sph_integrator_arkode *own = it->own;
  own->fresh = 1;
  own->resume = own->ahead = 0;
  own->use_kept = 0;
  own->end = it->time;
  sph_controller_forget(&own->past);
  it->rhs_status = 0;
  return outcome(it, own->call->reset(own->memory, it->time, it->y));
}

/* ARKODE took a copy of y when it was created: it is told of the y there is now.  The problem's
 * limits need rates at (time, y): of slow steps those of the slow part, of implicit ones all, since
 * what is stiff may start with a layer that the first step is to see.  `before` is free at that
 * moment. */
int sph_integrator_arkode_start(sph_integrator *it)
{
  int status = SPH_OK;
  if (it->problem.limits && (it->info.wants & SPH_WANTS_FAST))
    status = sph_integrator_piece(it, SPH_PIECE_EXPLICIT, it->time, it->y, it->before);
  else if (it->problem.limits)
    status = sph_integrator_rhs(it, it->time, it->y, it->before);
  return status ? status : sph_integrator_arkode_reject(it);
}

/* Sets out from a checkpoint with the step that ARKODE had in mind there.  If it goes beyond the
 * stop time, ARKODE makes it last (cut/last), cut = left (1 - 4 eps), which may differ from cut. */
static int go_ahead(const sph_integrator *it, double t_stop)
{
  const sph_integrator_arkode *own = it->own;
  double h = own->ahead, cut = (t_stop - it->time) * (1 - 4 * DBL_EPSILON);
  if (it->time + h > t_stop || h == cut) h = own->last * (cut / own->last);
  int failed = own->call->set_max_first_growth(own->memory, GROWTH);
  return failed ? failed : own->call->set_init_step(own->memory, h);
}

/* From now on ARKODE knows the steps itself. */
static int went_ahead(sph_integrator_arkode *own)
{
  if (!(own->ahead > 0)) return 0;
  own->ahead = 0;
  return own->call->set_max_first_growth(own->memory, FIRST_GROWTH);
}

/* The step that ARKODE will try, and what it needs for it. */
static int prepare(sph_integrator *it, const sph_attempt *a, double t_stop, double *h)
{
  sph_integrator_arkode *own = it->own;
  *h = a->h;
  if (it->def.relax &&
      own->end != it->time) { /* the last step ended at a stop time, all but a relaxation */
    int status = sph_integrator_arkode_reject(it);
    if (status) return status;
  }
  if (!it->adaptive) return own->call->set_fixed_step(own->memory, a->h);
  if (own->resume > 0) {
    *h = fmin(*h, own->resume);
    int status = sph_integrator_arkode_reject(it);
    if (status) return status;
  }
  if (own->fresh && it->first < 0.9 * *h) *h = it->first; /* else the limit binds as before */
  if (own->fresh) return own->call->set_init_step(own->memory, *h < INFINITY ? *h : 0);
  if (!(own->ahead > 0)) return own->call->get_current_step(own->memory, h);
  *h = own->ahead;
  return go_ahead(it, t_stop);
}

/* A relaxed step to a stop time ends beside it.  As if it had not: its state is that of the stop
 * time, with an error of the order of the step's.  (A step that its error has shortened is shorter
 * by more than that.) */
static int missed(const sph_integrator *it, double t, double t_stop)
{
  const sph_integrator_arkode *own = it->own;
  double left = t_stop - it->time;
  return it->def.relax && own->trial >= left * (1 - CLOSE) && t_stop - t < 0.05 * left;
}

int sph_integrator_arkode_attempt(sph_integrator *it, sph_attempt *a, double t_stop)
{
  sph_integrator_arkode *own = it->own;
  double t = it->time, left = t_stop - it->time, h = 0;
  own->text[0] = 0;
  it->rhs_status = 0;
  int flag = prepare(it, a, t_stop, &h);
  own->trial = h;
  if (flag >= 0) flag = own->call->set_stop_time(own->memory, t_stop);
  if (flag >= 0) flag = own->call->evolve(own->memory, t_stop, it->y, &t, ARK_ONE_STEP);
  if (went_ahead(own)) flag = -1;
  if (flag < 0 || sph_nvector_lost(it->y)) {
    a->h = fmin(h, left);
    return outcome(it, flag);
  }
  own->fresh = 0;
  it->first = INFINITY;
  own->end = t;
  int stopped = flag == ARK_TSTOP_RETURN || missed(it, t, t_stop);
  a->t = stopped ? t_stop : t;
  a->h = a->t - it->time;
  if (!it->adaptive) return SPH_OK;
  own->call->get_num_err_test_fails(own->memory, &it->stats.rejected);
  it->stats.rejected += it->rejected;
  if (a->h < a->limit * (1 - CLOSE)) a->bound = stopped ? SPH_BOUND_STOP : SPH_BOUND_ERROR;
  /* A controller that grows steps slowly should not see the one that was cut short. */
  double short_step = sph_controller_remembers(&it->controller) ? 0.9 : 0.2;
  if (a->bound == SPH_BOUND_STOP && a->h < short_step * it->stats.dt_last)
    own->resume = it->stats.dt_last;
  if (own->resume > 0)
    it->next = own->resume;
  else
    own->call->get_current_step(own->memory, &it->next);
  return sph_integrator_controlled(it, a);
}

int sph_integrator_arkode_interpolate(sph_integrator *it, double t, N_Vector at)
{
  sph_integrator_arkode *own = it->own;
  it->rhs_status = 0;
  return outcome(it, own->call->get_dky(own->memory, it->def.relax ? fmin(t, own->end) : t, 0, at));
}

/* The steps that ARKODE took and is about to take, which it keeps to itself. */
static int keep_steps(const sph_integrator *it, sph_integrator_arkode *own, sph_keep *keep)
{
  double ahead = own->ahead, last = own->last;
  int failed = 0;
  if (!sph_keep_reading(keep) && !own->fresh && !(ahead > 0))
    failed = own->call->get_current_step(own->memory, &ahead) ||
             own->call->get_last_step(own->memory, &last);
  if (failed) return sph_error_set(keep->error, SPH_ERR_STATE, "%s has no steps", it->info.name);
  sph_keep_real(keep, "ahead", 1, &ahead);
  int status = sph_keep_real(keep, "last", 1, &last);
  if (!sph_keep_reading(keep)) return status;
  own->ahead = ahead;
  own->last = last;
  return status;
}

static int keep_rates(sph_integrator *it, sph_integrator_arkode *own, sph_keep *keep)
{
  const int reading = sph_keep_reading(keep);
  const long n = sph_nvector_layout(it->y)->length;
  int there = own->use_kept || (own->fsal && !it->def.relax && !own->fresh && own->rates &&
                                own->rates_t == it->time);
  int status = sph_keep_int(keep, "rates_kept", &there);
  if (status || !there) return status;
  if (reading && !own->kept) own->kept = sph_nvector_clone(it->y, "rates", keep->error);
  if (reading && !own->kept) return SPH_ERR_MEMORY;
  N_Vector rates = reading || own->use_kept ? own->kept : own->rates;
  own->use_kept |= reading;
  return sph_keep_real(keep, "rates", n, sph_nvector_data(rates));
}

int sph_integrator_arkode_keep(sph_integrator *it, sph_keep *keep)
{
  sph_integrator_arkode *own = it->own;
  const int reading = sph_keep_reading(keep);
  double past[3] = {own->past.error[0], own->past.error[1], own->past.h};
  int status = reading ? sph_integrator_arkode_reject(it) : SPH_OK;
  if (status) return status;
  sph_keep_int(keep, "fresh", &own->fresh);
  sph_keep_real(keep, "resume", 1, &own->resume);
  sph_keep_real(keep, "end", 1, &own->end);
  status = sph_keep_real(keep, "past", 3, past);
  if (reading) own->past = (sph_controller_past){.error = {past[0], past[1]}, .h = past[2]};
  if (!status) status = keep_rates(it, own, keep);
  return status || !it->adaptive ? status : keep_steps(it, own, keep);
}
