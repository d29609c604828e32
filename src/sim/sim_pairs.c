/* Phase pairs: pack (a sorted copy of what the loops read) -> one fused loop per interaction -> rates. */
#include <math.h>
#include <string.h>

#include "fluid_loops.h"
#include "sim_rhs.h"
#include "wall_pair.h"

enum { PARALLEL_MIN = 2048, BLOCKS = 64 };

/* One record at sorted place s: see fluid_pair.h. */
static void pack(const sph_evaluation *e, int g, long s, long i, double *record)
{
  const sph_sim *sim = e->sim;
  const sph_view *view = &e->view[g];
  const sph_group *group = sim->group[g];
  int dim = sim->dim;
  double rho = view->rho[i], p = view->p[i];
  for (int d = 0; d < dim; d++) {
    const double *wrap = sph_neighbors_wrap(sim->neighbors, g, d);
    record[d] = view->x[d][i] - (wrap ? wrap[i] * sim->length[d] : 0);
    record[slot_v(dim) + d] = view->v[d][i];
  }
  record[slot_rho(dim)] = rho;
  record[slot_p(dim)] = sim->loop_terms & SPH_FORM_C2 ? p : p / (rho * rho);
  record[slot_c(dim)] = view->c[i];
  record[slot_V(dim)] = view->m[i] / rho;
  int extra = sim->sorted[g].stride > slot_extra(dim);
  for (int d = 0; extra && d < dim; d++) {
    double W = group->wall ? sim->sorted[g].sum[SPH_WALL_W][s] : 0;
    double v = W > 0 ? sim->sorted[g].sum[SPH_WALL_V + d][s] / W : view->v[d][i];
    record[slot_extra(dim) + d] = group->wall ? 2 * view->v[d][i] - v : 0;
  }
  if (sim->loop_terms & SPH_THERMAL) record[slot_u(dim)] = view->u ? view->u[i] : 0;
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
    sph_sorted *sorted = &sim->sorted[g];
    const int *order = sph_neighbors_order(sim->neighbors, g);
    long n = e->view[g].n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long s = 0; s < n; s++) pack(e, g, s, order[s], sorted->record + s * sorted->stride);
    pack_tail(sorted, n);
  }
}

void sph_sim_pairs_pack_positions(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const sph_sorted *sorted = &sim->sorted[g];
  const int *order = sph_neighbors_order(sim->neighbors, g);
  for (int d = 0; d < sim->dim; d++) {
    const double *wrap = sph_neighbors_wrap(sim->neighbors, g, d), *x = e->view[g].x[d];
    for (long s = 0; s < e->view[g].n; s++)
      sorted->record[s * sorted->stride + d] =
          x[order[s]] - (wrap ? wrap[order[s]] * sim->length[d] : 0);
  }
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

/* Terms of the interaction fluid <- source. */
static unsigned interaction_terms(const sph_sim *sim, const sph_group *source)
{
  unsigned terms = sim->loop_terms;
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
    constants.terms = interaction_terms(sim, sim->group[s]);
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
