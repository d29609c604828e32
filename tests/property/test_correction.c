/* Corrected gradients: exact where neighbours lack, what their forms keep and what not, the
 * viscosity that they put right on a lattice, and what is refused.  test_terms.c holds them to the
 * brute force. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "balance.h"
#include "cpu.h"
#include "near.h"
#include "quick.h"
#include "sim_data.h"

/* ---- exact: a cloud of jittered points, all sides free ---- */

typedef struct cloud {
  int dim;
  sph_sim *sim;
  sph_group *water;
  long n;
} cloud;

static const double c0 = 20, rho0 = 1000; /* [m/s], [kg/m^3] */

static cloud make_cloud(int dim, int kernel, const char *isa, const char *continuity,
                        const char *pressure)
{
  const double dx = dim == 3 ? 0.125 : 0.0625;
  cloud it = {.dim = dim};
  it.sim = sph_sim_create(&(sph_sim_def){
      .dim = dim, .dx = dx, .kernel = sph_kernel_name(sph_kernel_get(kernel)), .isa = isa});
  it.water = sph_group_box(it.sim, "water", (double[3]){0}, (double[]){1, 1, 1}, rho0);
  sph_group_jitter(it.water, 0.2, (unsigned long)(10 * kernel + dim));
  sph_group_set_eos(it.water, sph_eos_linear(rho0, c0, -INFINITY));
  sph_sim_add_term(it.sim, sph_term_corrected(sph_term_continuity(), continuity));
  sph_sim_add_term(it.sim, sph_term_corrected(sph_term_pressure(), pressure));
  it.n = sph_group_count(it.water);
  return it;
}

/* p = grad . x, v linear of the matrix L; masses of a lattice, whatever the density. */
static const double grad[3] = {4e3, -9e3, 2e3}; /* [Pa/m] */
static const double L[3][3] = {{0.5, -2, 1}, {3, -1, 0.3}, {-0.7, 0.2, 1.5}};

static void set_linear(const cloud *it)
{
  double *rho = sph_group_write(it->water, "density", 0);
  for (long i = 0; i < it->n; i++) {
    double x[3] = {0}, p = 0;
    for (int d = 0; d < it->dim; d++)
      p += grad[d] * (x[d] = sph_group_read(it->water, "position", d)[i]);
    rho[i] = rho0 + p / (c0 * c0);
    for (int d = 0; d < it->dim; d++)
      sph_group_write(it->water, "velocity", d)[i] =
          L[d][0] * x[0] + L[d][1] * x[1] + L[d][2] * x[2];
  }
  if (sph_sim_evaluate(it->sim) != SPH_OK) fail_msg("%s", sph_sim_error(it->sim));
}

/* Is the least eigenvalue of the gradient matrix of point i above 0.2?  By leading minors. */
static int surrounded(const cloud *it, long i)
{
  const double h = sph_sim_h(it->sim), *rho = sph_group_read(it->water, "density", 0);
  const double *m = sph_group_read(it->water, "mass", 0);
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(it->sim));
  double M[3][3] = {{0}};
  for (long j = 0; j < it->n; j++) {
    double r[3] = {0}, r2 = 0;
    for (int d = 0; d < it->dim; d++) {
      const double *x = sph_group_read(it->water, "position", d);
      r[d] = x[i] - x[j], r2 += r[d] * r[d];
    }
    if (j == i || r2 >= 9.1 * h * h) continue;
    double VF = m[j] / rho[j] * sph_kernel_dwdr(kernel, it->dim, sqrt(r2), h) / sqrt(r2);
    for (int a = 0; a < it->dim; a++)
      for (int b = 0; b < it->dim; b++) M[a][b] -= VF * r[a] * r[b];
  }
  for (int a = 0; a < it->dim; a++) M[a][a] -= 0.2;
  double two = M[0][0] * M[1][1] - M[0][1] * M[0][1];
  if (M[0][0] <= 0 || (it->dim > 1 && two <= 0)) return 0;
  return it->dim < 3 || M[2][2] * two - M[0][0] * M[1][2] * M[1][2] - M[1][1] * M[0][2] * M[0][2] +
                                2 * M[0][1] * M[1][2] * M[0][2] >
                            0;
}

