#include "sim_prepare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cpu.h"
#include "eos_table.h"
#include "gradient_pair.h"
#include "memory.h"
#include "shift_pair.h"
#include "sim_dominant.h"
#include "sim_energy.h"
#include "sim_extremes.h"
#include "sim_failure.h"
#include "sim_fit.h"
#include "sim_implicit.h"
#include "sim_keep.h"
#include "sim_mirror.h"
#include "sim_overlap.h"
#include "sim_parts.h"
#include "sim_relax.h"
#include "sim_rhs.h"
#include "sim_single.h"
#include "sim_tangent.h"
#include "sim_weights.h"
#include "sundials.h"
#include "switch_pair.h"
#include "term_part.h"
#include "wall_pair.h"

/* Does every group have what it needs? */
static int check_groups(sph_sim *sim)
{
  long fluids = 0, dusts = 0;
  sph_group *fluid = NULL;
  for (int g = 0; g < sim->groups; g++) {
    dusts += sim->group[g]->eos.dust;
    if (!sim->group[g]->wall && !sim->group[g]->eos.dust) {
      fluids += sim->group[g]->n;
      if (!fluid) fluid = sim->group[g];
    }
  }
  if (fluids == 0)
    return sph_sim_fail(sim, SPH_ERR_STATE,
                        "no fluid particles: add a group with sph_group_box first%s",
                        dusts ? " (dust alone is none)" : "");
  for (int g = 0; g < sim->groups; g++) {
    sph_group *group = sim->group[g];
    if (!group->wall && !group->has_eos)
      return sph_sim_fail(sim, SPH_ERR_STATE,
                          "group %s has no equation of state: sph_group_set_eos", group->name);
    if (group->eos.dust && sph_group_data_energy(group) >= 0)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "group %s: dust has no energy, not %s; drag heats the fluid", group->name,
                          sph_group_energy(group));
    if (!group->wall && !group->eos.dust &&
        (sph_group_data_energy(group) < 0) != (sph_group_data_energy(fluid) < 0))
      return sph_sim_fail(sim, SPH_ERR_STATE,
                          "groups %s and %s: all fluids or none must have an energy "
                          "(sph_group_set_energy)",
                          fluid->name, group->name);
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
      if (!(rho > 0 && isfinite(rho)) || !(m > 0 && isfinite(m)))
        return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                            "group %s, particle %ld: density %g, mass %g; right is > 0",
                            group->name, i, rho, m);
    }
    const double *rho = group->own[SPH_DENSITY][0], *u = group->own[SPH_ENERGY][0];
    long bad = sph_eos_find_bad(&group->eos, group->n, rho, group->eos.thermal ? u : NULL);
    if (bad >= 0)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "group %s, particle %ld: no state of equation of state %s has density "
                          "%g, internal energy %g",
                          group->name, bad, group->eos.name, rho[bad], u[bad]);
  }
  return SPH_OK;
}

/* Would a term do nothing?  It is more likely to be meant otherwise. */
static int check_heat(sph_sim *sim, const sph_group *group)
{
  const unsigned bits = sim->terms.bits;
  int energy = sph_group_data_energy(group) >= 0;
  if ((bits & SPH_CONDUCTIVITY) && !group->eos.thermal)
    return sph_sim_fail(
        sim, SPH_ERR_ARGUMENT,
        "conductivity-artificial acts on internal energy, which %s with equation of state "
        "%s has not: leave the term out",
        group->name, group->eos.name);
  if ((bits & SPH_CONDUCTION) && !(energy && group->eos.c_v > 0))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "conduction needs a temperature, which %s has not: give it %s", group->name,
                        energy ? "a specific heat (eos.c_v)"
                               : "an energy (sph_group_set_energy) and a specific heat (eos.c_v)");
  if (sim->terms.heats && !energy)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "heat-source heats an energy, which %s has not: sph_group_set_energy",
                        group->name);
  return SPH_OK;
}

