/* Instances of the loop that makes masks, once per instruction set. */
#include "mask_loops.h"

/* Bits of the lanes that hold targets. */
static unsigned lanes_of(const sph_mask_task *k, long b)
{
  long n = k->targets - b * SPH_LANES;
  return n >= SPH_LANES ? (1u << SPH_LANES) - 1 : (1u << n) - 1;
}

BODY void mask_run(int dim, const sph_mask_task *k, long b, sph_run run, unsigned lanes,
                   const vec *home, unsigned char *mask)
{
  const sph_pair_task *t = k->pairs;
  const double *source = t->source + sph_run_start(run) * t->source_stride;
  const long itself =
      k->same && sph_run_image(run) == 0 ? b * SPH_LANES - sph_run_start(run) : -SPH_LANES;
  vec i[3];
  for (int d = 0; d < dim; d++) i[d] = home[d] - t->shift[sph_run_image(run)][d];
  for (long n = 0; n < sph_run_count(run); n++, source += t->source_stride) {
    vec r2 = v_set(0);
    for (int d = 0; d < dim; d++) r2 += (i[d] - source[d]) * (i[d] - source[d]);
    unsigned bits = lanes & v_bits((vec_mask)(r2 < k->reach2));
    if (n >= itself && n < itself + SPH_LANES) bits &= ~(1u << (n - itself));
    mask[n] = (unsigned char)bits;
  }
}

BODY void mask_blocks(int dim, const sph_mask_task *k, long begin, long end)
{
  const sph_pair_task *t = k->pairs;
  for (long b = begin; b < end; b++) {
    const double *record = t->target + b * SPH_LANES * t->target_stride;
    unsigned char *mask = k->mask + k->first[b];
    vec home[3];
    for (int d = 0; d < dim; d++) home[d] = v_gather(record + d, t->target_stride);
    for (long r = t->first[b]; r < t->first[b + 1]; mask += sph_run_count(t->runs[r++]))
      mask_run(dim, k, b, t->runs[r], lanes_of(k, b), home, mask);
  }
}

#define MASK(dim) \
  static void mask_##dim(const sph_mask_task *k, long b, long e) { mask_blocks(dim, k, b, e); }
MASK(1)
MASK(2)
MASK(3)

const sph_mask_table SPH_ISA_NAME(sph_mask_loops) = {{mask_1, mask_2, mask_3}};
