/* The check of a case against the schema: it reads top down, stops at the first error, leaves
 * behind a tree in which every key with a default is present and every number is evaluated. */
#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_curve.h"
#include "case_event.h"
#include "case_material.h"
#include "case_scalar.h"
#include "case_schema.h"
#include "case_solution.h"
#include "sphode/case.h"
#include "words.h"

static int check_value(sph_case *c, const sph_case_key *key, sph_case_node *node);
static const sph_case_key *find_key(const char *mapping, const char *name);
static int check_map(sph_case *c, const char *mapping, sph_case_node *node);

#define FAIL(node, column, ...) sph_case_schema_fail(c, c->error, node, 1, column, __VA_ARGS__)
#define FAIL_KEY(node, ...) sph_case_schema_fail(c, c->error, node, 0, 0, __VA_ARGS__)

/* ---- words */

static int check_word(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  char word[80];
  sph_words w = {.wanted = node->text};
  for (int k = 0; sph_case_schema_choice(key, k, word); k++) {
    if (!strcmp(node->text, word)) return SPH_OK;
    sph_words_add(&w, word);
  }
  sph_integrator_missing missing;
  for (int k = 0; !strcmp(key->more, "@integrators") && sph_integrator_missing_get(k, &missing);
       k++)
    if (!strcmp(node->text, missing.name))
      return FAIL(node, 0, "%s: %s needs %s", key->name, missing.name, missing.needs);
  return FAIL(node, 0, "%s: found '%.40s'; %sknown: %s", key->name, node->text, w.nearest, w.known);
}

/* What others call it; NULL: nothing of this mapping. */
static const char *alias(const char *mapping, const char *key)
{
  static const struct {
    const char *key, *right;
  } table[] = {
      {"sphere", "ball"},    {"circle", "ball"},   {"disc", "ball"},
      {"disk", "ball"},      {"rectangle", "box"}, {"cube", "box"},
      {"cuboid", "box"},     {"square", "box"},    {"subtract", "difference"},
      {"cut", "difference"}, {"stl", "surface"},   {"mesh", "surface"},
      {"walls", "layers"},   {"dx", "spacing"},    {"resolution", "spacing"},
      {"dim", "dimension"},  {"time", "end"},      {"t_end", "end"},
      {"duration", "end"},   {"g", "gravity"},     {"viscosity", "viscosity-laminar"},
      {"rho", "density"},    {"rho0", "density"},  {"type", "kind"},
      {"c0", "sound_speed"},
  };
  for (size_t k = 0; k < sizeof table / sizeof *table; k++)
    if (!strcmp(table[k].key, key) && find_key(mapping, table[k].right)) return table[k].right;
  return NULL;
}

static int unknown_key(sph_case *c, const char *mapping, const sph_case_node *node)
{
  sph_words w = {.wanted = node->key};
  for (int k = 0; sph_case_schema_key(k); k++)
    if (!strcmp(sph_case_schema_key(k)->mapping, mapping))
      sph_words_add(&w, sph_case_schema_key(k)->name);
  const char *other = alias(mapping, node->key);
  if (other) snprintf(w.nearest, sizeof w.nearest, "did you mean '%s'? ", other);
  return FAIL_KEY(node, "unknown key '%.40s' in %s; %sknown: %s", node->key, mapping, w.nearest,
                  w.known[0] ? w.known : "none");
}

/* ---- numbers */

/* The unit of a checked value: a plain number is taken as SI, zero fits all. */
static int check_unit(sph_case *c, const sph_case_key *key, const sph_case_node *node,
                      const sph_case_value *value)
{
  sph_si_unit unit = {.factor = 1};
  double off = 0, dimension = 0;
  if (!strcmp(key->unit, "any") || value->any) return SPH_OK;
  if (strcmp(key->unit, "1")) {
    int inverse = key->unit[0] == '1'; /* "1/s" */
    sph_si_unit_parse(key->unit + 2 * inverse, NULL, NULL, &unit);
    for (int b = 0; b < SPH_SI_BASES && inverse; b++) unit.power[b] = -unit.power[b];
  }
  for (int b = 0; b < SPH_SI_BASES; b++) {
    dimension += fabs(value->power[b]);
    off += fabs(value->power[b] - unit.power[b]);
  }
  if (dimension == 0 || off < 1e-6) return SPH_OK;
  char found[80];
  sph_si_unit_write(value->power, found, sizeof found);
  return FAIL(node, 0, "%s: found %s, wanted %s", key->name, found,
              strcmp(key->unit, "1") ? key->unit : "a plain number");
}

