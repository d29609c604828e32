/* What drag between dust and fluids keeps, whatever the state, and what it is on a lattice; what
 * else acts on dust. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "balance.h"
#include "sim_data.h"

enum { SOME = 9 }; /* of the scenes: every kernel, every dimension */

/* One dust or two in a gas or a liquid that carries its heat along. */
static void make(scene *s, int k, int thermal, int periodic)
{
  scene_def def = scene_number(k, thermal, periodic);
  def.dusts = 1 + k / 2 % 2;
  def.laminar = 1;
  scene_make(s, &def);
  s->o.drag = 1;
  if (k % 2)
    s->o.drag_K = 300;
  else
    s->o.drag_rate = 0.5;
  s->o.energy = ORACLE_U;
}

static scene_rates rates_of(scene *s, scene_options options)
{
  sph_sim *sim = scene_sim(s, options);
  scene_rates rates = scene_evaluate(s, sim);
  sph_sim_free(sim);
  return rates;
}

static int is_dust(const scene *s, long i) { return s->o.group[s->o.particle[i].group].dust; }

/* ---- whatever the state ---- */

static void momentum(void **state)
{
  (void)state;
  for (int k = 0; k < SOME; k++) {
    scene s;
    make(&s, k, k / 3 % 2, 1);
    scene_rates r = rates_of(&s, (scene_options){0});
    assert_momentum(&s, &r);
    scene_rates_free(&r);
    scene_free(&s);
  }
}

static void angular_momentum(void **state)
{
  (void)state;
  for (int k = 0; k < SOME; k++) {
    scene s;
    make(&s, k, 0, 0);
    scene_rates r = rates_of(&s, (scene_options){0});
    for (int d = s.o.dim == 2 ? 2 : 0; d < 3 && s.o.dim > 1; d++) {
      balance torque = torque_of(&s, &r, d);
      assert_zero(&torque, 1e-14, "sum m x cross a");
    }
    scene_rates_free(&r);
    scene_free(&s);
  }
}

/* Motion of both loses what the fluid gains as heat, of which each particle gets some. */
static void energy(void **state)
{
  (void)state;
  for (int k = 0; k < SOME; k++) {
    scene s;
    balance total = {0, 0};
    make(&s, k, k / 3 % 2, 1);
    if (k % 4 == 3) s.o.energy = ORACLE_TOTAL;
    if (!s.thermal) s.o.energy = ORACLE_U;
    scene_rates r = rates_of(&s, (scene_options){0});
    for (long i = 0; i < r.n; i++) {
      if (is_dust(&s, i) || s.o.energy != ORACLE_TOTAL) add(&total, power_of(&s, &r, i));
      add(&total, s.o.particle[i].m * r.du[i]);
      if (s.o.energy == ORACLE_U) assert_true(is_dust(&s, i) ? r.du[i] == 0 : r.du[i] > 0);
    }
    assert_zero(&total, 1e-14, "sum m (v.a + du/dt)");
    scene_rates_free(&r);
    scene_free(&s);
  }
}

/* Nothing where all move alike; the same bits for any search, skin and number of threads, of which
 * sums in another order may differ by rounding. */
static void the_same(void **state)
{
  (void)state;
  for (int k = 0; k < SOME; k++) {
    scene s;
    make(&s, k, k / 3 % 2, 1);
    s.o.continuity = s.o.pressure = ORACLE_C2;
    scene_rates one = rates_of(&s, (scene_options){0});
    scene_rates four = rates_of(&s, (scene_options){.threads = 4});
    assert_true(scene_rates_same(&one, &four));
    scene_rates_free(&one), scene_rates_free(&four);
    s.o.pressure = ORACLE_NONE;
    for (long i = 0; i < s.o.n; i++)
      for (int d = 0; d < s.o.dim; d++) s.o.particle[i].v[d] = 3 - 2 * d;
    one = rates_of(&s, (scene_options){0});
    for (long i = 0; i < s.o.n; i++)
      for (int d = 0; d < s.o.dim; d++) assert_true(one.a[d][i] == 0 && one.du[i] == 0);
    scene_rates_free(&one);
    scene_free(&s);
  }
}

