/* Events and modifiers: when, how often, in which order, and what becomes of the state.
 *
 * A block in free fall feels no force but gravity: its state is a parabola in time, which schemes
 * of order two and cubic dense output have exactly, so that moments are known to rounding. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "integrator.h"
#include "near.h"
#include "sim_run.h"
#include "sphode.h"

static const double g = 9.81, dx = 0.1, bottom = 1; /* [m/s^2], [m] */

static const char *const method[] = {"leapfrog",
                                     NULL,
                                     "erk:zonneveld-5-3-4",
                                     "symplectic",
                                     "dkd",
                                     "erk:dormand-prince-7-4-5",
                                     "verlet-dual",
                                     "erk:rdpk3sp35-5-2-3"};
enum { METHODS = sizeof method / sizeof *method };

/* A block with its lower edge at y = 1, falling from rest in steps of dt, 0: as limits say. */
static sph_sim *falling(const char *name, double dt)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx});
  sph_group *block = sph_group_box(sim, "block", (double[]){0, 1}, (double[]){0.4, 1.4}, 1000);
  sph_group_set_eos(block, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -g, 0}));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = name, .dt_fixed = dt});
  return sim;
}

static double edge(sph_sim *sim) /* its lower one */
{
  return sph_group_read(sph_sim_group(sim, "block"), "position", 1)[0] - dx / 2;
}

static double height(void *ctx, sph_sim *sim) { return edge(sim) - *(const double *)ctx; }

/* ---- what happened, in the order of being told ---- */

typedef struct diary {
  int entries;
  struct {
    char name[16]; /* "" of frames */
    double t, value, edge;
    long step;
  } entry[200];
} diary;

static int note(diary *d, sph_sim *sim, const char *name, double value, long step)
{
  if (d->entries >= 200) return SPH_ERR_STATE;
  snprintf(d->entry[d->entries].name, sizeof d->entry->name, "%s", name);
  d->entry[d->entries].t = sph_sim_time(sim);
  d->entry[d->entries].value = value;
  d->entry[d->entries].step = step;
  d->entry[d->entries++].edge = edge(sim);
  return SPH_OK;
}

static int note_frame(void *ctx, sph_sim *sim, sph_error *error)
{
  (void)error;
  return note(ctx, sim, "", 0, 0);
}

static int note_event(void *ctx, sph_sim *sim, const sph_event_record *r, sph_error *error)
{
  (void)error;
  assert_true(r->t == sph_sim_time(sim));
  return note(ctx, sim, r->name, r->value, r->step);
}

static void keep(sph_sim *sim, diary *d, double interval)
{
  sph_sim_add_output(
      sim, (sph_output){.interval = interval, .frame = note_frame, .event = note_event, .ctx = d});
}

static long count_of(const sph_sim *sim, int k, double *first, double *last)
{
  sph_event_info info = {0};
  assert_int_equal(sph_sim_event_get(sim, k, &info), 1);
  if (first) *first = info.first;
  if (last) *last = info.last;
  return info.count;
}

static void good(sph_sim *sim, int status)
{
  if (status) fail_msg("%s", sph_sim_error(sim));
}

/* ---- when ---- */

/* Front, energy, a function of the user's, time: each where the parabola says, of every way to
 * step. */
