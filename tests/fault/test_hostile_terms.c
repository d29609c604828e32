/* Bad values and combinations of the terms of density, viscosity, heat and own scalars, of
 * energies and temperatures: refused with a text that tells what was wrong and what would be
 * right, word by word. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

/* What to spoil: a liquid or a gas without terms, c_v unknown, no energy chosen. */
typedef struct subject {
  sph_sim *sim;
  sph_group *water, *floor;
} subject;

static subject make(sph_eos eos)
{
  subject s = {.sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1})};
  s.water = sph_group_box(s.sim, "water", (double[]){0, 0}, (double[]){1, 0.5}, 1000);
  s.floor = sph_group_create(s.sim, "floor", "wall");
  sph_group_add_layers(s.floor, (double[]){0, 0}, (double[]){1, 0.8}, "y+", 1000);
  sph_group_set_eos(s.water, eos);
  sph_group_set_boundary(s.floor, sph_boundary_adami());
  double *u = sph_group_write(s.water, "energy", 0);
  for (long i = 0; u && i < sph_group_count(s.water); i++) u[i] = 100;
  assert_string_equal(sph_sim_error(s.sim), "");
  return s;
}

static subject liquid(void) { return make(sph_eos_tait(1000, 20, 7)); }
static subject gas(void) { return make(sph_eos_ideal_gas(1.4)); }

/* Refused where it is set or, at the latest, when it is used; then nothing works any more. */
static void assert_refused(subject s, int status, const char *text)
{
  int found = sph_sim_evaluate(s.sim);
  if (strcmp(sph_sim_error(s.sim), text) != 0)
    fail_msg("\"%s\"\n  instead of\n\"%s\"", sph_sim_error(s.sim), text);
  assert_int_equal(found, status);
  sph_sim_add_term(s.sim, (sph_term){.name = "nonsense"});
  sph_group_set_energy(s.water, "nonsense");
  assert_int_equal(sph_sim_run(s.sim, 1), status);
  assert_string_equal(sph_sim_error(s.sim), text);
  sph_sim_free(s.sim);
}

static void refused(subject s, sph_term term, const char *text)
{
  sph_sim_add_term(s.sim, term);
  assert_refused(s, SPH_ERR_ARGUMENT, text);
}

/* ---- parameters ---- */

static void parameters(void **state)
{
  (void)state;
  static const double bad[] = {NAN, INFINITY, -INFINITY, -1};
  static const char *const name[] = {"nan", "inf", "-inf", "-1"};
  char text[200];
  for (int k = 0; k < 4; k++) {
    snprintf(text, sizeof text, "term viscosity-signal: alpha = %s; right is a finite number >= 0",
             name[k]);
    refused(liquid(), sph_term_viscosity_signal(bad[k], 3), text);
    snprintf(text, sizeof text, "term viscosity-signal: beta = %s; right is a finite number >= 0",
             name[k]);
    refused(liquid(), sph_term_viscosity_signal(1, bad[k]), text);
    snprintf(text, sizeof text, "term xsph: epsilon = %s; right is 0 to 1, usually up to 0.5",
             name[k]);
    refused(liquid(), sph_term_xsph(bad[k]), text);
    snprintf(text, sizeof text, "term continuity: exponent = %s is not finite", name[k]);
    if (k < 3) refused(liquid(), sph_term_continuity_phi(bad[k]), text);
    snprintf(text, sizeof text, "term delta: delta = %s; right is a finite number >= 0", name[k]);
    refused(liquid(), sph_term_delta("fourtakas", bad[k]), text);
  }
  refused(liquid(), sph_term_xsph(2), "term xsph: epsilon = 2; right is 0 to 1, usually up to 0.5");
  refused(liquid(), sph_term_viscosity_laminar("newton"),
          "term viscosity-laminar: form \"newton\"; known: morris, mcg");
  refused(liquid(), sph_term_continuity_form("sum"),
          "term continuity: form \"sum\"; known: c2, c1, phi");
  refused(liquid(), sph_term_pressure_form("c1"), "term pressure: form \"c1\"; known: c2, s, phi");
  refused(liquid(), sph_term_heat_source(NULL, NULL), "term heat-source: no power function (NULL)");
  int anything;
  refused(liquid(), sph_term_heat_source(NULL, &anything),
          "term heat-source: no power function (NULL)");
}

