#include "root.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include <math.h>

#include "gsl.h"

static const double CLOSE = 1e-12; /* of the interval */
enum { MOST = 200 };               /* evaluations: a bisection needs 40 */

/* The change of sign lies in (low, high], where s = 0 is a and s = 1 is b. */
typedef struct search {
  sph_root_function *value;
  void *ctx;
  double a, b, value_a, value_b;
  double low, high;
  double exact; /* a root where the value is zero; 2: none yet */
  int status;
} search;

static double time_of(const search *r, double s) { return fmin(r->a + s * (r->b - r->a), r->b); }

/* What GSL sees: always finite. */
static double value_at(double s, void *data)
{
  search *r = data;
  double value = 0;
  if (s <= 0) return r->value_a;
  if (s >= 1) return r->value_b;
  if (!r->status) r->status = r->value(r->ctx, time_of(r, s), &value);
  if (r->status || !isfinite(value)) return 0;
  if (value == 0 || (value > 0) == (r->value_b > 0)) {
    r->high = fmin(r->high, s);
    if (value == 0) r->exact = s;
  } else if (s < r->high) {
    r->low = fmax(r->low, s);
  }
  return value;
}

static int narrow(search *r, gsl_root_fsolver *solver, gsl_function *function)
{
  double close = fmax(CLOSE, 2 * DBL_EPSILON * fmax(fabs(r->a), fabs(r->b)) / (r->b - r->a));
  int failed = gsl_root_fsolver_set(solver, function, 0, 1);
  for (int k = 0; !failed && !r->status && k < MOST; k++) {
    if (r->high - r->low <= close || r->exact == r->high) break;
    failed = gsl_root_fsolver_iterate(solver);
  }
  return failed;
}

int sph_root_find(sph_root_function *value, void *ctx, double a, double value_a, double b,
                  double value_b, double *t, sph_error *error)
{
  search r = {.value = value, .ctx = ctx, .a = a, .b = b, .value_a = value_a, .value_b = value_b};
  gsl_function function = {value_at, &r};
  r.high = 1;
  r.exact = 2;
  *t = b;
  if (value_b == 0) return SPH_OK;
  sph_gsl_begin();
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  sph_gsl_end();
  if (!solver) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: the search of a root");
  /* The user's functions run without the lock: finite values with a change of sign raise no error
   * in GSL. */
  int failed = narrow(&r, solver, &function);
  gsl_root_fsolver_free(solver);
  if (r.status) return r.status;
  if (failed)
    return sph_error_set(error, SPH_ERR_STEP, "no root in %.9g to %.9g s: %s", a, b,
                         gsl_strerror(failed));
  if (r.high < 1) *t = time_of(&r, r.high);
  return SPH_OK;
}
