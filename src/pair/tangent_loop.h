/* tangent_loop.h -- the derivative of the loop over pairs, for any body of sphode/pair_loop.h.
 *
 * vec is one complex number here, value + i STEP derivative: STEP is so small that products of
 * derivatives vanish beside the values, and large enough that nothing underflows.  The sums S of a
 * target i are functions of its record, of those of its sources, and of the constants of the body:
 *
 *   tangent:     dS_i = sum_j (dS/di) di + (dS/dj) dj + (dS/dk) dk
 *   transposed:  with weights w of the sums of both ends, for a particle a of the target group
 *                bar_a += (dS_a/da)^T w_a            where it is the target,
 *                bar_a += sum_b (dS_b/da)^T w_b      where it is a source of b
 *
 * No atomics here either: the second one gathers, and needs the pairs (b <- a) in the list
 * (a <- b). */
#ifndef SPH_TANGENT_LOOP_H
#define SPH_TANGENT_LOOP_H
#include "sphode/neighbors.h"

/* All records are those of a pair loop; _d: their derivatives, of the same shape. */
typedef struct sph_tangent_task {
  const double *target, *target_d; /* [targets][target_stride]; _d: tangent only */
  const double *source, *source_d; /* [n_source][source_stride] */
  long target_stride, source_stride;
  long targets;
  int lanes;                /* targets in a block of the list */
  const long *first;        /* [blocks + 1] */
  const sph_run *runs;      /* [first[blocks]] */
  const double (*shift)[3]; /* of the images [m] */
  double reach2;            /* pairs farther than its root add zeros: they are skipped [m^2] */
  int kernel;
  unsigned terms; /* of fluid_constants, and its numbers */
  const double *numbers, *numbers_d;
  double *const *sum_d; /* tangent: [sums][targets] added to */
  /* Transposed: weights of the sums, [sums][targets] and [sums][n_source]; NULL: not a target, or
   * not a source, of the other.  Constants where the target is a source. */
  const double *const *weight, *const *weight_source;
  unsigned terms_source;
  const double *numbers_source;
  unsigned active; /* bit s: slot s matters */
  double *bar;     /* [targets][target_stride] added to */
} sph_tangent_task;

typedef void sph_tangent_function(const sph_tangent_task *task, long begin, long end); /* blocks */

#ifdef SPH_VEC_TANGENT
#include "sphode/pair_loop.h"

static const double tangent_step = 0x1p-300;

BODY vec tangent_number(double value, double derivative)
{
  return __builtin_complex(value, tangent_step * derivative);
}

/* Slots of one record, with derivatives. */
BODY void tangent_record(const double *record, const double *derivative, int slots, vec *to)
{
  for (int s = 0; s < slots; s++) to[s] = tangent_number(record[s], derivative[s]);
}

BODY void tangent_shift(const vec *home, const double *shift, int dim, int slots, vec *to)
{
  for (int s = 0; s < slots; s++) to[s] = s < dim ? home[s] - shift[s] : home[s];
}

BODY double tangent_distance2(int dim, const vec *i, const double *source)
{
  double r2 = 0;
  for (int d = 0; d < dim; d++) r2 += (__real__ i[d] - source[d]) * (__real__ i[d] - source[d]);
  return r2;
}

/* Target n of block b. */
BODY void tangent_target(sph_pair_body *body, const sph_tangent_task *t, const void *constants,
                         long b, long n, int dim, int slots, int sums)
{
  vec home[SPH_PAIR_SLOTS], i[SPH_PAIR_SLOTS], j[SPH_PAIR_SLOTS], sum[SPH_PAIR_SUMS];
  for (int s = 0; s < sums; s++) sum[s] = 0;
  tangent_record(t->target + n * t->target_stride, t->target_d + n * t->target_stride, slots, home);
  for (long r = t->first[b]; r < t->first[b + 1]; r++) {
    const sph_run run = t->runs[r];
    tangent_shift(home, t->shift[sph_run_image(run)], dim, slots, i);
    for (long k = sph_run_start(run); k < sph_run_start(run) + sph_run_count(run); k++) {
      const double *source = t->source + k * t->source_stride;
      if (tangent_distance2(dim, i, source) > t->reach2) continue;
      tangent_record(source, t->source_d + k * t->source_stride, slots, j);
      body(dim, constants, i, j, sum);
    }
  }
  for (int s = 0; s < sums; s++) t->sum_d[s][n] += __imag__ sum[s] / tangent_step;
}