static int check_range(sph_case *c, const sph_case_key *key, const sph_case_node *node)
{
  const char *unit = strcmp(key->unit, "1") && strcmp(key->unit, "any") ? key->unit : "";
  const char *gap = unit[0] ? " " : "";
  if (node->number >= key->low && node->number <= key->high) return SPH_OK;
  if (key->low == DBL_MIN && isinf(key->high))
    return FAIL(node, 0, "%s: found %g%s%s; must be > 0", key->name, node->number, gap, unit);
  if (isinf(key->high))
    return FAIL(node, 0, "%s: found %g%s%s; must be >= %g", key->name, node->number, gap, unit,
                key->low);
  if (key->low == DBL_MIN)
    return FAIL(node, 0, "%s: found %g%s%s; must be > 0 and at most %g", key->name, node->number,
                gap, unit, key->high);
  return FAIL(node, 0, "%s: found %g%s%s; must be from %g to %g", key->name, node->number, gap,
              unit, key->low, key->high);
}

static int not_scalar(sph_case *c, const sph_case_key *key, const sph_case_node *node,
                      const char *wanted)
{
  static const char *const kind[] = {"a value", "a mapping", "a list"};
  if (node->kind == SPH_CASE_SCALAR) return SPH_OK;
  return FAIL(node, 0, "%s: found %s, wanted %s", key->name, kind[node->kind], wanted);
}

static int check_number(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  sph_case_value value;
  int n = c->n;
  if (not_scalar(c, key, node, "a number")) return SPH_ERR_PARSE;
  if (key->type == SPH_CASE_LARGEST_T) {
    static char largest[] = "largest";
    c->names[n++] = (sph_case_name){.name = largest, .value = 2.7}; /* anything positive */
  }
  if (sph_case_value_evaluate(node->text, c->names, n, &value))
    return FAIL(node, value.column, "%s: %s", key->name, value.problem);
  node->number = value.value;
  if (check_unit(c, key, node, &value)) return SPH_ERR_PARSE;
  return key->type == SPH_CASE_LARGEST_T ? SPH_OK : check_range(c, key, node);
}

static int check_count(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  sph_case_key plain = *key;
  plain.unit = "1";
  int status = check_number(c, &plain, node);
  if (!status && node->number != rint(node->number))
    return FAIL(node, 0, "%s: found %g, wanted a whole number", key->name, node->number);
  return status;
}

static int check_field(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  sph_case_value value;
  if (not_scalar(c, key, node, "an expression")) return SPH_ERR_PARSE;
  const int dim = key->type == SPH_CASE_MOMENT_T ? 0 : c->dim;
  if (key->type == SPH_CASE_FIELD_T
          ? sph_case_value_field_unit(node->text, c->names, c->n, dim, &value)
          : sph_case_value_formula_unit(node->text, c->timed, c->timed_n, dim, &value))
    return FAIL(node, value.column, "%s: %s", key->name, value.problem);
  int status = check_unit(c, key, node, &value);
  if (status || key->low >= key->high ||
      sph_case_value_evaluate(node->text, c->names, c->n, &value))
    return status;
  node->number = value.value; /* a constant after all */
  return check_range(c, key, node);
}

static int check_texts(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  int status = SPH_OK;
  if (node->kind != SPH_CASE_LIST) return not_scalar(c, key, node, "a text or a list of texts");
  for (sph_case_node *child = node->first; child && !status; child = child->next)
    status = not_scalar(c, key, child, "a text");
  return status;
}

/* ---- parameters */

