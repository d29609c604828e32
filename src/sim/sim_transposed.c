/* z = (df/dy)^T w: the phases of a tangent (sim_tangent.c) backwards.  What a sum, a record or a
 * particle is worth, its `bar`, is handed from what was made of it to what it was made of. */
#include "sim_transposed.h"

#include <math.h>
#include <string.h>

#include "cpu.h"
#include "drag_pair.h"
#include "gradient_pair.h"
#include "memory.h"
#include "tangent_loops.h"
#include "wall_pair.h"

enum { PARALLEL_MIN = 256, BLOCKS = 4 };

typedef struct sph_bars {
  double *record;             /* [room * stride] */
  double *sum[SPH_PAIR_SUMS]; /* [room] */
  sph_point *point;           /* [capacity] */
  double *body;               /* heating and acceleration by body terms, [capacity][4] */
} sph_bars;

struct sph_transposed {
  sph_tangent *tangent;
  const double *w;
  sph_bars bars[SPH_SETS_MAX];
};

/* ---- the workspace ---- */

void sph_sim_transposed_free(struct sph_transposed *r)
{
  if (!r) return;
  for (int g = 0; g < SPH_SETS_MAX; g++) {
    sph_memory_free(r->bars[g].record);
    for (int s = 0; s < SPH_PAIR_SUMS; s++) sph_memory_free(r->bars[g].sum[s]);
    sph_memory_free(r->bars[g].point);
    sph_memory_free(r->bars[g].body);
  }
  sph_memory_free(r);
}

static struct sph_transposed *get(sph_sim *sim)
{
  sph_tangent *t = sph_sim_tangent_get(sim);
  if (!t || t->transposed) return t ? t->transposed : NULL;
  struct sph_transposed *r = SPH_NEW(struct sph_transposed, 1, "a transposed product", &sim->error);
  if (!r) return NULL;
  r->tangent = t;
  for (int g = 0; g < sim->groups; g++) {
    const long room = sim->sorted[g].room, capacity = sim->group[g]->capacity;
    sph_bars *bars = &r->bars[g];
    bars->record = SPH_NEW(double, room * sim->sorted[g].stride, "bars of records", &sim->error);
    bars->point = SPH_NEW(sph_point, capacity, "bars of particles", &sim->error);
    bars->body = SPH_NEW(double, 4 * capacity, "bars of body terms", &sim->error);
    for (int s = 0; s < SPH_PAIR_SUMS; s++)
      if (t->group[g].sum_d[s]) bars->sum[s] = SPH_NEW(double, room, "bars of sums", &sim->error);
  }
  if (!sim->error.status) return t->transposed = r;
  sph_sim_transposed_free(r);
  return NULL;
}

/* ---- maps ---- */

static sph_local local(const struct sph_transposed *r, int g, long i, long s)
{
  const sph_tangent *t = r->tangent;
  return (sph_local){t, t->sim->group[g], &t->e.view[g], i, s};
}

static void clear_sums(struct sph_transposed *r, int g)
{
  for (int q = 0; q < SPH_PAIR_SUMS; q++)
    if (r->bars[g].sum[q])
      memset(r->bars[g].sum[q], 0, (size_t)r->tangent->sim->sorted[g].room * sizeof(double));
}

/* What w makes of the rates of one particle. */
static void rates(struct sph_transposed *r, int g, long i, long s)
{
  const sph_tangent *t = r->tangent;
  const sph_group *group = t->sim->group[g];
  const sph_view w = sph_group_data_view(group, r->w, NULL);
  const sph_local k = local(r, g, i, s);
  double out[SPH_RATES_OUT] = {0}, in[SPH_RATES_IN] = {0};
  for (int d = 0; d < group->dim; d++) {
    out[d] = w.x[d][i];
    out[3 + d] = w.v[d][i];
  }
  if (!group->summed) out[6] = w.rho[i];
  if (t->e.view[g].du) out[7] = w.energy[i];
  for (int q = 0; q < group->scalars; q++) out[8 + q] = w.s[q][i];
  sph_sim_tangent_map_transposed(sph_sim_tangent_map_rates, &k, SPH_RATES_IN, SPH_RATES_OUT, out,
                                 in);
  for (int q = 0; q < SPH_PAIR_SUMS; q++)
    if (r->bars[g].sum[q]) r->bars[g].sum[q][s] = in[q];
  memcpy(&r->bars[g].point[i], in + SPH_PAIR_SUMS, sizeof(sph_point));
  memcpy(r->bars[g].body + 4 * i, in + SPH_PAIR_SUMS + SPH_POINT, 4 * sizeof(double));
}

