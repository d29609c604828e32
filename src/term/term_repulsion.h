/* term_repulsion.h -- a short-range repulsion by the particles of a wall, beside its pressure.
 *
 *   a_i = epsilon (c0/dx)^2 max(R/r - 1, 0) r_ij,  R = 0.8 dx:
 *   potential 1/2 epsilon c0^2 (R - r)^2/dx^2 where r < R
 *
 * Continuity remembers how many neighbors a particle had, not whose they were: where fluid draws
 * away from a wall, a particle that takes the wall's particles in their place keeps its density,
 * and nothing holds it off.  The first layer rests at dx; with R = 0.9 dx and more water that moves
 * over the lattice of the wall is braked by it.  Such forces: Monaghan (1994); beside the pressure
 * of dummy particles: Liu, Shao & Chang (2012).
 *
 * Sums are linear in F and scaled once at the end: k->repulsion is epsilon (c0/dx)^2 over that
 * factor.  Walls without it have 0 there. */
#ifndef SPH_TERM_REPULSION_H
#define SPH_TERM_REPULSION_H
#include "fluid_pair.h"

/* Without F, which p->push is multiplied by. */
BODY void term_repulsion(int dim, const pair *p, const fluid_constants *k, vec *sum)
{
  vec push = k->repulsion * v_min0(1 - k->range / fluid_apart(p->distance));
  for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] -= push * p->r[d];
}

#endif
