/* sphode run: a case from its file to its pictures. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "prog_job.h"
#include "prog_live.h"

/* --output, or the name of the case file without what is behind its last dot. */
static void name_directory(prog_job *j)
{
  const char *slash = strrchr(j->o->what, '/'), *name = slash ? slash + 1 : j->o->what;
  const char *dot = strrchr(name, '.');
  int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
  if (j->o->output)
    snprintf(j->directory, sizeof j->directory, "%s", j->o->output);
  else
    snprintf(j->directory, sizeof j->directory, "%.*s%s", length, name, dot ? "" : ".run");
}

static int failed(const sph_error *error) { return sph_prog_error(PROG_FAILED, "%s", error->text); }

/* case.yml.  Under another name first: a run that goes on may find no space, and the old one is to
 * stay. */
static int write_case(const prog_job *j, const char *text)
{
  char path[4096], part[4100];
  snprintf(path, sizeof path, "%s/case.yml", j->directory);
  snprintf(part, sizeof part, "%s.tmp", path);
  FILE *file = fopen(part, "wb");
  int bad = !file || fwrite(text, 1, strlen(text), file) != strlen(text);
  bad = (file && fclose(file)) || bad || rename(part, path);
  if (bad && file) {
    const int why = errno;
    unlink(part);
    errno = why;
  }
  return bad ? sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(errno)) : PROG_OK;
}

/* The case.yml that is there; NULL: none. */
static char *read_case(const prog_job *j)
{
  char path[4096];
  long size = -1;
  snprintf(path, sizeof path, "%s/case.yml", j->directory);
  FILE *file = fopen(path, "rb");
  if (file && !fseek(file, 0, SEEK_END)) size = ftell(file);
  char *text = size >= 0 ? malloc((size_t)size + 1) : NULL;
  if (text) {
    rewind(file);
    text[fread(text, 1, (size_t)size, file)] = 0;
  }
  if (file) fclose(file);
  return text;
}

int sph_prog_run_keep(prog_job *j)
{
  sph_error error = {0};
  if (sph_case_files_keep(j->c, j->directory, &error)) return failed(&error);
  j->before = read_case(j);
  return write_case(j, sph_case_text(j->c));
}

/* Drifts are told from the start of the run, whichever part of it goes on now. */
static int keep_start(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  sph_balance *b = ctx;
  (void)sim, (void)error;
  sph_keep_real(keep, "mass", 1, &b->mass);
  sph_keep_real(keep, "momentum", 3, b->momentum);
  sph_keep_real(keep, "angular_momentum", 3, b->angular_momentum);
  sph_keep_real(keep, "kinetic", 1, &b->kinetic);
  sph_keep_real(keep, "internal", 1, &b->internal);
  sph_keep_real(keep, "potential", 1, &b->potential);
  return sph_keep_real(keep, "total", 1, &b->total);
}

int sph_prog_run_build(prog_job *j)
{
  sph_error error = {0};
  if (sph_case_check_parts(j->c, &error)) return failed(&error);
  j->sim = sph_case_build(j->c, j->o->threads, &error);
  if (!j->sim) return failed(&error);
  if (sph_sim_evaluate(j->sim)) return sph_prog_sim_error(j->c, j->sim, j->o->what);
  if (sph_case_plot_check(j->c, j->sim, &error)) return failed(&error);
  sph_sim_balance(j->sim, &j->start);
  sph_sim_keep_add(j->sim, (sph_kept){.name = "balance", .keep = keep_start, .ctx = &j->start});
  return PROG_OK;
}

void sph_prog_run_outputs(prog_job *j)
{
  sph_case_build_outputs(j->c, j->sim, j->directory, j->command);
  sph_case_build_checkpoints(j->c, j->sim, j->directory, j->command);
}

int sph_prog_run_listen(prog_job *j)
{
  if (!j->o->live) return PROG_OK;
  j->page = sph_prog_live_start(j->o->port, j->directory);
  return j->page ? PROG_OK : PROG_FAILED;
}

/* What sphode check would say. */
static void warn(const prog_job *j)
{
  char text[400];
  for (int k = 0; !j->o->quiet && sph_prog_warning(j->c, j->sim, k, text, sizeof text); k++)
    sph_prog_error(PROG_OK, "warning: %s", text);
  if (!j->o->quiet) sph_prog_sizes_warn(j->c, j->sim, j->directory);
}

static int prepare(prog_job *j)
{
  sph_error error = {0};
  j->c = sph_case_read(j->o->what, j->o->sets, j->o->set, &error);
  if (!j->c) return failed(&error);
  int status = sph_prog_run_build(j);
  if (status) return status;
  name_directory(j);
  status = sph_prog_run_listen(j);
  if (status) return status;
  j->end = sph_case_end(j->c);
  j->held = sph_prog_directory_take(j->directory, j->o->force);
  if (j->held < 0) return PROG_FAILED;
  warn(j);
  sph_prog_run_outputs(j);
  return sph_prog_run_keep(j);
}

