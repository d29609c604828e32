/* Work of the walls that move on the fluids: the force of sph_sim_force against their velocity,
 * where they turn their torque against the rotation, over time by the trapezoidal rule.
 *
 *   W = - int sum over the walls of (F . v + omega T . n) dt,   T about the centre of rotation */
#include "sim_work.h"

#include "sim_force.h"

int sph_sim_work_moves(const sph_sim *sim)
{
  for (int g = 0; sim && g < sim->groups; g++)
    if (sim->group[g]->wall && sph_sim_walls_moves(&sim->group[g]->boundary)) return 1;
  return 0;
}

/* Of one wall, in the state shown [W/m^(3-dim)]. */
static int add_power(sph_sim *sim, const sph_group *wall, double *power)
{
  const sph_wall_motion m = sph_sim_walls_motion(&wall->boundary, sim->time);
  sph_force f;
  const int status = sph_sim_force(sim, wall, m.turns ? m.centre : NULL, &f);
  for (int d = 0; d < 3 && !status; d++) {
    *power -= f.force[d] * m.velocity[d];
    if (m.turns) *power -= f.torque[d] * m.axis[d] * m.turn[1];
  }
  return status;
}

int sph_sim_work(sph_sim *sim, double *work)
{
  double power = 0;
  if (work) *work = sim ? sim->work.sum : 0;
  if (!sim || !sph_sim_data_ok(sim)) return sph_sim_status(sim);
  if (!work) return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "work of walls: no place for it (NULL)");
  sph_work *w = &sim->work;
  if (!sph_sim_work_moves(sim) || (w->known && sim->time <= w->t)) return SPH_OK;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *wall = sim->group[g];
    if (!wall->wall || !sph_sim_walls_moves(&wall->boundary)) continue;
    const int status = add_power(sim, wall, &power);
    if (status) return status;
  }
  if (w->known) w->sum += 0.5 * (w->power + power) * (sim->time - w->t);
  *w = (sph_work){.known = 1, .t = sim->time, .power = power, .sum = w->sum};
  *work = w->sum;
  return SPH_OK;
}

int sph_sim_work_keep(sph_sim *sim, sph_keep *keep)
{
  sph_work *w = &sim->work;
  if (!sph_sim_work_moves(sim) || (keep->reading && !sph_keep_has(keep, "known")))
    return keep->error->status; /* or another version wrote it */
  sph_keep_int(keep, "known", &w->known);
  sph_keep_real(keep, "t", 1, &w->t);
  sph_keep_real(keep, "power", 1, &w->power);
  return sph_keep_real(keep, "sum", 1, &w->sum);
}
