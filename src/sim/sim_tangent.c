/* A tangent of f: its phases, each followed by its derivative. */
#include "sim_tangent.h"
#include "sim_single.h"

#include <math.h>
#include <string.h>

#include "drag_pair.h"
#include "eos_table.h"
#include "gradient_pair.h"
#include "memory.h"
#include "sim_transposed.h"
#include "tangent_loops.h"
#include "term_part.h"
#include "wall_pair.h"

enum { PARALLEL_MIN = 1024, CHUNK = 256 };

/* ---- the workspace ---- */

static int make_group(sph_tangent *t, int g)
{
  sph_sim *sim = t->sim;
  const sph_group *group = sim->group[g];
  sph_tangent_group *own = &t->group[g];
  const long room = sim->sorted[g].room;
  own->record_d = SPH_NEW(double, room * sim->sorted[g].stride + SPH_PAIR_SLOTS,
                          "derivatives of records", &sim->error);
  int sums = group->wall ? SPH_WALL_SUMS : SPH_FLUID_SUMS_ALL;
  if (!group->wall && sim->fluid_sums > sums) sums = sim->fluid_sums;
  for (int s = 0; s < sums; s++)
    own->sum_d[s] = SPH_NEW(double, room, "derivatives of pair sums", &sim->error);
  own->point = SPH_NEW(sph_point, group->capacity, "changes of particles", &sim->error);
  double **slope[] = {&own->p_rho, &own->p_u, &own->c_rho, &own->c_u, &own->T_rho, &own->T_u};
  for (int k = 0; !group->wall && k < 6; k++)
    *slope[k] = SPH_NEW(double, group->capacity, "slopes of an equation of state", &sim->error);
  for (int k = 0; !group->wall && (sim->loop_terms & SPH_ANTUONO) && k < 6; k++)
    own->matrix[k] = SPH_NEW(double, room, "gradient matrices", &sim->error);
  return sim->error.status;
}

/* What differences need: callbacks and parameters. */
static int make_differences(sph_tangent *t)
{
  sph_sim *sim = t->sim;
  const long length = sim->layout.length;
  t->beside_rate = SPH_NEW(double, length, "rates beside a state", &sim->error);
  t->body = SPH_NEW(double, length, "changes of body terms", &sim->error);
  t->drag = SPH_NEW(double, length, "rates by drag", &sim->error);
  for (int g = 0; g < sim->groups && (sim->terms.called || sim->terms.phi.phi); g++) {
    t->beside[g] =
        SPH_NEW(double, SPH_POINT * sim->group[g]->capacity, "a state beside another", &sim->error);
    t->record[g] = SPH_NEW(double, sim->sorted[g].room * sim->sorted[g].stride, "copies of records",
                           &sim->error);
  }
  return sim->error.status;
}

int sph_sim_tangent_fit(sph_sim *sim)
{
  for (int g = 0; g < sim->groups; g++)
    if (sim->group[g]->model != SPH_MODEL_ADAMI)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "derivatives of f know adami walls alone; wall %s has %s: images and "
                          "densities of walls are no part of them yet",
                          sim->group[g]->name, sim->group[g]->boundary.name);
  return SPH_OK;
}

sph_tangent *sph_sim_tangent_get(sph_sim *sim)
{
  if (sim->error.status) return NULL;
  if (sim->tangent) return sim->tangent;
  if (sph_sim_single_refuse(sim, "derivatives are those of double precision alone")) return NULL;
  if (sim->loop_terms & SPH_CORRECTED) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                 "no derivatives of terms whose gradients are corrected: right is correction none");
    return NULL;
  }
  if (sim->loop_terms & SPH_SWITCHES) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                 "no derivatives of a simulation whose artificial viscosity has a switch: its "
                 "slope is not worked out; right is a viscosity without one");
    return NULL;
  }
  if (sim->part[SPH_WHOLE].shift) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                 "no derivatives of a right-hand side with %s: it jumps where particles come to a "
                 "free surface, and its passes have none; right is a simulation without the term",
                 sph_term_part_named(sim->loop_terms & SPH_SHIFTS));
    return NULL;
  }
  if (sph_sim_tangent_fit(sim)) return NULL;
  sph_tangent *t = SPH_NEW(sph_tangent, 1, "a tangent", &sim->error);
  if (!t) return NULL;
  t->sim = sim;
  t->rate = SPH_NEW(double, sim->layout.length, "rates of a tangent", &sim->error);
  int status = sim->error.status;
  for (int g = 0; !status && g < sim->groups; g++) status = make_group(t, g);
  if (!status) status = make_differences(t);
  if (!status) return sim->tangent = t;
  sph_sim_tangent_free(t);
  return NULL;
}

