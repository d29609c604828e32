/* Case files: units against their definitions, expressions, the schema's defaults, and for every
 * kind of broken file the message that a user reads.  tests/data/broken/x.yml begin with "#: "
 * and the message expected, without its path. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <dirent.h>
#include <math.h>

#include "case_schema.h"
#include "case_value.h"
#include "controller.h"
#include "linear.h"
#include "memory.h"
#include "si_unit.h"
#include "sphode.h"

/* ---- units and expressions */

static sph_case_name names[] = {{.name = (char[]){"H"}, .value = 0.6, .power = {0, 1, 0}},
                                {.name = (char[]){"g"}, .value = 9.81, .power = {0, 1, -2}},
                                {.name = (char[]){"n"}, .value = 3}};
enum { NAMES = sizeof names / sizeof *names };

static void units_have_their_size_and_dimension(void **state)
{
  static const struct {
    const char *text;
    double value, power[SPH_SI_BASES]; /* SI; kg, m, s, K, mol */
  } cases[] = {
      {"9.81 m/s^2", 9.81, {0, 1, -2}},
      {"0.5 mm", 0.5e-3, {0, 1, 0}},
      {"0.01m", 0.01, {0, 1, 0}},
      {"2 kPa", 2000, {1, -1, -2}},
      {"1 g/cm^3", 1000, {1, -3, 0}},
      {"1.125 in", 0.028575, {0, 1, 0}}, /* 25.4 mm by definition */
      {"1 ft", 0.3048, {0, 1, 0}},
      {"3 min", 180, {0, 0, 1}},
      {"2 N m", 2, {1, 2, -2}},
      {"2 N*m", 2, {1, 2, -2}},
      {"1 J/kg", 1, {0, 2, -2}},
      {"1 bar", 1e5, {1, -1, -2}},
      {"1.002 mPa s", 1.002e-3, {1, -1, -1}},
      {"0.6 W/m/K", 0.6, {1, 1, -3, -1}},
      {"0.4 kJ/kg/K", 400, {0, 2, -2, -1}},
      {"28.9644 g/mol", 0.0289644, {1, 0, 0, 0, -1}},
      {"8.314 J/mol/K*2 K", 16.628, {1, 2, -2, 0, -1}},
      {"50 Hz", 50, {0, 0, -1}},
      {"90 deg", 1.5707963267948966, {0, 0, 0}},
      {"0.2 1/s", 0.2, {0, 0, -1}},
      {"2 1/mm*H", 1200, {0, 0, 0}},
      {"36 km/min", 600, {0, 1, -1}},
      {"H/40", 0.015, {0, 1, 0}},
      {"g*2 s", 19.62, {0, 1, -1}},
      {"10*sqrt(2*g*H)", 34.310348293189911, {0, 1, -1}},
      {"2 m/g", 0.2038735983690112, {0, 0, 2}}, /* g is the parameter here */
      {"2 g", 2e-3, {1, 0, 0}},                 /* and the gram here */
      {"H < 1 m ? 2 Pa : 3 Pa", 2, {1, -1, -2}},
      {"max(H, 1 m)", 1, {0, 1, 0}},
      {"H^n", 0.216, {0, 3, 0}},
      {"pi", 3.14159265358979, {0, 0, 0}},
      {"1e-3", 1e-3, {0, 0, 0}},
      {".5", 0.5, {0, 0, 0}},
  };
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    sph_case_value v;
    if (sph_case_value_evaluate(cases[k].text, names, NAMES, &v))
      fail_msg("%s: %s", cases[k].text, v.problem);
    if (!(fabs(v.value - cases[k].value) <= 1e-14 * fabs(cases[k].value)))
      fail_msg("%s: %.17g, expected %.17g", cases[k].text, v.value, cases[k].value);
    for (int b = 0; b < SPH_SI_BASES; b++)
      if (v.power[b] != cases[k].power[b])
        fail_msg("%s: power %g of base %d, expected %g", cases[k].text, v.power[b], b,
                 cases[k].power[b]);
  }
}

