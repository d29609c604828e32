/* nvector.h -- our own N_Vector: one contiguous, 64-byte aligned block of doubles.
 *
 * Reductions sum fixed chunks of each segment's n entries in order (padding never counts), so that they are bitwise
 * the same for any number of threads. */
#ifndef SPH_NVECTOR_H
#define SPH_NVECTOR_H
#include <sundials/sundials_nvector.h>

#include "layout.h"
#include "sphode/base.h"

/* A vector of that layout (borrowed: must outlive all clones), entries zero.  NULL on failure (recorded). */
N_Vector sph_nvector_create(const sph_layout *layout, int threads, SUNContext context,
                            sph_error *error);
double *sph_nvector_data(N_Vector v);
const sph_layout *sph_nvector_layout(N_Vector v);
/* Vectors alive that were cloned from the same root, itself included (for the memory report and leak tests). */

#endif
