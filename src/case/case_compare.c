/* What a run says against its references: tables over time, exact solutions at the end. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_curve.h"
#include "case_schema.h"
#include "csv.h"
#include "exact.h"
#include "file.h"
#include "memory.h"
#include "sphode/case.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

typedef struct comparer {
  const sph_case *c;
  sph_sim *sim; /* NULL: series only */
  const char *directory;
  const sph_case_node *node; /* the comparison */
  const sph_case_node *kind; /* of its reference */
  sph_error *error;
} comparer;

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

/* The path of a file that stands beside the case. */
static int beside(const sph_case *c, const char *file, char path[SPH_PATH], sph_error *error)
{
  const char *slash = strrchr(c->path, '/');
  int directory = slash && file[0] != '/' ? (int)(slash - c->path) + 1 : 0;
  int n = snprintf(path, SPH_PATH, "%.*s%s", directory, c->path, file);
  if (n < SPH_PATH) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "%.100s...: path too long", file);
}

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
  int status = beside(a->c, get_text(a->kind, "file", ""), path, a->error);
  if (status) return status;
  return table_read(path, get_text(a->kind, "x", NULL), get_text(a->kind, "y", NULL), t, a->error);
}

static sph_case_distance wanted(const sph_case_node *node)
{
  double window[3];
  sph_case_distance d = {.norm = get_text(node, "norm", "rms"),
                         .offset = get_number(node, "offset", 0),
                         .average = get_number(node, "average", 0),
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

/* ---- exact solutions at the end, over the particles of the fluids */

typedef struct profile {
  long n;
  double *x, *run, *exact, *weight; /* [n] owned; weight: volume */
} profile;

static void profile_free(profile *p)
{
  sph_memory_free(p->x);
  sph_memory_free(p->run);
  sph_memory_free(p->exact);
  sph_memory_free(p->weight);
}

static int profile_new(profile *p, long n, sph_error *error)
{
  p->x = SPH_NEW(double, n, "a profile", error);
  p->run = SPH_NEW(double, n, "a profile", error);
  p->exact = SPH_NEW(double, n, "a profile", error);
  p->weight = SPH_NEW(double, n, "a profile", error);
  return p->x && p->run && p->exact && p->weight ? SPH_OK : SPH_ERR_MEMORY;
}

/* "velocity_y": field and component. */
static const double *field_of(const sph_group *group, const char *name)
{
  char field[40];
  size_t n = strlen(name);
  int component = 0;
  snprintf(field, sizeof field, "%s", name);
  if (n > 2 && n < sizeof field && name[n - 2] == '_' && strchr("xyz", name[n - 1])) {
    component = name[n - 1] - 'x';
    field[n - 2] = 0;
  }
  return sph_group_read(group, field, component);
}

/* The particles of a group whose coordinate is in the window. */
static int gather(const comparer *a, const sph_group *group, int axis, const double window[2],
                  profile *p)
{
  const double *x = sph_group_read(group, "position", axis), *m = sph_group_read(group, "mass", 0);
  const double *rho = sph_group_read(group, "density", 0);
  const double *f = field_of(group, get_text(a->node, "quantity", ""));
  if (!x || !m || !rho || !f) return fail(a, child_of(a->node, "quantity"), "no such field");
  for (long i = 0; i < sph_group_count(group); i++) {
    if (x[i] < window[0] || x[i] > window[1]) continue;
    p->x[p->n] = x[i];
    p->run[p->n] = f[i];
    p->weight[p->n++] = m[i] / rho[i];
  }
  return SPH_OK;
}

static sph_exact_gas gas_of(const sph_case_node *map)
{
  return (sph_exact_gas){.rho = get_number(map, "density", 0),
                         .u = get_number(map, "velocity", 0),
                         .p = get_number(map, "pressure", 0)};
}

static int exact_riemann(const comparer *a, profile *p)
{
  const char *field = get_text(a->node, "quantity", "");
  double t = sph_sim_time(a->sim), gamma = get_number(a->kind, "gamma", 1.4);
  sph_exact_riemann r = {.gamma = gamma,
                         .left = gas_of(child_of(a->kind, "left")),
                         .right = gas_of(child_of(a->kind, "right"))};
  int status = sph_exact_riemann_solve(&r, a->error);
  for (long i = 0; i < p->n && !status; i++) {
    double s = t > 0 ? p->x[i] / t : copysign(HUGE_VAL, p->x[i]);
    sph_exact_gas gas = sph_exact_riemann_at(&r, s);
    if (!strcmp(field, "density"))
      p->exact[i] = gas.rho;
    else if (!strcmp(field, "velocity_x"))
      p->exact[i] = gas.u;
    else if (!strcmp(field, "pressure"))
      p->exact[i] = gas.p;
    else if (!strcmp(field, "energy"))
      p->exact[i] = gas.p / ((gamma - 1) * gas.rho);
    else
      return fail(a, child_of(a->node, "quantity"),
                  "a Riemann problem has density, velocity_x, pressure, energy");
  }
  return status;
}

static int exact_column(const comparer *a, const sph_group *group, profile *p)
{
  const char *field = get_text(a->node, "quantity", "");
  sph_exact_column column = {.eos = *sph_group_eos(group),
                             .surface = get_number(a->kind, "surface", 0),
                             .g = get_number(a->kind, "gravity", 0)};
  column.p_surface = column.eos.p_background;
  if (!strcmp(field, "pressure"))
    return sph_exact_column_at(&column, p->n, p->x, NULL, p->exact, a->error);
  if (!strcmp(field, "density"))
    return sph_exact_column_at(&column, p->n, p->x, p->exact, NULL, a->error);
  return fail(a, child_of(a->node, "quantity"), "a column at rest has pressure and density");
}

static int compare_profile(const comparer *a, sph_case_distance *d)
{
  int riemann = !strcmp(a->kind->key, "riemann"), axis = riemann ? 0 : a->c->dim - 1;
  const sph_group *fluid = NULL, *group;
  profile p = {0};
  long n = 0;
  for (int k = 0; (group = sph_sim_group_get(a->sim, k)); k++) {
    if (strcmp(sph_group_kind(group), "fluid")) continue;
    if (!fluid) fluid = group;
    n += sph_group_count(group);
  }
  if (!fluid) return fail(a, a->node, "there is no fluid");
  int status = profile_new(&p, n, a->error);
  for (int k = 0; !status && (group = sph_sim_group_get(a->sim, k)); k++)
    if (!strcmp(sph_group_kind(group), "fluid")) status = gather(a, group, axis, d->window, &p);
  if (!status) status = riemann ? exact_riemann(a, &p) : exact_column(a, fluid, &p);
  if (!status) {
    double scale = get_number(a->node, "value_scale", 1);
    d->largest = 0;
    for (long i = 0; i < p.n; i++) d->largest = fmax(d->largest, p.exact[i] / scale);
    d->unshifted = d->value = sph_case_curve_norm(d->norm, p.n, p.weight, p.run, p.exact) / scale;
    d->used = d->wanted = p.n;
  }
  profile_free(&p);
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

static int measure(const comparer *a, sph_case_distance *d)
{
  int at_end = !strcmp(a->kind->key, "riemann") || !strcmp(a->kind->key, "column");
  *d = wanted(a->node);
  if (at_end && (!strcmp(d->norm, "mean") || !strcmp(d->norm, "arrival")))
    return fail(a, child_of(a->node, "norm"), "riemann and column know rms, l1, max");
  int status = at_end ? compare_profile(a, d) : compare_series(a, d);
  return status ? status : divide(a, d);
}

static char *note_of(const sph_case_distance *d, sph_error *error)
{
  char note[160] = "";
  if (d->used < d->wanted)
    snprintf(note, sizeof note, "the run covers %ld of %ld points of the reference", d->used,
             d->wanted);
  else if (d->offset > 0)
    snprintf(note, sizeof note, "time offset %.3g; %.3g without", d->shift, d->unshifted);
  return sph_memory_string(note, error);
}

static int fill(const comparer *a, sph_comparison *to)
{
  sph_case_distance d;
  int status = measure(a, &d);
  if (status) return status;
  *to = (sph_comparison){.name = get_text(a->node, "name", ""),
                         .reference = get_text(a->node, "source", a->kind->key),
                         .quantity = get_text(a->node, "quantity", ""),
                         .norm = d.norm,
                         .value = d.value,
                         .bar = get_number(a->node, "bar", NAN)};
  to->pass = d.used == d.wanted && d.used > 0 && d.value <= to->bar;
  to->note = note_of(&d, a->error);
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

int sph_case_compare_plot(const sph_case *c, int k, const char *directory, char *png, size_t size,
                          sph_error *error)
{
  char run[SPH_PATH], table_path[SPH_PATH];
  sph_error own = {0};
  comparer a = {.c = c, .directory = directory, .error = error ? error : &own};
  if (!c || !png)
    return sph_error_set(a.error, SPH_ERR_ARGUMENT, "a picture of comparison %d: no %s (NULL)", k,
                         c ? "place for its path" : "case");
  a.node = comparison(c, k);
  a.kind = a.node ? child_of(a.node, "reference")->first : NULL;
  if (!a.kind || strcmp(a.kind->key, "csv"))
    return sph_error_set(a.error, SPH_ERR_ARGUMENT, "comparison %d has no table to draw", k);
  sph_case_distance d;
  int status = measure(&a, &d);
  if (!status) status = sph_file_path(run, directory, "series.csv", a.error);
  if (!status) status = beside(c, get_text(a.kind, "file", ""), table_path, a.error);
  if (status) return status;
  double time = get_number(a.node, "time_scale", 1);
  sph_plot_curve curves[] = {{.csv = run,
                              .x = "time",
                              .y = get_text(a.node, "quantity", ""),
                              .x_scale = time,
                              .y_scale = get_number(a.node, "value_scale", 1),
                              .x_offset = -d.shift * time,
                              .label = "this run"},
                             {.csv = table_path,
                              .x = get_text(a.kind, "x", NULL),
                              .y = get_text(a.kind, "y", NULL),
                              .label = get_text(a.node, "source", "reference"),
                              .points = 1}};
  sph_plot_def def = {.title = get_text(a.node, "name", NULL),
                      .x_label = "scaled time",
                      .y_label = get_text(a.node, "quantity", "")};
  if ((size_t)snprintf(png, size, "%s/compare_%d.png", directory, k) >= size)
    return sph_error_set(a.error, SPH_ERR_FILE, "%s: path too long", directory);
  return sph_plot_series(curves, 2, &def, png, a.error);
}
