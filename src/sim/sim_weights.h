/* sim_weights.h -- the error weights of the time integrators. */
#ifndef SPH_SIM_WEIGHTS_H
#define SPH_SIM_WEIGHTS_H
#include "sim_data.h"
#include "sphode/sundials.h"

/* Sets the scales of all groups from the state at the start (p, c known). */
void sph_sim_weights_scales(sph_sim *sim);
/* Is every scale that the user set that of a field that is integrated? */
int sph_sim_weights_check(sph_sim *sim);
/* The rms of rates (a vector like y) of all fields but the position, over their scales [1/s]. */
double sph_sim_weights_rate(const sph_sim *sim, N_Vector rates);

#endif
