#include "sim_unknown.h"

#include <math.h>
#include <string.h>

#include "sim_energy.h"

enum { MOST = 40, ROWS = 1024 }; /* iterations; rows from which on threads pay */

/* ---- rows ---- */

/* Of dust, only drag and registered terms act on the velocity; it has no energy. */
int sph_sim_unknown_takes_part(const sph_group *group, const sph_unknown *u)
{
  return !group->wall &&
         (!group->eos.dust || u->drags || (u->called && u->number != SPH_UNKNOWN_ENERGY));
}

static double *field_of(const sph_view *view, const sph_unknown *u, int c)
{
  if (u->number >= SPH_UNKNOWN_SCALAR) return view->s[u->number - SPH_UNKNOWN_SCALAR];
  if (u->number == SPH_UNKNOWN_DENSITY) return view->rho;
  return u->number == SPH_UNKNOWN_VELOCITY ? view->v[c] : view->energy;
}

static const double *rate_of(const sph_view *rate, const sph_unknown *u, int c)
{
  if (u->number >= SPH_UNKNOWN_SCALAR) return rate->ds[u->number - SPH_UNKNOWN_SCALAR];
  if (u->number == SPH_UNKNOWN_DENSITY) return rate->drho;
  return u->number == SPH_UNKNOWN_VELOCITY ? rate->dv[c] : rate->du;
}

/* What is solved for: the field itself, for energies T. */
static const double *solved_of(const sph_view *z, const sph_unknown *u, int c)
{
  return u->number == SPH_UNKNOWN_ENERGY ? z->T : field_of(z, u, c);
}

/* dU/dT of the energy that is integrated. */
static double factor_of(const sph_group *group, const sph_view *z, const sph_unknown *u, long i)
{
  const double c_v = group->eos.c_v, gamma = group->eos.gamma;
  if (u->number != SPH_UNKNOWN_ENERGY) return 1;
  switch (sph_group_data_energy(group)) {
  case SPH_TEMPERATURE: return 1;
  case SPH_ENTROPY: return c_v * (gamma - 1) * pow(z->rho[i], 1 - gamma);
  default: return c_v;
  }
}

/* M: of the symmetric form of the equation. */
static double mass_of(const sph_group *group, const sph_view *z, const sph_unknown *u, long i)
{
  if (u->number == SPH_UNKNOWN_DENSITY || u->per_volume) return z->m[i] / z->rho[i];
  return u->number == SPH_UNKNOWN_ENERGY ? z->m[i] * group->eos.c_v : z->m[i];
}

static int field_number(const sph_group *group, const sph_unknown *u)
{
  if (u->number >= SPH_UNKNOWN_SCALAR) return SPH_SCALAR + u->number - SPH_UNKNOWN_SCALAR;
  if (u->number == SPH_UNKNOWN_DENSITY) return SPH_DENSITY;
  return u->number == SPH_UNKNOWN_VELOCITY ? SPH_VELOCITY : sph_group_data_energy(group);
}

/* Where component c of a row is. */
static long place(const sph_solving *s, const sph_unknown *u, long row, int c)
{
  return u->matrix->components > 1 ? row * u->components + c : c * s->own->pattern.rows + row;
}

/* sum_b W_ab x_b of the wall's part of the diagonal block. */
static double at_wall(const sph_unknown *u, long row, int a, const double x[3])
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
static void set_row(const sph_solving *s, const sph_unknown *u, int g, long row, long i)
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
    if (u->number == SPH_UNKNOWN_ENERGY && own->heats) miss += gamma * own->heat[row];
    own->b[at] = mass / factor * miss;
    if (u->direct) own->b[at] += mass * x[c];
    if (u->direct && u->meets_walls) own->b[at] += at_wall(u, row, c, x);
    own->old[at] = u->direct ? x[c] : 0;
    own->x[at] = own->old[at];
    own->weight[at] = factor / s->sim->scale[g][field_number(group, u)];
  }
}

static void set_mass(const sph_solving *s, const sph_unknown *u, int g, long row, long i)
{
  const double mass = mass_of(s->sim->group[g], &s->z[g], u, i);
  const int d = u->matrix->components;
  for (int c = 0; c < d; c++) u->matrix->A.floor[row * d + c] = mass;
}

/* Into the state. */
static void take_row(const sph_solving *s, const sph_unknown *u, int g, long row, long i)
{
  const double factor = factor_of(s->sim->group[g], &s->z[g], u, i);
  for (int c = 0; c < u->components; c++) {
    const long at = place(s, u, row, c);
    double *field = field_of(&s->z[g], u, c);
    if (u->direct && u->number != SPH_UNKNOWN_ENERGY)
      field[i] = s->own->x[at];
    else
      field[i] += factor * (s->own->x[at] - s->own->old[at]);
  }
}

