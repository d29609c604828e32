/* sim_prepare.h -- from what was attached to a system of ODEs, once, before the first
 * evaluation. */
#ifndef SPH_SIM_PREPARE_H
#define SPH_SIM_PREPARE_H
#include "sim_data.h"

int sph_sim_prepare(sph_sim *sim);
/* What integrators ask of the simulation. */
sph_problem sph_sim_prepare_problem(sph_sim *sim);
/* A search among particles of the simulation, one lane, in its periodic box. */
sph_neighbors_def sph_sim_prepare_search(const sph_sim *sim, double reach);
/* What is made of the smoothing length. */
void sph_sim_prepare_h(sph_sim *sim);
/* Room in the sorted copy of group g for one particle more. */
int sph_sim_prepare_room(sph_sim *sim, int g);
void sph_sim_prepare_undo(sph_sim *sim); /* lets go of all that it made */

#endif
