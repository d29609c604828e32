/* plot_plane.c -- a table of places over time, as a probe writes it, as maps of a column. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "csv.h"
#include "memory.h"
#include "picture.h"
#include "sphode/output.h"

enum { FRAMES_MAX = 16, COLUMNS = 5, TIME = 3, VALUE = 4 }; /* behind x, y, z */

typedef struct plane {
  const char *csv, *column;
  double *of[COLUMNS]; /* [rows]; NULL: the table has no such direction */
  long rows, places;
  int across, up;
  double cell[2];
  char unit[64];
  sph_error *error;
} plane;

static int has_column(const plane *p, const char *name)
{
  char found[128];
  for (int k = 0; sph_csv_name(p->csv, k, found, NULL) > 0; k++)
    if (!strcmp(found, name)) return 1;
  return 0;
}

static int read_columns(plane *p)
{
  const char *const name[COLUMNS] = {"x", "y", "z", "time", p->column};
  char title[128] = "";
  int status = SPH_OK;
  for (int k = 0; k < COLUMNS && !status; k++) {
    long n = 0;
    if (k < TIME && !has_column(p, name[k])) continue;
    status = sph_csv_read(p->csv, name[k], 0, &p->of[k], &n, title, p->error);
    p->rows = n;
  }
  const char *open = status ? NULL : strchr(title, '[');
  if (open) snprintf(p->unit, sizeof p->unit, "%.*s", (int)strcspn(open + 1, "]"), open + 1);
  while (!status && p->places < p->rows && p->of[TIME][p->places] == p->of[TIME][0]) p->places++;
  if (status || (p->places > 0 && p->rows % p->places == 0)) return status;
  return sph_error_set(p->error, SPH_ERR_FILE,
                       "%s: %ld rows, %ld at the first time: not the same "
                       "places at each",
                       p->csv, p->rows, p->places);
}

static double extent(const plane *p, int d)
{
  double lo = INFINITY, hi = -INFINITY;
  for (long i = 0; p->of[d] && i < p->places; i++)
    lo = fmin(lo, p->of[d][i]), hi = fmax(hi, p->of[d][i]);
  return hi > lo ? hi - lo : 0;
}

/* The two directions in which its places differ most. */
static int choose_directions(plane *p)
{
  int least = 0;
  for (int d = 1; d < 3; d++)
    if (extent(p, d) <= extent(p, least)) least = d;
  p->across = least == 0 ? 1 : 0;
  p->up = least == 2 ? 1 : 2;
  if (p->of[p->across] && p->of[p->up] && extent(p, p->across) > 0 && extent(p, p->up) > 0)
    return SPH_OK;
  return sph_error_set(p->error, SPH_ERR_ARGUMENT,
                       "%s: its places lie on a line; curves draw it (sphode plot --table --series "
                       "--over)",
                       p->csv);
}

/* What a place stands for: steps along a row and to the next one. */
static void measure_cell(plane *p)
{
  const double *x[2] = {p->of[p->across], p->of[p->up]}; /* choose_directions found them */
  if (!x[0] || !x[1]) return;
  const double first[2] = {x[0][1] - x[0][0], x[1][1] - x[1][0]};
  long next = 2;
  while (next < p->places &&
         fabs((x[0][next] - x[0][0]) * first[1] - (x[1][next] - x[1][0]) * first[0]) <=
             1e-9 * (first[0] * first[0] + first[1] * first[1]) * (double)next)
    next++;
  for (int k = 0; k < 2; k++)
    p->cell[k] = fabs(first[k]) + (next < p->places ? fabs(x[k][next] - x[k][0]) : 0);
}

static int take_frame(const plane *p, long k, sph_snapshot *to)
{
  *to = (sph_snapshot){.dim = 2,
                       .time = p->of[TIME][k * p->places],
                       .spacing = fmax(p->cell[0], p->cell[1]),
                       .n = {p->places, 0}};
  snprintf(to->unit, sizeof to->unit, "%s", p->unit);
  double *x = to->x[SPH_FLUIDS] = SPH_NEW(double, 3 * p->places, "a plane", p->error);
  to->value[SPH_FLUIDS] = SPH_NEW(double, p->places, "a plane", p->error);
  if (!x || !to->value[SPH_FLUIDS]) return SPH_ERR_MEMORY;
  for (long i = 0; i < p->places; i++) {
    const long row = k * p->places + i;
    x[3 * i] = p->of[p->across][row];
    x[3 * i + 1] = p->of[p->up][row];
    to->value[SPH_FLUIDS][i] = p->of[VALUE][row];
  }
  return SPH_OK;
}

/* Which of the `count` times are drawn: those nearest to time[n], or evenly. */
static void choose_times(const plane *p, const double *time, int n, long *chosen)
{
  const long count = p->rows / p->places;
  for (int k = 0; k < n; k++) {
    chosen[k] = n == 1 ? count - 1 : (2 * k * (count - 1) + n - 1) / (2 * (n - 1));
    if (!time) continue;
    chosen[k] = 0;
    for (long j = 1; j < count; j++)
      if (fabs(p->of[TIME][j * p->places] - time[k]) <
          fabs(p->of[TIME][chosen[k] * p->places] - time[k]))
        chosen[k] = j;
  }
}

static int draw(const plane *p, const double *time, int n, const char *png)
{
  long chosen[FRAMES_MAX];
  sph_snapshot frame[FRAMES_MAX];
  sph_picture picture = {.field = p->column,
                         .width = 1200,
                         .height = 1500,
                         .cell = {p->cell[0], p->cell[1]},
                         .axis = {"xyz"[p->across], "xyz"[p->up]}};
  const long count = p->rows / p->places;
  int status = SPH_OK, taken = 0;
  if (n > count && !time) n = (int)count;
  choose_times(p, time, n, chosen);
  for (; taken < n && !status; taken++) status = take_frame(p, chosen[taken], &frame[taken]);
  if (!status) status = sph_picture_sheet(&picture, frame, n, png, p->error);
  while (taken > 0) sph_snapshot_read_free(&frame[--taken]);
  return status;
}

static int plot(const char *csv, const char *column, const double *time, int n, const char *png,
                sph_error *error)
{
  sph_error own = {0};
  plane p = {.csv = csv, .column = column, .error = error ? error : &own};
  if (!csv || !column)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a map of no %s (NULL)",
                         csv ? "column" : "table");
  if (n < 1 || n > FRAMES_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%d frames in a picture; 1 to %d are right", n,
                         FRAMES_MAX);
  int status = read_columns(&p);
  if (!status) status = choose_directions(&p);
  if (!status) measure_cell(&p);
  if (!status) status = draw(&p, time, n, png);
  for (int k = 0; k < COLUMNS; k++) sph_memory_free(p.of[k]);
  return status;
}

int sph_plot_plane(const char *csv, const char *column, int n, const char *png, sph_error *error)
{
  return plot(csv, column, NULL, n, png, error);
}

int sph_plot_plane_at(const char *csv, const char *column, const double *time, int n,
                      const char *png, sph_error *error)
{
  if (!time) return sph_error_set(error, SPH_ERR_ARGUMENT, "maps at %d times at NULL", n);
  return plot(csv, column, time, n, png, error);
}