int sph_case_check_name(sph_case *c, const sph_case_node *node)
{
  static const char *const taken[] = {"x", "y", "z", "t", "pi", "largest"};
  const char *name = node->key;
  size_t n = strlen(name);
  int word = n > 0 && n <= 40 && (isalpha((unsigned char)name[0]) || name[0] == '_');
  for (size_t k = 0; k < n; k++) word = word && (isalnum((unsigned char)name[k]) || name[k] == '_');
  if (!word)
    return FAIL_KEY(node, "'%.40s' cannot be a name in expressions; letters, digits and _ can",
                    name);
  for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
    if (!strcmp(name, taken[k]))
      return FAIL_KEY(node, "'%s' has a meaning of its own; choose another name", name);
  if (strcmp(name, "g") && sph_si_unit_known(name, n))
    return FAIL_KEY(node, "'%s' is a unit; choose another name", name);
  return SPH_OK;
}

/* Where a name stands in an expression as a word; NULL: it does not. */
static const char *word_in(const char *text, const char *name)
{
  const size_t n = strlen(name);
  for (const char *at = text; n > 0 && (at = strstr(at, name)); at++) {
    const int before = at > text && (isalnum((unsigned char)at[-1]) || at[-1] == '_');
    if (!before && !isalnum((unsigned char)at[n]) && at[n] != '_') return at;
  }
  return NULL;
}

/* An expression that is none: does it use itself, or what is defined further down? */
static int fail_parameter(sph_case *c, const sph_case_node *child, const sph_case_value *value)
{
  for (const sph_case_node *next = child; next; next = next->next) {
    const char *at = word_in(child->text, next->key);
    if (!at || at - child->text != value->column) continue;
    if (next == child) return FAIL(child, value->column, "%s: it is defined by itself", child->key);
    return FAIL(child, value->column,
                "%s: '%.40s' is defined below, on line %d; right is above what uses it", child->key,
                next->key, next->key_line);
  }
  return FAIL(child, value->column, "%s: %s", child->key, value->problem);
}

static int check_parameters(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  if (node->kind != SPH_CASE_MAP)
    return FAIL(node, 0, "%s: wanted a mapping of names to numbers", key->name);
  for (sph_case_node *child = node->first; child; child = child->next) {
    sph_case_value value;
    const sph_case_key one = {.name = child->key};
    if (sph_case_check_name(c, child) || not_scalar(c, &one, child, "a number"))
      return SPH_ERR_PARSE;
    if (c->n >= SPH_CASE_NAMES - 1) return FAIL_KEY(child, "more than %d parameters", c->n);
    if (sph_case_value_evaluate(child->text, c->names, c->n, &value))
      return fail_parameter(c, child, &value);
    sph_case_name *name = &c->names[c->n++];
    *name = (sph_case_name){.name = child->key, .value = value.value};
    memcpy(name->power, value.power, sizeof name->power);
  }
  return SPH_OK;
}

/* ---- lists and mappings */

/* count items of the type `one`; count < 0: any number. */
static int check_list(sph_case *c, const sph_case_key *key, enum sph_case_type one, int count,
                      sph_case_node *node)
{
  sph_case_key item = *key;
  int n = 0;
  item.type = one;
  if (node->kind != SPH_CASE_LIST && count >= 0)
    return FAIL(node, 0, "%s: wanted a list of %d, as [%s]", key->name, count,
                count == 1   ? "1"
                : count == 2 ? "1, 2"
                             : "1, 2, 3");
  if (node->kind != SPH_CASE_LIST)
    return FAIL(node, 0, "%s: found %s, wanted a list: [...], or lines that begin with -",
                key->name, node->kind == SPH_CASE_MAP ? "a mapping" : "a value");
  for (sph_case_node *child = node->first; child; child = child->next, n++)
    if (check_value(c, &item, child)) return SPH_ERR_PARSE;
  if (count >= 0 && n != count)
    return FAIL(node, 0, "%s: found %d values, wanted %d", key->name, n, count);
  return SPH_OK;
}

static int check_named(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  if (node->kind != SPH_CASE_MAP || !node->first)
    return FAIL(node, 0, "%s: wanted a mapping of names to %ss", key->name, key->more);
  for (sph_case_node *child = node->first; child; child = child->next)
    if (check_map(c, key->more, child)) return SPH_ERR_PARSE;
  return SPH_OK;
}

