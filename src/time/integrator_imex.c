/* ARKODE's implicit-explicit Runge-Kutta pairs, y' = f_E + f_I (ARKStep).
 *
 * An implicit stage is z = known + gamma f_I(t, z), which the problem itself solves: it knows that
 * f_I is, say, linear in the velocities once positions are given, and f_I leaves positions alone,
 * so that these are exact in `known` and one linear system a stage does.  To ARKODE this is a
 * nonlinear solver: it asks for the correction z - z_pred, and has in `sdata` what makes
 * known = z_pred + sdata.  f_I of the stage is then (z - known)/gamma (deduced), not evaluated. */
#include "integrator_arkode.h"
#include "integrator_table.h"
#include "memory.h"
#include "nvector.h"

#define ARK(function) SPH_SUNDIALS(ARKStep, function)

typedef struct imex {
  SUNNonlinearSolver solver; /* its content: the integrator */
  N_Vector known, z;
  double t; /* of z, if that is a stage of the attempt at work; else that of its start [s] */
} imex;

static int rhs_explicit(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  return sph_integrator_arkode_piece(data, SPH_PIECE_EXPLICIT, t, y, ydot);
}

static int rhs_implicit(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  return sph_integrator_arkode_piece(data, SPH_PIECE_IMPLICIT, t, y, ydot);
}

static SUNNonlinearSolver_Type type(SUNNonlinearSolver solver)
{
  (void)solver;
  return SUNNONLINEARSOLVER_ROOTFIND;
}

static int take_no_system(SUNNonlinearSolver solver, SUNNonlinSolSysFn system)
{
  (void)solver, (void)system; /* the problem knows its own */
  return 0;
}

static int begin(SUNNonlinearSolver solver, N_Vector y, void *memory)
{
  sph_integrator *it = solver->content;
  ((imex *)((sph_integrator_arkode *)it->own)->kind)->t = it->time;
  (void)y, (void)memory;
  return 0;
}

/* The straight line from the state y at the start of the step to the last stage, at t: it spares an
 * iterative solver a third of its iterations. */
static void guess(const sph_integrator *it, imex *own, N_Vector y, double t)
{
  double part = own->t > it->time ? (t - it->time) / (own->t - it->time) : 0;
  if (part > 0)
    N_VLinearSum(part, own->z, 1 - part, y, own->z);
  else
    N_VScale(1, y, own->z);
  own->t = t;
}

/* A stage that cannot be solved ends the attempt; our loop repeats it with half the step. */
static int solve(SUNNonlinearSolver solver, N_Vector y, N_Vector correction, N_Vector weight,
                 sunrealtype tolerance, sunbooleantype setup, void *memory)
{
  sph_integrator *it = solver->content;
  imex *own = ((sph_integrator_arkode *)it->own)->kind;
  N_Vector predicted, current, rate, sdata;
  double t, gamma;
  void *data;
  (void)y, (void)weight, (void)tolerance, (void)setup;
  if (sph_nvector_lost(it->y)) return it->rhs_status = SPH_ERR_MEMORY;
  if (ARK(GetNonlinearSystemData)(memory, &t, &predicted, &current, &rate, &gamma, &sdata, &data))
    return SPH_ERR_STEP;
  N_VLinearSum(1, predicted, 1, sdata, own->known);
  guess(it, own, predicted, t);
  sph_stage stage = {.t = t,
                     .gamma = gamma,
                     .tolerance = it->def.stage_tolerance,
                     .known = own->known,
                     .z = own->z};
  it->rhs_status = it->problem.solve(&stage, it->problem.ctx);
  it->stats.solves++;
  it->stats.solve_iterations += stage.iterations;
  N_VLinearSum(1, own->z, -1, predicted, correction);
  return it->rhs_status ? SPH_ERR_STEP : 0;
}

static int attach(sph_integrator *it, imex *own, void *memory, SUNContext context)
{
  own->solver = SUNNonlinSolNewEmpty(context);
  if (!own->solver) return -1;
  own->solver->content = it;
  own->solver->ops->gettype = type;
  own->solver->ops->setsysfn = take_no_system;
  own->solver->ops->setup = begin;
  own->solver->ops->solve = solve;
  return ARK(SetNonlinearSolver)(memory,
                                 own->solver) || /* relaxation wants f_I of the stages themselves */
         ARK(SetDeduceImplicitRhs)(memory, !it->def.relax) ||
         ARK(SetPredictorMethod)(memory, 0);
}

static int set_tables(void *memory, int row)
{
  ARKodeButcherTable pair[2];
  if (!sph_integrator_table_pair(row, pair)) return -1;
  int failed = ARKStepSetTables(memory, pair[0]->q, pair[0]->p, pair[1], pair[0]);
  ARKodeButcherTable_Free(pair[0]);
  ARKodeButcherTable_Free(pair[1]);
  return failed;
}

static int create(sph_integrator *it, SUNContext context)
{
  if (!it->problem.rhs_piece || !it->problem.solve)
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "integrator %s solves for the implicit part of f, and there is none; "
                         "right is a part, or an explicit integrator (\"erk:...\")",
                         it->info.name);
  sph_integrator_arkode *shared = sph_integrator_arkode_create(it, context, &sph_sundials_ark);
  imex *own = SPH_NEW(imex, 1, "an implicit-explicit integrator", it->problem.error);
  if (!shared || !own) {
    sph_memory_free(own);
    return SPH_ERR_MEMORY;
  }
  shared->kind = own;
  own->known = sph_nvector_clone(it->y, "a stage's known part", it->problem.error);
  own->z = sph_nvector_clone(it->y, "a stage", it->problem.error);
  if (!own->known || !own->z) return SPH_ERR_MEMORY;
  shared->memory = ARKStepCreate(rhs_explicit, rhs_implicit, it->time, it->y, context);
  int status = sph_integrator_arkode_configure(it);
  if (!status && (attach(it, own, shared->memory, context) || set_tables(shared->memory, it->row)))
    status = SPH_ERR_MEMORY;
  return status;
}

static void release(sph_integrator *it)
{
  sph_integrator_arkode *shared = it->own;
  imex *own = shared ? shared->kind : NULL;
  sph_integrator_arkode_free(it);
  if (!own) return;
  SUNNonlinSolFreeEmpty(own->solver);
  if (own->known) N_VDestroy(own->known);
  if (own->z) N_VDestroy(own->z);
  sph_memory_free(own);
}

const sph_stepper sph_integrator_imex = {
    create,
    release,
    sph_integrator_arkode_start,
    sph_integrator_arkode_attempt,
    sph_integrator_arkode_reject,
    sph_integrator_arkode_interpolate,
    sph_integrator_arkode_keep,
    NULL,
};
