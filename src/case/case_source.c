#include "case_source.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "memory.h"

#define child_of sph_case_reader_find

enum { CHUNK = 256 };

/* Fields that sources of scalars know, before the scalar itself. */
enum { DENSITY, PRESSURE, ENERGY, TEMPERATURE, SPEED, SCALAR, FIELDS };

typedef struct source {
  sph_sim *sim;
  int fields;                   /* FIELDS of a scalar, else 0 */
  sph_case_formula *formula[3]; /* NULL: there is no such direction; heating: the first */
  char what[3][SPH_CASE_WHAT];  /* "file:line:column: body-force: acceleration 'sqrt(t)'" */
} source;

static void release(void *ctx)
{
  source *it = ctx;
  for (int d = 0; d < 3; d++) sph_case_value_formula_free(it->formula[d]);
  sph_memory_free(it);
}

/* Formula d at n particles from i on, n at most CHUNK. */
static int evaluate(const source *it, int d, const sph_particles *s, long i, long n, double *value)
{
  double speed[CHUNK], T[CHUNK], none[CHUNK];
  const double *x[3] = {NULL, NULL, NULL};
  for (int axis = 0; axis < s->dim; axis++) x[axis] = s->x[axis] + i;
  if (!it->fields) return sph_case_value_formula_at(it->formula[d], n, x, s->t, value);
  for (long k = 0; k < n; k++) {
    double v2 = 0;
    for (int axis = 0; axis < s->dim; axis++) v2 += s->v[axis][i + k] * s->v[axis][i + k];
    speed[k] = sqrt(v2);
    T[k] = none[k] = NAN;
  }
  const sph_eos *eos = s->u ? sph_group_eos(sph_sim_group(it->sim, s->group)) : NULL;
  if (sph_eos_has_temperature(eos)) sph_eos_temperature(eos, n, s->rho + i, s->u + i, T);
  const double *const field[FIELDS] = {
      [DENSITY] = s->rho + i, [PRESSURE] = s->p + i, [ENERGY] = s->u ? s->u + i : none,
      [TEMPERATURE] = T,      [SPEED] = speed,       [SCALAR] = s->s + i};
  return sph_case_value_formula_with(it->formula[d], n, x, s->t, FIELDS, field, value);
}

/* Says where formula d is not finite: at one of n particles from the first one on. */
static int fail(const source *it, int d, const sph_particles *s, long first, long n)
{
  double value = 0;
  char place[100] = "";
  long i = first;
  while (i < first + n && !evaluate(it, d, s, i, 1, &value)) i++;
  for (int axis = 0; i < first + n && axis < s->dim; axis++) {
    const size_t used = strlen(place);
    snprintf(place + used, sizeof place - used, ", %c = %.6g m", "xyz"[axis], s -> x[axis][i]);
  }
  return sph_sim_fail(it->sim, SPH_ERR_STEP,
                      "%s is %g at t = %.9g s%s (%s); right is one that is finite wherever the "
                      "fluid comes, up to the end of the run, as sqrt(max(0, ...)) is",
                      it->what[d], isnan(value) ? NAN : value, s->t, place, s->group);
}

/* rate[i] += formula(x_i, t), formula d. */
static int add_rate(const source *it, int d, const sph_particles *s, double *rate)
{
  double q[CHUNK];
  for (long i = 0; rate && i < s->n; i += CHUNK) {
    const long n = s->n - i < CHUNK ? s->n - i : CHUNK;
    if (evaluate(it, d, s, i, n, q)) return fail(it, d, s, i, n);
    for (long k = 0; k < n; k++) rate[i + k] += q[k];
  }
  return SPH_OK;
}

static int heat(const sph_term *term, const sph_particles *s)
{
  const source *it = term->ctx;
  return add_rate(it, 0, s, s->du);
}

static int force(const sph_term *term, const sph_particles *s)
{
  const source *it = term->ctx;
  int status = SPH_OK;
  for (int d = 0; d < s->dim && !status; d++) status = add_rate(it, d, s, s->a[d]);
  return status;
}

