/* Every allocation of a small simulation fails once, from sph_sim_create to the end of the run:
 * SPH_ERR_MEMORY every time, no crash, no leak (under ASan or valgrind), and what was attached is
 * let go of exactly once. */
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

#include "failing.h"
#include "sphode.h"

/* ---- things of the user, with counters of how often they were let go of ---- */

enum { TERM, EOS, BOUNDARY, OUTPUT, EVENT, MODIFIER, FIELD, OWNED };
static int let_go[OWNED];
static void count(void *ctx) { (*(int *)ctx)++; }

static int push(const sph_term *term, const sph_particles *particles)
{
  (void)term;
  for (long i = 0; i < particles->n; i++) particles->a[0][i] += 0.1;
  return SPH_OK;
}

static void slide(void *ctx, double t, double displacement[3], double velocity[3],
                  double acceleration[3])
{
  (void)ctx, (void)displacement, (void)acceleration;
  velocity[0] = 0.1 * t;
}

static int frame(void *ctx, sph_sim *sim, sph_error *error)
{
  (void)ctx, (void)sim, (void)error;
  return SPH_OK;
}

/* Decay of a scalar, and its diffusion. */
static int decay(const sph_term *term, const sph_particles *particles)
{
  (void)term;
  for (long i = 0; i < particles->n; i++) particles->ds[i] -= particles->s[i];
  return SPH_OK;
}

static void diffuse(const sph_term *term, const sph_tile *tile)
{
  (void)term;
  for (long k = 0; k < tile->n; k++)
    tile->ds[k] += 1e-3 * (tile->s_i[k] - tile->s_j[k]) * tile->V[k] * tile->F[k] *
                   (tile->i[0][k] + tile->j[0][k]) / tile->i[0][k];
}

static double power(void *ctx, const double x[3], double t)
{
  (void)ctx;
  return 1 + 0.1 * x[0] + t;
}

static double own_phi_calls;
static void own_phi(const sph_term *term, const sph_particles *particles, double *phi)
{
  (void)term;
  own_phi_calls++;
  for (long i = 0; i < particles->n; i++) phi[i] = 1 + 0.01 * particles->x[0][i];
}

enum row { C2, SUMMED, PHI };
typedef struct variant {
  const char *method, *neighbors;
  int periodic, thermal;
  enum row row;
  const char *energy;   /* NULL: default; with conduction, laminar viscosity, a heat source */
  int scalar;           /* a term with one, and with a pair function */
  int dust;             /* with drag */
  const char *walls;    /* their model; NULL: adami */
  const char *switches; /* of artificial viscosity; without heat */
} variant;

static void add_row(sph_sim *sim, const variant *v)
{
  static const char *const form[] = {"c2", "s", "phi"};
  sph_term continuity = sph_term_continuity_phi(0.5);
  continuity.phi = own_phi, continuity.ctx = &let_go[FIELD], continuity.free = count;
  sph_sim_add_term(sim, v->row == C2       ? sph_term_corrected(sph_term_continuity(),
                                                          v->thermal ? "one-sided" : NULL)
                        : v->row == SUMMED ? sph_term_summation(1)
                                           : continuity);
  const int corrected = v->row == C2 && v->thermal;
  sph_sim_add_term(sim, sph_term_corrected(sph_term_pressure_form(form[v->row]),
                                           corrected ? "mean" : NULL));
}

static void add_heat(sph_sim *sim, sph_group *water, const variant *v)
{
  sph_group_set_viscosity(water, 1), sph_group_set_conductivity(water, 1);
  sph_group_set_energy(water, v->energy);
  sph_sim_add_term(sim, sph_term_viscosity_laminar(v->thermal ? "mcg" : "morris"));
  sph_sim_add_term(sim, sph_term_viscosity_signal(0.5, 3));
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_add_term(sim, sph_term_heat_source(power, NULL));
  sph_sim_add_term(sim, sph_term_xsph(0.2));
  sph_sim_add_term(sim, sph_term_stress_artificial(0.2, 0.01));
  sph_term shifting = sph_term_shifting(NULL, 1);
  shifting.advection = 0, shifting.steps = v->periodic; /* a rate; where periodic between steps */
  sph_sim_add_term(sim, shifting);
}

static void add_scalar(sph_sim *sim)
{
  sph_sim_add_term(sim, (sph_term){"dye", .body = decay, .pair = diffuse, .reads = "density",
                                   .scalar = {.name = "c", .scale = 1, .initial = 1}});
  sph_term salt = sph_term_scalar_diffusion((sph_scalar){.name = "salt", .scale = 1}, 1e-3);
  salt.by_group = &(sph_group_value){"floor", 1};
  salt.by_groups = 1;
  sph_sim_add_term(sim, salt);
}

