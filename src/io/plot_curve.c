#include "plot_curve.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "csv.h"
#include "memory.h"
#include "snapshot.h"

static double scale_or_1(double scale) { return scale == 0 ? 1 : scale; }

static int is_snapshot(const char *path)
{
  const char *dot = path ? strrchr(path, '.') : NULL;
  return dot && !strcmp(dot, ".hdf");
}

/* Leaves the points of the time nearest to `at`, the earlier one of two. */
static int keep_time(const sph_plot_curve *c, sph_csv_rows rows, sph_plot_points *p,
                     sph_error *error)
{
  double *time = NULL;
  long n = 0, kept = 0;
  char title[SPH_PLOT_TITLE];
  int status = sph_csv_read_rows(c->csv, rows, "time", 0, &time, &n, title, error);
  for (long i = 0; !status && i < n; i++)
    if (isfinite(time[i]) && !(fabs(time[i] - *c->at) >= fabs(p->time - *c->at))) p->time = time[i];
  for (long i = 0; !status && i < n && i < p->n; i++)
    if (time[i] == p->time) p->x[kept] = p->x[i], p->y[kept] = p->y[i], kept++;
  p->n = kept;
  sph_memory_free(time);
  return status;
}

static int read_table(const sph_plot_curve *c, sph_plot_points *p, sph_error *error)
{
  const sph_csv_rows rows = {c->where, c->is ? c->is : ""};
  long n = 0;
  int status = sph_csv_read_rows(c->csv, rows, c->x, 0, &p->x, &p->n, p->x_title, error);
  if (!status) status = sph_csv_read_rows(c->csv, rows, c->y, 1, &p->y, &n, p->y_title, error);
  if (n < p->n) p->n = n; /* of a table that grows */
  if (!status && c->at) status = keep_time(c, rows, p, error);
  return status;
}

/* A coordinate, or a field, of the fluids of a snapshot. */
static int read_field(const char *path, const char *name, double **values, long *n, double *time,
                      char title[SPH_PLOT_TITLE], sph_error *error)
{
  const char *letter = strlen(name) == 1 ? strchr("xyz", *name) : NULL;
  const int d = letter ? (int)(letter - "xyz") : -1;
  sph_snapshot s;
  int status = sph_snapshot_read(path, d < 0 ? name : sph_snapshot_read_default(path), &s, error);
  if (status) return status;
  *n = s.n[SPH_FLUIDS];
  *time = s.time;
  *values = SPH_NEW(double, *n + 1, "a profile", error);
  if (!*values) status = SPH_ERR_MEMORY;
  for (long i = 0; !status && i < *n; i++)
    (*values)[i] = d >= 0                ? s.x[SPH_FLUIDS][3 * i + d]
                   : s.value[SPH_FLUIDS] ? s.value[SPH_FLUIDS][i]
                                         : NAN;
  snprintf(title, SPH_PLOT_TITLE, d >= 0 || *s.unit ? "%.60s [%s]" : "%.60s", name,
           d >= 0 ? "m" : s.unit);
  sph_snapshot_read_free(&s);
  return status;
}

static int read_snapshot(const sph_plot_curve *c, sph_plot_points *p, sph_error *error)
{
  const char *x = c->x ? c->x : "x", *y = c->y ? c->y : sph_snapshot_read_default(c->csv);
  int status = read_field(c->csv, x, &p->x, &p->n, &p->time, p->x_title, error);
  return status ? status : read_field(c->csv, y, &p->y, &p->n, &p->time, p->y_title, error);
}

int sph_plot_curve_read(const sph_plot_curve *c, sph_plot_points *p, sph_error *error)
{
  const double x_scale = scale_or_1(c->x_scale), y_scale = scale_or_1(c->y_scale);
  *p = (sph_plot_points){.time = NAN};
  int status = is_snapshot(c->csv) ? read_snapshot(c, p, error) : read_table(c, p, error);
  if (!status && p->n == 0)
    status = sph_error_set(error, SPH_ERR_FILE, "%s: no rows to draw", c->csv);
  for (long i = 0; !status && i < p->n; i++) {
    const int drawn = isfinite(p->x[i]) && isfinite(p->y[i]);
    p->x[i] = drawn ? (p->x[i] - c->x_offset) / x_scale : NAN;
    p->y[i] = drawn ? p->y[i] / y_scale : NAN;
  }
  if (status) sph_plot_curve_free(p);
  return status;
}

void sph_plot_curve_free(sph_plot_points *p)
{
  sph_memory_free(p->x);
  sph_memory_free(p->y);
  p->x = p->y = NULL;
}

void sph_plot_curve_unit(const char *title, char unit[SPH_PLOT_TITLE])
{
  const char *open = strrchr(title, '[');
  snprintf(unit, SPH_PLOT_TITLE, "%.*s", open ? (int)strcspn(open + 1, "]") : 0,
           open ? open + 1 : "");
}
