/* Operators on jittered lattices, 3D, Wendland C2, h = 1.5 dx: million directed pairs inside the
 * support per second of one core. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"
#include "sphode.h"

enum { REPEATS = 5, FIELDS = 10 };

typedef struct points {
  long n;
  double *x[3], *V, *f, *out[FIELDS];
} points;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

static double *array(long n)
{
  double *a = calloc((size_t)n, sizeof *a);
  if (!a) bench_complain("out of memory"), exit(1);
  return a;
}

static points make(int across)
{
  points p = {.n = (long)across * across * across};
  unsigned state = 1;
  p.V = array(p.n), p.f = array(p.n);
  for (int d = 0; d < 3; d++) p.x[d] = array(p.n);
  for (int k = 0; k < FIELDS; k++) p.out[k] = array(p.n);
  for (long i = 0; i < p.n; i++) {
    for (long d = 0, rest = i; d < 3; d++, rest /= across)
      p.x[d][i] = ((double)(rest % across) + 0.5 + 0.4 * noise(&state)) / across;
    p.V[i] = 1.0 / (double)p.n;
    p.f[i] = sin(6 * p.x[0][i]) * cos(5 * p.x[1][i]) + p.x[2][i];
  }
  return p;
}

static void drop(points *p)
{
  free(p->V), free(p->f);
  for (int d = 0; d < 3; d++) free(p->x[d]);
  for (int k = 0; k < FIELDS; k++) free(p->out[k]);
}

static int interpolate(sph_operator *op, points *p)
{
  return sph_operator_interpolate(op, p->f, p->out[0], NULL);
}
static int difference(sph_operator *op, points *p)
{
  return sph_operator_gradient(op, "difference", p->f, p->out, NULL);
}
static int corrected(sph_operator *op, points *p)
{
  return sph_operator_gradient(op, "corrected", p->f, p->out, NULL);
}
static int fatehi(sph_operator *op, points *p)
{
  return sph_operator_laplacian(op, "fatehi-manzari", NULL, p->f, p->out[0], NULL);
}
static int mls_1(sph_operator *op, points *p)
{
  return sph_operator_mls(op, 1, p->f, p->out[0], p->out + 1, NULL, NULL);
}
static int mls_2(sph_operator *op, points *p)
{
  return sph_operator_mls(op, 2, p->f, p->out[0], p->out + 1, p->out + 4, NULL);
}

void bench_operators(void)
{
  static const struct {
    const char *name;
    int (*call)(sph_operator *op, points *p);
  } all[] = {{"operators: interpolate", interpolate},
             {"operators: gradient difference", difference},
             {"operators: gradient corrected", corrected},
             {"operators: mls 1", mls_1},
             {"operators: mls 2", mls_2},
             {"operators: laplacian fatehi-manzari", fatehi}};
  const int across = bench_quick() ? 16 : 36;
  points p = make(across);
  const sph_operator_def def = {.dim = 3,
                                .h = 1.5 / across,
                                .periodic = {1, 1, 1},
                                .length = {1, 1, 1}};
  sph_operator *op = sph_operator_create(&def, NULL);
  const double *const x[] = {p.x[0], p.x[1], p.x[2]};
  const double pairs = (double)p.n * sph_kernel_neighbors(sph_kernel_get(0), 3, 1.5) / 1e6;
  if (sph_operator_set_points(op, p.n, x, p.V, NULL, NULL)) exit(1);
  for (int k = 0; k < (int)(sizeof all / sizeof *all); k++) {
    double rate[REPEATS];
    if (!bench_wanted(all[k].name)) continue;
    for (int r = 0; r < REPEATS; r++) {
      const double start = bench_thread_seconds();
      if (all[k].call(op, &p)) exit(1);
      rate[r] = pairs / (bench_thread_seconds() - start);
    }
    bench_report(all[k].name, "Mpairs/s/core", rate, REPEATS);
  }
  sph_operator_free(op);
  drop(&p);
}
