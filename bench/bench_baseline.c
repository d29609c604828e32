/* Whole right-hand sides beside those of a good plain code (baseline.h), by turns: a jittered block
 * of liquid in open space.  "rebuild": both sort and build their lists in every evaluation.  And
 * how time per particle grows with their number.  The rates of both must agree. */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

#include "baseline.h"
#include "bench.h"
#include "cpu.h"

#define DECLARE(isa, loops) extern const baseline_code baseline_code_##loops;
SPH_ISA_BUILT(DECLARE)
static const baseline_code *const codes[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &baseline_code_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

enum { REPEATS = 9 };
static const double ALPHA = 0.02, DELTA = 0.1, RHO0 = 1000, C0 = 10;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

static sph_sim *make(int dim, long across)
{
  const double dx = 1.0 / (double)across, lo[3] = {0}, hi[3] = {1, 1, 1};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = dim, .dx = dx, .skin = -1});
  sph_group *fluid = sph_group_box(sim, "fluid", lo, hi, RHO0);
  sph_group_set_eos(fluid, sph_eos_tait(RHO0, C0, 7));
  unsigned state = 1;
  for (int d = 0; d < dim; d++) {
    double *x = sph_group_write(fluid, "position", d), *v = sph_group_write(fluid, "velocity", d);
    for (long i = 0; x && v && i < sph_group_count(fluid); i++) {
      v[i] = sin(6.28 * x[i]) + 0.05 * noise(&state);
      x[i] += 0.2 * dx * noise(&state) + 0.37 * dx;
    }
  }
  double *rho = sph_group_write(fluid, "density", 0);
  for (long i = 0; rho && i < sph_group_count(fluid); i++)
    rho[i] = RHO0 * (1 + 0.01 * noise(&state));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(ALPHA, 0));
  sph_sim_add_term(sim, sph_term_delta("molteni", DELTA));
  return sim;
}

/* Moves all particles so far that lists are built anew. */
static void move(sph_sim *sim)
{
  double *x = sph_group_write(sph_sim_group(sim, "fluid"), "position", 0);
  for (long i = 0; x && i < sph_group_count(sph_sim_group(sim, "fluid")); i++) x[i] += 1e-3;
}

/* Seconds of an evaluation; its pairs. */
static double seconds_of(sph_sim *sim, double *pairs)
{
  sph_sim_stats before, after;
  sph_sim_get_stats(sim, &before);
  double begin = bench_thread_seconds();
  if (sph_sim_evaluate(sim)) bench_complain("%s", sph_sim_error(sim));
  double seconds = bench_thread_seconds() - begin;
  sph_sim_get_stats(sim, &after);
  if (pairs) *pairs = after.pairs - before.pairs;
  return seconds;
}

static baseline_def definition(const sph_sim *sim, const sph_group *fluid)
{
  baseline_def def = {.dim = sph_sim_dim(sim),
                      .h = sph_sim_h(sim),
                      .alpha = ALPHA,
                      .delta = DELTA,
                      .rho0 = RHO0,
                      .c0 = C0,
                      .n = sph_group_count(fluid),
                      .rho = sph_group_read(fluid, "density", 0),
                      .m = sph_group_read(fluid, "mass", 0)};
  for (int d = 0; d < def.dim; d++) {
    def.x[d] = sph_group_read(fluid, "position", d);
    def.v[d] = sph_group_read(fluid, "velocity", d);
  }
  return def;
}

/* The largest difference of two arrays over the largest entry. */
static double apart(const double *a, const double *b, long n)
{
  double most = 0, size = 0;
  for (long i = 0; i < n; i++) {
    most = fmax(most, fabs(a[i] - b[i]));
    size = fmax(size, fabs(b[i]));
  }
  return most / size;
}

