/* What a run says against its references: tables and exact solutions over time here, exact
 * solutions in space in case_profile.c. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_path.h"
#include "case_profile.h"
#include "case_section.h"
#include "csv.h"
#include "exact.h"
#include "file.h"
#include "memory.h"
#include "sphode/case.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

typedef sph_case_comparer comparer;

typedef struct table {
  long n;
  double *x, *y; /* [n] owned */
} table;

static void table_free(table *t)
{
  sph_memory_free(t->x);
  sph_memory_free(t->y);
}

static int fail(const comparer *a, const sph_case_node *node, const char *what)
{
  return sph_case_schema_fail(a->c, a->error, node, 0, 0, "%s", what);
}

/* ---- tables */

static int table_read(const char *path, const char *x, const char *y, table *t, sph_error *error)
{
  char title[128];
  long n = 0;
  int status = sph_csv_read(path, x, 0, &t->x, &t->n, title, error);
  if (!status) status = sph_csv_read(path, y, 1, &t->y, &n, title, error);
  if (!status && n != t->n)
    status = sph_error_set(error, SPH_ERR_FILE, "%s: columns of %ld and %ld rows", path, t->n, n);
  return status;
}

/* The column of series.csv over time, scaled. */
static int read_run(const comparer *a, table *t)
{
  char path[SPH_PATH];
  double time = get_number(a->node, "time_scale", 1), value = get_number(a->node, "value_scale", 1);
  int status = sph_file_path(path, a->directory, "series.csv", a->error);
  if (!status) status = table_read(path, "time", get_text(a->node, "quantity", ""), t, a->error);
  for (long i = 0; i < t->n && !status; i++) {
    t->x[i] /= time;
    t->y[i] /= value;
  }
  return status;
}

/* Semi-axis of the exact drop at the times of the run. */
static int exact_drop(const comparer *a, const table *run, table *t)
{
  double time = get_number(a->node, "time_scale", 1), value = get_number(a->node, "value_scale", 1);
  sph_exact_drop drop = {.radius = get_number(a->kind, "radius", 0),
                         .rate = get_number(a->kind, "rate", 0),
                         .omega = get_number(a->kind, "omega", 0)};
  sph_exact_ellipse *e = SPH_NEW(sph_exact_ellipse, run->n, "ellipses", a->error);
  t->n = run->n;
  t->x = SPH_NEW(double, run->n, "times", a->error);
  t->y = SPH_NEW(double, run->n, "semi-axes", a->error);
  int status = e && t->x && t->y ? SPH_OK : SPH_ERR_MEMORY,
      b = get_text(a->kind, "axis", "x")[0] == 'y';
  for (long i = 0; i < t->n && !status; i++) t->x[i] = run->x[i] * time;
  if (!status) status = sph_exact_drop_at(&drop, t->n, t->x, e, a->error);
  for (long i = 0; i < t->n && !status; i++) {
    t->x[i] = run->x[i];
    t->y[i] = (b ? e[i].b : e[i].a) / value;
  }
  sph_memory_free(e);
  return status;
}

static int read_reference(const comparer *a, const table *run, table *t)
{
  char path[SPH_PATH];
  if (!strcmp(a->kind->key, "drop")) return exact_drop(a, run, t);
  if (strcmp(a->kind->key, "csv")) return SPH_OK; /* one value */
  int status = sph_case_path(a->c, get_text(a->kind, "file", ""), path, a->error);
  if (status) return status;
  return table_read(path, get_text(a->kind, "x", NULL), get_text(a->kind, "y", NULL), t, a->error);
}

static sph_case_distance wanted(const sph_case_node *node)
{
  double window[3];
  sph_case_distance d = {.norm = get_text(node, "norm", "rms"),
                         .offset = get_number(node, "offset", 0),
                         .average = get_number(node, "average", 0),
                         .by_time = !strcmp(get_text(node, "weight", "points"), "time"),
                         .found = NAN,
                         .window = {-INFINITY, INFINITY},
                         .up_to = get_number(node, "up_to", INFINITY),
                         .threshold = get_number(node, "threshold", 0.5)};
  if (sph_case_reader_vector(node, "window", window)) memcpy(d.window, window, sizeof d.window);
  return d;
}

static int compare_series(const comparer *a, sph_case_distance *d)
{
  table run = {0}, reference = {0};
  d->one = a->kind->number;
  int status = read_run(a, &run);
  if (!status) status = read_reference(a, &run, &reference);
  if (!status)
    status = sph_case_curve_compare(&(sph_case_curve){run.n, run.x, run.y},
                                    &(sph_case_curve){reference.n, reference.x, reference.y}, d,
                                    a->error);
  table_free(&run);
  table_free(&reference);
  return status;
}