static void what_cannot_be_is_refused(void **state)
{
  static const char *const bad[] = {
      "1 m + 1 s", "H + g",   "sin(H)", "exp(1 s)",  "1/0",
      "0/0",       "log(-1)", "1 xyz",  "0.01xyz",   "2 H",
      "a",         "1,2",     "H = 2",  "(1",        "1 +",
      "",          " ",       "\"a\"",  "1 m/s^2.5", "1e999",
      "m",         "H m",     "1..2",   "\xc3\xa9",  "H < 1 s ? 1 m : 1 s + H"};
  (void)state;
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    sph_case_value v;
    if (sph_case_value_evaluate(bad[k], names, NAMES, &v) != SPH_ERR_PARSE)
      fail_msg("'%s' was taken as %g", bad[k], v.value);
    assert_true(v.problem[0] != 0);
  }
}

static void a_problem_tells_its_column(void **state)
{
  sph_case_value v;
  (void)state;
  sph_case_value_evaluate("2*H + 3 foo", names, NAMES, &v);
  assert_int_equal(v.column, 8);
  sph_case_value_evaluate("20 mm + bar", names, NAMES, &v);
  assert_int_equal(v.column, 8);
}

static void fields_are_evaluated_at_each_point(void **state)
{
  const double x[] = {-1, 0, 0.5}, y[] = {2, 3, 4};
  const double *const points[] = {x, y};
  double out[3];
  sph_case_value v;
  (void)state;
  assert_int_equal(sph_case_value_field("x < 0 ? 1 kPa : y*H*2 Pa/m^2", names, NAMES, 2, 3, points,
                                        out, &v),
                   0);
  assert_true(out[0] == 1000);
  assert_true(fabs(out[1] - 3.6) < 1e-14 && fabs(out[2] - 4.8) < 1e-14);
  assert_int_equal(sph_case_value_field("1/x", names, NAMES, 2, 3, points, out, &v), SPH_ERR_PARSE);
  assert_non_null(strstr(v.problem, "infinite at x = 0 m"));
  assert_int_equal(sph_case_value_field("z", names, NAMES, 2, 3, points, out, &v), SPH_ERR_PARSE);
}

/* ---- whole files */

static const char small[] = "dimension: 2\n"
                            "spacing: 1 cm\n"
                            "groups:\n"
                            "  water:\n"
                            "    kind: fluid\n"
                            "    density: 1000\n"
                            "    eos: {tait: {sound_speed: 20 m/s}}\n"
                            "    shapes: [{box: {lower: [0, 0], upper: [0.1, 20 cm]}}]\n"
                            "terms: {continuity: , pressure: }\n"
                            "run: {end: 20 ms}\n";

