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

#include "clock.h"
#include "keep.h"
#include "memory.h"
#include "sim_parts.h"
#include "sim_unknown.h"
#include "sim_weights.h"
#include "term_part.h"

enum { MOST = 40, ROWS = 1024 }; /* turns; rows from which on threads pay */

enum {
  LAMINAR = SPH_MORRIS | SPH_MCG,
  VISCOUS = LAMINAR | SPH_ARTIFICIAL,
  CENTRAL = SPH_MCG | SPH_ARTIFICIAL | SPH_DRAG /* forces along r: the vector matrix */
};

/* ---- the stage ---- */

/* The change of the state since the last call, in the norm of the stage. */
static int turn(const sph_solving *s, double *change)
{
  N_Vector last = s->own->last, rate = s->own->rate, weight = s->own->norm;
  int status = sph_sim_weights(s->stage->z, weight, s->sim);
  N_VLinearSum(1, s->stage->z, -1, last, rate);
  *change = N_VWrmsNorm(rate, weight);
  N_VScale(1, s->stage->z, last);
  return status;
}

static int solve_all(const sph_solving *s)
{
  const struct sph_implicit *own = s->own;
  double last = 0, change = 0;
  int status = own->loops ? turn(s, &change) : SPH_OK;
  for (int k = 0; !status && k < MOST; k++) {
    for (int q = 0; !status && q < SPH_UNKNOWNS; q++)
      if (q == SPH_UNKNOWN_ENERGY)
        status = sph_sim_unknown_solve_energy(s);
      else if (own->unknown[q].there)
        status = sph_sim_unknown_solve(s, &own->unknown[q]);
    if (!status && own->loops) status = turn(s, &change);
    if (status || !own->loops) return status;
    if (k > 0 && sph_sim_unknown_near(change, last, s->stage->tolerance)) return SPH_OK;
    last = change;
  }
  return status ? status
                : sph_sim_admit_retry(s->sim, "implicit stage: unknowns that act on each other do "
                                              "not settle");
}

