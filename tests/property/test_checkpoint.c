/* A checkpoint changes nothing, and a run that goes on from it is the one that was never
 * interrupted: the same bits of the state, the same bytes of all files, for every integrator, with
 * and without error control, any number of threads, events and modifiers that change things. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sphode.h"

enum { ACROSS = 8, EVERY = 3 };
static char root[200];

/* ---- the run ---- */

typedef struct variant {
  sph_integrator_def integrator;
  int wants;   /* enum sph_integrator_wants */
  int events;  /* events and modifiers that change */
  int outputs; /* into a directory */
} variant;

/* Forgets nothing: the speed of particle 0 at each call, summed. */
typedef struct memory {
  double sum;
  long calls;
} memory;

static int damp(void *ctx, sph_sim *sim)
{
  memory *m = ctx;
  sph_group *water = sph_sim_group(sim, "water");
  double *v = sph_group_write(water, "velocity", 1);
  m->sum += v[0];
  m->calls++;
  for (long i = 0; i < sph_group_count(water); i++) v[i] *= 0.95 + 1e-3 * m->sum;
  return 1;
}

static int keep_memory(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  memory *m = ctx;
  (void)sim, (void)error;
  sph_keep_real(keep, "sum", 1, &m->sum);
  return sph_keep_integer(keep, "calls", 1, &m->calls);
}

static int less_gravity(void *ctx, sph_sim *sim)
{
  (void)ctx;
  sph_sim_change_term(sim, sph_term_gravity((double[3]){0, -3, 0}));
  return SPH_OK;
}

static void add_events(sph_sim *sim, const variant *v, memory *m)
{
  sph_sim_add_event(sim, &(sph_event){.name = "early",
                                      .type = "time",
                                      .threshold = 0.02,
                                      .change = less_gravity,
                                      .snapshot = 1});
  sph_sim_add_event(sim, &(sph_event){.name = "still", .type = "steady", .threshold = 20});
  sph_sim_add_event(
      sim, &(sph_event){.name = "moving", .type = "energy", .quantity = "kinetic", .threshold = 1});
  sph_sim_add_modifier(sim, (sph_modifier){.name = "damp", .steps = 7, .modify = damp, .ctx = m});
  if (!(v->wants & SPH_WANTS_SEPARABLE)) sph_sim_reset_density(sim, "mls", 5);
  sph_sim_keep_add(sim, (sph_kept){.name = "damping", .keep = keep_memory, .ctx = m});
}

static void add_terms(sph_sim *sim, sph_group *water, const variant *v)
{
  const int separable = v->wants & SPH_WANTS_SEPARABLE;
  sph_sim_add_term(sim, separable ? sph_term_summation(0) : sph_term_continuity());
  sph_sim_add_term(sim, separable ? sph_term_pressure_form("s") : sph_term_pressure());
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -10, 0}));
  if (separable) return;
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_group_set_viscosity(water, v->wants & SPH_WANTS_IMPLICIT ? 50 : 1);
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  if (v->wants & SPH_WANTS_FAST) {
    sph_sim_add_term(sim, sph_term_harmonic(30));
    sph_sim_set_part(sim, "harmonic", "fast");
  }
}

/* A column of water, disordered, that falls in a tank. */
static sph_sim *make(const variant *v, int threads, const char *directory, memory *m)
{
  const double dx = 1.0 / ACROSS;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .threads = threads, .speed = 2});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group *tank = sph_group_walls(sim, "tank", (double[]){0, 0}, (double[]){2, 1.5}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 30, 7));
  sph_boundary adami = sph_boundary_adami();
  adami.no_slip = !(v->wants & SPH_WANTS_SEPARABLE);
  sph_group_set_boundary(tank, adami);
  sph_group_jitter(water, 0.1, 3);
  add_terms(sim, water, v);
  sph_sim_set_integrator(sim, &v->integrator);
  *m = (memory){0};
  if (v->events) add_events(sim, v, m);
  if (directory && v->outputs) {
    sph_sim_add_output(sim, sph_output_hdf5(directory, 0.011));
    sph_sim_add_output(sim, sph_output_series(directory, v->integrator.method[0] == 'l' ? 0 : 0.007,
                                              NULL, 0));
    sph_sim_add_output(sim, sph_output_events(directory));
  }
  return sim;
}

/* ---- what is the same ---- */

typedef struct result {
  long n;
  double *values;
} result;

