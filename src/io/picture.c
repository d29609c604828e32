#include "picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gnuplot.h"
#include "memory.h"

static const double half_slice = 0.75; /* of its thickness in 3D, in spacings */
enum { SAMPLES = 2000000 };            /* of values, for the range of colours */

/* Pixels. */
static const double left = 80, right = 145, top = 45, bottom = 60, gap_x = 60, gap_y = 36;

void sph_picture_bound(sph_picture *p, const sph_snapshot *frame)
{
  if (!p->dim) {
    p->dim = frame->dim;
    p->spacing = frame->spacing;
    snprintf(p->field_unit, sizeof p->field_unit, "%s", frame->unit);
    for (int part = 0; part < SPH_PARTS; part++)
      for (int d = 0; d < 3; d++) p->box_lo[part][d] = INFINITY, p->box_hi[part][d] = -INFINITY;
  }
  p->particles += frame->n[SPH_FLUIDS];
  p->frames++;
  for (int part = 0; part < SPH_PARTS; part++)
    for (long i = 0; i < 3 * frame->n[part]; i++) {
      p->box_lo[part][i % 3] = fmin(p->box_lo[part][i % 3], frame->x[part][i]);
      p->box_hi[part][i % 3] = fmax(p->box_hi[part][i % 3], frame->x[part][i]);
    }
}

/* Which directions: in 3D a slice across the thinner horizontal one, z up. */
static void choose_directions(sph_picture *p)
{
  const double *lo = p->box_lo[SPH_FLUIDS], *hi = p->box_hi[SPH_FLUIDS];
  p->across = 0;
  p->up = p->dim - 1;
  p->slice = -1;
  if (p->dim < 3) return;
  p->slice = hi[1] - lo[1] <= hi[0] - lo[0] ? 1 : 0;
  p->slice_at = (lo[p->slice] + hi[p->slice]) / 2;
  p->across = 1 - p->slice;
}

/* What is drawn: the fluids with some wall around them; what leaked through walls is left out. */
void sph_picture_view(sph_picture *p)
{
  choose_directions(p);
  for (int k = 0; k < 2; k++) {
    const double margin = p->cell[k] > 0 ? p->cell[k] / 2 : 4 * p->spacing;
    const int d = k ? p->up : p->across;
    const double wall_lo = p->box_lo[SPH_WALLS][d], wall_hi = p->box_hi[SPH_WALLS][d];
    double lo = p->box_lo[SPH_FLUIDS][d], hi = p->box_hi[SPH_FLUIDS][d];
    if (wall_lo < wall_hi) {
      lo = fmin(fmax(lo, wall_lo), wall_hi);
      hi = fmax(fmin(hi, wall_hi), wall_lo);
    }
    p->lo[k] = isfinite(lo) ? lo - margin : 0;
    p->hi[k] = isfinite(hi) ? hi + margin : 1;
  }
}

static int visible(const sph_picture *p, const double *x)
{
  if (p->slice >= 0 && fabs(x[p->slice] - p->slice_at) > half_slice * p->spacing) return 0;
  if (x[p->across] < p->lo[0] || x[p->across] > p->hi[0]) return 0;
  return p->dim == 1 || (x[p->up] >= p->lo[1] && x[p->up] <= p->hi[1]);
}