static int check_flag(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  node->number = !strcmp(node->text, "true");
  if (node->number != 0 || !strcmp(node->text, "false")) return SPH_OK;
  return FAIL(node, 0, "%s: found '%.40s', wanted true or false", key->name, node->text);
}

static int check_value(sph_case *c, const sph_case_key *key, sph_case_node *node)
{
  switch (key->type) {
  case SPH_CASE_MAP_T: return check_map(c, key->more, node);
  case SPH_CASE_LIST_T: return check_list(c, key, SPH_CASE_MAP_T, -1, node);
  case SPH_CASE_NAMED_T: return check_named(c, key, node);
  case SPH_CASE_PARAMETERS_T: return check_parameters(c, key, node);
  case SPH_CASE_TEXT_T: return not_scalar(c, key, node, "a text");
  case SPH_CASE_WORD_T: return not_scalar(c, key, node, "a word") || check_word(c, key, node);
  case SPH_CASE_WORDS_T: return check_list(c, key, SPH_CASE_WORD_T, -1, node);
  case SPH_CASE_FLAG_T:
    return not_scalar(c, key, node, "true or false") || check_flag(c, key, node);
  case SPH_CASE_COUNT_T: return check_count(c, key, node);
  case SPH_CASE_NUMBER_T:
  case SPH_CASE_LARGEST_T: return check_number(c, key, node);
  case SPH_CASE_VECTOR_T: return check_list(c, key, SPH_CASE_NUMBER_T, c->dim, node);
  case SPH_CASE_PAIR_T: return check_list(c, key, SPH_CASE_NUMBER_T, 2, node);
  case SPH_CASE_NUMBERS_T: return check_list(c, key, SPH_CASE_NUMBER_T, -1, node);
  case SPH_CASE_POINTS_T: return check_list(c, key, SPH_CASE_PAIR_T, -1, node);
  case SPH_CASE_FIELD_T:
  case SPH_CASE_FORMULA_T:
  case SPH_CASE_MOMENT_T: return check_field(c, key, node);
  case SPH_CASE_FORMULAS_T: return check_list(c, key, SPH_CASE_FORMULA_T, c->dim, node);
  case SPH_CASE_MOMENTS_T: return check_list(c, key, SPH_CASE_MOMENT_T, c->dim, node);
  case SPH_CASE_TEXTS_T: return check_texts(c, key, node);
  case SPH_CASE_SOURCE_T: return not_scalar(c, key, node, "an expression");
  case SPH_CASE_FIELDS_T: return check_list(c, key, SPH_CASE_FIELD_T, c->dim, node);
  }
  return SPH_ERR_STATE;
}

static const sph_case_key *find_key(const char *mapping, const char *name)
{
  const sph_case_key *key;
  for (int k = 0; (key = sph_case_schema_key(k)); k++)
    if (!strcmp(key->mapping, mapping) && !strcmp(key->name, name)) return key;
  return NULL;
}

static int add_default(sph_case *c, const sph_case_key *key, sph_case_node *map)
{
  int is_map = key->type == SPH_CASE_MAP_T;
  sph_case_node *node = sph_case_reader_new(is_map ? SPH_CASE_MAP : SPH_CASE_SCALAR, key->name,
                                            is_map ? NULL : key->standard, c->error);
  if (!node) return SPH_ERR_MEMORY;
  node->origin = "default";
  sph_case_reader_append(map, node);
  return check_value(c, key, node);
}

static int complete(sph_case *c, const char *mapping, sph_case_node *map)
{
  const sph_case_key *key;
  for (int k = 0; (key = sph_case_schema_key(k)); k++) {
    if (strcmp(key->mapping, mapping) || sph_case_reader_find(map, key->name)) continue;
    if (!key->standard)
      return FAIL_KEY(map, "missing key '%s' in %s: %s", key->name, map->key ? map->key : mapping,
                      key->about);
    if (key->standard[0] && add_default(c, key, map)) return c->error->status;
  }
  return SPH_OK;
}

