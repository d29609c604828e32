/* Bad values at every door of the public interface: the status says what kind, the text names the
 * object and the value, later calls change nothing, nothing crashes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

/* ---- a small simulation that works, to be spoiled ---- */

typedef struct small {
  sph_sim *sim;
  sph_group *water, *floor;
} small;

static small make(void)
{
  small s = {.sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1})};
  s.water = sph_group_box(s.sim, "water", (double[]){0, 0}, (double[]){1, 0.5}, 1000);
  s.floor = sph_group_create(s.sim, "floor", "wall");
  sph_group_add_layers(s.floor, (double[]){0, 0}, (double[]){1, 0.8}, "y+", 1000);
  sph_group_set_eos(s.water, sph_eos_tait(1000, 20, 7));
  sph_group_set_boundary(s.floor, sph_boundary_adami());
  sph_sim_add_term(s.sim, sph_term_continuity());
  sph_sim_add_term(s.sim, sph_term_pressure());
  assert_string_equal(sph_sim_error(s.sim), "");
  return s;
}

/* The first error is this one (word: part of its text), and it sticks. */
static void assert_refused(sph_sim *sim, int status, const char *word, const char *what)
{
  const char *text = sph_sim_error(sim);
  if (sph_sim_status(sim) != status)
    fail_msg("%s: status %d, not %d; \"%s\"", what, sph_sim_status(sim), status, text);
  if (!strstr(text, word)) fail_msg("%s: \"%s\" does not tell \"%s\"", what, text, word);
  if (strlen(text) < 12) fail_msg("%s: \"%s\" tells too little", what, text);
  char first[1000];
  snprintf(first, sizeof first, "%s", text);
  sph_sim_add_term(sim, (sph_term){.name = "nonsense"});
  sph_group_create(sim, "", "");
  assert_int_equal(sph_sim_run(sim, 1), status);
  assert_int_equal(sph_sim_step(sim), status);
  assert_int_equal(sph_sim_evaluate(sim), status);
  assert_string_equal(sph_sim_error(sim), first);
}

static const double bad[] = {NAN, INFINITY, -INFINITY, -1, 0};
static const char *const bad_text[] = {"nan", "inf", "-inf", "-1", "0"};
enum { NOT_A_NUMBER, INFINITE, MINUS_INFINITE, NEGATIVE, ZERO, BAD };

/* ---- sph_sim_create ---- */

static void refused_def(sph_sim_def def, const char *word, const char *what)
{
  sph_sim *sim = sph_sim_create(&def);
  assert_non_null(sim);
  assert_refused(sim, SPH_ERR_ARGUMENT, word, what);
  sph_sim_free(sim);
}

static void create(void **state)
{
  (void)state;
  const sph_sim_def good = {.dim = 2, .dx = 0.1, .periodic = {1}, .length = {2}};
  sph_sim_def def;
  static const int dims[] = {0, -1, 4, 1 << 30};
  for (int k = 0; k < 4; k++) def = good, def.dim = dims[k], refused_def(def, "dim", "dim");
  for (int k = 0; k < BAD; k++) {
    def = good, def.dx = bad[k], refused_def(def, bad_text[k], "dx");
    if (k != ZERO) def = good, def.h_over_dx = bad[k], refused_def(def, bad_text[k], "h_over_dx");
    def = good, def.length[0] = bad[k], refused_def(def, bad_text[k], "length");
    if (k < NEGATIVE) def = good, def.origin[0] = bad[k], refused_def(def, bad_text[k], "origin");
    if (k != ZERO) def = good, def.speed = bad[k], refused_def(def, bad_text[k], "speed");
    if (k < NEGATIVE && k != MINUS_INFINITE)
      def = good, def.skin = bad[k], refused_def(def, bad_text[k], "skin");
  }
  def = good, def.length[0] = 0.2, refused_def(def, "0.2", "a periodic box that is too small");
  def = good, def.kernel = "gauss", refused_def(def, "gauss", "kernel");
  def = good, def.kernel = "gauss", refused_def(def, "wendland-c2", "kernel: the known ones");
  def = good, def.kernel = "", refused_def(def, "wendland-c2", "no kernel");
  def = good, def.search = "oak", refused_def(def, "oak", "search");
  def = good, def.isa = "sse9", refused_def(def, "sse9", "isa");
  def = good, def.threads = -1, refused_def(def, "-1", "threads");
  sph_sim *sim = sph_sim_create(NULL);
  assert_true(sph_sim_status(sim) < 0 && strlen(sph_sim_error(sim)) > 5);
  sph_sim_free(sim);
}

