/* Error weights: physical scales of each field of each group.
 *   x: h;  v: V = max(user's, sqrt(g height), 0.01 c0, |v| at the start);
 *   rho: rho0 (V/c0)^2;  u, e: V^2/2;  A: (gamma - 1) rho^(1-gamma) V^2/2;  T: V^2/(2 c_v)
 * and for a thermal one c0 = mean sound speed, rho0 = mean density; for a gas (no c0) V = c0.  An
 * energy that is carried along: the range of u at the start or a thousandth of u, if that is more.
 * Dust, which has no c: V at least that of the fluids, rho the mean density.
 * Scalars: as their terms say.  What sph_sim_set_scale says comes first. */
#include "sim_weights.h"

#include <math.h>

enum { PARALLEL_MIN = 32768 }; /* entries from which on threads pay */

static double mean(const double *a, long n)
{
  double sum = 0;
  for (long i = 0; i < n; i++) sum += a[i];
  return n ? sum / (double)n : 0;
}

/* The range, and a thousandth of the largest magnitude: V^2/2 of a slow liquid is no scale of its
 * heat. */
static double carried(const double *u, long n)
{
  double low = INFINITY, high = -INFINITY;
  for (long i = 0; i < n; i++) {
    low = fmin(low, u[i]);
    high = fmax(high, u[i]);
  }
  return n ? fmax(high - low, 1e-3 * fmax(fabs(low), fabs(high))) : 0;
}

/* sqrt(|g| height): the extent of the fluid along g. */
static double fall_speed(const sph_sim *sim, const sph_view *view)
{
  double g2 = 0, low = INFINITY, high = -INFINITY;
  for (int d = 0; d < sim->dim; d++) g2 += sim->terms.g[d] * sim->terms.g[d];
  for (long i = 0; g2 > 0 && i < view->n; i++) {
    double along = 0;
    for (int d = 0; d < sim->dim; d++) along += sim->terms.g[d] * view->x[d][i];
    low = fmin(low, along);
    high = fmax(high, along);
  }
  return high > low ? sqrt(high - low) : 0;
}

static double speed(const sph_sim *sim, const sph_view *view)
{
  double most = 0;
  for (long i = 0; i < view->n; i++) {
    double v2 = 0;
    for (int d = 0; d < sim->dim; d++) v2 += view->v[d][i] * view->v[d][i];
    most = fmax(most, v2);
  }
  return sqrt(most);
}

/* V_least: of the fluids, for dust. */
static void set_scales(sph_sim *sim, int g, const sph_view *view, double V_least)
{
  const sph_group *group = sim->group[g];
  double c = group->eos.c0, rho = group->eos.rho0, V = fmax(sim->speed, V_least);
  if (group->eos.thermal || !(c > 0)) c = mean(view->c, view->n);
  if (group->eos.thermal || !(rho > 0)) rho = mean(view->rho, view->n);
  V = fmax(V, fmax(fall_speed(sim, view), speed(sim, view)));
  V = fmax(V, group->eos.thermal && !(group->eos.c0 > 0) ? c : 0.01 * c);
  double *scale = sim->scale[g];
  scale[SPH_POSITION] = sim->h;
  scale[SPH_VELOCITY] = V;
  scale[SPH_DENSITY] = rho * fmin(1, (V / c) * (V / c));
  double u = V * V / 2, gamma = group->eos.gamma;
  if (view->u && !group->eos.thermal) u = fmax(u, carried(view->u, view->n));
  scale[SPH_ENERGY] = scale[SPH_TOTAL_ENERGY] = u;
  scale[SPH_ENTROPY] = (gamma - 1) * pow(rho, 1 - gamma) * u;
  scale[SPH_TEMPERATURE] = u / group->eos.c_v;
  for (int q = 0; q < group->scalars; q++) scale[SPH_SCALAR + q] = sim->terms.scalar[q].scale;
  for (int field = 0; field < SPH_FIELDS; field++) {
    const double *all = sim->set_scale[SPH_SETS_MAX], *own = sim->set_scale[g];
    if (all[field] > 0) scale[field] = all[field];
    if (own[field] > 0) scale[field] = own[field];
  }
}

/* Density of a wall: as of the first fluid. */
static void set_wall(sph_sim *sim, int g)
{
  double *scale = &sim->scale[g][SPH_DENSITY];
  for (int f = sim->groups - 1; f >= 0; f--)
    if (!sim->group[f]->wall && !sim->group[f]->eos.dust) *scale = sim->scale[f][SPH_DENSITY];
  if (sim->set_scale[g][SPH_DENSITY] > 0) *scale = sim->set_scale[g][SPH_DENSITY];
}

int sph_sim_weights_check(sph_sim *sim)
{
  for (int set = 0; set <= SPH_SETS_MAX; set++)
    for (int field = 0; field < SPH_FIELDS; field++) {
      int found = 0;
      for (int g = 0; g < sim->groups; g++)
        found |= (g == set || set == SPH_SETS_MAX) && sim->group[g]->offset[field][0] >= 0;
      if (found || !(sim->set_scale[set][field] > 0)) continue;
      const sph_field_info *info = sph_group_field(sim->group[0], field);
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "scale %g of %s: %s%s integrates it; right is a field of the ODE vector",
                          sim->set_scale[set][field], info ? info->name : "a scalar",
                          set < SPH_SETS_MAX ? "nothing in group " : "no fluid",
                          set < SPH_SETS_MAX ? sim->group[set]->name : "");
    }
  return SPH_OK;
}

double sph_sim_weights_rate(const sph_sim *sim, N_Vector rates)
{
  const double *rate = sph_nvector_data(rates);
  double sum = 0, entries = 0;
  for (int g = 0; g < sim->groups; g++)
    for (int field = SPH_POSITION + 1; field < SPH_FIELDS; field++)
      for (int c = 0; c < 3; c++) {
        long offset = sim->group[g]->offset[field][c], n = offset >= 0 ? sim->group[g]->n : 0;
        entries += (double)n;
        for (long i = 0; i < n; i++) {
          double q = rate[offset + i] / sim->scale[g][field];
          sum += q * q;
        }
      }
  return sqrt(sum / entries);
}

void sph_sim_weights_scales(sph_sim *sim)
{
  double V_most = 0;
  for (int dust = 0; dust < 2; dust++) /* fluids first */
    for (int g = 0; g < sim->groups; g++) {
      const sph_group *group = sim->group[g];
      if (group->wall || group->eos.dust != dust) continue;
      sph_view view = sph_group_data_view(group, sph_nvector_data(sim->y), NULL);
      set_scales(sim, g, &view, dust ? V_most : 0);
      V_most = fmax(V_most, sim->scale[g][SPH_VELOCITY]);
    }
  for (int g = 0; g < sim->groups; g++)
    if (sim->group[g]->wall) set_wall(sim, g);
}

int sph_sim_weights(N_Vector y, N_Vector weight, void *ctx)
{
  const sph_sim *sim = ctx;
  (void)y;
  for (int g = 0; g < sim->groups; g++)
    for (int field = 0; field < SPH_FIELDS; field++)
      for (int c = 0; c < 3; c++) {
        const long offset = sim->group[g]->offset[field][c], n = sim->group[g]->n;
        if (offset < 0) continue;
        const double value = 1 / sim->scale[g][field];
        double *w = sph_nvector_data(weight) + offset;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
        for (long i = 0; i < n; i++) w[i] = value;
      }
  return 0;
}
