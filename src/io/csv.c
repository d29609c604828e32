#include "csv.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"

typedef struct table {
  const char *path;
  FILE *file;
  char line[8192];
  long number; /* of the line, from 1 */
  int too_long, columns;
} table;

/* "a","b" is a,b: pandas, R and spreadsheets write quotes. */
static void unquote(char *line)
{
  char *to = line;
  int inside = 0;
  for (const char *from = line; *from; from++)
    if (*from == '"')
      inside = !inside;
    else
      *to++ = (char)(inside && *from == ',' ? ' ' : *from);
  *to = '\0';
}

/* The next line that is neither empty nor a comment; 0 at the end, or at one that is too long. */
static int next_line(table *t)
{
  while (fgets(t->line, sizeof t->line, t->file)) {
    t->number++;
    t->too_long = strlen(t->line) + 1 == sizeof t->line && t->line[sizeof t->line - 2] != '\n';
    if (t->too_long) return 0;
    t->line[strcspn(t->line, "\r\n")] = '\0';
    unquote(t->line);
    if (t->line[0] != '#' && t->line[strspn(t->line, " \t")] != '\0') return 1;
  }
  return 0;
}

/* Field number k of the line; NULL behind the last. */
static const char *field(const table *t, int k)
{
  const char *at = t->line;
  for (; k > 0; k--) {
    at = strchr(at, ',');
    if (!at) return NULL;
    at++;
  }
  return at + strspn(at, " \t");
}

static int same_name(const char *title, const char *name)
{
  size_t length = strcspn(title, ",[");
  while (length > 0 && (title[length - 1] == ' ' || title[length - 1] == '\t')) length--;
  return strlen(name) == length && !strncmp(title, name, length);
}

static int find_column(const table *t, const char *name, int column, char title[128],
                       sph_error *error)
{
  const char *at;
  int k = 0;
  for (; (at = field(t, k)); k++)
    if (name ? same_name(at, name) : k == column) break;
  if (at) {
    snprintf(title, 128, "%.*s", (int)strcspn(at, ","), at);
    return k;
  }
  if (name)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: no column \"%s\" among %.500s", t->path,
                         name, t->line);
  return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: no column %d, there are %d", t->path,
                       column + 1, k);
}

/* Does column k hold this word? */
static int holds(const table *t, int k, const char *word)
{
  const char *at = field(t, k);
  size_t length = at ? strcspn(at, ",") : 0;
  while (length > 0 && (at[length - 1] == ' ' || at[length - 1] == '\t')) length--;
  return at && strlen(word) == length && !strncmp(at, word, length);
}

/* Columns of the line, but for empty ones at its end. */
static int columns_of(const table *t)
{
  int n = 0, k = 0;
  for (const char *at; (at = field(t, k)); k++)
    if (*at && *at != ',') n = k + 1;
  return n;
}

/* Behind the last line that next_line gave. */
static int all_read(const table *t, sph_error *error)
{
  if (t->too_long)
    return sph_error_set(error, SPH_ERR_PARSE, "%s:%ld: a line of more than %zu characters",
                         t->path, t->number, sizeof t->line - 2);
  if (ferror(t->file))
    return sph_error_set(error, SPH_ERR_FILE, "cannot read %s: %s", t->path, strerror(errno));
  return SPH_OK;
}

/* Of the lines whose column `where` holds the word `is`; where < 0: of all. */
static int read_values(table *t, int where, const char *is, int column, double **values, long *n,
                       sph_error *error)
{
  long capacity = 0;
  while (next_line(t)) {
    if (where >= 0 && !holds(t, where, is)) continue;
    const char *at = field(t, column);
    char *end = NULL;
    const int found = columns_of(t);
    if (found > t->columns)
      return sph_error_set(error, SPH_ERR_PARSE,
                           "%s:%ld: it has %d columns, the first line names %d; decimals have a "
                           "point, not a comma",
                           t->path, t->number, found, t->columns);
    if (!at)
      return sph_error_set(error, SPH_ERR_PARSE, "%s:%ld: it has no column %d", t->path, t->number,
                           column + 1);
    double value = strtod(at, &end);
    if (end == at || end[strspn(end, " \t")] != (at[strcspn(at, ",")] ? ',' : '\0'))
      return sph_error_set(error, SPH_ERR_PARSE, "%s:%ld: \"%.*s\" in column %d is not a number",
                           t->path, t->number, (int)strcspn(at, ","), at, column + 1);
    if (*n == capacity) {
      void *grown = *values;
      long more = 2 * capacity + 256;
      int status = sph_memory_grow(&grown, (size_t)capacity, (size_t)more, sizeof **values,
                                   "a column of a table", error);
      if (status != SPH_OK) return status;
      *values = grown;
      capacity = more;
    }
    (*values)[(*n)++] = value;
  }
  return all_read(t, error);
}

