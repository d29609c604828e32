/* tile_pair.h -- pair terms that are registered at run time, tile by tile (sph_tile).
 *
 * A tile is a block of targets times up to SPH_TILE_ROWS sources.  It shows what the terms read,
 * each term adds to it, then its rows are summed, and heated, as built-in terms are; these have a
 * loop of their own.  Filling what is read costs most: a store for each lane of each. */
#ifndef SPH_TILE_PAIR_H
#define SPH_TILE_PAIR_H
#include "fluid_pair.h"
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

/* v_i - v_j, where it is kept, and r.v, with the velocity that sources have in these slots. */
BODY void tile_velocities(int dim, const vec *v_i, int slot, int n, const tile_rows *rows, int keep,
                          vec (*v)[SPH_TILE_ROWS], vec *rv)
{
  for (int q = 0; q < n; q++) {
    const double *v_j = rows->source[q] + slot;
    vec dot = v_set(0);
    for (int d = 0; d < dim; d++) dot += rows->r[d][q] * (v_i[d] - v_j[d]);
    rv[q] = dot;
  }
  for (int q = 0; keep && q < n; q++)
    for (int d = 0; d < dim; d++) v[d][q] = v_i[d] - rows->source[q][slot + d];
}

/* F of rows 0 .. n - 1, in the unit of users: all that knows the kernel. */
typedef void tile_kernel(const tile_constants *k, tile_rows *rows, int n);

BODY void tile_F(int dim, int kernel, const tile_constants *k, tile_rows *rows, int n)
{
  const double inverse_h = k->fluid.inverse_h, scale = k->F_scale;
  for (int q = 0; q < n; q++)
    rows->F[q] = scale * kernel_shape_f_at(kernel, dim, v_sqrt(rows->r2[q]), inverse_h);
}

/* What is read of rows 0 .. n - 1 besides r and r2, one after another: short loops, whose roots and
 * divisions overlap. */
