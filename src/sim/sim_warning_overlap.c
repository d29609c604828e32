/* Do bodies overlap, or gape?  Particles of two groups that touch are one spacing apart: much
 * nearer, one stands in the other; a little farther, there is a gap between two fluids that were to
 * meet. */
#include <math.h>

#include "sim_overlap.h"
#include "sim_warning.h"

/* Faces that touch are 1 dx apart, with lattices that stand askew to sqrt(1.5) dx. */
static const double NEAR = 0.7 * (1 + 1e-9), TOUCHING = 1.25, APART = 1.9;

/* Dust goes through all; a mirror is a plane. */
static int is_body(const sph_group *group)
{
  return !group->eos.dust && !(group->wall && group->model == SPH_MODEL_MIRROR);
}

static void find_between(sph_finder *f, const sph_sim *sim, sph_neighbors *search, int g, int k)
{
  const sph_group *a = sim->group[g], *b = sim->group[k];
  const sph_overlap found = sph_sim_overlap_find(sim, search, g, k, NEAR * sim->dx);
  const double apart = found.least / sim->dx;
  char place[100];
  sph_sim_overlap_place(sim, found.x, place, sizeof place);
  if (found.n)
    sph_sim_warning_found(f,
                          "%s and %s: %ld particles of %s are nearer than %.3g dx = %.3g m to one "
                          "of the other, the first at %s; right are shapes that are cut out of "
                          "each other (difference), and lengths that are whole numbers of dx",
                          a->name, b->name, found.n, a->name, NEAR, NEAR * sim->dx, place);
  else if (!a->wall && !b->wall && apart > TOUCHING && apart < APART)
    sph_sim_warning_found(f,
                          "%s and %s: there is a gap between them, their particles are %.3g dx "
                          "apart at least, at %s; where they are to touch, 1 is right: lengths "
                          "that are whole numbers of dx, or one lattice_origin for both",
                          a->name, b->name, apart, place);
}

/* Particles of one group that each stand on a lattice: its shapes lie in each other, or askew. */
static void find_within(sph_finder *f, const sph_sim *sim, sph_neighbors *search, int g)
{
  const sph_group *group = sim->group[g];
  if (group->shapes < 2 || group->loose) return;
  const sph_overlap found = sph_sim_overlap_find(sim, search, g, g, NEAR * sim->dx);
  char place[100];
  if (!found.n) return;
  sph_sim_overlap_place(sim, found.x, place, sizeof place);
  sph_sim_warning_found(f,
                        "%s: %ld of its particles are nearer than %.3g dx = %.3g m to another of "
                        "them, the first at %s; right are shapes that do not overlap (union makes "
                        "one of several), and lengths that are whole numbers of dx",
                        group->name, found.n, NEAR, NEAR * sim->dx, place);
}

void sph_sim_warning_overlap(sph_finder *f, const sph_sim *sim)
{
  if (f->found > f->wanted || sim->time != sim->start) return; /* later they mix and part */
  sph_neighbors *search = sph_sim_overlap_search(sim, APART * sim->dx);
  for (int g = 0; g < sim->groups && search; g++)
    for (int k = g + 1; k < sim->groups && is_body(sim->group[g]); k++)
      if (is_body(sim->group[k])) find_between(f, sim, search, g, k);
  for (int g = 0; g < sim->groups && search; g++)
    if (is_body(sim->group[g])) find_within(f, sim, search, g);
  sph_neighbors_free(search);
}
