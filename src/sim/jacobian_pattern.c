/* Dependencies are followed as the phases hand them on:
 *
 *   record of a fluid particle   itself; with a summed density all within the support
 *   sums of a wall               records of fluids within the support
 *   sums of a fluid              records of fluids and walls within the support
 *   its rates                    its sums; with Antuono's gradients those of its neighbours, too */
#include "jacobian_pattern.h"

#include <stdlib.h>
#include <string.h>

#include "cpu.h"
#include "memory.h"

void sph_jacobian_pattern_free(sph_sets *sets)
{
  sph_memory_free(sets->first);
  sph_memory_free(sets->item);
  *sets = (sph_sets){0};
}

/* ---- sets ---- */

static int by_number(const void *a, const void *b)
{
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

/* A growing list of sets: the one that is made goes to the end. */
typedef struct maker {
  sph_sets sets;
  long room; /* of item */
  int *mark; /* [marks] the set that a number is in already, + 1 */
  long made; /* sets so far */
  sph_error *error;
} maker;

static int maker_start(maker *m, long sets, long numbers)
{
  m->sets = (sph_sets){.n = sets};
  m->sets.first = SPH_NEW(long, sets + 1, "a pattern", m->error);
  m->mark = SPH_NEW(int, numbers, "marks of a pattern", m->error);
  m->made = m->room = 0;
  return m->sets.first && m->mark ? SPH_OK : SPH_ERR_MEMORY;
}

static int maker_add(maker *m, int number)
{
  long *end = &m->sets.first[m->made + 1];
  if (m->mark[number] == (int)m->made + 1) return SPH_OK;
  if (!m->sets.item || *end == m->room) {
    long room = m->room ? 2 * m->room : 1024;
    int status = sph_memory_grow((void **)&m->sets.item, (size_t)*end, (size_t)room, sizeof(int),
                                 "a pattern", m->error);
    if (status) return status;
    m->room = room;
  }
  m->mark[number] = (int)m->made + 1;
  m->sets.item[(*end)++] = number;
  return SPH_OK;
}

/* A whole set of others, or the number itself where there are none. */
static int maker_add_set(maker *m, const sph_sets *others, long k)
{
  int status = SPH_OK;
  if (!others) return maker_add(m, (int)k);
  for (long q = others->first[k]; !status && others->item && q < others->first[k + 1]; q++)
    status = maker_add(m, others->item[q]);
  return status;
}

static void maker_next(maker *m)
{
  long begin = m->sets.first[m->made], end = m->sets.first[m->made + 1];
  if (m->sets.item) qsort(m->sets.item + begin, (size_t)(end - begin), sizeof(int), by_number);
  if (++m->made < m->sets.n) m->sets.first[m->made + 1] = end;
}

/* What was made, or nothing after a failure. */
static int maker_end(maker *m, int status, sph_sets *to)
{
  sph_memory_free(m->mark);
  *to = m->sets;
  if (status) sph_jacobian_pattern_free(to);
  return status;
}

/* set i: the union of B(j) over j in A(i), and of D(j) over j in C(i); B NULL: of the j
 * themselves; C NULL: nothing. */
static int compose(const sph_sets *A, const sph_sets *B, const sph_sets *C, const sph_sets *D,
                   long numbers, sph_sets *to, sph_error *error)
{
  maker m = {.error = error};
  int status = maker_start(&m, A->n, numbers);
  for (long i = 0; !status && i < A->n; i++) {
    for (long k = A->first[i]; !status && k < A->first[i + 1]; k++)
      status = maker_add_set(&m, B, A->item[k]);
    for (long k = C ? C->first[i] : 0; !status && C && k < C->first[i + 1]; k++)
      status = maker_add_set(&m, D, C->item[k]);
    if (!status) maker_next(&m);
  }
  return maker_end(&m, status, to);
}

/* ---- neighbours ---- */

/* Numbers of fluids, or of walls, group after group. */
static long base_of(const sph_sim *sim, int walls, long base[SPH_SETS_MAX])
{
  long n = 0;
  for (int g = 0; g < sim->groups; g++) {
    base[g] = n;
    if (sim->group[g]->wall == walls) n += sim->group[g]->n;
  }
  return n;
}

long sph_jacobian_pattern_base(const sph_sim *sim, long base[SPH_SETS_MAX])
{
  return base_of(sim, 0, base);
}

/* Particles of group s, from number `base` on, within the support of the one at sorted place n of
 * group g. */
static int add_near(const sph_sim *sim, maker *m, int g, long n, int s, long base)
{
  const int *order = sph_neighbors_order(sim->neighbors, s);
  const sph_list list = sph_neighbors_list(sim->neighbors, g, s);
  const double(*shift)[3] = sph_neighbors_shifts(sim->neighbors, NULL);
  const double *i = sim->sorted[g].record + n * sim->sorted[g].stride;
  const double reach2 = sim->H * sim->H * (1 + 1e-12);
  const long b = n / sph_cpu_lanes(sim->isa);
  int status = SPH_OK;
  if (b >= list.blocks) return SPH_OK;
  for (long r = list.first[b]; !status && r < list.first[b + 1]; r++) {
    const sph_run run = list.runs[r];
    for (long k = sph_run_start(run); !status && k < sph_run_start(run) + sph_run_count(run); k++) {
      const double *j = sim->sorted[s].record + k * sim->sorted[s].stride;
      double r2 = 0;
      for (int d = 0; d < sim->dim; d++) {
        double x = i[d] - shift[sph_run_image(run)][d] - j[d];
        r2 += x * x;
      }
      if (r2 <= reach2) status = maker_add(m, (int)base + order[k]);
    }
  }
  return status;
}

/* For each fluid (or wall) particle all fluids (or walls) within the support. */
static int neighbours(const sph_sim *sim, int of_walls, int walls, sph_sets *to, sph_error *error)
{
  long base[SPH_SETS_MAX] = {0}, unused[SPH_SETS_MAX], most = 0;
  const long numbers = base_of(sim, walls, base);
  maker m = {.error = error};
  int status = maker_start(&m, base_of(sim, of_walls, unused), numbers);
  for (int g = 0; g < sim->groups; g++) most = sim->group[g]->n > most ? sim->group[g]->n : most;
  long *place = SPH_NEW(long, most, "sorted places", error);
  if (!place) status = SPH_ERR_MEMORY;
  for (int g = 0; !status && g < sim->groups; g++) {
    if (sim->group[g]->wall != of_walls) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
    for (long n = 0; n < sim->group[g]->n; n++) place[order[n]] = n;
    for (long i = 0; !status && i < sim->group[g]->n; i++) {
      for (int s = 0; !status && s < sim->groups; s++)
        if (sim->group[s]->wall == walls) status = add_near(sim, &m, g, place[i], s, base[s]);
      if (!status) maker_next(&m);
    }
  }
  sph_memory_free(place);
  return maker_end(&m, status, to);
}

int sph_jacobian_pattern_make(sph_sim *sim, int lagged, sph_sets *rows)
{
  const sph_part *whole = &sim->part[SPH_WHOLE];
  const int walls = whole->walls && !lagged, summed = sim->terms.summed;
  long unused[SPH_SETS_MAX], n = base_of(sim, 0, unused);
  sph_sets near = {0}, of_walls = {0}, of_fluids = {0}, wall_sums = {0}, sums = {0};
  sph_error *error = &sim->error;
  int status = neighbours(sim, 0, 0, &near, error);
  if (!status && walls) status = neighbours(sim, 0, 1, &of_fluids, error);
  if (!status && walls) status = neighbours(sim, 1, 0, &of_walls, error);
  const sph_sets *records = summed ? &near : NULL;
  if (!status && walls) status = compose(&of_walls, records, NULL, NULL, n, &wall_sums, error);
  if (!status)
    status = compose(&near, records, walls ? &of_fluids : NULL, &wall_sums, n, &sums, error);
  if (!status && whole->gradients && !lagged)
    status = compose(&near, &sums, NULL, NULL, n, rows, error);
  else if (!status) {
    *rows = sums;
    sums = (sph_sets){0};
  }
  sph_sets *all[] = {&near, &of_walls, &of_fluids, &wall_sums, &sums};
  for (int k = 0; k < 5; k++) sph_jacobian_pattern_free(all[k]);
  return status;
}

/* ---- colours ---- */

/* The other way round: for each number the sets that it is in. */
static int transposed(const sph_sets *A, sph_sets *to, sph_error *error)
{
  const long entries = A->first[A->n];
  *to = (sph_sets){.n = A->n};
  to->first = SPH_NEW(long, A->n + 2, "a pattern", error);
  to->item = SPH_NEW(int, entries, "a pattern", error);
  if (!to->first || !to->item) {
    sph_jacobian_pattern_free(to);
    return SPH_ERR_MEMORY;
  }
  for (long k = 0; k < entries; k++) to->first[A->item[k] + 2]++;
  for (long i = 0; i < A->n; i++) to->first[i + 2] += to->first[i + 1];
  for (long i = 0; i < A->n; i++)
    for (long k = A->first[i]; k < A->first[i + 1]; k++)
      to->item[to->first[A->item[k] + 1]++] = (int)i;
  return SPH_OK;
}

/* Greedy, in the order of numbers: the least colour that no particle has which shares a set. */
int sph_jacobian_pattern_colour(const sph_sets *rows, int *colour, sph_error *error)
{
  sph_sets columns;
  int status = transposed(rows, &columns, error), colours = 0;
  if (status) return status;
  int *taken = SPH_NEW(int, rows->n + 1, "colours", error); /* by which particle, + 1 */
  if (!taken) status = SPH_ERR_MEMORY;
  for (long j = 0; j < rows->n; j++) colour[j] = -1;
  for (long j = 0; !status && j < rows->n; j++) {
    for (long k = columns.first[j]; k < columns.first[j + 1]; k++) {
      const long i = columns.item[k];
      for (long q = rows->first[i]; q < rows->first[i + 1]; q++)
        if (colour[rows->item[q]] >= 0) taken[colour[rows->item[q]]] = (int)j + 1;
    }
    colour[j] = 0;
    while (taken[colour[j]] == (int)j + 1) colour[j]++;
    if (colour[j] >= colours) colours = colour[j] + 1;
  }
  sph_memory_free(taken);
  sph_jacobian_pattern_free(&columns);
  return status ? status : colours;
}
