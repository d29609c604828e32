/* Initial density and pressure of a group, and its material. */
#include <math.h>

#include "material_table.h"
#include "sim_data.h"

static int ready(const sph_group *group, const char *what, int inverse)
{
  if (!group || !sph_sim_data_ok(group->sim)) return 0;
  if (group->sim->prepared)
    sph_sim_fail(group->sim, SPH_ERR_STATE, "group %s: %s is set before the run", group->name,
                 what);
  else if (!group->has_eos)
    sph_sim_fail(group->sim, SPH_ERR_STATE, "group %s: set its equation of state before its %s",
                 group->name, what);
  else if (inverse && !group->eos.density)
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                 "group %s: equation of state %s has no inverse rho(p)", group->name,
                 group->eos.name);
  return sph_sim_data_ok(group->sim);
}

/* Density by pressure at the present volume: mass and density change by the same factor. */
static void set_density(sph_group *group, long i, double rho)
{
  group->own[SPH_MASS][0][i] *= rho / group->own[SPH_DENSITY][0][i];
  group->own[SPH_DENSITY][0][i] = rho;
}

/* Internal energy that gives pressure p at density rho; without energy_at rho(p, u) = rho, by
 * bisection in log u. */
static double energy_of(const sph_eos *eos, double p, double rho)
{
  if (eos->energy_at) return eos->energy_at(eos, rho, p);
  double low = -100, high = 100; /* ln u */
  for (int k = 0; k < 200; k++) {
    double middle = 0.5 * (low + high);
    if (eos->density(eos, p, exp(middle)) > rho)
      low = middle; /* too cold */
    else
      high = middle;
  }
  return exp(0.5 * (low + high));
}

/* Is (rho, u) a state, and one with pressure p? */
static int has_pressure(const sph_eos *eos, double rho, double u, double p)
{
  double found, c;
  if (!isfinite(p) || !(isfinite(rho) && rho > 0)) return 0;
  eos->pressure(eos, 1, &rho, eos->thermal ? &u : NULL, &found, &c);
  if (!eos->thermal) return !isnan(c);
  return fabs(found - p) <= 1e-6 * (fabs(p) + rho * c * c); /* NaN: no */
}

void sph_group_set_pressure(sph_group *group, const double *p)
{
  if (!ready(group, "pressure", 1)) return;
  if (!p) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: no pressures (NULL)", group->name);
    return;
  }
  for (long i = 0; i < group->n; i++) {
    double rho = group->own[SPH_DENSITY][0][i];
    double u = group->eos.thermal ? energy_of(&group->eos, p[i], rho) : 0;
    if (!group->eos.thermal) rho = group->eos.density(&group->eos, p[i], 0);
    if (!has_pressure(&group->eos, rho, u, p[i])) {
      sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                   "group %s, particle %ld: no state of equation of state %s has p = %g Pa",
                   group->name, i, group->eos.name, p[i]);
      return;
    }
    if (group->eos.thermal)
      group->own[SPH_ENERGY][0][i] = u;
    else
      set_density(group, i, rho);
  }
}

void sph_group_set_density(sph_group *group, const double *rho)
{
  if (!ready(group, "density", 0)) return;
  if (!rho) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: no densities (NULL)", group->name);
    return;
  }
  for (long i = 0; i < group->n; i++) {
    double p, c = 0;
    const int positive = rho[i] > 0 && rho[i] < INFINITY;
    if (positive && !group->eos.thermal) group->eos.pressure(&group->eos, 1, &rho[i], NULL, &p, &c);
    if (!positive || isnan(c)) {
      sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s, particle %ld: density %g kg/m^3; %s%s",
                   group->name, i, rho[i],
                   positive ? "no state of equation of state " : "right is > 0",
                   positive ? group->eos.name : "");
      return;
    }
    set_density(group, i, rho[i]);
  }
}

/* d p/d z = rho g downwards from p at the surface, by Runge-Kutta of order 4 in depth: for any
 * inverse rho(p). */
static double pressure_at(const sph_eos *eos, double p, double depth, double g)
{
  enum { STEPS = 200 };
  double dz = depth / STEPS;
  for (int k = 0; k < STEPS; k++) {
    double k1 = g * eos->density(eos, p, 0);
    double k2 = g * eos->density(eos, p + dz / 2 * k1, 0);
    double k3 = g * eos->density(eos, p + dz / 2 * k2, 0);
    double k4 = g * eos->density(eos, p + dz * k3, 0);
    p += dz / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return p;
}

void sph_group_set_hydrostatic(sph_group *group, int axis, double surface, double g)
{
  if (ready(group, "hydrostatic pressure", 1))
    sph_group_set_column(group, axis, surface, group->eos.p_background, g);
}

void sph_group_set_column(sph_group *group, int axis, double surface, double p_surface, double g)
{
  if (!ready(group, "hydrostatic pressure", 1)) return;
  if (axis < 0 || axis >= group->dim || !isfinite(surface) || !isfinite(p_surface) ||
      !(isfinite(g) && g >= 0)) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                 "group %s: hydrostatic along axis %d, surface %g m, pressure there %g Pa, g = %g "
                 "m/s^2; right is 0 <= axis < %d, finite, g >= 0",
                 group->name, axis, surface, p_surface, g, group->dim);
    return;
  }
  if (group->eos.thermal || group->eos.dust) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: hydrostatic needs a liquid, not %s",
                 group->name, group->eos.name);
    return;
  }
  for (long i = 0; i < group->n; i++) {
    double depth = fmax(0, surface - group->own[SPH_POSITION][axis][i]);
    double p = pressure_at(&group->eos, p_surface, depth, g);
    set_density(group, i, group->eos.density(&group->eos, p, 0));
  }
}

void sph_group_set_temperature(sph_group *group, const double *T)
{
  if (!ready(group, "temperature", 1)) return;
  if (!T || !(group->eos.c_v > 0)) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                 T ? "group %s: equation of state %s has no temperature: set its specific "
                     "heat, eos.c_v"
                   : "group %s: no temperatures (NULL); equation of state %s",
                 group->name, group->eos.name);
    return;
  }
  for (long i = 0; i < group->n; i++)
    if (!(T[i] > 0 && T[i] < INFINITY)) {
      sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                   "group %s, particle %ld: temperature %g K; right is > 0", group->name, i, T[i]);
      return;
    }
  sph_eos_energy(&group->eos, group->n, group->own[SPH_DENSITY][0], T, group->own[SPH_ENERGY][0]);
}

void sph_group_set_material(sph_group *group, sph_material material)
{
  if (!group) {
    if (material.eos.free) material.eos.free(material.eos.ctx);
    return;
  }
  if (!material.eos.name && sph_sim_data_ok(group->sim))
    sph_material_explain(&material, &group->sim->error);
  sph_group_set_eos(group, material.eos);
  sph_group_set_viscosity(group, material.viscosity);
  sph_group_set_conductivity(group, material.conductivity);
}
