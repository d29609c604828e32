#include "sim_matrix.h"

#include <math.h>
#include <string.h>

#include "memory.h"
#include "tile_loops.h"

enum { BLOCKS = 64, ROWS = 1024 }; /* a thread's share */

static const double ROUNDING = 1e-9; /* relative: what is lost in squared distances is less */

/* ---- the pattern ---- */

static sph_masks *masks_of(const sph_pattern *pattern, int target, int source)
{
  return &pattern->masks[target * pattern->groups + source];
}

static sph_pair_task pairs_of(const sph_sim *sim, int target, int source, sph_list list)
{
  return (sph_pair_task){.target = sim->sorted[target].record,
                         .source = sim->sorted[source].record,
                         .target_stride = sim->sorted[target].stride,
                         .source_stride = sim->sorted[source].stride,
                         .first = list.first,
                         .runs = list.runs,
                         .shift = sph_neighbors_shifts(sim->neighbors, NULL)};
}

/* Room for the masks of a list, and where each block's begin. */
static int reserve_masks(sph_sim *sim, sph_masks *masks, sph_list list)
{
  int status = SPH_OK;
  if (list.blocks + 1 > masks->room_first) {
    status = sph_memory_grow((void **)&masks->first, 0, (size_t)(list.blocks + 1), sizeof(long),
                             "masks of a matrix", &sim->error);
    if (!status) masks->room_first = list.blocks + 1;
  }
  if (status) return status;
  masks->first[0] = 0;
  for (long b = 0; b < list.blocks; b++) {
    masks->first[b + 1] = masks->first[b];
    for (long r = list.first[b]; r < list.first[b + 1]; r++)
      masks->first[b + 1] += sph_run_count(list.runs[r]);
  }
  long count = masks->first[list.blocks];
  if (count <= masks->room) return SPH_OK;
  count += count / 8;
  status =
      sph_memory_grow((void **)&masks->mask, 0, (size_t)count, 1, "masks of a matrix", &sim->error);
  if (!status) masks->room = count;
  return status;
}

static int make_masks(const sph_evaluation *e, const sph_pattern *pattern, int target, int source)
{
  sph_sim *sim = e->sim;
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const sph_pair_task pairs = pairs_of(sim, target, source, list);
  sph_masks *masks = masks_of(pattern, target, source);
  const double reach = sim->H + sim->skin;
  int status = reserve_masks(sim, masks, list);
  if (status) return status;
  const sph_mask_task task = {.pairs = &pairs,
                              .targets = e->view[target].n,
                              .same = target == source,
                              .reach2 = reach * reach * (1 + ROUNDING),
                              .first = masks->first,
                              .mask = masks->mask};
  sph_mask_function *loop = sph_mask_loop(sim->isa, sim->dim);
  long chunks = (list.blocks + BLOCKS - 1) / BLOCKS;
#pragma omp parallel for num_threads(sim->threads) schedule(dynamic) if (chunks > 2)
  for (long c = 0; c < chunks; c++)
    loop(&task, c * BLOCKS, c + 1 < chunks ? (c + 1) * BLOCKS : list.blocks);
  return SPH_OK;
}

/* Calls for all neighbours of the targets of blocks [begin, end), in the order of the masks. */
typedef void visit(const sph_pattern *pattern, long row, int column);

static void count(const sph_pattern *pattern, long row, int column)
{
  (void)column;
  pattern->start[row + 1]++;
}

static void take(const sph_pattern *pattern, long row, int column)
{
  pattern->column[pattern->start[row] + pattern->filled[row]++] = column;
}

static inline __attribute__((always_inline)) void
walk(const sph_sim *sim, const sph_pattern *pattern, int target, int source, visit *each)
{
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const sph_masks *masks = masks_of(pattern, target, source);
  const int lanes = sph_cpu_lanes(sim->isa);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (list.blocks > BLOCKS)
  for (long b = 0; b < list.blocks; b++) {
    const unsigned char *mask = masks->mask + masks->first[b];
    for (long r = list.first[b]; r < list.first[b + 1]; r++)
      for (long n = 0; n < sph_run_count(list.runs[r]); n++)
        for (unsigned bits = *mask++; bits; bits &= bits - 1)
          each(pattern, pattern->base[target] + b * lanes + __builtin_ctz(bits),
               (int)(pattern->base[source] + sph_run_start(list.runs[r]) + n));
  }
}