static void defaults_are_filled_in(void **state)
{
  sph_error error = {0};
  (void)state;
  sph_case *c = sph_case_read_text("small.yml", small, strlen(small), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  assert_string_equal(sph_case_title(c), "");
  assert_string_equal(sph_case_text(c), small);
  assert_true(sph_case_end(c) == 20 * 1e-3);
  assert_string_equal(sph_case_plot_field(c), "velocity");
  const sph_case_node *tait = sph_case_reader_find(c->root, "groups")->first;
  tait = sph_case_reader_find(sph_case_reader_find(tait, "eos"), "tait");
  assert_true(sph_case_reader_number(tait, "gamma", 0) == 7);
  assert_string_equal(sph_case_reader_find(sph_case_reader_find(c->root, "kernel"), "name")->text,
                      "wendland-c2");
  sph_case_free(c);
}

static void set_replaces_and_adds(void **state)
{
  const char *const set[] = {"spacing=2 cm", "kernel.h_over_dx=1.7",
                             "groups.water.shapes.0.box.upper=[0.2, 0.3]", "title=Two words",
                             "terms.pressure.part=slow"};
  sph_error error = {0};
  (void)state;
  sph_case *c = sph_case_read_text("small.yml", small, strlen(small), 5, set, &error);
  if (!c) fail_msg("%s", error.text);
  assert_true(sph_case_reader_number(c->root, "spacing", 0) == 0.02);
  assert_true(sph_case_reader_number(sph_case_reader_find(c->root, "kernel"), "h_over_dx", 0) ==
              1.7);
  assert_string_equal(sph_case_title(c), "Two words");
  const sph_case_node *terms = sph_case_reader_find(c->root, "terms");
  assert_string_equal(sph_case_reader_text(sph_case_reader_find(terms, "pressure"), "part", "none"),
                      "slow");
  assert_true(!strncmp(sph_case_text(c), "# --set spacing=2 cm\n", 21));
  assert_string_equal(sph_case_source(c), small);
  sph_case_free(c);
}

static void same_tree(const sph_case_node *a, const sph_case_node *b)
{
  assert_int_equal(a->kind, b->kind);
  if (a->kind == SPH_CASE_SCALAR) assert_string_equal(a->text, b->text);
  assert_true(a->number == b->number || (isnan(a->number) && isnan(b->number)));
  for (a = a->first, b = b->first; a && b; a = a->next, b = b->next) {
    if (a->key && b->key) assert_string_equal(a->key, b->key);
    same_tree(a, b);
  }
  assert_true(!a && !b);
}

/* What is kept of a run says what was run: its text alone gives the case that was set, and so does
 * what was read with the same settings, as a restart does. */
static void the_text_is_that_of_what_was_set(void **state)
{
  const char *const set[] = {
      "spacing=2 cm",
      "title=\"two\\nlines, \\\"quoted\\\", \\x07 and a \\\\\"",
      "description=>\n  over two\n  lines: folded\n",
      "groups.water={kind: fluid, density: 900, eos: {linear: {sound_speed: 3*10 m/s}},\n shapes: "
      "[{ball: {centre: [0, 0], radius: 0.1}}, {box: {lower: [0, 1], upper: [0.1, 2]}}]}",
      "groups.water.shapes.1.box.upper=[0.2, 2.3]",
      "terms.gravity={acceleration: [0, -9.81]}",
      "groups.\"a b\"={kind: wall, density: 1, shapes: [layers: {lower: [-1, -1], upper: [3, 3], "
      "open: [x-]}]}",
  };
  const int n = sizeof set / sizeof *set;
  sph_error error = {0};
  (void)state;
  sph_case *c = sph_case_read_text("small.yml", small, strlen(small), n, set, &error);
  if (!c) fail_msg("%s", error.text);
  const char *text = sph_case_text(c), *source = sph_case_source(c);
  sph_case *again = sph_case_read_text("kept.yml", text, strlen(text), 0, NULL, &error);
  if (!again) fail_msg("%s\n%s", error.text, text);
  same_tree(c->root, again->root);
  sph_case_free(again);
  again = sph_case_read_text("kept.yml", source, strlen(source), n, set, &error);
  if (!again) fail_msg("%s\n%s", error.text, source);
  same_tree(c->root, again->root);
  sph_case_free(again);
  sph_case_free(c);
}

static void a_wrong_set_says_so(void **state)
{
  static const char *const wrong[][2] = {
      {"spacing=2 s", "small.yml: --set spacing=2 s: spacing: found s, wanted m"},
      {"spacing", "--set spacing: wanted key=value, as spacing=1cm"},
      {"spacing=[1",
       "small.yml: --set spacing=[1: in its value:2:1: not YAML: did not find expected ',' or ']', "
       "while parsing a flow sequence"},
      {"groups.water.shapes.7.box=1",
       "small.yml: --set groups.water.shapes.7.box=1: there is no '7'"},
  };
  (void)state;
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    sph_error error = {0};
    assert_null(sph_case_read_text("small.yml", small, strlen(small), 1, &wrong[k][0], &error));
    assert_int_equal(error.status, SPH_ERR_PARSE);
    assert_string_equal(error.text, wrong[k][1]);
  }
}

static void a_byte_order_mark_is_skipped(void **state)
{
  static const char *const set[] = {"spacing=2 cm"};
  char marked[sizeof small + 3] = "\xef\xbb\xbf";
  sph_error error = {0};
  (void)state;
  sph_case *c =
      sph_case_read_text("small.yml", strcat(marked, small), sizeof marked - 1, 1, set, &error);
  if (!c) fail_msg("%s", error.text);
  assert_string_equal(sph_case_source(c), small); /* readable again */
  sph_case_free(c);
  assert_null(sph_case_read_text("bad.yml", "\xef\xbb\xbf\x01", 4, 0, NULL, &error));
  assert_true(!strncmp(error.text, "bad.yml:1:1: control", 20));
}

