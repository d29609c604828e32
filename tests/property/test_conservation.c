/* What the right-hand side keeps, whatever the state: momentum, angular momentum, energy, entropy,
 * mass of the diffusing density; the signs of what it loses; and the states that it leaves
 * alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "balance.h"
#include "quick.h"

typedef struct terms {
  enum oracle_row row;
  double alpha, beta, conductivity, delta;
  enum oracle_delta diffusion;
} terms;

static void set_terms(scene *s, const terms *t)
{
  oracle *o = &s->o;
  o->continuity = o->pressure = t->row;
  o->alpha = t->alpha, o->beta = t->beta, o->conductivity = t->conductivity;
  o->diffusion = t->diffusion, o->delta = t->delta;
}

static scene_rates rates_with(scene *s, const terms *t)
{
  set_terms(s, t);
  sph_sim *sim = scene_sim(s, (scene_options){0});
  scene_rates rates = scene_evaluate(s, sim);
  sph_sim_free(sim);
  return rates;
}

static const terms rows[] = {{.row = ORACLE_C1}, {.row = ORACLE_C2}};
static const terms dissipative[] = {
    {.row = ORACLE_C1, .alpha = 1, .beta = 2, .conductivity = 1},
    {.row = ORACLE_C2, .alpha = 1, .beta = 2, .conductivity = 1},
};

/* ---- momentum ---- */

static void momentum_with(scene *s, const terms *t)
{
  scene_rates r = rates_with(s, t);
  assert_momentum(s, &r);
  scene_rates_free(&r);
}

static void momentum(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, 1);
    scene s;
    scene_make(&s, &def);
    for (int t = 0; t < 2; t++) momentum_with(&s, &rows[t]);
    for (int t = 0; t < 2; t++) momentum_with(&s, &dissipative[t]);
    scene_free(&s);
  }
}

/* sum m x cross a of a free cloud: every force here is central. */
static void angular_momentum(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, 0);
    if (def.dim == 1) continue;
    scene s;
    scene_make(&s, &def);
    scene_rates r = rates_with(&s, &dissipative[k % 2]);
    for (int d = def.dim == 2 ? 2 : 0; d < 3; d++) {
      balance torque = torque_of(&s, &r, d);
      assert_zero(&torque, 1e-14, "sum m x cross a");
    }
    scene_rates_free(&r);
    scene_free(&s);
  }
}

/* ---- energy ---- */

/* sum m (v.a + du/dt) = 0: compression and its partner, viscosity and its heat, conduction. */
static void energy_of_gases(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, k / 3 % 2);
    scene s;
    scene_make(&s, &def);
    for (int t = 0; t < 4; t++) {
      scene_rates r = rates_with(&s, t < 2 ? &rows[t] : &dissipative[t - 2]);
      balance energy = {0, 0};
      for (long i = 0; i < r.n; i++) {
        add(&energy, power_of(&s, &r, i));
        add(&energy, s.o.particle[i].m * r.du[i]);
      }
      assert_zero(&energy, 1e-14, "sum m (v.a + du/dt)");
      scene_rates_free(&r);
    }
    scene_free(&s);
  }
}

/* sum m (v.a + p/rho^2 drho/dt) = 0: the elastic energy of a liquid. */
static void energy_of_liquids(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 0, k / 3 % 2);
    scene s;
    scene_make(&s, &def);
    for (int t = 0; t < 2; t++) {
      scene_rates r = rates_with(&s, &rows[t]);
      balance energy = {0, 0};
      for (long i = 0; i < r.n; i++) {
        const oracle_particle *it = &s.o.particle[i];
        add(&energy, power_of(&s, &r, i));
        add(&energy, it->m * r.p[i] / (it->rho * it->rho) * r.drho[i]);
      }
      assert_zero(&energy, 1e-14, "sum m (v.a + p/rho^2 drho/dt)");
      scene_rates_free(&r);
    }
    scene_free(&s);
  }
}

/* Viscosity heats every particle, by as much as motion loses. */
static void viscous_heat(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, 1);
    scene s;
    scene_make(&s, &def);
    scene_rates r = rates_with(&s, &(terms){.alpha = 1, .beta = 2});
    balance energy = {0, 0};
    long heated = 0;
    for (long i = 0; i < r.n; i++) {
      assert_true(r.du[i] >= 0);
      assert_true(r.drho[i] == 0);
      heated += r.du[i] > 0;
      add(&energy, power_of(&s, &r, i));
      add(&energy, s.o.particle[i].m * r.du[i]);
    }
    assert_in_range(heated, r.n / 2, r.n);
    assert_zero(&energy, 1e-14, "sum m (v.a + du/dt)");
    scene_rates_free(&r);
    scene_free(&s);
  }
}

