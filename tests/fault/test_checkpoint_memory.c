/* Checkpoints in trouble: each allocation fails once, each byte is damaged once, files are cut
 * short, the disk is full, nothing is given: told, nothing half written, nothing leaks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "failing.h"
#include "sphode.h"

static char directory[200], path[300];

static sph_sim *make(int n)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 1.0 / n});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_linear(1000, 100, -INFINITY));
  sph_group_set_viscosity(water, 1);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -1, 0}));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "imex:ark324l2sa-4-2-3"});
  sph_sim_add_output(sim, sph_output_hdf5(directory, 1e-3));
  sph_sim_add_output(sim, sph_output_series(directory, 1e-3, NULL, 0));
  sph_sim_add_output(sim, sph_output_events(directory));
  sph_sim_add_event(sim, &(sph_event){.name = "then", .type = "time", .threshold = 1e-3});
  return sim;
}

static sph_checkpoint_def def(void)
{
  static const char *const set[] = {"a=1", "b=2"};
  return (sph_checkpoint_def){.directory = directory,
                              .case_path = "case.yml",
                              .case_text = "a: 1\n",
                              .sets = 2,
                              .set = set};
}

static int write_one(sph_error *error)
{
  sph_sim *sim = make(6);
  int status = sph_sim_run(sim, 2e-3);
  const sph_checkpoint_def d = def();
  if (!status) sph_checkpoint_set(sim, &d);
  if (!status) status = sph_checkpoint_write(sim);
  if (sph_sim_status(sim)) sph_error_set(error, sph_sim_status(sim), "%s", sph_sim_error(sim));
  sph_sim_free(sim);
  return sph_error_set(error, status, "out of memory: the simulation");
}

static int read_one(sph_error *error)
{
  sph_sim *sim = make(6);
  sph_checkpoint_read(sim, path);
  int status = sph_sim_run(sim, 3e-3);
  sph_error_set(error, status, "%s", sph_sim_error(sim));
  sph_sim_free(sim);
  return status;
}

static int tell_one(sph_error *error)
{
  sph_checkpoint_info info;
  int status = sph_checkpoint_info_read(path, &info, error);
  if (status) return status;
  assert_string_equal(info.case_text, "a: 1\n");
  assert_string_equal(info.case_path, "case.yml");
  assert_int_equal(info.sets, 2);
  assert_string_equal(info.set[1], "b=2");
  sph_checkpoint_info_free(&info);
  return SPH_OK;
}

static void each_allocation_fails(int (*what)(sph_error *error), long from)
{
  long fails = 0;
  for (fail_at = from; fail_at < 100000; fail_at++) {
    sph_error error = {0};
    calls = 0;
    int status = what(&error);
    if (calls < fail_at) {
      assert_int_equal(status, SPH_OK);
      break;
    }
    fails++;
    if (status != SPH_ERR_MEMORY)
      fail_msg("allocation %ld: status %d, %s", fail_at, status, error.text);
    assert_true(strlen(error.text) > 5);
  }
  assert_true(fails > 3);
  fail_at = 0;
}

/* Allocations that what() makes before the part that is looked at here. */
static long allocations_of_a_run(void)
{
  sph_sim *sim = make(6);
  calls = 0;
  fail_at = 0;
  assert_int_equal(sph_sim_run(sim, 2e-3), SPH_OK);
  sph_sim_free(sim);
  return calls;
}

static void memory(void **state)
{
  (void)state;
  sph_error error = {0};
  const long before = allocations_of_a_run();
  assert_int_equal(write_one(&error), SPH_OK);
  assert_true(sph_checkpoint_find(directory, 0, path, sizeof path));
  each_allocation_fails(write_one, before);
  each_allocation_fails(tell_one, 1);
  each_allocation_fails(read_one, 1);
  each_allocation_fails(tell_one, 1); /* it is whole yet */
}

/* ---- damage ---- */