static result take(const sph_sim *sim)
{
  static const char *const field[] = {"position", "velocity", "density"};
  sph_sim_stats stats;
  sph_group *water = sph_sim_group(sim, "water");
  const long n = sph_group_count(water);
  result r = {.n = 5 * n + 5};
  r.values = calloc((size_t)r.n, sizeof(double));
  assert_non_null(r.values);
  double *at = r.values;
  for (int f = 0; f < 3; f++)
    for (int d = 0; d < (f < 2 ? 2 : 1); d++, at += n)
      memcpy(at, sph_group_read(water, field[f], d), (size_t)n * sizeof *at);
  sph_sim_get_stats(sim, &stats);
  *at++ = sph_sim_time(sim);
  *at++ = (double)stats.step.steps;
  *at++ = stats.step.dt_last;
  *at++ = (double)stats.step.rejected;
  *at++ = (double)stats.list_builds;
  return r;
}

static int same(const result *a, const result *b)
{
  return a->n == b->n && !memcmp(a->values, b->values, (size_t)a->n * sizeof(double));
}

static void must(sph_sim *sim, int status, const char *what)
{
  if (status) fail_msg("%s: %s", what, sph_sim_error(sim));
}

static void path_of(char path[300], const char *name) { snprintf(path, 300, "%s/%s", root, name); }

static void clear(const char *directory)
{
  char command[700];
  snprintf(command, sizeof command, "rm -rf '%s'", directory);
  assert_int_equal(system(command), 0);
}

/* ---- bits ---- */

static result plain(const variant *v, double end, const char *directory)
{
  memory m;
  sph_sim *sim = make(v, 1, directory, &m);
  must(sim, sph_sim_run(sim, end), "without checkpoints");
  result r = take(sim);
  sph_sim_free(sim);
  return r;
}

static int stop_at(void *ctx, sph_sim *sim) { return sph_sim_time(sim) >= *(double *)ctx; }

static result checked(const variant *v, double end, double stop, const char *directory)
{
  memory m;
  sph_sim *sim = make(v, 1, directory, &m);
  sph_checkpoint_set(sim,
                     &(sph_checkpoint_def){.directory = directory, .steps = EVERY, .keep = 1000});
  if (stop > 0) sph_sim_set_progress(sim, stop_at, &stop);
  int status = sph_sim_run(sim, end);
  if (status != (stop > 0 ? SPH_ERR_STOPPED : SPH_OK)) must(sim, status, "with checkpoints");
  result r = take(sim);
  sph_sim_free(sim);
  return r;
}

static result restarted(const variant *v, double end, int threads, const char *path,
                        const char *directory)
{
  memory m;
  sph_sim *sim = make(v, threads, directory, &m);
  must(sim, sph_checkpoint_read(sim, path), "read");
  must(sim, sph_sim_run(sim, end), "restarted");
  result r = take(sim);
  sph_sim_free(sim);
  return r;
}

/* How many numbers, after telling the last one. */
static long differing(const result *a, const result *b)
{
  static const char *const last[] = {"time", "steps", "dt_last", "rejected", "list_builds"};
  long count = 0, at = 0;
  for (long i = 0; a->n == b->n && i < a->n; i++)
    if (memcmp(&a->values[i], &b->values[i], sizeof(double)) != 0) count++, at = i;
  print_message("# %s: %.17g, %.17g\n", at < a->n - 5 ? "a field" : last[at - a->n + 5],
                a->values[at], b->values[at]);
  return count;
}

/* From each checkpoint of a run, all but its end, with one and two threads. */
static void one_integrator(const variant *v, double end, const char *name)
{
  char directory[300], path[400];
  path_of(directory, "bits");
  clear(directory);
  result a = plain(v, end, NULL), b = checked(v, end, 0, directory);
  if (!same(&a, &b)) fail_msg("%s: checkpoints change %ld numbers", name, differing(&a, &b));
  int k = 1, restarts = 0; /* 0: the end */
  for (; sph_checkpoint_find(directory, k, path, sizeof path); k += 1 + k / 3, restarts++) {
    result c = restarted(v, end, 1 + k % 2, path, NULL);
    if (!same(&a, &c)) fail_msg("%s: %s: %ld numbers differ", name, path, differing(&a, &c));
    free(c.values);
  }
  assert_in_range(restarts, 3, 100);
  free(a.values);
  free(b.values);
}

/* Times of a good number of steps. */
static double end_of(const variant *v)
{
  memory m;
  sph_sim *sim = make(v, 1, NULL, &m);
  for (int k = 0; k < 40; k++) must(sim, sph_sim_step(sim), v->integrator.method);
  double t = sph_sim_time(sim);
  sph_sim_free(sim);
  return t * (1 + 1e-3);
}