/* ---- groups ---- */

static void groups(void **state)
{
  (void)state;
  const double lo[] = {0, 0}, hi[] = {1, 1};
  static const char *const names[] = {NULL, "", "a b", "water", "a/b", "\xc3\xa9"};
  for (int k = 0; k < 6; k++) {
    small s = make();
    assert_null(sph_group_create(s.sim, names[k], "fluid"));
    assert_refused(s.sim, SPH_ERR_ARGUMENT, names[k] ? names[k] : "name", "group name");
    sph_sim_free(s.sim);
  }
  static const char *const kinds[] = {NULL, "", "solid"};
  for (int k = 0; k < 3; k++) {
    small s = make();
    assert_null(sph_group_create(s.sim, "oil", kinds[k]));
    assert_refused(s.sim, SPH_ERR_ARGUMENT, kinds[k] ? kinds[k] : "kind", "group kind");
    sph_sim_free(s.sim);
  }
  for (int k = 0; k < BAD; k++) {
    small s = make();
    sph_group_add_box(s.water, lo, hi, bad[k]);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "rho0 of a box");
    sph_sim_free(s.sim);
    s = make();
    sph_group_add_ball(s.water, lo, bad[k], 1000);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "radius");
    sph_sim_free(s.sim);
    if (k == ZERO) continue;
    s = make();
    sph_group_add_box(s.water, lo, (double[]){bad[k], 1}, 1000);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "corner of a box");
    sph_sim_free(s.sim);
    s = make();
    sph_group_add_layers(s.floor, lo, (double[]){1, bad[k]}, "", 1000);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "corner of layers");
    sph_sim_free(s.sim);
    if (k == NEGATIVE) continue;
    s = make();
    const double x[] = {0.5, bad[k]}, y[] = {0.1, 0.2}, *const xy[] = {x, y};
    sph_group_add_points(s.water, 2, xy, 1000);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "a point");
    sph_sim_free(s.sim);
  }
}

static void no_pointers(void **state)
{
  (void)state;
  const double lo[] = {0, 0}, hi[] = {1, 1}, *const none[] = {NULL, NULL};
  for (int k = 0; k < 10; k++) {
    small s = make();
    switch (k) {
    case 0: sph_group_add_box(s.water, NULL, hi, 1000); break;
    case 1: sph_group_add_box(s.water, lo, NULL, 1000); break;
    case 2: sph_group_add_ball(s.water, NULL, 1, 1000); break;
    case 3: sph_group_add_layers(s.floor, lo, NULL, "", 1000); break;
    case 4: sph_group_add_points(s.water, 1, NULL, 1000); break;
    case 5: sph_group_add_points(s.water, 1, none, 1000); break;
    case 6: sph_group_set_pressure(s.water, NULL); break;
    case 7: sph_sim_add_term(s.sim, sph_term_gravity(NULL)); break;
    case 8: sph_sim_add_term(s.sim, sph_term_delta(NULL, 0.1)); break;
    case 9: sph_group_set_density(s.water, NULL); break;
    }
    if (sph_sim_status(s.sim) != SPH_ERR_ARGUMENT)
      fail_msg("NULL number %d: status %d", k, sph_sim_status(s.sim));
    sph_sim_free(s.sim);
  }
  small s = make();
  sph_group_add_layers(s.floor, lo, hi, "y+ z-", 1000); /* there is no z in 2D */
  assert_refused(s.sim, SPH_ERR_ARGUMENT, "z-", "open sides");
  sph_sim_free(s.sim);
  s = make();
  sph_group_add_points(s.water, -1, none, 1000);
  assert_refused(s.sim, SPH_ERR_ARGUMENT, "-1", "n");
  sph_sim_free(s.sim);
}

/* ---- equations of state, boundaries ---- */

static void refused_eos(sph_eos eos, const char *word, const char *what)
{
  small s = make();
  sph_group_set_eos(s.water, eos);
  assert_refused(s.sim, SPH_ERR_ARGUMENT, word, what);
  sph_sim_free(s.sim);
}

