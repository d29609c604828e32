#include "case_reader.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <yaml.h>

#include "memory.h"

/* Events, not libyaml's documents: those take minutes for 200 000 brackets, and expand aliases. */
typedef struct reader {
  const char *path, *text;
  yaml_parser_t yaml;
  yaml_event_t event; /* the present one */
  sph_error *error;
} reader;

static int fail_at(reader *r, yaml_mark_t mark, const char *what)
{
  return sph_error_set(r->error, SPH_ERR_PARSE, "%s:%d:%d: %s", r->path, (int)mark.line + 1,
                       (int)mark.column + 1, what);
}

static int fail(reader *r, const char *what) { return fail_at(r, r->event.start_mark, what); }

sph_case_node *sph_case_reader_new(enum sph_case_kind kind, const char *key, const char *text,
                                   sph_error *error)
{
  sph_case_node *node = SPH_NEW(sph_case_node, 1, "a node of the case", error);
  if (!node) return NULL;
  node->kind = kind;
  if (key) node->key = sph_memory_string(key, error);
  if (text) node->text = sph_memory_string(text, error);
  if ((!key || node->key) && (!text || node->text)) return node;
  sph_case_reader_free(node);
  return NULL;
}

void sph_case_reader_append(sph_case_node *parent, sph_case_node *child)
{
  if (parent->last)
    parent->last->next = child;
  else
    parent->first = child;
  parent->last = child;
}

void sph_case_reader_free(sph_case_node *node)
{
  if (!node) return;
  for (sph_case_node *child = node->first, *next; child; child = next) {
    next = child->next;
    sph_case_reader_free(child);
  }
  sph_memory_free(node->key);
  sph_memory_free(node->text);
  sph_memory_free(node);
}

sph_case_node *sph_case_reader_find(const sph_case_node *parent, const char *key)
{
  sph_case_node *child = parent ? parent->first : NULL;
  while (child && (!child->key || strcmp(child->key, key))) child = child->next;
  return child;
}

/* libyaml tells the byte that is no text, not its place: characters are counted here. */
static yaml_mark_t mark_of(const reader *r, size_t byte)
{
  yaml_mark_t mark = {0};
  for (size_t k = 0; k < byte; k++) {
    if (r->text[k] == '\n' || (r->text[k] == '\r' && k + 1 < byte && r->text[k + 1] != '\n')) {
      mark.line++;
      mark.column = 0;
    } else if (((unsigned char)r->text[k] & 0xc0) != 0x80) { /* not the rest of a character */
      mark.column++;
    }
  }
  return mark;
}

/* What it mostly means, and helps. */
static const char *remedy(const char *problem)
{
  if (strstr(problem, "mapping values are not allowed"))
    return "; a key has a space behind its ':', an expression with ': ' in it stands in quotes";
  if (strstr(problem, "cannot start any token"))
    return "; lines are indented with spaces, not tabs";
  return "";
}

static int advance(reader *r)
{
  yaml_event_delete(&r->event);
  memset(&r->event, 0, sizeof r->event);
  if (yaml_parser_parse(&r->yaml, &r->event)) return SPH_OK;
  const char *problem = r->yaml.problem ? r->yaml.problem : "not readable as YAML";
  char what[300];
  if (r->yaml.error == YAML_MEMORY_ERROR)
    return sph_error_set(r->error, SPH_ERR_MEMORY, "out of memory: reading %s", r->path);
  if (r->yaml.error == YAML_READER_ERROR) {
    snprintf(what, sizeof what, "%s; a case file is plain text in UTF-8", problem);
    return fail_at(r, mark_of(r, r->yaml.problem_offset), what);
  }
  snprintf(what, sizeof what, "not YAML: %s%s%s%s", problem, r->yaml.context ? ", " : "",
           r->yaml.context ? r->yaml.context : "", remedy(problem));
  return fail_at(r, r->yaml.problem_mark, what);
}

static int refuse(reader *r, const yaml_char_t *anchor, const yaml_char_t *tag)
{
  if (anchor) return fail(r, "found an anchor (&); write the value where it is used");
  if (tag) return fail(r, "found a tag (!); only plain mappings, lists and values are read");
  return SPH_OK;
}

static sph_case_node *value(reader *r, int depth);

static sph_case_node *place(reader *r, sph_case_node *node)
{
  if (!node) return NULL;
  node->line = (int)r->event.start_mark.line + 1;
  node->column = (int)r->event.start_mark.column + 1;
  return node;
}

static sph_case_node *scalar(reader *r)
{
  const char *text = (const char *)r->event.data.scalar.value;
  if (strlen(text) != r->event.data.scalar.length) {
    fail(r, "found a NUL character; a case file is plain text in UTF-8");
    return NULL;
  }
  if (refuse(r, r->event.data.scalar.anchor, r->event.data.scalar.tag)) return NULL;
  sph_case_node *node = place(r, sph_case_reader_new(SPH_CASE_SCALAR, NULL, text, r->error));
  if (node) node->quoted = r->event.data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
  return node;
}

static sph_case_node *list(reader *r, int depth)
{
  if (refuse(r, r->event.data.sequence_start.anchor, r->event.data.sequence_start.tag)) return NULL;
  sph_case_node *node = place(r, sph_case_reader_new(SPH_CASE_LIST, NULL, NULL, r->error));
  while (node) {
    if (advance(r)) break;
    if (r->event.type == YAML_SEQUENCE_END_EVENT) return node;
    sph_case_node *child = value(r, depth + 1);
    if (!child) break;
    sph_case_reader_append(node, child);
  }
  sph_case_reader_free(node);
  return NULL;
}

