/* The field comes from the snapshots of a run: at each point of the table that of moving least
 * squares of order 1 over the fluid particles, which goes on linearly up to walls; then the mean
 * over all snapshots in the window. */
#include "case_section.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_path.h"
#include "csv.h"
#include "file.h"
#include "frames.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode/field.h"
#include "sphode/kernel.h"
#include "sphode/operator.h"
#include "sphode/output.h"
#include "text.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

typedef sph_case_comparer comparer;

/* The table, and what the run has there. */
typedef struct section {
  long n;
  double *at, *value; /* owned: the table's coordinate and value */
  double *place, *now, *sum;
  const double *x[3]; /* in place, which is owned; [m] */
  long frames;
  double first, last; /* times of the frames [s] */
  sph_operator *op;
} section;

int sph_case_section_known(const comparer *a) { return !strcmp(a->kind->key, "section"); }

static int axis_of(const comparer *a) { return get_text(a->kind, "axis", "x")[0] - 'x'; }

static void section_free(section *s)
{
  sph_memory_free(s->at);
  sph_memory_free(s->value);
  sph_memory_free(s->place);
  sph_operator_free(s->op);
}

static int read_table(const comparer *a, section *s)
{
  char path[SPH_CASE_PATH], title[128];
  const sph_case_node *file = sph_case_reader_find(a->kind, "file");
  long n = 0;
  if (sph_case_path(a->c, file->text, path, a->error)) return a->error->status;
  int status = sph_csv_read(path, get_text(a->kind, "x", NULL), 0, &s->at, &s->n, title, a->error);
  if (!status)
    status = sph_csv_read(path, get_text(a->kind, "y", NULL), 1, &s->value, &n, title, a->error);
  if (!status && n != s->n)
    status =
        sph_error_set(a->error, SPH_ERR_FILE, "%s: columns of %ld and %ld rows", path, s->n, n);
  return status;
}

/* The periodic box of the case. */
static void enclose(const comparer *a, sph_operator_def *def)
{
  const sph_case_node *periodic = child_of(a->c->root, "periodic");
  double upper[3] = {0};
  if (!periodic) return;
  sph_case_reader_vector(periodic, "lower", def->origin);
  sph_case_reader_vector(periodic, "upper", upper);
  for (int d = 0; d < 3; d++) def->length[d] = upper[d] - def->origin[d];
  for (const sph_case_node *axis = child_of(periodic, "axes")->first; axis; axis = axis->next)
    def->periodic[*axis->text - 'x'] = 1;
}

/* Its points in space, and the operator. */
static int prepare(const comparer *a, section *s)
{
  const sph_case_node *kernel = child_of(a->c->root, "kernel");
  const char *name = get_text(kernel, "name", NULL);
  double through[3] = {0}, ratio = get_number(kernel, "h_over_dx", 0);
  if (!(ratio > 0)) ratio = sph_kernel_h_over_dx(sph_kernel_find(name));
  sph_operator_def def = {.dim = a->c->dim,
                          .h = ratio * get_number(a->c->root, "spacing", 0),
                          .kernel = name,
                          .lower_order = 1};
  enclose(a, &def);
  sph_case_reader_vector(a->kind, "through", through);
  s->place = sph_memory_new((size_t)s->n + 1, 5 * sizeof *s->place, "a section", a->error);
  if (!s->place) return SPH_ERR_MEMORY;
  s->now = s->place + 3 * s->n;
  s->sum = s->now + s->n;
  for (int d = 0; d < 3; d++) {
    s->x[d] = s->place + d * s->n;
    for (long i = 0; i < s->n; i++)
      s->place[d * s->n + i] =
          d == axis_of(a) ? s->at[i] * get_number(a->kind, "length", 1) : through[d];
  }
  s->op = sph_operator_create(&def, a->error);
  return s->op ? SPH_OK : a->error->status;
}

/* Positions and one field of the fluids; to: [*n], owned. */
static int read_field(const comparer *a, const char *path, const char *field, sph_snapshot *to)
{
  int status = sph_snapshot_read(path, field, to, a->error);
  if (status || (to->x[SPH_FLUIDS] && to->value[SPH_FLUIDS])) return status;
  sph_snapshot_read_free(to);
  return sph_error_set(a->error, SPH_ERR_FILE, "%s: no field %s of fluids", path, field);
}

static int interpolate(const comparer *a, section *s, const sph_snapshot *field, double *x,
                       const double *volume)
{
  const long n = field->n[SPH_FLUIDS];
  const double *const by[3] = {x, x + n, x + 2 * n};
  for (long i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) x[d * n + i] = field->x[SPH_FLUIDS][3 * i + d];
  int status = sph_operator_set_points(s->op, n, by, volume, NULL, a->error);
  if (!status) status = sph_operator_set_probes(s->op, s->n, s->x, a->error);
  if (!status)
    status = sph_operator_mls(s->op, 1, field->value[SPH_FLUIDS], s->now, NULL, NULL, a->error);
  for (long i = 0; i < s->n && !status; i++) s->sum[i] += s->now[i];
  return status;
}

