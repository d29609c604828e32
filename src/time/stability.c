/* Stability regions of the integrators, by rays from the origin. */
#include <complex.h>
#include <math.h>
#include <stddef.h>

#include "integrator_data.h"
#include "integrator_table.h"
#include "memory.h"
#include "nvector.h"

static const double GROWTH = 1.001; /* a step */
static const double FARTHEST = 50;  /* |z| */
enum { RAYS = 90 };                 /* of a quarter */

/* ---- Runge-Kutta: R(z) = 1 + z sum_i b_i Y_i,  Y_i = 1 + z sum_j a_ij Y_j ---- */

static double amplification(const struct ARKodeButcherTableMem *table, double complex z)
{
  enum { STAGES = 32 };
  double complex Y[STAGES], R = 1;
  for (int i = 0; i < table->stages && i < STAGES; i++) {
    Y[i] = 1;
    for (int j = 0; j < i; j++) Y[i] += z * table->A[i][j] * Y[j];
    R += z * table->b[i] * Y[i];
  }
  return cabs(R);
}

/* ---- our own schemes: the oscillator itself is stepped ---- */

/* v' = a v - b u, u' = b v + a u: lambda = a +- i b, two entries of a vector. */
typedef struct oscillator {
  double a, b;
  sph_segment segment[2];
  sph_layout layout;
  SUNContext context;
  N_Vector y;
  sph_integrator *it;
} oscillator;

static int rhs(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  const oscillator *o = ctx;
  const double *at = sph_nvector_data(y);
  double *to = sph_nvector_data(ydot);
  (void)t;
  to[0] = o->a * at[0] - o->b * at[8];
  to[8] = o->b * at[0] + o->a * at[8];
  return 0;
}

static int create(oscillator *o, const char *method, sph_error *error)
{
  const sph_integrator_def def = {.method = method, .dt_fixed = 1};
  const sph_problem problem = {.ctx = o, .threads = 1, .rhs = rhs, .error = error};
  *o = (oscillator){.segment = {{0, 1, 8, SPH_ROLE_VELOCITY, -1}, {8, 1, 8, SPH_ROLE_OTHER, -1}}};
  o->layout = (sph_layout){16, 2, 2, o->segment};
  o->context = sph_sundials_context(error);
  o->y = o->context ? sph_nvector_create(&o->layout, 1, o->context, error) : NULL;
  if (o->y) o->it = sph_integrator_create(&def, &problem, 0, o->y, o->context, error);
  return o->it ? SPH_OK : SPH_ERR_MEMORY;
}

static void destroy(oscillator *o)
{
  sph_integrator_free(o->it);
  if (o->y) N_VDestroy(o->y);
  sph_sundials_context_free(o->context);
}

/* Amplification of a step of size 1: the largest state of the last third of 96 steps over that of
 * the first, which wipes out where on its ellipse it is. */
static double measured(oscillator *o, double complex z)
{
  enum { STEPS = 96 };
  double *y = sph_nvector_data(o->y), early = 0, late = 0;
  o->a = creal(z), o->b = cimag(z);
  y[0] = 1, y[8] = 0.5;
  sph_integrator_reset(o->it, 0);
  for (int k = 0; k < STEPS; k++) {
    if (sph_integrator_step(o->it, k + 1)) break;
    double size = hypot(y[0], y[8]);
    if (!(size < 100)) return INFINITY;
    if (k < STEPS / 3) early = fmax(early, size);
    if (k >= STEPS - STEPS / 3) late = fmax(late, size);
  }
  return pow(late / early, 1.5 / STEPS);
}

/* ---- rays ---- */

typedef struct region {
  ARKodeButcherTable table; /* NULL: measured */
  oscillator o;
  sph_error error;
} region;

static int open_region(region *r, const char *method)
{
  *r = (region){0};
  int k = sph_integrator_table_find(method, &r->error);
  if (k < 0) return SPH_ERR_ARGUMENT;
  r->table = sph_integrator_table_butcher(k);
  if (r->table) return SPH_OK;
  if (!sph_integrator_table_scheme(k)) return SPH_ERR_ARGUMENT;
  return create(&r->o, method, &r->error);
}

static void close_region(region *r)
{
  if (r->table) ARKodeButcherTable_Free(r->table);
  destroy(&r->o);
}

static int stable(region *r, double complex z)
{
  double growth = r->table ? amplification(r->table, z) : measured(&r->o, z);
  return growth <= GROWTH;
}

static double extent(region *r, double angle)
{
  const double complex ray = cos(angle) + I * fmax(sin(angle), 0);
  const double stride = r->table ? 0.02 : 0.1;
  double good = 0, bad = stride;
  while (bad < FARTHEST && stable(r, bad * ray)) good = bad, bad += stride;
  for (int k = 0; k < 12; k++) {
    double middle = (good + bad) / 2;
    if (stable(r, middle * ray))
      good = middle;
    else
      bad = middle;
  }
  return good;
}

double sph_stability_extent(const char *method, double angle)
{
  region r;
  double found = NAN;
  if (!open_region(&r, method) && angle >= 0 && angle <= 4) found = extent(&r, angle);
  close_region(&r);
  return r.error.status ? NAN : found;
}

/* Rays of every degree are found once; between two of them the shorter one counts. */
double sph_stability_step(const char *method, long n, const double *re, const double *im)
{
  const double pi = acos(-1), step = pi / 2 / RAYS;
  double ray[RAYS + 1], longest = INFINITY;
  region r;
  int status = open_region(&r, method);
  for (int k = 0; k <= RAYS; k++) ray[k] = -1;
  for (long i = 0; !status && i < n; i++) {
    double size = hypot(re[i], im[i]);
    if (size == 0) continue;
    double angle = atan2(fabs(im[i]), fmin(re[i], 0)) - pi / 2;
    int k = (int)fmin(fmax(angle / step, 0), RAYS - 1);
    for (int q = k; q <= k + 1; q++)
      if (ray[q] < 0) ray[q] = extent(&r, pi / 2 + q * step);
    longest = fmin(longest, fmin(ray[k], ray[k + 1]) / size);
  }
  close_region(&r);
  return status || r.error.status ? NAN : longest;
}