typedef struct worst {
  double a, drho; /* relative errors */
  long n;
} worst;

static void look(const cloud *it, worst *w)
{
  double size = 0, divergence = 0;
  for (int d = 0; d < it->dim; d++) size += grad[d] * grad[d], divergence += L[d][d];
  for (long i = 0; i < it->n; i++) {
    if (!surrounded(it, i)) continue;
    w->n++;
    double rho = sph_group_read(it->water, "density", 0)[i];
    double drho = sph_group_rate(it->water, "density", 0)[i];
    w->drho = fmax(w->drho, fabs(drho / (rho * divergence) + 1));
    for (int d = 0; d < it->dim; d++) {
      double a = sph_group_rate(it->water, "velocity", d)[i];
      w->a = fmax(w->a, fabs(rho * a + grad[d]) / sqrt(size));
    }
  }
}

static void exact(void **state)
{
  (void)state;
  static const char *const isa[] = {NULL, "reference", SPH_ISA_TWO_LANES};
  worst corrected = {0}, plain = {0};
  long all = 0;
  for (int dim = 1; dim <= 3; dim++)
    for (int k = 0; sph_kernel_get(k); k++) {
      cloud it = make_cloud(dim, k, isa[(k + dim) % 3], "one-sided", "one-sided");
      set_linear(&it);
      look(&it, &corrected);
      all += it.n;
      sph_sim_free(it.sim);
      it = make_cloud(dim, k, isa[k % 3], NULL, NULL);
      set_linear(&it);
      look(&it, &plain);
      sph_sim_free(it.sim);
    }
  print_message("# linear p and v, surfaces too: grad p off by %.2g, div v by %.2g at %ld of %ld "
                "points; without correction %.2g, %.2g\n",
                corrected.a, corrected.drho, corrected.n, all, plain.a, plain.drho);
  assert_true(corrected.a <= 1e-11 && corrected.drho <= 1e-11);
  assert_true(corrected.n > 0.97 * (double)all);
  assert_true(plain.a > 0.3 && plain.drho > 0.3);
}

/* ---- what is kept ---- */

static const enum oracle_row rows[] = {ORACLE_C2, ORACLE_C1, ORACLE_PHI};

static scene_rates rates_of(scene *s, int row, enum oracle_correction pressure,
                            enum oracle_laminar laminar, enum oracle_correction viscous)
{
  oracle *o = &s->o;
  o->continuity = o->pressure = rows[row];
  o->exponent = 0.5L;
  o->pressure_corrected = pressure;
  o->continuity_corrected = pressure ? ORACLE_ONE_SIDED : ORACLE_PLAIN;
  o->laminar = laminar, o->laminar_corrected = viscous;
  sph_sim *sim = scene_sim(s, (scene_options){0});
  scene_rates rates = scene_evaluate(s, sim);
  sph_sim_free(sim);
  return rates;
}

/* |sum m a| of its size, the largest direction. */
static double lost_momentum(const scene *s, const scene_rates *r)
{
  real most = 0;
  for (int d = 0; d < s->o.dim; d++) {
    balance force = {0, 0};
    for (long i = 0; i < r->n; i++) add(&force, s->o.particle[i].m * r->a[d][i]);
    most = fmaxl(most, fabsl(force.sum) / force.size);
  }
  return (double)most;
}

static double lost_energy(const scene *s, const scene_rates *r)
{
  balance power = {0, 0};
  for (long i = 0; i < r->n; i++) {
    add(&power, power_of(s, r, i));
    add(&power, s->o.particle[i].m * r->du[i]);
  }
  return (double)(fabsl(power.sum) / power.size);
}

static double twist(const scene *s, const scene_rates *r)
{
  real most = 0;
  for (int d = s->o.dim == 2 ? 2 : 0; d < 3; d++) {
    balance b = torque_of(s, r, d);
    most = fmaxl(most, fabsl(b.sum) / b.size);
  }
  return (double)most;
}

/* Free clouds of gas, with and without viscosity.  Row c2 keeps angular momentum, too: its twist
 * is sum V_i p_i (r cross B_i r) V_j F, and B_i M_i is symmetric; with other weights than V_j it is
 * not M_i that is summed. */
