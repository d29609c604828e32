/* Lists of one instruction set: a source is kept if a target of the block is within reach.
 *
 * Stretches of the sorted order that can hold such sources, as the search finds them, are tested
 * STEP sources at a time against every target of the block: the least distance squared to the
 * block, one comparison, one mask.  With c the middle of the block, u = x_i - c, y = x_j - c,
 *   |x_i - x_j|^2 = |y|^2 + (|u|^2 - 2 u.y):
 * what is in brackets costs three operations a pair.  The reference (SPH_LANES == 1) takes blocks
 * of any size. */
#include <float.h>

#include "neighbors_data.h"
#include "sphode/simd.h"

enum { PIECE = 256, MARKS = 8 * PIECE };
enum {
  STEP = SPH_LANES_MAX,
  PARTS = STEP / SPH_LANES
}; /* sources tested at once; vectors of them */

typedef struct block {
  double x[3][SPH_LANES_MAX]; /* targets; a short last block repeats its last one */
  double lo[3], hi[3];
} block;

/* Sources of a set, for the runs of `out`. */
typedef struct asked {
  const sph_neighbors *nb;
  int source;
  sph_runs *out;
} asked;

typedef struct probe {
  double centre[3];
  double minus_2u[3][SPH_LANES_MAX], uu[SPH_LANES_MAX];
  double limit; /* on the distance squared */
} probe;

/* Where "within reach" begins and ends, in turn: sorted places of the source. */
typedef struct marks {
  int n, at[MARKS + PIECE + 2 * SPH_LANES_MAX];
} marks;

BODY block load(int dim, int lanes, const sph_set *target, long b)
{
  block t = {0};
  for (int d = 0; d < dim; d++) {
    t.lo[d] = INFINITY;
    t.hi[d] = -INFINITY;
    for (int l = 0; l < lanes; l++) {
      long s = b * lanes + l;
      double x = target->x[d][s < target->n ? s : target->n - 1];
      t.x[d][l] = x;
      t.lo[d] = x < t.lo[d] ? x : t.lo[d];
      t.hi[d] = x > t.hi[d] ? x : t.hi[d];
    }
  }
  return t;
}

BODY block shifted(int dim, int lanes, const block *t, const double *shift)
{
  block moved = *t;
  for (int d = 0; d < dim; d++) {
    for (int l = 0; l < lanes; l++) moved.x[d][l] -= shift[d];
    moved.lo[d] -= shift[d];
    moved.hi[d] -= shift[d];
  }
  return moved;
}

BODY int reaches(int dim, double reach, const block *t, const double *shift, const sph_set *source)
{
  for (int d = 0; d < dim; d++)
    if (t->lo[d] - shift[d] - source->hi[d] > reach ||
        source->lo[d] - (t->hi[d] - shift[d]) > reach)
      return 0;
  return 1;
}

/* Sorts by begin and joins what overlaps. */
static int merge(sph_stretch *s, int n)
{
  for (int k = 1; k < n; k++) {
    sph_stretch here = s[k];
    int m = k;
    for (; m > 0 && s[m - 1].begin > here.begin; m--) s[m] = s[m - 1];
    s[m] = here;
  }
  int last = 0;
  for (int k = 1; k < n; k++) {
    if (s[k].begin > s[last].end)
      s[++last] = s[k];
    else if (s[k].end > s[last].end)
      s[last].end = s[k].end;
  }
  return n ? last + 1 : 0;
}

BODY int compact(int dim, double reach, const double *lo, const double *hi)
{
  int is = 1;
  for (int d = 0; d < dim; d++) is &= hi[d] - lo[d] <= 1.5 * reach;
  return is;
}

/* Box [lo, hi] of targets l, l + 1, ... while it is compact; returns the first one not in it. */
BODY int part(int dim, int lanes, double reach, const block *t, int l, double *lo, double *hi)
{
  for (int d = 0; d < dim; d++) lo[d] = hi[d] = t->x[d][l];
  while (++l < lanes) {
    double low[3] = {0}, high[3] = {0};
    for (int d = 0; d < dim; d++) {
      low[d] = fmin(lo[d], t->x[d][l]);
      high[d] = fmax(hi[d], t->x[d][l]);
    }
    if (!compact(dim, reach, low, high)) break;
    memcpy(lo, low, sizeof low);
    memcpy(hi, high, sizeof high);
  }
  return l;
}

/* What the search finds around lo .. hi; a user's own is held to its promise. */
static int ask(const asked *q, const double *lo, const double *hi, int max, sph_stretch *out)
{
  const sph_search *search = &q->nb->search;
  int n = search->near(search->ctx, q->source, lo, hi, q->nb->def.reach, max, out), last = 0;
  if (!q->nb->own) return n;
  int good = n >= 0 && n <= max;
  for (int k = 0; good && k < n; k++) {
    good =
        out[k].begin >= last && out[k].end > out[k].begin && out[k].end <= q->nb->set[q->source].n;
    last = out[k].end;
  }
  if (!good && !q->out->status) q->out->status = SPH_ERR_ARGUMENT;
  return good ? n : 0;
}

/* All sources that can be near the block.  Where its targets lie apart (a column ends, far
 * flyers) the search is for one compact part after the other. */
BODY int candidates(int dim, int lanes, const asked *q, const block *t, sph_stretch *out)
{
  const double reach = q->nb->def.reach;
  if (compact(dim, reach, t->lo, t->hi)) return ask(q, t->lo, t->hi, SPH_STRETCHES, out);
  int n = 0;
  for (int l = 0; l < lanes;) {
    double lo[3] = {0}, hi[3] = {0};
    l = part(dim, lanes, reach, t, l, lo, hi);
    n += ask(q, lo, hi, SPH_STRETCHES / SPH_LANES_MAX, out + n);
  }
  return merge(out, n);
}

