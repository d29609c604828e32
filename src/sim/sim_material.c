/* Phase eos: pressure and sound speed of every fluid particle. */
#include <math.h>

#include "sim_energy.h"
#include "sim_failure.h"
#include "sim_rhs.h"

enum { PARALLEL_MIN = 4096, CHUNK = 2048 };

/* The first of the bad ones is told; at most n. */
static void suspect(sph_sim *sim, int g, const double *a, double least, long n)
{
  for (long i = n - 1; i >= 0; i--)
    if (!(a[i] > least && a[i] < INFINITY)) sph_sim_failure_suspect(sim, g, i);
}

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
  for (int g = 0; g < sim->groups && (e->part->eos || e->part->pairs); g++) {
    const sph_group *group = sim->group[g];
    const sph_view *view = &e->view[g];
    if (group->wall) continue;
    long n = view->n, bad = not_positive(view->rho, n, sim->threads);
    if (bad) suspect(sim, g, view->rho, 0, n);
    if (bad)
      return sph_sim_admit_retry(sim, "%s: density of %ld particles is not positive", group->name,
                                 bad);
    if (!e->part->eos) continue;
    sph_sim_energy_internal(sim, group, view);
#pragma omp parallel for num_threads(sim->threads) schedule(static) reduction(+ : bad)             \
    if (n > PARALLEL_MIN)
    for (long i = 0; i < n; i += CHUNK) {
      long some = n - i < CHUNK ? n - i : CHUNK;
      group->eos.pressure(&group->eos, some, view->rho + i, group->eos.thermal ? view->u + i : NULL,
                          view->p + i, view->c + i);
      for (long k = i; k < i + some; k++) bad += !(view->c[k] < INFINITY);
    }
    if (bad) suspect(sim, g, view->c, -INFINITY, n);
    if (bad)
      return sph_sim_admit_retry(sim, "%s: %ld particles are in no state of equation of state %s",
                                 group->name, bad, group->eos.name);
  }
  return SPH_OK;
}

static void powers(const sph_sim *sim, const sph_view *view, double *phi)
{
  const double exponent = sim->terms.phi.exponent;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long i = 0; i < view->n; i++) phi[i] = pow(view->rho[i], exponent);
}

void sph_sim_material_phi(sph_evaluation *e, int walls)
{
  const sph_sim *sim = e->sim;
  const sph_term *term = &sim->terms.phi;
  for (int g = 0; g < sim->groups; g++) {
    double *phi = sim->sorted[g].phi;
    if (!phi || sim->group[g]->wall != walls) continue;
    if (term->phi) {
      const sph_particles particles = sph_sim_bodies_particles(e, g);
      term->phi(term, &particles, phi);
    } else
      powers(sim, &e->view[g], phi);
  }
}
