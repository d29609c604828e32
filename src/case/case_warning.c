/* Keys that do nothing without their partner, events that never happen, periods longer than the
 * run: right, but hardly what was meant. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "case_schema.h"
#include "case_solution.h"
#include "sphode/case.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

/* Warning number `wanted` of those that are found. */
typedef struct finder {
  const sph_case *c;
  int wanted, found;
  char *text;
  size_t size;
} finder;

static void found(finder *f, const sph_case_node *node, const char *format, ...) SPH_PRINTF(3, 4);
static void found(finder *f, const sph_case_node *node, const char *format, ...)
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
  if (node && !partner) found(f, node, "does nothing without %s", what);
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

static void look_at_group(finder *f, const sph_case_node *group, const sph_case_node *terms)
{
  const int conduction = child_of(terms, "conduction") != NULL;
  const int laminar = child_of(terms, "viscosity-laminar") != NULL;
  const int viscous =
      laminar || child_of(terms, "viscosity-artificial") || child_of(terms, "viscosity-signal");
  const sph_case_node *boundary = child_of(group, "boundary");
  without(f, group, "viscosity", laminar, "the term viscosity-laminar");
  without(f, group, "conductivity", conduction, "the term conduction");
  without(f, group, "seed", get_number(group, "jitter", 0) > 0, "jitter");
  without(f, boundary, "temperature", conduction, "the term conduction");
  without(f, boundary, "heat_flux", conduction, "the term conduction");
  without(f, boundary, "no_slip", viscous, "a viscosity among the terms");
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

static void look_at_comparisons(finder *f, const sph_case_node *list, double end)
{
  for (const sph_case_node *one = list ? list->first : NULL; one; one = one->next) {
    const char *norm = get_text(one, "norm", "rms");
    const double scale = get_number(one, "time_scale", 1);
    double window[3];
    without(f, one, "threshold", !strcmp(norm, "arrival"), "norm: arrival");
    if (!sph_case_solution_find(child_of(one, "reference")->first->key) &&
        sph_case_reader_vector(one, "window", window) && window[0] * scale > end)
      found(f, child_of(one, "window"), "it begins at %g s, behind the end of the run, %g s",
            window[0] * scale, end);
  }
}

static void look_at_events(finder *f, const sph_case_node *events, double end)
{
  for (const sph_case_node *e = events ? events->first : NULL; e; e = e->next) {
    const sph_case_node *time = child_of(child_of(e, "when"), "time");
    if (!time) continue;
    if (time->number > end)
      found(f, time, "event %.60s never happens: the run ends at t = %g s", e->key, end);
    if (time->number == 0)
      found(f, time, "event %.60s never happens: the run begins there; an event is what it passes",
            e->key);
    if (!strcmp(get_text(e, "direction", "rising"), "falling"))
      found(f, child_of(e, "direction"), "event %.60s never happens: time rises", e->key);
    without(f, e, "samples", 0, "something to search; a time is known");
  }
}

static void look_at_period(finder *f, const sph_case_node *map, const char *key, double end)
{
  const sph_case_node *node = given(map, key);
  if (node && node->number > end)
    found(f, node, "%g s is longer than the run of %g s", node->number, end);
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

int sph_case_warning(const sph_case *c, int k, char *text, size_t size)
{
  finder f = {.c = c, .wanted = k, .text = text, .size = size};
  if (!c || k < 0) return 0;
  const sph_case_node *terms = child_of(c->root, "terms");
  look_at_terms(&f, terms);
  for (const sph_case_node *g = child_of(c->root, "groups")->first; g; g = g->next)
    look_at_group(&f, g, terms);
  look_at_integrator(&f, child_of(c->root, "integrator"));
  look_at_comparisons(&f, child_of(c->root, "compare"), sph_case_end(c));
  look_at_events(&f, child_of(c->root, "events"), sph_case_end(c));
  look_at_periods(&f, c->root, sph_case_end(c));
  return f.found > k;
}
