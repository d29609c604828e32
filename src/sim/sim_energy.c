/* Which energy a group integrates, and the others that follow from it.
 *
 *   u                du/dt = p/rho^2 (drho/dt)_c + q
 *   e = u + v^2/2    de/dt = du/dt + v.a
 *   A = p/rho^gamma  dA/dt = (gamma - 1) rho^(1 - gamma) q,  u = A rho^(gamma - 1)/(gamma - 1)
 *                    (ideal gas; Springel & Hernquist 2002)
 *   T                c_v dT/dt = T (dp/dT)_rho/rho^2 (drho/dt)_c + q
 *
 * q: all heating but that by compression [W/kg]; (drho/dt)_c: the rate of continuity, without
 * diffusion.  Where the pressure does not depend on the energy it is carried along: du/dt = q,
 * c_v dT/dt = q. */
#include "sim_energy.h"

#include <math.h>
#include <string.h>

enum { PARALLEL_MIN = 4096, CHUNK = 256 };

static double speed2(const sph_view *view, int dim, long i)
{
  double v2 = 0;
  for (int d = 0; d < dim; d++) v2 += view->v[d][i] * view->v[d][i];
  return v2;
}

/* u of particles [begin, end). */
static void internal(const sph_group *group, const sph_view *view, long begin, long end)
{
  const double *energy = view->energy;
  double gamma = group->eos.gamma;
  switch (sph_group_data_energy(group)) {
  case SPH_TOTAL_ENERGY:
    for (long i = begin; i < end; i++) view->u[i] = energy[i] - speed2(view, group->dim, i) / 2;
    break;
  case SPH_ENTROPY:
    for (long i = begin; i < end; i++)
      view->u[i] = energy[i] * pow(view->rho[i], gamma - 1) / (gamma - 1);
    break;
  case SPH_TEMPERATURE:
    sph_eos_energy(&group->eos, end - begin, view->rho + begin, energy + begin, view->u + begin);
    break;
  default: break;
  }
}

void sph_sim_energy_internal_of(const sph_group *group, const sph_view *view, long begin, long end)
{
  int integrated = sph_group_data_energy(group), temperature = view->T && view->T != view->energy;
  if (integrated < 0 || (integrated == SPH_ENERGY && !temperature)) return;
  internal(group, view, begin, end);
  if (temperature)
    sph_eos_temperature(&group->eos, end - begin, view->rho + begin, view->u + begin,
                        view->T + begin);
}

void sph_sim_energy_internal(const sph_sim *sim, const sph_group *group, const sph_view *view)
{
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long i = 0; i < view->n; i += CHUNK)
    sph_sim_energy_internal_of(group, view, i, view->n - i < CHUNK ? view->n : i + CHUNK);
}

double sph_sim_energy_rate(const sph_group *group, const sph_view *view, long i, double heat,
                           double compression)
{
  const double rho = view->rho[i], gamma = group->eos.gamma;
  const double per_pressure = compression / (rho * rho);
  const int works = group->eos.thermal && compression != 0; /* else there may be no pressure */
  double rate = heat + (works ? view->p[i] * per_pressure : 0), pT = 0;
  switch (sph_group_data_energy(group)) {
  case SPH_TOTAL_ENERGY:
    for (int d = 0; d < group->dim; d++) rate += view->v[d][i] * view->dv[d][i];
    return rate;
  case SPH_ENTROPY: return (gamma - 1) * pow(rho, 1 - gamma) * heat;
  case SPH_TEMPERATURE:
    if (works) sph_eos_thermal_pressure(&group->eos, 1, &rho, &view->energy[i], &pT);
    return (heat + pT * per_pressure) / group->eos.c_v;
  default: return rate;
  }
}

/* One energy of a group from rho, u, p, v, into to[n]. */
static void derive(const sph_group *group, const sph_view *view, int field, double *to)
{
  double gamma = group->eos.gamma;
  if (field == SPH_TEMPERATURE) {
    sph_eos_temperature(&group->eos, view->n, view->rho, view->u, to);
    return;
  }
  for (long i = 0; i < view->n; i++) {
    double u = view->u[i], rho = view->rho[i];
    if (field == SPH_TOTAL_ENERGY) to[i] = u + speed2(view, group->dim, i) / 2;
    if (field == SPH_ENTROPY) to[i] = (gamma - 1) * u * pow(rho, 1 - gamma);
    if (field == SPH_ENTHALPY) to[i] = u + view->p[i] / rho;
  }
}

int sph_sim_energy_has(const sph_group *group, int field)
{
  if (group->wall || sph_group_data_energy(group) < 0) return 0;
  if (field == SPH_TEMPERATURE) return group->eos.c_v > 0;
  if (field == SPH_ENTROPY) return !strcmp(group->eos.name, "ideal-gas");
  return field == SPH_TOTAL_ENERGY || field == SPH_ENTHALPY;
}

int sph_sim_energy_derive(sph_group *group, const double *y, int field)
{
  int status = sph_group_data_own(group, field, &group->sim->error);
  const sph_view view = sph_group_data_view(group, y, NULL);
  if (!status) derive(group, &view, field, group->own[field][0]);
  return status;
}

/* ---- before the run ---- */

static int check(sph_group *group, int field)
{
  sph_sim *sim = group->sim;
  const char *name = sph_group_energy(group);
  if (field == SPH_ENTROPY && !sph_sim_energy_has(group, SPH_ENTROPY))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: energy entropy needs an ideal gas, not equation of state %s",
                        group->name, group->eos.name);
  if (field == SPH_TEMPERATURE && !(group->eos.c_v > 0))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: energy temperature needs a specific heat: set eos.c_v",
                        group->name);
  if (field == SPH_TOTAL_ENERGY && !group->eos.thermal)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: the pressure of equation of state %s does not depend on an "
                        "energy; right are u, temperature or none, not %s",
                        group->name, group->eos.name, name);
  if (field < 0 && group->eos.thermal)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: equation of state %s needs an energy, not none", group->name,
                        group->eos.name);
  return SPH_OK;
}

int sph_sim_energy_start(sph_group *group)
{
  int field = sph_group_data_energy(group), status = check(group, field);
  if (!status && group->sim->needs_temperature && group->eos.c_v > 0)
    status = sph_group_data_own(group, SPH_TEMPERATURE, &group->sim->error);
  if (status || field < 0 || field == SPH_ENERGY) return status;
  status = sph_sim_energy_derive(group, NULL, field);
  int carried = field == SPH_TEMPERATURE && !group->eos.thermal; /* else the eos knows better */
  for (long i = 0; !status && carried && i < group->n; i++)
    if (!(group->own[field][0][i] > 0))
      status = sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                            "group %s, particle %ld: starts at %g K; right is > 0: set its "
                            "temperature",
                            group->name, i, group->own[field][0][i]);
  return status;
}
