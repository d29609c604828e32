/* Phase prepare: <grad rho>^L of every fluid particle, for the Antuono diffusion (gradient_pair.h).
 *
 * Where the least eigenvalue of M is under 0.4 (a surface, an isolated particle) the gradient is
 * left out: Molteni's diffusion for that end of the pair. */
#include <string.h>

#include "gradient_loops.h"
#include "sim_rhs.h"

static const double LEAST_EIGENVALUE = 0.4;

int sph_sim_gradients_cholesky(int dim, double A[3][3], double shift, double L[3][3])
{
  for (int a = 0; a < dim; a++)
    for (int b = 0; b <= a; b++) {
      double sum = A[a][b] - (a == b ? shift : 0);
      for (int k = 0; k < b; k++) sum -= L[a][k] * L[b][k];
      if (a == b && !(sum > 0)) return 0;
      L[a][b] = a == b ? sqrt(sum) : sum / L[b][b];
    }
  return 1;
}

/* x = (L L^T)^-1 x. */
void sph_sim_gradients_solve(int dim, double L[3][3], double x[3])
{
  for (int a = 0; a < dim; a++) {
    for (int k = 0; k < a; k++) x[a] -= L[a][k] * x[k];
    x[a] /= L[a][a];
  }
  for (int a = dim - 1; a >= 0; a--) {
    for (int k = a + 1; k < dim; k++) x[a] -= L[k][a] * x[k];
    x[a] /= L[a][a];
  }
}

int sph_sim_gradients_factor(const sph_sim *sim, double *const *matrix, long s, double L[3][3])
{
  int k = 0;
  double M[3][3];
  memset(L, 0, 9 * sizeof(double));
  for (int a = 0; a < sim->dim; a++)
    for (int b = a; b < sim->dim; b++) M[a][b] = M[b][a] = sim->F_scale * matrix[k++][s];
  return sph_sim_gradients_cholesky(sim->dim, M, LEAST_EIGENVALUE, L) &&
         sph_sim_gradients_cholesky(sim->dim, M, 0, L);
}

static void finish(const sph_sim *sim, sph_sorted *sorted, long s)
{
  int dim = sim->dim, first = gradient_sums(dim) - dim;
  double L[3][3], gradient[3] = {0};
  if (!sph_sim_gradients_factor(sim, sorted->sum, s, L)) return; /* the slots hold zeros */
  for (int a = 0; a < dim; a++) gradient[a] = sim->F_scale * sorted->sum[first + a][s];
  sph_sim_gradients_solve(dim, L, gradient);
  for (int a = 0; a < dim; a++)
    sorted->record[s * sorted->stride + slot_extra(dim) + a] = gradient[a];
}

int sph_sim_gradients(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (!e->part->gradients) return SPH_OK;
  sph_pair_function *loop = sph_gradient_loop(sim->isa, sim->kernel_number, sim->dim);
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall || sim->group[g]->eos.dust) continue;
    sph_sim_pairs_clear(sim, g, gradient_sums(sim->dim));
    for (int s = 0; s < sim->groups; s++)
      if (sph_sim_interaction_same_fluid(sim->group[g], sim->group[s]))
        sph_sim_pairs_loop(sim, loop, g, s, &sim->constants);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (e->view[g].n > 2048)
    for (long s = 0; s < e->view[g].n; s++) finish(sim, &sim->sorted[g], s);
  }
  return SPH_OK;
}
