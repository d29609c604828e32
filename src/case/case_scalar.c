#include "case_scalar.h"

#include <math.h>
#include <string.h>

#include "case_source.h"
#include "sphode/field.h"
#include "sphode/neighbors.h"

#define child_of sph_case_reader_find
#define get_number sph_case_reader_number
#define get_text sph_case_reader_text

#define FAIL(node, column, ...) sph_case_schema_fail(c, c->error, node, 1, column, __VA_ARGS__)
#define FAIL_KEY(node, ...) sph_case_schema_fail(c, c->error, node, 0, 0, __VA_ARGS__)

/* ---- the check */

/* Numbers are SI everywhere, so its unit is, too. */
static int read_unit(sph_case *c, const sph_case_node *scalar, double power[SPH_SI_BASES])
{
  const sph_case_node *node = child_of(scalar, "unit");
  sph_si_unit unit = {.factor = 1};
  const size_t length = strlen(node->text);
  memset(power, 0, SPH_SI_BASES * sizeof *power);
  if (!strcmp(node->text, "1")) return SPH_OK;
  const int inverse = !strncmp(node->text, "1/", 2);
  if (sph_si_unit_parse(node->text + inverse, NULL, NULL, &unit) + (size_t)inverse != length ||
      unit.factor != 1)
    return FAIL(node, 0,
                "unit: found '%.40s'; right is one of SI without a factor, as mol/kg, or 1",
                node->text);
  memcpy(power, unit.power, SPH_SI_BASES * sizeof *power);
  return SPH_OK;
}

/* A plain number is taken as SI, zero fits all. */
static int check_unit(sph_case *c, const sph_case_node *node, const char *key,
                      const sph_case_value *value, const double wanted[SPH_SI_BASES])
{
  char found[80], right[80];
  static const double plain[SPH_SI_BASES];
  if (value->any || sph_si_unit_same(value->power, plain) || sph_si_unit_same(value->power, wanted))
    return SPH_OK;
  sph_si_unit_write(value->power, found, sizeof found);
  sph_si_unit_write(wanted, right, sizeof right);
  return FAIL(node, 0, "%s: found %s, wanted %s", key, found,
              strcmp(right, "1") ? right : "a plain number");
}

static int check_field(sph_case *c, const sph_case_node *map, const double power[SPH_SI_BASES])
{
  const sph_case_node *node = child_of(map, "initial");
  sph_case_value value;
  if (!node) return SPH_OK;
  if (sph_case_value_field_unit(node->text, c->names, c->n, c->dim, &value))
    return FAIL(node, value.column, "initial: %s", value.problem);
  return check_unit(c, node, "initial", &value, power);
}

static int check_number(sph_case *c, const sph_case_node *map, const char *key,
                        const double power[SPH_SI_BASES])
{
  const sph_case_node *node = child_of(map, key);
  sph_case_value value;
  if (!node) return SPH_OK;
  if (sph_case_value_evaluate(node->text, c->names, c->n, &value))
    return FAIL(node, value.column, "%s: %s", key, value.problem);
  return check_unit(c, node, key, &value, power);
}

static int check_source(sph_case *c, const sph_case_node *scalar, const double power[SPH_SI_BASES])
{
  const sph_case_node *node = child_of(scalar, "source");
  sph_case_name names[SPH_CASE_SOURCE_NAMES];
  sph_case_value value;
  double rate[SPH_SI_BASES];
  if (!node) return SPH_OK;
  const int n = sph_case_source_names(c, scalar->key, power, names);
  if (sph_case_value_formula_unit(node->text, names, n, c->dim, &value))
    return FAIL(node, value.column, "source: %s", value.problem);
  memcpy(rate, power, sizeof rate);
  rate[2] -= 1; /* a second */
  return check_unit(c, node, "source", &value, rate);
}

/* Is there a group of that name and kind? */
static int check_group(sph_case *c, const sph_case_node *named, const char *kind)
{
  const sph_case_node *group = child_of(child_of(c->root, "groups"), named->key);
  if (!strcmp(get_text(group, "kind", ""), kind)) return SPH_OK;
  return FAIL_KEY(named, "'%.60s' is %s; right is the name of a %s", named->key,
                  !group           ? "no group"
                  : kind[0] == 'w' ? "a fluid"
                                   : "a wall",
                  kind);
}