void sph_sim_tangent_free(sph_tangent *t)
{
  if (!t) return;
  for (int g = 0; g < SPH_SETS_MAX; g++) {
    sph_tangent_group *own = &t->group[g];
    for (int s = 0; s < SPH_PAIR_SUMS; s++) sph_memory_free(own->sum_d[s]);
    for (int k = 0; k < 6; k++) sph_memory_free(own->matrix[k]);
    double *slope[] = {own->p_rho, own->p_u, own->c_rho, own->c_u, own->T_rho, own->T_u};
    for (int k = 0; k < 6; k++) sph_memory_free(slope[k]);
    sph_memory_free(own->record_d);
    sph_memory_free(own->point);
    sph_memory_free(t->beside[g]);
    sph_memory_free(t->record[g]);
  }
  sph_memory_free(t->rate);
  sph_memory_free(t->body);
  sph_memory_free(t->drag);
  sph_memory_free(t->beside_rate);
  sph_sim_transposed_free(t->transposed);
  sph_memory_free(t);
}

/* ---- phases ---- */

/* Entries of s that belong to particle i. */
static void take_state(const sph_tangent *t, int g)
{
  const sph_group *group = t->sim->group[g];
  sph_point *point = t->group[g].point;
  memset(point, 0, (size_t)group->n * sizeof *point);
  if (!t->s || group->wall) return;
  const sph_view s = sph_group_data_view(group, t->s, NULL);
  const int energy = sph_group_data_energy(group) >= 0;
  for (long i = 0; i < group->n; i++) {
    for (int d = 0; d < group->dim; d++) {
      point[i].x[d] = s.x[d][i];
      point[i].v[d] = s.v[d][i];
    }
    if (!group->summed) point[i].rho = s.rho[i];
    if (energy) point[i].energy = s.energy[i];
    for (int q = 0; q < group->scalars; q++) point[i].s[q] = s.s[q][i];
  }
}

static void clear_sums(sph_tangent *t, int g)
{
  for (int s = 0; s < SPH_PAIR_SUMS; s++)
    if (t->group[g].sum_d[s])
      memset(t->group[g].sum_d[s], 0, (size_t)t->sim->sorted[g].room * sizeof(double));
}

/* Records of group g that hold positions and what does not change. */
static void positions(const sph_tangent *t, int g)
{
  const sph_sim *sim = t->sim;
  const int *order = sph_neighbors_order(sim->neighbors, g);
  const long stride = sim->sorted[g].stride;
  double *record = t->group[g].record_d;
  memset(record, 0, (size_t)(sim->sorted[g].room * stride) * sizeof *record);
  for (long s = 0; s < sim->group[g]->n; s++)
    for (int d = 0; d < sim->dim; d++) record[s * stride + d] = t->group[g].point[order[s]].x[d];
}

/* For summed densities; records hold positions and masses. */
static int density(sph_tangent *t)
{
  sph_sim *sim = t->sim;
  int status = sph_sim_density(&t->e);
  if (status || !t->e.part->density) return status;
  const double W_d = sph_sim_tangent_call_number(t, &sim->W_scale);
  for (int g = 0; g < sim->groups; g++) positions(t, g);
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
    clear_sums(t, g);
    for (int s = 0; s < sim->groups; s++)
      if (sph_sim_interaction_same_species(sim->group[g], sim->group[s]))
        sph_sim_tangent_loop(t, SPH_TANGENT_density, g, s);
    for (long s = 0; s < sim->group[g]->n; s++)
      t->group[g].point[order[s]].rho =
          sim->W_scale * t->group[g].sum_d[0][s] + W_d / sim->W_scale * t->e.view[g].rho[order[s]];
  }
  return SPH_OK;
}

