/* Phase drag: dust and fluids exchange momentum (drag_pair.h).  It comes before the pairs, which
 * turn all heat into the rate of the energy that is integrated. */
#include <math.h>

#include "drag_loops.h"
#include "sim_rhs.h"

int sph_sim_drag_acts(const sph_sim *sim, const sph_group *target, const sph_group *source)
{
  return (sim->loop_terms & SPH_DRAG) && !target->wall && !source->wall &&
         target->eos.dust != source->eos.dust;
}

/* sigma/h^d of W, and 1/(sigma_k h)^2. */
static double scale(const sph_sim *sim)
{
  double width = sph_kernel_deviation(sim->kernel, sim->dim) * sim->h;
  return sim->W_scale / (width * width);
}

fluid_constants sph_sim_drag_constants(const sph_sim *sim, int target, int source)
{
  const double unit = scale(sim), rate = unit * sim->terms.drag_rate;
  return (fluid_constants){.kernel = sim->kernel_number,
                           .inverse_h = 1 / sim->h,
                           .drag = unit * sim->terms.drag_K,
                           .drag_i = sim->group[target]->eos.dust ? rate : 0,
                           .drag_j = sim->group[source]->eos.dust ? rate : 0};
}

/* Sums to rates of one group; returns the largest SPH_DRAG_RATE. */
static double add_rates(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const sph_view *view = &e->view[g];
  const int *order = sph_neighbors_order(sim->neighbors, g);
  double *const *sum = sim->sorted[g].sum;
  double most = 0;
#pragma omp parallel for num_threads(sim->threads) schedule(static) \
    reduction(max                                                   \
              : most) if (view->n > 4096)
  for (long s = 0; s < view->n; s++) {
    const long i = order[s];
    for (int d = 0; d < sim->dim; d++) view->dv[d][i] += sum[SPH_DRAG_A + d][s];
    if (view->du) view->du[i] += sum[SPH_DRAG_HEAT][s];
    double rate = sum[SPH_DRAG_RATE][s];
    most = rate > most ? rate : most;
  }
  return most;
}

int sph_sim_drag_add(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (!e->part->drag) return SPH_OK;
  sph_pair_function *loop = sph_drag_loop(sim->isa, sim->kernel_number, sim->dim);
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (group->wall) continue;
    sph_sim_pairs_clear(sim, g, SPH_DRAG_SUMS);
    for (int s = 0; s < sim->groups; s++) {
      const fluid_constants k = sph_sim_drag_constants(sim, g, s);
      if (sph_sim_drag_acts(sim, group, sim->group[s])) sph_sim_pairs_loop(sim, loop, g, s, &k);
    }
    double *rate = &e->drag_rate[group->eos.dust];
    *rate = fmax(*rate, add_rates(e, g));
  }
  return SPH_OK;
}
