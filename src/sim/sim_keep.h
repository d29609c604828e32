/* sim_keep.h -- all that a simulation remembers between steps, for checkpoints. */
#ifndef SPH_SIM_KEEP_H
#define SPH_SIM_KEEP_H
#include "sim_data.h"

/* Notes the parameters that events may change: behind sph_sim_prepare. */
void sph_sim_keep_start(sph_sim *sim);
/* One walk over a prepared simulation, writing or reading.  A status. */
int sph_sim_keep(sph_sim *sim, sph_keep *keep);
/* Who writes checkpoints while it runs takes the place of the one before. */
void sph_sim_keep_saver(sph_sim *sim, sph_saver saver);
/* Behind a step: time for one?  last: the run ends here. */
int sph_sim_keep_save(sph_sim *sim, int last);
void sph_sim_keep_free(sph_sim *sim);

#endif