static void all_rates(struct sph_transposed *r)
{
  const sph_sim *sim = r->tangent->sim;
  for (int g = 0; g < sim->groups; g++) {
    const int *order = sph_neighbors_order(sim->neighbors, g);
    const long n = sim->group[g]->n;
    memset(r->bars[g].point, 0, (size_t)n * sizeof(sph_point));
    memset(r->bars[g].record, 0,
           (size_t)(sim->sorted[g].room * sim->sorted[g].stride) * sizeof(double));
    clear_sums(r, g);
    if (sim->group[g]->wall) continue;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long s = 0; s < n; s++) rates(r, g, order ? order[s] : s, s);
  }
}

/* Records of group g to its particles. */
static void unpack(struct sph_transposed *r, int g)
{
  const sph_sim *sim = r->tangent->sim;
  const int *order = sph_neighbors_order(sim->neighbors, g);
  const long n = sim->group[g]->n, stride = sim->sorted[g].stride;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long s = 0; s < n; s++) {
    const sph_local k = local(r, g, order[s], s);
    sph_sim_tangent_map_transposed(sph_sim_tangent_map_pack, &k, SPH_POINT, (int)stride,
                                   r->bars[g].record + s * stride,
                                   (double *)&r->bars[g].point[order[s]]);
  }
}

/* ---- loops ---- */

/* Slots that a pass over the sources of a fluid, or a wall, reads. */
static unsigned active_of(const sph_sim *sim, int pass, int g)
{
  const int dim = sim->dim, wall = sim->group[g]->wall;
  unsigned slots = (1u << slot_extra(dim)) - 1, extra = ((1u << dim) - 1) << slot_extra(dim);
  if (pass != SPH_TANGENT_fluid && pass != SPH_TANGENT_wall) return slots;
  if (wall || (sim->loop_terms & SPH_ANTUONO)) slots |= extra;
  if (sim->loop_terms & SPH_THERMAL) slots |= 1u << slot_u(dim) | 1u << slot_T(dim);
  if (sim->loop_terms & SPH_FORM_PHI) slots |= 1u << slot_phi(dim);
  return slots;
}

/* Adds to the bars of the records of `target` what they are worth in the sums of both; `sums`:
 * whose count. */
static void loop(struct sph_transposed *r, int pass, int target, int source, int of_target,
                 int of_source)
{
  sph_tangent *t = r->tangent;
  sph_sim *sim = t->sim;
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const fluid_constants k = sph_sim_tangent_loop_constants(t, pass, target, source);
  const fluid_constants k_source = sph_sim_tangent_loop_constants(t, pass, source, target);
  const double *const *weight = (const double *const *)r->bars[target].sum;
  const double *const *weight_source = (const double *const *)r->bars[source].sum;
  const sph_tangent_task task = {.target = sim->sorted[target].record,
                                 .source = sim->sorted[source].record,
                                 .target_stride = sim->sorted[target].stride,
                                 .source_stride = sim->sorted[source].stride,
                                 .targets = sim->group[target]->n,
                                 .lanes = sph_cpu_lanes(sim->isa),
                                 .first = list.first,
                                 .runs = list.runs,
                                 .shift = sph_neighbors_shifts(sim->neighbors, NULL),
                                 .reach2 = sim->H * sim->H * (1 + 1e-12),
                                 .kernel = sim->kernel_number,
                                 .terms = k.terms,
                                 .numbers = &k.inverse_h,
                                 .weight = of_target ? weight : NULL,
                                 .weight_source = of_source ? weight_source : NULL,
                                 .terms_source = k_source.terms,
                                 .numbers_source = &k_source.inverse_h,
                                 .active = active_of(sim, pass, target),
                                 .bar = r->bars[target].record};
  sph_tangent_function *run = sph_tangent_loops_transposed[pass][sim->dim - 1];
  long chunks = (list.blocks + BLOCKS - 1) / BLOCKS;
#pragma omp parallel for num_threads(sim->threads) schedule(dynamic) if (chunks > 2)
  for (long c = 0; c < chunks; c++)
    run(&task, c * BLOCKS, c + 1 < chunks ? (c + 1) * BLOCKS : list.blocks);
}

static int acts(const sph_sim *sim, int pass, const sph_group *target, const sph_group *source)
{
  if (pass == SPH_TANGENT_drag) return sph_sim_drag_acts(sim, target, source);
  if (pass == SPH_TANGENT_gradient)
    return sph_sim_interaction_same_fluid(target, source) && !target->eos.dust;
  return sph_sim_interaction_same_species(target, source);
}