static void kept(void **state)
{
  (void)state;
  double momentum = 0, energy = 0, torque = INFINITY, one_sided = INFINITY, central = 0;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene s;
    scene_def def = scene_number(k, 1, 0);
    def.laminar = 1;
    scene_make(&s, &def);
    for (int row = 0; row < 3; row++) {
      scene_rates r = rates_of(&s, row, ORACLE_MEAN, (enum oracle_laminar)(k % 3), ORACLE_MEAN);
      momentum = fmax(momentum, lost_momentum(&s, &r));
      energy = fmax(energy, lost_energy(&s, &r));
      scene_rates_free(&r);
      r = rates_of(&s, row, ORACLE_MEAN, ORACLE_INVISCID, ORACLE_PLAIN);
      if (def.dim > 1 && row > 0) torque = fmin(torque, twist(&s, &r));
      if (def.dim > 1 && row == 0) central = fmax(central, twist(&s, &r));
      scene_rates_free(&r);
      r = rates_of(&s, row, ORACLE_ONE_SIDED, ORACLE_INVISCID, ORACLE_PLAIN);
      one_sided = fmin(one_sided, lost_momentum(&s, &r));
      scene_rates_free(&r);
    }
    scene_rates r = rates_of(&s, 0, ORACLE_PLAIN, ORACLE_MCG, ORACLE_MEAN);
    if (def.dim > 1) central = fmax(central, twist(&s, &r));
    scene_rates_free(&r);
    scene_free(&s);
  }
  print_message(
      "# mean: sum m a %.2g, energy %.2g, sum m x cross a %.2g (c2, mcg), %.2g and more (s, phi); "
      "one-sided: sum m a %.2g and more\n",
      momentum, energy, central, torque, one_sided);
  assert_true(momentum <= 1e-13 && energy <= 1e-13 && central <= 1e-13);
  assert_true(torque > 1e-7 && one_sided > 1e-4);
}

/* Of viscosity alone: no fluid particle is cooled. */
static void heats(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride())
    for (int form = ORACLE_MORRIS; form <= ORACLE_MCG; form++) {
      scene s;
      scene_def def = scene_number(k, 1, k % 2);
      def.laminar = 1;
      scene_make(&s, &def);
      s.o.laminar = (enum oracle_laminar)form;
      s.o.laminar_corrected = k % 2 ? ORACLE_MEAN : ORACLE_ONE_SIDED;
      sph_sim *sim = scene_sim(&s, (scene_options){0});
      scene_rates r = scene_evaluate(&s, sim);
      for (long i = 0; i < r.n; i++) assert_true(r.du[i] >= 0);
      scene_rates_free(&r);
      sph_sim_free(sim);
      scene_free(&s);
    }
}

/* ---- viscosity on a lattice ---- */

/* a_x over nu lap v of v_x = y^2 in the middle of a square lattice. */
static double viscosity_ratio(const char *correction)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.05});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1);
  sph_group_set_eos(water, sph_eos_linear(1, 10, -INFINITY));
  sph_group_set_viscosity(water, 0.01);
  sph_sim_add_term(sim, sph_term_corrected(sph_term_viscosity_laminar("morris"), correction));
  const double *y = sph_group_read(water, "position", 1);
  double *v = sph_group_write(water, "velocity", 0);
  long middle = 0;
  for (long i = 0; i < sph_group_count(water); i++) {
    const double *x = sph_group_read(water, "position", 0);
    v[i] = y[i] * y[i];
    if (hypot(x[i] - 0.525, y[i] - 0.525) < 1e-9) middle = i;
  }
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  double ratio = sph_group_rate(water, "velocity", 0)[middle] / (0.01 * 2);
  sph_sim_free(sim);
  return ratio;
}

static void viscosity(void **state)
{
  (void)state;
  double plain = viscosity_ratio("none");
  print_message("# effective over nominal viscosity: %.6f, corrected %.6f\n", plain,
                viscosity_ratio("mean"));
  assert_near(plain, 1 - 2.600732e-3, 1e-8); /* -(1/d) sum V r.grad W of that lattice */
  assert_near(viscosity_ratio("one-sided"), 1, 1e-12);
  assert_near(viscosity_ratio("mean"), 1, 1e-12);
}

