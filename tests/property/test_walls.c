/* Walls: what images and dynamic boundary particles are, whatever the state.
 *
 * Mirror: a fluid with its reflections written out as particles has the rates of the fluid between
 * mirrors, term by term: planes, edges, corners, a tilted one that moves.  DBC: the rate of density
 * is the sum over the fluid, written again here.  Both: the same bits for any number of threads and
 * over a restart; what they do not go with is refused by name; no particle leaves a box. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <math.h>

#include "near.h"
#include "sphode.h"

enum { MOST = 4096 };

static double chance(void)
{
  static unsigned long state = 88172645463325252ul;
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return (double)(state >> 11) / 9007199254740992.0;
}

/* ---- mirrors against reflections that are written out ---- */

typedef struct cloud {
  int dim;
  long n;
  double x[3][MOST], v[3][MOST], rho[MOST], u[MOST];
} cloud;

/* Particle i, reflected in the plane through `point` with unit normal n, which moves with v_b. */
static void add_image(cloud *c, long i, const double *point, const double *n, const double *v_b)
{
  double d = 0, w = 0;
  const long j = c->n++;
  assert_true(j < MOST);
  for (int k = 0; k < c->dim; k++) {
    d += (c->x[k][i] - point[k]) * n[k];
    w += (c->v[k][i] - v_b[k]) * n[k];
  }
  for (int k = 0; k < c->dim; k++) {
    c->x[k][j] = c->x[k][i] - 2 * d * n[k];
    c->v[k][j] = c->v[k][i] - 2 * w * n[k];
  }
  c->rho[j] = c->rho[i];
  c->u[j] = c->u[i];
}

static void all_terms(sph_sim *sim, const char *form)
{
  sph_sim_add_term(sim, !strcmp(form, "phi") ? sph_term_continuity_phi(0.5)
                                             : sph_term_continuity_form(form));
  sph_sim_add_term(sim, sph_term_pressure_form(!strcmp(form, "c1") ? "s" : form));
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.5, 1));
  sph_sim_add_term(sim, sph_term_viscosity_signal(0.3, 2));
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_conductivity_artificial(0.7));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_add_term(sim, sph_term_delta("molteni", 0.1));
  sph_sim_add_term(sim, sph_term_xsph(0.3));
}

/* A gas of the first n particles of c. */
static sph_sim *gas(const cloud *c, long n, const sph_sim_def *def, const char *form)
{
  sph_sim *sim = sph_sim_create(def);
  sph_group *group = sph_group_create(sim, "gas", "fluid");
  sph_group_add_points(group, n, (const double *const[]){c->x[0], c->x[1], c->x[2]}, 1);
  sph_eos eos = sph_eos_ideal_gas(1.4);
  eos.c_v = 2, eos.rho0 = 1, eos.c0 = 1;
  sph_group_set_eos(group, eos);
  sph_group_set_viscosity(group, 0.3);
  sph_group_set_conductivity(group, 0.7);
  for (int k = 0; k < c->dim; k++)
    memcpy(sph_group_write(group, "velocity", k), c->v[k], (size_t)n * sizeof(double));
  double *m = sph_group_write(group, "mass", 0);
  for (long i = 0; i < n; i++) m[i] *= c->rho[i];
  memcpy(sph_group_write(group, "density", 0), c->rho, (size_t)n * sizeof(double));
  memcpy(sph_group_write(group, "energy", 0), c->u, (size_t)n * sizeof(double));
  all_terms(sim, form);
  return sim;
}

/* The rates of the first n particles, which both have, relative to the largest of each field; last:
 * the fourth field, or NULL. */