/* x of Fourtakas' series, at most: gamma |g| H/c0^2. */
static int check_fourtakas(sph_sim *sim, const sph_group *group)
{
  const sph_eos *eos = &group->eos;
  double g2 = 0;
  for (int d = 0; d < sim->dim; d++) g2 += sim->terms.g[d] * sim->terms.g[d];
  double x = eos->gamma * sqrt(g2) * sim->H / (eos->c0 * eos->c0);
  if (!eos->thermal && eos->gamma >= 1 && x < 0.1) return SPH_OK;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "delta fourtakas needs a liquid like tait, linear or murnaghan whose density "
                      "differs little over a support; %s with equation of state %s has gamma g "
                      "H/c0^2 = %g, right is below 0.1",
                      group->name, eos->name, x);
}

/* What follows the particles where they shift: density and velocity of one liquid. */
static int check_advection(sph_sim *sim, const sph_group *group, const sph_group *first)
{
  const unsigned bits = sim->terms.bits;
  const char *name = bits & SPH_SHIFTING ? "shifting" : "transport-velocity";
  if (!(bits & SPH_SHIFTS)) return SPH_OK;
  if (!sph_sim_interaction_same_fluid(group, first))
    return sph_sim_fail(
        sim, SPH_ERR_ARGUMENT,
        "%s: density would follow across from %s to %s, which differ in reference "
        "density or sound speed; right is advection = 0 (in a case: advection: false)",
        name, first->name, group->name);
  if (sph_group_data_energy(group) >= 0 || sim->terms.scalars)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "%s: density and velocity follow the particles of %s, but not its %s; "
                        "right is advection = 0 (in a case: advection: false)",
                        name, group->name,
                        sim->terms.scalars ? sim->terms.scalar[0].name : sph_group_energy(group));
  return SPH_OK;
}

static int check_shift(sph_sim *sim, const sph_group *group, const sph_group *first)
{
  const sph_term *shift = &sim->terms.shift;
  if ((sim->terms.bits & SPH_TRANSPORT) && !(group->eos.c0 > 0 && group->eos.rho0 > 0))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "transport-velocity: equation of state %s of %s has no reference density "
                        "and sound speed (rho0 = %g, c0 = %g); right is a liquid, or shifting with "
                        "advection = 0 (in a case: advection: false)",
                        group->eos.name, group->name, group->eos.rho0, group->eos.c0);
  return shift->advection ? check_advection(sim, group, first) : SPH_OK;
}

/* Groups that a scalar names, and their diffusivities. */
static int check_scalar(sph_sim *sim, const sph_term *term)
{
  for (int k = 0; k < term->by_groups; k++) {
    const sph_group_value *one = &term->by_group[k];
    int g = 0;
    while (g < sim->groups && strcmp(sim->group[g]->name, one->group) != 0) g++;
    if (g == sim->groups)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "term %s: there is no group %s", term->name,
                          one->group);
    if (!sim->group[g]->wall && one->value < 0)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "term %s: diffusivity in %s = %g m^2/s; right is >= 0", term->name,
                          one->group, one->value);
  }
  return SPH_OK;
}

static int check_terms(sph_sim *sim)
{
  double viscosity = 0, conductivity = 0;
  int status = SPH_OK, dusty = 0;
  const sph_group *first = NULL;
  for (int g = 0; !status && g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    dusty |= group->eos.dust;
    if (group->wall || group->eos.dust) continue;
    if (!first) first = group;
    status = check_heat(sim, group);
    if (!status) status = check_shift(sim, group, first);
    if (!status && (sim->terms.bits & SPH_DIFFUSION) && sim->terms.delta > 0 &&
        !(group->eos.c0 > 0))
      status = sph_sim_fail(
          sim, SPH_ERR_ARGUMENT,
          "delta needs a reference sound speed, which equation of state %s of %s has not "
          "(c0 = %g): leave the term out or set eos.c0",
          group->eos.name, group->name, group->eos.c0);
    if (!status && (sim->terms.bits & SPH_FOURTAKAS)) status = check_fourtakas(sim, group);
    viscosity = fmax(viscosity, group->viscosity);
    conductivity = fmax(conductivity, group->conductivity);
  }
  if (!status && (sim->terms.bits & (SPH_MORRIS | SPH_MCG)) && viscosity == 0)
    status = sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "viscosity-laminar: no fluid has a viscosity: sph_group_set_viscosity");
  if (!status && (sim->terms.bits & SPH_CONDUCTION) && conductivity == 0)
    status = sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "conduction: no fluid has a conductivity: sph_group_set_conductivity");
  if (!status && (sim->terms.bits & SPH_DRAG) && !dusty)
    status = sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "drag: there is no dust: a group with equation of state sph_eos_dust");
  for (int k = 0; !status && k < sim->terms.called; k++)
    status = check_scalar(sim, &sim->terms.call[k].term);
  return status;
}

