#include "case_profile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_solution.h"
#include "file.h"
#include "frames.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode/field.h"
#include "text.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

typedef sph_case_comparer comparer;

enum { TIMES = 16 };

/* What is compared: a field or one component of it. */
typedef struct quantity {
  char field[64];
  int first, components; /* of the field */
} quantity;

typedef struct profile {
  double time; /* [s] */
  long n;      /* particles that are compared, */
  long first;  /* of all those of fluids, in the order of the groups */
  long all;
  int components;
  double *x[3], *run[3], *exact[3]; /* [n]; [dim], [components] */
  double *weight;                   /* [n] volume [m^dim] */
  double *memory;                   /* of all, owned */
} profile;

static int fail(const comparer *a, const sph_case_node *node, const char *what)
{
  return sph_case_schema_fail(a->c, a->error, node, 0, 0, "%s", what);
}

int sph_case_profile_known(const comparer *a)
{
  return sph_case_solution_find(a->kind->key) != NULL;
}

/* "velocity_y": a component; "velocity": all of them. */
static quantity quantity_of(const comparer *a)
{
  const char *name = get_text(a->node, "quantity", "");
  size_t n = strlen(name);
  quantity q = {.components = 1};
  snprintf(q.field, sizeof q.field, "%s", name);
  if (n > 2 && n < sizeof q.field && name[n - 2] == '_' && strchr("xyz", name[n - 1])) {
    q.first = name[n - 1] - 'x';
    q.field[n - 2] = 0;
    return q;
  }
  int number = sph_field_find(q.field);
  if (number >= 0 && sph_field_get(number)->vector) q.components = a->c->dim;
  return q;
}

/* Coordinate that the solution depends on; -1: several. */
static int along(const comparer *a)
{
  int axis = sph_case_solution_find(a->kind->key)->along;
  return axis == SPH_CASE_ALONG_LAST ? a->c->dim - 1 : axis == SPH_CASE_ALONG_NONE ? -1 : axis;
}

/* ---- particles: of the simulation as it is, or of a snapshot */

static int make(profile *p, int dim, int components, sph_error *error)
{
  const long n = p->n;
  int arrays = 0;
  p->memory = sph_memory_new((size_t)n + 1, 10 * sizeof *p->memory, "a profile", error);
  if (!p->memory) return SPH_ERR_MEMORY;
  p->components = components;
  for (int d = 0; d < dim; d++) p->x[d] = p->memory + n * arrays++;
  for (int c = 0; c < components; c++) p->run[c] = p->memory + n * arrays++;
  for (int c = 0; c < components; c++) p->exact[c] = p->memory + n * arrays++;
  p->weight = p->memory + n * arrays;
  return SPH_OK;
}

/* Of those that are compared: one, or all. */
static const sph_group *next_fluid(const comparer *a, int *k)
{
  const char *only = get_text(a->node, "group", NULL);
  const sph_group *group;
  for (; (group = sph_sim_group_get(a->sim, *k)); ++*k)
    if (!strcmp(sph_group_kind(group), "fluid") && (!only || !strcmp(only, sph_group_name(group))))
      break;
  return group;
}

static void count_fluids(const comparer *a, profile *p)
{
  const sph_group *group;
  int first = 0;
  next_fluid(a, &first);
  for (int k = 0; (group = next_fluid(a, &k)); k++) p->n += sph_group_count(group);
  for (int k = 0; (group = sph_sim_group_get(a->sim, k)); k++) {
    if (strcmp(sph_group_kind(group), "fluid") != 0) continue;
    p->all += sph_group_count(group);
    if (k < first) p->first += sph_group_count(group);
  }
}

static int from_simulation(const comparer *a, const quantity *q, profile *p)
{
  const sph_group *group;
  long first = 0;
  for (int k = 0; (group = next_fluid(a, &k)); k++) {
    long n = sph_group_count(group);
    const double *m = sph_group_read(group, "mass", 0), *rho = sph_group_read(group, "density", 0);
    for (int d = 0; d < a->c->dim; d++)
      memcpy(p->x[d] + first, sph_group_read(group, "position", d), (size_t)n * sizeof *p->x[d]);
    for (int c = 0; c < q->components; c++) {
      const double *from = sph_group_read(group, q->field, q->first + c);
      if (!from) return fail(a, child_of(a->node, "quantity"), "no such field");
      memcpy(p->run[c] + first, from, (size_t)n * sizeof *from);
    }
    for (long i = 0; i < n; i++) p->weight[first + i] = m[i] / rho[i];
    first += n;
  }
  return SPH_OK;
}