static void same_rates(sph_sim *a, sph_sim *b, long n, int dim, const char *last)
{
  const char *const field[] = {"position", "velocity", "density", last};
  if (sph_sim_evaluate(a) || sph_sim_evaluate(b))
    fail_msg("%s; %s", sph_sim_error(a), sph_sim_error(b));
  for (int f = 0; f < 4 && field[f]; f++)
    for (int k = 0; k < (f < 2 ? dim : 1); k++) {
      const double *p = sph_group_rate(sph_sim_group(a, "gas"), field[f], k);
      const double *q = sph_group_rate(sph_sim_group(b, "gas"), field[f], k);
      double most = 0;
      for (long i = 0; i < n; i++) most = fmax(most, fabs(q[i]));
      if (!(most > 1e-3)) fail_msg("%s: at most %g", field[f], most);
      for (long i = 0; i < n; i++)
        if (!(fabs(p[i] - q[i]) <= 2e-12 * most))
          fail_msg("%s %d of particle %ld: %.17g with mirrors, %.17g with reflections", field[f], k,
                   i, p[i], q[i]);
    }
}

static void scatter(cloud *c, int dim, int across)
{
  c->dim = dim;
  c->n = 0;
  for (int cell = 0; cell < (dim == 3 ? across * across * across : across * across); cell++) {
    const long i = c->n++;
    const int at[3] = {cell % across, cell / across % across, cell / across / across};
    for (int k = 0; k < dim; k++) {
      c->x[k][i] = (at[k] + 0.5 + 0.4 * (2 * chance() - 1)) / across;
      c->v[k][i] = 2 * chance() - 1;
    }
    c->rho[i] = 1 + 0.2 * chance();
    c->u[i] = 1 + chance();
  }
}

/* [0, 1]^dim between mirrors, and twice as wide a periodic box of it and its reflections. */
static void box_of_mirrors(int dim, int across, const char *form)
{
  static cloud c;
  static const double zero[3];
  scatter(&c, dim, across);
  const long n = c.n;
  for (int k = 0; k < dim; k++) {
    double normal[3] = {0};
    normal[k] = 1;
    for (long i = 0, end = c.n; i < end; i++) add_image(&c, i, zero, normal, zero);
  }
  sph_sim_def def = {.dim = dim, .dx = 1.0 / across, .h_over_dx = 1.3};
  sph_sim *mirrored = gas(&c, n, &def, form);
  sph_group *walls = sph_group_create(mirrored, "walls", "wall");
  sph_boundary boundary = sph_boundary_mirror();
  sph_boundary_mirror_box(&boundary, zero, (double[]){1, 1, 1}, NULL, dim);
  sph_group_set_boundary(walls, boundary);
  for (int k = 0; k < dim; k++) def.periodic[k] = 1, def.origin[k] = -1, def.length[k] = 2;
  sph_sim *whole = gas(&c, c.n, &def, form);
  same_rates(mirrored, whole, n, dim, "energy");
  assert_true(sph_group_count(walls) > n / 2);
  sph_sim_free(mirrored), sph_sim_free(whole);
}

static void planes_edges_corners(void **state)
{
  (void)state;
  box_of_mirrors(2, 12, "c2");
  box_of_mirrors(2, 12, "c1");
  box_of_mirrors(2, 12, "phi");
  box_of_mirrors(3, 7, "c2");
}

/* A liquid of the first n particles of c that shifts, whose viscosity is switched, or, where that
 * of the term is, with corrected gradients. */
static sph_sim *drifting(const cloud *c, long n, const sph_sim_def *def, sph_term term)
{
  sph_sim *sim = sph_sim_create(def);
  sph_group *group = sph_group_create(sim, "gas", "fluid");
  sph_group_add_points(group, n, (const double *const[]){c->x[0], c->x[1], c->x[2]}, 1);
  sph_group_set_eos(group, sph_eos_tait(1, 10, 7));
  for (int k = 0; k < c->dim; k++)
    memcpy(sph_group_write(group, "velocity", k), c->v[k], (size_t)n * sizeof(double));
  memcpy(sph_group_write(group, "density", 0), c->rho, (size_t)n * sizeof(double));
  const int mean = term.correction != NULL;
  sph_group_set_viscosity(group, 0.3);
  sph_sim_add_term(sim, sph_term_corrected(sph_term_continuity(), mean ? "one-sided" : NULL));
  sph_sim_add_term(sim, sph_term_corrected(sph_term_pressure(), term.correction));
  sph_sim_add_term(sim, term);
  double *alpha = term.switches ? sph_group_write(group, "alpha", 0) : NULL; /* NULL: balsara */
  for (long i = 0; alpha && i < n; i++) alpha[i] = 0.3 * c->u[i];
  return sim;
}

