/* sphode check: is a case right, and what would it cost? */
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "prog.h"

enum { STAGE = 200 };

static void print_groups(const sph_sim *sim)
{
  const sph_group *group;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    const sph_packing *p = sph_group_packing(group);
    printf("%-12s %ld %s particles%s%s", sph_group_name(group), sph_group_count(group),
           sph_group_kind(group), sph_group_eos(group) ? ", " : "",
           sph_group_eos(group) ? sph_group_eos(group)->name : "");
    if (p)
      printf(", packed in %d moves to %.2g (%s; on the lattice %.2g)", p->iterations, p->uniformity,
             p->settled ? "as wanted" : "not as even as wanted", p->before);
    putchar('\n');
  }
  printf("%-12s dim %d, dx = %.4g m, h = %.4g m (%.3g dx), %s\n", "resolution", sph_sim_dim(sim),
         sph_sim_dx(sim), sph_sim_h(sim), sph_sim_h(sim) / sph_sim_dx(sim), sph_sim_kernel(sim));
}

int sph_prog_sim_error(const sph_case *c, const sph_sim *sim, const char *what)
{
  char place[4200];
  const int known = sph_case_place(c, sph_sim_error(sim), place, sizeof place);
  return sph_prog_error(PROG_FAILED, "%s: %s", known ? place : what, sph_sim_error(sim));
}

int sph_prog_warning(const sph_case *c, const sph_sim *sim, int k, char *text, size_t size)
{
  int of_sim = 0, of_case = 0;
  if (sph_sim_warning(sim, k, text, size)) return 1;
  while (of_sim < k && sph_sim_warning(sim, of_sim, NULL, 0)) of_sim++;
  k -= of_sim;
  if (sph_case_warning(c, k, text, size)) return 1;
  while (of_case < k && sph_case_warning(c, of_case, text, size)) of_case++;
  return sph_case_warning_places(c, sim, k - of_case, text, size);
}

static int warnings(const sph_case *c, const sph_sim *sim)
{
  char text[400];
  int n = 0;
  for (; sph_prog_warning(c, sim, n, text, sizeof text); n++) printf("warning      %s\n", text);
  return n;
}

static void print_events(const sph_case *c)
{
  char text[400];
  for (int k = 0; sph_case_event_text(c, k, text, sizeof text); k++)
    printf("event        %s\n", text);
}

/* A place for the outputs of the trial, which show what is wrong with probes and monitors. */
static int make_stage(char stage[STAGE])
{
  const char *temporary = getenv("TMPDIR");
  snprintf(stage, STAGE, "%s/sphode-check-XXXXXX", temporary ? temporary : "/tmp");
  if (mkdtemp(stage)) return PROG_OK;
  sph_prog_error(PROG_FAILED, "cannot make the directory %s: %s", stage, strerror(errno));
  stage[0] = 0;
  return PROG_FAILED;
}

static void remove_stage(const char *stage)
{
  char path[STAGE + 300];
  DIR *list = *stage ? opendir(stage) : NULL;
  for (struct dirent *entry; list && (entry = readdir(list));) {
    snprintf(path, sizeof path, "%s/%s", stage, entry->d_name);
    if (entry->d_name[0] != '.') unlink(path);
  }
  if (list) closedir(list);
  if (*stage) rmdir(stage);
}

/* Of the start; what is wrong with it is told behind the report. */
static void picture(const prog_options *o, const sph_case *c, const sph_sim *sim, sph_error *error)
{
  if (o->picture && !sph_plot_geometry(sim, sph_case_title(c), o->picture, error))
    printf("%-12s %s\n", "picture", o->picture);
}

enum { STEPS = 20 };

/* Which limits the steps met: sound (cfl), viscosity, forces, errors, ... */
static void print_bounds(const sph_sim *sim, const sph_step_stats *s)
{
  const char *between = "";
  printf("%-12s ", "bound by");
  for (int k = 0; k < SPH_BOUND_COUNT; k++) {
    if (!s->bound_by[k]) continue;
    printf("%s%s %.0f %%", between, sph_sim_bound_name(sim, k),
           100. * (double)s->bound_by[k] / (double)s->steps);
    between = ", ";
  }
  putchar('\n');
}

/* A few steps tell the step size and the speed of this machine.  The first one does not count: it
 * builds lists and warms caches. */
static int estimate(sph_sim *sim, double end)
{
  sph_sim_stats s = {0};
  double begin = 0;
  int status = sph_sim_run(sim, sph_sim_time(sim)); /* first frames, which find what is wrong */
  for (int k = 0; k <= STEPS && !status && sph_sim_time(sim) < end; k++) {
    status = sph_sim_step(sim);
    if (k == 0) begin = sph_prog_progress_now();
  }
  if (status) return status;
  const double seconds = sph_prog_progress_now() - begin;
  sph_sim_get_stats(sim, &s);
  const double steps = ceil(end / s.step.dt_largest),
               one = seconds / fmax(1, (double)s.step.steps - 1);
  printf("%-12s about %.3g steps of %.3g s to t = %.4g s (%s)\n", "steps", steps, s.step.dt_largest,
         end, sph_sim_integrator(sim));
  print_bounds(sim, &s.step);
  printf("%-12s about %.2g s on this machine with %d thread%s, %.3g MB\n", "time", steps * one,
         sph_sim_threads(sim), sph_sim_threads(sim) == 1 ? "" : "s", 1e-6 * s.bytes);
  return SPH_OK;
}

/* The simulation at its start, then a few steps with its outputs. */
static int try_out(const prog_options *o, const sph_case *c, sph_sim *sim, const char *stage,
                   sph_error *drawing, sph_error *error)
{
  if (*sph_case_title(c)) printf("%s\n\n", sph_case_title(c));
  print_groups(sim);
  print_events(c);
  int n = warnings(c, sim);
  picture(o, c, sim, drawing);
  int status = sph_case_plot_check(c, sim, error);
  if (status) return status;
  sph_case_build_output_trial(c, sim, stage);
  status = sph_sim_status(sim);
  if (!status) status = estimate(sim, sph_case_end(c));
  if (!status) status = sph_case_compare_check(c, sim, stage, error);
  if (!status) status = sph_prog_sizes(c, sim, stage, &n, error);
  if (!status) printf("%-12s right, %d warning%s\n", "the case", n, n == 1 ? "" : "s");
  return status;
}

int sph_prog_check(const prog_options *o)
{
  char stage[STAGE] = "";
  sph_error error = {0}, drawing = {0}; /* of the picture, which the rest does not need */
  sph_case *c = sph_case_read(o->what, o->sets, o->set, &error);
  int right = c && !sph_case_check_parts(c, &error);
  sph_sim *sim = right ? sph_case_build(c, o->threads, &error) : NULL;
  int status = sim ? sph_sim_evaluate(sim) : error.status, told = 0;
  if (!status) told = status = make_stage(stage);
  if (!status) status = try_out(o, c, sim, stage, &drawing, &error);
  remove_stage(stage);
  fflush(stdout);
  if (error.status)
    sph_prog_error(PROG_FAILED, "%s", error.text);
  else if (status && !told && status != PROG_FAILED)
    sph_prog_sim_error(c, sim, o->what);
  if (drawing.status)
    status = sph_prog_error(PROG_FAILED, "no picture: %s (exit status 1)", drawing.text);
  sph_sim_free(sim);
  sph_case_free(c);
  return status ? PROG_FAILED : PROG_OK;
}