/* Conduction moves energy, evens it out, and makes entropy: sum m du = 0, sum m u du < 0, sum m
 * du/u > 0. */
static void conduction(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, 1);
    scene s;
    scene_make(&s, &def);
    scene_rates r = rates_with(&s, &(terms){.conductivity = 1});
    balance energy = {0, 0};
    real variance = 0, entropy = 0;
    for (long i = 0; i < r.n; i++) {
      const oracle_particle *it = &s.o.particle[i];
      for (int d = 0; d < def.dim; d++) assert_true(r.a[d][i] == 0);
      add(&energy, it->m * r.du[i]);
      variance += it->m * it->u * r.du[i];
      entropy += it->m * r.du[i] / it->u;
    }
    assert_zero(&energy, 1e-14, "sum m du/dt");
    assert_true(variance < 0 && entropy > 0);
    scene_rates_free(&r);
    scene_free(&s);
  }
}

/* Of every particle: A = p/rho^gamma stays where nothing dissipates, and grows where viscosity
 * does.
 *   dA/dt = (gamma - 1) rho^(1 - gamma) (du/dt - p/rho^2 drho/dt) */
static void entropy(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, k / 3 % 2);
    scene s;
    scene_make(&s, &def);
    for (int t = 0; t < 4; t++) {
      terms these = t < 2 ? rows[t] : dissipative[t - 2];
      these.conductivity = 0;
      scene_rates r = rates_with(&s, &these);
      oracle_evaluate(&s.o);
      for (long i = 0; i < r.n; i++) {
        const oracle_particle *it = &s.o.particle[i];
        real made = r.du[i] - r.p[i] / (it->rho * it->rho) * r.drho[i];
        assert_true(made >= -1e-14L * it->du_size);
        if (t < 2) assert_true(made <= 1e-14L * it->du_size);
      }
      scene_rates_free(&r);
    }
    scene_free(&s);
  }
}

/* ... and over a run, in which particles leave the periodic box at all sides. */
static void momentum_of_a_run(void **state)
{
  (void)state;
  static const char *const method[] = {"erk:bogacki-shampine-4-2-3", "leapfrog", "verlet"};
  for (int k = 0; k < 6; k++) {
    scene_def def = scene_number(k, 0, 1);
    scene s;
    scene_make(&s, &def);
    set_terms(&s,
              &(terms){.row = ORACLE_C2, .alpha = 0.1, .diffusion = ORACLE_ANTUONO, .delta = 0.1});
    for (long i = 0; i < s.o.n; i++)
      for (int d = 0; d < def.dim; d++) s.o.particle[i].v[d] += 4; /* all of them flow */
    sph_sim *sim = scene_sim(&s, (scene_options){0});
    sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method[k / 2]});
    sph_balance start, end;
    sph_sim_balance(sim, &start);
    if (sph_sim_run(sim, 0.1) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
    sph_sim_balance(sim, &end);
    assert_true(start.mass > 0 && end.mass == start.mass);
    for (int d = 0; d < def.dim; d++)
      assert_true(fabs(end.momentum[d] - start.momentum[d]) <= 1e-13 * fabs(start.momentum[d]));
    assert_true(end.kinetic < start.kinetic); /* something happened */
    sph_sim_free(sim);
    scene_free(&s);
  }
}

/* ---- density ---- */

/* C1 is the time derivative of the summation density along the motion: against differences of sum m
 * W. */
static real summation(const oracle *o, long i, real time)
{
  real rho = 0;
  for (long j = 0; j < o->n; j++) {
    real r2 = 0;
    for (int k = 0; k < o->dim; k++) {
      const oracle_particle *a = &o->particle[i], *b = &o->particle[j];
      real d = a->x[k] - b->x[k] + time * (a->v[k] - b->v[k]);
      if (o->periodic[k]) d -= o->length[k] * roundl(d / o->length[k]);
      r2 += d * d;
    }
    rho += o->particle[j].m * oracle_w(o, sqrtl(r2));
  }
  return rho;
}