static void moments_are_exact(void **state)
{
  (void)state;
  const double fall = 0.3, t = sqrt(2 * fall / g), dt = 0.011;
  double largest = 0;
  for (int k = 0; k < METHODS; k++) {
    double mark = bottom - fall;
    diary d = {0};
    sph_sim *sim = falling(method[k], dt);
    sph_sim_add_event(sim, &(sph_event){.name = "own", .value = height, .ctx = &mark});
    sph_sim_add_event(sim, &(sph_event){.name = "front",
                                        .type = "front",
                                        .axis = 1,
                                        .threshold = mark + 0.4,
                                        .direction = "falling"});
    sph_sim_add_event(sim, &(sph_event){.name = "fast",
                                        .type = "energy",
                                        .quantity = "kinetic",
                                        .threshold = 0.16 * 1000 * g * fall});
    sph_sim_add_event(sim, &(sph_event){.name = "time", .type = "time", .threshold = 0.1});
    sph_sim_add_event(sim, &(sph_event){.name = "never",
                                        .type = "front",
                                        .axis = 1,
                                        .threshold = mark + 0.4,
                                        .direction = "rising"});
    keep(sim, &d, INFINITY);
    good(sim, sph_sim_run(sim, 0.4));
    for (int e = 0; e < 3; e++) {
      double first;
      assert_int_equal(count_of(sim, e, &first, NULL), 1);
      largest = fmax(largest, fabs(first - t) / dt);
      if (!(fabs(first - t) < 1e-9 * dt))
        fail_msg("%s: event %d at %.15g, not %.15g", sph_sim_integrator(sim), e, first, t);
    }
    double first;
    assert_int_equal(count_of(sim, 3, &first, NULL), 1);
    assert_true(first == 0.1);
    assert_int_equal(count_of(sim, 4, NULL, NULL), 0);
    assert_int_equal(d.entries, 6);
    assert_string_equal(d.entry[1].name, "time");
    assert_true(d.entry[1].value == 0.1 && d.entry[1].step == (long)ceil(0.1 / dt));
    assert_true(fabs(d.entry[2].edge - mark) < 1e-9);
    sph_sim_free(sim);
  }
  print_message("# moments of events: %.2g of a step off\n", largest);
}

/* Every integrator there is, of order two and more, finds a moment, stops there, and goes on.  The
 * dense output of ARKODE's tables of order two is linear in a step: g dt^2/8 off the parabola. */
static void of_every_integrator(void **state)
{
  (void)state;
  const double fall = 0.3, t = sqrt(2 * fall / g), dt = 0.011;
  double mark = bottom - fall;
  sph_integrator_info info;
  int tried = 0;
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    /* With densities that are sums, as separable problems have, a block does not fall as one. */
    if (info.order < 2 || (info.wants & SPH_WANTS_SEPARABLE)) continue;
    sph_sim *sim = falling(info.name, dt);
    if (info.wants & SPH_WANTS_IMPLICIT) { /* viscosity, which does nothing here */
      sph_group_set_viscosity(sph_sim_group(sim, "block"), 1);
      sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
    }
    if (info.wants & SPH_WANTS_FAST) sph_sim_set_part(sim, "gravity", "fast");
    sph_sim_add_event(sim, &(sph_event){.name = "own", .value = height, .ctx = &mark, .stop = 1});
    good(sim, sph_sim_run(sim, 0.4));
    assert_true(sph_sim_stopped_by(sim) != NULL);
    double close = info.wants & SPH_WANTS_IMPLICIT ? 1e-6 : 1e-9; /* stages to 1e-8 */
    double sag = strchr(info.name, ':') && info.order == 2 ? g * dt * dt / 8 : 0;
    if (!(fabs(sph_sim_time(sim) - t) < close * dt + 1.01 * sag / (g * t)))
      fail_msg("%s: %.15g, not %.15g", info.name, sph_sim_time(sim), t);
    good(sim, sph_sim_run(sim, 0.4));
    assert_near(edge(sim), bottom - g * 0.4 * 0.4 / 2, close + 1.01 * sag);
    sph_sim_free(sim);
    tried++;
  }
  print_message("# %d integrators\n", tried);
  assert_true(tried > 20);
}

/* The centre of four particles on a spring swings as X0 cos(omega t), whatever they do to each
 * other: frames between steps, where events are found, have the order of the integrator, up to 4
 * (cubic polynomials). */
static const double X0 = 0.5, omega = 2;

static int off_the_cosine(void *ctx, sph_sim *sim, sph_error *error)
{
  const double *x = sph_group_read(sph_sim_group(sim, "patch"), "position", 0);
  double *worst = ctx, centre = (x[0] + x[1] + x[2] + x[3]) / 4;
  (void)error;
  *worst = fmax(*worst, fabs(centre - X0 * cos(omega * sph_sim_time(sim))));
  return SPH_OK;
}