static void compare(const char *name, const sph_group *fluid, int dim, double *const dv[3],
                    const double *drho)
{
  const long n = sph_group_count(fluid);
  double most = apart(sph_group_rate(fluid, "density", 0), drho, n);
  for (int d = 0; d < dim; d++)
    most = fmax(most, apart(sph_group_rate(fluid, "velocity", d), dv[d], n));
  if (most > 1e-11) bench_complain("%s: the rates differ by %g of the largest", name, most);
}

static void turns(const char *name, sph_sim *sim, const baseline_code *code, baseline *plain,
                  int rebuild, double *const dv[3], double *drho)
{
  char other[80];
  double rate[REPEATS], ratio[REPEATS], plain_rate[REPEATS], pairs;
  snprintf(other, sizeof other, "%s/csr", name);
  for (int k = -1; k < REPEATS; k++) {
    if (rebuild) move(sim);
    double ours = seconds_of(sim, &pairs), begin = bench_thread_seconds();
    if (rebuild && !code->build(plain)) return;
    code->rates(plain, dv, drho);
    double its = bench_thread_seconds() - begin;
    if (k < 0) continue;
    rate[k] = pairs / ours / 1e6;
    plain_rate[k] = pairs / its / 1e6;
    ratio[k] = its / ours;
  }
  bench_report(other, "Mpairs/s", plain_rate, REPEATS);
  bench_report_over(name, "Mpairs/s", rate, REPEATS, other, ratio);
}

static void measure(int dim, long across, const char *size, int rebuild)
{
  char name[60];
  snprintf(name, sizeof name, "plain/%dd/%s/%s", dim, size, rebuild ? "rebuild" : "lists");
  if (!bench_wanted(name)) return;
  sph_sim *sim = make(dim, across);
  seconds_of(sim, NULL);
  const sph_group *fluid = sph_sim_group(sim, "fluid");
  const baseline_def def = definition(sim, fluid);
  double *work = calloc(4 * (size_t)def.n, sizeof *work);
  const baseline_code *code = codes[sph_cpu_isa(NULL, NULL)];
  baseline *plain = code->create(&def);
  if (work && plain && code->build(plain)) {
    double *const dv[3] = {work, work + def.n, work + 2 * def.n}, *drho = work + 3 * def.n;
    turns(name, sim, code, plain, rebuild, dv, drho);
    compare(name, fluid, dim, dv, drho);
  }
  free(work);
  code->free(plain);
  sph_sim_free(sim);
}

/* Time per particle over that of 1e4 particles, by turns. */
static void grow(int dim, long across, const char *size)
{
  char name[60];
  snprintf(name, sizeof name, "growth/%dd/%s", dim, size);
  if (!bench_wanted(name)) return;
  const long few = dim == 3 ? 22 : 100;
  sph_sim *sim = make(dim, across), *small = make(dim, few);
  double n = (double)sph_group_count(sph_sim_group(sim, "fluid"));
  double n_small = (double)sph_group_count(sph_sim_group(small, "fluid"));
  double each[REPEATS], ratio[REPEATS];
  for (int k = -1; k < REPEATS; k++) {
    double a = seconds_of(sim, NULL) / n, b = 0;
    for (int repeat = 0; repeat < 20; repeat++) b += seconds_of(small, NULL) / n_small / 20;
    if (k < 0) continue;
    each[k] = 1e9 * a;
    ratio[k] = a / b;
  }
  bench_report_over(name, "ns", each, REPEATS, "1e4 particles", ratio);
  sph_sim_free(sim);
  sph_sim_free(small);
}

void bench_baseline(void)
{
  measure(3, bench_quick() ? 22 : 46, "1e5", 0);
  measure(3, bench_quick() ? 22 : 46, "1e5", 1);
  measure(2, bench_quick() ? 100 : 316, "1e5", 0);
  measure(2, bench_quick() ? 100 : 316, "1e5", 1);
  if (bench_quick()) return;
  grow(3, 46, "1e5");
  grow(3, 100, "1e6");
  if (!bench_filtered()) return; /* minutes, gigabytes */
  measure(3, 100, "1e6", 0);
  measure(3, 100, "1e6", 1);
  grow(3, 216, "1e7");
}
