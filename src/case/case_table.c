#include "case_table.h"

#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_path.h"
#include "case_schema.h"
#include "csv.h"
#include "gsl.h"
#include "memory.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text

enum beyond { HOLD, REPEAT };

struct sph_case_table {
  long n;
  double *t, *value; /* [n], SI; t rises */
  enum beyond beyond;
  int cubic;
  gsl_interp *spline;
};

/* Natural cubic, or straight lines; two rows have no curvature to choose. */
static int make_spline(sph_case_table *it)
{
  const gsl_interp_type *type = it->cubic && it->n > 2 ? gsl_interp_cspline : gsl_interp_linear;
  if (it->cubic && it->n > 2 && it->beyond == REPEAT) type = gsl_interp_cspline_periodic;
  sph_gsl_begin();
  it->spline = gsl_interp_alloc(type, (size_t)it->n);
  int failed = !it->spline || gsl_interp_init(it->spline, it->t, it->value, (size_t)it->n);
  sph_gsl_end();
  return failed ? SPH_ERR_MEMORY : SPH_OK;
}

double sph_case_table_at(const sph_case_table *it, double t)
{
  const double from = it->t[0], to = it->t[it->n - 1];
  double value = NAN;
  if (it->beyond == REPEAT) t -= floor((t - from) / (to - from)) * (to - from);
  if (t <= from) return it->value[0];
  if (t >= to) return it->value[it->n - 1];
  /* Inside, where GSL finds no error. */
  return gsl_interp_eval_e(it->spline, it->t, it->value, t, NULL, &value) ? NAN : value;
}

sph_case_table *sph_case_table_copy(const sph_case_table *table)
{
  sph_case_table *it = SPH_NEW(sph_case_table, 1, "a table", NULL);
  if (!it) return NULL;
  *it = *table;
  it->spline = NULL;
  it->t = SPH_NEW(double, it->n, "a table", NULL);
  it->value = SPH_NEW(double, it->n, "a table", NULL);
  if (it->t && it->value) {
    memcpy(it->t, table->t, (size_t)it->n * sizeof *it->t);
    memcpy(it->value, table->value, (size_t)it->n * sizeof *it->value);
    if (!make_spline(it)) return it;
  }
  sph_case_table_free(it);
  return NULL;
}

void sph_case_table_free(sph_case_table *it)
{
  if (!it) return;
  if (it->spline) gsl_interp_free(it->spline);
  sph_memory_free(it->t);
  sph_memory_free(it->value);
  sph_memory_free(it);
}

/* ---- from a case */

/* The unit in "front [m]". */
static int unit_of(sph_case *c, const char *title, const char *what, sph_case_value *unit)
{
  const char *open = strchr(title, '['), *close = open ? strchr(open, ']') : NULL;
  char text[140];
  *unit = (sph_case_value){.value = 1};
  if (!close || close == open + 1) return SPH_OK;
  snprintf(text, sizeof text, "%s%.*s", open[1] == '1' ? "" : "1 ", (int)(close - open - 1),
           open + 1);
  if (!sph_case_value_evaluate(text, c->names, c->n, unit)) return SPH_OK;
  return sph_error_set(c->error, SPH_ERR_PARSE, "%s: unit of the column '%.60s': %s", what, title,
                       unit->problem);
}

static int check_times(const sph_case_table *it, const char *path, sph_error *error)
{
  if (it->n < 2)
    return sph_error_set(error, SPH_ERR_FILE, "%s: a table of %ld row%s; right is 2 or more", path,
                         it->n, it->n == 1 ? "" : "s");
  for (long k = 0; k < it->n; k++) {
    if (!isfinite(it->t[k]) || !isfinite(it->value[k]))
      return sph_error_set(error, SPH_ERR_FILE,
                           "%s: row %ld holds %g, %g; finite numbers are right", path, k + 1,
                           it->t[k], it->value[k]);
    if (k > 0 && !(it->t[k] > it->t[k - 1]))
      return sph_error_set(error, SPH_ERR_FILE,
                           "%s: row %ld is of t = %g, the one before it of %g; times that rise are "
                           "right",
                           path, k + 1, it->t[k], it->t[k - 1]);
  }
  return SPH_OK;
}

static int check_repeat(const sph_case_table *it, const char *path, sph_error *error)
{
  if (it->beyond != REPEAT || it->value[0] == it->value[it->n - 1]) return SPH_OK;
  return sph_error_set(
      error, SPH_ERR_FILE,
      "%s: begins with %g, ends with %g; with outside: repeat both must be the same", path,
      it->value[0], it->value[it->n - 1]);
}

