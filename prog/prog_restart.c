/* sphode restart: a run goes on from its last good checkpoint. */
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "prog_job.h"

static void forget(prog_job *j)
{
  sph_sim_free(j->sim);
  sph_case_free(j->c);
  j->sim = NULL;
  j->c = NULL;
}

/* The case of the checkpoint with the first `sets` that are set now besides; with `last`, too. */
static sph_case *case_of(const prog_job *j, const sph_checkpoint_info *info, int sets,
                         const char *last, sph_error *error)
{
  const char *set[2 * PROG_SETS + 1];
  int n = 0;
  for (int k = 0; k < info->sets && n < PROG_SETS; k++) set[n++] = info->set[k];
  for (int k = 0; k < sets; k++) set[n++] = j->o->set[k];
  if (last) set[n++] = last;
  const char *text = info->case_text ? info->case_text : "";
  char kept[4096];
  if (faccessat(j->held, "files", F_OK, 0)) /* none is named, or another version wrote it */
    return sph_case_read_text(info->case_path, text, strlen(text), n, set, error);
  snprintf(kept, sizeof kept, "%s/case.yml", j->directory);
  return sph_case_read_text(kept, text, strlen(text), n, set, error);
}

/* Each --set by itself, behind those in front of it: can the run go on with it? */
static int check_sets(const prog_job *j, const sph_checkpoint_info *info)
{
  sph_error error = {0}, none = {0};
  int bad = 0, k = 0;
  sph_case *before = j->o->sets ? case_of(j, info, 0, NULL, &none) : NULL;
  for (; before && !bad && k < j->o->sets; k++) {
    none = (sph_error){0};
    sph_case *now = case_of(j, info, k + 1, NULL, &none);
    if (!now) continue; /* it needs one behind it */
    bad = sph_case_restart_check(before, now, &error);
    sph_case_free(before);
    before = now;
  }
  sph_case_free(before);
  return bad ? sph_prog_error(PROG_FAILED, "%s: --set %s: %s", j->directory, j->o->set[k - 1],
                              error.text)
             : PROG_OK;
}

static int set_end(prog_job *j, const sph_checkpoint_info *info)
{
  char until[200];
  sph_error error = {0};
  j->end = sph_case_end(j->c);
  if (!j->o->until) return PROG_OK;
  snprintf(until, sizeof until, "run.end=%s", j->o->until);
  sph_case *other = case_of(j, info, j->o->sets, until, &error);
  if (!other) return sph_prog_error(PROG_FAILED, "--until: %s", error.text);
  j->end = sph_case_end(other);
  sph_case_free(other);
  return PROG_OK;
}

static void compare_versions(const prog_job *j, const sph_checkpoint_info *info)
{
  if (info->same && !strcmp(info->isa, sph_sim_isa(j->sim))) return;
  sph_prog_error(PROG_OK,
                 "it was written by sphode %s with SUNDIALS %s on %s: from here on, bits may "
                 "differ from those of a run without interruption",
                 info->version, info->sundials, info->isa);
}

