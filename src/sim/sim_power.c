/* The power of each term: what its rates alone do to the energies of the fluids.
 *
 *   dK/dt = sum_i m_i v_i . a_i,   dU/dt = sum_i m_i du_i/dt
 *
 * with, by the energy that is integrated (sim_energy.c),
 *
 *   u  du/dt    e  de/dt - v.a    A  rho^(gamma - 1)/(gamma - 1) dA/dt + p/rho^2 drho/dt
 *   T  c_v dT/dt + (du/drho)_T drho/dt
 *
 * and p/rho^2 drho/dt of the elastic energy of a fluid whose pressure depends on density alone. */
#include "sim_power.h"

#include <math.h>

#include "sim_force.h"
#include "sim_parts.h"
#include "sim_prepare.h"
#include "term_part.h"

/* The pair terms, drag and gravity that a simulation may have; the others are called. */
static const unsigned bits_of[] = {
    SPH_CONTINUITY,   SPH_PRESSURE_FORCE, SPH_ARTIFICIAL, SPH_SIGNAL, SPH_MORRIS | SPH_MCG,
    SPH_CONDUCTIVITY, SPH_CONDUCTION,     SPH_DIFFUSION,  SPH_DRAG,   SPH_UNIFORM,
    SPH_SHIFTING,     SPH_TRANSPORT,      SPH_STRESS,
};
enum { BUILT_IN = sizeof bits_of / sizeof *bits_of };

/* Bits of term k, or of a called one; 0: behind the last. */
static unsigned find(const sph_sim *sim, int k, const sph_called_term **call)
{
  const sph_term_set *set = &sim->terms;
  unsigned bits = set->bits | (set->uniform ? SPH_UNIFORM : 0);
  if (set->drag_K > 0 || set->drag_rate > 0) bits |= SPH_DRAG;
  if (set->shift.steps) bits &= ~(unsigned)SPH_SHIFTING; /* between steps: no part of f */
  *call = NULL;
  for (int b = 0; b < BUILT_IN; b++)
    if ((bits & bits_of[b]) && k-- == 0) return bits_of[b];
  if (k >= 0 && k < set->called) *call = &set->call[k];
  return 0;
}

const char *sph_sim_power_term(const sph_sim *sim, int k)
{
  const sph_called_term *call;
  unsigned bits = sim && k >= 0 ? find(sim, k, &call) : 0;
  if (bits) return sph_term_part_named(bits);
  return sim && k >= 0 && call ? call->name : NULL;
}

int sph_sim_power_pushes(const sph_sim *sim, int k)
{
  const sph_called_term *call;
  const unsigned bits = find(sim, k, &call);
  return call || (bits & ~(unsigned)(SPH_CONTINUITY | SPH_DIFFUSION | SPH_CONDUCTIVITY |
                                     SPH_CONDUCTION)) != 0;
}

/* (du/drho)_T by central differences: linear in 1/rho or constant for what is built in. */
static double slope_at_T(const sph_eos *eos, double rho, double T)
{
  const double step = 1e-4 * rho, at[2] = {rho - step, rho + step}, both[2] = {T, T};
  double u[2];
  sph_eos_energy(eos, 2, at, both, u);
  return (u[1] - u[0]) / (2 * step);
}

/* Rate of the internal energy of particle i [W/kg]. */
static double heating(const sph_group *group, const sph_view *view, long i, double va)
{
  const sph_eos *eos = &group->eos;
  const double rho = view->rho[i], drho = view->drho ? view->drho[i] : 0;
  const double work = view->p[i] / (rho * rho) * drho, du = view->du ? view->du[i] : 0;
  double rate = 0;
  if (!eos->thermal && eos->elastic_energy) rate = work;
  switch (sph_group_data_energy(group)) {
  case SPH_ENERGY: return rate + du;
  case SPH_TOTAL_ENERGY: return rate + du - va;
  case SPH_ENTROPY: return pow(rho, eos->gamma - 1) / (eos->gamma - 1) * du + work;
  case SPH_TEMPERATURE:
    if (drho != 0 && eos->thermal) rate = slope_at_T(eos, rho, view->energy[i]) * drho;
    return rate + eos->c_v * du;
  default: return rate;
  }
}

static void sum_up(const sph_evaluation *e, sph_power *power)
{
  for (int g = 0; g < e->sim->groups; g++) {
    const sph_group *group = e->sim->group[g];
    const sph_view *view = &e->view[g];
    for (long i = 0; !group->wall && i < view->n; i++) {
      double va = 0;
      for (int d = 0; d < e->sim->dim; d++) va += view->v[d][i] * view->dv[d][i];
      power->kinetic += view->m[i] * va;
      power->internal += view->m[i] * heating(group, view, i, va);
    }
  }
}

/* The phases of the right-hand side behind the walls, of one term. */
int sph_sim_power_rates(sph_sim *sim, int k, N_Vector ydot, sph_part *part, sph_evaluation *e)
{
  const sph_called_term *call;
  const unsigned bits = find(sim, k, &call);
  int status = sph_sim_force_begin(e, sim, ydot);
  if (!status)
    status = sph_sim_parts_of(sim, part, bits, call ? 1u << (call - sim->terms.call) : 0);
  if (status) return status;
  part->gravity = (bits & SPH_UNIFORM) != 0;
  if (bits & SPH_PRESSURE_FORCE) part->terms |= sim->loop_terms & SPH_CONTINUITY; /* its work */
  part->terms |= fluid_corrections(part->terms | (sim->loop_terms & SPH_CORRECTED));
  e->part = part;
  status = sph_sim_bodies_add(e);
  if (!status) status = sph_sim_gradients(e);
  if (!status) status = sph_sim_switches(e);
  if (!status) status = sph_sim_shift_add(e);
  if (!status) status = sph_sim_drag_add(e);
  if (!status) status = sph_sim_pairs_add(e);
  if (status > 0) status = sph_sim_fail(sim, SPH_ERR_STEP, "t = %g s: %s", sim->time, sim->retry);
  return status;
}

/* Where density is a sum, the work on an elastic fluid is not in f. */
static int check(sph_sim *sim)
{
  for (int g = 0; sim->terms.summed && g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (!group->wall && !group->eos.thermal && group->eos.elastic_energy)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "the power of terms: the density of %s is a sum, so that the rate of its "
                          "elastic energy is no part of f; right is term continuity",
                          group->name);
  }
  return SPH_OK;
}

int sph_sim_power(sph_sim *sim, int k, sph_power *power)
{
  sph_evaluation e;
  sph_part part;
  if (!sph_sim_data_ok(sim)) return sph_sim_status(sim);
  const char *name = sph_sim_power_term(sim, k);
  if (!name || !power)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "the power of term number %d: %s", k,
                        power ? "there is none" : "no place for it (NULL)");
  int status = check(sim);
  if (!status) status = sph_sim_prepare(sim);
  if (status) return status;
  *power = (sph_power){.term = name};
  N_Vector ydot = sph_nvector_clone(sim->ydot, "the rates of one term", &sim->error);
  if (!ydot) return sim->error.status;
  status = sph_sim_power_rates(sim, k, ydot, &part, &e);
  if (!status) sum_up(&e, power);
  N_VDestroy(ydot);
  return status;
}
