#include "case_source.h"

#include <string.h>

#include "memory.h"

#define child_of sph_case_reader_find

enum { CHUNK = 256 };

typedef struct source {
  sph_case_formula *formula[3]; /* NULL: there is no such direction; heating: the first */
} source;

static void release(void *ctx)
{
  source *it = ctx;
  for (int d = 0; d < 3; d++) sph_case_value_formula_free(it->formula[d]);
  sph_memory_free(it);
}

/* rate[i] += formula(x_i, t). */
static int add_rate(sph_case_formula *formula, const sph_particles *s, double *rate)
{
  double q[CHUNK];
  for (long i = 0; rate && i < s->n; i += CHUNK) {
    const long n = s->n - i < CHUNK ? s->n - i : CHUNK;
    const double *x[3] = {NULL, NULL, NULL};
    for (int d = 0; d < s->dim; d++) x[d] = s->x[d] + i;
    if (sph_case_value_formula_at(formula, n, x, s->t, q)) return SPH_ERR_ARGUMENT;
    for (long k = 0; k < n; k++) rate[i + k] += q[k];
  }
  return SPH_OK;
}

static int heat(const sph_term *term, const sph_particles *s)
{
  const source *it = term->ctx;
  return add_rate(it->formula[0], s, s->du);
}

static int force(const sph_term *term, const sph_particles *s)
{
  const source *it = term->ctx;
  int status = SPH_OK;
  for (int d = 0; d < s->dim && !status; d++) status = add_rate(it->formula[d], s, s->a[d]);
  return status;
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
  for (int d = 0; node && d < 3; node = node->next, d++) {
    sph_case_value value;
    it->formula[d] =
        sph_case_value_formula_create(node->text, c->timed, c->timed_n, c->dim, &value);
    if (!it->formula[d]) {
      release(it);
      return sph_case_schema_fail(c, error, node, 1, value.column, "%s: %s",
                                  heats ? "power" : "acceleration", value.problem);
    }
    if (heats) break;
  }
  sph_sim_add_term(sim, (sph_term){.name = map->key,
                                   .body = heats ? heat : force,
                                   .reads = "",
                                   .ctx = it,
                                   .free = release});
  return SPH_OK;
}
