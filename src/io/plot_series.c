/* plot_series.c -- columns of tables over each other: results as lines, references as points. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gnuplot.h"
#include "memory.h"
#include "plot_curve.h"

static const char *const colours[] = {"#31688e", "#d1495b", "#35b779", "#6b4c9a",
                                      "#e08e0b", "#482878", "#666666", "#1b9e77"};
enum { COLOURS = sizeof colours / sizeof *colours };
enum { MANY = 200 }; /* points that would hide each other */

enum { WIDTH = 1000, HEIGHT = 620, PANEL = 260, KEY = 34, BELOW = 62 }; /* pixels */

typedef struct picture {
  const sph_plot_def *def;
  const sph_plot_curve *curve;
  int n, panels;
  sph_plot_points *points;      /* [n] */
  int *panel;                   /* [n] of each curve: 0, 1, ... from above */
  char (*unit)[SPH_PLOT_TITLE]; /* [panels] */
  sph_text script, data;
  sph_error *error;
} picture;

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

static void add_head(picture *p)
{
  const sph_plot_def *def = p->def;
  sph_text_add(&p->script,
               "set grid lc rgb '#e4e4e4' lt 1\nset border 3\n"
               "set key %s horizontal Left reverse noenhanced %s\n",
               p->panels > 1 ? "at graph 0, 1.02 left bottom" : "outside bottom center",
               p->panels > 1 ? "samplen 2" : "spacing 1.3 height 2");
  if (def->title) {
    sph_text_add(&p->script, "set title ");
    sph_text_gnuplot_string(&p->script, def->title);
    sph_text_add(&p->script, " noenhanced\n");
  }
  add_label(&p->script, "x", def->x_label, p->points[0].x_title);
  if (def->log_x) add_log(&p->script, "x", def->x_min, def->x_max);
  if (def->log_y) add_log(&p->script, "y", def->y_min, def->y_max);
  add_range(&p->script, "x", def->x_min, def->x_max);
  add_range(&p->script, "y", def->y_min, def->y_max);
}

/* Its title where a panel, or a picture, has one column, else the unit. */
static void add_y_label(picture *p, int panel)
{
  const char *title = NULL;
  char unit[SPH_PLOT_TITLE + 8] = "";
  for (int k = 0; k < p->n; k++) {
    if (p->panel[k] != panel) continue;
    if (p->def->panels && title && strcmp(title, p->points[k].y_title) != 0 && !*unit)
      snprintf(unit, sizeof unit, *p->unit[panel] ? "[%s]" : " ", p->unit[panel]);
    if (!title) title = p->points[k].y_title;
  }
  add_label(&p->script, "y", p->def->y_label, *unit ? unit : title ? title : "");
}

/* In the key: the column, and its time where it is one. */
static void add_title(picture *p, int k)
{
  char text[SPH_PLOT_TITLE + 40];
  const sph_plot_points *points = &p->points[k];
  if (isfinite(points->time))
    snprintf(text, sizeof text, "%s, t = %.4g s", points->y_title, points->time);
  else
    snprintf(text, sizeof text, "%s", points->y_title);
  sph_text_add(&p->script, " title ");
  sph_text_gnuplot_string(&p->script, p->curve[k].label ? p->curve[k].label : text);
}

static void add_curve(picture *p, int k, int first)
{
  static const int shapes[] = {7, 5, 9, 13,
                               11}; /* gnuplot's filled circle, square, triangle, ... */
  const sph_plot_curve *c = &p->curve[k];
  const long rows = p->points[k].n;
  sph_text *script = &p->script;
  sph_text_add(script, "%s data index %d using 1:2 ", first ? "plot" : ", \\\n ", k);
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
  add_title(p, k);
}

static void add_panel(picture *p, int panel)
{
  int first = 1;
  add_y_label(p, panel);
  for (int k = 0; k < p->n; k++)
    if (p->panel[k] == panel) add_curve(p, k, first), first = 0;
  sph_text_add(&p->script, "\n");
}

static int height_of(const picture *p)
{
  return p->panels == 1 ? HEIGHT : p->panels * PANEL + BELOW + (p->def->title ? KEY : 0);
}