/* ---- the list */

/* divide_by, in which `largest` may stand. */
static int divide(const comparer *a, sph_case_distance *d)
{
  static char largest[] = "largest";
  const sph_case_node *node = child_of(a->node, "divide_by");
  sph_case_name names[SPH_CASE_NAMES];
  sph_case_value value;
  int n = a->c->n;
  memcpy(names, a->c->names, (size_t)n * sizeof *names);
  names[n++] = (sph_case_name){.name = largest, .value = d->largest};
  if (!isfinite(d->largest)) return SPH_OK; /* nothing was compared */
  if (sph_case_value_evaluate(node->text, names, n, &value))
    return sph_case_schema_fail(a->c, a->error, node, 1, value.column, "divide_by: %s",
                                value.problem);
  if (!(value.value > 0)) return fail(a, node, "divide_by: must be > 0");
  d->value /= value.value;
  d->unshifted /= value.value;
  return SPH_OK;
}

static int measure(const comparer *a, sph_case_distance *d, char note[SPH_CASE_NOTE])
{
  const sph_case_node *at = child_of(a->node, "at");
  int in_space = sph_case_profile_known(a);
  *d = wanted(a->node);
  note[0] = 0;
  if (at && !in_space) return fail(a, at, "at: belongs to solutions in space");
  int status = in_space                    ? sph_case_profile_compare(a, d, note)
               : sph_case_section_known(a) ? sph_case_section_compare(a, d, note)
                                           : compare_series(a, d);
  return status ? status : divide(a, d);
}

/* Why there is no distance; NULL: there is one, or points of the reference behind the run. */
static const char *nothing_of(const sph_case_distance *d)
{
  if (d->used) return NULL;
  if (!strcmp(d->norm, "arrival"))
    return isfinite(d->largest) ? "the run does not pass the threshold in the window"
                                : "the reference does not pass the threshold in the window";
  if (!strcmp(d->norm, "mean")) return "the run does not cover the window";
  if (sph_case_curve_of_one(d->norm)) return "the run has too few points or swings in the window";
  return d->wanted ? NULL : "no point of the reference is in the window and below up_to";
}

static void note_of(const sph_case_distance *d, char note[SPH_CASE_NOTE])
{
  const char *nothing = nothing_of(d);
  if (nothing)
    snprintf(note, SPH_CASE_NOTE, "%s", nothing);
  else if (d->used < d->wanted)
    snprintf(note, SPH_CASE_NOTE, "the run covers %ld of %ld points of the reference", d->used,
             d->wanted);
  else if (d->offset > 0)
    snprintf(note, SPH_CASE_NOTE, "time offset %.3g; %.3g without", d->shift, d->unshifted);
  else if (isfinite(d->found) && !note[0])
    snprintf(note, SPH_CASE_NOTE, "%.5g", d->found);
}

static int fill(const comparer *a, sph_comparison *to)
{
  sph_case_distance d;
  char note[SPH_CASE_NOTE];
  int status = measure(a, &d, note);
  if (status) return status;
  note_of(&d, note);
  *to = (sph_comparison){.name = get_text(a->node, "name", ""),
                         .reference = get_text(a->node, "source", a->kind->key),
                         .quantity = get_text(a->node, "quantity", ""),
                         .norm = d.norm,
                         .value = d.value,
                         .bar = get_number(a->node, "bar", NAN)};
  to->pass = d.used == d.wanted && d.used > 0 && d.value <= to->bar;
  to->note = sph_memory_string(note, a->error);
  return to->note ? SPH_OK : SPH_ERR_MEMORY;
}

static const sph_case_node *comparison(const sph_case *c, int k)
{
  const sph_case_node *list = child_of(c->root, "compare"), *node = list ? list->first : NULL;
  for (; node && k > 0; k--) node = node->next;
  return node;
}

