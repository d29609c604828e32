/* Stages of implicit-explicit schemes, z = known + gamma f_I(t, z), at the exact positions of the
 * stage: f_I leaves them as they are in `known`.  One unknown after another:
 *
 *   rho   density diffusion                  V drho/dt = - sum k_ij (rho_i - rho_j) + more
 *   v     laminar and artificial viscosity,
 *         drag of dust                       m dv/dt = - sum K_ij (v_i - v_j)
 *   u     heating by them with the new v, conduction   m du/dt = Q - sum k_ij (T_i - T_j)
 *   s     scalars of registered terms
 *
 * each by linear solves with the matrices of matrix_pair.h.  What these do not hold is iterated
 * until the stage equation is met to the stage's tolerance:
 *
 *   walls                what viscosity and conduction see of a wall, 2 x_w - <x>, depends on the
 *                        fluid around it.  The matrix has <x> = x_i (symmetric: 2 k_iw on the
 *                        diagonal), the right-hand side the rest, <x> - x_i of the last iterate
 *   density diffusion    V, gradients and hydrostatic differences of the last iterate
 *   artificial viscosity Newton: who approaches, and how fast, as in the last iterate
 *   T(u)                 Newton, where c_v is not constant
 *   registered terms     with the Jacobians that they give, Newton or nearly so
 *
 * Unknown and state differ for energies: T is solved for, dU = s c_v dT of the integrated one. */
#include "sim_implicit.h"

#include <math.h>
#include <string.h>

#include "clock.h"
#include "linear.h"
#include "memory.h"
#include "sim_energy.h"
#include "sim_matrix.h"
#include "sim_parts.h"
#include "sim_weights.h"
#include "term_part.h"

enum { MOST = 40, ROWS = 1024 }; /* iterations; rows from which on threads pay */

enum {
  LAMINAR = SPH_MORRIS | SPH_MCG,
  VISCOUS = LAMINAR | SPH_ARTIFICIAL,
  CENTRAL = SPH_MCG | SPH_ARTIFICIAL | SPH_DRAG /* forces along r: the vector matrix */
};

/* Fields that are solved for, one after the other. */
enum { DENSITY, VELOCITY, ENERGY, SCALAR, UNKNOWNS = SCALAR + SPH_SCALARS_MAX };

/* What one of them is solved with. */
typedef struct unknown {
  int there, number;    /* terms of it are implicit; DENSITY, ..., SCALAR + number of the scalar */
  unsigned called;      /* bit k: terms.call[k] is among them */
  int per_volume;       /* scalars */
  int drags;            /* by drag, too: then dust takes part */
  int components;       /* columns of the scalar matrix; dim with the vector matrix, too */
  int direct;           /* f is linear: what the matrix has, what walls add, and the heating */
  int meets_walls;      /* walls add to it */
  sph_part part, walls; /* its terms; they between fluids and walls alone */
  int coupling;         /* enum sph_coupling */
  sph_matrix *matrix;
  sph_linear *solver;
} unknown;

struct sph_implicit {
  unknown unknown[UNKNOWNS];
  int heats;        /* implicit terms of the velocity heat an energy */
  int loops;        /* what comes later acts back on what comes before */
  sph_part heating; /* the terms that do */
  sph_pattern pattern;
  sph_matrix scalar, vector;
  sph_linear *solver[2];     /* of these */
  N_Vector rate, last, norm; /* the last two where it loops */
  long rows;                 /* room */
  /* Row by row, [rows * dim]: the unknown, before and after; right-hand side; 1 / scale. */
  double *x, *old, *b, *weight;
  double *heat; /* [rows] rate of the energy by terms of the velocity */
};

/* One stage at work: views of its vectors. */
typedef struct solving {
  sph_sim *sim;
  struct sph_implicit *own;
  sph_stage *stage;
  sph_view z[SPH_SETS_MAX], known[SPH_SETS_MAX], rate[SPH_SETS_MAX];
} solving;

/* ---- rows ---- */

