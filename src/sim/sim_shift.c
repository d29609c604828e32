/* Phase shift: particles move with v + dv, by shifting or the transport velocity (shift_pair.h),
 * and density and velocity follow.
 *
 *   shifting            dv_i = -2 s h U sum V_j (1 + R (W/W(dx))^4) grad W, at most U/2
 *   transport-velocity  dv_i = -tau p_b/m_i sum (V_i^2 + V_j^2) grad W
 *
 * Free surfaces (shifting): a particle is alone where the least eigenvalue of M is under 0.2, and
 * does not shift; at the surface where it is under 0.75 and nobody is in the cone around the normal
 * (Marrone et al. 2010).  Who has a particle at the surface in reach moves along it only:
 * dv - (dv.n) n, n the mean of the normals there.  f jumps where that changes. */
#include <math.h>
#include <string.h>

#include "shift_loops.h"
#include "sim_mirror.h"
#include "sim_parts.h"
#include "sim_rhs.h"

static const double ALONE = 0.2, INSIDE = 0.75; /* least eigenvalues */
enum { PARALLEL_MIN = 2048 };

static int fluid(const sph_group *group) { return !group->wall && !group->eos.dust; }

/* Where none is kept, it is looked for at the start alone, to tell. */
static int keeps_surface(const sph_sim *sim)
{
  return (sim->loop_terms & SPH_SHIFTING) && sim->terms.shift.surface;
}

static shift_constants constants_of(const sph_sim *sim)
{
  const sph_term *term = &sim->terms.shift;
  const double L = sph_kernel_support(sim->kernel) * sim->h / 2;
  const double near = sph_kernel_w(sim->kernel, sim->dim, sim->dx, sim->h) / sim->W_scale;
  const int transport = (sim->loop_terms & SPH_TRANSPORT) != 0;
  return (shift_constants){.inverse_h = 1 / sim->h,
                           .crowd = term->crowding > 0 ? term->crowding / pow(near, 4) : 0,
                           .L = L,
                           .L2 = L * L,
                           .transport = transport,
                           .kernel = sim->kernel_number,
                           .surface = !sim->prepared || keeps_surface(sim),
                           .corrected = (sim->loop_terms & SPH_CONTINUITY_CORRECTED) != 0};
}

double sph_sim_shift_speed(const sph_sim *sim, const sph_group *group)
{
  const sph_term *term = &sim->terms.shift;
  const sph_eos *eos = &group->eos;
  if (sim->loop_terms & SPH_SHIFTING) return term->strength * term->speed;
  if (!(sim->loop_terms & SPH_TRANSPORT)) return 0;
  const double tau = term->time > 0 ? term->time : 0.1 * sim->h / eos->c0;
  const double p_b = term->background > 0 ? term->background : eos->rho0 * eos->c0 * eos->c0;
  return tau * p_b / (eos->rho0 * sim->h);
}

/* One of the passes, over all that are listed with group g. */
static void pass(sph_sim *sim, const shift_constants *k, int number, int sums, int g)
{
  sph_pair_function *loop = sph_shift_loop(sim->isa, sim->kernel_number, sim->dim, number);
  sph_sim_pairs_clear(sim, g, sums);
  for (int s = 0; s < sim->groups; s++) {
    shift_constants of = *k;
    of.wall = sim->group[s]->wall && !sph_sim_mirror_slips(sim->group[s]);
    if (sph_sim_interaction_same_species(sim->group[g], sim->group[s]))
      sph_sim_pairs_loop_records(sim, loop, g, s, sim->sorted[g].shifted, sim->sorted[s].shifted,
                                 shift_slots(sim->dim), &of);
  }
}

/* ---- records */

/* x v rho V of sorted place s; the rest zero. */
static void start(const sph_sim *sim, int g, long s)
{
  const int dim = sim->dim;
  const sph_sorted *sorted = &sim->sorted[g];
  const double *from = sorted->record + s * sorted->stride;
  double *to = sorted->shifted + s * shift_slots(dim);
  memset(to, 0, (size_t)shift_slots(dim) * sizeof *to);
  memcpy(to, from, 2 * (size_t)dim * sizeof *to);
  to[shift_rho(dim)] = from[slot_rho(dim)];
  to[shift_V(dim)] = from[slot_V(dim)];
}

/* The lanes behind the last particle hold copies of it. */
static void finish_tail(const sph_sim *sim, int g, long n)
{
  const sph_sorted *sorted = &sim->sorted[g];
  const size_t slots = (size_t)shift_slots(sim->dim);
  for (long s = n; n > 0 && s < sorted->room; s++)
    memcpy(sorted->shifted + (size_t)s * slots, sorted->shifted + (size_t)(n - 1) * slots,
           slots * sizeof(double));
}