/* What dynamic boundary particles and mirrors do not go with. */
static int check_walls(sph_sim *sim)
{
  const char *implicit = sph_term_part_first(&sim->terms, SPH_TERM_IMPLICIT);
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (!group->wall || group->model == SPH_MODEL_ADAMI) continue;
    if (implicit)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "wall %s: implicit terms (%s) know adami walls alone, not %s",
                          group->name, implicit, group->boundary.name);
    if (group->model == SPH_MODEL_MIRROR) continue;
    if (group->eos.thermal)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "wall %s: dbc has no energy for equation of state %s; right is one "
                          "p(rho), or boundary adami",
                          group->name, group->eos.name);
    if (sim->terms.summed || !(sim->terms.bits & SPH_CONTINUITY))
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "wall %s: the density of dbc follows the term continuity, which there "
                          "is not",
                          group->name);
    for (long i = 0; i < group->n; i++)
      if (!(group->own[SPH_DENSITY][0][i] > 0 && group->own[SPH_DENSITY][0][i] < INFINITY))
        return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                            "wall %s, particle %ld: density %g; right is > 0", group->name, i,
                            group->own[SPH_DENSITY][0][i]);
  }
  return SPH_OK;
}

/* Positions may have been written since walls were added: their motion starts there. */
static int start_walls(sph_sim *sim)
{
  int status = SPH_OK;
  for (int g = 0; !status && g < sim->groups; g++) {
    sph_group *group = sim->group[g];
    if (!group->wall || !group->n) continue; /* a mirror has no particles */
    for (int d = 0; d < sim->dim; d++)
      memcpy(group->start[d], group->own[SPH_POSITION][d], (size_t)group->n * sizeof(double));
    if (group->boundary.temperature_at && sim->needs_temperature)
      status = sph_group_data_own(group, SPH_TEMPERATURE, &sim->error);
  }
  return status;
}

void sph_sim_prepare_h(sph_sim *sim)
{
  sim->H = sph_kernel_support(sim->kernel) * sim->h;
  sim->constants.inverse_h = 1 / sim->h;
  sim->W_scale = sph_kernel_sigma(sim->kernel, sim->dim) / pow(sim->h, sim->dim);
  sim->F_scale = sim->W_scale / (sim->h * sim->h);
}

/* The loops over pairs: their terms and what these need. */
static int make_terms(sph_sim *sim)
{
  const sph_term_set *terms = &sim->terms;
  unsigned bits = terms->bits;
  for (int g = 0; g < sim->groups; g++)
    if (sph_group_data_energy(sim->group[g]) >= 0) bits |= SPH_THERMAL;
  if (terms->form_phi) bits |= SPH_FORM_PHI;
  if (!terms->form_phi && !terms->form_c1) bits |= SPH_FORM_C2;
  if (terms->summed && (bits & SPH_THERMAL)) bits |= SPH_CONTINUITY; /* for the work of pressure */
  if (terms->alpha == 0 && terms->beta == 0) bits &= ~(unsigned)SPH_ARTIFICIAL;
  if (terms->signal_alpha == 0) bits &= ~(unsigned)SPH_SIGNAL;
  if (!(bits & (SPH_ARTIFICIAL | SPH_SIGNAL))) bits &= ~(unsigned)SPH_SWITCHES;
  if (terms->epsilon == 0) bits &= ~(unsigned)SPH_XSPH;
  if (terms->stress_alpha == 0 && terms->stress_beta == 0) bits &= ~(unsigned)SPH_STRESS;
  if (terms->shift.strength == 0) bits &= ~(unsigned)SPH_SHIFTING;
  if (terms->delta == 0) bits &= ~(unsigned)SPH_DIFFUSION;
  if (terms->drag_K == 0 && terms->drag_rate == 0) bits &= ~(unsigned)SPH_DRAG;
  bits = (bits & ~(unsigned)SPH_CORRECTED) | fluid_corrections(bits);
  sim->loop_terms = bits;
  sim->constants = (fluid_constants){.terms = bits, .kernel = sim->kernel_number};
  sph_sim_prepare_h(sim);
  sim->needs_temperature = (bits & SPH_CONDUCTION) || sph_sim_implicit_heats(sim);
  int status = sph_sim_parts_make(sim);
  if (!status && sim->part[SPH_WHOLE].tiles && terms->scalars && (bits & SPH_CORRECTED))
    status = sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "corrected terms beside pair terms of your own with scalars: there is no "
                          "room for both in the loops; right is correction none, or no scalar");
  if (!status && sim->has_integrator) status = sph_sim_fit(sim);
  sim->fluid_sums = bits & SPH_RARE ? SPH_FLUID_SUMS_ALL : SPH_FLUID_SUMS;
  if (sim->part[SPH_WHOLE].tiles) sim->fluid_sums = SPH_SUM_SCALAR + terms->scalars;
  return status;
}