static void refused_boundary(sph_boundary boundary, const char *word, const char *what)
{
  small s = make();
  sph_group_set_boundary(s.floor, boundary);
  assert_refused(s.sim, SPH_ERR_ARGUMENT, word, what);
  sph_sim_free(s.sim);
}

static void refused_repulsion(int of_fluid, double epsilon, const char *word)
{
  small s = make();
  sph_group_set_repulsion(of_fluid ? s.water : s.floor, epsilon);
  assert_refused(s.sim, SPH_ERR_ARGUMENT, word, "a repulsion");
  sph_sim_free(s.sim);
}

static void materials(void **state)
{
  (void)state;
  for (int k = 0; k < BAD; k++) {
    refused_eos(sph_eos_tait(bad[k], 20, 7), bad_text[k], "rho0");
    refused_eos(sph_eos_tait(1000, bad[k], 7), bad_text[k], "c0");
    refused_eos(sph_eos_tait(1000, 20, bad[k]), bad_text[k], "gamma");
    refused_eos(sph_eos_linear(bad[k], 20, 0), bad_text[k], "rho0");
    refused_eos(sph_eos_ideal_gas(bad[k]), bad_text[k], "gamma");
  }
  refused_eos(sph_eos_ideal_gas(1), "1", "gamma of a gas");
  refused_eos(sph_eos_linear(1000, 20, NAN), "nan", "p_min");
  sph_eos eos = sph_eos_tait(1000, 20, 7);
  eos.p_background = INFINITY, refused_eos(eos, "inf", "p_background");
  refused_eos((sph_eos){0}, "name", "an empty equation of state");
  refused_eos((sph_eos){.name = "mine"}, "mine", "one without functions");

  refused_repulsion(0, -1, "repulsion -1");
  refused_repulsion(0, NAN, "repulsion nan");
  refused_repulsion(1, 0.4, "is a fluid");
  refused_boundary((sph_boundary){0}, "adami", "an empty boundary");
  refused_boundary((sph_boundary){.name = "rubber"}, "rubber", "boundary");
  refused_boundary((sph_boundary){.name = "rubber"}, "adami", "boundary: the known ones");
  refused_boundary(sph_boundary_mirror(), "0 planes", "a mirror without planes");
  sph_boundary mirror = sph_boundary_mirror();
  sph_boundary_mirror_plane(&mirror, (double[]){0, 0}, (double[]){0, NAN}, 2);
  refused_boundary(mirror, "normal", "a normal that is no number");
  mirror = sph_boundary_mirror();
  sph_boundary_mirror_box(&mirror, (double[]){0, 0}, (double[]){1, 1}, "north", 2);
  refused_boundary(mirror, "sides of a box", "an open side that is none");
  for (int k = 0; k < 9; k++)
    sph_boundary_mirror_plane(&mirror, (double[]){0, 0}, (double[]){0, 1}, 2);
  refused_boundary(mirror, "1 to 6", "too many planes");
  sph_boundary_mirror_plane(NULL, NULL, NULL, 2), sph_boundary_mirror_box(NULL, NULL, NULL, "", 2);
}

static void refused_material(sph_material material, const char *word, const char *what)
{
  small s = make();
  sph_group_set_material(s.water, material);
  assert_refused(s.sim, SPH_ERR_ARGUMENT, word, what);
  sph_sim_free(s.sim);
}

static int let_go;
static void count_free(void *ctx) { let_go += *(int *)ctx; }