/* One field of all fluids of a snapshot to to[p->n], and their positions. */
static int read_field(const comparer *a, const char *path, const char *field, profile *p,
                      double *to)
{
  sph_snapshot s;
  int status = sph_snapshot_read(path, field, &s, a->error);
  if (status) return status;
  const double *x = s.x[SPH_FLUIDS], *value = s.value[SPH_FLUIDS];
  long found = x && value ? s.n[SPH_FLUIDS] : 0;
  if (!x || !value || found != p->all) {
    sph_snapshot_read_free(&s);
    return sph_error_set(a->error, SPH_ERR_FILE,
                         "%s: %ld fluid particles with %s; the case has %ld", path, found, field,
                         p->all);
  }
  for (long i = 0; i < p->n; i++) {
    const long from = p->first + i;
    for (int d = 0; d < a->c->dim; d++) p->x[d][i] = x[3 * from + d];
    to[i] = value[from];
  }
  sph_snapshot_read_free(&s);
  return SPH_OK;
}

static int from_snapshot(const comparer *a, const char *path, const quantity *q, profile *p)
{
  int number = sph_field_find(q->field), vector = number >= 0 && sph_field_get(number)->vector;
  int status = read_field(a, path, "mass", p, p->weight);
  if (!status) status = read_field(a, path, "density", p, p->exact[0]); /* in passing */
  for (long i = 0; i < p->n && !status; i++) p->weight[i] /= p->exact[0][i];
  for (int c = 0; c < q->components && !status; c++) {
    char name[80];
    snprintf(name, sizeof name, vector ? "%s_%c" : "%s", q->field, 'x' + q->first + c);
    status = read_field(a, path, name, p, p->run[c]);
  }
  return status;
}

/* The snapshot at time t, within rounding. */
static int find_snapshot(const comparer *a, double t, char path[SPH_PATH])
{
  long *number = NULL;
  int count = sph_frames_list(a->directory, &number, a->error), found = -1;
  int status = count < 0 ? count : SPH_OK;
  double nearest = NAN, time;
  for (int k = 0; k < count && !status && found < 0; k++) {
    status = sph_frames_path(path, a->directory, number[k], a->error);
    if (!status) status = sph_snapshot_read_time(path, &time, a->error);
    if (status) break;
    if (!(fabs(time - t) >= fabs(nearest - t))) nearest = time;
    if (fabs(time - t) <= 1e-9 * fmax(t, sph_case_end(a->c))) found = k;
  }
  sph_memory_free(number);
  if (status || found >= 0) return status;
  return sph_case_schema_fail(a->c, a->error, child_of(a->node, "at"), 0, 0,
                              "at: there is no snapshot at t = %g s, the nearest is at %g s; see "
                              "output: snapshots",
                              t, nearest);
}

/* ---- the exact solution at the particles */

static int solve(const comparer *a, const quantity *q, profile *p)
{
  const sph_case_solution *solution = sph_case_solution_find(a->kind->key);
  sph_case_moment m = {.reference = a->kind, .sim = a->sim, .time = p->time, .dim = a->c->dim};
  const sph_case_node *named = child_of(a->node, "quantity");
  sph_error e = {0};
  long first = 0;
  int status = SPH_OK;
  for (int k = 0; !status && (m.group = next_fluid(a, &k)); k++) {
    m.n = sph_group_count(m.group);
    for (int d = 0; d < m.dim; d++) m.x[d] = p->x[d] + first;
    for (int c = 0; c < q->components && !status; c++)
      status = solution->at(&m, q->field, q->first + c, p->exact[c] + first, &e);
    first += m.n;
  }
  if (status == SPH_CASE_NO_FIELD)
    return sph_case_schema_fail(a->c, a->error, named, 1, 0, "quantity: found '%.60s'; %s",
                                named->text, solution->about);
  if (status == SPH_ERR_MEMORY) return sph_error_set(a->error, status, "%s", e.text);
  return status ? sph_case_schema_fail(a->c, a->error, a->kind, 0, 0, "%s", e.text) : SPH_OK;
}