/* The key that the present event is; NULL with an error. */
static sph_case_node *key_of(reader *r, const sph_case_node *map)
{
  if (r->event.type == YAML_ALIAS_EVENT) return value(r, 0);
  if (r->event.type != YAML_SCALAR_EVENT) {
    fail(r, "found a list or a mapping as a key; a key is a word");
    return NULL;
  }
  sph_case_node *key = scalar(r);
  const sph_case_node *old = key ? sph_case_reader_find(map, key->text) : NULL;
  if (!old) return key;
  char what[200];
  snprintf(what, sizeof what, "duplicate key '%.60s'; it stands already in line %d", key->text,
           old->key_line);
  fail(r, what);
  sph_case_reader_free(key);
  return NULL;
}

static sph_case_node *pair(reader *r, const sph_case_node *map, int depth)
{
  sph_case_node *key = key_of(r, map), *node = NULL;
  if (key && !advance(r)) node = value(r, depth + 1);
  if (node) {
    node->key = key->text;
    key->text = NULL;
    node->key_line = key->line;
    node->key_column = key->column;
  }
  sph_case_reader_free(key);
  return node;
}

static sph_case_node *map(reader *r, int depth)
{
  if (refuse(r, r->event.data.mapping_start.anchor, r->event.data.mapping_start.tag)) return NULL;
  sph_case_node *node = place(r, sph_case_reader_new(SPH_CASE_MAP, NULL, NULL, r->error));
  while (node) {
    if (advance(r)) break;
    if (r->event.type == YAML_MAPPING_END_EVENT) return node;
    sph_case_node *child = pair(r, node, depth);
    if (!child) break;
    sph_case_reader_append(node, child);
  }
  sph_case_reader_free(node);
  return NULL;
}

/* The value that begins at the present event. */
static sph_case_node *value(reader *r, int depth)
{
  if (depth > SPH_CASE_DEPTH) {
    fail(r, "nested deeper than 32 levels; a case needs 6");
    return NULL;
  }
  switch (r->event.type) {
  case YAML_SCALAR_EVENT: return scalar(r);
  case YAML_SEQUENCE_START_EVENT: return list(r, depth);
  case YAML_MAPPING_START_EVENT: return map(r, depth);
  case YAML_ALIAS_EVENT: fail(r, "found an alias (*); write the value where it is used"); break;
  default: fail(r, "found nothing; a case is a mapping of keys to values"); break;
  }
  return NULL;
}

static sph_case_node *document(reader *r)
{
  do /* to the first value, or to the end of an empty stream */
    if (advance(r)) return NULL;
  while (r->event.type == YAML_STREAM_START_EVENT || r->event.type == YAML_DOCUMENT_START_EVENT);
  sph_case_node *root = value(r, 0);
  if (!root) return NULL;
  do
    if (advance(r)) goto failed;
  while (r->event.type == YAML_DOCUMENT_END_EVENT);
  if (r->event.type == YAML_STREAM_END_EVENT) return root;
  fail(r, "found a second document; a file holds one case");
failed:
  sph_case_reader_free(root);
  return NULL;
}

sph_case_node *sph_case_reader_parse(const char *path, const char *text, size_t size,
                                     sph_error *error)
{
  reader r = {.path = path, .text = text, .error = error};
  if (size > SPH_CASE_BYTES) {
    sph_error_set(error, SPH_ERR_PARSE, "%s: %zu bytes; a case file has at most 1 MiB", path, size);
    return NULL;
  }
  if (!yaml_parser_initialize(&r.yaml)) {
    sph_error_set(error, SPH_ERR_MEMORY, "out of memory: reading %s", path);
    return NULL;
  }
  yaml_parser_set_input_string(&r.yaml, (const unsigned char *)text, size);
  yaml_parser_set_encoding(&r.yaml, YAML_UTF8_ENCODING);
  sph_case_node *root = document(&r);
  yaml_event_delete(&r.event);
  yaml_parser_delete(&r.yaml);
  return root;
}

char *sph_case_reader_load(const char *path, size_t *size, sph_error *error)
{
  FILE *file = path ? fopen(path, "rb") : NULL;
  char *text = NULL;
  *size = 0;
  if (!path) {
    sph_error_set(error, SPH_ERR_ARGUMENT, "a case: no path (NULL)");
    return NULL;
  }
  if (!file) {
    sph_error_set(error, SPH_ERR_FILE, "%s: cannot open: %s", path, strerror(errno));
    return NULL;
  }
  /* One byte more than allowed: a longer file is seen without asking for its size (pipes have
   * none). */
  text = SPH_NEW(char, SPH_CASE_BYTES + 2, "the case file", error);
  if (!text) goto done;
  *size = fread(text, 1, SPH_CASE_BYTES + 1, file);
  if (ferror(file))
    sph_error_set(error, SPH_ERR_FILE, "%s: cannot read: %s", path, strerror(errno));
  else if (*size > SPH_CASE_BYTES)
    sph_error_set(error, SPH_ERR_PARSE, "%s: larger than 1 MiB; a case file has a few kB", path);
  else
    goto done;
  sph_memory_free(text);
  text = NULL;
done:
  fclose(file);
  return text;
}

double sph_case_reader_number(const sph_case_node *map, const char *key, double standard)
{
  const sph_case_node *node = sph_case_reader_find(map, key);
  return node ? node->number : standard;
}

const char *sph_case_reader_text(const sph_case_node *map, const char *key, const char *standard)
{
  const sph_case_node *node = sph_case_reader_find(map, key);
  return node ? node->text : standard;
}

int sph_case_reader_vector(const sph_case_node *map, const char *key, double values[3])
{
  const sph_case_node *list = sph_case_reader_find(map, key), *child = list ? list->first : NULL;
  values[0] = values[1] = values[2] = 0;
  for (int d = 0; d < 3 && child; d++, child = child->next) values[d] = child->number;
  return list != NULL;
}
