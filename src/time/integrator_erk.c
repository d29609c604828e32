/* ARKODE's explicit Runge-Kutta schemes. */
#include <math.h>

#include "integrator_arkode.h"
#include "integrator_table.h"

#if SPH_SUNDIALS_NUMBER < 60700
static int nothing(sunrealtype t, N_Vector y, void *data)
{
  (void)t, (void)y, (void)data;
  return 0;
}

/* SUNDIALS up to 6.6.2 takes any last stage at c = 1 for the rate at the end, and loses order; a
 * hook after the step makes it evaluate anew. */
static int repair(void *memory, ARKodeButcherTable table)
{
  int wrong = fabs(table->c[table->stages - 1] - 1) < 1e-10 && !sph_integrator_table_fsal(table);
  return wrong ? ERKStepSetPostprocessStepFn(memory, nothing) : 0;
}
#else
static int repair(void *memory, ARKodeButcherTable table)
{
  (void)memory, (void)table;
  return 0;
}
#endif

static int set_table(sph_integrator_arkode *own, int row)
{
  ARKodeButcherTable table = sph_integrator_table_butcher(row);
  if (!table) return -1;
  own->fsal = sph_integrator_table_fsal(table);
  int failed =
      ERKStepSetTable(own->memory, table) || repair(own->memory, table); /* it keeps a copy */
  ARKodeButcherTable_Free(table);
  return failed;
}

static int create(sph_integrator *it, SUNContext context)
{
  sph_integrator_arkode *own = sph_integrator_arkode_create(it, context, &sph_sundials_erk);
  if (!own) return SPH_ERR_MEMORY;
  own->memory = ERKStepCreate(sph_integrator_arkode_rhs, it->time, it->y, context);
  int status = sph_integrator_arkode_configure(it);
  return !status && set_table(own, it->row) ? SPH_ERR_MEMORY : status;
}

const sph_stepper sph_integrator_erk = {
    create,
    sph_integrator_arkode_free,
    sph_integrator_arkode_start,
    sph_integrator_arkode_attempt,
    sph_integrator_arkode_reject,
    sph_integrator_arkode_interpolate,
    sph_integrator_arkode_keep,
    NULL,
};