static int check_one(sph_case *c, const char *mapping, const sph_case_node *map)
{
  char known[300] = "";
  const sph_case_key *key;
  if (map->first && !map->first->next) return SPH_OK;
  for (int k = 0; (key = sph_case_schema_key(k)); k++) {
    size_t n = strlen(known);
    if (!strcmp(key->mapping, mapping))
      snprintf(known + n, sizeof known - n, "%s%s", n ? ", " : "", key->name);
  }
  return FAIL_KEY(map, "%s: found %s; exactly one of these belongs here: %s", mapping,
                  map->first ? "several keys" : "nothing", known);
}

static int is_one(const char *mapping)
{
  const sph_case_mapping *m;
  for (int k = 0; (m = sph_case_schema_mapping(k)); k++)
    if (!strcmp(m->name, mapping)) return m->one;
  return 0;
}

static int check_map(sph_case *c, const char *mapping, sph_case_node *node)
{
  if (node->kind == SPH_CASE_SCALAR && !node->quoted && !node->text[0]) node->kind = SPH_CASE_MAP;
  if (node->kind != SPH_CASE_MAP)
    return FAIL(node, 0, "%s: found %s, wanted a mapping (key: value)",
                node->key ? node->key : mapping,
                node->kind == SPH_CASE_LIST ? "a list" : "a value");
  for (sph_case_node *child = node->first; child; child = child->next) {
    const sph_case_key *key = find_key(mapping, child->key);
    if (!key) return unknown_key(c, mapping, child);
    if (key->type == SPH_CASE_PARAMETERS_T) continue; /* done before, as tables are */
    if (!strcmp(mapping, "case") && !strcmp(key->name, "tables")) continue;
    if (check_value(c, key, child)) return c->error->status;
  }
  return is_one(mapping) ? check_one(c, mapping, node) : complete(c, mapping, node);
}

/* ---- what no key alone can tell */

static int check_fluid(sph_case *c)
{
  const sph_case_node *groups = sph_case_reader_find(c->root, "groups"), *group = groups->first;
  while (group && strcmp(sph_case_reader_text(group, "kind", ""), "fluid")) group = group->next;
  if (group) return SPH_OK;
  return FAIL_KEY(groups, "groups: no fluid among them; at least one has kind: fluid");
}

/* Density and pressure must be partners, or energy is not conserved. */
static int check_forms(sph_case *c)
{
  static const char *const partner[][2] = {{"c2", "c2"}, {"c1", "s"}, {"phi", "phi"}};
  const sph_case_node *terms = sph_case_reader_find(c->root, "terms");
  const sph_case_node *continuity = sph_case_reader_find(terms, "continuity");
  const sph_case_node *one = sph_case_reader_find(continuity, "form");
  const sph_case_node *summation = sph_case_reader_find(terms, "summation");
  const sph_case_node *other =
      sph_case_reader_find(sph_case_reader_find(terms, "pressure"), "form");
  if (summation && continuity)
    return FAIL_KEY(summation, "summation: density is that of continuity already; one of them");
  const char *row = summation ? "c1" : one ? one->text : NULL;
  if (!row || !other) return SPH_OK;
  for (int k = 0; k < 3; k++)
    if (!strcmp(row, partner[k][0]) && !strcmp(other->text, partner[k][1])) return SPH_OK;
  int given = !other->origin || strcmp(other->origin, "default"); /* else the other end's */
  const sph_case_node *blamed = given ? other : one ? one : summation;
  return sph_case_schema_fail(c, c->error, blamed, blamed != summation, 0,
                              "form: found pressure %s with %s%s, which do not conserve energy; "
                              "right are c2 with c2, s with c1 or summation, phi with phi",
                              other->text, summation ? "summation" : "continuity ",
                              summation ? "" : row);
}