static int reserve_pattern(sph_sim *sim, sph_pattern *pattern)
{
  sph_error *error = &sim->error;
  long rows = 0;
  pattern->groups = sim->groups;
  for (int g = 0; g < sim->groups; g++) {
    pattern->base[g] = rows;
    if (!sim->group[g]->wall) rows += sim->group[g]->n;
  }
  pattern->rows = rows;
  if (!pattern->masks)
    pattern->masks = SPH_NEW(sph_masks, sim->groups * sim->groups, "masks of a matrix", error);
  if (!pattern->masks) return SPH_ERR_MEMORY;
  if (pattern->start && rows <= pattern->room_rows) return SPH_OK;
  if (sph_memory_grow((void **)&pattern->start, 0, (size_t)rows + 1, sizeof(long),
                      "rows of a matrix", error) ||
      sph_memory_grow((void **)&pattern->filled, 0, (size_t)rows, sizeof(int), "rows of a matrix",
                      error))
    return SPH_ERR_MEMORY;
  pattern->room_rows = rows;
  return SPH_OK;
}

static int make_columns(sph_sim *sim, sph_pattern *pattern)
{
  const long rows = pattern->rows;
  memset(pattern->start, 0, (size_t)(rows + 1) * sizeof(long));
  memset(pattern->filled, 0, (size_t)rows * sizeof(int));
  for (int g = 0; g < sim->groups; g++)
    for (int s = 0; s < sim->groups; s++)
      if (!sim->group[g]->wall && !sim->group[s]->wall) walk(sim, pattern, g, s, count);
  for (long i = 0; i < rows; i++) pattern->start[i + 1] += pattern->start[i];
  long entries = pattern->start[rows];
  if (entries > pattern->room) {
    entries += entries / 8;
    if (sph_memory_grow((void **)&pattern->column, 0, (size_t)entries, sizeof(int),
                        "columns of a matrix", &sim->error))
      return SPH_ERR_MEMORY;
    pattern->room = entries;
  }
  for (int g = 0; g < sim->groups; g++)
    for (int s = 0; s < sim->groups; s++)
      if (!sim->group[g]->wall && !sim->group[s]->wall) walk(sim, pattern, g, s, take);
  return SPH_OK;
}

/* Records hold the positions of the last list build: from there none of a pair moves by more than
 * skin/2, wherever it is now. */
static void pack_built(const sph_evaluation *e)
{
  sph_evaluation built = *e;
  for (int g = 0; g < e->sim->groups; g++) {
    for (int d = 0; d < e->sim->dim; d++) built.view[g].x[d] = e->sim->sorted[g].built[d];
    sph_sim_pairs_pack_positions(&built, g);
  }
}

int sph_sim_matrix_pattern(sph_evaluation *e, sph_pattern *pattern)
{
  sph_sim *sim = e->sim;
  const int known = pattern->number && pattern->builds == sim->list_builds;
  if (known && !pattern->again) return SPH_OK;
  int status = reserve_pattern(sim, pattern);
  if (!status) pack_built(e);
  for (int g = 0; !status && g < sim->groups; g++)
    for (int s = 0; !status && s < sim->groups; s++)
      if (!sim->group[g]->wall && !sim->group[s]->wall) status = make_masks(e, pattern, g, s);
  for (int g = 0; g < sim->groups; g++) sph_sim_pairs_pack_positions(e, g);
  if (!status) status = make_columns(sim, pattern);
  if (status) return status;
  pattern->builds = sim->list_builds;
  pattern->number += !known;
  pattern->again = 0;
  return SPH_OK;
}

/* ---- the matrix ---- */

/* Rows of one particle's components: its own other ones, then those of its neighbours. */
static void expand(const sph_pattern *pattern, sph_csr *A, int d, long i)
{
  const long length = pattern->start[i + 1] - pattern->start[i], row = d * length + d - 1;
  const int *column = pattern->column + pattern->start[i];
  for (int a = 0; a < d; a++) {
    long at = A->start[i * d + a] = d * d * pattern->start[i] + i * d * (d - 1) + a * row;
    for (int b = 0; b < d; b++)
      if (b != a) A->column[at++] = (int)(i * d + b);
    for (long n = 0; n < length; n++)
      for (int b = 0; b < d; b++) A->column[at++] = column[n] * d + b;
  }
}

enum { OF_PAIR = 8, OF_PARTICLE = 5 }; /* numbers that entries depend on, at most */

static long from_length(const sph_sim *sim)
{
  long n = OF_PAIR * sim->groups * sim->groups;
  for (int g = 0; g < sim->groups; g++) n += OF_PARTICLE * sim->group[g]->n;
  return n;
}

