/* Mixed precision: the loops of pairs, of the gradient pass and of Adami's walls read records in
 * single precision (single_loop.h).  The state, its integration, equations of state, lists and sums
 * are doubles.
 *
 * What has no such loops is refused: it would read records that are not there. */
#include "sim_single.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PARALLEL_MIN = 2048, PACKED = 256 };

/* Products of V, F and squared distances of a pair must neither leave the range of floats nor
 * become denormal. */
static const double LEAST_DX = 1e-6, LARGEST_DX = 1e6;

/* Positions are rounded by half of a quantum. */
static const double LARGEST_QUANTUM = 1e-5; /* [h] */

/* Rates are rounded by 1e-6 of themselves; error control must not see that. */
static const double LEAST_TOLERANCE = 1e-5;

int sph_sim_single_refuse(sph_sim *sim, const char *what)
{
  if (!sim->single) return SPH_OK;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "precision mixed: %s; right is precision double (or no precision at all)",
                      what);
}

static const char *rare_term(unsigned bits)
{
  static const struct {
    unsigned bits;
    const char *what;
  } rare[] = {{SPH_FORM_PHI, "the row phi of densities and pressures"},
              {SPH_SIGNAL, "viscosity-signal"},
              {SPH_MORRIS | SPH_MCG, "viscosity-laminar"},
              {SPH_FOURTAKAS, "delta of model fourtakas"},
              {SPH_CONDUCTION, "conduction"},
              {SPH_XSPH, "xsph"},
              {SPH_STRESS, "stress-artificial"},
              {SPH_SWITCHES, "switches of artificial viscosity"},
              {SPH_CORRECTED, "corrected gradients"},
              {SPH_SHIFTS, "shifting and the transport velocity"},
              {SPH_DRAG, "drag"}};
  for (size_t k = 0; k < sizeof rare / sizeof *rare; k++)
    if (bits & rare[k].bits) return rare[k].what;
  return NULL;
}

static const char *unfit(const sph_sim *sim)
{
  const char *rare = rare_term(sim->loop_terms);
  if (rare) return rare;
  if (sim->terms.summed) return "summation";
  if (sim->part[SPH_WHOLE].tiles) return "scalars that diffuse and pair terms of your own";
  for (int g = 0; g < sim->groups; g++)
    if (sim->group[g]->eos.dust) return "dust";
  return NULL;
}

int sph_sim_single_check(sph_sim *sim)
{
  if (!sim->single) return SPH_OK;
  char what[200];
  const char *name = unfit(sim);
  const double tolerance = sim->integrator_def.tolerance;
  if (name) {
    snprintf(what, sizeof what, "%s: no loops of it in single precision", name);
    return sph_sim_single_refuse(sim, what);
  }
  if (tolerance > 0 && tolerance < LEAST_TOLERANCE) {
    snprintf(what, sizeof what,
             "tolerance = %g is below what rates of that precision allow, %g: a larger one",
             tolerance, LEAST_TOLERANCE);
    return sph_sim_single_refuse(sim, what);
  }
  if (sim->dx >= LEAST_DX && sim->dx <= LARGEST_DX) return SPH_OK;
  snprintf(what, sizeof what, "dx = %g m leaves the range of floats; with it dx is %g to %g m",
           sim->dx, LEAST_DX, LARGEST_DX);
  return sph_sim_single_refuse(sim, what);
}

/* Of all particles, as the lists were built; of a periodic direction the box. */
static void range(const sph_sim *sim, int d, double *low, double *high)
{
  double least = INFINITY, most = -INFINITY;
  for (int g = 0; g < sim->groups && !sim->periodic[d]; g++) {
    const double *x = sim->sorted[g].built[d];
    const long n = sim->group[g]->n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) reduction(min      \
                                                                              : least) \
    reduction(max                                                                      \
              : most) if (n > PARALLEL_MIN)
    for (long i = 0; i < n; i++) {
      if (x[i] < least) least = x[i];
      if (x[i] > most) most = x[i];
    }
  }
  *low = sim->periodic[d] ? sim->origin[d] : least;
  *high = sim->periodic[d] ? sim->origin[d] + sim->length[d] : most;
}

int sph_sim_single_range(sph_sim *sim)
{
  double largest = 0;
  int exponent;
  if (!sim->single) return SPH_OK;
  for (int d = 0; d < sim->dim; d++) {
    double low, high;
    range(sim, d, &low, &high);
    if (!(high >= low)) low = high = 0;
    sim->centre[d] = 0.5 * (low + high);
    largest = fmax(largest, high - low);
  }
  /* Twice the room of the differences in a periodic image, so that none wraps around to zero. */
  frexp(largest + 4 * (sim->H + sim->skin), &exponent);
  sim->quantum = ldexp(1, exponent - 30);
  if (sim->quantum <= LARGEST_QUANTUM * sim->h) return SPH_OK;
  char what[200];
  snprintf(what, sizeof what,
           "particles are up to %.3g m apart, positions would be rounded by %.1g h", largest,
           0.5 * sim->quantum / sim->h);
  return sph_sim_single_refuse(sim, what);
}

void sph_sim_single_copy(const sph_sim *sim, int g, int first, int last, long begin, long end)
{
  const sph_sorted *sorted = &sim->sorted[g];
  const long stride = sorted->stride;
  const int dim = sim->dim;
  for (long s = begin; s < end; s++) {
    const double *record = sorted->record + s * stride;
    float *single = sorted->single + s * stride;
    for (int q = first; q < dim; q++) {
      const int32_t at = (int32_t)lrint((record[q] - sim->centre[q]) / sim->quantum);
      memcpy(&single[q], &at, sizeof at);
    }
    for (int q = first > dim ? first : dim; q < last; q++) single[q] = (float)record[q];
  }
}

void sph_sim_single_pack(const sph_sim *sim, int g)
{
  const sph_sorted *sorted = &sim->sorted[g];
  const long n = sim->group[g]->n > 0 ? sorted->room : 0;
  const int slots = (int)sorted->stride;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long s = 0; s < n; s += PACKED)
    sph_sim_single_copy(sim, g, 0, slots, s, s + PACKED < n ? s + PACKED : n);
}
