/* What an integrator remembers from step to step, for checkpoints: with it the next step is the
 * same to the last bit.  Dense output inside the last step is not kept. */
#include "integrator_data.h"
#include "keep.h"

static void keep_stats(sph_step_stats *s, sph_keep *keep)
{
  long *const count[] = {&s->steps,
                         &s->rejected,
                         &s->retries,
                         &s->rhs_evaluations,
                         &s->fast_evaluations,
                         &s->fast_steps,
                         &s->fast_rejected,
                         &s->implicit_evaluations,
                         &s->solves,
                         &s->solve_iterations};
  enum { COUNTS = sizeof count / sizeof *count };
  long counts[COUNTS];
  double sizes[] = {s->dt_last, s->dt_smallest, s->dt_largest};
  for (int k = 0; k < COUNTS; k++) counts[k] = *count[k];
  sph_keep_integer(keep, "counts", COUNTS, counts);
  sph_keep_integer(keep, "bound_by", SPH_BOUND_COUNT, s->bound_by);
  sph_keep_real(keep, "dt", 3, sizes);
  for (int k = 0; k < COUNTS; k++) *count[k] = counts[k];
  s->dt_last = sizes[0];
  s->dt_smallest = sizes[1];
  s->dt_largest = sizes[2];
}

int sph_integrator_keep(sph_integrator *it, sph_keep *keep)
{
  sph_keep_real(keep, "time", 1, &it->time);
  keep_stats(&it->stats, keep);
  const int same = sph_keep_word(keep, "method", it->info.name);
  if (sph_keep_reading(keep)) {
    sph_integrator_reset(it, it->time);
    it->rejected = it->stats.rejected;
  }
  if (!same || keep->error->status) return keep->error->status; /* another one starts anew */
  sph_keep_real(keep, "dt_min", 1, &it->def.dt_min);
  sph_keep_real(keep, "limit", 1, &it->limit);
  sph_keep_real(keep, "next", 1, &it->next);
  sph_keep_real(keep, "first", 1, &it->first);
  sph_keep_real(keep, "cap", 1, &it->cap);
  sph_keep_int(keep, "cause", &it->cause);
  sph_keep_int(keep, "bound", &it->bound);
  int status = sph_keep_int(keep, "started", &it->started);
  return !status && it->started ? it->stepper->keep(it, keep) : status;
}
