/* The run: steps, and what belongs to moments in them: frames and events at their exact times by
 * dense output, so that none of them shortens a step. */
#include "sim_run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "clock.h"
#include "sim_event.h"
#include "sim_extremes.h"
#include "sim_failure.h"
#include "sim_keep.h"
#include "sim_mirror.h"
#include "sim_parts.h"
#include "sim_prepare.h"
#include "sim_rhs.h"

int sph_sim_run_show(sph_sim *sim, double t)
{
  int now = t == sph_integrator_time(sim->integrator), status = SPH_OK;
  if (!now) status = sph_integrator_interpolate(sim->integrator, t, sim->frame);
  sim->shown = now ? sim->y : sim->frame;
  sim->time = t;
  sim->derived = 0;
  return status;
}

static void show_end(sph_sim *sim) { sph_sim_run_show(sim, sph_integrator_time(sim->integrator)); }

int sph_sim_run_derived(sph_sim *sim)
{
  if (sim->derived) return SPH_OK;
  int status = sph_sim_rhs_show(sim, sim->time, sim->shown);
  if (status > 0) status = sph_sim_fail(sim, SPH_ERR_STEP, "t = %g s: %s", sim->time, sim->retry);
  sim->derived = !status;
  return status;
}

/* ---- frames ---- */

static const double MOST_FRAMES = 1e6; /* in one step */

/* Time of an outlet's next frame; interval 0: written after every step instead. */
static double due(const sph_outlet *outlet)
{
  double interval = outlet->output.interval;
  return interval > 0 ? outlet->start + (double)outlet->frames * interval : INFINITY;
}

/* Frames due in time that was stepped through without a run (sph_sim_step) are not written. */
static void skip_past(const sph_sim *sim, sph_outlet *outlet)
{
  double interval = outlet->output.interval;
  if (!(interval > 0 && interval < INFINITY) || due(outlet) > sim->time) return;
  outlet->frames = (long)fmin(1e15, floor((sim->time - outlet->start) / interval) + 1);
}

/* A frame of the state shown, unless it has one of this moment. */
static int frame(sph_sim *sim, sph_outlet *outlet)
{
  if (outlet->last == sim->time) return SPH_OK;
  int status = sph_sim_run_derived(sim);
  if (!status) status = outlet->output.frame(outlet->output.ctx, sim, &sim->error);
  outlet->last = sim->time;
  return status;
}

int sph_sim_run_frame_all(sph_sim *sim)
{
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->outlets; k++)
    if (sim->outlet[k].open) status = frame(sim, &sim->outlet[k]);
  return status;
}

static int check_interval(sph_sim *sim, const sph_output *output)
{
  double step = sph_integrator_time(sim->integrator) - sph_integrator_previous(sim->integrator);
  if (!(output->interval > 0) || step <= MOST_FRAMES * output->interval) return SPH_OK;
  return sph_sim_fail(
      sim, SPH_ERR_ARGUMENT,
      "output %s: an interval of %g s is too short for steps of %g s; right is at least %.2g s",
      output->name ? output->name : "", output->interval, step, step / MOST_FRAMES);
}

/* All frames due in the last step up to t. */
static int frames(sph_sim *sim, double t)
{
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->outlets; k++) {
    sph_outlet *outlet = &sim->outlet[k];
    status = check_interval(sim, &outlet->output);
    double slack = 1e-9 * outlet->output.interval; /* a frame at the end is not lost to rounding */
    for (; !status && isfinite(due(outlet)) && due(outlet) <= t + slack; outlet->frames++) {
      status = sph_sim_run_show(sim, fmin(due(outlet), t));
      if (!status) status = frame(sim, outlet);
    }
  }
  show_end(sim);
  return status;
}

/* Interval 0: a frame at the end of each step. */
static int frames_of_steps(sph_sim *sim)
{
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->outlets; k++)
    if (sim->outlet[k].output.interval == 0) status = frame(sim, &sim->outlet[k]);
  return status;
}

static int open_outputs(sph_sim *sim)
{
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->outlets; k++) {
    sph_outlet *outlet = &sim->outlet[k];
    if (outlet->open) {
      skip_past(sim, outlet);
      continue;
    }
    outlet->start = sim->time;
    outlet->frames = 1;
    outlet->last = NAN;
    if (outlet->output.open) status = outlet->output.open(outlet->output.ctx, sim, &sim->error);
    outlet->open = !status;
    if (!status) status = frame(sim, outlet);
  }
  return status;
}

