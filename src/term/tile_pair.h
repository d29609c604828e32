/* tile_pair.h -- pair terms that are registered at run time, tile by tile (sph_tile).
 *
 * A tile is a block of targets times up to SPH_TILE_ROWS sources.  The loop over pairs in which
 * built-in terms act keeps r2, rv and F of each; once the tile is full, what else the terms read is
 * filled in, each term adds to it, and its rows are summed, and heated, as built-in terms are. */
#ifndef SPH_TILE_PAIR_H
#define SPH_TILE_PAIR_H
#include "fluid_terms.h"
#include "sphode/term.h"

enum { SPH_TILE_ROWS = 16, SPH_TILE_TERMS = 32, SPH_TILE_SLOTS = 14 };

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

/* What a tile shows of a pair. */
enum sph_tile_show {
  SPH_TILE_R = 1,
  SPH_TILE_V = 2,
  SPH_TILE_R2 = 4,
  SPH_TILE_RV = 8,
  SPH_TILE_V_VISCOUS = 16,
  SPH_TILE_RV_VISCOUS = 32,
  SPH_TILE_F = 64,
  SPH_TILE_VOLUME = 128,
  SPH_TILE_MASS = 256,
  SPH_TILE_PAIR = 511
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
  int scalars;
  int isothermal;  /* the source is a wall with a temperature of its own */
  unsigned fused;  /* built-in terms that act in the same loop; none of SPH_RARE */
  unsigned fields; /* bit of each field that any of them reads */
  unsigned adds;   /* enum sph_tile_add that any of them adds to */
  unsigned show;   /* enum sph_tile_show that any of them reads, or that summing does */
  int terms;
  sph_tile_term term[SPH_TILE_TERMS];
  /* Matrices of implicit stages: which unknown, enum tile_unknown. */
  int unknown, per_volume;
  double gamma;
} tile_constants;

enum tile_unknown { TILE_VELOCITY, TILE_TEMPERATURE, TILE_SCALAR };

/* The arrays of one tile, a row a source: on the stack of a thread, about 20 KiB of it in use. */
typedef struct tile_rows {
  const double *source[SPH_TILE_ROWS]; /* records */
  vec r[3][SPH_TILE_ROWS], v[3][SPH_TILE_ROWS], r2[SPH_TILE_ROWS], rv[SPH_TILE_ROWS];
  vec v_viscous[3][SPH_TILE_ROWS], rv_viscous[SPH_TILE_ROWS]; /* at no-slip walls only */
  vec F[SPH_TILE_ROWS], V[SPH_TILE_ROWS], m[SPH_TILE_ROWS];
  vec push[SPH_TILE_ROWS], along_r[SPH_TILE_ROWS], along_v[SPH_TILE_ROWS];
  vec drho[SPH_TILE_ROWS], du[SPH_TILE_ROWS], ds[SPH_SCALARS_MAX][SPH_TILE_ROWS];
  vec i[SPH_TILE_FIELDS][SPH_TILE_ROWS], j[SPH_TILE_FIELDS][SPH_TILE_ROWS];
} tile_rows;

/* Slots of a record that built-in terms may read in this loop. */
BODY int tile_slots(int dim) { return slot_u(dim) + 1; }

BODY int tile_slot(int dim, int field)
{
  switch (field) {
  case SPH_TILE_DENSITY: return slot_rho(dim);
  case SPH_TILE_PRESSURE: return slot_p(dim);
  case SPH_TILE_SOUND_SPEED: return slot_c(dim);
  case SPH_TILE_ENERGY: return slot_u(dim);
  case SPH_TILE_TEMPERATURE: return slot_T(dim);
  default: return slot_scalar(dim) + field - SPH_TILE_SCALAR;
  }
}

/* The pressure, whatever the row keeps in its slot. */
BODY double tile_pressure(int dim, unsigned terms, const double *record)
{
  if (terms & SPH_FORM_C2) return record[slot_p(dim)];
  double p = record[slot_p(dim)] * record[slot_rho(dim)] * record[slot_rho(dim)];
  return terms & SPH_FORM_PHI ? p / record[slot_phi(dim)] : p;
}