static double dense_error(const sph_integrator_info *info, double dt)
{
  const double lo[] = {X0 - dx, -dx}, hi[] = {X0 + dx, dx};
  double worst = 0;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx});
  sph_group *patch = sph_group_box(sim, "patch", lo, hi, 1);
  sph_group_set_eos(patch, sph_eos_tait(1, 1, 7));
  int summed = (info->wants & SPH_WANTS_SEPARABLE) != 0;
  sph_sim_add_term(sim, summed ? sph_term_summation(0) : sph_term_continuity());
  sph_sim_add_term(sim, summed ? sph_term_pressure_form("s") : sph_term_pressure());
  sph_sim_add_term(sim, sph_term_harmonic(omega));
  if (info->wants & SPH_WANTS_IMPLICIT) {
    sph_group_set_viscosity(patch, 0.01);
    sph_sim_add_term(sim, sph_term_viscosity_laminar(NULL));
  }
  if (info->wants & SPH_WANTS_FAST) sph_sim_set_part(sim, "harmonic", "fast");
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = info->name,
                                                    .dt_fixed = dt,
                                                    .stage_tolerance = 1e-13});
  sph_sim_add_output(sim, (sph_output){.interval = 1e-3, .frame = off_the_cosine, .ctx = &worst});
  if (sph_sim_run(sim, 1.5)) fail_msg("%s: %s", info->name, sph_sim_error(sim));
  sph_sim_free(sim);
  return worst;
}

static void dense_output_has_the_order(void **state)
{
  (void)state;
  sph_integrator_info info;
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (!strcmp(info.name, "verlet-dual")) continue; /* its errors do not shrink smoothly */
    double h = info.order == 1 ? 0.005 : 0.04;
    double coarse = dense_error(&info, h), fine = dense_error(&info, h / 2);
    double order = log2(coarse / fine), nominal = fmin(info.order, 4);
    if (!(order > nominal - 0.1))
      fail_msg("%s: %.2e, %.2e, order %.2f, not %g", info.name, coarse, fine, order, nominal);
  }
}

/* A point gets wet and dry again as the block falls through it: beside a bisection in the dense
 * output of the same run without events. */
static double covered(sph_sim *sim)
{
  static const double x[2] = {0.2, 0.5};
  const sph_group *block = sph_sim_group(sim, "block");
  const double *X = sph_group_read(block, "position", 0), *Y = sph_group_read(block, "position", 1);
  const double *m = sph_group_read(block, "mass", 0), *rho = sph_group_read(block, "density", 0);
  const sph_kernel *kernel = sph_kernel_find("wendland-c2");
  double sum = 0;
  for (long i = 0; i < sph_group_count(block); i++)
    sum += m[i] / rho[i] * sph_kernel_w(kernel, 2, hypot(X[i] - x[0], Y[i] - x[1]), sph_sim_h(sim));
  return sum - 0.15;
}

static double bisection(sph_sim *sim, double a, double b)
{
  assert_int_equal(sph_sim_run_show(sim, a), SPH_OK);
  double value_a = covered(sim);
  while (b - a > 1e-15) {
    double t = (a + b) / 2;
    assert_int_equal(sph_sim_run_show(sim, t), SPH_OK);
    if ((covered(sim) > 0) == (value_a > 0))
      a = t;
    else
      b = t;
  }
  return b;
}

static void wet_and_dry(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    double found[2], expected[2], last = -1;
    int passages = 0;
    sph_sim *sim = falling(k ? "leapfrog" : NULL, 0), *plain = falling(k ? "leapfrog" : NULL, 0);
    sph_sim_add_event(sim, &(sph_event){.name = "wet", .type = "wet", .x = {0.2, 0.5}});
    sph_sim_add_event(sim, &(sph_event){.name = "dry", .type = "dry", .x = {0.2, 0.5}});
    good(sim, sph_sim_run(sim, 0.5));
    assert_int_equal(count_of(sim, 0, &found[0], NULL), 1);
    assert_int_equal(count_of(sim, 1, &found[1], NULL), 1);
    while (passages < 2) {
      good(plain, sph_sim_step(plain));
      double now = covered(plain), t = sph_sim_time(plain);
      if ((now > 0) != (last > 0))
        expected[passages++] = bisection(plain, sph_integrator_previous(plain->integrator), t);
      last = now;
      sph_sim_run_show(plain, t);
    }
    sph_sim_stats stats;
    sph_sim_get_stats(sim, &stats);
    for (int e = 0; e < 2; e++)
      if (!(fabs(found[e] - expected[e]) < 1e-9 * stats.step.dt_smallest))
        fail_msg("%.16g, bisection %.16g", found[e], expected[e]);
    sph_sim_free(sim);
    sph_sim_free(plain);
  }
}

