#include "case_curve.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "memory.h"

double sph_case_curve_norm(const char *norm, long n, const double *weight, const double *a,
                           const double *b)
{
  double sum = 0, weights = 0, most = 0;
  int square = !strcmp(norm, "rms");
  for (long i = 0; i < n; i++) {
    double d = fabs(a[i] - b[i]), w = weight ? weight[i] : 1;
    sum += w * (square ? d * d : d);
    weights += w;
    if (!(d <= most)) most = d; /* NaN stays */
    if (isnan(d)) return NAN;
  }
  if (n == 0) return NAN;
  if (!strcmp(norm, "max")) return most;
  return square ? sqrt(sum / weights) : sum / weights;
}

/* The curve between its points is straight: k with x[k] <= x < x[k + 1], inside. */
static long segment(const sph_case_curve *c, double x)
{
  long low = 0, high = c->n - 1;
  while (high - low > 1) {
    long middle = (low + high) / 2;
    if (c->x[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  return low;
}

static double at(const sph_case_curve *c, double x)
{
  if (c->n == 1 || x <= c->x[0]) return c->y[0];
  if (x >= c->x[c->n - 1]) return c->y[c->n - 1];
  long k = segment(c, x);
  double width = c->x[k + 1] - c->x[k];
  return c->y[k] + (width > 0 ? (x - c->x[k]) / width : 0) * (c->y[k + 1] - c->y[k]);
}

void sph_case_curve_integrate(const sph_case_curve *run, double *integral)
{
  for (long k = 0; k < run->n; k++)
    integral[k] =
        k == 0 ? 0
               : integral[k - 1] + 0.5 * (run->x[k] - run->x[k - 1]) * (run->y[k] + run->y[k - 1]);
}

static double integral_to(const sph_case_curve *c, const double *integral, double x)
{
  long k = segment(c, x);
  return integral[k] + 0.5 * (x - c->x[k]) * (c->y[k] + at(c, x));
}

double sph_case_curve_mean(const sph_case_curve *run, const double *integral, double x,
                           double width)
{
  if (run->n == 0) return NAN;
  double from = fmax(x - 0.5 * width, run->x[0]), to = fmin(x + 0.5 * width, run->x[run->n - 1]);
  if (width <= 0 || run->n == 1 || !(to > from)) return at(run, x);
  return (integral_to(run, integral, to) - integral_to(run, integral, from)) / (to - from);
}

/* First x from `from` on where y passes the threshold upwards; NaN: never. */
static double arrival(const sph_case_curve *c, const double window[2], double threshold)
{
  for (long k = 0; k < c->n; k++) {
    if (c->x[k] < window[0] || c->x[k] > window[1] || !(c->y[k] >= threshold)) continue;
    if (k == 0 || !(c->y[k - 1] < threshold)) return c->x[k];
    double part = (threshold - c->y[k - 1]) / (c->y[k] - c->y[k - 1]);
    return c->x[k - 1] + part * (c->x[k] - c->x[k - 1]);
  }
  return NAN;
}

/* The points of the reference that count, and the run there. */
typedef struct points {
  const sph_case_curve *run;
  const double *integral;
  double *x, *y, *there; /* [n] */
  double *weight;        /* [n]; NULL: all the same */
  long n;
} points;

static double distance_at(const points *p, const sph_case_distance *d, double shift)
{
  for (long i = 0; i < p->n; i++)
    p->there[i] = sph_case_curve_mean(p->run, p->integral, p->x[i] - shift, d->average);
  return sph_case_curve_norm(d->norm, p->n, p->weight, p->there, p->y);
}

/* The distance has several minima: a scan, then a golden section around the best. */
static void best_shift(const points *p, sph_case_distance *d)
{
  enum { SCAN = 400 };
  double step = d->offset / SCAN, best = 0, golden = 0.5 * (sqrt(5) - 1);
  d->unshifted = d->value = distance_at(p, d, 0);
  d->shift = 0;
  for (int k = 1; k <= SCAN && step > 0; k++) {
    double value = distance_at(p, d, k * step);
    if (!(value < d->value)) continue;
    d->value = value;
    best = k * step;
  }
  double low = fmax(best - step, 0), high = fmin(best + step, d->offset);
  while (step > 0 && high - low > 1e-6 * d->offset) {
    double a = high - golden * (high - low), b = low + golden * (high - low);
    if (distance_at(p, d, a) < distance_at(p, d, b))
      high = b;
    else
      low = a;
  }
  double value = distance_at(p, d, 0.5 * (low + high));
  d->shift = value < d->value ? 0.5 * (low + high) : best;
  d->value = fmin(value, d->value);
}

static void choose(points *p, const sph_case_curve *reference, sph_case_distance *d)
{
  double end = p->run->n ? p->run->x[p->run->n - 1] : -INFINITY;
  d->largest = -INFINITY;
  for (long i = 0; i < reference->n; i++) {
    double x = reference->x[i], y = reference->y[i];
    if (x < d->window[0] || x > d->window[1] || y > d->up_to) continue;
    d->wanted++;
    if (x > end * (1 + 1e-9)) continue;
    p->x[p->n] = x;
    p->y[p->n++] = y;
    d->largest = fmax(d->largest, y);
  }
  d->used = p->n;
}

/* Half of the way to the neighbors of each point: the trapezoidal rule.  Points of one time, or out
 * of order by what digitising does, count as they are apart. */
static void weigh(points *p)
{
  for (long i = 0; p->n > 1 && i < p->n; i++) {
    const double from = p->x[i > 0 ? i - 1 : 0], to = p->x[i + 1 < p->n ? i + 1 : i];
    p->weight[i] = fmax(0.5 * (to - from), 0);
  }
  if (p->n == 1) p->weight[0] = 1;
}

static void compare_arrival(const points *p, const sph_case_curve *reference, sph_case_distance *d)
{
  d->largest = reference->n ? arrival(reference, d->window, d->threshold) : d->one;
  d->wanted = 1;
  d->found = arrival(p->run, d->window, d->threshold);
  d->unshifted = d->value = fabs(d->found - d->largest);
  d->used = isfinite(d->value);
}

static void compare_mean(const points *p, const sph_case_curve *reference, sph_case_distance *d)
{
  double sum = 0, end = p->run->n ? p->run->x[p->run->n - 1] : -INFINITY;
  for (long i = 0; i < p->n; i++) sum += p->y[i];
  double wanted = reference->n ? sum / (double)p->n : d->one;
  double from = fmax(d->window[0], p->run->n ? p->run->x[0] : 0), to = fmin(d->window[1], end);
  double mean = sph_case_curve_mean(p->run, p->integral, 0.5 * (from + to), to - from);
  int whole = to > from && (isinf(d->window[1]) || end >= d->window[1] * (1 - 1e-9));
  if (!reference->n) {
    d->largest = d->one;
    d->wanted = 1;
  }
  d->used = whole ? d->wanted : 0;
  d->found = whole ? mean : NAN;
  d->unshifted = d->value = fabs(d->found - wanted);
}

static double drift(const sph_case_curve *c, const double window[2])
{
  double most = c->n ? 0 : NAN;
  for (long k = 0; k < c->n; k++) {
    double change = fabs(c->y[k] - c->y[0]);
    if (c->x[k] < window[0] || c->x[k] > window[1]) continue;
    if (isnan(change)) return NAN;
    most = fmax(most, change);
  }
  return most;
}

/* Those that one number says. */
static int compare_one(const points *p, sph_case_distance *d, sph_error *error)
{
  double period = NAN, decay = NAN;
  int drifts = !strcmp(d->norm, "drift");
  int status = drifts ? SPH_OK : sph_case_swing(p->run, d->window, &period, &decay, error);
  d->largest = d->one;
  d->wanted = 1;
  d->found = drifts ? drift(p->run, d->window) : strcmp(d->norm, "decay") ? period : decay;
  d->unshifted = d->value = fabs(d->found - d->one);
  d->used = isfinite(d->value);
  return status;
}

int sph_case_curve_of_one(const char *norm)
{
  return !strcmp(norm, "drift") || !strcmp(norm, "period") || !strcmp(norm, "decay");
}

int sph_case_curve_compare(const sph_case_curve *run, const sph_case_curve *reference,
                           sph_case_distance *d, sph_error *error)
{
  points p = {.run = run};
  double *integral = SPH_NEW(double, run->n, "a comparison", error);
  p.integral = integral;
  p.x = SPH_NEW(double, reference->n, "a comparison", error);
  p.y = SPH_NEW(double, reference->n, "a comparison", error);
  p.there = SPH_NEW(double, reference->n, "a comparison", error);
  p.weight = d->by_time ? SPH_NEW(double, reference->n, "a comparison", error) : NULL;
  int status =
      integral && p.x && p.y && p.there && (p.weight || !d->by_time) ? SPH_OK : SPH_ERR_MEMORY;
  d->value = d->unshifted = d->found = NAN;
  d->shift = 0;
  d->used = d->wanted = 0;
  if (!status) {
    sph_case_curve_integrate(run, integral);
    choose(&p, reference, d);
    if (p.weight) weigh(&p);
    if (!strcmp(d->norm, "arrival"))
      compare_arrival(&p, reference, d);
    else if (!strcmp(d->norm, "mean"))
      compare_mean(&p, reference, d);
    else if (sph_case_curve_of_one(d->norm))
      status = compare_one(&p, d, error);
    else
      best_shift(&p, d);
  }
  sph_memory_free(p.weight);
  sph_memory_free(p.there);
  sph_memory_free(p.y);
  sph_memory_free(p.x);
  sph_memory_free(integral);
  return status;
}

void sph_case_curve_label(char label[SPH_CASE_LABEL], const char *what, double scale,
                          const char *unit)
{
  if (scale == 1)
    snprintf(label, SPH_CASE_LABEL, *unit ? "%.39s [%s]" : "%.39s", what, unit);
  else
    snprintf(label, SPH_CASE_LABEL, *unit ? "%.39s / (%.3g %s)" : "%.39s / %.3g", what, scale,
             unit);
}
