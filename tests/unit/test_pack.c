/* Packing: bodies hold their volume, have a layer of particles half a spacing below their surface
 * without gaps, and are more even than a lattice that is cut; the same every time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "near.h"
#include "sphode.h"

typedef struct packed {
  sph_sim *sim;
  sph_group *group;
  long n;
  const double *x[3];
} packed;

static packed pack(sph_shape *shape, double dx, const sph_pack *how)
{
  packed p = {.sim = sph_sim_create(&(sph_sim_def){.dim = sph_shape_dim(shape), .dx = dx})};
  p.group = sph_group_create(p.sim, "g", "fluid");
  sph_group_add_shape(p.group, shape, &(sph_fill){.rho0 = 1000, .pack = how});
  if (sph_sim_status(p.sim)) fail_msg("%s", sph_sim_error(p.sim));
  p.n = sph_group_count(p.group);
  for (int d = 0; d < sph_shape_dim(shape); d++) p.x[d] = sph_group_read(p.group, "position", d);
  return p;
}

static double distance(const sph_shape *shape, const packed *p, long i)
{
  double x[3] = {0};
  for (int d = 0; d < sph_shape_dim(shape); d++) x[d] = p->x[d][i];
  return sph_shape_distance(shape, x);
}

/* Standard deviation of sum V W of the particles that see no surface. */
static double unevenness(const sph_shape *shape, const packed *p, double dx)
{
  const sph_kernel *kernel = sph_kernel_find("wendland-c2");
  const int dim = sph_shape_dim(shape);
  double sum = 0, squares = 0;
  long inner = 0;
  for (long i = 0; i < p->n; i++) {
    double C = 0;
    if (distance(shape, p, i) > -3 * dx) continue;
    for (long j = 0; j < p->n; j++) {
      double r2 = 0;
      for (int d = 0; d < dim; d++) r2 += (p->x[d][i] - p->x[d][j]) * (p->x[d][i] - p->x[d][j]);
      C += pow(dx, dim) * sph_kernel_w(kernel, dim, sqrt(r2), 1.5 * dx);
    }
    sum += C, squares += C * C, inner++;
  }
  assert_true(inner > 20);
  return sqrt(squares / (double)inner - sum * sum / (double)inner / (double)inner);
}

static double nearest(const packed *p, int dim)
{
  double least = INFINITY;
  for (long i = 0; i < p->n; i++)
    for (long j = 0; j < i; j++) {
      double r2 = 0;
      for (int d = 0; d < dim; d++) r2 += (p->x[d][i] - p->x[d][j]) * (p->x[d][i] - p->x[d][j]);
      least = fmin(least, r2);
    }
  return sqrt(least);
}

