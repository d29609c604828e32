/* Modifiers: what writes fields between steps gives the composition of steps and changes, exactly;
 * and the order of frames, events and modifiers at the end of a step. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "near.h"
#include "sphode.h"

enum { STEPS = 12 };
static const double dt = 0.0625; /* an exact number */

static const char *const method[] = {"leapfrog",    NULL,      "erk:zonneveld-5-3-4",
                                     "symplectic",  "dkd",     "erk:dormand-prince-7-4-5",
                                     "verlet-dual", "midpoint"};
enum { METHODS = sizeof method / sizeof *method };

static int decay(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) s->ds[i] -= s->s[i];
  return SPH_OK;
}

/* A scalar q' = -q on a few particles at rest. */
static sph_sim *decaying(const char *name)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1, .dx = 1});
  sph_group *box = sph_group_box(sim, "box", (double[]){0}, (double[]){4}, 1);
  sph_group_set_eos(box, sph_eos_tait(1, 1, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, (sph_term){.name = "decay",
                                   .body = decay,
                                   .scalar = {.name = "q", .scale = 1, .initial = 1}});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = name, .dt_fixed = dt});
  return sim;
}

static double q_of(const sph_sim *sim)
{
  return sph_group_read(sph_sim_group(sim, "box"), "q", 0)[0];
}

typedef struct script {
  double factor;
  int told, runs; /* what it returns; calls so far */
  double time[64];
} script;

static int multiply(void *ctx, sph_sim *sim)
{
  script *s = ctx;
  sph_group *box = sph_sim_group(sim, "box");
  double *q = sph_group_write(box, "q", 0);
  for (long i = 0; i < sph_group_count(box); i++) q[i] *= s->factor;
  s->time[s->runs++] = sph_sim_time(sim);
  return s->told;
}

/* q' = -q, and q *= 1.5 after each step: bit for bit what the same steps and changes by hand give,
 * and R(-dt)^n 1.5^n, R the scheme's own factor, where it has one step. */
static void composition(void **state)
{
  (void)state;
  for (int k = 0; k < METHODS; k++) {
    script s = {.factor = 1.5, .told = 1}, by_hand = s;
    sph_sim *sim = decaying(method[k]), *hand = decaying(method[k]);
    sph_sim_add_modifier(sim,
                         (sph_modifier){.name = "grow", .steps = 1, .modify = multiply, .ctx = &s});
    assert_int_equal(sph_sim_run(sim, STEPS * dt), SPH_OK);
    double R = 0;
    for (int n = 0; n < STEPS; n++) {
      assert_int_equal(sph_sim_step(hand), SPH_OK);
      if (n == 0) R = q_of(hand);
      multiply(&by_hand, hand);
      sph_sim_changed(hand);
    }
    assert_int_equal(s.runs, STEPS);
    assert_true(q_of(sim) == q_of(hand));
    assert_near(q_of(sim) / pow(1.5 * R, STEPS), 1, 1e-13);
    assert_near(R, exp(-dt), 2 * dt * dt);
    sph_sim_free(sim);
    sph_sim_free(hand);
  }
}

/* One that did not change anything costs nothing and changes nothing; with one that did there is
 * one evaluation more a step, not one for each. */
static void one_start_for_all(void **state)
{
  (void)state;
  long calls[4];
  double q[4];
  for (int k = 0; k < 4; k++) {
    script s[2] = {{.factor = 1, .told = k >= 2}, {.factor = 1, .told = k == 3}};
    sph_sim *sim = decaying(NULL);
    for (int m = 0; k > 0 && m < 2; m++)
      sph_sim_add_modifier(
          sim, (sph_modifier){.name = m ? "b" : "a", .steps = 1, .modify = multiply, .ctx = &s[m]});
    assert_int_equal(sph_sim_run(sim, STEPS * dt), SPH_OK);
    sph_sim_stats stats;
    sph_sim_get_stats(sim, &stats);
    calls[k] = stats.step.rhs_evaluations;
    q[k] = q_of(sim);
    sph_sim_free(sim);
  }
  assert_int_equal(calls[1], calls[0]);
  assert_true(q[1] == q[0]);
  assert_true(calls[2] > calls[0] && calls[2] <= calls[0] + 2 * STEPS);
  assert_int_equal(calls[3], calls[2]);
}

/* Every 3 steps; or at the first end of a step at or behind the multiples of 0.15 s. */
static void when_they_are_due(void **state)
{
  (void)state;
  script steps = {.factor = 1, .told = 1}, times = steps;
  sph_sim *sim = decaying(NULL);
  sph_sim_add_modifier(sim,
                       (sph_modifier){.name = "a", .steps = 3, .modify = multiply, .ctx = &steps});
  sph_sim_add_modifier(
      sim, (sph_modifier){.name = "b", .interval = 0.15, .modify = multiply, .ctx = &times});
  assert_int_equal(sph_sim_run(sim, STEPS * dt), SPH_OK);
  assert_int_equal(steps.runs, STEPS / 3);
  for (int k = 0; k < steps.runs; k++) assert_true(steps.time[k] == 3 * (k + 1) * dt);
  assert_int_equal(times.runs, 5);
  for (int k = 0; k < times.runs; k++) assert_true(times.time[k] == ceil((k + 1) * 0.15 / dt) * dt);
  sph_sim_free(sim);
}