int sph_csv_read(const char *path, const char *name, int column, double **values, long *n,
                 char title[128], sph_error *error)
{
  return sph_csv_read_rows(path, (sph_csv_rows){NULL, NULL}, name, column, values, n, title, error);
}

/* Does a row stand where names are right? */
static int is_row(const table *t)
{
  char *end;
  int k = 0, numbers = 1;
  for (const char *at; numbers && (at = field(t, k)); k++) {
    (void)strtod(at, &end);
    numbers = end != at && end[strspn(end, " \t")] == (at[strcspn(at, ",")] ? ',' : '\0');
  }
  return numbers;
}

static int check_separator(const table *t, sph_error *error)
{
  const int tab = strchr(t->line, '\t') != NULL;
  if (strchr(t->line, ',') || !(tab || strchr(t->line, ';'))) return SPH_OK;
  return sph_error_set(error, SPH_ERR_PARSE,
                       "%s:%ld: columns with a %s between them; right are commas, and points in "
                       "decimals",
                       t->path, t->number, tab ? "tabulator" : "semicolon");
}

/* Opens the table and reads its header; t is there but where memory was not. */
static int start(table **to, const char *path, sph_error *error)
{
  table *t = *to = SPH_NEW(table, 1, "a line of a table", error);
  if (!t) return SPH_ERR_MEMORY;
  t->path = path ? path : "(none)";
  t->file = path ? fopen(path, "r") : NULL;
  if (!t->file)
    return sph_error_set(error, SPH_ERR_FILE, "cannot read %s: %s", t->path,
                         strerror(path ? errno : ENOENT));
  const int line = next_line(t);
  if (line && check_separator(t, error)) return SPH_ERR_PARSE;
  if (line && !is_row(t)) {
    t->columns = columns_of(t);
    return SPH_OK;
  }
  int status = all_read(t, error);
  if (!status && t->line[0])
    return sph_error_set(error, SPH_ERR_PARSE,
                         "%s:%ld: found numbers; the first line names the columns, as t [s],x [m]",
                         t->path, t->number);
  return status ? status : sph_error_set(error, SPH_ERR_PARSE, "%s: an empty table", t->path);
}

static void finish(table *t)
{
  if (t->file) fclose(t->file);
  sph_memory_free(t);
}

int sph_csv_name(const char *path, int k, char name[128], sph_error *error)
{
  table *t = NULL;
  int status = start(&t, path, error);
  if (status == SPH_ERR_MEMORY) return status;
  const char *at = status ? NULL : field(t, k);
  if (at) {
    size_t length = strcspn(at, ",[");
    while (length > 0 && (at[length - 1] == ' ' || at[length - 1] == '\t')) length--;
    snprintf(name, 128, "%.*s", (int)length, at);
  }
  finish(t);
  return status ? status : at != NULL;
}

int sph_csv_read_rows(const char *path, sph_csv_rows rows, const char *name, int column,
                      double **values, long *n, char title[128], sph_error *error)
{
  int where = -1;
  *values = NULL;
  *n = 0;
  table *t = NULL;
  int status = start(&t, path, error);
  if (status == SPH_ERR_MEMORY) return status;
  if (status == SPH_OK && rows.column) {
    where = find_column(t, rows.column, 0, title, error);
    status = where < 0 ? where : SPH_OK;
  }
  int found = status == SPH_OK ? find_column(t, name, column, title, error) : status;
  status = found < 0 ? found : read_values(t, where, rows.is, found, values, n, error);
  finish(t);
  if (status == SPH_OK) return status;
  sph_memory_free(*values);
  *values = NULL;
  *n = 0;
  return status;
}
