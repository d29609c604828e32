/* Pictures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog.h"

enum { COLUMNS = 8, CURVES = COLUMNS * PROG_FRAMES, COMPARISONS = 64 };

static int report(int status, const char *png, const sph_error *error)
{
  if (status == SPH_OK)
    printf("picture      %s\n", png);
  else
    sph_prog_error(PROG_FAILED, "no picture: %s", error->text);
  return status;
}

static int frames(const char *directory, const char *field, int n)
{
  char png[4096];
  sph_error error = {0};
  snprintf(png, sizeof png, "%s/frames.png", directory);
  return report(sph_plot_frames(directory, field, n, png, &error), png, &error);
}

void sph_prog_plot_case(const sph_case *c, const char *directory, int n)
{
  int status = frames(directory, sph_case_plot_field(c), sph_case_plot_frames(c));
  for (int k = 0; k < n && status != SPH_ERR_UNBUILT; k++) {
    char png[4096];
    sph_error error = {0};
    status = sph_case_compare_plot(c, k, directory, png, sizeof png, &error);
    if (status != SPH_ERR_ARGUMENT) report(status, png, &error); /* else: nothing to draw */
  }
}

sph_case *sph_prog_plot_of(const char *directory)
{
  char path[4096];
  sph_error none = {0};
  snprintf(path, sizeof path, "%s/case.yml", directory);
  return sph_case_read(path, 0, NULL, &none);
}

/* DIR/x.csv and DIR/x.png. */
static void name_table(const prog_options *o, char csv[4096], char png[4096])
{
  const char *table = o->table ? o->table : "series.csv", *end = strrchr(table, '.');
  snprintf(csv, 4096, "%s/%s", o->what, table);
  snprintf(png, 4096, "%s/%.*s.png", o->what, (int)(end ? end - table : (long)strlen(table)),
           table);
}

/* --at: "0.1,250ms" are 0.1 and 0.25 s; time[PROG_FRAMES], returns how many, or -1, told. */
static int take_times(const prog_options *o, double *time)
{
  const char *at = o->at;
  int n = 0;
  if (!at) return 0;
  do {
    char *end;
    at += *at == ',' && n > 0;
    const double t = strtod(at, &end);
    int right = end != at && t >= 0 && t < 1e30 && n < PROG_FRAMES;
    end += strspn(end, " ");
    const double unit = !strncmp(end, "ms", 2) ? 1e-3 : 1;
    end += unit < 1 ? 2 : *end == 's';
    if (*end && *end != ',') right = 0;
    if (!right)
      return sph_prog_error(-1, "--at %s: wanted 1 to %d times with commas between, as 0.1,250ms",
                            o->at, PROG_FRAMES);
    time[n++] = t * unit;
    at = end;
  } while (*at);
  return n;
}

/* A table of places in a plane. */
static int map(const prog_options *o, const double *time, int times)
{
  char csv[4096], png[4096];
  sph_error error = {0};
  name_table(o, csv, png);
  const int status = times ? sph_plot_plane_at(csv, o->field, time, times, png, &error)
                           : sph_plot_plane(csv, o->field, o->frames ? o->frames : 1, png, &error);
  return report(status, png, &error) ? PROG_FAILED : PROG_OK;
}

typedef struct curves {
  int n, columns;
  sph_plot_curve curve[CURVES];
  char words[1000], path[PROG_FRAMES][4096];
} curves;

/* --series: a curve for each column, and each of the times (csv: the same table for all of them, or
 * a snapshot for each). */
static int take_columns(const prog_options *o, const double *time, int times, const char *csv,
                        curves *c)
{
  char *rest = NULL;
  if ((size_t)snprintf(c->words, sizeof c->words, "%s", o->series) >= sizeof c->words)
    return sph_prog_error(PROG_USAGE, "plot: --series of more than %zu bytes", sizeof c->words - 1);
  for (char *word = strtok_r(c->words, ",", &rest); word; word = strtok_r(NULL, ",", &rest)) {
    if (c->columns++ == COLUMNS)
      return sph_prog_error(PROG_USAGE, "plot: --series of more than %d columns", COLUMNS);
    for (int k = 0; k < (times ? times : 1); k++)
      c->curve[c->n++] = (sph_plot_curve){.csv = csv ? csv : c->path[k],
                                          .x = o->over,
                                          .y = word,
                                          .at = csv && times ? &time[k] : NULL,
                                          .points = !csv       ? 1
                                                    : !o->over ? 0
                                                    : times    ? 2
                                                               : 1};
  }
  return PROG_OK;
}

