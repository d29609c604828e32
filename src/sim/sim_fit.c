#include "sim_fit.h"

#include <string.h>

#include "term_part.h"

/* The first of these terms, or of those of the user's own that have a pair function; NULL: none. */
static const char *first_of(const sph_sim *sim, unsigned bits)
{
  for (int k = 0; k < sim->terms.called; k++)
    if (sim->terms.call[k].term.pair) return sim->terms.call[k].name;
  return sph_term_part_named(sim->loop_terms & bits);
}

/* Forces of positions alone, and nothing integrated besides. */
static int separable(sph_sim *sim)
{
  const char *method = sph_sim_integrator(sim);
  const char *term = first_of(sim, SPH_VISCOUS | SPH_XSPH | SPH_DRAG |
                                       (sim->part[SPH_WHOLE].shift ? SPH_SHIFTS : 0));
  for (int k = 0; !term && k < sim->terms.called; k++)
    if (sim->terms.call[k].term.body && !sim->terms.call[k].term.potential)
      term = sim->terms.call[k].name;
  if (term)
    return sph_sim_fail(
        sim, SPH_ERR_ARGUMENT,
        "integrator %s steps positions and velocities in turns: forces are to depend "
        "on positions alone, and %s may depend on velocities",
        method, term);
  if (!sim->terms.summed)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "integrator %s steps positions and velocities in turns: density is to be a "
                        "sum over neighbours (summation), not integrated",
                        method);
  for (int g = 0; g < sim->groups; g++)
    if (!sim->group[g]->wall && sph_group_data_energy(sim->group[g]) >= 0)
      return sph_sim_fail(
          sim, SPH_ERR_ARGUMENT,
          "integrator %s steps positions and velocities in turns, and %s integrates "
          "an energy besides: right is an equation of state without one",
          method, sim->group[g]->name);
  return SPH_OK;
}

static int bounded(sph_sim *sim)
{
  unsigned without = SPH_SIGNAL | SPH_CONDUCTIVITY | SPH_STRESS;
  if (sim->part[SPH_WHOLE].shift) without |= SPH_SHIFTS;
  if (sph_term_set_alpha(&sim->terms) >= 0) without |= SPH_ARTIFICIAL; /* rates of alpha */
  if (sim->loop_terms & SPH_LAMINAR_CORRECTED) without |= SPH_MORRIS | SPH_MCG;
  if (sim->loop_terms & SPH_PRESSURE_ONE_SIDED) without |= SPH_PRESSURE_FORCE;
  const char *term = first_of(sim, without);
  if (!term) return SPH_OK;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "integrator %s needs a bound of the eigenvalues of all terms, and there is "
                      "none of %s",
                      sph_sim_integrator(sim), term);
}

/* Is the energy a function of the state, particle by particle? */
static int relaxing(sph_sim *sim)
{
  int linear = 1;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const int field = sph_group_data_energy(group);
    if (group->model == SPH_MODEL_DBC)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "relax energy: the density of wall %s (dbc) stores work of the fluid; "
                          "right is boundary adami or mirror",
                          group->name);
    if (group->wall) continue;
    linear &= field == SPH_TOTAL_ENERGY;
    if (field == SPH_ENTROPY || field == SPH_TEMPERATURE)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "relax energy: %s integrates %s; right is u (sph_group_set_energy)",
                          group->name, sph_group_energy(group));
    if (group->eos.thermal || group->eos.dust) continue;
    if (sim->terms.summed)
      return sph_sim_fail(
          sim, SPH_ERR_ARGUMENT,
          "relax energy: the elastic energy of %s is in its density, which is a sum "
          "over neighbours here: right is continuity, or an equation of state with "
          "an internal energy",
          group->name);
    if (!group->eos.elastic_energy)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "relax energy: equation of state %s of %s tells no elastic energy",
                          group->eos.name, group->name);
  }
  if (linear)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "relax energy: of integrated total energies each step keeps the sum; right "
                        "is no relaxation, or u (sph_group_set_energy)");
  return SPH_OK;
}

/* What the integrator wants: sph_integrator_wants. */
static int wants_of(const char *method)
{
  sph_integrator_info info;
  for (int k = 0; sph_integrator_info_get(k, &info); k++)
    if (!strcmp(info.name, method)) return info.wants;
  return 0;
}

int sph_sim_fit(sph_sim *sim)
{
  const int wants = sim->integrator_def.own ? 0 : wants_of(sph_sim_integrator(sim));
  int status = wants & SPH_WANTS_SEPARABLE ? separable(sim) : SPH_OK;
  if (!status && (wants & SPH_WANTS_DOMINANT)) status = bounded(sim);
  if (!status && sim->integrator_def.relax) status = relaxing(sim);
  return status;
}
