/* fast.h -- steps the fast part of a multirate problem from one slow stage to the next:
 *
 *   y' = f_fast(t, y) + sum_k theta^k r_k,   theta = (t - shift)/scale,
 *
 * r_k: what the slow stages so far do to it.  Explicit Runge-Kutta tables, with steps of a given
 * size, by error control, or by the problem's limits. */
#ifndef SPH_FAST_H
#define SPH_FAST_H
#include "integrator_data.h"

enum { SPH_FAST_RATES_MAX = 8 };

typedef struct sph_fast_rates {
  double shift, scale; /* [s] */
  int n;               /* at most SPH_FAST_RATES_MAX */
  N_Vector *rate;      /* [n] */
} sph_fast_rates;

typedef struct sph_fast sph_fast;

/* With the table it->def.fast_method, or without one that of the least stages with that order.
 * NULL: recorded. */
sph_fast *sph_fast_create(sph_integrator *it, int order);
void sph_fast_free(sph_fast *fast); /* NULL is fine */

/* From y = y(t0) to y(t1), t1 > t0.  A status; > 0: the fast part asks for shorter slow steps. */
int sph_fast_evolve(sph_fast *fast, const sph_fast_rates *rates, double t0, double t1, N_Vector y);
/* f_fast(t, y), for ARKODE's dense output. */
int sph_fast_rhs(sph_fast *fast, double t, N_Vector y, N_Vector ydot);
/* Step sizes so far say nothing of what follows. */
void sph_fast_reset(sph_fast *fast);
int sph_fast_keep(sph_fast *fast, sph_keep *keep); /* they, for checkpoints */

/* Is def right for the fast part, or without one says nothing of it?  Else recorded. */
int sph_fast_check(const sph_integrator_def *def, int has_fast, sph_error *error);

#endif