void sph_sim_run_close(sph_sim *sim)
{
  for (int k = 0; k < sim->outlets; k++) {
    sph_outlet *outlet = &sim->outlet[k];
    if (outlet->open && outlet->output.close)
      outlet->output.close(outlet->output.ctx, sim, &sim->error);
    outlet->open = 0;
  }
}

/* ---- steps ---- */

static int step(sph_sim *sim, double t_stop)
{
  sim->retry[0] = 0;
  sim->suspect.known = 0;
  double from = sph_integrator_time(sim->integrator);
  int status = sph_integrator_step(sim->integrator, t_stop);
  show_end(sim);
  sph_sim_event_stepped(sim, from);
  if (status && sim->retry[0]) { /* why the evaluations asked for smaller steps */
    size_t used = strlen(sim->error.text);
    snprintf(sim->error.text + used, sizeof sim->error.text - used, "; the last reason: %s",
             sim->retry);
  }
  if (status == SPH_ERR_STEP) sph_sim_failure_tell(sim);
  return status;
}

/* Events and frames of the last step in the order of time, up to its end, or to the event that
 * cuts it short. */
static int look_back(sph_sim *sim, int framed, int *cut)
{
  double end = sph_integrator_time(sim->integrator), t = -INFINITY;
  int status = SPH_OK;
  while (!status && !*cut && t <= end) {
    status = sph_sim_event_next(sim, &t);
    if (!status && framed) status = frames(sim, fmin(t, end));
    if (!status && t <= end) status = sph_sim_event_happen(sim, t, cut);
  }
  if (!status && *cut) return sph_sim_event_cut(sim, t);
  show_end(sim);
  return status;
}

int sph_sim_run_step(sph_sim *sim, double t_stop, int framed)
{
  int cut = 0, status = sph_sim_event_start(sim);
  sim->stopped_by = NULL;
  if (!status) status = step(sim, t_stop);
  if (!status) sph_sim_extremes_step(sim);
  if (!status) status = look_back(sim, framed, &cut);
  if (!status && framed) status = frames_of_steps(sim);
  if (!status && cut) status = sph_sim_event_act(sim);
  if (!status) status = sph_sim_modifier_run(sim);
  if (!status) sph_sim_mirror_bounce(sim);
  if (!status) status = sph_sim_mirror_apart(sim);
  return status;
}

static int run(sph_sim *sim, double t_end)
{
  int status = sph_sim_prepare(sim);
  if (!status) status = sph_sim_parts_fit(sim);
  if (status) return status;
  if (!(isfinite(t_end) && t_end >= sim->time))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "t_end = %g s; right is finite and >= %g s, the present time", t_end,
                        sim->time);
  sim->stopped_by = NULL;
  status = open_outputs(sim);
  while (!status && sim->time < t_end && !sim->stopped_by) {
    status = sph_sim_run_step(sim, t_end, 1);
    if (!status) status = sph_sim_keep_save(sim, 0);
    if (!status && sim->progress && sim->progress(sim->progress_ctx, sim) && sim->time < t_end) {
      status = sph_sim_keep_save(sim, 1);
      if (!status)
        status = sph_sim_fail(sim, SPH_ERR_STOPPED, "stopped %s at t = %g s",
                              sim->why ? sim->why : "on request", sim->time);
    }
  }
  for (int k = 0; !status && k < sim->outlets; k++) /* INFINITY: start and end only */
    if (isinf(sim->outlet[k].output.interval)) status = frame(sim, &sim->outlet[k]);
  if (!status) status = sph_sim_keep_save(sim, 1);
  if (status) sph_sim_run_close(sim);
  return status;
}

int sph_sim_run_enter(sph_sim *sim)
{
  if (sim && sim->inside)
    return sph_sim_fail(sim, SPH_ERR_STATE,
                        "a run or step inside of another at t = %g s; right is none in callbacks "
                        "(terms, outputs, events, modifiers, progress)",
                        sim->time);
  if (sim) sim->inside = 1;
  return SPH_OK;
}

void sph_sim_run_leave(sph_sim *sim)
{
  if (sim) sim->inside = 0;
}

int sph_sim_run(sph_sim *sim, double t_end)
{
  double begin = sph_clock();
  if (!sim) return SPH_ERR_MEMORY;
  int status = sph_sim_run_enter(sim);
  if (status) return status;
  sim->begun = begin;
  status = run(sim, t_end);
  sph_sim_run_leave(sim);
  sim->seconds += sph_clock() - begin;
  sim->begun = 0;
  return status;
}
