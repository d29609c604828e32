/* tile_matrix.h -- what registered pair terms give to the matrices of implicit stages
 * (sph_term_jacobian), tile by tile.
 *
 * The built-in terms have made the entries (matrix_loops.c); to each, in the same order, is added
 * - gamma w_i k, to the diagonal gamma w_i k, w = m or V.  Beside walls, without masks, twice that
 * to the diagonal alone: as if the wall's x were 2 x_wall - x_i. */
#ifndef SPH_TILE_MATRIX_H
#define SPH_TILE_MATRIX_H
#include "matrix_loops.h"
#include "tile_pair.h"

typedef struct tile_matrix {
  const sph_matrix_task *task;
  const tile_constants *k;
  vec weight; /* gamma w of the targets */
  int lanes, vector;
  unsigned char bits[SPH_TILE_ROWS];
  double *at[SPH_LANES]; /* the next entry of each target */
  long row[SPH_LANES];   /* vector: entries of a row of each target */
  double sum[SPH_LANES];
  tile_rows rows;
} tile_matrix;

/* The registered terms on rows 0 .. n - 1; the place of push holds k. */
static __attribute__((noinline, unused)) void tile_jacobian(int dim, tile_matrix *it, int n)
{
  const tile_constants *k = it->k;
  sph_tile tile = tile_open(dim, k, &it->rows);
  tile.n = (long)n * SPH_LANES;
  double *to = (double *)it->rows.push;
  memset(to, 0, (size_t)n * sizeof(vec));
  const sph_term_jacobian jacobian = {.v = k->unknown == TILE_VELOCITY ? to : NULL,
                                      .T = k->unknown == TILE_TEMPERATURE ? to : NULL,
                                      .s = k->unknown == TILE_SCALAR ? to : NULL};
  for (int q = 0; q < k->terms; q++) {
    const sph_term *term = k->term[q].term;
    if (!term->jacobian_pair) continue;
    tile_fields(&k->term[q], &it->rows, &tile);
    term->jacobian_pair(term, &tile, &jacobian);
  }
}

static __attribute__((noinline, unused)) void tile_matrix_take(int dim, const vec *v,
                                                               tile_matrix *it, int n)
{
  tile_fill_pair(dim, it->k, v, &it->rows, n);
  tile_fill(dim, it->k, v, &it->rows, n);
  tile_jacobian(dim, it, n);
  for (int q = 0; q < n; q++) {
    const vec value = it->weight * it->rows.push[q];
    for (int l = 0; l < it->lanes; l++) {
      if (!(it->bits[q] >> l & 1)) continue;
      it->sum[l] += value[l];
      if (!it->task->mask) continue;
      for (int a = 0; a < (it->vector ? dim : 1); a++) it->at[l][a * (it->row[l] + 1)] -= value[l];
      it->at[l] += it->vector ? dim : 1;
    }
  }
}

BODY void tile_matrix_open(int dim, tile_matrix *it, long b)
{
  const sph_matrix_task *t = it->task;
  const double *record = t->pairs->target + b * SPH_LANES * t->pairs->target_stride;
  const int d = it->vector ? dim : 1;
  long left = t->targets - b * SPH_LANES;
  vec V = v_gather(record + slot_V(dim), t->pairs->target_stride);
  vec rho = v_gather(record + slot_rho(dim), t->pairs->target_stride);
  it->lanes = left < SPH_LANES ? (int)left : SPH_LANES;
  it->weight = it->k->gamma * (it->k->per_volume ? V : V * rho);
  for (int l = 0; l < it->lanes; l++) {
    const long i = b * SPH_LANES + l, *start = t->start + i * d;
    it->sum[l] = 0;
    it->row[l] = start[1] - start[0];
    if (t->mask) it->at[l] = t->value + start[0] + d - 1 + (long)t->filled[i] * d;
  }
}

BODY void tile_matrix_close(int dim, tile_matrix *it, long b)
{
  const sph_matrix_task *t = it->task;
  const int d = it->vector ? dim : 1;
  for (int l = 0; l < it->lanes; l++) {
    const long i = b * SPH_LANES + l;
    for (int a = 0; a < d; a++) t->diagonal[i * d + a] += (t->mask ? 1 : 2) * it->sum[l];
    if (t->mask) t->filled[i] = (int)((it->at[l] - t->value - t->start[i * d] - d + 1) / d);
  }
}

/* All pairs of one block. */
BODY void tile_matrix_block(int dim, tile_matrix *it, long b)
{
  const sph_pair_task *t = it->task->pairs;
  const double *record = t->target + b * SPH_LANES * t->target_stride;
  const unsigned char *mask = it->task->mask ? it->task->mask + it->task->first[b] : NULL;
  vec home[3], x[3], v[3];
  int n = 0;
  for (int d = 0; d < dim; d++) {
    home[d] = v_gather(record + d, t->target_stride);
    v[d] = v_gather(record + slot_v(dim) + d, t->target_stride);
  }
  tile_targets(dim, it->k, record, t->target_stride, &it->rows);
  tile_matrix_open(dim, it, b);
  for (long r = t->first[b]; r < t->first[b + 1]; r++) {
    const sph_run run = t->runs[r];
    const double *source = t->source + sph_run_start(run) * t->source_stride;
    for (int d = 0; d < dim; d++) x[d] = home[d] - t->shift[sph_run_image(run)][d];
    for (int q = 0; q < sph_run_count(run); q++, source += t->source_stride) {
      const unsigned char bits = mask ? *mask++ : 255;
      if (!bits) continue;
      it->bits[n] = bits;
      tile_row(dim, x, source, &it->rows, n++);
      if (n < SPH_TILE_ROWS) continue;
      tile_matrix_take(dim, v, it, n);
      n = 0;
    }
  }
  if (n > 0) tile_matrix_take(dim, v, it, n);
  tile_matrix_close(dim, it, b);
}

BODY void tile_matrix_blocks(int dim, const sph_matrix_task *t, long begin, long end)
{
  tile_matrix it = {.task = t, .k = t->pairs->constants, .vector = t->vector};
  for (long b = begin; b < end; b++)
    if (t->pairs->first[b] < t->pairs->first[b + 1]) tile_matrix_block(dim, &it, b);
}

#endif