/* ---- runs ---- */

enum { ACROSS = 50 };

static void run_cloud(int threads, double *out)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 1.0 / ACROSS, .threads = threads});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, rho0);
  sph_group *tank = sph_group_create(sim, "tank", "wall");
  sph_group_add_layers(tank, (double[]){0, 0}, (double[]){1.2, 1}, "x- y+", rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, 20, 7));
  sph_group_set_boundary(tank, sph_boundary_adami_no_slip());
  sph_group_set_viscosity(water, 1);
  sph_group_jitter(water, 0.1, 4);
  sph_sim_add_term(sim, sph_term_corrected(sph_term_continuity(), "one-sided"));
  sph_sim_add_term(sim, sph_term_corrected(sph_term_pressure(), "mean"));
  sph_sim_add_term(sim, sph_term_corrected(sph_term_viscosity_laminar("mcg"), "mean"));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -1, 0}));
  for (int k = 0; k < 12; k++)
    if (sph_sim_step(sim) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  for (int d = 0; d < 2; d++)
    memcpy(out + d * ACROSS * ACROSS, sph_group_read(water, "velocity", d),
           ACROSS * ACROSS * sizeof(double));
  sph_sim_free(sim);
}

static void any_threads(void **state)
{
  (void)state;
  static double one[2 * ACROSS * ACROSS], other[2 * ACROSS * ACROSS];
  run_cloud(1, one);
  for (int threads = 2; threads <= 3; threads++) {
    run_cloud(threads, other);
    assert_memory_equal(one, other, sizeof one);
  }
}

/* Tiles beside corrected terms add to them what they add to others. */
static void swap(const sph_term *term, const sph_tile *tile)
{
  (void)term;
  for (long k = 0; k < tile->n; k++) tile->push[k] += 3 * tile->V[k] * tile->F[k];
}

static void beside_tiles(void **state)
{
  (void)state;
  double *a[4];
  for (int k = 0; k < 4; k++) {
    cloud it = make_cloud(2, 0, NULL, "one-sided", "mean");
    if (k & 1) sph_sim_add_term(it.sim, (sph_term){.name = "swap", .pair = swap, .adds = "push"});
    if (k > 1) sph_sim_add_term(it.sim, sph_term_delta("antuono", 0.1));
    set_linear(&it);
    a[k] = malloc((size_t)it.n * sizeof(double));
    memcpy(a[k], sph_group_rate(it.water, "velocity", 0), (size_t)it.n * sizeof(double));
    if (k == 1 || k == 3) {
      cloud alone = make_cloud(2, 0, NULL, NULL, NULL);
      cloud with = make_cloud(2, 0, NULL, NULL, NULL);
      sph_sim_add_term(with.sim, (sph_term){.name = "swap", .pair = swap, .adds = "push"});
      set_linear(&alone), set_linear(&with);
      for (long i = 0; i < it.n; i++) {
        double added = sph_group_rate(with.water, "velocity", 0)[i] -
                       sph_group_rate(alone.water, "velocity", 0)[i];
        assert_near(a[k][i] - a[k - 1][i], added, 1e-9);
      }
      sph_sim_free(alone.sim), sph_sim_free(with.sim);
    }
    sph_sim_free(it.sim);
  }
  for (int k = 0; k < 4; k++) free(a[k]);
}

/* ---- keys of case files ---- */

static void keys(void **state)
{
  (void)state;
  static const char text[] =
      "dimension: 2\nspacing: 0.1\ngroups:\n"
      "  water: {kind: fluid, density: 1000, eos: {tait: {sound_speed: 10}}, viscosity: 1,\n"
      "    shapes: [{box: {lower: [0, 0], upper: [1, 1]}}]}\n"
      "terms: {continuity: {correction: one-sided}, pressure: {correction: mean},\n"
      "  viscosity-laminar: {correction: one-sided}}\n"
      "density_reset: {kind: shepard, every: 7}\nrun: {end: 0.01}\n";
  sph_error error = {0};
  sph_case *c = sph_case_read_text("case.yml", text, strlen(text), 0, NULL, &error);
  sph_sim *sim = sph_case_build(c, 1, &error);
  if (!sim) fail_msg("%s", error.text);
  assert_int_equal(sim->terms.bits & SPH_CORRECTED,
                   SPH_CONTINUITY_CORRECTED | SPH_PRESSURE_MEAN | SPH_LAMINAR_ONE_SIDED);
  assert_int_equal(sim->modifiers, 1);
  assert_string_equal(sim->modifier[0].name, "density-reset");
  assert_int_equal(sim->modifier[0].modifier.steps, 7);
  assert_int_equal(sph_sim_run(sim, 0.01), SPH_OK);
  sph_sim_free(sim);
  sph_case_free(c);
}

