#include <math.h>

#include "sim_run.h"

/* Compensated (Kahan 1965): the drift of an energy is far less than the energy. */
typedef struct sum {
  double value, lost;
} sum;

static void add_to(sum *s, double x)
{
  double y = x - s->lost, t = s->value + y;
  s->lost = (t - s->value) - y;
  s->value = t;
}

enum { KINETIC, INTERNAL, POTENTIAL, ENERGIES };

/* What particle i adds; sums run over particles in their own order: the same for any number of
 * threads. */
static void add(const sph_sim *sim, const sph_group *group, const sph_view *view, long i,
                sph_balance *b, sum energy[ENERGIES])
{
  double x[3] = {0}, v[3] = {0}, m = view->m[i], v2 = 0;
  for (int d = 0; d < sim->dim; d++) {
    x[d] = view->x[d][i];
    v[d] = view->v[d][i];
    v2 += v[d] * v[d];
    b->momentum[d] += m * v[d];
  }
  for (int d = 0; d < 3; d++) {
    int a = (d + 1) % 3, c = (d + 2) % 3;
    b->angular_momentum[d] += m * (x[a] * v[c] - x[c] * v[a]);
  }
  b->mass += m;
  add_to(&energy[KINETIC], 0.5 * m * v2);
  add_to(&energy[POTENTIAL], m * sph_term_set_potential(&sim->terms, x));
  if (view->u) add_to(&energy[INTERNAL], m * view->u[i]);
  if (!group->eos.thermal && group->eos.elastic_energy)
    add_to(&energy[INTERNAL], m * group->eos.elastic_energy(&group->eos, view->rho[i]));
}

void sph_sim_balance(const sph_sim *sim, sph_balance *balance)
{
  if (!balance) return;
  *balance = (sph_balance){0};
  sum energy[ENERGIES] = {{0, 0}};
  /* Densities that are sums and energies that are not integrated follow from the state shown. */
  if (sim && sim->prepared && sim->groups > 0) sph_sim_run_derived(sim->group[0]->sim);
  for (int g = 0; sim && g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (group->wall || !group->has_eos) continue;
    sph_view view =
        sph_group_data_view(group, sim->shown ? sph_nvector_data(sim->shown) : NULL, NULL);
    for (long i = 0; i < group->n; i++) add(sim, group, &view, i, balance, energy);
  }
  balance->kinetic = energy[KINETIC].value;
  balance->internal = energy[INTERNAL].value;
  balance->potential = energy[POTENTIAL].value;
  balance->total = balance->kinetic + balance->internal + balance->potential;
}
