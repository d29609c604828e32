/* sim_relax.h -- the energy that relaxation keeps, and its derivative. */
#ifndef SPH_SIM_RELAX_H
#define SPH_SIM_RELAX_H
#include "sim_data.h"

/* E(y) - E(y0) [J], E: kinetic, internal or elastic, potential; and how much of that may be
 * rounding of y, a few standard deviations. */
int sph_sim_relax_energy(N_Vector y0, N_Vector y, double *change, double *rounding, void *sim);
/* dE/dy, each entry in J per unit of its field; padding is left alone. */
int sph_sim_relax_gradient(N_Vector y, N_Vector gradient, void *sim);

#endif
