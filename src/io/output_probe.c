/* Fields of the fluids at places over time: Shepard interpolation by the operators. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "memory.h"
#include "monitor.h"
#include "rows.h"
#include "sphode/kernel.h"
#include "sphode/operator.h"
#include "units.h"
#include "words.h"

enum { COLUMNS_MAX = 32, NAME = 64 };

typedef struct column {
  char field[NAME];
  int component, vector;
} column;

typedef struct context {
  sph_error error; /* of the constructor; told by open */
  char *directory, *name, *fields, *group;
  long n;    /* places */
  double *x; /* [n][3] */
  double box[2][3];
  int columns;
  column column[COLUMNS_MAX];
  sph_rows rows;
} context;

/* The particles near the places. */
typedef struct cloud {
  int dim;
  long n, *index; /* among the particles of all chosen groups, rising */
  double *x[3], *volume, *f;
  void *memory;
} cloud;

static int chosen(const context *c, const sph_group *group)
{
  if (strcmp(sph_group_kind(group), "fluid") != 0) return 0;
  if (c->group) return !strcmp(c->group, sph_group_name(group));
  return !sph_group_eos(group)->dust; /* which fills no space of its own */
}

/* ---- what is asked for ---- */

static int refuse(const context *c, sph_error *error, const char *what)
{
  return sph_error_set(error, SPH_ERR_ARGUMENT, "probe %s: %s", c->name ? c->name : "", what);
}

/* All particles lie in [box[0], box[1]]; it and its length on each side is where probes may be: one
 * that is farther off is a mistake in its unit or its sign. */
static int check_places(const context *c, const sph_sim *sim, sph_error *error)
{
  const int dim = sph_sim_dim(sim);
  double low[3], high[3];
  for (int d = 0; d < dim; d++) {
    const sph_group *group;
    low[d] = INFINITY, high[d] = -INFINITY;
    for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
      const double *x = sph_group_read(group, "position", d);
      for (long i = 0; x && i < sph_group_count(group); i++)
        low[d] = fmin(low[d], x[i]), high[d] = fmax(high[d], x[i]);
    }
    const double more = fmax(high[d] - low[d], sph_sim_dx(sim));
    if (sph_sim_periodic(sim, d, NULL, NULL)) continue;
    if (c->box[1][d] >= low[d] - more && c->box[0][d] <= high[d] + more) continue;
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "probe %s: its places lie between %c = %g and %g m, all particles between "
                         "%g and %g m",
                         c->name, "xyz"[d], c -> box[0][d], c -> box[1][d], low[d], high[d]);
  }
  return SPH_OK;
}

static const sph_field_info *find_field(const sph_group *group, const char *name, sph_words *words)
{
  const sph_field_info *info;
  for (int k = 0; (info = sph_group_field(group, k)); k++) {
    if (!sph_group_read(group, info->name, 0)) continue;
    if (!strcmp(info->name, name)) return info;
    if (words) sph_words_add(words, info->name);
  }
  return NULL;
}

/* Columns of one field, which all chosen groups must have. */
static int add_field(context *c, const sph_sim *sim, const char *name, sph_error *error)
{
  const sph_field_info *info = NULL;
  const sph_group *group;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    sph_words words = {.wanted = name};
    if (!chosen(c, group)) continue;
    info = find_field(group, name, &words);
    if (!info)
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "probe %s: %s has no field \"%.60s\"; %sit has: %s", c->name,
                           sph_group_name(group), name, words.nearest, words.known);
  }
  for (int d = 0; info && d < (info->vector ? sph_sim_dim(sim) : 1); d++) {
    if (c->columns == COLUMNS_MAX) return refuse(c, error, "more than 32 columns");
    column *to = &c->column[c->columns++];
    *to = (column){.component = d, .vector = info->vector};
    snprintf(to->field, sizeof to->field, "%s", info->name);
  }
  return SPH_OK;
}

