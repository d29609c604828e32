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
  const double *target, *target_d; /* [targets][target_stride] */
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
  double *const *sum, *const *sum_d; /* [sums][targets] added to; sum NULL: values not wanted */
  /* transposed only: */
  const double *const *weight;        /* [sums][targets] of the targets; NULL: none */
  const double *const *weight_source; /* [sums][n_source] of the sources; NULL: none */
  double *bar;                        /* [targets][target_stride] added to */
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

/* Is a source within reach of i? */
BODY int tangent_near(const sph_tangent_task *t, int dim, const vec *i, const double *source)
{
  double r2 = 0;
  for (int d = 0; d < dim; d++) r2 += (__real__ i[d] - source[d]) * (__real__ i[d] - source[d]);
  return r2 <= t->reach2;
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
    tangent_shift(home, t->shift[run.image], dim, slots, i);
    for (long k = run.start; k < (long)run.start + (long)run.count; k++) {
      const double *source = t->source + k * t->source_stride;
      if (!tangent_near(t, dim, i, source)) continue;
      tangent_record(source, t->source_d + k * t->source_stride, slots, j);
      body(dim, constants, i, j, sum);
    }
  }
  for (int s = 0; s < sums; s++) {
    if (t->sum) t->sum[s][n] += __real__ sum[s];
    t->sum_d[s][n] += __imag__ sum[s] / tangent_step;
  }
}

BODY void tangent_loop(sph_pair_body *body, const sph_tangent_task *t, const void *constants,
                       long begin, long end, int dim, int slots, int sums)
{
  for (long b = begin; b < end; b++)
    for (long n = b * t->lanes; n < (b + 1) * t->lanes && n < t->targets; n++)
      tangent_target(body, t, constants, b, n, dim, slots, sums);
}
#endif

#endif
