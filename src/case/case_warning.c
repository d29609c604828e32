/* Keys that do nothing without their partner, events that never happen, periods longer than the run
 * or far shorter, pressures that nothing holds, degrees that are radians: right, but hardly what
 * was meant. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_path.h"
#include "case_solution.h"
#include "case_warning.h"
#include "csv.h"
#include "memory.h"
#include "sphode/case.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

typedef sph_case_finder finder;
#define warn sph_case_warning_found

void sph_case_warning_found(sph_case_finder *f, const sph_case_node *node, const char *format, ...)
{
  char what[300];
  va_list arguments;
  if (f->found++ != f->wanted) return;
  va_start(arguments, format);
  vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  if (node->key_line > 0)
    snprintf(f->text, f->size, "%s:%d: %s: %s", node->file ? node->file : f->c->path,
             node->key_line, node->key, what);
  else
    snprintf(f->text, f->size, "%s: %s", node->key, what);
}

/* A key that the user gave, not its default. */
static const sph_case_node *given(const sph_case_node *map, const char *key)
{
  const sph_case_node *node = child_of(map, key);
  return node && !(node->origin && !strcmp(node->origin, "default")) ? node : NULL;
}

static void without(finder *f, const sph_case_node *map, const char *key, int partner,
                    const char *what)
{
  const sph_case_node *node = given(map, key);
  if (node && !partner) warn(f, node, "does nothing without %s", what);
}

static void look_at_terms(finder *f, const sph_case_node *terms)
{
  for (const sph_case_node *term = terms->first; term; term = term->next) {
    const char *which = get_text(term, "switch", "none");
    without(f, term, "alpha_min", strstr(which, "morris") || strstr(which, "cullen"),
            "a switch that varies alpha (morris-monaghan, cullen-dehnen)");
    without(f, term, "exponent", !strcmp(get_text(term, "form", "phi"), "phi"), "form: phi");
    without(f, term, "crowding", !strcmp(get_text(term, "form", "delta-plus"), "delta-plus"),
            "form: delta-plus");
  }
}

/* What terms make of viscosities, conductivities, temperatures, the simulation tells itself. */
static void look_at_group(finder *f, const sph_case_node *group, const sph_case_node *terms)
{
  const int conduction = child_of(terms, "conduction") != NULL;
  const sph_case_node *boundary = child_of(group, "boundary");
  without(f, group, "seed", get_number(group, "jitter", 0) > 0, "jitter");
  without(f, boundary, "heat_flux", conduction, "the term conduction");
  const char *model = get_text(boundary, "model", "adami");
  without(f, boundary, "heat_flux", !strcmp(model, "mirror") || !conduction, "model: mirror");
  without(f, boundary, "repulsion", !strcmp(model, "adami"), "model: adami");
  int filled = 0;
  for (const sph_case_node *shape = child_of(group, "shapes")->first; shape; shape = shape->next)
    filled |= strcmp(shape->first->key, "file") && strcmp(shape->first->key, "layers") &&
              strcmp(shape->first->key, "plane");
  without(f, group, "lattice", filled, "a shape that is filled; file and layers have their own");
  without(f, group, "packing", filled, "a shape that is filled; file and layers have their own");
}

static void look_at_integrator(finder *f, const sph_case_node *map)
{
  const char *method = get_text(map, "method", "");
  const int imex = !strncmp(method, "imex:", 5), erk = !strncmp(method, "erk:", 4);
  const int fixed = child_of(map, "dt_fixed") != NULL;
  const int control = get_number(map, "error_control", 1) != 0 && !fixed;
  without(f, map, "linear", imex, "an imex: method");
  without(f, map, "stage_tolerance", imex, "an imex: method");
  without(f, map, "relax", erk || imex, "an erk: or imex: method");
  without(f, map, "tolerance", control, "error control");
  without(f, map, "controller", control, "error control");
  without(f, map, "cfl", !fixed, "steps that change: dt_fixed is given");
  without(f, map, "dt_max", !fixed, "steps that change: dt_fixed is given");
  without(f, map, "dt_min", !fixed, "steps that change: dt_fixed is given");
}

static int of_points(const char *norm)
{
  return !strcmp(norm, "rms") || !strcmp(norm, "l1") || !strcmp(norm, "max");
}