/* What a group integrates. */
static int start_groups(sph_sim *sim)
{
  int status = SPH_OK;
  sph_sim_density_calibrate(sim);
  for (int g = 0; !status && g < sim->groups; g++) {
    sph_group *group = sim->group[g];
    if (group->wall) continue;
    group->summed = sim->terms.summed;
    status = sph_sim_energy_start(group);
  }
  return status;
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

/* Sums of the loops over a group. */
static int sums_of(const sph_sim *sim, const sph_group *group)
{
  if (group->model == SPH_MODEL_MIRROR) return 0; /* images are no targets */
  int sums = group->wall ? SPH_WALL_SUMS : sim->fluid_sums;
  if (group->model == SPH_MODEL_DBC) sums = SPH_FLUID_SUMS_ALL;
  if (!group->wall && (sim->loop_terms & (SPH_ANTUONO | SPH_CORRECTED)))
    sums = sums > gradient_sums(sim->dim) ? sums : gradient_sums(sim->dim);
  if (!group->wall && (sim->loop_terms & SPH_SHIFTS)) {
    const int own = shift_concentration_sums(sim->dim);
    sums = sums > own ? sums : own;
  }
  const int switched = switch_sum_more(sim->dim) + 2;
  if (!group->wall && (sim->loop_terms & SPH_SWITCHES)) sums = sums > switched ? sums : switched;
  return sums;
}

int sph_sim_prepare_room(sph_sim *sim, int g)
{
  sph_sorted *sorted = &sim->sorted[g];
  const size_t old = (size_t)sorted->room, room = (size_t)sim->group[g]->capacity;
  if (old >= (size_t)sim->group[g]->n + 1) return SPH_OK;
  int status =
      sph_memory_grow((void **)&sorted->record, 0, room * (size_t)sorted->stride + SPH_PAIR_SLOTS,
                      sizeof(double), "records", &sim->error);
  if (!status && sorted->single)
    status =
        sph_memory_grow((void **)&sorted->single, 0, room * (size_t)sorted->stride + SPH_PAIR_SLOTS,
                        sizeof(float), "records in single precision", &sim->error);
  for (int d = 0; !status && d < sim->dim; d++)
    status = sph_memory_grow((void **)&sorted->built[d], old, room, sizeof(double),
                             "positions of the lists", &sim->error);
  if (!status && sorted->phi)
    status = sph_memory_grow((void **)&sorted->phi, 0, room, sizeof(double), "phi", &sim->error);
  if (!status && sorted->shifted)
    status = sph_memory_grow((void **)&sorted->shifted, 0,
                             room * (size_t)shift_slots(sim->dim) + SPH_PAIR_SLOTS, sizeof(double),
                             "records of what shifts", &sim->error);
  if (!status && sorted->shock)
    status = sph_memory_grow((void **)&sorted->shock, 0,
                             room * (size_t)switch_slots(sim->dim) + SPH_PAIR_SLOTS, sizeof(double),
                             "records of a switch", &sim->error);
  if (!status) sorted->room = (long)room;
  return status;
}

static int make_sorted(sph_sim *sim, int g)
{
  sph_sorted *sorted = &sim->sorted[g];
  unsigned terms = sim->loop_terms;
  int mirrors = 0;
  for (int k = 0; k < sim->groups; k++) {
    if (sim->group[k]->wall) terms |= SPH_WALL;
    mirrors |= sim->group[k]->wall && sim->group[k]->model == SPH_MODEL_MIRROR;
  }
  /* Tiles read all slots up to the scalars; the others only those of their terms. */
  sorted->stride =
      fluid_slots(sim->dim, terms, sim->part[SPH_WHOLE].tiles ? sim->terms.scalars : 0);
  sorted->room = (sim->group[g]->n + 7) / 8 * 8; /* whole blocks: what is beyond costs time, too */
  sorted->record =
      SPH_NEW(double, sorted->room * sorted->stride + SPH_PAIR_SLOTS, "records", &sim->error);
  if (sim->single)
    sorted->single = SPH_NEW(float, sorted->room * sorted->stride + SPH_PAIR_SLOTS,
                             "records in single precision", &sim->error);
  for (int s = 0; s < sums_of(sim, sim->group[g]); s++)
    sorted->sum[s] = SPH_NEW(double, sorted->room, "pair sums", &sim->error);
  for (int d = 0; d < sim->dim; d++)
    sorted->built[d] = SPH_NEW(double, sorted->room, "positions of the lists", &sim->error);
  if (sim->loop_terms & SPH_SHIFTS)
    sorted->shifted = SPH_NEW(double, sorted->room *shift_slots(sim->dim) + SPH_PAIR_SLOTS,
                              "records of what shifts", &sim->error);
  const int mirror = sim->group[g]->model == SPH_MODEL_MIRROR && sim->group[g]->wall;
  if ((!sim->group[g]->wall || mirror) && (terms & SPH_CULLEN_DEHNEN))
    sorted->shock = SPH_NEW(double, sorted->room *switch_slots(sim->dim) + SPH_PAIR_SLOTS,
                            "records of a switch", &sim->error);
  if (terms & SPH_FORM_PHI) sorted->phi = SPH_NEW(double, sorted->room, "phi", &sim->error);
  if (!sim->group[g]->wall && mirrors)
    sorted->place = SPH_NEW(int, sorted->room, "sorted places", &sim->error);
  return sim->error.status;
}

sph_neighbors_def sph_sim_prepare_search(const sph_sim *sim, double reach)
{
  sph_neighbors_def def = {.dim = sim->dim, .reach = reach, .dx = sim->dx, .threads = sim->threads};
  for (int d = 0; d < sim->dim; d++) {
    def.periodic[d] = sim->periodic[d];
    def.origin[d] = sim->origin[d];
    def.length[d] = sim->length[d];
  }
  return def;
}

static int make_search(sph_sim *sim)
{
  sph_search own = sim->own_search;
  own.free = NULL; /* it is the simulation's */
  sph_neighbors_def def = sph_sim_prepare_search(sim, sim->H + sim->skin);
  def.lanes = sph_cpu_lanes(sim->isa);
  def.search = sim->uses_own_search ? NULL : sim->search;
  def.own = sim->uses_own_search ? &own : NULL;
  sim->neighbors = sph_neighbors_create(&def, &sim->error);
  return sim->error.status;
}

static int limits(double t, N_Vector y, sph_step_limit *limit, void *ctx)
{
  const sph_sim *sim = ctx;
  (void)t, (void)y;
  memcpy(limit->dt, sim->limit, sizeof limit->dt);
  return SPH_OK;
}

static int limits_fast(double t, N_Vector y, sph_step_limit *limit, void *ctx)
{
  const sph_sim *sim = ctx;
  (void)t, (void)y;
  memcpy(limit->dt, sim->limit_fast, sizeof limit->dt);
  return SPH_OK;
}

static int left(sph_sim *sim, int g, long i, double density)
{
  sph_sim_failure_suspect(sim, g, i);
  return sph_sim_admit_retry(sim, "%s: particle %ld left the admissible states: density %g",
                             sim->group[g]->name, i, density);
}

/* Is that of particles begin .. end - 1 all finite, and density positive?  The first that is not;
 * else `end`. */
static long find_left(const sph_sim *sim, const sph_view *view, int wall, long begin, long end)
{
  for (long i = begin; i < end; i++) {
    double size = view->rho[i] + (view->energy ? fabs(view->energy[i]) : 0);
    for (int q = 0; !wall && q < sim->terms.scalars; q++) size += fabs(view->s[q][i]);
    for (int d = 0; d < sim->dim; d++) size += fabs(view->x[d][i]) + fabs(view->v[d][i]);
    if (!(view->rho[i] > 0) || !(size < INFINITY)) return i;
  }
  return end;
}

/* The first particle of group g that is not finite, or without a positive density, into *left, and
 * the first in no state of the equation of state into *bad; n: none. */
static void look_at(const sph_sim *sim, int g, const sph_view *view, long *left, long *bad)
{
  enum { CHUNK = 1024 };
  const sph_eos *eos = &sim->group[g]->eos;
  const int wall = sim->group[g]->wall,
            stated = !wall && !(eos->thermal && view->energy != view->u);
  const long n = view->n;
  long first = n, lost = n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) \
    reduction(min                                                   \
              : first, lost) if (n > 4096)
  for (long i = 0; i < n; i += CHUNK) {
    const long end = n - i < CHUNK ? n : i + CHUNK, out = find_left(sim, view, wall, i, end);
    if (out < end && out < first) first = out;
    if (out < end || !stated) continue;
    const long at =
        sph_eos_find_bad(eos, end - i, view->rho + i, eos->thermal ? view->u + i : NULL);
    if (at >= 0 && i + at < lost) lost = i + at;
  }
  *left = first;
  *bad = lost;
}

