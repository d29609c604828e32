/* NULL at the doors of case files, outputs, summaries and pictures: a status and a reason that
 * tells what was missing, or a harmless empty value; never a crash. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "sphode.h"

static const char text[] = "dimension: 2\n"
                           "spacing: 0.1\n"
                           "groups:\n"
                           "  water:\n"
                           "    kind: fluid\n"
                           "    density: 1000\n"
                           "    eos: {linear: {sound_speed: 10}}\n"
                           "    shapes: [{box: {lower: [0, 0], upper: [1, 1]}}]\n"
                           "terms: {pressure: }\n"
                           "run: {end: 1}\n";

static sph_case *read_case(void)
{
  sph_error error = {0};
  sph_case *c = sph_case_read_text("case.yml", text, strlen(text), 0, NULL, &error);
  if (!c) fail_msg("%s", error.text);
  return c;
}

static sph_sim *make(void)
{
  sph_case *c = read_case();
  sph_sim *sim = sph_case_build(c, 1, NULL);
  sph_case_free(c);
  assert_non_null(sim);
  return sim;
}

/* This error is told, once. */
static void told(sph_error *error, int status, const char *part)
{
  if (error->status != SPH_ERR_ARGUMENT || status != SPH_ERR_ARGUMENT)
    fail_msg("status %d and %d, \"%s\"", status, error->status, error->text);
  if (!strstr(error->text, part)) fail_msg("\"%s\" does not tell \"%s\"", error->text, part);
  *error = (sph_error){0};
}

static void reading(void **state)
{
  static const char *const none[] = {NULL};
  sph_error e = {0};
  (void)state;
  assert_null(sph_case_read(NULL, 0, NULL, &e));
  told(&e, e.status, "no path (NULL)");
  assert_null(sph_case_read_text(NULL, NULL, 0, 0, NULL, &e));
  told(&e, e.status, "no path (NULL)");
  assert_null(sph_case_read_text("x", NULL, 10, 0, NULL, &e));
  told(&e, e.status, "x: no text (NULL)");
  assert_null(sph_case_read_text("x", text, strlen(text), 2, NULL, &e));
  told(&e, e.status, "x: 2 settings at NULL");
  assert_null(sph_case_read_text("x", text, strlen(text), 1, none, &e));
  told(&e, e.status, "x: setting 0 is NULL");
  assert_null(sph_case_read_text("x", text, strlen(text), -1, none, &e));
  told(&e, e.status, "x: -1 settings");
  assert_null(sph_case_read(NULL, 0, NULL, NULL));
  assert_null(sph_case_read_text(NULL, NULL, 0, 0, NULL, NULL));
}

static void no_case(void **state)
{
  sph_error e = {0};
  sph_comparison *list;
  int n = 7;
  char png[100];
  (void)state;
  assert_null(sph_case_build(NULL, 1, &e));
  told(&e, e.status, "no case (NULL)");
  assert_null(sph_case_build(NULL, 1, NULL));
  assert_int_equal(sph_case_check_parts(NULL, NULL), SPH_ERR_ARGUMENT);
  told(&e, sph_case_compare(NULL, NULL, NULL, &list, &n, &e), "no case (NULL)");
  assert_true(list == NULL && n == 0);
  told(&e, sph_case_compare_plot(NULL, 0, "d", png, sizeof png, &e), "no case (NULL)");
  assert_string_equal(sph_case_title(NULL), "");
  assert_string_equal(sph_case_text(NULL), "");
  assert_string_equal(sph_case_plot_field(NULL), "");
  assert_int_equal(sph_case_plot_frames(NULL), 0);
  assert_true(sph_case_end(NULL) == 0);
  sph_case_free(NULL);
  sph_case_compare_free(NULL, 3);
  sph_sim *sim = make();
  sph_case_build_outputs(NULL, sim, "d", NULL);
  assert_int_equal(sph_sim_status(sim), SPH_ERR_ARGUMENT);
  assert_non_null(strstr(sph_sim_error(sim), "no case (NULL)"));
  sph_sim_free(sim);
  sph_case_build_outputs(NULL, NULL, NULL, NULL);
  sph_case_size size;
  told(&e, sph_case_size_get(NULL, NULL, NULL, 0, &size, &e), "no case (NULL)");
  told(&e, sph_case_plot_check(NULL, NULL, &e), "no case (NULL)");
  told(&e, sph_case_restart_check(NULL, NULL, &e), "no case (NULL)");
  assert_int_equal(sph_case_warning_places(NULL, NULL, 0, png, sizeof png), 0);
  assert_int_equal(sph_case_place(NULL, "probe a:", png, sizeof png), 0);
  told(&e, (int)sph_output_hdf5_size(NULL, NULL, &e), "no simulation (NULL)");
  assert_true(sph_checkpoint_size(NULL) < 0);
  sim = make();
  assert_int_equal(sph_checkpoint_size(sim), SPH_ERR_STATE);
  assert_non_null(
      strstr(sph_sim_error(sim), "sph_checkpoint_size: sph_checkpoint_set comes first"));
  sph_sim_free(sim);
  sph_sim_set_stop(NULL, "x");
  assert_string_equal(sph_sim_bound_name(NULL, SPH_BOUND_USER), "dt_max");
}