/* Shifting, its free surface (liquid in the middle), the transport velocity and switches take
 * images into their gradients; means of both ends take factors, alpha and matrices of images. */
static void drifts(int dim, int across, int surface, const char *last, sph_term term)
{
  static cloud c;
  const double zero[3] = {0}, one[3] = {1, 1, 1};
  scatter(&c, dim, across);
  for (long i = 0; surface && i < c.n; i++) c.x[dim - 1][i] *= 0.5, c.x[dim - 1][i] += 0.25;
  const long n = c.n;
  for (int k = 0; k < dim; k++) {
    double normal[3] = {0};
    normal[k] = 1;
    for (long i = 0, end = c.n; i < end; i++) add_image(&c, i, zero, normal, zero);
  }
  sph_sim_def def = {.dim = dim, .dx = 1.0 / across, .h_over_dx = 1.3};
  sph_sim *mirrored = drifting(&c, n, &def, term);
  sph_group *walls = sph_group_create(mirrored, "walls", "wall");
  sph_boundary boundary = sph_boundary_mirror();
  sph_boundary_mirror_box(&boundary, zero, one, NULL, dim);
  sph_group_set_boundary(walls, boundary);
  for (int k = 0; k < dim; k++) def.periodic[k] = 1, def.origin[k] = -1, def.length[k] = 2;
  sph_sim *whole = drifting(&c, c.n, &def, term);
  same_rates(mirrored, whole, n, dim, last);
  sph_sim_free(mirrored), sph_sim_free(whole);
}

static void shifting_and_switches(void **state)
{
  (void)state;
  sph_term inside = sph_term_shifting("delta-plus", 1), along = sph_term_shifting("fick", 1);
  inside.surface = 0;
  for (int dim = 2; dim <= 3; dim++) {
    const int across = dim == 2 ? 12 : 7;
    drifts(dim, across, 0, NULL, inside);
    drifts(dim, across, 1, NULL, along);
    drifts(dim, across, 0, NULL, sph_term_transport_velocity(0, 0));
    drifts(dim, across, 0, "alpha",
           sph_term_switched(sph_term_viscosity_artificial(1, 2), "morris-monaghan", 0.1));
    drifts(dim, across, 0, "alpha",
           sph_term_switched(sph_term_viscosity_artificial(1, 2), "cullen-dehnen", 0));
    drifts(dim, across, 0, NULL,
           sph_term_switched(sph_term_viscosity_artificial(1, 2), "balsara", 0));
    drifts(dim, across, 0, "alpha",
           sph_term_switched(sph_term_viscosity_signal(1, 3), "balsara morris-monaghan", 0.1));
    drifts(dim, across, 0, NULL, sph_term_corrected(sph_term_viscosity_laminar("morris"), "mean"));
    drifts(dim, across, 0, NULL, sph_term_corrected(sph_term_viscosity_laminar("mcg"), "mean"));
  }
}

static sph_sim *corrected(const cloud *c, long n, const sph_sim_def *def, const char *form)
{
  (void)form;
  return drifting(c, n, def, sph_term_corrected(sph_term_viscosity_laminar("morris"), "mean"));
}