static int resolve(context *c, const sph_sim *sim, sph_error *error)
{
  const sph_group *group = NULL;
  int found = 0;
  int status = sph_error_set(error, c->error.status, "%s", c->error.text);
  if (!status) status = sph_monitor_check_name("probe", c->name, error);
  for (int k = 0; !status && (group = sph_sim_group_get(sim, k)); k++) found += chosen(c, group);
  if (!status && !found)
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "probe %s: no fluid group \"%s\"", c->name,
                           c->group ? c->group : "");
  char *list = status ? NULL : sph_memory_string(c->fields, error), *rest = NULL;
  c->columns = 0;
  if (!status && !list) status = SPH_ERR_MEMORY;
  for (char *word = list ? strtok_r(list, " ,", &rest) : NULL; word && !status;
       word = strtok_r(NULL, " ,", &rest))
    status = add_field(c, sim, word, error);
  sph_memory_free(list);
  if (!status && c->columns == 0) status = refuse(c, error, "no fields");
  return status;
}

/* ---- the particles near the places ---- */

static int take(cloud *all, long n, int dim, sph_error *error)
{
  double *memory = sph_memory_new((size_t)n + 1, 6 * sizeof *memory, "a probe", error);
  *all = (cloud){.dim = dim, .memory = memory};
  if (!memory) return SPH_ERR_MEMORY;
  for (int d = 0; d < 3; d++) all->x[d] = memory + d * n;
  all->volume = memory + 3 * n;
  all->f = memory + 4 * n;
  all->index = (void *)(memory + 5 * n);
  return SPH_OK;
}

static int gather(const context *c, const sph_sim *sim, double support, cloud *all,
                  sph_error *error)
{
  const sph_group *group;
  const int dim = sph_sim_dim(sim);
  long offset = 0, n = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    if (chosen(c, group)) n += sph_group_count(group);
  if (take(all, n, dim, error)) return SPH_ERR_MEMORY;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    if (!chosen(c, group)) continue;
    const double *x[3] = {NULL}, *m = sph_group_read(group, "mass", 0);
    const double *rho = sph_group_read(group, "density", 0);
    for (int d = 0; d < dim; d++) x[d] = sph_group_read(group, "position", d);
    for (long i = 0; i < sph_group_count(group); i++) {
      int near = 1;
      for (int d = 0; d < dim; d++)
        near &= sph_sim_periodic(sim, d, NULL, NULL) ||
                (x[d][i] >= c->box[0][d] - support && x[d][i] <= c->box[1][d] + support);
      if (!near) continue;
      for (int d = 0; d < dim; d++) all->x[d][all->n] = x[d][i];
      all->volume[all->n] = m[i] / rho[i];
      all->index[all->n++] = offset + i;
    }
    offset += sph_group_count(group);
  }
  return SPH_OK;
}

/* Of a column, into all->f. */
static void gather_field(const context *c, const sph_sim *sim, const column *of, cloud *all)
{
  const sph_group *group;
  long offset = 0, at = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    if (!chosen(c, group)) continue;
    const double *f = sph_group_read(group, of->field, of->component);
    const long end = offset + sph_group_count(group);
    for (; at < all->n && all->index[at] < end; at++)
      all->f[at] = f ? f[all->index[at] - offset] : NAN;
    offset = end;
  }
}

/* ---- a frame ---- */

static sph_operator *operator_of(const sph_sim *sim, sph_error *error)
{
  sph_operator_def def = {.dim = sph_sim_dim(sim),
                          .h = sph_sim_h(sim),
                          .kernel = sph_sim_kernel(sim),
                          .threads = sph_sim_threads(sim),
                          .lower_order = 1};
  for (int d = 0; d < def.dim; d++)
    def.periodic[d] = sph_sim_periodic(sim, d, &def.origin[d], &def.length[d]);
  return sph_operator_create(&def, error);
}

/* cover[n], then the columns, [n] each; NaN where it is dry. */
static int interpolate(const context *c, const sph_sim *sim, sph_operator *op, cloud *all,
                       double *value, sph_error *error)
{
  const double *const x[3] = {all->x[0], all->x[1], all->x[2]};
  double *place = SPH_NEW(double, 3 * c->n, "the places of a probe", error);
  int status = place ? SPH_OK : SPH_ERR_MEMORY;
  for (long i = 0; place && i < c->n; i++)
    for (int d = 0; d < 3; d++) place[d * c->n + i] = c->x[3 * i + d];
  if (!status) status = sph_operator_set_points(op, all->n, x, all->volume, NULL, error);
  if (!status)
    status = sph_operator_set_probes(op, c->n,
                                     (const double *const[]){place, place + c->n, place + 2 * c->n},
                                     error);
  for (long j = 0; j < all->n; j++) all->f[j] = 1;
  if (!status) status = sph_operator_interpolate(op, all->f, value, error);
  for (int k = 0; !status && k < c->columns; k++) {
    double *to = value + (k + 1) * c->n;
    gather_field(c, sim, &c->column[k], all);
    status = sph_operator_shepard(op, all->f, to, error);
    for (long i = 0; i < c->n; i++)
      if (!(value[i] >= sph_monitor_wet)) to[i] = NAN;
  }
  sph_memory_free(place);
  return status;
}