static sph_term salt(double D, const sph_group_value *by_group, int n)
{
  sph_term term = sph_term_scalar_diffusion((sph_scalar){.name = "salt", .scale = 1}, D);
  term.by_group = by_group;
  term.by_groups = n;
  return term;
}

static void scalars_that_diffuse(void **state)
{
  (void)state;
  refused(liquid(), salt(-1, NULL, 0),
          "term salt: diffusivity = -1; right is a finite number >= 0");
  refused(liquid(), salt(NAN, NULL, 0),
          "term salt: diffusivity = nan; right is a finite number >= 0");
  refused(liquid(), salt(1, &(sph_group_value){NULL, 1}, 1),
          "term salt: a value of no group (NULL)");
  refused(liquid(), salt(1, &(sph_group_value){"floor", NAN}, 1),
          "term salt: group floor: nan is not finite");
  refused(liquid(), salt(1, &(sph_group_value){"ceiling", 1}, 1),
          "term salt: there is no group ceiling");
  refused(liquid(), salt(1, &(sph_group_value){"water", -1}, 1),
          "term salt: diffusivity in water = -1 m^2/s; right is >= 0");
  refused(liquid(), sph_term_scalar_diffusion((sph_scalar){.scale = 1}, 1),
          "a term without a name");
}

/* ---- combinations ---- */

static void refused_pair(subject s, sph_term first, sph_term second, const char *text)
{
  sph_sim_add_term(s.sim, first);
  refused(s, second, text);
}

static void twice(void **state)
{
  (void)state;
  refused_pair(liquid(), sph_term_summation(1), sph_term_summation(0),
               "term summation: density is already that of summation");
  refused_pair(liquid(), sph_term_continuity(), sph_term_summation(0),
               "term summation: density is already that of continuity");
  refused_pair(liquid(), sph_term_summation(1), sph_term_continuity(),
               "term continuity: density is summed already");
  refused_pair(liquid(), sph_term_viscosity_laminar("mcg"), sph_term_viscosity_laminar("morris"),
               "term viscosity-laminar: added twice");
  refused_pair(liquid(), sph_term_xsph(0.5), sph_term_xsph(0.5), "term xsph: added twice");
  refused_pair(gas(), sph_term_conduction(), sph_term_conduction(), "term conduction: added twice");
  refused_pair(liquid(), sph_term_viscosity_signal(1, 3), sph_term_viscosity_signal(1, 3),
               "term viscosity-signal: added twice");
  refused_pair(liquid(), sph_term_delta("fourtakas", 0.1), sph_term_delta("molteni", 0.1),
               "term delta: added twice");
}

static void rows(void **state)
{
  (void)state;
  static const char mixed[] = "continuity and pressure of different rows do not conserve energy: "
                              "use c2 with c2, c1 or summation with s, phi with phi";
  refused_pair(liquid(), sph_term_summation(1), sph_term_pressure(), mixed);
  refused_pair(liquid(), sph_term_summation(1), sph_term_pressure_form("phi"), mixed);
  refused_pair(liquid(), sph_term_continuity_phi(0.5), sph_term_pressure(), mixed);
  refused_pair(liquid(), sph_term_continuity_phi(0), sph_term_pressure_form("s"), mixed);
  refused_pair(liquid(), sph_term_continuity_form("c1"), sph_term_pressure_form("phi"), mixed);
  refused(liquid(), sph_term_pressure_form("phi"),
          "term pressure: form phi takes phi from continuity of form phi");
  refused_pair(liquid(), sph_term_summation(1), sph_term_delta("molteni", 0.1),
               "term delta diffuses a density that is integrated; summation has none: leave one of "
               "them out");
}

/* ---- terms that would do nothing, or nothing right ---- */

static double power(void *ctx, const double x[3], double t) { return (void)ctx, (void)x, t; }

