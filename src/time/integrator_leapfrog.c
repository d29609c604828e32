/* Leapfrog, staggered: w = v, rho, u live at half steps; one evaluation a step, self-starting:
 *
 *   w^n+1/2 = w^n-1/2 + (dt_n-1 + dt_n)/2 F^n     (from rest: w^1/2 = w^0 + dt/2 F^0)
 *   r^n+1   = r^n + dt_n v^n+1/2
 *   F^n+1   = F(r^n+1, w*),   w* = w^n+1/2 + dt_n/2 F^n     the state that velocity-dependent forces see
 *   w^n+1   = w^n+1/2 + dt_n/2 F^n+1                        the state shown, at the same time as r
 *
 * Second order; time-reversible and symplectic for constant steps and forces of position. */
#include "memory.h"
#include "nvector.h"
#include "stepper.h"

typedef struct memory {
  N_Vector f, half, y_previous, f_previous, stage;
  double dt_previous; /* 0: no half-step values yet */
  int known;          /* f is that of (t, y) */
} memory;

static void free_memory(sph_stepper *s)
{
  memory *m = s->memory;
  if (!m) return;
  N_Vector all[] = {m->f, m->half, m->y_previous, m->f_previous, m->stage};
  for (int k = 0; k < 5; k++)
    if (all[k]) N_VDestroy(all[k]);
  sph_memory_free(m);
  s->memory = NULL;
}

static int create(sph_stepper *s)
{
  memory *m = s->memory = SPH_NEW(memory, 1, "the integrator", s->problem->error);
  if (!m) return SPH_ERR_MEMORY;
  N_Vector *all[] = {&m->f, &m->half, &m->y_previous, &m->f_previous, &m->stage};
  for (int k = 0; k < 5; k++)
    if (!(*all[k] = N_VClone(s->y)))
      return sph_error_set(s->problem->error, SPH_ERR_MEMORY,
                           "out of memory: vectors of the integrator");
  return SPH_OK;
}

/* Positions of `to`: r + dt times the rate of the partner segment at half step (where there is one, v^n+1/2 plus what
 * moves particles besides their velocity, dr/dt - v). */
static void drift(const sph_stepper *s, double dt, N_Vector half, N_Vector to)
{
  const memory *m = s->memory;
  const sph_layout *layout = sph_nvector_layout(s->y);
  const double *y = sph_nvector_data(s->y), *f = sph_nvector_data(m->f),
               *w = sph_nvector_data(half);
  double *x = sph_nvector_data(to);
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *r = &layout->segment[k];
    if (r->role != SPH_ROLE_POSITION) continue;
    long v = r->partner < 0 ? -1 : layout->segment[r->partner].offset;
    for (long i = 0, o = r->offset; i < r->n; i++, o++)
      x[o] = y[o] + dt * (f[o] + (v < 0 ? 0 : w[v + i] - y[v + i]));
  }
}

static void copy_positions(const sph_stepper *s, N_Vector from, N_Vector to)
{
  const sph_layout *layout = sph_nvector_layout(s->y);
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *r = &layout->segment[k];
    if (r->role != SPH_ROLE_POSITION) continue;
    for (long o = r->offset; o < r->offset + r->n; o++)
      sph_nvector_data(to)[o] = sph_nvector_data(from)[o];
  }
}

static int step(sph_stepper *s, double cap, double t_stop)
{
  memory *m = s->memory;
  int status = m->known ? SPH_OK : sph_stepper_rhs(s, s->t, s->y, m->f);
  if (status) return status;
  m->known = 1;
  double dt = s->t + cap * (1 + 1e-10) >= t_stop ? t_stop - s->t : cap;
  /* y_previous holds w^n+1/2 until the step is known to be good */
  N_Vector from = m->dt_previous > 0 ? m->half : s->y;
  N_VLinearSum(1, from, 0.5 * (m->dt_previous + dt), m->f, m->y_previous);
  N_VLinearSum(1, m->y_previous, 0.5 * dt, m->f, m->stage);
  drift(s, dt, m->y_previous, m->stage);
  status = sph_stepper_rhs(s, s->t + dt, m->stage, m->f_previous);
  if (status) return status;
  N_Vector f_new = m->f_previous, half_new = m->y_previous;
  m->f_previous = m->f;
  m->f = f_new;
  m->y_previous = m->half;
  m->half = half_new;
  N_VScale(1, s->y, m->y_previous);
  N_VLinearSum(1, m->half, 0.5 * dt, m->f, s->y);
  copy_positions(s, m->stage, s->y);
  m->dt_previous = dt;
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
  m->dt_previous = 0;
  return SPH_OK;
}

const sph_scheme sph_integrator_leapfrog = {create, step, interpolate, reset, free_memory};
