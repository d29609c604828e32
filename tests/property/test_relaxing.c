/* The energy that relaxation keeps, of particles: its derivative against differences, its drift
 * over hundreds of steps; and what the simulation refuses to multirate, symplectic, stabilised
 * schemes and to relaxation, with the reason. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sim_data.h"
#include "sim_relax.h"
#include "sphode.h"
#include "sphode/sundials.h"

enum { ACROSS = 16 };
static const double pi = 3.14159265358979323846;

/* Terms and groups of a box in 2D. */
enum {
  GAS = 1,    /* ideal gas, else a liquid */
  HEAT = 2,   /* a liquid carries u along */
  BODIES = 4, /* gravity and a harmonic force, else periodic */
  TOTAL = 8,  /* the gas integrates u + v^2/2 */
  ARTIFICIAL = 16,
  LAMINAR = 32,
  SUMMED = 64,
  ROUGH = 128 /* noise in everything, else smooth */
};

static double noise(long k) { return sin(1 + 12.9898 * (double)k * (double)(k % 7 + 1)); }

static sph_sim *make(unsigned what, const sph_integrator_def *def)
{
  const double dx = 1.0 / ACROSS;
  const int periodic = !(what & BODIES);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = dx,
                                               .speed = 1,
                                               .periodic = {periodic, periodic},
                                               .length = {periodic, periodic}});
  sph_group *box = sph_group_box(sim, "box", (double[]){0, 0}, (double[]){1, 1}, 2);
  sph_group_set_eos(box, what & GAS ? sph_eos_ideal_gas(1.4) : sph_eos_tait(2, 10, 7));
  if (what & HEAT) sph_group_set_energy(box, "u");
  if (what & TOTAL) sph_group_set_energy(box, "total");
  sph_sim_add_term(sim, what & SUMMED ? sph_term_summation(0) : sph_term_continuity());
  sph_sim_add_term(sim, what & SUMMED ? sph_term_pressure_form("s") : sph_term_pressure());
  if (what & ARTIFICIAL) sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  if (what & LAMINAR) {
    sph_group_set_viscosity(box, 0.01);
    sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  }
  if (what & BODIES) {
    sph_sim_add_term(sim, sph_term_gravity((double[3]){0.3, -1, 0}));
    sph_sim_add_term(sim, sph_term_harmonic(2));
  }
  const double rough = what & ROUGH ? 1 : 0;
  double *x = sph_group_write(box, "position", 0), *y = sph_group_write(box, "position", 1);
  double *vx = sph_group_write(box, "velocity", 0), *vy = sph_group_write(box, "velocity", 1);
  double *rho = what & SUMMED ? NULL : sph_group_write(box, "density", 0);
  double *u = what & (GAS | HEAT) ? sph_group_write(box, "energy", 0) : NULL;
  for (long i = 0; x && y && vx && vy && i < sph_group_count(box); i++) {
    double a = 2 * pi * x[i], b = 2 * pi * y[i];
    vx[i] = 0.1 * (sin(a) * cos(b) + rough * noise(3 * i));
    vy[i] = 0.1 * (-cos(a) * sin(b) + 0.5 * cos(a));
    x[i] += 0.02 * dx * (sin(b) + rough * noise(i));
    y[i] += 0.02 * dx * cos(a + b);
    if (rho) rho[i] *= 1 + 1e-3 * (cos(a) + rough * noise(i + 7));
    if (u) u[i] = 2 + 0.02 * (sin(a) + rough * noise(2 * i));
  }
  if (def) sph_sim_set_integrator(sim, def);
  return sim;
}

/* Between two states near each other against <dE/dy, change>, field by field; between any two
 * against the balance. */
