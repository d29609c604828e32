/* Comparisons, before a run of hours: are their tables there, has the run that quantity? */
#include <stdio.h>
#include <string.h>

#include "case_path.h"
#include "case_profile.h"
#include "case_section.h"
#include "csv.h"
#include "file.h"
#include "memory.h"
#include "sphode/case.h"
#include "words.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text

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
static int is_field(const sph_group *group, const char *name, sph_words *words)
{
  const sph_field_info *info;
  const size_t n = strlen(name);
  for (int k = 0; (info = sph_group_field(group, k)); k++) {
    const size_t length = strlen(info->name);
    if (!strcmp(info->name, name)) return 1;
    if (info->vector && n == length + 2 && !strncmp(info->name, name, length) &&
        name[length] == '_' && strchr("xyz", name[length + 1]))
      return 1;
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

int sph_case_compare_check(const sph_case *c, sph_sim *sim, const char *directory, sph_error *error)
{
  sph_error own = {0};
  comparer a = {.c = c, .sim = sim, .directory = directory, .error = error ? error : &own};
  if (!c || !sim)
    return sph_error_set(a.error, SPH_ERR_ARGUMENT, "a check of comparisons: no %s (NULL)",
                         c ? "simulation" : "case");
  const sph_case_node *list = child_of(c->root, "compare");
  int status = SPH_OK;
  for (a.node = list ? list->first : NULL; a.node && !status; a.node = a.node->next) {
    a.kind = child_of(a.node, "reference")->first;
    const int in_space = sph_case_profile_known(&a) || sph_case_section_known(&a);
    status = check_table(&a);
    if (!status) status = in_space ? check_field(&a) : check_series(&a);
  }
  return status;
}
