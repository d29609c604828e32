/* Phase pairs: pack (a sorted copy of what the loops read) -> one fused loop per interaction ->
 * rates. */
#include <math.h>
#include <string.h>

#include "fluid_loops.h"
#include "sim_rhs.h"
#include "wall_pair.h"

enum { PARALLEL_MIN = 2048, PACKED = 256, BLOCKS = 64 };

/* What packing reads of one group. */
typedef struct packing {
  const sph_sim *sim;
  sph_view view;
  const int *order;
  const double *wrap[3];   /* periodic boxes to subtract; NULL: not periodic */
  double *const *wall_sum; /* of the extrapolation; NULL for fluids */
  double *record;
  long stride;
} packing;

static packing packing_of(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  packing k = {.sim = sim, .view = e->view[g], .order = sph_neighbors_order(sim->neighbors, g)};
  for (int d = 0; d < sim->dim; d++) k.wrap[d] = sph_neighbors_wrap(sim->neighbors, g, d);
  k.wall_sum = sim->group[g]->wall ? sim->sorted[g].sum : NULL;
  k.record = sim->sorted[g].record;
  k.stride = sim->sorted[g].stride;
  return k;
}

static double position(const packing *k, int d, long i)
{
  return k->view.x[d][i] - (k->wrap[d] ? k->wrap[d][i] * k->sim->length[d] : 0);
}

/* The velocity that viscous terms see of a wall particle: 2 v - <v_fluid>. */
static double slip_velocity(const packing *k, int d, long s, long i)
{
  double W = k->wall_sum[SPH_WALL_W][s], v = k->view.v[d][i];
  return W > 0 ? 2 * v - k->wall_sum[SPH_WALL_V + d][s] / W : v;
}

/* One record, at sorted place s: see fluid_pair.h. */
static inline void pack(const packing *k, int dim, long s)
{
  const sph_view *view = &k->view;
  const long i = k->order[s];
  double *record = k->record + s * k->stride;
  const double rho = view->rho[i], p = view->p[i], inverse_rho = 1 / rho;
  for (int d = 0; d < dim; d++) {
    record[d] = position(k, d, i);
    record[slot_v(dim) + d] = view->v[d][i];
  }
  record[slot_rho(dim)] = rho;
  record[slot_p(dim)] = k->sim->loop_terms & SPH_FORM_C2 ? p : p * inverse_rho * inverse_rho;
  record[slot_c(dim)] = view->c[i];
  record[slot_V(dim)] = view->m[i] * inverse_rho;
  if (k->stride <= slot_extra(dim)) return;
  for (int d = 0; d < dim; d++)
    record[slot_extra(dim) + d] = k->wall_sum ? slip_velocity(k, d, s, i) : 0;
  if (k->sim->loop_terms & SPH_THERMAL) record[slot_u(dim)] = view->u ? view->u[i] : 0;
}

static void pack_range(const packing *k, long begin, long end)
{
  const int dim = k->sim->dim;
  for (long s = begin; s < end; s++) {
    if (dim == 3)
      pack(k, 3, s);
    else if (dim == 2)
      pack(k, 2, s);
    else
      pack(k, 1, s);
  }
}

/* The lanes behind the last particle hold copies of it: finite, and never stored. */
static void pack_tail(sph_sorted *sorted, long n)
{
  for (long s = n; n > 0 && s < sorted->room; s++)
    memcpy(sorted->record + s * sorted->stride, sorted->record + (n - 1) * sorted->stride,
           (size_t)sorted->stride * sizeof(double));
}

void sph_sim_pairs_pack(sph_evaluation *e, int walls)
{
  sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall != walls) continue;
    const packing k = packing_of(e, g);
    const long n = e->view[g].n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long s = 0; s < n; s += PACKED) pack_range(&k, s, s + PACKED < n ? s + PACKED : n);
    pack_tail(&sim->sorted[g], n);
  }
}

void sph_sim_pairs_pack_positions(const sph_evaluation *e, int g)
{
  const packing k = packing_of(e, g);
  for (long s = 0; s < e->view[g].n; s++)
    for (int d = 0; d < e->sim->dim; d++) k.record[s * k.stride + d] = position(&k, d, k.order[s]);
  pack_tail(&e->sim->sorted[g], e->view[g].n);
}