static void unfit(void **state)
{
  (void)state;
  sph_eos eos = sph_eos_ideal_gas(1.4);
  eos.c_v = 718;
  refused(gas(), sph_term_delta("fourtakas", 0.1),
          "delta needs a reference sound speed, which equation of state ideal-gas of water has not "
          "(c0 = 0): leave the term out or set eos.c0");
  subject soft = make(sph_eos_linear(1000, 3, -INFINITY));
  refused_pair(
      soft, sph_term_gravity((double[3]){0, -9.81, 0}), sph_term_delta("fourtakas", 0.1),
      "delta fourtakas needs a liquid like tait, linear or murnaghan whose density differs "
      "little over a support; water with equation of state linear has gamma g H/c0^2 = "
      "0.327, right is below 0.1");
  refused(gas(), sph_term_conduction(),
          "conduction needs a temperature, which water has not: give it a specific heat (eos.c_v)");
  refused(liquid(), sph_term_conduction(),
          "conduction needs a temperature, which water has not: give it an energy "
          "(sph_group_set_energy) and a specific heat (eos.c_v)");
  refused(make(eos), sph_term_conduction(),
          "conduction: no fluid has a conductivity: sph_group_set_conductivity");
  refused(liquid(), sph_term_viscosity_laminar(NULL),
          "viscosity-laminar: no fluid has a viscosity: sph_group_set_viscosity");
  refused(
      liquid(), sph_term_conductivity_artificial(1),
      "conductivity-artificial acts on internal energy, which water with equation of state tait "
      "has not: leave the term out");
  refused(liquid(), sph_term_heat_source(power, NULL),
          "heat-source heats an energy, which water has not: sph_group_set_energy");
}

/* ---- dust ---- */

static subject dusty(void)
{
  subject s = liquid();
  sph_group *dust = sph_group_box(s.sim, "dust", (double[]){0, 0}, (double[]){1, 0.5}, 3);
  sph_group_set_eos(dust, sph_eos_dust());
  return s;
}

static void dust(void **state)
{
  (void)state;
  static const double bad[] = {NAN, INFINITY, -1}, p[50] = {0};
  static const char *const name[] = {"nan", "inf", "-1"};
  char text[200];
  for (int k = 0; k < 3; k++) {
    snprintf(text, sizeof text, "term drag: K = %s; right is a finite number >= 0", name[k]);
    refused(dusty(), sph_term_drag(bad[k]), text);
    snprintf(text, sizeof text, "term drag: stopping time = %s s; right is > 0 and finite",
             name[k]);
    refused(dusty(), sph_term_drag_time(bad[k]), text);
  }
  refused(dusty(), sph_term_drag_time(0),
          "term drag: stopping time = 0 s; right is > 0 and finite");
  refused(dusty(), (sph_term){.name = "drag", .form = "k"},
          "term drag: form \"k\"; known: K, time");
  refused_pair(dusty(), sph_term_drag(1), sph_term_drag_time(1), "term drag: added twice");
  refused(liquid(), sph_term_drag(1),
          "drag: there is no dust: a group with equation of state sph_eos_dust");
  subject s = dusty();
  sph_group_set_energy(sph_sim_group(s.sim, "dust"), "u");
  assert_refused(s, SPH_ERR_ARGUMENT,
                 "group dust: dust has no energy, not u; drag heats the fluid");
  s = liquid(), sph_group_set_eos(s.floor, sph_eos_dust());
  assert_refused(s, SPH_ERR_ARGUMENT,
                 "group floor is a wall: it has the equation of state of a fluid, not of dust");
  s = liquid(), sph_group_set_eos(s.water, sph_eos_dust());
  assert_refused(s, SPH_ERR_STATE,
                 "no fluid particles: add a group with sph_group_box first (dust alone is none)");
  s = dusty(), sph_group_set_pressure(sph_sim_group(s.sim, "dust"), p);
  assert_refused(s, SPH_ERR_ARGUMENT,
                 "group dust, particle 0: no state of equation of state dust has p = 0 Pa");
  s = dusty(), sph_group_set_hydrostatic(sph_sim_group(s.sim, "dust"), 1, 1, 9.81);
  assert_refused(s, SPH_ERR_ARGUMENT, "group dust: hydrostatic needs a liquid, not dust");
}

/* ---- energies and temperatures ---- */

static void refused_energy(subject s, int wall, const char *variable, const char *text)
{
  sph_group_set_energy(wall ? s.floor : s.water, variable);
  assert_refused(s, SPH_ERR_ARGUMENT, text);
}