/* Of tables and snapshots that are gone; the run goes on without. */
static void tell_lost(char *told)
{
  char *rest = NULL;
  for (char *line = strtok_r(told, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
    sph_prog_error(PROG_OK, "warning: %s", line);
}

/* A run that just goes on is still the one of its first command line. */
static void set_command(prog_job *j, const sph_checkpoint_info *info)
{
  const int other = j->o->until || j->o->sets > 0;
  j->command = j->o->command;
  if (!info->command) return;
  snprintf(j->line, sizeof j->line, "%s%s%s", info->command, other ? "; " : "",
           other ? j->o->command : "");
  j->command = j->line;
}

static int has_ended(const prog_job *j) { return !faccessat(j->held, "summary.json", F_OK, 0); }

/* There is nothing left to do. */
static int tell_end(const prog_job *j, const char *path, double t)
{
  if (j->o->until)
    return sph_prog_error(PROG_FAILED,
                          "--until %s: the run came to t = %.6g s (%s); right is a later time, as "
                          "--until %.3gs",
                          j->o->until, t, path, 2 * t);
  return sph_prog_error(PROG_FAILED,
                        "%s is at t = %.6g s, its end is %.6g s; --until TIME goes on to a later "
                        "time, as --until %.3gs",
                        path, t, j->end, 2 * t);
}

/* -1: the file is of no use, told; else an exit status. */
static int go_on_from(prog_job *j, const char *path)
{
  sph_checkpoint_info info;
  sph_error error = {0};
  char told[2000] = "";
  if (sph_checkpoint_info_read(path, &info, &error)) {
    sph_prog_error(PROG_FAILED, "%s", error.text);
    return -1;
  }
  int status = PROG_OK;
  if (!info.case_path || !info.case_text)
    status = sph_prog_error(PROG_FAILED, "%s: it is not of a case file", path);
  if (!status && !(j->c = case_of(j, &info, j->o->sets, NULL, &error)))
    status = sph_prog_error(PROG_FAILED, "%s", error.text);
  if (!status) status = check_sets(j, &info);
  if (!status) status = set_end(j, &info);
  /* One that came to its end may have been killed before it was concluded. */
  if (!status && (info.time > j->end || (info.time == j->end && has_ended(j))))
    status = tell_end(j, path, info.time);
  if (!status) set_command(j, &info);
  if (!status) status = sph_prog_run_build(j);
  if (!status) sph_prog_run_outputs(j);
  if (!status && sph_checkpoint_read_told(j->sim, path, told, sizeof told)) {
    sph_prog_error(PROG_FAILED, "%s", sph_sim_error(j->sim));
    forget(j);
    status = -1;
  }
  if (!status && j->o->sets > 0) sph_sim_changed(j->sim);
  if (!status && sph_sim_status(j->sim)) status = sph_prog_sim_error(j->c, j->sim, j->directory);
  if (!status) status = sph_prog_run_keep(j); /* not before all that may refuse it */
  if (!status) compare_versions(j, &info);
  if (!status) tell_lost(told);
  if (!status) unlinkat(j->held, "summary.json", 0); /* it goes on */
  if (!status && !j->o->quiet)
    fprintf(stderr, "going on from %s: t = %.6g s, step %ld\n", path, info.time, info.step);
  sph_checkpoint_info_free(&info);
  return status;
}

/* A directory without a checkpoint: is it that of a run? */
static int tell_none(const prog_job *j)
{
  const int run = !faccessat(j->held, "case.yml", F_OK, 0);
  if (!run)
    return sph_prog_error(PROG_FAILED,
                          "%s holds no checkpoint (checkpoint_*.hdf), nor a case.yml: right is the "
                          "directory of a run",
                          j->directory);
  return sph_prog_error(PROG_FAILED,
                        "%s holds no checkpoint (checkpoint_*.hdf); sphode run %s/case.yml -o "
                        "ELSEWHERE begins again, with --set checkpoint.wall=60s one each minute "
                        "(checkpoint.keep=0: none)",
                        j->directory, j->directory);
}

static int prepare(prog_job *j)
{
  char path[4096];
  int status = -1, k = 0;
  if (snprintf(j->directory, sizeof j->directory, "%s", j->o->what) >= (int)sizeof j->directory)
    return sph_prog_error(PROG_FAILED, "%.60s...: path too long", j->o->what);
  j->held = sph_prog_directory_hold(j->directory);
  if (j->held < 0 || sph_prog_run_listen(j)) return PROG_FAILED;
  for (; status < 0 && sph_checkpoint_find(j->directory, k, path, sizeof path); k++)
    status = go_on_from(j, path);
  if (status >= 0) return status;
  if (k && j->o->sets > 0)
    return sph_prog_error(PROG_FAILED,
                          "%s: none of its checkpoints can be used with what is set now; sphode "
                          "restart %s without --set may go on",
                          j->directory, j->directory);
  if (k)
    return sph_prog_error(PROG_FAILED,
                          "%s: none of its checkpoints can be used; sphode run begins again with "
                          "%s/case.yml",
                          j->directory, j->directory);
  return tell_none(j);
}

int sph_prog_restart(const prog_options *o)
{
  prog_job j = {.o = o, .held = -1};
  return sph_prog_run_finish(&j, prepare(&j));
}
