/* Phase prepare (gradient_pair.h): <grad rho>^L of every fluid particle, for the Antuono diffusion;
 * B = M^-1, for terms whose gradients are corrected.
 *
 * Where the least eigenvalue of M is under 0.4 (a surface, an isolated particle) the gradient is
 * left out: Molteni's diffusion for that end of the pair.  Where it is under 0.2, B = 1.  The
 * first M is of neighbours of the same fluid, as the diffusion, the second of all its species. */
#include <string.h>

#include "cpu.h"
#include "gradient_loops.h"
#include "sim_mirror.h"
#include "sim_rhs.h"
#include "sim_single.h"

static const double LEAST_EIGENVALUE = 0.4, LEAST_CORRECTED = 0.2;

/* Cholesky of the dim x dim matrix A - shift I; 0 where it is not positive definite. */
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

/* Of M; 0 where it has an eigenvalue below `least`. */
static int factor(const sph_sim *sim, double *const *matrix, long s, double least, double L[3][3])
{
  int k = 0;
  double M[3][3];
  memset(L, 0, 9 * sizeof(double));
  for (int a = 0; a < sim->dim; a++)
    for (int b = a; b < sim->dim; b++) M[a][b] = M[b][a] = sim->F_scale * matrix[k++][s];
  return sph_sim_gradients_cholesky(sim->dim, M, least, L) &&
         sph_sim_gradients_cholesky(sim->dim, M, 0, L);
}

int sph_sim_gradients_factor(const sph_sim *sim, double *const *matrix, long s, double L[3][3])
{
  return factor(sim, matrix, s, LEAST_EIGENVALUE, L);
}

/* A symmetric matrix and its cofactors; of fewer dimensions with a diagonal of ones behind. */
typedef struct symmetric {
  double xx, xy, xz, yy, yz, zz;
} symmetric;

static inline symmetric matrix_at(int dim, double scale, double *const *sum, long s)
{
  symmetric M = {.xx = scale * sum[0][s], .yy = 1, .zz = 1};
  if (dim > 1) M.xy = scale * sum[1][s], M.yy = scale * sum[dim][s];
  if (dim > 2) M.xz = scale * sum[2][s], M.yz = scale * sum[4][s], M.zz = scale * sum[5][s];
  return M;
}

static inline symmetric cofactors(const symmetric *M)
{
  return (symmetric){.xx = M->yy * M->zz - M->yz * M->yz,
                     .xy = M->xz * M->yz - M->xy * M->zz,
                     .xz = M->xy * M->yz - M->xz * M->yy,
                     .yy = M->xx * M->zz - M->xz * M->xz,
                     .yz = M->xy * M->xz - M->xx * M->yz,
                     .zz = M->xx * M->yy - M->xy * M->xy};
}

static inline double determinant(const symmetric *M, const symmetric *C)
{
  return M->xx * C->xx + M->xy * C->xy + M->xz * C->xz;
}

/* Is every eigenvalue above `least`?  All leading minors of M - least are positive then. */
static inline int above(symmetric M, double least)
{
  M.xx -= least, M.yy -= least, M.zz -= least;
  const symmetric C = cofactors(&M);
  return M.xx > 0 && C.zz > 0 && determinant(&M, &C) > 0;
}

/* M^-1 b by cofactors, M being far from singular: one division a particle. */
static inline void finish(const sph_sim *sim, int dim, double *const *sum, long s, double *gradient)
{
  const double scale = sim->F_scale;
  double *const *b = sum + gradient_sums(dim) - dim;
  const symmetric M = matrix_at(dim, scale, sum, s), C = cofactors(&M);
  if (!above(M, LEAST_EIGENVALUE)) return; /* the slots hold zeros */
  const double x = b[0][s], y = dim > 1 ? b[1][s] : 0, z = dim > 2 ? b[2][s] : 0;
  const double factor = scale / determinant(&M, &C);
  gradient[0] = factor * (C.xx * x + C.xy * y + C.xz * z);
  if (dim > 1) gradient[1] = factor * (C.xy * x + C.yy * y + C.yz * z);
  if (dim > 2) gradient[2] = factor * (C.xz * x + C.yz * y + C.zz * z);
}

/* Of a share whose first target is at sorted place `first`. */
static void finish_share(const sph_sim *sim, int g, const sph_share *share, long first)
{
  const sph_sorted *sorted = &sim->sorted[g];
  double *gradient = sorted->record + first * sorted->stride + slot_extra(sim->dim);
  const long n = sph_sim_pairs_targets(sim, g, share);
  for (long s = 0; s < n; s++, gradient += sorted->stride) {
    if (sim->dim == 3)
      finish(sim, 3, share->sum, s, gradient);
    else if (sim->dim == 2)
      finish(sim, 2, share->sum, s, gradient);
    else
      finish(sim, 1, share->sum, s, gradient);
  }
}

/* B of the target that has sum[..][s] and this record. */
static void invert(const sph_sim *sim, double *const *sum, long s, double *record)
{
  const int dim = sim->dim;
  double L[3][3], *B = record + slot_B(dim);
  const int corrected = factor(sim, sum, s, LEAST_CORRECTED, L);
  for (int a = 0; a < dim; a++) {
    double column[3] = {0};
    column[a] = 1;
    if (corrected) sph_sim_gradients_solve(dim, L, column);
    for (int b = a; b < dim; b++) *B++ = column[b];
  }
}

typedef struct preparing {
  const sph_evaluation *e;
  int g;
} preparing;

/* Sums over neighbours of the same fluid, or over those of its species that are another. */
static void add_sums(const sph_sim *sim, const sph_share *share, int g, int same)
{
  sph_pair_function *loop = sph_gradient_loop(sim->isa, sim->kernel_number, sim->dim);
  for (int s = 0; s < sim->groups; s++)
    if (sph_sim_interaction_same_species(sim->group[g], sim->group[s]) &&
        sph_sim_interaction_same_fluid(sim->group[g], sim->group[s]) == same)
      sph_sim_pairs_loop_share(sim, share, loop, g, s, &sim->constants);
}

/* Some targets: their sums, and while these are in the cache what follows from them.  Slots that
 * the loop does not read are written. */
static void prepare_share(void *ctx, const sph_share *share)
{
  const preparing *k = ctx;
  const sph_sim *sim = k->e->sim;
  sph_sorted *sorted = &k->e->sim->sorted[k->g];
  const long first = share->begin * sph_cpu_lanes(sim->isa);
  add_sums(sim, share, k->g, 1);
  if (k->e->part->rates & SPH_ANTUONO) finish_share(sim, k->g, share, first);
  if (sim->single)
    sph_sim_single_copy(sim, k->g, slot_extra(sim->dim), slot_extra(sim->dim) + sim->dim, first,
                        first + sph_sim_pairs_targets(sim, k->g, share));
  if (!(k->e->part->terms & SPH_CORRECTED)) return;
  add_sums(sim, share, k->g, 0);
  for (long s = 0; s < sph_sim_pairs_targets(sim, k->g, share); s++)
    invert(sim, share->sum, s, sorted->record + (first + s) * sorted->stride);
}

int sph_sim_gradients(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (!e->part->gradients) return SPH_OK;
  for (int g = 0; g < sim->groups; g++) {
    preparing k = {.e = e, .g = g};
    if (!sim->group[g]->wall && !sim->group[g]->eos.dust)
      sph_sim_pairs_share(sim, g, gradient_sums(sim->dim), !e->sums, prepare_share, &k);
  }
  if (e->part->terms & SPH_CORRECTED) sph_sim_mirror_matrices(sim);
  return SPH_OK;
}
