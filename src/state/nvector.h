/* nvector.h -- our own N_Vector: one contiguous, 64-byte aligned block of doubles.
 *
 * Operations leave padding alone.  Reductions sum fixed chunks of each segment's n entries in
 * order: bitwise the same for any number of threads. */
#ifndef SPH_NVECTOR_H
#define SPH_NVECTOR_H
#include "layout.h"
#include "sphode/base.h"
#include "sundials.h"

/* A vector of that layout (borrowed: outlives all clones; a segment's n may change between
 * steps), entries zero.  NULL on failure (recorded). */
N_Vector sph_nvector_create(const sph_layout *layout, int threads, SUNContext context,
                            sph_error *error);
double *sph_nvector_data(N_Vector v);
const sph_layout *sph_nvector_layout(N_Vector v);
#endif
