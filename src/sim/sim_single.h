/* sim_single.h -- mixed precision: records in single precision beside those in double. */
#ifndef SPH_SIM_SINGLE_H
#define SPH_SIM_SINGLE_H
#include "sim_rhs.h"

/* May a simulation with these terms, groups and this integrator be one of mixed precision?  Does
 * nothing with one of double. */
int sph_sim_single_check(sph_sim *sim);
/* SPH_OK, or an error that `what` has no loops in single precision. */
int sph_sim_single_refuse(sph_sim *sim, const char *what);

/* The quantum of positions, after lists were built; refuses what it would be too large for. */
int sph_sim_single_range(sph_sim *sim);

/* Slots first .. last - 1 of the records at sorted places begin .. end - 1 of group g, from those
 * in double. */
void sph_sim_single_copy(const sph_sim *sim, int g, int first, int last, long begin, long end);
/* All of group g, with what lies behind the last particle. */
void sph_sim_single_pack(const sph_sim *sim, int g);

#endif