static void the_simulation_is_what_the_file_says(void **state)
{
  sph_error error = {0};
  (void)state;
  sph_case *c = sph_case_read_text("small.yml", small, strlen(small), 0, NULL, &error);
  sph_sim *sim = c ? sph_case_build(c, 2, &error) : NULL;
  if (!sim) fail_msg("%s", error.text);
  const sph_group *water = sph_sim_group(sim, "water");
  assert_int_equal(sph_group_count(water), 200);
  assert_int_equal(sph_sim_threads(sim), 2);
  assert_true(sph_sim_dx(sim) == 0.01);
  assert_true(sph_group_eos(water)->c0 == 20 && sph_group_eos(water)->rho0 == 1000);
  sph_sim_free(sim);
  sph_case_free(c);
}

/* One group of each kind, beside what it must be. */
static void materials_are_what_the_file_says(void **state)
{
  const sph_eos water = sph_eos_tait(1000, 20, 7);
  sph_eos oil = sph_eos_linear(900, 30, -5), mud = sph_eos_murnaghan(1500, 3e6, 4);
  sph_eos liquid = sph_eos_stiffened_gas(1000, 4.4, 6e8, 20),
          own = sph_material_preset("air-tait", 50).eos;
  oil.p_background = mud.p_background = 100;
  liquid.c_v = 3000, own.rho0 = 1.3;
  const struct {
    const char *text;
    sph_eos eos;
    double viscosity, conductivity;
  } group[] = {
      {"density: 1000, eos: {tait: {sound_speed: 20}}, viscosity: 2 mPa s", water, 2e-3, 0},
      {"density: 900, eos: {linear: {sound_speed: 30, background: 1 hPa, p_min: -5 Pa}}", oil, 0,
       0},
      {"density: 1500, eos: {murnaghan: {bulk_modulus: 3 MPa, n: 4, background: 1 hPa}}", mud, 0,
       0},
      {"density: 1.2, eos: {isothermal: {sound_speed: 290}}", sph_eos_isothermal(1.2, 290), 0, 0},
      {"density: 2, eos: {polytropic: {pressure: 8 Pa, gamma: 2}}", sph_eos_polytropic(2, 2, 2), 0,
       0},
      {"density: 1, eos: {ideal-gas: {gamma: 1.4, molar_mass: 29 g/mol}}, conductivity: 0.025 "
       "W/m/K",
       sph_eos_ideal_gas_molar(1.4, 0.029), 0, 0.025},
      {"density: 1000, eos: {stiffened-gas: {gamma: 4.4, p_inf: 0.6 GPa, q: 20}}, "
       "specific_heat: 3 kJ/kg/K",
       liquid, 0, 0},
      {"density: 8930, eos: {mie-grueneisen: {sound_speed: 3940, slope: 1.49, grueneisen: 2}}",
       sph_eos_mie_grueneisen(8930, 3940, 1.49, 2), 0, 0},
      {"density: 1.225, eos: {tait: {match: g0, gamma: 1.4}}",
       sph_eos_tait_matched(&water, 1.225, 1.4), 0, 0},
      {"material: {preset: water, sound_speed: 10}, conductivity: 0",
       sph_material_preset("water", 10).eos, 1.002e-3, 0},
      {"material: {preset: air-tait, sound_speed: 50}, density: 1.3, viscosity: 0", own, 0,
       0.025326},
      {"material: {preset: steel}", sph_material_preset("steel", 0).eos, 0, 0},
      {"density: 1.225, eos: {tait: {match: g9, gamma: 1.4}}",
       sph_eos_tait_matched(&(sph_eos){.rho0 = 998.2, .c0 = 10, .gamma = 7}, 1.225, 1.4), 0, 0},
  };
  enum { GROUPS = sizeof group / sizeof *group };
  char text[4000] = "dimension: 1\nspacing: 0.1\ngroups:\n", name[20];
  sph_error error = {0};
  (void)state;
  for (int k = 0; k < GROUPS; k++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "  g%d: {kind: fluid, %s, shapes: [{box: {lower: [%d], upper: [%d]}}]}\n", k,
             group[k].text, k, k + 1);
  strcat(text, "terms: {continuity: , pressure: }\nrun: {end: 20 ms}\n");
  sph_case *c = sph_case_read_text("groups.yml", text, strlen(text), 0, NULL, &error);
  sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
  if (!sim) fail_msg("%s", error.text);
  for (int k = 0; k < GROUPS; k++) {
    snprintf(name, sizeof name, "g%d", k);
    const sph_group *g = sph_sim_group(sim, name);
    const sph_eos *found = sph_group_eos(g), *expected = &group[k].eos;
    assert_string_equal(found->name, expected->name);
    const double a[] = {found->rho0,
                        found->c0,
                        found->gamma,
                        found->p_background,
                        found->p_inf,
                        found->q,
                        found->slope,
                        found->grueneisen,
                        found->c_v,
                        sph_group_viscosity(g),
                        sph_group_conductivity(g)};
    const double b[] = {expected->rho0,         expected->c0,         expected->gamma,
                        expected->p_background, expected->p_inf,      expected->q,
                        expected->slope,        expected->grueneisen, expected->c_v,
                        group[k].viscosity,     group[k].conductivity};
    for (int m = expected->rho0 > 0 ? 0 : 1; m < 11; m++)
      if (!(fabs(a[m] - b[m]) <= 1e-14 * fabs(b[m])))
        fail_msg("%s: constant %d is %.17g, expected %.17g", name, m, a[m], b[m]);
    assert_true(found->p_min == expected->p_min);
    double rho = expected->rho0 > 0 ? expected->rho0 : 1;
    if (strcmp(found->name, "ideal-gas") != 0) /* the density of the particles, too */
      assert_true(fabs(sph_group_read(g, "density", 0)[0] - rho) <= 1e-14 * rho);
  }
  sph_sim_free(sim);
  sph_case_free(c);
}

