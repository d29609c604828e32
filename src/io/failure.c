/* The neighbourhood of the particle at which a run failed, as a table: the last good state, and
 * what each term does to it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "file.h"
#include "memory.h"
#include "sim_failure.h"
#include "sim_power.h"
#include "sphode/field.h"
#include "sphode/kernel.h"
#include "sphode/measure.h"
#include "sphode/output.h"
#include "text.h"
#include "units.h"

static const double REACH = 2; /* supports */

typedef struct near_by {
  int group;
  long i;
  double distance; /* [m] */
} near_by;

typedef struct table {
  sph_sim *sim;
  long n, room;
  near_by *row;
  int terms;
  double *a; /* [terms][n][dim] [m/s^2] */
  sph_text text;
  sph_error error;
} table;

static double distance(const sph_sim *sim, const sph_group *group, long i)
{
  const sph_group *other = sim->group[sim->suspect.group];
  double r2 = 0;
  for (int d = 0; d < sim->dim; d++) {
    double s = sph_group_read(group, "position", d)[i] -
               sph_group_read(other, "position", d)[sim->suspect.i];
    if (sim->periodic[d]) s -= sim->length[d] * nearbyint(s / sim->length[d]);
    r2 += s * s;
  }
  return sqrt(r2);
}

static int gather(table *t)
{
  const sph_sim *sim = t->sim;
  for (int g = 0; g < sim->groups; g++)
    for (long i = 0; i < sph_group_count(sim->group[g]); i++) {
      const double r = distance(sim, sim->group[g], i);
      if (!(r <= REACH * sim->H)) continue;
      if (t->n == t->room) {
        const long room = 2 * t->room + 64;
        if (sph_memory_grow((void **)&t->row, (size_t)t->room, (size_t)room, sizeof *t->row,
                            "a neighbourhood", &t->error))
          return SPH_ERR_MEMORY;
        t->room = room;
      }
      t->row[t->n++] = (near_by){g, i, r};
    }
  return SPH_OK;
}

/* The accelerations by term k of the rows. */
static int take(table *t, int k, N_Vector ydot)
{
  sph_sim *sim = t->sim;
  sph_evaluation e;
  sph_part part;
  const int status = sph_sim_power_rates(sim, k, ydot, &part, &e);
  if (status) return sph_error_set(&t->error, status, "%s", sim->error.text);
  for (long r = 0; r < t->n; r++)
    for (int d = 0; d < sim->dim; d++) {
      const near_by *row = &t->row[r];
      const double *dv = sim->group[row->group]->wall ? NULL : e.view[row->group].dv[d];
      t->a[((long)k * t->n + r) * sim->dim + d] = dv ? dv[row->i] : 0;
    }
  return SPH_OK;
}

static int accelerations(table *t)
{
  while (sph_sim_power_term(t->sim, t->terms)) t->terms++;
  t->a = SPH_NEW(double, (long)t->terms * t->n * t->sim->dim + 1, "accelerations", &t->error);
  N_Vector ydot = sph_nvector_clone(t->sim->y, "the rates of one term", &t->error);
  for (int k = 0; k < t->terms && !t->error.status; k++) take(t, k, ydot);
  if (ydot) N_VDestroy(ydot);
  return t->error.status;
}

/* Does a group have it?  An energy: does one integrate it; else it is zero. */
static int has(const sph_sim *sim, const char *field)
{
  const int energy = !strcmp(field, "energy");
  for (int g = 0; g < sim->groups; g++)
    if (energy ? sph_group_data_energy(sim->group[g]) >= 0
               : sph_group_read(sim->group[g], field, 0) != NULL)
      return 1;
  return 0;
}

/* The columns of a field, or (row NULL) their titles. */
static void add_field(table *t, const sph_field_info *info, const near_by *row)
{
  const sph_sim *sim = t->sim;
  const int place = !strcmp(info->name, "position"), mass = !strcmp(info->name, "mass");
  if (!has(sim, info->name)) return;
  for (int d = 0; d < (info->vector ? sim->dim : 1); d++) {
    const double *value = row ? sph_group_read(sim->group[row->group], info->name, d) : NULL;
    sph_text_add(&t->text, ",");
    if (value) sph_text_add(&t->text, "%.15g", value[row->i]);
    if (!row)
      sph_text_add(&t->text, "%s%s%.*s [%s]", place ? "" : info->name,
                   info->vector && !place ? "_" : "", info->vector ? 1 : 0, &"xyz"[d],
                   mass ? sph_units_get(SPH_UNIT_MASS, sim->dim) : info->unit);
  }
}

/* Row r, or (r -1) the titles. */
static void add_row(table *t, long r)
{
  const sph_sim *sim = t->sim;
  const near_by *row = r < 0 ? NULL : &t->row[r];
  const sph_field_info *info;
  if (row)
    sph_text_add(&t->text, "%s,%ld,%.6g", sim->group[row->group]->name,
                 sph_group_id(sim->group[row->group], row->i), row->distance);
  else
    sph_text_add(&t->text, "group,id,distance [m]");
  for (int k = 0; (info = sph_field_get(k)); k++) add_field(t, info, row);
  for (int k = 0; k < t->terms; k++)
    for (int d = 0; sph_sim_power_pushes(sim, k) && d < sim->dim; d++)
      if (row)
        sph_text_add(&t->text, ",%.15g", t->a[((long)k * t->n + r) * sim->dim + d]);
      else
        sph_text_add(&t->text, ",%s_%c [m/s^2]", sph_sim_power_term(sim, k), "xyz"[d]);
  sph_text_add(&t->text, "\n");
}

static int write(table *t, const char *path)
{
  int status = gather(t);
  if (!status) status = accelerations(t);
  for (long r = -1; !status && r < t->n; r++) add_row(t, r);
  if (!status) status = sph_error_set(&t->error, t->text.error.status, "%s", t->text.error.text);
  return status ? status : sph_file_replace(path, t->text.data, t->text.length, &t->error);
}

int sph_failure_write(sph_sim *sim, const char *path, sph_error *error)
{
  if (!sim || !path)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a failed run: no %s (NULL)",
                         sim ? "path" : "simulation");
  if (!sim->suspect.known || sim->error.status != SPH_ERR_STEP)
    return sph_error_set(error, SPH_ERR_STATE, "%s: no step of this simulation has failed", path);
  table t = {.sim = sim};
  const sph_error failure = sph_sim_failure_aside(sim);
  const int status = write(&t, path);
  sim->error = failure;
  if (status) sph_error_set(error, status, "%s: %s", path, t.error.text);
  sph_text_free(&t.text);
  sph_memory_free(t.a);
  sph_memory_free(t.row);
  return status;
}
