/* A liquid is weakly compressible where its speeds stay below a tenth of its sound speed, and its
 * density within a percent of the reference (Monaghan 1994): against the largest speed that is
 * known, the weight of the liquid, and the density at the start. */
#include <math.h>

#include "sim_rhs.h"
#include "sim_warning.h"

static const double MACH = 0.1, WEIGHT = 0.01, START = 0.03, ROUNDING = 0.03; /* of lattices, too */
static const double STIFF = 100; /* times the largest speed: ten times the steps */

/* Largest speed of a fluid's particles in the state shown. */
static double moving(const sph_sim *sim, const sph_group *fluid)
{
  double most = 0;
  for (long i = 0; i < fluid->n; i++) {
    double v2 = 0;
    for (int d = 0; d < sim->dim; d++) {
      const double v = sph_group_read(fluid, "velocity", d)[i];
      v2 += v * v;
    }
    most = fmax(most, v2);
  }
  return sqrt(most);
}

/* g times the extent of a fluid, of all if NULL, along it [m^2/s^2]; along periodic directions it
 * has no bottom. */
static double head(const sph_sim *sim, const sph_group *fluid)
{
  double low = INFINITY, high = -INFINITY, g2 = 0;
  for (int d = 0; d < sim->dim; d++) g2 += sim->periodic[d] ? 0 : pow(sim->terms.g[d], 2);
  for (int k = 0; k < sim->groups && g2 > 0; k++) {
    const sph_group *group = sim->group[k];
    if (group->wall || group->eos.dust || (fluid && group != fluid)) continue;
    for (long i = 0; i < group->n; i++) {
      double along = 0;
      for (int d = 0; d < sim->dim; d++)
        if (!sim->periodic[d]) along += sim->terms.g[d] * sph_group_read(group, "position", d)[i];
      low = fmin(low, along);
      high = fmax(high, along);
    }
  }
  return high >= low && g2 > 0 ? high - low + sqrt(g2) * sim->dx : 0;
}

/* Largest distance of a wall's particles from its axis, as they are. */
static double reach(const sph_group *wall)
{
  const double *n = wall->boundary.axis;
  double most = 0;
  for (long i = 0; i < wall->n; i++) {
    double r2 = 0, along = 0;
    for (int d = 0; d < wall->dim; d++) {
      const double r = sph_group_read(wall, "position", d)[i] - wall->boundary.centre[d];
      r2 += r * r;
      along += n[d] * r;
    }
    most = fmax(most, r2 - along * along);
  }
  return sqrt(most);
}

/* Largest speed of the walls over the time in which sound of speed c crosses a hundred times the
 * largest extent of their particles, and who it is. */
static double walls(const sph_sim *sim, double c, const char **name)
{
  enum { SAMPLES = 200 };
  double most = 0, size = 0;
  for (int g = 0; g < sim->groups; g++)
    for (int d = 0; d < sim->dim; d++) {
      double low = INFINITY, high = -INFINITY;
      for (long i = 0; i < sim->group[g]->n; i++) {
        const double x = sph_group_read(sim->group[g], "position", d)[i];
        low = fmin(low, x);
        high = fmax(high, x);
      }
      size = fmax(size, high - low);
    }
  for (int g = 0; g < sim->groups; g++) {
    const sph_boundary *wall = &sim->group[g]->boundary;
    if (!sim->group[g]->wall || !sph_sim_walls_moves(wall)) continue;
    for (int k = 0; k < SAMPLES; k++) {
      const sph_wall_motion m =
          sph_sim_walls_motion(wall, sim->time + k * (100 * size / c) / SAMPLES);
      const double *v = m.velocity, turning = fabs(m.turn[1]) * reach(sim->group[g]);
      const double speed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + turning;
      if (speed > most) *name = sim->group[g]->name, most = speed;
    }
  }
  return most;
}