/* A plane and one at right angles to it, of another group, both tilted and moving. */
static void tilt(sph_sim *make(const cloud *, long, const sph_sim_def *, const char *),
                 const char *last)
{
  static cloud c;
  const double a = 0.3, one[3] = {cos(a), sin(a)}, two[3] = {-sin(a), cos(a)};
  const double at[3] = {-0.3, -0.4}, v_b[3] = {0.3, -0.2};
  scatter(&c, 2, 14);
  for (long i = 0; i < c.n; i++) { /* in front of both */
    const double x = c.x[0][i], y = c.x[1][i];
    for (int k = 0; k < 2; k++) c.x[k][i] = at[k] + x * one[k] + y * two[k];
  }
  const long n = c.n;
  for (long i = 0, end = c.n; i < end; i++) add_image(&c, i, at, one, v_b);
  for (long i = 0, end = c.n; i < end; i++) add_image(&c, i, at, two, v_b);
  const sph_sim_def def = {.dim = 2, .dx = 1.0 / 14};
  sph_sim *mirrored = make(&c, n, &def, "c2"), *whole = make(&c, c.n, &def, "c2");
  const double *normal[] = {one, two};
  for (int k = 0; k < 2; k++) {
    sph_group *wall = sph_group_create(mirrored, k ? "two" : "one", "wall");
    sph_boundary boundary = sph_boundary_mirror();
    const double twice[3] = {2 * normal[k][0], 2 * normal[k][1]};
    sph_boundary_mirror_plane(&boundary, at, twice, 2);
    boundary.motion = NULL;
    sph_group_set_boundary(wall, boundary);
  }
  for (long i = 0; i < n; i++) /* the same in the frame of the planes */
    for (int k = 0; k < 2; k++) {
      sph_group_write(sph_sim_group(mirrored, "gas"), "velocity", k)[i] -= v_b[k];
      sph_group_write(sph_sim_group(whole, "gas"), "velocity", k)[i] -= v_b[k];
    }
  for (long i = n; i < c.n; i++)
    for (int k = 0; k < 2; k++)
      sph_group_write(sph_sim_group(whole, "gas"), "velocity", k)[i] -= v_b[k];
  same_rates(mirrored, whole, n, 2, last);
  sph_sim_free(mirrored), sph_sim_free(whole);
}

static void tilted(void **state)
{
  (void)state;
  tilt(gas, "energy");
  tilt(corrected, NULL);
}

/* A piston: its plane at x = 0.3 t. */
static void push(void *ctx, double t, double displacement[3], double velocity[3],
                 double acceleration[3])
{
  (void)ctx;
  for (int d = 0; d < 3; d++) displacement[d] = velocity[d] = acceleration[d] = 0;
  displacement[0] = 0.3 * t;
  velocity[0] = 0.3;
}

/* Slowly pushed gas is compressed as (1 - 0.3 t)^-gamma says, and no particle is left behind. */
static void piston(void **state)
{
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.02});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, 1);
  sph_group_set_eos(gas, sph_eos_ideal_gas(1.4));
  for (int k = 0; k < 2; k++) {
    sph_boundary boundary = sph_boundary_mirror();
    sph_boundary_mirror_plane(&boundary, k ? (double[]){1} : (double[]){0},
                              k ? (double[]){-1} : (double[]){1}, 1);
    boundary.motion = k ? NULL : push;
    sph_group_set_boundary(sph_group_create(sim, k ? "end" : "piston", "wall"), boundary);
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(1, 2));
  double *u = sph_group_write(gas, "energy", 0), mean = 0;
  for (long i = 0; i < 50; i++) u[i] = 1000; /* c = 24: the piston is slow */
  if (sph_sim_run(sim, 1)) fail_msg("%s", sph_sim_error(sim));
  const double *x = sph_group_read(gas, "position", 0), *p = sph_group_read(gas, "pressure", 0);
  for (long i = 0; i < 50; i++) {
    assert_true(x[i] > 0.3 && x[i] < 1);
    mean += p[i] / 50;
  }
  const double exact = 400 * pow(0.7, -1.4);
  print_message("# piston: p = %.5g, adiabatic %.5g\n", mean, exact);
  assert_near(mean / exact, 1, 0.01);
  sph_sim_free(sim);
}

