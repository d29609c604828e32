#include "sim_prepare.h"

#include <math.h>
#include <string.h>

#include "cpu.h"
#include "fluid_loops.h"
#include "memory.h"
#include "sim_rhs.h"
#include "sim_weights.h"
#include "sundials.h"

/* Does every group have what it needs? */
static int check_groups(sph_sim *sim)
{
  long fluids = 0;
  sph_group *fluid = NULL;
  for (int g = 0; g < sim->groups; g++)
    if (!sim->group[g]->wall) {
      fluids += sim->group[g]->n;
      if (!fluid) fluid = sim->group[g];
    }
  if (fluids == 0)
    return sph_sim_fail(sim, SPH_ERR_STATE,
                        "no fluid particles: add a group with sph_group_box first");
  for (int g = 0; g < sim->groups; g++) {
    sph_group *group = sim->group[g];
    if (!group->wall && !group->has_eos)
      return sph_sim_fail(sim, SPH_ERR_STATE,
                          "group %s has no equation of state: sph_group_set_eos", group->name);
    if (!group->wall && group->eos.thermal != fluid->eos.thermal)
      return sph_sim_fail(
          sim, SPH_ERR_STATE,
          "groups %s and %s: all fluids or none must have a thermal equation of state", fluid->name,
          group->name);
    if (group->wall && !group->has_boundary)
      return sph_sim_fail(sim, SPH_ERR_STATE,
                          "wall %s has no boundary model: sph_group_set_boundary", group->name);
    if (!group->wall || group->has_eos) continue;
    group->eos = fluid->eos; /* borrowed: the fluid lets go of it */
    group->eos.free = NULL;
    group->has_eos = 1;
  }
  return SPH_OK;
}

static int check_values(sph_sim *sim)
{
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (group->wall) {
      if (group->eos.density) continue;
      return sph_sim_fail(
          sim, SPH_ERR_STATE,
          "wall %s: the equation of state has no inverse (density), which walls need", group->name);
    }
    for (long i = 0; i < group->n; i++) {
      double rho = group->own[SPH_DENSITY][0][i], m = group->own[SPH_MASS][0][i];
      double u = group->own[SPH_ENERGY][0][i];
      if (!(rho > 0 && isfinite(rho)) || !(m > 0 && isfinite(m)))
        return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                            "group %s, particle %ld: density %g, mass %g; right is > 0",
                            group->name, i, rho, m);
      if (group->eos.thermal && !(u > 0 && isfinite(u)))
        return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                            "group %s, particle %ld: internal energy %g; right is > 0", group->name,
                            i, u);
    }
  }
  return SPH_OK;
}

/* Would a term do nothing?  It is more likely to be meant otherwise. */
static int check_terms(sph_sim *sim)
{
  const unsigned diffusion = SPH_MOLTENI | SPH_ANTUONO;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (group->wall) continue;
    if ((sim->terms.bits & SPH_CONDUCTIVITY) && !group->eos.thermal)
      return sph_sim_fail(
          sim, SPH_ERR_ARGUMENT,
          "conductivity-artificial acts on internal energy, which %s with equation of state "
          "%s has not: leave the term out",
          group->name, group->eos.name);
    if ((sim->terms.bits & diffusion) && sim->terms.delta > 0 && !(group->eos.c0 > 0))
      return sph_sim_fail(
          sim, SPH_ERR_ARGUMENT,
          "delta needs a reference sound speed, which equation of state %s of %s has not "
          "(c0 = %g): leave the term out or set eos.c0",
          group->eos.name, group->name, group->eos.c0);
  }
  return SPH_OK;
}

/* Positions may have been written since walls were added: their motion starts there. */
static void start_walls(sph_sim *sim)
{
  for (int g = 0; g < sim->groups; g++)
    for (int d = 0; sim->group[g]->wall && d < sim->dim; d++)
      memcpy(sim->group[g]->start[d], sim->group[g]->own[SPH_POSITION][d],
             (size_t)sim->group[g]->n * sizeof(double));
}

