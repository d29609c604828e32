/* The switches of artificial viscosity: against a brute force in long double; what they leave as it
 * was (momentum, heating >= 0, the same bits); and where the answer is known: a uniform flow, a
 * uniform compression, a shear flow. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "balance.h"
#include "near.h"
#include "quick.h"

/* ---- against the brute force ---- */

enum { MIXES = 5 };

/* Switches number `mix` of one of the two viscosities, alpha anywhere between its bounds. */
static void choose(scene *s, int mix, int signal, unsigned long seed)
{
  oracle *o = &s->o;
  unsigned long state = seed;
  o->continuity = o->pressure = mix % 2 ? ORACLE_C1 : ORACLE_C2;
  if (signal)
    o->signal_alpha = 1.5, o->signal_beta = 3;
  else
    o->alpha = 1.5, o->beta = 2;
  o->balsara = mix % 2 == 0;
  o->varied = (enum oracle_alpha)((mix + 1) / 2);
  o->alpha_min = 0.1;
  for (int k = 0; k < o->dim; k++) o->g[k] = k ? -9.81 : 2.5;
  for (long i = 0; i < o->n; i++) o->particle[i].alpha = 0.1 + 1.4 * scene_random(&state);
}

typedef struct worst {
  double a, du, dalpha;
} worst;

static void same(const char *what, long i, double found, real right, real size, double *most)
{
  const double error = (double)(fabsl(found - right) / size);
  *most = fmax(*most, error);
  if (!(error <= 1e-14))
    fail_msg("%s of particle %ld: %.17g, oracle %.17Lg, error %g of size %Lg", what, i, found,
             right, error, size);
}

static void compare(scene *s, worst *w)
{
  sph_sim *sim = scene_sim(s, (scene_options){0});
  scene_rates r = scene_evaluate(s, sim);
  oracle_evaluate(&s->o);
  for (long i = 0; i < s->o.n; i++) {
    const oracle_particle *it = &s->o.particle[i];
    if (s->o.group[it->group].wall || s->o.group[it->group].dust) continue;
    for (int k = 0; k < s->o.dim; k++) same("a", i, r.a[k][i], it->a[k], it->a_size, &w->a);
    if (s->thermal) same("du", i, r.du[i], it->du, it->du_size, &w->du);
    if (s->o.varied) same("dalpha", i, r.dalpha[i], it->dalpha, it->dalpha_size, &w->dalpha);
  }
  scene_rates_free(&r);
  sph_sim_free(sim);
}

static void brute_force(void **state)
{
  (void)state;
  worst w = {0};
  for (int k = 0; k < 4 * MIXES; k++) {
    scene_def def = {.dim = 1 + k % 3,
                     .kernel = k % ORACLE_KERNELS,
                     .random = k % 2,
                     .walls = k % 4 == 1 ? 2 : 0,
                     .no_slip = k % 8 == 1,
                     .dusts = k % 5 == 4,
                     .thermal = k % 3 != 2,
                     .fluids = 1 + k % 2,
                     .seed = (unsigned long)(300 + k)};
    scene s;
    def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : def.walls ? 9 : 8;
    def.periodic[0] = def.dim > 1 && k % 7 < 3;
    scene_make(&s, &def);
    choose(&s, k % MIXES, k / MIXES % 2, def.seed);
    compare(&s, &w);
    scene_free(&s);
  }
  print_message("# largest errors over size: a %.2g, du %.2g, dalpha %.2g\n", w.a, w.du, w.dalpha);
}

/* ---- what stays ---- */

/* Sums of m a vanish; with nothing but this viscosity each particle is heated. */
static void dissipates(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, 1);
    scene s;
    scene_make(&s, &def);
    choose(&s, k % MIXES, k % 2, def.seed);
    s.o.continuity = s.o.pressure = ORACLE_NONE;
    for (int d = 0; d < 3; d++) s.o.g[d] = 0;
    sph_sim *sim = scene_sim(&s, (scene_options){0});
    scene_rates r = scene_evaluate(&s, sim);
    balance energy = {0, 0};
    assert_momentum(&s, &r);
    for (long i = 0; i < r.n; i++) {
      assert_true(r.du[i] >= 0);
      add(&energy, power_of(&s, &r, i));
      add(&energy, s.o.particle[i].m * r.du[i]);
    }
    assert_zero(&energy, 1e-14, "sum m (v.a + du/dt)");
    scene_rates_free(&r);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

