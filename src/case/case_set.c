#include "case_set.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"

static int is_plain(const sph_case_value *value)
{
  double dimension = 0;
  for (int b = 0; b < SPH_SI_BASES; b++) dimension += fabs(value->power[b]);
  return dimension == 0;
}

/* Its value, by those above it, names[*n]; SPH_ERR_PARSE: it has none. */
static int value_of(const sph_case *c, const char *name, sph_case_name names[], int *n,
                    sph_case_value *value)
{
  const sph_case_node *one = sph_case_reader_find(c->root, "parameters");
  for (one = one ? one->first : NULL; one && *n < SPH_CASE_NAMES; one = one->next) {
    const int last = !strcmp(one->key, name);
    const int status = one->kind == SPH_CASE_SCALAR
                           ? sph_case_value_evaluate(one->text, names, *n, value)
                           : SPH_ERR_PARSE;
    if (last) return status;
    if (status) continue;
    names[*n] = (sph_case_name){.name = one->key, .value = value->value};
    memcpy(names[(*n)++].power, value->power, sizeof value->power);
  }
  return SPH_ERR_PARSE;
}

int sph_case_set_unit(const sph_case *c, const char *name, sph_case_node *given)
{
  sph_case_name names[SPH_CASE_NAMES];
  sph_case_value old, value;
  char unit[80], text[SPH_CASE_VALUE_LENGTH + 100], *end;
  int n = 0;
  if (given->kind != SPH_CASE_SCALAR || strlen(given->text) > SPH_CASE_VALUE_LENGTH ||
      value_of(c, name, names, &n, &old) || is_plain(&old) ||
      sph_case_value_evaluate(given->text, names, n, &value) || !is_plain(&value))
    return SPH_OK;
  sph_si_unit_write(old.power, unit, sizeof unit);
  (void)strtod(given->text, &end);
  snprintf(text, sizeof text, *end ? "(%s)*(1 %s)" : "%s %s", given->text, unit);
  if (sph_case_value_evaluate(text, names, n, &value)) return SPH_OK; /* a unit as m^0.5 */
  char *copy = sph_memory_string(text, c->error);
  if (!copy) return SPH_ERR_MEMORY;
  sph_memory_free(given->text);
  given->text = copy;
  return SPH_OK;
}
