/* The search of one instruction set: a source is kept if any target of the block is within reach of it.
 *
 * Stretches of the sorted order that can hold such sources are tested SPH_LANES sources at a time against every target
 * of the block: the least distance squared to the block, one comparison, one mask. */
#include "neighbors_data.h"
#include "sphode/simd.h"

enum { STRETCHES = 512 };

typedef struct stretch {
  int begin, end; /* sorted places of the source */
} stretch;

typedef struct block {
  double x
      [3]
      [SPH_LANES]; /* targets, shifted into the source's image; short blocks repeat their last one */
  double lo[3], hi[3];
} block;

static block load(const sph_neighbors *nb, const sph_set *target, long b, const double *shift)
{
  block t = {0};
  for (int d = 0; d < nb->def.dim; d++) {
    t.lo[d] = INFINITY;
    t.hi[d] = -INFINITY;
    for (int l = 0; l < SPH_LANES; l++) {
      long s = b * SPH_LANES + l;
      double x = target->x[d][s < target->n ? s : target->n - 1] - shift[d];
      t.x[d][l] = x;
      t.lo[d] = x < t.lo[d] ? x : t.lo[d];
      t.hi[d] = x > t.hi[d] ? x : t.hi[d];
    }
  }
  return t;
}

/* Distance from [lo, hi] to column k of direction d; columns at the edge of the grid go on without end. */
static double gap(const sph_grid *grid, int d, long k, double lo, double hi)
{
  double size = 1 / grid->inverse[d], left = grid->origin[d] + (double)k * size;
  if (k > 0 && left > hi) return left - hi;
  if (k < grid->cells[d] - 1 && left + size < lo) return lo - left - size;
  return 0;
}

/* The stretches of all columns that [lo, hi] reaches, in sorted order; the part of a column that it reaches is
 * narrowed by its distance.  Returns how many; STRETCHES + 1: too many. */
static int columns(const sph_neighbors *nb, const sph_set *source, const double *lo,
                   const double *hi, stretch *out, int n)
{
  const sph_grid *grid = &source->grid;
  int dim = nb->def.dim, z = dim - 1;
  double reach = nb->def.reach;
  long from[2] = {0, 0}, to[2] = {0, 0};
  for (int d = 0; d < z; d++) {
    from[d] = sph_grid_cell(grid, d, lo[d] - reach);
    to[d] = sph_grid_cell(grid, d, hi[d] + reach);
  }
  for (long a = from[0]; a <= to[0]; a++)
    for (long b = from[1]; b <= to[1]; b++) {
      double ga = z > 0 ? gap(grid, 0, a, lo[0], hi[0]) : 0,
             gb = z > 1 ? gap(grid, 1, b, lo[1], hi[1]) : 0;
      double rest = reach * reach * (1 + 1e-12) - ga * ga - gb * gb;
      if (rest <= 0) continue;
      rest = sqrt(rest) * (1 + 1e-12);
      long column = z == 0 ? 0 : z == 1 ? a : a * grid->cells[1] + b;
      long c0 = column * grid->cells[z] + sph_grid_cell(grid, z, lo[z] - rest);
      long c1 = column * grid->cells[z] + sph_grid_cell(grid, z, hi[z] + rest);
      stretch s = {source->start[c0], source->start[c1 + 1]};
      if (s.begin == s.end) continue;
      if (n == STRETCHES) return STRETCHES + 1;
      out[n++] = s;
    }
  return n;
}

/* Sorts by begin and joins what overlaps. */
static int merge(stretch *s, int n)
{
  for (int k = 1; k < n; k++) {
    stretch here = s[k];
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

/* All sources that can be near the block.  Where its targets lie far apart (at the end of a column, far flyers) each
 * is searched for on its own. */
static int candidates(const sph_neighbors *nb, const sph_set *source, const block *t, stretch *out)
{
  int apart = 0, n = 0;
  for (int d = 0; d < nb->def.dim; d++) apart |= t->hi[d] - t->lo[d] > 1.5 * nb->def.reach;
  if (!apart) return columns(nb, source, t->lo, t->hi, out, 0);
  for (int l = 0; l < SPH_LANES && n <= STRETCHES; l++) {
    double x[3] = {0};
    for (int d = 0; d < nb->def.dim; d++) x[d] = t->x[d][l];
    n = columns(nb, source, x, x, out, n);
  }
  return n <= STRETCHES ? merge(out, n) : n;
}

/* Bit l: source s + l is within reach of a target. */
BODY unsigned near(int dim, const sph_set *source, const block *t, int s, double reach2)
{
  vec least = v_set(INFINITY), x[3];
  for (int d = 0; d < dim; d++) x[d] = v_load(source->x[d] + s);
#pragma GCC unroll 8
  for (int l = 0; l < SPH_LANES; l++) {
    vec r2 = v_set(0);
    for (int d = 0; d < dim; d++) {
      vec r = x[d] - t->x[d][l];
      r2 += r * r;
    }
    least = v_min(least, r2);
  }
  return v_bits((vec_mask)(least <= reach2));
}

BODY void test(int dim, const sph_set *source, const block *t, stretch s, double reach2, long first,
               int image, sph_runs *out)
{
  for (int j = s.begin; j < s.end; j += SPH_LANES) {
    unsigned bits = near(dim, source, t, j, reach2);
    if (s.end - j < SPH_LANES) bits &= (1u << (s.end - j)) - 1;
    while (bits) {
      int start = __builtin_ctz(bits), count = __builtin_ctz(~(bits >> start));
      sph_neighbors_runs_add(out, first, j + start, count, image);
      bits &= ~(((1u << count) - 1) << start);
    }
  }
}

static void test_stretch(const sph_neighbors *nb, const sph_set *source, const block *t, stretch s,
                         long first, int image, sph_runs *out)
{
  double reach2 = nb->def.reach * nb->def.reach * (1 + 1e-12);
  if (nb->def.dim == 1) test(1, source, t, s, reach2, first, image, out);
  if (nb->def.dim == 2) test(2, source, t, s, reach2, first, image, out);
  if (nb->def.dim == 3) test(3, source, t, s, reach2, first, image, out);
}

static int image_reaches(const sph_neighbors *nb, const sph_set *source, const block *t)
{
  for (int d = 0; d < nb->def.dim; d++)
    if (t->lo[d] - source->grid.hi[d] > nb->def.reach ||
        source->grid.lo[d] - t->hi[d] > nb->def.reach)
      return 0;
  return 1;
}

static void search(const sph_neighbors *nb, const sph_set *target, const sph_set *source,
                   long begin, long end, long *first, sph_runs *out)
{
  stretch found[STRETCHES];
  for (long b = begin; b < end; b++) {
    first[b] = out->n;
    for (int m = 0; m < nb->images; m++) {
      const block t = load(nb, target, b, nb->shift[m]);
      if (!image_reaches(nb, source, &t)) continue;
      int n = candidates(nb, source, &t, found);
      if (n > STRETCHES) { /* a very coarse grid: all of it */
        found[0] = (stretch){0, (int)source->n};
        n = 1;
      }
      for (int k = 0; k < n; k++) test_stretch(nb, source, &t, found[k], first[b], m, out);
    }
  }
}

const sph_neighbors_table SPH_ISA_NAME(sph_neighbors_loops) = {search};
