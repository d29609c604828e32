#include "sphode/case.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_include.h"
#include "case_schema.h"
#include "case_set.h"
#include "memory.h"
#include "snapshot.h"
#include "text.h"

static void set_origin(sph_case_node *node, const char *origin)
{
  node->origin = origin;
  node->line = node->column = node->key_line = 0;
  for (sph_case_node *child = node->first; child; child = child->next) set_origin(child, origin);
}

/* The child that a word of a path names: a key, or in a list a number from 0. */
static sph_case_node *descend(const sph_case_node *node, const char *word)
{
  if (node->kind != SPH_CASE_LIST) return sph_case_reader_find(node, word);
  char *end;
  long k = strtol(word, &end, 10);
  sph_case_node *child = *word && !*end && k >= 0 ? node->first : NULL;
  for (; child && k > 0; k--) child = child->next;
  return child;
}

/* A mapping, as "conduction:" with nothing behind it is one, too. */
static int may_have_keys(sph_case_node *node)
{
  if (node->kind == SPH_CASE_SCALAR && !node->quoted && !node->text[0]) node->kind = SPH_CASE_MAP;
  return node->kind == SPH_CASE_MAP;
}

/* Takes the content of `given`, keeps the place among its siblings. */
static void replace(sph_case_node *node, sph_case_node *given)
{
  sph_case_node old = *node;
  *node = *given;
  node->key = old.key;
  node->next = old.next;
  *given = old;
  given->key = NULL;
  given->next = NULL;
}

static int put(sph_case *c, const char *set, char *path, sph_case_node *given)
{
  sph_case_node *node = c->root;
  for (char *word = path, *dot; word; word = dot) {
    dot = strchr(word, '.');
    if (dot) *dot++ = 0;
    sph_case_node *child = descend(node, word);
    if (!child && !may_have_keys(node))
      return sph_error_set(c->error, SPH_ERR_PARSE, "%s: --set %s: there is no '%s'", c->path, set,
                           word);
    if (!child) {
      child = sph_case_reader_new(SPH_CASE_MAP, word, NULL, c->error);
      if (!child) return SPH_ERR_MEMORY;
      child->origin = set;
      sph_case_reader_append(node, child);
    }
    node = child;
  }
  replace(node, given);
  return SPH_OK;
}

/* "dx=1cm" is a parameter where there is one of that name and no such key of the file. */
static int is_parameter(const sph_case *c, const char *set, const char *end)
{
  char name[60];
  if ((size_t)(end - set) >= sizeof name || c->root->kind != SPH_CASE_MAP) return 0;
  snprintf(name, sizeof name, "%.*s", (int)(end - set), set);
  for (int k = 0; sph_case_schema_key(k); k++)
    if (!strcmp(sph_case_schema_key(k)->mapping, "case") &&
        !strcmp(sph_case_schema_key(k)->name, name))
      return 0;
  return sph_case_reader_find(sph_case_reader_find(c->root, "parameters"), name) != NULL;
}

static int apply(sph_case *c, const char *set)
{
  const char *value = strchr(set, '=');
  char path[200], where[500];
  if (!value || value == set || (size_t)(value - set) >= sizeof path - 20)
    return sph_error_set(c->error, SPH_ERR_PARSE, "--set %.100s: wanted key=value, as spacing=1cm",
                         set);
  snprintf(path, sizeof path, "%s%.*s", is_parameter(c, set, value) ? "parameters." : "",
           (int)(value - set), set);
  snprintf(where, sizeof where, "%s: --set %.200s: in its value", c->path, set);
  const char *text = value + 1 + strspn(value + 1, " \t");
  sph_case_node *given = *text ? sph_case_reader_parse(where, text, strlen(text), c->error)
                               : sph_case_reader_new(SPH_CASE_SCALAR, NULL, "", c->error);
  if (!given) return c->error->status;
  set_origin(given, set);
  static const char of_parameters[] = "parameters.";
  const size_t n = strlen(of_parameters);
  int status = strncmp(path, of_parameters, n) ? SPH_OK : sph_case_set_unit(c, path + n, given);
  if (!status) status = put(c, set, path, given);
  sph_case_reader_free(given);
  return status;
}

/* A copy of what was gathered, NULL with an error; text is freed. */
static char *taken(sph_text *text, sph_error *error)
{
  char *copy = NULL;
  if (text->error.status)
    sph_error_set(error, text->error.status, "%s", text->error.text);
  else
    copy = sph_memory_string(text->data ? text->data : "", error);
  sph_text_free(text);
  return copy;
}

/* What was read: of one file its text, of several the joined tree. */
static char *source_of(const sph_case *c, int joined, const char *text, size_t size,
                       sph_error *error)
{
  sph_text source = {0};
  if (!joined) {
    sph_text_append(&source, text, size);
    return taken(&source, error);
  }
  sph_text_add(&source, "# %s", c->path);
  for (int k = 0; k < c->includes; k++) sph_text_add(&source, ", %s", c->include[k]);
  sph_text_add(&source, " joined");
  sph_case_include_write(c, &source);
  return taken(&source, error);
}

