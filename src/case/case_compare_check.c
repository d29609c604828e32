/* Comparisons, before a run of hours: are their tables there, has the run that quantity? */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_build.h"
#include "case_path.h"
#include "case_profile.h"
#include "case_section.h"
#include "csv.h"
#include "file.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode/case.h"
#include "words.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

typedef sph_case_comparer comparer;

static int fail(const comparer *a, const sph_case_node *node, const char *what)
{
  return sph_case_schema_fail(a->c, a->error, node, 1, 0, "%s", what);
}

static int check_column(const comparer *a, const char *path, const char *name, int number,
                        const sph_case_node *blamed)
{
  double *values = NULL;
  char title[128];
  long n = 0;
  sph_error e = {0};
  const int status = sph_csv_read(path, name, number, &values, &n, title, &e);
  sph_memory_free(values);
  return status ? fail(a, blamed, e.text) : SPH_OK;
}

static int check_table(const comparer *a)
{
  char path[SPH_CASE_PATH];
  const sph_case_node *file = child_of(a->kind, "file"), *x = child_of(a->kind, "x"),
                      *y = child_of(a->kind, "y");
  if (!file) return SPH_OK; /* no table */
  int status = sph_case_path(a->c, file->text, path, a->error);
  if (!status) status = check_column(a, path, x ? x->text : NULL, 0, x ? x : file);
  if (!status) status = check_column(a, path, y ? y->text : NULL, 1, y ? y : file);
  return status;
}

/* velocity_x is a component of velocity. */
static int is_named(const sph_field_info *info, const char *name)
{
  const size_t n = strlen(name), length = strlen(info->name);
  if (!strcmp(info->name, name)) return 1;
  return info->vector && n == length + 2 && !strncmp(info->name, name, length) &&
         name[length] == '_' && strchr("xyz", name[length + 1]);
}

static int is_field(const sph_group *group, const char *name, sph_words *words)
{
  const sph_field_info *info;
  for (int k = 0; (info = sph_group_field(group, k)); k++) {
    if (is_named(info, name)) return 1;
    sph_words_add(words, info->name);
  }
  return 0;
}

static int check_field(const comparer *a)
{
  const sph_case_node *quantity = child_of(a->node, "quantity");
  const char *only = get_text(a->node, "group", NULL);
  const sph_group *group;
  char what[700];
  for (int k = 0; (group = sph_sim_group_get(a->sim, k)); k++) {
    sph_words words = {.wanted = quantity->text};
    if (strcmp(sph_group_kind(group), "fluid") != 0) continue;
    if (only && strcmp(only, sph_group_name(group)) != 0) continue;
    if (is_field(group, quantity->text, &words)) continue;
    snprintf(what, sizeof what, "quantity: %.60s has no field '%.60s'; %sit has: %.400s",
             sph_group_name(group), quantity->text, words.nearest, words.known);
    return fail(a, quantity, what);
  }
  return SPH_OK;
}

static int check_series(const comparer *a)
{
  char path[SPH_PATH];
  const sph_case_node *quantity = child_of(a->node, "quantity");
  if (!a->directory) return SPH_OK;
  if (sph_file_path(path, a->directory, "series.csv", a->error)) return a->error->status;
  if (!check_column(a, path, quantity->text, 0, quantity)) return SPH_OK;
  a->error->status = SPH_OK; /* in words of the case: that file is nobody's */
  char what[300];
  snprintf(what, sizeof what,
           "quantity: '%.60s' is no column of series.csv; right are kinetic, potential, internal, "
           "total, momentum_x, ..., and the names of output: monitors and forces",
           quantity->text);
  return fail(a, quantity, what);
}

static int has_snapshots_of_events(const sph_case *c)
{
  const sph_case_node *events = child_of(c->root, "events");
  int found = 0;
  for (const sph_case_node *e = events ? events->first : NULL; e; e = e->next)
    found |= get_number(e, "snapshot", 0) != 0;
  return found;
}

/* Will there be a snapshot at each of its times? */
static int check_times(const comparer *a)
{
  const sph_case_node *at = child_of(a->node, "at");
  const double end = sph_case_end(a->c);
  const double every = get_number(child_of(a->c->root, "output"), "snapshots", end / 20);
  char what[200];
  if (at && !sph_case_profile_known(a)) return fail(a, at, "at: belongs to solutions in space");
  for (const sph_case_node *t = at ? at->first : NULL; t; t = t->next) {
    const double off = fabs(t->number - every * round(t->number / every));
    if (t->number > end * (1 + 1e-9))
      snprintf(what, sizeof what, "at: %g s is behind the end of the run, %g s", t->number, end);
    else if (off > 1e-9 * end && t->number < end * (1 - 1e-9) && !has_snapshots_of_events(a->c))
      snprintf(what, sizeof what,
               "at: there will be no snapshot at t = %g s; output: snapshots makes one each %g s",
               t->number, every);
    else
      continue;
    return fail(a, t, what);
  }
  return SPH_OK;
}