/* Fields know distances of points; one number is compared with what one number says of a run. */
static int check_norm(const sph_case *c, const sph_case_node *one)
{
  const sph_case_node *norm = sph_case_reader_find(one, "norm");
  const sph_case_node *kind = sph_case_reader_find(one, "reference")->first;
  const char *name = norm->text;
  const int of_points = !strcmp(name, "rms") || !strcmp(name, "l1") || !strcmp(name, "max");
  const int value = !strcmp(kind->key, "value");
  const int in_space = sph_case_solution_find(kind->key) || !strcmp(kind->key, "section");
  if (in_space && !of_points)
    return FAIL(norm, 0, "norm: solutions in space and sections know rms, l1, max");
  if (!value && sph_case_curve_of_one(name))
    return FAIL(norm, 0, "norm: drift, period, decay go with reference: value");
  if (value && of_points)
    return FAIL(kind, 0,
                "reference: value with norm %s, which compares the points of a curve; right is "
                "norm: mean, arrival, drift, period or decay",
                name);
  return SPH_OK;
}

static int check_comparisons(sph_case *c)
{
  const sph_case_node *list = sph_case_reader_find(c->root, "compare");
  for (const sph_case_node *one = list ? list->first : NULL; one; one = one->next) {
    const sph_case_node *group = sph_case_reader_find(one, "group");
    const sph_case_node *map =
        group ? sph_case_reader_find(sph_case_reader_find(c->root, "groups"), group->text) : NULL;
    if (check_norm(c, one)) return c->error->status;
    if (!group) continue;
    if (!sph_case_solution_find(sph_case_reader_find(one, "reference")->first->key))
      return FAIL_KEY(group, "group: belongs to solutions in space");
    if (strcmp(sph_case_reader_text(map, "kind", ""), "fluid") != 0)
      return FAIL(group, 0, "group: there is no fluid '%.60s'", group->text);
  }
  return SPH_OK;
}

static int check_drag(sph_case *c)
{
  const sph_case_node *drag = sph_case_reader_find(sph_case_reader_find(c->root, "terms"), "drag");
  const sph_case_node *K = sph_case_reader_find(drag, "coefficient");
  const sph_case_node *time = sph_case_reader_find(drag, "stopping_time");
  if (!drag || !K != !time) return SPH_OK;
  if (K) return FAIL_KEY(time, "drag: found both coefficient and stopping_time; one is right");
  return FAIL_KEY(drag, "missing key 'coefficient' or 'stopping_time' in drag");
}

/* With imex, where no term has a part. */
static int implicit_by_default(const sph_case_node *terms)
{
  static const char *const names[] = {"viscosity-laminar", "conduction", "drag"};
  int found = 0;
  for (int k = 0; k < 3; k++) found |= sph_case_reader_find(terms, names[k]) != NULL;
  return found;
}

int sph_case_check_parts(const sph_case *c, sph_error *error)
{
  sph_error own = {0};
  if (!error) error = &own;
  if (!c) return sph_error_set(error, SPH_ERR_ARGUMENT, "the parts of no case (NULL)");
  const sph_case_node *terms = sph_case_reader_find(c->root, "terms");
  const sph_case_node *method =
      sph_case_reader_find(sph_case_reader_find(c->root, "integrator"), "method");
  const char *name = method ? method->text : "";
  const int imex = !strncmp(name, "imex:", 5), mri = !strncmp(name, "mri:", 4);
  int parts = 0, implicit = 0, fast = 0;
  for (const sph_case_node *term = terms->first; term; term = term->next) {
    const sph_case_node *part = sph_case_reader_find(term, "part");
    if (!part) continue;
    const int is_implicit = !strcmp(part->text, "implicit"), is_fast = !strcmp(part->text, "fast");
    if ((is_implicit && !imex) || (is_fast && !mri))
      return sph_case_schema_fail(c, error, part, 1, 0,
                                  "part: found %s, but integrator %s steps all terms alike; right "
                                  "is method: %s",
                                  part->text, name, is_fast ? "mri:<coupling>" : "imex:<table>");
    parts++, implicit += is_implicit, fast += is_fast;
  }
  if (mri && !fast)
    return sph_case_schema_fail(c, error, method, 1, 0,
                                "method: %s needs fast terms; none has part: fast", name);
  if (imex && !implicit && (parts || !implicit_by_default(terms)))
    return sph_case_schema_fail(c, error, method, 1, 0,
                                "method: %s needs implicit terms; none has part: implicit%s", name,
                                parts ? ""
                                      : ", and there is no viscosity-laminar, conduction, drag");
  return SPH_OK;
}