/* Of dust, only drag and registered terms act on the velocity; it has no energy. */
static int takes_part(const sph_group *group, const unknown *u)
{
  return !group->wall && (!group->eos.dust || u->drags || (u->called && u->number != ENERGY));
}

static double *field_of(const sph_view *view, const unknown *u, int c)
{
  if (u->number >= SCALAR) return view->s[u->number - SCALAR];
  if (u->number == DENSITY) return view->rho;
  return u->number == VELOCITY ? view->v[c] : view->energy;
}

static const double *rate_of(const sph_view *rate, const unknown *u, int c)
{
  if (u->number >= SCALAR) return rate->ds[u->number - SCALAR];
  if (u->number == DENSITY) return rate->drho;
  return u->number == VELOCITY ? rate->dv[c] : rate->du;
}

/* What is solved for: the field itself, for energies T. */
static const double *solved_of(const sph_view *z, const unknown *u, int c)
{
  return u->number == ENERGY ? z->T : field_of(z, u, c);
}

/* dU/dT of the energy that is integrated. */
static double factor_of(const sph_group *group, const sph_view *z, const unknown *u, long i)
{
  const double c_v = group->eos.c_v, gamma = group->eos.gamma;
  if (u->number != ENERGY) return 1;
  switch (sph_group_data_energy(group)) {
  case SPH_TEMPERATURE: return 1;
  case SPH_ENTROPY: return c_v * (gamma - 1) * pow(z->rho[i], 1 - gamma);
  default: return c_v;
  }
}

/* M: of the symmetric form of the equation. */
static double mass_of(const sph_group *group, const sph_view *z, const unknown *u, long i)
{
  if (u->number == DENSITY || u->per_volume) return z->m[i] / z->rho[i];
  return u->number == ENERGY ? z->m[i] * group->eos.c_v : z->m[i];
}

static int field_number(const sph_group *group, const unknown *u)
{
  if (u->number >= SCALAR) return SPH_SCALAR + u->number - SCALAR;
  if (u->number == DENSITY) return SPH_DENSITY;
  return u->number == VELOCITY ? SPH_VELOCITY : sph_group_data_energy(group);
}

/* Where component c of a row is. */
static long place(const solving *s, const unknown *u, long row, int c)
{
  return u->matrix->components > 1 ? row * u->components + c : c * s->own->pattern.rows + row;
}

/* sum_b W_ab x_b of the wall's part of the diagonal block. */
static double at_wall(const unknown *u, long row, int a, const double x[3])
{
  double *const *wall = u->matrix->wall;
  int d = u->components;
  if (u->matrix->components == 1) return wall[0][row] * x[a];
  double sum = 0;
  for (int p = 0, k = 0; p < d; p++)
    for (int q = p; q < d; q++, k++) {
      if (p == a) sum += wall[k][row] * x[q];
      if (q == a && p != a) sum += wall[k][row] * x[p];
    }
  return sum;
}

/* The right-hand side of particle i, from the iterate z and the rates there,
 *   direct:    M x + M/factor (known + gamma (heat + f_walls) - z) + W x
 *   otherwise: M/factor (known + gamma f - z), of the change of x
 * for known, z the state, x what is solved for, and f_walls that of walls alone. */
static void set_row(const solving *s, const unknown *u, int g, long row, long i)
{
  struct sph_implicit *own = s->own;
  const sph_group *group = s->sim->group[g];
  const sph_view *z = &s->z[g];
  const double gamma = s->stage->gamma, mass = mass_of(group, z, u, i);
  const double factor = factor_of(group, z, u, i);
  const int rates = !u->direct || u->meets_walls;
  double x[3];
  for (int c = 0; c < u->components; c++) x[c] = solved_of(z, u, c)[i];
  for (int c = 0; c < u->components; c++) {
    const long at = place(s, u, row, c);
    double miss = field_of(&s->known[g], u, c)[i] - field_of(z, u, c)[i];
    if (rates) miss += gamma * rate_of(&s->rate[g], u, c)[i];
    if (u->number == ENERGY && own->heats) miss += gamma * own->heat[row];
    own->b[at] = mass / factor * miss;
    if (u->direct) own->b[at] += mass * x[c];
    if (u->direct && u->meets_walls) own->b[at] += at_wall(u, row, c, x);
    own->old[at] = u->direct ? x[c] : 0;
    own->x[at] = own->old[at];
    own->weight[at] = factor / s->sim->scale[g][field_number(group, u)];
  }
}