int sph_case_compare(const sph_case *c, sph_sim *sim, const char *directory, sph_comparison **list,
                     int *n, sph_error *error)
{
  sph_error own = {0};
  comparer a = {.c = c, .sim = sim, .directory = directory, .error = error ? error : &own};
  int count = 0, status = SPH_OK;
  if (list) *list = NULL;
  if (n) *n = 0;
  if (!c || !list || !n)
    return sph_error_set(a.error, SPH_ERR_ARGUMENT, "a comparison of a run: no %s (NULL)",
                         !c      ? "case"
                         : !list ? "place for the list"
                                 : "place for its length");
  while (comparison(c, count)) count++;
  sph_comparison *all = SPH_NEW(sph_comparison, count, "comparisons", a.error);
  if (!all) return SPH_ERR_MEMORY;
  for (int k = 0; k < count && !status; k++) {
    a.number = k;
    a.node = comparison(c, k);
    a.kind = child_of(a.node, "reference")->first;
    status = fill(&a, &all[k]);
  }
  if (status) {
    sph_case_compare_free(all, count);
    return status;
  }
  *list = all;
  *n = count;
  return SPH_OK;
}

void sph_case_compare_free(sph_comparison *list, int n)
{
  for (int k = 0; list && k < n; k++) sph_memory_free((void *)(size_t)list[k].note);
  sph_memory_free(list);
}

/* "front / (0.0572 m)": a column of the run in a scale of its own. */
static int scaled_label(const char *csv, const sph_plot_curve *curve, char label[SPH_CASE_NOTE],
                        sph_error *error)
{
  char title[128];
  double *values = NULL;
  long n = 0;
  int status = sph_csv_read(csv, curve->y, 0, &values, &n, title, error);
  sph_memory_free(values);
  if (status) return status;
  const char *open = strchr(title, '['), *close = open ? strchr(open, ']') : NULL;
  snprintf(label, SPH_CASE_NOTE, close ? "%.60s / (%.4g %.*s)" : "%.60s / %.4g", curve->y,
           curve->y_scale, close ? (int)(close - open) - 1 : 0, open ? open + 1 : "");
  return SPH_OK;
}

/* The run's column and the points of the table. */
static int plot_table(const comparer *a, const char *png)
{
  char run[SPH_PATH], table_path[SPH_PATH], note[SPH_CASE_NOTE];
  sph_case_distance d;
  int status = measure(a, &d, note);
  if (!status) status = sph_file_path(run, a->directory, "series.csv", a->error);
  if (!status) status = sph_case_path(a->c, get_text(a->kind, "file", ""), table_path, a->error);
  if (status) return status;
  double time = get_number(a->node, "time_scale", 1);
  sph_plot_curve curves[] = {{.csv = run,
                              .x = "time",
                              .y = get_text(a->node, "quantity", ""),
                              .x_scale = time,
                              .y_scale = get_number(a->node, "value_scale", 1),
                              .x_offset = -d.shift * time,
                              .label = "this run"},
                             {.csv = table_path,
                              .x = get_text(a->kind, "x", NULL),
                              .y = get_text(a->kind, "y", NULL),
                              .label = get_text(a->node, "source", "reference"),
                              .points = 1}};
  char x_label[40], y_label[SPH_CASE_NOTE];
  snprintf(x_label, sizeof x_label, "time / %.4g s", time);
  status = scaled_label(run, &curves[0], y_label, a->error);
  if (status) return status;
  sph_plot_def def = {.title = get_text(a->node, "name", NULL),
                      .x_label = time == 1 ? NULL : x_label,
                      .y_label = curves[0].y_scale == 1 ? NULL : y_label};
  return sph_plot_series(curves, 2, &def, png, a->error);
}

int sph_case_compare_plot(const sph_case *c, int k, const char *directory, char *png, size_t size,
                          sph_error *error)
{
  sph_error own = {0};
  comparer a = {.c = c, .directory = directory, .number = k, .error = error ? error : &own};
  if (!c || !png)
    return sph_error_set(a.error, SPH_ERR_ARGUMENT, "a picture of comparison %d: no %s (NULL)", k,
                         c ? "place for its path" : "case");
  a.node = comparison(c, k);
  a.kind = a.node ? child_of(a.node, "reference")->first : NULL;
  int in_space = a.kind && sph_case_profile_known(&a);
  const int section = a.kind && sph_case_section_known(&a);
  if (!in_space && !section && (!a.kind || strcmp(a.kind->key, "csv")))
    return sph_error_set(a.error, SPH_ERR_ARGUMENT, "comparison %d has no curves to draw", k);
  if ((size_t)snprintf(png, size, "%s/compare_%d.png", directory, k) >= size)
    return sph_error_set(a.error, SPH_ERR_FILE, "%s: path too long", directory);
  if (section) return sph_case_section_plot(&a, png);
  return in_space ? sph_case_profile_plot(&a, png) : plot_table(&a, png);
}
