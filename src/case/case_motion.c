#include "case_motion.h"

#include "memory.h"

static void move(void *ctx, double t, double displacement[3], double velocity[3],
                 double acceleration[3])
{
  const sph_case_motion *m = ctx;
  for (int d = 0; d < 3; d++) {
    velocity[d] = m->velocity[d];
    displacement[d] = m->displacement[d] + (m->slide ? 0 : velocity[d] * (t - m->since));
    acceleration[d] = 0;
  }
}

void sph_case_motion_set(sph_boundary *boundary, sph_case_motion *motion)
{
  boundary->motion = move;
  boundary->ctx = motion;
  boundary->free = sph_memory_free;
}

void sph_case_motion_change(sph_case_motion *motion, double t, const sph_case_motion *next)
{
  double unused[3];
  sph_case_motion now = *next;
  move(motion, t, now.displacement, unused, unused);
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
