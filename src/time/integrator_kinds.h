/* integrator_kinds.h -- the rows of multirate, symplectic and low-storage schemes. */
#ifndef SPH_INTEGRATOR_KINDS_H
#define SPH_INTEGRATOR_KINDS_H
#include "integrator_data.h"

/* Name of row k = 0, 1, ..., also of those that this SUNDIALS lacks, which come last; NULL behind
 * the last.  *needs: the SUNDIALS that has it first, 70200 for 7.2.0. */
const char *sph_integrator_mri_known(int k, int *needs);
const char *sph_integrator_sprk_known(int k, int *needs);
const char *sph_integrator_lsrk_known(int k, int *needs);

/* What such a row is, but its name; 0: out of memory.  Only of rows that this SUNDIALS has. */
int sph_integrator_mri_info(int k, sph_integrator_info *info);
int sph_integrator_sprk_info(int k, sph_integrator_info *info);
int sph_integrator_lsrk_info(int k, sph_integrator_info *info);

extern const sph_stepper sph_integrator_mri, sph_integrator_sprk, sph_integrator_lsrk;

#endif
