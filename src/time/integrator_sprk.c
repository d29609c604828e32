/* ARKODE's symplectic partitioned schemes (SPRKStep): kicks and drifts of a separable problem. */
#include <string.h>

#include "integrator_arkode.h"
#include "integrator_kinds.h"
#include "memory.h"
#include "nvector.h"

enum { NEEDS = 60600 };
/* The largest omega h/c of a lattice of particles (docs/theory.md, step limits). */
#define OMEGA 1.16

static const struct {
  const char *name, *method;
  double stability;
} row[] = {
#define X(name, method, omega_dt) {name, method, omega_dt / OMEGA},
#include "integrator_sprk.def"
#undef X
};
enum { ROWS = sizeof row / sizeof *row };

const char *sph_integrator_sprk_known(int k, int *needs)
{
  *needs = NEEDS;
  return k < ROWS ? row[k].name : NULL;
}

#if SPH_SUNDIALS_NUMBER >= 60600
#include <arkode/arkode_sprkstep.h>

int sph_integrator_sprk_info(int k, sph_integrator_info *info)
{
  ARKodeSPRKTable table = ARKodeSPRKTable_LoadByName(row[k].method);
  if (!table) return 0;
  *info = (sph_integrator_info){.order = table->q,
                                .stages = table->stages,
                                .stability = row[k].stability,
                                .wants = SPH_WANTS_SEPARABLE};
  ARKodeSPRKTable_Free(table);
  return 1;
}

static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *it)
{
  return sph_integrator_arkode_piece(it, SPH_PIECE_KICK, t, y, ydot);
}

/* For rates at the ends of a step ARKODE has both write to one vector: this one to positions. */
static int drift(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  sph_integrator *it = data;
  N_Vector rates = ((sph_integrator_arkode *)it->own)->kind;
  const sph_layout *layout = sph_nvector_layout(y);
  int status = sph_integrator_arkode_piece(it, SPH_PIECE_DRIFT, t, y, rates);
  for (int k = 0; !status && k < layout->segments; k++) {
    const sph_segment *s = &layout->segment[k];
    if (s->role == SPH_ROLE_POSITION)
      memcpy(sph_nvector_data(ydot) + s->offset, sph_nvector_data(rates) + s->offset,
             (size_t)s->n * sizeof(double));
  }
  return status;
}

static int set_method(void *memory, const char *name)
{
  int k = 0;
  while (strcmp(row[k].name, name)) k++;
  ARKodeSPRKTable table = ARKodeSPRKTable_LoadByName(row[k].method);
  if (!table) return -1;
  int failed = SPRKStepSetMethod(memory, table); /* it keeps a copy */
  ARKodeSPRKTable_Free(table);
  return failed;
}

static int create(sph_integrator *it, SUNContext context)
{
  if (!it->problem.rhs_piece)
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "integrator %s steps positions and velocities apart, and f is one piece",
                         it->info.name);
  sph_integrator_arkode *own = sph_integrator_arkode_create(it, context, &sph_sundials_sprk);
  if (!own) return SPH_ERR_MEMORY;
  own->kind = sph_nvector_clone(it->y, "rates of positions", it->problem.error);
  if (!own->kind) return SPH_ERR_MEMORY;
  own->memory = SPRKStepCreate(kick, drift, it->time, it->y, context);
  int status = sph_integrator_arkode_configure(it);
  return !status && set_method(own->memory, it->info.name) ? SPH_ERR_MEMORY : status;
}

static void release(sph_integrator *it)
{
  sph_integrator_arkode *own = it->own;
  if (own && own->kind) N_VDestroy(own->kind);
  sph_integrator_arkode_free(it);
}

const sph_stepper sph_integrator_sprk = {
    create,
    release,
    sph_integrator_arkode_start,
    sph_integrator_arkode_attempt,
    sph_integrator_arkode_reject,
    sph_integrator_arkode_interpolate,
};

#else
int sph_integrator_sprk_info(int k, sph_integrator_info *info)
{
  (void)k, (void)info;
  return 0;
}
const sph_stepper sph_integrator_sprk = {0};
#endif