static void continuity_is_exact(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 0, 1);
    scene s;
    scene_make(&s, &def);
    scene_rates r = rates_with(&s, &rows[0]);
    oracle_evaluate(&s.o);   /* for the sizes */
    const real step = 1e-7L; /* [s]; errors: step^2 W''' and 1e-19/step */
    for (long i = 0; i < r.n; i += 1 + r.n / 50) {
      real rate = (summation(&s.o, i, step) - summation(&s.o, i, -step)) / (2 * step);
      if (fabsl(rate - r.drho[i]) > 1e-9L * s.o.particle[i].drho_size)
        fail_msg("drho/dt %.15g, differences %.15Lg", r.drho[i], rate);
    }
    scene_rates_free(&r);
    scene_free(&s);
  }
}

/* Diffusion keeps sum V D = 0; Molteni's lowers sum V rho^2. */
static void density_diffusion(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 0, k / 3 % 2);
    scene s;
    scene_make(&s, &def);
    for (int model = ORACLE_MOLTENI; model <= ORACLE_ANTUONO; model++) {
      terms these = {.delta = 0.1, .diffusion = (enum oracle_delta)model};
      scene_rates r = rates_with(&s, &these);
      balance mass = {0, 0};
      real square = 0;
      for (long i = 0; i < r.n; i++) {
        const oracle_particle *it = &s.o.particle[i];
        add(&mass, it->m / it->rho * r.drho[i]);
        square += it->m * r.drho[i];
      }
      assert_zero(&mass, 1e-12, "sum V D");
      if (model == ORACLE_MOLTENI) assert_true(square < 0);
      scene_rates_free(&r);
    }
    scene_free(&s);
  }
}

/* Antuono's diffusion leaves a linear density alone, at a free surface too; Molteni's does not
 * there. */
static void linear_density(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    scene_def def = {.dim = dim, .n = dim == 2 ? 20 : 14, .fluids = 1, .seed = 4};
    scene s;
    scene_make(&s, &def);
    const double side = def.n * s.dx, reach = 4 * s.h_over_dx * s.dx;
    for (long i = 0; i < s.o.n; i++) {
      oracle_particle *it = &s.o.particle[i];
      it->rho = (double)(1000 + 10 * it->x[0] - 20 * it->x[1] + 7 * it->x[2]);
      it->m = (double)(it->rho * powl(s.dx, dim));
    }
    scene_rates molteni = rates_with(&s, &(terms){.delta = 0.1, .diffusion = ORACLE_MOLTENI});
    scene_rates antuono = rates_with(&s, &(terms){.delta = 0.1, .diffusion = ORACLE_ANTUONO});
    double most[2] = {0, 0};
    long seen = 0;
    for (long i = 0; i < s.o.n; i++) {
      int corner = 0; /* near two faces and more: some gradients there are left out */
      for (int k = 0; k < dim; k++)
        corner += s.o.particle[i].x[k] < reach || s.o.particle[i].x[k] > side - reach;
      if (corner > 1) continue;
      most[0] = fmax(most[0], fabs(molteni.drho[i]));
      most[1] = fmax(most[1], fabs(antuono.drho[i]));
      seen++;
    }
    print_message("# %dD, %ld particles: Molteni %.3g, Antuono %.3g kg/m^3/s\n", dim, seen, most[0],
                  most[1]);
    assert_true(seen > 20 && most[0] > 10 && most[1] < 1e-10 * most[0]);
    scene_rates_free(&molteni);
    scene_rates_free(&antuono);
    scene_free(&s);
  }
}

/* ---- states left alone ---- */

/* A uniform lattice in a periodic box that moves as a whole has no rates at all. */
static void uniform_state(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, k / 3 % 2, 1);
    scene s;
    scene_make(&s, &def);
    for (long i = 0; i < s.o.n; i++) {
      oracle_particle *it = &s.o.particle[i];
      long cell = i;
      for (int d = 0; d < def.dim; d++, cell /= def.n) {
        it->x[d] = s.dx * ((double)(cell % def.n) + 0.5);
        it->v[d] = 3 - d;
      }
      it->rho = 1040, it->u = 10, it->m = 1040 * pow(s.dx, def.dim);
    }
    terms these = dissipative[k % 2];
    if (!def.thermal) these.conductivity = 0, these.diffusion = ORACLE_ANTUONO, these.delta = 0.1;
    scene_rates r = rates_with(&s, &these);
    oracle_evaluate(&s.o);
    for (long i = 0; i < r.n; i++) {
      const oracle_particle *it = &s.o.particle[i];
      for (int d = 0; d < def.dim; d++) assert_true(fabs(r.a[d][i]) <= 1e-14L * it->a_size);
      assert_true(fabs(r.drho[i]) <= 1e-14L * it->drho_size);
      assert_true(fabs(r.du[i]) <= 1e-14L * it->du_size);
    }
    scene_rates_free(&r);
    scene_free(&s);
  }
}

