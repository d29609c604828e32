/* sim_force.h -- evaluations of the state shown, to measure it. */
#ifndef SPH_SIM_FORCE_H
#define SPH_SIM_FORCE_H
#include "sim_rhs.h"
#include "sphode/measure.h"

/* An evaluation whose pressures, walls and records are those of the state shown, with the lists as
 * they are; ydot NULL: without rates.  0 or a failure (recorded). */
int sph_sim_force_begin(sph_evaluation *e, sph_sim *sim, N_Vector ydot);

#endif