static int check_scalar(sph_case *c, const sph_case_node *scalar)
{
  double power[SPH_SI_BASES];
  const sph_case_node *fluids = child_of(scalar, "fluids"), *walls = child_of(scalar, "walls");
  int status = sph_case_check_name(c, scalar);
  for (int k = 0; !status && k < c->timed_n; k++)
    if (!strcmp(c->timed[k].name, scalar->key))
      status = FAIL_KEY(scalar, "'%.60s' is a parameter or a table, too; choose another name",
                        scalar->key);
  if (!status && sph_field_find(scalar->key) >= 0)
    status = FAIL_KEY(scalar, "there is a field '%.60s' already; choose another name", scalar->key);
  if (!status) status = read_unit(c, scalar, power);
  if (!status) status = check_field(c, scalar, power);
  if (!status) status = check_number(c, scalar, "scale", power);
  if (!status) status = check_source(c, scalar, power);
  for (const sph_case_node *one = fluids ? fluids->first : NULL; one && !status; one = one->next) {
    status = check_group(c, one, "fluid");
    if (!status) status = check_field(c, one, power);
  }
  for (const sph_case_node *one = walls ? walls->first : NULL; one && !status; one = one->next) {
    status = check_group(c, one, "wall");
    if (!status) status = check_number(c, one, "value", power);
  }
  return status;
}

int sph_case_scalar_check(sph_case *c)
{
  const sph_case_node *scalars = child_of(c->root, "scalars");
  int status = SPH_OK;
  for (const sph_case_node *one = scalars ? scalars->first : NULL; one && !status; one = one->next)
    status = check_scalar(c, one);
  return status;
}

/* ---- the simulation */

typedef struct builder {
  const sph_case *c;
  sph_sim *sim;
  sph_error *error;
} builder;

static int told(const builder *b, const sph_case_node *node)
{
  if (b->error->status) return b->error->status;
  if (sph_sim_status(b->sim) == SPH_OK) return SPH_OK;
  return sph_case_schema_fail(b->c, b->error, node, 0, 0, "%s", sph_sim_error(b->sim));
}

/* What it is at the start in one group; *most: its largest magnitude. */
static int set_initial(const builder *b, sph_group *group, const char *name,
                       const sph_case_node *node, double *most)
{
  const double *x[3] = {NULL, NULL, NULL};
  sph_case_value value;
  const long n = sph_group_count(group);
  double *s = sph_group_write(group, name, 0);
  for (int d = 0; d < b->c->dim; d++) x[d] = sph_group_read(group, "position", d);
  if (!s) return told(b, node);
  if (sph_case_value_field(node->text, b->c->names, b->c->n, b->c->dim, n, x, s, &value))
    return sph_case_schema_fail(b->c, b->error, node, 1, value.column, "%s", value.problem);
  for (long i = 0; i < n; i++) *most = fmax(*most, fabs(s[i]));
  return SPH_OK;
}

/* Its term; by_group: room for all groups. */
static int add_term(const builder *b, const sph_case_node *scalar, sph_group_value *by_group)
{
  const sph_case_node *fluids = child_of(scalar, "fluids"), *walls = child_of(scalar, "walls");
  const sph_case_node *one;
  int n = 0;
  for (one = fluids ? fluids->first : NULL; one; one = one->next)
    if (child_of(one, "diffusivity"))
      by_group[n++] = (sph_group_value){one->key, get_number(one, "diffusivity", 0)};
  for (one = walls ? walls->first : NULL; one; one = one->next)
    by_group[n++] = (sph_group_value){one->key, get_number(one, "value", 0)};
  sph_term term = sph_term_scalar_diffusion((sph_scalar){.name = scalar->key,
                                                         .unit = get_text(scalar, "unit", "1"),
                                                         .scale = 1},
                                            get_number(scalar, "diffusivity", 0));
  term.by_group = by_group;
  term.by_groups = n;
  if (child_of(scalar, "source") &&
      sph_case_source_react(b->c, b->sim, scalar->key, child_of(scalar, "source"), &term, b->error))
    return b->error->status;
  sph_sim_add_term(b->sim, term);
  return told(b, scalar);
}

static int add_scalar(const builder *b, const sph_case_node *scalar)
{
  sph_group_value by_group[SPH_SETS_MAX];
  const sph_case_node *fluids = child_of(scalar, "fluids"), *walls = child_of(scalar, "walls");
  double most = 0;
  int status = add_term(b, scalar, by_group);
  const sph_case_node *group = child_of(b->c->root, "groups")->first;
  for (; group && !status; group = group->next) {
    const sph_case_node *own = child_of(child_of(fluids, group->key), "initial");
    if (!strcmp(get_text(group, "kind", ""), "fluid"))
      status = set_initial(b, sph_sim_group(b->sim, group->key), scalar->key,
                           own ? own : child_of(scalar, "initial"), &most);
  }
  for (const sph_case_node *one = walls ? walls->first : NULL; one; one = one->next)
    most = fmax(most, fabs(get_number(one, "value", 0)));
  if (status) return status;
  sph_sim_set_scale(b->sim, NULL, scalar->key, get_number(scalar, "scale", most > 0 ? most : 1));
  return told(b, scalar);
}

int sph_case_scalar_add(const sph_case *c, sph_sim *sim, sph_error *error)
{
  const builder b = {.c = c, .sim = sim, .error = error};
  const sph_case_node *scalars = child_of(c->root, "scalars");
  int status = SPH_OK;
  for (const sph_case_node *one = scalars ? scalars->first : NULL; one && !status; one = one->next)
    status = add_scalar(&b, one);
  return status;
}
