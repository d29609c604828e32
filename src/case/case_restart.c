/* What of a case may be another when a run goes on: what the state, the columns of tables and the
 * numbers of particles do not hang on. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "case_schema.h"
#include "sphode/case.h"

#define child_of sph_case_reader_find

enum { PATH = 300 };

/* Beginnings of paths, * is any word; the first that fits counts, one behind "!" may not.  What
 * parameters and tables change is looked for where they are used. */
static const char *const may[] = {"title",
                                  "description",
                                  "include",
                                  "parameters",
                                  "tables",
                                  "speed",
                                  "integrator",
                                  "run",
                                  "checkpoint",
                                  "plot",
                                  "compare",
                                  "events",
                                  "density_reset",
                                  "output.snapshots",
                                  "output.series",
                                  "output.fields",
                                  "output.precision",
                                  "output.compression",
                                  "output.probes.*.interval",
                                  "groups.*.viscosity",
                                  "groups.*.conductivity",
                                  "groups.*.scales",
                                  "groups.*.boundary.temperature",
                                  "groups.*.boundary.heat_flux",
                                  "scalars.*.diffusivity",
                                  "scalars.*.source",
                                  "scalars.*.scale",
                                  "scalars.*.fluids.*.diffusivity",
                                  "scalars.*.walls.*.value",
                                  "!terms.summation",
                                  "!terms.*.switch",
                                  "terms.*.*"};

typedef struct walk {
  const sph_case *before, *now;
  char path[PATH];
  sph_error *error;
} walk;

static int fits(const char *pattern, const char *path)
{
  for (; *pattern; pattern++) {
    if (*pattern == '*')
      for (; path[0] && path[0] != '.'; path++) continue;
    else if (*pattern != *path++)
      return 0;
  }
  return !*path || *path == '.';
}

static int allowed(const walk *w)
{
  for (size_t k = 0; k < sizeof may / sizeof *may; k++) {
    const int not = may[k][0] == '!';
    if (fits(may[k] + not, w->path)) return !not ;
  }
  return 0;
}

/* ---- is it the same? ---- */

static const sph_case_name *find_name(const sph_case *c, const char *word, size_t n)
{
  for (int k = 0; k < c->n; k++)
    if (strlen(c->names[k].name) == n && !strncmp(c->names[k].name, word, n)) return &c->names[k];
  return NULL;
}

static int same_tree(const sph_case_node *a, const sph_case_node *b)
{
  if (!a || !b || a->kind != b->kind) return a == b;
  if (a->kind == SPH_CASE_SCALAR) return !strcmp(a->text, b->text);
  const sph_case_node *p = a->first, *q = b->first;
  for (; p && q && same_tree(p, q); p = p->next) q = q->next;
  return !p && !q;
}

/* Is the word a parameter or a table that became another? */
static int became_another(const walk *w, const char *word, size_t n)
{
  char name[60];
  const sph_case_name *a = find_name(w->before, word, n), *b = find_name(w->now, word, n);
  if (a && b) return a->value != b->value || !sph_si_unit_same(a->power, b->power);
  if (n >= sizeof name) return 0;
  snprintf(name, sizeof name, "%.*s", (int)n, word);
  return !same_tree(child_of(child_of(w->before->root, "tables"), name),
                    child_of(child_of(w->now->root, "tables"), name));
}

static int uses_another(const walk *w, const char *text)
{
  for (const char *at = text; *at;) {
    size_t n = 0;
    while (isalnum((unsigned char)at[n]) || at[n] == '_') n++;
    if (n && !isdigit((unsigned char)*at) && became_another(w, at, n)) return 1;
    at += n ? n : 1;
  }
  return 0;
}

/* Numbers by their values; all else, as formulas, by its text and what it names. */
static int same(const walk *w, const sph_case_node *a, const sph_case_node *b)
{
  if (a->number != b->number) return 0;
  if (a->number != 0) return 1;
  return !strcmp(a->text, b->text) && !uses_another(w, b->text);
}

/* ---- the walk ---- */

static int refuse(const walk *w, const sph_case_node *a, const sph_case_node *b)
{
  const char *was = a && a->kind == SPH_CASE_SCALAR ? a->text : a ? "something else" : "not there";
  const char *is = b && b->kind == SPH_CASE_SCALAR ? b->text : b ? "new" : "gone";
  return sph_error_set(
      w->error, SPH_ERR_ARGUMENT,
      "%s (it was %.60s, is %.60s%s) cannot change where a run goes on; what can: run, "
      "integrator, checkpoint, intervals of output, events, density_reset, speed, plot, compare, "
      "viscosity, conductivity and scales of groups, temperatures of walls, parameters of terms "
      "that the run has (but switches)",
      w->path, was, is, a && b && !strcmp(was, is) ? " with other parameters" : "");
}

/* A new table does not move the others, but that of events is the last one. */
static int is_new_probe(const walk *w, const sph_case_node *a)
{
  return !a && (fits("output.probes", w->path) || fits("output.probes.*", w->path)) &&
         !child_of(w->before->root, "events") && !child_of(w->now->root, "events");
}

static const sph_case_node *partner(const sph_case_node *in, const sph_case_node *of, long k)
{
  if (of->key) return child_of(in, of->key);
  const sph_case_node *child = in->first;
  for (; child && k > 0; k--) child = child->next;
  return child;
}

static int compare(walk *w, const sph_case_node *a, const sph_case_node *b);

static int compare_child(walk *w, const sph_case_node *a, const sph_case_node *b, long k)
{
  const size_t used = strlen(w->path);
  const char *key = a ? a->key : b->key, *dot = used ? "." : "";
  if (key)
    snprintf(w->path + used, sizeof w->path - used, "%s%s", dot, key);
  else
    snprintf(w->path + used, sizeof w->path - used, "%s%ld", dot, k);
  int status = SPH_OK;
  if (!allowed(w) && !is_new_probe(w, a)) status = a && b ? compare(w, a, b) : refuse(w, a, b);
  w->path[used] = '\0';
  return status;
}

static int compare(walk *w, const sph_case_node *a, const sph_case_node *b)
{
  int status = SPH_OK;
  long k = 0;
  if (a->kind != b->kind) return refuse(w, a, b);
  if (a->kind == SPH_CASE_SCALAR) return same(w, a, b) ? SPH_OK : refuse(w, a, b);
  for (const sph_case_node *child = a->first; child && !status; child = child->next, k++)
    status = compare_child(w, child, partner(b, child, k), k);
  k = 0;
  for (const sph_case_node *child = b->first; child && !status; child = child->next, k++)
    if (!partner(a, child, k)) status = compare_child(w, NULL, child, k);
  return status;
}

int sph_case_restart_check(const sph_case *before, const sph_case *now, sph_error *error)
{
  sph_error own = {0};
  walk w = {.before = before, .now = now, .error = error ? error : &own};
  if (!before || !now)
    return sph_error_set(w.error, SPH_ERR_ARGUMENT, "a restart of no case (NULL)");
  return compare(&w, before->root, now->root);
}
