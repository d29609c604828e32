/* Work of walls that move: a piston pushes a gas together, and the energy of the gas grows by its
 * work alone, which is that of an adiabat,
 *
 *   W = U_0 ((V_0/V)^(gamma - 1) - 1)
 *
 * with images behind a plane, particles, and particles that turn about an axis far away. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../near.h"
#include "sphode.h"

static const double T = 2, stroke = 0.3, far = 1e4, length = 1; /* [s], [m] */
enum { ACROSS = 10, FRAMES = 200 };
enum { PUSHES, REFLECTS, TURNS, KINDS };

static void push(void *ctx, double t, double displacement[3], double velocity[3],
                 double acceleration[3])
{
  const double w = acos(-1) / T;
  (void)ctx;
  for (int d = 0; d < 3; d++) displacement[d] = velocity[d] = acceleration[d] = 0;
  displacement[0] = stroke / 2 * (1 - cos(w * t));
  velocity[0] = stroke / 2 * w * sin(w * t);
  acceleration[0] = stroke / 2 * w * w * cos(w * t);
}

/* The same about an axis below: clockwise. */
static void turn(void *ctx, double t, double angle[3])
{
  double x[3], v[3], a[3];
  push(ctx, t, x, v, a);
  angle[0] = -x[0] / far, angle[1] = -v[0] / far, angle[2] = -a[0] / far;
}

static sph_group *wall(sph_sim *sim, const char *name, double from, double to, double high)
{
  sph_group *group = sph_group_create(sim, name, "wall");
  if (from < to) sph_group_add_box(group, (double[]){from, 0}, (double[]){to, high}, 1);
  return group;
}

static sph_sim *make(int kind, int n)
{
  const double dx = length / n, high = ACROSS * dx;
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .periodic = {0, 1}, .length = {0, high}});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0, 0}, (double[]){length, high}, 1);
  sph_group_set_eos(gas, sph_eos_ideal_gas(1.4));
  for (long i = 0; i < sph_group_count(gas); i++) sph_group_write(gas, "energy", 0)[i] = 2.5;
  sph_group_set_boundary(wall(sim, "end", length, length + 6 * dx, high), sph_boundary_adami());
  sph_boundary b = kind == REFLECTS ? sph_boundary_mirror() : sph_boundary_adami();
  if (kind == TURNS) {
    b.rotation = turn;
    b.centre[1] = -far;
  } else
    b.motion = push;
  if (kind == REFLECTS) b.planes = 1, b.plane[0] = (sph_plane){.normal = {1, 0, 0}};
  sph_group_set_boundary(wall(sim, "piston", kind == REFLECTS ? 0 : -6 * dx, 0, high), b);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  return sim;
}

typedef struct result {
  double work, gained, adiabatic; /* [J/m] */
} result;

/* - F.v [W/m] of the piston now. */
static double power(sph_sim *sim)
{
  double x[3], v[3], a[3], p = 0;
  sph_force f;
  const sph_group *group;
  push(NULL, sph_sim_time(sim), x, v, a);
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    if (!strcmp(sph_group_name(group), "piston")) {
      assert_int_equal(sph_sim_force(sim, group, NULL, &f), SPH_OK);
      p -= f.force[0] * v[0];
    }
  return p;
}

static result compress(int kind, int n)
{
  result r = {0};
  double sum = 0, before = 0;
  sph_balance start, end;
  sph_sim *sim = make(kind, n);
  if (sph_sim_evaluate(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  sph_sim_balance(sim, &start);
  for (int k = 0; k <= FRAMES; k++) {
    if (k && sph_sim_run(sim, k * T / FRAMES)) fail_msg("%s", sph_sim_error(sim));
    if (sph_sim_work(sim, &r.work)) fail_msg("%s", sph_sim_error(sim));
    if (kind == PUSHES) { /* the trapezoidal rule over these moments, to rounding */
      const double now = power(sim);
      if (k) sum += T / FRAMES * (before + now) / 2;
      before = now;
      assert_near(r.work, sum, 1e-9);
    }
    double again;
    assert_int_equal(sph_sim_work(sim, &again), SPH_OK);
    assert_true(again == r.work && (k || r.work == 0));
  }
  sph_sim_balance(sim, &end);
  r.gained = end.total - start.total;
  r.adiabatic = start.total * (pow(1 - stroke / length, -0.4) - 1);
  print_message("# kind %d, %d long: work %.5g of %.5g J/m, %.2e of it are missing\n", kind, n,
                r.work, r.adiabatic, r.gained / r.work - 1);
  sph_sim_free(sim);
  return r;
}

static void pistons(void **state)
{
  (void)state;
  for (int kind = 0; kind < KINDS; kind++) {
    const result coarse = compress(kind, 25), fine = compress(kind, 50);
    assert_near(coarse.work, coarse.adiabatic, 0.002 * coarse.adiabatic);
    assert_near(fine.work, fine.adiabatic, 0.001 * fine.adiabatic);
    assert_near(coarse.gained, coarse.work, 0.04 * coarse.work);
    assert_near(fine.gained, fine.work, 0.02 * fine.work);
  }
}

/* The summary tells the drift beside the work. */
static double of_summary(const char *text, const char *name)
{
  const char *at = strstr(text, name);
  assert_non_null(at);
  return strtod(at + strlen(name), NULL);
}

static void drift(void **state)
{
  (void)state;
  char text[4000];
  sph_balance start;
  sph_sim *sim = make(PUSHES, 50);
  sph_sim_evaluate(sim);
  sph_sim_balance(sim, &start);
  for (int k = 0; k <= FRAMES; k++) {
    double work;
    if (k) sph_sim_run(sim, k * T / FRAMES);
    sph_sim_work(sim, &work);
  }
  assert_true(sph_summary_text(text, sizeof text, sim, &start, NULL, 0) > 0);
  const double work = of_summary(text, "beside "), left = of_summary(text, "walls: total energy ");
  print_message("# summary: work %g J/m, drift %g J/m\n", work, left);
  assert_true(work > 0.07 * start.total && fabs(left) < 0.02 * work);
  sph_sim_free(sim);
}

static void at_rest(void **state)
{
  (void)state;
  double work = 1;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.1});
  assert_int_equal(sph_sim_work(sim, &work), SPH_OK);
  assert_true(work == 0);
  assert_int_equal(sph_sim_work(sim, NULL), SPH_ERR_ARGUMENT);
  sph_sim_free(sim);
  assert_int_equal(sph_sim_work(NULL, &work), SPH_ERR_MEMORY);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(pistons), cmocka_unit_test(drift),
                                     cmocka_unit_test(at_rest)};
  return cmocka_run_group_tests_name("work", tests, NULL, NULL);
}