/* Before all that may use them. */
static int check_tables(sph_case *c)
{
  sph_case_node *tables = sph_case_reader_find(c->root, "tables");
  if (tables && check_value(c, find_key("case", "tables"), tables)) return c->error->status;
  for (sph_case_node *one = tables ? tables->first : NULL; one; one = one->next)
    if (sph_case_check_name(c, one)) return c->error->status;
  return sph_case_table_read_all(c);
}

static int check_rotation(const sph_case *c, const sph_case_node *rotation)
{
  const sph_case_node *rate = sph_case_reader_find(rotation, "angular_velocity");
  const sph_case_node *angle = sph_case_reader_find(rotation, "angle");
  const sph_case_node *axis = sph_case_reader_find(rotation, "axis");
  if (c->dim == 1) return FAIL_KEY(rotation, "rotation: nothing turns in 1D; right is 2D or 3D");
  if (axis && c->dim == 2) return FAIL_KEY(axis, "rotation: the axis is z in 2D; leave it out");
  if (!rate && !angle)
    return FAIL_KEY(rotation, "missing key 'angular_velocity' or 'angle' in rotation");
  if (rate && angle)
    return FAIL_KEY(angle, "rotation: found both angular_velocity and angle; one is right");
  return SPH_OK;
}

/* A wall moves in one way. */
static int check_motions(sph_case *c)
{
  const sph_case_node *groups = sph_case_reader_find(c->root, "groups");
  int status = SPH_OK;
  for (const sph_case_node *group = groups->first; group && !status; group = group->next) {
    const sph_case_node *motion =
        sph_case_reader_find(sph_case_reader_find(group, "boundary"), "motion");
    const sph_case_node *v = sph_case_reader_find(motion, "velocity");
    const sph_case_node *x = sph_case_reader_find(motion, "displacement");
    const sph_case_node *rotation = sph_case_reader_find(motion, "rotation");
    const int slide = sph_case_reader_number(motion, "slide", 0) != 0;
    if (motion && !v && !x && !rotation)
      return FAIL_KEY(motion, "missing key 'velocity', 'displacement' or 'rotation' in motion");
    if (v && x) return FAIL_KEY(x, "motion: found both velocity and displacement; one is right");
    if (x && slide)
      return FAIL_KEY(x, "motion: a wall that slides has a velocity, not a displacement");
    if (rotation) status = check_rotation(c, rotation);
    if (!status && slide && sph_case_reader_find(rotation, "angle"))
      return FAIL_KEY(rotation, "motion: a wall that slides has an angular velocity, not an angle");
  }
  return status;
}

/* ---- places and outputs */

static int check_axis(sph_case *c, const sph_case_node *axis, const char *key)
{
  if (!axis || axis->text[0] - 'x' < c->dim) return SPH_OK;
  return FAIL(axis, 0, "%s: there is no %s in %d dimension%s", key, axis->text, c->dim,
              c->dim == 1 ? "" : "s");
}

static int check_periodic(sph_case *c)
{
  const sph_case_node *periodic = sph_case_reader_find(c->root, "periodic");
  const sph_case_node *axes = sph_case_reader_find(periodic, "axes");
  double lower[3], upper[3];
  sph_case_reader_vector(periodic, "lower", lower);
  sph_case_reader_vector(periodic, "upper", upper);
  int status = SPH_OK;
  for (const sph_case_node *axis = axes ? axes->first : NULL; axis && !status; axis = axis->next) {
    const int d = axis->text[0] - 'x';
    status = check_axis(c, axis, "axes");
    if (!status && !(upper[d] > lower[d]))
      status = FAIL(sph_case_reader_find(periodic, "upper"), 0,
                    "upper: found %s = %g m, with lower %g m; upper above lower is right",
                    axis->text, upper[d], lower[d]);
  }
  return status;
}

