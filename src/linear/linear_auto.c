/* The method that costs least by counts: entries, iterations of the last solve, solves per matrix
 * and matrices per pattern so far, and the fill of factors once that was looked for.  Never by
 * clocks or numbers of threads: a run takes the same course everywhere.
 *
 * Incomplete factors for the narrow matrices of 1D, of which they are nearly the whole factor, and
 * conjugate gradients with the diagonal for all others; Cholesky factors where they cost EDGE times
 * less by the figures below, which were measured: docs/linear-solvers.md. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "keep.h"
#include "linear_cholmod.h"
#include "linear_data.h"
#include "linear_loops.h"
#include "memory.h"

/* [ns] */
static const double ENTRY = 1, ROW = 12;          /* of an iteration: an entry, a row */
static const double ORDER = 90, ORDER_WIDE = 700; /* an entry of A, ordered and analysed */
static const double FLOP = 0.8, FACTOR = 6;       /* of factors: a flop, an entry of L */
static const double SOLVE = 1.2;                  /* an entry of L, a column */

static const double EDGE = 1.5;
static const double NARROW = 12;  /* entries in a row on average: 1D has fewer, 2D more */
static const double WELL = 30;    /* condition up to which the diagonal is good enough in 1D */
static const double LARGEST = 30; /* entries of L for one of A: more memory is not taken */
static const double ALIKE = 0.1;  /* difference of rows up to which fill is known */

enum { JACOBI, IC0, CHOLESKY, METHODS };

static const sph_linear_method *const method[METHODS] = {&sph_linear_pcg_jacobi, &sph_linear_ic0,
                                                         &sph_linear_cholmod};

typedef struct choice {
  sph_linear *with[METHODS];      /* made when first needed */
  long solves, solves_before;     /* with these values, with those before */
  long matrices, matrices_before; /* of this pattern, of that before */
  int ordered, factored;          /* Cholesky factors know this pattern, these values */
  uint64_t print;                 /* of the matrix */
  double condition;               /* 1/least floor over diagonal */
  double iterations;              /* of the last iterative solve, over the root of its condition */
  double spent;                   /* on iterations since fill was looked for [ns] */
  double rows, flops, entries;    /* of the A that was analysed, and of its L; rows = 0: none */
} choice;

static double entries(const sph_csr *A) { return (double)A->start[A->n]; }
static int narrow(const sph_csr *A) { return entries(A) <= NARROW * (double)A->n; }
static double largest(long a, long b) { return (double)(a > b ? a : b); }

/* ---- costs [ns] */

static double cost_of_iterations(const sph_linear_task *task, double iterations)
{
  int runs = (task->columns + SPH_LINEAR_WIDTH - 1) / SPH_LINEAR_WIDTH;
  return runs * iterations * (ENTRY * entries(task->A) + ROW * (double)task->A->n);
}

static double cost_of_order(const sph_csr *A)
{
  return (narrow(A) ? ORDER : ORDER_WIDE) * entries(A);
}

/* Of one solve by factors L, if patterns and values go on to last as long as they did. */
static double cost_of_factors(const choice *c, const sph_linear_task *task, double entries,
                              double flops)
{
  double solves = largest(c->solves + 1, c->solves_before);
  double matrices = largest(c->matrices, c->matrices_before);
  double order = c->ordered ? 0 : cost_of_order(task->A) / matrices;
  double factor = c->factored ? 0 : FLOP * flops + FACTOR * entries;
  return (order + factor) / solves + SOLVE * entries * task->columns;
}

/* ---- the choice */

static int make(choice *c, const sph_linear *solver, int k, sph_error *error)
{
  if (!c->with[k]) c->with[k] = sph_linear_create_method(method[k], solver->threads, error);
  return c->with[k] ? SPH_OK : SPH_ERR_MEMORY;
}

/* Is the fill of such a matrix known?  It is looked for when iterations have cost as much as that
 * does, and factors with no more entries than A would win.  *known: yes. */
static int look_for_fill(choice *c, sph_linear *solver, const sph_linear_task *task,
                         double iterative, int *known, sph_error *error)
{
  const sph_csr *A = task->A;
  const double n = (double)A->n, least = entries(A) / 2 + n;
  *known = fabs(n - c->rows) <= ALIKE * c->rows;
  if (*known || c->spent < cost_of_order(A)) return SPH_OK;
  if (EDGE * cost_of_factors(c, task, least, 0) > iterative) return SPH_OK;
  c->spent = 0;
  int status = make(c, solver, CHOLESKY, error);
  if (!status)
    status = sph_linear_cholmod_analyse(c->with[CHOLESKY], task, &c->flops, &c->entries, error);
  if (status) return status;
  c->rows = n;
  c->ordered = *known = 1;
  return SPH_OK;
}

