/* Bad values at the doors of events, modifiers, scales and changes of terms: the status and the
 * text tell what is wrong; what was attached is let go of once; later calls change nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

static int let_go;
static void count(void *ctx) { (*(int *)ctx)++; }

static double zero(void *ctx, sph_sim *sim)
{
  (void)ctx, (void)sim;
  return 0;
}

static int nothing(void *ctx, sph_sim *sim)
{
  (void)ctx, (void)sim;
  return 0;
}

static sph_sim *make(void)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 0.5}, 1000);
  sph_group *floor = sph_group_create(sim, "floor", "wall");
  sph_group_add_layers(floor, (double[]){0, 0}, (double[]){1, 0.8}, "y+", 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 20, 7));
  sph_group_set_boundary(floor, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0, 0));
  assert_string_equal(sph_sim_error(sim), "");
  return sim;
}

/* The first error is this one, and it sticks. */
static void refused(sph_sim *sim, int status, const char *text)
{
  if (sph_sim_status(sim) != status || !strstr(sph_sim_error(sim), text))
    fail_msg("%d \"%s\", not %d \"%s\"", sph_sim_status(sim), sph_sim_error(sim), status, text);
  char first[1000];
  snprintf(first, sizeof first, "%s", sph_sim_error(sim));
  sph_sim_add_event(sim, NULL);
  sph_sim_add_modifier(sim, (sph_modifier){.name = "other"});
  sph_sim_change_term(sim, sph_term_pressure());
  sph_sim_set_scale(sim, NULL, "nonsense", 1);
  assert_int_equal(sph_sim_run(sim, 1), status);
  assert_int_equal(sph_sim_step(sim), status);
  assert_string_equal(sph_sim_error(sim), first);
  sph_sim_free(sim);
}

static void bad_event(sph_event event, const char *text)
{
  sph_sim *sim = make();
  event.ctx = &let_go, event.free = count, let_go = 0;
  sph_sim_add_event(sim, &event);
  assert_int_equal(let_go, 1);
  refused(sim, SPH_ERR_ARGUMENT, text);
}

static void events(void **state)
{
  (void)state;
  static const char *const names[] = {NULL, "", "a b", "a,b", "a\"b", "\xc3\xa9"};
  const sph_event good = {.name = "e", .value = zero};
  sph_event e;
  for (int k = 0; k < 6; k++) {
    e = good, e.name = names[k];
    bad_event(e, "event name");
  }
  char long_name[100] = "";
  for (int k = 0; k < 64; k++) long_name[k] = 'a';
  e = good, e.name = long_name, bad_event(e, "event name");
  bad_event((sph_event){.name = "e"}, "event e: type \"\"; front, wet, dry, energy, steady, time");
  bad_event((sph_event){.name = "e", .type = "back"}, "\"back\"");
  e = good, e.type = "front", bad_event(e, "and a function of its own");
  e = good, e.direction = "up", bad_event(e, "direction \"up\"; rising, falling, both");
  e = good, e.samples = -1, bad_event(e, "samples = -1");
  e = good, e.samples = 65, bad_event(e, "samples = 65; right is 0 to 64");
  e = good, e.threshold = NAN, bad_event(e, "threshold = nan");
  e = good, e.threshold = INFINITY, bad_event(e, "threshold = inf");
  bad_event((sph_event){.name = "e", .type = "front", .axis = 2},
            "event e: axis 2; 0 to 1 are right");
  bad_event((sph_event){.name = "e", .type = "front", .axis = -1}, "event e: axis -1");
  bad_event((sph_event){.name = "e", .type = "front", .group = "oil"}, "no fluid group \"oil\"");
  bad_event((sph_event){.name = "e", .type = "front", .group = "floor"}, "\"floor\"");
  bad_event((sph_event){.name = "e", .type = "wet", .x = {0, NAN}}, "x[1] = nan");
  bad_event((sph_event){.name = "e", .type = "dry", .x = {-INFINITY}}, "x[0] = -inf");
  bad_event((sph_event){.name = "e", .type = "energy", .quantity = "heat"}, "quantity \"heat\"");
  bad_event((sph_event){.name = "e", .type = "steady"}, "rates 0 1/s; right is > 0");
  bad_event((sph_event){.name = "e", .type = "steady", .threshold = -1}, "rates -1 1/s");

  sph_sim *sim = make();
  sph_sim_add_event(sim, NULL);
  refused(sim, SPH_ERR_ARGUMENT, "NULL");
  sim = make();
  sph_sim_add_event(sim, &good);
  sph_sim_add_event(sim, &good);
  refused(sim, SPH_ERR_ARGUMENT, "event e exists already");
  sim = make();
  let_go = 0;
  for (int k = 0; k <= SPH_EVENTS_MAX; k++) {
    char name[20];
    snprintf(name, sizeof name, "e%d", k);
    sph_sim_add_event(sim,
                      &(sph_event){.name = name, .value = zero, .ctx = &let_go, .free = count});
  }
  refused(sim, SPH_ERR_ARGUMENT, "more than 32 events");
  assert_int_equal(let_go, SPH_EVENTS_MAX + 1);
}

