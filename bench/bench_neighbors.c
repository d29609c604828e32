/* Sorting points into cells and building the exact list of runs, in the same unit as the pair
 * loops: million directed pairs within reach a second.  A list that is rebuilt in every right-hand
 * side costs pair loop + sort + build. */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"
#include "cpu.h"

enum { REPEATS = 9 };

typedef struct cloud {
  const char *name;
  int dim;
  double reach;  /* [dx]; the spacing dx is 1 */
  double jitter; /* [dx], to either side */
  long n;
  double *x[3]; /* [n] */
} cloud;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

/* Lattice places in an order that is not the sorted one, each moved at random. */
static int fill(cloud *c, long across)
{
  unsigned state = 1;
  c->n = 1;
  for (int d = 0; d < c->dim; d++) c->n *= across;
  for (int d = 0; d < c->dim; d++)
    if (!(c->x[d] = malloc((size_t)c->n * sizeof(double)))) return 0;
  for (long i = 0; i < c->n; i++) {
    long place = i;
    for (int d = 0; d < c->dim; d++, place /= across)
      c->x[d][i] = (double)(place % across) + 2 * c->jitter * noise(&state);
  }
  return 1;
}

static double pairs_of_block(const cloud *c, const sph_neighbors *nb, long b, int lanes)
{
  const sph_list list = sph_neighbors_list(nb, 0, 0);
  const int *order = sph_neighbors_order(nb, 0);
  double pairs = 0;
  for (long r = list.first[b]; r < list.first[b + 1]; r++)
    for (long t = b * lanes; t < (b + 1) * lanes && t < c->n; t++)
      for (long s = sph_run_start(list.runs[r]);
           s < sph_run_start(list.runs[r]) + sph_run_count(list.runs[r]); s++) {
        double r2 = 0;
        for (int d = 0; d < c->dim; d++) {
          double step = c->x[d][order[t]] - c->x[d][order[s]];
          r2 += step * step;
        }
        pairs += s != t && r2 < c->reach * c->reach;
      }
  return pairs;
}

static void report(const cloud *c, const char *what, double pairs, double *seconds)
{
  char name[80];
  snprintf(name, sizeof name, "neighbors/%dd/%s/%s", c->dim, c->name, what);
  for (int k = 0; k < REPEATS; k++) seconds[k] = pairs / seconds[k] / 1e6;
  bench_report(name, "Mpairs/s", seconds, REPEATS);
}

static void measure(const cloud *c)
{
  int lanes = sph_cpu_lanes(sph_cpu_isa(NULL, NULL));
  double sort[REPEATS], build[REPEATS], pairs = 0;
  sph_error error = {0};
  sph_neighbors *nb = sph_neighbors_create(
      &(sph_neighbors_def){.dim = c->dim, .reach = c->reach, .dx = 1, .lanes = lanes}, &error);
  for (int k = -1; k < REPEATS; k++) { /* the first takes the memory */
    double begin = bench_thread_seconds();
    sph_neighbors_sort(nb, 0, c->n, (const double *const *)c->x, &error);
    double middle = bench_thread_seconds();
    sph_neighbors_build(nb, 0, 0, &error);
    if (k < 0) continue;
    sort[k] = middle - begin;
    build[k] = bench_thread_seconds() - middle;
  }
  for (long b = 0; b < sph_neighbors_list(nb, 0, 0).blocks; b++)
    pairs += pairs_of_block(c, nb, b, lanes);
  if (error.status)
    bench_complain("%s", error.text);
  else {
    report(c, "sort", pairs, sort);
    report(c, "build", pairs, build);
  }
  sph_neighbors_free(nb);
}

void bench_neighbors(void)
{
  cloud clouds[] = {
      {.name = "lattice", .dim = 3, .reach = 3, .jitter = 0.1},
      {.name = "disorder", .dim = 3, .reach = 3, .jitter = 0.5},
      {.name = "lattice", .dim = 2, .reach = 3, .jitter = 0.1},
      {.name = "disorder", .dim = 2, .reach = 3, .jitter = 0.5},
  };
  if (!bench_wanted("neighbors")) return;
  for (size_t k = 0; k < sizeof clouds / sizeof *clouds; k++) {
    long across3 = bench_quick() ? 20 : 46, across2 = bench_quick() ? 100 : 316;
    if (fill(&clouds[k], clouds[k].dim == 3 ? across3 : across2)) measure(&clouds[k]);
    for (int d = 0; d < 3; d++) free(clouds[k].x[d]);
  }
}
