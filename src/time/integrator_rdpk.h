/* integrator_rdpk.h -- the Runge-Kutta pairs of Ranocha et al. (2022). */
#ifndef SPH_INTEGRATOR_RDPK_H
#define SPH_INTEGRATOR_RDPK_H
#include "sundials.h"

/* Pair k = 0, 1, ...; NULL behind the last. */
const char *sph_integrator_rdpk_name(int k);
/* Its Butcher table, owned by the caller; NULL: out of memory. */
ARKodeButcherTable sph_integrator_rdpk_table(int k);
/* Its stability limit S, measured. */
double sph_integrator_rdpk_stability(int k);
/* The exponents beta_1, beta_2, beta_3 of its step size controller: [3]; NULL behind the last. */
const double *sph_integrator_rdpk_control(int k);

#endif
