/* A bound of the eigenvalues of df/dy, from sums over pairs.
 *
 * Pairs that exchange an unknown x (matrix_pair.h) make M dx/dt = - L x with
 *
 *   x^T L x = 1/2 sum_ij (x_i - x_j)^T D_ij (x_i - x_j) <= 2 sum_i x_i^T D_i x_i,
 *   D_i = sum_j D_ij,
 *
 * since (a - b)^2 <= 2 a^2 + 2 b^2: no eigenvalue of M^-1 L is larger than 2 lambda_max(D_i)/M_i of
 * the worst particle (where D is scalar, Gershgorin's bound).  A row of D_i has no larger sum of
 * magnitudes than lambda_max allows for.  Velocities, temperatures, densities have a bound each.
 *
 * The rest of f are waves of omega <= 1.16 c/h (docs/theory.md), and terms of the user's own,
 * slower than 2/dt_max.  L is symmetric with respect to M and waves are antisymmetric with respect
 * to their energy: the sum of the bounds is one of all. */
#include "sim_dominant.h"

#include <math.h>

#include "sim_matrix.h"

static const double OMEGA = 2; /* of waves: disorder adds to 1.16 */

/* Largest sum of magnitudes in a row of the symmetric matrix at sorted place s. */
static double row_sum(double *const *sum, int d, long s)
{
  double row[3] = {0};
  for (int a = 0, k = 0; a < d; a++)
    for (int b = a; b < d; b++, k++) {
      row[a] += fabs(sum[k][s]);
      if (b != a) row[b] += fabs(sum[k][s]);
    }
  return fmax(row[0], fmax(row[1], row[2]));
}

/* What x changes by: mass, heat capacity, volume. */
static double mass_of(const sph_group *group, const sph_view *view, int coupling, long i)
{
  if (coupling == SPH_COUPLING_DIFFUSION) return view->m[i] / view->rho[i];
  return coupling == SPH_COUPLING_CONDUCTION ? view->m[i] * group->eos.c_v : view->m[i];
}

static double largest_of(sph_evaluation *e, int coupling)
{
  sph_sim *sim = e->sim;
  double most = 0;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const int *order = sph_neighbors_order(sim->neighbors, g);
    if (group->wall || (group->eos.dust && coupling != SPH_COUPLING_VISCOSITY)) continue;
    const int d = sph_sim_matrix_sums(e, g, coupling);
    for (long s = 0; s < e->view[g].n; s++)
      most = fmax(most, 2 * row_sum(sim->sorted[g].sum, d, s) /
                            mass_of(group, &e->view[g], coupling, order[s]));
  }
  return most;
}

static double waves_of(const sph_evaluation *e)
{
  double c = 0;
  for (int g = 0; g < e->sim->groups; g++)
    for (long i = 0; !e->sim->group[g]->wall && i < e->view[g].n; i++) c = fmax(c, e->view[g].c[i]);
  return OMEGA * c / e->sim->h_sound;
}

int sph_sim_dominant(double t, N_Vector y, double *lambda, void *ctx)
{
  sph_sim *sim = ctx;
  sph_evaluation e = {.sim = sim, .t = t, .part = &sim->part[SPH_WHOLE]};
  for (int g = 0; g < sim->groups; g++)
    e.view[g] = sph_group_data_view(sim->group[g], sph_nvector_data(y), NULL);
  int status = sph_sim_walls_move(&e);
  if (!status) status = sph_sim_lists_update(&e);
  if (!status) status = sph_sim_density(&e);
  if (!status) status = sph_sim_material_eos(&e);
  if (!status) status = sph_sim_walls_fill(&e);
  if (status) return status;
  const unsigned terms = sim->loop_terms;
  *lambda = 0;
  if ((terms & (SPH_VISCOUS | SPH_DRAG))) *lambda = largest_of(&e, SPH_COUPLING_VISCOSITY);
  if (terms & SPH_CONDUCTION) *lambda = fmax(*lambda, largest_of(&e, SPH_COUPLING_CONDUCTION));
  if (terms & SPH_DIFFUSION) *lambda = fmax(*lambda, largest_of(&e, SPH_COUPLING_DIFFUSION));
  *lambda += waves_of(&e) + 2 / sim->limit[SPH_BOUND_USER] + 2 / sim->limit[SPH_BOUND_DIFFUSION];
  return SPH_OK;
}
