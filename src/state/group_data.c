#include "group_data.h"

#include <string.h>

#include "memory.h"

int sph_group_data_components(int dim, int field)
{
  return field < SPH_SCALAR && sph_field_get(field)->vector ? dim : 1;
}

int sph_group_data_energy(const struct sph_group *group)
{
  static const int field[] = {[SPH_ENERGY_NONE] = -1,
                              [SPH_ENERGY_U] = SPH_ENERGY,
                              [SPH_ENERGY_TOTAL] = SPH_TOTAL_ENERGY,
                              [SPH_ENERGY_ENTROPY] = SPH_ENTROPY,
                              [SPH_ENERGY_TEMPERATURE] = SPH_TEMPERATURE};
  if (group->wall || !group->has_eos) return -1;
  if (group->energy == SPH_ENERGY_DEFAULT) return group->eos.thermal ? SPH_ENERGY : -1;
  return field[group->energy];
}

int sph_group_data_integrated(const struct sph_group *group, int field)
{
  if (group->wall) return group->model == SPH_MODEL_DBC && field == SPH_DENSITY;
  if (field >= SPH_SCALAR) return field - SPH_SCALAR < group->scalars;
  if (field >= SPH_ENERGY && field <= SPH_TEMPERATURE) return field == sph_group_data_energy(group);
  if (field == SPH_DENSITY) return !group->summed;
  return sph_field_get(field)->integrated;
}

/* Fields that every group keeps from the start; the others get an array where they are needed. */
static int always(const struct sph_group *group, int field)
{
  if (field >= SPH_SCALAR) return !group->wall && field - SPH_SCALAR < group->scalars;
  return field != SPH_TOTAL_ENERGY && field != SPH_ENTROPY && field != SPH_TEMPERATURE &&
         field != SPH_ENTHALPY;
}

int sph_group_data_isothermal(const struct sph_group *group)
{
  return group->wall && (group->boundary.temperature > 0 || group->boundary.temperature_at);
}

int sph_group_data_own(struct sph_group *group, int field, sph_error *error)
{
  for (int c = 0; c < sph_group_data_components(group->dim, field); c++) {
    if (group->own[field][c] || group->offset[field][c] >= 0) continue;
    group->own[field][c] = SPH_NEW(double, group->capacity, "a field", error);
    if (!group->own[field][c]) return SPH_ERR_MEMORY;
  }
  return SPH_OK;
}

int sph_group_data_reserve(struct sph_group *group, long count, sph_error *error)
{
  if (count <= group->capacity) return SPH_OK;
  long wanted = count > group->capacity * 3 / 2 ? count : group->capacity * 3 / 2;
  size_t capacity = (size_t)(wanted + 7) / 8 * 8, old = (size_t)group->n;
  int status = SPH_OK;
  if (group->id || group->model == SPH_MODEL_MIRROR)
    status = sph_memory_grow((void **)&group->id, old, capacity, sizeof(long), "particle numbers",
                             error);
  for (int field = 0; field < SPH_FIELDS; field++)
    for (int c = 0; status == SPH_OK && c < sph_group_data_components(group->dim, field); c++)
      if (always(group, field) || group->own[field][c])
        status = sph_memory_grow((void **)&group->own[field][c], old, capacity, sizeof(double),
                                 "a field", error);
  for (int d = 0; group->wall && status == SPH_OK && d < group->dim; d++)
    status = sph_memory_grow((void **)&group->start[d], old, capacity, sizeof(double),
                             "wall positions", error);
  if (group->model == SPH_MODEL_MIRROR && status == SPH_OK)
    status = sph_memory_grow((void **)&group->ghost, old, capacity, sizeof(sph_ghost),
                             "mirror images", error);
  if (status == SPH_OK) group->capacity = (long)capacity;
  return status;
}

void sph_group_data_free(struct sph_group *group)
{
  if (!group) return;
  if (group->eos.free) group->eos.free(group->eos.ctx);
  if (group->boundary.free) group->boundary.free(group->boundary.ctx);
  for (int c = 0; c < 3; c++) {
    for (int field = 0; field < SPH_FIELDS; field++) sph_memory_free(group->own[field][c]);
    sph_memory_free(group->start[c]);
  }
  sph_memory_free(group->id);
  sph_memory_free(group->ghost);
  sph_memory_free(group);
}