/* Derivatives of the equation of state. */
static void slopes(sph_tangent *t, int g)
{
  const sph_group *group = t->sim->group[g];
  const sph_view *view = &t->e.view[g];
  sph_tangent_group *own = &t->group[g];
#pragma omp parallel for num_threads(t->sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long i = 0; i < view->n; i += CHUNK) {
    long some = view->n - i < CHUNK ? view->n - i : CHUNK;
    sph_eos_slopes(&group->eos, some, view->rho + i, group->eos.thermal ? view->u + i : NULL,
                   own->p_rho + i, own->p_u + i, own->c_rho + i, own->c_u + i);
    if (view->u && group->eos.c_v > 0)
      sph_eos_slopes_temperature(&group->eos, some, view->rho + i, view->u + i, own->T_rho + i,
                                 own->T_u + i);
  }
}

/* One map for all particles of a group. */
static void each_point(const sph_tangent *t, int g, sph_local_map *map)
{
  const long n = t->sim->group[g]->n;
#pragma omp parallel for num_threads(t->sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long i = 0; i < n; i++) {
    const sph_local k = {t, t->sim->group[g], &t->e.view[g], i, 0};
    sph_point *point = &t->group[g].point[i];
    map(&k, (const double *)point, (double *)point);
  }
}

static int material(sph_tangent *t)
{
  int status = sph_sim_material_eos(&t->e);
  if (status || !t->e.part->eos) return status;
  for (int g = 0; g < t->sim->groups; g++) {
    if (t->sim->group[g]->wall) continue;
    slopes(t, g);
    each_point(t, g, sph_sim_tangent_map_eos);
  }
  return sph_sim_tangent_call_eos(t);
}

/* Points of group g to derivatives of its records. */
static void pack(const sph_tangent *t, int g)
{
  const int *order = sph_neighbors_order(t->sim->neighbors, g);
  const long n = t->sim->group[g]->n, stride = t->sim->sorted[g].stride;
#pragma omp parallel for num_threads(t->sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long s = 0; s < n; s++) {
    const sph_local k = {t, t->sim->group[g], &t->e.view[g], order[s], s};
    double *record = t->group[g].record_d + s * stride;
    memset(record, 0, (size_t)stride * sizeof *record);
    sph_sim_tangent_map_pack(&k, (const double *)&t->group[g].point[order[s]], record);
  }
}

/* Of all fluids, or all walls. */
static void pack_all(const sph_tangent *t, int walls)
{
  for (int g = 0; g < t->sim->groups; g++)
    if (t->sim->group[g]->wall == walls) pack(t, g);
}

static void sums_in(const sph_tangent *t, int g, long s, double *in)
{
  for (int q = 0; q < SPH_PAIR_SUMS; q++)
    in[q] = t->group[g].sum_d[q] ? t->group[g].sum_d[q][s] : 0;
}

static void wall(sph_tangent *t, int g)
{
  sph_sim *sim = t->sim;
  const int *order = sph_neighbors_order(sim->neighbors, g);
  positions(t, g);
  clear_sums(t, g);
  t->motion[g] = sph_sim_walls_motion(&t->sim->group[g]->boundary, t->e.t);
  for (int f = 0; f < sim->groups; f++)
    if (!sim->group[f]->wall && !sim->group[f]->eos.dust)
      sph_sim_tangent_loop(t, SPH_TANGENT_wall, g, f);
  for (long s = 0; s < sim->group[g]->n; s++) {
    const sph_local k = {t, sim->group[g], &t->e.view[g], order[s], s};
    double in[SPH_PAIR_SUMS];
    sums_in(t, g, s, in);
    sph_sim_tangent_map_wall(&k, in, (double *)&t->group[g].point[order[s]]);
  }
}

static int walls(sph_tangent *t)
{
  sph_sim *sim = t->sim;
  int status = sph_sim_walls_fill(&t->e);
  if (status || !t->e.part->pairs) return status;
  sph_sim_tangent_call_phi(t, 0);
  pack_all(t, 0);
  for (int g = 0; g < sim->groups && t->e.part->walls; g++) {
    if (!sim->group[g]->wall) continue;
    if (!t->lagged) wall(t, g);
    sph_sim_tangent_call_walls(t, g);
    double T_d = 2 * sph_sim_tangent_call_number(t, &sim->group[g]->boundary.temperature);
    for (long i = 0; i < sim->group[g]->n; i++) t->group[g].point[i].T += T_d;
    sph_sim_tangent_call_heat(t, g);
  }
  sph_sim_tangent_call_phi(t, 1);
  if (t->e.part->walls) pack_all(t, 1);
  return SPH_OK;
}