/* All that can be implicit, or the fluid's waves fast. */
static void deal(sph_sim *sim, const variant *v)
{
  static const char *const implicit[] = {"viscosity-artificial", "viscosity-laminar", "conduction",
                                         "delta"};
  const int implicits = v->thermal ? 3 : 4;
  for (int k = 0; !strncmp(v->method, "imex:", 5) && k < implicits; k++)
    sph_sim_set_part(sim, implicit[k], "implicit");
  if (!strncmp(v->method, "imex:", 5) && v->dust) sph_sim_set_part(sim, "drag", "implicit");
  if (!strncmp(v->method, "mri:", 4)) sph_sim_set_part(sim, "pressure", "fast");
}

static double moment(void *ctx, sph_sim *sim)
{
  (void)ctx;
  return sph_sim_time(sim) - 0.003;
}

static int happens(void *ctx, sph_sim *sim)
{
  (void)ctx;
  sph_sim_change_term(sim, sph_term_gravity((double[3]){0, -9, 0}));
  return SPH_OK;
}

static int wrote(void *ctx, sph_sim *sim)
{
  (void)ctx, (void)sim;
  return 1;
}

/* Events that look at all there is, one that happens, and what comes between steps. */
static void add_moments(sph_sim *sim, const variant *v)
{
  if (v->row != SUMMED) sph_sim_reset_density(sim, v->thermal ? "shepard" : "mls", 2);
  sph_sim_add_event(sim, &(sph_event){.name = "own",
                                      .value = moment,
                                      .change = happens,
                                      .snapshot = 1,
                                      .ctx = &let_go[EVENT],
                                      .free = count});
  sph_sim_add_event(sim, &(sph_event){.name = "front", .type = "front", .threshold = 3});
  sph_sim_add_event(sim, &(sph_event){.name = "wet", .type = "wet", .x = {0.5, 2}});
  sph_sim_add_event(sim, &(sph_event){.name = "energy", .type = "energy", .threshold = 1e9});
  sph_sim_add_event(sim, &(sph_event){.name = "steady", .type = "steady", .threshold = 1e-9});
  sph_sim_add_modifier(sim, (sph_modifier){.name = "m",
                                           .interval = 0.004,
                                           .modify = wrote,
                                           .ctx = &let_go[MODIFIER],
                                           .free = count});
}

static void add_dust(sph_sim *sim)
{
  sph_group *dust = sph_group_box(sim, "dust", (double[]){0, 0}, (double[]){1, 0.5}, 10);
  sph_group_set_eos(dust, sph_eos_dust());
  sph_sim_add_term(sim, sph_term_drag_time(0.1));
}

static void at_rest(void *ctx, const double x[3], double t, double v[3])
{
  (void)ctx, (void)x, (void)t;
  v[0] = v[1] = 0;
}

static double constant(void *ctx, const double x[3], double t)
{
  (void)ctx, (void)x, (void)t;
  return 1000;
}

static int attach_and_run(sph_sim *sim, const variant *v)
{
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 0.5}, 1000);
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  const double lo[] = {0, 0}, hi[] = {1, 0.8};
  const char *open = v->periodic ? "x- x+ y+" : "y+", *model = v->walls ? v->walls : "adami";
  sph_eos eos = v->thermal ? sph_eos_ideal_gas(1.4) : sph_eos_tait(1000, 20, 7);
  eos.ctx = &let_go[EOS], eos.free = count, eos.c_v = 700;
  sph_group_set_eos(water, eos);
  sph_boundary boundary = sph_boundary_adami_no_slip();
  boundary.name = model;
  if (!strcmp(model, "mirror"))
    sph_boundary_mirror_box(&boundary, lo, hi, open, 2);
  else
    sph_group_add_layers(floor, lo, hi, open, 1000);
  boundary.temperature = v->energy ? 0.2 : 0;
  boundary.motion = slide, boundary.ctx = &let_go[BOUNDARY], boundary.free = count;
  sph_group_set_boundary(floor, boundary);
  add_row(sim, v);
  if (v->energy) add_heat(sim, water, v);
  if (v->scalar) add_scalar(sim);
  if (v->dust) add_dust(sim);
  sph_term viscosity = sph_term_viscosity_artificial(0.1, 0);
  if (v->switches) viscosity = sph_term_switched(viscosity, v->switches, 0);
  sph_sim_add_term(sim, viscosity);
  if (!v->thermal && v->row != SUMMED)
    sph_sim_add_term(sim, sph_term_delta(v->row == PHI ? "fourtakas" : "antuono", 0.1));
  if (v->thermal) sph_sim_add_term(sim, sph_term_conductivity_artificial(1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -9.81, 0}));
  sph_sim_add_term(sim, (sph_term){"push", .body = push, .ctx = &let_go[TERM], .free = count});
  if (!v->thermal)
    sph_manufactured_attach(water, &(sph_manufactured){.velocity = at_rest,
                                                       .density = constant,
                                                       .length = 1,
                                                       .time = 1});
  deal(sim, v);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = v->method});
  sph_sim_add_output(sim, (sph_output){"nothing", 0.002, .frame = frame, .ctx = &let_go[OUTPUT],
                                       .free = count});
  add_moments(sim, v);
  long n = sph_group_count(water);
  double *u = v->thermal || v->energy ? sph_group_write(water, "energy", 0) : NULL;
  for (long i = 0; u && i < n; i++) u[i] = 100;
  if (!v->thermal) sph_group_set_hydrostatic(water, 1, 0.5, 9.81);
  int status = sph_sim_run(sim, 0.01);
  if (status == SPH_OK) status = sph_sim_step(sim);
  if (status == SPH_OK) status = sph_sim_evaluate(sim);
  if (status == SPH_OK && !sph_group_ids(water)) status = sph_sim_status(sim);
  return status;
}

