/* Time integration around the right-hand side: seconds of a step outside of it over those inside,
 * in percent. */
#include <sphode.h>
#include <stdio.h>

#include "bench.h"

enum { REPEATS = 5 };

static void measure(int dim, long across, const char *method, double tolerance)
{
  char name[80];
  snprintf(name, sizeof name, "integration/%dd/%s/%s", dim, method,
           tolerance < 0 ? "cfl" : "error-control");
  if (!bench_wanted(name)) return;
  double dx = 1.0 / (double)across, share[REPEATS];
  double lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1};
  sph_sim_def def = {.dim = dim, .dx = dx, .speed = 1};
  for (int d = 0; d < dim; d++) {
    def.periodic[d] = 1;
    def.length[d] = 1;
  }
  sph_sim *sim = sph_sim_create(&def);
  sph_group *fluid = sph_group_box(sim, "fluid", lo, hi, 1000);
  sph_group_set_eos(fluid, sph_eos_tait(1000, 10, 7));
  double *v = sph_group_write(fluid, "velocity", 0);
  const double *y = sph_group_read(fluid, "position", 1);
  for (long i = 0; v && i < sph_group_count(fluid); i++) v[i] = sin(6.28318530717958648 * y[i]);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("molteni", 0.1));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .tolerance = tolerance});
  for (int k = -1; k < REPEATS; k++) {
    sph_sim_stats before, after;
    sph_sim_get_stats(sim, &before);
    for (int step = 0; step < (bench_quick() ? 2 : 6); step++) sph_sim_step(sim);
    sph_sim_get_stats(sim, &after);
    double inside = after.rhs_seconds - before.rhs_seconds;
    if (k >= 0) share[k] = 100 * (after.seconds - before.seconds - inside) / inside;
  }
  if (sph_sim_status(sim)) bench_complain("%s", sph_sim_error(sim));
  bench_report(name, "% of rhs", share, REPEATS);
  sph_sim_free(sim);
}

void bench_integration(void)
{
  long across = bench_quick() ? 20 : 46;
  measure(3, across, "erk:bogacki-shampine-4-2-3", 1e-2);
  measure(3, across, "erk:bogacki-shampine-4-2-3", -1);
  measure(3, across, "leapfrog", -1);
  measure(2, bench_quick() ? 60 : 200, "erk:bogacki-shampine-4-2-3", 1e-2);
}
