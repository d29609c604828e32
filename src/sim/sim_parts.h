/* sim_parts.h -- the parts of f: which terms, which phases. */
#ifndef SPH_SIM_PARTS_H
#define SPH_SIM_PARTS_H
#include "sim_data.h"

/* Once all terms are known to the loops: what each part is.  0 or a failure (recorded). */
int sph_sim_parts_make(sph_sim *sim);
/* A part of some of the pair terms and of the called terms, without motion and forces. */
int sph_sim_parts_of(sph_sim *sim, sph_part *part, unsigned bits, unsigned called);
/* Does the integrator step the parts that were set?  0 or a failure (recorded). */
int sph_sim_parts_fit(sph_sim *sim);

#endif
