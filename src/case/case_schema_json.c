/* The schema as JSON Schema (draft 2020-12), from the table that checks case files: editors
 * complete and check by it.  It knows names, words, numbers of entries; units and expressions are
 * texts to it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_schema.h"
#include "sphode/case.h"
#include "text.h"

static void add_choices(sph_text *text, const sph_case_key *key)
{
  char word[80];
  if (!strcmp(key->more, "@integrators")) { /* they depend on the SUNDIALS that is installed */
    sph_text_add(text, "\"type\": \"string\"");
    return;
  }
  sph_text_add(text, "\"enum\": [");
  for (int k = 0; sph_case_schema_choice(key, k, word); k++) {
    if (k) sph_text_add(text, ", ");
    sph_text_json_string(text, word);
  }
  sph_text_add(text, "]");
}

/* A plain number has a range; one with a unit, or an expression, is a text. */
static void add_number(sph_text *text, const sph_case_key *key, int whole)
{
  sph_text_add(text, "\"anyOf\": [{\"type\": \"%s\"", whole ? "integer" : "number");
  if (isfinite(key->low) && (key->low != 0 || key->high != 0))
    sph_text_add(text, ", \"minimum\": %.9g", key->low < 1e-300 && key->low > 0 ? 0 : key->low);
  if (isfinite(key->high) && (key->low != 0 || key->high != 0))
    sph_text_add(text, ", \"maximum\": %.9g", key->high);
  sph_text_add(text, "}, {\"type\": \"string\"}]");
}

static void add_expression(sph_text *text)
{
  sph_text_add(text, "\"type\": [\"number\", \"string\"]");
}

static void add_list(sph_text *text, const sph_case_key *key,
                     void (*add)(sph_text *text, const sph_case_key *key), int least, int most)
{
  sph_text_add(text, "\"type\": \"array\", \"items\": {");
  add(text, key);
  sph_text_add(text, "}");
  if (least) sph_text_add(text, ", \"minItems\": %d", least);
  if (most) sph_text_add(text, ", \"maxItems\": %d", most);
}

static void one_mapping(sph_text *text, const sph_case_key *key)
{
  sph_text_add(text, "\"$ref\": \"#/$defs/%s\"", key->more);
}

static void one_number(sph_text *text, const sph_case_key *key) { add_number(text, key, 0); }

static void one_expression(sph_text *text, const sph_case_key *key)
{
  (void)key;
  add_expression(text);
}

static void one_pair(sph_text *text, const sph_case_key *key)
{
  add_list(text, key, one_number, 2, 2);
}

static void add_names(sph_text *text, const sph_case_key *key)
{
  sph_text_add(text, "\"type\": \"object\", \"additionalProperties\": {");
  if (key->type == SPH_CASE_PARAMETERS_T)
    add_expression(text);
  else
    one_mapping(text, key);
  sph_text_add(text, "}");
}

static void add_type(sph_text *text, const sph_case_key *key)
{
  switch (key->type) {
  case SPH_CASE_MAP_T: one_mapping(text, key); break;
  case SPH_CASE_LIST_T: add_list(text, key, one_mapping, 0, 0); break;
  case SPH_CASE_NAMED_T:
  case SPH_CASE_PARAMETERS_T: add_names(text, key); break;
  case SPH_CASE_TEXT_T: sph_text_add(text, "\"type\": [\"string\", \"number\", \"null\"]"); break;
  case SPH_CASE_WORD_T: add_choices(text, key); break;
  case SPH_CASE_WORDS_T: add_list(text, key, add_choices, 0, 0); break;
  case SPH_CASE_FLAG_T: sph_text_add(text, "\"type\": \"boolean\""); break;
  case SPH_CASE_COUNT_T: add_number(text, key, 1); break;
  case SPH_CASE_NUMBER_T:
  case SPH_CASE_LARGEST_T: one_number(text, key); break;
  case SPH_CASE_VECTOR_T: add_list(text, key, one_number, 1, 3); break;
  case SPH_CASE_PAIR_T: one_pair(text, key); break;
  case SPH_CASE_NUMBERS_T: add_list(text, key, one_number, 0, 0); break;
  case SPH_CASE_POINTS_T: add_list(text, key, one_pair, 3, 0); break;
  case SPH_CASE_FIELD_T:
  case SPH_CASE_FORMULA_T:
  case SPH_CASE_SOURCE_T:
  case SPH_CASE_MOMENT_T: add_expression(text); break;
  case SPH_CASE_FIELDS_T:
  case SPH_CASE_FORMULAS_T:
  case SPH_CASE_MOMENTS_T: add_list(text, key, one_expression, 1, 3); break;
  case SPH_CASE_TEXTS_T:
    sph_text_add(text, "\"type\": [\"string\", \"array\"], \"items\": {\"type\": \"string\"}");
    break;
  }
}

