/* tile_pair.h -- pair terms that are registered at run time, tile by tile (sph_tile).
 *
 * A tile is a block of targets times up to SPH_TILE_ROWS sources.  The built-in terms run fused
 * while it is filled; then each term that was registered adds to it; then its rows are summed, and
 * heated, as built-in ones are. */
#ifndef SPH_TILE_PAIR_H
#define SPH_TILE_PAIR_H
#include "fluid_terms.h"
#include "sphode/term.h"

enum { SPH_TILE_ROWS = 16, SPH_TILE_TERMS = 32 };

/* Fields that a tile can hold of both ends. */
enum sph_tile_field {
  SPH_TILE_DENSITY,
  SPH_TILE_PRESSURE,
  SPH_TILE_SOUND_SPEED,
  SPH_TILE_ENERGY,
  SPH_TILE_TEMPERATURE,
  SPH_TILE_SCALAR, /* + number of the scalar */
  SPH_TILE_FIELDS = SPH_TILE_SCALAR + SPH_SCALARS_MAX
};

/* Sums of a target: those of the fluid loop, then these. */
enum {
  SPH_SUM_DENSITY = SPH_FLUID_SUMS_ALL,
  SPH_SUM_SCALAR,
  SPH_TILE_SUMS = SPH_SUM_SCALAR + SPH_SCALARS_MAX
};

/* What tiles add to. */
enum sph_tile_add {
  SPH_TILE_PUSH = 1,
  SPH_TILE_ALONG_R = 2,
  SPH_TILE_ALONG_V = 4,
  SPH_TILE_DRHO = 8,
  SPH_TILE_DU = 16,
  SPH_TILE_DS = 32,
  SPH_TILE_ALL = 63
};

typedef struct sph_tile_term {
  const sph_term *term;
  int scalar;                         /* its own, or -1 */
  unsigned char read[SPH_TILE_READS]; /* enum sph_tile_field of each field it reads */
  int reads;
} sph_tile_term;

typedef struct tile_constants {
  fluid_constants fluid; /* first: the built-in bodies read it */
  double F_scale;        /* sigma/h^(d+2): users see F in its unit */
  double t, h;           /* [s], [m] */
  const char *target, *source;
  int slots, scalars;
  int isothermal;  /* the source is a wall with a temperature of its own */
  unsigned fields; /* bit of each field that any of them reads */
  unsigned adds;   /* enum sph_tile_add that any of them adds to */
  int terms;
  sph_tile_term term[SPH_TILE_TERMS];
  /* Matrices of implicit stages: which unknown, enum tile_unknown. */
  int unknown, per_volume;
  double gamma;
} tile_constants;

enum tile_unknown { TILE_VELOCITY, TILE_TEMPERATURE, TILE_SCALAR };

/* The arrays of one tile, a row a source: on the stack of a thread, about 20 KiB of it in use. */
typedef struct tile_rows {
  vec r[3][SPH_TILE_ROWS], v[3][SPH_TILE_ROWS], r2[SPH_TILE_ROWS], rv[SPH_TILE_ROWS];
  vec v_viscous[3][SPH_TILE_ROWS], rv_viscous[SPH_TILE_ROWS]; /* at no-slip walls only */
  vec F[SPH_TILE_ROWS], V[SPH_TILE_ROWS], m[SPH_TILE_ROWS];
  vec push[SPH_TILE_ROWS], along_r[SPH_TILE_ROWS], along_v[SPH_TILE_ROWS];
  vec drho[SPH_TILE_ROWS], du[SPH_TILE_ROWS], ds[SPH_SCALARS_MAX][SPH_TILE_ROWS];
  vec i[SPH_TILE_FIELDS][SPH_TILE_ROWS], j[SPH_TILE_FIELDS][SPH_TILE_ROWS];
} tile_rows;

/* The fields of the targets: the same in all rows of a block. */
BODY void tile_targets(int dim, const tile_constants *k, const double *record, long stride,
                       tile_rows *rows)
{
  vec slot[SPH_PAIR_SLOTS];
  for (int s = 0; s < k->slots; s++) slot[s] = v_gather(record + s, stride);
  const particle i = fluid_particle(dim, k->fluid.terms, slot);
  const vec field[] = {[SPH_TILE_DENSITY] = i.rho,
                       [SPH_TILE_PRESSURE] = fluid_pressure(k->fluid.terms, &i),
                       [SPH_TILE_SOUND_SPEED] = i.c,
                       [SPH_TILE_ENERGY] = slot[slot_u(dim)],
                       [SPH_TILE_TEMPERATURE] = slot[slot_T(dim)]};
  for (int f = 0; f < SPH_TILE_FIELDS; f++) {
    if (!(k->fields >> f & 1)) continue;
    vec value = f < SPH_TILE_SCALAR ? field[f] : slot[slot_scalar(dim) + f - SPH_TILE_SCALAR];
    for (int n = 0; n < SPH_TILE_ROWS; n++) rows->i[f][n] = value;
  }
}

