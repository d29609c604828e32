/* Velocity Verlet (kick, drift, kick) for velocity-dependent forces; w = v, rho, u, F = dw/dt, one evaluation a step:
 *
 *   w^1/2 = w^n + dt/2 F^n,   r^n+1 = r^n + dt v^1/2,   w* = w^n + dt F^n,
 *   F^n+1 = F(r^n+1, w*),     w^n+1 = w^1/2 + dt/2 F^n+1
 *
 * Second order in all; using v^1/2 in the forces would give first order. */
#include "memory.h"
#include "nvector.h"
#include "stepper.h"

/* Vectors; f belongs to (t, y) and f_previous to (t_previous, y_previous).  w: half-step values, for leapfrog. */
typedef struct memory {
  N_Vector f, y_previous, f_previous, stage;
  int known; /* f is */
} memory;

static void free_memory(sph_stepper *s)
{
  memory *m = s->memory;
  if (!m) return;
  N_Vector all[] = {m->f, m->y_previous, m->f_previous, m->stage};
  for (int k = 0; k < 4; k++)
    if (all[k]) N_VDestroy(all[k]);
  sph_memory_free(m);
  s->memory = NULL;
}

static int create(sph_stepper *s)
{
  memory *m = s->memory = SPH_NEW(memory, 1, "the integrator", s->problem->error);
  if (!m) return SPH_ERR_MEMORY;
  N_Vector *all[] = {&m->f, &m->y_previous, &m->f_previous, &m->stage};
  for (int k = 0; k < 4; k++)
    if (!(*all[k] = N_VClone(s->y)))
      return sph_error_set(s->problem->error, SPH_ERR_MEMORY,
                           "out of memory: vectors of the integrator");
  return SPH_OK;
}

/* stage = (r^n+1, w*). */
static void predict(const sph_stepper *s, double dt)
{
  const memory *m = s->memory;
  const sph_layout *layout = sph_nvector_layout(s->y);
  N_VLinearSum(1, s->y, dt, m->f, m->stage);
  const double *f = sph_nvector_data(m->f);
  double *stage = sph_nvector_data(m->stage);
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *r = &layout->segment[k];
    if (r->role != SPH_ROLE_POSITION || r->partner < 0) continue;
    const double *a = f + layout->segment[r->partner].offset;
    double *x = stage + r->offset;
    for (long i = 0; i < r->n; i++) x[i] += 0.5 * dt * dt * a[i];
  }
}

/* y = (r^n+1, w^n + dt/2 (F^n + F^n+1)) */
static void correct(const sph_stepper *s, double dt, N_Vector f_new)
{
  const memory *m = s->memory;
  const sph_layout *layout = sph_nvector_layout(s->y);
  sunrealtype c[3] = {1, 0.5 * dt, 0.5 * dt};
  N_Vector x[3] = {m->y_previous, m->f_previous, f_new};
  N_VLinearCombination(3, c, x, s->y);
  const double *stage = sph_nvector_data(m->stage);
  double *y = sph_nvector_data(s->y);
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *r = &layout->segment[k];
    if (r->role != SPH_ROLE_POSITION) continue;
    for (long i = 0; i < r->n; i++) y[r->offset + i] = stage[r->offset + i];
  }
}

static int step(sph_stepper *s, double cap, double t_stop)
{
  memory *m = s->memory;
  int status = m->known ? SPH_OK : sph_stepper_rhs(s, s->t, s->y, m->f);
  if (status) return status;
  m->known = 1;
  double dt = s->t + cap * (1 + 1e-10) >= t_stop ? t_stop - s->t : cap;
  predict(s, dt);
  status = sph_stepper_rhs(s, s->t + dt, m->stage, m->f_previous); /* f_previous: room for F^n+1 */
  if (status) return status;
  N_Vector f_new = m->f_previous;
  m->f_previous = m->f;
  m->f = f_new;
  N_VScale(1, s->y, m->y_previous);
  correct(s, dt, f_new);
  s->t_previous = s->t;
  s->t = dt == t_stop - s->t ? t_stop : s->t + dt;
  return SPH_OK;
}

static int interpolate(sph_stepper *s, double t, N_Vector at)
{
  const memory *m = s->memory;
  sph_stepper_hermite(s->t_previous, s->t, t, m->y_previous, m->f_previous, s->y, m->f, at);
  return SPH_OK;
}

static int reset(sph_stepper *s)
{
  memory *m = s->memory;
  m->known = 0;
  return SPH_OK;
}

const sph_scheme sph_integrator_verlet = {create, step, interpolate, reset, free_memory};