/* A state between steps: all finite, density positive, a state of the equation of state. */
static int admissible(double t, N_Vector y, void *ctx)
{
  sph_sim *sim = ctx;
  (void)t;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const sph_view view = sph_group_data_view(group, sph_nvector_data(y), NULL);
    long first, bad;
    if (group->wall && group->model != SPH_MODEL_DBC) continue;
    look_at(sim, g, &view, &first, &bad);
    if (first < view.n) return left(sim, g, first, view.rho[first]);
    if (bad >= view.n) continue;
    sph_sim_failure_suspect(sim, g, bad);
    return sph_sim_admit_retry(
        sim, "%s: particle %ld is in no state of equation of state %s: density %g", group->name,
        bad, group->eos.name, view.rho[bad]);
  }
  return SPH_OK;
}

sph_problem sph_sim_prepare_problem(sph_sim *sim)
{
  return (sph_problem){.ctx = sim,
                       .threads = sim->threads,
                       .drift = sim->part[SPH_WHOLE].shift || (sim->loop_terms & SPH_XSPH),
                       .rhs = sph_sim_rhs,
                       .rhs_still = sph_sim_rhs_still,
                       .weights = sph_sim_weights,
                       .rhs_piece = sph_sim_rhs_piece,
                       .limits = limits,
                       .limits_fast = limits_fast,
                       .dominant = sph_sim_dominant,
                       .energy = sph_sim_relax_energy,
                       .energy_gradient = sph_sim_relax_gradient,
                       .solve = sim->implicit ? sph_sim_implicit_solve : NULL,
                       .admissible = admissible,
                       .error = &sim->error};
}