/* Points of a table that count, but are behind the end of the run: with them nothing passes. */
static void look_at_table(finder *f, const sph_case_node *one, double end)
{
  const sph_case_node *kind = child_of(one, "reference")->first;
  char path[SPH_CASE_PATH], title[128];
  double *x = NULL, *y = NULL, window[3] = {-INFINITY, INFINITY};
  const double up_to = get_number(one, "up_to", INFINITY);
  long nx = 0, ny = 0, wanted = 0, used = 0;
  sph_error e = {0};
  if (strcmp(kind->key, "csv") != 0 || !of_points(get_text(one, "norm", "")) ||
      sph_case_path(f->c, get_text(kind, "file", ""), path, &e) ||
      sph_csv_read(path, get_text(kind, "x", NULL), 0, &x, &nx, title, &e))
    return;
  if (child_of(one, "window")) sph_case_reader_vector(one, "window", window);
  if (!sph_csv_read(path, get_text(kind, "y", NULL), 1, &y, &ny, title, &e))
    for (long k = 0; k < nx && k < ny; k++) {
      if (!(x[k] >= window[0] && x[k] <= window[1] && y[k] <= up_to)) continue;
      wanted++;
      used += x[k] <= end * (1 + 1e-9);
    }
  if (wanted == 0 && ny > 0)
    warn(f, child_of(one, "reference"), "none of its %ld points is in the window and below up_to",
         nx);
  else if (used < wanted && (used == 0 || child_of(one, "bar")))
    warn(f, child_of(one, "reference"),
         "%ld of its %ld points that count are behind the end of the run, %g in their time: the "
         "comparison does not pass",
         wanted - used, wanted, end);
  sph_memory_free(x);
  sph_memory_free(y);
}

static void look_at_comparisons(finder *f, const sph_case_node *list, double end)
{
  for (const sph_case_node *one = list ? list->first : NULL; one; one = one->next) {
    const char *norm = get_text(one, "norm", "rms");
    const double scale = get_number(one, "time_scale", 1);
    double window[3];
    without(f, one, "threshold", !strcmp(norm, "arrival"), "norm: arrival");
    if (!sph_case_solution_find(child_of(one, "reference")->first->key) &&
        sph_case_reader_vector(one, "window", window) && window[0] * scale > end)
      warn(f, child_of(one, "window"), "it begins at %g s, behind the end of the run, %g s",
           window[0] * scale, end);
    else
      look_at_table(f, one, end / scale);
  }
}

static void look_at_events(finder *f, const sph_case_node *events, double end)
{
  for (const sph_case_node *e = events ? events->first : NULL; e; e = e->next) {
    const sph_case_node *time = child_of(child_of(e, "when"), "time");
    if (!time) continue;
    if (time->number > end)
      warn(f, time, "event %.60s never happens: the run ends at t = %g s", e->key, end);
    if (time->number == 0)
      warn(f, time, "event %.60s never happens: the run begins there; an event is what it passes",
           e->key);
    if (!strcmp(get_text(e, "direction", "rising"), "falling"))
      warn(f, child_of(e, "direction"), "event %.60s never happens: time rises", e->key);
    without(f, e, "samples", 0, "something to search; a time is known");
  }
}

static void look_at_period(finder *f, const sph_case_node *map, const char *key, double end)
{
  const sph_case_node *node = given(map, key);
  if (node && node->number > end)
    warn(f, node, "%g s is longer than the run of %g s", node->number, end);
}

static void look_at_periods(finder *f, const sph_case_node *root, double end)
{
  const sph_case_node *output = child_of(root, "output"), *probes = child_of(output, "probes");
  look_at_period(f, output, "snapshots", end);
  look_at_period(f, output, "series", end);
  for (const sph_case_node *p = probes ? probes->first : NULL; p; p = p->next)
    look_at_period(f, p, "interval", end);
  look_at_period(f, child_of(root, "checkpoint"), "interval", end);
}

/* ---- too many of them */

static void look_at_count(finder *f, const sph_case_node *map, const char *key, double end,
                          double most, const char *what)
{
  const sph_case_node *node = given(map, key);
  if (node && end / node->number > most)
    warn(f, node, "%g s makes %.3g %s in the run of %g s; a right number is below %g", node->number,
         end / node->number, what, end, most);
}

static void look_at_counts(finder *f, const sph_case_node *root, double end)
{
  const sph_case_node *output = child_of(root, "output"), *probes = child_of(output, "probes");
  look_at_count(f, output, "snapshots", end, 1e4, "snapshots");
  look_at_count(f, output, "series", end, 1e6, "rows of series.csv");
  for (const sph_case_node *p = probes ? probes->first : NULL; p; p = p->next)
    look_at_count(f, p, "interval", end, 1e6, "frames of the probe");
  look_at_count(f, child_of(root, "checkpoint"), "interval", end, 1e4, "checkpoints");
}

