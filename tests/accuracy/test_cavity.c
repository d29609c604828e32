/* Lid-driven cavity, Re = U L/nu = 100: velocities along both centre lines against Ghia, Ghia and
 * Shin (1982), data/ghia_1982_re100_[uv].csv, with corrected gradients, shifting, a background
 * pressure of 0.05 rho0 c0^2 and a lid that slides without being moved.  Means over time, by moving
 * least squares of order 1 from the fluid alone; rms over the points of both lines inside the
 * walls, in U.  20 x 20 particles, which go always, before the flow is steady: at most 0.027;
 * 50 x 50 (SPHODE_TEST_LONG): 0.01, and at Re = 400 0.03. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "csv.h"
#include "long.h"
#include "memory.h"
#include "sphode.h"

static const double L = 1, U = 1, rho0 = 1000, c0 = 10; /* [m], [m/s], [kg/m^3], [m/s] */

/* One line of the reference: points, its velocities, those of the run, summed. */
typedef struct line {
  long n;
  double *at, *value, *sum, *place[2];
  int component;
} line;

static line read_line(const char *name, int component)
{
  char path[1000], title[128];
  const char *source = getenv("SRCDIR");
  line l = {.component = component};
  sph_error error = {0};
  snprintf(path, sizeof path, "%s/data/%s", source ? source : ".", name);
  if (sph_csv_read(path, NULL, 0, &l.at, &l.n, title, &error)) fail_msg("%s", error.text);
  if (sph_csv_read(path, NULL, 1, &l.value, &l.n, title, &error)) fail_msg("%s", error.text);
  l.sum = calloc((size_t)l.n, sizeof *l.sum);
  for (int d = 0; d < 2; d++) {
    l.place[d] = calloc((size_t)l.n, sizeof *l.place[d]);
    for (long i = 0; i < l.n; i++) l.place[d][i] = d == component ? L / 2 : l.at[i] * L;
  }
  return l;
}

static void line_free(line *l)
{
  sph_memory_free(l->at), sph_memory_free(l->value), free(l->sum), free(l->place[0]),
      free(l->place[1]);
}

static void slide(void *ctx, double t, double displacement[3], double velocity[3],
                  double acceleration[3])
{
  (void)ctx, (void)t;
  for (int d = 0; d < 3; d++) displacement[d] = acceleration[d] = velocity[d] = 0;
  velocity[0] = U;
}

static sph_sim *cavity(int n, double Re)
{
  const double dx = L / n, t = 4 * dx; /* of walls */
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = 2, .speed = U});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){L, L}, rho0);
  sph_group *tank = sph_group_create(sim, "tank", "wall");
  sph_group_add_box(tank, (double[]){-t, -t}, (double[]){0, L}, rho0);
  sph_group_add_box(tank, (double[]){0, -t}, (double[]){L, 0}, rho0);
  sph_group_add_box(tank, (double[]){L, -t}, (double[]){L + t, L}, rho0);
  sph_group *lid = sph_group_create(sim, "lid", "wall");
  sph_group_add_box(lid, (double[]){-t, L}, (double[]){L + t, L + t}, rho0);
  sph_eos eos = sph_eos_tait(rho0, c0, 7);
  eos.p_background = 0.05 * rho0 * c0 * c0;
  sph_group_set_eos(water, eos);
  sph_group_set_viscosity(water, rho0 * U * L / Re);
  sph_boundary wall = sph_boundary_adami_no_slip();
  wall.tension = 1;
  sph_group_set_boundary(tank, wall);
  wall.motion = slide;
  sph_group_set_boundary(lid, wall);
  sph_term shifting = sph_term_shifting("fick", U);
  shifting.surface = 0;
  sph_sim_add_term(sim, sph_term_corrected(sph_term_continuity(), "one-sided"));
  sph_sim_add_term(sim, sph_term_corrected(sph_term_pressure(), "mean"));
  sph_sim_add_term(sim, sph_term_corrected(sph_term_viscosity_laminar("morris"), "mean"));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, shifting);
  assert_string_equal(sph_sim_error(sim), "");
  return sim;
}

static void add_sample(const sph_sim *sim, int n, line *lines)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const long many = sph_group_count(water);
  const double *x[2] = {sph_group_read(water, "position", 0), sph_group_read(water, "position", 1)};
  const double *m = sph_group_read(water, "mass", 0), *rho = sph_group_read(water, "density", 0);
  double *volume = malloc((size_t)many * sizeof *volume);
  sph_error error = {0};
  sph_operator *op =
      sph_operator_create(&(sph_operator_def){.dim = 2, .h = 2 * L / n, .lower_order = 1}, &error);
  for (long i = 0; i < many; i++) volume[i] = m[i] / rho[i];
  sph_operator_set_points(op, many, x, volume, NULL, &error);
  for (int k = 0; k < 2; k++) {
    line *l = &lines[k];
    double *now = malloc((size_t)l->n * sizeof *now);
    sph_operator_set_probes(op, l->n, (const double *const *)l->place, &error);
    sph_operator_mls(op, 1, sph_group_read(water, "velocity", l->component), now, NULL, NULL,
                     &error);
    if (error.status) fail_msg("%s", error.text);
    for (long i = 0; i < l->n; i++) l->sum[i] += now[i];
    free(now);
  }
  sph_operator_free(op);
  free(volume);
}

/* Mean from t to t + 4 L/U. */
static double distance(int n, int Re, double t)
{
  enum { SAMPLES = 40 };
  char name[2][40];
  for (int k = 0; k < 2; k++)
    snprintf(name[k], sizeof name[k], "ghia_1982_re%d_%c.csv", Re, "uv"[k]);
  line lines[2] = {read_line(name[0], 0), read_line(name[1], 1)};
  sph_sim *sim = cavity(n, Re);
  for (int k = 1; k <= SAMPLES; k++) {
    if (sph_sim_run(sim, t + 4 * L / U * k / SAMPLES)) fail_msg("%s", sph_sim_error(sim));
    add_sample(sim, n, lines);
  }
  double sum = 0, points = 0, of[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    for (long i = 0; i < lines[k].n; i++) {
      if (lines[k].at[i] == 0 || lines[k].at[i] == 1) continue; /* walls */
      double apart = lines[k].sum[i] / SAMPLES / U - lines[k].value[i];
      of[k] += apart * apart, points += 1;
    }
    sum += of[k];
    line_free(&lines[k]);
  }
  print_message("# Re = %d, %d x %d, t = %g to %g: rms %.4f of U (squares of u %.2g, of v %.2g)\n",
                Re, n, n, t, t + 4, sqrt(sum / points), of[0], of[1]);
  sph_sim_free(sim);
  return sqrt(sum / points);
}

static void coarse(void **state)
{
  (void)state;
  assert_true(distance(20, 100, 8) <= 0.027);
}

static void fine(void **state)
{
  (void)state;
  if (test_is_short()) return;
  assert_true(distance(50, 100, 16) <= 0.01);
  assert_true(distance(50, 400, 36) <= 0.03);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(coarse), cmocka_unit_test(fine)};
  return cmocka_run_group_tests_name("lid-driven cavity", tests, NULL, NULL);
}
