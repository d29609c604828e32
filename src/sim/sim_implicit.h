/* sim_implicit.h -- stages of implicit-explicit schemes, z = known + gamma f_I(t, z). */
#ifndef SPH_SIM_IMPLICIT_H
#define SPH_SIM_IMPLICIT_H
#include "sim_data.h"

/* What it takes to solve stages, where there are implicit terms.  0 or a failure (recorded). */
int sph_sim_implicit_make(sph_sim *sim);
void sph_sim_implicit_free(sph_sim *sim);
double sph_sim_implicit_bytes(const sph_sim *sim); /* without its linear solvers */
/* What they remember from stage to stage, for checkpoints. */
int sph_sim_implicit_keep(sph_sim *sim, sph_keep *keep);

/* Is there an implicit term of the user's own that changes the energy?  Has every fluid one? */
int sph_sim_implicit_heats(const sph_sim *sim);
int sph_sim_implicit_check(sph_sim *sim);

/* sph_problem.solve */
int sph_sim_implicit_solve(sph_stage *stage, void *sim);

#endif