/* ---- among frames and events ---- */

typedef struct diary {
  int n;
  double t[99], q[99];
} diary;

static int look(void *ctx, sph_sim *sim, sph_error *error)
{
  diary *d = ctx;
  (void)error;
  d->t[d->n] = sph_sim_time(sim);
  d->q[d->n++] = q_of(sim);
  return d->n < 99 ? SPH_OK : SPH_ERR_STATE;
}

/* Frames at the end of a step are of the state before, inside the next of the one after. */
static void frames_come_first(void **state)
{
  (void)state;
  diary d = {0};
  script s = {.factor = 100, .told = 1};
  sph_sim *sim = decaying(NULL);
  sph_sim_add_output(sim, (sph_output){.interval = dt / 2, .frame = look, .ctx = &d});
  sph_sim_add_modifier(sim, (sph_modifier){.name = "a", .steps = 1, .modify = multiply, .ctx = &s});
  assert_int_equal(sph_sim_run(sim, 2 * dt), SPH_OK);
  assert_int_equal(d.n, 5);
  for (int k = 0; k < d.n; k++) {
    double expected = exp(-d.t[k]) * (k <= 2 ? 1 : 100);
    assert_near(d.q[k] / expected, 1, 1e-4);
  }
  assert_near(q_of(sim) / (1e4 * exp(-2 * dt)), 1, 1e-4);
  sph_sim_free(sim);
}

static double level(void *ctx, sph_sim *sim) { return q_of(sim) - *(const double *)ctx; }

/* A modifier that carries q over the threshold: found where it happened, once; also by an event
 * that stops there: the step that is cut to nothing is one, so that the next fifth ends at 9 dt. */
static void events_see_what_modifiers_do(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    double threshold = 2;
    script s = {.factor = 4, .told = 1};
    sph_event_info info;
    sph_sim *sim = decaying(NULL);
    sph_sim_add_event(sim, &(sph_event){.name = "up",
                                        .value = level,
                                        .ctx = &threshold,
                                        .direction = "rising",
                                        .stop = k});
    sph_sim_add_modifier(sim,
                         (sph_modifier){.name = "a", .steps = 5, .modify = multiply, .ctx = &s});
    assert_int_equal(sph_sim_run(sim, 9 * dt), SPH_OK);
    assert_int_equal(sph_sim_event_get(sim, 0, &info), 1);
    assert_int_equal(info.count, 1);
    assert_true(info.first == 5 * dt);
    assert_true(sph_sim_time(sim) == (k ? 5 : 9) * dt);
    assert_int_equal(sph_sim_run(sim, 9 * dt), SPH_OK);
    assert_near(q_of(sim) / ((k ? 16 : 4) * exp(-9 * dt)), 1, 1e-4);
    sph_sim_free(sim);
  }
}

/* A step that an event cuts short counts as one, and modifiers come at its end, behind the change,
 * also where the run stops there. */
static int halve(void *ctx, sph_sim *sim)
{
  script s = {.factor = 0.5};
  (void)ctx;
  multiply(&s, sim);
  return SPH_OK;
}

static void cut_steps_count(void **state)
{
  (void)state;
  for (int stop = 0; stop < 2; stop++) {
    script s = {.factor = 1, .told = 1};
    sph_sim *sim = decaying(NULL);
    sph_sim_add_event(sim, &(sph_event){.name = "cut",
                                        .type = "time",
                                        .threshold = 1.5 * dt,
                                        .stop = stop,
                                        .change = stop ? NULL : halve});
    sph_sim_add_modifier(sim,
                         (sph_modifier){.name = "a", .steps = 2, .modify = multiply, .ctx = &s});
    assert_int_equal(sph_sim_run(sim, 4.5 * dt), SPH_OK);
    assert_true(sph_sim_time(sim) == (stop ? 1.5 : 4.5) * dt);
    assert_int_equal(sph_sim_run(sim, 4.5 * dt), SPH_OK);
    assert_int_equal(s.runs, 2);
    assert_true(s.time[0] == 1.5 * dt && s.time[1] == 3.5 * dt);
    assert_near(q_of(sim) / ((stop ? 1 : 0.5) * exp(-4.5 * dt)), 1, 1e-4);
    sph_sim_free(sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(composition),
      cmocka_unit_test(one_start_for_all),
      cmocka_unit_test(when_they_are_due),
      cmocka_unit_test(frames_come_first),
      cmocka_unit_test(events_see_what_modifiers_do),
      cmocka_unit_test(cut_steps_count),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