static void find_mach(sph_finder *f, const sph_sim *sim, const sph_group *fluid)
{
  const double c0 = fluid->eos.c0, fall = sqrt(2 * head(sim, NULL)), own = moving(sim, fluid);
  const char *wall = "";
  const double driven = walls(sim, c0, &wall), most = fmax(fmax(fall, own), driven);
  if (most <= MACH * c0 * (1 + ROUNDING)) return;
  if (most == own)
    sph_sim_warning_found(f,
                          "%s moves at %.3g m/s, %.2g of its sound speed %.3g m/s; right is at "
                          "most %g: a sound speed of %.3g m/s or more",
                          fluid->name, own, own / c0, c0, MACH, own / MACH);
  else if (most == driven)
    sph_sim_warning_found(f,
                          "%s: wall %s moves at %.3g m/s, %.2g of the sound speed %.3g m/s; right "
                          "is at most %g: a sound speed of %.3g m/s or more",
                          fluid->name, wall, driven, driven / c0, c0, MACH, driven / MACH);
  else
    sph_sim_warning_found(f,
                          "%s can fall to sqrt(2 g H) = %.3g m/s, %.2g of its sound speed %.3g "
                          "m/s; right is at most %g: a sound speed of %.3g m/s or more",
                          fluid->name, fall, fall / c0, c0, MACH, fall / MACH);
}

/* One liquid that only gravity moves: its sound speed is often that of the real one. */
static void find_stiff(sph_finder *f, const sph_sim *sim, const sph_group *fluid)
{
  const double c0 = fluid->eos.c0, fall = sqrt(2 * head(sim, NULL));
  const char *wall = "";
  int fluids = 0;
  for (int g = 0; g < sim->groups; g++) fluids += !sim->group[g]->wall;
  if (fluids > 1 || !(fall > 0) || sim->terms.called > 0) return;
  const double most = fmax(fmax(fall, moving(sim, fluid)), walls(sim, c0, &wall));
  if (c0 <= STIFF * most) return;
  sph_sim_warning_found(f,
                        "%s: sound speed %.4g m/s is %.3g times the largest speed, about %.3g m/s; "
                        "where sound itself is not looked at, right is 10 times, %.3g m/s, with "
                        "1/%.0f of the steps",
                        fluid->name, c0, c0 / most, most, most / MACH, c0 / (most / MACH));
}

static void find_pressure(sph_finder *f, const sph_sim *sim, const sph_group *fluid)
{
  const double c0 = fluid->eos.c0, weight = head(sim, fluid) / (c0 * c0);
  const double *rho = sph_group_read(fluid, "density", 0);
  double far = 0;
  for (long i = 0; i < fluid->n; i++) far = fmax(far, fabs(rho[i] / fluid->eos.rho0 - 1));
  if (weight > WEIGHT * (1 + ROUNDING))
    sph_sim_warning_found(f,
                          "%s: its own weight compresses it by g H/c0^2 = %.2g %%; right is at "
                          "most %g %%: a sound speed of %.3g m/s or more, not %.3g m/s",
                          fluid->name, 100 * weight, 100 * WEIGHT, c0 * sqrt(weight / WEIGHT), c0);
  if (far > START)
    sph_sim_warning_found(f,
                          "%s: density starts %.2g %% off the reference; right is at most %g %%: a "
                          "sound speed of about %.3g m/s or more, not %.3g m/s",
                          fluid->name, 100 * far, 100 * START, c0 * sqrt(far / START), c0);
}

void sph_sim_warning_speeds(sph_finder *f, const sph_sim *sim)
{
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *fluid = sim->group[g];
    const sph_eos *eos = &fluid->eos;
    if (fluid->wall || eos->dust || eos->thermal || !(eos->rho0 > 0 && eos->c0 > 0)) continue;
    find_mach(f, sim, fluid);
    find_stiff(f, sim, fluid);
    find_pressure(f, sim, fluid);
  }
}
