/* Particles off their lattice: a start without the preferred directions of one. */
#include <math.h>
#include <stdint.h>

#include "sim_data.h"

/* Uniform in [-1, 1], from the number of a draw alone: SplitMix64 (Steele, Lea & Flood 2014). */
static double uniform(uint64_t seed, uint64_t draw)
{
  uint64_t z = seed + (draw + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return (double)(z >> 11) * 0x1p-52 - 1;
}

static int ready(const sph_group *group, double fraction)
{
  if (!group || !sph_sim_data_ok(group->sim)) return 0;
  if (group->sim->prepared)
    sph_sim_fail(group->sim, SPH_ERR_STATE, "group %s: particles are jittered before the run",
                 group->name);
  else if (!(fraction >= 0 && fraction <= 0.5))
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                 "group %s: jitter = %g of the spacing; right is from 0 to 0.5", group->name,
                 fraction);
  return sph_sim_data_ok(group->sim);
}

void sph_group_jitter(sph_group *group, double fraction, unsigned long seed)
{
  if (!ready(group, fraction)) return;
  group->loose |= fraction > 0;
  for (long i = 0; i < group->n; i++)
    for (int d = 0; d < group->dim; d++) {
      double by = fraction * group->sim->dx *
                  uniform(seed, 3 * (uint64_t)sph_group_data_id(group, i) + (uint64_t)d);
      group->own[SPH_POSITION][d][i] += by;
      if (group->wall) group->start[d][i] += by;
    }
}