static void take_heat(const sph_solving *s, const sph_unknown *u, int g, long row, long i)
{
  (void)u;
  s->own->heat[row] = s->rate[g].du[i];
}

/* Without conduction: U = known + gamma heat. */
static void add_heat(const sph_solving *s, const sph_unknown *u, int g, long row, long i)
{
  (void)u;
  s->z[g].energy[i] = s->known[g].energy[i] + s->stage->gamma * s->own->heat[row];
}

typedef void each_row(const sph_solving *s, const sph_unknown *u, int g, long row, long i);

/* Calls for the particles of all groups that take part. */
static void rows(const sph_solving *s, const sph_unknown *u, each_row *each)
{
  for (int g = 0; g < s->sim->groups; g++) {
    const int *order = sph_neighbors_order(s->sim->neighbors, g);
    const long base = s->own->pattern.base[g], n = s->z[g].n;
    if (!sph_sim_unknown_takes_part(s->sim->group[g], u)) continue;
#pragma omp parallel for num_threads(s->sim->threads) schedule(static) if (n > ROWS)
    for (long k = 0; k < n; k++) each(s, u, g, base + k, order[k]);
  }
}

/* Of other groups: 1 x = 0, of no weight. */
static void idle_rows(const sph_solving *s, const sph_unknown *u)
{
  struct sph_implicit *own = s->own;
  for (int g = 0; g < s->sim->groups; g++) {
    const long base = own->pattern.base[g];
    if (s->sim->group[g]->wall || sph_sim_unknown_takes_part(s->sim->group[g], u)) continue;
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
static double active_rows(const sph_solving *s, const sph_unknown *u)
{
  long sum = 0;
  for (int g = 0; g < s->sim->groups; g++)
    if (sph_sim_unknown_takes_part(s->sim->group[g], u)) sum += s->z[g].n;
  return (double)sum;
}

static double mean(double squares, double count) { return count > 0 ? sqrt(squares / count) : 0; }

/* Weighted mean of the change of the unknown. */
static double change_of(const sph_solving *s, const sph_unknown *u)
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

sph_evaluation sph_sim_unknown_evaluation(const sph_solving *s, const sph_part *part)
{
  sph_evaluation e = {.sim = s->sim, .t = s->stage->t, .part = part};
  for (int g = 0; g < s->sim->groups; g++) e.view[g] = s->z[g];
  return e;
}

/* Records, pressures, walls of the iterate: with the rates that the right-hand side wants. */
static int evaluate(const sph_solving *s, const sph_unknown *u)
{
  const sph_part *part = u->direct ? &u->walls : &u->part;
  if (!u->direct || u->meets_walls)
    return sph_sim_rhs_part(s->sim, part, s->stage->t, s->stage->z, s->own->rate);
  sph_evaluation e = sph_sim_unknown_evaluation(s, &u->part);
  int status = sph_sim_density(&e);
  if (!status) status = sph_sim_material_eos(&e);
  if (!status) status = sph_sim_walls_fill(&e);
  return status;
}

/* What jacobian_body of a group's terms adds to the diagonal: gamma M times the decay. */
static void add_bodies(const sph_solving *s, const sph_unknown *u, const sph_evaluation *e, int g)
{
  struct sph_implicit *own = s->own;
  const sph_term_set *terms = &s->sim->terms;
  const int *order = sph_neighbors_order(s->sim->neighbors, g);
  const int d = u->matrix->components;
  const double gamma = s->stage->gamma;
  double *decay = own->b; /* [n], not in use yet */
  memset(decay, 0, (size_t)s->z[g].n * sizeof *decay);
  const sph_term_jacobian jacobian = {.v = u->number == SPH_UNKNOWN_VELOCITY ? decay : NULL,
                                      .T = u->number == SPH_UNKNOWN_ENERGY ? decay : NULL,
                                      .s = u->number >= SPH_UNKNOWN_SCALAR ? decay : NULL};
  for (int k = 0; k < terms->called; k++) {
    const sph_called_term *call = &terms->call[k];
    if (!(u->called >> k & 1) || !call->term.jacobian_body) continue;
    sph_particles particles = sph_sim_bodies_particles(e, g);
    particles.s = call->scalar < 0 ? NULL : s->z[g].s[call->scalar];
    call->term.jacobian_body(&call->term, &particles, &jacobian);
  }
  for (long k = 0; k < s->z[g].n; k++) {
    const long i = order[k], row = own->pattern.base[g] + k;
    const double mass =
        u->number == SPH_UNKNOWN_ENERGY ? s->z[g].m[i] : u->matrix->A.floor[row * d];
    for (int c = 0; c < d; c++)
      u->matrix->A.diagonal[row * d + c] += gamma * mass * fmax(decay[i], 0);
  }
}

static void add_called(const sph_solving *s, const sph_unknown *u, sph_evaluation *e)
{
  const int which = u->number == SPH_UNKNOWN_VELOCITY ? TILE_VELOCITY
                    : u->number == SPH_UNKNOWN_ENERGY ? TILE_TEMPERATURE
                                                      : TILE_SCALAR;
  for (int g = 0; g < s->sim->groups; g++)
    if (sph_sim_unknown_takes_part(s->sim->group[g], u)) add_bodies(s, u, e, g);
  if (u->part.tiles)
    sph_sim_matrix_add_tiles(e, &s->own->pattern, u->matrix, s->stage->gamma, which, u->per_volume);
}

static int fill(const sph_solving *s, const sph_unknown *u)
{
  sph_evaluation e = sph_sim_unknown_evaluation(s, &u->part);
  int status = sph_sim_matrix_shape(s->sim, &s->own->pattern, u->matrix);
  if (status) return status;
  idle_rows(s, u);
  if (!u->direct)
    u->matrix->from_pattern = 0;
  else if (sph_sim_matrix_same(&e, &s->own->pattern, u->matrix, s->stage->gamma, u->coupling))
    return SPH_OK;
  rows(s, u, set_mass);
  sph_sim_matrix_fill(&e, &s->own->pattern, u->matrix, s->stage->gamma, u->coupling);
  if (u->called) add_called(s, u, &e);
  return SPH_OK;
}

/* Pairs exchange: without walls sum M x = sum b, whatever the error of x.  A constant makes it so,
 * and what is conserved is so to rounding.  Rows that are coupled to none keep out of it: M x = b.
 */
static void conserve(const sph_solving *s, const sph_unknown *u)
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
static double linear_tolerance(const sph_solving *s, const sph_unknown *u)
{
  return 0.3 * s->stage->tolerance *
         sqrt(fmax(active_rows(s, u), 1) / (double)s->own->pattern.rows);
}

static int solve_linear(const sph_solving *s, const sph_unknown *u)
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
static double missed(const sph_solving *s, const sph_unknown *u)
{
  struct sph_implicit *own = s->own;
  double sum = 0;
  if (u->number != SPH_UNKNOWN_ENERGY || !u->direct) return 0;
  for (int g = 0; g < s->sim->groups; g++) {
    const int *order = sph_neighbors_order(s->sim->neighbors, g);
    if (!sph_sim_unknown_takes_part(s->sim->group[g], u)) continue;
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
int sph_sim_unknown_near(double change, double last, double tolerance)
{
  double rate = last > 0 ? fmin(change / last, 0.9) : 0.5;
  return change * rate / (1 - rate) <= 0.3 * tolerance;
}

static const char *name_of(const sph_solving *s, const sph_unknown *u)
{
  static const char *const names[] = {"density", "velocity", "energy"};
  return u->number < SPH_UNKNOWN_SCALAR ? names[u->number]
                                        : s->sim->terms.scalar[u->number - SPH_UNKNOWN_SCALAR].name;
}

int sph_sim_unknown_solve(const sph_solving *s, const sph_unknown *u)
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
    if (sph_sim_unknown_near(change, last, s->stage->tolerance) &&
        miss <= 0.3 * s->stage->tolerance)
      return SPH_OK;
    last = change;
  }
  return sph_sim_admit_retry(s->sim,
                             "implicit stage: %s change by %g of the tolerance still after %d "
                             "iterations",
                             name_of(s, u), last / s->stage->tolerance, MOST);
}

int sph_sim_unknown_solve_energy(const sph_solving *s)
{
  struct sph_implicit *own = s->own;
  const sph_unknown *u = &own->unknown[SPH_UNKNOWN_ENERGY];
  if (own->heats) {
    int status = sph_sim_rhs_part(s->sim, &own->heating, s->stage->t, s->stage->z, own->rate);
    if (status) return status;
    rows(s, u, take_heat);
    rows(s, u, add_heat);
  }
  return u->there ? sph_sim_unknown_solve(s, u) : SPH_OK;
}