/* ---- a column of liquid, and what is to hold it */

static void look_at_column(finder *f, const sph_case_node *column, const sph_case_node *terms)
{
  static const double MOSTLY = 0.7, NEAR = 0.05;
  double g[3] = {0}, all = 0;
  const double wanted = get_number(column, "gravity", 0);
  const int up = get_text(column, "axis", &"xyz"[f->c->dim - 1])[0] - 'x';
  if (child_of(terms, "body-force") || child_of(terms, "harmonic") || wanted == 0) return;
  sph_case_reader_vector(child_of(terms, "gravity"), "acceleration", g);
  for (int d = 0; d < f->c->dim; d++) all += g[d] * g[d];
  all = sqrt(all);
  if (all == 0)
    warn(f, column,
         "there is no gravity among the terms to hold this pressure: the liquid will "
         "spring apart");
  else if (g[up] > MOSTLY * all)
    warn(f, column, "the pressure rises downwards along %c, but gravity acts upwards: %g m/s^2",
         'x' + up, g[up]);
  else if (-g[up] < MOSTLY * all)
    warn(f, column, "the pressure rises downwards along %c, but gravity acts along (%g, %g, %g)",
         'x' + up, g[0], g[1], g[2]);
  else if (fabs(-g[up] / wanted - 1) > NEAR)
    warn(f, child_of(column, "gravity"), "%g m/s^2, but gravity among the terms is %g m/s^2",
         wanted, -g[up]);
}

/* ---- angles */

/* 30, which nobody means in radians. */
static void look_at_angle(finder *f, const sph_case_node *angle)
{
  char *end;
  const double n = angle ? strtod(angle->text, &end) : 0;
  if (angle && end != angle->text && !*end && fabs(n) > 2 * M_PI)
    warn(f, angle, "%s are radians, %.3g turns; in degrees right is %s deg", angle->text,
         n / (2 * M_PI), angle->text);
}

/* In shapes within shapes. */
static void look_at_rotations(finder *f, const sph_case_node *node)
{
  if (node->key && !strcmp(node->key, "rotate")) look_at_angle(f, child_of(node, "angle"));
  for (const sph_case_node *child = node->first; child; child = child->next)
    look_at_rotations(f, child);
}

static int is_constant(const finder *f, const sph_case_node *node)
{
  sph_case_value value;
  return !sph_case_value_evaluate(node->text, f->c->names, f->c->n, &value);
}

/* What these say at t = 0 is subtracted. */
static void look_at_motion(finder *f, const sph_case_node *motion)
{
  const sph_case_node *angle = child_of(child_of(motion, "rotation"), "angle");
  const sph_case_node *by = child_of(motion, "displacement"), *one = by ? by->first : NULL;
  if (angle && is_constant(f, angle))
    warn(f, angle,
         "it does not change with t: the wall stands still; right is an expression in t, "
         "as 30 deg*sin(2*pi*t/(1 s)), or angular_velocity");
  while (one && is_constant(f, one)) one = one->next;
  if (by && !one)
    warn(f, by,
         "none of them changes with t: the wall stands still; right are expressions in t, "
         "as 2 cm*sin(2*pi*t/(1 s)), or velocity");
}

int sph_case_warning(const sph_case *c, int k, char *text, size_t size)
{
  finder f = {.c = c, .wanted = k, .text = text, .size = size};
  if (!c || k < 0) return 0;
  const sph_case_node *terms = child_of(c->root, "terms");
  look_at_terms(&f, terms);
  for (const sph_case_node *g = child_of(c->root, "groups")->first; g; g = g->next) {
    const sph_case_node *column = child_of(child_of(g, "initial"), "hydrostatic");
    look_at_group(&f, g, terms);
    if (column) look_at_column(&f, column, terms);
    look_at_rotations(&f, child_of(g, "shapes"));
    look_at_motion(&f, child_of(child_of(g, "boundary"), "motion"));
  }
  look_at_integrator(&f, child_of(c->root, "integrator"));
  look_at_comparisons(&f, child_of(c->root, "compare"), sph_case_end(c));
  look_at_events(&f, child_of(c->root, "events"), sph_case_end(c));
  look_at_periods(&f, c->root, sph_case_end(c));
  look_at_counts(&f, c->root, sph_case_end(c));
  return f.found > k;
}