static int rising(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void a_disc_fits(void **state)
{
  const double R = 0.5, dx = 0.025, c[] = {0.1, -0.2};
  double angle[400];
  sph_error e = {0};
  int layer = 0;
  (void)state;
  sph_shape *disc = sph_shape_ball(2, c, R, &e);
  packed p = pack(disc, dx, &(sph_pack){.uniformity = 0.005});
  const sph_packing *info = sph_group_packing(p.group);
  assert_near(info->volume, M_PI * R * R, 1e-3 * M_PI * R * R);
  assert_near((double)p.n * dx * dx, M_PI * R * R, 1e-3 * M_PI * R * R);
  assert_true(info->settled && info->uniformity <= 0.005);
  assert_true(info->before > 4 * info->uniformity);
  for (long i = 0; i < p.n; i++) {
    const double d = distance(disc, &p, i);
    assert_true(d < -0.499 * dx);
    if (d < -0.6 * dx) continue;
    assert_true(layer < 400);
    angle[layer++] = atan2(p.x[1][i] - c[1], p.x[0][i] - c[0]);
  }
  /* The outermost layer goes all the way round. */
  qsort(angle, (size_t)layer, sizeof *angle, rising);
  double gap = angle[0] + 2 * M_PI - angle[layer - 1];
  for (int k = 1; k < layer; k++) gap = fmax(gap, angle[k] - angle[k - 1]);
  assert_true(gap * (R - dx / 2) < 1.6 * dx);
  assert_true(nearest(&p, 2) > 0.6 * dx);
  assert_true(unevenness(disc, &p, dx) < 0.01);
  sph_sim_free(p.sim);
  sph_shape_free(disc);
}

static void a_ball_fits(void **state)
{
  const double R = 0.5, dx = 1. / 14, c[] = {0, 0, 0};
  sph_error e = {0};
  (void)state;
  sph_shape *ball = sph_shape_ball(3, c, R, &e);
  packed p = pack(ball, dx, &(sph_pack){.uniformity = 0.02});
  const sph_packing *info = sph_group_packing(p.group);
  assert_near((double)p.n * dx * dx * dx, M_PI / 6, 2e-3 * M_PI / 6);
  assert_true(info->settled);
  assert_true(info->before > 1.5 * info->uniformity);
  for (long i = 0; i < p.n; i++) assert_true(distance(ball, &p, i) < -0.499 * dx);
  assert_true(nearest(&p, 3) > 0.55 * dx);
  sph_sim_free(p.sim);
  sph_shape_free(ball);
}

/* Where the distance is a bound only: two boxes with a common side are one, and that side, off the
 * lattice, is no surface. */
static void a_union_has_no_seam(void **state)
{
  const double dx = 0.05, side = 0.63;
  sph_error e = {0};
  (void)state;
  sph_shape *two[] = {sph_shape_box(2, (double[]){0, 0}, (double[]){side, 0.5}, &e),
                      sph_shape_box(2, (double[]){side, 0}, (double[]){1.2, 0.5}, &e)};
  sph_shape *both = sph_shape_union(2, two, &e);
  packed p = pack(both, dx, &(sph_pack){.uniformity = 0.015});
  assert_int_equal(p.n, 240);
  long seam = 0;
  for (long i = 0; i < p.n; i++) seam += fabs(p.x[0][i] - side) < 0.45 * dx;
  assert_true(seam >= 5); /* ten in a row */
  assert_true(sph_group_packing(p.group)->settled);
  sph_sim_free(p.sim);
  sph_shape_free(both);
}

/* A wall of three layers around a disc. */
static void a_shell_has_its_layers(void **state)
{
  const double R = 0.5, dx = 0.05, c[] = {0, 0};
  sph_error e = {0};
  (void)state;
  sph_shape *shell = sph_shape_shell(sph_shape_ball(2, c, R, &e), 3 * dx, 0, dx, &e);
  packed p = pack(shell, dx, &(sph_pack){.uniformity = 0.015});
  long layer[3] = {0};
  for (long i = 0; i < p.n; i++) {
    const int k = (int)floor((hypot(p.x[0][i], p.x[1][i]) - R) / dx);
    assert_in_range(k, 0, 2);
    layer[k]++;
  }
  for (int k = 0; k < 3; k++)
    assert_near((double)layer[k], 2 * M_PI * (R / dx + k + 0.5),
                0.35 * 2 * M_PI * (R / dx + k + 0.5));
  sph_sim_free(p.sim);
  sph_shape_free(shell);
}

/* ---- corners ---- */

/* Of the cells of all particles, the parts of the body that are nearest to each: the least and the
 * largest area over dx^2. */
static void cells_of(const sph_shape *shape, const packed *p, double dx, double cell[2])
{
  enum { MOST = 1000, FINE = 8 };
  double lower[3], upper[3], area[MOST] = {0};
  const double s = dx / FINE;
  assert_in_range(p->n, 1, MOST);
  assert_true(sph_shape_bounds(shape, lower, upper));
  for (double x = lower[0] + s / 2; x < upper[0]; x += s)
    for (double y = lower[1] + s / 2; y < upper[1]; y += s) {
      double least = INFINITY;
      long nearest = 0;
      if (sph_shape_distance(shape, (double[]){x, y}) > 0) continue;
      for (long i = 0; i < p->n; i++) {
        const double r2 = pow(p->x[0][i] - x, 2) + pow(p->x[1][i] - y, 2);
        if (r2 < least) least = r2, nearest = i;
      }
      area[nearest] += 1.0 / FINE / FINE;
    }
  cell[0] = INFINITY, cell[1] = 0;
  for (long i = 0; i < p->n; i++)
    cell[0] = fmin(cell[0], area[i]), cell[1] = fmax(cell[1], area[i]);
}

/* Right ones, out of the body and into it, askew to the lattice; sharp ones, of 60 degrees. */
static void corners_are_filled(void **state)
{
  const double o[] = {0, 0}, dx = 0.05;
  (void)state;
  for (int k = 0; k < 2; k++) {
    sph_error e = {0};
    double cell[2];
    sph_shape *part[] = {sph_shape_box(2, (double[]){-0.5, -0.5}, (double[]){0.5, 0.5}, &e),
                         sph_shape_rotate(sph_shape_box(2, (double[]){-0.2, -0.2},
                                                        (double[]){0.2, 0.2}, &e),
                                          NULL, 0.4, o, &e)};
    sph_shape *shape =
        k ? sph_shape_polygon(3, (const double[3][2]){{-0.6, -0.35}, {0.6, -0.35}, {0, 0.69}}, &e)
          : sph_shape_difference(2, part, &e);
    if (k) sph_shape_free(part[0]), sph_shape_free(part[1]);
    packed p = pack(shape, k ? dx / 2 : dx, &(sph_pack){0});
    cells_of(shape, &p, k ? dx / 2 : dx, cell);
    print_message("# %s: nearest %.2f dx, cells of %.2f to %.2f dx^2\n", k ? "60 degrees" : "notch",
                  nearest(&p, 2) / (k ? dx / 2 : dx), cell[0], cell[1]);
    assert_true(nearest(&p, 2) > 0.6 * (k ? dx / 2 : dx));
    assert_true(cell[0] > 0.85 && cell[1] < 1.27);
    sph_sim_free(p.sim);
    sph_shape_free(shape);
  }
}

static void the_same_every_time(void **state)
{
  const double c[] = {0, 0};
  sph_error e = {0};
  (void)state;
  sph_shape *disc = sph_shape_ball(2, c, 0.5, &e);
  packed p = pack(disc, 0.05, &(sph_pack){.iterations = 10}),
         q = pack(disc, 0.05, &(sph_pack){.iterations = 10});
  assert_int_equal(p.n, q.n);
  for (int d = 0; d < 2; d++) assert_memory_equal(p.x[d], q.x[d], (size_t)p.n * sizeof *p.x[d]);
  assert_int_equal(sph_group_packing(p.group)->iterations, 10);
  assert_false(sph_group_packing(p.group)->settled);
  sph_sim_free(p.sim), sph_sim_free(q.sim);
  sph_shape_free(disc);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_disc_fits),         cmocka_unit_test(a_ball_fits),
      cmocka_unit_test(a_union_has_no_seam), cmocka_unit_test(a_shell_has_its_layers),
      cmocka_unit_test(corners_are_filled),  cmocka_unit_test(the_same_every_time),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