static int draw_curves(const curves *c, const char *png)
{
  sph_error error = {0};
  const int status = sph_plot_series(c->curve, c->n, &(sph_plot_def){.panels = 1}, png, &error);
  return report(status, png, &error) ? PROG_FAILED : PROG_OK;
}

/* Columns of a table of the run over another one. */
static int draw_table(const prog_options *o, const double *time, int times, curves *c)
{
  char csv[4096], png[4096];
  if (!o->series)
    return sph_prog_error(PROG_USAGE, "plot: --table and --over want --series COLUMN,...%s",
                          o->table && !o->over ? ", or of a plane --field COLUMN" : "");
  if (times && !o->over)
    return sph_prog_error(PROG_USAGE, "plot: --at wants --over COLUMN where it is of a table");
  name_table(o, csv, png);
  const int status = take_columns(o, time, times, csv, c);
  return status ? status : draw_curves(c, png);
}

/* Fields of the particles over a coordinate, at the snapshots nearest to the times. */
static int draw_profiles(const prog_options *o, const double *time, int times, curves *c)
{
  long number[PROG_FRAMES];
  char png[4096];
  sph_error error = {0};
  int left = 0;
  const sph_left_out left_out = sph_prog_left_out(&left);
  if (sph_plot_nearest(o->what, time, times, number, &left_out, &error))
    return sph_prog_error(PROG_FAILED, "no picture: %s", error.text);
  for (int k = 0; k < times; k++)
    snprintf(c->path[k], sizeof c->path[k], "%s/snapshot_%04ld.hdf", o->what, number[k]);
  snprintf(png, sizeof png, "%s/profiles.png", o->what);
  int status = take_columns(o, time, times, NULL, c);
  if (!status) status = draw_curves(c, png);
  return sph_prog_left_out_end(left, sph_plot_count(o->what, NULL), status);
}

static int draw(const prog_options *o, const double *time, int times)
{
  curves *c = calloc(1, sizeof *c);
  if (!c) return sph_prog_error(PROG_FAILED, "plot: out of memory");
  const int status = times && o->series && !o->table ? draw_profiles(o, time, times, c)
                                                     : draw_table(o, time, times, c);
  free(c);
  return status;
}

/* Snapshots on a sheet. */
static int sheet(const prog_options *o, const sph_case *c, const double *time, int times, int *left)
{
  long number[PROG_FRAMES];
  char png[4096];
  sph_error error = {0};
  const int n = o->frames ? o->frames : c ? sph_case_plot_frames(c) : 4;
  sph_sheet_def def = {.directory = o->what,
                       .field = o->field ? o->field
                                : c      ? sph_case_plot_field(c)
                                         : NULL,
                       .n = times ? times : n,
                       .number = times ? number : NULL,
                       .left_out = sph_prog_left_out(left)};
  snprintf(png, sizeof png, "%s/frames.png", o->what);
  int status =
      times ? sph_plot_nearest(o->what, time, times, number, &def.left_out, &error) : SPH_OK;
  if (!status) status = sph_plot_sheet(&def, png, &error);
  return report(status, png, &error);
}

/* Again, from the tables that the run left; it may have been stopped before it compared. */
static void comparisons(const sph_case *c, const char *directory)
{
  for (int k = 0; k < COMPARISONS; k++) {
    char png[4096];
    if (!sph_case_compare_plot(c, k, directory, png, sizeof png, NULL))
      printf("picture      %s\n", png);
  }
}

int sph_prog_plot(const prog_options *o)
{
  double time[PROG_FRAMES];
  const int times = take_times(o, time);
  if (times < 0) return PROG_USAGE;
  if (o->table && o->field && !o->series && !o->over) return map(o, time, times);
  if (o->series || o->table || o->over) return draw(o, time, times);
  sph_case *c = sph_prog_plot_of(o->what);
  int left = 0;
  const int status = sheet(o, c, time, times, &left);
  if (c && status == SPH_OK && !times) comparisons(c, o->what);
  sph_case_free(c);
  return sph_prog_left_out_end(left, sph_plot_count(o->what, NULL),
                               status == SPH_OK ? PROG_OK : PROG_FAILED);
}
