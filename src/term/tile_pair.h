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
  unsigned fields; /* bit of each field that any of them reads */
  int terms;
  sph_tile_term term[SPH_TILE_TERMS];
} tile_constants;

/* The arrays of one tile, a row a source: on the stack of a thread, about 20 KiB of it in use. */
typedef struct tile_rows {
  vec r[3][SPH_TILE_ROWS], v[3][SPH_TILE_ROWS], r2[SPH_TILE_ROWS], rv[SPH_TILE_ROWS];
  vec v_viscous[3][SPH_TILE_ROWS], rv_viscous[SPH_TILE_ROWS]; /* at no-slip walls only */
  vec F[SPH_TILE_ROWS], V[SPH_TILE_ROWS], m[SPH_TILE_ROWS];
  vec push[SPH_TILE_ROWS], along_r[SPH_TILE_ROWS], along_v[SPH_TILE_ROWS];
  vec drho[SPH_TILE_ROWS], du[SPH_TILE_ROWS], ds[SPH_SCALARS_MAX][SPH_TILE_ROWS];
  vec i[SPH_TILE_FIELDS][SPH_TILE_ROWS], j[SPH_TILE_FIELDS][SPH_TILE_ROWS];
} tile_rows;

BODY vec tile_field(int dim, unsigned terms, const vec *slot, const particle *a, int field)
{
  switch (field) {
  case SPH_TILE_DENSITY: return a->rho;
  case SPH_TILE_PRESSURE: return fluid_pressure(terms, a);
  case SPH_TILE_SOUND_SPEED: return a->c;
  case SPH_TILE_ENERGY: return a->u;
  case SPH_TILE_TEMPERATURE: return a->T;
  default: return slot[slot_scalar(dim) + field - SPH_TILE_SCALAR];
  }
}

/* The fields of the targets: the same in all rows of a block. */
BODY void tile_targets(int dim, const tile_constants *k, const vec *slot_i, tile_rows *rows)
{
  const particle i = fluid_particle(dim, k->fluid.terms, slot_i);
  for (int f = 0; f < SPH_TILE_FIELDS; f++)
    for (int n = 0; (k->fields >> f & 1) && n < SPH_TILE_ROWS; n++)
      rows->i[f][n] = tile_field(dim, k->fluid.terms, slot_i, &i, f);
}

/* Row n: the pair (i, j), after the built-in terms have acted on it. */
BODY void tile_fill(int dim, int kernel, const tile_constants *k, const vec *slot_i,
                    const vec *slot_j, vec *sum, tile_rows *rows, int n)
{
  const unsigned terms = k->fluid.terms;
  const particle i = fluid_particle(dim, terms, slot_i), j = fluid_particle(dim, terms, slot_j);
  pair p = fluid_pair_common(dim, kernel, terms, &k->fluid, &i, &j);
  fluid_terms(dim, kernel, terms, &p, &k->fluid, &i, &j, sum);
  fluid_pair_forces(dim, terms, &p, sum);
  for (int d = 0; d < dim; d++) {
    rows->r[d][n] = p.r[d];
    rows->v[d][n] = i.v[d] - j.v[d];
  }
  rows->r2[n] = p.r2;
  rows->rv[n] = p.rv;
  if (terms & SPH_NO_SLIP) {
    rows->rv_viscous[n] = v_set(0);
    for (int d = 0; d < dim; d++) {
      rows->v_viscous[d][n] = i.v[d] - j.extra[d];
      rows->rv_viscous[n] += p.r[d] * rows->v_viscous[d][n];
    }
  }
  rows->F[n] = k->F_scale * p.F;
  rows->V[n] = j.V;
  rows->m[n] = j.V * j.rho;
  rows->push[n] = rows->along_r[n] = rows->along_v[n] = rows->drho[n] = rows->du[n] = v_set(0);
  for (int s = 0; s < k->scalars; s++) rows->ds[s][n] = v_set(0);
  for (int f = 0; f < SPH_TILE_FIELDS; f++) {
    if (!(k->fields >> f & 1)) continue;
    int mirrored = f >= SPH_TILE_SCALAR && (terms & SPH_WALL);
    rows->j[f][n] = mirrored ? rows->i[f][n] : tile_field(dim, terms, slot_j, &j, f);
  }
}