static int simulate(const variant *v, char *text, size_t size)
{
  memset(let_go, 0, sizeof let_go);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = 0.1,
                                               .threads = 2,
                                               .search = v->neighbors,
                                               .periodic = {v->periodic},
                                               .length = {v->periodic}});
  int status = attach_and_run(sim, v);
  snprintf(text, size, "%s", sph_sim_error(sim));
  sph_sim_free(sim);
  return status;
}

static void each_allocation_fails(const variant *v)
{
  char text[1000];
  fail_at = 0, calls = 0;
  if (simulate(v, text, sizeof text) != SPH_OK) fail_msg("%s", text);
  long all = calls;
  for (fail_at = 1; fail_at <= all; fail_at++) {
    calls = 0;
    int status = simulate(v, text, sizeof text);
    if (status != SPH_ERR_MEMORY)
      fail_msg("allocation %ld of %ld fails: status %d, \"%s\"", fail_at, all, status, text);
    if (!strstr(text, "memory")) fail_msg("allocation %ld: \"%s\"", fail_at, text);
    for (int k = 0; k < OWNED; k++)
      if (let_go[k] != (k != FIELD || v->row == PHI))
        fail_msg("allocation %ld of %ld fails (%s): thing %d let go of %d times", fail_at, all,
                 text, k, let_go[k]);
  }
  print_message("# %s: %ld allocations\n", v->method, all);
  assert_true(all > 50);
}

static const variant variants[] = {
    {"erk:bogacki-shampine-4-2-3", NULL, 0, 0, C2, NULL, 0, 0, NULL, "morris-monaghan"},
    {"leapfrog", "brute-force", 1, 0, C2, NULL, 0, 1, NULL, NULL},
    {"verlet", "hash", 1, 1, C2, NULL, 0, 0, NULL, "balsara cullen-dehnen"},
    {"leapfrog", "tree", 0, 0, SUMMED, "temperature", 1, 1, NULL, NULL},
    {"erk:bogacki-shampine-4-2-3", NULL, 1, 1, SUMMED, "entropy", 0, 0, NULL, NULL},
    {"erk:bogacki-shampine-4-2-3", NULL, 0, 0, PHI, "u", 1, 0, NULL, NULL},
    {"leapfrog", NULL, 0, 1, PHI, "total", 1, 1, NULL, NULL},
    {"imex:ark324l2sa-4-2-3", NULL, 1, 1, C2, "total", 0, 0, NULL, NULL},
    {"imex:ark324l2sa-4-2-3", NULL, 0, 0, C2, "temperature", 1, 1, NULL, NULL},
    {"mri:kw3", NULL, 1, 0, C2, NULL, 0, 0, NULL, NULL},
    {"erk:bogacki-shampine-4-2-3", NULL, 1, 0, C2, NULL, 0, 0, "dbc", NULL},
    {"leapfrog", NULL, 1, 1, PHI, "total", 1, 0, "mirror", NULL},
};
enum { VARIANTS = sizeof variants / sizeof *variants };

static void all(void **state)
{
  (void)state;
  for (int k = 0; k < VARIANTS; k++) each_allocation_fails(&variants[k]);
  assert_true(own_phi_calls > 0);
}

/* Once a simulation runs, the right-hand side takes no memory.  (Steps may, where lists grow.) */
static void none_in_the_right_hand_side(void **state)
{
  (void)state;
  for (int k = 0; k < VARIANTS; k++) {
    const variant *v = &variants[k];
    fail_at = 0;
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                                 .dx = 0.1,
                                                 .threads = 2,
                                                 .search = v->neighbors,
                                                 .periodic = {v->periodic},
                                                 .length = {v->periodic}});
    if (attach_and_run(sim, v) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
    long before = calls;
    for (int q = 0; q < 10; q++) assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    if (calls != before) fail_msg("variant %d: %ld allocations", k, calls - before);
    sph_sim_free(sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(all),
                                     cmocka_unit_test(none_in_the_right_hand_side)};
  return cmocka_run_group_tests_name("out of memory", tests, NULL, NULL);
}
