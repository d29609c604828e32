#include "baseline.h"

#include "cpu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { STRIDE = 10 }; /* of a record: x[3] v[3] rho p c V */

struct baseline {
  baseline_def def;
  double reach, size, lo[3]; /* of the support, of a cell; lower corner [m] */
  long cells[3];
  int *cell;  /* [n] of particle i */
  int *start; /* [cells + 1] first sorted place */
  long start_room;
  int *order;     /* [n] particle in sorted place s */
  double *record; /* [n][STRIDE] sorted */
  long *first;    /* [n + 1] of each row */
  int *near;      /* [first[n]] sorted places */
  long near_room;
};

static void baseline_free(baseline *b)
{
  if (!b) return;
  free(b->cell);
  free(b->start);
  free(b->order);
  free(b->record);
  free(b->first);
  free(b->near);
  free(b);
}

static baseline *baseline_create(const baseline_def *def)
{
  baseline *b = calloc(1, sizeof *b);
  if (!b) return NULL;
  const size_t n = (size_t)def->n;
  b->def = *def;
  b->reach = 2 * def->h;
  b->size = b->reach / 2;
  b->cell = malloc(n * sizeof *b->cell);
  b->order = malloc(n * sizeof *b->order);
  b->record = calloc(n * STRIDE, sizeof *b->record);
  b->first = malloc((n + 1) * sizeof *b->first);
  if (b->cell && b->order && b->record && b->first) return b;
  baseline_free(b);
  return NULL;
}

/* Cells half as wide as the support, over all particles. */
static int make_cells(baseline *b)
{
  const baseline_def *def = &b->def;
  long all = 1;
  for (int d = 0; d < 3; d++) {
    b->cells[d] = 1;
    if (d >= def->dim) continue;
    double lo = INFINITY, hi = -INFINITY;
    for (long i = 0; i < def->n; i++) {
      lo = fmin(lo, def->x[d][i]);
      hi = fmax(hi, def->x[d][i]);
    }
    b->lo[d] = lo;
    b->cells[d] = (long)((hi - lo) / b->size) + 1;
    all *= b->cells[d];
  }
  if (all <= b->start_room) return 1;
  free(b->start);
  b->start = malloc((size_t)(all + 1) * sizeof *b->start);
  b->start_room = b->start ? all : 0;
  return b->start != NULL;
}

static long cell_of(const baseline *b, const double *x, int d)
{
  return (long)((x[d] - b->lo[d]) / b->size);
}

/* Counting sort; the last coordinate runs fastest. */
static int sort(baseline *b)
{
  const baseline_def *def = &b->def;
  if (!make_cells(b)) return 0;
  const long all = b->cells[0] * b->cells[1] * b->cells[2];
  memset(b->start, 0, (size_t)(all + 1) * sizeof *b->start);
  for (long i = 0; i < def->n; i++) {
    long c = 0;
    for (int d = 0; d < def->dim; d++)
      c = c * b->cells[d] + (long)((def->x[d][i] - b->lo[d]) / b->size);
    b->cell[i] = (int)c;
    b->start[c + 1]++;
  }
  for (long c = 0; c < all; c++) b->start[c + 1] += b->start[c];
  for (long i = def->n; i-- > 0;) b->order[--b->start[b->cell[i] + 1]] = (int)i;
  memmove(b->start, b->start + 1, (size_t)all * sizeof *b->start);
  b->start[all] = (int)def->n;
  return 1;
}

static int reserve(baseline *b, long more, long used)
{
  if (used + more <= b->near_room) return 1;
  long room = 2 * (used + more);
  int *near = realloc(b->near, (size_t)room * sizeof *near);
  if (!near) return 0;
  b->near = near;
  b->near_room = room;
  return 1;
}

/* Appends those of the sorted places begin .. end - 1 that place s reaches. */
static long add_near(const baseline *b, long s, long begin, long end, long n)
{
  const double *at = b->record + s * STRIDE, reach2 = b->reach * b->reach;
  for (long k = begin; k < end; k++) {
    const double *x = b->record + k * STRIDE;
    double r2 = (at[0] - x[0]) * (at[0] - x[0]) + (at[1] - x[1]) * (at[1] - x[1]) +
                (at[2] - x[2]) * (at[2] - x[2]);
    b->near[n] = (int)k;
    n += r2 < reach2 && k != s;
  }
  return n;
}

