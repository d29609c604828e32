/* Whole right-hand sides: pack, pair loop, rates, without and with a sort and list build in
 * each. */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"

enum { REPEATS = 9 };

typedef struct setup {
  const char *name, *kernel;
  int dim;
  long across; /* particles along a side */
  int thermal;
  const char *delta; /* NULL: none */
} setup;

/* Every kernel sees the same pairs: those within 3 dx. */
static double h_over_dx(const char *kernel)
{
  return 3 / sph_kernel_support(sph_kernel_find(kernel));
}

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

/* A jittered, unaligned, periodic lattice with a smooth flow: nothing is aligned with the cells of
 * the search. */
static sph_sim *make(const setup *s, double skin)
{
  double dx = 1.0 / (double)s->across, c0 = 10;
  sph_sim_def def = {.dim = s->dim,
                     .dx = dx,
                     .kernel = s->kernel,
                     .h_over_dx = h_over_dx(s->kernel),
                     .skin = skin};
  double lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1};
  for (int d = 0; d < s->dim; d++) {
    def.periodic[d] = 1;
    def.length[d] = 1;
    def.origin[d] = 0.37 * dx * (d + 1);
  }
  sph_sim *sim = sph_sim_create(&def);
  sph_group *fluid = sph_group_box(sim, "fluid", lo, hi, 1000);
  sph_eos eos = s->thermal ? sph_eos_ideal_gas(1.4) : sph_eos_tait(1000, c0, 7);
  eos.c0 = c0; /* the density diffusion of the thermal one needs it, too */
  sph_group_set_eos(fluid, eos);
  unsigned state = 1;
  for (int d = 0; d < s->dim; d++) {
    double *x = sph_group_write(fluid, "position", d), *v = sph_group_write(fluid, "velocity", d);
    for (long i = 0; x && i < sph_group_count(fluid); i++) {
      v[i] = sin(6.28 * x[i]) + 0.05 * noise(&state);
      x[i] += 0.2 * dx * noise(&state);
    }
  }
  double *u = sph_group_write(fluid, "energy", 0);
  for (long i = 0; u && i < sph_group_count(fluid); i++) u[i] = 100;
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  if (s->delta) sph_sim_add_term(sim, sph_term_delta(s->delta, 0.1));
  return sim;
}

/* Million pairs a second of one right-hand side. */
static double rate_of(sph_sim *sim)
{
  sph_sim_stats before, after;
  sph_sim_get_stats(sim, &before);
  double begin = bench_thread_seconds();
  if (sph_sim_evaluate(sim)) fprintf(stderr, "bench: %s\n", sph_sim_error(sim));
  double seconds = bench_thread_seconds() - begin;
  sph_sim_get_stats(sim, &after);
  return (after.pairs - before.pairs) / seconds / 1e6;
}

/* Full right-hand sides; rebuild: move all particles by far more than the
 * skin before each. */
static void measure(const setup *s, int rebuild)
{
  char name[80];
  snprintf(name, sizeof name, "rhs/%dd/%s/%s", s->dim, s->name, rebuild ? "rebuild" : "lists");
  if (!bench_wanted(name)) return;
  sph_sim *sim = make(s, -1); /* no skin: every pair of the lists can count */
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
static void measure_kernel(const setup *s)
{
  char name[80], baseline[80];
  snprintf(name, sizeof name, "rhs/%dd/%s/over-wendland-c2", s->dim, s->kernel);
  snprintf(baseline, sizeof baseline, "rhs/%dd/molteni/lists", s->dim);
  if (!bench_wanted(name)) return;
  setup usual = *s;
  usual.kernel = "wendland-c2";
  sph_sim *sim = make(s, -1), *other = make(&usual, -1);
  double rate[REPEATS], ratio[REPEATS];
  for (int k = -2; k < REPEATS; k++) {
    double a = rate_of(sim), b = rate_of(other);
    if (k >= 0) rate[k] = a, ratio[k] = a / b;
  }
  bench_report_over(name, "Mpairs/s", rate, REPEATS, baseline, ratio);
  sph_sim_free(sim);
  sph_sim_free(other);
}

void bench_rhs(void)
{
  long a3 = bench_quick() ? 20 : 46, a2 = bench_quick() ? 100 : 316;
  const char *usual = "wendland-c2";
  const setup setups[] = {{"molteni", usual, 3, a3, 0, "molteni"},
                          {"molteni-thermal", usual, 3, a3, 1, "molteni"},
                          {"antuono", usual, 3, a3, 0, "antuono"},
                          {"any", usual, 3, a3, 0, NULL},
                          {"molteni", usual, 2, a2, 0, "molteni"},
                          {"antuono", usual, 2, a2, 0, "antuono"},
                          {"molteni", usual, 1, 10000, 0, "molteni"}};
  for (unsigned k = 0; k < sizeof setups / sizeof *setups; k++) measure(&setups[k], 0);
  measure(&setups[0], 1);
  measure(&setups[4], 1);
  const sph_kernel *kernel;
  for (int dim = 3; dim >= 1; dim--)
    for (int k = 1; (kernel = sph_kernel_get(k)); k++) {
      long across = dim == 3 ? a3 : dim == 2 ? a2 : 10000;
      measure_kernel(&(setup){"", sph_kernel_name(kernel), dim, across, 0, "molteni"});
    }
}
