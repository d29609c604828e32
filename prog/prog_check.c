/* sphode check: is a case right, and what would it cost? */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "prog.h"

static void print_groups(const sph_sim *sim)
{
  const sph_group *group;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    printf("%-12s %ld %s particles%s%s\n", sph_group_name(group), sph_group_count(group),
           sph_group_kind(group), sph_group_eos(group) ? ", " : "",
           sph_group_eos(group) ? sph_group_eos(group)->name : "");
  printf("%-12s dim %d, dx = %.4g m, h = %.4g m (%.3g dx), %s\n", "resolution", sph_sim_dim(sim),
         sph_sim_dx(sim), sph_sim_h(sim), sph_sim_h(sim) / sph_sim_dx(sim), sph_sim_kernel(sim));
}

static int warnings(const sph_sim *sim)
{
  char text[300];
  int n = 0;
  for (; sph_sim_warning(sim, n, text, sizeof text); n++) printf("warning      %s\n", text);
  return n;
}

enum { STEPS = 20 };

typedef struct trial {
  double begin;       /* wall time after the first step [s]: it builds lists and warms caches */
  double one;         /* wall time of a step after it [s] */
  sph_sim_stats last; /* after as many */
} trial;

static int after_step(void *ctx, sph_sim *sim)
{
  trial *t = ctx;
  sph_sim_get_stats(sim, &t->last);
  long more = t->last.step.steps - 1;
  if (more == 0) t->begin = sph_prog_progress_now();
  if (more > 0) t->one = (sph_prog_progress_now() - t->begin) / (double)more;
  return more >= STEPS;
}

/* A few steps tell the step size and the speed of this machine; nothing is written. */
static int estimate(sph_sim *sim, double end)
{
  trial t = {0};
  sph_sim_set_progress(sim, after_step, &t);
  int status = sph_sim_run(sim, end);
  if (status && status != SPH_ERR_STOPPED) return status;
  double steps = ceil(end / t.last.step.dt_largest);
  printf("%-12s about %.3g steps of %.3g s to t = %.4g s (%s)\n", "steps", steps,
         t.last.step.dt_largest, end, sph_sim_integrator(sim));
  printf("%-12s about %.2g s on this machine with %d thread%s, %.3g MB\n", "time", steps * t.one,
         sph_sim_threads(sim), sph_sim_threads(sim) == 1 ? "" : "s", 1e-6 * t.last.bytes);
  return SPH_OK;
}

int sph_prog_check(const prog_options *o)
{
  sph_error error = {0};
  sph_case *c = sph_case_read(o->what, o->sets, o->set, &error);
  int right = c && !sph_case_check_parts(c, &error);
  sph_sim *sim = right ? sph_case_build(c, o->threads, &error) : NULL;
  int status = sim ? sph_sim_evaluate(sim) : error.status;
  if (!status) {
    printf("%s\n\n", sph_case_title(c));
    print_groups(sim);
    int n = warnings(sim);
    status = estimate(sim, sph_case_end(c));
    if (!status) printf("%-12s right, %d warning%s\n", "the case", n, n == 1 ? "" : "s");
  }
  if (error.status)
    sph_prog_error(PROG_FAILED, "%s", error.text);
  else if (status)
    sph_prog_error(PROG_FAILED, "%s: %s", o->what, sph_sim_error(sim));
  sph_sim_free(sim);
  sph_case_free(c);
  return status ? PROG_FAILED : PROG_OK;
}