/* The fields of source j, in row n; a wall mirrors scalars, energy and, unless it has one of its
 * own, temperature. */
BODY void tile_source(int dim, unsigned terms, const tile_constants *k, const particle *j,
                      const double *record, tile_rows *rows, int n)
{
  if (k->fields & 1u << SPH_TILE_DENSITY) rows->j[SPH_TILE_DENSITY][n] = j->rho;
  if (k->fields & 1u << SPH_TILE_PRESSURE) rows->j[SPH_TILE_PRESSURE][n] = fluid_pressure(terms, j);
  if (k->fields & 1u << SPH_TILE_SOUND_SPEED) rows->j[SPH_TILE_SOUND_SPEED][n] = j->c;
  const int wall = (terms & SPH_WALL) != 0;
  if (k->fields & 1u << SPH_TILE_ENERGY)
    rows->j[SPH_TILE_ENERGY][n] = wall ? rows->i[SPH_TILE_ENERGY][n] : v_set(record[slot_u(dim)]);
  if (k->fields & 1u << SPH_TILE_TEMPERATURE)
    rows->j[SPH_TILE_TEMPERATURE][n] =
        wall && !k->isothermal ? rows->i[SPH_TILE_TEMPERATURE][n] : v_set(record[slot_T(dim)]);
  for (int s = 0; s < k->scalars; s++) {
    rows->ds[s][n] = v_set(0);
    if (k->fields >> (SPH_TILE_SCALAR + s) & 1)
      rows->j[SPH_TILE_SCALAR + s][n] =
          terms & SPH_WALL ? rows->i[SPH_TILE_SCALAR + s][n] : v_set(record[slot_scalar(dim) + s]);
  }
}

/* Row n: the pair p of i and j. */
BODY void tile_row(int dim, unsigned terms, const tile_constants *k, const pair *p,
                   const particle *i, const particle *j, const double *record, tile_rows *rows,
                   int n)
{
  for (int d = 0; d < dim; d++) {
    rows->r[d][n] = p->r[d];
    rows->v[d][n] = i->v[d] - j->v[d];
  }
  rows->r2[n] = p->r2;
  rows->rv[n] = p->rv;
  if (terms & SPH_NO_SLIP) {
    vec rv = v_set(0);
    for (int d = 0; d < dim; d++) {
      vec v = i->v[d] - j->extra[d];
      rows->v_viscous[d][n] = v;
      rv += p->r[d] * v;
    }
    rows->rv_viscous[n] = rv;
  }
  rows->F[n] = k->F_scale * p->F;
  rows->V[n] = j->V;
  rows->m[n] = j->V * j->rho;
  tile_source(dim, terms, k, j, record, rows, n);
}

/* The same, after the built-in terms have acted on the pair. */
BODY void tile_fill(int dim, int kernel, unsigned terms, const tile_constants *k, const vec *slot_i,
                    const vec *slot_j, const double *record, vec *sum, tile_rows *rows, int n)
{
  const particle i = fluid_particle(dim, terms, slot_i), j = fluid_particle(dim, terms, slot_j);
  pair p = fluid_pair_common(dim, kernel, terms, &k->fluid, &i, &j);
  fluid_terms(dim, kernel, terms, &p, &k->fluid, &i, &j, sum);
  fluid_pair_forces(dim, terms, &p, sum);
  tile_row(dim, terms, k, &p, &i, &j, record, rows, n);
}

/* Nothing is added yet. */
BODY void tile_clear(unsigned adds, tile_rows *rows, int n)
{
  size_t bytes = (size_t)n * sizeof(vec);
  if (adds & SPH_TILE_PUSH) memset(rows->push, 0, bytes);
  if (adds & SPH_TILE_ALONG_R) memset(rows->along_r, 0, bytes);
  if (adds & SPH_TILE_ALONG_V) memset(rows->along_v, 0, bytes);
  if (adds & SPH_TILE_DRHO) memset(rows->drho, 0, bytes);
  if (adds & SPH_TILE_DU) memset(rows->du, 0, bytes);
}

