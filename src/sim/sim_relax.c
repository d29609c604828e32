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

#include <float.h>
#include <math.h>
#include <string.h>

#include "sim_rhs.h"

enum { CHUNK = 256, PARALLEL_MIN = 4096 };

static int total(const sph_group *group)
{
  return sph_group_data_energy(group) == SPH_TOTAL_ENERGY;
}

/* What the energy differs by between two states; magnitudes of what it consists of; their squares,
 * particle by particle; sum m |v - v0|^2/2, with which the change is quadratic. */
enum { CHANGE, PARTS, SQUARES, MOTION, SUMS };

/* Of some particles: differences one by one, since of E itself steps change the last digits
 * only. */
typedef struct chunk {
  double change[CHUNK], parts[CHUNK], moved[CHUNK]; /* per mass */
} chunk;

static void add_motion(const double *v0, const double *v, long n, chunk *c)
{
  for (long i = 0; i < n; i++) {
    const double step = v[i] - v0[i];
    c->change[i] += step * (v[i] + v0[i]) / 2;
    c->parts[i] += v[i] * v[i] / 2;
    c->moved[i] += step * step / 2;
  }
}

static void add_internal(const double *u0, const double *u, long n, chunk *c)
{
  for (long i = 0; i < n; i++) {
    c->change[i] += u[i] - u0[i];
    c->parts[i] += fabs(u[i]);
  }
}

/* p/rho is what rounding of rho makes of it; p may be that of a state nearby. */
static void add_elastic(const sph_eos *eos, const double *rho0, const double *rho, const double *p,
                        long n, chunk *c)
{
  for (long i = 0; i < n; i++) {
    const double e = eos->elastic_energy(eos, rho[i]);
    c->change[i] += e - eos->elastic_energy(eos, rho0[i]);
    c->parts[i] += fabs(e) + fabs(p[i]) / rho[i];
  }
}

static void add_potential(const sph_sim *sim, const sph_view *from, const sph_view *to, long begin,
                          long n, chunk *c)
{
  for (long i = 0; i < n; i++) {
    double x0[3] = {0}, x[3] = {0};
    for (int d = 0; d < sim->dim; d++) {
      x0[d] = from->x[d][begin + i];
      x[d] = to->x[d][begin + i];
    }
    const double potential = sph_term_set_potential(&sim->terms, x);
    c->change[i] += potential - sph_term_set_potential(&sim->terms, x0);
    c->parts[i] += fabs(potential);
  }
}

static void add_chunk(const sph_sim *sim, const sph_group *group, const sph_view *from,
                      const sph_view *to, long begin, long end, double sum[SUMS])
{
  const long n = end - begin;
  const double *m = to->m + begin;
  chunk c = {{0}, {0}, {0}};
  for (int d = 0; d < sim->dim && !total(group); d++)
    add_motion(from->v[d] + begin, to->v[d] + begin, n, &c);
  if (to->energy) add_internal(from->energy + begin, to->energy + begin, n, &c);
  if (!group->eos.thermal && group->eos.elastic_energy)
    add_elastic(&group->eos, from->rho + begin, to->rho + begin, to->p + begin, n, &c);
  if (sim->terms.uniform || sim->terms.called > 0) add_potential(sim, from, to, begin, n, &c);
  for (long i = 0; i < n; i++) {
    sum[CHANGE] += m[i] * c.change[i];
    sum[PARTS] += m[i] * c.parts[i];
    sum[SQUARES] += m[i] * c.parts[i] * m[i] * c.parts[i];
    sum[MOTION] += m[i] * c.moved[i];
  }
}

/* Chunks of particles, added in order. */
static void add_group(const sph_sim *sim, const sph_group *group, const sph_view *from,
                      const sph_view *to, double all[SUMS])
{
  const long n = to->n, chunks = (n + CHUNK - 1) / CHUNK;
  double *part = sim->sorted[group->index].sum[0]; /* free between evaluations */
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long k = 0; k < chunks; k++) {
    const long end = (k + 1) * CHUNK < n ? (k + 1) * CHUNK : n;
    double own[SUMS] = {0};
    add_chunk(sim, group, from, to, k * CHUNK, end, own);
    memcpy(part + SUMS * k, own, sizeof own);
  }
  for (long k = 0; k < SUMS * chunks; k++) all[k % SUMS] += part[k];
}

/* What is left of E by rounding: that of particles is independent, as a rule, and adds up as the
 * root of squares.  Where the step hardly moves anything, all may round alike, and no change of the
 * step's length would mend that: then the sum. */
static double rounding_of(const double sum[SUMS])
{
  const double at_worst = 4 * DBL_EPSILON * sum[PARTS];
  return sum[MOTION] > 1e3 * at_worst ? DBL_EPSILON * sqrt(sum[SQUARES]) : at_worst;
}

int sph_sim_relax_energy(N_Vector y0, N_Vector y, double *change, double *rounding, void *ctx)
{
  const sph_sim *sim = ctx;
  double all[SUMS] = {0};
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (group->wall) continue;
    const sph_view from = sph_group_data_view(group, sph_nvector_data(y0), NULL);
    const sph_view to = sph_group_data_view(group, sph_nvector_data(y), NULL);
    add_group(sim, group, &from, &to, all);
  }
  *change = all[CHANGE];
  *rounding = rounding_of(all);
  return all[PARTS] < INFINITY && isfinite(all[CHANGE]) ? SPH_OK : SPH_RETRY;
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