/* The front of a dam break, a maximum over particles that change: between the rows of a series of
 * frames, five a step or more. */
typedef struct series {
  int n;
  double t[20000], front[20000];
} series;

static int measure(void *ctx, sph_sim *sim, sph_error *error)
{
  series *s = ctx;
  const sph_monitor front = {.name = "front", .type = "front"};
  if (s->n >= 20000) return SPH_ERR_STATE;
  s->t[s->n] = sph_sim_time(sim);
  return sph_monitor_value(&front, sim, &s->front[s->n++], error);
}

static sph_sim *dam_break(const char *name)
{
  const double H = 1, c0 = 10 * sqrt(2 * g * H);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = H / 12});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){H, H}, 1000);
  sph_group *tank = sph_group_create(sim, "tank", "wall");
  sph_group_add_layers(tank, (double[]){0, 0}, (double[]){6 * H, 1.5 * H}, "y+", 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, c0, 7));
  sph_group_set_boundary(tank, sph_boundary_adami());
  sph_group_set_hydrostatic(water, 1, H, g);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.05, 0));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -g, 0}));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = name});
  return sim;
}

static void front_of_a_dam_break(void **state)
{
  (void)state;
  static const char *const name[] = {"e0", "e1", "e2", "e3"};
  static series s;
  for (int k = 0; k < 2; k++) {
    sph_sim *sim = dam_break(k ? "leapfrog" : NULL);
    for (int e = 0; e < 4; e++)
      sph_sim_add_event(sim, &(sph_event){.name = name[e],
                                          .type = "front",
                                          .threshold = 1.2 + 0.5 * e,
                                          .once = 1});
    s.n = 0;
    sph_sim_add_output(sim, (sph_output){.interval = 1e-4, .frame = measure, .ctx = &s});
    good(sim, sph_sim_run(sim, 0.7));
    sph_sim_stats stats;
    sph_sim_get_stats(sim, &stats);
    for (int e = 0; e < 4; e++) {
      double first, x = 1.2 + 0.5 * e;
      int row = 1;
      assert_int_equal(count_of(sim, e, &first, NULL), 1);
      while (row < s.n - 1 && s.front[row] < x) row++;
      double expected = s.t[row - 1] + (x - s.front[row - 1]) / (s.front[row] - s.front[row - 1]) *
                                           (s.t[row] - s.t[row - 1]);
      print_message("# front at %.1f: %.9f s, between frames %.9f s\n", x, first, expected);
      assert_true(first > s.t[row - 1] && first <= s.t[row]);
      assert_near(first, expected, 1e-7); /* 1e-4^2 a/(8 v) is 1e-8 */
    }
    assert_true(stats.step.steps < s.n / 5);
    sph_sim_free(sim);
  }
}

/* ---- how often ---- */

static double from_time(void *ctx, sph_sim *sim) { return sph_sim_time(sim) - *(double *)ctx; }

static double touch(void *ctx, sph_sim *sim)
{
  double s = from_time(ctx, sim);
  return s * s;
}

/* Zero exactly at the end of a step, which is the start of the next: once, in the direction in
 * which it is passed; touched: once; at the start of all: never. */
