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
  *motion = now;
}
