/* sim_implicit.h -- stages of implicit-explicit schemes, z = known + gamma f_I(t, z). */
#ifndef SPH_SIM_IMPLICIT_H
#define SPH_SIM_IMPLICIT_H
#include "sim_data.h"

/* What it takes to solve stages, where there are implicit terms.  0 or a failure (recorded). */
int sph_sim_implicit_make(sph_sim *sim);
void sph_sim_implicit_free(sph_sim *sim);

/* sph_problem.solve */
int sph_sim_implicit_solve(sph_stage *stage, void *sim);

#endif
