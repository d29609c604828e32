#include <math.h>
#include <string.h>

#include "memory.h"
#include "monitor.h"
#include "rows.h"
#include "sim_work.h"
#include "sphode/measure.h"
#include "sphode/output.h"
#include "sphode/sim.h"
#include "text.h"
#include "units.h"

typedef struct context {
  sph_error error; /* of the constructor; told by open */
  char *directory;
  sph_monitor *monitors;   /* [n], strings owned */
  sph_series_force *force; /* [forces], names owned */
  int n, forces, powers;
  sph_rows rows;
} context;

static char *copy(const char *text, sph_error *error)
{
  return text ? sph_memory_string(text, error) : NULL;
}

/* Scalar k of the fluids, or NULL; all fluids have the same. */
static const sph_field_info *scalar(const sph_sim *sim, int k)
{
  const sph_group *group;
  int fixed = 0;
  while (sph_field_get(fixed)) fixed++;
  for (int g = 0; (group = sph_sim_group_get(sim, g)); g++)
    if (!strcmp(sph_group_kind(group), "fluid")) return sph_group_field(group, fixed + k);
  return NULL;
}

/* Mass-weighted mean, least and largest value of a scalar over all fluids. */
static void add_scalar(sph_sim *sim, const char *name, sph_text *row)
{
  double mass = 0, sum = 0, least = INFINITY, most = -INFINITY;
  const sph_group *group;
  for (int g = 0; (group = sph_sim_group_get(sim, g)); g++) {
    const double *s = sph_group_read(group, name, 0), *m = sph_group_read(group, "mass", 0);
    for (long i = 0; s && m && i < sph_group_count(group); i++) {
      mass += m[i];
      sum += m[i] * s[i];
      least = fmin(least, s[i]);
      most = fmax(most, s[i]);
    }
  }
  sph_text_add(row, ",%.15g,%.15g,%.15g", sum / mass, least, most);
}

/* First component of a torque or an angular momentum; behind the last where there is none. */
static int first_turn(int dim) { return dim == 3 ? 0 : dim == 2 ? 2 : 3; }

static void header_forces(const context *c, int dim, sph_text *row)
{
  static const char *const parts[] = {"force", "pressure", "viscous"};
  for (int k = 0; k < c->forces; k++) {
    for (int part = 0; part < 3; part++)
      for (int d = 0; d < dim; d++)
        sph_text_add(row, ",%s_%s_%c [%s]", c->force[k].wall, parts[part], "xyz"[d],
                     sph_units_get(SPH_UNIT_FORCE, dim));
    for (int d = first_turn(dim); d < 3; d++)
      sph_text_add(row, ",%s_torque_%c [%s]", c->force[k].wall, "xyz"[d],
                   sph_units_get(SPH_UNIT_TORQUE, dim));
  }
}

static void header_powers(const sph_sim *sim, sph_text *row)
{
  const char *unit = sph_units_get(SPH_UNIT_POWER, sph_sim_dim(sim)), *term;
  for (int k = 0; (term = sph_sim_power_term(sim, k)); k++)
    sph_text_add(row, ",%s_kinetic [%s],%s_internal [%s]", term, unit, term, unit);
}

static void header(const context *c, const sph_sim *sim, sph_text *row)
{
  static const char *const energies[] = {"kinetic", "potential", "internal", "total"};
  const sph_field_info *info;
  int dim = sph_sim_dim(sim);
  sph_text_add(row, "time [s],step,dt [s]");
  for (int k = 0; k < 4; k++)
    sph_text_add(row, ",%s [%s]", energies[k], sph_units_get(SPH_UNIT_ENERGY, dim));
  for (int d = 0; d < dim; d++)
    sph_text_add(row, ",momentum_%c [%s]", "xyz"[d], sph_units_get(SPH_UNIT_MOMENTUM, dim));
  for (int d = first_turn(dim); d < 3; d++)
    sph_text_add(row, ",angular_momentum_%c [%s]", "xyz"[d],
                 sph_units_get(SPH_UNIT_ANGULAR_MOMENTUM, dim));
  for (int k = 0; (info = scalar(sim, k)); k++)
    sph_text_add(row, ",%s_mean [%s],%s_min [%s],%s_max [%s]", info->name, info->unit, info->name,
                 info->unit, info->name, info->unit);
  for (int k = 0; k < c->n; k++)
    sph_text_add(row, ",%s [%s]", c->monitors[k].name, sph_monitor_unit(c->monitors[k].type));
  header_forces(c, dim, row);
  if (sph_sim_work_moves(sim)) sph_text_add(row, ",work [%s]", sph_units_get(SPH_UNIT_ENERGY, dim));
  if (c->powers) header_powers(sim, row);
  sph_text_add(row, "\n");
}

