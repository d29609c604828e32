/* sim_transposed.h -- products with the transposed derivative of the right-hand side. */
#ifndef SPH_SIM_TRANSPOSED_H
#define SPH_SIM_TRANSPOSED_H
#include "sim_tangent.h"

/* Weights of the pressure of fluid particles, besides: factor * weight[group][i]. */
typedef struct sph_pressure_bars {
  double factor;
  const double *const *weight; /* NULL for walls */
} sph_pressure_bars;

/* z[length] = (df/dy)^T w + (dp/dy)^T pressure (NULL: none) at (t, y), as sph_sim_tangent; exact to
 * rounding but for body terms of the user, which are taken to act on each particle alone.  Refused
 * with tiles and a phi of the user's. */
int sph_sim_transposed(sph_sim *sim, int part, double t, const double *y, const double *w,
                       const sph_pressure_bars *pressure, int lagged, double *z);
void sph_sim_transposed_free(struct sph_transposed *transposed); /* NULL is fine */

#endif