static void gradient_is_that_of_the_energy(void **state)
{
  static const unsigned scene[] = {GAS,           GAS | BODIES,        0, BODIES, HEAT,
                                   HEAT | BODIES, GAS | TOTAL | BODIES};
  (void)state;
  for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
    sph_sim *sim = make(scene[k] | ROUGH, NULL);
    N_Vector y = sph_sim_vector(sim);
    if (!y) fail_msg("%s", sph_sim_error(sim));
    N_Vector slope = N_VClone(y), change = N_VClone(y), below = N_VClone(y), above = N_VClone(y);
    double difference, rounding;
    assert_int_equal(sph_sim_relax_gradient(y, slope, sim), SPH_OK);
    for (int q = 0; q < sim->layout.segments; q++) { /* each field for itself */
      const sph_segment *s = &sim->layout.segment[q];
      double *d = N_VGetArrayPointer(change);
      const double *at = N_VGetArrayPointer(y);
      N_VConst(0, change);
      for (long i = s->offset; i < s->offset + s->n; i++)
        d[i] = (1 + fabs(at[i])) * noise(i) * 1e-5;
      N_VLinearSum(1, y, -0.5, change, below);
      N_VLinearSum(1, y, 0.5, change, above);
      assert_int_equal(sph_sim_relax_energy(below, above, &difference, &rounding, sim), SPH_OK);
      double product = N_VDotProd(slope, change);
      if (!(fabs(difference - product) <= 1e-6 * fabs(difference) + rounding))
        fail_msg("scene %zu, segment %d (role %d): %.9g, not %.9g", k, q, s->role, product,
                 difference);
    }
    sph_balance balance[2];
    N_VScale(1.01, y, above);
    assert_int_equal(sph_sim_relax_energy(y, above, &difference, &rounding, sim), SPH_OK);
    sph_sim_balance(sim, &balance[0]);
    assert_int_equal(sph_sim_set_vector(sim, 0, above), SPH_OK);
    sph_sim_balance(sim, &balance[1]);
    double expected = balance[1].total - balance[0].total;
    double size = balance[1].kinetic + fabs(balance[1].internal) + fabs(balance[1].potential);
    if (!(fabs(difference - expected) <= 1e-13 * size && rounding < 1e-14 * size))
      fail_msg("scene %zu: %.15g, not %.15g; rounding %.2g", k, difference, expected, rounding);
    N_VDestroy(slope);
    N_VDestroy(change);
    N_VDestroy(below);
    N_VDestroy(above);
    sph_sim_free(sim);
  }
}

