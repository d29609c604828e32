#include "case_motion.h"

#include <math.h>

#include "memory.h"

static double at(sph_case_formula *formula, double t)
{
  double x = NAN;
  return sph_case_value_formula_at(formula, 1, NULL, t, &x) ? NAN : x;
}

/* Central differences of fourth order, five points `step` apart.  Not a number is an error of the
 * run, which says where it comes from. */
static void differences(sph_case_formula *formula, double start, double h, double t, double *x,
                        double *v, double *a)
{
  const double f[5] = {at(formula, t - 2 * h), at(formula, t - h), at(formula, t),
                       at(formula, t + h), at(formula, t + 2 * h)};
  *x = f[2] - start;
  *v = (8 * (f[3] - f[1]) - (f[4] - f[0])) / (12 * h);
  *a = (16 * (f[3] + f[1]) - (f[4] + f[0]) - 30 * f[2]) / (12 * h * h);
}

static void move(void *ctx, double t, double displacement[3], double velocity[3],
                 double acceleration[3])
{
  const sph_case_motion *m = ctx;
  for (int d = 0; d < 3; d++) {
    velocity[d] = m->velocity[d];
    displacement[d] = m->displacement[d] + (m->slide ? 0 : velocity[d] * (t - m->since));
    acceleration[d] = 0;
    if (m->formula[d] && !m->changed)
      differences(m->formula[d], m->start[d], m->step, t, &displacement[d], &velocity[d],
                  &acceleration[d]);
  }
}

static void turn_to(void *ctx, double t, double turn[3])
{
  const sph_case_motion *m = ctx;
  turn[0] = m->slide ? 0 : m->rate * t;
  turn[1] = m->rate;
  turn[2] = 0;
  if (m->angle) differences(m->angle, m->angle_start, m->step, t, &turn[0], &turn[1], &turn[2]);
}

/* Not finite: not a number, and the run says where. */
static void surface(sph_case_formula *formula, double t, long n, const double *const x[3],
                    double *value)
{
  if (sph_case_value_formula_at(formula, n, x, t, value))
    for (long i = 0; i < n; i++) value[i] = NAN;
}

static void temperature_at(void *ctx, double t, long n, const double *const x[3], double *value)
{
  surface(((const sph_case_motion *)ctx)->temperature, t, n, x, value);
}

static void heat_flux_at(void *ctx, double t, long n, const double *const x[3], double *value)
{
  surface(((const sph_case_motion *)ctx)->heat_flux, t, n, x, value);
}

void sph_case_motion_free(void *motion)
{
  sph_case_motion *m = motion;
  if (!m) return;
  for (int d = 0; d < 3; d++) sph_case_value_formula_free(m->formula[d]);
  sph_case_value_formula_free(m->angle);
  sph_case_value_formula_free(m->temperature);
  sph_case_value_formula_free(m->heat_flux);
  sph_memory_free(m);
}

int sph_case_motion_begin(sph_case_motion *m, double step)
{
  m->step = step;
  for (int d = 0; d < 3; d++) {
    m->start[d] = m->formula[d] ? at(m->formula[d], 0) : 0;
    if (!isfinite(m->start[d])) return SPH_ERR_ARGUMENT;
  }
  m->angle_start = m->angle ? at(m->angle, 0) : 0;
  return isfinite(m->angle_start) ? SPH_OK : SPH_ERR_ARGUMENT;
}

void sph_case_motion_set(sph_boundary *boundary, sph_case_motion *motion, int moves, int turns)
{
  boundary->motion = moves ? move : NULL;
  boundary->rotation = turns ? turn_to : NULL;
  boundary->temperature_at = motion->temperature ? temperature_at : NULL;
  boundary->heat_flux_at = motion->heat_flux ? heat_flux_at : NULL;
  for (int k = 0; k < 4; k++) boundary->source[k] = motion->what[k][0] ? motion->what[k] : NULL;
  boundary->ctx = motion;
  boundary->free = sph_case_motion_free;
}

void sph_case_motion_change(sph_case_motion *motion, double t, const sph_case_motion *next)
{
  double unused[3], there[3];
  move(motion, t, there, unused, unused);
  for (int d = 0; d < 3; d++) {
    motion->displacement[d] = there[d];
    motion->velocity[d] = next->velocity[d];
  }
  motion->slide = next->slide;
  motion->since = t;
  motion->changed = 1;
}

int sph_case_motion_keep(void *motion, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  sph_case_motion *m = motion;
  long flags[2] = {m->changed, m->slide};
  (void)sim, (void)error;
  int status = sph_keep_integer(keep, "changed", 2, flags);
  if (status || !flags[0]) return status; /* it is as the case says */
  m->changed = 1;
  m->slide = (int)flags[1];
  sph_keep_real(keep, "since", 1, &m->since);
  sph_keep_real(keep, "displacement", 3, m->displacement);
  return sph_keep_real(keep, "velocity", 3, m->velocity);
}
