/* Phase bodies: starts all rates (dx/dt = v and dv/dt = g in the parts that have them, the others
 * zero) and adds the body terms. */
#include <math.h>

#include "sim_rhs.h"

enum { PARALLEL_MIN = 4096 };

static void start(const sph_evaluation *e, const sph_view *view)
{
  const sph_sim *sim = e->sim;
  const sph_part *part = e->part;
  const int moves = part->positions, gravity = part->gravity;
  const double *g = sim->terms.g;
  long n = view->n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long i = 0; i < n; i++) {
    for (int d = 0; d < sim->dim; d++) {
      if (!e->still) view->dx[d][i] = moves ? view->v[d][i] : 0;
      view->dv[d][i] = gravity ? g[d] : 0;
    }
    if (view->drho) view->drho[i] = 0;
    if (view->du) view->du[i] = 0;
    for (int q = 0; q < sim->terms.scalars; q++) view->ds[q][i] = 0;
  }
}

sph_particles sph_sim_bodies_particles(const sph_evaluation *e, int g)
{
  const sph_view *view = &e->view[g];
  sph_particles s = {.dim = e->sim->dim, .n = view->n, .t = e->t, .group = e->sim->group[g]->name};
  for (int d = 0; d < s.dim; d++) {
    s.x[d] = view->x[d];
    s.v[d] = view->v[d];
    s.a[d] = view->dv[d];
  }
  s.rho = view->rho;
  s.u = view->u;
  s.p = view->p;
  s.c = view->c;
  s.m = view->m;
  s.drho = view->drho;
  s.du = view->du;
  return s;
}

static int body(sph_evaluation *e, const sph_term *term, const sph_particles *s)
{
  sph_sim *sim = e->sim;
  int status = term->body ? term->body(term, s) : SPH_OK;
  if (status > 0) return sph_sim_admit_retry(sim, "term %s asks for a smaller step", term->name);
  if (status < 0)
    return sph_error_set(&sim->error, status, "term %s failed at t = %g s in group %s", term->name,
                         s->t, s->group);
  return SPH_OK;
}

static int limit(sph_evaluation *e, const sph_term *term, const sph_particles *s)
{
  double limit = term->dt_max ? term->dt_max(term, s) : INFINITY;
  if (!(limit > 0))
    return sph_error_set(&e->sim->error, SPH_ERR_ARGUMENT, "term %s: dt_max gave %g; right is > 0",
                         term->name, limit);
  e->limit_user = fmin(e->limit_user, limit);
  return SPH_OK;
}

static int add(sph_evaluation *e, int g, int k)
{
  const sph_called_term *call = &e->sim->terms.call[k];
  const sph_view *view = &e->view[g];
  sph_particles s = sph_sim_bodies_particles(e, g);
  s.s = call->scalar < 0 ? NULL : view->s[call->scalar];
  s.ds = call->scalar < 0 ? NULL : view->ds[call->scalar];
  int status = body(e, &call->term, &s);
  if (!status && (e->part->limit_called >> k & 1)) status = limit(e, &call->term, &s);
  return status;
}

int sph_sim_bodies_add(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  int status = SPH_OK;
  e->limit_user = INFINITY;
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall) continue;
    start(e, &e->view[g]);
    for (int k = 0; !status && k < sim->terms.called; k++)
      if (e->part->called >> k & 1) status = add(e, g, k);
  }
  return status;
}
