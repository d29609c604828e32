/* Which particle made a step fail, and what acts on it.
 *
 * It is the one that an evaluation refused, if one was; else, in the last good state, the fastest
 * where waves and motion bind the steps, and where anything else does, that of the largest
 * acceleration. */
#include "sim_failure.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "sim_power.h"
#include "sim_run.h"
#include "sphode/measure.h"

void sph_sim_failure_suspect(sph_sim *sim, int group, long i)
{
  sim->suspect = (sph_suspect){.known = 1, .group = group, .i = i};
}

sph_error sph_sim_failure_aside(sph_sim *sim)
{
  sph_error error = sim->error;
  sim->error = (sph_error){0};
  return error;
}

static void say(sph_error *failure, const char *format, ...) SPH_PRINTF(2, 3);
static void say(sph_error *failure, const char *format, ...)
{
  const size_t used = strlen(failure->text);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(failure->text + used, sizeof failure->text - used, format, arguments);
  va_end(arguments);
}

static double length_of(const sph_sim *sim, double *const v[3], long i)
{
  double sum = 0;
  for (int d = 0; d < sim->dim; d++) sum += v[d][i] * v[d][i];
  return sqrt(sum);
}

/* The accelerations of all terms together, in total. */
static int add_terms(sph_sim *sim, N_Vector ydot, N_Vector total)
{
  int status = SPH_OK;
  N_VConst(0, total);
  for (int k = 0; !status && sph_sim_power_term(sim, k); k++) {
    sph_evaluation e;
    sph_part part;
    status = sph_sim_power_rates(sim, k, ydot, &part, &e);
    if (!status) N_VLinearSum(1, total, 1, ydot, total);
  }
  return status;
}

static void find(sph_sim *sim, N_Vector total)
{
  const int fastest = sph_integrator_bound(sim->integrator) == SPH_BOUND_CFL;
  double most = -1;
  for (int g = 0; g < sim->groups; g++) {
    const sph_view view =
        sph_group_data_view(sim->group[g], sph_nvector_data(sim->shown), sph_nvector_data(total));
    for (long i = 0; !sim->group[g]->wall && i < view.n; i++) {
      const double size =
          fastest ? view.c[i] + length_of(sim, view.v, i) : length_of(sim, view.dv, i);
      if (!(size > most)) continue;
      most = size;
      sph_sim_failure_suspect(sim, g, i);
    }
  }
}

static void say_vector(const sph_sim *sim, sph_error *failure, double *const v[3], long i)
{
  for (int d = 0; d < sim->dim; d++)
    say(failure, "%s%.6g%s", d ? ", " : "(", v[d][i], d + 1 < sim->dim ? "" : ")");
}

static void say_particle(const sph_sim *sim, sph_error *failure, N_Vector total)
{
  const sph_group *group = sim->group[sim->suspect.group];
  const long i = sim->suspect.i;
  const sph_view view =
      sph_group_data_view(group, sph_nvector_data(sim->shown), sph_nvector_data(total));
  say(failure, "; in the last good state, t = %.9g s, particle %ld of %s (id %ld) is at ",
      sim->time, i, group->name, sph_group_data_id(group, i));
  say_vector(sim, failure, view.x, i);
  say(failure, " m, velocity ");
  say_vector(sim, failure, view.v, i);
  say(failure, " m/s, density %.6g kg/m^3", view.rho[i]);
  if (view.p) say(failure, ", pressure %.6g Pa", view.p[i]);
  say(failure, ", acceleration %.3g m/s^2", length_of(sim, view.dv, i));
}

/* ": pressure 3e+08, gravity 9.81" */
static int say_terms(sph_sim *sim, sph_error *failure, N_Vector ydot)
{
  int status = SPH_OK, said = 0;
  for (int k = 0; !status && sph_sim_power_term(sim, k); k++) {
    sph_evaluation e;
    sph_part part;
    status = sph_sim_power_rates(sim, k, ydot, &part, &e);
    if (status) break;
    const double a = length_of(sim, e.view[sim->suspect.group].dv, sim->suspect.i);
    if (a > 0) say(failure, "%s%s %.3g", said++ ? ", " : ", by ", sph_sim_power_term(sim, k), a);
  }
  return status;
}

static const char *remedy(const sph_sim *sim)
{
  if (sim->integrator_def.dt_fixed > 0)
    return "a smaller dt_fixed, or none: then steps are as long as their limits allow, and are "
           "halved where they fail";
  switch (sph_integrator_bound(sim->integrator)) {
  case SPH_BOUND_CFL:
    return "a larger sound speed (ten times the largest speed), more viscosity, a smaller cfl";
  case SPH_BOUND_VISCOUS:
  case SPH_BOUND_CONDUCTION: return "a density that stays near its reference, an implicit part";
  case SPH_BOUND_FORCE: return "a start without overlaps, forces and motions that begin smoothly";
  case SPH_BOUND_ERROR: return "forces and motions without jumps, a larger tolerance";
  default: return "a smaller cfl or tolerance, more viscosity, forces that begin smoothly";
  }
}

static void describe(sph_sim *sim, sph_error *failure)
{
  N_Vector ydot = sph_nvector_clone(sim->y, "rates of one term", &sim->error);
  N_Vector total = sph_nvector_clone(sim->y, "rates of all terms", &sim->error);
  if (ydot && total && !add_terms(sim, ydot, total)) {
    if (!sim->suspect.known) find(sim, total);
    if (sim->suspect.known) {
      say_particle(sim, failure, total);
      say_terms(sim, failure, ydot);
      if (!strstr(failure->text, "; right is ")) /* else it has said so */
        say(failure, ". What helps: %s", remedy(sim));
    }
  }
  if (ydot) N_VDestroy(ydot);
  if (total) N_VDestroy(total);
}

void sph_sim_failure_tell(sph_sim *sim)
{
  sph_error failure = sph_sim_failure_aside(sim);
  describe(sim, &failure);
  sim->error = (sph_error){0};
  sim->derived = 0;
  /* What cannot be written does not hide why the run failed. */
  if (sph_sim_run_frame_all(sim))
    say(&failure, "; not all outputs have that state: %.300s", sim->error.text);
  sim->error = failure;
}