BODY double tile_field(int dim, unsigned terms, int field, const double *record)
{
  return field == SPH_TILE_PRESSURE ? tile_pressure(dim, terms, record)
                                    : record[tile_slot(dim, field)];
}

/* The fields of the targets: the same in all rows of a block. */
BODY void tile_targets(int dim, const tile_constants *k, const double *record, long stride,
                       tile_rows *rows)
{
  for (int f = 0; f < SPH_TILE_FIELDS; f++) {
    if (!(k->fields >> f & 1)) continue;
    vec value = v_set(0);
    for (int l = 0; l < SPH_LANES; l++)
      value[l] = tile_field(dim, k->fluid.terms, f, record + l * stride);
    for (int n = 0; n < SPH_TILE_ROWS; n++) rows->i[f][n] = value;
  }
}

/* The fields of the sources; a wall mirrors scalars, energy and, unless it has one of its own,
 * temperature. */
BODY void tile_sources(int dim, const tile_constants *k, tile_rows *rows, int n)
{
  const unsigned terms = k->fluid.terms;
  for (int f = 0; f < SPH_TILE_FIELDS; f++) {
    if (!(k->fields >> f & 1)) continue;
    const int slot = tile_slot(dim, f), mirrored = f >= SPH_TILE_ENERGY && (terms & SPH_WALL) &&
                                                   !(f == SPH_TILE_TEMPERATURE && k->isothermal);
    if (mirrored)
      for (int q = 0; q < n; q++) rows->j[f][q] = rows->i[f][q];
    else if (f == SPH_TILE_PRESSURE)
      for (int q = 0; q < n; q++) rows->j[f][q] = v_set(tile_pressure(dim, terms, rows->source[q]));
    else
      for (int q = 0; q < n; q++) rows->j[f][q] = v_set(rows->source[q][slot]);
  }
}

/* v_i - v_j, and r.v, with the velocity that sources have in these slots. */
BODY void tile_v(int dim, const vec *v_i, int slot, int n, const tile_rows *rows,
                 vec (*v)[SPH_TILE_ROWS])
{
  for (int q = 0; q < n; q++)
    for (int d = 0; d < dim; d++) v[d][q] = v_i[d] - rows->source[q][slot + d];
}

BODY void tile_rv(int dim, const vec *v_i, int slot, int n, const tile_rows *rows, vec *rv)
{
  for (int q = 0; q < n; q++) {
    const double *v_j = rows->source[q] + slot;
    vec dot = v_set(0);
    for (int d = 0; d < dim; d++) dot += rows->r[d][q] * (v_i[d] - v_j[d]);
    rv[q] = dot;
  }
}

/* What is read of rows 0 .. n - 1 besides r, r2, rv and F, one after another: short loops. */
BODY void tile_fill(int dim, const tile_constants *k, const vec *v, tile_rows *rows, int n)
{
  const unsigned show = k->show;
  if (show & SPH_TILE_VOLUME)
    for (int q = 0; q < n; q++) rows->V[q] = v_set(rows->source[q][slot_V(dim)]);
  if (show & SPH_TILE_MASS)
    for (int q = 0; q < n; q++)
      rows->m[q] = v_set(rows->source[q][slot_V(dim)] * rows->source[q][slot_rho(dim)]);
  if (show & SPH_TILE_V) tile_v(dim, v, slot_v(dim), n, rows, rows->v);
  if (k->fluid.terms & SPH_NO_SLIP) {
    tile_v(dim, v, slot_extra(dim), n, rows, rows->v_viscous);
    tile_rv(dim, v, slot_extra(dim), n, rows, rows->rv_viscous);
  }
  tile_sources(dim, k, rows, n);
}

/* rv and F, in the unit of users, where no loop over pairs has made them. */
BODY void tile_fill_pair(int dim, const tile_constants *k, const vec *v, tile_rows *rows, int n)
{
  const double inverse_h = k->fluid.inverse_h, scale = k->F_scale;
  for (int q = 0; k->show & SPH_TILE_F && q < n; q++)
    rows->F[q] = scale * kernel_shape_f_at(k->fluid.kernel, dim, v_sqrt(rows->r2[q]), inverse_h);
  if (k->show & SPH_TILE_RV) tile_rv(dim, v, slot_v(dim), n, rows, rows->rv);
}