/* A failure that stuck to the simulation while it was measured. */
static int told(const sph_sim *sim, int status, sph_error *error)
{
  return status ? sph_error_set(error, status, "%s", sph_sim_error(sim)) : SPH_OK;
}

static int add_forces(const context *c, sph_sim *sim, sph_text *row, sph_error *error)
{
  const int dim = sph_sim_dim(sim);
  for (int k = 0; k < c->forces; k++) {
    sph_force f;
    int status = sph_sim_force(sim, sph_sim_group(sim, c->force[k].wall), c->force[k].about, &f);
    if (status) return told(sim, status, error);
    const double *parts[] = {f.force, f.pressure, f.viscous};
    for (int part = 0; part < 3; part++)
      for (int d = 0; d < dim; d++) sph_text_add(row, ",%.15g", parts[part][d]);
    for (int d = first_turn(dim); d < 3; d++) sph_text_add(row, ",%.15g", f.torque[d]);
  }
  return SPH_OK;
}

/* Of walls that move. */
static int add_work(sph_sim *sim, sph_text *row, sph_error *error)
{
  double work;
  if (!sph_sim_work_moves(sim)) return SPH_OK;
  const int status = sph_sim_work(sim, &work);
  if (status) return told(sim, status, error);
  sph_text_add(row, ",%.15g", work);
  return SPH_OK;
}

static int add_powers(sph_sim *sim, sph_text *row, sph_error *error)
{
  for (int k = 0; sph_sim_power_term(sim, k); k++) {
    sph_power power;
    int status = sph_sim_power(sim, k, &power);
    if (status) return told(sim, status, error);
    sph_text_add(row, ",%.15g,%.15g", power.kinetic, power.internal);
  }
  return SPH_OK;
}

static int numbers(const context *c, sph_sim *sim, sph_text *row, sph_error *error)
{
  int dim = sph_sim_dim(sim), status = SPH_OK;
  sph_balance b;
  sph_sim_stats stats;
  sph_sim_balance(sim, &b);
  sph_sim_get_stats(sim, &stats);
  sph_text_add(row, "%.15g,%ld,%.15g", sph_sim_time(sim), stats.step.steps, stats.step.dt_last);
  sph_text_add(row, ",%.15g,%.15g,%.15g,%.15g", b.kinetic, b.potential, b.internal, b.total);
  for (int d = 0; d < dim; d++) sph_text_add(row, ",%.15g", b.momentum[d]);
  for (int d = first_turn(dim); d < 3; d++) sph_text_add(row, ",%.15g", b.angular_momentum[d]);
  const sph_field_info *info;
  for (int k = 0; (info = scalar(sim, k)); k++) add_scalar(sim, info->name, row);
  for (int k = 0; status == SPH_OK && k < c->n; k++) {
    double value = NAN;
    status = sph_monitor_value(&c->monitors[k], sim, &value, error);
    sph_text_add(row, ",%.15g", value);
  }
  if (status == SPH_OK) status = add_forces(c, sim, row, error);
  if (status == SPH_OK) status = add_work(sim, row, error);
  if (status == SPH_OK && c->powers) status = add_powers(sim, row, error);
  sph_text_add(row, "\n");
  return status;
}

/* Monitors and walls: are they there?  Else, what would be right. */
static int check(const context *c, const sph_sim *sim, sph_error *error)
{
  int status = sph_error_set(error, c->error.status, "%s", c->error.text);
  for (int k = 0; !status && k < c->n; k++) status = sph_monitor_check(&c->monitors[k], sim, error);
  for (int k = 0; !status && k < c->forces; k++) {
    const char *kind = sph_group_kind(sph_sim_group(sim, c->force[k].wall));
    if (strcmp(kind, "wall") != 0)
      return sph_error_set(error, SPH_ERR_ARGUMENT, "a force on %s: %s; right is a wall",
                           c->force[k].wall, *kind ? "it is a fluid" : "there is no such group");
  }
  return status;
}