/* Keeps the particles whose coordinate is in the window. */
static void cut(const comparer *a, const double window[2], profile *p)
{
  int axis = along(a) < 0 ? 0 : along(a);
  long n = 0;
  for (long i = 0; i < p->n; i++) {
    if (p->x[axis][i] < window[0] || p->x[axis][i] > window[1]) continue;
    for (int d = 0; d < a->c->dim; d++) p->x[d][n] = p->x[d][i];
    for (int c = 0; c < p->components; c++) {
      p->run[c][n] = p->run[c][i];
      p->exact[c][n] = p->exact[c][i];
    }
    p->weight[n++] = p->weight[i];
  }
  p->n = n;
}

static int take(const comparer *a, const double *at, const quantity *q, const double window[2],
                profile *p)
{
  char path[SPH_PATH];
  double now = sph_sim_time(a->sim);
  int past = at && fabs(*at - now) > 1e-9 * now;
  count_fluids(a, p);
  int status = make(p, a->c->dim, q->components, a->error);
  p->time = at ? *at : now;
  if (!status && past) status = find_snapshot(a, p->time, path);
  if (!status) status = past ? from_snapshot(a, path, q, p) : from_simulation(a, q, p);
  if (!status) status = solve(a, q, p);
  if (!status) cut(a, window, p);
  return status;
}

/* ---- distances */

/* Of a vector: the length of the difference. */
static int distance(const comparer *a, const profile *p, const char *norm, double *value)
{
  double *apart = SPH_NEW(double, 2 * p->n, "a distance", a->error);
  if (!apart) return SPH_ERR_MEMORY;
  for (long i = 0; i < p->n; i++) {
    double sum = 0;
    for (int c = 0; c < p->components; c++)
      sum += (p->run[c][i] - p->exact[c][i]) * (p->run[c][i] - p->exact[c][i]);
    apart[i] = sqrt(sum);
  }
  *value = sph_case_curve_norm(norm, p->n, p->weight, apart, apart + p->n);
  sph_memory_free(apart);
  return SPH_OK;
}

static double largest(const profile *p)
{
  double most = 0;
  for (long i = 0; i < p->n; i++) {
    double sum = 0;
    for (int c = 0; c < p->components; c++) sum += p->exact[c][i] * p->exact[c][i];
    most = fmax(most, p->components == 1 ? p->exact[0][i] : sqrt(sum));
  }
  return most;
}

/* ---- the table of a comparison: for each time k the columns x_k, run_k, exact_k */

typedef struct row {
  double x;
  long i;
} row;

static int by_x(const void *a, const void *b)
{
  const row *p = a, *q = b;
  return p->x != q->x ? (p->x > q->x) - (p->x < q->x) : (p->i > q->i) - (p->i < q->i);
}

/* Places of the particles along the coordinate; without one as they are. */
static row *rows_of(const comparer *a, const profile *p)
{
  row *rows = SPH_NEW(row, p->n, "a table", a->error);
  int axis = along(a);
  for (long i = 0; rows && i < p->n; i++)
    rows[i] = (row){axis < 0 ? p->exact[0][i] : p->x[axis][i], i};
  if (rows) qsort(rows, (size_t)p->n, sizeof *rows, by_x);
  return rows;
}

static const char *unit_of(const quantity *q)
{
  const int number = sph_field_find(q->field);
  return number < 0 ? "" : sph_field_get(number)->unit;
}

static void add_head(const comparer *a, const profile *p, int times, const quantity *q,
                     sph_text *text)
{
  const int axis = along(a);
  const char *unit = unit_of(q);
  sph_text_add(text, "# %s: %s, and %s\n", get_text(a->node, "name", ""),
               get_text(a->node, "quantity", ""), get_text(a->node, "source", a->kind->key));
  for (int k = 0; k < times; k++) sph_text_add(text, "# _%d: t = %.9g s\n", k, p[k].time);
  for (int k = 0; k < times; k++) {
    if (axis >= 0) sph_text_add(text, "%s%c_%d [m]", k ? "," : "", 'x' + axis, k);
    for (int c = 0; c < q->components; c++)
      sph_text_add(text, "%srun%d_%d [%s],exact%d_%d [%s]", k || c || axis >= 0 ? "," : "", c, k,
                   unit, c, k, unit);
  }
  sph_text_add(text, "\n");
}