static void same_bits(void **state)
{
  (void)state;
  for (int mix = 0; mix < MIXES; mix++) {
    scene_def def = {.dim = 2, .n = 90, .thermal = 1, .fluids = 2, .seed = 5, .periodic = {1, 1}};
    scene s;
    scene_make(&s, &def);
    choose(&s, mix, 0, 7);
    scene_rates first = {0};
    for (int threads = 1; threads <= 3; threads++) {
      sph_sim *sim = scene_sim(&s, (scene_options){.threads = threads});
      scene_rates r = scene_evaluate(&s, sim);
      if (threads > 1) assert_true(scene_rates_same(&first, &r));
      if (threads > 1) scene_rates_free(&r);
      if (threads == 1) first = r;
      sph_sim_free(sim);
    }
    scene_rates_free(&first);
    scene_free(&s);
  }
}

/* ---- known answers ---- */

static const double gamma_gas = 1.4, u0 = 2.5; /* c = sqrt(1.4) */

/* A periodic box of gas on which only this viscosity acts. */
static sph_sim *gas_box(int n, sph_term viscosity, sph_group **gas)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = 1.0 / n, .h_over_dx = 2, .periodic = {1, 1}, .length = {1, 1}, .speed = 1});
  *gas = sph_group_box(sim, "gas", (double[]){0, 0}, (double[]){1, 1}, 1);
  sph_group_set_eos(*gas, sph_eos_ideal_gas(gamma_gas));
  sph_sim_add_term(sim, viscosity);
  double *u = sph_group_write(*gas, "energy", 0);
  assert_string_equal(sph_sim_error(sim), "");
  for (long i = 0; i < sph_group_count(*gas); i++) u[i] = u0;
  return sim;
}

static double sound(void) { return sqrt(gamma_gas * (gamma_gas - 1) * u0); }

/* In a uniform flow alpha decays exponentially: rate 0.2 c/h, or c/(10 h), c that is v_sig. */
static void decays(void **state)
{
  (void)state;
  static const char *const name[] = {"morris-monaghan", "cullen-dehnen"};
  static const double factor[] = {0.2, 0.1};
  for (int k = 0; k < 2; k++) {
    sph_group *gas;
    sph_term viscosity = sph_term_switched(sph_term_viscosity_artificial(2, 4), name[k], 0.1);
    sph_sim *sim = gas_box(12, viscosity, &gas);
    double *alpha = sph_group_write(gas, "alpha", 0), *v = sph_group_write(gas, "velocity", 0);
    for (long i = 0; i < sph_group_count(gas); i++) alpha[i] = 1.9, v[i] = 0.3;
    sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "erk:bogacki-shampine-4-2-3",
                                                      .dt_fixed = 5e-3});
    assert_int_equal(sph_sim_run(sim, 0.5), SPH_OK);
    const double right = 0.1 + 1.8 * exp(-factor[k] * sound() / sph_sim_h(sim) * 0.5);
    const double *found = sph_group_read(gas, "alpha", 0);
    assert_true(right < 1.6);
    for (long i = 0; i < sph_group_count(gas); i++) assert_near(found[i], right, 1e-7);
    sph_sim_free(sim);
  }
}

/* v = -H x and a = -w^2 x: div v = -d H, d(div v)/dt = -d (w^2 + H^2), no shear; inside, the
 * farthest neighbour tells v_sig. */