/* The loop over fluid pairs: its terms and constants (fluid_pair.h). */
static void make_constants(sph_sim *sim)
{
  const sph_term_set *terms = &sim->terms;
  int thermal = 0;
  for (int g = 0; g < sim->groups; g++) thermal |= sim->group[g]->eos.thermal;
  sim->loop_terms = terms->bits;
  if (thermal) sim->loop_terms |= SPH_THERMAL;
  if (!terms->form_c1) sim->loop_terms |= SPH_FORM_C2;
  if (terms->alpha == 0 && terms->beta == 0) sim->loop_terms &= ~(unsigned)SPH_ARTIFICIAL;
  if (terms->delta == 0) sim->loop_terms &= ~(unsigned)(SPH_MOLTENI | SPH_ANTUONO);
  sim->constants = (fluid_constants){.terms = sim->loop_terms,
                                     .inverse_h = 1 / sim->h,
                                     .eta2 = 0.01 * sim->h * sim->h,
                                     .viscosity_1 = -terms->alpha * sim->h,
                                     .viscosity_2 = 2 * terms->beta * sim->h * sim->h,
                                     .alpha_u = terms->alpha_u};
  sim->F_scale = sph_kernel_sigma(sim->kernel, sim->dim) / pow(sim->h, sim->dim + 2);
}

static int make_vectors(sph_sim *sim)
{
  sim->layout.segment =
      SPH_NEW(sph_segment, sim->groups * SPH_FIELDS * 3, "the layout", &sim->error);
  if (!sim->layout.segment) return SPH_ERR_MEMORY;
  for (int g = 0; g < sim->groups; g++) sph_group_data_place(sim->group[g], &sim->layout);
  sim->context = sph_sundials_context(&sim->error);
  if (!sim->context) return sim->error.status;
  N_Vector *vector[] = {&sim->y, &sim->ydot, &sim->frame};
  for (int k = 0; k < 3; k++)
    if (!(*vector[k] = sph_nvector_create(&sim->layout, sim->threads, sim->context, &sim->error)))
      return sim->error.status;
  for (int g = 0; g < sim->groups; g++)
    sph_group_data_move(sim->group[g], sph_nvector_data(sim->y));
  sim->shown = sim->y;
  return SPH_OK;
}

static int make_sorted(sph_sim *sim, int g)
{
  sph_sorted *sorted = &sim->sorted[g];
  unsigned terms = sim->loop_terms;
  for (int k = 0; k < sim->groups; k++)
    if (sim->group[k]->wall) terms |= SPH_WALL;
  sorted->stride = fluid_slots(sim->dim, terms);
  sorted->room = sim->group[g]->capacity;
  sorted->record =
      SPH_NEW(double, sorted->room * sorted->stride + SPH_PAIR_SLOTS, "records", &sim->error);
  for (int s = 0; s < SPH_PAIR_SUMS; s++)
    sorted->sum[s] = SPH_NEW(double, sorted->room, "pair sums", &sim->error);
  for (int d = 0; d < sim->dim; d++)
    sorted->built[d] = SPH_NEW(double, sorted->room, "positions of the lists", &sim->error);
  return sim->error.status;
}

static int make_search(sph_sim *sim)
{
  sph_neighbors_def def = {.dim = sim->dim,
                           .reach = sim->H + sim->skin,
                           .dx = sim->dx,
                           .lanes = sph_cpu_lanes(sim->isa),
                           .threads = sim->threads,
                           .method = sim->neighbors_method};
  for (int d = 0; d < sim->dim; d++) {
    def.periodic[d] = sim->periodic[d];
    def.origin[d] = sim->origin[d];
    def.length[d] = sim->length[d];
  }
  sim->neighbors = sph_neighbors_create(&def, &sim->error);
  return sim->error.status;
}

static int limits(double t, N_Vector y, sph_step_limit *limit, void *ctx)
{
  const sph_sim *sim = ctx;
  (void)t, (void)y;
  for (int k = 0; k < SPH_BOUND_COUNT; k++) limit->dt[k] = INFINITY;
  limit->dt[SPH_BOUND_CFL] = sim->limit_cfl;
  limit->dt[SPH_BOUND_FORCE] = sim->limit_force;
  limit->dt[SPH_BOUND_USER] = sim->limit_user;
  return SPH_OK;
}