static void add_row(const comparer *a, const profile *p, int times, row *const rows[TIMES], long i,
                    sph_text *text)
{
  int axis = along(a);
  for (int k = 0; k < times; k++) {
    int there = i < p[k].n;
    long at = there ? rows[k][i].i : 0;
    if (axis >= 0) sph_text_add(text, "%s%.15g", k ? "," : "", there ? p[k].x[axis][at] : NAN);
    for (int c = 0; c < p[k].components; c++)
      sph_text_add(text, "%s%.15g,%.15g", k || c || axis >= 0 ? "," : "",
                   there ? p[k].run[c][at] : NAN, there ? p[k].exact[c][at] : NAN);
  }
  sph_text_add(text, "\n");
}

static int table_path(const comparer *a, char path[SPH_PATH])
{
  char name[40];
  snprintf(name, sizeof name, "compare_%d.csv", a->number);
  return sph_file_path(path, a->directory, name, a->error);
}

static int write_table(const comparer *a, const profile *p, int times, const quantity *q)
{
  char path[SPH_PATH];
  row *rows[TIMES] = {NULL};
  sph_text text = {0};
  long n = 0;
  int status = table_path(a, path);
  add_head(a, p, times, q, &text);
  for (int k = 0; k < times && !status; k++) {
    rows[k] = rows_of(a, &p[k]);
    if (!rows[k]) status = SPH_ERR_MEMORY;
    if (p[k].n > n) n = p[k].n;
  }
  for (long i = 0; i < n && !status; i++) add_row(a, p, times, rows, i, &text);
  if (!status) status = sph_error_set(a->error, text.error.status, "%s", text.error.text);
  if (!status) status = sph_file_replace(path, text.data, text.length, a->error);
  for (int k = 0; k < times; k++) sph_memory_free(rows[k]);
  sph_text_free(&text);
  return status;
}

/* ---- together */

/* The times asked for, times[TIMES]; returns how many, 0: the end. */
static int times_of(const comparer *a, double times[TIMES])
{
  const sph_case_node *list = child_of(a->node, "at"), *node = list ? list->first : NULL;
  int n = 0;
  for (; node; node = node->next) {
    if (n == TIMES) return fail(a, list, "at: more than 16 times");
    times[n++] = node->number;
  }
  return n;
}

static int compare_all(const comparer *a, sph_case_distance *d, const double *times, int n,
                       profile *p, char note[SPH_CASE_NOTE])
{
  double scale = get_number(a->node, "value_scale", 1);
  quantity q = quantity_of(a);
  int status = SPH_OK;
  size_t used = 0;
  d->value = d->largest = 0;
  d->used = d->wanted = 0;
  for (int k = 0; k < (n ? n : 1) && !status; k++) {
    double value = NAN;
    status = take(a, n ? &times[k] : NULL, &q, d->window, &p[k]);
    if (!status) status = distance(a, &p[k], d->norm, &value);
    value /= scale;
    if (!(value <= d->value || isnan(d->value))) d->value = value; /* NaN stays */
    d->largest = fmax(d->largest, largest(&p[k]) / scale);
    d->used = d->wanted += p[k].n;
    if (n > 1 && !status && used < SPH_CASE_NOTE)
      used += (size_t)snprintf(note + used, SPH_CASE_NOTE - used, "%s%.3g at %.3g s", k ? ", " : "",
                               value, times[k]);
  }
  d->unshifted = d->value;
  if (!status && a->directory) status = write_table(a, p, n ? n : 1, &q);
  return status;
}

