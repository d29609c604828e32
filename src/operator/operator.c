#include "sphode/operator.h"

#include <math.h>
#include <string.h>

#include "memory.h"
#include "operator_data.h"
#include "words.h"

enum { POINTS, PROBES }; /* sets of the search */

/* ---- create */

static const sph_kernel *find_kernel(const char *name, sph_error *error)
{
  const sph_kernel *kernel = sph_kernel_find(name ? name : "wendland-c2");
  if (kernel) return kernel;
  sph_words words = {.wanted = name};
  for (int k = 0; k < SPH_KERNELS; k++) sph_words_add(&words, sph_kernel_name(sph_kernel_get(k)));
  sph_error_set(error, SPH_ERR_ARGUMENT, "kernel \"%s\"; %sknown: %s", name, words.nearest,
                words.known);
  return NULL;
}

static int check(const sph_operator_def *def, sph_error *error)
{
  if (def->dim < 1 || def->dim > 3)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "dim = %d; right is 1, 2 or 3", def->dim);
  if (!(def->h > 0 && def->h < INFINITY))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "h = %g m; right is a finite number > 0", def->h);
  if (def->threads < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "threads = %d; right is >= 0", def->threads);
  return SPH_OK;
}

static sph_neighbors *make_neighbors(const sph_operator *op, const char *name, sph_error *error)
{
  const sph_operator_def *def = &op->def;
  sph_neighbors_def search = {.dim = def->dim,
                              .reach = sph_kernel_support(op->kernel) * def->h,
                              .dx = def->h / sph_kernel_h_over_dx(op->kernel),
                              .lanes = sph_cpu_lanes(op->isa),
                              .threads = def->threads,
                              .search = name};
  for (int d = 0; d < 3; d++) {
    search.periodic[d] = def->periodic[d];
    search.origin[d] = def->origin[d];
    search.length[d] = def->length[d];
  }
  return sph_neighbors_create(&search, error);
}

sph_operator *sph_operator_create(const sph_operator_def *def, sph_error *error)
{
  if (!def) {
    sph_error_set(error, SPH_ERR_ARGUMENT, "sph_operator_create: no definition (NULL)");
    return NULL;
  }
  const sph_kernel *kernel = find_kernel(def->kernel, error);
  const int isa = kernel ? sph_cpu_isa(NULL, error) : -1;
  if (isa < 0 || check(def, error)) return NULL;
  sph_operator *op = SPH_NEW(sph_operator, 1, "operators", error);
  if (!op) return NULL;
  op->def = *def;
  op->def.kernel = op->def.search = NULL;
  if (op->def.threads == 0) op->def.threads = 1;
  op->kernel = kernel;
  op->isa = isa;
  while (sph_kernel_get(op->number) != kernel) op->number++;
  op->neighbors = make_neighbors(op, def->search, error);
  op->row = op->neighbors ? SPH_NEW(sph_row, op->def.threads, "rows of operators", error) : NULL;
  if (op->row) return op;
  sph_operator_free(op);
  return NULL;
}

static void free_places(sph_places *places)
{
  for (int d = 0; d < 3; d++) sph_memory_free(places->x[d]);
  *places = (sph_places){0};
}

/* The op has no points then. */
static void free_points(sph_operator *op)
{
  free_places(&op->points);
  free_places(&op->probes);
  sph_memory_free(op->V);
  sph_memory_free(op->rho);
  op->V = op->rho = NULL;
  op->probing = op->ready = 0;
}

void sph_operator_free(sph_operator *op)
{
  if (!op) return;
  free_points(op);
  sph_neighbors_free(op->neighbors);
  sph_memory_free(op->values);
  sph_memory_free(op->numbers);
  sph_memory_free(op->row);
  sph_memory_free(op);
}

/* ---- points and probes */

/* Sorts the places; positions that cannot be are the caller's error here. */
static int sort(sph_operator *op, int set, long n, const double *const x[], sph_error *error)
{
  static const double *const none[3];
  sph_error why = {0};
  for (int d = 0; n > 0 && d < op->def.dim; d++)
    if (!x || !x[d])
      return sph_error_set(error, SPH_ERR_ARGUMENT, "operators: x[%d] is NULL; right is [%d][%ld]",
                           d, op->def.dim, n);
  int status = sph_neighbors_sort(op->neighbors, set, n, n > 0 ? x : none, &why);
  if (status)
    sph_error_set(error, status < 0 ? status : SPH_ERR_ARGUMENT, "operators: %s", why.text);
  return status > 0 ? SPH_ERR_ARGUMENT : status;
}

/* Sorted, wrapped copy of their positions. */
static int place(sph_operator *op, sph_places *places, int set, long n, const double *const x[],
                 sph_error *error)
{
  free_places(places);
  int status = sort(op, set, n, x, error);
  for (int d = 0; !status && d < op->def.dim; d++) {
    places->x[d] = SPH_NEW(double, n, "positions of operators", error);
    if (!places->x[d]) status = SPH_ERR_MEMORY;
  }
  if (status) return status;
  places->n = n;
  places->order = sph_neighbors_order(op->neighbors, set);
  for (int d = 0; d < op->def.dim; d++) {
    const double *wrap = sph_neighbors_wrap(op->neighbors, set, d);
    for (long s = 0; s < n; s++) {
      const long i = places->order[s];
      places->x[d][s] = x[d][i] - (wrap ? wrap[i] * op->def.length[d] : 0);
    }
  }
  return SPH_OK;
}

