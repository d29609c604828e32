/* Whole right-hand sides: pack, pair loop, rates, without and with a sort and list build in
 * each. */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"

enum { REPEATS = 9 };

typedef struct setup {
  const char *name;
  int dim;
  long across; /* particles along a side */
  int thermal;
  const char *delta; /* NULL: none */
} setup;

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
  sph_sim_def def = {
      .dim = s->dim, .dx = dx, .kernel = "wendland-c2", .h_over_dx = 1.5, .skin = skin};
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

/* Million pairs a second of full right-hand sides; rebuild: move all particles by far more than the
 * skin before each. */
static void measure(const setup *s, int rebuild)
{
  char name[80];
  snprintf(name, sizeof name, "rhs/%dd/%s/%s", s->dim, s->name, rebuild ? "rebuild" : "lists");
  if (!bench_wanted(name)) return;
  sph_sim *sim = make(s, -1); /* no skin: every pair of the lists can count */
  double rate[REPEATS];
  sph_sim_stats before, after;
  for (int k = -2; k < REPEATS; k++) {
    double *x = sph_group_write(sph_sim_group(sim, "fluid"), "position", 0);
    for (long i = 0; rebuild && x && i < sph_group_count(sph_sim_group(sim, "fluid")); i++)
      x[i] += 1e-3;
    sph_sim_get_stats(sim, &before);
    double begin = bench_thread_seconds();
    if (sph_sim_evaluate(sim)) fprintf(stderr, "bench: %s\n", sph_sim_error(sim));
    double seconds = bench_thread_seconds() - begin;
    sph_sim_get_stats(sim, &after);
    if (k >= 0) rate[k] = (after.pairs - before.pairs) / seconds / 1e6;
  }
  bench_report(name, "Mpairs/s", rate, REPEATS);
  sph_sim_free(sim);
}

void bench_rhs(void)
{
  long a3 = bench_quick() ? 20 : 46, a2 = bench_quick() ? 100 : 316;
  const setup setups[] = {{"molteni", 3, a3, 0, "molteni"},
                          {"molteni-thermal", 3, a3, 1, "molteni"},
                          {"antuono", 3, a3, 0, "antuono"},
                          {"any", 3, a3, 0, NULL},
                          {"molteni", 2, a2, 0, "molteni"},
                          {"antuono", 2, a2, 0, "antuono"},
                          {"molteni", 1, 10000, 0, "molteni"}};
  for (unsigned k = 0; k < sizeof setups / sizeof *setups; k++) measure(&setups[k], 0);
  measure(&setups[0], 1);
  measure(&setups[4], 1);
}