static int add_frame(const comparer *a, const char *path, section *s)
{
  sph_snapshot mass = {0}, density = {0}, field = {0};
  double *work = NULL;
  int status = read_field(a, path, "mass", &mass);
  if (!status) status = read_field(a, path, "density", &density);
  if (!status) status = read_field(a, path, get_text(a->node, "quantity", ""), &field);
  const long n = status ? 0 : field.n[SPH_FLUIDS];
  if (!status && !(work = sph_memory_new((size_t)n, 4 * sizeof *work, "a section", a->error)))
    status = SPH_ERR_MEMORY;
  for (long i = 0; i < n && !status; i++)
    work[i] = mass.value[SPH_FLUIDS][i] / density.value[SPH_FLUIDS][i];
  if (!status) status = interpolate(a, s, &field, work + n, work);
  sph_memory_free(work);
  sph_snapshot_read_free(&mass);
  sph_snapshot_read_free(&density);
  sph_snapshot_read_free(&field);
  return status;
}

/* All snapshots in the window of times; those of a run before it are not there any more. */
static int add_frames(const comparer *a, const double window[2], section *s)
{
  char path[SPH_PATH];
  long *number = NULL;
  const double scale = get_number(a->node, "time_scale", 1), slack = 1e-9 * sph_case_end(a->c);
  int count = sph_frames_list(a->directory, &number, a->error);
  int status = count < 0 ? count : SPH_OK;
  for (int k = 0; k < count && !status; k++) {
    double time;
    status = sph_frames_path(path, a->directory, number[k], a->error);
    if (!status) status = sph_snapshot_read_time(path, &time, a->error);
    if (status || time < window[0] * scale - slack || time > window[1] * scale + slack) continue;
    if (!s->frames++) s->first = time;
    s->last = time;
    status = add_frame(a, path, s);
  }
  sph_memory_free(number);
  return status;
}

static int table_path(const comparer *a, char path[SPH_PATH])
{
  char name[40];
  snprintf(name, sizeof name, "compare_%d.csv", a->number);
  return sph_file_path(path, a->directory, name, a->error);
}

static int write_table(const comparer *a, const section *s)
{
  char path[SPH_PATH];
  sph_text text = {0};
  sph_text_add(&text, "# %s: %s, and %s\n", get_text(a->node, "name", ""),
               get_text(a->node, "quantity", ""), get_text(a->node, "source", "the table"));
  sph_text_add(&text, "# mean of %ld snapshots, t = %.9g s to %.9g s\nat,run,reference\n",
               s->frames, s->first, s->last);
  for (long i = 0; i < s->n; i++)
    sph_text_add(&text, "%.15g,%.15g,%.15g\n", s->at[i], s->sum[i], s->value[i]);
  int status = table_path(a, path);
  if (!status) status = sph_error_set(a->error, text.error.status, "%s", text.error.text);
  if (!status) status = sph_file_replace(path, text.data, text.length, a->error);
  sph_text_free(&text);
  return status;
}

static int measure(const comparer *a, sph_case_distance *d, section *s, char note[SPH_CASE_NOTE])
{
  const double scale = get_number(a->node, "value_scale", 1);
  int status = read_table(a, s);
  if (!status) status = prepare(a, s);
  if (!status) status = add_frames(a, d->window, s);
  if (!status && !s->frames)
    status = sph_case_schema_fail(a->c, a->error, a->node, 0, 0,
                                  "window: there is no snapshot in it; see output: snapshots");
  if (status) return status;
  d->largest = -INFINITY;
  for (long i = 0; i < s->n; i++) {
    s->sum[i] /= (double)s->frames * scale;
    d->largest = fmax(d->largest, s->value[i]);
  }
  d->used = d->wanted = s->n;
  d->unshifted = d->value = sph_case_curve_norm(d->norm, s->n, NULL, s->sum, s->value);
  snprintf(note, SPH_CASE_NOTE, "mean of %ld snapshots from %.4g s to %.4g s", s->frames, s->first,
           s->last);
  return write_table(a, s);
}

int sph_case_section_compare(const comparer *a, sph_case_distance *d, char note[SPH_CASE_NOTE])
{
  section s = {0};
  note[0] = 0;
  int status = measure(a, d, &s, note);
  section_free(&s);
  return status;
}

/* "m/s" of "velocity_x"; "": of a scalar of a term. */
static const char *unit_of(const char *quantity)
{
  char name[64];
  snprintf(name, sizeof name, "%s", quantity);
  const size_t n = strlen(name);
  if (sph_field_find(name) < 0 && n > 2 && name[n - 2] == '_') name[n - 2] = '\0';
  const int number = sph_field_find(name);
  return number < 0 ? "" : sph_field_get(number)->unit;
}

int sph_case_section_plot(const comparer *a, const char *png)
{
  char path[SPH_PATH], x_label[SPH_CASE_LABEL], y_label[SPH_CASE_LABEL];
  const char *quantity = get_text(a->node, "quantity", "");
  int status = table_path(a, path);
  sph_plot_curve curves[] = {{.csv = path, .x = "at", .y = "run", .label = "this run", .points = 2},
                             {.csv = path, .x = "at", .y = "reference", .points = 1}};
  curves[1].label = get_text(a->node, "source", "reference");
  sph_case_curve_label(x_label, get_text(a->kind, "axis", "x"), get_number(a->kind, "length", 1),
                       "m");
  sph_case_curve_label(y_label, quantity, get_number(a->node, "value_scale", 1), unit_of(quantity));
  sph_plot_def def = {.title = get_text(a->node, "name", NULL),
                      .x_label = x_label,
                      .y_label = y_label};
  return status ? status : sph_plot_series(curves, 2, &def, png, a->error);
}