BODY void tangent_loop(sph_pair_body *body, const sph_tangent_task *t, const void *constants,
                       long begin, long end, int dim, int slots, int sums)
{
  for (long b = begin; b < end; b++)
    for (long n = b * t->lanes; n < (b + 1) * t->lanes && n < t->targets; n++)
      tangent_target(body, t, constants, b, n, dim, slots, sums);
}

/* bar += (d sums/d which)^T weight, slot by slot; which is i or j; both: i and j together. */
BODY void transposed_slots(sph_pair_body *body, const void *constants, unsigned active,
                           const vec *i, const vec *j, vec *which, vec *both, const double *weight,
                           int dim, int slots, int sums, double *bar)
{
  for (int s = 0; s < slots; s++) {
    vec sum[SPH_PAIR_SUMS];
    double slope = 0;
    if (!(active >> s & 1)) continue;
    for (int q = 0; q < sums; q++) sum[q] = 0;
    const double kept = __real__ which[s];
    which[s] = tangent_number(kept, 1);
    if (both) both[s] = which[s];
    body(dim, constants, i, j, sum);
    which[s] = kept;
    if (both) both[s] = kept;
    for (int q = 0; q < sums; q++) slope += weight[q] * __imag__ sum[q];
    bar[s] += slope / tangent_step;
  }
}

/* Slots of a record alone. */
BODY void transposed_record(const double *record, int slots, vec *to)
{
  for (int s = 0; s < slots; s++) to[s] = record[s];
}

BODY void transposed_target(sph_pair_body *body, const sph_tangent_task *t, const void *constants,
                            const void *constants_source, long b, long n, int dim, int slots,
                            int sums)
{
  vec home[SPH_PAIR_SLOTS], i[SPH_PAIR_SLOTS], j[SPH_PAIR_SLOTS];
  double weight[SPH_PAIR_SUMS], bar[SPH_PAIR_SLOTS] = {0};
  transposed_record(t->target + n * t->target_stride, slots, home);
  for (long r = t->first[b]; r < t->first[b + 1]; r++) {
    const sph_run run = t->runs[r];
    tangent_shift(home, t->shift[sph_run_image(run)], dim, slots, i);
    for (long k = sph_run_start(run); k < sph_run_start(run) + sph_run_count(run); k++) {
      const double *source = t->source + k * t->source_stride;
      if (tangent_distance2(dim, i, source) > t->reach2) continue;
      const int self = source == t->target + n * t->target_stride; /* moves with itself */
      transposed_record(source, slots, j);
      if (t->weight) {
        for (int q = 0; q < sums; q++) weight[q] = t->weight[q][n];
        transposed_slots(body, constants, t->active, i, j, i, self ? j : NULL, weight, dim, slots,
                         sums, bar);
      }
      if (t->weight_source && !self) {
        for (int q = 0; q < sums; q++) weight[q] = t->weight_source[q][k];
        transposed_slots(body, constants_source, t->active, j, i, i, NULL, weight, dim, slots, sums,
                         bar);
      }
    }
  }
  for (int s = 0; s < slots && s < t->target_stride; s++)
    t->bar[n * t->target_stride + s] += bar[s];
}

BODY void transposed_loop(sph_pair_body *body, const sph_tangent_task *t, const void *constants,
                          const void *constants_source, long begin, long end, int dim, int slots,
                          int sums)
{
  for (long b = begin; b < end; b++)
    for (long n = b * t->lanes; n < (b + 1) * t->lanes && n < t->targets; n++)
      transposed_target(body, t, constants, constants_source, b, n, dim, slots, sums);
}
#endif

#endif
