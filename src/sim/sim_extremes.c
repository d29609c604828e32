#include "sim_extremes.h"

#include <math.h>

#include "sim_rhs.h"

int sph_sim_extremes_liquid(const sph_group *group)
{
  const sph_eos *eos = &group->eos;
  return !group->wall && !eos->dust && !eos->thermal && eos->rho0 > 0 && eos->c0 > 0;
}

void sph_sim_extremes_start(sph_sim *sim)
{
  sph_extremes *x = &sim->extremes;
  for (int d = 0; d < sim->dim; d++) {
    x->low[d] = INFINITY, x->high[d] = -INFINITY;
    for (int g = 0; g < sim->groups; g++) {
      const double *at = sph_group_read(sim->group[g], "position", d);
      for (long i = 0; i < sim->group[g]->n; i++) {
        x->low[d] = fmin(x->low[d], at[i]);
        x->high[d] = fmax(x->high[d], at[i]);
      }
    }
  }
  sph_sim_extremes_step(sim); /* the start counts, too */
}

void sph_sim_extremes_see(sph_sim *sim, const sph_group *group, double speed, double least,
                          double most)
{
  sph_extremes *x = &sim->extremes;
  if (group->n == 0 || !sph_sim_extremes_liquid(group)) return;
  x->mach_now = fmax(x->mach_now, speed / group->eos.c0);
  x->density_now =
      fmax(x->density_now, fmax(most / group->eos.rho0 - 1, 1 - least / group->eos.rho0));
}

void sph_sim_extremes_step(sph_sim *sim)
{
  sph_extremes *x = &sim->extremes;
  x->mach = fmax(x->mach, x->mach_now);
  x->density = fmax(x->density, x->density_now);
}

/* Bodies that stand still, around which there is an inside. */
static int have_walls(const sph_sim *sim)
{
  int walls = 0;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *wall = sim->group[g];
    if (!wall->wall) continue;
    if (wall->model == SPH_MODEL_MIRROR || sph_sim_walls_moves(&wall->boundary)) return 0;
    walls++;
  }
  return walls > 0;
}

long sph_sim_extremes_strayed(const sph_sim *sim, double *most)
{
  const sph_extremes *x = &sim->extremes;
  long strayed = 0;
  *most = 0;
  for (int g = 0; g < sim->groups && have_walls(sim); g++) {
    const sph_group *group = sim->group[g];
    if (!sph_sim_extremes_liquid(group)) continue;
    for (long i = 0; i < group->n; i++) {
      int far = 0;
      for (int d = 0; d < sim->dim; d++) {
        const double at = sph_group_read(group, "position", d)[i];
        const double out = fmax(x->low[d] - at, at - x->high[d]);
        if (sim->periodic[d] || !(out > x->high[d] - x->low[d])) continue;
        *most = fmax(*most, out);
        far = 1;
      }
      strayed += far;
    }
  }
  return strayed;
}
