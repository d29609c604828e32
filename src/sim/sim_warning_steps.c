/* Terms that bound steps far below what sound asks for, and steps that no scheme is stable with. */
#include <math.h>
#include <string.h>

#include "sim_warning.h"

static const double FAR = 5, DAMPING = 5; /* times the acoustic limit */

/* Viscosity, conduction, drag where they are explicit. */
static void find_in_limits(sph_finder *f, const sph_sim *sim)
{
  static const struct {
    int bound;
    const char *term;
  } row[] = {{SPH_BOUND_VISCOUS, "viscosity-laminar"},
             {SPH_BOUND_CONDUCTION, "conduction"},
             {SPH_BOUND_DRAG, "drag"}};
  const int stabilised = !strncmp(sph_sim_integrator(sim), "lsrk:", 5);
  for (size_t k = 0; !stabilised && k < sizeof row / sizeof *row; k++) {
    const double ratio = sim->limit[SPH_BOUND_CFL] / sim->limit[row[k].bound];
    if (ratio > FAR && ratio < INFINITY)
      sph_sim_warning_found(
          f,
          "%s bounds steps to 1/%.0f of h/c: integrator imex:ark324l2sa-4-2-3 takes it "
          "implicitly",
          row[k].term, ratio);
  }
}

/* What damps goes with the speed of sound (sim_admit.c): 1 + 0.6 alpha, 5.5 delta. */
static void find_in_damping(sph_finder *f, const sph_sim *sim)
{
  const unsigned terms = sim->part[SPH_WHOLE].limit_terms;
  const double alpha = fmax(terms & SPH_ARTIFICIAL ? sim->terms.alpha : 0,
                            terms & SPH_SIGNAL ? sim->terms.signal_alpha : 0);
  const double delta = terms & SPH_DIFFUSION ? sim->terms.delta : 0;
  if (1 + 0.6 * alpha > DAMPING)
    sph_sim_warning_found(
        f,
        "an artificial viscosity with alpha = %g bounds steps to 1/%.3g of those that sound allows "
        "(1 + 0.6 alpha); usual are 0.01 to 2. For a viscous liquid right is viscosity-laminar, "
        "which integrator imex:ark324l2sa-4-2-3 takes implicitly",
        alpha, 1 + 0.6 * alpha);
  if (5.5 * delta > DAMPING)
    sph_sim_warning_found(
        f,
        "diffusion of density with delta = %g bounds steps to 1/%.3g of those that sound allows "
        "(5.5 delta); usual is 0.1. Integrator imex:ark324l2sa-4-2-3 takes it implicitly "
        "(part: implicit)",
        delta, 5.5 * delta);
}

/* The scheme's stability limit S; 0: not known. */
static double stability_of(const sph_sim *sim, int *controlled)
{
  sph_integrator_info info;
  for (int k = 0; sph_integrator_info_get(k, &info); k++)
    if (!strcmp(info.name, sph_sim_integrator(sim))) {
      const sph_integrator_def *def = &sim->integrator_def;
      *controlled = info.error_control && def->tolerance >= 0 && !(def->dt_fixed > 0);
      return info.stability;
    }
  return 0;
}

/* Error control shortens steps that are not stable; nothing else does. */
static void find_in_stability(sph_finder *f, const sph_sim *sim)
{
  const sph_integrator_def *def = &sim->integrator_def;
  int controlled = 0;
  const double S = stability_of(sim, &controlled), longest = S * sim->limit[SPH_BOUND_CFL];
  if (!(S > 0) || controlled) return;
  if (def->dt_fixed > 1.05 * longest)
    sph_sim_warning_found(
        f,
        "dt_fixed = %.3g s is %.3g times the longest step that %s is stable "
        "with, %.2g h/(c + v) = %.3g s here; right is less, by default 0.35 of it",
        def->dt_fixed, def->dt_fixed / longest, sph_sim_integrator(sim), S, longest);
  else if (!(def->dt_fixed > 0) && def->cfl > 1.05)
    sph_sim_warning_found(f,
                          "cfl = %g: steps of %g times the longest that %s is stable with, "
                          "%.2g h/(c + v), as measured; right is at most 1, by default 0.35",
                          def->cfl, def->cfl, sph_sim_integrator(sim), S);
}

void sph_sim_warning_steps(sph_finder *f, const sph_sim *sim)
{
  find_in_limits(f, sim);
  find_in_damping(f, sim);
  find_in_stability(f, sim);
}
