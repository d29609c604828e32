/* Step limits of one evaluation against docs/theory.md, Step limits, written again:
 *
 *   liquids   min_i h'/(c_i s + |v_i|),  s = max(1 + 0.6 alpha, 5.5 delta)
 *   gases     h'/[max_i (c_i s + |v_i|) + (1 + 1.2 beta) max_i |v_i|]
 *   force     0.25 sqrt(h/max_i |a_i|)
 *   viscous   0.125 h^2 min_i rho_i/eta, with mcg a third
 *   heat      0.125 h^2 min_i rho_i c_v/kappa
 *
 * h' = h min(1, sigma_k/sigma_k(Wendland C2)); alpha = max of both artificial viscosities,
 * beta = max(beta, beta_signal/2); eta the largest of the fluids.  Random states, two fluids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "scene.h"
#include "sim_data.h"

enum { LIQUID, GAS };

/* sigma_k^2 = (1/d) int q^2 W dV, in units of h^2; midpoint rule. */
static double deviation(int dim, int kernel)
{
  enum { N = 20000 };
  static const real pi = 3.14159265358979323846L;
  const oracle o = {.dim = dim, .kernel = (enum oracle_kernel)kernel, .h = 1};
  const real surface = dim == 1   ? 2
                       : dim == 2 ? 2 * pi
                                  : 4 * pi,
             step = 3.0L / N; /* support: 3 h */
  real sum = 0;
  for (int k = 0; k < N; k++) {
    real q = (k + 0.5L) * step;
    sum += surface * powl(q, dim + 1) * oracle_w(&o, q) * step;
  }
  return (double)sqrtl(sum / dim);
}

typedef struct fluid {
  double speed, v, a, rho; /* max of c s + |v|, of |v|, of |a|; min of rho */
} fluid;

static fluid look(const scene *s, const scene_rates *r, int g, double signal)
{
  fluid it = {.rho = INFINITY};
  for (long i = 0; i < s->o.n; i++) {
    const oracle_particle *p = &s->o.particle[i];
    double v2 = 0, a2 = 0;
    if (p->group != g) continue;
    for (int k = 0; k < s->o.dim; k++) {
      v2 += (double)(p->v[k] * p->v[k]);
      a2 += r->a[k][i] * r->a[k][i];
    }
    it.speed = fmax(it.speed, r->c[i] * signal + sqrt(v2));
    it.v = fmax(it.v, sqrt(v2)), it.a = fmax(it.a, sqrt(a2));
    it.rho = fmin(it.rho, (double)p->rho);
  }
  assert_true(it.v > 0 && it.a > 0 && it.rho < INFINITY);
  return it;
}

typedef struct limits {
  double cfl, force, viscous, conduction;
} limits;

static limits expected(const scene *s, const scene_rates *r)
{
  const oracle *o = &s->o;
  const oracle_group *group = o->group;
  double narrow = deviation(o->dim, o->kernel) / deviation(o->dim, ORACLE_WENDLAND_C2);
  double h = (double)o->h, sound = narrow < 1 ? h * narrow : h;
  double alpha = (double)(o->alpha > o->signal_alpha ? o->alpha : o->signal_alpha);
  double beta = (double)(o->beta > o->signal_beta / 2 ? o->beta : o->signal_beta / 2);
  double eta = fmax((double)group[0].viscosity, (double)group[1].viscosity);
  limits it = {INFINITY, INFINITY, INFINITY, INFINITY};
  for (int g = 0; g < 2; g++) {
    fluid f = look(s, r, g, fmax(1 + 0.6 * alpha, o->diffusion ? 5.5 * (double)o->delta : 0));
    double speed = f.speed + (s->thermal ? (1 + 1.2 * beta) * f.v : 0);
    it.cfl = fmin(it.cfl, sound / speed);
    it.force = fmin(it.force, 0.25 * sqrt(h / f.a));
    if (o->laminar)
      it.viscous =
          fmin(it.viscous, 0.125 * h * h * f.rho / (o->laminar == ORACLE_MCG ? 3 : 1) / eta);
    if (o->conduction)
      it.conduction = fmin(it.conduction, 0.125 * h * h * f.rho * (double)group[g].eos.c_v /
                                              (double)group[g].conductivity);
  }
  return it;
}

static void same(const char *name, double found, double right)
{
  if (isinf(right) ? found != right : !(fabs(found / right - 1) <= 1e-7))
    fail_msg("%s: %.17g s, not %.17g s", name, found, right);
}

/* State k: kernels, dimensions, terms in turn. */
static void state_of(scene *s, int k, int thermal)
{
  scene_def def = {.dim = 1 + k % 3,
                   .kernel = k % ORACLE_KERNELS,
                   .fluids = 2,
                   .thermal = thermal,
                   .laminar = 1,
                   .walls = k % 3 && k % 4 == 3,
                   .no_slip = 1,
                   .seed = (unsigned long)(500 + 2 * k + thermal)};
  def.n = def.dim == 1 ? 40 : def.dim == 2 ? 12 : 8;
  for (int d = 0; d < def.dim; d++) def.periodic[d] = !def.walls || d < def.dim - 1;
  scene_make(s, &def);
  oracle *o = &s->o;
  o->continuity = o->pressure = ORACLE_C2;
  o->energy = thermal ? ORACLE_DEFAULT : ORACLE_U;
  if (k % 2) o->alpha = 0.5, o->beta = k / 2 % 2 ? 2 : 1;
  if (k / 2 % 2) o->signal_alpha = k % 5 < 2 ? 0.25 : 1, o->signal_beta = 3;
  o->laminar = k % 5 == 0 ? ORACLE_INVISCID : k % 5 < 3 ? ORACLE_MORRIS : ORACLE_MCG;
  o->conduction = k % 3 > 0;
  if (!thermal && k % 4 == 2) o->diffusion = ORACLE_MOLTENI, o->delta = k % 8 == 2 ? 0.1L : 1;
  if (k / 4 % 2) o->group[0].viscosity = 7, o->group[0].conductivity = 90;
  o->group[2].viscosity = 50; /* a wall's counts for nothing */
}

static void check(int k, int thermal)
{
  scene s;
  state_of(&s, k, thermal);
  sph_sim *sim = scene_sim(&s, (scene_options){0});
  scene_rates rates = scene_evaluate(&s, sim);
  limits right = expected(&s, &rates);
  same("cfl", sim->limit[SPH_BOUND_CFL], right.cfl);
  same("force", sim->limit[SPH_BOUND_FORCE], right.force);
  same("viscous", sim->limit[SPH_BOUND_VISCOUS], right.viscous);
  same("conduction", sim->limit[SPH_BOUND_CONDUCTION], right.conduction);
  scene_rates_free(&rates);
  sph_sim_free(sim);
  scene_free(&s);
}

static void of_liquids(void **state)
{
  (void)state;
  for (int k = 0; k < 40; k++) check(k, LIQUID);
}

static void of_gases(void **state)
{
  (void)state;
  for (int k = 0; k < 40; k++) check(k, GAS);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(of_liquids), cmocka_unit_test(of_gases)};
  return cmocka_run_group_tests_name("limits", tests, NULL, NULL);
}