static void add_number(sph_text *row, double value)
{
  if (isnan(value))
    sph_text_add(row, ",nan"); /* whatever its sign */
  else
    sph_text_add(row, ",%.15g", value);
}

static void add_rows(const context *c, const sph_sim *sim, const double *value, sph_text *row)
{
  for (long i = 0; i < c->n; i++) {
    sph_text_add(row, "%.15g", sph_sim_time(sim));
    for (int d = 0; d < sph_sim_dim(sim); d++) add_number(row, c->x[3 * i + d]);
    for (int k = 0; k <= c->columns; k++) add_number(row, value[k * c->n + i]);
    sph_text_add(row, "\n");
  }
  if (c->n > 1) sph_text_add(row, "\n");
}

static int frame_probe(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  const double support = kernel ? sph_kernel_support(kernel) * sph_sim_h(sim) : 0;
  sph_text row = {0};
  cloud all = {0};
  double *value = SPH_NEW(double, (c->columns + 1) * c->n, "the values of a probe", error);
  sph_operator *op = operator_of(sim, error);
  int status = value && op ? SPH_OK : error->status;
  if (!status) status = gather(c, sim, support, &all, error);
  if (!status && all.n > 0) status = interpolate(c, sim, op, &all, value, error);
  for (long i = c->n; all.n == 0 && value && i < (c->columns + 1) * c->n; i++) value[i] = NAN;
  if (!status) {
    add_rows(c, sim, value, &row);
    status = sph_rows_append(&c->rows, &row, error);
  }
  sph_operator_free(op);
  sph_memory_free(all.memory);
  sph_memory_free(value);
  return status;
}

/* ---- the file ---- */

static void header(const context *c, const sph_sim *sim, sph_text *row)
{
  const sph_group *group = NULL;
  sph_text_add(row, "time [s]");
  for (int d = 0; d < sph_sim_dim(sim); d++) sph_text_add(row, ",%c [m]", "xyz"[d]);
  sph_text_add(row, ",cover [1]");
  for (int k = 0; (group = sph_sim_group_get(sim, k)) && !chosen(c, group);) k++;
  for (int k = 0; group && k < c->columns; k++) {
    const column *of = &c->column[k];
    const sph_field_info *info = find_field(group, of->field, NULL);
    const char *unit = strcmp(of->field, "mass") || !info
                           ? (info ? info->unit : "")
                           : sph_units_get(SPH_UNIT_MASS, sph_sim_dim(sim));
    if (of->vector)
      sph_text_add(row, ",%s_%c [%s]", of->field, "xyz"[of->component], unit);
    else
      sph_text_add(row, ",%s [%s]", of->field, unit);
  }
  sph_text_add(row, "\n");
}

static int file_name(const context *c, char name[80])
{
  return snprintf(name, 80, "probe_%s.csv", c->name);
}

static int open_probe(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  sph_text row = {0};
  char name[80];
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: a probe");
  int status = resolve(c, sim, error);
  if (!status) status = check_places(c, sim, error); /* at the start alone: particles may leave */
  if (status) return status;
  file_name(c, name);
  status = sph_rows_open(&c->rows, c->directory, name, error);
  if (status) return status;
  header(c, sim, &row);
  return sph_rows_append(&c->rows, &row, error);
}

static int keep_probe(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  context *c = ctx;
  sph_text columns = {0};
  char name[80];
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: a probe");
  int status = resolve(c, sim, error);
  if (status) return status;
  c->rows.framed = c->n > 1;
  header(c, sim, &columns);
  file_name(c, name);
  status = sph_error_set(error, columns.error.status, "%s", columns.error.text);
  if (!status) status = sph_rows_keep(&c->rows, c->directory, name, columns.data, keep);
  sph_text_free(&columns);
  return status;
}

static int close_probe(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  (void)sim;
  return c ? sph_rows_close(&c->rows, error) : SPH_OK;
}