static unsigned char *load(long *size)
{
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  *size = ftell(file);
  rewind(file);
  unsigned char *data = malloc((size_t)*size);
  assert_non_null(data);
  assert_int_equal(fread(data, 1, (size_t)*size, file), *size);
  fclose(file);
  return data;
}

static void store(const char *to, const unsigned char *data, long size)
{
  FILE *file = fopen(to, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(data, 1, (size_t)size, file), size);
  fclose(file);
}

static void refused(const char *file, const char *why)
{
  sph_checkpoint_info info;
  sph_error error = {0};
  assert_int_equal(sph_checkpoint_info_read(file, &info, &error), SPH_ERR_FILE);
  assert_non_null(strstr(error.text, file));
  if (!strstr(error.text, why)) fail_msg("\"%s\" says not \"%s\"", error.text, why);
}

static void damage(void **state)
{
  (void)state;
  sph_error error = {0};
  char hurt[320];
  long size;
  assert_int_equal(write_one(&error), SPH_OK);
  assert_true(sph_checkpoint_find(directory, 0, path, sizeof path));
  unsigned char *data = load(&size);
  snprintf(hurt, sizeof hurt, "%s/hurt", directory);
  store(hurt, data, size);
  FILE *file = fopen(hurt, "r+b");
  assert_non_null(file);
  setbuf(file, NULL);
  for (long i = 0; i < size; i += i < 2000 ? 1 : 61) {
    fseek(file, i, SEEK_SET);
    fputc(data[i] ^ (1 << i % 8), file);
    refused(hurt, i < 512 ? "" : "its checksum is wrong: it is damaged");
    fseek(file, i, SEEK_SET);
    fputc(data[i], file);
  }
  fclose(file);
  for (long n = 0; n < size; n += n < 600 ? 1 : 997) {
    store(hurt, data, n);
    refused(hurt, n < 512 ? "" : "it was cut short");
  }
  store(hurt, data, size);
  file = fopen(hurt, "ab");
  assert_non_null(file);
  fputc('x', file);
  fclose(file);
  refused(hurt, "it was cut short");
  data[25] = '2';
  store(hurt, data, size);
  refused(hurt, "it is of format 2; this sphode");
  unlink(hurt);
  refused(hurt, "No such file");
  refused(directory, "");
  free(data);
}

/* ---- another simulation ---- */

static void another(void **state)
{
  (void)state;
  sph_error error = {0};
  assert_int_equal(write_one(&error), SPH_OK);
  assert_true(sph_checkpoint_find(directory, 0, path, sizeof path));
  sph_sim *sim = make(7);
  assert_int_equal(sph_checkpoint_read(sim, path), SPH_ERR_FILE);
  assert_non_null(strstr(sph_sim_error(sim), "another simulation"));
  assert_non_null(strstr(sph_sim_error(sim), "particles is 36 there, 49 here"));
  sph_sim_free(sim);
  sim = make(6);
  sph_sim_add_term(sim, sph_term_harmonic(1));
  assert_int_equal(sph_checkpoint_read(sim, path), SPH_ERR_FILE);
  assert_non_null(strstr(sph_sim_error(sim), "another simulation"));
  sph_sim_free(sim);
}

/* ---- no space ---- */

static void full_disk(void **state)
{
  (void)state;
  char temporary[320];
  sph_sim *sim = make(6);
  const sph_checkpoint_def d = def();
  sph_checkpoint_set(sim, &d);
  assert_int_equal(sph_sim_run(sim, 2e-3), SPH_OK);
  assert_true(sph_checkpoint_find(directory, 0, path, sizeof path));
  assert_int_equal(sph_sim_step(sim), SPH_OK);
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  snprintf(temporary, sizeof temporary, "%s/checkpoint_%08ld.hdf.tmp", directory, stats.step.steps);
  assert_int_equal(symlink("/dev/full", temporary), 0);
  assert_int_equal(sph_checkpoint_write(sim), SPH_ERR_FILE);
  assert_non_null(strstr(sph_sim_error(sim), "No space left on device"));
  assert_int_not_equal(access(temporary, F_OK), 0);
  sph_sim_free(sim);
  sph_error error = {0};
  assert_int_equal(tell_one(&error), SPH_OK); /* the one before is whole */
}