static void properties(void **state)
{
  (void)state;
  for (int k = 0; k < BAD; k++) {
    refused_eos(sph_eos_stiffened_gas(bad[k], 4.4, 6e8, 0), bad_text[k], "rho0");
    refused_eos(sph_eos_mie_grueneisen(8930, 3940, 1.49, bad[k]), bad_text[k], "grueneisen");
    for (int wall = 0; wall < 2 && k != ZERO; wall++) {
      small s = make();
      sph_group_set_viscosity(wall ? s.floor : s.water, bad[k]);
      assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "viscosity");
      sph_sim_free(s.sim), s = make();
      sph_group_set_conductivity(wall ? s.floor : s.water, bad[k]);
      assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "conductivity");
      sph_sim_free(s.sim);
    }
    sph_material water = sph_material_preset("water", 20);
    if (k != ZERO) water.viscosity = bad[k], refused_material(water, bad_text[k], "viscosity");
    if (k != ZERO) refused_material(sph_material_preset("water", bad[k]), bad_text[k], "c0");
    if (k != ZERO) refused_material(sph_material_preset("steel", bad[k]), "leave c0", "c0");
  }
  refused_material(sph_material_preset("ketchup", 0), "ketchup", "material");
  refused_material(sph_material_preset("ketchup", 0), "water-stiffened", "the known ones");
  refused_material(sph_material_preset(NULL, 0), "known: water", "no name");
  refused_material(sph_material_preset("oil", 0), "oil", "no sound speed");

  small s = make();
  int one = 1;
  sph_material own = sph_material_preset("water", 20);
  own.eos.ctx = &one, own.eos.free = count_free;
  let_go = 0;
  sph_group_set_viscosity(s.floor, 0.5), sph_group_set_conductivity(s.floor, 2);
  sph_group_set_material(s.water, own); /* replaced: let go of */
  sph_group_set_material(s.water, sph_material_preset("water", 20));
  assert_int_equal(let_go, 1);
  sph_group_set_material(NULL, own);
  assert_int_equal(let_go, 2);
  assert_true(sph_group_viscosity(s.floor) == 0.5 && sph_group_conductivity(s.floor) == 2);
  assert_true(sph_group_viscosity(s.water) == 1.002e-3);
  assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  sph_group_set_viscosity(s.water, 1);
  assert_refused(s.sim, SPH_ERR_STATE, "viscosity", "viscosity in the run");
  sph_group_set_material(s.water, own);
  assert_int_equal(let_go, 3);
  sph_sim_free(s.sim);
}

/* ---- terms ---- */

static void refused_term(sph_term term, const char *word, const char *what)
{
  small s = make();
  sph_sim_add_term(s.sim, term);
  assert_refused(s.sim, SPH_ERR_ARGUMENT, word, what);
  sph_sim_free(s.sim);
}

static void terms(void **state)
{
  (void)state;
  for (int k = 0; k < BAD; k++) {
    if (k == ZERO) continue;
    refused_term(sph_term_viscosity_artificial(bad[k], 0), bad_text[k], "alpha");
    refused_term(sph_term_viscosity_artificial(0, bad[k]), bad_text[k], "beta");
    refused_term(sph_term_conductivity_artificial(bad[k]), bad_text[k], "alpha_u");
    refused_term(sph_term_delta("molteni", bad[k]), bad_text[k], "delta");
    if (k < NEGATIVE) {
      refused_term(sph_term_gravity((double[3]){0, bad[k], 0}), bad_text[k], "g");
      refused_term(sph_term_harmonic(bad[k]), bad_text[k], "omega");
    }
  }
  refused_term(sph_term_delta("marrone", 0.1), "marrone", "model");
  refused_term(sph_term_delta("marrone", 0.1), "antuono", "model: the known ones");
  refused_term(sph_term_continuity_form("c3"), "c3", "form");
  refused_term(sph_term_pressure_form("p"), "p", "form");
  refused_term((sph_term){0}, "name", "an empty term");
  refused_term((sph_term){.name = "wind"}, "wind", "a term without a function");
  refused_term(sph_term_continuity(), "continuity", "a term twice");
}

/* ---- the integrator ---- */

static void refused_integrator(sph_integrator_def def, const char *word, const char *what)
{
  small s = make();
  sph_sim_set_integrator(s.sim, &def);
  assert_refused(s.sim, SPH_ERR_ARGUMENT, word, what);
  sph_sim_free(s.sim);
}

static int no_step(void *ctx, sph_ode *ode)
{
  (void)ctx, (void)ode;
  return SPH_OK;
}

static void own_integrators(void **state)
{
  (void)state;
  const sph_scheme good = {
      .name = "mine", .order = 1, .stages = 1, .stability = 1, .step = no_step};
  sph_scheme s = good;
  refused_integrator((sph_integrator_def){.own = &s, .method = "dkd"}, "method", "both");
  refused_integrator((sph_integrator_def){.own = &(sph_scheme){0}}, "name", "all zero");
  s.name = "midpoint";
  refused_integrator((sph_integrator_def){.own = &s}, "midpoint", "a known name");
  s = good;
  s.step = NULL;
  refused_integrator((sph_integrator_def){.own = &s}, "step", "no step");
  s = good;
  for (int k = 0; k < BAD; k++) {
    s.stability = bad[k];
    refused_integrator((sph_integrator_def){.own = &s}, bad_text[k], "stability");
  }
  s = good;
  s.work = 17;
  refused_integrator((sph_integrator_def){.own = &s}, "17", "work");
}