/* The tree as it was set, with what was set in comments in front; no paths, which a restart may
 * have others of. */
static char *text_of(const sph_case *c, sph_error *error)
{
  sph_text text = {0};
  for (int k = 0; k < SPH_CASE_SETS && c->set[k]; k++) {
    sph_text_add(&text, "# --set ");
    for (const char *at = c->set[k]; *at; at++)
      sph_text_add(&text, "%c", (unsigned char)*at < ' ' ? ' ' : *at);
    sph_text_add(&text, "\n");
  }
  sph_case_include_write(c, &text);
  return taken(&text, error);
}

static int check_given(const char *path, const char *text, int n, const char *const *set,
                       sph_error *error)
{
  if (!path) return sph_error_set(error, SPH_ERR_ARGUMENT, "a case: no path (NULL)");
  if (!text) return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: no text (NULL)", path);
  if (n < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: %d settings; right is >= 0", path, n);
  if (n > 0 && !set)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: %d settings at NULL", path, n);
  for (int k = 0; k < n; k++)
    if (!set[k])
      return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: setting %d is NULL; key=value is right",
                           path, k);
  return error->status;
}

sph_case *sph_case_read_text(const char *path, const char *text, size_t size, int n,
                             const char *const *set, sph_error *error)
{
  static const char mark[] = "\xef\xbb\xbf"; /* some editors begin UTF-8 with it */
  sph_error own = {0};
  if (!error) error = &own;
  if (check_given(path, text, n, set, error)) return NULL;
  if (size >= 3 && !memcmp(text, mark, 3)) text += 3, size -= 3;
  sph_case *c = SPH_NEW(sph_case, 1, "a case", error);
  if (!c) return NULL;
  c->error = error;
  c->path = sph_memory_string(path, error);
  if (c->path) c->root = sph_case_reader_parse(c->path, text, size, error);
  const int joined = c->root ? sph_case_include(c) : SPH_ERR_PARSE;
  if (joined >= 0) c->source = source_of(c, joined, text, size, error);
  if (n > SPH_CASE_SETS)
    sph_error_set(error, SPH_ERR_PARSE, "%d times --set; at most %d", n, SPH_CASE_SETS);
  for (int k = 0; k < n && c->root && !error->status; k++) {
    c->set[k] = sph_memory_string(set[k], error); /* messages point to it later, too */
    if (c->set[k]) apply(c, c->set[k]);
  }
  if (n > 0 && !error->status) c->text = text_of(c, error);
  if (!error->status) sph_case_check(c);
  c->error = NULL;
  if (!error->status) return c;
  sph_case_free(c);
  return NULL;
}

sph_case *sph_case_read(const char *path, int n, const char *const *set, sph_error *error)
{
  sph_error own = {0};
  if (!error) error = &own;
  size_t size;
  char *text = sph_case_reader_load(path, &size, error);
  sph_case *c = text ? sph_case_read_text(path, text, size, n, set, error) : NULL;
  sph_memory_free(text);
  return c;
}

void sph_case_free(sph_case *c)
{
  if (!c) return;
  sph_case_reader_free(c->root);
  for (int k = 0; k < SPH_CASE_SETS; k++) sph_memory_free(c->set[k]);
  for (int k = c->n; k < c->timed_n; k++) sph_case_table_free(c->timed[k].table);
  for (int k = 0; k < c->includes; k++) sph_memory_free(c->include[k]);
  sph_memory_free(c->path);
  sph_memory_free(c->text);
  sph_memory_free(c->source);
  sph_memory_free(c);
}

static const sph_case_node *find(const sph_case *c, const char *mapping, const char *key)
{
  return c ? sph_case_reader_find(sph_case_reader_find(c->root, mapping), key) : NULL;
}

const char *sph_case_title(const sph_case *c)
{
  const sph_case_node *title = c ? sph_case_reader_find(c->root, "title") : NULL;
  return title ? title->text : "";
}

const char *sph_case_text(const sph_case *c) { return !c ? "" : c->text ? c->text : c->source; }

const char *sph_case_source(const sph_case *c) { return c ? c->source : ""; }

const char *sph_case_set(const sph_case *c, int k)
{
  return c && k >= 0 && k < SPH_CASE_SETS ? c->set[k] : NULL;
}

double sph_case_time_limit(const sph_case *c)
{
  const sph_case_node *limit = find(c, "run", "time_limit");
  return limit ? limit->number : 0;
}

double sph_case_end(const sph_case *c)
{
  const sph_case_node *end = find(c, "run", "end");
  return end ? end->number : 0;
}

const char *sph_case_plot_field(const sph_case *c)
{
  const sph_case_node *field = find(c, "plot", "field"), *written = find(c, "output", "fields");
  if (field) return field->text;
  if (!c) return "";
  return sph_snapshot_holds(written ? written->text : NULL, "velocity") ? "velocity" : "density";
}

int sph_case_plot_frames(const sph_case *c)
{
  const sph_case_node *frames = find(c, "plot", "frames");
  return frames ? (int)frames->number : 0;
}