int sph_sim_matrix_shape(sph_sim *sim, const sph_pattern *pattern, sph_matrix *matrix)
{
  if (matrix->pattern == pattern->number) return SPH_OK;
  const int d = matrix->components, sums = d * (d + 1) / 2;
  const long n = pattern->rows, entries = d * d * pattern->start[n] + n * d * (d - 1);
  int status = sph_csr_reserve(&matrix->A, n * d,
                               entries <= matrix->A.room_entries ? entries : entries + entries / 8,
                               &sim->error);
  for (int s = 0; !status && s < sums && n > matrix->room; s++)
    status = sph_memory_grow((void **)&matrix->wall[s], 0, (size_t)n, sizeof(double),
                             "a matrix beside walls", &sim->error);
  if (status) return status;
  if (n > matrix->room) matrix->room = n;
  const long from = from_length(sim);
  if (from > matrix->from_room)
    status = sph_memory_grow((void **)&matrix->from, 0, (size_t)from, sizeof(double),
                             "what a matrix is made from", &sim->error);
  if (status) return status;
  if (from > matrix->from_room) matrix->from_room = from;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > ROWS)
  for (long i = 0; i < n; i++) expand(pattern, &matrix->A, d, i);
  matrix->A.n = n * d;
  matrix->A.start[n * d] = entries;
  matrix->pattern = pattern->number;
  return SPH_OK;
}

static matrix_constants constants_of(const sph_evaluation *e, int target, int source, double gamma,
                                     int coupling)
{
  const sph_sim *sim = e->sim;
  const sph_group *i = sim->group[target], *j = sim->group[source];
  matrix_constants k = {.fluid = sph_sim_interaction_constants(sim, e->part, i, j),
                        .vector = gamma * sim->F_scale,
                        .regular = coupling != SPH_COUPLING_DIFFUSION};
  if (coupling == SPH_COUPLING_VISCOSITY && (k.fluid.terms & SPH_MORRIS))
    k.scalar = k.vector * k.fluid.laminar;
  if (coupling == SPH_COUPLING_VISCOSITY && e->part->drag && sph_sim_drag_acts(sim, i, j)) {
    k.fluid = sph_sim_drag_constants(sim, target, source);
    k.drag = gamma;
  }
  if (coupling == SPH_COUPLING_CONDUCTION && (k.fluid.terms & SPH_CONDUCTION))
    k.scalar = k.vector * k.fluid.conduction;
  if (coupling == SPH_COUPLING_DIFFUSION && (k.fluid.terms & SPH_DIFFUSION))
    k.scalar = k.vector * 2 * sim->terms.delta * sim->h * i->eos.c0;
  return k;
}

/* A loop over all target blocks of (target <- source); masks NULL: source is a wall. */
static void loop_over(const sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                      sph_matrix_function *loop, int target, int source, const void *constants)
{
  const sph_sim *sim = e->sim;
  const sph_list list = sph_neighbors_list(sim->neighbors, target, source);
  const sph_masks *masks = sim->group[source]->wall ? NULL : masks_of(pattern, target, source);
  sph_pair_task pairs = pairs_of(sim, target, source, list);
  pairs.constants = constants;
  const long row = pattern->base[target] * matrix->components;
  const sph_matrix_task task = {.pairs = &pairs,
                                .first = masks ? masks->first : NULL,
                                .mask = masks ? masks->mask : NULL,
                                .vector = matrix->vector,
                                .targets = e->view[target].n,
                                .start = matrix->A.start + row,
                                .diagonal = matrix->A.diagonal + row,
                                .filled = pattern->filled + pattern->base[target],
                                .value = matrix->A.value};
  long chunks = (list.blocks + BLOCKS - 1) / BLOCKS;
#pragma omp parallel for num_threads(sim->threads) schedule(dynamic) if (chunks > 2)
  for (long c = 0; c < chunks; c++)
    loop(&task, c * BLOCKS, c + 1 < chunks ? (c + 1) * BLOCKS : list.blocks);
}