static void set_mass(const solving *s, const unknown *u, int g, long row, long i)
{
  const double mass = mass_of(s->sim->group[g], &s->z[g], u, i);
  const int d = u->matrix->components;
  for (int c = 0; c < d; c++) u->matrix->A.floor[row * d + c] = mass;
}

/* Into the state. */
static void take_row(const solving *s, const unknown *u, int g, long row, long i)
{
  const double factor = factor_of(s->sim->group[g], &s->z[g], u, i);
  for (int c = 0; c < u->components; c++) {
    const long at = place(s, u, row, c);
    double *field = field_of(&s->z[g], u, c);
    if (u->direct && u->number != ENERGY)
      field[i] = s->own->x[at];
    else
      field[i] += factor * (s->own->x[at] - s->own->old[at]);
  }
}

static void take_heat(const solving *s, const unknown *u, int g, long row, long i)
{
  (void)u;
  s->own->heat[row] = s->rate[g].du[i];
}

/* Without conduction: U = known + gamma heat. */
static void add_heat(const solving *s, const unknown *u, int g, long row, long i)
{
  (void)u;
  s->z[g].energy[i] = s->known[g].energy[i] + s->stage->gamma * s->own->heat[row];
}

typedef void each_row(const solving *s, const unknown *u, int g, long row, long i);

/* Calls for the particles of all groups that take part. */
static void rows(const solving *s, const unknown *u, each_row *each)
{
  for (int g = 0; g < s->sim->groups; g++) {
    const int *order = sph_neighbors_order(s->sim->neighbors, g);
    const long base = s->own->pattern.base[g], n = s->z[g].n;
    if (!takes_part(s->sim->group[g], u)) continue;
#pragma omp parallel for num_threads(s->sim->threads) schedule(static) if (n > ROWS)
    for (long k = 0; k < n; k++) each(s, u, g, base + k, order[k]);
  }
}

/* Of other groups: 1 x = 0, of no weight. */
static void idle_rows(const solving *s, const unknown *u)
{
  struct sph_implicit *own = s->own;
  for (int g = 0; g < s->sim->groups; g++) {
    const long base = own->pattern.base[g];
    if (s->sim->group[g]->wall || takes_part(s->sim->group[g], u)) continue;
    for (long row = base; row < base + s->z[g].n; row++) {
      for (int c = 0; c < u->matrix->components; c++)
        u->matrix->A.floor[row * u->matrix->components + c] = 1;
      for (int c = 0; c < u->components; c++) {
        const long at = place(s, u, row, c);
        own->x[at] = own->old[at] = own->b[at] = own->weight[at] = 0;
      }
    }
  }
}

/* Rows of those that take part: means are over them. */
static double active_rows(const solving *s, const unknown *u)
{
  long sum = 0;
  for (int g = 0; g < s->sim->groups; g++)
    if (takes_part(s->sim->group[g], u)) sum += s->z[g].n;
  return (double)sum;
}

static double mean(double squares, double count) { return count > 0 ? sqrt(squares / count) : 0; }

/* Weighted mean of the change of the unknown. */
static double change_of(const solving *s, const unknown *u)
{
  const struct sph_implicit *own = s->own;
  const long n = own->pattern.rows * u->components;
  double sum = 0;
  for (long k = 0; k < n; k++) {
    double change = own->weight[k] * (own->x[k] - own->old[k]);
    sum += change * change;
  }
  return mean(sum, active_rows(s, u) * u->components);
}

/* ---- one unknown ---- */

