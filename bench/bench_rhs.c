/* Whole right-hand sides: pack, pair loop, rates, without and with a sort and list build in
 * each. */
#include <math.h>
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"
#include "bench_flow.h"

enum { REPEATS = 9 };

/* Million pairs a second of one right-hand side. */
static double rate_of(sph_sim *sim)
{
  sph_sim_stats before, after;
  sph_sim_get_stats(sim, &before);
  double begin = bench_thread_seconds();
  if (sph_sim_evaluate(sim)) bench_complain("%s", sph_sim_error(sim));
  double seconds = bench_thread_seconds() - begin;
  sph_sim_get_stats(sim, &after);
  return (after.pairs - before.pairs) / seconds / 1e6;
}

/* Full right-hand sides; rebuild: move all particles by far more than the
 * skin before each. */
static void measure(const bench_flow *s, int rebuild)
{
  char name[80];
  snprintf(name, sizeof name, "rhs/%dd/%s/%s", s->dim, s->name, rebuild ? "rebuild" : "lists");
  if (!bench_wanted(name)) return;
  sph_sim *sim = bench_flow_make(s, -1, 1); /* no skin: every pair of the lists can count */
  double rate[REPEATS];
  for (int k = -2; k < REPEATS; k++) {
    double *x = sph_group_write(sph_sim_group(sim, "fluid"), "position", 0);
    for (long i = 0; rebuild && x && i < sph_group_count(sph_sim_group(sim, "fluid")); i++)
      x[i] += 1e-3;
    double now = rate_of(sim);
    if (k >= 0) rate[k] = now;
  }
  bench_report(name, "Mpairs/s", rate, REPEATS);
  sph_sim_free(sim);
}

/* A kernel, and its rate over that of Wendland C2, by turns. */
static void measure_kernel(const bench_flow *s)
{
  char name[80], baseline[80];
  snprintf(name, sizeof name, "rhs/%dd/%s/over-wendland-c2", s->dim, s->kernel);
  snprintf(baseline, sizeof baseline, "rhs/%dd/molteni/lists", s->dim);
  if (!bench_wanted(name)) return;
  bench_flow usual = *s;
  usual.kernel = "wendland-c2";
  sph_sim *sim = bench_flow_make(s, -1, 1), *other = bench_flow_make(&usual, -1, 1);
  double rate[REPEATS], ratio[REPEATS];
  for (int k = -2; k < REPEATS; k++) {
    double a = rate_of(sim), b = rate_of(other);
    if (k >= 0) rate[k] = a, ratio[k] = a / b;
  }
  bench_report_over(name, "Mpairs/s", rate, REPEATS, baseline, ratio);
  sph_sim_free(sim);
  sph_sim_free(other);
}

/* The largest difference of an acceleration from that in double precision, over their rms. */
static double difference(sph_sim *sim, sph_sim *usual)
{
  sph_group *a = sph_sim_group(sim, "fluid"), *b = sph_sim_group(usual, "fluid");
  const long n = sph_group_count(a);
  double squares = 0, largest = 0;
  for (int d = 0; d < sph_sim_dim(sim); d++) {
    const double *x = sph_group_rate(a, "velocity", d), *y = sph_group_rate(b, "velocity", d);
    for (long i = 0; x && y && i < n; i++) {
      squares += y[i] * y[i];
      largest = fmax(largest, fabs(x[i] - y[i]));
    }
  }
  return largest / sqrt(squares / (double)n);
}

/* Has this processor mixed precision?  Said once where not: no failure. */
static int has_mixed(void)
{
  static int told;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 3, .dx = 1, .precision = "mixed"});
  const int has = sph_sim_status(sim) == SPH_OK;
  if (!has && !told++) fprintf(stderr, "bench: left out: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return has;
}

/* Mixed precision over double, by turns, and how far its rates are from those. */
static void measure_mixed(const bench_flow *s)
{
  char name[80], baseline[80], error[80];
  snprintf(name, sizeof name, "rhs/%dd/%s/mixed", s->dim, s->name);
  snprintf(error, sizeof error, "rhs/%dd/%s/mixed/error", s->dim, s->name);
  snprintf(baseline, sizeof baseline, "rhs/%dd/%s/lists", s->dim, s->name);
  if ((!bench_wanted(name) && !bench_wanted(error)) || !has_mixed()) return;
  bench_flow mixed = *s;
  mixed.precision = "mixed";
  sph_sim *sim = bench_flow_make(&mixed, -1, 1), *usual = bench_flow_make(s, -1, 1);
  double rate[REPEATS], ratio[REPEATS];
  for (int k = -2; k < REPEATS; k++) {
    double a = rate_of(sim), b = rate_of(usual);
    if (k >= 0) rate[k] = a, ratio[k] = a / b;
  }
  bench_report_over(name, "Mpairs/s", rate, REPEATS, baseline, ratio);
  rate[0] = difference(sim, usual);
  bench_report(error, "1", rate, 1);
  sph_sim_free(sim);
  sph_sim_free(usual);
}

void bench_rhs(void)
{
  long a3 = bench_quick() ? 20 : 46, a2 = bench_quick() ? 100 : 316;
  const char *usual = "wendland-c2";
  const bench_flow setups[] = {{"molteni", usual, 3, a3, 0, "molteni", 3, NULL},
                               {"molteni-thermal", usual, 3, a3, 1, "molteni", 3, NULL},
                               {"antuono", usual, 3, a3, 0, "antuono", 3, NULL},
                               {"any", usual, 3, a3, 0, NULL, 3, NULL},
                               {"molteni", usual, 2, a2, 0, "molteni", 3, NULL},
                               {"antuono", usual, 2, a2, 0, "antuono", 3, NULL},
                               {"molteni", usual, 1, 10000, 0, "molteni", 3, NULL},
                               {"molteni-2h", usual, 3, a3, 0, "molteni", 4, NULL},
                               {"antuono-2h", usual, 3, a3, 0, "antuono", 4, NULL}};
  for (unsigned k = 0; k < sizeof setups / sizeof *setups; k++) measure(&setups[k], 0);
  const int mixed[] = {0, 2, 3, 4, 5, 7, 8};
  for (unsigned k = 0; k < sizeof mixed / sizeof *mixed; k++) measure_mixed(&setups[mixed[k]]);
  measure(&setups[0], 1);
  measure(&setups[4], 1);
  const sph_kernel *kernel;
  for (int dim = 3; dim >= 1; dim--)
    for (int k = 1; (kernel = sph_kernel_get(k)); k++) {
      long across = dim == 3 ? a3 : dim == 2 ? a2 : 10000;
      measure_kernel(
          &(bench_flow){"", sph_kernel_name(kernel), dim, across, 0, "molteni", 3, NULL});
    }
}