static void energies(void **state)
{
  (void)state;
  refused_energy(gas(), 1, "u", "group floor is a wall: it integrates nothing");
  refused_energy(gas(), 0, "enthalpy",
                 "group water: energy \"enthalpy\"; known: u, total, entropy, temperature, none");
  refused_energy(gas(), 0, NULL,
                 "group water: energy \"\"; known: u, total, entropy, temperature, none");
  refused_energy(liquid(), 0, "entropy",
                 "group water: energy entropy needs an ideal gas, not equation of state tait");
  refused_energy(
      liquid(), 0, "total",
      "group water: the pressure of equation of state tait does not depend on an energy; "
      "right are u, temperature or none, not total");
  refused_energy(gas(), 0, "none",
                 "group water: equation of state ideal-gas needs an energy, not none");
  for (int k = 0; k < 2; k++)
    refused_energy(k ? gas() : liquid(), 0, "temperature",
                   "group water: energy temperature needs a specific heat: set eos.c_v");
  subject s = gas(); /* one fluid with energy, one without */
  sph_group *oil = sph_group_box(s.sim, "oil", (double[]){5, 5}, (double[]){6, 6}, 900);
  sph_group_set_eos(oil, sph_eos_tait(900, 20, 7));
  assert_refused(s, SPH_ERR_STATE,
                 "groups water and oil: all fluids or none must have an energy "
                 "(sph_group_set_energy)");
  s = gas();
  assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  sph_group_set_energy(s.water, "u");
  assert_refused(s, SPH_ERR_STATE, "group water: the energy is set before the run");
}

static void temperatures(void **state)
{
  (void)state;
  double T[50];
  sph_eos eos = sph_eos_ideal_gas(1.4);
  for (int i = 0; i < 50; i++) T[i] = i == 7 ? -300 : 300;
  subject s = liquid();
  assert_int_equal(sph_group_count(s.water), 50);
  sph_group_set_temperature(sph_group_create(s.sim, "oil", "fluid"), T);
  assert_refused(s, SPH_ERR_STATE, "group oil: set its equation of state before its temperature");
  s = gas();
  sph_group_set_temperature(s.water, T);
  assert_refused(s, SPH_ERR_ARGUMENT,
                 "group water: equation of state ideal-gas has no temperature: set its specific "
                 "heat, eos.c_v");
  s = gas();
  sph_group_set_temperature(s.water, NULL);
  assert_refused(s, SPH_ERR_ARGUMENT,
                 "group water: no temperatures (NULL); equation of state ideal-gas");
  eos.c_v = 718;
  s = make(eos);
  sph_group_set_temperature(s.water, T);
  assert_refused(s, SPH_ERR_ARGUMENT, "group water, particle 7: temperature -300 K; right is > 0");
  T[7] = NAN;
  s = make(eos);
  sph_group_set_temperature(s.water, T);
  assert_refused(s, SPH_ERR_ARGUMENT, "group water, particle 7: temperature nan K; right is > 0");
  s = make(eos);
  assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  sph_group_set_temperature(s.water, T);
  assert_refused(s, SPH_ERR_STATE, "group water: temperature is set before the run");
  static const double bad[] = {NAN, -1, INFINITY};
  static const char *const name[] = {"nan", "-1", "inf"};
  for (int k = 0; k < 3; k++) {
    char text[200];
    sph_boundary boundary = sph_boundary_adami();
    boundary.temperature = bad[k];
    s = gas();
    sph_group_set_boundary(s.floor, boundary);
    snprintf(
        text, sizeof text,
        "group floor: temperature of the boundary %s K; right is > 0 and finite, or 0: adiabatic",
        name[k]);
    assert_refused(s, SPH_ERR_ARGUMENT, text);
  }
}

/* ---- a user's own ---- */

static int body(const sph_term *term, const sph_particles *particles)
{
  return (void)term, (void)particles, SPH_OK;
}
static void pair(const sph_term *term, const sph_tile *tile) { (void)term, (void)tile; }

static sph_term dye(sph_scalar scalar)
{
  return (sph_term){.name = "dye", .body = body, .scalar = scalar};
}

