/* The manual of the format, from the table that checks it. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_schema.h"
#include "text.h"

static const char head[] =
    "# Case files\n\n"
    "A case file tells a simulation, its outputs and what it is compared with. This page is made "
    "from the table\nthat checks case files (`sphode info case`).\n\n"
    "```\nsphode new               writes one to begin with\n"
    "sphode check case.yml    reads it, tells what it would cost, runs nothing\n"
    "sphode run case.yml      runs it\n"
    "sphode sweep case.yml --vary dx=2cm,1cm   runs it with several values\n```\n\n"
    "[tutorial.md](tutorial.md) makes one in ten minutes.\n\n"
    "The format is [YAML](https://yaml.org): `key: value` a line, indented below what it belongs "
    "to, lists as `[1, 2]` or\nlines that begin with `-`, comments behind `#`. Tags, anchors and "
    "aliases are not read; keys may stand once.\n\n"
    "**Numbers** are expressions with units: `9.81 m/s^2`, `0.5 mm`, `1 g/cm^3`, `H/40`, "
    "`10*sqrt(2*g*H)`. A unit stands behind a\nnumber, never behind a name. The dimension of the "
    "whole is checked: metres cannot be added to seconds, nor given for a\nspeed. A number without "
    "any unit is taken as SI, also one that `--set` gives to a parameter with a unit. Names come "
    "from `parameters`; each may use those above it, and none "
    "is a unit, as W is. Known\n"
    "functions are those of muParser: `sqrt`, `sin`, `exp`, `min`, `max`, `abs`, ..., "
    "`x < 0 ? a : b` (in quotes: YAML takes `: ` for a key), and the constant `pi`.\nExpressions "
    "of the initial state may use the "
    "coordinates `x`, `y`, `z`, those of sources and motions the time `t` and the names of "
    "`tables`, too.\n\n"
    "**Units**: kg g, m km dm cm mm um in ft, s ms us min, Hz kHz, N kN, Pa mPa hPa kPa MPa GPa "
    "bar mbar, J kJ MJ, W mW kW, K, mol, deg, and\ntheir products, quotients and powers.\n\n"
    "An **error** tells its place, what was found and what is right:\n\n"
    "```\ncase.yml:7:10: spacing: found s, wanted m\n"
    "case.yml:9:3: unknown key 'nam' in kernel; did you mean 'name'? known: name, h_over_dx\n```\n";

static const char *type_of(const sph_case_key *key)
{
  static const char *const words[] = {"mapping",
                                      "list of",
                                      "names to",
                                      "names to numbers",
                                      "text",
                                      "word",
                                      "list of words",
                                      "true/false",
                                      "whole number",
                                      "number",
                                      "number",
                                      "vector",
                                      "[from, to]",
                                      "list of numbers",
                                      "list of pairs",
                                      "expression",
                                      "vector of expressions",
                                      "expression",
                                      "vector of expressions",
                                      "vector of expressions in t",
                                      "expression in t",
                                      "text or list of texts",
                                      "expression"};
  return words[key->type];
}

/* A vertical bar would end the cell. */
static void add_cell(sph_text *text, const char *cell)
{
  for (; *cell; cell++) sph_text_add(text, *cell == '|' ? "\\|" : "%c", *cell);
}

static void add_type(sph_text *text, const sph_case_key *key)
{
  int nested =
      key->type == SPH_CASE_MAP_T || key->type == SPH_CASE_LIST_T || key->type == SPH_CASE_NAMED_T;
  sph_text_add(text, "%s", key->type == SPH_CASE_MAP_T ? "" : type_of(key));
  if (nested)
    sph_text_add(text, "%s[%s](#%s)", key->type == SPH_CASE_MAP_T ? "" : " ", key->more, key->more);
  if (!strcmp(key->unit, "any")) sph_text_add(text, " (any unit)");
  if (key->unit[0] && strcmp(key->unit, "1") && strcmp(key->unit, "any"))
    sph_text_add(text, " [%s]", key->unit);
}

static void add_range(sph_text *text, const sph_case_key *key)
{
  if (key->type < SPH_CASE_COUNT_T || key->type == SPH_CASE_LARGEST_T ||
      key->type >= SPH_CASE_FIELD_T)
    return;
  if (key->low == DBL_MIN)
    sph_text_add(text, "> 0");
  else if (isfinite(key->low) && isinf(key->high))
    sph_text_add(text, ">= %g", key->low);
  if (isfinite(key->high))
    sph_text_add(text, "%s%g to %g", key->low == DBL_MIN ? ", " : "",
                 key->low == DBL_MIN ? 0 : key->low, key->high);
}

static void add_choices(sph_text *text, const sph_case_key *key)
{
  char word[80];
  if (key->type != SPH_CASE_WORD_T && key->type != SPH_CASE_WORDS_T) return;
  if (!strcmp(key->more, "@integrators")) { /* they depend on the SUNDIALS that is installed */
    sph_text_add(text, "`leapfrog`, `dkd`, ..., `erk:`, `imex:`, `mri:`, `sprk:`, `lsrk:` and a "
                       "table: `sphode info integrators`");
    return;
  }
  for (int k = 0; sph_case_schema_choice(key, k, word); k++)
    sph_text_add(text, "%s`%s`", k ? ", " : "", word);
}

static void add_key(sph_text *text, const sph_case_key *key)
{
  sph_text_add(text, "| `%s` | ", key->name);
  add_type(text, key);
  sph_text_add(text, " | ");
  add_range(text, key);
  add_choices(text, key);
  if (!key->standard)
    sph_text_add(text, " | **required**");
  else if (key->standard[0] && strcmp(key->standard, "{}"))
    sph_text_add(text, " | `%s`", key->standard);
  else
    sph_text_add(text, " | ");
  sph_text_add(text, " | ");
  add_cell(text, key->about);
  sph_text_add(text, " |\n");
}

static void add_mapping(sph_text *text, const sph_case_mapping *mapping)
{
  const sph_case_key *key;
  sph_text_add(text,
               "\n## %s\n\n%s%s\n\n| key | value | range | default | |\n|---|---|---|---|---|\n",
               mapping->name, mapping->about, mapping->one ? " Exactly one of these:" : "");
  for (int k = 0; (key = sph_case_schema_key(k)); k++)
    if (!strcmp(key->mapping, mapping->name)) add_key(text, key);
}

int sph_case_manual(char *buffer, size_t size)
{
  sph_text text = {0};
  const sph_case_mapping *mapping;
  sph_text_add(&text, "%s", head);
  for (int k = 0; (mapping = sph_case_schema_mapping(k)); k++) add_mapping(&text, mapping);
  int length = text.error.status ? text.error.status : (int)text.length;
  if (length >= 0 && buffer && size) snprintf(buffer, size, "%s", text.data);
  sph_text_free(&text);
  return length;
}
