/* integrator.h -- one time integrator at work: steps a problem from stop to stop.
 *
 * The caller owns y; between steps it may change it and must then call sph_integrator_reset. */
#ifndef SPH_INTEGRATOR_INTERNAL_H
#define SPH_INTEGRATOR_INTERNAL_H
#include "problem.h"
#include "sphode/checkpoint.h"
#include "sphode/integrator.h"

typedef struct sph_integrator sph_integrator;

/* Is the definition right?  Else recorded: unknown method (with the known ones), bad value. */
int sph_integrator_check(const sph_integrator_def *def, sph_error *error);

/* The definition is checked and copied.  y: the start, cloned from, borrowed until free; after
 * each step it holds the state at sph_integrator_time.  context: outlives the integrator.  NULL:
 * recorded. */
sph_integrator *sph_integrator_create(const sph_integrator_def *def, const sph_problem *problem,
                                      double t, N_Vector y, SUNContext context, sph_error *error);
void sph_integrator_free(sph_integrator *integrator);

/* One accepted step, never past t_stop, and exactly on it if it would come within rounding of it.
 * 0 or a failure (recorded in the problem's error; y is then the last good state). */
int sph_integrator_step(sph_integrator *integrator, double t_stop);
double sph_integrator_time(const sph_integrator *integrator);
/* The time before the last step: interpolation covers [previous, time]. */
double sph_integrator_previous(const sph_integrator *integrator);
/* Dense output inside the last step: cubic Hermite or ARKODE's. */
int sph_integrator_interpolate(sph_integrator *integrator, double t, N_Vector at);
/* Is there a last step?  Not at the start or after a reset. */
int sph_integrator_stepped(const sph_integrator *integrator);
/* The slope of the dense output at t in the last step; work: overwritten. */
int sph_integrator_rate(sph_integrator *integrator, double t, N_Vector rate, N_Vector work);
/* y (or the right-hand side) changed under the integrator: it starts anew. */
int sph_integrator_reset(sph_integrator *integrator, double t);
/* The same, but the first step is no longer than the next one would have been: for changes that
 * leave errors what they are. */
int sph_integrator_go_on(sph_integrator *integrator, double t);
const sph_step_stats *sph_integrator_stats(const sph_integrator *integrator);
/* All that it remembers besides y, which is there already when this is read.  Another method than
 * the one that wrote it starts anew from y. */
int sph_integrator_keep(sph_integrator *integrator, sph_keep *keep);
/* What bound the last accepted step: enum sph_bound. */
int sph_integrator_bound(const sph_integrator *integrator);

#endif