/* The room to the other end was enough at the start; the step after which it is not is told. */
static void closes(void **state)
{
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.02, .h_over_dx = 1.5});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0.96}, (double[]){1}, 1);
  sph_group_set_eos(gas, sph_eos_ideal_gas(1.4));
  for (int k = 0; k < 2; k++) {
    sph_boundary boundary = sph_boundary_mirror();
    sph_boundary_mirror_plane(&boundary, k ? (double[]){1} : (double[]){0},
                              k ? (double[]){-1} : (double[]){1}, 1);
    boundary.motion = k ? NULL : push;
    sph_group_set_boundary(sph_group_create(sim, k ? "end" : "piston", "wall"), boundary);
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  for (long i = 0; i < 2; i++) sph_group_write(gas, "energy", 0)[i] = 0.01;
  assert_int_equal(sph_sim_run(sim, 2.7), SPH_OK); /* 0.19 m apart */
  assert_true(sph_sim_run(sim, 3.2) < 0);
  const double t = sph_sim_time(sim), room = 1 - 0.3 * t;
  char told[80];
  snprintf(told, sizeof told, "t = %g s: mirrors piston and end have moved to %g m", t, room);
  if (!strstr(sph_sim_error(sim), told)) fail_msg("%s not in: %s", told, sph_sim_error(sim));
  assert_true(room < 0.1 && room > 0.04); /* the support is 0.06 m */
  sph_sim_free(sim);
}

/* Far from the liquid, which rests, there are no images: they come with the piston. */
static void comes_near(void **state)
{
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 0.02, .speed = 1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0.5}, (double[]){1}, 1);
  sph_group *wall = sph_group_create(sim, "piston", "wall");
  sph_boundary boundary = sph_boundary_mirror();
  sph_boundary_mirror_plane(&boundary, (double[]){0}, (double[]){1}, 1);
  boundary.motion = push;
  sph_group_set_boundary(wall, boundary);
  sph_group_set_eos(water, sph_eos_linear(1, 10, -INFINITY));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  assert_int_equal(sph_group_count(wall), 0);
  if (sph_sim_run(sim, 1.55)) fail_msg("%s", sph_sim_error(sim)); /* at 0.465 */
  assert_true(sph_group_count(wall) > 0);
  sph_sim_free(sim);
}

/* ---- dynamic boundary particles ---- */

static sph_sim *pool(const char *model, int threads)
{
  const double dx = 0.05, lo[] = {0, 0}, hi[] = {1, 1.5};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .threads = threads});
  sph_group *water = sph_group_box(sim, "water", lo, (double[]){0.5, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 40, 7));
  sph_group *tank = sph_group_create(sim, "tank", "wall");
  sph_boundary boundary = !strcmp(model, "dbc") ? sph_boundary_dbc() : sph_boundary_mirror();
  if (!strcmp(model, "dbc"))
    sph_group_add_layers(tank, lo, hi, "y+", 1000);
  else
    sph_boundary_mirror_box(&boundary, lo, hi, "y+", 2);
  sph_group_set_boundary(tank, boundary);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.05, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -9.81}));
  if (strstr(model, "shifting")) sph_sim_add_term(sim, sph_term_shifting("delta-plus", 5));
  return sim;
}

