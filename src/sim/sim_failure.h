/* sim_failure.h -- what there is to tell of a step that failed. */
#ifndef SPH_SIM_FAILURE_H
#define SPH_SIM_FAILURE_H
#include "sim_data.h"

/* That particle is why the evaluation asks for a smaller step. */
void sph_sim_failure_suspect(sph_sim *sim, int group, long i);
/* A step failed, the last good state is shown: finds the particle that did it, tells of it behind
 * the error, and gives all open outputs a frame of that state. */
void sph_sim_failure_tell(sph_sim *sim);
/* Puts the error aside, so that the state can be looked at; and back. */
sph_error sph_sim_failure_aside(sph_sim *sim);

#endif