static int make_integrator(sph_sim *sim)
{
  const sph_problem problem = sph_sim_prepare_problem(sim);
  sim->integrator = sph_integrator_create(&sim->integrator_def, &problem, sim->time, sim->y,
                                          sim->context, &sim->error);
  return sim->error.status;
}

/* A vector that was never written takes no memory, and most runs never ask for these rates. */
static int make_rates_anew(sph_sim *sim)
{
  N_VDestroy(sim->ydot);
  sim->ydot = sph_nvector_create(&sim->layout, sim->threads, sim->context, &sim->error);
  return sim->error.status;
}

/* Says of which groups the first two are that are too near each other. */
static int refuse_near(sph_sim *sim)
{
  const double near = 0.1 * sim->dx;
  char first[300] = "", place[100];
  sph_neighbors *search = sph_sim_overlap_search(sim, near);
  for (int g = 0; g < sim->groups && search; g++)
    for (int s = 0; s < sim->groups && !sim->group[g]->wall && !*first; s++) {
      const sph_group *a = sim->group[g], *b = sim->group[s];
      sph_overlap found = {0};
      if (sph_sim_interaction_same_species(a, b))
        found = sph_sim_overlap_find(sim, search, g, s, near);
      sph_sim_overlap_place(sim, found.x, place, sizeof place);
      if (found.n)
        snprintf(first, sizeof first, ", the first of %s at %s to one of %s", a->name, place,
                 a == b ? "its own" : b->name);
    }
  sph_neighbors_free(search);
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "%ld particles start nearer than 0.1 dx = %g m to another%s (a wall in the "
                      "fluid, or two shapes that overlap? difference cuts one out of the other)",
                      sim->near, near, first);
}

