/* case_swing.c -- the period and the decay of a curve that swings around zero, as
 * cos(2 pi t/T) exp(-gamma t) does.
 *
 * A half swing lies between two passages through zero.  Passages count once the curve has been
 * beyond a tenth of its last half swing on both sides: noise around zero makes none.
 *
 *   period  2 (last passage - first)/(number of half swings)
 *   decay   - slope of ln |integral of y over a half swing| over its middle, least squares: of
 *           the damped cosine these integrals fall by exactly exp(-gamma T/2) from one to the
 *           next, whatever the phase; of a curve that stays on one side of zero: - slope of
 *           ln |y|, least squares */
#include <math.h>

#include "case_curve.h"
#include "memory.h"

enum { HALVES_MAX = 4096 };
static const double beyond = 0.1;

typedef struct passages {
  double at[HALVES_MAX + 1];   /* times */
  double area[HALVES_MAX + 1]; /* integral of |y| since the passage before */
  int n;
} passages;

/* Where the straight line between two points of the curve is zero. */
static double zero_between(const sph_case_curve *c, long k)
{
  return c->x[k - 1] - c->y[k - 1] * (c->x[k] - c->x[k - 1]) / (c->y[k] - c->y[k - 1]);
}

static void find_passages(const sph_case_curve *c, const double window[2], passages *p)
{
  double at = NAN, area = 0, area_at = 0, most = 0, before = 0;
  int side = 0;
  for (long k = 1; k < c->n && p->n <= HALVES_MAX; k++) {
    const double y = c->y[k], y_before = c->y[k - 1], width = c->x[k] - c->x[k - 1];
    if (c->x[k - 1] < window[0] || c->x[k] > window[1]) continue;
    if ((y > 0) != (y_before > 0)) {
      at = zero_between(c, k);
      area_at = area + 0.5 * y_before * (at - c->x[k - 1]);
    }
    area += 0.5 * (y + y_before) * width;
    if (side && (y > 0) != (side > 0) && fabs(y) > beyond * most) {
      p->at[p->n] = at;
      p->area[p->n++] = fabs(area_at - before);
      before = area_at;
      side = -side;
      most = fabs(y);
    }
    if (!side) side = y > 0 ? 1 : -1;
    if ((y > 0) == (side > 0)) most = fmax(most, fabs(y));
  }
}

/* Of a line by least squares. */
typedef struct line {
  double n, x, y, xx, xy;
} line;

static void add(line *l, double x, double y)
{
  l->n++;
  l->x += x;
  l->y += y;
  l->xx += x * x;
  l->xy += x * y;
}

static double slope(const line *l)
{
  return (l->n * l->xy - l->x * l->y) / (l->n * l->xx - l->x * l->x);
}

static double decay(const passages *p)
{
  line l = {0};
  for (int k = 1; k < p->n; k++)
    add(&l, 0.5 * (p->at[k] + p->at[k - 1]) - p->at[0], log(p->area[k]));
  return -slope(&l);
}

/* Of a curve that is never zero in the window; else NaN. */
static double decay_aside(const sph_case_curve *c, const double window[2])
{
  line l = {0};
  int above = 0, below = 0;
  for (long k = 0; k < c->n; k++) {
    if (c->x[k] < window[0] || c->x[k] > window[1]) continue;
    above |= c->y[k] > 0, below |= c->y[k] < 0;
    add(&l, c->x[k] - c->x[0], log(fabs(c->y[k])));
  }
  return above != below && l.n >= 2 ? -slope(&l) : NAN;
}

int sph_case_swing(const sph_case_curve *run, const double window[2], double *period, double *rate,
                   sph_error *error)
{
  passages *p = SPH_NEW(passages, 1, "the swings of a curve", error);
  *period = NAN;
  if (!p) return SPH_ERR_MEMORY;
  p->n = 0;
  find_passages(run, window, p);
  if (p->n >= 2) *period = 2 * (p->at[p->n - 1] - p->at[0]) / (p->n - 1);
  *rate = p->n >= 3 ? decay(p) : decay_aside(run, window);
  sph_memory_free(p);
  return SPH_OK;
}