/* Row s: stretches of five cells along the last axis are consecutive places. */
static long add_row(baseline *b, long s, long n)
{
  const int last = b->def.dim - 1;
  long at[3] = {0}, from[3] = {0}, to[3] = {0};
  for (int d = 0; d <= last; d++) {
    at[d] = cell_of(b, b->record + s * STRIDE, d);
    from[d] = at[d] > 2 ? at[d] - 2 : 0;
    to[d] = at[d] + 2 < b->cells[d] ? at[d] + 2 : b->cells[d] - 1;
  }
  const long middle = last == 2;
  for (long x = from[0]; x <= to[0]; x++)
    for (long y = middle ? from[1] : 0; y <= (middle ? to[1] : 0); y++) {
      long column = middle ? (x * b->cells[1] + y) * b->cells[2] : x * b->cells[1];
      long begin = b->start[column + from[last]], end = b->start[column + to[last] + 1];
      if (!reserve(b, end - begin, n)) return -1;
      n = add_near(b, s, begin, end, n);
    }
  return n;
}

static void pack_positions(baseline *b)
{
  for (long s = 0; s < b->def.n; s++)
    for (int d = 0; d < b->def.dim; d++) b->record[s * STRIDE + d] = b->def.x[d][b->order[s]];
}

static int baseline_build(baseline *b)
{
  long n = 0;
  if (!sort(b)) return 0;
  pack_positions(b);
  for (long s = 0; s < b->def.n; s++) {
    b->first[s] = n;
    if ((n = add_row(b, s, n)) < 0) return 0;
  }
  b->first[b->def.n] = n;
  return 1;
}

static void pack(baseline *b)
{
  const baseline_def *def = &b->def;
  const double B = def->rho0 * def->c0 * def->c0 / 7;
  for (long s = 0; s < def->n; s++) {
    const long i = b->order[s];
    double *record = b->record + s * STRIDE;
    const double x = def->rho[i] / def->rho0, x3 = x * x * x;
    for (int d = 0; d < def->dim; d++) {
      record[d] = def->x[d][i];
      record[3 + d] = def->v[d][i];
    }
    record[6] = def->rho[i];
    record[7] = B * (x3 * x3 * x - 1);
    record[8] = def->c0 * x3;
    record[9] = def->m[i] / def->rho[i];
  }
}

/* Sums of one particle: acceleration, compression, diffusion; all times h^(dim + 2)/sigma. */
static inline __attribute__((always_inline)) void row(const baseline *b, long s, int dim,
                                                      double sum[5])
{
  const double h = b->def.h, eta2 = 0.01 * h * h, half = 0.5 / h, alpha_h = b->def.alpha * h;
  const double *i = b->record + s * STRIDE, inverse_rho = 1 / i[6];
  for (long k = b->first[s]; k < b->first[s + 1]; k++) {
    const double *j = b->record + (long)b->near[k] * STRIDE;
    double r[3], r2 = 0, rv = 0;
    for (int d = 0; d < dim; d++) {
      r[d] = i[d] - j[d];
      r2 += r[d] * r[d];
      rv += r[d] * (i[3 + d] - j[3 + d]);
    }
    const double t = 1 - half * sqrt(r2), VF = -5 * t * t * t * j[9], w = 0.5 * (rv - fabs(rv));
    const double viscous = alpha_h * w * j[6] * (i[8] + j[8]) / ((r2 + eta2) * (i[6] + j[6]));
    const double push = VF * (viscous - (i[7] + j[7]) * inverse_rho);
    for (int d = 0; d < dim; d++) sum[d] += push * r[d];
    sum[3] += VF * rv;
    sum[4] += 2 * VF * (i[6] - j[6]);
  }
}

static void rows(const baseline *b, double *const dv[3], double *drho)
{
  const baseline_def *def = &b->def;
  const double h = def->h, h2 = h * h;
  const double F = def->dim == 3 ? 21 / (16 * PI * h2 * h2 * h) : 7 / (4 * PI * h2 * h2);
  for (long s = 0; s < def->n; s++) {
    double sum[5] = {0};
    const long i = b->order[s];
    if (def->dim == 3)
      row(b, s, 3, sum);
    else
      row(b, s, 2, sum);
    for (int d = 0; d < def->dim; d++) dv[d][i] = F * sum[d];
    drho[i] = F * (def->rho[i] * sum[3] + def->delta * h * def->c0 * sum[4]);
  }
}

static void baseline_rates(baseline *b, double *const dv[3], double *drho)
{
  pack(b);
  rows(b, dv, drho);
}

const baseline_code SPH_ISA_NAME(baseline_code) = {baseline_create, baseline_free, baseline_build,
                                                   baseline_rates};