/* The sums of the gradient matrix, which the next loops overwrite. */
static void keep_matrix(const sph_tangent *t, int g)
{
  const sph_sorted *sorted = &t->sim->sorted[g];
  for (int q = 0; q < gradient_sums(t->sim->dim) - t->sim->dim; q++)
    memcpy(t->group[g].matrix[q], sorted->sum[q], (size_t)sorted->room * sizeof(double));
}

static int gradients(sph_tangent *t)
{
  sph_sim *sim = t->sim;
  int status = sph_sim_gradients(&t->e);
  if (status || !t->e.part->gradients || t->lagged) return status;
  const int dim = sim->dim;
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall || sim->group[g]->eos.dust) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
    keep_matrix(t, g);
    clear_sums(t, g);
    for (int s = 0; s < sim->groups; s++)
      if (sph_sim_interaction_same_fluid(sim->group[g], sim->group[s]))
        sph_sim_tangent_loop(t, SPH_TANGENT_gradient, g, s);
    for (long s = 0; s < sim->group[g]->n; s++) {
      const sph_local k = {t, sim->group[g], &t->e.view[g], order[s], s};
      sph_point *point = &t->group[g].point[order[s]];
      double in[SPH_PAIR_SUMS];
      sums_in(t, g, s, in);
      sph_sim_tangent_map_gradient(&k, in, (double *)point);
      for (int d = 0; d < dim; d++)
        t->group[g].record_d[s * sim->sorted[g].stride + slot_extra(dim) + d] = point->extra[d];
    }
  }
  return SPH_OK;
}

/* Rates of one group from the changes of its sums. */
static void rates(const sph_tangent *t, int g, double *out)
{
  const sph_sim *sim = t->sim;
  const sph_group *group = sim->group[g];
  const int *order = sph_neighbors_order(sim->neighbors, g);
  const sph_view to = sph_group_data_view(group, t->y, out);
  const sph_view body = sph_group_data_view(group, t->y, t->body);
  for (long s = 0; s < group->n; s++) {
    const long i = order ? order[s] : s;
    const sph_local k = {t, group, &t->e.view[g], i, s};
    double in[SPH_RATES_IN] = {0}, rate[SPH_RATES_OUT] = {0};
    if (t->e.part->pairs) sums_in(t, g, s, in);
    memcpy(in + SPH_PAIR_SUMS, &t->group[g].point[i], sizeof(sph_point));
    double *add = in + SPH_PAIR_SUMS + SPH_POINT;
    if (body.du) add[0] = body.du[i];
    for (int d = 0; d < sim->dim; d++) add[1 + d] = body.dv[d][i];
    sph_sim_tangent_map_rates(&k, in, rate);
    for (int d = 0; d < sim->dim; d++) {
      to.dx[d][i] += rate[d];
      to.dv[d][i] += rate[3 + d];
    }
    if (to.drho) to.drho[i] += rate[6] + body.drho[i];
    if (to.du) to.du[i] += rate[7];
    for (int q = 0; q < group->scalars; q++) to.ds[q][i] += rate[8 + q] + body.ds[q][i];
  }
}

/* Rates of f itself by drag, kept; their changes, added to those by body terms. */
static int drag(sph_tangent *t)
{
  sph_sim *sim = t->sim;
  sph_evaluation e = t->e;
  memset(t->drag, 0, (size_t)sim->layout.length * sizeof *t->drag);
  if (!t->e.part->drag) return SPH_OK;
  for (int g = 0; g < sim->groups; g++) {
    const int *order = sph_neighbors_order(sim->neighbors, g);
    const sph_view to = sph_group_data_view(sim->group[g], t->y, t->body);
    double *const *sum = t->group[g].sum_d;
    e.view[g] = sph_group_data_view(sim->group[g], t->y, t->drag);
    if (sim->group[g]->wall) continue;
    clear_sums(t, g);
    for (int s = 0; s < sim->groups; s++)
      if (sph_sim_drag_acts(sim, sim->group[g], sim->group[s]))
        sph_sim_tangent_loop(t, SPH_TANGENT_drag, g, s);
    for (long s = 0; s < sim->group[g]->n; s++) {
      for (int d = 0; d < sim->dim; d++) to.dv[d][order[s]] += sum[SPH_DRAG_A + d][s];
      if (to.du) to.du[order[s]] += sum[SPH_DRAG_HEAT][s];
    }
  }
  int status = sph_sim_drag_add(&e);
  for (long i = 0; i < sim->layout.length; i++) t->rate[i] += t->drag[i];
  return status;
}