static void null_flows_through(void **state)
{
  (void)state;
  sph_event_info info;
  let_go = 0;
  sph_sim_add_event(NULL, NULL);
  sph_sim_add_event(NULL, &(sph_event){.name = "e", .value = zero, .ctx = &let_go, .free = count});
  sph_sim_add_modifier(NULL, (sph_modifier){.ctx = &let_go, .free = count});
  assert_int_equal(let_go, 2);
  sph_sim_change_term(NULL, sph_term_pressure());
  sph_sim_set_scale(NULL, NULL, NULL, 0);
  assert_int_equal(sph_sim_event_get(NULL, 0, &info), 0);
  assert_null(sph_sim_stopped_by(NULL));
  assert_null(sph_event_type(-1));
  assert_null(sph_event_type(6));
  assert_null(sph_event_unit(NULL));
  assert_null(sph_event_unit("back"));
  assert_string_equal(sph_event_unit(sph_event_type(0)), "m");
  sph_sim *sim = make();
  assert_int_equal(sph_sim_event_get(sim, 0, &info), 0);
  assert_int_equal(sph_sim_event_get(sim, -1, &info), 0);
  assert_null(sph_sim_stopped_by(sim));
  sph_sim_free(sim);
}

static void bad_modifier(sph_modifier modifier, const char *text)
{
  sph_sim *sim = make();
  modifier.ctx = &let_go, modifier.free = count, let_go = 0;
  sph_sim_add_modifier(sim, modifier);
  assert_int_equal(let_go, 1);
  refused(sim, SPH_ERR_ARGUMENT, text);
}

static void modifiers(void **state)
{
  (void)state;
  bad_modifier((sph_modifier){.steps = 1, .modify = nothing}, "modifier name \"\"");
  bad_modifier((sph_modifier){.name = "m", .steps = 1}, "modifier m: no function");
  bad_modifier((sph_modifier){.name = "m", .modify = nothing}, "steps = 0, interval = 0 s");
  bad_modifier((sph_modifier){.name = "m", .modify = nothing, .steps = -1}, "steps = -1");
  bad_modifier((sph_modifier){.name = "m", .modify = nothing, .interval = -1}, "interval = -1");
  bad_modifier((sph_modifier){.name = "m", .modify = nothing, .interval = NAN}, "interval = nan");
  bad_modifier((sph_modifier){.name = "m", .modify = nothing, .interval = INFINITY}, "= inf");
  bad_modifier((sph_modifier){.name = "m", .modify = nothing, .steps = 1, .interval = 1}, "one of");
  sph_sim *sim = make();
  let_go = 0;
  for (int k = 0; k <= SPH_MODIFIERS_MAX; k++)
    sph_sim_add_modifier(
        sim,
        (sph_modifier){.name = "m", .steps = 1, .modify = nothing, .ctx = &let_go, .free = count});
  refused(sim, SPH_ERR_ARGUMENT, "more than 16 modifiers");
  assert_int_equal(let_go, SPH_MODIFIERS_MAX + 1);
}

/* Before the run (0) or between steps (1). */
static void bad_change(sph_term term, int later, const char *text)
{
  sph_sim *sim = make();
  if (later) assert_int_equal(sph_sim_step(sim), SPH_OK);
  sph_sim_change_term(sim, term);
  refused(sim, SPH_ERR_ARGUMENT, text);
}

static void changes_of_terms(void **state)
{
  (void)state;
  for (int later = 0; later < 2; later++) {
    bad_change((sph_term){0}, later, "term \"\" cannot change; gravity, harmonic");
    bad_change(sph_term_pressure(), later, "term \"pressure\" cannot change");
    bad_change(sph_term_xsph(0.5), later, "term xsph: the simulation has none");
    bad_change(sph_term_harmonic(1), later, "term harmonic: the simulation has none");
    bad_change(sph_term_delta("antuono", -1), later, "delta = -1");
    bad_change(sph_term_delta("molteni", 0.1), later, "form \"molteni\" is another one");
    bad_change(sph_term_delta("mine", 0.1), later, "model \"mine\"");
    bad_change(sph_term_gravity((double[3]){0, NAN, 0}), later, "g[1] = nan");
  }
  bad_change(sph_term_viscosity_artificial(0.1, 0), 1, "its strength was 0 at the start");
  sph_sim *sim = make();
  sph_sim_change_term(sim, sph_term_delta("antuono", 0));
  sph_sim_change_term(sim, sph_term_viscosity_artificial(0.1, 0));
  sph_sim_change_term(sim, sph_term_gravity((double[3]){0, -1, 0}));
  assert_int_equal(sph_sim_step(sim), SPH_OK);
  sph_sim_change_term(sim, sph_term_viscosity_artificial(0, 0));
  assert_int_equal(sph_sim_step(sim), SPH_OK);
  sph_sim_free(sim);
}

