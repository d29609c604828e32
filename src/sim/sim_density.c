/* Phase density: for terms.summed, rho_i = sum m_j W_ij over fluid and wall particles. */
#include "density_loops.h"
#include "sim_rhs.h"

int sph_sim_density(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (!e->part->density) return SPH_OK;
  sph_pair_function *loop = sph_density_loop(sim->isa, sim->kernel_number, sim->dim);
  const fluid_constants k = {.inverse_h = 1 / sim->h};
  for (int g = 0; g < sim->groups; g++) sph_sim_pairs_pack_positions(e, g);
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
    const sph_view *view = &e->view[g];
    sph_sim_pairs_clear(sim, g, SPH_DENSITY_SUMS);
    for (int s = 0; s < sim->groups; s++)
      if (sph_sim_interaction_same_species(sim->group[g], sim->group[s]))
        sph_sim_pairs_loop(sim, loop, g, s, &k);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view->n > 4096)
    for (long s = 0; s < view->n; s++)
      view->rho[order[s]] = sim->W_scale * sim->sorted[g].sum[0][s];
  }
  return SPH_OK;
}

/* Sum of W dx^d over the lattice around a particle, itself included. */
static double lattice_sum(const sph_sim *sim)
{
  const long reach = (long)(sim->H / sim->dx) + 1, y = sim->dim > 1 ? reach : 0;
  const long z = sim->dim > 2 ? reach : 0;
  double sum = 0;
  for (long a = -reach; a <= reach; a++)
    for (long b = -y; b <= y; b++)
      for (long c = -z; c <= z; c++) {
        double r = sim->dx * sqrt((double)(a * a + b * b + c * c));
        sum += sph_kernel_w(sim->kernel, sim->dim, r, sim->h);
      }
  return sum * sim->volume;
}

void sph_sim_density_calibrate(sph_sim *sim)
{
  if (!sim->terms.summed || !sim->terms.calibrate) return;
  double sum = lattice_sum(sim);
  for (int g = 0; g < sim->groups; g++) {
    sph_group *group = sim->group[g];
    if (group->wall || group->eos.thermal || group->eos.dust) continue;
    for (long i = 0; i < group->n; i++) group->own[SPH_MASS][0][i] /= sum;
    sim->wall_volume = sim->volume / sum;
  }
}