static void scalars(void **state)
{
  (void)state;
  static const char *const name[] = {
      "",
      "a b",
      "\xc3\xa9",
      "c-1",
      "Density",
      "_c",
      "abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyzabcdefghijkl"}; /* 64 */
  char text[300];
  for (int k = 0; k < 7; k++) {
    snprintf(text, sizeof text,
             "term dye: scalar \"%s\"; right is 1 to 63 of A-Z a-z 0-9 _, the first of a-z",
             name[k]);
    refused(liquid(), dye((sph_scalar){.name = name[k], .scale = 1}), text);
  }
  static const char *const taken[] = {"density", "energy", "temperature", "entropic_function",
                                      "id"};
  for (int k = 0; k < 4; k++) {
    snprintf(text, sizeof text, "term dye: there is a field %s already; choose another name",
             taken[k]);
    refused(liquid(), dye((sph_scalar){.name = taken[k], .scale = 1}), text);
  }
  refused_pair(liquid(), dye((sph_scalar){.name = "c", .scale = 1}),
               dye((sph_scalar){.name = "c", .scale = 1}),
               "term dye: there is a field c already; choose another name");
  static const double scale[] = {0, -1, NAN, INFINITY};
  for (int k = 0; k < 4; k++) {
    snprintf(text, sizeof text,
             "term dye: scalar c: scale = %g, initial = 0; right is finite and scale > 0",
             scale[k]);
    refused(liquid(), dye((sph_scalar){.name = "c", .scale = scale[k]}), text);
  }
  refused(liquid(), dye((sph_scalar){.name = "c", .scale = 1, .initial = NAN}),
          "term dye: scalar c: scale = 1, initial = nan; right is finite and scale > 0");
  refused(liquid(), dye((sph_scalar){.name = "c", .unit = "kg,m", .scale = 1}),
          "term dye: scalar c: unit \"kg,m\"; right is a text like kg/m^3, without , ; \" [ ] and "
          "line ends");
  refused(liquid(), (sph_term){.name = "dye", .scalar = {.name = "c", .scale = 1}},
          "term \"dye\": not a built-in one and without a body or pair function");
}

static void too_many(void **state)
{
  (void)state;
  static const char *const name[] = {"a", "b", "c", "d", "e", "f", "g", "h"};
  subject s = liquid();
  for (int k = 0; k < 8; k++)
    sph_sim_add_term(s.sim, dye((sph_scalar){.name = name[k], .scale = 1}));
  assert_string_equal(sph_sim_error(s.sim), "");
  refused(s, dye((sph_scalar){.name = "i", .scale = 1}), "term dye: more than 8 scalars");
  s = liquid();
  for (int k = 0; k < 32; k++) sph_sim_add_term(s.sim, dye((sph_scalar){0}));
  assert_string_equal(sph_sim_error(s.sim), "");
  refused(s, dye((sph_scalar){0}), "term dye: more than 32 terms with functions");
}

static void reads(void **state)
{
  (void)state;
  static const char many[] = "density pressure sound_speed, density pressure sound_speed, density "
                             "pressure sound_speed";
  char longer[300] = {0};
  memset(longer, 'a', 256);
  refused(liquid(), (sph_term){.name = "dye", .pair = pair, .reads = "density colour"},
          "term dye reads \"colour\"; known: density, pressure, sound_speed, energy, temperature, "
          "scalars of terms, and of the pair r, v, r2, rv, v_viscous, rv_viscous, F, V, m");
  refused(liquid(), (sph_term){.name = "dye", .pair = pair, .reads = "energy"},
          "term dye reads energy, which no fluid has");
  refused(gas(), (sph_term){.name = "dye", .pair = pair, .reads = many},
          "term dye reads more than 8 fields");
  refused(gas(), (sph_term){.name = "dye", .pair = pair, .reads = longer},
          "term dye: reads or adds of more than 255 characters");
  refused(gas(), (sph_term){.name = "dye", .pair = pair, .adds = longer},
          "term dye: reads or adds of more than 255 characters");
  refused(gas(), (sph_term){.name = "dye", .pair = pair, .adds = "drho, speed"},
          "term dye adds to \"speed\"; known: push, along_r, along_v, drho, du, ds");
}

/* ---- NULL flows through, and after the start it is too late ---- */

