/* ARKODE's symplectic partitioned schemes (SPRKStep): kicks and drifts of a separable problem. */
#include <string.h>

#include "integrator_arkode.h"
#include "integrator_kinds.h"
#include "memory.h"
#include "nvector.h"

#define NEEDS 60600
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

typedef struct partitioned {
  ARKodeSPRKTable table;
  N_Vector rates; /* of positions */
  double moved;   /* by the drifts of this step so far: fraction of it */
  int stage;      /* in this step */
} partitioned;

static partitioned *of(const sph_integrator *it)
{
  return ((const sph_integrator_arkode *)it->own)->kind;
}

/* Forces at the time of the positions.  ARKODE tells that of the velocities, with which forces that
 * depend on time, moving walls say, would cost all orders but the first. */
static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  sph_integrator *it = data;
  const sph_integrator_arkode *own = it->own;
  (void)t;
  return sph_integrator_arkode_piece(it, SPH_PIECE_KICK, it->time + of(it)->moved * own->trial, y,
                                     ydot);
}

/* For rates at the ends of a step ARKODE has both write to one vector: this one to positions. */
static int drift(sunrealtype t, N_Vector y, N_Vector ydot, void *data)
{
  sph_integrator *it = data;
  partitioned *kind = of(it);
  const sph_layout *layout = sph_nvector_layout(y);
  int status = sph_integrator_arkode_piece(it, SPH_PIECE_DRIFT, t, y, kind->rates);
  if (kind->stage < kind->table->stages) kind->moved += kind->table->a[kind->stage++];
  for (int k = 0; !status && k < layout->segments; k++) {
    const sph_segment *s = &layout->segment[k];
    if (s->role == SPH_ROLE_POSITION)
      memcpy(sph_nvector_data(ydot) + s->offset, sph_nvector_data(kind->rates) + s->offset,
             (size_t)s->n * sizeof(double));
  }
  return status;
}

static ARKodeSPRKTable table_of(const char *name)
{
  int k = 0;
  while (strcmp(row[k].name, name)) k++;
  return ARKodeSPRKTable_LoadByName(row[k].method);
}

/* No rates at the ends of a step are wanted, a force each, but positions and velocities: cubic and,
 * as their derivative, quadratic, with s = (t - t0)/h, rise = x1 - x0:
 *   x = x0 + s rise + s (s - 1) ((1 - 2 s) rise + h ((s - 1) v0 + s v1))
 *   v = v0 + s (v1 - v0) + 3 s (s - 1) (v0 + v1 - 2 rise/h) */
static void between(long n, double s, double h, const double *x0, const double *x1,
                    const double *v0, const double *v1, double *x, double *v)
{
  for (long i = 0; i < n; i++) {
    double rise = x1[i] - x0[i], slope = (s - 1) * v0[i] + s * v1[i];
    x[i] = x0[i] + s * rise + s * (s - 1) * ((1 - 2 * s) * rise + h * slope);
    v[i] = v0[i] + s * (v1[i] - v0[i]) + 3 * s * (s - 1) * (v0[i] + v1[i] - 2 * rise / h);
  }
}

static int interpolate(sph_integrator *it, double t, N_Vector at)
{
  const sph_layout *layout = sph_nvector_layout(at);
  const double *y0 = sph_nvector_data(it->before), *y1 = sph_nvector_data(it->y);
  double h = it->time - it->previous, s = (t - it->previous) / h, *y = sph_nvector_data(at);
  N_VLinearSum(1 - s, it->before, s, it->y, at);
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *x = &layout->segment[k];
    if (x->role != SPH_ROLE_POSITION) continue;
    const long v = layout->segment[x->partner].offset;
    between(x->n, s, h, y0 + x->offset, y1 + x->offset, y0 + v, y1 + v, y + x->offset, y + v);
  }
  return SPH_OK;
}

static int create(sph_integrator *it, SUNContext context)
{
  if (!it->problem.rhs_piece)
    return sph_error_set(it->problem.error, SPH_ERR_ARGUMENT,
                         "integrator %s steps positions and velocities apart, and f is one piece",
                         it->info.name);
  sph_integrator_arkode *own = sph_integrator_arkode_create(it, context, &sph_sundials_sprk);
  if (!own) return SPH_ERR_MEMORY;
  partitioned *kind = own->kind =
      SPH_NEW(partitioned, 1, "a symplectic integrator", it->problem.error);
  if (!kind) return SPH_ERR_MEMORY;
  kind->table = table_of(it->info.name);
  kind->rates = sph_nvector_clone(it->y, "rates of positions", it->problem.error);
  if (!kind->table || !kind->rates) return SPH_ERR_MEMORY;
  own->memory = SPRKStepCreate(kick, drift, it->time, it->y, context);
  int status = sph_integrator_arkode_configure(it);
  if (!status && (own->call->set_interpolant_type(own->memory, ARK_INTERP_LAGRANGE) ||
                  own->call->set_interpolant_degree(own->memory, 1) ||
                  SPRKStepSetMethod(own->memory, kind->table))) /* it keeps a copy */
    status = SPH_ERR_MEMORY;
  return status;
}

static void release(sph_integrator *it)
{
  sph_integrator_arkode *own = it->own;
  partitioned *kind = own ? own->kind : NULL;
  sph_integrator_arkode_free(it);
  if (!kind) return;
  if (kind->rates) N_VDestroy(kind->rates);
  if (kind->table) ARKodeSPRKTable_Free(kind->table);
  sph_memory_free(kind);
}

static int attempt(sph_integrator *it, sph_attempt *a, double t_stop)
{
  partitioned *kind = of(it);
  kind->moved = kind->stage = 0;
  return sph_integrator_arkode_attempt(it, a, t_stop);
}

const sph_stepper sph_integrator_sprk = {
    create,
    release,
    sph_integrator_arkode_start,
    attempt,
    sph_integrator_arkode_reject,
    interpolate,
    sph_integrator_arkode_keep,
    NULL,
};

#else
int sph_integrator_sprk_info(int k, sph_integrator_info *info)
{
  (void)k, (void)info;
  return 0;
}
const sph_stepper sph_integrator_sprk = {0};
#endif
