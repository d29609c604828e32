/* Phase eos: pressure and sound speed of every fluid particle. */
#include <math.h>

#include "sim_rhs.h"

enum { PARALLEL_MIN = 4096, CHUNK = 2048 };

/* Entries of a[n] that are not > 0 and finite. */
static long not_positive(const double *a, long n, int threads)
{
  long bad = 0;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(+ : bad)                  \
    if (n > PARALLEL_MIN)
  for (long i = 0; i < n; i++) bad += !(a[i] > 0 && a[i] < INFINITY);
  return bad;
}

int sph_sim_material_eos(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const sph_view *view = &e->view[g];
    if (group->wall) continue;
    long n = view->n, bad = not_positive(view->rho, n, sim->threads);
    if (bad)
      return sph_sim_admit_retry(sim, "%s: density of %ld particles is not positive", group->name,
                                 bad);
    if (view->u && (bad = not_positive(view->u, n, sim->threads)))
      return sph_sim_admit_retry(sim, "%s: internal energy of %ld particles is not positive",
                                 group->name, bad);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long i = 0; i < n; i += CHUNK)
      group->eos.pressure(&group->eos, n - i < CHUNK ? n - i : CHUNK, view->rho + i,
                          view->u ? view->u + i : NULL, view->p + i, view->c + i);
  }
  return SPH_OK;
}
