/* Kernels, neighbour search and fused loops against the brute force of tests/property/oracle.c in
 * long double, linked with nothing but them: for the processors that build-aux/check-aarch64
 * compiles for. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fluid_loops.h"
#include "kernel_lanes.h"
#include "oracle.h"
#include "sphode/kernel.h"

enum { MOST = 64, ROOM = MOST + 8 };

static const double tolerance = 1e-14; /* of the size of a sum: rounding */

typedef struct cloud {
  int dim, kernel;
  unsigned terms;
  double h;
  long n;
  double x[3][ROOM], v[3][ROOM], rho[ROOM], m;
} cloud;

typedef struct rates {
  double a[3][ROOM], drho[ROOM];
} rates;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

/* A disordered lattice of spacing 1, supports of 3, sound speed 10. */
static cloud make(int dim, int kernel, unsigned terms)
{
  const long across = dim == 1 ? 40 : dim == 2 ? 8 : 4;
  cloud c = {.dim = dim, .kernel = kernel, .terms = terms, .n = 1, .m = 1000};
  unsigned state = (unsigned)(8 * dim + kernel);
  for (int d = 0; d < dim; d++) c.n *= across;
  c.h = 3 / sph_kernel_support(sph_kernel_get(kernel));
  for (long i = 0; i < c.n; i++) {
    long place = i;
    for (int d = 0; d < dim; d++, place /= across) {
      c.x[d][i] = (double)(place % across) + 0.6 * noise(&state);
      c.v[d][i] = noise(&state);
    }
    c.rho[i] = 1000 * (1 + 0.02 * noise(&state));
  }
  return c;
}

static const double c0 = 10, alpha = 0.3, delta = 0.1, eta = 7;
/* Loops for water leave beta out. */
static double beta(const cloud *c) { return c->terms & SPH_QUADRATIC ? 2 : 0; }

static void expected(const cloud *c, oracle_particle *particle)
{
  oracle o = {.dim = c->dim,
              .kernel = (enum oracle_kernel)c->kernel,
              .h = (real)c->h,
              .continuity = ORACLE_C2,
              .pressure = ORACLE_C2,
              .alpha = (real)alpha,
              .beta = (real)beta(c),
              .laminar = c->terms & SPH_MORRIS ? ORACLE_MORRIS : ORACLE_INVISCID,
              .diffusion = c->terms & SPH_MOLTENI ? ORACLE_MOLTENI : ORACLE_OFF,
              .delta = (real)delta,
              .groups = 1,
              .n = c->n,
              .particle = particle};
  o.group[0].eos = (oracle_eos){.kind = ORACLE_LINEAR, .rho0 = 1000, .c0 = (real)c0, .gamma = 1};
  o.group[0].viscosity = (real)eta;
  for (long i = 0; i < c->n; i++) {
    particle[i] = (oracle_particle){.m = (real)c->m, .rho = (real)c->rho[i]};
    for (int d = 0; d < c->dim; d++) {
      particle[i].x[d] = (real)c->x[d][i];
      particle[i].v[d] = (real)c->v[d][i];
    }
  }
  oracle_evaluate(&o);
}

/* Records in sorted order; those behind the last are copies of it. */
static void pack(const cloud *c, const int *order, double *record, long stride)
{
  for (long s = 0; s < (c->n + 7) / 8 * 8; s++, record += stride) {
    const long i = order[s < c->n ? s : c->n - 1];
    for (int d = 0; d < c->dim; d++) {
      record[d] = c->x[d][i];
      record[slot_v(c->dim) + d] = c->v[d][i];
    }
    record[slot_rho(c->dim)] = c->rho[i];
    record[slot_p(c->dim)] = c0 * c0 * (c->rho[i] - 1000);
    record[slot_c(c->dim)] = c0;
    record[slot_V(c->dim)] = c->m / c->rho[i];
  }
}

