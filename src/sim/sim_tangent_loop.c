/* Derivatives of passes over pairs. */
#include "cpu.h"
#include "sim_tangent.h"
#include "tangent_loops.h"

enum { BLOCKS = 16 };

/* Sources beyond the support add zeros; a little more, for rounding. */
static double reach2(const sph_sim *sim) { return sim->H * sim->H * (1 + 1e-12); }

fluid_constants sph_sim_tangent_loop_constants(const sph_tangent *tangent, int pass, int target,
                                               int source)
{
  const sph_sim *sim = tangent->sim;
  if (pass == SPH_TANGENT_drag) return sph_sim_drag_constants(sim, target, source);
  if (pass == SPH_TANGENT_wall)
    return sph_sim_walls_constants(sim, sim->group[target], tangent->e.t);
  if (pass != SPH_TANGENT_fluid) return sim->constants;
  return sph_sim_interaction_constants(sim, tangent->e.part, sim->group[target],
                                       sim->group[source]);
}

static int zeros(const double *a, long n)
{
  long i = 0;
  while (i < n && a[i] == 0) i++;
  return i == n;
}

/* Does nothing change that this loop reads, as along many parameters? */
static int still(const sph_tangent *tangent, const fluid_constants *k_d, int target, int source)
{
  const int groups[] = {target, source};
  int same = !tangent->s && zeros(&k_d->inverse_h, SPH_FLUID_NUMBERS);
  for (int g = 0; same && g < 2; g++)
    same = zeros(tangent->group[groups[g]].record_d,
                 tangent->sim->group[groups[g]]->n * tangent->sim->sorted[groups[g]].stride);
  return same;
}

void sph_sim_tangent_loop(sph_tangent *tangent, int pass, int target, int source)
{
  sph_sim *sim = tangent->sim;
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const fluid_constants k = sph_sim_tangent_loop_constants(tangent, pass, target, source);
  const fluid_constants k_d = sph_sim_tangent_call_constants(tangent, pass, target, source);
  if (still(tangent, &k_d, target, source)) return; /* its derivative is zero */
  const sph_tangent_task task = {.target = sim->sorted[target].record,
                                 .target_d = tangent->group[target].record_d,
                                 .source = sim->sorted[source].record,
                                 .source_d = tangent->group[source].record_d,
                                 .target_stride = sim->sorted[target].stride,
                                 .source_stride = sim->sorted[source].stride,
                                 .targets = sim->group[target]->n,
                                 .lanes = sph_cpu_lanes(sim->isa),
                                 .first = list.first,
                                 .runs = list.runs,
                                 .shift = sph_neighbors_shifts(sim->neighbors, NULL),
                                 .reach2 = reach2(sim),
                                 .kernel = sim->kernel_number,
                                 .terms = k.terms,
                                 .numbers = &k.inverse_h,
                                 .numbers_d = &k_d.inverse_h,
                                 .sum_d = tangent->group[target].sum_d};
  sph_tangent_function *loop = sph_tangent_loops[pass][sim->dim - 1];
  long chunks = (list.blocks + BLOCKS - 1) / BLOCKS;
#pragma omp parallel for num_threads(sim->threads) schedule(dynamic) if (chunks > 2)
  for (long c = 0; c < chunks; c++)
    loop(&task, c * BLOCKS, c + 1 < chunks ? (c + 1) * BLOCKS : list.blocks);
}