static void ends_of_steps_count_once(void **state)
{
  (void)state;
  static const char *const direction[] = {"both", "rising", "falling"};
  const double dt = 1.0 / 128;
  double at[2] = {3 * dt, 0};
  for (int k = 0; k < 6; k++) {
    double first;
    sph_sim *sim = falling(k < 3 ? NULL : "verlet", dt);
    for (int e = 0; e < 2; e++) {
      sph_event event = {.name = e ? "start" : "end", .value = from_time, .ctx = &at[e]};
      event.direction = direction[k % 3];
      sph_sim_add_event(sim, &event);
    }
    sph_sim_add_event(sim, &(sph_event){.name = "touch",
                                        .value = touch,
                                        .ctx = &at[0],
                                        .direction = direction[k % 3]});
    good(sim, sph_sim_run(sim, 10 * dt));
    assert_int_equal(count_of(sim, 0, &first, NULL), k % 3 != 2);
    if (k % 3 != 2) assert_true(first == 3 * dt);
    assert_int_equal(count_of(sim, 1, NULL, NULL), 0);
    assert_int_equal(count_of(sim, 2, NULL, NULL), k % 3 != 1);
    sph_sim_free(sim);
  }
}

static double waves(void *ctx, sph_sim *sim) { return sin(*(double *)ctx * sph_sim_time(sim) + 1); }

/* Passages n pi = w t + 1, four in a step: seen with looks between, in order; once: the first. */
static void many_in_a_step(void **state)
{
  (void)state;
  double dt = 0.01, w = 4 * acos(-1) / dt;
  diary d = {0};
  sph_sim *sim = falling(NULL, dt);
  sph_sim_add_event(sim, &(sph_event){.name = "w", .value = waves, .ctx = &w, .samples = 15});
  sph_sim_add_event(sim,
                    &(sph_event){.name = "1", .value = waves, .ctx = &w, .samples = 15, .once = 1});
  keep(sim, &d, INFINITY);
  good(sim, sph_sim_run(sim, 3 * dt));
  assert_int_equal(count_of(sim, 0, NULL, NULL), 12);
  assert_int_equal(count_of(sim, 1, NULL, NULL), 1);
  int n = 0;
  for (int k = 0; k < d.entries; k++) {
    assert_true(k == 0 || d.entry[k].t >= d.entry[k - 1].t);
    if (strcmp(d.entry[k].name, "w")) continue;
    assert_near(d.entry[k].t, (++n * acos(-1) - 1) / w, 1e-10 * dt);
  }
  assert_int_equal(n, 12);
  sph_sim_free(sim);
}

/* A jump, as of a front that loses its spray, is found as well as a slope. */
static double jump(void *ctx, sph_sim *sim) { return from_time(ctx, sim) < 0 ? -1 : 1e9; }

static void jumps(void **state)
{
  (void)state;
  double at = 0.0237, first;
  sph_sim *sim = falling(NULL, 0.01);
  sph_sim_add_event(sim, &(sph_event){.name = "jump", .value = jump, .ctx = &at});
  good(sim, sph_sim_run(sim, 0.05));
  assert_int_equal(count_of(sim, 0, &first, NULL), 1);
  assert_true(first >= at && first < at + 1e-11 * 0.01);
  sph_sim_free(sim);
}

/* ---- frames ---- */

/* Rows and frames of one output come in the order of time; a snapshot that coincides with a frame
 * that is due is not written twice. */
static void frames_in_order(void **state)
{
  (void)state;
  double marks[] = {0.9, 0.65, 0.45}, dt = 0.03;
  const double expected = sqrt(2 * 0.35 / g);
  diary d = {0}, ends = {0};
  sph_sim *sim = falling(NULL, dt);
  sph_sim_add_event(sim, &(sph_event){.name = "a", .value = height, .ctx = &marks[0]});
  sph_sim_add_event(sim,
                    &(sph_event){.name = "b", .value = height, .ctx = &marks[1], .snapshot = 1});
  sph_sim_add_event(sim, &(sph_event){.name = "c", .value = height, .ctx = &marks[2]});
  sph_sim_add_event(
      sim, &(sph_event){.name = "t", .type = "time", .threshold = 4 * 0.02, .snapshot = 1});
  keep(sim, &d, 0.02);
  keep(sim, &ends, INFINITY);
  good(sim, sph_sim_run(sim, 0.4));
  int frames = 0, extra = 0;
  for (int k = 0; k < d.entries; k++) {
    assert_true(k == 0 || d.entry[k].t >= d.entry[k - 1].t);
    assert_true(fabs(d.entry[k].edge - (bottom - g * d.entry[k].t * d.entry[k].t / 2)) < 1e-9);
    if (d.entry[k].name[0]) continue;
    frames++;
    extra += fabs(d.entry[k].t - expected) < 1e-10;
  }
  assert_int_equal(frames, 22); /* 0, 0.02, ..., 0.4 and that of b */
  assert_int_equal(extra, 1);
  assert_int_equal(ends.entries, 4 + 4); /* four events; the start, b, t, the end */
  sph_sim_free(sim);
}