/* z is `known` but for what is solved for, where it is a guess; energies start from `known`. */
static void start(const sph_solving *s, int g, long i)
{
  const sph_view *z = &s->z[g], *known = &s->known[g];
  const sph_unknown *u = s->own->unknown;
  const sph_group *group = s->sim->group[g];
  for (int d = 0; d < s->sim->dim; d++) {
    z->x[d][i] = known->x[d][i];
    if (!u[SPH_UNKNOWN_VELOCITY].there ||
        !sph_sim_unknown_takes_part(group, &u[SPH_UNKNOWN_VELOCITY]))
      z->v[d][i] = known->v[d][i];
  }
  if (!u[SPH_UNKNOWN_DENSITY].there || !sph_sim_unknown_takes_part(group, &u[SPH_UNKNOWN_DENSITY]))
    z->rho[i] = known->rho[i];
  if (z->energy) z->energy[i] = known->energy[i];
  for (int q = 0; q < s->sim->terms.scalars; q++)
    if (!u[SPH_UNKNOWN_SCALAR + q].there ||
        !sph_sim_unknown_takes_part(group, &u[SPH_UNKNOWN_SCALAR + q]))
      z->s[q][i] = known->s[q][i];
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
static int open_stage(const sph_solving *s)
{
  const sph_part *part = &s->sim->part[SPH_PIECE_IMPLICIT];
  for (int g = 0; g < s->sim->groups; g++) {
    if (s->sim->group[g]->wall) continue;
#pragma omp parallel for num_threads(s->sim->threads) schedule(static) if (s->z[g].n > ROWS)
    for (long i = 0; i < s->z[g].n; i++) start(s, g, i);
  }
  sph_evaluation e = sph_sim_unknown_evaluation(s, part);
  int status = sph_sim_walls_move(&e);
  if (!status) status = sph_sim_lists_update(&e);
  for (int g = 0; !status && g < s->sim->groups; g++) sph_sim_pairs_pack_positions(&e, g);
  if (!status) status = sph_sim_matrix_pattern(&e, &s->own->pattern);
  return status ? status : reserve(s->sim, s->own);
}

int sph_sim_implicit_solve(sph_stage *stage, void *ctx)
{
  sph_sim *sim = ctx;
  sph_solving s = {.sim = sim, .own = sim->implicit, .stage = stage};
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
  sph_unknown *u = &own->unknown[number];
  const int vector = number == SPH_UNKNOWN_VELOCITY && (bits & CENTRAL);
  *u = (sph_unknown){.number = number, .there = bits || called, .called = called};
  if (!u->there) return SPH_OK;
  u->coupling = number < SPH_UNKNOWN_SCALAR ? coupling[number] : SPH_COUPLING_NONE;
  u->components = number == SPH_UNKNOWN_VELOCITY ? sim->dim : 1;
  u->drags = (bits & SPH_DRAG) != 0;
  u->direct = number != SPH_UNKNOWN_DENSITY && !(bits & SPH_ARTIFICIAL) && !called;
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
  int status = make_unknown(sim, SPH_UNKNOWN_DENSITY, bits & SPH_DIFFUSION, 0);
  if (!status)
    status = make_unknown(sim, SPH_UNKNOWN_VELOCITY, bits & (VISCOUS | SPH_DRAG),
                          called_that(sim, SPH_CHANGES_VELOCITY, -1));
  if (!status)
    status = make_unknown(sim, SPH_UNKNOWN_ENERGY, bits & SPH_CONDUCTION,
                          called_that(sim, SPH_CHANGES_ENERGY, -1));
  for (int q = 0; !status && q < terms->scalars; q++) {
    unsigned called = called_that(sim, SPH_CHANGES_SCALAR, q);
    status = make_unknown(sim, SPH_UNKNOWN_SCALAR + q, 0, called);
    for (int k = 0; k < terms->called; k++)
      if (called >> k & 1)
        sim->implicit->unknown[SPH_UNKNOWN_SCALAR + q].per_volume =
            terms->call[k].term.scalar.per_volume;
  }
  return status;
}

/* Which unknowns act on each other. */
static int make_order(sph_sim *sim, unsigned bits)
{
  struct sph_implicit *own = sim->implicit;
  const sph_unknown *u = own->unknown;
  int energies = 0, thermal = 0;
  for (int g = 0; g < sim->groups; g++) {
    energies |= sph_group_data_energy(sim->group[g]) >= 0;
    thermal |= !sim->group[g]->wall && sim->group[g]->eos.thermal;
  }
  own->heats = energies && u[SPH_UNKNOWN_VELOCITY].there;
  own->loops = some_act_on_several(sim) ||
               (thermal && ((bits & SPH_ARTIFICIAL) || u[SPH_UNKNOWN_DENSITY].meets_walls) &&
                (own->heats || u[SPH_UNKNOWN_ENERGY].there));
  return sph_sim_parts_of(sim, &own->heating, bits & (VISCOUS | SPH_DRAG),
                          u[SPH_UNKNOWN_VELOCITY].called & ~u[SPH_UNKNOWN_ENERGY].called);
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

double sph_sim_implicit_bytes(const sph_sim *sim)
{
  const struct sph_implicit *own = sim->implicit;
  if (!own) return 0;
  int vectors = (own->rate != NULL) + (own->last != NULL) + (own->norm != NULL);
  return sizeof *own + 8.0 * vectors * (double)sim->layout.length +
         8.0 * 5 * (double)own->rows * sim->dim + sph_sim_matrix_pattern_bytes(&own->pattern) +
         sph_sim_matrix_bytes(&own->scalar) + sph_sim_matrix_bytes(&own->vector);
}

/* Patterns and matrices have numbers by which solvers know them again; those themselves are made
 * anew. */
static int keep_numbers(sph_sim *sim, sph_keep *keep)
{
  struct sph_implicit *own = sim->implicit;
  sph_pattern *pattern = &own->pattern;
  sph_keep_integer(keep, "builds", 1, &pattern->builds);
  sph_keep_integer(keep, "pattern", 1, &pattern->number);
  sph_keep_integer(keep, "scalar_values", 1, &own->scalar.values);
  int status = sph_keep_integer(keep, "vector_values", 1, &own->vector.values);
  if (status || !sph_keep_reading(keep)) return status;
  pattern->again = 1;
  own->scalar.pattern = own->vector.pattern = -1;
  own->scalar.from_pattern = own->vector.from_pattern = 0;
  return SPH_OK;
}

int sph_sim_implicit_keep(sph_sim *sim, sph_keep *keep)
{
  static const char *const name[2] = {"scalar", "vector"};
  const char *method = sim->integrator_def.linear;
  struct sph_implicit *own = sim->implicit;
  if (!own) return SPH_OK;
  int status = keep_numbers(sim, keep);
  if (!sph_keep_word(keep, "linear", method ? method : "auto")) return keep->error->status;
  for (int k = 0; !status && k < 2; k++) {
    if (!own->solver[k]) continue;
    sph_keep_enter(keep, name[k]);
    status = sph_linear_keep(own->solver[k], keep);
    sph_keep_leave(keep);
  }
  return status;
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