/* What users see of rows 0 .. n - 1. */
BODY sph_tile tile_open(int dim, const tile_constants *k, tile_rows *rows, int n)
{
  const int no_slip = (k->fluid.terms & SPH_NO_SLIP) != 0;
  sph_tile tile = {.dim = dim,
                   .wall = (k->fluid.terms & SPH_WALL) != 0,
                   .n = (long)n * SPH_LANES,
                   .t = k->t,
                   .h = k->h,
                   .target = k->target,
                   .source = k->source,
                   .r2 = (const double *)rows->r2,
                   .rv = (const double *)rows->rv,
                   .rv_viscous = (const double *)(no_slip ? rows->rv_viscous : rows->rv),
                   .F = (const double *)rows->F,
                   .V = (const double *)rows->V,
                   .m = (const double *)rows->m,
                   .push = k->adds & SPH_TILE_PUSH ? (double *)rows->push : NULL,
                   .along_r = k->adds & SPH_TILE_ALONG_R ? (double *)rows->along_r : NULL,
                   .along_v = k->adds & SPH_TILE_ALONG_V ? (double *)rows->along_v : NULL,
                   .drho = k->adds & SPH_TILE_DRHO ? (double *)rows->drho : NULL,
                   .du = k->adds & SPH_TILE_DU ? (double *)rows->du : NULL};
  for (int d = 0; d < dim; d++) {
    tile.r[d] = (const double *)rows->r[d];
    tile.v[d] = (const double *)rows->v[d];
    tile.v_viscous[d] = no_slip ? (const double *)rows->v_viscous[d] : tile.v[d];
  }
  return tile;
}

/* The fields that one term reads, and its scalar. */
BODY void tile_fields(const sph_tile_term *one, tile_rows *rows, sph_tile *tile)
{
  for (int f = 0; f < one->reads; f++) {
    tile->i[f] = (const double *)rows->i[one->read[f]];
    tile->j[f] = (const double *)rows->j[one->read[f]];
  }
  int s = one->scalar;
  tile->s_i = s < 0 ? NULL : (const double *)rows->i[SPH_TILE_SCALAR + s];
  tile->s_j = s < 0 ? NULL : (const double *)rows->j[SPH_TILE_SCALAR + s];
  tile->ds = s < 0 ? NULL : (double *)rows->ds[s];
}

/* Sum of a[q] b[q]: in a register, not in memory that rows might lie in. */
BODY vec tile_product(const vec *a, const vec *b, int n)
{
  vec total = v_set(0);
  for (int q = 0; q < n; q++) total += a[q] * b[q];
  return total;
}

/* Forces along r, from rows that hold them; dissipative ones, with rv, heat. */
BODY void tile_take_along(int dim, const tile_rows *rows, const vec *along, const vec *rv, int n,
                          vec *sum)
{
  for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] += tile_product(along, rows->r[d], n);
  if (rv) sum[SPH_SUM_HEAT] -= 0.5 * tile_product(along, rv, n);
}

BODY void tile_take_drag(int dim, const tile_rows *rows, const vec (*v)[SPH_TILE_ROWS], int heats,
                         int n, vec *sum)
{
  vec work = v_set(0);
  for (int d = 0; d < dim; d++) {
    sum[SPH_SUM_A + d] += tile_product(rows->along_v, v[d], n);
    for (int q = 0; heats && q < n; q++) work += rows->along_v[q] * v[d][q] * v[d][q];
  }
  sum[SPH_SUM_HEAT] -= 0.5 * work;
}

BODY vec tile_total(const vec *row, int n)
{
  vec total = v_set(0);
  for (int q = 0; q < n; q++) total += row[q];
  return total;
}

/* The registered terms, each on rows 0 .. n - 1; what they added: to the fluid sums `taken`, to
 * density and scalars `more`.  Not inlined: once for all kernels and places. */
