/* term_xsph.h -- XSPH (Monaghan 1989, eq. 2.6): particles move with a velocity nearer to that of
 * their neighbours.
 *
 *   d r_i/dt = v_i - epsilon sum_j m_j/rho_ij v_ij W_ij,   rho_ij: mean
 *
 * v itself is not changed; the mass centre moves as before.  Fluid neighbours only.  W goes without
 * its constant factor (sim_pairs.c). */
#ifndef SPH_TERM_XSPH_H
#define SPH_TERM_XSPH_H
#include "fluid_pair.h"

BODY void term_xsph(int dim, int kernel, const pair *p, const fluid_constants *k, const particle *i,
                    const particle *j, vec *sum)
{
  vec W = kernel_shape_w(kernel, dim, p->distance * k->inverse_h);
  vec weight = k->epsilon * 2 * j->V * j->rho / (i->rho + j->rho) * W;
  for (int d = 0; d < dim; d++) sum[SPH_SUM_DRIFT + d] -= weight * (i->v[d] - j->v[d]);
}

#endif