static void a_preset_without_that_sound_speed(void **state)
{
  static const char text[] =
      "dimension: 1\nspacing: 0.1\ngroups:\n  block: {kind: fluid, material: "
      "%s, shapes: [{box: {lower: [0], upper: [1]}}]}\n"
      "terms: {continuity: , pressure: }\nrun: {end: 1}\n";
  static const char *const wrong[][2] = {
      {"{preset: steel, sound_speed: 9}", "bad.yml:4:24: material steel: c0 = 9 m/s"},
      {"{preset: oil}", "bad.yml:4:24: material oil: numerical sound speed c0 = 0 m/s must be"}};
  (void)state;
  for (int k = 0; k < 2; k++) {
    char whole[500];
    sph_error error = {0};
    snprintf(whole, sizeof whole, text, wrong[k][0]);
    sph_case *c = sph_case_read_text("bad.yml", whole, strlen(whole), 0, NULL, &error);
    assert_non_null(c);
    assert_null(sph_case_build(c, 1, &error));
    if (strncmp(error.text, wrong[k][1], strlen(wrong[k][1])) != 0)
      fail_msg("found %s", error.text);
    sph_case_free(c);
  }
}

/* Uniform in [-0.2, 0.2] dx in each direction: mean 0, variance 0.2^2/3; the same every time. */
static void jitter_moves_particles_off_their_lattice(void **state)
{
  const char *const set[][2] = {{"groups.water.jitter=0", "groups.water.seed=1"},
                                {"groups.water.jitter=0.2", "groups.water.seed=1"},
                                {"groups.water.jitter=0.2", "groups.water.seed=1"},
                                {"groups.water.jitter=0.2", "groups.water.seed=2"}};
  enum { CASES = 4, N = 200 };
  double x[CASES][2][N], sum = 0, squares = 0, together = 0;
  (void)state;
  for (int k = 0; k < CASES; k++) {
    sph_error error = {0};
    sph_case *c = sph_case_read_text("small.yml", small, strlen(small), 2, set[k], &error);
    sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
    if (!sim) fail_msg("%s", error.text);
    for (int d = 0; d < 2; d++)
      memcpy(x[k][d], sph_group_read(sph_sim_group(sim, "water"), "position", d), sizeof x[k][d]);
    sph_sim_free(sim);
    sph_case_free(c);
  }
  for (int i = 0; i < N; i++) {
    double by[2];
    for (int d = 0; d < 2; d++) {
      by[d] = (x[1][d][i] - x[0][d][i]) / 0.01;
      assert_true(fabs(by[d]) <= 0.2);
      assert_true(x[2][d][i] == x[1][d][i]);
      assert_true(x[3][d][i] != x[1][d][i]);
      sum += by[d], squares += by[d] * by[d];
    }
    together += by[0] * by[1];
  }
  double one = 0.2 / sqrt(3); /* standard deviation */
  assert_true(fabs(sum / (2 * N)) < 4 * one / sqrt(2 * N));
  assert_true(fabs(squares / (2 * N) / (one * one) - 1) < 4 * sqrt(0.8 / (2 * N)));
  assert_true(fabs(together / N) < 4 * one * one / sqrt(N));
}

