/* Every place, its row, its body. */
#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "operator_data.h"

enum { PARALLEL_MIN = 16 }; /* places a thread */

/* What all threads share. */
typedef struct sweep {
  const sph_operator *op;
  const sph_places *places;
  sph_row_task rows;
  sph_row_collect *collect;
  sph_row_weigh *weigh;
  sph_operator_body *body;
  const void *task;
  int rungs;
} sweep;

/* What became of some places. */
typedef struct outcome {
  long lowered;  /* how many took a simpler form */
  long singular; /* lowest number of those that have none; LONG_MAX: there is none */
} outcome;

static sweep sweep_of(const sph_operator *op, sph_operator_body *body, const void *task, int rungs)
{
  const int dim = op->def.dim, set = op->probing;
  const sph_list list = sph_neighbors_list(op->neighbors, set, 0);
  const double h = op->def.h, H = sph_kernel_support(op->kernel) * h;
  const sph_operator_table *table = sph_operator_loop(op->isa);
  double h_to_dim = 1;
  for (int d = 0; d < dim; d++) h_to_dim *= h;
  const double sigma = sph_kernel_sigma(op->kernel, dim) / h_to_dim;
  sweep w = {.op = op,
             .places = set ? &op->probes : &op->points,
             .rows = {.V = op->V,
                      .number = op->points.order,
                      .first = list.first,
                      .runs = list.runs,
                      .shift = sph_neighbors_shifts(op->neighbors, NULL),
                      .H2 = H * H,
                      .inverse_h = 1 / h,
                      .scale_w = sigma,
                      .scale_f = sigma / (h * h)},
             .collect = table->collect[dim - 1],
             .weigh = table->weigh[op->number][dim - 1],
             .body = body,
             .task = task,
             .rungs = op->def.lower_order ? rungs : 1};
  for (int d = 0; d < dim; d++) w.rows.x[d] = op->points.x[d];
  return w;
}

static void fill(const sweep *w, long s, sph_row *row)
{
  double x[3] = {0};
  for (int d = 0; d < w->op->def.dim; d++) x[d] = w->places->x[d][s];
  row->i = w->places->order[s];
  w->collect(&w->rows, s / sph_cpu_lanes(w->op->isa), x, row);
  w->weigh(&w->rows, row);
}

static outcome visit(const sweep *w, long begin, long end, sph_row *row)
{
  outcome o = {0, LONG_MAX};
  for (long s = begin; s < end; s++) {
    int rung = 0;
    fill(w, s, row);
    while (rung < w->rungs && w->body(w->task, row, rung)) rung++;
    if (rung == w->rungs)
      o.singular = row->i < o.singular ? row->i : o.singular;
    else
      o.lowered += rung > 0;
  }
  return o;
}

/* "(0.1, 0.2) m" */
static void write_place(int dim, const double *x, char *text, size_t size)
{
  size_t n = 0;
  for (int d = 0; d < dim && n < size; d++)
    n += (size_t)snprintf(text + n, size - n, "%s%g", d ? ", " : "(", x[d]);
  if (n < size) snprintf(text + n, size - n, ") m");
}

/* The place at fault: where it is, how many are near it. */
static int report(const sweep *w, const char *name, long i, sph_error *error)
{
  const int dim = w->op->def.dim;
  char where[100] = "";
  long near = 0;
  for (long s = 0; s < w->places->n; s++) {
    if (w->places->order[s] != i) continue;
    double x[3] = {0};
    for (int d = 0; d < dim; d++) x[d] = w->places->x[d][s];
    write_place(dim, x, where, sizeof where);
    fill(w, s, &w->op->row[0]);
    near = w->op->row[0].n - !w->op->probing;
  }
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "%s: singular moment matrix at %s %ld, %s, which has %ld neighbour%s within "
                       "%g m; right are more, in all directions (a larger h), or lower_order = 1",
                       name, w->op->probing ? "probe" : "point", i, where, near,
                       near == 1 ? "" : "s", sqrt(w->rows.H2));
}

int sph_operator_each(sph_operator *op, const char *name, sph_operator_body *body, const void *task,
                      int rungs, sph_error *error)
{
  const sweep w = sweep_of(op, body, task, rungs);
  const long n = w.places->n, threads = op->def.threads;
  long lowered = 0, singular = LONG_MAX;
#pragma omp parallel for num_threads(op->def.threads) schedule(static, 1)                         \
    reduction(+ : lowered) reduction(min : singular) if (n > PARALLEL_MIN * threads)
  for (long t = 0; t < threads; t++) {
    const outcome o = visit(&w, n * t / threads, n * (t + 1) / threads, &op->row[t]);
    lowered += o.lowered;
    singular = o.singular < singular ? o.singular : singular;
  }
  op->lowered = lowered;
  return singular < LONG_MAX ? report(&w, name, singular, error) : SPH_OK;
}
