/* linear_cholmod.h -- Cholesky factors whose fill is known before they are made. */
#ifndef SPH_LINEAR_CHOLMOD_H
#define SPH_LINEAR_CHOLMOD_H
#include "linear_data.h"

/* Supernodal or simplicial, as CHOLMOD sees fit. */
extern const sph_linear_method sph_linear_cholmod;

/* The symbolic half of a solve, for the next one of the same pattern; what the numeric half will
 * take: flops and entries of L. */
int sph_linear_cholmod_analyse(sph_linear *solver, const sph_linear_task *task, double *flops,
                               double *entries, sph_error *error);

#endif