static int keep_nothing(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  (void)ctx, (void)sim, (void)keep, (void)error;
  return SPH_OK;
}

static int keep_wrong(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  (void)ctx, (void)sim, (void)error;
  return sph_keep_real(keep, "x", 3, NULL);
}

static void refused_def(sph_checkpoint_def wrong, const char *why)
{
  sph_sim *sim = make(6);
  sph_checkpoint_set(sim, &wrong);
  assert_int_equal(sph_sim_status(sim), SPH_ERR_ARGUMENT);
  if (!strstr(sph_sim_error(sim), why)) fail_msg("%s", sph_sim_error(sim));
  sph_sim_free(sim);
}

static void nothing(void **state)
{
  (void)state;
  sph_error error = {0};
  sph_checkpoint_info info;
  sph_checkpoint_set(NULL, NULL);
  assert_int_not_equal(sph_checkpoint_write(NULL), SPH_OK);
  assert_int_not_equal(sph_checkpoint_read(NULL, "x"), SPH_OK);
  assert_int_equal(sph_checkpoint_info_read(NULL, &info, &error), SPH_ERR_FILE);
  assert_int_equal(sph_checkpoint_info_read("x", NULL, NULL), SPH_ERR_ARGUMENT);
  sph_checkpoint_info_free(NULL);
  assert_int_equal(sph_checkpoint_find(NULL, 0, NULL, 0), 0);
  assert_int_equal(sph_checkpoint_find(directory, -1, NULL, 0), 0);
  assert_int_equal(sph_keep_reading(NULL), 0);
  assert_int_equal(sph_keep_has(NULL, "x"), 0);
  assert_int_not_equal(sph_keep_real(NULL, "x", 0, NULL), SPH_OK);
  assert_int_not_equal(sph_keep_integer(NULL, NULL, 1, NULL), SPH_OK);
  sph_sim_keep_add(NULL, (sph_kept){0});
  sph_checkpoint_def d = def();
  d.directory = NULL;
  refused_def(d, "no directory");
  d = def();
  d.steps = -1;
  refused_def(d, "0 or more");
  d = def();
  d.interval = NAN;
  refused_def(d, "interval");
  d = def();
  d.wall = -1;
  refused_def(d, "wall");
  d = def();
  d.set = NULL;
  refused_def(d, "settings at NULL");
  sph_sim *sim = make(6);
  assert_int_equal(sph_checkpoint_write(sim), SPH_ERR_STATE);
  sph_sim_free(sim);
  static const char *const bad[] = {NULL, "", "a/b", "twice"};
  for (int k = 0; k < 4; k++) {
    sim = make(6);
    sph_sim_keep_add(sim, (sph_kept){.name = "twice", .keep = keep_nothing});
    sph_sim_keep_add(sim, (sph_kept){.name = bad[k], .keep = keep_nothing});
    assert_int_equal(sph_sim_status(sim), SPH_ERR_ARGUMENT);
    sph_sim_free(sim);
  }
  sim = make(6);
  d = def();
  sph_sim_keep_add(sim, (sph_kept){.name = "wrong", .keep = keep_wrong});
  sph_checkpoint_set(sim, &d);
  assert_int_equal(sph_sim_run(sim, 1e-3), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "3 values of \"x\" at NULL"));
  sph_sim_free(sim);
}

static int set_up(void **state)
{
  (void)state;
  const char *temporary = getenv("TMPDIR");
  snprintf(directory, sizeof directory, "%s/sphode_checkpoint_XXXXXX",
           temporary ? temporary : "/tmp");
  return mkdtemp(directory) ? 0 : -1;
}

static int tear_down(void **state)
{
  char command[300];
  (void)state;
  snprintf(command, sizeof command, "rm -rf '%s'", directory);
  return system(command);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nothing),   cmocka_unit_test(another), cmocka_unit_test(damage),
      cmocka_unit_test(full_disk), cmocka_unit_test(memory),
  };
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