static void compression(void **state)
{
  (void)state;
  const double H = 0.7, w = 1.3, alpha_max = 1.5, alpha_now = 0.3;
  for (int k = 0; k < 6; k++) {
    const int dim = 1 + k / 2, varied = k % 2, n = 18;
    sph_group *gas;
    sph_term viscosity =
        sph_term_switched(sph_term_viscosity_artificial(alpha_max, 0),
                          varied ? "cullen-dehnen" : "morris-monaghan", varied ? 0 : 0.1);
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = dim, .dx = 1.0 / n, .h_over_dx = 2});
    gas = sph_group_box(sim, "gas", (double[]){0, 0, 0}, (double[]){1, 1, 1}, 1);
    sph_group_set_eos(gas, sph_eos_linear(1, 2, -INFINITY));
    sph_sim_add_term(sim, viscosity);
    sph_sim_add_term(sim, sph_term_harmonic(w));
    double *alpha = sph_group_write(gas, "alpha", 0);
    for (long i = 0; i < sph_group_count(gas); i++) alpha[i] = alpha_now;
    for (int d = 0; d < dim; d++) {
      const double *x = sph_group_read(gas, "position", d);
      double *v = sph_group_write(gas, "velocity", d);
      for (long i = 0; i < sph_group_count(gas); i++) v[i] = -H * x[i];
    }
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    const double h = sph_sim_h(sim), dx = 1.0 / n, c = 2;
    /* |r| < 2 h = 4 dx on the lattice: the farthest is (3, 2, 1) dx in 3D, (3, 2) dx in 2D. */
    const double far = dx * (dim == 1 ? 3 : dim == 2 ? sqrt(13) : sqrt(14));
    const double v_sig = c + H * far, A = dim * (w * w + H * H);
    const double local = alpha_max * h * h * A / (v_sig * v_sig + h * h * A);
    double right = 0.2 * c / h * (0.1 - alpha_now) + dim * H * (alpha_max - alpha_now);
    if (varied) right = (local - alpha_now) * v_sig / h * (local > alpha_now ? 10 : 0.1);
    const double *rate = sph_group_rate(gas, "alpha", 0), *x[3];
    long inside = 0;
    for (int d = 0; d < dim; d++) x[d] = sph_group_read(gas, "position", d);
    for (long i = 0; i < sph_group_count(gas); i++) {
      double edge = 1;
      for (int d = 0; d < dim; d++) edge = fmin(edge, fmin(x[d][i], 1 - x[d][i]));
      if (edge < 8 * dx) continue;
      assert_near(rate[i], right, 1e-9 * fabs(right));
      inside++;
    }
    assert_true(inside > 0);
    sph_sim_free(sim);
  }
}

/* Heating of v_x = sin(2 pi y), on disordered particles, by a viscosity with these switches. */
static double heating(const char *switches)
{
  sph_group *gas;
  sph_term viscosity = sph_term_switched(sph_term_viscosity_artificial(1, 2), switches, 0);
  sph_sim *sim = gas_box(40, viscosity, &gas);
  sph_group_jitter(gas, 0.1, 1);
  const double *y = sph_group_read(gas, "position", 1);
  double *v = sph_group_write(gas, "velocity", 0), heat = 0;
  for (long i = 0; i < sph_group_count(gas); i++) v[i] = sin(6.283185307179586 * y[i]);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  const double *m = sph_group_read(gas, "mass", 0), *du = sph_group_rate(gas, "energy", 0);
  for (long i = 0; i < sph_group_count(gas); i++) heat += m[i] * du[i];
  sph_sim_free(sim);
  return heat;
}

/* Without a switch shear is braked as by nu = alpha h c/16 (half of the pairs approach) and more,
 * by beta; Balsara's factor leaves what disorder makes of div v. */
static void shear(void **state)
{
  (void)state;
  const double none = heating("none"), balsara = heating("balsara");
  const double expected = 2.0 / 40 * sound() / 16 * 39.47841760435743 / 2; /* nu k^2 <v^2> */
  print_message("# heating of a shear flow: %.3f of alpha h c/16, with balsara %.4f of that\n",
                none / expected, balsara / none);
  assert_true(none > expected && none < 2 * expected);
  assert_true(balsara > 0 && balsara <= 0.05 * none);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(brute_force), cmocka_unit_test(dissipates),
                                     cmocka_unit_test(same_bits),   cmocka_unit_test(decays),
                                     cmocka_unit_test(compression), cmocka_unit_test(shear)};
  return cmocka_run_group_tests_name("switches", tests, NULL, NULL);
}
