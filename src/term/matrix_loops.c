/* Instances of the loops that fill matrices, once per instruction set, for any kernel: what it
 * costs to tell them apart is little beside what it costs to scatter the entries. */
#include "matrix_loops.h"

BODY int kernel_of(const void *constants)
{
  return ((const matrix_constants *)constants)->fluid.kernel;
}

/* The targets of a block whose bit is set. */
#define EACH_LANE(l, bits)                                                               \
  for (unsigned rest_ = (bits), l = 0; rest_ && (l = (unsigned)__builtin_ctz(rest_), 1); \
       rest_ &= rest_ - 1)

typedef struct matrix_block {
  const sph_matrix_task *task;
  long target;               /* the first */
  int lanes;                 /* that hold targets */
  const unsigned char *mask; /* of the next source */
  vec home[SPH_PAIR_SLOTS], i[SPH_PAIR_SLOTS];
  double *at[SPH_LANES];    /* scalar: the next entry of each target; vector: of its first row */
  long row[SPH_LANES];      /* vector: entries of a row of each target */
  double sum[6][SPH_LANES]; /* of k; of k I + q r r^T, the upper triangle by rows */
} matrix_block;

BODY matrix_block open_block(int slots, const sph_matrix_task *k, long b)
{
  matrix_block it = {.task = k, .target = b * SPH_LANES, .mask = k->mask + k->first[b]};
  const double *record = k->pairs->target + it.target * k->pairs->target_stride;
  long left = k->targets - it.target;
  it.lanes = left < SPH_LANES ? (int)left : SPH_LANES;
  for (int s = 0; s < slots; s++) it.home[s] = v_gather(record + s, k->pairs->target_stride);
  return it;
}

BODY void shift_block(int dim, int slots, matrix_block *it, sph_run run)
{
  for (int s = 0; s < slots; s++)
    it->i[s] = s < dim ? it->home[s] - it->task->pairs->shift[sph_run_image(run)][s] : it->home[s];
}

/* ---- scalars ---- */

BODY void scalar_run(int dim, int kernel, matrix_block *it, sph_run run)
{
  const sph_pair_task *t = it->task->pairs;
  const double *source = t->source + sph_run_start(run) * t->source_stride;
  for (int n = 0; n < sph_run_count(run); n++, source += t->source_stride) {
    const unsigned bits = *it->mask++;
    if (!bits) continue;
    vec j[SPH_PAIR_SLOTS];
    for (int d = 0; d < dim; d++) j[d] = v_set(source[d]);
    j[slot_V(dim)] = v_set(source[slot_V(dim)]);
    const vec k = matrix_scalar(dim, kernel, t->constants, it->i, j);
    EACH_LANE(l, bits)
    {
      *it->at[l]++ = -k[l];
      it->sum[0][l] += k[l];
    }
  }
}

BODY void scalar_blocks(int dim, int kernel, const sph_matrix_task *k, long begin, long end)
{
  const int slots = slot_V(dim) + 1;
  for (long b = begin; b < end; b++) {
    if (k->first[b] == k->first[b + 1]) continue;
    matrix_block it = open_block(slots, k, b);
    const long *start = k->start + it.target;
    int *filled = k->filled + it.target;
    for (int l = 0; l < it.lanes; l++) it.at[l] = k->value + start[l] + filled[l];
    for (long r = k->pairs->first[b]; r < k->pairs->first[b + 1]; r++) {
      shift_block(dim, slots, &it, k->pairs->runs[r]);
      scalar_run(dim, kernel, &it, k->pairs->runs[r]);
    }
    for (int l = 0; l < it.lanes; l++) {
      filled[l] = (int)(it.at[l] - k->value - start[l]);
      k->diagonal[it.target + l] += it.sum[0][l];
    }
  }
}

/* ---- vectors ---- */

/* The block of one pair: k I + q r r^T. */
BODY void vector_entry(int dim, matrix_block *it, unsigned l, double k, double q, const vec *r)
{
  double *to = it->at[l];
  int s = 0;
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++, s++) {
      const double value = q * r[a][l] * r[b][l] + (a == b ? k : 0);
      to[a * it->row[l] + b] = -value;
      to[b * it->row[l] + a] = -value;
      it->sum[s][l] += value;
    }
  it->at[l] += dim;
}