/* One axis of x for all of them, with numbers below the lowest. */
static void add_panels(picture *p)
{
  const double height = height_of(p);
  double lo = INFINITY, hi = -INFINITY;
  for (int k = 0; k < p->n; k++)
    for (long i = 0; i < p->points[k].n; i++)
      lo = fmin(lo, p->points[k].x[i]), hi = fmax(hi, p->points[k].x[i]);
  if (!(p->def->x_min < p->def->x_max)) add_range(&p->script, "x", lo, hi);
  sph_text_add(&p->script,
               "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.97\n");
  for (int j = 0; j < p->panels; j++) {
    const double below = BELOW + (p->panels - 1 - j) * PANEL;
    const int lowest = j == p->panels - 1;
    sph_text_add(&p->script, "\nset bmargin at screen %.5f; set tmargin at screen %.5f\n",
                 below / height, (below + PANEL - KEY) / height);
    if (lowest)
      add_label(&p->script, "x", p->def->x_label, p->points[0].x_title);
    else
      sph_text_add(&p->script, "set xlabel\n");
    if (!p->def->log_x) sph_text_add(&p->script, "set format x '%s'\n", lowest ? "%g" : "");
    add_panel(p, j);
    if (j == 0) sph_text_add(&p->script, "unset title\n");
  }
  sph_text_add(&p->script, "unset multiplot\n");
}

/* A panel for each unit, in the order of the curves. */
static void choose_panels(picture *p)
{
  char unit[SPH_PLOT_TITLE];
  for (int k = 0; k < p->n; k++) {
    int j = 0;
    sph_plot_curve_unit(p->points[k].y_title, unit);
    while (j < p->panels && p->def->panels && strcmp(unit, p->unit[j]) != 0) j++;
    if (!p->def->panels) j = 0;
    if (j == p->panels) memcpy(p->unit[p->panels++], unit, sizeof unit);
    p->panel[k] = j;
  }
}

static void add_data(picture *p)
{
  for (int k = 0; k < p->n; k++) {
    const sph_plot_points *points = &p->points[k];
    for (long i = 0; i < points->n; i++)
      if (isfinite(points->x[i]))
        sph_text_add(&p->data, "%.9g %.9g\n", points->x[i], points->y[i]);
      else
        sph_text_add(&p->data, "NaN NaN\n");
    sph_text_add(&p->data, "\n\n");
  }
}

static int draw(picture *p, const char *png)
{
  sph_gnuplot names;
  int status = sph_gnuplot_names(&names, png, p->error);
  if (status) return status;
  choose_panels(p);
  add_data(p);
  sph_gnuplot_begin(&names, &p->script, WIDTH, height_of(p));
  add_head(p);
  if (p->panels > 1)
    add_panels(p);
  else
    add_panel(p, 0);
  return sph_gnuplot_run(&names, &p->script, &p->data, p->error);
}

int sph_plot_series(const sph_plot_curve *curve, int n, const sph_plot_def *def, const char *png,
                    sph_error *error)
{
  static const sph_plot_def plain;
  sph_gnuplot names;
  if (!curve) return sph_error_set(error, SPH_ERR_ARGUMENT, "%d curves to draw at NULL", n);
  if (n < 1) return sph_error_set(error, SPH_ERR_ARGUMENT, "%d curves to draw: at least 1", n);
  int status = sph_gnuplot_names(&names, png, error), read = 0;
  if (status) return status;
  picture p = {.def = def ? def : &plain, .curve = curve, .n = n, .error = error};
  p.points = SPH_NEW(sph_plot_points, n, "a picture", error);
  p.panel = SPH_NEW(int, n, "a picture", error);
  p.unit = sph_memory_new((size_t)n, sizeof *p.unit, "a picture", error);
  if (!p.points || !p.panel || !p.unit) status = SPH_ERR_MEMORY;
  for (; read < n && !status; read += !status)
    status = sph_plot_curve_read(&curve[read], &p.points[read], error);
  if (!status) status = draw(&p, png);
  while (read > 0) sph_plot_curve_free(&p.points[--read]);
  sph_memory_free(p.points);
  sph_memory_free(p.panel);
  sph_memory_free(p.unit);
  return status;
}
