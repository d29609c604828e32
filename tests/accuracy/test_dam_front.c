/* A column of water a wide and 2a high falls: its front against the experiments of Martin & Moyce
 * (1952) and of Koshizuka & Oka (1996), up to T = t sqrt(2g/a) = 3.2.
 *
 * H = 2a, H/dx = 40 and 80 (SPHODE_TEST_LONG=1: and 160).  An experiment may start late: one offset
 * 0 <= T0 <= 0.5 each, the one that fits best.  Error: root mean square of z(T - T0) - z_exp over
 * (largest z_exp - 1), z = front/a.  The three experiments differ among themselves by 5 %.  Front:
 * largest x with 3 neighbours within 2 dx, + dx/2. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

enum { FRAMES = 160, POINTS = 100 };
static const double a = 1, g = 1, rho0 = 1000, T_end = 3.2; /* [m], [m/s^2], [kg/m^3] */

static sph_sim *dam(int n)
{
  const double H = 2 * a, dx = H / n, c0 = 10 * sqrt(2 * g * H);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = 1.5});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){a, H}, rho0);
  sph_group *walls = sph_group_create(sim, "walls", "wall");
  sph_group_add_layers(walls, (double[]){0, 0}, (double[]){6 * a, 1.25 * H}, "y+", rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  sph_group_set_boundary(walls, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -g, 0}));
  sph_group_set_hydrostatic(water, 1, H, g);
  return sim;
}

/* z at T = T_end k/FRAMES. */
static void run(int n, double z[FRAMES + 1])
{
  sph_sim *sim = dam(n);
  const sph_monitor front = {.name = "front", .type = "front", .group = "water", .axis = 0};
  sph_error error = {0};
  for (int k = 0; k <= FRAMES; k++) {
    double t = T_end * k / FRAMES / sqrt(2 * g / a);
    if (k > 0 && sph_sim_run(sim, t) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
    if (sph_monitor_value(&front, sim, &z[k], &error) != SPH_OK) fail_msg("%s", error.text);
    z[k] /= a;
  }
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  print_message("# H/dx = %d: %ld steps, %.1f s\n", n, stats.step.steps, stats.seconds);
  sph_sim_free(sim);
}

static double at(const double z[FRAMES + 1], double T)
{
  double k = fmin(fmax(T / T_end * FRAMES, 0), FRAMES - 1e-9), w = k - floor(k);
  return (1 - w) * z[(int)k] + w * z[(int)k + 1];
}

/* Rows "T,z" of a published table that the run reaches with any offset. */
static int read_table(const char *name, double T[POINTS], double z[POINTS])
{
  char path[1000], line[400];
  const char *source = getenv("SRCDIR");
  snprintf(path, sizeof path, "%s/data/%s", source ? source : ".", name);
  FILE *file = fopen(path, "r");
  if (!file) fail_msg("cannot read %s", path);
  int n = 0;
  while (n < POINTS && fgets(line, sizeof line, file))
    if (sscanf(line, "%lf,%lf", &T[n], &z[n]) == 2 && T[n] <= T_end) n++;
  fclose(file);
  return n;
}

static double error_with_offset(const double z[FRAMES + 1], int n, const double *T_exp,
                                const double *z_exp, double T0)
{
  double sum = 0, largest = 1;
  for (int k = 0; k < n; k++) {
    double e = at(z, T_exp[k] - T0) - z_exp[k];
    sum += e * e / n;
    largest = fmax(largest, z_exp[k]);
  }
  return sqrt(sum) / (largest - 1);
}

static void compare(const double z[FRAMES + 1], const char *name, double bar)
{
  double T_exp[POINTS], z_exp[POINTS], best = INFINITY, offset = 0;
  int n = read_table(name, T_exp, z_exp);
  assert_in_range(n, 4, POINTS);
  for (int k = 0; k <= 50; k++) {
    double error = error_with_offset(z, n, T_exp, z_exp, 0.01 * k);
    if (error < best) best = error, offset = 0.01 * k;
  }
  print_message("# %s: %.2f %% (bar %.1f %%) with offset %.2f; %.2f %% without; %d points\n", name,
                100 * best, 100 * bar, offset, 100 * error_with_offset(z, n, T_exp, z_exp, 0), n);
  assert_true(best <= bar);
}

static void front(void **state)
{
  (void)state;
  double coarse[FRAMES + 1], z[FRAMES + 1], fine[FRAMES + 1];
  run(40, coarse);
  run(80, z);
  print_message("# z(T = 2) = %.3f, %.3f\n", at(coarse, 2), at(z, 2));
  compare(z, "martin_moyce_1952_a2.25in.csv", 0.02);
  compare(z, "martin_moyce_1952_a1.125in.csv", 0.06);
  compare(z, "koshizuka_oka_1996.csv", 0.06);
  assert_true(fabs(at(coarse, 2) - 2.66) <= 0.08);
  assert_true(fabs(at(z, 2) - 2.66) <= 0.02); /* what finer ones tend to */
  if (!getenv("SPHODE_TEST_LONG")) return;
  run(160, fine);
  print_message("# z(T = 2) = %.3f at H/dx = 160\n", at(fine, 2));
  assert_true(fabs(at(fine, 2) - at(z, 2)) < fabs(at(z, 2) - at(coarse, 2)));
  assert_true(fabs(at(fine, 2) - 2.66) <= 0.02);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(front)};
  return cmocka_run_group_tests_name("dam front", tests, NULL, NULL);
}