static sph_evaluation evaluation_of(const solving *s, const sph_part *part)
{
  sph_evaluation e = {.sim = s->sim, .t = s->stage->t, .part = part};
  for (int g = 0; g < s->sim->groups; g++) e.view[g] = s->z[g];
  return e;
}

/* Records, pressures, walls of the iterate: with the rates that the right-hand side wants. */
static int evaluate(const solving *s, const unknown *u)
{
  const sph_part *part = u->direct ? &u->walls : &u->part;
  if (!u->direct || u->meets_walls)
    return sph_sim_rhs_part(s->sim, part, s->stage->t, s->stage->z, s->own->rate);
  sph_evaluation e = evaluation_of(s, &u->part);
  int status = sph_sim_density(&e);
  if (!status) status = sph_sim_material_eos(&e);
  if (!status) status = sph_sim_walls_fill(&e);
  return status;
}

/* What jacobian_body of a group's terms adds to the diagonal: gamma M times the decay. */
static void add_bodies(const solving *s, const unknown *u, const sph_evaluation *e, int g)
{
  struct sph_implicit *own = s->own;
  const sph_term_set *terms = &s->sim->terms;
  const int *order = sph_neighbors_order(s->sim->neighbors, g);
  const int d = u->matrix->components;
  const double gamma = s->stage->gamma;
  double *decay = own->b; /* [n], not in use yet */
  memset(decay, 0, (size_t)s->z[g].n * sizeof *decay);
  const sph_term_jacobian jacobian = {.v = u->number == VELOCITY ? decay : NULL,
                                      .T = u->number == ENERGY ? decay : NULL,
                                      .s = u->number >= SCALAR ? decay : NULL};
  for (int k = 0; k < terms->called; k++) {
    const sph_called_term *call = &terms->call[k];
    if (!(u->called >> k & 1) || !call->term.jacobian_body) continue;
    sph_particles particles = sph_sim_bodies_particles(e, g);
    particles.s = call->scalar < 0 ? NULL : s->z[g].s[call->scalar];
    call->term.jacobian_body(&call->term, &particles, &jacobian);
  }
  for (long k = 0; k < s->z[g].n; k++) {
    const long i = order[k], row = own->pattern.base[g] + k;
    const double mass = u->number == ENERGY ? s->z[g].m[i] : u->matrix->A.floor[row * d];
    for (int c = 0; c < d; c++)
      u->matrix->A.diagonal[row * d + c] += gamma * mass * fmax(decay[i], 0);
  }
}

static void add_called(const solving *s, const unknown *u, sph_evaluation *e)
{
  const int which = u->number == VELOCITY ? TILE_VELOCITY
                    : u->number == ENERGY ? TILE_TEMPERATURE
                                          : TILE_SCALAR;
  for (int g = 0; g < s->sim->groups; g++)
    if (takes_part(s->sim->group[g], u)) add_bodies(s, u, e, g);
  if (u->part.tiles)
    sph_sim_matrix_add_tiles(e, &s->own->pattern, u->matrix, s->stage->gamma, which, u->per_volume);
}

static int fill(const solving *s, const unknown *u)
{
  sph_evaluation e = evaluation_of(s, &u->part);
  int status = sph_sim_matrix_shape(s->sim, &s->own->pattern, u->matrix);
  if (status) return status;
  rows(s, u, set_mass);
  idle_rows(s, u);
  sph_sim_matrix_fill(&e, &s->own->pattern, u->matrix, s->stage->gamma, u->coupling);
  if (u->called) add_called(s, u, &e);
  return SPH_OK;
}

/* Pairs exchange: without walls sum M x = sum b, whatever the error of x.  A constant makes it so,
 * and what is conserved is so to rounding.  Rows that are coupled to none keep out of it: M x = b.
 */
