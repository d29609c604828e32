/* Phase pairs: pack (a sorted copy of what the loops read) -> one fused loop per interaction ->
 * rates. */
#include <math.h>
#include <string.h>

#include "cpu.h"
#include "neighbors_sort.h"
#include "sim_energy.h"
#include "sim_rhs.h"
#include "sim_single.h"
#include "tile_pair.h"
#include "wall_pair.h"

enum { PARALLEL_MIN = 2048, PACKED = 256, BLOCKS = SPH_SHARE_BLOCKS };

/* What packing reads of one group. */
typedef struct packing {
  const sph_sim *sim;
  sph_view view;
  const int *order;
  const double *wrap[3];   /* periodic boxes to subtract; NULL: not periodic; */
  double length[3];        /* their size [m] */
  double *const *wall_sum; /* of the extrapolation; NULL for others than adami walls */
  double *const *seen;     /* velocity that viscous terms see of other walls; NULL for fluids */
  double wall_T;           /* of an isothermal wall [K], else 0; where it has T, that counts */
  int isothermal;
  const double *phi; /* NULL: another row */
  double *record;
  long stride;
  int scalars; /* in the records: those of pair terms alone */
} packing;

static packing packing_of(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  packing k = {.sim = sim, .view = e->view[g], .order = sph_neighbors_order(sim->neighbors, g)};
  for (int d = 0; d < sim->dim; d++) {
    k.wrap[d] = sph_neighbors_wrap(sim->neighbors, g, d);
    k.length[d] = sim->length[d];
  }
  const sph_group *group = sim->group[g];
  if (group->wall && group->model == SPH_MODEL_ADAMI) k.wall_sum = sim->sorted[g].sum;
  if (group->model == SPH_MODEL_DBC) k.seen = e->view[g].v;
  if (group->model == SPH_MODEL_MIRROR) k.seen = group->start;
  k.wall_T = group->boundary.temperature;
  k.isothermal = sph_group_data_isothermal(group);
  k.phi = sim->sorted[g].phi;
  k.record = sim->sorted[g].record;
  k.stride = sim->sorted[g].stride;
  k.scalars = sim->part[SPH_WHOLE].tiles ? sim->terms.scalars : 0;
  return k;
}

static double position(const packing *k, int d, long i)
{
  return k->view.x[d][i] - (k->wrap[d] ? k->wrap[d][i] * k->length[d] : 0);
}

/* The velocity that viscous terms see of a wall particle: 2 v - <v_fluid> (wall_pair.h). */
static double slip_velocity(const packing *k, int d, long s, long i)
{
  double W = k->wall_sum[SPH_WALL_W][s], v = k->view.v[d][i];
  return W > 0 ? 2 * v - k->wall_sum[SPH_WALL_V + d][s] / W : v;
}

/* The temperature that conduction sees: 2 T - <T_fluid>, so that T is that of the surface. */
static double temperature(const packing *k, long s, long i)
{
  if (!k->wall_sum) return k->view.T ? k->view.T[i] : k->wall_T;
  double W = k->wall_sum[SPH_WALL_W][s];
  const double T = k->view.T ? k->view.T[i] : k->wall_T;
  return W > 0 && k->isothermal ? 2 * T - k->wall_sum[SPH_WALL_T][s] / W : 0;
}

/* What only some sets of terms read. */
static inline void pack_more(const packing *k, int dim, long s, long i, double *record)
{
  const sph_view *view = &k->view;
  const unsigned terms = k->sim->loop_terms;
  for (int d = 0; d < dim; d++)
    record[slot_extra(dim) + d] = k->wall_sum ? slip_velocity(k, d, s, i)
                                  : k->seen   ? k->seen[d][i]
                                              : 0;
  if (terms & SPH_THERMAL) {
    record[slot_u(dim)] = view->u ? view->u[i] : 0;
    record[slot_T(dim)] = temperature(k, s, i);
  }
  if (k->phi) {
    record[slot_phi(dim)] = k->phi[i];
    record[slot_p(dim)] *= k->phi[i];
  }
  for (int q = 0; q < k->scalars; q++)
    record[slot_scalar(dim) + q] = view->s[q] ? view->s[q][i] : 0;
}

/* Records at sorted places begin .. end - 1: see fluid_pair.h. */
static inline void pack(const packing *k, int dim, long begin, long end)
{
  const sph_view view = k->view;
  const int *order = k->order, more = k->stride > slot_extra(dim);
  const int is_c2 = (k->sim->loop_terms & SPH_FORM_C2) != 0;
  double *record = k->record + begin * k->stride;
  for (long s = begin; s < end; s++, record += k->stride) {
    const long i = order[s];
    const double rho = view.rho[i], p = view.p[i], inverse_rho = 1 / rho;
    for (int d = 0; d < dim; d++) {
      record[d] = view.x[d][i] - (k->wrap[d] ? k->wrap[d][i] * k->length[d] : 0);
      record[slot_v(dim) + d] = view.v[d][i];
    }
    record[slot_rho(dim)] = rho;
    record[slot_p(dim)] = is_c2 ? p : p * inverse_rho * inverse_rho;
    record[slot_c(dim)] = view.c[i];
    record[slot_V(dim)] = view.m[i] * inverse_rho;
    if (more) pack_more(k, dim, s, i, record);
  }
}