/* Images have dv, normal and flag of their particles, reflected. */
static void show_images(const sph_evaluation *e)
{
  const sph_sim *sim = e->sim;
  const int dim = sim->dim, slots = shift_slots(dim);
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (!sph_sim_mirror_slips(group)) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (e->view[g].n > PARALLEL_MIN)
    for (long s = 0; s < e->view[g].n; s++) {
      const sph_ghost *ghost = &group->ghost[order[s]];
      const double *from =
          sim->sorted[ghost->group].shifted + sph_sim_mirror_parent(sim, ghost) * slots;
      double *to = sim->sorted[g].shifted + s * slots;
      for (int k = shift_drift(dim); k < slots; k++) to[k] = from[k];
      sph_sim_mirror_turn(sim, ghost, to + shift_drift(dim));
      sph_sim_mirror_turn(sim, ghost, to + shift_normal(dim));
    }
    finish_tail(sim, g, e->view[g].n);
  }
}

/* ---- where a free surface is */

static double length_of(int dim, const double *a)
{
  double sum = 0;
  for (int d = 0; d < dim; d++) sum += a[d] * a[d];
  return sqrt(sum);
}

static void scale(int dim, double *a, double factor)
{
  for (int d = 0; d < dim; d++) a[d] *= factor;
}

/* Flag and normal of a candidate; alone: no shift. */
static void find_candidate(const sph_sim *sim, int g, long s, double *record)
{
  const int dim = sim->dim;
  double *const *sum = sim->sorted[g].sum;
  double M[3][3], L[3][3], *normal = record + shift_normal(dim);
  int k = 2 * dim;
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++) M[a][b] = M[b][a] = sim->F_scale * sum[k++][s];
  if (sph_sim_gradients_cholesky(dim, M, INSIDE, L)) return;
  if (!sph_sim_gradients_cholesky(dim, M, ALONE, L)) {
    if (keeps_surface(sim)) scale(dim, record + shift_drift(dim), 0);
    return;
  }
  double n[3] = {0};
  for (int d = 0; d < dim; d++) n[d] = -sum[dim + d][s];
  if (sph_sim_gradients_cholesky(dim, M, 0, L)) sph_sim_gradients_solve(dim, L, n);
  const double length = length_of(dim, n);
  for (int d = 0; d < dim && length > 0; d++) normal[d] = n[d] / length;
  record[shift_flag(dim)] = 1;
}

/* dv keeps what is along the surface. */
static void project(const sph_sim *sim, int g, long s)
{
  const int dim = sim->dim;
  double *const *sum = sim->sorted[g].sum;
  double *drift = sim->sorted[g].shifted + s * shift_slots(dim) + shift_drift(dim);
  double n[3] = {0}, along = 0;
  if (!(sum[SHIFT_NEAR][s] > 0)) return;
  for (int d = 0; d < dim; d++) n[d] = sum[SHIFT_NORMAL + d][s];
  const double length = length_of(dim, n);
  if (!(length > 0)) scale(dim, drift, 0); /* a film */
  for (int d = 0; d < dim && length > 0; d++) along += drift[d] * n[d] / length;
  for (int d = 0; d < dim && length > 0; d++) drift[d] -= along * n[d] / length;
}

static void find_surface(sph_evaluation *e, const shift_constants *k)
{
  sph_sim *sim = e->sim;
  const int dim = sim->dim, slots = shift_slots(dim);
  sim->surface = 0;
  for (int g = 0; g < sim->groups; g++) {
    if (!fluid(sim->group[g])) continue;
    pass(sim, k, SPH_SHIFT_covered, SHIFT_COVERED_SUMS, g);
    long open = 0;
#pragma omp parallel for num_threads(sim->threads) schedule(static) reduction(+ : open)            \
    if (e->view[g].n > PARALLEL_MIN)
    for (long s = 0; s < e->view[g].n; s++) {
      double *flag = sim->sorted[g].shifted + s * slots + shift_flag(dim);
      if (sim->sorted[g].sum[0][s] > 0) *flag = 0;
      open += *flag > 0;
    }
    sim->surface += open;
    finish_tail(sim, g, e->view[g].n);
  }
}

static void keep_surface(sph_evaluation *e, const shift_constants *k)
{
  sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups && sim->surface > 0; g++) {
    if (!fluid(sim->group[g])) continue;
    pass(sim, k, SPH_SHIFT_near, 1 + sim->dim, g);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (e->view[g].n > PARALLEL_MIN)
    for (long s = 0; s < e->view[g].n; s++) project(sim, g, s);
  }
}

/* ---- rates */

