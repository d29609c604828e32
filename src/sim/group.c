#include "sphode/group.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "eos_table.h"
#include "memory.h"
#include "sim_energy.h"
#include "sim_mirror.h"
#include "sim_run.h"

/* Of walls: what holds blocks of water (tests/property/test_wall_holds.c, docs/walls.md). */
static const double REPULSION = 0.4;

static int ok(const sph_group *group) { return group && sph_sim_data_ok(group->sim); }

static int good_name(const char *name)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return name && *name && strlen(name) < SPH_NAME_MAX && strspn(name, letters) == strlen(name);
}

static int check_new(sph_sim *sim, const char *name, const char *kind)
{
  if (!good_name(name))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group name \"%.80s\"; right is 1 to %d of A-Z a-z 0-9 _ -",
                        name ? name : "", SPH_NAME_MAX - 1);
  if (sph_sim_group(sim, name))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "group %s exists already", name);
  if (!kind || (strcmp(kind, "fluid") && strcmp(kind, "wall")))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "group %s: kind \"%s\"; known: fluid, wall", name,
                        kind ? kind : "");
  if (sim->prepared)
    return sph_sim_fail(sim, SPH_ERR_STATE, "group %s: groups are added before the run", name);
  if (sim->groups == SPH_SETS_MAX)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "group %s: more than %d groups", name, SPH_SETS_MAX);
  return SPH_OK;
}

sph_group *sph_group_create(sph_sim *sim, const char *name, const char *kind)
{
  if (!sph_sim_data_ok(sim) || check_new(sim, name, kind)) return NULL;
  sph_group *group = SPH_NEW(sph_group, 1, "a group", &sim->error);
  if (!group) return NULL;
  snprintf(group->name, sizeof group->name, "%s", name);
  group->sim = sim;
  group->wall = !strcmp(kind, "wall");
  group->repulsion = REPULSION;
  group->dim = sim->dim;
  group->index = sim->groups;
  for (int field = 0; field < SPH_FIELDS; field++)
    for (int c = 0; c < 3; c++) group->offset[field][c] = -1;
  group->scalars = group->wall ? 0 : sim->terms.scalars;
  sim->group[sim->groups++] = group;
  return group;
}

/* Before the run, and the last call found no error? */
static int settable(sph_group *group, const char *what)
{
  if (!ok(group)) return 0;
  if (!group->sim->prepared) return 1;
  sph_sim_fail(group->sim, SPH_ERR_STATE, "group %s: %s is set before the run", group->name, what);
  return 0;
}

void sph_group_set_eos(sph_group *group, sph_eos eos)
{
  int kept = settable(group, "the equation of state") && !sph_eos_check(&eos, &group->sim->error);
  if (kept && group->wall && eos.dust)
    kept = !sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                         "group %s is a wall: it has the equation of state of a fluid, not of dust",
                         group->name);
  if (!kept) {
    if (eos.free) eos.free(eos.ctx);
    return;
  }
  if (group->eos.free) group->eos.free(group->eos.ctx);
  snprintf(group->eos_name, sizeof group->eos_name, "%s", eos.name);
  group->eos = eos;
  group->eos.name = group->eos_name;
  group->has_eos = 1;
}

/* Takes the axis with length 1. */
static int take_rotation(const sph_group *group, sph_boundary *b)
{
  double *n = b->axis, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!b->rotation) return SPH_OK;
  if (length == 0) n[2] = length = 1;
  if (group->dim == 1 || !(length < INFINITY) || (group->dim == 2 && (n[0] != 0 || n[1] != 0)) ||
      !isfinite(b->centre[0] + b->centre[1] + b->centre[2]))
    return sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                        "group %s: a rotation in %dD about the axis (%g, %g, %g) through (%g, %g, "
                        "%g); right is 2D about z or 3D, all finite",
                        group->name, group->dim, n[0], n[1], n[2], b->centre[0], b->centre[1],
                        b->centre[2]);
  for (int d = 0; d < 3; d++) n[d] /= length;
  return SPH_OK;
}

