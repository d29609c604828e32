/* What writes fields between steps. */
#include <math.h>

#include "sim_event.h"

static int due(const sph_modifying *m, double t)
{
  if (m->modifier.steps > 0) return m->done >= m->modifier.steps;
  double slack = 1e-9 * m->modifier.interval; /* as for frames */
  return t >= m->start + m->done * m->modifier.interval - slack;
}

/* Steps count anew; of intervals those that are over. */
static void go_on(sph_modifying *m, double t)
{
  double over = (t - m->start) / m->modifier.interval;
  m->done = m->modifier.steps > 0 ? 0 : floor(over + 1e-9) + 1;
}

int sph_sim_modifier_run(sph_sim *sim)
{
  for (int k = 0; k < sim->modifiers; k++) {
    sph_modifying *m = &sim->modifier[k];
    double t = sim->time;
    if (m->modifier.steps > 0) m->done++;
    if (!due(m, t)) continue;
    go_on(m, t);
    int status = m->modifier.modify(m->modifier.ctx, sim);
    if (status < 0)
      sph_sim_fail(sim, status, "modifier %s failed at t = %.9g s: %s", m->name, t,
                   sph_status_text(status));
    if (status > 0) sph_sim_changed(sim); /* the next one reads what belongs to it */
    if (sim->error.status) return sim->error.status;
  }
  return SPH_OK;
}