static void add_about(sph_text *text, const sph_case_key *key)
{
  char about[800];
  const int unit = key->unit[0] && strcmp(key->unit, "1") && strcmp(key->unit, "any");
  snprintf(about, sizeof about, "%s%s%s%s%s%s", key->about, unit ? " [" : "", unit ? key->unit : "",
           unit ? "]" : "",
           key->standard && key->standard[0] && strcmp(key->standard, "{}") ? " Default: " : "",
           key->standard && strcmp(key->standard, "{}") ? key->standard : "");
  sph_text_add(text, "\"description\": ");
  sph_text_json_string(text, about);
}

/* What must be there; a file that includes others may leave it to them. */
static void add_required(sph_text *text, const char *mapping)
{
  const sph_case_key *key;
  const int root = !strcmp(mapping, "case");
  int n = 0;
  for (int k = 0; (key = sph_case_schema_key(k)); k++) {
    if (strcmp(key->mapping, mapping) != 0 || key->standard) continue;
    if (n++)
      sph_text_add(text, ", ");
    else
      sph_text_add(text, root ? ",\n  \"anyOf\": [{\"required\": [\"include\"]}, {\"required\": ["
                              : ",\n  \"required\": [");
    sph_text_json_string(text, key->name);
  }
  if (n) sph_text_add(text, root ? "]}]" : "]");
}

static void add_mapping(sph_text *text, const sph_case_mapping *mapping)
{
  const sph_case_key *key;
  int n = 0;
  sph_text_add(text, "\"type\": [\"object\", \"null\"], \"description\": ");
  sph_text_json_string(text, mapping->about);
  sph_text_add(text, ", \"additionalProperties\": false");
  if (mapping->one) sph_text_add(text, ", \"minProperties\": 1, \"maxProperties\": 1");
  sph_text_add(text, ",\n  \"properties\": {");
  for (int k = 0; (key = sph_case_schema_key(k)); k++) {
    if (strcmp(key->mapping, mapping->name) != 0) continue;
    sph_text_add(text, "%s\n    ", n++ ? "," : "");
    sph_text_json_string(text, key->name);
    sph_text_add(text, ": {");
    add_about(text, key);
    sph_text_add(text, ", ");
    add_type(text, key);
    sph_text_add(text, "}");
  }
  sph_text_add(text, "}");
  add_required(text, mapping->name);
}

int sph_case_schema_json(char *buffer, size_t size)
{
  sph_text text = {0};
  const sph_case_mapping *mapping;
  sph_text_add(&text, "{\"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n"
                      "  \"title\": \"A case file of sphode\",\n  ");
  add_mapping(&text, sph_case_schema_mapping(0));
  sph_text_add(&text, ",\n  \"$defs\": {");
  for (int k = 1; (mapping = sph_case_schema_mapping(k)); k++) {
    sph_text_add(&text, "%s\n  ", k > 1 ? "," : "");
    sph_text_json_string(&text, mapping->name);
    sph_text_add(&text, ": {");
    add_mapping(&text, mapping);
    sph_text_add(&text, "}");
  }
  sph_text_add(&text, "}\n}\n");
  const int length = text.error.status ? text.error.status : (int)text.length;
  if (length >= 0 && buffer && size) snprintf(buffer, size, "%s", text.data);
  sph_text_free(&text);
  return length;
}
