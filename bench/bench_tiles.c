/* Terms registered at run time against the same terms in the fused loop, by turns: time over fused
 * time of whole right-hand sides in 3D. */
#include <math.h>
#include <sphode.h>
#include <stdio.h>

#include "bench.h"

enum { REPEATS = 9, TERMS = 5 };

/* As users may compile theirs, "native": for the processor at hand, loops as vectors; "plain": by
 * the flags of this build, which name no processor unless CFLAGS do. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

static const double alpha = 0.02, delta = 0.1, c0 = 10, alpha_u = 1;

/* What a term adds to each pair k of a tile t. */
#define TERM(name, statement)                                               \
  CLONES static void name##_native(const sph_term *term, const sph_tile *t) \
  {                                                                         \
    (void)term;                                                             \
    _Pragma("omp simd") for (long k = 0; k < t->n; k++) statement;          \
  }                                                                         \
  static void name##_plain(const sph_term *term, const sph_tile *t)         \
  {                                                                         \
    (void)term;                                                             \
    _Pragma("omp simd") for (long k = 0; k < t->n; k++) statement;          \
  }

TERM(continuity, t->drho[k] += t->i[0][k] * t->V[k] * t->rv[k] * t->F[k])
TERM(pressure, t->push[k] -= t->V[k] * (t->i[1][k] + t->j[1][k]) / t->i[0][k] * t->F[k])
TERM(viscosity, t->along_r[k] += alpha * t->h * t->m[k] * (t->i[1][k] + t->j[1][k]) *
                                 (t->rv[k] < 0 ? t->rv[k] : 0) * t->F[k] /
                                 ((t->i[0][k] + t->j[0][k]) * (t->r2[k] + 0.01 * t->h * t->h)))
TERM(diffusion, t->drho[k] += 2 * delta * t->h * c0 * t->V[k] * (t->i[0][k] - t->j[0][k]) * t->F[k])
TERM(conductivity, t->du[k] += alpha_u * t->m[k] * 2 / (t->i[0][k] + t->j[0][k]) *
                               sqrt(2 * fabs(t->i[1][k] - t->j[1][k]) / (t->i[0][k] + t->j[0][k])) *
                               (t->i[2][k] - t->j[2][k]) * sqrt(t->r2[k]) * t->F[k])

#define TILE(word, how, reads_, adds_)                                                 \
  {                                                                                    \
    .name = #word " by tile", .pair = word##_##how, .reads = (reads_), .adds = (adds_) \
  }
#define TILES(word, reads, adds)                                    \
  {                                                                 \
    TILE(word, native, reads, adds), TILE(word, plain, reads, adds) \
  }
static const sph_term tiles[TERMS][2] = {
    TILES(viscosity, "density sound_speed r2 rv F m", "along_r"),
    TILES(continuity, "density rv F V", "drho"),
    TILES(pressure, "density pressure F V", "push"),
    TILES(diffusion, "density F V", "drho"),
    TILES(conductivity, "density pressure energy r2 F m", "du"),
};

/* Of `terms` the first `by_tile` are tiles, the others fused, and `more` come by tile besides; of
 * five the fluid has an energy. */
typedef struct mixture {
  int terms, by_tile, more, plain;
} mixture;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

static sph_sim *make(mixture m)
{
  const long across = bench_quick() ? 20 : 46;
  const double dx = 1.0 / (double)across;
  sph_sim_def def = {.dim = 3, .dx = dx, .skin = -1, .periodic = {1, 1, 1}, .length = {1, 1, 1}};
  for (int d = 0; d < 3; d++) def.origin[d] = 0.37 * dx * (d + 1);
  sph_sim *sim = sph_sim_create(&def);
  sph_group *fluid = sph_group_box(sim, "fluid", (double[3]){0}, (double[]){1, 1, 1}, 1000);
  sph_group_set_eos(fluid, m.terms > 4 ? sph_eos_stiffened_gas(1000, 7, 1000 * c0 * c0 / 7, 0)
                                       : sph_eos_tait(1000, c0, 7));
  unsigned state = 1;
  for (int d = 0; d < 3; d++) {
    double *x = sph_group_write(fluid, "position", d), *v = sph_group_write(fluid, "velocity", d);
    for (long i = 0; x && v && i < sph_group_count(fluid); i++) {
      v[i] = sin(6.28 * x[i]) + 0.05 * noise(&state);
      x[i] += 0.2 * dx * noise(&state);
    }
  }
  double *u = m.terms > 4 ? sph_group_write(fluid, "energy", 0) : NULL;
  for (long i = 0; u && i < sph_group_count(fluid); i++)
    u[i] = c0 * c0 / 6 * (1 + 0.01 * noise(&state));
  for (int k = 0; k < m.by_tile; k++) sph_sim_add_term(sim, tiles[k][m.plain]);
  for (int k = 0; k < m.more; k++) sph_sim_add_term(sim, tiles[k][m.plain]);
  if (m.by_tile < 1) sph_sim_add_term(sim, sph_term_viscosity_artificial(alpha, 0));
  if (m.by_tile < 2) sph_sim_add_term(sim, sph_term_continuity());
  if (m.by_tile < 3) sph_sim_add_term(sim, sph_term_pressure());
  if (m.by_tile < 4) sph_sim_add_term(sim, sph_term_delta("molteni", delta));
  if (m.by_tile < 5 && m.terms > 4)
    sph_sim_add_term(sim, sph_term_conductivity_artificial(alpha_u));
  return sim;
}

static double seconds_of(sph_sim *sim)
{
  double begin = bench_thread_seconds();
  if (sph_sim_evaluate(sim)) bench_complain("%s", sph_sim_error(sim));
  return bench_thread_seconds() - begin;
}

static void measure(const char *name, mixture m)
{
  if (!bench_wanted(name)) return;
  sph_sim *fused = make((mixture){.terms = m.terms}), *tile = make(m);
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
  measure("tiles/3d/one-more", (mixture){.terms = 4, .more = 1});
  measure("tiles/3d/one-beside-fused", (mixture){.terms = 4, .by_tile = 1});
  measure("tiles/3d/one-beside-fused/plain", (mixture){.terms = 4, .by_tile = 1, .plain = 1});
  measure("tiles/3d/all-four", (mixture){.terms = 4, .by_tile = 4});
  measure("tiles/3d/all-five", (mixture){.terms = 5, .by_tile = 5});
  measure("tiles/3d/all-five/plain", (mixture){.terms = 5, .by_tile = 5, .plain = 1});
}
