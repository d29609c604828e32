/* fluid_terms.h -- the bodies of all built-in pair terms, one after another on the same pair,
 * and the whole pair. */
#ifndef SPH_FLUID_TERMS_H
#define SPH_FLUID_TERMS_H
#include "term_conduction.h"
#include "term_conductivity_artificial.h"
#include "term_continuity.h"
#include "term_delta.h"
#include "term_pressure.h"
#include "term_stress_artificial.h"
#include "term_viscosity_artificial.h"
#include "term_viscosity_laminar.h"
#include "term_viscosity_signal.h"
#include "term_xsph.h"

BODY void fluid_terms(int dim, int kernel, unsigned terms, pair *p, const fluid_constants *k,
                      const particle *i, const particle *j, vec *sum)
{
  if (terms & SPH_CONTINUITY) term_continuity(terms, p, j, sum);
  if (terms & SPH_PRESSURE_FORCE) term_pressure(terms, p, i, j);
  if (terms & SPH_ARTIFICIAL) term_viscosity_artificial(p, k, i, j);
  if (terms & SPH_SIGNAL) term_viscosity_signal(p, k, i, j);
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

/* One pair: the bodies of its terms, closed by fluid_pair_forces. */
BODY void fluid_pair(int dim, int kernel, unsigned terms, const fluid_constants *k,
                     const vec *slot_i, const vec *slot_j, vec *sum)
{
  const particle i = fluid_particle(dim, terms, slot_i), j = fluid_particle(dim, terms, slot_j);
  pair p = fluid_pair_common(dim, kernel, terms, k, &i, &j);
  fluid_terms(dim, kernel, terms, &p, k, &i, &j, sum);
  fluid_pair_forces(dim, terms, &p, sum);
}

#endif