static int pairs(sph_tangent *t, double *out)
{
  sph_sim *sim = t->sim;
  for (int g = 0; g < sim->groups; g++)
    if (!sim->group[g]->wall) clear_sums(t, g);
  sph_sim_tangent_call_tiles(t);
  for (int g = 0; g < sim->groups && t->e.part->pairs; g++)
    for (int s = 0; s < sim->groups && !sim->group[g]->wall; s++)
      if (sph_sim_interaction_same_species(sim->group[g], sim->group[s]))
        sph_sim_tangent_loop(t, SPH_TANGENT_fluid, g, s);
  int status = sph_sim_pairs_add(&t->e);
  for (int g = 0; !status && g < sim->groups; g++)
    if (!sim->group[g]->wall) rates(t, g, out);
  return status ? status : sph_sim_tangent_call_rates(t, out);
}

/* NULL: recorded. */
static sph_tangent *start(sph_sim *sim, int part, double t, const double *y, int lagged)
{
  sph_tangent *own = sph_sim_tangent_get(sim);
  if (!own) return NULL;
  own->e = (sph_evaluation){.sim = sim, .t = t, .part = &sim->part[part], .sums = 1};
  own->y = y;
  own->s = NULL;
  own->theta = NULL;
  own->lagged = lagged;
  for (int g = 0; g < sim->groups; g++)
    own->e.view[g] = sph_group_data_view(sim->group[g], y, own->rate);
  return own;
}

int sph_sim_tangent(sph_sim *sim, int part, double t, const double *y, const double *s,
                    const sph_parameter *theta, int lagged, double *out)
{
  sph_tangent *own = start(sim, part, t, y, lagged);
  if (!own) return sim->error.status;
  own->s = s;
  own->theta = theta;
  memset(out, 0, (size_t)sim->layout.length * sizeof *out);
  for (int g = 0; g < sim->groups; g++) {
    take_state(own, g);
    if (sim->group[g]->wall) sph_sim_tangent_call_motion(own, g);
  }
  int status = sph_sim_walls_move(&own->e);
  if (!status && own->e.part->lists) status = sph_sim_lists_update(&own->e);
  if (!status) status = density(own);
  if (!status) status = material(own);
  if (!status) status = sph_sim_bodies_add(&own->e);
  if (!status) status = sph_sim_tangent_call_bodies(own);
  if (!status) status = walls(own);
  if (!status) status = gradients(own);
  if (!status) status = drag(own);
  if (!status) status = pairs(own, out);
  return status;
}

int sph_sim_tangent_base(sph_sim *sim, int part, double t, const double *y, int lagged)
{
  sph_tangent *own = start(sim, part, t, y, lagged);
  if (!own) return sim->error.status;
  int status = sph_sim_walls_move(&own->e);
  if (!status && own->e.part->lists) status = sph_sim_lists_update(&own->e);
  if (!status) status = sph_sim_density(&own->e);
  if (!status) status = sph_sim_material_eos(&own->e);
  if (!status) status = sph_sim_bodies_add(&own->e);
  if (!status) status = sph_sim_walls_fill(&own->e);
  if (!status) status = sph_sim_gradients(&own->e);
  for (int g = 0; !status && g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (group->wall) own->motion[g] = sph_sim_walls_motion(&group->boundary, own->e.t);
    if (group->wall) continue;
    if (own->e.part->eos) slopes(own, g);
    if (own->e.part->gradients && !group->eos.dust) keep_matrix(own, g);
  }
  if (!status) status = sph_sim_drag_add(&own->e);
  return status ? status : sph_sim_pairs_add(&own->e);
}
