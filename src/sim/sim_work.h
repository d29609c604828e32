/* sim_work.h -- the work of walls that move; sph_sim_work is in sphode/measure.h. */
#ifndef SPH_SIM_WORK_H
#define SPH_SIM_WORK_H
#include "keep.h"
#include "sim_rhs.h"

int sph_sim_work_moves(const sph_sim *sim); /* Does a wall move? */
int sph_sim_work_keep(sph_sim *sim, sph_keep *keep);

#endif
