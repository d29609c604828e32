#include "case_schema.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "sphode/kernel.h"
#include "sphode/material.h"
#include "sphode/neighbors.h"
#include "sphode/shape.h"

static const sph_case_mapping mappings[] = {
#define SPH_CASE_MAPPING(mapping, one, about) {#mapping, one, about},
#define SPH_CASE_KEY(mapping, name, type, unit, standard, low, high, more, about)
#include "case_schema.def"
#undef SPH_CASE_MAPPING
#undef SPH_CASE_KEY
};

#define TINY DBL_MIN
static const sph_case_key keys[] = {
#define SPH_CASE_MAPPING(mapping, one, about)
#define SPH_CASE_KEY(mapping, name, type, unit, standard, low, high, more, about) \
  {#mapping, #name, SPH_CASE_##type##_T, unit, standard, low, high, more, about},
#include "case_schema.def"
#undef SPH_CASE_MAPPING
#undef SPH_CASE_KEY
};

enum { MAPPINGS = sizeof mappings / sizeof *mappings, KEYS = sizeof keys / sizeof *keys };

const sph_case_mapping *sph_case_schema_mapping(int k)
{
  return k < MAPPINGS ? mappings + k : NULL;
}
const sph_case_key *sph_case_schema_key(int k) { return k < KEYS ? keys + k : NULL; }

/* ---- words ---------------------------------------------------------------------------------- */

static const char *library_word(const char *table, int k, char word[80])
{
  const char *found = NULL;
  sph_integrator_info info;
  if (!strcmp(table, "@kernels")) found = sph_kernel_name(sph_kernel_get(k));
  if (!strcmp(table, "@searches")) found = sph_neighbors_search_name(k);
  if (!strcmp(table, "@boundaries")) found = sph_boundary_name(k);
  if (!strcmp(table, "@materials")) found = sph_material_name(k);
  if (!strcmp(table, "@lattices")) found = sph_shape_lattice_name(k);
  if (!strcmp(table, "@monitors")) found = sph_monitor_type(k);
  if (!strcmp(table, "@integrators") && sph_integrator_info_get(k, &info)) found = info.name;
  if (found) snprintf(word, 80, "%s", found);
  return found ? word : NULL;
}

const char *sph_case_schema_choice(const sph_case_key *key, int k, char word[80])
{
  if (key->more[0] == '@') return library_word(key->more, k, word);
  const char *at = key->more;
  for (; k > 0; k--) {
    at = strchr(at, '|');
    if (!at) return NULL;
    at++;
  }
  snprintf(word, 80, "%.*s", (int)strcspn(at, "|"), at);
  return word;
}

/* ---- errors --------------------------------------------------------------------------------- */

int sph_case_schema_fail(const sph_case *c, sph_error *error, const sph_case_node *node, int value,
                         int column, const char *format, ...)
{
  char what[700];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  int key = !value && node->key;
  int line = key ? node->key_line : node->line;
  int at = key ? node->key_column : node->column + column + node->quoted;
  if (line > 0)
    return sph_error_set(error, SPH_ERR_PARSE, "%s:%d:%d: %s", node->file ? node->file : c->path,
                         line, at, what);
  int set = node->origin && strcmp(node->origin, "default");
  return sph_error_set(error, SPH_ERR_PARSE, "%s: %s%s: %s", c->path, set ? "--set " : "",
                       set ? node->origin : "default", what);
}