static void integrators(void **state)
{
  (void)state;
  refused_integrator((sph_integrator_def){.method = "euler"}, "euler", "method");
  refused_integrator((sph_integrator_def){.method = "euler"}, "leapfrog", "the known ones");
  refused_integrator((sph_integrator_def){.method = "erk:no-such-table"}, "no-such-table", "table");
  refused_integrator((sph_integrator_def){.method = ""}, "leapfrog", "no method");
  for (int k = 0; k < BAD; k++) {
    if (k == ZERO) continue;
    refused_integrator((sph_integrator_def){.cfl = bad[k]}, bad_text[k], "cfl");
    refused_integrator((sph_integrator_def){.dt_max = bad[k]}, bad_text[k], "dt_max");
    refused_integrator((sph_integrator_def){.dt_min = bad[k]}, bad_text[k], "dt_min");
    refused_integrator((sph_integrator_def){.dt_fixed = bad[k]}, bad_text[k], "dt_fixed");
    if (k < MINUS_INFINITE)
      refused_integrator((sph_integrator_def){.tolerance = bad[k]}, bad_text[k], "tolerance");
  }
  refused_integrator((sph_integrator_def){.retries = -1}, "-1", "retries");
}

/* ---- outputs, times ---- */

static int frame(void *ctx, sph_sim *sim, sph_error *error)
{
  (void)ctx, (void)sim, (void)error;
  return SPH_OK;
}

static void outputs_and_times(void **state)
{
  (void)state;
  for (int k = 0; k < BAD; k++) {
    small s = make();
    if (k != ZERO && k != INFINITE) {
      sph_sim_add_output(s.sim, (sph_output){"mine", .interval = bad[k], .frame = frame});
      assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "interval");
    }
    sph_sim_free(s.sim);
    if (k == ZERO) continue;
    s = make();
    assert_int_equal(sph_sim_run(s.sim, bad[k]), SPH_ERR_ARGUMENT);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "t_end");
    sph_sim_free(s.sim);
  }
}

/* ---- the wrong order ---- */

static void refused_state(sph_sim *sim, const char *word, const char *what)
{
  assert_refused(sim, SPH_ERR_STATE, word, what);
  sph_sim_free(sim);
}

static void unfinished(void **state)
{
  (void)state;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  assert_true(sph_sim_run(sim, 1) < 0);
  refused_state(sim, "fluid", "nothing at all");

  sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group_create(sim, "water", "fluid");
  assert_true(sph_sim_run(sim, 1) < 0);
  refused_state(sim, "fluid", "no particles");

  sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_sim_add_term(sim, sph_term_pressure());
  assert_true(sph_sim_evaluate(sim) < 0);
  refused_state(sim, "water", "no equation of state");

  sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1}); /* rows that do not match */
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 20, 7));
  sph_sim_add_term(sim, sph_term_continuity_form("c1"));
  sph_sim_add_term(sim, sph_term_pressure_form("c2"));
  assert_true(sph_sim_evaluate(sim) < 0);
  assert_true(strstr(sph_sim_error(sim), "c1") != NULL);
  sph_sim_free(sim);
}

static void after_the_start(void **state)
{
  (void)state;
  for (int k = 0; k < 6; k++) {
    small s = make();
    assert_int_equal(sph_sim_run(s.sim, 1e-4), SPH_OK);
    switch (k) {
    case 0: sph_group_add_box(s.water, (double[]){0, 1}, (double[]){1, 2}, 1000); break;
    case 1: sph_group_create(s.sim, "oil", "fluid"); break;
    case 2: sph_sim_add_term(s.sim, sph_term_harmonic(1)); break;
    case 3: sph_group_set_eos(s.water, sph_eos_tait(1000, 30, 7)); break;
    case 4: sph_group_set_boundary(s.floor, sph_boundary_adami()); break;
    case 5: sph_sim_set_integrator(s.sim, &(sph_integrator_def){.method = "leapfrog"}); break;
    }
    assert_refused(s.sim, SPH_ERR_STATE, " ", "after the start");
    sph_sim_free(s.sim);
  }
}