void sph_group_set_boundary(sph_group *group, sph_boundary boundary)
{
  int kept = settable(group, "the boundary");
  if (kept && !group->wall)
    kept = !sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                         "group %s is a fluid: boundaries are for walls", group->name);
  int model = 0;
  while (sph_boundary_name(model) &&
         (!boundary.name || strcmp(sph_boundary_name(model), boundary.name)))
    model++;
  if (kept && !sph_boundary_name(model))
    kept = !sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                         "group %s: boundary \"%s\"; known: adami, dbc, mirror", group->name,
                         boundary.name ? boundary.name : "");
  if (kept && !(boundary.temperature >= 0 && boundary.temperature < INFINITY))
    kept =
        !sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                      "group %s: temperature of the boundary %g K; right is > 0 and finite, or 0: "
                      "adiabatic",
                      group->name, boundary.temperature);
  kept = kept && !sph_sim_mirror_take(group->sim, group, &boundary) &&
         !take_rotation(group, &boundary);
  if (!kept) {
    if (boundary.free) boundary.free(boundary.ctx);
    return;
  }
  if (group->boundary.free) group->boundary.free(group->boundary.ctx);
  group->boundary = boundary;
  group->boundary.name = sph_boundary_name(model);
  group->model = (enum sph_wall_model)model;
  group->has_boundary = 1;
}

void sph_group_set_repulsion(sph_group *group, double epsilon)
{
  if (!settable(group, "the repulsion")) return;
  if (!group->wall)
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s is a fluid: a repulsion is of walls",
                 group->name);
  else if (!(epsilon >= 0 && epsilon < INFINITY))
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                 "group %s: repulsion %g; right is >= 0 and finite (0.4), or 0: none", group->name,
                 epsilon);
  else
    group->repulsion = epsilon;
}

/* A property >= 0 and finite, before the run; later where a loop over pairs has such terms. */
static void set_property(sph_group *group, double *to, unsigned terms, const char *what,
                         double value, const char *unit)
{
  if (!ok(group)) return;
  sph_sim *sim = group->sim;
  if (sim->prepared && !(sim->loop_terms & terms))
    sph_sim_fail(sim, SPH_ERR_STATE,
                 "group %s: %s is set before the run where no term asks for it at the start",
                 group->name, what);
  else if (sim->prepared && sim->shown != sim->y)
    sph_sim_fail(sim, SPH_ERR_STATE, "group %s: %s changes between steps", group->name, what);
  else if (!(value >= 0 && isfinite(value)))
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "group %s: %s %g %s; right is >= 0 and finite", group->name,
                 what, value, unit);
  else {
    *to = value;
    sph_sim_changed(sim);
  }
}

void sph_group_set_viscosity(sph_group *group, double eta)
{
  if (group) set_property(group, &group->viscosity, SPH_MORRIS | SPH_MCG, "viscosity", eta, "Pa s");
}

void sph_group_set_conductivity(sph_group *group, double kappa)
{
  if (group)
    set_property(group, &group->conductivity, SPH_CONDUCTION, "conductivity", kappa, "W/(m K)");
}

double sph_group_viscosity(const sph_group *group) { return group ? group->viscosity : 0; }

double sph_group_conductivity(const sph_group *group) { return group ? group->conductivity : 0; }

const char *sph_group_name(const sph_group *group) { return group ? group->name : ""; }

const char *sph_group_kind(const sph_group *group)
{
  return !group ? "" : group->wall ? "wall" : "fluid";
}

long sph_group_count(const sph_group *group) { return group ? group->n : 0; }

const sph_eos *sph_group_eos(const sph_group *group)
{
  return group && group->has_eos ? &group->eos : NULL;
}

int sph_group_thermal(const sph_group *group)
{
  return group && group->has_eos && group->eos.thermal;
}

const long *sph_group_ids(const sph_group *group)
{
  if (!group) return NULL;
  sph_group *own = group->sim->group[group->index];
  return sph_group_data_ids(own, &own->sim->error);
}

long sph_group_id(const sph_group *group, long i)
{
  return group && i >= 0 && i < group->n ? sph_group_data_id(group, i) : -1;
}

/* ---- energies ---- */

static const char *const energies[] = {[SPH_ENERGY_NONE] = "none",
                                       [SPH_ENERGY_U] = "u",
                                       [SPH_ENERGY_TOTAL] = "total",
                                       [SPH_ENERGY_ENTROPY] = "entropy",
                                       [SPH_ENERGY_TEMPERATURE] = "temperature"};

void sph_group_set_energy(sph_group *group, const char *variable)
{
  if (!settable(group, "the energy")) return;
  if (group->wall) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s is a wall: it integrates nothing",
                 group->name);
    return;
  }
  for (int k = SPH_ENERGY_NONE; variable && k <= SPH_ENERGY_TEMPERATURE; k++)
    if (!strcmp(variable, energies[k])) {
      group->energy = (enum sph_energy)k;
      return;
    }
  sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
               "group %s: energy \"%s\"; known: u, total, entropy, temperature, none", group->name,
               variable ? variable : "");
}