static int pick(choice *c, sph_linear *solver, const sph_linear_task *task, int *k,
                sph_error *error)
{
  const sph_csr *A = task->A;
  const double iterative = cost_of_iterations(task, c->iterations * sqrt(c->condition));
  int known = 0;
  *k = narrow(A) && c->condition > WELL ? IC0 : JACOBI;
  if (c->iterations == 0) return SPH_OK; /* the first solve is to tell */
  int status = look_for_fill(c, solver, task, iterative, &known, error);
  if (status || !known || c->entries > LARGEST * entries(A)) return status;
  if (EDGE * cost_of_factors(c, task, c->entries, c->flops) < iterative) *k = CHOLESKY;
  return SPH_OK;
}

/* ---- the method */

static int create(sph_linear *solver, sph_error *error)
{
  choice *c = SPH_NEW(choice, 1, "a choice of linear solvers", error);
  solver->own = c;
  return c ? make(c, solver, JACOBI, error) : SPH_ERR_MEMORY;
}

/* A number that is another one for another diagonal (Fowler, Noll & Vo's hash), and so, but for a
 * chance that costs time only, for other values: a numbered matrix may be the one before again. */
static uint64_t print_of(const sph_csr *A)
{
  uint64_t print = 14695981039346656037u;
  for (long i = 0; i < A->n; i++) {
    uint64_t bits;
    memcpy(&bits, &A->diagonal[i], sizeof bits);
    print = (print ^ bits ^ bits >> 32) * 1099511628211u;
  }
  return print;
}

static int prepare(sph_linear *solver, const sph_csr *A, int change, sph_error *error)
{
  choice *c = solver->own;
  const uint64_t print = print_of(A);
  (void)error;
  if (change == SPH_LINEAR_VALUES && print == c->print) return SPH_OK;
  c->print = print;
  if (change == SPH_LINEAR_PATTERN) {
    c->matrices_before = c->matrices;
    c->matrices = 0;
    c->ordered = 0;
  }
  c->solves_before = c->solves;
  c->solves = 0;
  c->matrices++;
  c->factored = 0;
  c->condition = 1;
  for (long i = 0; i < A->n; i++) c->condition = fmax(c->condition, A->diagonal[i] / A->floor[i]);
  return SPH_OK;
}

static void add_stats(sph_linear_stats *to, const sph_linear_stats *after,
                      const sph_linear_stats *before)
{
  to->iterations += after->iterations - before->iterations;
  to->analyses += after->analyses - before->analyses;
  to->factorisations += after->factorisations - before->factorisations;
  to->last = after->last;
}

/* What an iterative solve tells of the next one. */
static void learn(choice *c, const sph_linear_task *task, long iterations, int incomplete)
{
  double n = (double)(incomplete ? 2 * iterations : iterations); /* each solves with L, too */
  c->iterations = (n + 1) / sqrt(c->condition);
  c->spent += cost_of_iterations(task, n + 1);
}

static int solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  choice *c = solver->own;
  int k, status = pick(c, solver, task, &k, error);
  if (!status) status = make(c, solver, k, error);
  if (status) return status;
  sph_linear *with = c->with[k];
  const sph_linear_stats before = with->stats;
  status = sph_linear_solve(with, task, error);
  add_stats(&solver->stats, &with->stats, &before);
  solver->used = with->method;
  if (status > 0) return sph_linear_refuse(solver, "%s: %s", with->method->name, with->reason);
  if (status < 0) return status;
  if (k == CHOLESKY)
    c->ordered = c->factored = 1;
  else
    learn(c, task, with->stats.last, k == IC0);
  c->solves++;
  return SPH_OK;
}

static int keep_choice(sph_linear *solver, sph_keep *keep)
{
  choice *c = solver->own;
  long counts[] = {c->solves,  c->solves_before, c->matrices,   c->matrices_before,
                   c->ordered, c->factored,      (long)c->print};
  double costs[] = {c->condition, c->iterations, c->spent, c->rows, c->flops, c->entries};
  sph_keep_integer(keep, "counts", sizeof counts / sizeof *counts, counts);
  int status = sph_keep_real(keep, "costs", sizeof costs / sizeof *costs, costs);
  c->solves = counts[0];
  c->solves_before = counts[1];
  c->matrices = counts[2];
  c->matrices_before = counts[3];
  c->ordered = (int)counts[4];
  c->factored = (int)counts[5];
  c->print = (uint64_t)counts[6];
  c->condition = costs[0];
  c->iterations = costs[1];
  c->spent = costs[2];
  c->rows = costs[3];
  c->flops = costs[4];
  c->entries = costs[5];
  return status;
}

static void done(sph_linear *solver)
{
  choice *c = solver->own;
  if (!c) return;
  for (int k = 0; k < METHODS; k++) sph_linear_free(c->with[k]);
  sph_memory_free(c);
}

const sph_linear_method sph_linear_auto = {.name = "auto",
                                           .create = create,
                                           .prepare = prepare,
                                           .solve = solve,
                                           .free = done,
                                           .keep = keep_choice};