static int check_hydrostatic(sph_case *c)
{
  const sph_case_node *groups = sph_case_reader_find(c->root, "groups");
  int status = SPH_OK;
  for (const sph_case_node *group = groups->first; group && !status; group = group->next) {
    const sph_case_node *initial = sph_case_reader_find(group, "initial");
    const sph_case_node *column = sph_case_reader_find(initial, "hydrostatic");
    status = check_axis(c, sph_case_reader_find(column, "axis"), "axis");
  }
  return status;
}

static int check_probe(sph_case *c, const sph_case_node *probe)
{
  static const char *const ways[] = {"at", "points", "line", "plane"};
  const sph_case_node *points = sph_case_reader_find(probe, "points");
  int given = 0;
  for (int k = 0; k < 4; k++) given += sph_case_reader_find(probe, ways[k]) != NULL;
  if (given != 1)
    return FAIL_KEY(probe,
                    "probe %.60s: found %s; exactly one of these says where: at, points, "
                    "line, plane",
                    probe->key, given ? "several places" : "no place");
  return !points || points->first ? SPH_OK : FAIL(points, 0, "points: found none");
}

static int check_force(sph_case *c, const sph_case_node *force)
{
  const sph_case_node *group =
      sph_case_reader_find(sph_case_reader_find(c->root, "groups"), force->key);
  if (!strcmp(sph_case_reader_text(group, "kind", ""), "wall")) return SPH_OK;
  return FAIL_KEY(force, "forces: '%.60s' is %s; right is the name of a wall", force->key,
                  group ? "a fluid" : "no group");
}

static int check_outputs(sph_case *c)
{
  const sph_case_node *output = sph_case_reader_find(c->root, "output");
  const sph_case_node *monitors = sph_case_reader_find(output, "monitors");
  const sph_case_node *forces = sph_case_reader_find(output, "forces");
  const sph_case_node *probes = sph_case_reader_find(output, "probes");
  int status = SPH_OK;
  for (const sph_case_node *m = monitors ? monitors->first : NULL; m && !status; m = m->next)
    status = check_axis(c, sph_case_reader_find(m, "axis"), "axis");
  for (const sph_case_node *f = forces ? forces->first : NULL; f && !status; f = f->next)
    status = check_force(c, f);
  for (const sph_case_node *p = probes ? probes->first : NULL; p && !status; p = p->next)
    status = check_probe(c, p);
  return status;
}

/* Before all that has one: else what it is missed for would be blamed. */
static int missing_dimension(sph_case *c)
{
  for (const sph_case_node *node = c->root->first; node; node = node->next)
    if (!find_key("case", node->key)) return unknown_key(c, "case", node);
  return FAIL_KEY(c->root, "missing key 'dimension' in case: %s",
                  find_key("case", "dimension")->about);
}

int sph_case_check(sph_case *c)
{
  sph_case_node *dimension = sph_case_reader_find(c->root, "dimension");
  sph_case_node *parameters = sph_case_reader_find(c->root, "parameters");
  if (dimension && check_value(c, find_key("case", "dimension"), dimension))
    return c->error->status;
  if (!dimension && c->root->kind == SPH_CASE_MAP && c->root->first) return missing_dimension(c);
  c->dim = dimension ? (int)dimension->number : 3;
  if (parameters && check_value(c, find_key("case", "parameters"), parameters))
    return c->error->status;
  if (check_tables(c)) return c->error->status;
  const sph_case_node *include =
      sph_case_reader_find(c->root, "include"); /* those of files are gone */
  if (include) return FAIL_KEY(include, "include: stands in files; --set cannot bring it");
  int status = check_map(c, "case", c->root);
  if (!status) status = check_fluid(c);
  if (!status) status = sph_case_material_check(c);
  if (!status) status = sph_case_event_check(c);
  if (!status) status = check_drag(c);
  if (!status) status = check_motions(c);
  if (!status) status = check_comparisons(c);
  if (!status) status = check_periodic(c);
  if (!status) status = check_hydrostatic(c);
  if (!status) status = check_outputs(c);
  if (!status) status = sph_case_scalar_check(c);
  return status ? status : check_forms(c);
}