int sph_case_profile_compare(const comparer *a, sph_case_distance *d, char note[SPH_CASE_NOTE])
{
  double times[TIMES];
  profile p[TIMES] = {{0}};
  int first = 0;
  note[0] = 0;
  if (!a->sim) return fail(a, a->node, "a solution in space is compared with a simulation");
  if (!next_fluid(a, &first)) return fail(a, a->node, "there is no fluid");
  int n = times_of(a, times);
  int status = n < 0 ? n : compare_all(a, d, times, n, p, note);
  for (int k = 0; k < TIMES; k++) sph_memory_free(p[k].memory);
  return status;
}

/* The solution at the end, where the particles are now: what it has not, it says here. */
int sph_case_profile_check(const comparer *a)
{
  const sph_group *group;
  quantity q = quantity_of(a);
  profile p = {.time = sph_case_end(a->c)};
  double times[TIMES];
  long first = 0;
  if (times_of(a, times) < 0) return a->error->status;
  count_fluids(a, &p);
  int status = make(&p, a->c->dim, q.components, a->error);
  for (int k = 0; !status && (group = next_fluid(a, &k)); k++) {
    const long n = sph_group_count(group);
    for (int d = 0; d < a->c->dim; d++)
      memcpy(p.x[d] + first, sph_group_read(group, "position", d), (size_t)n * sizeof *p.x[d]);
    first += n;
  }
  if (!status) status = solve(a, &q, &p);
  sph_memory_free(p.memory);
  return status;
}

/* ---- the picture of the table */

enum { NAME = 40, CURVES = 2 * 3 * TIMES };

typedef struct picture {
  sph_plot_curve curve[CURVES];
  char x[CURVES][NAME], y[CURVES][NAME], label[CURVES][NAME];
  int n;
} picture;

/* Component c at time number k: the particles as points, the solution as a line. */
static void add_curve(const comparer *a, picture *p, const char *path, int exact, int k, int c,
                      double t)
{
  int n = p->n++, axis = along(a), several = quantity_of(a).components > 1;
  double scale = get_number(a->node, "value_scale", 1);
  snprintf(p->y[n], NAME, "%s%d_%d", exact ? "exact" : "run", c, k);
  if (axis >= 0)
    snprintf(p->x[n], NAME, "%c_%d", 'x' + axis, k);
  else
    snprintf(p->x[n], NAME, "exact%d_%d", c, k);
  if (exact)
    snprintf(p->label[n], NAME, "%s", k || c ? "" : "exact");
  else
    snprintf(p->label[n], NAME, several ? "t = %.3g s, %c" : "t = %.3g s", t, 'x' + c);
  p->curve[n] = (sph_plot_curve){.csv = path,
                                 .x = p->x[n],
                                 .y = p->y[n],
                                 .x_scale = axis < 0 ? scale : 1,
                                 .y_scale = scale,
                                 .label = p->label[n],
                                 .points = !exact,
                                 .colour = exact ? 7 : 0};
}

int sph_case_profile_plot(const comparer *a, const char *png)
{
  char path[SPH_PATH], x_label[SPH_CASE_LABEL], y_label[SPH_CASE_LABEL];
  double times[TIMES] = {sph_case_end(a->c)}, scale = get_number(a->node, "value_scale", 1);
  quantity q = quantity_of(a);
  int given = times_of(a, times), count = given > 0 ? given : 1, axis = along(a);
  int status = given < 0 ? given : table_path(a, path);
  picture *p = status ? NULL : SPH_NEW(picture, 1, "a picture", a->error);
  if (!p) return status ? status : SPH_ERR_MEMORY;
  for (int exact = 0; exact < 2; exact++)
    for (int k = 0; k < count; k++)
      for (int c = 0; c < q.components; c++) add_curve(a, p, path, exact, k, c, times[k]);
  sph_case_curve_label(y_label, get_text(a->node, "quantity", ""), scale, unit_of(&q));
  if (axis < 0)
    sph_case_curve_label(x_label, "exact", scale, unit_of(&q));
  else
    snprintf(x_label, sizeof x_label, "%c [m]", 'x' + axis);
  sph_plot_def def = {.title = get_text(a->node, "name", NULL),
                      .x_label = x_label,
                      .y_label = y_label};
  status = sph_plot_series(p->curve, p->n, &def, png, a->error);
  sph_memory_free(p);
  return status;
}
