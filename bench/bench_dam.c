/* The dam break of SPHERIC's test 2 (cases/dam-break-3d-obstacle.yml; Kleefsman et al. 2005), walls
 * and all: whole steps, and what a developed flow costs beside its start.  h = 2 dx (or
 * 1.3 dx: 1e5-1.3h), alpha = 0.001, c0 = 44.29 m/s.
 *
 *   dam/3d/SIZE/DELTA/step   pairs a second of whole steps of leapfrog: lists, integrator, all
 *   dam/3d/developed/DELTA   right-hand sides at t = 0.9 s, spray and all, beside those at the
 *                            start, its water jittered by 0.1 dx, by turns
 */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"
#include "bench_flow.h"

enum { REPEATS = 7 };

static double pairs_of(const sph_sim *sim)
{
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  return stats.pairs;
}

static void measure_step(int n, const char *size, double h_over_dx, const char *delta)
{
  char name[80];
  double rate[REPEATS];
  snprintf(name, sizeof name, "dam/3d/%s/%s/step", size, delta);
  if (!bench_wanted(name)) return;
  sph_sim *sim = bench_flow_dam(&(bench_dam_def){n, h_over_dx, delta, "leapfrog", 0, 1});
  for (int k = -2; k < REPEATS; k++) {
    double pairs = pairs_of(sim), begin = bench_thread_seconds();
    sph_sim_step(sim);
    double seconds = bench_thread_seconds() - begin;
    if (k >= 0) rate[k] = (pairs_of(sim) - pairs) / seconds / 1e6;
  }
  if (sph_sim_status(sim)) bench_complain("%s", sph_sim_error(sim));
  bench_report(name, "Mpairs/s", rate, REPEATS);
  sph_sim_free(sim);
}

static double rate_of(sph_sim *sim)
{
  double pairs = pairs_of(sim), begin = bench_thread_seconds();
  if (sph_sim_evaluate(sim)) bench_complain("%s", sph_sim_error(sim));
  double seconds = bench_thread_seconds() - begin;
  return (pairs_of(sim) - pairs) / seconds / 1e6;
}

static void measure_developed(const char *delta)
{
  char name[80], start[80];
  double rate[REPEATS], ratio[REPEATS];
  const int n = bench_quick() ? 8 : 14;
  snprintf(name, sizeof name, "dam/3d/developed/%s", delta);
  snprintf(start, sizeof start, "its start");
  if (!bench_wanted(name)) return;
  const bench_dam_def def = {n, 2, delta, "erk:bogacki-shampine-4-2-3", 0, 1};
  sph_sim *developed = bench_flow_dam(&def);
  sph_sim *lattice = bench_flow_dam(&(bench_dam_def){n, 2, delta, "leapfrog", 0.1, 1});
  if (sph_sim_run(developed, 0.9)) bench_complain("%s", sph_sim_error(developed));
  for (int k = -1; k < REPEATS; k++) {
    double a = rate_of(developed), b = rate_of(lattice);
    if (k >= 0) rate[k] = a, ratio[k] = a / b;
  }
  bench_report_over(name, "Mpairs/s", rate, REPEATS, start, ratio);
  sph_sim_free(developed);
  sph_sim_free(lattice);
}

void bench_dam(void)
{
  if (!bench_filtered()) return; /* minutes */
  measure_step(29, "1e5", 2, "molteni");
  measure_step(29, "1e5", 2, "antuono");
  measure_step(29, "1e5-1.3h", 1.3, "molteni");
  measure_step(46, "4e5", 2, "molteni");
  measure_step(65, "1e6", 2, "molteni");
  measure_developed("molteni");
  measure_developed("antuono");
}