static int is_time(const sph_case_value *unit)
{
  double others = 0;
  for (int b = 0; b < SPH_SI_BASES; b++) others += b == 2 ? 0 : fabs(unit->power[b]);
  return others == 0 && (unit->power[2] == 0 || unit->power[2] == 1);
}

/* given: the unit of the case, NULL: that of the file. */
static int load(sph_case *c, sph_case_table *it, const sph_case_node *map, const char *path,
                const sph_case_value *given, double power[SPH_SI_BASES])
{
  char t_title[128], title[128];
  sph_case_value t_unit, unit;
  long rows = 0;
  int status = sph_csv_read(path, get_text(map, "t", NULL), 0, &it->t, &it->n, t_title, c->error);
  if (!status)
    status =
        sph_csv_read(path, get_text(map, "column", NULL), 1, &it->value, &rows, title, c->error);
  if (!status && rows != it->n)
    status =
        sph_error_set(c->error, SPH_ERR_FILE, "%s: columns of %ld and %ld rows", path, it->n, rows);
  if (!status) status = unit_of(c, t_title, path, &t_unit);
  if (!status && !given) status = unit_of(c, title, path, &unit);
  if (status) return status;
  if (given) unit = *given;
  if (!is_time(&t_unit))
    return sph_error_set(c->error, SPH_ERR_PARSE,
                         "%s: the column '%.60s' is no time; s, ms, min are right", path, t_title);
  for (long k = 0; k < it->n; k++) it->t[k] *= t_unit.value, it->value[k] *= unit.value;
  memcpy(power, unit.power, sizeof unit.power);
  status = check_times(it, path, c->error);
  return status ? status : check_repeat(it, path, c->error);
}

static int read_one(sph_case *c, const sph_case_node *map)
{
  char path[SPH_CASE_PATH];
  sph_case_name *name = &c->timed[c->timed_n];
  sph_error *outer = c->error, inner = {0};
  const sph_case_node *file = child_of(map, "file"), *given = child_of(map, "unit");
  sph_case_value unit;
  if (given && sph_case_value_evaluate(given->text, c->names, c->n, &unit))
    return sph_case_schema_fail(c, outer, given, 1, unit.column, "unit: %s", unit.problem);
  sph_case_table *it = SPH_NEW(sph_case_table, 1, "a table", outer);
  if (!it) return SPH_ERR_MEMORY;
  *name = (sph_case_name){.name = map->key, .table = it};
  c->timed_n++; /* owned from here on */
  it->beyond = !strcmp(get_text(map, "outside", "hold"), "repeat") ? REPEAT : HOLD;
  it->cubic = strcmp(get_text(map, "interpolation", "cubic"), "linear") != 0;
  c->error = &inner;
  int status = sph_case_path(c, file->text, path, &inner);
  if (!status) status = load(c, it, map, path, given ? &unit : NULL, name->power);
  if (!status && make_spline(it))
    status = sph_error_set(&inner, SPH_ERR_MEMORY, "out of memory: a table");
  c->error = outer;
  if (status == SPH_ERR_MEMORY) return sph_error_set(outer, status, "%s", inner.text);
  if (status) return sph_case_schema_fail(c, outer, file, 1, 0, "%s", inner.text);
  for (long k = 0; k < it->n; k++)
    if (fabs(it->value[k]) > fabs(name->value)) name->value = it->value[k]; /* to see its unit */
  return SPH_OK;
}

int sph_case_table_read_all(sph_case *c)
{
  const sph_case_node *tables = child_of(c->root, "tables");
  int status = SPH_OK;
  memcpy(c->timed, c->names, (size_t)c->n * sizeof *c->names);
  c->timed_n = c->n;
  for (const sph_case_node *map = tables ? tables->first : NULL; map && !status; map = map->next) {
    if (c->timed_n >= SPH_CASE_NAMES)
      return sph_case_schema_fail(c, c->error, map, 0, 0, "more than %d parameters and tables",
                                  SPH_CASE_NAMES);
    for (int k = 0; k < c->n; k++)
      if (!strcmp(c->names[k].name, map->key))
        return sph_case_schema_fail(c, c->error, map, 0, 0,
                                    "'%s' is a parameter, too; choose another name", map->key);
    status = read_one(c, map);
  }
  return status;
}
