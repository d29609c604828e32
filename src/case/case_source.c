#include "case_source.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "memory.h"

#define child_of sph_case_reader_find

enum { CHUNK = 256 };

enum { WHAT = 300 };

typedef struct source {
  sph_sim *sim;
  sph_case_formula *formula[3]; /* NULL: there is no such direction; heating: the first */
  char what[3][WHAT];           /* "file:line:column: body-force: acceleration 'sqrt(t)'" */
} source;

static void release(void *ctx)
{
  source *it = ctx;
  for (int d = 0; d < 3; d++) sph_case_value_formula_free(it->formula[d]);
  sph_memory_free(it);
}

/* Says where formula d is not finite: at one of n particles from the first one on. */
static int fail(const source *it, int d, const sph_particles *s, long first, long n)
{
  double value = 0;
  const double *x[3] = {NULL, NULL, NULL};
  char place[100] = "";
  long i = first;
  for (; i < first + n; i++) {
    for (int axis = 0; axis < s->dim; axis++) x[axis] = s->x[axis] + i;
    if (sph_case_value_formula_at(it->formula[d], 1, x, s->t, &value)) break;
  }
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
    const double *x[3] = {NULL, NULL, NULL};
    for (int axis = 0; axis < s->dim; axis++) x[axis] = s->x[axis] + i;
    if (sph_case_value_formula_at(it->formula[d], n, x, s->t, q)) return fail(it, d, s, i, n);
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

static void describe(const sph_case *c, const char *term, const char *key,
                     const sph_case_node *node, char what[WHAT])
{
  sph_error error = {0};
  sph_case_schema_fail(c, &error, node, 1, 0, "%s: %s '%.100s'", term, key, node->text);
  snprintf(what, WHAT, "%.*s", WHAT - 1, error.text);
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
    describe(c, map->key, heats ? "power" : "acceleration", node, it->what[d]);
    if (heats) break;
  }
  sph_sim_add_term(sim, (sph_term){.name = map->key,
                                   .body = heats ? heat : force,
                                   .reads = "",
                                   .ctx = it,
                                   .free = release});
  return SPH_OK;
}
