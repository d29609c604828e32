/* Phase neighbors: the lists hold every pair closer than H + skin at their build; no particle may
 * have moved by more than skin/2 since. */
#include <math.h>

#include "keep.h"
#include "neighbors_sort.h"
#include "sim_mirror.h"
#include "sim_single.h"

enum { PARALLEL_MIN = 4096, COUNTED = 16 }; /* builds of which one's pairs are counted */

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
  if (!sim->listed || sph_sim_mirror_moved(sim, e->t)) return 0;
  for (int g = 0; g < sim->groups; g++)
    if (!(moved2(sim, g, &e->view[g]) <= sim->skin * sim->skin / 4)) return 0;
  return 1;
}

/* By the threads that compare them (moved2): memory is near whoever writes it first. */
static void take_down(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const long n = e->view[g].n;
  for (int d = 0; n > 0 && d < sim->dim; d++) { /* a mirror has none */
    const double *x = e->view[g].x[d];
    double *built = sim->sorted[g].built[d];
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long i = 0; i < n; i++) built[i] = x[i];
  }
}

/* Records are made behind the lists: until then their memory holds sorted positions. */
static void lend(sph_sim *sim, int g)
{
  const sph_sorted *sorted = &sim->sorted[g];
  double *x[3];
  for (int d = 0; d < 3; d++) x[d] = sorted->record + d * (sorted->room + SPH_LANES_MAX);
  sph_neighbors_sort_lend(sim->neighbors, g, x);
}

/* Order and lists of the positions in `built`. */
static int build(sph_sim *sim)
{
  sph_error error = {0};
  sim->listed = 0;
  int status = sph_sim_mirror_make(sim);
  if (status) return status;
  for (int g = 0; !error.status && g < sim->groups; g++) {
    double *const *x = sim->sorted[g].built;
    lend(sim, g);
    sph_neighbors_sort(sim->neighbors, g, sim->group[g]->n,
                       (const double *const[]){x[0], x[1], x[2]}, &error);
  }
  if (!error.status) sph_sim_mirror_find(sim);
  if (!error.status && (status = sph_sim_single_range(sim))) return status;
  for (int g = 0; !error.status && g < sim->groups; g++)
    for (int s = 0; !error.status && s < sim->groups; s++)
      if (sph_sim_interaction_listed(sim, sim->group[g], sim->group[s]))
        sph_neighbors_build(sim->neighbors, g, s, &error);
  if (error.status == SPH_RETRY) return sph_sim_admit_retry(sim, "%s", error.text);
  if (error.status) return sph_error_set(&sim->error, error.status, "%s", error.text);
  sim->listed = 1;
  sim->fresh |= sim->list_builds++ % COUNTED == 0;
  return SPH_OK;
}

/* Their number, and where their fields are, changed with the build. */
static void look_anew(sph_evaluation *e)
{
  const sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups; g++)
    if (sim->group[g]->model == SPH_MODEL_MIRROR) {
      e->view[g] = sph_group_data_view(sim->group[g], NULL, NULL);
      sph_sim_mirror_place(e, g);
    }
}

int sph_sim_lists_update(sph_evaluation *e)
{
  if (current(e)) return SPH_OK;
  for (int g = 0; g < e->sim->groups; g++) take_down(e, g);
  sph_sim_mirror_stand(e->sim, e->t);
  int status = build(e->sim);
  if (!status) look_anew(e);
  return status;
}

/* The order of particles, and so the bits of sums, is that of the last build: it is made again from
 * its positions. */
int sph_sim_lists_keep(sph_sim *sim, sph_keep *keep)
{
  static const char *const axis[3] = {"x", "y", "z"};
  int listed = sim->listed, status = sph_keep_int(keep, "listed", &listed);
  sph_keep_enter(keep, "group");
  for (int g = 0; !status && listed && g < sim->groups; g++) {
    const int mirror = sim->group[g]->model == SPH_MODEL_MIRROR; /* its ghosts are made again */
    sph_keep_enter(keep, sim->group[g]->name);
    if (mirror) status = sph_keep_real(keep, "placed", 3, sim->group[g]->placed);
    for (int d = 0; !mirror && d < sim->dim && d < 3; d++)
      status = sph_keep_real(keep, axis[d], sim->group[g]->n, sim->sorted[g].built[d]);
    sph_keep_leave(keep);
  }
  sph_keep_leave(keep);
  if (!status && keep->reading) {
    sim->listed = 0;
    if (listed && build(sim))
      status = sph_error_set(keep->error, SPH_ERR_FILE, "its particles have no neighbours: %s",
                             sim->error.status ? sim->error.text : sim->retry);
  }
  sph_keep_int(keep, "fresh", &sim->fresh);
  sph_keep_integer(keep, "builds", 1, &sim->list_builds);
  sph_keep_integer(keep, "near", 1, &sim->near);
  return status ? status : sph_keep_real(keep, "pairs", 1, &sim->pairs_now);
}
