/* single_loop.h -- the loop over pairs in single precision (SPH_VEC_FLOAT): eight floats a vector,
 * whatever the width of the doubles.
 *
 * Positions are 32-bit integers, in quanta: their differences are exact far from the origin and in
 * all images, and no more than the floats that they become are rounded.  Sums are floats over some
 * 32 sources and doubles over all.  Bodies see the difference of two positions as the position of
 * the target, and zero as that of the source. */
#ifndef SPH_SINGLE_LOOP_H
#define SPH_SINGLE_LOOP_H

#include "sphode/pair_loop.h"

#ifdef SPH_VEC_FLOAT

enum { SPH_SINGLE_SUMMED = 32 }; /* sources, or a run more, before sums become doubles */

BODY int single_integer(float a)
{
  int integer;
  memcpy(&integer, &a, sizeof integer);
  return integer;
}

/* Eight doubles.  Compilers make poor code of vectors that are wider than a register. */
typedef struct single_wide {
  __m256d low, high;
} single_wide;

BODY single_wide single_load(const double *a)
{
  return (single_wide){_mm256_loadu_pd(a), _mm256_loadu_pd(a + 4)};
}

BODY void single_store(double *to, single_wide a)
{
  _mm256_storeu_pd(to, a.low);
  _mm256_storeu_pd(to + 4, a.high);
}

BODY void single_add(single_wide *total, vec a)
{
  total->low += _mm256_cvtps_pd(_mm256_castps256_ps128((__m256)a));
  total->high += _mm256_cvtps_pd(_mm256_extractf128_ps((__m256)a, 1));
}

/* The sources of a run. */
BODY void single_run(sph_pair_body *body, const sph_pair_task *t, sph_run run, int dim, int slots,
                     const vec_mask *home, const vec *i, vec *sum)
{
  const vec_scalar quantum = (vec_scalar)t->quantum;
  const float *source = t->source_single + sph_run_start(run) * t->source_stride;
  const float *const end_of_run = source + sph_run_count(run) * t->source_stride;
  vec_mask at[3];
  for (int d = 0; d < dim; d++) at[d] = home[d];
  if (sph_run_image(run) > 0)
    for (int d = 0; d < dim; d++)
      at[d] -= (int32_t)lrint(t->shift[sph_run_image(run)][d] / t->quantum);
#pragma GCC unroll 26
  for (int line = 0; line <= SPH_LANES * slots / 16; line++)
    __builtin_prefetch(end_of_run + 16 * line); /* as pair_prefetch */
  do {
    vec relative[SPH_PAIR_SLOTS], j[SPH_PAIR_SLOTS];
#pragma GCC unroll 26
    for (int s = 0; s < slots; s++)
      if (s < dim) {
        relative[s] = __builtin_convertvector(at[s] - single_integer(source[s]), vec) * quantum;
        j[s] = v_set(0);
      } else {
        relative[s] = i[s];
        j[s] = v_set(source[s]);
      }
    body(dim, t->constants, relative, j, sum);
    source += t->source_stride;
  } while (source != end_of_run);
}

BODY void sph_pair_loop(sph_pair_body *body, const sph_pair_task *t, long begin, long end, int dim,
                        int slots, int sums)
{
  for (long b = begin; b < end; b++) {
    if (t->first[b] == t->first[b + 1]) continue;
    vec_mask home[3];
    vec i[SPH_PAIR_SLOTS], sum[SPH_PAIR_SUMS];
    single_wide total[SPH_PAIR_SUMS];
    const float *record = t->target_single + b * SPH_LANES * t->target_stride;
    float slot[SPH_PAIR_SLOTS][SPH_LANES];
    pair_gather(record, t->target_stride, slots, slot);
    for (int d = 0; d < dim; d++) home[d] = (vec_mask)v_load(slot[d]);
#pragma GCC unroll 26
    for (int s = dim; s < slots; s++) i[s] = v_load(slot[s]);
#pragma GCC unroll 18
    for (int s = 0; s < sums; s++) {
      total[s] = single_load(t->sum[s] + b * SPH_LANES);
      sum[s] = v_set(0);
    }
    int summed = 0;
    long r = t->first[b];
    do {
      single_run(body, t, t->runs[r], dim, slots, home, i, sum);
      summed += sph_run_count(t->runs[r]);
      if (summed < SPH_SINGLE_SUMMED && r + 1 < t->first[b + 1]) continue;
#pragma GCC unroll 18
      for (int s = 0; s < sums; s++) {
        single_add(&total[s], sum[s]);
        sum[s] = v_set(0);
      }
      summed = 0;
    } while (++r < t->first[b + 1]);
#pragma GCC unroll 18
    for (int s = 0; s < sums; s++) single_store(t->sum[s] + b * SPH_LANES, total[s]);
  }
}

#endif
#endif
