/* fluid_terms.h -- the bodies of all built-in pair terms, one after another on the same pair,
 * and the whole pair. */
#ifndef SPH_FLUID_TERMS_H
#define SPH_FLUID_TERMS_H
#include "term_conduction.h"
#include "term_conductivity_artificial.h"
#include "term_continuity.h"
#include "term_delta.h"
#include "term_pressure.h"
#include "term_repulsion.h"
#include "term_stress_artificial.h"
#include "term_viscosity_artificial.h"
#include "term_viscosity_laminar.h"
#include "term_viscosity_signal.h"
#include "term_xsph.h"

BODY void fluid_terms(int dim, int kernel, unsigned terms, pair *p, const fluid_constants *k,
                      const particle *i, const particle *j, vec *sum)
{
  if ((terms & SPH_CONTINUITY) && !(terms & SPH_CONTINUITY_CORRECTED))
    term_continuity(terms, p, p->rv, j, sum);
  if ((terms & SPH_PRESSURE_FORCE) && !(terms & SPH_PRESSURE_CORRECTED))
    term_pressure(terms, p, i, j);
  if ((terms & SPH_PRESSURE_FORCE) && (terms & SPH_WALL)) term_repulsion(dim, p, k, sum);
  if (terms & SPH_ARTIFICIAL) term_viscosity_artificial(terms, p, k, i, j);
  if (terms & SPH_SIGNAL) term_viscosity_signal(terms, p, k, i, j);
  if (terms & SPH_MORRIS) term_viscosity_morris(p, kernel, k, i);
  if (terms & SPH_MCG) term_viscosity_mcg(p, kernel, k, i);
  if (terms & SPH_CONDUCTIVITY) term_conductivity_artificial(terms, p, k, i, j, sum);
  if (terms & SPH_CONDUCTION) term_conduction(p, kernel, k, i, j, sum);
  if (terms & SPH_MOLTENI) term_delta_molteni(p, i, j, sum);
  if (terms & SPH_ANTUONO) term_delta_antuono(dim, terms, p, i, j, sum);
  if (terms & SPH_FOURTAKAS) term_delta_fourtakas(dim, p, k, i, j, sum);
  if (terms & SPH_XSPH) term_xsph(dim, kernel, p, k, i, j, sum);
  if (terms & SPH_STRESS) term_stress_artificial(dim, kernel, terms, p, k, i, j, sum);
}

/* B r, of the upper triangle of B. */
BODY void fluid_times(int dim, const vec *B, const vec *r, vec *Br)
{
  for (int a = 0; a < dim; a++) Br[a] = v_set(0);
  for (int a = 0, k = 0; a < dim; a++)
    for (int b = a; b < dim; b++, k++) {
      Br[a] += B[k] * r[b];
      if (b > a) Br[b] += B[k] * r[a];
    }
}

/* Those whose gradients are corrected, before the others: B_i of the target, B_j of the source. */
BODY void fluid_terms_corrected(int dim, unsigned terms, pair *p, const particle *i,
                                const particle *j, const vec *B_i, const vec *B_j, vec *sum)
{
  vec v[3], Br_i[3], Br_j[3];
  for (int d = 0; d < dim; d++) v[d] = i->v[d] - j->v[d];
  fluid_times(dim, B_i, p->r, Br_i);
  fluid_times(dim, B_j, p->r, Br_j);
  if (terms & SPH_CONTINUITY_CORRECTED) term_continuity(terms, p, fluid_dot(dim, Br_i, v), j, sum);
  if (terms & SPH_PRESSURE_CORRECTED) term_pressure_corrected(dim, terms, p, i, j, Br_i, Br_j, sum);
  if (!(terms & SPH_LAMINAR_CORRECTED)) return;
  vec rBr = fluid_dot(dim, p->r, Br_i);
  if (terms & SPH_LAMINAR_MEAN) rBr = 0.5 * (rBr + fluid_dot(dim, p->r, Br_j));
  p->stretch = rBr / fluid_apart(p->r2);
}

/* One pair: the bodies of its terms, closed by fluid_pair_forces; what they share of it. */
BODY pair fluid_pair(int dim, int kernel, unsigned terms, const fluid_constants *k,
                     const vec *slot_i, const vec *slot_j, vec *sum)
{
  const particle i = fluid_particle(dim, terms, slot_i), j = fluid_particle(dim, terms, slot_j);
  pair p = fluid_pair_common(dim, kernel, terms, k, &i, &j);
  if (terms & SPH_CORRECTED) {
    const vec *B_i = slot_i + slot_B(dim);
    /* a wall of particles mirrors that of i */
    const vec *B_j = (terms & SPH_WALL) && k->other == 0 ? B_i : slot_j + slot_B(dim);
    fluid_terms_corrected(dim, terms, &p, &i, &j, B_i, B_j, sum);
  }
  fluid_terms(dim, kernel, terms, &p, k, &i, &j, sum);
  fluid_pair_forces(dim, terms, &p, sum);
  return p;
}

#endif
