#include "shift_pair.h"
#include "sim_extremes.h"
#include "sim_implicit.h"
#include "switch_pair.h"

static double held(const sph_sim *sim)
{
  double doubles = 3.0 * (double)sim->layout.length; /* without the integrator's own vectors */
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const sph_sorted *sorted = &sim->sorted[g];
    int arrays = (int)sorted->stride + sim->dim + (sorted->phi != NULL);
    for (int s = 0; s < SPH_PAIR_SUMS; s++) arrays += sorted->sum[s] != NULL;
    if (sorted->shifted) arrays += shift_slots(sim->dim);
    if (sorted->shock) arrays += switch_slots(sim->dim);
    doubles += (double)sorted->room * arrays;
    for (int field = 0; field < SPH_FIELDS; field++)
      for (int c = 0; c < 3; c++) doubles += group->own[field][c] ? (double)group->capacity : 0;
  }
  return 8 * doubles + sph_sim_implicit_bytes(sim) +
         (sim->neighbors ? sph_neighbors_bytes(sim->neighbors) : 0);
}

void sph_sim_get_stats(const sph_sim *sim, sph_sim_stats *stats)
{
  if (!stats) return;
  *stats = (sph_sim_stats){0};
  if (!sim) return;
  if (sim->integrator) stats->step = *sph_integrator_stats(sim->integrator);
  stats->pairs = sim->pairs;
  stats->seconds = sim->seconds;
  stats->rhs_seconds = sim->rhs_seconds;
  stats->solve_seconds = sim->solve_seconds;
  stats->matrices = sim->matrices;
  stats->list_builds = sim->list_builds;
  stats->near = sim->near;
  stats->bytes = held(sim);
  stats->mach = sim->extremes.mach;
  stats->density = sim->extremes.density;
  if (sim->prepared) stats->strayed = sph_sim_extremes_strayed(sim, &stats->strayed_by);
}