/* 0.5/(largest sum of the fluids + largest of the dusts), each sum_j m_j K/(rho_i rho_j) D_ij. */
static double limit_of(const scene *s)
{
  const oracle *o = &s->o;
  real most[2] = {0, 0};
  for (long i = 0; i < o->n; i++) {
    const oracle_particle *a = &o->particle[i];
    real rate = 0;
    for (long j = 0; j < o->n; j++) {
      const oracle_particle *b = &o->particle[j];
      real r2 = 0;
      for (int d = 0; d < o->dim; d++) {
        real x = a->x[d] - b->x[d];
        if (o->periodic[d]) x -= o->length[d] * roundl(x / o->length[d]);
        r2 += x * x;
      }
      if (is_dust(s, i) == is_dust(s, j)) continue;
      real K = o->drag_K + o->drag_rate * (is_dust(s, i) ? a->rho : b->rho);
      real D = r2 / (o->h * o->h) * oracle_w(o, sqrtl(r2)) / o->second_moment;
      rate += b->m * K / (a->rho * b->rho) * D;
    }
    if (rate > most[is_dust(s, i)]) most[is_dust(s, i)] = rate;
  }
  return (double)(0.5L / (most[0] + most[1]));
}

static void step_limit(void **state)
{
  (void)state;
  for (int k = 0; k < SOME; k++) {
    scene s;
    make(&s, k, k / 3 % 2, k / 2 % 2);
    sph_sim *sim = scene_sim(&s, (scene_options){0});
    scene_rates r = scene_evaluate(&s, sim);
    oracle_evaluate(&s.o);
    double right = limit_of(&s), found = sim->limit[SPH_BOUND_DRAG];
    if (!(fabs(found / right - 1) <= 1e-12)) fail_msg("drag: %.17g s, not %.17g s", found, right);
    scene_rates_free(&r);
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* ---- on a lattice ---- */

/* Accelerations of two lattices, dust at `offset` dx of the fluid in each direction, of their own
 * densities, with velocity v of the dust; per K/rho and per v. */
typedef struct streams {
  double fluid[3], dust[3], limit;
} streams;

static const double K = 50, rho_fluid = 2, rho_dust = 0.6;

static streams lattices(int dim, const char *kernel, double h_over_dx, double offset, double v)
{
  enum { N = 12 };
  const double dx = 0.1, lo[] = {0, 0, 0}, hi[] = {N * dx, N * dx, N * dx};
  sph_sim_def def = {.dim = dim, .dx = dx, .kernel = kernel, .h_over_dx = h_over_dx};
  for (int d = 0; d < dim; d++) def.periodic[d] = 1, def.length[d] = N * dx;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *gas = sph_group_box(sim, "gas", lo, hi, rho_fluid);
  sph_group *dust = sph_group_box(sim, "dust", lo, hi, rho_dust);
  sph_group_set_eos(gas, sph_eos_isothermal(rho_fluid, 1));
  sph_group_set_eos(dust, sph_eos_dust());
  sph_sim_add_term(sim, sph_term_drag(K));
  for (int d = 0; d < dim; d++)
    for (long i = 0; i < sph_group_count(dust); i++) {
      sph_group_write(dust, "position", d)[i] += offset * dx;
      sph_group_write(dust, "velocity", d)[i] = (d + 1) * v;
    }
  if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
  streams it = {.limit = sim->limit[SPH_BOUND_DRAG]};
  for (int d = 0; d < dim; d++) {
    const double *a = sph_group_rate(gas, "velocity", d), *b = sph_group_rate(dust, "velocity", d);
    for (long i = 0; i < sph_group_count(gas); i++) { /* all the same */
      assert_true(fabs(a[i] - a[0]) <= 1e-13 * fabs(a[0]));
      assert_true(fabs(b[i] - b[0]) <= 1e-13 * fabs(b[0]));
    }
    it.fluid[d] = a[0] * rho_fluid / K / ((d + 1) * v);
    it.dust[d] = -b[0] * rho_dust / K / ((d + 1) * v);
  }
  sph_sim_free(sim);
  return it;
}

/* Quintic splines on a line with h = dx add up to the exact second moment, wherever they stand: a =
 * -K/rho (v_i - v_j), exactly. */
static void exact_on_a_line(void **state)
{
  (void)state;
  for (int k = 0; k < 7; k++) {
    streams it = lattices(1, "quintic-spline", 1, k / 7.0, 0.3);
    assert_true(fabs(it.fluid[0] - 1) <= 1e-13 && fabs(it.dust[0] - 1) <= 1e-13);
    double t = 0.5 / (K / rho_fluid + K / rho_dust);
    assert_true(fabs(it.limit / t - 1) <= 1e-13);
  }
}

/* In the plane and in space, too, the drag has the direction of v where the offset is symmetric,
 * and the size of the sum of d x^2 D over the lattice, 1 but for what is left at this h/dx
 * (computed elsewhere). */
static void near_1_on_lattices(void **state)
{
  (void)state;
  static const struct {
    int dim;
    const char *kernel;
    double h_over_dx, offset, sum;
  } row[] = {
      {1, "wendland-c2", 1.5, 0, 8.23e-3},   {1, "wendland-c2", 1.5, 0.5, -6.96e-3},
      {2, "wendland-c2", 1.5, 0, -1.49e-3},  {2, "wendland-c2", 1.5, 0.5, 2.17e-3},
      {3, "wendland-c2", 1.5, 0, -2.59e-3},  {3, "wendland-c2", 1.5, 0.5, 3.44e-3},
      {2, "wendland-c4", 1.7, 0, -1.18e-3},  {3, "wendland-c4", 1.7, 0.5, 1.24e-3},
      {2, "wendland-c6", 2, 0.5, 2.23e-4},   {3, "wendland-c6", 2, 0, -1.82e-4},
      {2, "cubic-spline", 1.2, 0, -1.15e-2}, {3, "cubic-spline", 1.2, 0.5, 5.86e-3},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    streams it =
        lattices(row[k].dim, row[k].kernel, row[k].h_over_dx, row[k].offset, k % 2 ? -0.2 : 3);
    for (int d = 0; d < row[k].dim; d++) {
      assert_true(fabs(it.fluid[d] - 1 - row[k].sum) <= 6e-3 * fabs(row[k].sum) + 1e-9);
      assert_true(fabs(it.fluid[d] / it.dust[d] - 1) <= 1e-12);
      assert_true(fabs(it.fluid[d] / it.fluid[0] - 1) <= 1e-12);
    }
  }
}

/* Twice the coefficient is twice the drag, from the next evaluation on; so is half a stopping time,
 * of which K = rho_dust/t_s is the same to begin with. */
static void coefficients_may_change(void **state)
{
  (void)state;
  scene s;
  scene_def def = {.dim = 2, .n = 12, .dusts = 1, .periodic = {1, 1}, .seed = 3};
  scene_make(&s, &def);
  for (long i = 0; i < s.o.n; i++)
    if (is_dust(&s, i)) s.o.particle[i].rho = 512;
  s.o.drag = 1, s.o.drag_K = 128;
  sph_sim *sim = scene_sim(&s, (scene_options){0});
  scene_rates was = scene_evaluate(&s, sim);
  const double limit = sim->limit[SPH_BOUND_DRAG];
  for (int k = 0; k < 2; k++) {
    sph_sim_change_term(sim, k ? sph_term_drag_time(2) : sph_term_drag(256));
    scene_rates now = scene_evaluate(&s, sim);
    assert_true(sim->limit[SPH_BOUND_DRAG] == limit / 2);
    for (long i = 0; i < s.o.n; i++) assert_true(now.a[0][i] == 2 * was.a[0][i]);
    scene_rates_free(&now);
  }
  scene_rates_free(&was);
  sph_sim_free(sim);
  scene_free(&s);
}

/* ---- what else acts on dust ---- */

/* Body forces, and nothing else: not the pressure and viscosity of the fluid, not walls, not
 * another dust, not XSPH; its density changes with its own motion. */
static void free_flight(void **state)
{
  (void)state;
  for (int k = 0; k < SOME; k++) {
    scene s;
    scene_def def = scene_number(k, k / 3 % 2, 0);
    def.dusts = 2, def.walls = k % 3, def.laminar = 1, def.no_slip = 1;
    scene_make(&s, &def);
    s.o.continuity = s.o.pressure = ORACLE_C2;
    s.o.alpha = 1, s.o.laminar = ORACLE_MORRIS, s.o.epsilon = 0.5;
    for (int d = 0; d < s.o.dim; d++) s.o.g[d] = d - 2;
    scene_rates r = rates_of(&s, (scene_options){0});
    long dust = 0, compressed = 0;
    for (long i = 0; i < r.n; i++) {
      if (!is_dust(&s, i)) continue;
      for (int d = 0; d < s.o.dim; d++) {
        assert_true(r.a[d][i] == (double)s.o.g[d]);
        assert_true(r.dx[d][i] == (double)s.o.particle[i].v[d]);
      }
      assert_true(r.p[i] == 0 && r.c[i] == 0);
      dust++, compressed += r.drho[i] != 0;
    }
    assert_true(dust > 0 && compressed > dust / 2);
    scene_rates_free(&r);
    scene_free(&s);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(momentum),
      cmocka_unit_test(angular_momentum),
      cmocka_unit_test(energy),
      cmocka_unit_test(the_same),
      cmocka_unit_test(step_limit),
      cmocka_unit_test(exact_on_a_line),
      cmocka_unit_test(coefficients_may_change),
      cmocka_unit_test(near_1_on_lattices),
      cmocka_unit_test(free_flight),
  };
  return cmocka_run_group_tests_name("drag", tests, NULL, NULL);
}