/* A run that failed or was stopped: where does it go on? */
static void tell_checkpoint(const prog_job *j)
{
  char path[4096];
  sph_checkpoint_info info;
  if (!sph_checkpoint_find(j->directory, 0, path, sizeof path)) {
    sph_prog_error(PROG_OK,
                   "%s holds no checkpoint yet, so that sphode run begins again; --set "
                   "checkpoint.wall=60s writes one each minute",
                   j->directory);
    return;
  }
  if (sph_checkpoint_info_read(path, &info, NULL)) return;
  sph_prog_error(PROG_OK, "sphode restart %s goes on from t = %.6g s, step %ld", j->directory,
                 info.time, info.step);
  sph_checkpoint_info_free(&info);
}

/* A step that failed: what is around the particle at which it did. */
static void tell_failure(const prog_job *j)
{
  char path[4096];
  sph_error error = {0};
  snprintf(path, sizeof path, "%s/failure.csv", j->directory);
  if (sph_failure_write(j->sim, path, &error))
    sph_prog_error(PROG_OK, "%s", error.text);
  else
    sph_prog_error(PROG_OK,
                   "%s: the particles around it, and what each term does to them; sphode plot %s "
                   "shows the snapshots up to the last good state",
                   path, j->directory);
}

static int simulate(prog_job *j)
{
  prog_progress progress;
  const double limit = sph_case_time_limit(j->c);
  sph_prog_progress_start(&progress, j->sim, j->end, j->o->quiet);
  if (limit > 0) progress.limit = progress.start + limit;
  progress.page = j->page;
  const double from = sph_sim_time(j->sim);
  int status = sph_sim_run(j->sim, j->end);
  sph_prog_live_end(j->page);
  j->page = NULL;
  sph_prog_progress_end(&progress);
  if (status == SPH_OK) return PROG_OK;
  const int begun = sph_sim_time(j->sim) > from || status != SPH_ERR_ARGUMENT;
  if (!begun) { /* an output cannot be opened */
    sph_prog_sim_error(j->c, j->sim, j->directory);
    if (j->before) write_case(j, j->before);
  } else
    sph_prog_error(PROG_FAILED, "%s: %s", j->directory, sph_sim_error(j->sim));
  if (status == SPH_ERR_STEP) tell_failure(j);
  if (begun) tell_checkpoint(j);
  if (status != SPH_ERR_STOPPED) return PROG_FAILED;
  int number = sph_prog_progress_signal();
  return number ? 128 + number : sph_prog_progress_over(&progress) ? PROG_LIMIT : PROG_FAILED;
}

static int compare(prog_job *j)
{
  sph_error error = {0};
  if (sph_case_compare(j->c, j->sim, j->directory, &j->comparison, &j->comparisons, &error))
    return failed(&error);
  return PROG_OK;
}

static void print_summary(const prog_job *j)
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

/* An exit status: what is judged must pass. */
static int judge(const prog_job *j)
{
  int missed = 0;
  for (int k = 0; k < j->comparisons; k++)
    missed += !isnan(j->comparison[k].bar) && !j->comparison[k].pass;
  if (!missed || j->o->lenient) return PROG_OK;
  return sph_prog_error(PROG_BAR,
                        "%s: %d of %d comparisons %s its bar (exit status 3; --lenient: 0)",
                        j->directory, missed, j->comparisons, missed == 1 ? "misses" : "miss");
}

/* What is told of a run, also of one that failed or was stopped. */
static int conclude(prog_job *j)
{
  sph_error error = {0};
  if (sph_summary_write(j->directory, j->sim, &j->start, j->comparison, j->comparisons, &error))
    return failed(&error);
  if (j->o->quiet) return PROG_OK;
  print_summary(j);
  printf("results      %s\n", j->directory);
  fflush(stdout);
  sph_prog_progress_release(); /* pictures can be drawn again */
  sph_prog_plot_case(j->c, j->directory, j->comparisons);
  return PROG_OK;
}

int sph_prog_run_finish(prog_job *j, int status)
{
  if (!status) {
    status = simulate(j);
    int compared = status ? status : compare(j), concluded = conclude(j);
    if (!status) status = compared ? compared : concluded;
    if (!status) status = judge(j);
  }
  sph_prog_live_end(j->page);
  sph_case_compare_free(j->comparison, j->comparisons);
  sph_sim_free(j->sim);
  sph_case_free(j->c);
  free(j->before);
  if (j->held >= 0) close(j->held);
  return status;
}

int sph_prog_run(const prog_options *o)
{
  prog_job j = {.o = o, .command = o->command, .held = -1};
  return sph_prog_run_finish(&j, prepare(&j));
}
