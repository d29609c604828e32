/* sim_drag.h -- drag between dust and fluids: its constants. */
#ifndef SPH_SIM_DRAG_H
#define SPH_SIM_DRAG_H
#include "drag_pair.h"
#include "sim_data.h"

/* Of (target <- source), K and rates times a factor. */
drag_constants sph_sim_drag_constants(const sph_sim *sim, int target, int source, double factor);
/* Of the sums of drag_pair: sigma/h^d of W, and 1/(sigma_k h)^2. */
double sph_sim_drag_scale(const sph_sim *sim);

#endif