BODY void vector_run(int dim, int kernel, matrix_block *it, sph_run run)
{
  const sph_pair_task *t = it->task->pairs;
  const double *source = t->source + sph_run_start(run) * t->source_stride;
  for (int n = 0; n < sph_run_count(run); n++, source += t->source_stride) {
    const unsigned bits = *it->mask++;
    if (!bits) continue;
    vec j[SPH_PAIR_SLOTS], along_v, along_r;
    for (int s = 0; s < slot_extra(dim); s++) j[s] = v_set(source[s]);
    matrix_pair p;
    matrix_vector(dim, kernel, t->constants, it->i, j, &p, &along_v, &along_r);
    EACH_LANE(l, bits) { vector_entry(dim, it, l, along_v[l], along_r[l], p.r); }
  }
}

/* Adds the sums of target l to the diagonal block. */
BODY void vector_diagonal(int dim, const matrix_block *it, int l)
{
  const sph_matrix_task *k = it->task;
  const long row = (it->target + l) * dim;
  int s = 0;
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++, s++) {
      if (a == b) k->diagonal[row + a] += it->sum[s][l];
      if (a == b) continue;
      k->value[k->start[row + a] + b - 1] += it->sum[s][l];
      k->value[k->start[row + b] + a] += it->sum[s][l];
    }
}

BODY void vector_blocks(int dim, int kernel, const sph_matrix_task *k, long begin, long end)
{
  const int slots = slot_extra(dim);
  for (long b = begin; b < end; b++) {
    if (k->first[b] == k->first[b + 1]) continue;
    matrix_block it = open_block(slots, k, b);
    int *filled = k->filled + it.target;
    for (int l = 0; l < it.lanes; l++) {
      const long *start = k->start + (it.target + l) * dim;
      it.row[l] = start[1] - start[0];
      it.at[l] = k->value + start[0] + dim - 1 + (long)filled[l] * dim;
    }
    for (long r = k->pairs->first[b]; r < k->pairs->first[b + 1]; r++) {
      shift_block(dim, slots, &it, k->pairs->runs[r]);
      vector_run(dim, kernel, &it, k->pairs->runs[r]);
    }
    for (int l = 0; l < it.lanes; l++) {
      const double *begun = k->value + k->start[(it.target + l) * dim] + dim - 1;
      filled[l] = (int)((it.at[l] - begun) / dim);
      vector_diagonal(dim, &it, l);
    }
  }
}

/* ---- walls: sums alone ---- */

BODY void wall_scalar(int dim, const void *constants, const vec *i, const vec *j, vec *sum)
{
  sum[0] += matrix_scalar(dim, kernel_of(constants), constants, i, j);
}

BODY void wall_vector(int dim, const void *constants, const vec *i, const vec *j, vec *sum)
{
  matrix_pair p;
  vec along_v, along_r;
  matrix_vector(dim, kernel_of(constants), constants, i, j, &p, &along_v, &along_r);
  int s = 0;
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++, s++) {
      sum[s] += along_r * p.r[a] * p.r[b];
      if (a == b) sum[s] += along_v;
    }
}

#define MATRIX(dim)                                                             \
  static void scalar_##dim(const sph_matrix_task *k, long b, long e)            \
  {                                                                             \
    scalar_blocks(dim, kernel_of(k->pairs->constants), k, b, e);                \
  }                                                                             \
  static void vector_##dim(const sph_matrix_task *k, long b, long e)            \
  {                                                                             \
    vector_blocks(dim, kernel_of(k->pairs->constants), k, b, e);                \
  }                                                                             \
  static void wall_scalar_##dim(const sph_pair_task *t, long b, long e)         \
  {                                                                             \
    sph_pair_loop(wall_scalar, t, b, e, dim, 2 * dim + 4, 1);                   \
  }                                                                             \
  static void wall_vector_##dim(const sph_pair_task *t, long b, long e)         \
  {                                                                             \
    sph_pair_loop(wall_vector, t, b, e, dim, 3 * dim + 4, dim * (dim + 1) / 2); \
  }
MATRIX(1)
MATRIX(2)
MATRIX(3)

#define LOOPS(dim)                                                   \
  {                                                                  \
    scalar_##dim, vector_##dim, wall_scalar_##dim, wall_vector_##dim \
  }
const sph_matrix_table SPH_ISA_NAME(sph_matrix_loops) = {{LOOPS(1), LOOPS(2), LOOPS(3)}};