static __attribute__((noinline, unused)) void
tile_call(int dim, const tile_constants *k, tile_rows *rows, int n, vec *taken, vec *more)
{
  const int no_slip = (k->fluid.terms & SPH_NO_SLIP) != 0;
  const int heats = (k->fluid.terms & SPH_THERMAL) != 0;
  const vec unit = v_set(1 / k->F_scale), *rv = no_slip ? rows->rv_viscous : rows->rv;
  sph_tile tile = tile_open(dim, k, rows, n);
  tile_clear(k->adds, rows, n);
  for (int q = 0; q < k->terms; q++) {
    tile_fields(&k->term[q], rows, &tile);
    k->term[q].term->pair(k->term[q].term, &tile);
  }
  for (int s = 0; s < SPH_SUM_DRIFT; s++) taken[s] = v_set(0);
  if (k->adds & SPH_TILE_PUSH) tile_take_along(dim, rows, rows->push, NULL, n, taken);
  if (k->adds & SPH_TILE_ALONG_R)
    tile_take_along(dim, rows, rows->along_r, heats ? rv : NULL, n, taken);
  if (k->adds & SPH_TILE_ALONG_V)
    tile_take_drag(dim, rows, no_slip ? rows->v_viscous : rows->v, heats, n, taken);
  if (k->adds & SPH_TILE_DU) taken[SPH_SUM_HEAT] += tile_total(rows->du, n);
  if (k->adds & SPH_TILE_DRHO) more[0] += unit * tile_total(rows->drho, n);
  for (int s = 0; s < k->scalars; s++) more[1 + s] += unit * tile_total(rows->ds[s], n);
}

/* Calls them, and sums what they added, in the unit of the fluid sums. */
BODY void tile_take(int dim, const tile_constants *k, tile_rows *rows, int n, vec *sum, vec *more)
{
  const vec unit = v_set(1 / k->F_scale);
  vec taken[SPH_SUM_DRIFT];
  tile_call(dim, k, rows, n, taken, more);
  for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] += unit * taken[SPH_SUM_A + d];
  sum[SPH_SUM_HEAT] += unit * taken[SPH_SUM_HEAT];
}

/* All pairs of one block; rows go on over the ends of runs. */
BODY void tile_block(int dim, int kernel, unsigned terms, const sph_pair_task *t, long b, vec *sum,
                     vec *more, tile_rows *rows)
{
  const tile_constants *k = t->constants;
  const int slots = slot_scalar(dim);
  const double *record = t->target + b * SPH_LANES * t->target_stride;
  vec home[SPH_PAIR_SLOTS];
  int n = 0;
#pragma GCC unroll 26
  for (int s = 0; s < slots; s++) home[s] = v_gather(record + s, t->target_stride);
  tile_targets(dim, k, record, t->target_stride, rows);
  for (long r = t->first[b]; r < t->first[b + 1]; r++) {
    const sph_run run = t->runs[r];
    vec i[SPH_PAIR_SLOTS], j[SPH_PAIR_SLOTS];
#pragma GCC unroll 26
    for (int s = 0; s < slots; s++) i[s] = s < dim ? home[s] - t->shift[run.image][s] : home[s];
    const double *source = t->source + (long)run.start * t->source_stride;
    pair_prefetch(source + (long)run.count * t->source_stride, slots);
    for (int q = 0; q < (int)run.count; q++, source += t->source_stride) {
#pragma GCC unroll 26
      for (int s = 0; s < slots; s++) j[s] = v_set(source[s]);
      tile_fill(dim, kernel, terms, k, i, j, source, sum, rows, n++);
      if (n < SPH_TILE_ROWS) continue;
      tile_take(dim, k, rows, n, sum, more);
      n = 0;
    }
  }
  if (n > 0) tile_take(dim, k, rows, n, sum, more);
}

BODY void tile_blocks(int dim, int kernel, unsigned terms, int rare, const sph_pair_task *t,
                      long begin, long end)
{
  const tile_constants *k = t->constants;
  const int sums = rare ? SPH_FLUID_SUMS_ALL : SPH_FLUID_SUMS; /* those of the built-in terms */
  tile_rows rows;
  for (long b = begin; b < end; b++) {
    if (t->first[b] == t->first[b + 1]) continue;
    vec sum[SPH_FLUID_SUMS_ALL], more[1 + SPH_SCALARS_MAX];
#pragma GCC unroll 9
    for (int s = 0; s < sums; s++) sum[s] = v_load(t->sum[s] + b * SPH_LANES);
    for (int s = 0; s <= k->scalars; s++)
      more[s] = v_load(t->sum[SPH_SUM_DENSITY + s] + b * SPH_LANES);
    tile_block(dim, kernel, terms, t, b, sum, more, &rows);
#pragma GCC unroll 9
    for (int s = 0; s < sums; s++) v_store(t->sum[s] + b * SPH_LANES, sum[s]);
    for (int s = 0; s <= k->scalars; s++)
      v_store(t->sum[SPH_SUM_DENSITY + s] + b * SPH_LANES, more[s]);
  }
}

#endif