/* What failed to be read tells its own reason at the end of the chain. */
static void the_first_reason_stays(void **state)
{
  sph_error e = {0};
  (void)state;
  sph_case *c = sph_case_read("no/such.yml", 0, NULL, &e);
  sph_sim *sim = sph_case_build(c, 1, &e);
  sph_case_build_outputs(c, sim, "d", NULL);
  assert_true(sph_sim_run(sim, sph_case_end(c)) < 0);
  assert_int_equal(e.status, SPH_ERR_FILE);
  assert_string_equal(e.text, "no/such.yml: cannot open: No such file or directory");
}

static void a_case_and_nothing_else(void **state)
{
  sph_error e = {0};
  sph_comparison *list = NULL;
  int n = 7;
  (void)state;
  sph_case *c = read_case();
  told(&e, sph_case_compare(c, NULL, "d", NULL, NULL, &e), "no place for the list");
  told(&e, sph_case_compare(c, NULL, "d", NULL, &n, &e), "no place for the list");
  told(&e, sph_case_compare(c, NULL, "d", &list, NULL, &e), "no place for its length");
  assert_int_equal(sph_case_compare(c, NULL, NULL, &list, &n, &e), SPH_OK); /* it has none */
  sph_case_compare_free(list, n);
  told(&e, sph_case_compare_plot(c, 0, "d", NULL, 9, &e), "no place for its path");
  sph_case_build_outputs(c, NULL, NULL, NULL);
  sph_case_free(c);
  assert_true(sph_case_manual(NULL, 9) > 1000);
}

static void monitors(void **state)
{
  static const sph_monitor front = {.name = "front", .type = "front"};
  sph_error e = {0};
  double value = 7;
  (void)state;
  sph_sim *sim = make();
  told(&e, sph_monitor_value(NULL, sim, &value, &e), "no monitor (NULL)");
  told(&e, sph_monitor_value(&front, NULL, &value, &e), "no simulation (NULL)");
  told(&e, sph_monitor_value(&front, sim, NULL, &e), "front: no place for its value");
  told(&e, sph_monitor_value(&(sph_monitor){.type = "front"}, sim, &value, &e), "monitor name");
  told(&e, sph_monitor_value(&(sph_monitor){.name = "front"}, sim, &value, &e), "type");
  assert_true(value == 7);
  assert_int_equal(sph_monitor_value(NULL, NULL, NULL, NULL), SPH_ERR_ARGUMENT);
  assert_null(sph_monitor_unit(NULL));
  sph_sim_free(sim);
}

/* The run refuses the output before its first step, and makes no file. */
static void refused_output(sph_output output, const char *part)
{
  sph_sim *sim = make();
  sph_sim_add_output(sim, output);
  assert_int_equal(sph_sim_run(sim, 1), SPH_ERR_ARGUMENT);
  if (!strstr(sph_sim_error(sim), part))
    fail_msg("\"%s\" does not tell \"%s\"", sph_sim_error(sim), part);
  assert_true(sph_sim_time(sim) == 0);
  sph_sim_free(sim);
}

static void outputs(void **state)
{
  (void)state;
  refused_output(sph_output_series("d", 1, NULL, 3), "3 monitors at NULL");
  refused_output(sph_output_series(NULL, 1, NULL, 0), "no directory");
  refused_output(sph_output_hdf5_def(NULL), "without a definition (NULL)");
  refused_output(sph_output_hdf5(NULL, 1), "no directory");
}

static void summaries(void **state)
{
  sph_error e = {0};
  (void)state;
  sph_sim *sim = make();
  told(&e, sph_summary_write("d", NULL, NULL, NULL, 0, &e), "needs a simulation");
  told(&e, sph_summary_write("d", sim, NULL, NULL, 3, &e), "3 comparisons at NULL");
  told(&e, sph_summary_write(NULL, sim, NULL, NULL, 0, &e), "no directory");
  assert_int_equal(sph_summary_text(NULL, 0, NULL, NULL, NULL, 0), SPH_ERR_ARGUMENT);
  assert_int_equal(sph_summary_text(NULL, 0, sim, NULL, NULL, 3), SPH_ERR_ARGUMENT);
  assert_true(sph_summary_text(NULL, 9, sim, NULL, NULL, 0) > 100);
  sph_sim_free(sim);
}

static void pictures(void **state)
{
  static const sph_plot_curve nothing;
  sph_error e = {0};
  (void)state;
  told(&e, sph_plot_series(NULL, 2, NULL, "x.png", &e), "2 curves to draw at NULL");
  told(&e, sph_plot_series(&nothing, 1, NULL, NULL, &e), "x.png is right");
  assert_int_equal(sph_plot_series(&nothing, 1, NULL, "x.png", NULL), SPH_ERR_FILE);
  told(&e, sph_plot_particles(NULL, NULL, NULL, &e), "no path (NULL)");
  assert_true(sph_plot_frames(NULL, NULL, 1, NULL, NULL) < 0);
  assert_true(sph_plot_count(NULL, NULL) < 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reading),
      cmocka_unit_test(no_case),
      cmocka_unit_test(the_first_reason_stays),
      cmocka_unit_test(a_case_and_nothing_else),
      cmocka_unit_test(monitors),
      cmocka_unit_test(outputs),
      cmocka_unit_test(summaries),
      cmocka_unit_test(pictures),
  };
  return cmocka_run_group_tests_name("NULL to cases and outputs", tests, NULL, NULL);
}
