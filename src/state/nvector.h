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
/* A clone of w with entries zero, or NULL (recorded); N_VClone instead gives a vector without
 * entries. */
N_Vector sph_nvector_clone(N_Vector w, const char *what, sph_error *error);
/* How many such vectors live; while there are any, no operation on v and its relatives does
 * anything. */
long sph_nvector_lost(N_Vector v);
/* Is it such a vector, with entries, of a layout of at least that length? */
int sph_nvector_holds(N_Vector v, long length);
double *sph_nvector_data(N_Vector v);
const sph_layout *sph_nvector_layout(N_Vector v);
#endif