void sph_sim_pairs_clear(sph_sim *sim, int g, int sums)
{
  for (int s = 0; s < sums; s++)
    memset(sim->sorted[g].sum[s], 0, (size_t)sim->sorted[g].room * sizeof(double));
}

void sph_sim_pairs_loop(sph_sim *sim, sph_pair_function *loop, int target, int source,
                        const void *constants)
{
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const sph_pair_task task = {.target = sim->sorted[target].record,
                              .source = sim->sorted[source].record,
                              .target_stride = sim->sorted[target].stride,
                              .source_stride = sim->sorted[source].stride,
                              .first = list.first,
                              .runs = list.runs,
                              .shift = sph_neighbors_shifts(sim->neighbors, NULL),
                              .sum = sim->sorted[target].sum,
                              .constants = constants};
  long chunks = (list.blocks + BLOCKS - 1) / BLOCKS;
#pragma omp parallel for num_threads(sim->threads) schedule(dynamic) if (chunks > 2)
  for (long c = 0; c < chunks; c++)
    loop(&task, c * BLOCKS, c + 1 < chunks ? (c + 1) * BLOCKS : list.blocks);
}

int sph_sim_pairs_same_fluid(const sph_group *target, const sph_group *source)
{
  return source->wall || (source->eos.rho0 == target->eos.rho0 && source->eos.c0 == target->eos.c0);
}

/* Terms of the interaction fluid <- source. */
static unsigned interaction_terms(const sph_sim *sim, const sph_group *target,
                                  const sph_group *source)
{
  unsigned terms = sim->loop_terms;
  if (!sph_sim_pairs_same_fluid(target, source)) terms &= ~(unsigned)(SPH_MOLTENI | SPH_ANTUONO);
  if (!source->wall) return terms;
  terms &= ~(unsigned)SPH_CONDUCTIVITY; /* walls are adiabatic */
  if (!source->boundary.no_slip) terms &= ~(unsigned)SPH_ARTIFICIAL;
  return terms | SPH_WALL;
}

/* Adds the sums at sorted place s, scaled, to the rates of particle i. */
static void add_rates(const sph_sim *sim, const sph_group *group, const sph_view *view, long s,
                      long i)
{
  double *const *sum = sim->sorted[group->index].sum;
  double rho = view->rho[i], compression = sim->F_scale * sum[SPH_SUM_COMPRESSION][s];
  if (sim->loop_terms & SPH_FORM_C2) compression *= rho;
  for (int d = 0; d < sim->dim; d++) view->dv[d][i] += sim->F_scale * sum[SPH_SUM_A + d][s];
  double diffusion = sim->terms.delta * sim->h * group->eos.c0 * sim->F_scale;
  if (sim->loop_terms & SPH_CONTINUITY) view->drho[i] += compression;
  if (sim->loop_terms & (SPH_MOLTENI | SPH_ANTUONO))
    view->drho[i] += diffusion * sum[SPH_SUM_DIFFUSION][s];
  if (!view->du) return;
  view->du[i] += sim->F_scale * sum[SPH_SUM_HEAT][s];
  if (sim->loop_terms & SPH_PRESSURE_FORCE) view->du[i] += view->p[i] / (rho * rho) * compression;
}

static void add_group(sph_evaluation *e, int g)
{
  sph_sim *sim = e->sim;
  const int *order = sph_neighbors_order(sim->neighbors, g);
  sph_sim_pairs_clear(sim, g, SPH_FLUID_SUMS);
  for (int s = 0; s < sim->groups; s++) {
    fluid_constants constants = sim->constants;
    constants.terms = interaction_terms(sim, sim->group[g], sim->group[s]);
    sph_sim_pairs_loop(sim, sph_fluid_loop(sim->isa, sim->kernel_number, sim->dim, constants.terms),
                       g, s, &constants);
  }
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (e->view[g].n > PARALLEL_MIN)
  for (long s = 0; s < e->view[g].n; s++) add_rates(sim, sim->group[g], &e->view[g], s, order[s]);
}

int sph_sim_pairs_add(sph_evaluation *e)
{
  for (int g = 0; g < e->sim->groups; g++)
    if (!e->sim->group[g]->wall) add_group(e, g);
  return SPH_OK;
}
