/* States of runs, and how far they are from each other. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "prog_work.h"

static int is_fluid(const sph_group *group) { return !strcmp(sph_group_kind(group), "fluid"); }

static void add_field(work_fields *fields, const sph_group *group, const sph_field_info *info,
                      int components)
{
  if (fields->n == WORK_FIELDS || fields->columns + components > WORK_COLUMNS) return;
  int f = fields->n++;
  snprintf(fields->name[f], sizeof fields->name[f], "%s", info->name);
  fields->scale[f] = sph_group_scale(group, info->name);
  fields->unit[f] = info->unit;
  for (int c = 0; c < components; c++) {
    fields->field[fields->columns] = f;
    fields->component[fields->columns++] = c;
  }
}

/* Position, velocity, density, energy if there is one, scalars. */
void sph_prog_work_state_fields(const sph_sim *sim, work_fields *fields)
{
  static const char *const common[] = {"position", "velocity", "density", "energy"};
  const sph_group *group, *fluid = NULL;
  const sph_field_info *info;
  *fields = (work_fields){0};
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    if (!is_fluid(group)) continue;
    if (!fluid) fluid = group;
    fields->particles += sph_group_count(group);
  }
  for (int k = 0; fluid && k < (int)(sizeof common / sizeof *common); k++) {
    info = sph_field_get(sph_field_find(common[k]));
    if (strcmp(common[k], "energy") || strcmp(sph_group_energy(fluid), "none"))
      add_field(fields, fluid, info, info->vector ? sph_sim_dim(sim) : 1);
  }
  for (int k = 0; fluid && (info = sph_group_field(fluid, k)); k++)
    if (sph_field_find(info->name) < 0) add_field(fields, fluid, info, 1);
}

typedef struct place {
  long id;
  const sph_group *group;
  long i;
} place;

static int by_id(const void *a, const void *b)
{
  long x = ((const place *)a)->id, y = ((const place *)b)->id;
  return (x > y) - (x < y);
}

/* Where each fluid particle is, in the order of their numbers. */
static place *places(const sph_sim *sim, long particles)
{
  place *at = calloc((size_t)particles + 1, sizeof *at);
  const sph_group *group;
  long n = 0;
  for (int k = 0; at && (group = sph_sim_group_get(sim, k)); k++)
    for (long i = 0; is_fluid(group) && i < sph_group_count(group) && n < particles; i++)
      at[n++] = (place){sph_group_id(group, i), group, i};
  if (at) qsort(at, (size_t)n, sizeof *at, by_id);
  return at;
}

double *sph_prog_work_state_take(const sph_sim *sim, const work_fields *fields)
{
  long n = fields->particles;
  place *at = places(sim, n);
  double *state = calloc((size_t)(fields->columns * n) + 1, sizeof *state);
  for (int c = 0; at && state && c < fields->columns; c++) {
    const char *name = fields->name[fields->field[c]];
    const sph_group *of = NULL;
    const double *from = NULL;
    double scale = 1;
    for (long i = 0; i < n; i++) {
      if (at[i].group != of) {
        of = at[i].group;
        from = sph_group_read(of, name, fields->component[c]);
        scale = sph_group_scale(of, name);
      }
      state[c * n + i] = from && scale > 0 ? from[at[i].i] / scale : 0;
    }
  }
  free(at);
  return state;
}

void sph_prog_work_state_distance(const work_fields *fields, const double *a, const double *b,
                                  double distance[WORK_FIELDS])
{
  long n = fields->particles;
  for (int f = 0; f < WORK_FIELDS; f++) distance[f] = 0;
  for (int c = 0; c < fields->columns; c++)
    for (long i = 0; i < n; i++)
      distance[fields->field[c]] += (a[c * n + i] - b[c * n + i]) * (a[c * n + i] - b[c * n + i]);
  for (int f = 0; f < fields->n; f++) distance[f] = sqrt(distance[f] / (double)n);
}