/* The registered terms, each on rows 0 .. n - 1. */
static __attribute__((noinline, unused)) void tile_call(int dim, const tile_constants *k,
                                                        tile_rows *rows, int n)
{
  sph_tile tile = {.dim = dim,
                   .wall = (k->fluid.terms & SPH_WALL) != 0,
                   .n = (long)n * SPH_LANES,
                   .t = k->t,
                   .h = k->h,
                   .target = k->target,
                   .source = k->source,
                   .r2 = (const double *)rows->r2,
                   .rv = (const double *)rows->rv,
                   .F = (const double *)rows->F,
                   .V = (const double *)rows->V,
                   .m = (const double *)rows->m,
                   .push = (double *)rows->push,
                   .along_r = (double *)rows->along_r,
                   .along_v = (double *)rows->along_v,
                   .drho = (double *)rows->drho,
                   .du = (double *)rows->du};
  const int no_slip = (k->fluid.terms & SPH_NO_SLIP) != 0;
  tile.rv_viscous = no_slip ? (const double *)rows->rv_viscous : tile.rv;
  for (int d = 0; d < dim; d++) {
    tile.r[d] = (const double *)rows->r[d];
    tile.v[d] = (const double *)rows->v[d];
    tile.v_viscous[d] = no_slip ? (const double *)rows->v_viscous[d] : tile.v[d];
  }
  for (int q = 0; q < k->terms; q++) {
    const sph_tile_term *one = &k->term[q];
    for (int f = 0; f < one->reads; f++) {
      tile.i[f] = (const double *)rows->i[one->read[f]];
      tile.j[f] = (const double *)rows->j[one->read[f]];
    }
    int s = one->scalar;
    tile.s_i = s < 0 ? NULL : (const double *)rows->i[SPH_TILE_SCALAR + s];
    tile.s_j = s < 0 ? NULL : (const double *)rows->j[SPH_TILE_SCALAR + s];
    tile.ds = s < 0 ? NULL : (double *)rows->ds[s];
    one->term->pair(one->term, &tile);
  }
}

/* Sums what they added, in the unit of the fluid sums. */
BODY void tile_take(int dim, const tile_constants *k, const tile_rows *rows, int n, vec *sum)
{
  const vec unit = v_set(1 / k->F_scale);
  const int no_slip = (k->fluid.terms & SPH_NO_SLIP) != 0;
  const vec(*v)[SPH_TILE_ROWS] = no_slip ? rows->v_viscous : rows->v;
  const vec *rv = no_slip ? rows->rv_viscous : rows->rv;
  for (int q = 0; q < n; q++) {
    vec force = unit * (rows->push[q] + rows->along_r[q]), drag = unit * rows->along_v[q];
    vec v2 = v_set(0);
    for (int d = 0; d < dim; d++) {
      sum[SPH_SUM_A + d] += force * rows->r[d][q] + drag * v[d][q];
      v2 += v[d][q] * v[d][q];
    }
    vec work = unit * rows->along_r[q] * rv[q] + drag * v2;
    sum[SPH_SUM_HEAT] += unit * rows->du[q] - 0.5 * work;
    sum[SPH_SUM_DENSITY] += unit * rows->drho[q];
    for (int s = 0; s < k->scalars; s++) sum[SPH_SUM_SCALAR + s] += unit * rows->ds[s][q];
  }
}

/* All pairs of one block; rows go on over the ends of runs. */
BODY void tile_block(int dim, int kernel, const sph_pair_task *t, long b, const vec *home, vec *sum,
                     tile_rows *rows)
{
  const tile_constants *k = t->constants;
  int n = 0;
  tile_targets(dim, k, home, rows);
  for (long r = t->first[b]; r < t->first[b + 1]; r++) {
    const sph_run run = t->runs[r];
    vec i[SPH_PAIR_SLOTS], j[SPH_PAIR_SLOTS];
    for (int s = 0; s < k->slots; s++) i[s] = s < dim ? home[s] - t->shift[run.image][s] : home[s];
    const double *source = t->source + (long)run.start * t->source_stride;
    for (int q = 0; q < (int)run.count; q++, source += t->source_stride) {
      for (int s = 0; s < k->slots; s++) j[s] = v_set(source[s]);
      tile_fill(dim, kernel, k, i, j, sum, rows, n++);
      if (n < SPH_TILE_ROWS) continue;
      tile_call(dim, k, rows, n);
      tile_take(dim, k, rows, n, sum);
      n = 0;
    }
  }
  if (n > 0) tile_call(dim, k, rows, n);
  tile_take(dim, k, rows, n, sum);
}

BODY void tile_loop(int dim, int kernel, const sph_pair_task *t, long begin, long end)
{
  const tile_constants *k = t->constants;
  const int sums = SPH_SUM_SCALAR + k->scalars;
  tile_rows rows;
  for (long b = begin; b < end; b++) {
    if (t->first[b] == t->first[b + 1]) continue;
    vec home[SPH_PAIR_SLOTS], sum[SPH_TILE_SUMS];
    const double *record = t->target + b * SPH_LANES * t->target_stride;
    for (int s = 0; s < k->slots; s++) home[s] = v_gather(record + s, t->target_stride);
    for (int s = 0; s < sums; s++) sum[s] = v_load(t->sum[s] + b * SPH_LANES);
    tile_block(dim, kernel, t, b, home, sum, &rows);
    for (int s = 0; s < sums; s++) v_store(t->sum[s] + b * SPH_LANES, sum[s]);
  }
}

#endif