/* A frame or an event shows a state that is not the one that is integrated. */
static int changes_there(void *ctx, sph_sim *sim, sph_error *error)
{
  (void)ctx, (void)error;
  if (sph_sim_time(sim) > 0) sph_sim_change_term(sim, sph_term_gravity((double[3]){0, 0, 0}));
  return sph_sim_status(sim);
}

static void changes_inside_frames(void **state)
{
  (void)state;
  sph_sim *sim = make();
  sph_sim_add_output(sim, (sph_output){.interval = 1e-3, .frame = changes_there});
  assert_int_equal(sph_sim_run(sim, 0.1), SPH_ERR_STATE);
  refused(sim, SPH_ERR_STATE, "terms change between steps");
}

/* A step inside of a step: from every callback, told and not followed. */
static int steps(sph_sim *sim) { return sph_sim_time(sim) > 0.01 ? sph_sim_step(sim) : SPH_OK; }
static double steps_value(void *ctx, sph_sim *sim)
{
  (void)ctx, steps(sim);
  return sph_sim_time(sim) - 0.02;
}
static int steps_change(void *ctx, sph_sim *sim)
{
  (void)ctx;
  return sph_sim_run(sim, 1);
}
static int steps_frame(void *ctx, sph_sim *sim, sph_error *error)
{
  (void)ctx, (void)error;
  return steps(sim);
}
static int steps_progress(void *ctx, sph_sim *sim)
{
  (void)ctx;
  return steps(sim);
}

static void steps_inside_of_steps(void **state)
{
  (void)state;
  for (int k = 0; k < 5; k++) {
    sph_sim *sim = make();
    sph_event value = {.name = "e", .value = steps_value};
    sph_event time = {.name = "e", .type = "time", .threshold = 0.02, .change = steps_change};
    if (k < 2) sph_sim_add_event(sim, k ? &time : &value);
    if (k == 2) sph_sim_add_output(sim, (sph_output){.interval = 0.02, .frame = steps_frame});
    if (k == 3)
      sph_sim_add_modifier(sim, (sph_modifier){.name = "m", .steps = 1, .modify = steps_progress});
    if (k == 4) sph_sim_set_progress(sim, steps_progress, NULL);
    assert_true(sph_sim_run(sim, 0.1) < 0);
    refused(sim, SPH_ERR_STATE, "a run or step inside of another");
  }
}

static void scales(void **state)
{
  (void)state;
  static const double bad[] = {NAN, INFINITY, -INFINITY, -1, 0};
  for (int k = 0; k < 5; k++) {
    sph_sim *sim = make();
    sph_sim_set_scale(sim, NULL, "velocity", bad[k]);
    refused(sim, SPH_ERR_ARGUMENT, "scale of velocity");
  }
  static const char *const fields[] = {NULL, "", "speed"};
  for (int k = 0; k < 3; k++) {
    sph_sim *sim = make();
    sph_sim_set_scale(sim, NULL, fields[k], 1);
    refused(sim, SPH_ERR_ARGUMENT, "no such field");
  }
  static const char *const others[] = {"pressure", "energy", "mass"};
  for (int k = 0; k < 6; k++) {
    sph_sim *sim = make();
    sph_sim_set_scale(sim, k < 3 ? NULL : sph_sim_group(sim, "water"), others[k % 3], 1);
    assert_int_equal(sph_sim_status(sim), SPH_OK);
    assert_int_equal(sph_sim_step(sim), SPH_ERR_ARGUMENT);
    refused(sim, SPH_ERR_ARGUMENT, k < 3 ? "no fluid integrates it" : "nothing in group water");
  }
  sph_sim *sim = make(), *other = make();
  sph_sim_set_scale(sim, sph_sim_group(other, "water"), "velocity", 1);
  refused(sim, SPH_ERR_ARGUMENT, "of another simulation");
  assert_int_equal(sph_sim_step(other), SPH_OK);
  sph_sim_set_scale(other, NULL, "velocity", 1);
  refused(other, SPH_ERR_STATE, "before the run");
}

static void no_directory(void **state)
{
  (void)state;
  sph_sim *sim = make();
  sph_sim_add_output(sim, sph_output_events(NULL));
  int status = sph_sim_run(sim, 0.01);
  assert_true(status < 0);
  refused(sim, status, "directory");
  sim = make();
  sph_sim_add_output(sim, sph_output_events("/dev/null/here"));
  assert_int_equal(sph_sim_run(sim, 0.01), SPH_ERR_FILE);
  refused(sim, SPH_ERR_FILE, "/dev/null");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(events),
      cmocka_unit_test(null_flows_through),
      cmocka_unit_test(modifiers),
      cmocka_unit_test(changes_of_terms),
      cmocka_unit_test(changes_inside_frames),
      cmocka_unit_test(steps_inside_of_steps),
      cmocka_unit_test(scales),
      cmocka_unit_test(no_directory),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
