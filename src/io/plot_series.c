/* plot_series.c -- columns of tables over each other: results as lines, references as points. */
#include <math.h>
#include <stdio.h>

#include "csv.h"
#include "gnuplot.h"
#include "memory.h"
#include "sphode/output.h"

static const char *const colours[] = {"#31688e", "#d1495b", "#35b779", "#6b4c9a",
                                      "#e08e0b", "#482878", "#666666", "#1b9e77"};
enum { COLOURS = sizeof colours / sizeof *colours };
enum { MANY = 200 }; /* points that would hide each other */

static double scale_or_1(double scale) { return scale == 0 ? 1 : scale; }

/* Adds the curve as a block of data, *rows long; its titles are those of the columns. */
static int add_curve(const sph_plot_curve *c, sph_text *data, long *rows, char x_title[128],
                     char y_title[128], sph_error *error)
{
  double *x = NULL, *y = NULL, x_scale = scale_or_1(c->x_scale), y_scale = scale_or_1(c->y_scale);
  long n = 0, n_y = 0;
  sph_csv_rows which = {c->where, c->is ? c->is : ""};
  int status = sph_csv_read_rows(c->csv, which, c->x, 0, &x, &n, x_title, error);
  if (status == SPH_OK)
    status = sph_csv_read_rows(c->csv, which, c->y, 1, &y, &n_y, y_title, error);
  if (status == SPH_OK && n == 0)
    status = sph_error_set(error, SPH_ERR_FILE, "%s: no rows to draw", c->csv);
  for (long i = 0; status == SPH_OK && i < n && i < n_y; i++)
    if (isfinite(x[i]) && isfinite(y[i]))
      sph_text_add(data, "%.9g %.9g\n", (x[i] - c->x_offset) / x_scale, y[i] / y_scale);
    else
      sph_text_add(data, "NaN NaN\n");
  sph_text_add(data, "\n\n");
  *rows = n;
  sph_memory_free(x);
  sph_memory_free(y);
  return status;
}

static void add_label(sph_text *script, const char *axis, const char *given, const char *title)
{
  sph_text_add(script, "set %slabel ", axis);
  sph_text_gnuplot_string(script, given ? given : title);
  sph_text_add(script, *axis == 'x' ? " noenhanced offset 0, 0.4\n" : " noenhanced\n");
}

static void add_range(sph_text *script, const char *axis, double lo, double hi)
{
  if (lo < hi) sph_text_add(script, "set %srange [%.9g:%.9g]\n", axis, lo, hi);
}

/* A logarithmic axis: powers of ten, over less than two of them 1, 2, 5, 10, 20, ..., with small
 * tics at 3, 4, 6, ... */
static void add_log(sph_text *script, const char *axis, double lo, double hi)
{
  static const int small[] = {3, 4, 6, 7, 8, 9};
  sph_text_add(script, "set logscale %s\n", axis);
  if (!(lo > 0 && hi > lo && hi < 100 * lo)) {
    sph_text_add(script, "set format %s '10^{%%T}'\nset m%stics 10\n", axis, axis);
    return;
  }
  sph_text_add(script, "set format %s '%%g'\nset %stics (", axis, axis);
  double power = pow(10, floor(log10(lo)));
  while (power <= hi) {
    sph_text_add(script, "%.9g, %.9g, %.9g, ", power, 2 * power, 5 * power);
    for (size_t k = 0; k < sizeof small / sizeof *small; k++)
      sph_text_add(script, "'' %.9g 1, ", small[k] * power);
    power *= 10;
  }
  sph_text_add(script, "%.9g)\n", power);
}

static void add_head(const sph_plot_def *def, const char *x_title, const char *y_title,
                     sph_text *script)
{
  sph_text_add(
      script,
      "set grid lc rgb '#e4e4e4' lt 1\nset border 3\n"
      "set key outside bottom center horizontal Left reverse noenhanced spacing 1.3 height 2\n");
  if (def->title) {
    sph_text_add(script, "set title ");
    sph_text_gnuplot_string(script, def->title);
    sph_text_add(script, " noenhanced\n");
  }
  add_label(script, "x", def->x_label, x_title);
  add_label(script, "y", def->y_label, y_title);
  if (def->log_x) add_log(script, "x", def->x_min, def->x_max);
  if (def->log_y) add_log(script, "y", def->y_min, def->y_max);
  add_range(script, "x", def->x_min, def->x_max);
  add_range(script, "y", def->y_min, def->y_max);
}

static void add_plot(const sph_plot_curve *c, int k, long rows, const char *title, sph_text *script)
{
  static const int shapes[] = {7, 5, 9, 13,
                               11}; /* gnuplot's filled circle, square, triangle, ... */
  sph_text_add(script, "%s data index %d using 1:2 ", k ? ", \\\n " : "plot", k);
  const char *colour = colours[(c->colour > 0 ? c->colour - 1 : k) % COLOURS];
  if (c->points)
    sph_text_add(script, "with %s pt %d ps %s lc rgb '%s'",
                 c->points == 2 ? "linespoints lw 1.6" : "points", shapes[k % 5],
                 rows > MANY ? "0.4" : "1.0", colour);
  if (c->points == 1 && rows > MANY) /* of a size that one can tell in the key */
    sph_text_add(script, " notitle, \\\n NaN with points pt %d ps 1.0 lc rgb '%s'", shapes[k % 5],
                 colour);
  if (!c->points)
    sph_text_add(script, "with lines lw %s lc rgb '%s'", rows > MANY ? "1.5" : "2.2", colour);
  sph_text_add(script, " title ");
  sph_text_gnuplot_string(script, c->label ? c->label : title);
}

int sph_plot_series(const sph_plot_curve *curve, int n, const sph_plot_def *def, const char *png,
                    sph_error *error)
{
  static const sph_plot_def plain;
  sph_gnuplot names;
  sph_text script = {0}, data = {0}, curves = {0};
  char x_first[128] = "", y_first[128] = "", x_title[128], y_title[128];
  if (!curve) return sph_error_set(error, SPH_ERR_ARGUMENT, "%d curves to draw at NULL", n);
  if (n < 1) return sph_error_set(error, SPH_ERR_ARGUMENT, "%d curves to draw: at least 1", n);
  int status = sph_gnuplot_names(&names, png, error);
  for (int k = 0; status == SPH_OK && k < n; k++) {
    long rows = 0;
    status =
        add_curve(&curve[k], &data, &rows, k ? x_title : x_first, k ? y_title : y_first, error);
    add_plot(&curve[k], k, rows, k ? y_title : y_first, &curves);
  }
  if (status == SPH_OK) status = sph_error_set(error, curves.error.status, "%s", curves.error.text);
  if (status == SPH_OK) {
    sph_gnuplot_begin(&names, &script, 1000, 620);
    add_head(def ? def : &plain, x_first, y_first, &script);
    sph_text_add(&script, "%s\n", curves.data ? curves.data : "");
    status = sph_gnuplot_run(&names, &script, &data, error);
  }
  sph_text_free(&curves);
  sph_text_free(&data);
  sph_text_free(&script);
  return status;
}
