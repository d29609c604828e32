/* plot.c -- particles coloured by a field, one or several frames, by gnuplot. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "file.h"
#include "frames.h"
#include "gnuplot.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode/output.h"

enum { FRAMES_MAX = 16 };

/* Pixels. */
static const double width_max = 1200, height_max = 1500;
static const double left = 80, right = 120, top = 45, bottom = 60, gap_x = 60, gap_y = 36;

typedef struct picture {
  const char *field;
  int n;
  sph_snapshot frame[FRAMES_MAX];
  int dim, across, up; /* the directions drawn */
  int slice;           /* the direction looked along in 3D, or -1 */
  double slice_at;     /* [m] */
  double lo[2], hi[2]; /* of what is drawn [m] */
  double from, to;     /* of the colours, SI */
  double unit;         /* SI value of the unit that is drawn: 1000 for kPa */
  double length;       /* and that of the axes: 0.001 for mm */
  const char *length_unit;
  char label[120];   /* "pressure [kPa]" */
  int columns, rows; /* of panels */
  double panel[2];   /* size of one [pixels] */
} picture;

static void bounds(const picture *p, int part, int d, double *lo, double *hi)
{
  *lo = INFINITY;
  *hi = -INFINITY;
  for (int k = 0; k < p->n; k++)
    for (long i = 0; i < p->frame[k].n[part]; i++) {
      *lo = fmin(*lo, p->frame[k].x[part][3 * i + d]);
      *hi = fmax(*hi, p->frame[k].x[part][3 * i + d]);
    }
}

/* Which directions: in 3D a slice across the thinner horizontal one, z up. */
static void choose_directions(picture *p)
{
  double lo[2], hi[2];
  p->dim = p->frame[0].dim;
  p->across = 0;
  p->up = p->dim - 1;
  p->slice = -1;
  if (p->dim < 3) return;
  for (int d = 0; d < 2; d++) bounds(p, SPH_FLUIDS, d, &lo[d], &hi[d]);
  p->slice = hi[1] - lo[1] <= hi[0] - lo[0] ? 1 : 0;
  p->slice_at = (lo[p->slice] + hi[p->slice]) / 2;
  p->across = 1 - p->slice;
}

/* What is drawn: the fluids with some wall around them; what leaked through walls is left out. */
static void choose_window(picture *p)
{
  double margin = 4 * p->frame[0].spacing;
  for (int k = 0; k < 2; k++) {
    double lo, hi, wall_lo, wall_hi;
    int d = k ? p->up : p->across;
    bounds(p, SPH_FLUIDS, d, &lo, &hi);
    bounds(p, SPH_WALLS, d, &wall_lo, &wall_hi);
    if (wall_lo < wall_hi) {
      lo = fmin(fmax(lo, wall_lo), wall_hi);
      hi = fmax(fmin(hi, wall_hi), wall_lo);
    }
    p->lo[k] = isfinite(lo) ? lo - margin : 0;
    p->hi[k] = isfinite(hi) ? hi + margin : 1;
  }
}

static int visible(const picture *p, const double *x)
{
  if (p->slice >= 0 && fabs(x[p->slice] - p->slice_at) > 0.75 * p->frame[0].spacing) return 0;
  if (x[p->across] < p->lo[0] || x[p->across] > p->hi[0]) return 0;
  return p->dim == 1 || (x[p->up] >= p->lo[1] && x[p->up] <= p->hi[1]);
}

