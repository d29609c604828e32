/* sim_weights.h -- the error weights of the time integrators. */
#ifndef SPH_SIM_WEIGHTS_H
#define SPH_SIM_WEIGHTS_H
#include "sim_data.h"

/* Sets the scales of group g from its state at the start (p, c known). */
void sph_sim_weights_scales(sph_sim *sim, int g, const sph_view *view);
/* weight = 1/scale of every entry: an ARKEwtFn at tolerance 1. */
int sph_sim_weights(N_Vector y, N_Vector weight, void *sim);

#endif
