/* The run: steps, and frames at their exact times by dense output, so that no frame shortens a
 * step. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "clock.h"
#include "sim_parts.h"
#include "sim_prepare.h"
#include "sim_rhs.h"
#include "sim_run.h"

static void show(sph_sim *sim, double t, N_Vector state)
{
  sim->shown = state;
  sim->time = t;
  sim->derived = 0;
}

int sph_sim_run_derived(sph_sim *sim)
{
  if (sim->derived) return SPH_OK;
  int status = sph_sim_rhs_show(sim, sim->time, sim->shown);
  if (status > 0) status = sph_sim_fail(sim, SPH_ERR_STEP, "t = %g s: %s", sim->time, sim->retry);
  sim->derived = !status;
  return status;
}

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

static int frame(sph_sim *sim, sph_outlet *outlet)
{
  int status = sph_sim_run_derived(sim);
  if (!status) status = outlet->output.frame(outlet->output.ctx, sim, &sim->error);
  outlet->frames++;
  return status;
}

/* All frames due in (previous, time] of the last step. */
static int frames(sph_sim *sim)
{
  double now = sph_integrator_time(sim->integrator);
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->outlets; k++) {
    sph_outlet *outlet = &sim->outlet[k];
    double last = sph_integrator_previous(sim->integrator);
    if (now - last > MOST_FRAMES * outlet->output.interval && outlet->output.interval > 0)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "output %s: an interval of %g s in steps of %g s",
                          outlet->output.name ? outlet->output.name : "", outlet->output.interval,
                          now - last);
    double slack = 1e-9 * outlet->output.interval; /* a frame at the end is not lost to rounding */
    for (double t = due(outlet); !status && isfinite(t) && t <= now + slack; t = due(outlet)) {
      if (t < now) {
        status = sph_integrator_interpolate(sim->integrator, t, sim->frame);
        show(sim, t, sim->frame);
      }
      if (!status) status = frame(sim, outlet);
      show(sim, now, sim->y);
    }
    if (!status && outlet->output.interval == 0) status = frame(sim, outlet);
  }
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
    outlet->frames = 0;
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

int sph_sim_run_step(sph_sim *sim, double t_stop)
{
  sim->retry[0] = 0;
  int status = sph_integrator_step(sim->integrator, t_stop);
  show(sim, sph_integrator_time(sim->integrator), sim->y);
  if (status && sim->retry[0]) { /* why the evaluations asked for smaller steps */
    size_t used = strlen(sim->error.text);
    snprintf(sim->error.text + used, sizeof sim->error.text - used, "; the last reason: %s",
             sim->retry);
  }
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
  status = open_outputs(sim);
  while (!status && sim->time < t_end) {
    status = sph_sim_run_step(sim, t_end);
    if (!status) status = frames(sim);
    if (!status && sim->progress && sim->progress(sim->progress_ctx, sim))
      status = sph_sim_fail(sim, SPH_ERR_STOPPED, "stopped on request at t = %g s", sim->time);
  }
  for (int k = 0; !status && k < sim->outlets; k++) /* INFINITY: start and end only */
    if (isinf(sim->outlet[k].output.interval)) status = frame(sim, &sim->outlet[k]);
  if (status) sph_sim_run_close(sim);
  return status;
}

int sph_sim_run(sph_sim *sim, double t_end)
{
  double begin = sph_clock();
  int status = run(sim, t_end);
  if (sim) sim->seconds += sph_clock() - begin;
  return status;
}