static int open_series(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  sph_text row = {0};
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: a time series");
  int status = check(c, sim, error);
  if (status == SPH_OK) status = sph_rows_open(&c->rows, c->directory, "series.csv", error);
  if (status != SPH_OK) return status;
  header(c, sim, &row);
  return sph_rows_append(&c->rows, &row, error);
}

static int frame_series(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  sph_text row = {0};
  int status = numbers(c, sim, &row, error);
  if (status == SPH_OK) return sph_rows_append(&c->rows, &row, error);
  sph_text_free(&row);
  return status;
}

static int keep_series(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  context *c = ctx;
  sph_text columns = {0};
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: a time series");
  int status = check(c, sim, error);
  if (status) return status;
  header(c, sim, &columns);
  status = sph_error_set(error, columns.error.status, "%s", columns.error.text);
  if (!status) status = sph_rows_keep(&c->rows, c->directory, "series.csv", columns.data, keep);
  sph_text_free(&columns);
  return status;
}

static int close_series(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  (void)sim;
  return c ? sph_rows_close(&c->rows, error) : SPH_OK;
}

static void free_series(void *ctx)
{
  context *c = ctx;
  sph_error none = {0};
  if (!c) return;
  sph_rows_close(&c->rows, &none);
  for (int k = 0; c->monitors && k < c->n; k++) {
    sph_memory_free((void *)c->monitors[k].name);
    sph_memory_free((void *)c->monitors[k].type);
    sph_memory_free((void *)c->monitors[k].group);
  }
  for (int k = 0; c->force && k < c->forces; k++) sph_memory_free((void *)c->force[k].wall);
  sph_memory_free(c->force);
  sph_memory_free(c->monitors);
  sph_memory_free(c->directory);
  sph_memory_free(c);
}

static void copy_monitors(context *c, const sph_monitor *monitors, int n)
{
  if (n <= 0) return;
  if (!monitors) {
    sph_error_set(&c->error, SPH_ERR_ARGUMENT, "a time series: %d monitors at NULL", n);
    return;
  }
  c->monitors = SPH_NEW(sph_monitor, n, "monitors", &c->error);
  for (int k = 0; c->monitors && k < n; k++) {
    sph_monitor *m = &c->monitors[k];
    *m = monitors[k];
    m->name = copy(monitors[k].name, &c->error);
    m->type = copy(monitors[k].type, &c->error);
    m->group = copy(monitors[k].group, &c->error);
    c->n = k + 1;
  }
}

static void copy_forces(context *c, const sph_series_def *def)
{
  if (def->forces <= 0) return;
  if (!def->force) {
    sph_error_set(&c->error, SPH_ERR_ARGUMENT, "a time series: %d forces at NULL", def->forces);
    return;
  }
  c->force = SPH_NEW(sph_series_force, def->forces, "forces", &c->error);
  for (int k = 0; c->force && k < def->forces; k++) {
    c->force[k] = def->force[k];
    c->force[k].wall = copy(def->force[k].wall ? def->force[k].wall : "", &c->error);
    c->forces = k + 1;
  }
}

sph_output sph_output_series_def(const sph_series_def *def)
{
  static const sph_series_def nothing = {0};
  context *c = sph_memory_take(1, sizeof *c);
  if (!def) def = &nothing;
  if (c) {
    c->rows.fd = -1;
    c->directory = copy(def->directory, &c->error);
    copy_monitors(c, def->monitor, def->monitors);
    copy_forces(c, def);
    c->powers = def->powers != 0;
  }
  return (sph_output){.name = "series",
                      .interval = def->interval,
                      .open = open_series,
                      .frame = frame_series,
                      .close = close_series,
                      .keep = keep_series,
                      .ctx = c,
                      .free = free_series};
}

sph_output sph_output_series(const char *directory, double interval, const sph_monitor *monitors,
                             int n)
{
  return sph_output_series_def(&(sph_series_def){
      .directory = directory, .interval = interval, .monitor = monitors, .monitors = n});
}