static int role_of(int field)
{
  if (field == SPH_POSITION) return SPH_ROLE_POSITION;
  if (field == SPH_DENSITY) return SPH_ROLE_DENSITY;
  return field == SPH_VELOCITY ? SPH_ROLE_VELOCITY : SPH_ROLE_OTHER;
}

static void place(struct sph_group *group, sph_layout *layout, int field, int c, int role)
{
  sph_segment *segment = &layout->segment[layout->segments++];
  *segment = (sph_segment){layout->length, group->n, group->capacity, role, -1};
  group->offset[field][c] = layout->length;
  layout->length += group->capacity;
  layout->entries += group->n;
}

void sph_group_data_place(struct sph_group *group, sph_layout *layout)
{
  int position = layout->segments;
  for (int field = 0; field < SPH_FIELDS; field++) {
    if (!sph_group_data_integrated(group, field)) continue;
    for (int c = 0; c < sph_group_data_components(group->dim, field); c++)
      place(group, layout, field, c, role_of(field));
  }
  for (int d = 0; d < group->dim && layout->segments > position; d++)
    layout->segment[position + d].partner = position + group->dim + d;
}

void sph_group_data_move(struct sph_group *group, double *y)
{
  for (int field = 0; field < SPH_FIELDS; field++)
    for (int c = 0; c < 3; c++) {
      if (group->offset[field][c] < 0 || !group->own[field][c]) continue;
      memcpy(y + group->offset[field][c], group->own[field][c], (size_t)group->n * sizeof *y);
      sph_memory_free(group->own[field][c]);
      group->own[field][c] = NULL;
    }
}

long sph_group_data_id(const struct sph_group *group, long i)
{
  return group->id ? group->id[i] : group->first_id + i;
}

long *sph_group_data_ids(struct sph_group *group, sph_error *error)
{
  if (group->id) return group->id;
  long *id = SPH_NEW(long, group->capacity, "particle numbers", error);
  for (long i = 0; id && i < group->n; i++) id[i] = group->first_id + i;
  return group->id = id;
}

double *sph_group_data_component(const struct sph_group *group, const double *y, int field, int c)
{
  if (group->offset[field][c] < 0) return group->own[field][c];
  return y ? (double *)y + group->offset[field][c] : NULL;
}

static double *rate(const struct sph_group *group, double *ydot, int field, int c)
{
  return ydot && group->offset[field][c] >= 0 ? ydot + group->offset[field][c] : NULL;
}

sph_view sph_group_data_view(const struct sph_group *group, const double *y, double *ydot)
{
  sph_view view = {.n = group->n};
  for (int d = 0; d < group->dim; d++) {
    view.x[d] = sph_group_data_component(group, y, SPH_POSITION, d);
    view.v[d] = sph_group_data_component(group, y, SPH_VELOCITY, d);
    view.dx[d] = rate(group, ydot, SPH_POSITION, d);
    view.dv[d] = rate(group, ydot, SPH_VELOCITY, d);
  }
  view.rho = sph_group_data_component(group, y, SPH_DENSITY, 0);
  view.drho = rate(group, ydot, SPH_DENSITY, 0);
  view.m = group->own[SPH_MASS][0];
  view.p = group->own[SPH_PRESSURE][0];
  view.c = group->own[SPH_SOUND_SPEED][0];
  view.T = sph_group_data_component(group, y, SPH_TEMPERATURE, 0);
  for (int k = 0; k < group->scalars; k++) {
    view.s[k] = sph_group_data_component(group, y, SPH_SCALAR + k, 0);
    view.ds[k] = rate(group, ydot, SPH_SCALAR + k, 0);
  }
  int energy = sph_group_data_energy(group);
  if (group->model == SPH_MODEL_MIRROR) view.u = group->own[SPH_ENERGY][0];
  if (energy < 0) return view;
  view.u = sph_group_data_component(group, y, SPH_ENERGY, 0);
  view.energy = sph_group_data_component(group, y, energy, 0);
  view.du = rate(group, ydot, energy, 0);
  return view;
}
