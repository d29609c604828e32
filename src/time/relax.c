#include "relax.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "integrator_arkode.h"
#include "integrator_table.h"
#include "nvector.h"

#define SINCE 60600

/* The least of its weights b; INFINITY without memory for its tables, which is told where it is
 * made. */
static double weights_of(const char *name)
{
  ARKodeButcherTable table[2] = {NULL, NULL};
  int row = sph_integrator_table_find(name, NULL);
  double least = INFINITY;
  if (!sph_integrator_table_pair(row, table)) table[0] = sph_integrator_table_butcher(row);
  for (int k = 0; k < 2; k++)
    for (int i = 0; table[k] && i < table[k]->stages; i++) least = fmin(least, table[k]->b[i]);
  for (int k = 0; k < 2; k++)
    if (table[k]) ARKodeButcherTable_Free(table[k]);
  return least;
}

int sph_relax_check(const sph_integrator_def *def, const sph_integrator_info *info,
                    sph_error *error)
{
  if (!def->relax) return SPH_OK;
  if (strcmp(def->relax, "energy"))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator: relax = \"%.40s\"; right are \"energy\" and none (NULL)",
                         def->relax);
  if (def->own || (strncmp(info->name, "erk:", 4) && strncmp(info->name, "imex:", 5)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator %s does not relax; those that do are erk:<table> and "
                         "imex:<table>",
                         info->name);
  if (weights_of(info->name) < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "integrator %s does not relax: its table has a negative weight b",
                         info->name);
  if (SPH_SUNDIALS_NUMBER < SINCE)
    return sph_error_set(error, SPH_ERR_UNBUILT,
                         "relax needs SUNDIALS 6.6 or later; this library has " SUNDIALS_VERSION);
  return SPH_OK;
}

#if SPH_SUNDIALS_NUMBER >= SINCE

/* Newton's method ends with a residual that may be rounding, or behind a change of gamma after
 * which there is nothing else left. */
static const double CHANGE = 1e-9;

/* ARKODE needs E only up to a constant: here that of the start of the step. */
static int energy(N_Vector y, sunrealtype *e, void *data)
{
  sph_integrator *it = data;
  sph_integrator_arkode *own = it->own;
  double rounding = 0;
  if (sph_nvector_lost(y)) return it->rhs_status = SPH_ERR_MEMORY;
  int status = it->problem.energy(it->before, y, e, &rounding, it->problem.ctx);
  if (status < 0) it->rhs_status = status;
  return status ? status : own->call->set_relax_res_tol(own->memory, fmax(DBL_MIN, rounding));
}

static int gradient(N_Vector y, N_Vector slope, void *data)
{
  sph_integrator *it = data;
  if (sph_nvector_lost(y)) return it->rhs_status = SPH_ERR_MEMORY;
  int status = it->problem.energy_gradient(y, slope, it->problem.ctx);
  if (status < 0) it->rhs_status = status;
  return status;
}

int sph_relax_attach(sph_integrator *it)
{
  sph_integrator_arkode *own = it->own;
  if (!it->def.relax) return SPH_OK;
  if (!it->problem.energy || !it->problem.energy_gradient)
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "relax: there is no energy that is a function of the state");
  int failed = own->call->set_relax_fn(own->memory, energy, gradient) ||
               own->call->set_relax_tol(own->memory, CHANGE, CHANGE);
  return failed ? SPH_ERR_MEMORY : SPH_OK;
}

int sph_relax_failed(int flag) { return flag == ARK_RELAX_FAIL; }

#else

int sph_relax_attach(sph_integrator *it)
{
  (void)it;
  return SPH_OK;
}

int sph_relax_failed(int flag)
{
  (void)flag;
  return 0;
}

#endif
