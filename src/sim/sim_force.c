/* The force of the fluids on a wall: what the pair terms of (fluid <- wall) do to the fluid, with
 * the other sign.
 *
 *   F = - sum_i m_i a_i^wall,   T = - sum_i (x_i - x_0) x m_i a_i^wall
 *
 * Pressure and viscosity apart are the same loops with these terms alone. */
#include "sim_force.h"

#include <math.h>
#include <stddef.h>

#include "sim_parts.h"
#include "sim_prepare.h"
#include "sim_run.h"
#include "sphode/measure.h"

/* Inside the box, where that is periodic: a torque is not one of an image far away. */
static double place(const sph_sim *sim, int d, double x)
{
  if (!sim->periodic[d]) return x;
  return x - sim->length[d] * floor((x - sim->origin[d]) / sim->length[d]);
}

/* Minus the sums of fluid g, as forces; torque NULL: not wanted. */
static void take(const sph_evaluation *e, int g, const double about[3], double force[3],
                 double torque[3])
{
  const sph_sim *sim = e->sim;
  const sph_view *view = &e->view[g];
  const int *order = sph_neighbors_order(sim->neighbors, g);
  double *const *sum = sim->sorted[g].sum;
  for (long s = 0; s < view->n; s++) {
    const long i = order[s];
    double f[3] = {0}, arm[3] = {0};
    for (int d = 0; d < sim->dim; d++) {
      f[d] = -view->m[i] * sim->F_scale * sum[SPH_SUM_A + d][s];
      force[d] += f[d];
      if (torque) arm[d] = place(sim, d, view->x[d][i]) - about[d];
    }
    for (int d = 0; torque && d < 3; d++) {
      const int a = (d + 1) % 3, b = (d + 2) % 3;
      torque[d] += arm[a] * f[b] - arm[b] * f[a];
    }
  }
}

typedef struct adding {
  const sph_evaluation *e;
  int fluid, wall;
} adding;

static void add_share(void *ctx, const sph_share *share)
{
  const adding *a = ctx;
  sph_sim_interaction_add(a->e, share, a->fluid, a->wall);
}

/* By the pair terms of a part, of all fluids. */
static void add(sph_evaluation *e, const sph_part *part, const sph_group *wall,
                const double about[3], double force[3], double torque[3])
{
  sph_sim *sim = e->sim;
  e->part = part;
  for (int g = 0; g < sim->groups; g++) {
    if (sim->group[g]->wall || !sph_sim_interaction_same_species(sim->group[g], wall)) continue;
    adding a = {.e = e, .fluid = g, .wall = wall->index};
    sph_sim_pairs_share(sim, g, sim->fluid_sums, 0, add_share, &a);
    take(e, g, about, force, torque);
  }
}

static int check(sph_sim *sim, const sph_group *wall, const double *about, const sph_force *force)
{
  if (!sph_sim_data_ok(sim)) return sph_sim_status(sim);
  if (!wall || wall->sim != sim || !wall->wall || !force)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "a force on %s; right is a wall of the simulation%s",
                        wall ? wall->name : "no group (NULL)",
                        force ? "" : ", and a place for it (it is NULL)");
  for (int d = 0; about && d < sim->dim; d++)
    if (!isfinite(about[d]))
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "the torque on %s about x[%d] = %g m: not finite",
                          wall->name, d, about[d]);
  return SPH_OK;
}

int sph_sim_force_begin(sph_evaluation *e, sph_sim *sim, N_Vector ydot)
{
  int status = sph_sim_prepare(sim);
  if (status) return status;
  sim->derived = 0; /* records, too, must be those of the state shown */
  status = sph_sim_run_derived(sim);
  *e = (sph_evaluation){.sim = sim, .t = sim->time, .part = &sim->part[SPH_WHOLE]};
  if (!status) sph_sim_rhs_views(e, sim->shown, ydot);
  return status;
}

int sph_sim_force(sph_sim *sim, const sph_group *wall, const double *about, sph_force *force)
{
  static const struct {
    unsigned bits;
    size_t to;
  } share[] = {{SPH_PRESSURE_FORCE, offsetof(sph_force, pressure)},
               {SPH_VISCOUS, offsetof(sph_force, viscous)}};
  sph_evaluation e;
  int status = check(sim, wall, about, force);
  if (!status) status = sph_sim_force_begin(&e, sim, NULL);
  if (!status) status = sph_sim_gradients(&e);
  if (!status) status = sph_sim_switches(&e);
  if (status) return status;
  double from[3] = {0};
  for (int d = 0; about && d < sim->dim; d++) from[d] = about[d];
  *force = (sph_force){0};
  add(&e, &sim->part[SPH_WHOLE], wall, from, force->force, force->torque);
  for (size_t k = 0; !status && k < sizeof share / sizeof *share; k++) {
    sph_part part;
    status = sph_sim_parts_of(sim, &part, share[k].bits, 0);
    void *to = (char *)force + share[k].to;
    if (!status) add(&e, &part, wall, from, to, NULL);
  }
  return status;
}