/* A switch that varies alpha gives particles a field of it, which starts at its least. */
static void switches_of_viscosity(void **state)
{
  static const char *const set[][2] = {
      {"terms.viscosity-artificial={alpha: 2, beta: 4, switch: balsara morris-monaghan, "
       "alpha_min: 0.2}",
       "terms.pressure={}"},
      {"terms.viscosity-signal={alpha: 2, switch: cullen-dehnen}", "terms.pressure={}"},
      {"terms.viscosity-artificial={alpha: 2, switch: balsara}", "terms.pressure={}"}};
  static const double least[] = {0.2, 0, -1};
  (void)state;
  for (int k = 0; k < 3; k++) {
    sph_error error = {0};
    sph_case *c = sph_case_read_text("small.yml", small, strlen(small), 2, set[k], &error);
    sph_sim *sim = c ? sph_case_build(c, 1, &error) : NULL;
    if (!sim) fail_msg("%s", error.text);
    const double *alpha = sph_group_read(sph_sim_group(sim, "water"), "alpha", 0);
    assert_int_equal(alpha != NULL, least[k] >= 0);
    if (alpha) assert_true(*alpha == least[k]);
    sph_sim_free(sim);
    sph_case_free(c);
  }
}

/* Of a liquid the pressure follows, in a gas the density is that at which pressure is taken. */
static void density_at_the_start(void **state)
{
  static const char text[] =
      "dimension: 1\nspacing: 0.1\ngroups:\n  water:\n    kind: fluid\n    density: 1000\n"
      "    eos: {%s}\n    initial: {density: 1000 kg/m^3*(1 + 0.01*x/(1 m))%s}\n"
      "    shapes: [{box: {lower: [0], upper: [1]}}]\n"
      "terms: {continuity: , pressure: }\nrun: {end: 1}\n";
  (void)state;
  for (int gas = 0; gas < 2; gas++) {
    char whole[500];
    sph_error error = {0};
    snprintf(whole, sizeof whole, text,
             gas ? "ideal-gas: {gamma: 1.4}" : "linear: {sound_speed: 20}",
             gas ? ", pressure: 5 kPa" : "");
    sph_case *c = sph_case_read_text("density.yml", whole, strlen(whole), 0, NULL, &error);
    sph_sim *sim = sph_case_build(c, 1, &error);
    if (!sim || sph_sim_evaluate(sim)) fail_msg("%s%s", error.text, sph_sim_error(sim));
    const sph_group *water = sph_sim_group(sim, "water");
    const double *x = sph_group_read(water, "position", 0), *m = sph_group_read(water, "mass", 0);
    const double *rho = sph_group_read(water, "density", 0);
    const double *p = sph_group_read(water, "pressure", 0);
    for (long i = 0; i < 10; i++) {
      const double right = gas ? 5000 : 400 * 10 * x[i];
      assert_true(fabs(rho[i] - 1000 - 10 * x[i]) <= 1e-9);
      assert_true(fabs(m[i] - 0.1 * rho[i]) <= 1e-9 && fabs(p[i] - right) <= 1e-6);
    }
    sph_sim_free(sim);
    sph_case_free(c);
  }
}

