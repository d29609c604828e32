/* sim_extremes.h -- how far liquids went from what they are meant for: Mach numbers, densities, and
 * particles that nothing held. */
#ifndef SPH_SIM_EXTREMES_H
#define SPH_SIM_EXTREMES_H
#include "sim_data.h"

/* Has it a sound speed that is chosen, so that it is to stay slow and dense? */
int sph_sim_extremes_liquid(const sph_group *group);
/* At the start: where all particles are. */
void sph_sim_extremes_start(sph_sim *sim);
/* An evaluation: the largest speed of a group, its least and its largest density. */
void sph_sim_extremes_see(sph_sim *sim, const sph_group *group, double speed, double least,
                          double most);
/* The step whose last evaluation that was is taken. */
void sph_sim_extremes_step(sph_sim *sim);
/* Particles of liquids that are, in the state shown, farther outside of where all were at the start
 * than that is long; the largest distance [m].  0 where walls move, are mirrors, or are none. */
long sph_sim_extremes_strayed(const sph_sim *sim, double *most);

#endif