/* A pass whose sums belong to fluids, over records of fluids and (walls) walls. */
static void fluid_pass(struct sph_transposed *r, int pass, int walls)
{
  const sph_sim *sim = r->tangent->sim;
  for (int g = 0; g < sim->groups; g++)
    for (int s = 0; s < sim->groups; s++) {
      const sph_group *target = sim->group[g], *source = sim->group[s];
      if ((target->wall && source->wall) || (target->wall && !walls)) continue;
      if (acts(sim, pass, target, source)) loop(r, pass, g, s, !target->wall, !source->wall);
    }
}

/* ---- phases, the last first ---- */

/* What drag adds to, as body terms do. */
static void drag(struct sph_transposed *r)
{
  const sph_sim *sim = r->tangent->sim;
  if (!r->tangent->e.part->drag) return;
  for (int g = 0; g < sim->groups; g++) {
    const int *order = sph_neighbors_order(sim->neighbors, g);
    if (sim->group[g]->wall) continue;
    clear_sums(r, g);
    for (long s = 0; s < sim->group[g]->n; s++) {
      const double *body = r->bars[g].body + 4L * order[s];
      r->bars[g].sum[SPH_DRAG_HEAT][s] = body[0];
      for (int d = 0; d < sim->dim; d++) r->bars[g].sum[SPH_DRAG_A + d][s] = body[1 + d];
    }
  }
  fluid_pass(r, SPH_TANGENT_drag, 0);
}

static void gradients(struct sph_transposed *r)
{
  const sph_tangent *t = r->tangent;
  const sph_sim *sim = t->sim;
  const int dim = sim->dim, sums = gradient_sums(dim);
  if (!t->e.part->gradients || t->lagged) return;
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall) continue;
    clear_sums(r, g);
    for (long s = 0; s < sim->group[g]->n && !sim->group[g]->eos.dust; s++) {
      const sph_local k = local(r, g, -1, s);
      double in[SPH_PAIR_SUMS] = {0};
      sph_point out = {0};
      double *extra = r->bars[g].record + s * sim->sorted[g].stride + slot_extra(dim);
      memcpy(out.extra, extra, (size_t)dim * sizeof(double));
      memset(extra, 0, (size_t)dim * sizeof(double));
      sph_sim_tangent_map_transposed(sph_sim_tangent_map_gradient, &k, sums, SPH_POINT,
                                     (const double *)&out, in);
      for (int q = 0; q < sums; q++) r->bars[g].sum[q][s] = in[q];
    }
  }
  fluid_pass(r, SPH_TANGENT_gradient, 1);
}

static void walls(struct sph_transposed *r)
{
  const sph_tangent *t = r->tangent;
  const sph_sim *sim = t->sim;
  if (!t->e.part->walls || t->lagged) return;
  for (int g = 0; g < sim->groups; g++) {
    if (!sim->group[g]->wall) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
    unpack(r, g);
    for (long s = 0; s < sim->group[g]->n; s++) {
      const sph_local k = local(r, g, order[s], s);
      double in[SPH_WALL_SUMS] = {0};
      sph_sim_tangent_map_transposed(sph_sim_tangent_map_wall, &k, SPH_WALL_SUMS, SPH_POINT,
                                     (const double *)&r->bars[g].point[order[s]], in);
      for (int q = 0; q < SPH_WALL_SUMS; q++) r->bars[g].sum[q][s] = in[q];
    }
    for (int f = 0; f < sim->groups; f++)
      if (!sim->group[f]->wall && !sim->group[f]->eos.dust) loop(r, SPH_TANGENT_wall, f, g, 0, 1);
  }
}

/* p, c, u, T, phi to what they were made of. */
static void material(struct sph_transposed *r)
{
  const sph_sim *sim = r->tangent->sim;
  for (int g = 0; g < sim->groups && r->tangent->e.part->eos; g++) {
    const long n = sim->group[g]->wall ? 0 : sim->group[g]->n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long i = 0; i < n; i++) {
      const sph_local k = local(r, g, i, -1);
      sph_point *bar = &r->bars[g].point[i];
      const sph_point made = {.u = bar->u, .T = bar->T, .p = bar->p, .c = bar->c, .phi = bar->phi};
      bar->u = bar->T = bar->p = bar->c = bar->phi = 0;
      sph_sim_tangent_map_transposed(sph_sim_tangent_map_eos, &k, SPH_POINT, SPH_POINT,
                                     (const double *)&made, (double *)bar);
    }
  }
}