static void wrong_kind(void **state)
{
  (void)state;
  small s = make();
  sph_group_set_boundary(s.water, sph_boundary_adami());
  assert_refused(s.sim, SPH_ERR_ARGUMENT, "water", "boundary of a fluid");
  sph_sim_free(s.sim);
  s = make();
  sph_group_set_hydrostatic(s.water, 2, 1, 9.81); /* there is no z in 2D */
  assert_refused(s.sim, SPH_ERR_ARGUMENT, "2", "axis");
  sph_sim_free(s.sim);
  for (int k = 0; k < NEGATIVE; k++) {
    s = make();
    sph_group_set_hydrostatic(s.water, 1, bad[k], 9.81);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "surface");
    sph_sim_free(s.sim);
    s = make();
    sph_group_set_hydrostatic(s.water, 1, 1, bad[k]);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "g");
    sph_sim_free(s.sim);
    s = make();
    sph_group_set_column(s.water, 1, 1, bad[k], 9.81);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, bad_text[k], "pressure at the surface");
    sph_sim_free(s.sim);
  }
  const double far[] = {NAN, INFINITY, -0.1, 0.51};
  for (int k = 0; k < 4; k++) {
    s = make();
    sph_group_jitter(s.water, far[k], 1);
    assert_refused(s.sim, SPH_ERR_ARGUMENT, "jitter", "jitter");
    sph_sim_free(s.sim);
  }
  s = make();
  assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  sph_group_jitter(s.water, 0.1, 1);
  assert_refused(s.sim, SPH_ERR_STATE, "before the run", "late jitter");
  sph_sim_free(s.sim);
  s = make();
  assert_null(sph_group_read(s.water, "temperature", 0));
  assert_null(sph_group_read(s.water, "velocity", 2));
  assert_null(sph_group_read(s.water, "velocity", -1));
  assert_null(sph_group_read(s.water, NULL, 0));
  assert_null(sph_group_write(s.water, "pressure", 7));
  assert_null(sph_group_rate(s.water, "mass", 0));
  assert_string_equal(sph_sim_error(s.sim), ""); /* asking is no error */
  sph_sim_free(s.sim);
}

/* ---- states that no step can start from ---- */

static void bad_states(void **state)
{
  (void)state;
  static const char *const field[] = {"position", "velocity", "density", "mass"};
  for (int f = 0; f < 4; f++)
    for (int k = 0; k < BAD; k++) {
      if (f < 2 && k >= NEGATIVE) continue;
      small s = make();
      sph_group_write(s.water, field[f], 0)[7] = bad[k];
      int status = sph_sim_run(s.sim, 0.1);
      if (status >= 0) fail_msg("%s = %s: ran, status %d", field[f], bad_text[k], status);
      if (!strstr(sph_sim_error(s.sim), f == 1 ? "finite" : " 7"))
        fail_msg("%s = %s: \"%s\"", field[f], bad_text[k], sph_sim_error(s.sim));
      sph_sim_free(s.sim);
    }
}

/* A user's functions that fail or return nonsense. */
static int failing(const sph_term *term, const sph_particles *particles)
{
  (void)particles;
  return *(const int *)term->ctx;
}
static int poisonous(const sph_term *term, const sph_particles *particles)
{
  (void)term;
  particles->a[0][3] = NAN;
  return SPH_OK;
}
static int stop(void *ctx, sph_sim *sim)
{
  (void)ctx, (void)sim;
  return 1;
}

static void callbacks(void **state)
{
  (void)state;
  static int answers[] = {SPH_RETRY, SPH_ERR_ARGUMENT, -77};
  for (int k = 0; k < 4; k++) {
    small s = make();
    sph_sim_add_term(s.sim, (sph_term){.name = "mine",
                                       .body = k < 3 ? failing : poisonous,
                                       .ctx = k < 3 ? &answers[k] : NULL});
    int status = sph_sim_run(s.sim, 0.1);
    if (status >= 0 || !*sph_sim_error(s.sim))
      fail_msg("user's term %d: status %d, \"%s\"", k, status, sph_sim_error(s.sim));
    sph_sim_free(s.sim);
  }
  small s = make();
  sph_sim_set_progress(s.sim, stop, NULL);
  assert_int_equal(sph_sim_run(s.sim, 0.1), SPH_ERR_STOPPED);
  sph_sim_free(s.sim);
}

