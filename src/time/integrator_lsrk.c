/* ARKODE's low-storage schemes (LSRKStep): stabilised ones, with as many stages as the largest
 * eigenvalue asks for (Runge-Kutta-Chebyshev, -Legendre), and strong stability preserving ones. */
#include <math.h>
#include <string.h>

#include "integrator_arkode.h"
#include "integrator_kinds.h"
#include "nvector.h"

enum { NEEDS = 70200, STAGES_MAX = 200 };

static const struct {
  const char *name, *method;
  int order, stages; /* 0: as many as are needed */
  double stability;
} row[] = {
    {"lsrk:rkc-2", "ARKODE_LSRK_RKC_2", 2, 0, 0.5},
    {"lsrk:rkl-2", "ARKODE_LSRK_RKL_2", 2, 0, 0.5},
    {"lsrk:ssp-4-2", "ARKODE_LSRK_SSP_S_2", 2, 4, 2},
    {"lsrk:ssp-10-2", "ARKODE_LSRK_SSP_S_2", 2, 10, 2},
    {"lsrk:ssp-4-3", "ARKODE_LSRK_SSP_S_3", 3, 4, 2},
    {"lsrk:ssp-9-3", "ARKODE_LSRK_SSP_S_3", 3, 9, 2},
    {"lsrk:ssp-10-4", "ARKODE_LSRK_SSP_10_4", 4, 10, 2},
};
enum { ROWS = sizeof row / sizeof *row };

const char *sph_integrator_lsrk_known(int k, int *needs)
{
  *needs = NEEDS;
  return k < ROWS ? row[k].name : NULL;
}

int sph_integrator_lsrk_info(int k, sph_integrator_info *info)
{
  *info = (sph_integrator_info){.order = row[k].order,
                                .stages = row[k].stages,
                                .error_control = 1,
                                .stability = row[k].stability,
                                .wants = row[k].stages ? 0 : SPH_WANTS_DOMINANT};
  return 1;
}

#if SPH_SUNDIALS_NUMBER >= 70200
#include <arkode/arkode_lsrkstep.h>

/* It takes a failure > 0 for one that it may mend: halving steps is ours. */
static int rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *it)
{
  return sph_integrator_arkode_rhs(t, y, ydot, it) ? -1 : 0;
}

/* ARKODE takes s = sqrt(1.54 lambda dt) stages of Runge-Kutta-Chebyshev, stable up to
 * lambda dt = 0.653 (s^2 - 1) (Verwer, Sommeijer & Hundsdorfer 2004): too few by the -1. */
static const double FEW = 1 / 1.54;

static int dominant(sunrealtype t, N_Vector y, N_Vector f, sunrealtype *real,
                    sunrealtype *imaginary, void *data, N_Vector w1, N_Vector w2, N_Vector w3)
{
  sph_integrator *it = data;
  const sph_integrator_arkode *own = it->own;
  double lambda = 0;
  (void)f, (void)w1, (void)w2, (void)w3;
  it->rhs_status = it->problem.dominant(t, y, &lambda, it->problem.ctx);
  if (!it->rhs_status && !(lambda >= 0 && lambda < INFINITY)) it->rhs_status = SPH_RETRY;
  *real = -(lambda + (own->trial > 0 && own->trial < INFINITY ? FEW / own->trial : 0));
  *imaginary = 0;
  return it->rhs_status ? -1 : 0;
}

static int set_method(void *memory, int k)
{
  if (row[k].stages)
    return LSRKStepSetSSPMethodByName(memory, row[k].method) ||
           LSRKStepSetNumSSPStages(memory, row[k].stages);
  return LSRKStepSetSTSMethodByName(memory, row[k].method) ||
         LSRKStepSetDomEigFn(memory, dominant) || LSRKStepSetDomEigFrequency(memory, 1) ||
         LSRKStepSetDomEigSafetyFactor(memory, 1) || LSRKStepSetMaxNumStages(memory, STAGES_MAX);
}

static int create(sph_integrator *it, SUNContext context)
{
  sph_integrator_arkode *own = sph_integrator_arkode_create(it, context, &sph_sundials_lsrk);
  int k = 0;
  if (!own) return SPH_ERR_MEMORY;
  while (strcmp(row[k].name, it->info.name)) k++;
  if (!row[k].stages && !it->problem.dominant)
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "integrator %s needs a bound of the eigenvalues of df/dy, and there is "
                         "none",
                         it->info.name);
  own->memory = row[k].stages ? LSRKStepCreateSSP(rhs, it->time, it->y, context)
                              : LSRKStepCreateSTS(rhs, it->time, it->y, context);
  int status = sph_integrator_arkode_configure(it);
  if (!status && set_method(own->memory, k)) status = SPH_ERR_MEMORY;
  /* Of stabilised schemes SUNDIALS 7.5 keeps the rate at the end of a step for that at its start,
   * too: a polynomial without the latter. */
  if (!status && !row[k].stages && own->call->set_interpolant_degree(own->memory, 2))
    status = SPH_ERR_MEMORY;
  return status;
}

const sph_stepper sph_integrator_lsrk = {
    create,
    sph_integrator_arkode_free,
    sph_integrator_arkode_start,
    sph_integrator_arkode_attempt,
    sph_integrator_arkode_reject,
    sph_integrator_arkode_interpolate,
    sph_integrator_arkode_keep,
    NULL,
};
#else
const sph_stepper sph_integrator_lsrk = {0};
#endif