static void conserve(const solving *s, const unknown *u)
{
  struct sph_implicit *own = s->own;
  const double *M = u->matrix->A.floor, *diagonal = u->matrix->A.diagonal;
  const long n = own->pattern.rows;
  const int d = u->matrix->components;
  for (int c = 0; c < u->components; c++) {
    const int part = d > 1 ? c : 0;
    double missing = 0, mass = 0;
    for (long row = 0; row < n; row++) {
      const long at = place(s, u, row, c), k = row * d + part;
      if (!(diagonal[k] > M[k])) own->x[at] = own->b[at] / M[k];
      if (!(diagonal[k] > M[k])) continue;
      missing += own->b[at] - M[k] * own->x[at];
      mass += M[k];
    }
    for (long row = 0; mass > 0 && row < n; row++)
      if (diagonal[row * d + part] > M[row * d + part])
        own->x[place(s, u, row, c)] += missing / mass;
  }
}

/* The solver's mean is over all rows. */
static double linear_tolerance(const solving *s, const unknown *u)
{
  return 0.3 * s->stage->tolerance *
         sqrt(fmax(active_rows(s, u), 1) / (double)s->own->pattern.rows);
}

static int solve_linear(const solving *s, const unknown *u)
{
  struct sph_implicit *own = s->own;
  const int columns = u->components / u->matrix->components;
  const double *b[3], *weight[3];
  double *x[3];
  for (int c = 0; c < columns; c++) {
    b[c] = own->b + c * own->pattern.rows;
    weight[c] = own->weight + c * own->pattern.rows;
    x[c] = own->x + c * own->pattern.rows;
  }
  sph_linear_task task = {.A = &u->matrix->A,
                          .pattern = u->matrix->pattern,
                          .values = u->matrix->values,
                          .columns = columns,
                          .b = b,
                          .x = x,
                          .weight = weight,
                          .tolerance = linear_tolerance(s, u)};
  int status = sph_linear_solve(u->solver, &task, &s->sim->error);
  sph_linear_stats stats;
  sph_linear_get_stats(u->solver, &stats);
  s->stage->iterations += stats.last;
  if (status > 0)
    return sph_sim_admit_retry(s->sim, "implicit stage: %s", sph_linear_reason(u->solver));
  if (!status && !u->meets_walls && !u->called) conserve(s, u);
  return status;
}

/* How far T(u) of the new state is from the T that was solved for, in the norm of the stage. */
static double missed(const solving *s, const unknown *u)
{
  struct sph_implicit *own = s->own;
  double sum = 0;
  if (u->number != ENERGY || !u->direct) return 0;
  for (int g = 0; g < s->sim->groups; g++) {
    const int *order = sph_neighbors_order(s->sim->neighbors, g);
    if (!takes_part(s->sim->group[g], u)) continue;
    sph_sim_energy_internal(s->sim, s->sim->group[g], &s->z[g]);
    for (long k = 0; k < s->z[g].n; k++) {
      const long row = own->pattern.base[g] + k;
      double change = own->weight[row] * (s->z[g].T[order[k]] - own->x[row]);
      sum += change * change;
    }
  }
  return mean(sum, active_rows(s, u));
}

/* Is the iterate near enough, after changes that shrink like these? */
static int near_enough(double change, double last, double tolerance)
{
  double rate = last > 0 ? fmin(change / last, 0.9) : 0.5;
  return change * rate / (1 - rate) <= 0.3 * tolerance;
}

static const char *name_of(const solving *s, const unknown *u)
{
  static const char *const names[] = {"density", "velocity", "energy"};
  return u->number < SCALAR ? names[u->number] : s->sim->terms.scalar[u->number - SCALAR].name;
}

static int solve_unknown(const solving *s, const unknown *u)
{
  double last = 0;
  for (int k = 0; k < MOST; k++) {
    int status = evaluate(s, u);
    if (!status && (k == 0 || !u->direct)) status = fill(s, u);
    if (status) return status;
    rows(s, u, set_row);
    status = solve_linear(s, u);
    if (status) return status;
    rows(s, u, take_row);
    double change = change_of(s, u), miss = missed(s, u);
    if (u->direct && !u->meets_walls && miss <= 0.1 * s->stage->tolerance) return SPH_OK;
    if (near_enough(change, last, s->stage->tolerance) && miss <= 0.3 * s->stage->tolerance)
      return SPH_OK;
    last = change;
  }
  return sph_sim_admit_retry(s->sim,
                             "implicit stage: %s change by %g of the tolerance still after %d "
                             "iterations",
                             name_of(s, u), last / s->stage->tolerance, MOST);
}

