/* sphode/jacobian.h -- the Jacobian df/dy of a simulation as a sparse matrix: for linear stability,
 * fully implicit and steady solves of your own.
 *
 * Its values are products of df/dy with vectors (sph_sim_jacobian_times), each of which fills all
 * columns that share no row: as many as the colours of the pattern.  Rows couple to all particles
 * within the support; with density as a sum, walls, and Antuono's diffusion to neighbours of
 * neighbours, too. */
#ifndef SPHODE_JACOBIAN_H
#define SPHODE_JACOBIAN_H
#include "sphode/group.h"
#include "sphode/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_jacobian_def {
  /* 1: what walls extrapolate and Antuono's gradients are taken as constant: an approximation with
   * about a quarter (2D) or an eighth (3D) of the entries; 0: the derivative of f itself. */
  int lagged;
} sph_jacobian_def;

/* Compressed rows; row and column r belong to the same entry of the state.  Owned by
 * sph_jacobian_free; read only. */
typedef struct sph_jacobian {
  long n;            /* rows: entries of the state */
  const long *first; /* [n + 1] the entries of row r are first[r] ... first[r + 1] - 1 */
  const int *column; /* [first[n]] rising in each row */
  const double *value;
  const long *place; /* [n] of each row in the array of sph_sim_vector (sphode/sundials.h) */
  long patterns;     /* rises when first or column change: then factorise symbolically anew */
  long products;     /* of df/dy with vectors, that the last evaluation took */
} sph_jacobian;

/* Of a simulation, which must outlive it; def NULL: zeros.  NULL: the error is the simulation's. */
SPH_API sph_jacobian *sph_jacobian_create(sph_sim *sim, const sph_jacobian_def *def);
SPH_API void sph_jacobian_free(sph_jacobian *jacobian); /* NULL is fine */

/* Pattern and values at the state that the simulation shows.  0, or a failure that sticks to the
 * simulation. */
SPH_API int sph_jacobian_evaluate(sph_jacobian *jacobian);
/* ... at (t [s], y), y an array as that of sph_sim_vector.  Also SPH_RETRY: y is not admissible. */
SPH_API int sph_jacobian_evaluate_at(sph_jacobian *jacobian, double t, const double *y);

/* The row of particle 0 of an integrated field of a group; those of the others follow it.  -1: no
 * such field. */
SPH_API long sph_jacobian_row(const sph_jacobian *jacobian, const sph_group *group,
                              const char *field, int component);

/* Its eigenvalues re[k] + i im[k] [1/s], as a full matrix: for small systems, n up to
 * SPH_EIGENVALUES_MAX (5 s for 1000, growing with the cube).  frozen: positions are held, their
 * rows and columns are left out: waves and friction on particles that stay where they are, and five
 * times less time.  re, im: [n].  Returns how many there are, or a status < 0 that sticks to the
 * simulation. */
enum { SPH_EIGENVALUES_MAX = 4000 };
SPH_API long sph_jacobian_eigenvalues(const sph_jacobian *jacobian, int frozen, double *re,
                                      double *im);

#ifdef __cplusplus
}
#endif
#endif