static void pack_range(const packing *k, long begin, long end)
{
  if (k->sim->dim == 3)
    pack(k, 3, begin, end);
  else if (k->sim->dim == 2)
    pack(k, 2, begin, end);
  else
    pack(k, 1, begin, end);
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
    if (sim->single) sph_sim_single_pack(sim, g);
  }
}

void sph_sim_pairs_pack_positions(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const packing k = packing_of(e, g);
  const int wall = sim->group[g]->wall && sim->group[g]->model == SPH_MODEL_ADAMI;
  const double wall_mass = sim->group[g]->rho0 * sim->wall_volume;
  const long n = e->view[g].n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long s = 0; s < n; s++) {
    const long i = k.order[s];
    for (int d = 0; d < sim->dim; d++) k.record[s * k.stride + d] = position(&k, d, i);
    k.record[s * k.stride + slot_V(sim->dim)] = wall ? wall_mass : k.view.m[i];
  }
  pack_tail(&e->sim->sorted[g], n);
}

void sph_sim_pairs_clear(sph_sim *sim, int g, int sums)
{
  const long room = sim->sorted[g].room;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (room > PARALLEL_MIN)
  for (long i = 0; i < room; i += PACKED)
    for (int s = 0; s < sums; s++)
      memset(sim->sorted[g].sum[s] + i, 0,
             (size_t)(room - i < PACKED ? room - i : PACKED) * sizeof(double));
}

void sph_sim_pairs_loop(sph_sim *sim, sph_pair_function *loop, int target, int source,
                        const void *constants)
{
  sph_sim_pairs_loop_records(sim, loop, target, source, NULL, NULL, 0, constants);
}

void sph_sim_pairs_loop_records(sph_sim *sim, sph_pair_function *loop, int target, int source,
                                const double *record, const double *source_record, long stride,
                                const void *constants)
{
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const sph_sorted *to = &sim->sorted[target], *from = &sim->sorted[source];
  const sph_pair_task task = {.target = record ? record : to->record,
                              .source = record ? source_record : from->record,
                              .target_stride = record ? stride : to->stride,
                              .source_stride = record ? stride : from->stride,
                              .first = list.first,
                              .runs = list.runs,
                              .shift = sph_neighbors_shifts(sim->neighbors, NULL),
                              .sum = sim->sorted[target].sum,
                              .target_single = to->single,
                              .source_single = from->single,
                              .quantum = sim->quantum,
                              .constants = constants};
  long chunks = (list.blocks + BLOCKS - 1) / BLOCKS;
#pragma omp parallel for num_threads(sim->threads) schedule(dynamic) if (chunks > 2)
  for (long c = 0; c < chunks; c++)
    loop(&task, c * BLOCKS, c + 1 < chunks ? (c + 1) * BLOCKS : list.blocks);
}

long sph_sim_pairs_share(sph_sim *sim, int g, int sums, int scratch, sph_share_work *work,
                         void *ctx)
{
  const long lanes = sph_cpu_lanes(sim->isa), blocks = (sim->group[g]->n + lanes - 1) / lanes;
  const long shares = (blocks + BLOCKS - 1) / BLOCKS;
#pragma omp parallel for num_threads(sim->threads) schedule(dynamic) if (shares > 2)
  for (long c = 0; c < shares; c++) {
    _Alignas(64) double memory[SPH_PAIR_SUMS][BLOCKS * SPH_LANES_MAX];
    sph_share share = {.begin = c * BLOCKS, .end = c + 1 < shares ? (c + 1) * BLOCKS : blocks};
    for (int s = 0; s < sums; s++) {
      share.sum[s] = scratch ? memory[s] : sim->sorted[g].sum[s] + share.begin * lanes;
      memset(share.sum[s], 0, (size_t)((share.end - share.begin) * lanes) * sizeof(double));
    }
    work(ctx, &share);
  }
  return shares;
}

long sph_sim_pairs_targets(const sph_sim *sim, int g, const sph_share *share)
{
  const long lanes = sph_cpu_lanes(sim->isa), n = sim->group[g]->n;
  return (share->end * lanes < n ? share->end * lanes : n) - share->begin * lanes;
}

void sph_sim_pairs_loop_share(const sph_sim *sim, const sph_share *share, sph_pair_function *loop,
                              int target, int source, const void *constants)
{
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const sph_sorted *to = &sim->sorted[target], *from = &sim->sorted[source];
  const long first = share->begin * sph_cpu_lanes(sim->isa);
  const sph_pair_task task = {.target = to->record + first * to->stride,
                              .source = from->record,
                              .target_stride = to->stride,
                              .source_stride = from->stride,
                              .first = list.first + share->begin,
                              .runs = list.runs,
                              .shift = sph_neighbors_shifts(sim->neighbors, NULL),
                              .sum = share->sum,
                              .target_single = to->single ? to->single + first * to->stride : NULL,
                              .source_single = from->single,
                              .quantum = sim->quantum,
                              .constants = constants};
  if (list.blocks) loop(&task, 0, share->end - share->begin);
}