static int solve_energy(const solving *s)
{
  struct sph_implicit *own = s->own;
  const unknown *u = &own->unknown[ENERGY];
  if (own->heats) {
    int status = sph_sim_rhs_part(s->sim, &own->heating, s->stage->t, s->stage->z, own->rate);
    if (status) return status;
    rows(s, u, take_heat);
    rows(s, u, add_heat);
  }
  return u->there ? solve_unknown(s, u) : SPH_OK;
}

/* ---- the stage ---- */

/* The change of the state since the last call, in the norm of the stage. */
static int turn(const solving *s, double *change)
{
  N_Vector last = s->own->last, rate = s->own->rate, weight = s->own->norm;
  int status = sph_sim_weights(s->stage->z, weight, s->sim);
  N_VLinearSum(1, s->stage->z, -1, last, rate);
  *change = N_VWrmsNorm(rate, weight);
  N_VScale(1, s->stage->z, last);
  return status;
}

static int solve_all(const solving *s)
{
  const struct sph_implicit *own = s->own;
  double last = 0, change = 0;
  int status = own->loops ? turn(s, &change) : SPH_OK;
  for (int k = 0; !status && k < MOST; k++) {
    for (int q = 0; !status && q < UNKNOWNS; q++)
      if (q == ENERGY)
        status = solve_energy(s);
      else if (own->unknown[q].there)
        status = solve_unknown(s, &own->unknown[q]);
    if (!status && own->loops) status = turn(s, &change);
    if (status || !own->loops) return status;
    if (k > 0 && near_enough(change, last, s->stage->tolerance)) return SPH_OK;
    last = change;
  }
  return status ? status
                : sph_sim_admit_retry(s->sim, "implicit stage: unknowns that act on each other do "
                                              "not settle");
}

/* z is `known` but for what is solved for, where it is a guess; energies start from `known`. */
static void start(const solving *s, int g, long i)
{
  const sph_view *z = &s->z[g], *known = &s->known[g];
  const unknown *u = s->own->unknown;
  const sph_group *group = s->sim->group[g];
  for (int d = 0; d < s->sim->dim; d++) {
    z->x[d][i] = known->x[d][i];
    if (!u[VELOCITY].there || !takes_part(group, &u[VELOCITY])) z->v[d][i] = known->v[d][i];
  }
  if (!u[DENSITY].there || !takes_part(group, &u[DENSITY])) z->rho[i] = known->rho[i];
  if (z->energy) z->energy[i] = known->energy[i];
  for (int q = 0; q < s->sim->terms.scalars; q++)
    if (!u[SCALAR + q].there || !takes_part(group, &u[SCALAR + q])) z->s[q][i] = known->s[q][i];
}

static int reserve(sph_sim *sim, struct sph_implicit *own)
{
  double **all[] = {&own->x, &own->old, &own->b, &own->weight, &own->heat};
  for (size_t k = 0; own->pattern.rows > own->rows && k < sizeof all / sizeof *all; k++)
    if (sph_memory_grow((void **)all[k], 0, (size_t)(own->pattern.rows * sim->dim), sizeof(double),
                        "rows of implicit stages", &sim->error))
      return SPH_ERR_MEMORY;
  if (own->pattern.rows > own->rows) own->rows = own->pattern.rows;
  return SPH_OK;
}

