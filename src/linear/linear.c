/* The table of methods, and what all of them check. */
#include "linear.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "keep.h"
#include "linear_data.h"
#include "memory.h"
#include "name.h"

static const sph_linear_method *const table[] = {&sph_linear_auto,
                                                 &sph_linear_pcg_jacobi,
                                                 &sph_linear_ic0,
                                                 &sph_linear_cholmod_supernodal,
                                                 &sph_linear_cholmod_simplicial,
                                                 &sph_linear_klu};
enum { METHODS = sizeof table / sizeof table[0] };

const char *sph_linear_name(int k) { return k >= 0 && k < METHODS ? table[k]->name : NULL; }

static const sph_linear_method *unknown(const char *name, sph_error *error)
{
  char known[200] = "";
  const char *nearest = table[0]->name;
  for (int k = 0; k < METHODS; k++) {
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", k ? ", " : "", table[k]->name);
    if (sph_name_distance(name, table[k]->name) < sph_name_distance(name, nearest))
      nearest = table[k]->name;
  }
  sph_error_set(error, SPH_ERR_ARGUMENT,
                "linear solver \"%.60s\" is unknown; the nearest is \"%s\", known are %s", name,
                nearest, known);
  return NULL;
}

static const sph_linear_method *find(const char *name, sph_error *error)
{
  if (!name) return &sph_linear_auto;
  for (int k = 0; k < METHODS; k++)
    if (!strcmp(name, table[k]->name)) return table[k];
  return unknown(name, error);
}

sph_linear *sph_linear_create_method(const sph_linear_method *method, int threads, sph_error *error)
{
  sph_linear *solver = SPH_NEW(sph_linear, 1, "a linear solver", error);
  if (!solver) return NULL;
  solver->method = solver->used = method;
  solver->threads = threads > 1 ? threads : 1;
  if (!method->create(solver, error)) return solver;
  sph_linear_free(solver);
  return NULL;
}

sph_linear *sph_linear_create(const char *name, int threads, sph_error *error)
{
  const sph_linear_method *method = find(name, error);
  return method ? sph_linear_create_method(method, threads, error) : NULL;
}

int sph_linear_refuse(sph_linear *solver, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(solver->reason, sizeof solver->reason, format, arguments);
  va_end(arguments);
  return SPH_RETRY;
}

static int check(const sph_linear_task *task, sph_error *error)
{
  if (task->A->n < 0 || task->columns < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "linear solver: %ld rows, %d columns", task->A->n,
                         task->columns);
  if (!(task->tolerance > 0) || !isfinite(task->tolerance))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "linear solver: tolerance = %g; right is a finite number > 0",
                         task->tolerance);
  return SPH_OK;
}

/* A diagonal that is not > 0 shows at once what no method could solve. */
static int check_diagonal(sph_linear *solver, const sph_csr *A)
{
  for (long i = 0; i < A->n; i++)
    if (!(A->diagonal[i] > 0) || !isfinite(A->diagonal[i]) || !(A->floor[i] > 0))
      return sph_linear_refuse(
          solver, "row %ld has %g on the diagonal and the floor %g; right are finite numbers > 0",
          i, A->diagonal[i], A->floor[i]);
  return SPH_OK;
}

static int prepare(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  int change = SPH_LINEAR_PATTERN;
  if (solver->has_pattern && solver->pattern == task->pattern) {
    if (solver->has_values && solver->values == task->values) return SPH_OK;
    change = SPH_LINEAR_VALUES;
  }
  solver->has_pattern = solver->has_values = 0;
  int status = check_diagonal(solver, task->A);
  if (!status) status = solver->method->prepare(solver, task->A, change, error);
  if (status) return status;
  solver->pattern = task->pattern;
  solver->values = task->values;
  solver->has_pattern = solver->has_values = 1;
  return SPH_OK;
}

static int check_solution(sph_linear *solver, const sph_linear_task *task)
{
  for (int c = 0; c < task->columns; c++)
    for (long i = 0; i < task->A->n; i++)
      if (!isfinite(task->x[c][i]))
        return sph_linear_refuse(solver, "the solution is not finite: %g in row %ld of column %d",
                                 task->x[c][i], i, c);
  return SPH_OK;
}

int sph_linear_solve(sph_linear *solver, const sph_linear_task *task, sph_error *error)
{
  solver->reason[0] = '\0';
  solver->stats.last = 0;
  int status = check(task, error);
  if (status || task->A->n == 0 || task->columns == 0) return status;
  status = prepare(solver, task, error);
  if (!status) status = solver->method->solve(solver, task, error);
  if (!status) status = check_solution(solver, task);
  if (!status) solver->stats.solves++;
  return status;
}

int sph_linear_keep(sph_linear *solver, sph_keep *keep)
{
  if (!solver->method->keep) return SPH_OK;
  sph_keep_int(keep, "has_pattern", &solver->has_pattern);
  sph_keep_int(keep, "has_values", &solver->has_values);
  sph_keep_integer(keep, "pattern", 1, &solver->pattern);
  sph_keep_integer(keep, "values", 1, &solver->values);
  return solver->method->keep(solver, keep);
}

const char *sph_linear_used(const sph_linear *solver) { return solver->used->name; }

const char *sph_linear_reason(const sph_linear *solver) { return solver->reason; }

void sph_linear_get_stats(const sph_linear *solver, sph_linear_stats *stats)
{
  *stats = solver->stats;
}

void sph_linear_free(sph_linear *solver)
{
  if (!solver) return;
  solver->method->free(solver);
  sph_memory_free(solver);
}
