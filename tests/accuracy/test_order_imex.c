/* The order of implicit-explicit integrators on particles: as tests/accuracy/test_order.c, with
 * laminar viscosity as the implicit part, its largest rate (lattice: 6.5 nu/h^2) 0.26 and 10 times
 * that of sound (1.1 c0/h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "sphode.h"

enum { ACROSS = 16, N = ACROSS * ACROSS, FIELDS = 5 };

static const double c0 = 10, V = 1, T = 0.08, PI = 3.14159265358979323846; /* [m/s], [m/s], [s] */

static void start(sph_group *fluid)
{
  double *x = sph_group_write(fluid, "position", 0), *y = sph_group_write(fluid, "position", 1);
  double *u = sph_group_write(fluid, "velocity", 0), *v = sph_group_write(fluid, "velocity", 1);
  assert_true(x && y && u && v);
  for (int i = 0; i < N; i++) {
    double a = 2 * PI * x[i], b = 2 * PI * y[i];
    u[i] = V * (sin(a) * cos(b) + 0.5 * sin(a + 1));
    v[i] = V * (-cos(a) * sin(b) + 0.3 * cos(2 * b));
    x[i] += 0.05 / ACROSS * sin(3 * a + b); /* off the lattice */
    y[i] += 0.05 / ACROSS * cos(2 * b - a);
  }
}

/* Positions, velocities, density after T, in units of their scales. */
static void run(const char *method, double nu, int steps, double state[FIELDS][N])
{
  static const char *const field[] = {"position", "position", "velocity", "velocity", "density"};
  const double rho0 = 1000, scale[] = {1.0 / ACROSS, 1.0 / ACROSS, V, V, rho0 * V * V / c0 / c0};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = 1.0 / ACROSS,
                                               .kernel = "wendland-c6",
                                               .h_over_dx = 1.8,
                                               .periodic = {1, 1},
                                               .length = {1, 1},
                                               .speed = V});
  sph_group *fluid = sph_group_box(sim, "fluid", (double[]){0, 0}, (double[]){1, 1}, rho0);
  sph_group_set_eos(fluid, sph_eos_tait(rho0, c0, 7));
  sph_group_set_viscosity(fluid, rho0 * nu);
  start(fluid);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method,
                                                    .dt_fixed = T / steps,
                                                    .stage_tolerance = 1e-14});
  if (sph_sim_run(sim, T)) fail_msg("%s: %s", method, sph_sim_error(sim));
  for (int f = 0; f < FIELDS; f++) {
    const double *a = sph_group_read(fluid, field[f], f % 2 && f < 4);
    for (int i = 0; i < N; i++) state[f][i] = a[i] / scale[f];
  }
  sph_sim_free(sim);
}

static double distance(double a[FIELDS][N], double b[FIELDS][N])
{
  double sum = 0;
  for (int f = 0; f < FIELDS; f++)
    for (int i = 0; i < N; i++) sum += pow(a[f][i] - b[f][i], 2);
  return sqrt(sum / (FIELDS * N));
}

static double least = INFINITY; /* order, more than the nominal one */

static void check(const sph_integrator_info *info, double nu, double exact[FIELDS][N])
{
  static double found[FIELDS][N];
  const double h = 1.8 / ACROSS;
  double error[4];
  int n = (nu > 0.1 ? 4 : 1) * (int)ceil(T / (0.5 * info->stability * h / c0));
  for (int j = 0; j < 4; j++) {
    run(info->name, nu, n << j, found);
    error[j] = distance(found, exact);
  }
  double last = log2(error[2] / error[3]), before = log2(error[1] / error[2]);
  print_message("# %-26s order %d: %.2f, %.2f (%d to %d steps, error %.1e to %.1e)\n", info->name,
                info->order, before, last, n, n << 3, error[0], error[3]);
  least = fmin(least, fmax(before, last) - info->order);
  if (!(fmax(before, last) >= info->order - 0.1))
    fail_msg("%s, nu = %g: order %.2f", info->name, nu, last);
}

static void every_pair_has_its_order(void **state)
{
  static const double nu[] = {0.05, 2}; /* [m^2/s] */
  static double exact[FIELDS][N], coarser[FIELDS][N];
  sph_integrator_info info;
  int checked = 0;
  (void)state;
  for (int i = 0; i < 2; i++) {
    int steps = nu[i] > 1 ? 800 : 200;
    run("erk:fehlberg-13-7-8", nu[i], steps, exact);
    run("erk:fehlberg-13-7-8", nu[i], steps / 2, coarser);
    assert_true(distance(coarser, exact) < 1e-12);
    for (int k = 0; sph_integrator_info_get(k, &info); k++) {
      if (!(info.wants & SPH_WANTS_IMPLICIT) || info.order > 4) continue;
      check(&info, nu[i], exact);
      checked++;
    }
  }
  print_message("# least order - nominal: %.2f\n", least);
  assert_true(checked >= 6);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_pair_has_its_order)};
  return cmocka_run_group_tests_name("order_imex", tests, NULL, NULL);
}