static void heat_that_cannot_be(void **state)
{
  static const char text[] = "dimension: 1\nspacing: 0.1\ngroups:\n  water:\n    kind: fluid\n"
                             "    density: 1000\n    eos: {%s}\n%s\n"
                             "    shapes: [{box: {lower: [0], upper: [1]}}]\n"
                             "terms: {continuity: , pressure: %s}\nrun: {end: 1}\n";
  static const char *const wrong[][4] = {
      {"tait: {sound_speed: 10}", "    initial: {temperature: 300}", "",
       "bad.yml:8:15: group water: equation of state tait has no temperature: set its specific "
       "heat"},
      {"tait: {sound_speed: 10}", "", ", heat-source: {power: t/(1 s)*1 W/kg}",
       "heat-source heats an energy, which water has not"},
      {"tait: {sound_speed: 10}", "    energy: total", "",
       "group water: the pressure of equation of state tait does not depend on an energy"},
      {"ideal-gas: {gamma: 1.4}", "    energy: temperature\n    initial: {energy: 1}", "",
       "group water: energy temperature needs a specific heat"}};
  (void)state;
  for (int k = 0; k < 4; k++) {
    char whole[500];
    sph_error error = {0};
    snprintf(whole, sizeof whole, text, wrong[k][0], wrong[k][1], wrong[k][2]);
    sph_case *c = sph_case_read_text("bad.yml", whole, strlen(whole), 0, NULL, &error);
    if (!c) fail_msg("%s", error.text);
    sph_sim *sim = sph_case_build(c, 1, &error); /* the others when they are used */
    assert_true((sim == NULL) == (k == 0));
    if (sim) assert_int_equal(sph_sim_evaluate(sim), SPH_ERR_ARGUMENT);
    const char *found = sim ? sph_sim_error(sim) : error.text;
    if (strncmp(found, wrong[k][3], strlen(wrong[k][3])) != 0) fail_msg("found %s", found);
    sph_sim_free(sim);
    sph_case_free(c);
  }
}

