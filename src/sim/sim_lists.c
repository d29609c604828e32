/* Phase neighbors: the lists hold every pair closer than H + skin at their build; no particle may
 * have moved by more than skin/2 since. */
#include <math.h>
#include <string.h>

#include "sim_rhs.h"

enum { PARALLEL_MIN = 4096 };

/* Largest squared displacement of a group since the build; NaN where a position is. */
static double moved2(const sph_sim *sim, int g, const sph_view *view)
{
  double *const *built = sim->sorted[g].built;
  double most = 0;
  long n = view->n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) \
    reduction(max                                                   \
              : most) if (n > PARALLEL_MIN)
  for (long i = 0; i < n; i++) {
    double d2 = 0;
    for (int d = 0; d < sim->dim; d++) {
      double step = view->x[d][i] - built[d][i];
      d2 += step * step;
    }
    if (!(d2 <= most)) most = d2 < INFINITY ? d2 : INFINITY; /* NaN counts as far */
  }
  return most;
}

static int current(const sph_evaluation *e)
{
  const sph_sim *sim = e->sim;
  if (!sim->listed) return 0;
  for (int g = 0; g < sim->groups; g++)
    if (!(moved2(sim, g, &e->view[g]) <= sim->skin * sim->skin / 4)) return 0;
  return 1;
}

static int sort(sph_evaluation *e, int g, sph_error *error)
{
  sph_sim *sim = e->sim;
  const double *x[3] = {e->view[g].x[0], e->view[g].x[1], e->view[g].x[2]};
  int status = sph_neighbors_sort(sim->neighbors, g, e->view[g].n, x, error);
  for (int d = 0; !status && d < sim->dim; d++)
    memcpy(sim->sorted[g].built[d], x[d], (size_t)e->view[g].n * sizeof(double));
  return status;
}

int sph_sim_lists_update(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (current(e)) return SPH_OK;
  sph_error error = {0};
  sim->listed = 0;
  for (int g = 0; !error.status && g < sim->groups; g++) sort(e, g, &error);
  for (int g = 0; !error.status && g < sim->groups; g++)
    for (int s = 0; !error.status && s < sim->groups; s++)
      if (sph_sim_interaction_listed(sim, sim->group[g], sim->group[s]))
        sph_neighbors_build(sim->neighbors, g, s, &error);
  if (error.status == SPH_RETRY) return sph_sim_admit_retry(sim, "%s", error.text);
  if (error.status) return sph_error_set(&sim->error, error.status, "%s", error.text);
  sim->listed = sim->fresh = 1;
  sim->list_builds++;
  return SPH_OK;
}
