/* bench -- measures this build on this machine: bench [--json] [--quick] [--filter TEXT]
 *
 * --json: a line a figure, {"name", "value", "unit", "spread", "ratio", "baseline"}, after one that
 * tells of processor, instruction set, compiler and flags; bench/compare sets two of them side by
 * side.  Spread: (largest - smallest)/median; ratio: to the figure `baseline` of the same run.
 *
 * Rates are in million directed pairs inside the support per second of one core's CPU time; ratios
 * inside one run are worth more than any rate.  Exit status: 1 if something failed, rates or bits
 * differ that should not, or no figure has TEXT in its name. */
#define _POSIX_C_SOURCE 200809L
#include "bench.h"
#include "config.h"

#include <math.h>
#include <sphode.h>
#include <stdarg.h>
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

static int printed, complaints;

void bench_complain(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  fprintf(stderr, "bench: ");
  vfprintf(stderr, format, arguments);
  fprintf(stderr, "\n");
  va_end(arguments);
  complaints++;
}

/* Is this figure one of those that the filter names? */
static int asked(const char *name) { return !options.filter || strstr(name, options.filter); }

/* ... or some of those whose names begin so? */
int bench_wanted(const char *name)
{
  return asked(name) || !strncmp(options.filter, name, strlen(name));
}

int bench_filtered(void) { return options.filter != NULL; }

int bench_quick(void) { return options.quick; }

static int rising(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median_of(double *values, int n)
{
  qsort(values, (size_t)n, sizeof *values, rising);
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

void bench_report_over(const char *name, const char *unit, double *values, int n,
                       const char *baseline, double *ratios)
{
  if (!asked(name)) return;
  printed++;
  double median = median_of(values, n), ratio = ratios ? median_of(ratios, n) : 0;
  double spread = median != 0 ? (values[n - 1] - values[0]) / fabs(median) : 0;
  if (!options.json) {
    printf("%-44s %12.4g %-10s +- %.0f %%", name, median, unit, 50 * spread);
    if (ratios) printf("  %.3g of %s", ratio, baseline);
    printf("\n");
  } else {
    printf("{\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\", \"spread\": %.3g, ", name, median,
           unit, spread);
    if (ratios)
      printf("\"ratio\": %.4g, \"baseline\": \"%s\"}\n", ratio, baseline);
    else
      printf("\"ratio\": null, \"baseline\": null}\n");
  }
  fflush(stdout);
}

void bench_report(const char *name, const char *unit, double *values, int n)
{
  bench_report_over(name, unit, values, n, NULL, NULL);
}

/* The processor's name, "" where the system does not tell it. */
static void processor(char *name, size_t size)
{
  char line[400];
  FILE *file = fopen("/proc/cpuinfo", "r");
  *name = 0;
  while (file && !*name && fgets(line, sizeof line, file)) {
    const char *colon = strchr(line, ':');
    if (strncmp(line, "model name", 10) || !colon) continue;
    snprintf(name, size, "%s", colon + 2);
    name[strcspn(name, "\n\"\\")] = 0;
  }
  if (file) fclose(file);
}

static int introduce(void)
{
  char cpu[200];
  processor(cpu, sizeof cpu);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 1});
  const int status = sph_sim_status(sim);
  if (status)
    bench_complain("%s", sph_sim_error(sim));
  else
    printf(options.json
               ? "{\"sphode\": \"%s\", \"cpu\": \"%s\", \"isa\": \"%s\", \"sizes\": \"%s\", "
                 "\"compiler\": \"%s %s\", \"flags\": \"%s\"}\n"
               : "sphode %s; %s, %s; %s sizes; %s %s %s\n",
           sph_version(), cpu, sph_sim_isa(sim), options.quick ? "small" : "full", SPH_COMPILER,
           __VERSION__, SPH_CFLAGS);
  sph_sim_free(sim);
  return status;
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
  if (introduce()) return 2;
  bench_memory(); /* first: nothing is left of others */
  bench_neighbors();
  bench_search();
  bench_operators();
  bench_rhs();
  bench_phases();
  bench_baseline();
  bench_derivatives();
  bench_integration();
  bench_tiles();
  bench_threads();
  bench_reach();
  bench_dam();
  bench_output();
  bench_stability();
  bench_linear();
  bench_imex();
  bench_multirate();
  if (!printed)
    bench_complain("no figure has \"%s\" in its name", options.filter ? options.filter : "");
  return complaints > 0;
}