/* Lists, records and pattern of the stage's positions. */
static int open_stage(const solving *s)
{
  const sph_part *part = &s->sim->part[SPH_PIECE_IMPLICIT];
  for (int g = 0; g < s->sim->groups; g++)
    for (long i = 0; !s->sim->group[g]->wall && i < s->z[g].n; i++) start(s, g, i);
  sph_evaluation e = evaluation_of(s, part);
  int status = sph_sim_walls_move(&e);
  if (!status) status = sph_sim_lists_update(&e);
  for (int g = 0; !status && g < s->sim->groups; g++) sph_sim_pairs_pack_positions(&e, g);
  if (!status) status = sph_sim_matrix_pattern(&e, &s->own->pattern);
  return status ? status : reserve(s->sim, s->own);
}

int sph_sim_implicit_solve(sph_stage *stage, void *ctx)
{
  sph_sim *sim = ctx;
  solving s = {.sim = sim, .own = sim->implicit, .stage = stage};
  double begin = sph_clock();
  for (int g = 0; g < sim->groups; g++) {
    s.z[g] = sph_group_data_view(sim->group[g], sph_nvector_data(stage->z), NULL);
    s.known[g] = sph_group_data_view(sim->group[g], sph_nvector_data(stage->known), NULL);
    s.rate[g] = sph_group_data_view(sim->group[g], sph_nvector_data(stage->z),
                                    sph_nvector_data(s.own->rate));
  }
  int status = open_stage(&s);
  if (!status) status = solve_all(&s);
  sim->solve_seconds += sph_clock() - begin;
  return status;
}

/* ---- before the run ---- */

static int make_unknown(sph_sim *sim, int number, unsigned bits, unsigned called)
{
  static const int coupling[] = {SPH_COUPLING_DIFFUSION, SPH_COUPLING_VISCOSITY,
                                 SPH_COUPLING_CONDUCTION};
  struct sph_implicit *own = sim->implicit;
  unknown *u = &own->unknown[number];
  const int vector = number == VELOCITY && (bits & CENTRAL);
  *u = (unknown){.number = number, .there = bits || called, .called = called};
  if (!u->there) return SPH_OK;
  u->coupling = number < SCALAR ? coupling[number] : SPH_COUPLING_NONE;
  u->components = number == VELOCITY ? sim->dim : 1;
  u->drags = (bits & SPH_DRAG) != 0;
  u->direct = number != DENSITY && !(bits & SPH_ARTIFICIAL) && !called;
  u->matrix = vector ? &own->vector : &own->scalar;
  u->matrix->vector = vector;
  u->matrix->components = vector ? sim->dim : 1;
  if (!own->solver[vector])
    own->solver[vector] = sph_linear_create(sim->integrator_def.linear, sim->threads, &sim->error);
  u->solver = own->solver[vector];
  if (!u->solver) return sim->error.status;
  int status = sph_sim_parts_of(sim, &u->part, bits, called);
  u->walls = u->part;
  u->walls.only_walls = 1;
  u->walls.drag = 0;
  u->meets_walls = u->part.walls;
  return status;
}

/* Implicit called terms that change this (enum sph_term_changes). */
static unsigned called_that(const sph_sim *sim, unsigned changes, int scalar)
{
  unsigned called = 0;
  for (int k = 0; k < sim->terms.called; k++) {
    const sph_called_term *call = &sim->terms.call[k];
    if (call->part == SPH_TERM_IMPLICIT && (call->changes & changes) &&
        (scalar < 0 || call->scalar == scalar))
      called |= 1u << k;
  }
  return called;
}

int sph_sim_implicit_heats(const sph_sim *sim)
{
  return called_that(sim, SPH_CHANGES_ENERGY, -1) != 0;
}

/* They need an energy and a temperature. */
int sph_sim_implicit_check(sph_sim *sim)
{
  for (int g = 0; g < sim->groups && sph_sim_implicit_heats(sim); g++) {
    const sph_group *group = sim->group[g];
    if (group->wall || group->eos.dust || (sph_group_data_energy(group) >= 0 && group->eos.c_v > 0))
      continue;
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "an implicit term changes the energy of %s, which has not both an energy "
                        "(sph_group_set_energy) and a specific heat (eos.c_v)",
                        group->name);
  }
  return SPH_OK;
}