static void no_group(void **state)
{
  (void)state;
  sph_group_set_energy(NULL, "u");
  sph_group_set_temperature(NULL, NULL);
  sph_sim_add_term(NULL, dye((sph_scalar){.name = "c", .scale = 1}));
  assert_string_equal(sph_group_energy(NULL), "none");
  assert_null(sph_group_field(NULL, 0));
  assert_null(sph_term_name(-1));
  assert_null(sph_term_formula("newton"));
  assert_null(sph_term_formula(NULL));
  for (int k = 0; sph_term_name(k); k++) assert_non_null(sph_term_formula(sph_term_name(k)));
  subject s = liquid();
  assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  sph_sim_add_term(s.sim, sph_term_xsph(0.1));
  assert_refused(s, SPH_ERR_STATE, "term xsph: terms are added before the run");
}

/* Warnings name what does nothing, in this order; a sound set-up has none. */
static void warned(sph_sim *sim, const char *const *text, int n)
{
  char found[200];
  for (int k = 0; k < n; k++) {
    assert_int_equal(sph_sim_warning(sim, k, found, sizeof found), 1);
    assert_string_equal(found, text[k]);
  }
  assert_int_equal(sph_sim_warning(sim, n, found, sizeof found), 0);
}

static void warnings(void **state)
{
  (void)state;
  static const char *const bare[] = {
      "nothing changes the density: no continuity, no summation",
      "no pressure force",
      "delta fourtakas without gravity is molteni",
      "water has a viscosity, but there is no viscosity-laminar",
      "water has a conductivity, but there is no conduction",
      "wall floor has a temperature, but there is no conduction",
      "wall floor is no-slip, but there is no viscous term to feel it",
      "wall floor has a viscosity, which is not used: fluids take their own"};
  subject s = liquid();
  sph_boundary boundary = sph_boundary_adami_no_slip();
  boundary.temperature = 300;
  sph_group_set_boundary(s.floor, boundary);
  sph_group_set_viscosity(s.water, 1);
  sph_group_set_viscosity(s.floor, 1);
  sph_group_set_conductivity(s.water, 1);
  sph_sim_add_term(s.sim, sph_term_delta("fourtakas", 0.1));
  warned(s.sim, bare, 8);
  assert_int_equal(sph_sim_warning(NULL, 0, NULL, 0), 0);
  assert_int_equal(sph_sim_warning(s.sim, 0, NULL, 0), 1);
  sph_sim_add_term(s.sim, sph_term_continuity());
  sph_sim_add_term(s.sim, sph_term_pressure());
  sph_sim_add_term(s.sim, sph_term_gravity((double[]){0, -1, 0}));
  sph_sim_add_term(s.sim, sph_term_viscosity_laminar("mcg"));
  sph_sim_add_term(s.sim, sph_term_conduction());
  warned(s.sim, bare + 7, 1);
  sph_sim_free(s.sim);
}

/* Explicit steps, far shorter than sound's: by viscosity 0.125 h^2 rho/eta, 1/40 of h/c here, by
 * drag t_s/2; told once the limits are known, and not of what is implicit. */
static void warnings_of_steps(void **state)
{
  (void)state;
  static const char *const told[] = {
      "viscosity-laminar bounds steps to 1/40 of h/c: integrator imex:ark324l2sa-4-2-3 takes it "
      "implicitly",
      "drag bounds steps to 1/150 of h/c: integrator imex:ark324l2sa-4-2-3 takes it implicitly"};
  for (int k = 0; k < 3; k++) {
    subject s = {.sim = sph_sim_create(
                     &(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1, 1}})};
    for (int dust = 0; dust < 2; dust++) {
      sph_group *group = sph_group_box(s.sim, dust ? "dust" : "water", (double[]){0, 0},
                                       (double[]){1, 1}, dust ? 1 : 1000);
      sph_group_set_eos(group, dust ? sph_eos_dust() : sph_eos_tait(1000, 20, 7));
      if (!dust) sph_group_set_viscosity(group, 0.125 * 0.15 * 1000 * 20 * (k ? 40 : 4));
    }
    sph_sim_add_term(s.sim, sph_term_continuity());
    sph_sim_add_term(s.sim, sph_term_pressure());
    sph_sim_add_term(s.sim, sph_term_viscosity_laminar("morris"));
    sph_sim_add_term(s.sim, sph_term_drag(k ? 1e4 : 1));
    sph_sim_set_integrator(s.sim, &(sph_integrator_def){.method = k == 2 ? "imex:ark324l2sa-4-2-3"
                                                                         : NULL});
    warned(s.sim, told, 0);
    assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
    warned(s.sim, told, k == 1 ? 2 : 0);
    sph_sim_free(s.sim);
  }
}

