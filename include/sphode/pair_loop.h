/* sphode/pair_loop.h -- the loop over pairs, for any body: it knows no physics.
 *
 * Every target in a lane, every source broadcast.  A block of SPH_LANES consecutive sorted targets
 * meets, run by run, its sources (sphode/neighbors.h).  Particles are records of doubles in sorted
 * order; the first dim slots of a record are the position.  No atomics, colours or reductions: the
 * sums of a target depend on the order of its sources only.
 *
 * Use it around your own body:
 *
 *   BODY void count(int dim, const void *k, const vec *i, const vec *j, vec *sum)
 *   {
 *     sum[0] += ...;
 *   }
 *   void count_pairs(const sph_pair_task *t, long begin, long end)
 *   {
 *     sph_pair_loop(count, t, begin, end, 2, 2, 1);
 *   }
 *
 * dim, slots and sums must be constants for the loop to be fast.  A pair outside the support must
 * add exact zeros, and so must a particle with itself. */
#ifndef SPHODE_PAIR_LOOP_H
#define SPHODE_PAIR_LOOP_H

#include "sphode/neighbors.h"
#include "sphode/simd.h"

enum { SPH_PAIR_SLOTS = 26, SPH_PAIR_SUMS = 18 };

typedef struct sph_pair_task {
  const double *target; /* [blocks * lanes][target_stride] records; those past the last target: any
                           finite values */
  const double *source; /* [n_source][source_stride] records */
  long target_stride, source_stride;
  const long *first;        /* [blocks + 1] */
  const sph_run *runs;      /* [first[blocks]] */
  const double (*shift)[3]; /* of the images [m] */
  double *const *sum;       /* [sums][blocks * lanes], added to, sorted order */
  /* Of the library's mixed precision; NULL, NULL, 0 else: the same records as floats, but positions
   * as 32-bit integers, in quanta [m]. */
  const float *target_single, *source_single;
  double quantum;
  const void *constants; /* what the body needs besides */
} sph_pair_task;

typedef void sph_pair_function(const sph_pair_task *task, long begin, long end); /* blocks */

/* Adds to sum[] what target i (a lane each) gets from source j (the same in all lanes). */
typedef void sph_pair_body(int dim, const void *constants, const vec *i, const vec *j, vec *sum);

/* The next block is next in its column: its runs there end about a block behind these.  Fetched
 * early, they cost no waiting: 8 % of the loop in small cases, 13 % with a million particles. */
BODY void pair_prefetch(const double *behind, int slots)
{
#pragma GCC unroll 26
  for (int line = 0; line <= SPH_LANES * slots / 8; line++) __builtin_prefetch(behind + 8 * line);
}

/* Slots of the records of a block, a vector each.  Called once a block; inlined, it would be half
 * of the code of a loop. */
static __attribute__((noinline, unused)) void pair_gather(const vec_number *record, long stride,
                                                          int slots, vec_number (*slot)[SPH_LANES])
{
  for (int s = 0; s < slots; s++)
    for (int l = 0; l < SPH_LANES; l++) slot[s][l] = record[l * stride + s];
}

#ifndef SPH_VEC_FLOAT
BODY void sph_pair_loop(sph_pair_body *body, const sph_pair_task *t, long begin, long end, int dim,
                        int slots, int sums)
{
  for (long b = begin; b < end; b++) {
    if (t->first[b] == t->first[b + 1]) continue;
    vec home[SPH_PAIR_SLOTS], sum[SPH_PAIR_SUMS];
    const double *record = t->target + b * SPH_LANES * t->target_stride;
    double slot[SPH_PAIR_SLOTS][SPH_LANES];
    pair_gather(record, t->target_stride, slots, slot);
#pragma GCC unroll 26
    for (int s = 0; s < slots; s++) home[s] = v_load(slot[s]);
#pragma GCC unroll 18
    for (int s = 0; s < sums; s++) sum[s] = v_load(t->sum[s] + b * SPH_LANES);
    long r = t->first[b];
    do { /* every block here has runs, every run sources: a compiler keeps sums in registers */
      const sph_run run = t->runs[r];
      vec i[SPH_PAIR_SLOTS], j[SPH_PAIR_SLOTS];
#pragma GCC unroll 26
      for (int s = 0; s < slots; s++)
        i[s] = s < dim ? home[s] - t->shift[sph_run_image(run)][s] : home[s];
      const double *source = t->source + sph_run_start(run) * t->source_stride;
      const double *const end_of_run = source + sph_run_count(run) * t->source_stride;
      pair_prefetch(end_of_run, slots);
      do {
#pragma GCC unroll 26
        for (int s = 0; s < slots; s++) j[s] = v_set(source[s]);
        body(dim, t->constants, i, j, sum);
        source += t->source_stride;
      } while (source != end_of_run);
    } while (++r < t->first[b + 1]);
#pragma GCC unroll 18
    for (int s = 0; s < sums; s++) v_store(t->sum[s] + b * SPH_LANES, sum[s]);
  }
}
#endif

#endif
