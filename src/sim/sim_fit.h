/* sim_fit.h -- has the simulation what its integrator asks for? */
#ifndef SPH_SIM_FIT_H
#define SPH_SIM_FIT_H
#include "sim_data.h"

/* Once all terms are known: a separable f, a bound of its eigenvalues, an energy.  0 or a failure
 * (recorded). */
int sph_sim_fit(sph_sim *sim);

#endif
