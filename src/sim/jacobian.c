/* The Jacobian as a sparse matrix.  Of a field other than the position all rates of a particle
 * depend on all that its set of particles has; dx/dt = v on v alone, but with XSPH. */
#include <string.h>

#include "jacobian_data.h"
#include "memory.h"
#include "sim_prepare.h"
#include "sim_tangent.h"

static int group_of(const sph_sim *sim, int segment)
{
  const long offset = sim->layout.segment[segment].offset;
  int g = 0;
  for (int k = 0; k < sim->groups; k++)
    if (!sim->group[k]->wall && sim->group[k]->offset[SPH_POSITION][0] <= offset) g = k;
  return g;
}

/* ---- rows and columns ---- */

static int make_rows(jacobian *J)
{
  sph_sim *sim = J->sim;
  const sph_layout *layout = &sim->layout;
  J->particles = sph_jacobian_pattern_base(sim, J->base);
  J->open.n = layout->entries;
  J->place = SPH_NEW(long, layout->entries, "places of a Jacobian", &sim->error);
  J->segment_row = SPH_NEW(long, layout->segments + 1, "rows of a Jacobian", &sim->error);
  J->first = SPH_NEW(long, layout->entries + 1, "rows of a Jacobian", &sim->error);
  J->colour = SPH_NEW(int, J->particles, "colours", &sim->error);
  J->s = SPH_NEW(double, layout->length, "a direction", &sim->error);
  J->out = SPH_NEW(double, layout->length, "a product", &sim->error);
  if (sim->error.status) return sim->error.status;
  long row = 0;
  for (int k = 0; k < layout->segments; k++) {
    J->segment_row[k] = row;
    for (long i = 0; i < layout->segment[k].n; i++) J->place[row++] = layout->segment[k].offset + i;
  }
  J->segment_row[layout->segments] = row;
  J->open.place = J->place;
  return SPH_OK;
}

/* Is that a position whose rate is its velocity alone? */
static int plain(const sph_sim *sim, int segment)
{
  return sim->layout.segment[segment].role == SPH_ROLE_POSITION &&
         !(sim->part[SPH_WHOLE].rates & SPH_XSPH);
}

/* Where the particles of group g begin and end in set i. */
static void range(const jacobian *J, long i, int g, long *begin, long *end)
{
  const int *item = J->set.item;
  const long from = J->base[g], to = from + J->sim->group[g]->n;
  *begin = J->set.first[i];
  while (*begin < J->set.first[i + 1] && item[*begin] < from) ++*begin;
  *end = *begin;
  while (*end < J->set.first[i + 1] && item[*end] < to) ++*end;
}

/* The columns of row (segment k, particle i of its group), from column[at] on; column NULL: only
 * counted.  Returns how many. */
static long columns_of(const jacobian *J, int k, long i, int *column)
{
  const sph_layout *layout = &J->sim->layout;
  long count = 0;
  if (plain(J->sim, k)) {
    if (column) column[0] = (int)(J->segment_row[layout->segment[k].partner] + i);
    return 1;
  }
  for (int q = 0; q < layout->segments; q++) {
    long begin, end;
    const int g = group_of(J->sim, q);
    range(J, J->base[group_of(J->sim, k)] + i, g, &begin, &end);
    for (long p = begin; p < end; p++, count++)
      if (column) column[count] = (int)(J->segment_row[q] + J->set.item[p] - J->base[g]);
  }
  return count;
}

static int same_sets(const sph_sets *a, const sph_sets *b)
{
  return a->n == b->n && a->first && b->first &&
         !memcmp(a->first, b->first, (size_t)(a->n + 1) * sizeof *a->first) &&
         !memcmp(a->item, b->item, (size_t)a->first[a->n] * sizeof *a->item);
}

static int make_columns(jacobian *J)
{
  sph_sim *sim = J->sim;
  const sph_layout *layout = &sim->layout;
  long row = 0;
  for (int k = 0; k < layout->segments; k++)
    for (long i = 0; i < layout->segment[k].n; i++, row++)
      J->first[row + 1] = J->first[row] + columns_of(J, k, i, NULL);
  sph_memory_free(J->column);
  sph_memory_free(J->value);
  J->column = SPH_NEW(int, J->first[row], "columns of a Jacobian", &sim->error);
  J->value = SPH_NEW(double, J->first[row], "values of a Jacobian", &sim->error);
  if (sim->error.status) return sim->error.status;
  for (int k = 0, r = 0; k < layout->segments; k++)
    for (long i = 0; i < layout->segment[k].n; i++, r++)
      columns_of(J, k, i, J->column + J->first[r]);
  J->open.first = J->first;
  J->open.column = J->column;
  J->open.value = J->value;
  J->open.patterns++;
  return SPH_OK;
}

/* Number of the product that fills column c, of segment q. */
static long product_of(const jacobian *J, int q, long c)
{
  const long number = J->base[group_of(J->sim, q)] + c - J->segment_row[q];
  return (long)q * J->colours + J->colour[number];
}

