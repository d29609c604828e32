/* Density resets, between steps (reset_pair.h): with the mean m of s = r_ij/h over the neighbours,
 * weighed by V W, their spread C, and those of rho_j - rho_i,
 *
 *   shepard  rho_i <- rho_i + <rho_j - rho_i>
 *   mls      rho_i <- rho_i + <rho_j - rho_i> - m . C^-1 <(s - m) (rho_j - rho_i)>
 *
 * which is the value at i of the constant, of the linear function nearest to the density around.
 * Where C has an eigenvalue below 0.02, that of neighbours in a line or in a plane, the second has
 * no slope to go by, and is the first. */
#include <stdio.h>
#include <string.h>

#include "memory.h"
#include "reset_loops.h"
#include "sim_mirror.h"
#include "sim_rhs.h"
#include "sim_single.h"
#include "sphode/correction.h"

static const double LEAST_SPREAD = 0.02;

static const struct kind {
  const char *name;
  int order;
} kinds[] = {{"shepard", 0}, {"mls", 1}};

/* What is added to the density at sorted place s. */
static double change(const sph_sim *sim, double *const *sum, long s, int order)
{
  const int dim = sim->dim, first = reset_sums(dim) - dim - 1;
  const double A = sum[0][s], mean = sum[first][s] / A;
  double C[3][3], L[3][3], m[3], slope[3];
  if (!(A > 0)) return 0;
  if (!order) return mean;
  int k = dim + 1;
  for (int a = 0; a < dim; a++) m[a] = sum[1 + a][s] / A;
  for (int a = 0; a < dim; a++) {
    slope[a] = sum[first + 1 + a][s] / A - m[a] * mean;
    for (int b = a; b < dim; b++) C[a][b] = C[b][a] = sum[k++][s] / A - m[a] * m[b];
  }
  if (!sph_sim_gradients_cholesky(dim, C, LEAST_SPREAD, L)) return mean;
  if (!sph_sim_gradients_cholesky(dim, C, 0, L)) return mean;
  sph_sim_gradients_solve(dim, L, slope);
  double value = mean;
  for (int a = 0; a < dim; a++) value -= m[a] * slope[a];
  return value;
}

/* The loops of the reset may make more sums than those of the run. */
static int make_sums(sph_sim *sim, int g)
{
  sph_sorted *sorted = &sim->sorted[g];
  for (int s = 0; s < reset_sums(sim->dim); s++) {
    if (!sorted->sum[s]) sorted->sum[s] = SPH_NEW(double, sorted->room, "pair sums", &sim->error);
    if (!sorted->sum[s]) return SPH_ERR_MEMORY;
  }
  return SPH_OK;
}

static void reset(sph_sim *sim, int g, int order)
{
  sph_pair_function *loop = sph_reset_loop(sim->isa, sim->kernel_number, sim->dim);
  const int *sorted_to = sph_neighbors_order(sim->neighbors, g);
  const long n = sim->group[g]->n;
  double *rho = sph_group_data_component(sim->group[g], sph_nvector_data(sim->y), SPH_DENSITY, 0);
  sph_sim_pairs_clear(sim, g, reset_sums(sim->dim));
  for (int s = 0; s < sim->groups; s++)
    if (sph_sim_interaction_same_fluid(sim->group[g], sim->group[s]))
      sph_sim_pairs_loop(sim, loop, g, s, &sim->constants);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > 2048)
  for (long s = 0; s < n; s++) rho[sorted_to[s]] += change(sim, sim->sorted[g].sum, s, order);
}

static int modify(void *ctx, sph_sim *sim)
{
  const struct kind *kind = ctx;
  int status = sph_sim_rhs_show_anew(sim, sim->time, sim->y); /* records of all, walls filled */
  if (status > 0) return sph_sim_fail(sim, SPH_ERR_STEP, "density-reset: %s", sim->retry);
  for (int g = 0; !status && g < sim->groups; g++) {
    if (sim->group[g]->wall || sim->group[g]->eos.dust) continue;
    status = make_sums(sim, g);
    if (!status) reset(sim, g, kind->order);
  }
  return status ? status : 1;
}

int sph_sim_reset_check(sph_sim *sim)
{
  for (int k = 0; sim->terms.summed && k < sim->modifiers; k++)
    if (sim->modifier[k].modifier.modify == modify)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "density-reset: density is a sum over neighbours already (term "
                          "summation): leave one of them out");
  for (int k = 0; k < sim->modifiers; k++)
    if (sim->modifier[k].modifier.modify == modify) {
      const int status = sph_sim_single_refuse(sim, "density resets are of double precision alone");
      return status ? status : sph_sim_mirror_one_liquid(sim);
    }
  return SPH_OK;
}

void sph_sim_reset_density(sph_sim *sim, const char *kind, long steps)
{
  if (!sph_sim_data_ok(sim)) return;
  const struct kind *found = NULL;
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
    if (kind && !strcmp(kind, kinds[k].name)) found = &kinds[k];
  if (!found)
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "density-reset: kind \"%.60s\"; known: shepard, mls",
                 kind ? kind : "");
  for (int k = 0; k < sim->modifiers; k++)
    if (sim->modifier[k].modifier.modify == modify)
      sph_sim_fail(sim, SPH_ERR_ARGUMENT, "density-reset: added twice");
  sph_sim_add_modifier(sim, (sph_modifier){.name = "density-reset",
                                           .steps = steps,
                                           .modify = modify,
                                           .ctx = (void *)found});
  if (sph_sim_data_ok(sim) && sim->prepared) sph_sim_reset_check(sim);
}