/* Adds what only some sets of terms have, of the sums at place s, to the rates of particle i. */
static void add_more(const sph_sim *sim, const sph_part *part, const sph_group *group,
                     const sph_view *view, double *const *sum, long s, long i, double compression)
{
  if (view->drho && part->tiles) view->drho[i] += sim->F_scale * sum[SPH_SUM_DENSITY][s];
  if (part->rates & SPH_XSPH)
    for (int d = 0; d < sim->dim; d++) view->dx[d][i] += sim->W_scale * sum[SPH_SUM_DRIFT + d][s];
  for (int q = 0; q < group->scalars && part->tiles; q++)
    view->ds[q][i] += sim->F_scale * sum[SPH_SUM_SCALAR + q][s];
  if (!view->du) return;
  double heat = view->du[i] + sim->F_scale * sum[SPH_SUM_HEAT][s];
  if (!(part->rates & SPH_PRESSURE_FORCE)) compression = 0;
  view->du[i] = sph_sim_energy_rate(group, view, i, heat, compression);
}

/* Adds the sums of n particles from sorted place begin on, scaled, to the rates. */
static void add_rates(const sph_sim *sim, const sph_part *part, const sph_group *group,
                      const sph_view *at, double *const *sums, long begin, long n)
{
  const sph_view view = *at;
  const double *phi = sim->sorted[group->index].phi;
  const int *order = sph_neighbors_order(sim->neighbors, group->index) + begin;
  const double *sum[SPH_SUM_DIFFUSION + 1], scale = sim->F_scale;
  const double diffusion =
      part->rates & SPH_DIFFUSION ? sim->terms.delta * sim->h * group->eos.c0 * scale : 0;
  const int compresses = (part->rates & SPH_CONTINUITY) != 0, dim = sim->dim;
  const int more = part->tiles || (part->rates & SPH_XSPH) || view.du;
  for (int q = 0; q <= SPH_SUM_DIFFUSION; q++) sum[q] = sums[q];
  for (long s = 0; s < n; s++) {
    const long i = order[s];
    double compression = scale * sum[SPH_SUM_COMPRESSION][s];
    if (sim->loop_terms & SPH_FORM_C2) compression *= view.rho[i];
    if (phi) compression *= phi[i];
    for (int d = 0; d < dim; d++) view.dv[d][i] += scale * sum[SPH_SUM_A + d][s];
    if (view.drho && compresses) view.drho[i] += compression;
    if (view.drho && diffusion != 0) view.drho[i] += diffusion * sum[SPH_SUM_DIFFUSION][s];
    if (more) add_more(sim, part, group, at, sums, s, i, compression);
  }
}

/* Without pairs: only the heating by body terms is made the rate of the energy. */
static void add_heating(const sph_evaluation *e, int g)
{
  const sph_group *group = e->sim->group[g];
  const sph_view *view = &e->view[g];
  if (!view->du || view->energy == view->u) return;
#pragma omp parallel for num_threads(e->sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long i = 0; i < view->n; i++)
    view->du[i] = sph_sim_energy_rate(group, view, i, view->du[i], 0);
}

void sph_sim_pairs_rates(sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  if (e->part->pairs)
    add_rates(sim, e->part, sim->group[g], &e->view[g], sim->sorted[g].sum, 0, e->view[g].n);
  else
    add_heating(e, g);
}

typedef struct adding {
  const sph_evaluation *e;
  int g;
} adding;

/* Sums of some targets, from all sources, then their rates, while these sums are in the cache. */
static void add_share(void *ctx, const sph_share *share)
{
  const adding *a = ctx;
  const sph_evaluation *e = a->e;
  const sph_sim *sim = e->sim;
  for (int s = 0; s < sim->groups; s++)
    if (sph_sim_interaction_same_species(sim->group[a->g], sim->group[s]) &&
        (sim->group[s]->wall || !e->part->only_walls))
      sph_sim_interaction_add(e, share, a->g, s);
  add_rates(sim, e->part, sim->group[a->g], &e->view[a->g], share->sum,
            share->begin * sph_cpu_lanes(sim->isa), sph_sim_pairs_targets(sim, a->g, share));
}

int sph_sim_pairs_add(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups; g++) {
    adding a = {.e = e, .g = g};
    if (sim->group[g]->wall)
      sph_sim_walls_rates(e, g);
    else if (e->part->pairs)
      sph_sim_pairs_share(sim, g, sim->fluid_sums, !e->sums, add_share, &a);
    else
      add_heating(e, g);
  }
  return SPH_OK;
}
