#include "case_motion.h"

#include <math.h>

#include "memory.h"

static double at(sph_case_formula *formula, double t)
{
  double x = NAN;
  return sph_case_value_formula_at(formula, 1, NULL, t, &x) ? NAN : x;
}

/* Central differences of fourth order, five points `step` apart.  Not a number becomes a state that
 * is not admissible, and the run says which. */
static void differences(const sph_case_motion *m, int d, double t, double *x, double *v, double *a)
{
  const double h = m->step;
  const double f[5] = {at(m->formula[d], t - 2 * h), at(m->formula[d], t - h), at(m->formula[d], t),
                       at(m->formula[d], t + h), at(m->formula[d], t + 2 * h)};
  *x = f[2] - m->start[d];
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
      differences(m, d, t, &displacement[d], &velocity[d], &acceleration[d]);
  }
}

void sph_case_motion_free(void *motion)
{
  sph_case_motion *m = motion;
  if (!m) return;
  for (int d = 0; d < 3; d++) sph_case_value_formula_free(m->formula[d]);
  sph_memory_free(m);
}

int sph_case_motion_begin(sph_case_motion *m, double step)
{
  m->step = step;
  for (int d = 0; d < 3; d++) {
    m->start[d] = m->formula[d] ? at(m->formula[d], 0) : 0;
    if (!isfinite(m->start[d])) return SPH_ERR_ARGUMENT;
  }
  return SPH_OK;
}

void sph_case_motion_set(sph_boundary *boundary, sph_case_motion *motion)
{
  boundary->motion = move;
  boundary->ctx = motion;
  boundary->free = sph_case_motion_free;
}

void sph_case_motion_change(sph_case_motion *motion, double t, const sph_case_motion *next)
{
  double unused[3];
  sph_case_motion now = *next;
  move(motion, t, now.displacement, unused, unused);
  for (int d = 0; d < 3; d++) now.formula[d] = motion->formula[d]; /* still owned */
  now.since = t;
  now.changed = 1;
  *motion = now;
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