/* Room in the rows for all sources of any block. */
static int reserve_rows(sph_operator *op, const sph_list *list, sph_error *error)
{
  enum { ARRAYS = 6 };
  long most = 0;
  for (long b = 0; b < list->blocks; b++) {
    long n = 0;
    for (long k = list->first[b]; k < list->first[b + 1]; k++) n += sph_run_count(list->runs[k]);
    most = n > most ? n : most;
  }
  most += SPH_ROW_PAD;
  if (most > op->row_room) {
    const long room = most + most / 8;
    double *values = SPH_NEW(double, ARRAYS *room * op->def.threads, "rows of operators", error);
    int *numbers = SPH_NEW(int, room * op->def.threads, "rows of operators", error);
    if (!values || !numbers) {
      sph_memory_free(values);
      sph_memory_free(numbers);
      return SPH_ERR_MEMORY;
    }
    sph_memory_free(op->values);
    sph_memory_free(op->numbers);
    op->values = values, op->numbers = numbers, op->row_room = room;
  }
  for (int t = 0; t < op->def.threads; t++) {
    double *values = op->values + ARRAYS * op->row_room * t;
    sph_row *row = &op->row[t];
    for (int d = 0; d < 3; d++) row->r[d] = values + d * op->row_room;
    row->r2 = values + 3 * op->row_room;
    row->VW = values + 4 * op->row_room;
    row->VF = values + 5 * op->row_room;
    row->j = op->numbers + op->row_room * t;
  }
  return SPH_OK;
}

static int build(sph_operator *op, int set, sph_error *error)
{
  int status = sph_neighbors_build(op->neighbors, set, POINTS, error);
  if (status) return status;
  const sph_list list = sph_neighbors_list(op->neighbors, set, POINTS);
  return reserve_rows(op, &list, error);
}

static int check_positive(const char *what, const char *unit, long n, const double *a,
                          sph_error *error)
{
  for (long i = 0; i < n; i++)
    if (!(a[i] > 0 && a[i] < INFINITY))
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "operators: %s of point %ld is %g %s; right is a finite number > 0",
                           what, i, a[i], unit);
  return SPH_OK;
}

static int copy_weights(sph_operator *op, const double *volume, const double *density,
                        sph_error *error)
{
  const long n = op->points.n;
  op->V = SPH_NEW(double, n, "volumes of operators", error);
  if (!op->V) return SPH_ERR_MEMORY;
  for (long s = 0; s < n; s++) op->V[s] = volume[op->points.order[s]];
  if (!density) return SPH_OK;
  op->rho = SPH_NEW(double, n, "densities of operators", error);
  if (!op->rho) return SPH_ERR_MEMORY;
  if (n) memcpy(op->rho, density, (size_t)n * sizeof *density);
  return SPH_OK;
}

int sph_operator_set_points(sph_operator *op, long n, const double *const x[], const double *volume,
                            const double *density, sph_error *error)
{
  if (!op) return sph_error_set(error, SPH_ERR_STATE, "sph_operator_set_points: no op (NULL)");
  if (n < 0 || (n > 0 && !volume))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "operators: %ld points, volume %s; right is >= 0"
                         " points, each with its volume",
                         n, volume ? "given" : "NULL");
  free_points(op);
  int status = n ? check_positive("volume", "m^dim", n, volume, error) : SPH_OK;
  if (!status && density) status = check_positive("density", "kg/m^dim", n, density, error);
  if (!status) status = place(op, &op->points, POINTS, n, x, error);
  if (!status) status = copy_weights(op, volume, density, error);
  if (!status) status = build(op, POINTS, error);
  op->ready = !status;
  return status;
}

int sph_operator_set_probes(sph_operator *op, long n, const double *const x[], sph_error *error)
{
  if (!op || !op->ready)
    return sph_error_set(error, SPH_ERR_STATE,
                         "sph_operator_set_probes: call sph_operator_set_points first");
  if (n < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "operators: %ld probes; right is >= 0", n);
  op->probing = 0;
  if (!x) return SPH_OK;
  int status = place(op, &op->probes, PROBES, n, x, error);
  if (!status) status = build(op, PROBES, error);
  op->probing = !status;
  return status;
}

long sph_operator_lowered(const sph_operator *op) { return op ? op->lowered : 0; }

/* ---- what all operators ask */

int sph_operator_check(const sph_operator *op, const char *name, int field_there, sph_error *error)
{
  if (!op || !op->ready)
    return sph_error_set(error, SPH_ERR_STATE, "%s: call sph_operator_set_points first", name);
  if (field_there && op->probing)
    return sph_error_set(error, SPH_ERR_STATE,
                         "%s: needs the field at the place itself, which a probe has not; right "
                         "are interpolate, shepard, cspm, mls, or \"plain\"",
                         name);
  return SPH_OK;
}

int sph_operator_need(const char *name, const char *what, int n, const double *const array[],
                      sph_error *error)
{
  for (int k = 0; k < n; k++)
    if (!array || !array[k])
      return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: %s[%d] is NULL; right are %d array%s",
                           name, what, k, n, n == 1 ? "" : "s");
  return SPH_OK;
}