static int have_it(void)
{
  sph_sim *sim = make(GAS, &(sph_integrator_def){.relax = "energy"});
  int status = sph_sim_status(sim);
  if (status) print_message("# skipped: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  if (status) assert_int_equal(status, SPH_ERR_UNBUILT);
  return !status;
}

static double drift(unsigned what, const char *method, const char *relax)
{
  enum { STEPS = 300 };
  sph_sim *sim =
      make(what, &(sph_integrator_def){.method = method,
                                       .relax = relax,
                                       .dt_fixed = 1.5 / ACROSS / (what & GAS ? 1.1 : 20)});
  sph_balance first, last;
  sph_sim_evaluate(sim);
  sph_sim_balance(sim, &first);
  double most = 0;
  for (int step = 0; step < STEPS; step++) {
    if (sph_sim_step(sim)) fail_msg("%s: %s", method, sph_sim_error(sim));
    if (step % 10) continue;
    sph_sim_balance(sim, &last);
    most = fmax(most, fabs(last.total - first.total));
  }
  sph_sim_free(sim);
  return most / first.kinetic;
}

/* All heat is counted: u takes what viscosity takes from the motion. */
static void energy_is_kept(void **state)
{
  static const unsigned scene[] = {GAS, GAS | ARTIFICIAL | LAMINAR, 0, BODIES,
                                   HEAT | ARTIFICIAL | LAMINAR};
  static const char *const method[] = {"erk:bogacki-shampine-4-2-3", "erk:zonneveld-5-3-4"};
  (void)state;
  if (!have_it()) return;
  for (size_t k = 0; k < 2 * sizeof scene / sizeof *scene; k++) {
    double free = drift(scene[k / 2], method[k % 2], NULL);
    double relaxed = drift(scene[k / 2], method[k % 2], "energy");
    print_message("# scene %zu, %s: %.1e of the motion, relaxed %.1e\n", k / 2, method[k % 2], free,
                  relaxed);
    if (!(relaxed < 1e-12 && free > 30 * relaxed)) fail_msg("scene %zu: %.1e", k / 2, relaxed);
  }
}

/* ---- refusals */

static void refused(unsigned what, const sph_integrator_def *def, const char *text)
{
  sph_sim *sim = make(what, def);
  int status = sph_sim_step(sim);
  if (status == SPH_ERR_UNBUILT)
    print_message("# %s\n", sph_sim_error(sim));
  else if (status != SPH_ERR_ARGUMENT || !strstr(sph_sim_error(sim), text))
    fail_msg("%d \"%s\" lacks \"%s\"", status, sph_sim_error(sim), text);
  sph_sim_free(sim);
}

static void misfits_are_refused_with_a_reason(void **state)
{
  const sph_integrator_def sprk = {.method = "sprk:leapfrog-2-2"}, rkc = {.method = "lsrk:rkc-2"};
  const sph_integrator_def relax = {.relax = "energy"}, mri = {.method = "mri:kw3"};
  (void)state;
  refused(0, &sprk, "density is to be a sum over neighbours");
  refused(SUMMED | ARTIFICIAL, &sprk, "viscosity-artificial may depend on velocities");
  refused(SUMMED | LAMINAR, &sprk, "viscosity-laminar may depend on velocities");
  refused(SUMMED | GAS, &sprk, "integrates an energy besides");
  refused(SUMMED, &relax, "sum over neighbours here");
  refused(GAS | TOTAL, &relax, "each step keeps the sum");
  refused(0, &mri, "needs fast terms");
  for (int k = 0; k < 2; k++) {
    sph_sim *sim = make(GAS, &rkc);
    if (sph_sim_status(sim) == SPH_ERR_UNBUILT) {
      print_message("# %s\n", sph_sim_error(sim));
      sph_sim_free(sim);
      break;
    }
    sph_sim_add_term(sim,
                     k ? sph_term_viscosity_signal(1, 3) : sph_term_conductivity_artificial(1));
    assert_int_equal(sph_sim_step(sim), SPH_ERR_ARGUMENT);
    assert_non_null(strstr(sph_sim_error(sim),
                           k ? "none of viscosity-signal" : "none of conductivity-artificial"));
    sph_sim_free(sim);
  }
}

/* ---- symplectic schemes on particles */

/* A Hamiltonian system: pressure of a summed density.  The energy of a scheme of order 4 is within
 * 1e-6 for good, and comes back. */
static void symplectic_schemes_keep_the_energy(void **state)
{
  (void)state;
  sph_integrator_info info;
  int tried = 0;
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (!(info.wants & SPH_WANTS_SEPARABLE) || info.stages > 8) continue;
    sph_sim *sim = make(SUMMED, &(sph_integrator_def){.method = info.name, .dt_fixed = 2e-3});
    double worst[2] = {0, 0};
    sph_balance first, now;
    sph_sim_evaluate(sim);
    sph_sim_balance(sim, &first);
    for (int step = 0; step < 400; step++) {
      if (sph_sim_step(sim)) fail_msg("%s: %s", info.name, sph_sim_error(sim));
      sph_sim_balance(sim, &now);
      double *w = &worst[step / 200];
      *w = fmax(*w, fabs(now.total - first.total) / (first.kinetic + first.internal));
    }
    print_message("# %s: energy within %.1e, then %.1e\n", info.name, worst[0], worst[1]);
    if (!(worst[1] < 3 * worst[0] + 1e-9 && worst[1] < (info.order < 2   ? 0.1
                                                        : info.order < 4 ? 1e-2
                                                                         : 1e-3)))
      fail_msg("%s: energy off by %.1e, %.1e", info.name, worst[0], worst[1]);
    sph_sim_free(sim);
    tried++;
  }
  if (!tried) refused(SUMMED, &(sph_integrator_def){.method = "sprk:leapfrog-2-2"}, "");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gradient_is_that_of_the_energy),
      cmocka_unit_test(energy_is_kept),
      cmocka_unit_test(misfits_are_refused_with_a_reason),
      cmocka_unit_test(symplectic_schemes_keep_the_energy),
  };
  return cmocka_run_group_tests_name("relaxing", tests, NULL, NULL);
}
