/* sphode run: a case from its file to its pictures. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "prog.h"

typedef struct job {
  const prog_options *o;
  sph_case *c;
  sph_sim *sim;
  char directory[4000];
  int held;          /* the directory, -1: not */
  sph_balance start; /* of the fluids */
  sph_comparison *comparison;
  int comparisons;
} job;

/* --output, or the name of the case file without what is behind its last dot. */
static void name_directory(job *j)
{
  const char *slash = strrchr(j->o->what, '/'), *name = slash ? slash + 1 : j->o->what;
  const char *dot = strrchr(name, '.');
  int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
  if (j->o->output)
    snprintf(j->directory, sizeof j->directory, "%s", j->o->output);
  else
    snprintf(j->directory, sizeof j->directory, "%.*s%s", length, name, dot ? "" : ".run");
}

static int write_case(const job *j)
{
  char path[4096];
  snprintf(path, sizeof path, "%s/case.yml", j->directory);
  const char *text = sph_case_text(j->c);
  FILE *file = fopen(path, "wb");
  int bad = !file || fwrite(text, 1, strlen(text), file) != strlen(text);
  bad = (file && fclose(file)) || bad;
  return bad ? sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(errno)) : PROG_OK;
}

static int failed(const sph_error *error) { return sph_prog_error(PROG_FAILED, "%s", error->text); }

static int prepare(job *j)
{
  sph_error error = {0};
  j->c = sph_case_read(j->o->what, j->o->sets, j->o->set, &error);
  if (j->c && sph_case_check_parts(j->c, &error)) return failed(&error);
  if (j->c) j->sim = sph_case_build(j->c, j->o->threads, &error);
  if (!j->sim) return failed(&error);
  if (sph_sim_evaluate(j->sim))
    return sph_prog_error(PROG_FAILED, "%s: %s", j->o->what, sph_sim_error(j->sim));
  sph_sim_balance(j->sim, &j->start);
  name_directory(j);
  j->held = sph_prog_directory_take(j->directory, j->o->force);
  if (j->held < 0) return PROG_FAILED;
  sph_case_build_outputs(j->c, j->sim, j->directory, j->o->command);
  return write_case(j);
}

static int simulate(job *j)
{
  prog_progress progress;
  sph_prog_progress_start(&progress, j->sim, sph_case_end(j->c), j->o->quiet);
  int status = sph_sim_run(j->sim, sph_case_end(j->c));
  sph_prog_progress_end(&progress);
  if (status == SPH_OK) return PROG_OK;
  sph_prog_error(PROG_FAILED, "%s: %s", j->directory, sph_sim_error(j->sim));
  int number = status == SPH_ERR_STOPPED ? sph_prog_progress_signal() : 0;
  return number ? 128 + number : PROG_FAILED;
}

static int compare(job *j)
{
  sph_error error = {0};
  if (sph_case_compare(j->c, j->sim, j->directory, &j->comparison, &j->comparisons, &error))
    return failed(&error);
  return PROG_OK;
}

static void print_summary(const job *j)
{
  int n = sph_summary_text(NULL, 0, j->sim, &j->start, j->comparison, j->comparisons);
  char *text = n > 0 ? malloc((size_t)n + 1) : NULL;
  if (!text) return;
  sph_summary_text(text, (size_t)n + 1, j->sim, &j->start, j->comparison, j->comparisons);
  const char *title = sph_case_title(j->c);
  if (title && title[0]) printf("%s\n\n", title);
  fputs(text, stdout);
  free(text);
}

static int missed(const job *j)
{
  for (int k = 0; k < j->comparisons; k++)
    if (!isnan(j->comparison[k].bar) && !j->comparison[k].pass) return 1;
  return 0;
}

/* What is told of a run, also of one that failed or was stopped. */
static int conclude(job *j)
{
  sph_error error = {0};
  if (sph_summary_write(j->directory, j->sim, &j->start, j->comparison, j->comparisons, &error))
    return failed(&error);
  if (j->o->quiet) return PROG_OK;
  print_summary(j);
  printf("results      %s\n", j->directory);
  fflush(stdout);
  sph_prog_plot_case(j->c, j->directory, j->comparisons);
  return PROG_OK;
}

int sph_prog_run(const prog_options *o)
{
  job j = {.o = o, .held = -1};
  int status = prepare(&j);
  if (!status) {
    status = simulate(&j);
    int compared = status ? status : compare(&j), concluded = conclude(&j);
    if (!status) status = compared ? compared : concluded;
    if (!status && o->strict && missed(&j)) status = PROG_BAR;
  }
  sph_case_compare_free(j.comparison, j.comparisons);
  sph_sim_free(j.sim);
  sph_case_free(j.c);
  if (j.held >= 0) close(j.held);
  return status;
}