/* ---- NULL flows through ---- */

static void null_simulation(void **state)
{
  (void)state;
  assert_true(strlen(sph_sim_error(NULL)) > 5);
  assert_true(sph_sim_status(NULL) < 0);
  assert_null(sph_group_create(NULL, "water", "fluid"));
  assert_null(sph_group_box(NULL, "water", NULL, NULL, 1));
  assert_null(sph_group_walls(NULL, "water", NULL, NULL, 1));
  sph_group_add_box(NULL, NULL, NULL, 1);
  sph_group_add_ball(NULL, NULL, 1, 1);
  sph_group_add_layers(NULL, NULL, NULL, NULL, 1);
  sph_group_add_points(NULL, 1, NULL, 1);
  sph_group_set_eos(NULL, sph_eos_tait(1, 1, 1));
  sph_group_set_boundary(NULL, sph_boundary_adami());
  sph_group_set_hydrostatic(NULL, 0, 0, 0);
  sph_group_set_column(NULL, 0, 0, 0, 0);
  sph_group_jitter(NULL, 0.1, 1);
  sph_group_set_pressure(NULL, NULL);
  sph_group_set_density(NULL, NULL);
  sph_group_set_viscosity(NULL, 1), sph_group_set_conductivity(NULL, 1);
  sph_group_set_repulsion(NULL, 1);
  assert_true(sph_group_viscosity(NULL) == 0 && sph_group_conductivity(NULL) == 0);
  sph_group_set_material(NULL, sph_material_preset("water", 0));
  sph_group_set_material(NULL, sph_material_preset(NULL, 0));
  sph_sim_add_term(NULL, sph_term_pressure());
  sph_sim_set_integrator(NULL, NULL);
  sph_sim_add_output(NULL, (sph_output){0});
  sph_sim_set_progress(NULL, NULL, NULL);
  sph_sim_changed(NULL);
  assert_true(sph_sim_fail(NULL, SPH_ERR_FILE, "x") < 0);
  assert_true(sph_sim_run(NULL, 1) < 0 && sph_sim_step(NULL) < 0 && sph_sim_evaluate(NULL) < 0);
  assert_null(sph_sim_group(NULL, "water"));
  assert_null(sph_sim_group_get(NULL, 0));
  assert_null(sph_group_read(NULL, "position", 0));
  assert_null(sph_group_write(NULL, "position", 0));
  assert_null(sph_group_rate(NULL, "position", 0));
  assert_null(sph_group_ids(NULL));
  assert_int_equal(sph_group_id(NULL, 0), -1);
  assert_int_equal(sph_group_count(NULL), 0);
  sph_balance balance;
  sph_sim_stats stats;
  sph_sim_balance(NULL, &balance);
  sph_sim_get_stats(NULL, &stats);
  (void)sph_sim_time(NULL), (void)sph_sim_dim(NULL), (void)sph_sim_dx(NULL), (void)sph_sim_h(NULL);
  (void)sph_sim_kernel(NULL), (void)sph_sim_isa(NULL), (void)sph_sim_integrator(NULL);
  (void)sph_sim_threads(NULL), (void)sph_sim_revision(NULL);
  (void)sph_group_name(NULL), (void)sph_group_kind(NULL), (void)sph_group_eos(NULL);
  (void)sph_group_thermal(NULL);
  sph_sim_free(NULL);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(create),          cmocka_unit_test(groups),
      cmocka_unit_test(no_pointers),     cmocka_unit_test(materials),
      cmocka_unit_test(properties),      cmocka_unit_test(terms),
      cmocka_unit_test(integrators),     cmocka_unit_test(own_integrators),
      cmocka_unit_test(unfinished),      cmocka_unit_test(outputs_and_times),
      cmocka_unit_test(after_the_start), cmocka_unit_test(wrong_kind),
      cmocka_unit_test(bad_states),      cmocka_unit_test(callbacks),
      cmocka_unit_test(null_simulation),
  };
  return cmocka_run_group_tests_name("hostile input", tests, NULL, NULL);
}