const char *sph_group_energy(const sph_group *group)
{
  if (!group || group->wall) return "none";
  if (group->energy != SPH_ENERGY_DEFAULT) return energies[group->energy];
  return group->has_eos && group->eos.thermal ? "u" : "none";
}

/* ---- fields ---- */

void sph_group_scalars_added(sph_group *group)
{
  const sph_sim *sim = group->sim;
  for (; !group->wall && group->scalars < sim->terms.scalars; group->scalars++) {
    int field = SPH_SCALAR + group->scalars;
    if (group->capacity && sph_group_data_own(group, field, &group->sim->error)) return;
    for (long i = 0; i < group->n; i++)
      group->own[field][0][i] = sim->terms.scalar[group->scalars].initial;
  }
}

const sph_field_info *sph_group_field(const sph_group *group, int k)
{
  if (!group || k < SPH_SCALAR) return group ? sph_field_get(k) : NULL;
  return k - SPH_SCALAR < group->scalars ? &group->sim->terms.scalar[k - SPH_SCALAR].info : NULL;
}

/* The number of a field, scalars too; -1: no such. */
static int find(const sph_group *group, const char *field)
{
  int number = sph_field_find(field);
  if (number >= 0 || !group) return number;
  int scalar = sph_term_set_scalar(&group->sim->terms, field);
  return scalar >= 0 && scalar < group->scalars ? SPH_SCALAR + scalar : -1;
}

/* Where a component lives now; NULL: no such. */
static double *component(const sph_group *group, const char *field, int c)
{
  int number = find(group, field);
  if (!group || number < 0 || c < 0 || c >= sph_group_data_components(group->dim, number))
    return NULL;
  const sph_sim *sim = group->sim;
  return sph_group_data_component(group, sim->shown ? sph_nvector_data(sim->shown) : NULL, number,
                                  c);
}

/* An energy that is kept nowhere: made from the state shown. */
static const double *made(const sph_group *group, int field)
{
  sph_sim *sim = group->sim;
  if (!sph_sim_energy_has(group, field)) return NULL;
  if (sim->prepared && sph_sim_run_derived(sim)) return NULL;
  if (sph_sim_energy_derive(sim->group[group->index],
                            sim->shown ? sph_nvector_data(sim->shown) : NULL, field))
    return NULL;
  return group->own[field][0];
}

const double *sph_group_read(const sph_group *group, const char *field, int c)
{
  int number = find(group, field);
  if (!group || number < 0) return NULL;
  int kept = number == SPH_POSITION || number == SPH_VELOCITY || number == SPH_MASS ||
             sph_group_data_integrated(group, number);
  int other = number == SPH_ENTHALPY || (number >= SPH_TOTAL_ENERGY && number <= SPH_TEMPERATURE);
  if (!kept && other) return c == 0 ? made(group, number) : NULL;
  if (group->sim->prepared && (!kept || group->wall)) sph_sim_run_derived(group->sim);
  return component(group, field, c);
}

double *sph_group_write(sph_group *group, const char *field, int c)
{
  return ok(group) ? component(group, field, c) : NULL;
}

const double *sph_group_rate(const sph_group *group, const char *field, int c)
{
  int number = find(group, field);
  if (!ok(group) || !group->sim->prepared || number < 0 || c < 0 || c > 2) return NULL;
  if (group->offset[number][c] < 0) return NULL;
  return sph_nvector_data(group->sim->ydot) + group->offset[number][c];
}

double sph_group_scale(const sph_group *group, const char *field)
{
  int number = find(group, field);
  return !group || group->wall || number < 0 ? 0 : group->sim->scale[group->index][number];
}

sph_group *sph_group_box(sph_sim *sim, const char *name, const double *lo, const double *hi,
                         double rho0)
{
  sph_group *group = sph_group_create(sim, name, "fluid");
  sph_group_add_box(group, lo, hi, rho0);
  return group;
}

sph_group *sph_group_walls(sph_sim *sim, const char *name, const double *lo, const double *hi,
                           double rho0)
{
  sph_group *group = sph_group_create(sim, name, "wall");
  sph_group_add_layers(group, lo, hi, NULL, rho0);
  return group;
}
