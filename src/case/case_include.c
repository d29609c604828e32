/* What stands later wins: included files in their order, then the file that includes them.
 * Mappings are joined key by key, unless exactly one key belongs there and it is another; all else
 * is replaced. */
#include "case_include.h"

#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_path.h"
#include "memory.h"

#define child_of sph_case_reader_find
#define FAIL(node, ...) sph_case_schema_fail(c, c->error, node, 1, 0, __VA_ARGS__)

/* A file being read, and those that include it. */
typedef struct chain {
  const char *path; /* as it is opened */
  char real[PATH_MAX];
  const struct chain *from;
} chain;

static int expand(sph_case *c, sph_case_node *root, const chain *from);

/* ---- joining */

static const sph_case_key *key_of(const char *mapping, const char *name)
{
  const sph_case_key *key;
  for (int k = 0; mapping && (key = sph_case_schema_key(k)); k++)
    if (!strcmp(key->mapping, mapping) && !strcmp(key->name, name)) return key;
  return NULL;
}

static int of_one(const char *mapping)
{
  const sph_case_mapping *m;
  for (int k = 0; mapping && (m = sph_case_schema_mapping(k)); k++)
    if (!strcmp(m->name, mapping)) return m->one;
  return 0;
}

/* The mapping that a value is, NULL: none that is known; names to mappings have `named`. */
static const char *inside(const char *mapping, const char *named, const char *key,
                          const char **names_to)
{
  *names_to = NULL;
  if (named) return named;
  const sph_case_key *k = key_of(mapping, key);
  if (k && k->type == SPH_CASE_NAMED_T) *names_to = k->more;
  return k && k->type == SPH_CASE_MAP_T ? k->more : NULL;
}

static int is_map(const sph_case_node *node)
{
  return node->kind == SPH_CASE_MAP ||
         (node->kind == SPH_CASE_SCALAR && !node->quoted && !node->text[0]);
}

static void as_map(sph_case_node *node)
{
  node->kind = SPH_CASE_MAP;
  sph_memory_free(node->text);
  node->text = NULL;
}

/* The first child, no longer one. */
static sph_case_node *take_first(sph_case_node *map)
{
  sph_case_node *child = map->first;
  map->first = child->next;
  if (!map->first) map->last = NULL;
  child->next = NULL;
  return child;
}

/* node becomes what `by` is, in its place; by is freed. */
static void replace(sph_case_node *node, sph_case_node *by)
{
  sph_case_node old = *node;
  *node = *by;
  node->next = old.next;
  *by = old;
  by->next = NULL;
  sph_case_reader_free(by);
}

/* over's children go to base, over stays empty. */
static void join(sph_case_node *base, sph_case_node *over, const char *mapping, const char *named)
{
  while (over->first) {
    const char *names_to;
    sph_case_node *child = take_first(over), *old = child_of(base, child->key);
    const char *below = inside(mapping, named, child->key, &names_to);
    if (!old) {
      sph_case_reader_append(base, child);
      continue;
    }
    const int maps = is_map(old) && is_map(child);
    const int another = maps && of_one(below) && old->first && child->first &&
                        strcmp(old->first->key, child->first->key) != 0;
    if (!maps || another) {
      replace(old, child);
      continue;
    }
    if (old->kind != SPH_CASE_MAP) as_map(old);
    if (child->kind != SPH_CASE_MAP) as_map(child);
    join(old, child, below, names_to);
    sph_case_reader_free(child);
  }
}

/* ---- files */

/* Names of files stand for files beside their own: here beside the case. */
static int mark(sph_case *c, sph_case_node *node, const char *file, const char *prefix)
{
  node->file = file;
  if (node->kind == SPH_CASE_SCALAR && node->key && prefix[0] && node->text[0] != '/' &&
      (!strcmp(node->key, "file") || !strcmp(node->key, "path"))) {
    char text[SPH_CASE_PATH];
    if (snprintf(text, sizeof text, "%s%s", prefix, node->text) >= (int)sizeof text)
      return sph_error_set(c->error, SPH_ERR_FILE, "%.100s...: path too long", node->text);
    char *copy = sph_memory_string(text, c->error);
    if (!copy) return SPH_ERR_MEMORY;
    sph_memory_free(node->text);
    node->text = copy;
  }
  int status = SPH_OK;
  for (sph_case_node *child = node->first; child && !status; child = child->next)
    status = mark(c, child, file, prefix);
  return status;
}

/* The directory of a file that is included by `by`, as names beside the case begin with it. */
static void prefix_of(const sph_case *c, const char *path, char prefix[SPH_CASE_PATH])
{
  const char *slash = strrchr(c->path, '/'), *end = strrchr(path, '/');
  const size_t beside = slash ? (size_t)(slash - c->path) + 1 : 0;
  const int below = !strncmp(path, c->path, beside);
  const char *from = below ? path + beside : path;
  snprintf(prefix, SPH_CASE_PATH, "%.*s", end && end + 1 > from ? (int)(end + 1 - from) : 0, from);
}

