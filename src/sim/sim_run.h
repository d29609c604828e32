/* sim_run.h */
#ifndef SPH_SIM_RUN_H
#define SPH_SIM_RUN_H
#include "sim_data.h"

/* Makes pressure, sound speed and walls those of the state shown, if they are not. */
int sph_sim_run_derived(sph_sim *sim);

#endif