static void warnings_of_dust(void **state)
{
  (void)state;
  static const char *const told[] = {"drag with K = 0 does nothing",
                                     "dust is dust, but there is no drag: nothing acts on it",
                                     "dust is dust: walls do not hold it",
                                     "dust is dust: its viscosity and conductivity are not used"};
  subject s = dusty();
  sph_sim_add_term(s.sim, sph_term_continuity());
  sph_sim_add_term(s.sim, sph_term_pressure());
  warned(s.sim, told + 1, 2);
  sph_group_set_conductivity(sph_sim_group(s.sim, "dust"), 1);
  warned(s.sim, told + 1, 3);
  sph_sim_add_term(s.sim, sph_term_drag(0));
  warned(s.sim, (const char *[]){told[0], told[2], told[3]}, 3);
  sph_sim_free(s.sim);
}

/* ---- manufactured solutions ---- */

static void at_rest(void *ctx, const double x[3], double t, double v[3])
{
  (void)ctx, (void)x, (void)t;
  v[0] = v[1] = 0;
}

static double constant(void *ctx, const double x[3], double t)
{
  (void)x, (void)t;
  return ctx ? *(double *)ctx : 1000;
}

static void attached(subject s, sph_group *group, sph_manufactured def, const char *text)
{
  sph_manufactured_attach(group, &def);
  assert_refused(s, SPH_ERR_ARGUMENT, text);
}

static void manufactured(void **state)
{
  (void)state;
  static const char wants[] =
      "group water: a manufactured solution needs a velocity, and either a density or a pressure";
  static const char liquids[] = ": a manufactured solution needs a fluid whose pressure depends on "
                                "its density alone; set its equation of state before";
  const sph_manufactured right = {at_rest, constant, NULL, 1, 1, NULL};
  sph_manufactured d = right;
  double none = 0;
  char text[300];
  subject s = liquid();
  d.velocity = NULL, attached(s, s.water, d, wants);
  s = liquid(), d = right;
  d.density = NULL, attached(s, s.water, d, wants);
  s = liquid(), d = right;
  d.pressure = constant, attached(s, s.water, d, wants);
  s = liquid(), d = right;
  d.time = 0;
  attached(s, s.water, d,
           "group water: a manufactured solution that changes over 1 m and 0 s; right is > 0 and "
           "finite");
  s = liquid(), d = right;
  d.ctx = &none;
  attached(s, s.water, d, "group water, particle 0: manufactured density 0 kg/m^3; right is > 0");
  s = gas(), snprintf(text, sizeof text, "group water%s", liquids);
  attached(s, s.water, right, text);
  s = liquid(), snprintf(text, sizeof text, "group floor%s", liquids);
  attached(s, s.floor, right, text);
  s = liquid(), sph_manufactured_attach(s.water, &right);
  attached(s, s.water, right, "group water has a manufactured solution already");
  s = liquid();
  assert_int_equal(sph_manufactured_source(s.water, (double[3]){0}, 0, NULL, NULL),
                   SPH_ERR_ARGUMENT);
  assert_refused(s, SPH_ERR_ARGUMENT, "group water has no manufactured solution");
  s = liquid(), sph_manufactured_attach(s.water, &right);
  assert_int_equal(sph_manufactured_error_of(s.water, "mass", &(sph_manufactured_error){0}),
                   SPH_ERR_ARGUMENT);
  assert_refused(s, SPH_ERR_ARGUMENT,
                 "a manufactured solution has no field \"mass\"; known: velocity, density, "
                 "pressure");
  s = liquid(), assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  sph_manufactured_attach(s.water, &right);
  assert_refused(s, SPH_ERR_STATE,
                 "group water: a manufactured solution is attached before the run");
  sph_manufactured_attach(NULL, &right);
  assert_int_equal(sph_manufactured_source(NULL, (double[3]){0}, 0, NULL, NULL), SPH_ERR_ARGUMENT);
  assert_int_equal(sph_manufactured_error_of(NULL, "velocity", NULL), SPH_ERR_ARGUMENT);
}

/* ---- switches of artificial viscosity ---- */

static sph_term monaghan(double alpha, const char *switches, double alpha_min)
{
  return sph_term_switched(sph_term_viscosity_artificial(alpha, 2), switches, alpha_min);
}