/* ---- stop ---- */

static void a_stop_is_exact_and_goes_on(void **state)
{
  (void)state;
  for (int k = 0; k < METHODS; k++) {
    double mark = 0.7, t = sqrt(2 * 0.3 / g);
    diary d = {0};
    sph_sim *sim = falling(method[k], k % 2 ? 0.011 : 0);
    sph_sim_add_event(sim, &(sph_event){.name = "half", .value = height, .ctx = &mark, .stop = 1});
    keep(sim, &d, 0.05);
    keep(sim, &d, INFINITY);
    assert_null(sph_sim_stopped_by(sim));
    good(sim, sph_sim_run(sim, 0.4));
    assert_string_equal(sph_sim_stopped_by(sim), "half");
    assert_true(fabs(sph_sim_time(sim) - t) < 1e-11);
    assert_true(fabs(edge(sim) - mark) < 1e-10);
    assert_true(fabs(d.entry[d.entries - 1].t - t) < 1e-11); /* the frame at the end */
    good(sim, sph_sim_run(sim, 0.4));
    assert_null(sph_sim_stopped_by(sim));
    assert_true(sph_sim_time(sim) == 0.4);
    assert_true(fabs(edge(sim) - (bottom - g * 0.4 * 0.4 / 2)) < 1e-9);
    assert_int_equal(count_of(sim, 0, NULL, NULL), 1);
    for (int e = 1; e < d.entries; e++) assert_true(d.entry[e].t >= d.entry[e - 1].t);
    sph_sim_free(sim);
  }
}

/* Steps by hand have events, too. */
static void a_stop_ends_a_step(void **state)
{
  (void)state;
  double mark = 0.7;
  sph_sim *sim = falling(NULL, 0.011);
  sph_sim_add_event(sim, &(sph_event){.name = "half", .value = height, .ctx = &mark, .stop = 1});
  while (!sph_sim_stopped_by(sim)) good(sim, sph_sim_step(sim));
  assert_true(fabs(sph_sim_time(sim) - sqrt(2 * 0.3 / g)) < 1e-11);
  good(sim, sph_sim_step(sim));
  assert_true(fabs(sph_sim_time(sim) - sqrt(2 * 0.3 / g) - 0.011) < 1e-11);
  sph_sim_free(sim);
}

/* ---- change ---- */

static int no_gravity(void *ctx, sph_sim *sim)
{
  (void)ctx;
  sph_sim_change_term(sim, sph_term_gravity((double[3]){0, 0, 0}));
  return SPH_OK;
}

/* Gravity ends where the block has fallen by 0.3: from there it moves uniformly; frames behind are
 * those of the new motion, also in what would have been the step. */
static void gravity_is_switched_off(void **state)
{
  (void)state;
  for (int k = 0; k < METHODS; k++) {
    double mark = 0.7, t = sqrt(2 * 0.3 / g), v = -g * t;
    diary d = {0};
    sph_sim *sim = falling(method[k], k % 2 ? 0.05 : 0);
    sph_sim_add_event(
        sim, &(sph_event){.name = "off", .value = height, .ctx = &mark, .change = no_gravity});
    keep(sim, &d, 0.002);
    good(sim, sph_sim_run(sim, t + 0.1));
    int behind = 0;
    for (int e = 0; e < d.entries; e++) {
      double s = d.entry[e].t - t;
      behind += s > 0;
      double exact = mark + v * s - (s < 0 ? g * s * s / 2 : 0);
      if (!(fabs(d.entry[e].edge - exact) < 1e-9))
        fail_msg("%s, t* %+g s: %.12g, not %.12g", sph_sim_integrator(sim), s, d.entry[e].edge,
                 exact);
    }
    assert_true(behind >= 50);
    const sph_group *block = sph_sim_group(sim, "block");
    const double *vy = sph_group_read(block, "velocity", 1);
    for (long i = 0; i < sph_group_count(block); i++) assert_true(fabs(vy[i] - v) < 1e-10);
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    const double *a = sph_group_rate(block, "velocity", 1);
    for (long i = 0; i < sph_group_count(block); i++) assert_true(fabs(a[i]) < 1e-9);
    sph_sim_free(sim);
  }
}