static void free_probe(void *ctx)
{
  context *c = ctx;
  sph_error none = {0};
  if (!c) return;
  sph_rows_close(&c->rows, &none);
  sph_memory_free(c->directory);
  sph_memory_free(c->name);
  sph_memory_free(c->fields);
  sph_memory_free(c->group);
  sph_memory_free(c->x);
  sph_memory_free(c);
}

/* ---- the definition ---- */

static const double PLACES_MAX = 1e8;

static int check_grid(context *c, const sph_probe_def *def, const long n[2])
{
  for (int k = 0; k < 2; k++) {
    const double *edge = k ? def->across : def->along;
    const int none = edge[0] == 0 && edge[1] == 0 && edge[2] == 0;
    if (n[k] < 1 || (double)n[0] * (double)n[1] > PLACES_MAX)
      return sph_error_set(&c->error, SPH_ERR_ARGUMENT,
                           "probe %s: %ld x %ld places; right is 1 to %g", c->name, n[0], n[1],
                           PLACES_MAX);
    if (n[k] > 1 && none)
      return sph_error_set(&c->error, SPH_ERR_ARGUMENT,
                           "probe %s: %ld places along a line of no length", c->name, n[k]);
  }
  return SPH_OK;
}

static void place_grid(context *c, const sph_probe_def *def, const long n[2])
{
  for (long j = 0; j < n[1]; j++)
    for (long i = 0; i < n[0]; i++)
      for (int d = 0; d < 3; d++) {
        double along = n[0] > 1 ? (double)i / (double)(n[0] - 1) : 0;
        double across = n[1] > 1 ? (double)j / (double)(n[1] - 1) : 0;
        c->x[3 * (j * n[0] + i) + d] =
            def->from[d] + along * def->along[d] + across * def->across[d];
      }
}

static void place_all(context *c, const sph_probe_def *def)
{
  const long n[2] = {def->n[0] ? def->n[0] : 1, def->n[1] ? def->n[1] : 1};
  int status = SPH_OK;
  if (def->points < 0 || (double)def->points > PLACES_MAX || (def->points > 0 && !def->x))
    status = sph_error_set(&c->error, SPH_ERR_ARGUMENT, "probe %s: %ld points%s", c->name,
                           def->points, def->x ? "" : " at NULL");
  else if (def->points == 0)
    status = check_grid(c, def, n);
  if (status) return;
  c->n = def->points ? def->points : n[0] * n[1];
  c->x = SPH_NEW(double, 3 * c->n, "the places of a probe", &c->error);
  if (!c->x) return;
  if (def->points > 0 && def->x)
    memcpy(c->x, def->x, 3 * (size_t)c->n * sizeof *c->x);
  else
    place_grid(c, def, n);
  for (int d = 0; d < 3; d++) c->box[0][d] = INFINITY, c->box[1][d] = -INFINITY;
  for (long i = 0; i < 3 * c->n; i++) {
    c->box[0][i % 3] = fmin(c->box[0][i % 3], c->x[i]);
    c->box[1][i % 3] = fmax(c->box[1][i % 3], c->x[i]);
    if (!isfinite(c->x[i]))
      sph_error_set(&c->error, SPH_ERR_ARGUMENT, "probe %s: %c of place %ld is %g m, not finite",
                    c->name, "xyz"[i % 3], i / 3, c->x[i]);
  }
}

sph_output sph_output_probe(const sph_probe_def *def)
{
  static const sph_probe_def nothing = {.name = "of no definition (NULL)"};
  context *c = sph_memory_take(1, sizeof *c);
  if (!def) def = &nothing;
  if (c) {
    c->rows.fd = -1;
    c->directory = def->directory ? sph_memory_string(def->directory, &c->error) : NULL;
    c->name = sph_memory_string(def->name ? def->name : "", &c->error);
    c->fields =
        sph_memory_string(def->fields ? def->fields : "pressure velocity density", &c->error);
    c->group = def->group ? sph_memory_string(def->group, &c->error) : NULL;
    if (!c->error.status) place_all(c, def);
  }
  return (sph_output){.name = "probe",
                      .interval = def->interval,
                      .open = open_probe,
                      .frame = frame_probe,
                      .close = close_probe,
                      .keep = keep_probe,
                      .ctx = c,
                      .free = free_probe};
}