/* Entries by the product that fills them. */
static int sort_entries(jacobian *J)
{
  sph_sim *sim = J->sim;
  const int segments = sim->layout.segments;
  const long products = (long)segments * J->colours, n = J->open.n, entries = J->first[n];
  sph_memory_free(J->filled);
  sph_memory_free(J->entry);
  sph_memory_free(J->row);
  J->filled = SPH_NEW(long, products + 2, "products of a Jacobian", &sim->error);
  J->entry = SPH_NEW(long, entries, "entries of a Jacobian", &sim->error);
  J->row = SPH_NEW(int, entries, "entries of a Jacobian", &sim->error);
  if (sim->error.status) return sim->error.status;
  for (int pass = 0; pass < 2; pass++) {
    for (long row = 0; row < n; row++) {
      int q = 0; /* columns rise, so do their segments */
      for (long k = J->first[row]; k < J->first[row + 1]; k++) {
        while (J->column[k] >= J->segment_row[q + 1]) q++;
        const long product = product_of(J, q, J->column[k]);
        if (!pass) {
          J->filled[product + 2]++;
          continue;
        }
        J->row[J->filled[product + 1]] = (int)row;
        J->entry[J->filled[product + 1]++] = k;
      }
    }
    for (long p = 0; !pass && p < products; p++) J->filled[p + 2] += J->filled[p + 1];
  }
  return SPH_OK;
}

static int make_pattern(jacobian *J)
{
  sph_sets set = {0};
  int status = sph_jacobian_pattern_make(J->sim, J->lagged, &set);
  if (!status && same_sets(&set, &J->set)) {
    sph_jacobian_pattern_free(&set);
    return SPH_OK;
  }
  sph_jacobian_pattern_free(&J->set);
  J->set = set;
  if (!status) J->colours = sph_jacobian_pattern_colour(&J->set, J->colour, &J->sim->error);
  if (!status && J->colours < 0) status = J->colours;
  if (!status) status = make_columns(J);
  return status ? status : sort_entries(J);
}

/* ---- values ---- */

/* One in every entry of segment q whose particle has that colour. */
static void direct(const jacobian *J, int colour, int q)
{
  const sph_layout *layout = &J->sim->layout;
  const sph_segment *it = &layout->segment[q];
  const int *colours = J->colour + J->base[group_of(J->sim, q)];
  memset(J->s, 0, (size_t)layout->length * sizeof *J->s);
  for (long i = 0; i < it->n; i++) J->s[it->offset + i] = colours[i] == colour;
}

static int fill(jacobian *J, double t, const double *y)
{
  int status = SPH_OK;
  J->open.products = 0;
  for (int q = 0; !status && q < J->sim->layout.segments; q++)
    for (int colour = 0; !status && colour < J->colours; colour++) {
      const long product = (long)q * J->colours + colour;
      const long begin = J->filled[product], end = J->filled[product + 1];
      if (begin == end) continue;
      direct(J, colour, q);
      status = sph_sim_tangent(J->sim, SPH_WHOLE, t, y, J->s, NULL, J->lagged, J->out);
      for (long k = begin; k < end; k++) J->value[J->entry[k]] = J->out[J->place[J->row[k]]];
      J->open.products++;
    }
  return status;
}

int sph_jacobian_evaluate_at(sph_jacobian *open, double t, const double *y)
{
  jacobian *J = (jacobian *)open;
  if (!J || !sph_sim_data_ok(J->sim)) return J ? sph_sim_status(J->sim) : SPH_ERR_ARGUMENT;
  sph_sim *sim = J->sim;
  int status = sph_sim_tangent(sim, SPH_WHOLE, t, y, NULL, NULL, 0, J->out); /* lists, records */
  if (!status) status = make_pattern(J);
  if (!status) status = fill(J, t, y);
  sim->derived = 0; /* pressure etc. are those of y */
  return status;
}

int sph_jacobian_evaluate(sph_jacobian *open)
{
  const jacobian *J = (const jacobian *)open;
  if (!J) return SPH_ERR_ARGUMENT;
  int status = sph_jacobian_evaluate_at(open, J->sim->time, sph_nvector_data(J->sim->shown));
  if (status > 0)
    status = sph_sim_fail(J->sim, SPH_ERR_STEP, "no Jacobian at t = %g s: %s", J->sim->time,
                          J->sim->retry);
  return status;
}

sph_jacobian *sph_jacobian_create(sph_sim *sim, const sph_jacobian_def *def)
{
  if (!sph_sim_data_ok(sim) || sph_sim_prepare(sim) || sph_sim_tangent_fit(sim)) return NULL;
  jacobian *J = SPH_NEW(jacobian, 1, "a Jacobian", &sim->error);
  if (!J) return NULL;
  J->sim = sim;
  J->lagged = def && def->lagged;
  if (!make_rows(J)) return &J->open;
  sph_jacobian_free(&J->open);
  return NULL;
}

void sph_jacobian_free(sph_jacobian *open)
{
  jacobian *J = (jacobian *)open;
  if (!J) return;
  sph_jacobian_pattern_free(&J->set);
  sph_memory_free(J->place);
  sph_memory_free(J->segment_row);
  sph_memory_free(J->colour);
  sph_memory_free(J->first);
  sph_memory_free(J->column);
  sph_memory_free(J->value);
  sph_memory_free(J->filled);
  sph_memory_free(J->entry);
  sph_memory_free(J->row);
  sph_memory_free(J->s);
  sph_memory_free(J->out);
  sph_memory_free(J);
}

long sph_jacobian_row(const sph_jacobian *open, const sph_group *group, const char *field,
                      int component)
{
  const jacobian *J = (const jacobian *)open;
  const double *rate = J ? sph_group_rate(group, field, component) : NULL;
  if (!rate || group->sim != J->sim) return -1;
  const long offset = rate - sph_nvector_data(J->sim->ydot);
  for (int k = 0; k < J->sim->layout.segments; k++)
    if (J->sim->layout.segment[k].offset == offset) return J->segment_row[k];
  return -1;
}