/* Adds what walls do to the diagonal blocks of a group: its sums are those of walls alone. */
static void take_walls(const sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                       int target, double factor)
{
  const sph_sim *sim = e->sim;
  const int d = matrix->components;
  const long base = pattern->base[target];
  double *const *sum = sim->sorted[target].sum;
  sph_csr *A = &matrix->A;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (e->view[target].n > ROWS)
  for (long s = 0; s < e->view[target].n; s++) {
    const long i = base + s;
    int k = 0;
    for (int a = 0; a < d; a++)
      for (int b = a; b < d; b++, k++) {
        const double value = matrix->wall[k][i] = factor * sum[k][s];
        if (a == b) A->diagonal[i * d + a] += value;
        if (a == b) continue;
        A->value[A->start[i * d + a] + b - 1] += value;
        A->value[A->start[i * d + b] + a] += value;
      }
  }
}

static void fill_walls(const sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                       int target, double gamma, int coupling)
{
  sph_sim *sim = e->sim;
  const sph_matrix_loops *loops = sph_matrix_loop(sim->isa, sim->dim);
  const int d = matrix->components;
  sph_sim_pairs_clear(sim, target, d * (d + 1) / 2);
  for (int w = 0; w < sim->groups; w++) {
    if (!sim->group[w]->wall) continue;
    const matrix_constants k = constants_of(e, target, w, gamma, coupling);
    if (matrix->vector ? (k.fluid.terms & SPH_VISCOUS) != 0 : k.scalar > 0)
      sph_sim_pairs_loop(sim, matrix->vector ? loops->wall_vector : loops->wall_scalar, target, w,
                         &k);
  }
  take_walls(e, pattern, matrix, target, coupling == SPH_COUPLING_DIFFUSION ? 1 : 2);
}

/* The diagonal is M; a vector's own other components have nothing yet. */
static void start(const sph_sim *sim, const sph_pattern *pattern, sph_matrix *matrix)
{
  const int d = matrix->components;
  sph_csr *A = &matrix->A;
  memcpy(A->diagonal, A->floor, (size_t)A->n * sizeof *A->diagonal);
  memset(pattern->filled, 0, (size_t)pattern->rows * sizeof *pattern->filled);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (A->n > ROWS)
  for (long row = 0; row < A->n; row++)
    for (int b = 0; b < d - 1; b++) A->value[A->start[row] + b] = 0;
}

/* Takes a number down; is it what stands there? */
static int note(double **at, double value)
{
  int same = **at == value;
  *(*at)++ = value;
  return same;
}

int sph_sim_matrix_same(sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                        double gamma, int coupling)
{
  const sph_sim *sim = e->sim;
  const int dim = sim->dim;
  int same = matrix->from_pattern == pattern->number && matrix->from_coupling == coupling;
  double *at = matrix->from;
  for (int g = 0; g < sim->groups; g++)
    for (int s = 0; s < sim->groups; s++) {
      if (sim->group[g]->wall) continue;
      const matrix_constants k = constants_of(e, g, s, gamma, coupling);
      const double of_pair[OF_PAIR] = {k.scalar,       k.vector,
                                       k.drag,         k.fluid.laminar,
                                       k.fluid.drag,   k.fluid.drag_i,
                                       k.fluid.drag_j, (double)k.fluid.terms};
      for (int n = 0; n < OF_PAIR; n++) same &= note(&at, of_pair[n]);
    }
  for (int g = 0; g < sim->groups; g++) {
    const double *record = sim->sorted[g].record;
    for (long s = 0; s < e->view[g].n; s++, record += sim->sorted[g].stride) {
      for (int d = 0; d < dim; d++) same &= note(&at, record[d]);
      if (sim->group[g]->wall) continue; /* of constant volume */
      same &= note(&at, record[slot_V(dim)]);
      same &= note(&at, record[slot_rho(dim)]);
    }
  }
  matrix->from_pattern = pattern->number;
  matrix->from_coupling = coupling;
  return same;
}

void sph_sim_matrix_fill(sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                         double gamma, int coupling)
{
  const sph_sim *sim = e->sim;
  const sph_matrix_loops *loops = sph_matrix_loop(sim->isa, sim->dim);
  start(sim, pattern, matrix);
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall) continue;
    for (int s = 0; s < sim->groups; s++) {
      if (sim->group[s]->wall) continue;
      const matrix_constants k = constants_of(e, g, s, gamma, coupling);
      loop_over(e, pattern, matrix, matrix->vector ? loops->vector : loops->scalar, g, s, &k);
    }
    fill_walls(e, pattern, matrix, g, gamma, coupling);
  }
  matrix->values++;
  e->sim->matrices++;
}