/* Two observers, one of them moving: the same rates. */
static void galilean(void **state)
{
  (void)state;
  for (int k = 0; k < SCENES; k += quick_stride()) {
    scene_def def = scene_number(k, 1, k / 3 % 2);
    scene s;
    scene_make(&s, &def);
    scene_rates rest = rates_with(&s, &dissipative[k % 2]);
    for (long i = 0; i < s.o.n; i++)
      for (int d = 0; d < def.dim; d++) s.o.particle[i].v[d] += 5 - 7 * d;
    scene_rates moving = rates_with(&s, &dissipative[k % 2]);
    oracle_evaluate(&s.o);
    for (long i = 0; i < s.o.n; i++) {
      const oracle_particle *it = &s.o.particle[i];
      for (int d = 0; d < def.dim; d++)
        assert_true(fabs(rest.a[d][i] - moving.a[d][i]) <= 1e-14L * it->a_size);
      assert_true(fabs(rest.drho[i] - moving.drho[i]) <= 1e-14L * it->drho_size);
      assert_true(fabs(rest.du[i] - moving.du[i]) <= 1e-14L * it->du_size);
    }
    scene_rates_free(&rest);
    scene_rates_free(&moving);
    scene_free(&s);
  }
}

/* ---- signs, on two particles ---- */

static scene_rates two_particles(const terms *t, double approach, double *p)
{
  scene_def def = {.dim = 2, .n = 8, .fluids = 1, .thermal = 1, .seed = 1};
  scene s;
  scene_make(&s, &def);
  s.o.n = 2;
  for (int i = 0; i < 2; i++)
    s.o.particle[i] = (oracle_particle){.x = {0.05L * (2 * i - 1)},
                                        .v = {-approach * (2 * i - 1)},
                                        .m = 10,
                                        .rho = 1000,
                                        .u = 2 + i};
  scene_rates r = rates_with(&s, t);
  *p = r.p[0];
  scene_free(&s);
  return r;
}

static void signs(void **state)
{
  (void)state;
  for (int t = 0; t < 2; t++) {
    double p;
    scene_rates in = two_particles(&rows[t], 1, &p), out = two_particles(&rows[t], -1, &p);
    assert_true(p > 0);
    assert_true(in.a[0][0] < 0 && in.a[0][1] > 0); /* pressure repels */
    assert_true(in.a[0][0] == out.a[0][0]);
    assert_true(in.drho[0] > 0 && out.drho[0] < 0 && in.drho[0] == -out.drho[0]);
    assert_true(in.du[0] > 0 && out.du[0] < 0); /* compression heats */
    scene_rates_free(&in), scene_rates_free(&out);
  }
  double p;
  terms viscous = {.alpha = 1, .beta = 2}, conducting = {.conductivity = 1};
  scene_rates in = two_particles(&viscous, 1, &p), out = two_particles(&viscous, -1, &p);
  scene_rates heat = two_particles(&conducting, 0, &p);
  assert_true(in.a[0][0] < 0 && in.a[0][1] > 0 && in.du[0] > 0 && in.du[1] > 0);
  assert_true(out.a[0][0] == 0 && out.du[0] == 0); /* it acts on what approaches only */
  assert_true(heat.du[0] > 0 && heat.du[1] < 0);   /* from hot to cold */
  assert_true(heat.a[0][0] == 0 && heat.drho[0] == 0);
  scene_rates_free(&in), scene_rates_free(&out), scene_rates_free(&heat);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(momentum),
      cmocka_unit_test(momentum_of_a_run),
      cmocka_unit_test(angular_momentum),
      cmocka_unit_test(energy_of_gases),
      cmocka_unit_test(energy_of_liquids),
      cmocka_unit_test(viscous_heat),
      cmocka_unit_test(conduction),
      cmocka_unit_test(entropy),
      cmocka_unit_test(continuity_is_exact),
      cmocka_unit_test(density_diffusion),
      cmocka_unit_test(linear_density),
      cmocka_unit_test(uniform_state),
      cmocka_unit_test(galilean),
      cmocka_unit_test(signs),
  };
  return cmocka_run_group_tests_name("conservation", tests, NULL, balance_tell);
}