/* A state between steps: density and energy positive, all finite. */
static int admissible(double t, N_Vector y, void *ctx)
{
  sph_sim *sim = ctx;
  (void)t;
  for (int g = 0; g < sim->groups; g++) {
    sph_view view = sph_group_data_view(sim->group[g], sph_nvector_data(y), NULL);
    for (long i = 0; !sim->group[g]->wall && i < view.n; i++) {
      double size = view.rho[i] + (view.u ? view.u[i] : 0);
      for (int d = 0; d < sim->dim; d++) size += fabs(view.x[d][i]) + fabs(view.v[d][i]);
      if (!(view.rho[i] > 0) || (view.u && !(view.u[i] > 0)) || !(size < INFINITY))
        return sph_sim_admit_retry(sim, "%s: particle %ld left the admissible states: density %g",
                                   sim->group[g]->name, i, view.rho[i]);
    }
  }
  return SPH_OK;
}

static int make_integrator(sph_sim *sim)
{
  sph_problem problem = {.ctx = sim,
                         .threads = sim->threads,
                         .rhs = sph_sim_rhs,
                         .weights = sph_sim_weights,
                         .limits = limits,
                         .admissible = admissible,
                         .error = &sim->error};
  sim->integrator = sph_integrator_create(&sim->integrator_def, &problem, sim->time, sim->y,
                                          sim->context, &sim->error);
  return sim->error.status;
}

int sph_sim_prepare(sph_sim *sim)
{
  if (!sph_sim_data_ok(sim)) return sph_sim_status(sim);
  if (sim->prepared) return SPH_OK;
  int status = sph_term_set_check(&sim->terms, &sim->error);
  if (!status) status = check_groups(sim);
  if (!status) status = check_values(sim);
  if (!status) status = check_terms(sim);
  if (!status) start_walls(sim);
  if (!status) make_constants(sim);
  if (!status) status = make_vectors(sim);
  for (int g = 0; !status && g < sim->groups; g++) status = make_sorted(sim, g);
  if (!status) status = make_search(sim);
  if (!status) status = sph_sim_rhs(sim->time, sim->y, sim->ydot, sim); /* p and c for the scales */
  if (status > 0)
    status =
        sph_sim_fail(sim, SPH_ERR_ARGUMENT, "the initial state is not admissible: %s", sim->retry);
  if (!status && sim->near)
    status = sph_sim_fail(
        sim, SPH_ERR_ARGUMENT,
        "%ld particles start nearer than 0.1 dx = %g m to another (a wall in the fluid, "
        "or two shapes that overlap?)",
        sim->near, 0.1 * sim->dx);
  for (int g = 0; !status && g < sim->groups; g++) {
    sph_view view = sph_group_data_view(sim->group[g], sph_nvector_data(sim->y), NULL);
    if (!sim->group[g]->wall) sph_sim_weights_scales(sim, g, &view);
  }
  if (!status) status = make_integrator(sim);
  sim->prepared = sim->derived = !status;
  sim->start = sim->time;
  sim->revision++;
  return status;
}

void sph_sim_prepare_undo(sph_sim *sim)
{
  sph_integrator_free(sim->integrator);
  if (sim->y) N_VDestroy(sim->y);
  if (sim->ydot) N_VDestroy(sim->ydot);
  if (sim->frame) N_VDestroy(sim->frame);
  sph_sundials_context_free(sim->context);
  sph_memory_free(sim->layout.segment);
  sph_neighbors_free(sim->neighbors);
  for (int g = 0; g < sim->groups; g++) {
    sph_memory_free(sim->sorted[g].record);
    for (int s = 0; s < SPH_PAIR_SUMS; s++) sph_memory_free(sim->sorted[g].sum[s]);
    for (int d = 0; d < 3; d++) sph_memory_free(sim->sorted[g].built[d]);
  }
}