void sph_case_source_describe(const sph_case *c, const char *of, const char *key,
                              const sph_case_node *node, char what[SPH_CASE_WHAT])
{
  sph_error error = {0};
  sph_case_schema_fail(c, &error, node, 1, 0, "%s: %s '%.100s'", of, key, node->text);
  snprintf(what, SPH_CASE_WHAT, "%.*s", SPH_CASE_WHAT - 1, error.text);
}

int sph_case_source_is(const sph_case_node *map)
{
  return !strcmp(map->key, "heat-source") || !strcmp(map->key, "body-force");
}

int sph_case_source_add(const sph_case *c, sph_sim *sim, const sph_case_node *map, sph_error *error)
{
  const int heats = !strcmp(map->key, "heat-source");
  const sph_case_node *node = heats ? child_of(map, "power") : child_of(map, "acceleration")->first;
  source *it = SPH_NEW(source, 1, "a source", error);
  if (!it) return SPH_ERR_MEMORY;
  it->sim = sim;
  for (int d = 0; node && d < 3; node = node->next, d++) {
    sph_case_value value;
    it->formula[d] =
        sph_case_value_formula_create(node->text, c->timed, c->timed_n, c->dim, &value);
    if (!it->formula[d]) {
      release(it);
      return sph_case_schema_fail(c, error, node, 1, value.column, "%s: %s",
                                  heats ? "power" : "acceleration", value.problem);
    }
    sph_case_source_describe(c, map->key, heats ? "power" : "acceleration", node, it->what[d]);
    if (heats) break;
  }
  sph_sim_add_term(sim, (sph_term){.name = map->key,
                                   .body = heats ? heat : force,
                                   .reads = "",
                                   .ctx = it,
                                   .free = release});
  return SPH_OK;
}

/* ---- of scalars */

static int react(const sph_term *term, const sph_particles *s)
{
  return add_rate(term->ctx, 0, s, s->ds);
}

int sph_case_source_names(const sph_case *c, const char *scalar, const double power[SPH_SI_BASES],
                          sph_case_name names[SPH_CASE_SOURCE_NAMES])
{
  static char density[] = "density", pressure[] = "pressure", energy[] = "energy",
              temperature[] = "temperature", speed[] = "speed";
  const sph_case_name known[FIELDS] = {
      [DENSITY] = {.name = density, .value = 990, .power = {1, -3}},
      [PRESSURE] = {.name = pressure, .value = 1234, .power = {1, -1, -2}},
      [ENERGY] = {.name = energy, .value = 567, .power = {0, 2, -2}},
      [TEMPERATURE] = {.name = temperature, .value = 299, .power = {0, 0, 0, 1}},
      [SPEED] = {.name = speed, .value = 1.7, .power = {0, 1, -1}},
      [SCALAR] = {.name = (char *)scalar, .value = 0.31}}; /* NOLINT: nobody writes to it */
  memcpy(names, known, sizeof known);
  memcpy(names[SCALAR].power, power, sizeof names[SCALAR].power);
  memcpy(names + FIELDS, c->timed, (size_t)c->timed_n * sizeof *names);
  return FIELDS + c->timed_n;
}

int sph_case_source_react(const sph_case *c, sph_sim *sim, const char *scalar,
                          const sph_case_node *node, sph_term *term, sph_error *error)
{
  static const double plain[SPH_SI_BASES];
  sph_case_name names[SPH_CASE_SOURCE_NAMES];
  sph_case_value value;
  source *it = SPH_NEW(source, 1, "a source", error);
  if (!it) return SPH_ERR_MEMORY;
  it->sim = sim;
  it->fields = FIELDS;
  const int n = sph_case_source_names(c, scalar, plain, names);
  it->formula[0] = sph_case_value_formula_create(node->text, names, n, c->dim, &value);
  if (!it->formula[0]) {
    release(it);
    return sph_case_schema_fail(c, error, node, 1, value.column, "source: %s", value.problem);
  }
  sph_case_source_describe(c, scalar, "source", node, it->what[0]);
  term->body = react;
  term->ctx = it;
  term->free = release;
  return SPH_OK;
}