static int bounce(void *ctx, sph_sim *sim)
{
  sph_group *block = sph_sim_group(sim, "block");
  double *v = sph_group_write(block, "velocity", 1);
  (void)ctx;
  for (long i = 0; i < sph_group_count(block); i++) v[i] = -v[i];
  return SPH_OK;
}

/* Bounces at y = 0 come at sqrt(2 H/g) (1, 3, 5, ...), each found once, whatever the direction: the
 * function stands on zero when the next step begins. */
static void bounces(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * METHODS; k++) {
    double floor = 0, first = sqrt(2 * bottom / g), dt = k % 2 ? 0.02 : 0.013;
    diary d = {0};
    sph_sim *sim = falling(method[k / 2], dt);
    sph_sim_add_event(sim, &(sph_event){.name = "bounce",
                                        .value = height,
                                        .ctx = &floor,
                                        .direction = k % 2 ? NULL : "falling",
                                        .change = bounce});
    keep(sim, &d, INFINITY);
    good(sim, sph_sim_run(sim, 8 * first));
    int n = 0;
    for (int e = 0; e < d.entries; e++)
      if (d.entry[e].name[0]) assert_near(d.entry[e].t, (2 * n++ + 1) * first, 1e-9);
    assert_int_equal(n, 4);
    assert_near(edge(sim), bottom, 1e-8);
    sph_sim_free(sim);
  }
}

/* Where a step ends, nothing is cut, and the integrator starts anew all the same: as by hand. */
static void a_change_at_the_end_of_a_step(void **state)
{
  (void)state;
  const double dt = 1.0 / 128;
  double at = 3 * dt;
  for (int k = 0; k < METHODS; k++) {
    sph_sim *sim = falling(method[k], dt), *hand = falling(method[k], dt);
    sph_sim_add_event(sim,
                      &(sph_event){.name = "b", .value = from_time, .ctx = &at, .change = bounce});
    good(sim, sph_sim_run(sim, 10 * dt));
    good(hand, sph_sim_run(hand, at));
    bounce(NULL, hand);
    sph_sim_changed(hand);
    good(hand, sph_sim_run(hand, 10 * dt));
    assert_true(edge(sim) == edge(hand));
    assert_true(edge(sim) > bottom - 3 * g * at * at);
    sph_sim_free(sim);
    sph_sim_free(hand);
  }
}

/* Two events of one moment: both are told of the state before either changes it, and the order of
 * changes is that in which they were added. */
static int order[4], orders;
static int first_change(void *ctx, sph_sim *sim)
{
  (void)sim;
  order[orders++] = *(int *)ctx;
  return bounce(NULL, sim);
}

static void changes_of_one_moment(void **state)
{
  (void)state;
  int number[2] = {1, 2};
  diary d = {0};
  sph_sim *sim = falling(NULL, 0.03);
  orders = 0;
  for (int k = 0; k < 2; k++)
    sph_sim_add_event(sim, &(sph_event){.name = k ? "2" : "1",
                                        .type = "time",
                                        .threshold = 0.1,
                                        .change = first_change,
                                        .ctx = &number[k],
                                        .stop = k});
  keep(sim, &d, INFINITY);
  good(sim, sph_sim_run(sim, 1));
  assert_true(sph_sim_time(sim) == 0.1);
  assert_string_equal(sph_sim_stopped_by(sim), "2");
  assert_int_equal(orders, 2);
  assert_true(order[0] == 1 && order[1] == 2);
  assert_string_equal(d.entry[1].name, "1");
  assert_string_equal(d.entry[2].name, "2");
  sph_sim_free(sim);
}