/* ---- what is refused ---- */

static void own_pair(const sph_term *term, const sph_tile *tile) { (void)term, (void)tile; }

enum { WHOLE, IMPLICIT, SCALAR, JACOBIAN };

static void refused(void **state)
{
  (void)state;
  static const struct {
    const char *continuity, *pressure, *viscosity, *artificial;
    int summed, how;
    const char *text;
  } wrong[] = {
      {"one-sided", NULL, NULL, NULL, 0, WHOLE, "do not conserve energy"},
      {NULL, "mean", NULL, NULL, 0, WHOLE, "do not conserve energy"},
      {"mean", "mean", NULL, NULL, 0, WHOLE, "correction \"mean\"; known: none, one-sided"},
      {NULL, "both", NULL, NULL, 0, WHOLE, "known: none, one-sided, mean"},
      {NULL, NULL, "men", NULL, 0, WHOLE, "term viscosity-laminar: correction \"men\""},
      {NULL, NULL, NULL, "mean", 0, WHOLE, "only continuity, pressure and viscosity-laminar"},
      {NULL, "mean", NULL, NULL, 1, WHOLE, "beside summation right is none or one-sided"},
      {NULL, NULL, "mean", NULL, 0, IMPLICIT, "cannot be implicit"},
      {"one-sided", "mean", NULL, NULL, 0, SCALAR, "no room for both"},
      {"one-sided", "mean", NULL, NULL, 0, JACOBIAN, "no derivatives"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
    sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, rho0);
    sph_group_set_eos(water, sph_eos_tait(rho0, 10, 7));
    sph_group_set_viscosity(water, 1);
    sph_term density = wrong[k].summed ? sph_term_summation(1) : sph_term_continuity();
    sph_sim_add_term(sim, sph_term_corrected(density, wrong[k].continuity));
    sph_sim_add_term(sim, sph_term_corrected(sph_term_pressure_form(wrong[k].summed ? "s" : "c2"),
                                             wrong[k].pressure));
    sph_sim_add_term(sim,
                     sph_term_corrected(sph_term_viscosity_laminar("morris"), wrong[k].viscosity));
    sph_sim_add_term(sim, sph_term_corrected(sph_term_viscosity_artificial(0.1, 0),
                                             wrong[k].artificial));
    if (wrong[k].how == IMPLICIT) sph_sim_set_part(sim, "viscosity-laminar", "implicit");
    if (wrong[k].how == SCALAR)
      sph_sim_add_term(sim, (sph_term){.name = "dye",
                                       .pair = own_pair,
                                       .scalar = {.name = "c", .scale = 1}});
    int status = sph_sim_evaluate(sim);
    if (wrong[k].how == JACOBIAN) {
      assert_int_equal(status, SPH_OK);
      sph_jacobian *J = sph_jacobian_create(sim, NULL);
      if (J) sph_jacobian_evaluate(J);
      status = sph_sim_status(sim);
      sph_jacobian_free(J);
    }
    if (status != SPH_ERR_ARGUMENT || !strstr(sph_sim_error(sim), wrong[k].text))
      fail_msg("%zu: status %d, \"%s\"", k, status, sph_sim_error(sim));
    sph_sim_free(sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact),     cmocka_unit_test(kept),        cmocka_unit_test(heats),
      cmocka_unit_test(viscosity), cmocka_unit_test(any_threads), cmocka_unit_test(beside_tiles),
      cmocka_unit_test(keys),      cmocka_unit_test(refused),
  };
  return cmocka_run_group_tests_name("corrected gradients", tests, NULL, NULL);
}