static int rising(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The colours go over the values but for half a percent at either end: one splash must not bleach
 * the rest.  In 1D nothing is left out. */
static void choose_range(picture *p, double *value)
{
  long n = 0;
  double cut = p->dim == 1 ? 0 : 0.005;
  for (int k = 0; k < p->n; k++) {
    const sph_snapshot *s = &p->frame[k];
    for (long i = 0; s->value[SPH_FLUIDS] && i < s->n[SPH_FLUIDS]; i++)
      if (isfinite(s->value[SPH_FLUIDS][i]) && visible(p, s->x[SPH_FLUIDS] + 3 * i))
        value[n++] = s->value[SPH_FLUIDS][i];
  }
  qsort(value, (size_t)n, sizeof *value, rising);
  p->from = n ? value[(long)(cut * (double)(n - 1))] : 0;
  p->to = n ? value[(long)((1 - cut) * (double)(n - 1))] : 1;
  if (p->from > 0 && p->from < 0.3 * p->to) p->from = 0;
  double least = fmax(1e-12, 1e-4 * fmax(fabs(p->from), fabs(p->to))); /* a constant field */
  if (p->to - p->from < least) {
    p->from -= least;
    p->to += least;
  }
}

static void choose_label(picture *p)
{
  char name[64];
  const char *unit = p->frame[0].unit, *prefix = "";
  double largest = fmax(fabs(p->from), fabs(p->to));
  p->unit = 1;
  if (!strcmp(unit, "m/s") && largest < 1e-2) {
    p->unit = largest < 1e-5 ? 1e-6 : 1e-3;
    prefix = largest < 1e-5 ? "u" : "m";
  }
  if ((!strcmp(unit, "Pa") || !strcmp(unit, "J/kg")) && largest >= 1e3) {
    p->unit = largest >= 1e6 ? 1e6 : 1e3;
    prefix = largest >= 1e6 ? "M" : "k";
  }
  snprintf(name, sizeof name, "%s", p->field);
  for (char *c = name; *c; c++)
    if (*c == '_') *c = ' ';
  snprintf(p->label, sizeof p->label, *unit ? "%s [%s%s]" : "%s", name, prefix, unit);
}

/* Of the axes: no tic has more than a few digits. */
static void choose_length(picture *p)
{
  double far = 0;
  for (int k = 0; k < (p->dim == 1 ? 1 : 2); k++)
    far = fmax(far, fmax(fabs(p->lo[k]), fabs(p->hi[k])));
  p->length = far < 3e-5 ? 1e-6 : far < 3e-2 ? 1e-3 : 1;
  p->length_unit = far < 3e-5 ? "um" : far < 3e-2 ? "mm" : "m";
}

/* As many columns as bring the sheet nearest to 5 : 4; panels as large as the sheet allows. */
static void choose_layout(picture *p)
{
  double ratio = p->dim == 1 ? 0.4 : (p->hi[1] - p->lo[1]) / (p->hi[0] - p->lo[0]), best = INFINITY;
  for (int columns = 1; columns <= p->n; columns++) {
    int rows = (p->n + columns - 1) / columns;
    double off = fabs(log(columns / (rows * ratio) / 1.25));
    if (off >= best) continue;
    best = off;
    p->columns = columns;
    p->rows = rows;
  }
  double x = (width_max - left - right - (p->columns - 1) * gap_x) / p->columns;
  double y = (height_max - top - bottom - (p->rows - 1) * gap_y) / p->rows;
  p->panel[0] = floor(fmin(x, y / ratio));
  p->panel[1] = floor(fmin(y, x * ratio));
}

static void sheet(const picture *p, double size[2])
{
  double beside = p->dim == 1 ? 30 : right; /* 1D has no colour scale */
  size[0] = left + beside + p->columns * p->panel[0] + (p->columns - 1) * gap_x;
  size[1] = top + bottom + p->rows * p->panel[1] + (p->rows - 1) * gap_y;
}

/* Particles of one part as "x y value", a block for gnuplot's index; returns their number. */
static long add_block(const picture *p, int k, int part, sph_text *data)
{
  const sph_snapshot *s = &p->frame[k];
  long written = 0;
  for (long i = 0; i < s->n[part]; i++) {
    const double *x = s->x[part] + 3 * i;
    if (!visible(p, x)) continue;
    if (!written) sph_text_add(data, "# t = %.9g s, %s\n", s->time, part ? "walls" : "fluids");
    sph_text_add(data, "%.6g %.6g %.6g\n", x[p->across], p->dim == 1 ? 0 : x[p->up],
                 s->value[part] ? s->value[part][i] : 0);
    written++;
  }
  if (written) sph_text_add(data, "\n\n");
  return written;
}

/* Distance of the tics: 1, 2 or 5 times a power of ten, at least `pixels` apart. */
static double tics(double range, double length, double pixels)
{
  double least = range * pixels / length, power = pow(10, floor(log10(least)));
  double mantissa = least / power;
  return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

static const char palette[] =
    "set palette defined (0 '#440154', 1 '#482878', 2 '#3e4989', 3 '#31688e', 4 '#26828e', "
    "5 '#1f9e89', 6 '#35b779', 7 '#6ece58', 8 '#b5de2b', 9 '#fde725') # viridis\n";

/* gnuplot draws a particle true to scale: squares where they are a few pixels, which is three times
 * as fast and leaves no gaps, else discs. */
static int squares(const picture *p)
{
  return p->panel[0] / (p->hi[0] - p->lo[0]) * p->frame[0].spacing < 5;
}

static void add_head(const picture *p, sph_text *script)
{
  double size[2];
  sheet(p, size);
  double span = size[1] - bottom - top;
  sph_text_add(script, "length = %g # of the axes [m]\nradius = %.6g/length # of a particle\n",
               p->length, (squares(p) ? 0.68 : 0.55) * p->frame[0].spacing);
  sph_text_add(script, "unit = %g\n\n%s", p->unit, palette);
  sph_text_add(script, "set cbrange [%.9g:%.9g]\nset cblabel ", p->from / p->unit, p->to / p->unit);
  sph_text_gnuplot_string(script, p->label);
  sph_text_add(script, " offset 1.2, 0\nset cbtics %.6g",
               tics((p->to - p->from) / p->unit, span, 70));
  sph_text_add(script, "\nset colorbox vertical user origin screen %.4f, %.4f size %.4f, %.4f\n",
               1 - (right - 22) / size[0], bottom / size[1], 16 / size[0], span / size[1]);
  sph_text_add(script, "set xrange [%.6g:%.6g]\n", p->lo[0] / p->length, p->hi[0] / p->length);
  if (p->dim == 1) {
    double more = 0.05 * (p->to - p->from);
    sph_text_add(script, "unset colorbox\nset grid lc rgb '#dddddd'\nset yrange [%.9g:%.9g]\n",
                 (p->from - more) / p->unit, (p->to + more) / p->unit);
  } else {
    sph_text_add(script, "set yrange [%.6g:%.6g]\n", p->lo[1] / p->length, p->hi[1] / p->length);
  }
  sph_text_add(script, "set multiplot\n");
}

static void add_axes(const picture *p, int k, sph_text *script)
{
  double size[2], panel_x = p->panel[0], panel_y = p->panel[1];
  int column = k % p->columns, row = k / p->columns, lowest = k + p->columns >= p->n;
  sheet(p, size);
  double x = left + column * (panel_x + gap_x);
  double y = bottom + (p->rows - 1 - row) * (panel_y + gap_y);
  sph_text_add(script, "\nset lmargin at screen %.5f; set rmargin at screen %.5f\n", x / size[0],
               (x + panel_x) / size[0]);
  sph_text_add(script, "set bmargin at screen %.5f; set tmargin at screen %.5f\n", y / size[1],
               (y + panel_y) / size[1]);
  sph_text_add(script, "set label 1 't = %.4g s' at graph 0, 1 offset 0, 0.8 left\n",
               p->frame[k].time);
  sph_text_add(script, "set xtics %.6g format '%s'; set xlabel '",
               tics((p->hi[0] - p->lo[0]) / p->length, panel_x, 70), lowest ? "%g" : "");
  if (lowest) sph_text_add(script, "%c [%s]", "xyz"[p->across], p -> length_unit);
  sph_text_add(script, "'\nset format y '%s'; set ylabel ", column ? "" : "%g");
  if (p->dim == 1) {
    sph_text_gnuplot_string(script, column ? "" : p->label);
    sph_text_add(script, "\n");
  } else {
    sph_text_add(script, column ? "''" : "'%c [%s]'", "xyz"[p->up], p -> length_unit);
    sph_text_add(script, "; set ytics %.6g\n",
                 tics((p->hi[1] - p->lo[1]) / p->length, panel_y, 28));
  }
}

static void add_panel(const picture *p, int k, int *index, sph_text *script, sph_text *data)
{
  const char *separator = "plot", *shape = squares(p) ? "boxxyerror" : "circles";
  const char *radii = squares(p) ? "(radius):(radius)" : "(radius)";
  add_axes(p, k, script);
  if (k == 1) sph_text_add(script, "unset colorbox\n");
  if (p->dim > 1 && add_block(p, k, SPH_WALLS, data) > 0) {
    sph_text_add(
        script,
        "plot data index %d using ($1/length):($2/length):%s with %s lc rgb '#b4b4b4' fs solid "
        "noborder notitle",
        (*index)++, radii, shape);
    separator = ", \\\n ";
  }
  if (add_block(p, k, SPH_FLUIDS, data) == 0)
    sph_text_add(script, separator[0] == 'p' ? "plot NaN notitle\n" : "\n");
  else if (p->dim == 1)
    sph_text_add(
        script,
        "%s data index %d using ($1/length):($3/unit) with points pt 7 ps 0.5 lc rgb '#26828e' "
        "notitle\n",
        separator, (*index)++);
  else
    sph_text_add(script,
                 "%s data index %d using ($1/length):($2/length):%s:($3/unit) with %s lc palette "
                 "fs solid noborder "
                 "notitle\n",
                 separator, (*index)++, radii, shape);
}

static int choose(picture *p, sph_error *error)
{
  size_t values = 0;
  for (int k = 0; k < p->n; k++) {
    values += (size_t)p->frame[k].n[SPH_FLUIDS];
    if (p->frame[k].dim != p->frame[0].dim)
      return sph_error_set(error, SPH_ERR_FILE, "snapshots of %dD and %dD in one picture",
                           p->frame[0].dim, p->frame[k].dim);
  }
  double *value = SPH_NEW(double, values, "a picture", error);
  if (!value) return SPH_ERR_MEMORY;
  choose_directions(p);
  choose_window(p);
  choose_range(p, value);
  choose_label(p);
  choose_length(p);
  choose_layout(p);
  sph_memory_free(value);
  return SPH_OK;
}

static int draw(picture *p, const char *png, sph_error *error)
{
  sph_gnuplot names;
  sph_text script = {0}, data = {0};
  double size[2];
  int index = 0, status = sph_gnuplot_names(&names, png, error);
  if (status == SPH_OK) status = choose(p, error);
  if (status != SPH_OK) return status;
  sheet(p, size);
  sph_gnuplot_begin(&names, &script, (int)size[0], (int)size[1]);
  sph_text_add(&data, "# x [m], y [m], %s in SI units\n", p->field);
  add_head(p, &script);
  for (int k = 0; k < p->n; k++) add_panel(p, k, &index, &script, &data);
  sph_text_add(&script, "unset multiplot\n");
  return sph_gnuplot_run(&names, &script, &data, error);
}

/* Draws the snapshots of these numbers (of `directory`), or the one file `path` if given. */
static int draw_files(const char *path, const char *directory, const long *number, int n,
                      const char *field, const char *png, sph_error *error)
{
  char name[SPH_PATH];
  int status = SPH_OK;
  picture *p = SPH_NEW(picture, 1, "a picture", error);
  if (!p) return SPH_ERR_MEMORY;
  p->field = field ? field : "velocity";
  for (int k = 0; status == SPH_OK && k < n; k++) {
    if (!path) status = sph_frames_path(name, directory, number[k], error);
    if (status == SPH_OK)
      status = sph_snapshot_read(path ? path : name, p->field, &p->frame[k], error);
    if (status == SPH_OK) p->n++;
  }
  if (status == SPH_OK) status = draw(p, png, error);
  for (int k = 0; k < p->n; k++) sph_snapshot_read_free(&p->frame[k]);
  sph_memory_free(p);
  return status;
}

int sph_plot_frames(const char *directory, const char *field, int n, const char *png,
                    sph_error *error)
{
  long *number = NULL, chosen[FRAMES_MAX];
  if (n < 1 || n > FRAMES_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%d frames in a picture; 1 to %d are right", n,
                         FRAMES_MAX);
  int count = sph_frames_list(directory, &number, error), status = count;
  if (count == 0) status = sph_error_set(error, SPH_ERR_FILE, "%s holds no snapshots", directory);
  if (n > count) n = count;
  for (int k = 0; k < n; k++)
    chosen[k] = number[n == 1 ? count - 1 : (2 * k * (count - 1) + n - 1) / (2 * (n - 1))];
  if (status > 0) status = draw_files(NULL, directory, chosen, n, field, png, error);
  sph_memory_free(number);
  return status;
}

int sph_plot_particles(const char *path, const char *field, const char *png, sph_error *error)
{
  struct stat info;
  if (!path) return sph_error_set(error, SPH_ERR_ARGUMENT, "a picture of no path (NULL)");
  if (stat(path, &info) != 0)
    return sph_error_set(error, SPH_ERR_FILE, "%s: no such file or directory", path);
  if (S_ISDIR(info.st_mode)) return sph_plot_frames(path, field, 1, png, error);
  return draw_files(path, NULL, NULL, 1, field, png, error);
}

int sph_plot_count(const char *directory, sph_error *error)
{
  long *number = NULL;
  int count = sph_frames_list(directory, &number, error);
  sph_memory_free(number);
  return count;
}