int sph_sim_prepare(sph_sim *sim)
{
  if (!sph_sim_data_ok(sim)) return sph_sim_status(sim);
  if (sim->prepared) return SPH_OK;
  int status = sph_term_set_check(&sim->terms, &sim->error);
  if (!status && sim->has_integrator) status = sph_sim_parts_fit(sim);
  if (!status) status = check_groups(sim);
  if (!status) status = check_values(sim);
  if (!status) status = check_terms(sim);
  if (!status) status = check_walls(sim);
  if (!status) status = sph_sim_reset_check(sim);
  if (!status) status = sph_sim_implicit_check(sim);
  if (!status) status = make_terms(sim);
  if (!status) status = sph_sim_single_check(sim);
  if (!status) status = start_walls(sim);
  if (!status) status = sph_sim_mirror_check(sim);
  if (!status) status = start_groups(sim);
  if (!status) status = make_vectors(sim);
  if (!status) status = sph_sim_weights_check(sim);
  for (int g = 0; !status && g < sim->groups; g++) status = make_sorted(sim, g);
  if (!status) status = make_search(sim);
  if (!status) status = sph_sim_rhs(sim->time, sim->y, sim->ydot, sim); /* p and c for the scales */
  if (status > 0)
    status =
        sph_sim_fail(sim, SPH_ERR_ARGUMENT, "the initial state is not admissible: %s", sim->retry);
  if (!status && sim->near) status = refuse_near(sim);
  if (!status && (sim->loop_terms & SPH_TRANSPORT) && sim->surface > 0)
    status = sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "transport-velocity: %ld particles start at a free surface, which would "
                          "spread; right is shifting with surface = 1 (in a case: surface: true)",
                          sim->surface);
  if (!status) status = make_rates_anew(sim);
  if (!status) sph_sim_weights_scales(sim);
  if (!status) status = sph_sim_implicit_make(sim);
  if (!status && sim->implicit)
    status = sph_sim_single_refuse(sim, "implicit stages are solved in double precision alone");
  if (!status) status = make_integrator(sim);
  sim->prepared = sim->derived = !status;
  sim->start = sim->time;
  if (!status) sph_sim_extremes_start(sim);
  sph_sim_keep_start(sim);
  sim->revision++;
  return status;
}

void sph_sim_prepare_undo(sph_sim *sim)
{
  sph_integrator_free(sim->integrator);
  sph_sim_implicit_free(sim);
  sph_sim_tangent_free(sim->tangent);
  if (sim->y) N_VDestroy(sim->y);
  if (sim->ydot) N_VDestroy(sim->ydot);
  if (sim->frame) N_VDestroy(sim->frame);
  for (int k = 0; k < 2; k++)
    if (sim->slope[k]) N_VDestroy(sim->slope[k]);
  sph_sundials_context_free(sim->context);
  sph_memory_free(sim->layout.segment);
  sph_neighbors_free(sim->neighbors);
  for (int g = 0; g < sim->groups; g++) {
    sph_memory_free(sim->sorted[g].record);
    sph_memory_free(sim->sorted[g].single);
    sph_memory_free(sim->sorted[g].phi);
    sph_memory_free(sim->sorted[g].shifted);
    sph_memory_free(sim->sorted[g].shock);
    sph_memory_free(sim->sorted[g].place);
    for (int s = 0; s < SPH_PAIR_SUMS; s++) sph_memory_free(sim->sorted[g].sum[s]);
    for (int d = 0; d < 3; d++) sph_memory_free(sim->sorted[g].built[d]);
  }
}