static int found(const cloud *c, int isa, rates *out)
{
  static double record[ROOM * SPH_PAIR_SLOTS], sums[SPH_FLUID_SUMS_ALL][ROOM];
  double *sum[SPH_FLUID_SUMS_ALL];
  const double *const x[3] = {c->x[0], c->x[1], c->x[2]};
  const sph_neighbors_def def = {.dim = c->dim, .reach = 3, .dx = 1, .lanes = sph_cpu_lanes(isa)};
  const fluid_constants k = {.terms = c->terms,
                             .kernel = c->kernel,
                             .inverse_h = 1 / c->h,
                             .eta2 = 0.01 * c->h * c->h,
                             .viscosity_1 = -alpha * c->h,
                             .viscosity_2 = 2 * beta(c) * c->h * c->h,
                             .laminar = 2 * eta};
  const double F = sph_kernel_sigma(sph_kernel_get(c->kernel), c->dim) / pow(c->h, c->dim + 2);
  sph_error error = {0};
  sph_neighbors *nb = sph_neighbors_create(&def, &error);
  sph_neighbors_sort(nb, 0, c->n, x, &error);
  sph_neighbors_build(nb, 0, 0, &error);
  if (error.status) {
    printf("# %s\n", error.text);
    sph_neighbors_free(nb);
    return 0;
  }
  const int *order = sph_neighbors_order(nb, 0);
  const sph_list list = sph_neighbors_list(nb, 0, 0);
  const long stride = fluid_slots(c->dim, c->terms, 0);
  for (int s = 0; s < SPH_FLUID_SUMS_ALL; s++) {
    sum[s] = sums[s];
    for (long i = 0; i < ROOM; i++) sums[s][i] = 0;
  }
  pack(c, order, record, stride);
  const sph_pair_task task = {.target = record,
                              .source = record,
                              .target_stride = stride,
                              .source_stride = stride,
                              .first = list.first,
                              .runs = list.runs,
                              .shift = sph_neighbors_shifts(nb, NULL),
                              .sum = sum,
                              .constants = &k};
  sph_fluid_loop(isa, c->kernel, c->dim, c->terms)(&task, 0, list.blocks);
  for (long s = 0; s < c->n; s++) {
    const long i = order[s];
    for (int d = 0; d < c->dim; d++) out->a[d][i] = F * sums[SPH_SUM_A + d][s];
    out->drho[i] = F * (c->rho[i] * sums[SPH_SUM_COMPRESSION][s] +
                        delta * c->h * c0 * sums[SPH_SUM_DIFFUSION][s]);
  }
  sph_neighbors_free(nb);
  return 1;
}

/* The largest error of all rates, of their size; NaN counts as infinite. */
static double error_of(const cloud *c, int isa)
{
  static oracle_particle particle[ROOM];
  static rates r;
  double worst = 0;
  expected(c, particle);
  if (!found(c, isa, &r)) return INFINITY;
  for (long i = 0; i < c->n; i++) {
    const oracle_particle *it = &particle[i];
    double error = (double)(fabsl((real)r.drho[i] - it->drho) / it->drho_size);
    for (int d = 0; d < c->dim; d++)
      error = fmax(error, (double)(fabsl((real)r.a[d][i] - it->a[d]) / it->a_size));
    worst = error <= worst ? worst : isnan(error) ? INFINITY : error;
  }
  return worst;
}

static int tell(int good, int number, const char *name, const char *isa, double worst)
{
  printf("%s %d - %s, %s: largest error %.2g\n", good ? "ok" : "not ok", number, name, isa, worst);
  return !good;
}

static double loops(int isa, unsigned terms)
{
  double worst = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int kernel = 0; kernel < SPH_KERNELS; kernel++) {
      const cloud c = make(dim, kernel, terms);
      worst = fmax(worst, error_of(&c, isa));
    }
  return worst;
}

/* w and f in lanes, of their largest values. */
static double shapes(kernel_lanes *lanes)
{
  double worst = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int kernel = 0; kernel < SPH_KERNELS; kernel++) {
      const oracle o = {.dim = dim, .kernel = (enum oracle_kernel)kernel, .h = 1};
      const real sigma = (real)sph_kernel_sigma(sph_kernel_get(kernel), dim);
      for (double q = 0.01; q < 3.2; q += 0.1) {
        double at[KERNEL_LANES], w[KERNEL_LANES], f[KERNEL_LANES], l[KERNEL_LANES];
        for (int k = 0; k < KERNEL_LANES; k++) at[k] = q + 0.0123 * k;
        lanes(kernel, dim, at, w, f, l);
        for (int k = 0; k < KERNEL_LANES; k++) {
          const real exact_w = oracle_w(&o, (real)at[k]) / sigma;
          const real exact_f = oracle_f(&o, (real)at[k]) / sigma;
          worst = fmax(worst, (double)(fabsl((real)w[k] - exact_w) / oracle_w(&o, 0) * sigma));
          worst = fmax(worst, (double)(fabsl((real)f[k] - exact_f) / (1 + fabsl(exact_f))));
        }
      }
    }
  return worst;
}

int main(void)
{
  static kernel_lanes *const lanes[] = {kernel_lanes_reference, kernel_lanes_generic};
  const unsigned molteni = SPH_WATER | SPH_ARTIFICIAL | SPH_MOLTENI;
  const unsigned any = SPH_WATER | SPH_ARTIFICIAL | SPH_QUADRATIC, all = any | SPH_MORRIS;
  int failed = 0, number = 0;
  printf("1..8\n");
  for (int isa = SPH_ISA_reference; isa <= SPH_ISA_generic; isa++) {
    const char *name = sph_cpu_isa_name(isa);
    const double errors[] = {shapes(lanes[isa]), loops(isa, molteni), loops(isa, any),
                             loops(isa, all)};
    const char *const what[] = {"shapes of kernels", "delta-SPH", "any", "all"};
    for (int k = 0; k < 4; k++)
      failed |= tell(errors[k] <= tolerance, ++number, what[k], name, errors[k]);
  }
  return failed;
}
