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
static long not_positive(const double *a, long n)
{
  long bad = 0;
  for (long i = 0; i < n; i++) bad += !(a[i] > 0 && a[i] < INFINITY);
  return bad;
}

/* Of particles begin .. end - 1, whose densities are right: how many are in no state of it. */
static long find(const sph_group *group, const sph_view *view, long begin, long end)
{
  long lost = 0;
  sph_sim_energy_internal_of(group, view, begin, end);
  group->eos.pressure(&group->eos, end - begin, view->rho + begin,
                      group->eos.thermal ? view->u + begin : NULL, view->p + begin,
                      view->c + begin);
  for (long k = begin; k < end; k++) lost += !(view->c[k] < INFINITY);
  return lost;
}

/* All of a group in one sweep: densities are looked at where they are used. */
static int find_all(sph_evaluation *e, int g)
{
  sph_sim *sim = e->sim;
  const sph_group *group = sim->group[g];
  const sph_view *view = &e->view[g];
  const long n = view->n;
  long bad = 0, lost = 0;
#pragma omp parallel for num_threads(sim->threads) schedule(static) reduction(+ : bad, lost)       \
    if (n > PARALLEL_MIN)
  for (long i = 0; i < n; i += CHUNK) {
    const long end = n - i < CHUNK ? n : i + CHUNK, wrong = not_positive(view->rho + i, end - i);
    bad += wrong;
    if (!wrong && e->part->eos) lost += find(group, view, i, end);
  }
  if (bad) suspect(sim, g, view->rho, 0, n);
  if (bad)
    return sph_sim_admit_retry(sim, "%s: density of %ld particles is not positive", group->name,
                               bad);
  if (lost) suspect(sim, g, view->c, -INFINITY, n);
  if (lost)
    return sph_sim_admit_retry(sim, "%s: %ld particles are in no state of equation of state %s",
                               group->name, lost, group->eos.name);
  return SPH_OK;
}

int sph_sim_material_eos(sph_evaluation *e)
{
  const sph_sim *sim = e->sim;
  int status = SPH_OK;
  for (int g = 0; !status && g < sim->groups && (e->part->eos || e->part->pairs); g++)
    if (!sim->group[g]->wall) status = find_all(e, g);
  return status;
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