/* Does a term act on more than one unknown? */
static int some_act_on_several(const sph_sim *sim)
{
  for (int k = 0; k < sim->terms.called; k++) {
    const unsigned changes = sim->terms.call[k].changes;
    if (sim->terms.call[k].part == SPH_TERM_IMPLICIT && (changes & (changes - 1))) return 1;
  }
  return 0;
}

static int make_unknowns(sph_sim *sim, unsigned bits)
{
  const sph_term_set *terms = &sim->terms;
  int status = make_unknown(sim, DENSITY, bits & SPH_DIFFUSION, 0);
  if (!status)
    status = make_unknown(sim, VELOCITY, bits & (VISCOUS | SPH_DRAG),
                          called_that(sim, SPH_CHANGES_VELOCITY, -1));
  if (!status)
    status =
        make_unknown(sim, ENERGY, bits & SPH_CONDUCTION, called_that(sim, SPH_CHANGES_ENERGY, -1));
  for (int q = 0; !status && q < terms->scalars; q++) {
    unsigned called = called_that(sim, SPH_CHANGES_SCALAR, q);
    status = make_unknown(sim, SCALAR + q, 0, called);
    for (int k = 0; k < terms->called; k++)
      if (called >> k & 1)
        sim->implicit->unknown[SCALAR + q].per_volume = terms->call[k].term.scalar.per_volume;
  }
  return status;
}

/* Which unknowns act on each other. */
static int make_order(sph_sim *sim, unsigned bits)
{
  struct sph_implicit *own = sim->implicit;
  const unknown *u = own->unknown;
  int energies = 0, thermal = 0;
  for (int g = 0; g < sim->groups; g++) {
    energies |= sph_group_data_energy(sim->group[g]) >= 0;
    thermal |= !sim->group[g]->wall && sim->group[g]->eos.thermal;
  }
  own->heats = energies && u[VELOCITY].there;
  own->loops =
      some_act_on_several(sim) || (thermal && ((bits & SPH_ARTIFICIAL) || u[DENSITY].meets_walls) &&
                                   (own->heats || u[ENERGY].there));
  return sph_sim_parts_of(sim, &own->heating, bits & (VISCOUS | SPH_DRAG),
                          u[VELOCITY].called & ~u[ENERGY].called);
}

int sph_sim_implicit_make(sph_sim *sim)
{
  const unsigned bits = sim->loop_terms & sim->terms.implicit;
  sph_error *error = &sim->error;
  if (!sph_term_part_first(&sim->terms, SPH_TERM_IMPLICIT)) return SPH_OK;
  struct sph_implicit *own = sim->implicit =
      SPH_NEW(struct sph_implicit, 1, "implicit stages", error);
  if (!own) return SPH_ERR_MEMORY;
  int status = make_unknowns(sim, bits);
  if (!status) status = make_order(sim, bits);
  if (status) return status;
  own->rate = sph_nvector_clone(sim->y, "rates of implicit terms", error);
  if (!own->rate || !own->loops) return error->status;
  own->last = sph_nvector_clone(sim->y, "an implicit stage", error);
  own->norm = sph_nvector_clone(sim->y, "an implicit stage", error);
  return error->status;
}

void sph_sim_implicit_free(sph_sim *sim)
{
  struct sph_implicit *own = sim->implicit;
  if (!own) return;
  double *all[] = {own->x, own->old, own->b, own->weight, own->heat};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) sph_memory_free(all[k]);
  sph_sim_matrix_pattern_free(&own->pattern);
  sph_sim_matrix_free(&own->scalar);
  sph_sim_matrix_free(&own->vector);
  for (int k = 0; k < 2; k++) sph_linear_free(own->solver[k]);
  N_Vector vector[] = {own->rate, own->last, own->norm};
  for (int k = 0; k < 3; k++)
    if (vector[k]) N_VDestroy(vector[k]);
  sph_memory_free(own);
  sim->implicit = NULL;
}