/* SPHODE_TEST_QUICK=1, for sanitizers: one of five. */
static void each_integrator(void **state)
{
  (void)state;
  sph_integrator_info info;
  const int every = getenv("SPHODE_TEST_QUICK") ? 5 : 1;
  int count = 0;
  for (int k = 0; sph_integrator_info_get(k, &info); k += every) {
    variant v = {.integrator = {.method = info.name, .tolerance = -1}, .wants = info.wants};
    one_integrator(&v, end_of(&v), info.name);
    count++;
    if (!info.error_control) continue;
    v.integrator.tolerance = 1e-3;
    v.integrator.cfl = 10;
    one_integrator(&v, end_of(&v), info.name);
    v.events = 1;
    one_integrator(&v, end_of(&v), info.name);
  }
  print_message("# %d of the integrators: the same bits\n", count);
  assert_in_range(count * every, 30, 200);
}

/* Steps of one size; each controller; each linear solver; the fast part by error control. */
static void each_kind(void **state)
{
  (void)state;
  static const char *const linear[] = {
      "auto", "pcg-jacobi", "pcg-ic0", "cholmod-supernodal", "cholmod-simplicial", "klu"};
  static const char *const controller[] = {"i", "pi", "gustafsson", "pid", "h211"};
  static const char *const fixed[] = {"leapfrog", "verlet-dual", "erk:zonneveld-5-3-4",
                                      "imex:ark324l2sa-4-2-3", "mri:kw3"};
  for (size_t k = 0; k < sizeof linear / sizeof *linear; k++)
    for (int adaptive = 0; adaptive < 2; adaptive++) {
      variant v = {.integrator = {.method = "imex:ark324l2sa-4-2-3",
                                  .linear = linear[k],
                                  .tolerance = adaptive ? 1e-3 : -1},
                   .wants = SPH_WANTS_IMPLICIT};
      one_integrator(&v, end_of(&v), linear[k]);
    }
  for (size_t k = 0; k < sizeof controller / sizeof *controller; k++) {
    variant v = {.integrator = {.controller = controller[k], .tolerance = 1e-4, .cfl = 10}};
    one_integrator(&v, end_of(&v), controller[k]);
  }
  for (size_t k = 0; k < sizeof fixed / sizeof *fixed; k++) {
    variant v = {.integrator = {.method = fixed[k], .dt_fixed = 5e-4},
                 .wants = k == 3   ? SPH_WANTS_IMPLICIT
                          : k == 4 ? SPH_WANTS_FAST
                                   : 0};
    one_integrator(&v, 0.02 + 1e-5, fixed[k]);
    v.events = 1;
    one_integrator(&v, 0.03, fixed[k]);
  }
  variant v = {.integrator = {.method = "mri:kw3", .fast_tolerance = 1e-5, .tolerance = -1},
               .wants = SPH_WANTS_FAST};
  one_integrator(&v, end_of(&v), "mri:kw3 with error control of the fast part");
}

/* The same course, if not the same bits. */
static void near_to(const result *a, const result *b)
{
  assert_int_equal(a->n, b->n);
  for (long i = 0; i < a->n; i++) {
    double d = fabs(a->values[i] - b->values[i]);
    if (!(d <= 1e-8 * (1 + fabs(a->values[i]))))
      fail_msg("relaxed: number %ld differs by %g", i, d);
  }
}

/* Relaxed steps, from SUNDIALS 6.6 on, which an older one says and passes: their Newton's method
 * starts from the factor of the step before, which ARKODE does not tell. */
static void relaxed(void **state)
{
  (void)state;
  static const char *const method[] = {"erk:bogacki-shampine-4-2-3", "erk:zonneveld-5-3-4"};
  for (int k = 0; k < 4; k++) {
    variant v = {.integrator = {.method = method[k % 2],
                                .relax = "energy",
                                .tolerance = k < 2 ? -1 : 1e-3,
                                .cfl = k < 2 ? 0 : 10}};
    memory m;
    sph_sim *sim = make(&v, 1, NULL, &m);
    int unbuilt = sph_sim_status(sim) == SPH_ERR_UNBUILT;
    if (unbuilt) print_message("# not run: %s\n", sph_sim_error(sim));
    sph_sim_free(sim);
    if (unbuilt) return;
    char directory[300], path[400];
    path_of(directory, "relaxed");
    clear(directory);
    const double end = end_of(&v);
    result a = plain(&v, end, NULL), b = checked(&v, end, 0, directory);
    assert_true(same(&a, &b));
    assert_true(sph_checkpoint_find(directory, 3, path, sizeof path));
    result c = restarted(&v, end, 1, path, NULL);
    near_to(&a, &c);
    free(a.values);
    free(b.values);
    free(c.values);
  }
}

/* ---- files ---- */

static char *content(const char *directory, const char *name, long *size)
{
  char path[400];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  FILE *file = fopen(path, "rb");
  *size = -1;
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  *size = ftell(file);
  rewind(file);
  char *data = malloc((size_t)*size + 1);
  assert_non_null(data);
  assert_int_equal(fread(data, 1, (size_t)*size, file), *size);
  fclose(file);
  data[*size] = '\0';
  return data;
}