/* The limit leaves room for rounding: the terms are at most about (|u| + |y|)^2, each to a few
 * DBL_EPSILON. */
BODY probe make_probe(int dim, int lanes, double reach, const block *t)
{
  probe p = {0};
  double size = 2 * reach;
  for (int d = 0; d < dim; d++) {
    p.centre[d] = 0.5 * (t->lo[d] + t->hi[d]);
    size += t->hi[d] - t->lo[d];
    for (int l = 0; l < lanes; l++) {
      double u = t->x[d][l] - p.centre[d];
      p.minus_2u[d][l] = -2 * u;
      p.uu[l] += u * u;
    }
  }
  p.limit = reach * reach * (1 + 1e-12) + 64 * DBL_EPSILON * size * size;
  return p;
}

/* Bit k: source s + k is within reach of a target, k < STEP. */
BODY unsigned near(int dim, int lanes, const sph_set *source, const probe *p, int s)
{
  vec least[PARTS], y[PARTS][3], yy[PARTS];
  for (int k = 0; k < PARTS; k++) {
    least[k] = v_set(INFINITY);
    yy[k] = v_set(0);
    for (int d = 0; d < dim; d++) {
      y[k][d] = v_load(source->x[d] + s + k * SPH_LANES) - p->centre[d];
      yy[k] += y[k][d] * y[k][d];
    }
  }
#pragma GCC unroll 8
  for (int l = 0; l < lanes; l++)
    for (int k = 0; k < PARTS; k++) {
      vec bracket = v_set(p->uu[l]);
      for (int d = 0; d < dim; d++) bracket += y[k][d] * p->minus_2u[d][l];
      least[k] = v_min(least[k], bracket);
    }
  unsigned bits = 0;
  for (int k = 0; k < PARTS; k++)
    bits |= v_bits((vec_mask)(yy[k] + least[k] <= p->limit)) << (k * SPH_LANES);
  return bits;
}

/* Marks where the bits change; at most PIECE sources.  All STEP places are written, only the
 * changes are kept: how many there are is hard to foretell for a processor. */
BODY void test(int dim, int lanes, const sph_set *source, const probe *p, sph_stretch s,
               const sph_bits *list, marks *restrict m)
{
  unsigned inside = 0;
  int *at = m->at + m->n;
  for (int j = s.begin; j < s.end; j += STEP) {
    unsigned bits = near(dim, lanes, source, p, j);
    if (s.end - j < STEP) bits &= (1u << (s.end - j)) - 1;
    unsigned changes = (bits ^ (bits << 1 | inside)) & ((1u << STEP) - 1);
    inside = bits >> (STEP - 1);
    for (int k = 0; k < STEP; k++) at[k] = j + list->place[changes][k];
    at += list->count[changes];
  }
  if (inside) *at++ = s.end;
  m->n = (int)(at - m->at);
}

/* Marks become runs; a run that goes on where the last one ended lengthens it, if it fits. */
static void add_runs(marks *m, int image, sph_runs *out)
{
  long n = m->n / 2;
  m->n = 0;
  if (n == 0 || sph_neighbors_runs_reserve(out, n)) return;
  sph_run *last = out->run + out->n;
  int end = -1;
  for (const int *at = m->at; at < m->at + 2 * n; at += 2) {
    const long count = at[1] - at[0];
    if (at[0] == end && sph_run_count(last[-1]) + count <= SPH_RUN_LONGEST)
      last[-1] = sph_neighbors_run(sph_run_start(last[-1]), sph_run_count(last[-1]) + count, image);
    else
      *last++ = sph_neighbors_run(at[0], count, image);
    end = at[1];
  }
  out->n = last - out->run;
}

BODY void search_image(int dim, int lanes, const asked *q, const block *t, int image, marks *m)
{
  sph_stretch found[SPH_STRETCHES];
  const sph_set *source = &q->nb->set[q->source];
  const int n = candidates(dim, lanes, q, t, found);
  const probe p = make_probe(dim, lanes, q->nb->def.reach, t);
  for (int k = 0; k < n; k++)
    for (sph_stretch s = {found[k].begin, 0}; s.begin < found[k].end; s.begin = s.end) {
      s.end = found[k].end - s.begin > PIECE ? s.begin + PIECE : found[k].end;
      test(dim, lanes, source, &p, s, &q->nb->bits, m);
      if (m->n > MARKS) add_runs(m, image, q->out);
    }
  add_runs(m, image, q->out);
}

BODY void list_blocks(int dim, int lanes, const asked *q, int target, long begin, long end,
                      long *first)
{
  const sph_neighbors *nb = q->nb;
  marks m;
  m.n = 0;
  for (long b = begin; b < end; b++) {
    first[b] = q->out->n;
    const block t = load(dim, lanes, &nb->set[target], b);
    for (int image = 0; image < nb->images; image++) {
      if (!reaches(dim, nb->def.reach, &t, nb->shift[image], &nb->set[q->source])) continue;
      const block here = shifted(dim, lanes, &t, nb->shift[image]);
      search_image(dim, lanes, q, &here, image, &m);
    }
  }
}

static void list(const sph_neighbors *nb, int target, int source, long begin, long end, long *first,
                 sph_runs *out)
{
  const int lanes = SPH_LANES == 1 ? nb->def.lanes : SPH_LANES;
  const asked q = {nb, source, out};
  if (nb->def.dim == 1) list_blocks(1, lanes, &q, target, begin, end, first);
  if (nb->def.dim == 2) list_blocks(2, lanes, &q, target, begin, end, first);
  if (nb->def.dim == 3) list_blocks(3, lanes, &q, target, begin, end, first);
}

const sph_neighbors_table SPH_ISA_NAME(sph_neighbors_loops) = {list};