/* d rho_w/dt by two loops; where rho_w = rho0 and it would fall: 0. */
static void dynamic_rates(void **state)
{
  (void)state;
  sph_sim *sim = pool("dbc", 1);
  sph_group *water = sph_sim_group(sim, "water"), *tank = sph_sim_group(sim, "tank");
  const sph_kernel *kernel = sph_kernel_find("wendland-c2");
  for (int k = 0; k < 2; k++)
    for (long i = 0; i < sph_group_count(water); i++)
      sph_group_write(water, "velocity", k)[i] = chance() - 0.5;
  for (long w = 0; w < sph_group_count(tank); w++)
    sph_group_write(tank, "density", 0)[w] = 1000 + (w % 2 ? 5 * chance() : 0);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  const double *rate = sph_group_rate(tank, "density", 0), h = sph_sim_h(sim);
  const double *rho = sph_group_read(tank, "density", 0), *p = sph_group_read(tank, "pressure", 0);
  const double *m = sph_group_read(water, "mass", 0), *rho_f = sph_group_read(water, "density", 0);
  long held = 0, moved = 0;
  for (long w = 0; w < sph_group_count(tank); w++) {
    double sum = 0, r[2], pressure, c;
    for (long f = 0; f < sph_group_count(water); f++) {
      double r2 = 0, rv = 0;
      for (int k = 0; k < 2; k++) {
        r[k] = sph_group_read(tank, "position", k)[w] - sph_group_read(water, "position", k)[f];
        r2 += r[k] * r[k];
        rv -= r[k] * sph_group_read(water, "velocity", k)[f];
      }
      sum += m[f] / rho_f[f] * rv * sph_kernel_dwdr(kernel, 2, sqrt(r2), h) / sqrt(r2);
    }
    const double exact = rho[w] <= 1000 && sum < 0 ? 0 : rho[w] * sum;
    held += exact == 0 && sum < 0;
    moved += exact != 0;
    assert_near(rate[w], exact, 1e-9 * 1000);
    sph_group_eos(tank)->pressure(sph_group_eos(tank), 1, &rho[w], NULL, &pressure, &c);
    assert_near(p[w], pressure, 1e-9 * (1 + fabs(pressure)));
  }
  assert_true(held > 10 && moved > 50);
  sph_sim_free(sim);
}

/* ---- the same bits ---- */

static void *copy_of(const sph_sim *sim, const char *group, const char *field, int c, size_t *bytes)
{
  const sph_group *g = sph_sim_group(sim, group);
  *bytes = (size_t)sph_group_count(g) * sizeof(double);
  void *copy = malloc(*bytes);
  memcpy(copy, sph_group_read(g, field, c), *bytes);
  return copy;
}

static void same_bits(const sph_sim *a, const sph_sim *b, const char *group, const char *field,
                      int c)
{
  size_t m, n;
  void *p = copy_of(a, group, field, c, &m), *q = copy_of(b, group, field, c, &n);
  assert_int_equal(m, n);
  if (memcmp(p, q, m)) fail_msg("%s of %s differs", field, group);
  free(p), free(q);
}

static void same_state(const sph_sim *a, const sph_sim *b)
{
  for (int c = 0; c < 2; c++) {
    same_bits(a, b, "water", "position", c);
    same_bits(a, b, "water", "velocity", c);
    same_bits(a, b, "tank", "position", c);
  }
  same_bits(a, b, "water", "density", 0);
  same_bits(a, b, "tank", "density", 0);
  same_bits(a, b, "tank", "pressure", 0);
}

static int stop(void *ctx, sph_sim *sim)
{
  (void)ctx;
  return sph_sim_time(sim) >= 0.15;
}

/* Uninterrupted with 1 and with 3 threads; stopped, and from its checkpoint on. */
static void bits(const char *model)
{
  char path[200], directory[] = "/tmp/sphode_walls_XXXXXX";
  assert_non_null(mkdtemp(directory));
  sph_sim *one = pool(model, 1), *three = pool(model, 3), *part = pool(model, 1);
  sph_sim *rest = pool(model, 2);
  assert_int_equal(sph_sim_run(one, 0.3), SPH_OK);
  assert_int_equal(sph_sim_run(three, 0.3), SPH_OK);
  same_state(one, three);
  sph_checkpoint_set(part, &(sph_checkpoint_def){.directory = directory});
  sph_sim_set_progress(part, stop, NULL);
  assert_int_equal(sph_sim_run(part, 0.3), SPH_ERR_STOPPED);
  assert_true(sph_checkpoint_find(directory, 0, path, sizeof path));
  if (sph_checkpoint_read(rest, path)) fail_msg("%s", sph_sim_error(rest));
  assert_true(sph_sim_time(rest) < 0.2);
  if (sph_sim_run(rest, 0.3)) fail_msg("%s", sph_sim_error(rest));
  same_state(one, rest);
  sph_sim_free(one), sph_sim_free(three), sph_sim_free(part), sph_sim_free(rest);
  for (int k = 0; sph_checkpoint_find(directory, 0, path, sizeof path) && k < 9; k++) unlink(path);
  rmdir(directory);
}