static int rising(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

int sph_picture_take(sph_picture *p, const sph_snapshot *frame, sph_error *error)
{
  const double *v = frame->value[SPH_FLUIDS], *x = frame->x[SPH_FLUIDS];
  const long stride = 1 + p->particles / SAMPLES;
  if (!p->value) {
    p->value = SPH_NEW(double, p->particles / stride + p->frames, "a picture", error);
    if (!p->value) return SPH_ERR_MEMORY;
  }
  for (long i = 0; v && i < frame->n[SPH_FLUIDS]; i += stride)
    if (isfinite(v[i]) && visible(p, x + 3 * i)) p->value[p->values++] = v[i];
  return SPH_OK;
}

void sph_picture_range(sph_picture *p)
{
  const double cut = p->dim == 1 ? 0 : 0.005, last = (double)(p->values - 1);
  p->from = 0, p->to = 1;
  if (p->values > 0) {
    qsort(p->value, (size_t)p->values, sizeof *p->value, rising);
    p->from = p->value[(long)(cut * last)];
    p->to = p->value[(long)((1 - cut) * last)];
  }
  sph_memory_free(p->value);
  p->value = NULL;
  if (p->from > 0 && p->from < 0.3 * p->to) p->from = 0;
  double least = fmax(1e-12, 1e-4 * fmax(fabs(p->from), fabs(p->to))); /* a constant field */
  if (p->to - p->from < least) {
    p->from -= least;
    p->to += least;
  }
}

static void choose_label(sph_picture *p)
{
  char name[64];
  const char *unit = p->field_unit, *prefix = "";
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
static void choose_length(sph_picture *p)
{
  double far = 0;
  for (int k = 0; k < (p->dim == 1 ? 1 : 2); k++)
    far = fmax(far, fmax(fabs(p->lo[k]), fabs(p->hi[k])));
  p->length = far < 3e-5 ? 1e-6 : far < 3e-2 ? 1e-3 : 1;
  p->length_unit = far < 3e-5 ? "um" : far < 3e-2 ? "mm" : "m";
}

/* As many columns as bring the sheet nearest to 5 : 4; panels as large as the sheet allows. */
static void choose_layout(sph_picture *p)
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
  double x = (p->width - left - right - (p->columns - 1) * gap_x) / p->columns;
  double y = (p->height - top - bottom - (p->rows - 1) * gap_y) / p->rows;
  p->panel[0] = floor(fmin(x, y / ratio));
  p->panel[1] = floor(fmin(y, x * ratio));
}

static void sheet(const sph_picture *p, double size[2])
{
  double beside = p->dim == 1 ? 30 : right; /* 1D has no colour scale */
  size[0] = left + beside + p->columns * p->panel[0] + (p->columns - 1) * gap_x;
  size[1] = top + bottom + p->rows * p->panel[1] + (p->rows - 1) * gap_y;
}

/* Particles of one part as "x y value", a block for gnuplot's index; returns their number. */
static long add_block(const sph_picture *p, const sph_snapshot *s, int part, sph_text *data)
{
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
static int squares(const sph_picture *p)
{
  if (p->cell[0] > 0) return 1;
  return p->panel[0] / (p->hi[0] - p->lo[0]) * p->spacing < 5;
}

/* Halves of what a particle or a place fills. */
static const char *radii_of(const sph_picture *p)
{
  return p->cell[0] > 0 ? "(cell_x):(cell_y)" : squares(p) ? "(radius):(radius)" : "(radius)";
}

/* Of the axis across (0) or up (1). */
static char letter(const sph_picture *p, int k)
{
  return p->axis[k] ? p->axis[k] : "xyz"[k ? p->up : p->across];
}

static void add_head(const sph_picture *p, sph_text *script)
{
  double size[2];
  sheet(p, size);
  double span = size[1] - bottom - top;
  sph_text_add(script, "length = %g # of the axes [m]\nradius = %.6g/length # of a particle\n",
               p->length, (squares(p) ? 0.68 : 0.55) * p->spacing);
  if (p->cell[0] > 0)
    sph_text_add(script, "cell_x = %.6g/length\ncell_y = %.6g/length # half of a cell, and more\n",
                 0.52 * p->cell[0], 0.52 * p->cell[1]); /* no gaps */
  sph_text_add(script, "unit = %g\n\n%s", p->unit, palette);
  sph_text_add(script, "set cbrange [%.9g:%.9g]\nset cblabel ", p->from / p->unit, p->to / p->unit);
  sph_text_gnuplot_string(script, p->label);
  sph_text_add(script, " offset 1.2, 0\nset cbtics %.6g",
               tics((p->to - p->from) / p->unit, span, span < 300 ? 35 : 70));
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

static void add_axes(const sph_picture *p, int k, double time, sph_text *script)
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
  char text[64];
  if (p->decimals)
    snprintf(text, sizeof text, "%.*f", p->decimals, time);
  else
    snprintf(text, sizeof text, "%.4g", time);
  sph_text_add(script, "set label 1 't = %s s", text);
  if (p->slice >= 0)
    sph_text_add(script, ", slice %c = %.3g m, %.2g m thick", "xyz"[p->slice], p -> slice_at,
                 2 * half_slice * p -> spacing);
  sph_text_add(script, "' at graph 0, 1 offset 0, 0.8 left\n");
  sph_text_add(script, "set xtics %.6g format '%s'; set xlabel '",
               tics((p->hi[0] - p->lo[0]) / p->length, panel_x, 70), lowest ? "%g" : "");
  if (lowest) sph_text_add(script, "%c [%s]", letter(p, 0), p->length_unit);
  sph_text_add(script, "'\nset format y '%s'; set ylabel ", column ? "" : "%g");
  if (p->dim == 1) {
    sph_text_gnuplot_string(script, column ? "" : p->label);
    sph_text_add(script, "\n");
  } else {
    sph_text_add(script, column ? "''" : "'%c [%s]'", letter(p, 1), p->length_unit);
    sph_text_add(script, "; set ytics %.6g\n",
                 tics((p->hi[1] - p->lo[1]) / p->length, panel_y, panel_y < 300 ? 28 : 50));
  }
}

static void add_panel(const sph_picture *p, const sph_snapshot *frame, int k, int *index,
                      sph_text *script, sph_text *data)
{
  const char *separator = "plot", *shape = squares(p) ? "boxxyerror" : "circles";
  const char *radii = radii_of(p);
  add_axes(p, k, frame->time, script);
  if (k == 1) sph_text_add(script, "unset colorbox\n");
  if (p->dim > 1 && add_block(p, frame, SPH_WALLS, data) > 0) {
    sph_text_add(
        script,
        "plot data index %d using ($1/length):($2/length):%s with %s lc rgb '#b4b4b4' fs solid "
        "noborder notitle",
        (*index)++, radii, shape);
    separator = ", \\\n ";
  }
  if (add_block(p, frame, SPH_FLUIDS, data) == 0)
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

int sph_picture_draw(sph_picture *p, const sph_snapshot *frame, int n, const char *png,
                     sph_error *error)
{
  sph_gnuplot names;
  sph_text script = {0}, data = {0};
  double size[2];
  int index = 0, status = sph_gnuplot_names(&names, png, error);
  if (status) return status;
  p->n = n;
  choose_label(p);
  choose_length(p);
  choose_layout(p);
  sheet(p, size);
  sph_gnuplot_begin(&names, &script, (int)size[0], (int)size[1]);
  sph_text_add(&data, "# x [m], y [m], %s in SI units\n", p->field);
  add_head(p, &script);
  for (int k = 0; k < n; k++) add_panel(p, &frame[k], k, &index, &script, &data);
  sph_text_add(&script, "unset multiplot\n");
  return sph_gnuplot_run(&names, &script, &data, error);
}

int sph_picture_sheet(sph_picture *p, const sph_snapshot *frame, int n, const char *png,
                      sph_error *error)
{
  for (int k = 0; k < n; k++) {
    if (frame[k].dim != frame[0].dim)
      return sph_error_set(error, SPH_ERR_FILE, "snapshots of %dD and %dD in one picture",
                           frame[0].dim, frame[k].dim);
    sph_picture_bound(p, &frame[k]);
  }
  sph_picture_view(p);
  int status = SPH_OK;
  for (int k = 0; k < n && !status; k++) status = sph_picture_take(p, &frame[k], error);
  sph_picture_range(p);
  return status ? status : sph_picture_draw(p, frame, n, png, error);
}
