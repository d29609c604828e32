/* Terms registered at run time against the same terms in the fused loop, by turns: time over fused
 * time of whole right-hand sides in 3D. */
#include <sphode.h>
#include <stdio.h>

#include "bench.h"

enum { REPEATS = 9, TERMS = 4 };

/* As users may compile theirs: for the processor at hand, loops as vectors. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

static const double alpha = 0.02, delta = 0.1, c0 = 10;

CLONES static void continuity(const sph_term *term, const sph_tile *t)
{
  (void)term;
#pragma omp simd
  for (long k = 0; k < t->n; k++) t->drho[k] += t->i[0][k] * t->V[k] * t->rv[k] * t->F[k];
}

CLONES static void pressure(const sph_term *term, const sph_tile *t)
{
  (void)term;
#pragma omp simd
  for (long k = 0; k < t->n; k++)
    t->push[k] -= t->V[k] * (t->i[1][k] + t->j[1][k]) / t->i[0][k] * t->F[k];
}

CLONES static void viscosity(const sph_term *term, const sph_tile *t)
{
  const double eta2 = 0.01 * t->h * t->h, factor = alpha * t->h;
  (void)term;
#pragma omp simd
  for (long k = 0; k < t->n; k++) {
    double w = t->rv[k] < 0 ? t->rv[k] : 0, c = t->i[1][k] + t->j[1][k];
    t->along_r[k] +=
        factor * t->m[k] * c * w * t->F[k] / ((t->i[0][k] + t->j[0][k]) * (t->r2[k] + eta2));
  }
}

CLONES static void diffusion(const sph_term *term, const sph_tile *t)
{
  const double factor = 2 * delta * t->h * c0;
  (void)term;
#pragma omp simd
  for (long k = 0; k < t->n; k++)
    t->drho[k] += factor * t->V[k] * (t->i[0][k] - t->j[0][k]) * t->F[k];
}

static const sph_term tiles[TERMS] = {
    {.name = "viscosity by tile",
     .pair = viscosity,
     .reads = "density sound_speed r2 rv F m",
     .adds = "along_r"},
    {.name = "continuity by tile", .pair = continuity, .reads = "density rv F V", .adds = "drho"},
    {.name = "pressure by tile", .pair = pressure, .reads = "density pressure F V", .adds = "push"},
    {.name = "diffusion by tile", .pair = diffusion, .reads = "density F V", .adds = "drho"},
};

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

/* The first `by_tile` terms as tiles, the others fused; or all fused, and one more by tile. */
static sph_sim *make(int by_tile, int more)
{
  const long across = bench_quick() ? 20 : 46;
  const double dx = 1.0 / (double)across;
  sph_sim_def def = {.dim = 3, .dx = dx, .skin = -1, .periodic = {1, 1, 1}, .length = {1, 1, 1}};
  for (int d = 0; d < 3; d++) def.origin[d] = 0.37 * dx * (d + 1);
  sph_sim *sim = sph_sim_create(&def);
  sph_group *fluid = sph_group_box(sim, "fluid", (double[3]){0}, (double[]){1, 1, 1}, 1000);
  sph_group_set_eos(fluid, sph_eos_tait(1000, c0, 7));
  unsigned state = 1;
  for (int d = 0; d < 3; d++) {
    double *x = sph_group_write(fluid, "position", d), *v = sph_group_write(fluid, "velocity", d);
    for (long i = 0; x && v && i < sph_group_count(fluid); i++) {
      v[i] = sin(6.28 * x[i]) + 0.05 * noise(&state);
      x[i] += 0.2 * dx * noise(&state);
    }
  }
  for (int k = 0; k < by_tile; k++) sph_sim_add_term(sim, tiles[k]);
  if (more) sph_sim_add_term(sim, tiles[0]);
  if (by_tile < 1) sph_sim_add_term(sim, sph_term_viscosity_artificial(alpha, 0));
  if (by_tile < 2) sph_sim_add_term(sim, sph_term_continuity());
  if (by_tile < 3) sph_sim_add_term(sim, sph_term_pressure());
  if (by_tile < 4) sph_sim_add_term(sim, sph_term_delta("molteni", delta));
  return sim;
}

static double seconds_of(sph_sim *sim)
{
  double begin = bench_thread_seconds();
  if (sph_sim_evaluate(sim)) bench_complain("%s", sph_sim_error(sim));
  return bench_thread_seconds() - begin;
}

static void measure(const char *name, int by_tile, int more)
{
  if (!bench_wanted(name)) return;
  sph_sim *fused = make(0, 0), *tile = make(by_tile, more);
  double ratio[REPEATS];
  for (int k = -2; k < REPEATS; k++) {
    double a = seconds_of(tile), b = seconds_of(fused);
    if (k >= 0) ratio[k] = a / b;
  }
  bench_report(name, "1", ratio, REPEATS);
  sph_sim_free(fused);
  sph_sim_free(tile);
}

void bench_tiles(void)
{
  measure("tiles/3d/one-more", 0, 1);
  measure("tiles/3d/one-beside-fused", 1, 0);
  measure("tiles/3d/all-four", TERMS, 0);
}
