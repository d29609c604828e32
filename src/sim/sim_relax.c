/* The energy that relaxation keeps (Ketcheson 2019),
 *
 *   E = sum m (v^2/2 + u + e_el(rho) + Phi(x)),
 *
 * u where a fluid integrates it, e_el for pressures of density alone, Phi of the forces that have a
 * potential; and its derivative
 *
 *   dE/dx = -m g,  dE/dv = m v,  dE/du = m,  dE/drho = m p/rho^2,
 *
 * g: the acceleration by these forces.  With the total energy per mass for u, v^2/2 is in it. */
#include "sim_relax.h"

#include <math.h>

#include "sim_rhs.h"

enum { CHUNK = 256, PARALLEL_MIN = 4096 };

static int total(const sph_group *group)
{
  return sph_group_data_energy(group) == SPH_TOTAL_ENERGY;
}

/* Rounding is the limit of relaxation: sums with what it loses (Kahan 1965). */
typedef struct sum {
  double value, lost;
} sum;

static void add(sum *s, double x)
{
  double y = x - s->lost, t = s->value + y;
  s->lost = (t - s->value) - y;
  s->value = t;
}

/* The energy of particle i; *parts grows by the magnitudes of what that consists of. */
static double energy_of(const sph_sim *sim, const sph_group *group, const sph_view *view, long i,
                        double *parts)
{
  const int elastic = !group->eos.thermal && group->eos.elastic_energy;
  double x[3] = {0}, v2 = 0, u = view->energy ? view->energy[i] : 0;
  for (int d = 0; d < sim->dim; d++) {
    x[d] = view->x[d][i];
    v2 += view->v[d][i] * view->v[d][i];
  }
  if (elastic) u += group->eos.elastic_energy(&group->eos, view->rho[i]);
  const double m = view->m[i], kinetic = total(group) ? 0 : m * v2 / 2;
  const double potential = m * sph_term_set_potential(&sim->terms, x);
  *parts += kinetic + fabs(m * u) + fabs(potential);
  return kinetic + m * u + potential;
}

/* Chunks of particles, added in order: to the energy, and to the magnitudes. */
static void add_group(const sph_sim *sim, const sph_group *group, const sph_view *view, sum *energy,
                      double *parts)
{
  const long chunks = (view->n + CHUNK - 1) / CHUNK;
  double *part = sim->sorted[group->index].sum[0]; /* free between evaluations */
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long k = 0; k < chunks; k++) {
    const long end = (k + 1) * CHUNK < view->n ? (k + 1) * CHUNK : view->n;
    sum own = {0, 0};
    double magnitudes = 0;
    for (long i = k * CHUNK; i < end; i++) add(&own, energy_of(sim, group, view, i, &magnitudes));
    part[2 * k] = own.value;
    part[2 * k + 1] = magnitudes;
  }
  for (long k = 0; k < chunks; k++) {
    add(energy, part[2 * k]);
    *parts += part[2 * k + 1];
  }
}

int sph_sim_relax_energy(N_Vector y, double *energy, double *parts, void *ctx)
{
  const sph_sim *sim = ctx;
  sum all = {0, 0};
  *parts = 0;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const sph_view view = sph_group_data_view(group, sph_nvector_data(y), NULL);
    if (!group->wall) add_group(sim, group, &view, &all, parts);
  }
  *energy = all.value;
  return *parts < INFINITY ? SPH_OK : SPH_RETRY;
}

/* The acceleration by forces with a potential, for particles that do not move, into dx. */
static int accelerate(sph_sim *sim, const sph_group *group, const sph_view *view)
{
  sph_particles s = {.dim = sim->dim, .n = view->n, .t = sim->time, .group = group->name};
  int status = SPH_OK;
  for (int d = 0; d < sim->dim; d++) {
    for (long i = 0; i < view->n; i++) view->dx[d][i] = sim->terms.g[d];
    s.x[d] = view->x[d];
    s.v[d] = view->v[d];
    s.a[d] = view->dx[d];
  }
  s.rho = view->rho;
  s.m = view->m;
  for (int k = 0; !status && k < sim->terms.called; k++) {
    const sph_term *term = &sim->terms.call[k].term;
    if (term->potential && term->body) status = term->body(term, &s);
  }
  return status;
}

/* Particles [begin, end). */
static void derive(const sph_sim *sim, const sph_group *group, const sph_view *view, long begin,
                   long end)
{
  double *p = view->p + begin, *c = view->c + begin;
  const int elastic = view->drho && !group->eos.thermal && group->eos.elastic_energy;
  if (elastic) group->eos.pressure(&group->eos, end - begin, view->rho + begin, NULL, p, c);
  for (int d = 0; d < sim->dim; d++)
    for (long i = begin; i < end; i++) {
      view->dx[d][i] *= -view->m[i];
      view->dv[d][i] = total(group) ? 0 : view->m[i] * view->v[d][i];
    }
  for (long i = begin; view->du && i < end; i++) view->du[i] = view->m[i];
  for (long i = begin; view->drho && i < end; i++)
    view->drho[i] = elastic ? view->m[i] * view->p[i] / (view->rho[i] * view->rho[i]) : 0;
}

int sph_sim_relax_gradient(N_Vector y, N_Vector gradient, void *ctx)
{
  sph_sim *sim = ctx;
  int status = SPH_OK;
  for (int g = 0; !status && g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const sph_view view =
        sph_group_data_view(group, sph_nvector_data(y), sph_nvector_data(gradient));
    if (group->wall) continue;
    status = accelerate(sim, group, &view);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view.n > PARALLEL_MIN)
    for (long i = 0; i < view.n; i += CHUNK)
      derive(sim, group, &view, i, i + CHUNK < view.n ? i + CHUNK : view.n);
    for (int q = 0; q < group->scalars; q++)
      for (long i = 0; i < view.n; i++) view.ds[q][i] = 0;
  }
  return status;
}
