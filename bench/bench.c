/* bench -- measures this build on this machine: bench [--json] [--quick] [--filter TEXT]
 *
 * Rates are in million directed pairs inside the support per second of one core's CPU time; ratios
 * inside one run are worth more than any rate. */
#define _POSIX_C_SOURCE 200809L
#include "bench.h"

#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static struct {
  int json, quick;
  const char *filter;
} options;

double bench_thread_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int bench_wanted(const char *name) { return !options.filter || strstr(name, options.filter); }

int bench_filtered(void) { return options.filter != NULL; }

int bench_quick(void) { return options.quick; }

static int rising(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

void bench_report(const char *name, const char *unit, double *values, int n)
{
  qsort(values, (size_t)n, sizeof *values, rising);
  double median = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
  double spread = median != 0 ? (values[n - 1] - values[0]) / median : 0;
  if (options.json)
    printf("{\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\", \"spread\": %.3g}\n", name,
           median, unit, spread);
  else
    printf("%-44s %12.4g %-10s +- %.0f %%\n", name, median, unit, 50 * spread);
  fflush(stdout);
}

int main(int argc, char **argv)
{
  for (int k = 1; k < argc; k++) {
    if (!strcmp(argv[k], "--json"))
      options.json = 1;
    else if (!strcmp(argv[k], "--quick"))
      options.quick = 1;
    else if (!strcmp(argv[k], "--filter") && k + 1 < argc)
      options.filter = argv[++k];
    else {
      fprintf(stderr, "usage: bench [--json] [--quick] [--filter TEXT]\n");
      return 2;
    }
  }
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 1});
  if (!options.json) printf("sphode %s, isa %s, one thread\n", sph_version(), sph_sim_isa(sim));
  sph_sim_free(sim);
  bench_neighbors();
  bench_operators();
  bench_rhs();
  bench_derivatives();
  bench_integration();
  bench_tiles();
  bench_stability();
  bench_linear();
  bench_imex();
  bench_multirate();
  return 0;
}