static void same_file(const char *a, const char *b, const char *name)
{
  long n = 0, m = 0;
  char *x = content(a, name, &n), *y = content(b, name, &m);
  if (n != m || (x && memcmp(x, y, (size_t)n) != 0))
    fail_msg("%s: %ld and %ld bytes, or other ones", name, n, m);
  free(x);
  free(y);
}

static int all_same(const char *a, const char *b)
{
  static const char *const name[] = {"series.csv", "events.csv", "snapshot.hdf.series",
                                     "walls.hdf.series"};
  char snapshot[40];
  int frames = 0;
  for (int k = 0; k < 4; k++) same_file(a, b, name[k]);
  for (;; frames++) {
    long size;
    snprintf(snapshot, sizeof snapshot, "snapshot_%04d.hdf", frames);
    same_file(a, b, snapshot);
    char *data = content(a, snapshot, &size);
    free(data);
    if (!data) return frames;
  }
}

/* The run is stopped; then it goes on from the last checkpoint, then from older ones, whose files
 * reach further than they do. */
static void files(void **state)
{
  (void)state;
  static const char *const method[] = {"leapfrog", "erk:bogacki-shampine-4-2-3"};
  for (int k = 0; k < 2; k++) {
    const double end = 0.15;
    variant v = {.integrator = {.method = method[k]}, .events = 1, .outputs = 1};
    char a[300], b[300], path[400];
    path_of(a, "whole");
    path_of(b, "parts");
    clear(a);
    clear(b);
    result whole = plain(&v, end, a), part = checked(&v, end, 0.6 * end, b);
    assert_false(same(&whole, &part));
    for (int back = 0; back < 4; back += 1 + back) {
      assert_true(sph_checkpoint_find(b, back, path, sizeof path));
      result r = restarted(&v, end, 1, path, b);
      assert_true(same(&whole, &r));
      assert_in_range(all_same(a, b), 12, 20);
      free(r.values);
    }
    free(whole.values);
    free(part.values);
  }
}

/* ---- when, and which stay ---- */

static int count_files(const char *directory)
{
  int k = 0;
  while (sph_checkpoint_find(directory, k, NULL, 0)) k++;
  return k;
}

static void which_stay(void **state)
{
  (void)state;
  char directory[300], path[400];
  sph_checkpoint_info info;
  memory m;
  variant v = {.integrator = {.method = "leapfrog", .dt_fixed = 1e-3}};
  path_of(directory, "stay");
  clear(directory);
  sph_sim *sim = make(&v, 1, NULL, &m);
  sph_checkpoint_set(sim,
                     &(sph_checkpoint_def){.directory = directory, .interval = 5e-3, .keep = 3});
  must(sim, sph_sim_run(sim, 0.0225), "run");
  assert_int_equal(count_files(directory), 3);
  const long steps[] = {23, 20, 15};
  for (int k = 0; k < 3; k++) {
    assert_true(sph_checkpoint_find(directory, k, path, sizeof path));
    assert_int_equal(sph_checkpoint_info_read(path, &info, NULL), SPH_OK);
    assert_int_equal(info.step, steps[k]);
    assert_true(info.same);
    assert_string_equal(info.version, sph_version());
    assert_null(info.case_text);
    sph_checkpoint_info_free(&info);
  }
  must(sim, sph_sim_step(sim), "a step");
  must(sim, sph_checkpoint_write(sim), "by hand");
  assert_true(sph_checkpoint_find(directory, 0, path, sizeof path));
  assert_non_null(strstr(path, "checkpoint_00000024.hdf"));
  assert_int_equal(count_files(directory), 3);
  sph_sim_free(sim);
  /* Wall time: each step is late. */
  sim = make(&v, 1, NULL, &m);
  clear(directory);
  sph_checkpoint_set(sim, &(sph_checkpoint_def){.directory = directory, .wall = 1e-9, .keep = 100});
  must(sim, sph_sim_run(sim, 0.0095), "run");
  assert_int_equal(count_files(directory), 10);
  sph_sim_free(sim);
}

static int set_up(void **state)
{
  (void)state;
  const char *temporary = getenv("TMPDIR");
  snprintf(root, sizeof root, "%s/sphode_checkpoint_XXXXXX", temporary ? temporary : "/tmp");
  return mkdtemp(root) ? 0 : -1;
}

static int tear_down(void **state)
{
  (void)state;
  clear(root);
  return 0;
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(which_stay), cmocka_unit_test(files),           cmocka_unit_test(each_kind),
      cmocka_unit_test(relaxed),    cmocka_unit_test(each_integrator),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