static void a_wall_has_no_scales(void **state)
{
  static const char text[] =
      "dimension: 1\nspacing: 0.1\ngroups:\n"
      "  water: {kind: fluid, density: 1000, eos: {tait: {sound_speed: 10}},\n"
      "    shapes: [{box: {lower: [0], upper: [1]}}]}\n"
      "  wall: {kind: wall, scales: {velocity: 1 m/s}, density: 1000,\n"
      "    shapes: [{box: {lower: [1], upper: [2]}}]}\n"
      "terms: {continuity: , pressure: }\nrun: {end: 1}\n";
  sph_error error = {0};
  (void)state;
  sph_case *c = sph_case_read_text("bad.yml", text, strlen(text), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  assert_null(sph_case_build(c, 1, &error));
  assert_non_null(strstr(error.text, "bad.yml:6:22: a wall has no scales"));
  sph_case_free(c);
}

/* Words that the schema spells out are those of the library. */
static void words_of_the_library(void **state)
{
  static const struct {
    const char *key;
    const char *(*name)(int k);
  } table[] = {{"linear", sph_linear_name}, {"controller", sph_controller_name}};
  (void)state;
  for (size_t t = 0; t < sizeof table / sizeof *table; t++) {
    const sph_case_key *key;
    char word[80];
    for (int k = 0; (key = sph_case_schema_key(k)); k++)
      if (!strcmp(key->mapping, "integrator") && !strcmp(key->name, table[t].key)) break;
    assert_non_null(key);
    int k = 0;
    for (; table[t].name(k); k++) {
      assert_non_null(sph_case_schema_choice(key, k, word));
      assert_string_equal(word, table[t].name(k));
    }
    assert_null(sph_case_schema_choice(key, k, word));
  }
}

/* ---- broken files */

static void check_broken(const char *directory, const char *file)
{
  char path[512], *message;
  sph_error error = {0};
  size_t size;
  assert_true(strlen(directory) + strlen(file) + 2 < sizeof path);
  strcat(strcat(strcpy(path, directory), "/"), file);
  char *text = sph_case_reader_load(path, &size, &error);
  assert_non_null(text);
  message = text + 3; /* "#: " */
  message[strcspn(message, "\n")] = 0;
  sph_case *c = sph_case_read(path, 0, NULL, &error);
  if (c && !sph_case_check_parts(c, &error)) assert_null(sph_case_build(c, 1, &error));
  sph_case_free(c);
  assert_int_equal(error.status, SPH_ERR_PARSE);
  assert_true(!strncmp(error.text, path, strlen(path)) && error.text[strlen(path)] == ':');
  assert_string_equal(error.text + strlen(path) + 1, message);
  sph_memory_free(text);
}

static void broken_files_say_what_is_wrong(void **state)
{
  const char *root = getenv("SRCDIR");
  char directory[1024];
  int n = 0;
  (void)state;
  snprintf(directory, sizeof directory, "%s/tests/data/broken", root ? root : ".");
  DIR *files = opendir(directory);
  if (!files) fail_msg("cannot open %s", directory);
  for (struct dirent *f; (f = readdir(files));) {
    if (!strstr(f->d_name, ".yml")) continue;
    check_broken(directory, f->d_name);
    n++;
  }
  closedir(files);
  assert_true(n >= 50);
}

/* The message for `size` bytes of text; "" for a case that was read. */
static void refused(const char *text, size_t size, const char *part)
{
  sph_error error = {0};
  assert_null(sph_case_read_text("bad.yml", text, size, 0, NULL, &error));
  if (!strstr(error.text, part)) fail_msg("found '%s', expected '%s'", error.text, part);
}

static void bombs_and_garbage_are_refused_at_once(void **state)
{
  enum { BRACKETS = 200000, LARGE = 2 << 20 };
  char *text = malloc(LARGE);
  (void)state;
  assert_non_null(text);
  memset(text, '[', BRACKETS);
  refused(text, BRACKETS, "bad.yml:1:34: nested deeper than 32 levels");
  memset(text, ' ', LARGE);
  refused(text, LARGE, "at most 1 MiB");
  for (int k = 0; k < 4096; k++) text[k] = (char)(k * 167 + 128);
  refused(text, 4096, "a case file is plain text in UTF-8");
  refused("title: a\0b\n", 11, "control characters are not allowed");
  refused("title: \"a\\0b\"\n", 14, "found a NUL character");
  refused("title: \xff\xfe\n", 10, "a case file is plain text in UTF-8");
  refused("a: &a [1, 1]\nb: &b [*a, *a]\n", 28, "found an anchor (&)");
  free(text);
}

static void a_file_that_is_not_there(void **state)
{
  sph_error error = {0};
  (void)state;
  assert_null(sph_case_read("no/such.yml", 0, NULL, &error));
  assert_int_equal(error.status, SPH_ERR_FILE);
  assert_string_equal(error.text, "no/such.yml: cannot open: No such file or directory");
}

/* ---- the manual */

static void the_manual_is_current(void **state)
{
  const char *root = getenv("SRCDIR");
  char path[1024];
  (void)state;
  int length = sph_case_manual(NULL, 0);
  assert_true(length > 1000);
  char *made = malloc((size_t)length + 1), *kept = malloc((size_t)length + 2);
  assert_int_equal(sph_case_manual(made, (size_t)length + 1), length);
  snprintf(path, sizeof path, "%s/docs/case-files.md", root ? root : ".");
  FILE *file = fopen(path, "r");
  if (!file) fail_msg("cannot open %s", path);
  size_t n = fread(kept, 1, (size_t)length + 1, file);
  fclose(file);
  if (n != (size_t)length || memcmp(made, kept, n))
    fail_msg("docs/case-files.md is old: sphode info case >docs/case-files.md");
  free(kept);
  free(made);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(units_have_their_size_and_dimension),
      cmocka_unit_test(what_cannot_be_is_refused),
      cmocka_unit_test(a_problem_tells_its_column),
      cmocka_unit_test(fields_are_evaluated_at_each_point),
      cmocka_unit_test(defaults_are_filled_in),
      cmocka_unit_test(set_replaces_and_adds),
      cmocka_unit_test(the_text_is_that_of_what_was_set),
      cmocka_unit_test(a_wrong_set_says_so),
      cmocka_unit_test(a_byte_order_mark_is_skipped),
      cmocka_unit_test(the_simulation_is_what_the_file_says),
      cmocka_unit_test(jitter_moves_particles_off_their_lattice),
      cmocka_unit_test(materials_are_what_the_file_says),
      cmocka_unit_test(a_preset_without_that_sound_speed),
      cmocka_unit_test(switches_of_viscosity),
      cmocka_unit_test(heat_that_cannot_be),
      cmocka_unit_test(density_at_the_start),
      cmocka_unit_test(a_wall_has_no_scales),
      cmocka_unit_test(words_of_the_library),
      cmocka_unit_test(broken_files_say_what_is_wrong),
      cmocka_unit_test(bombs_and_garbage_are_refused_at_once),
      cmocka_unit_test(a_file_that_is_not_there),
      cmocka_unit_test(the_manual_is_current),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
