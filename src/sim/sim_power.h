/* sim_power.h -- the terms of f, one by one. */
#ifndef SPH_SIM_POWER_H
#define SPH_SIM_POWER_H
#include "sim_rhs.h"

/* Does term k accelerate particles?  Density diffusion, conduction and the like do not. */
int sph_sim_power_pushes(const sph_sim *sim, int k);
/* The rates of term k alone (sph_sim_power_term) of the state shown, in ydot and e->view.  part:
 * the caller's, filled in.  0 or a failure (recorded). */
int sph_sim_power_rates(sph_sim *sim, int k, N_Vector ydot, sph_part *part, sph_evaluation *e);

#endif