static void switches(void **state)
{
  (void)state;
  subject s;
  refused(gas(), monaghan(1, "balsara colin", 0),
          "term viscosity-artificial: switches \"colin\"; known: none, balsara, morris-monaghan, "
          "cullen-dehnen");
  refused(gas(), monaghan(1, "cullen-dehnen,morris-monaghan", 0),
          "term viscosity-artificial: switches morris-monaghan and cullen-dehnen: right is one of "
          "them");
  refused(gas(), monaghan(0, "morris-monaghan", 0),
          "term viscosity-artificial: alpha = 0, up to which its switch goes; right is > 0");
  refused(gas(), monaghan(1, "morris-monaghan", 1.5),
          "term viscosity-artificial: alpha_min = 1.5; right is up to alpha = 1");
  refused(gas(), monaghan(1, "morris-monaghan", -1),
          "term viscosity-artificial: alpha_min = -1; right is a finite number >= 0");
  s = gas(), sph_sim_add_term(s.sim, monaghan(1, "balsara", 0));
  refused(s, sph_term_viscosity_signal(1, 3),
          "viscosity-artificial and viscosity-signal, one of them with a switch: leave the other "
          "one out");
  s = gas(), sph_sim_add_term(s.sim, monaghan(1, "balsara", 0));
  sph_sim_set_part(s.sim, "viscosity-artificial", "implicit");
  assert_refused(s, SPH_ERR_ARGUMENT, "viscosity-artificial with a switch cannot be implicit");
  s = gas(), sph_sim_add_term(s.sim, monaghan(1, "cullen-dehnen", 0));
  sph_sim_add_term(s.sim, sph_term_viscosity_laminar("morris"));
  sph_group_set_viscosity(s.water, 1);
  sph_sim_set_integrator(s.sim, &(sph_integrator_def){.method = "imex:ark324l2sa-4-2-3"});
  assert_refused(
      s, SPH_ERR_ARGUMENT,
      "the switch cullen-dehnen follows from the whole acceleration, of which integrator "
      "imex:ark324l2sa-4-2-3 takes parts; right is one that steps all terms alike, or "
      "morris-monaghan");
  s = gas(), sph_sim_add_term(s.sim, monaghan(1, "balsara", 0));
  sph_jacobian *jacobian = sph_jacobian_create(s.sim, NULL);
  assert_int_equal(sph_jacobian_evaluate(jacobian), SPH_ERR_ARGUMENT);
  sph_jacobian_free(jacobian);
  assert_refused(
      s, SPH_ERR_ARGUMENT,
      "no derivatives of a simulation whose artificial viscosity has a switch: its slope "
      "is not worked out; right is a viscosity without one");
}

/* Alpha and beta of a term with a switch may change; what they may not go below stays. */
static void changed_switch(void **state)
{
  (void)state;
  subject s = gas();
  sph_sim_add_term(s.sim, monaghan(1, "morris-monaghan", 0.1));
  assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  sph_sim_change_term(s.sim, sph_term_viscosity_artificial(2, 4));
  assert_int_equal(sph_sim_evaluate(s.sim), SPH_OK);
  assert_non_null(sph_group_rate(s.water, "alpha", 0));
  sph_sim_change_term(s.sim, sph_term_viscosity_artificial(0.05, 0));
  assert_refused(s, SPH_ERR_ARGUMENT,
                 "term viscosity-artificial: alpha_min = 0.1; right is up to alpha = 0.05");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(scalars_that_diffuse),
      cmocka_unit_test(parameters),
      cmocka_unit_test(twice),
      cmocka_unit_test(rows),
      cmocka_unit_test(unfit),
      cmocka_unit_test(energies),
      cmocka_unit_test(temperatures),
      cmocka_unit_test(scalars),
      cmocka_unit_test(too_many),
      cmocka_unit_test(reads),
      cmocka_unit_test(no_group),
      cmocka_unit_test(warnings),
      cmocka_unit_test(dust),
      cmocka_unit_test(warnings_of_dust),
      cmocka_unit_test(warnings_of_steps),
      cmocka_unit_test(manufactured),
      cmocka_unit_test(switches),
      cmocka_unit_test(changed_switch),
  };
  return cmocka_run_group_tests_name("hostile terms", tests, NULL, NULL);
}