/* Densities that are sums to the positions they were made of. */
static void density(struct sph_transposed *r)
{
  const sph_tangent *t = r->tangent;
  const sph_sim *sim = t->sim;
  if (!t->e.part->density) return;
  for (int g = 0; g < sim->groups; g++) {
    const int *order = sph_neighbors_order(sim->neighbors, g);
    memset(r->bars[g].record, 0,
           (size_t)(sim->sorted[g].room * sim->sorted[g].stride) * sizeof(double));
    sph_sim_pairs_pack_positions(&t->e, g);
    if (sim->group[g]->wall) continue;
    clear_sums(r, g);
    for (long s = 0; s < sim->group[g]->n; s++)
      r->bars[g].sum[0][s] = sim->W_scale * r->bars[g].point[order[s]].rho;
  }
  fluid_pass(r, SPH_TANGENT_density, 0);
  for (int g = 0; g < sim->groups; g++) {
    const int *order = sph_neighbors_order(sim->neighbors, g);
    for (long s = 0; !sim->group[g]->wall && s < sim->group[g]->n; s++)
      for (int d = 0; d < sim->dim; d++)
        r->bars[g].point[order[s]].x[d] += r->bars[g].record[s * sim->sorted[g].stride + d];
  }
}

static void collect(const struct sph_transposed *r, double *z)
{
  const sph_sim *sim = r->tangent->sim;
  memset(z, 0, (size_t)sim->layout.length * sizeof *z);
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const sph_view to = sph_group_data_view(group, z, NULL);
    const int energy = sph_group_data_energy(group) >= 0;
    for (long i = 0; !group->wall && i < group->n; i++) {
      const sph_point *bar = &r->bars[g].point[i];
      for (int d = 0; d < group->dim; d++) {
        to.x[d][i] = bar->x[d];
        to.v[d][i] = bar->v[d];
      }
      if (!group->summed) to.rho[i] = bar->rho;
      if (energy) to.energy[i] = bar->energy;
      for (int q = 0; q < group->scalars; q++) to.s[q][i] = bar->s[q];
    }
  }
}

/* What a body term of the user's is worth: it is taken to act on each particle alone, so that one
 * field of all particles can be moved at once. */
static int bodies(struct sph_transposed *r)
{
  sph_tangent *t = r->tangent;
  const sph_sim *sim = t->sim;
  int status = SPH_OK;
  for (int c = 0; !status && c < SPH_POINT && sph_sim_tangent_call_has_bodies(t); c++) {
    status = sph_sim_tangent_call_field(t, c);
    for (int g = 0; !status && g < sim->groups; g++) {
      const sph_group *group = sim->group[g];
      const sph_view slope = sph_group_data_view(group, t->y, t->body);
      const sph_view w = sph_group_data_view(group, r->w, NULL);
      for (long i = 0; !group->wall && i < group->n; i++) {
        const double unit = ((const double *)&t->group[g].point[i])[c];
        const double *bar = r->bars[g].body + 4 * i;
        double sum = slope.du ? bar[0] * slope.du[i] : 0;
        for (int d = 0; d < group->dim; d++) sum += bar[1 + d] * slope.dv[d][i];
        if (slope.drho) sum += w.rho[i] * slope.drho[i];
        for (int q = 0; q < group->scalars; q++) sum += w.s[q][i] * slope.ds[q][i];
        ((double *)&r->bars[g].point[i])[c] += unit != 0 ? sum / unit : 0;
      }
    }
  }
  return status;
}

static int check(sph_sim *sim, int part)
{
  const char *what = sim->part[part].tiles        ? "registered pair terms (tiles)"
                     : sim->terms.phi.phi != NULL ? "a phi of your own"
                                                  : NULL;
  if (!what) return SPH_OK;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "no transposed products and adjoints of a simulation with %s", what);
}

static void add_pressure(struct sph_transposed *r, const sph_pressure_bars *pressure)
{
  const sph_sim *sim = r->tangent->sim;
  for (int g = 0; g < sim->groups; g++)
    for (long i = 0; pressure && pressure->weight[g] && i < sim->group[g]->n; i++)
      r->bars[g].point[i].p += pressure->factor * pressure->weight[g][i];
}

int sph_sim_transposed(sph_sim *sim, int part, double t, const double *y, const double *w,
                       const sph_pressure_bars *pressure, int lagged, double *z)
{
  struct sph_transposed *r = get(sim);
  if (!r) return sim->error.status;
  int status = check(sim, part);
  /* The phases themselves, their slopes and what the maps read: those of a tangent. */
  if (!status) status = sph_sim_tangent_base(sim, part, t, y, lagged);
  if (status) return status;
  r->w = w;
  all_rates(r);
  status = bodies(r);
  if (r->tangent->e.part->pairs) {
    fluid_pass(r, SPH_TANGENT_fluid, r->tangent->e.part->walls && !lagged);
    drag(r);
    gradients(r);
    walls(r);
    for (int g = 0; g < sim->groups; g++)
      if (!sim->group[g]->wall) unpack(r, g);
  }
  add_pressure(r, pressure);
  material(r);
  density(r);
  collect(r, z);
  return status;
}
