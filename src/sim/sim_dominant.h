/* sim_dominant.h -- a bound of the eigenvalues of df/dy, for stabilised schemes. */
#ifndef SPH_SIM_DOMINANT_H
#define SPH_SIM_DOMINANT_H
#include "sim_data.h"

/* sph_problem.dominant: lambda >= |eigenvalue| [1/s]; as much work as an evaluation of f. */
int sph_sim_dominant(double t, N_Vector y, double *lambda, void *sim);

#endif
