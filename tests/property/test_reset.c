/* Density resets: exact for constant and linear densities on jittered points with free surfaces;
 * beside walls, dust and other fluids the sums of their definition, in long double; noise that they
 * take out of a run; the same bits for any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "cpu.h"
#include "near.h"
#include "scene.h"

/* A step so short that nothing changes but by the reset behind it. */
static const sph_integrator_def no_time = {.method = "leapfrog",
                                           .dt_fixed = 1e-30,
                                           .dt_min = 1e-40};

static void step(sph_sim *sim)
{
  if (sph_sim_step(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
}

/* ---- exact ---- */

static double plane(int dim, const double *const x[], long i, double slope)
{
  double rho = 1000;
  for (int d = 0; d < dim; d++) rho += slope * (30 - 45 * d) * x[d][i];
  return rho;
}

/* Largest relative error of a density that was linear; slope 0: constant. */
static double error(int dim, int kernel, const char *isa, const char *kind, double slope)
{
  const int across = dim == 1 ? 30 : dim == 2 ? 12 : 8;
  const double dx = 1.0 / across, *x[3];
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = dim, .dx = dx, .kernel = sph_kernel_name(sph_kernel_get(kernel)), .isa = isa});
  sph_group *water = sph_group_box(sim, "water", (double[3]){0}, (double[]){1, 1, 1}, 1000);
  sph_group_jitter(water, 0.2, (unsigned long)(7 * kernel + dim));
  sph_group_set_eos(water, sph_eos_tait(1000, 50, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_set_integrator(sim, &no_time);
  sph_sim_reset_density(sim, kind, 1);
  for (int d = 0; d < dim; d++) x[d] = sph_group_read(water, "position", d);
  double *rho = sph_group_write(water, "density", 0), *m = sph_group_write(water, "mass", 0);
  for (long i = 0; i < sph_group_count(water); i++) {
    rho[i] = plane(dim, x, i, slope);
    m[i] *= 1 + 0.3 * sin(37.0 * (double)i);
  }
  step(sim);
  const double *now = sph_group_read(water, "density", 0);
  double worst = 0;
  for (int d = 0; d < dim; d++) x[d] = sph_group_read(water, "position", d);
  for (long i = 0; i < sph_group_count(water); i++) {
    double off = fabs(now[i] / plane(dim, x, i, slope) - 1);
    if (!(off <= worst)) worst = off;
  }
  sph_sim_free(sim);
  return worst;
}

static void exact(void **state)
{
  (void)state;
  static const char *const isa[] = {NULL, "reference", SPH_ISA_TWO_LANES};
  double constant = 0, linear = 0, least = INFINITY;
  for (int dim = 1; dim <= 3; dim++)
    for (int kernel = 0; sph_kernel_get(kernel); kernel++) {
      constant = fmax(constant, error(dim, kernel, isa[kernel % 3], "shepard", 0));
      linear = fmax(linear, error(dim, kernel, isa[(kernel + dim) % 3], "mls", 1));
      least = fmin(least, error(dim, kernel, NULL, "shepard", 1));
    }
  print_message("# shepard, constant density: %.2g; mls, linear: %.2g; shepard, linear: %.2g\n",
                constant, linear, least);
  assert_true(constant <= 1e-14);
  assert_true(linear <= 1e-11);
  assert_true(least > 1e-4);
}

/* ---- the definition ---- */

enum { MOST = 4 };

/* Gauss with pivots; x = A^-1 e_0. */
static void solve(int n, real A[MOST][MOST], real x[MOST])
{
  for (int r = 0; r < n; r++) x[r] = r == 0;
  for (int c = 0; c < n; c++) {
    int p = c;
    for (int r = c + 1; r < n; r++)
      if (fabsl(A[r][c]) > fabsl(A[p][c])) p = r;
    for (int k = 0; k < n; k++) {
      real t = A[c][k];
      A[c][k] = A[p][k], A[p][k] = t;
    }
    real t = x[c];
    x[c] = x[p], x[p] = t;
    for (int r = c + 1; r < n; r++) {
      real f = A[r][c] / A[c][c];
      for (int k = c; k < n; k++) A[r][k] -= f * A[c][k];
      x[r] -= f * x[c];
    }
  }
  for (int r = n - 1; r >= 0; r--) {
    for (int k = r + 1; k < n; k++) x[r] -= A[r][k] * x[k];
    x[r] /= A[r][r];
  }
}

/* Is C - shift I positive definite?  By its leading minors. */
static int positive(int dim, real C[3][3], real shift)
{
  real a = C[0][0] - shift, b = C[1][1] - shift, c = C[2][2] - shift;
  if (a <= 0) return 0;
  if (dim > 1 && a * b - C[0][1] * C[0][1] <= 0) return 0;
  return dim < 3 || a * (b * c - C[1][2] * C[1][2]) - C[0][1] * (C[0][1] * c - C[1][2] * C[0][2]) +
                            C[0][2] * (C[0][1] * C[1][2] - b * C[0][2]) >
                        0;
}

static int same_fluid(const oracle *o, long i, long j)
{
  const oracle_group *a = &o->group[o->particle[i].group], *b = &o->group[o->particle[j].group];
  return !a->dust && !b->dust && a->eos.rho0 == b->eos.rho0 && a->eos.c0 == b->eos.c0;
}

/* p = (1, r_ij/h), W; 0: too far. */
static int basis(const oracle *o, long i, long j, real p[MOST], real *W)
{
  real r2 = 0;
  p[0] = 1;
  for (int d = 0; d < o->dim; d++) {
    real r = o->particle[i].x[d] - o->particle[j].x[d];
    if (o->periodic[d]) r -= o->length[d] * roundl(r / o->length[d]);
    p[1 + d] = r / o->h;
    r2 += r * r;
  }
  *W = oracle_w(o, sqrtl(r2));
  return *W > 0;
}

/* rho_i = sum m_j (b0 + b.r_ij) W_ij, the size of what is added, and which of both it was; -1: the
 * spread is at the limit. */
static int expected(const oracle *o, long i, int mls, real *rho, real *size)
{
  const int n = o->dim + 1;
  real A[MOST][MOST] = {{0}}, C[3][3] = {{0}}, b[MOST] = {0}, p[MOST], W;
  for (long j = 0; j < o->n; j++) {
    if (!same_fluid(o, i, j) || !basis(o, i, j, p, &W)) continue;
    for (int r = 0; r < n; r++)
      for (int c = 0; c < n; c++)
        A[r][c] += o->particle[j].m / o->particle[j].rho * W * p[r] * p[c];
  }
  for (int r = 0; r < o->dim; r++)
    for (int c = 0; c < o->dim; c++)
      C[r][c] = A[1 + r][1 + c] / A[0][0] - A[0][1 + r] * A[0][1 + c] / (A[0][0] * A[0][0]);
  if (positive(o->dim, C, 0.02L + 1e-9L) != positive(o->dim, C, 0.02L - 1e-9L)) return -1;
  mls = mls && positive(o->dim, C, 0.02L);
  b[0] = 1 / A[0][0];
  if (mls) solve(n, A, b);
  *rho = *size = 0;
  for (long j = 0; j < o->n; j++) {
    if (!same_fluid(o, i, j) || !basis(o, i, j, p, &W)) continue;
    real sum = 0, part = 0;
    for (int r = 0; r < n; r++) sum += b[r] * p[r], part += fabsl(b[r] * p[r]);
    *rho += o->particle[j].m * W * sum;
    *size += o->particle[j].m * W * part;
  }
  return mls;
}

static double one_scene(int k, int mls, long count[2])
{
  scene_def def = {.dim = 1 + k % 3,
                   .kernel = k % ORACLE_KERNELS,
                   .fluids = 1 + k % 2,
                   .dusts = k % 5 == 2,
                   .thermal = k % 7 == 3,
                   .random = 1,
                   .walls = k / 2 % 3,
                   .seed = (unsigned long)(500 + k)};
  def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : 9;
  def.periodic[0] = def.dim > 1 && k % 4 == 1;
  scene s;
  scene_make(&s, &def);
  s.o.continuity = s.o.pressure = ORACLE_C2;
  oracle_evaluate(&s.o);
  sph_sim *sim = scene_sim(&s, (scene_options){.isa = k % 2 ? NULL : "reference"});
  sph_sim_set_integrator(sim, &no_time);
  sph_sim_reset_density(sim, mls ? "mls" : "shepard", 1);
  step(sim);
  scene_rates now = scene_evaluate(&s, sim);
  double worst = 0;
  for (long i = 0; i < s.o.n; i++) {
    const oracle_group *group = &s.o.group[s.o.particle[i].group];
    real rho, size;
    if (group->wall) continue;
    if (group->dust) assert_true(now.rho[i] == (double)s.o.particle[i].rho);
    int which = group->dust ? -1 : expected(&s.o, i, mls, &rho, &size);
    if (which < 0) continue;
    count[which]++;
    double off = (double)(fabsl(now.rho[i] - rho) / size);
    if (!(off <= worst)) worst = off;
  }
  scene_rates_free(&now);
  sph_sim_free(sim);
  scene_free(&s);
  return worst;
}

static void definition(void **state)
{
  (void)state;
  long shepard[2] = {0}, mls[2] = {0};
  double worst = 0;
  for (int k = 0; k < 24; k++) {
    worst = fmax(worst, one_scene(k, 0, shepard));
    worst = fmax(worst, one_scene(k, 1, mls));
  }
  print_message("# %ld mls, %ld where it falls back; largest error: %.2g of size\n", mls[1], mls[0],
                worst);
  assert_true(worst <= 1e-13);
  assert_true(mls[1] > 1000 && mls[0] > 20);
  assert_true(shepard[0] == mls[0] + mls[1]);
}

/* ---- runs ---- */

/* Water in a periodic box, at rest but for noise of its density; kind NULL: no reset.  The rms of
 * what is left of it. */
static double noise(const char *kind, int threads, double *rho_out)
{
  enum { ACROSS = 24 };
  unsigned long dice = 5;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = 1.0 / ACROSS, .threads = threads, .periodic = {1, 1}, .length = {1, 1}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog", .dt_fixed = 1e-3});
  if (kind) sph_sim_reset_density(sim, kind, 10);
  const long n = sph_group_count(water);
  double *rho = sph_group_write(water, "density", 0), mean = 0, sum = 0;
  for (long i = 0; i < n; i++) rho[i] *= 1 + 0.01 * (scene_random(&dice) - 0.5);
  for (int k = 0; k < 45; k++) step(sim);
  const double *now = sph_group_read(water, "density", 0);
  for (long i = 0; i < n; i++) mean += now[i] / (double)n;
  for (long i = 0; i < n; i++) sum += (now[i] - mean) * (now[i] - mean);
  if (rho_out) memcpy(rho_out, now, (size_t)n * sizeof *now);
  sph_balance balance;
  sph_sim_balance(sim, &balance);
  assert_near(balance.mass, 1000, 1e-9);
  for (int d = 0; d < 2; d++) assert_near(balance.momentum[d], 0, 1e-10);
  sph_sim_free(sim);
  return sqrt(sum / (double)n) / 1000;
}

/* Sound spreads noise and keeps its energy; resets take it out. */
static void less_noise(void **state)
{
  (void)state;
  double without = noise(NULL, 1, NULL), shepard = noise("shepard", 1, NULL);
  double mls = noise("mls", 1, NULL);
  print_message("# rms of the noise of density: %.2g, shepard %.2g, mls %.2g\n", without, shepard,
                mls);
  assert_true(without > 1e-3);
  assert_true(shepard < 0.3 * without && mls < 0.3 * without);
}

static void any_threads(void **state)
{
  (void)state;
  static double one[24 * 24], other[24 * 24];
  noise("mls", 1, one);
  for (int threads = 2; threads <= 3; threads++) {
    noise("mls", threads, other);
    assert_memory_equal(one, other, sizeof one);
  }
}

/* ---- errors ---- */

static void refused(void **state)
{
  (void)state;
  static const struct {
    const char *kind;
    long steps;
    int twice, summed;
    const char *text;
  } wrong[] = {{"mlss", 30, 0, 0, "kind \"mlss\"; known: shepard, mls"},
               {NULL, 30, 0, 0, "known: shepard, mls"},
               {"mls", 0, 0, 0, "steps = 0"},
               {"mls", -3, 0, 0, "steps = -3"},
               {"shepard", 5, 1, 0, "added twice"},
               {"mls", 5, 0, 1, "sum over neighbours already"}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
    for (int late = 0; late <= wrong[k].summed; late++) {
      sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.1});
      sph_group *water = sph_group_box(sim, "water", (double[]){0}, (double[]){1}, 1000);
      sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
      sph_sim_add_term(sim, wrong[k].summed ? sph_term_summation(1) : sph_term_continuity());
      sph_sim_add_term(sim, sph_term_pressure_form(wrong[k].summed ? "s" : "c2"));
      if (late) assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
      sph_sim_reset_density(sim, wrong[k].kind, wrong[k].steps);
      if (wrong[k].twice) sph_sim_reset_density(sim, wrong[k].kind, wrong[k].steps);
      assert_int_equal(sph_sim_run(sim, 0.01), SPH_ERR_ARGUMENT);
      if (!strstr(sph_sim_error(sim), wrong[k].text)) fail_msg("%s", sph_sim_error(sim));
      sph_sim_free(sim);
    }
  sph_sim_reset_density(NULL, "mls", 30);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact),       cmocka_unit_test(definition), cmocka_unit_test(less_noise),
      cmocka_unit_test(any_threads), cmocka_unit_test(refused),
  };
  return cmocka_run_group_tests_name("density resets", tests, NULL, NULL);
}
