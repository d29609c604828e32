/* Pictures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog.h"

enum { CURVES = 8, COMPARISONS = 64 };

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

/* The case of a run; NULL: a run without one, and the defaults. */
static sph_case *case_of(const char *directory)
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

/* A table of places in a plane. */
static int map(const prog_options *o)
{
  char csv[4096], png[4096];
  sph_error error = {0};
  name_table(o, csv, png);
  const int status = sph_plot_plane(csv, o->field, o->frames ? o->frames : 1, png, &error);
  return report(status, png, &error) ? PROG_FAILED : PROG_OK;
}

/* Columns of a table of the run over another one. */
static int curves(const prog_options *o)
{
  char csv[4096], png[4096], columns[1000], *rest = NULL;
  sph_plot_curve curve[CURVES];
  sph_error error = {0};
  int n = 0;
  if (!o->series)
    return sph_prog_error(PROG_USAGE, "plot: --table and --over want --series COLUMN,...%s",
                          o->table && !o->over ? ", or of a plane --field COLUMN" : "");
  name_table(o, csv, png);
  if ((size_t)snprintf(columns, sizeof columns, "%s", o->series) >= sizeof columns)
    return sph_prog_error(PROG_USAGE, "plot: --series of more than %zu bytes", sizeof columns - 1);
  for (char *word = strtok_r(columns, ",", &rest); word; word = strtok_r(NULL, ",", &rest)) {
    if (n == CURVES)
      return sph_prog_error(PROG_USAGE, "plot: --series of more than %d columns", CURVES);
    curve[n++] = (sph_plot_curve){.csv = csv, .x = o->over, .y = word, .points = o->over != NULL};
  }
  int status =
      sph_plot_series(curve, n, &(sph_plot_def){.y_label = n > 1 ? "" : NULL}, png, &error);
  return report(status, png, &error) ? PROG_FAILED : PROG_OK;
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
  if (o->table && o->field && !o->series && !o->over) return map(o);
  if (o->series || o->table || o->over) return curves(o);
  sph_case *c = case_of(o->what);
  const char *field = o->field ? o->field : c ? sph_case_plot_field(c) : NULL;
  int status = frames(o->what, field, o->frames ? o->frames : c ? sph_case_plot_frames(c) : 4);
  if (c && status == SPH_OK) comparisons(c, o->what);
  sph_case_free(c);
  return status == SPH_OK ? PROG_OK : PROG_FAILED;
}

/* A word of the command line that is two numbers with a letter between them. */
static int two(const char *text, char between, double value[2])
{
  char *end;
  value[0] = strtod(text, &end);
  if (end == text || *end != between) return 0;
  const char *second = end + 1;
  value[1] = strtod(second, &end);
  return end != second && !*end;
}

static int take_options(const prog_options *o, sph_movie_def *def)
{
  double range[2] = {0}, size[2] = {0};
  if (o->range && (!two(o->range, ':', range) || !(range[0] < range[1])))
    return sph_prog_error(PROG_USAGE, "--range %s: wanted FROM:TO in SI units, as 0:2000",
                          o->range);
  if (o->size && (!two(o->size, 'x', size) || !(size[0] >= 1 && size[1] >= 1) ||
                  !(size[0] < 1e5 && size[1] < 1e5)))
    return sph_prog_error(PROG_USAGE, "--size %s: wanted WIDTHxHEIGHT in pixels, as 1280x720",
                          o->size);
  def->from = range[0], def->to = range[1];
  def->width = (int)size[0], def->height = (int)size[1];
  def->rate = o->rate;
  return PROG_OK;
}

int sph_prog_movie(const prog_options *o)
{
  char path[4096];
  sph_error error = {0};
  sph_movie_def def = {.directory = o->what, .path = o->output ? o->output : path};
  int status = take_options(o, &def);
  if (status) return status;
  snprintf(path, sizeof path, "%s/movie.mp4", o->what);
  sph_case *c = case_of(o->what);
  def.field = o->field ? o->field : c ? sph_case_plot_field(c) : NULL;
  int frames = sph_movie_write(&def, &error);
  sph_case_free(c);
  if (frames < 0) return sph_prog_error(PROG_FAILED, "no movie: %s", error.text);
  if (!o->quiet) printf("movie        %s (%d frames)\n", def.path, frames);
  return PROG_OK;
}