BODY void tile_fill(int dim, tile_kernel *kernel, const tile_constants *k, const vec *v,
                    tile_rows *rows, int n)
{
  const unsigned show = k->show;
  if (show & SPH_TILE_F) kernel(k, rows, n);
  if (show & SPH_TILE_VOLUME)
    for (int q = 0; q < n; q++) rows->V[q] = v_set(rows->source[q][slot_V(dim)]);
  if (show & SPH_TILE_MASS)
    for (int q = 0; q < n; q++)
      rows->m[q] = v_set(rows->source[q][slot_V(dim)] * rows->source[q][slot_rho(dim)]);
  if (show & (SPH_TILE_V | SPH_TILE_RV))
    tile_velocities(dim, v, slot_v(dim), n, rows, (show & SPH_TILE_V) != 0, rows->v, rows->rv);
  if (k->fluid.terms & SPH_NO_SLIP)
    tile_velocities(dim, v, slot_extra(dim), n, rows, 1, rows->v_viscous, rows->rv_viscous);
  tile_sources(dim, k, rows, n);
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

/* Forces along r, from rows that hold them; dissipative ones, with rv, heat.  All sums at once: one
 * alone would wait for itself. */
BODY void tile_take_along(int dim, const tile_rows *rows, vec *along, const vec *rv, int n,
                          vec *taken)
{
  vec sum[3] = {v_set(0), v_set(0), v_set(0)}, work = v_set(0);
  for (int q = 0; rv && q < n; q++) work += along[q] * rv[q];
  for (int q = 0; q < n; q++) {
    for (int d = 0; d < dim; d++) sum[d] += along[q] * rows->r[d][q];
    along[q] = v_set(0);
  }
  for (int d = 0; d < dim; d++) taken[SPH_SUM_A + d] += sum[d];
  taken[SPH_SUM_HEAT] -= 0.5 * work;
}

BODY void tile_take_drag(int dim, tile_rows *rows, vec (*v)[SPH_TILE_ROWS], int heats, int n,
                         vec *taken)
{
  vec sum[3] = {v_set(0), v_set(0), v_set(0)}, work = v_set(0);
  for (int q = 0; heats && q < n; q++)
    for (int d = 0; d < dim; d++) work += rows->along_v[q] * v[d][q] * v[d][q];
  for (int q = 0; q < n; q++) {
    for (int d = 0; d < dim; d++) sum[d] += rows->along_v[q] * v[d][q];
    rows->along_v[q] = v_set(0);
  }
  for (int d = 0; d < dim; d++) taken[SPH_SUM_A + d] += sum[d];
  taken[SPH_SUM_HEAT] -= 0.5 * work;
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

/* The registered terms, each on rows 0 .. n - 1; what they added: to the fluid sums `taken`, to
 * density and scalars `more`. */
static __attribute__((noinline, unused)) void tile_call(int dim, const tile_constants *k,
                                                        sph_tile *tile, tile_rows *rows, int n,
                                                        vec *taken, vec *more)
{
  const int no_slip = (k->fluid.terms & SPH_NO_SLIP) != 0;
  const int heats = (k->fluid.terms & SPH_THERMAL) != 0;
  const vec unit = v_set(1 / k->F_scale), *rv = no_slip ? rows->rv_viscous : rows->rv;
  tile->n = (long)n * SPH_LANES;
  for (int q = 0; q < k->terms; q++) {
    tile_fields(&k->term[q], rows, tile);
    k->term[q].term->pair(k->term[q].term, tile);
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

/* One tile after another: its rows, what users see of them, and the sums of a block. */
typedef struct tile_work {
  vec v[3]; /* of the targets */
  vec sum[SPH_SUM_DRIFT], more[1 + SPH_SCALARS_MAX];
  sph_tile tile;
  tile_rows rows;
} tile_work;

/* Fills rows 0 .. n - 1, calls the terms, sums what they added, in the unit of the fluid sums. */
static __attribute__((noinline, unused)) void
tile_take(int dim, tile_kernel *kernel, const tile_constants *k, tile_work *w, int n)
{
  const vec unit = v_set(1 / k->F_scale);
  vec taken[SPH_SUM_DRIFT];
  tile_fill(dim, kernel, k, w->v, &w->rows, n);
  tile_call(dim, k, &w->tile, &w->rows, n, taken, w->more);
  for (int d = 0; d < dim; d++) w->sum[SPH_SUM_A + d] += unit * taken[SPH_SUM_A + d];
  w->sum[SPH_SUM_HEAT] += unit * taken[SPH_SUM_HEAT];
}

/* All pairs of one block; rows go on over the ends of runs. */
BODY void tile_block(int dim, tile_kernel *kernel, const sph_pair_task *t, long b, tile_work *w)
{
  const tile_constants *k = t->constants;
  const double *record = t->target + b * SPH_LANES * t->target_stride;
  vec home[3], x[3];
  int n = 0;
  for (int d = 0; d < dim; d++) {
    home[d] = v_gather(record + d, t->target_stride);
    w->v[d] = v_gather(record + slot_v(dim) + d, t->target_stride);
  }
  tile_targets(dim, k, record, t->target_stride, &w->rows);
  for (long r = t->first[b]; r < t->first[b + 1]; r++) {
    const sph_run run = t->runs[r];
    const double *source = t->source + sph_run_start(run) * t->source_stride;
    for (int d = 0; d < dim; d++) x[d] = home[d] - t->shift[sph_run_image(run)][d];
    pair_prefetch(source + sph_run_count(run) * t->source_stride, slot_extra(dim));
    for (int q = 0; q < sph_run_count(run); q++, source += t->source_stride) {
      tile_row(dim, x, source, &w->rows, n++);
      if (n < SPH_TILE_ROWS) continue;
      tile_take(dim, kernel, k, w, n);
      n = 0;
    }
  }
  if (n > 0) tile_take(dim, kernel, k, w, n);
}

BODY void tile_blocks(int dim, tile_kernel *kernel, const sph_pair_task *t, long begin, long end)
{
  const tile_constants *k = t->constants;
  tile_work w;
  w.tile = tile_open(dim, k, &w.rows);
  tile_clear(&w.rows);
  for (long b = begin; b < end; b++) {
    if (t->first[b] == t->first[b + 1]) continue;
    for (int s = 0; s < SPH_SUM_DRIFT; s++) w.sum[s] = v_load(t->sum[s] + b * SPH_LANES);
    for (int s = 0; s <= k->scalars; s++)
      w.more[s] = v_load(t->sum[SPH_SUM_DENSITY + s] + b * SPH_LANES);
    tile_block(dim, kernel, t, b, &w);
    for (int s = 0; s < SPH_SUM_DRIFT; s++) v_store(t->sum[s] + b * SPH_LANES, w.sum[s]);
    for (int s = 0; s <= k->scalars; s++)
      v_store(t->sum[SPH_SUM_DENSITY + s] + b * SPH_LANES, w.more[s]);
  }
}

#endif