/* Row n: targets at x, and source j. */
BODY void tile_row(int dim, const vec *x, const double *j, tile_rows *rows, int n)
{
  vec r2 = v_set(0);
  rows->source[n] = j;
  for (int d = 0; d < dim; d++) {
    const vec r = x[d] - j[d];
    rows->r[d][n] = r;
    r2 += r * r;
  }
  rows->r2[n] = r2;
}

/* Nothing is added yet; later what is summed is cleared. */
BODY void tile_clear(tile_rows *rows)
{
  memset(rows->push, 0, sizeof rows->push);
  memset(rows->along_r, 0, sizeof rows->along_r);
  memset(rows->along_v, 0, sizeof rows->along_v);
  memset(rows->drho, 0, sizeof rows->drho);
  memset(rows->du, 0, sizeof rows->du);
  memset(rows->ds, 0, sizeof rows->ds);
}

BODY const double *tile_shown(unsigned shown, const vec *rows)
{
  return shown ? (const double *)rows : NULL;
}

BODY double *tile_added(unsigned added, vec *rows) { return added ? (double *)rows : NULL; }

/* What users see of the rows. */
BODY sph_tile tile_open(int dim, const tile_constants *k, tile_rows *rows)
{
  const int no_slip = (k->fluid.terms & SPH_NO_SLIP) != 0;
  const unsigned show = k->show, adds = k->adds;
  sph_tile tile = {.dim = dim,
                   .wall = (k->fluid.terms & SPH_WALL) != 0,
                   .t = k->t,
                   .h = k->h,
                   .target = k->target,
                   .source = k->source,
                   .r2 = tile_shown(show & SPH_TILE_R2, rows->r2),
                   .rv = tile_shown(show & SPH_TILE_RV, rows->rv),
                   .rv_viscous = tile_shown(show & SPH_TILE_RV_VISCOUS,
                                            no_slip ? rows->rv_viscous : rows->rv),
                   .F = tile_shown(show & SPH_TILE_F, rows->F),
                   .V = tile_shown(show & SPH_TILE_VOLUME, rows->V),
                   .m = tile_shown(show & SPH_TILE_MASS, rows->m),
                   .push = tile_added(adds & SPH_TILE_PUSH, rows->push),
                   .along_r = tile_added(adds & SPH_TILE_ALONG_R, rows->along_r),
                   .along_v = tile_added(adds & SPH_TILE_ALONG_V, rows->along_v),
                   .drho = tile_added(adds & SPH_TILE_DRHO, rows->drho),
                   .du = tile_added(adds & SPH_TILE_DU, rows->du)};
  for (int d = 0; d < dim; d++) {
    tile.r[d] = tile_shown(show & SPH_TILE_R, rows->r[d]);
    tile.v[d] = tile_shown(show & SPH_TILE_V, rows->v[d]);
    tile.v_viscous[d] =
        tile_shown(show & SPH_TILE_V_VISCOUS, no_slip ? rows->v_viscous[d] : rows->v[d]);
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

/* One tile after another: its rows, what users see of them, and the sums of a block. */
typedef struct tile_work {
  vec i[SPH_TILE_SLOTS], v[3];   /* records of the targets; velocities */
  vec taken[SPH_SUM_DRIFT];      /* of one tile */
  vec more[1 + SPH_SCALARS_MAX]; /* density and scalars, of a block */
  const double (*shift)[3];
  sph_tile tile;
  int image[SPH_TILE_ROWS];
  tile_rows rows;
} tile_work;

static __attribute__((noinline, unused)) void tile_begin(int dim, const sph_pair_task *t,
                                                         tile_work *w)
{
  w->tile = tile_open(dim, t->constants, &w->rows);
  w->shift = t->shift;
  tile_clear(&w->rows);
}

static __attribute__((noinline, unused)) void tile_begin_block(int dim, const sph_pair_task *t,
                                                               long b, tile_work *w)
{
  const tile_constants *k = t->constants;
  const double *record = t->target + b * SPH_LANES * t->target_stride;
  for (int s = 0; s < tile_slots(dim); s++) w->i[s] = v_gather(record + s, t->target_stride);
  for (int d = 0; d < dim; d++) w->v[d] = w->i[slot_v(dim) + d];
  for (int s = 0; s <= k->scalars; s++)
    w->more[s] = v_load(t->sum[SPH_SUM_DENSITY + s] + b * SPH_LANES);
  tile_targets(dim, k, record, t->target_stride, &w->rows);
}

/* r of rows 0 .. n - 1. */
BODY void tile_r(int dim, tile_work *w, int n)
{
  for (int q = 0; q < n; q++)
    for (int d = 0; d < dim; d++)
      w->rows.r[d][q] = w->i[d] - w->shift[w->image[q]][d] - w->rows.source[q][d];
}

/* Forces of one row, whose r and v are made again: cheaper than to keep them.  Dissipative ones
 * heat with half of their work. */
BODY void tile_force(int dim, unsigned adds, int heats, tile_rows *rows, int q, const vec *x,
                     const vec *v_i, int slot, vec *a, vec *heat)
{
  const double *j = rows->source[q], *v_j = j + slot;
  vec along_r = v_set(0), push = v_set(0), work = v_set(0);
  if (adds & SPH_TILE_ALONG_R) along_r = rows->along_r[q], rows->along_r[q] = v_set(0);
  if (adds & SPH_TILE_PUSH) push = rows->push[q], rows->push[q] = v_set(0);
  for (int d = 0; d < dim; d++) a[d] += (push + along_r) * (x[d] - j[d]);
  if (heats)
    for (int d = 0; d < dim; d++) work += along_r * (x[d] - j[d]) * (v_i[d] - v_j[d]);
  if (adds & SPH_TILE_ALONG_V) {
    const vec along_v = rows->along_v[q];
    rows->along_v[q] = v_set(0);
    for (int d = 0; d < dim; d++) {
      const vec v = v_i[d] - v_j[d];
      a[d] += along_v * v;
      work += along_v * v * v;
    }
  }
  if (heats) *heat -= 0.5 * work;
}

BODY vec tile_total(vec *row, int n)
{
  vec total = v_set(0);
  for (int q = 0; q < n; q++) {
    total += row[q];
    row[q] = v_set(0);
  }
  return total;
}

/* What the terms added to rows 0 .. n - 1, in the unit of the fluid sums. */
BODY void tile_sum(int dim, const tile_constants *k, tile_work *w, int n)
{
  const unsigned adds = k->adds, forces = SPH_TILE_PUSH | SPH_TILE_ALONG_R | SPH_TILE_ALONG_V;
  const int heats = (k->fluid.terms & SPH_THERMAL) != 0, scalars = k->scalars;
  const int slot = k->fluid.terms & SPH_NO_SLIP ? slot_extra(dim) : slot_v(dim);
  const vec unit = v_set(1 / k->F_scale), zero = v_set(0), v[3] = {w->v[0], w->v[1], w->v[2]};
  vec a[3] = {zero, zero, zero}, x[3] = {zero, zero, zero}, heat = zero;
  for (int q = 0, image = -1; adds & forces && q < n; q++) {
    if (image != w->image[q]) {
      image = w->image[q];
      for (int d = 0; d < dim; d++) x[d] = w->i[d] - w->shift[image][d];
    }
    tile_force(dim, adds, heats, &w->rows, q, x, v, slot, a, &heat);
  }
  if (adds & SPH_TILE_DU) heat += tile_total(w->rows.du, n);
  if (adds & SPH_TILE_DRHO) w->more[0] += unit * tile_total(w->rows.drho, n);
  for (int s = 0; s < scalars; s++) w->more[1 + s] += unit * tile_total(w->rows.ds[s], n);
  for (int d = 0; d < dim; d++) w->taken[SPH_SUM_A + d] = unit * a[d];
  w->taken[SPH_SUM_HEAT] = unit * heat;
}

/* The registered terms on rows 0 .. n - 1, one after another, and their sums. */
typedef void tile_taker(const tile_constants *k, tile_work *w, int n);

BODY void tile_take(int dim, const tile_constants *k, tile_work *w, int n)
{
  if (k->show & SPH_TILE_R || k->fluid.terms & SPH_NO_SLIP) tile_r(dim, w, n);
  tile_fill(dim, k, w->v, &w->rows, n);
  w->tile.n = (long)n * SPH_LANES;
  for (int q = 0; q < k->terms; q++) {
    tile_fields(&k->term[q], &w->rows, &w->tile);
    k->term[q].term->pair(k->term[q].term, &w->tile);
  }
  tile_sum(dim, k, w, n);
}

/* Row n: built-in terms act, and what they made of the pair is kept. */
BODY void tile_pair(int dim, int kernel, unsigned fused, double F_scale, const fluid_constants *k,
                    const vec *i, const double *source, tile_rows *rows, int n, vec *sum)
{
  vec j[SPH_TILE_SLOTS];
#pragma GCC unroll 14
  for (int s = 0; s < tile_slots(dim); s++) j[s] = v_set(source[s]);
  const pair p = fluid_pair(dim, kernel, fused, k, i, j, sum);
  rows->source[n] = source;
  rows->r2[n] = p.r2;
  rows->rv[n] = p.rv;
  rows->F[n] = F_scale * p.F;
}

/* All pairs of one block; rows go on over the ends of runs. */
BODY void tile_block(int dim, int kernel, unsigned fused, tile_taker *take, const sph_pair_task *t,
                     long b, tile_work *w)
{
  const tile_constants *k = t->constants;
  const fluid_constants fluid = k->fluid; /* a copy, which no store to rows can change */
  const double F_scale = k->F_scale;
  const long last = t->first[b + 1] - 1;
  vec i[SPH_TILE_SLOTS], sum[SPH_SUM_DRIFT];
  int n = 0;
  tile_begin_block(dim, t, b, w);
#pragma GCC unroll 14
  for (int s = 0; s < tile_slots(dim); s++) i[s] = w->i[s];
#pragma GCC unroll 6
  for (int s = 0; s < SPH_SUM_DRIFT; s++) sum[s] = v_load(t->sum[s] + b * SPH_LANES);
  for (long r = t->first[b]; r <= last; r++) {
    const sph_run run = t->runs[r];
    const int image = sph_run_image(run);
    const double *source = t->source + sph_run_start(run) * t->source_stride;
    const double *const end_of_run = source + sph_run_count(run) * t->source_stride;
    for (int d = 0; d < dim; d++) i[d] = w->i[d] - t->shift[image][d];
    pair_prefetch(end_of_run, slot_extra(dim));
    do {
      do {
        w->image[n] = image;
        tile_pair(dim, kernel, fused, F_scale, &fluid, i, source, &w->rows, n++, sum);
        source += t->source_stride;
      } while (source != end_of_run && n < SPH_TILE_ROWS);
      if (n < SPH_TILE_ROWS && r < last) break;
      take(k, w, n);
      n = 0;
      for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] += w->taken[SPH_SUM_A + d];
      sum[SPH_SUM_HEAT] += w->taken[SPH_SUM_HEAT];
    } while (source != end_of_run);
  }
#pragma GCC unroll 6
  for (int s = 0; s < SPH_SUM_DRIFT; s++) v_store(t->sum[s] + b * SPH_LANES, sum[s]);
  for (int s = 0; s <= k->scalars; s++)
    v_store(t->sum[SPH_SUM_DENSITY + s] + b * SPH_LANES, w->more[s]);
}

BODY void tile_blocks(int dim, int kernel, unsigned fused, tile_taker *take, const sph_pair_task *t,
                      long begin, long end)
{
  tile_work w;
  tile_begin(dim, t, &w);
  for (long b = begin; b < end; b++)
    if (t->first[b] < t->first[b + 1]) tile_block(dim, kernel, fused, take, t, b, &w);
}

#endif
