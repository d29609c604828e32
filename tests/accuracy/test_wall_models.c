/* The three wall models (adami, dbc, mirror) on the same flows, against exact solutions: at rest,
 * along plates, through which heat goes, with manufactured fields, and in an impact.
 *
 * Bars are those of validation.md where it has them (column at rest 0.4 %, Couette 0.15 %,
 * Poiseuille 0.35 %, orders of 1 at early times); dynamic boundary particles have none there, and
 * are held to what they do, a few times worse.  SPHODE_TEST_LONG=1: finer, longer, and 10 s of a
 * dam break that hits the wall with each of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "wall_scene.h"

static int fine(void) { return getenv("SPHODE_TEST_LONG") != NULL; }

/* adami: test_hydrostatic.c */
static void at_rest(void **state)
{
  (void)state;
  const double t = fine() ? 120 : 10;
  const wall_rest mirror = wall_scene_rest("mirror", "antuono", t);
  const wall_rest dbc = wall_scene_rest("dbc", "antuono", t);
  print_message("# at rest, t = %g: mirror L1(p) %.3f %%, kinetic/potential %.1e; dbc %.3f %%, "
                "%.1e\n",
                t, 100 * mirror.error, mirror.motion, 100 * dbc.error, dbc.motion);
  assert_true(mirror.error <= 0.004 && mirror.motion <= 1e-6);
  assert_true(dbc.error <= 0.02 && dbc.motion <= 1e-4);
}

/* adami: test_channel.c */
static void channel(int couette, double bar)
{
  double coarse[WALL_TIMES], mirror[WALL_TIMES], dbc[WALL_TIMES];
  const int count = fine() ? WALL_TIMES : 2;
  wall_scene_channel("mirror", couette, 25, 1.5, 2, coarse);
  wall_scene_channel("mirror", couette, 50, 1.5, count, mirror);
  wall_scene_channel("dbc", couette, 25, 1.5, 1, dbc);
  for (int k = 0; k < count; k++) {
    const double order = k < 2 ? log2(coarse[k] / mirror[k]) : NAN;
    print_message("# %s, mirror, 50 across, t = %g: rms %.3f %%, order %.2f\n",
                  couette ? "Couette" : "Poiseuille", wall_scene_times[k], 100 * mirror[k], order);
    assert_true(mirror[k] <= bar);
    if (k < 2) assert_true(order >= 1);
  }
  print_message("# dbc, 25 across: rms %.3f %%\n", 100 * dbc[0]);
  assert_true(dbc[0] <= 0.05);
}

static void channels(void **state)
{
  (void)state;
  channel(1, 0.0015);
  channel(0, 0.0035);
}

/* Adami's no-slip walls, curved, one of them turning: at least order 1 is asked (docs/walls.md). */
static void cylinders(void **state)
{
  (void)state;
  const int n = fine() ? 12 : 8;
  const double coarse = wall_scene_cylinders("adami", n, 1.5);
  const double error = wall_scene_cylinders("adami", 2 * n, 1.5), order = log2(coarse / error);
  print_message("# between cylinders, adami, no slip: rms %.2f %% at %d, %.2f %% at %d across, "
                "order %.2f\n",
                100 * coarse, n, 100 * error, 2 * n, order);
  assert_true(order >= 1.6);
  assert_true(error * n * n <= 0.09); /* 0.125 % at 16, 0.053 % at 24 */
}

/* h is halved where dx is quartered: order 1 in dx is order 2 in h. */
static void slabs(void **state)
{
  (void)state;
  static const char *const kind[] = {"dirichlet", "neumann", "flux"};
  static const double bar[] = {0.0015, 0.001, 0.0004};
  for (int k = 0; k < 3; k++) {
    const double coarse = wall_scene_slab("mirror", kind[k], 20);
    const double error = wall_scene_slab("mirror", kind[k], 40);
    print_message("# heat, mirror, %s: rms %.2e at 20, %.2e at 40 across, order %.2f\n", kind[k],
                  coarse, error, log2(coarse / error));
    assert_true(error <= bar[k] && coarse >= 2 * error);
  }
}

static void manufactured(void **state)
{
  (void)state;
  static const int across[2][3] = {{16, 24, 36}, {16, 32, 64}};
  static const double bar[2] = {1.3, 1}; /* of velocity: slip as in a periodic box; no slip */
  for (int no_slip = 0; no_slip < 2; no_slip++) {
    double dx[3], v[3], p[3];
    for (int k = 0; k < 3; k++) {
      dx[k] = 1.0 / across[fine()][k];
      wall_scene_manufactured("mirror", no_slip, across[fine()][k], 0, &v[k], &p[k]);
    }
    const double order_v = sph_manufactured_order(3, dx, v);
    const double order_p = sph_manufactured_order(3, dx, p);
    print_message("# manufactured, mirror, %s: velocity %.2e U, order %.2f; pressure %.2e, %.2f\n",
                  no_slip ? "no slip" : "free slip", v[2], order_v, p[2], order_p);
    assert_true(order_v >= bar[no_slip] && order_p >= 0.9);
  }
}

/* No slip, h/dx = 2: at least order 1 is asked. */
static void fixed(void **state)
{
  (void)state;
  static const char *const model[] = {"adami", "mirror"};
  for (int k = 0; k < 2; k++) {
    double coarse, v, p;
    wall_scene_manufactured(model[k], 1, 16, 2, &coarse, &p);
    wall_scene_manufactured(model[k], 1, 32, 2, &v, &p);
    print_message("# manufactured, %s, no slip, h/dx = 2: velocity %.2e U at 32 across, order "
                  "%.2f\n",
                  model[k], v, log2(coarse / v));
    assert_true(v <= 0.0035 && log2(coarse / v) >= 1.6);
  }
}

/* Every particle stays in the tank; behind a mirror it may be within a step. */
static void impact(void **state)
{
  (void)state;
  static const char *const model[] = {"adami", "dbc", "mirror"};
  for (int k = fine() ? 0 : 2; k < 3; k++) {
    const wall_impact r = wall_scene_impact(model[k], 20, fine() ? 10 : 1.2);
    if (r.status) fail_msg("%s: %s", model[k], r.error);
    print_message("# impact, %s: %ld of %ld particles lost, least distance to a wall %.2f dx\n",
                  model[k], r.lost, r.particles, r.least);
    assert_int_equal(r.lost, 0);
    assert_true(r.least >= (k == 2 ? -0.1 : 0));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(at_rest),      cmocka_unit_test(channels),
                                     cmocka_unit_test(cylinders),    cmocka_unit_test(slabs),
                                     cmocka_unit_test(manufactured), cmocka_unit_test(fixed),
                                     cmocka_unit_test(impact)};
  return cmocka_run_group_tests_name("wall models", tests, NULL, NULL);
}