static void same_bits_always(void **state)
{
  (void)state;
  bits("dbc");
  bits("mirror");
  bits("mirror, shifting");
}

/* The water hits the far wall at 3 times the usual speed: mirrors let nothing through. */
static void nothing_gets_through(void **state)
{
  (void)state;
  sph_sim *sim = pool("mirror", 1);
  sph_group *water = sph_sim_group(sim, "water");
  double *v = sph_group_write(water, "velocity", 0);
  for (long i = 0; i < sph_group_count(water); i++) v[i] = 12;
  if (sph_sim_run(sim, 0.2)) fail_msg("%s", sph_sim_error(sim));
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  for (long i = 0; i < sph_group_count(water); i++)
    assert_true(x[i] >= 0 && x[i] <= 1 && y[i] >= 0);
  sph_sim_free(sim);
}

/* ---- case files ---- */

static const char case_text[] = "dimension: 2\n"
                                "spacing: 0.05 m\n"
                                "groups:\n"
                                "  water:\n"
                                "    kind: fluid\n"
                                "    density: 1000 kg/m^3\n"
                                "    eos: {tait: {sound_speed: 40 m/s}}\n"
                                "    shapes: [box: {lower: [0, 0], upper: [0.5, 1]}]\n"
                                "  tank:\n"
                                "    kind: wall\n"
                                "    density: 1000 kg/m^3\n"
                                "    shapes: [%s]\n"
                                "    boundary: {%s}\n"
                                "terms:\n"
                                "  continuity:\n"
                                "  pressure:\n"
                                "  viscosity-artificial: {alpha: 0.05}\n"
                                "  delta: {model: antuono, delta: 0.1}\n"
                                "  gravity: {acceleration: [0, -9.81 m/s^2]}\n"
                                "run: {end: 1 s}\n";
static const char layers[] = "layers: {lower: [0, 0], upper: [1, 1.5], open: [y+]}";

static sph_sim *of_case(const char *shapes, const char *boundary, char problem[1000])
{
  char text[1500];
  sph_error error = {0};
  snprintf(text, sizeof text, case_text, shapes, boundary);
  sph_case *c = sph_case_read_text("tank.yml", text, strlen(text), 0, NULL, &error);
  sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
  snprintf(problem, 1000, "%s", error.text);
  sph_case_free(c);
  return sim;
}

/* The same walls from a case file as from C. */
static void cases(void **state)
{
  (void)state;
  char problem[1000];
  static const char *const model[] = {"dbc", "mirror", "mirror"};
  static const char *const boundary[] = {"model: dbc", "model: mirror",
                                         "model: mirror, heat_flux: 3 W/m^2"};
  static const char *const shapes[] = {
      layers, layers,
      "plane: {point: [0, 0], normal: [2, 0]}, plane: {point: [1, 9], normal: [-1, 0]}, "
      "plane: {point: [3, 0], normal: [0, 1]}"};
  for (int k = 0; k < 3; k++) {
    sph_sim *a = of_case(shapes[k], boundary[k], problem), *b = pool(model[k], 1);
    if (!a) fail_msg("%s", problem);
    assert_int_equal(sph_sim_run(a, 0.05), SPH_OK);
    assert_int_equal(sph_sim_run(b, 0.05), SPH_OK);
    if (k < 2) same_state(a, b);
    assert_int_equal(sph_group_count(sph_sim_group(a, "tank")),
                     sph_group_count(sph_sim_group(b, "tank")));
    sph_sim_free(a), sph_sim_free(b);
  }
  assert_null(of_case("plane: {point: [0, 0], normal: [1, 0]}", "model: adami", problem));
  assert_non_null(strstr(problem, "mirror"));
  assert_null(of_case("ball: {centre: [0, 0], radius: 1}", "model: mirror", problem));
  assert_non_null(strstr(problem, "planes"));
  assert_null(of_case(layers, "model: adami, heat_flux: 3 W/m^2", problem));
  assert_non_null(strstr(problem, "heat flux"));
}