/* Will the snapshots that are read back hold what is compared? */
static int check_written(const comparer *a)
{
  const char *fields = get_text(child_of(a->c->root, "output"), "fields", NULL);
  const sph_case_node *quantity = child_of(a->node, "quantity");
  char field[64], what[300];
  if (!fields || !quantity || !(child_of(a->node, "at") || sph_case_section_known(a)))
    return SPH_OK;
  snprintf(field, sizeof field, "%s", quantity->text);
  const size_t n = strlen(field);
  if (n > 2 && field[n - 2] == '_' && strchr("xyz", field[n - 1])) field[n - 2] = 0;
  if (sph_snapshot_holds(fields, field)) return SPH_OK;
  snprintf(what, sizeof what,
           "quantity: snapshots will hold no %s, which is compared with them; output: fields has "
           "'%.100s'",
           field, fields);
  return fail(a, quantity, what);
}

/* Of a section its times, without which it has no snapshots; of others the places or times that
 * count: in time there may be none of them, which is told (case_warning.c). */
static int check_window(const comparer *a)
{
  const sph_case_node *node = child_of(a->node, "window"), *axis = child_of(a->kind, "axis");
  double window[3];
  char what[200];
  if (sph_case_section_known(a) && axis->text[0] - 'x' >= a->c->dim) {
    snprintf(what, sizeof what, "axis: there is no %s in %d dimension%s", axis->text, a->c->dim,
             a->c->dim == 1 ? "" : "s");
    return fail(a, axis, what);
  }
  if (!sph_case_reader_vector(a->node, "window", window)) return SPH_OK;
  snprintf(what, sizeof what, "window: found from %g to %g; right is from the less to the larger",
           window[0], window[1]);
  if (!(window[0] <= window[1])) return fail(a, node, what);
  const double begin = window[0] * get_number(a->node, "time_scale", 1), end = sph_case_end(a->c);
  snprintf(what, sizeof what, "window: it begins at %g s, behind the end of the run, %g s", begin,
           end);
  return sph_case_section_known(a) && begin > end ? fail(a, node, what) : SPH_OK;
}

int sph_case_compare_check(const sph_case *c, sph_sim *sim, const char *directory, sph_error *error)
{
  sph_error own = {0};
  comparer a = {.c = c, .sim = sim, .directory = directory, .error = error ? error : &own};
  if (!c || !sim)
    return sph_error_set(a.error, SPH_ERR_ARGUMENT, "a check of comparisons: no %s (NULL)",
                         c ? "simulation" : "case");
  const sph_case_node *list = child_of(c->root, "compare");
  int status = sph_case_build_output_fields(c, sim, a.error);
  for (a.node = list ? list->first : NULL; a.node && !status; a.node = a.node->next) {
    a.kind = child_of(a.node, "reference")->first;
    const int in_space = sph_case_profile_known(&a) || sph_case_section_known(&a);
    status = check_table(&a);
    if (!status) status = in_space ? check_field(&a) : check_series(&a);
    if (!status) status = check_times(&a);
    if (!status) status = check_written(&a);
    if (!status) status = check_window(&a);
    if (!status && sph_case_profile_known(&a)) status = sph_case_profile_check(&a);
  }
  return status;
}

/* ---- the picture */

/* Snapshots have an energy of each fluid, elastic where it is no other; with output: fields those
 * alone. */
static int in_snapshots(const sph_case *c, const sph_group *group, const sph_field_info *info)
{
  const char *fields = get_text(child_of(c->root, "output"), "fields", NULL);
  if (!sph_snapshot_holds(fields, info->name)) return 0;

  const int elastic = !strcmp(info->name, "energy") && !strcmp(sph_group_kind(group), "fluid");
  return info->saved && (elastic || sph_group_read(group, info->name, 0));
}

int sph_case_plot_check(const sph_case *c, sph_sim *sim, sph_error *error)
{
  sph_error own = {0};
  if (!error) error = &own;
  if (!c || !sim)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a check of the picture: no %s (NULL)",
                         c ? "simulation" : "case");
  const sph_case_node *field = child_of(child_of(c->root, "plot"), "field");
  static const char *const more[] = {"id", "group", "smoothing_length"}; /* of all particles */
  sph_words words = {.wanted = field ? field->text : ""};
  const sph_group *group;
  int fluids = 0, status = sph_case_build_output_fields(c, sim, error);
  if (status || !field) return status; /* else velocity or density */
  for (int k = 0; k < 3; k++)
    if (!strcmp(field->text, more[k])) return SPH_OK;
  for (int g = 0; (group = sph_sim_group_get(sim, g)); g++) {
    const sph_field_info *info;
    const int first = !strcmp(sph_group_kind(group), "fluid") && !fluids++;
    for (int k = 0; (info = sph_group_field(group, k)); k++) {
      if (!in_snapshots(c, group, info)) continue;
      if (is_named(info, field->text)) return SPH_OK;
      if (first) sph_words_add(&words, info->name);
    }
  }
  return sph_case_schema_fail(c, error, field, 1, 0,
                              "field: snapshots will have no '%.60s'; %sthey have: %.400s, and "
                              "components as velocity_x",
                              field->text, words.nearest, words.known);
}