/* Reads the file of a node, with all that it includes; NULL: told. */
static sph_case_node *read_file(sph_case *c, const sph_case_node *node, chain *here)
{
  char prefix[SPH_CASE_PATH];
  sph_error e = {0};
  size_t size = 0;
  char *kept = sph_memory_string(here->path, c->error);
  if (!kept) return NULL;
  c->include[c->includes++] = kept;
  char *text = sph_case_reader_load(here->path, &size, &e);
  if (!text) {
    FAIL(node, "include: %s", e.text);
    return NULL;
  }
  sph_case_node *root = sph_case_reader_parse(here->path, text, size, c->error);
  sph_memory_free(text);
  prefix_of(c, here->path, prefix);
  int status = root ? mark(c, root, kept, prefix) : SPH_ERR_PARSE;
  if (!status && !is_map(root)) status = FAIL(root, "wanted a mapping (key: value)");
  if (!status) status = expand(c, root, here);
  if (!status) return root;
  sph_case_reader_free(root);
  return NULL;
}

/* Beside the file that the node stands in. */
static sph_case_node *open_file(sph_case *c, const sph_case_node *node, const chain *from)
{
  char path[SPH_CASE_PATH];
  chain here = {.path = path, .from = from};
  if (node->kind != SPH_CASE_SCALAR || !node->text[0]) {
    FAIL(node, "include: wanted the name of a file, or a list of them");
    return NULL;
  }
  if (c->includes == SPH_CASE_INCLUDES) {
    FAIL(node, "include: more than %d files", SPH_CASE_INCLUDES);
    return NULL;
  }
  const char *slash = strrchr(from->path, '/');
  const int beside = slash && node->text[0] != '/' ? (int)(slash - from->path) + 1 : 0;
  if (snprintf(path, sizeof path, "%.*s%s", beside, from->path, node->text) >= (int)sizeof path) {
    FAIL(node, "include: path too long");
    return NULL;
  }
  if (!realpath(path, here.real)) snprintf(here.real, sizeof here.real, "%s", path);
  for (const chain *above = from; above; above = above->from)
    if (!strcmp(above->real, here.real)) {
      FAIL(node, "include: %s includes itself, by way of this line; take one of them out", path);
      return NULL;
    }
  return read_file(c, node, &here);
}

/* Takes the key `include` out of a mapping; NULL: there is none. */
static sph_case_node *take_include(sph_case_node *root)
{
  sph_case_node *before = NULL, *node = root->first;
  for (; node && strcmp(node->key, "include"); node = node->next) before = node;
  if (!node) return NULL;
  if (before)
    before->next = node->next;
  else
    root->first = node->next;
  if (root->last == node) root->last = before;
  node->next = NULL;
  return node;
}

static int expand(sph_case *c, sph_case_node *root, const chain *from)
{
  sph_case_node *list = take_include(root);
  if (!list) return SPH_OK;
  sph_case_node whole = {.kind = SPH_CASE_MAP};
  const int several = list->kind == SPH_CASE_LIST;
  sph_case_node *one = several ? list->first : list;
  int status = SPH_OK;
  for (; one && !status; one = several ? one->next : NULL) {
    sph_case_node *file = open_file(c, one, from);
    if (file)
      join(&whole, file, "case", NULL);
    else
      status = c->error->status ? c->error->status : SPH_ERR_PARSE;
    sph_case_reader_free(file);
  }
  if (!status) {
    join(&whole, root, "case", NULL);
    root->first = whole.first;
    root->last = whole.last;
    whole.first = NULL;
  }
  for (sph_case_node *child = whole.first, *next; child; child = next) {
    next = child->next;
    sph_case_reader_free(child);
  }
  sph_case_reader_free(list);
  return status;
}

int sph_case_include(sph_case *c)
{
  chain here = {.path = c->path};
  if (c->root->kind != SPH_CASE_MAP || !child_of(c->root, "include")) return 0;
  if (!realpath(c->path, here.real)) snprintf(here.real, sizeof here.real, "%s", c->path);
  int status = expand(c, c->root, &here);
  return status ? status : 1;
}

/* ---- as a text */

static void write_scalar(const sph_case_node *node, sph_text *text)
{
  if (!node->quoted) {
    sph_text_add(text, "%s", node->text);
    return;
  }
  sph_text_add(text, "\"");
  for (const char *at = node->text; *at; at++) {
    if (*at == '\n')
      sph_text_add(text, "\\n");
    else if (*at == '"' || *at == '\\')
      sph_text_add(text, "\\%c", *at);
    else if ((unsigned char)*at < ' ' || *at == '\177')
      sph_text_add(text, "\\x%02x", (unsigned)*at);
    else
      sph_text_add(text, "%c", *at);
  }
  sph_text_add(text, "\"");
}

static void write_key(const char *key, sph_text *text)
{
  const sph_case_node node = {
      .text = (char *)key,
      .quoted =
          key[strspn(key, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")] !=
          0};
  write_scalar(&node, text);
}

/* Scalars in one line, the rest below, indented; lists of scalars in brackets. */
static void write_value(const sph_case_node *node, int depth, sph_text *text)
{
  if (node->kind == SPH_CASE_SCALAR) {
    sph_text_add(text, " ");
    write_scalar(node, text);
    sph_text_add(text, "\n");
    return;
  }
  if (!node->first)
    sph_text_add(text, node->kind == SPH_CASE_LIST ? " []\n" : " {}\n");
  else
    sph_text_add(text, "\n");
  for (const sph_case_node *child = node->first; child; child = child->next) {
    sph_text_add(text, "%*s", 2 * depth, "");
    if (node->kind == SPH_CASE_LIST)
      sph_text_add(text, "-");
    else {
      write_key(child->key, text);
      sph_text_add(text, ":");
    }
    write_value(child, depth + 1, text);
  }
}

void sph_case_include_write(const sph_case *c, sph_text *text) { write_value(c->root, 0, text); }