void sph_sim_matrix_add_tiles(sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                              double gamma, int unknown, int per_volume)
{
  const sph_sim *sim = e->sim;
  sph_matrix_function *loop = sph_tile_loop_matrix(sim->isa, sim->dim);
  memset(pattern->filled, 0, (size_t)pattern->rows * sizeof *pattern->filled);
  for (int g = 0; g < sim->groups; g++)
    for (int s = 0; s < sim->groups && !sim->group[g]->wall; s++) {
      fluid_constants fluid =
          sph_sim_interaction_constants(sim, e->part, sim->group[g], sim->group[s]);
      fluid.terms &= ~(unsigned)SPH_PAIR_TERMS;
      tile_constants k = sph_sim_interaction_tile(e, &fluid, g, s);
      k.unknown = unknown;
      k.per_volume = per_volume;
      k.gamma = gamma;
      /* They leave dust alone, but its places in the rows are passed. */
      if (sim->group[g]->eos.dust || sim->group[s]->eos.dust) k.terms = 0;
      int seen = unknown == TILE_VELOCITY      ? (fluid.terms & SPH_NO_SLIP) != 0
                 : unknown == TILE_TEMPERATURE ? k.isothermal
                                               : 0; /* a wall mirrors scalars */
      if (!sim->group[s]->wall || seen) loop_over(e, pattern, matrix, loop, g, s, &k);
    }
}

/* Loops over pairs count a particle itself, too, which is coupled to itself by k_ii. */
static void leave_out_self(const sph_evaluation *e, int g, int d, double k)
{
  const sph_sim *sim = e->sim;
  const int *order = sph_neighbors_order(sim->neighbors, g);
  const sph_view *view = &e->view[g];
  for (long s = 0; s < view->n; s++) {
    const double V = view->m[order[s]] / view->rho[order[s]];
    for (int a = 0, at = 0; a < d; at += d - a, a++) sim->sorted[g].sum[at][s] -= k * V * V;
  }
}

int sph_sim_matrix_sums(sph_evaluation *e, int g, int coupling)
{
  sph_sim *sim = e->sim;
  const sph_matrix_loops *loops = sph_matrix_loop(sim->isa, sim->dim);
  const int vector = coupling == SPH_COUPLING_VISCOSITY, d = vector ? sim->dim : 1;
  const double f0 = -sph_kernel_f(sim->kernel, sim->dim, 0, sim->h) / sim->F_scale;
  sph_sim_pairs_clear(sim, g, d * (d + 1) / 2);
  for (int s = 0; s < sim->groups; s++) {
    matrix_constants k = constants_of(e, g, s, 1, coupling);
    k.regular = 1; /* else a singular F is that of a particle and itself */
    if (vector ? (k.fluid.terms & SPH_VISCOUS) || k.drag > 0 : k.scalar > 0)
      sph_sim_pairs_loop(sim, vector ? loops->wall_vector : loops->wall_scalar, g, s, &k);
    if (s == g) leave_out_self(e, g, d, isfinite(f0) ? k.scalar * f0 : 0);
  }
  return d;
}

double sph_sim_matrix_pattern_bytes(const sph_pattern *pattern)
{
  double bytes = (double)pattern->room_rows * (sizeof(long) + sizeof(int)) +
                 (double)pattern->room * sizeof(int);
  for (int k = 0; pattern->masks && k < pattern->groups * pattern->groups; k++)
    bytes += (double)pattern->masks[k].room_first * sizeof(long) + (double)pattern->masks[k].room;
  return bytes;
}

double sph_sim_matrix_bytes(const sph_matrix *matrix)
{
  const long d = matrix->components, block = d * (d + 1) / 2;
  return (double)matrix->A.room_rows * (sizeof(long) + 2 * sizeof(double)) +
         (double)matrix->A.room_entries * (sizeof(int) + sizeof(double)) +
         sizeof(double) * (double)(matrix->room * block + matrix->from_room);
}

void sph_sim_matrix_pattern_free(sph_pattern *pattern)
{
  for (int k = 0; pattern->masks && k < pattern->groups * pattern->groups; k++) {
    sph_memory_free(pattern->masks[k].first);
    sph_memory_free(pattern->masks[k].mask);
  }
  sph_memory_free(pattern->masks);
  sph_memory_free(pattern->start);
  sph_memory_free(pattern->column);
  sph_memory_free(pattern->filled);
}

void sph_sim_matrix_free(sph_matrix *matrix)
{
  for (int s = 0; s < SPH_MATRIX_WALL_SUMS; s++) sph_memory_free(matrix->wall[s]);
  sph_memory_free(matrix->from);
  sph_csr_free(&matrix->A);
}