/* dv before any surface. */
static void find_drift(const sph_sim *sim, int g, long s)
{
  const int dim = sim->dim, shifting = (sim->loop_terms & SPH_SHIFTING) != 0;
  const double U = sph_sim_shift_speed(sim, sim->group[g]);
  const double D = (shifting ? 2 : sim->group[g]->eos.rho0) * sim->h * U * sim->F_scale;
  double *drift = sim->sorted[g].shifted + s * shift_slots(dim) + shift_drift(dim);
  for (int d = 0; d < dim; d++) drift[d] = -D * sim->sorted[g].sum[d][s];
  const double length = length_of(dim, drift), most = 0.5 * sim->terms.shift.speed;
  if (shifting && length > most) scale(dim, drift, most / length);
}

static void find_drifts(sph_evaluation *e, const shift_constants *k, int g)
{
  sph_sim *sim = e->sim;
  const int dim = sim->dim;
  pass(sim, k, SPH_SHIFT_concentration, shift_concentration_sums(dim), g);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (e->view[g].n > PARALLEL_MIN)
  for (long s = 0; s < e->view[g].n; s++) {
    find_drift(sim, g, s);
    if (k->surface) find_candidate(sim, g, s, sim->sorted[g].shifted + s * shift_slots(dim));
  }
}

static void start_all(const sph_evaluation *e)
{
  const sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups; g++) {
    const long n = e->view[g].n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long s = 0; s < n; s++) start(sim, g, s);
    finish_tail(sim, g, n);
  }
}

static void add_drift(sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const int dim = sim->dim, *order = sph_neighbors_order(sim->neighbors, g);
  const sph_view *view = &e->view[g];
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long s = 0; s < view->n; s++)
    for (int d = 0; d < dim; d++)
      view->dx[d][order[s]] += sim->sorted[g].shifted[s * shift_slots(dim) + shift_drift(dim) + d];
}

static void add_advection(sph_evaluation *e, const shift_constants *k, int g)
{
  sph_sim *sim = e->sim;
  const int dim = sim->dim, *order = sph_neighbors_order(sim->neighbors, g);
  const sph_view *view = &e->view[g];
  double *const *sum = sim->sorted[g].sum;
  pass(sim, k, SPH_SHIFT_advection, 1 + dim, g);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long s = 0; s < view->n; s++) {
    const long i = order[s];
    for (int d = 0; d < dim; d++) view->dv[d][i] += sim->F_scale * sum[SHIFT_A + d][s];
    if (view->drho) view->drho[i] += sim->F_scale * sum[SHIFT_DRHO][s];
  }
}

int sph_sim_shift_add(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (!e->part->shift) return SPH_OK;
  const shift_constants k = constants_of(sim);
  start_all(e);
  for (int g = 0; g < sim->groups; g++)
    if (fluid(sim->group[g])) find_drifts(e, &k, g);
  if (k.surface) find_surface(e, &k);
  if (keeps_surface(sim)) {
    show_images(e);
    keep_surface(e, &k);
  }
  for (int g = 0; g < sim->groups; g++)
    if (fluid(sim->group[g])) finish_tail(sim, g, e->view[g].n);
  show_images(e);
  for (int g = 0; g < sim->groups; g++) {
    if (!fluid(sim->group[g])) continue;
    add_drift(e, g);
    if (sim->terms.shift.advection) add_advection(e, &k, g);
  }
  return SPH_OK;
}

/* ---- between steps */

/* The displacement that the rates would have made since the last one: y += tau f_shift.  Explicit:
 * neighbours part at rates of up to 8 U/h, and what crowds is not to pass by. */
int sph_sim_shift_step(void *ctx, sph_sim *sim)
{
  sph_part part;
  double tau = INFINITY;
  (void)ctx;
  if (!(sim->terms.bits & sim->loop_terms & SPH_SHIFTING)) return 0;
  for (int k = 0; k < sim->modifiers; k++)
    if (sim->modifier[k].modifier.modify == sph_sim_shift_step) {
      tau = sim->time - sim->modifier[k].start;
      sim->modifier[k].start = sim->time;
    }
  tau = fmin(tau, sim->h / (8 * sim->terms.shift.strength * sim->terms.shift.speed));
  N_Vector rate = sph_nvector_clone(sim->y, "displacements of a shift", &sim->error);
  if (!rate) return sim->error.status;
  int status = sph_sim_parts_of(sim, &part, SPH_SHIFTS, 0);
  if (!status) status = sph_sim_rhs_part(sim, &part, sim->time, sim->y, rate);
  if (!status) N_VLinearSum(1, sim->y, tau, rate, sim->y);
  N_VDestroy(rate);
  if (status > 0)
    return sph_sim_fail(sim, SPH_ERR_STEP, "shifting at t = %g s: %s", sim->time, sim->retry);
  return status ? status : 1;
}