/* Viscous forces, the only ones here, are proportional to the viscosity, also to a new one. */
static void viscosity_changes(void **state)
{
  (void)state;
  double a[2];
  sph_sim *sim = falling(NULL, 0.001);
  sph_group *block = sph_sim_group(sim, "block");
  sph_sim_add_term(sim, sph_term_viscosity_laminar(NULL));
  sph_sim_change_term(sim, sph_term_gravity((double[3]){0, 0, 0}));
  sph_group_set_viscosity(block, 2);
  double *v = sph_group_write(block, "velocity", 0);
  for (long i = 0; i < sph_group_count(block); i++) v[i] = sin((double)i);
  for (int k = 0; k < 2; k++) {
    good(sim, sph_sim_evaluate(sim));
    a[k] = sph_group_rate(block, "velocity", 0)[5];
    sph_group_set_viscosity(block, 3);
  }
  assert_true(fabs(a[0]) > 0.01);
  assert_near(a[1] / a[0], 1.5, 1e-13);
  good(sim, sph_sim_step(sim));
  sph_group_set_conductivity(block, 1);
  assert_int_equal(sph_sim_status(sim), SPH_ERR_STATE);
  assert_non_null(strstr(sph_sim_error(sim), "conductivity is set before the run where no term"));
  sph_sim_free(sim);
}

/* ---- failures ---- */

static double fails(void *ctx, sph_sim *sim)
{
  if (sph_sim_time(sim) < 0.02) return 1;
  if (*(int *)ctx == 0) return NAN;
  if (*(int *)ctx == 1) return INFINITY;
  sph_sim_fail(sim, SPH_ERR_STATE, "no reading today");
  return 0;
}

static int refuses(void *ctx, sph_sim *sim)
{
  (void)sim;
  return *(int *)ctx;
}

static void failures_end_the_run(void **state)
{
  (void)state;
  static const char *const text[] = {"event bad: its function gave nan at t = 0.02",
                                     "event bad: its function gave inf", "no reading today"};
  for (int k = 0; k < 3; k++) {
    sph_sim *sim = falling(NULL, 0.01);
    sph_sim_add_event(sim, &(sph_event){.name = "bad", .value = fails, .ctx = &k});
    assert_int_equal(sph_sim_run(sim, 0.1), k < 2 ? SPH_ERR_ARGUMENT : SPH_ERR_STATE);
    assert_non_null(strstr(sph_sim_error(sim), text[k]));
    sph_sim_free(sim);
  }
  for (int k = 0; k < 2; k++) {
    int status = SPH_ERR_FILE;
    sph_sim *sim = falling(NULL, 0.01);
    if (k == 0)
      sph_sim_add_event(sim, &(sph_event){.name = "bad",
                                          .type = "time",
                                          .threshold = 0.025,
                                          .change = refuses,
                                          .ctx = &status});
    else
      sph_sim_add_modifier(
          sim, (sph_modifier){.name = "bad", .steps = 1, .modify = refuses, .ctx = &status});
    assert_int_equal(sph_sim_run(sim, 0.1), SPH_ERR_FILE);
    assert_non_null(
        strstr(sph_sim_error(sim), k ? "modifier bad failed" : "event bad: its change"));
    sph_sim_free(sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(moments_are_exact),
      cmocka_unit_test(of_every_integrator),
      cmocka_unit_test(dense_output_has_the_order),
      cmocka_unit_test(wet_and_dry),
      cmocka_unit_test(front_of_a_dam_break),
      cmocka_unit_test(ends_of_steps_count_once),
      cmocka_unit_test(many_in_a_step),
      cmocka_unit_test(jumps),
      cmocka_unit_test(frames_in_order),
      cmocka_unit_test(a_stop_is_exact_and_goes_on),
      cmocka_unit_test(a_stop_ends_a_step),
      cmocka_unit_test(gravity_is_switched_off),
      cmocka_unit_test(bounces),
      cmocka_unit_test(a_change_at_the_end_of_a_step),
      cmocka_unit_test(changes_of_one_moment),
      cmocka_unit_test(viscosity_changes),
      cmocka_unit_test(failures_end_the_run),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