/* ---- what they do not go with ---- */

static void told(sph_sim *sim, const char *what)
{
  assert_int_not_equal(sph_sim_evaluate(sim), SPH_OK);
  if (!strstr(sph_sim_error(sim), what)) fail_msg("not told %s: %s", what, sph_sim_error(sim));
  sph_sim_free(sim);
}

static sph_sim *with_planes(int n, const double (*point)[2], const double (*normal)[2])
{
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {0, 1}, .length = {0, 2}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 2}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 40, 7));
  sph_boundary boundary = sph_boundary_mirror();
  for (int k = 0; k < n; k++) sph_boundary_mirror_plane(&boundary, point[k], normal[k], 2);
  sph_group_set_boundary(sph_group_create(sim, "tank", "wall"), boundary);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  return sim;
}

static void refused(void **state)
{
  (void)state;
  told(with_planes(0, NULL, NULL), "planes");
  told(with_planes(1, (double[][2]){{0, 0}}, (double[][2]){{0, 0}}), "not zero");
  told(with_planes(1, (double[][2]){{0, 0}}, (double[][2]){{0, 1}}), "periodic");
  told(with_planes(1, (double[][2]){{0.3, 0}}, (double[][2]){{1, 0}}), "behind");
  told(with_planes(2, (double[][2]){{0, 0}, {1, 0}}, (double[][2]){{1, 0}, {-1, 1e-3}}),
       "periodic");
  told(with_planes(2, (double[][2]){{-0.2, 0}, {-0.1, 0}}, (double[][2]){{1, 0}, {1, 0}}), "apart");
  sph_sim *sim = pool("mirror", 1);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  assert_null(sph_sensitivity_create(sim, 1, &(sph_sensitivity_parameter){.name = "gravity.y"}));
  if (!strstr(sph_sim_error(sim), "adami")) fail_msg("%s", sph_sim_error(sim));
  sph_sim_free(sim);
  sim = pool("dbc", 1);
  assert_null(sph_jacobian_create(sim, NULL));
  if (!strstr(sph_sim_error(sim), "adami")) fail_msg("%s", sph_sim_error(sim));
  sph_sim_free(sim);
  sim = pool("dbc", 1);
  sph_sim_set_part(sim, "viscosity-artificial", "implicit");
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "imex:ark324l2sa-4-2-3"});
  told(sim, "adami walls alone");
  sim = with_planes(1, (double[][2]){{0, 0}}, (double[][2]){{1, 0}});
  sph_group_add_box(sph_sim_group(sim, "tank"), (double[]){-1, 0}, (double[]){-0.5, 2}, 1000);
  told(sim, "particles");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planes_edges_corners),
      cmocka_unit_test(shifting_and_switches),
      cmocka_unit_test(tilted),
      cmocka_unit_test(piston),
      cmocka_unit_test(closes),
      cmocka_unit_test(comes_near),
      cmocka_unit_test(dynamic_rates),
      cmocka_unit_test(same_bits_always),
      cmocka_unit_test(nothing_gets_through),
      cmocka_unit_test(cases),
      cmocka_unit_test(refused),
  };
  return cmocka_run_group_tests_name("walls", tests, NULL, NULL);
}
