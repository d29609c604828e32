/* sphode sweep: a case with several values of some keys, each run in a process and a directory of
 * its own; one that fails does not end the others. */
#include "prog_sweep.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static volatile sig_atomic_t stop;
static void on_signal(int number) { stop = number; }

/* ---- what is varied */

/* The values of "a,[1,2],b": commas in brackets belong to a value. */
static int split(sweep_key *k, const char *text, const char *whole)
{
  int depth = 0;
  size_t n = 0;
  for (;; text++) {
    depth += (*text == '[' || *text == '(') - (*text == ']' || *text == ')');
    if (*text && (*text != ',' || depth > 0)) {
      if (n + 1 < sizeof k->value[0]) k->value[k->n][n++] = *text;
      continue;
    }
    k->value[k->n][n] = 0;
    if (n == 0) return sph_prog_error(PROG_USAGE, "--vary %s: found nothing between commas", whole);
    k->n++;
    n = 0;
    if (!*text) return PROG_OK;
    if (k->n == SWEEP_VALUES)
      return sph_prog_error(PROG_USAGE, "--vary %s: more than %d values", whole, SWEEP_VALUES);
  }
}

static int take_keys(sweep *s)
{
  for (int k = 0; k < s->o->varied; k++) {
    const char *text = s->o->vary[k], *equal = strchr(text, '=');
    sweep_key *key = &s->key[s->keys++];
    if (!equal || equal == text || (size_t)(equal - text) >= sizeof key->key)
      return sph_prog_error(PROG_USAGE, "--vary %s: wanted KEY=VALUE,VALUE, as spacing=2cm,1cm",
                            text);
    snprintf(key->key, sizeof key->key, "%.*s", (int)(equal - text), text);
    int status = split(key, equal + 1, text);
    if (status) return status;
  }
  if (s->keys) return PROG_OK;
  return sph_prog_error(PROG_USAGE, "sweep wants --vary KEY=VALUE,VALUE, as spacing=2cm,1cm");
}

/* Letters that no shell and no file system minds. */
static void name_run(sweep_run *r, int keys)
{
  size_t n = 0;
  for (int k = 0; k < keys; k++)
    for (const char *c = r->set[k]; (*c || k + 1 < keys) && n + 1 < sizeof r->name; c++) {
      const int good =
          *c && strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._=+-", *c);
      r->name[n++] = good ? *c : *c ? '_' : ',';
      if (!*c) break;
    }
  r->name[n] = 0;
}

/* All combinations, the last key the fastest. */
static int make_runs(sweep *s)
{
  int count = 1;
  for (int k = 0; k < s->keys; k++) count = count > SWEEP_RUNS ? count : count * s->key[k].n;
  if (count > SWEEP_RUNS) return sph_prog_error(PROG_USAGE, "more than %d runs", SWEEP_RUNS);
  for (; s->runs < count; s->runs++) {
    sweep_run *r = &s->run[s->runs];
    int rest = s->runs;
    for (int k = s->keys - 1; k >= 0; rest /= s->key[k--].n)
      snprintf(r->set[k], sizeof r->set[k], "%s=%s", s->key[k].key,
               s->key[k].value[rest % s->key[k].n]);
    r->pipe = -1;
    name_run(r, s->keys);
    for (int j = 0; j < s->runs; j++)
      if (!strcmp(s->run[j].name, r->name))
        return sph_prog_error(PROG_USAGE, "--vary: two runs of the name %s", r->name);
  }
  return PROG_OK;
}

static prog_options options_of(const sweep *s, const sweep_run *r)
{
  prog_options o = *s->o;
  for (int k = 0; k < s->keys && o.sets < PROG_SETS; k++) o.set[o.sets++] = r->set[k];
  return o;
}

/* What is wrong is told before the first hour of work. */
static int check(const sweep *s)
{
  for (int k = 0; k < s->runs; k++) {
    const prog_options o = options_of(s, &s->run[k]);
    sph_error error = {0};
    sph_case *c = sph_case_read(o.what, o.sets, o.set, &error);
    if (!c) return sph_prog_error(PROG_FAILED, "%s", error.text);
    sph_case_free(c);
  }
  return PROG_OK;
}

/* ---- runs */

static void child(const sweep *s, const sweep_run *r, int to)
{
  char directory[4000], log[4010];
  prog_options o = options_of(s, r);
  snprintf(directory, sizeof directory, "%s/%s", s->directory, r->name);
  snprintf(log, sizeof log, "%s.log", directory);
  o.output = directory;
  o.lenient = 0;
  o.report = fdopen(to, "w");
  int status = PROG_FAILED;
  const int logged = freopen(log, "w", stdout) && dup2(fileno(stdout), 2) >= 0;
  if (logged && o.report) status = sph_prog_run(&o);
  if ((!logged || fflush(stdout) || ferror(stdout) || ferror(stderr)) && o.report)
    fprintf(o.report, "unlogged\n");
  fflush(NULL);
  _exit(status);
}

static int start(sweep *s, sweep_run *r)
{
  int ends[2];
  if (pipe(ends)) return sph_prog_error(PROG_FAILED, "cannot make a pipe: %s", strerror(errno));
  fflush(NULL);
  const int process = fork();
  if (process == 0) {
    close(ends[0]);
    child(s, r, ends[1]);
  }
  close(ends[1]);
  r->pipe = ends[0];
  r->process = process;
  if (process > 0) return PROG_OK;
  return sph_prog_error(PROG_FAILED, "cannot make a process: %s", strerror(errno));
}

/* The lines of sph_prog_run's report. */
static void read_report(sweep_run *r)
{
  FILE *from = fdopen(r->pipe, "r");
  char line[300];
  r->pipe = -1;
  while (from && fgets(line, sizeof line, from)) {
    line[strcspn(line, "\n")] = 0;
    if (sscanf(line, "run %lf %ld %ld %lf", &r->spacing, &r->particles, &r->steps, &r->seconds) ==
        4)
      continue;
    if (!strcmp(line, "unlogged")) r->unlogged = 1;
    int at = 0, c = r->compared;
    if (c == SWEEP_COMPARED) continue;
    if (sscanf(line, "compare %lf %lf %19s %n", &r->of[c].value, &r->of[c].bar, r->of[c].norm,
               &at) != 3)
      continue;
    snprintf(r->of[c].name, sizeof r->of[c].name, "%.79s", line + at);
    r->compared++;
  }
  if (from) fclose(from);
}

/* Waits for one to end. */
static void await(sweep *s)
{
  int how = 0;
  const pid_t process = waitpid(-1, &how, 0);
  for (int k = 0; k < s->runs && process > 0; k++) {
    sweep_run *r = &s->run[k];
    if (r->process != process) continue;
    r->process = 0;
    r->done = 1;
    r->status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    read_report(r);
    if (!s->o->quiet)
      fprintf(stderr, "%s: %s\n", r->name,
              r->status == 0          ? "done"
              : r->status == PROG_BAR ? "done, misses a bar"
              : r->unlogged ? "failed, and its .log cannot be written; is there space left?"
                            : "failed, see its .log");
  }
}

static int run_all(sweep *s)
{
  int running = 0, next = 0, status = PROG_OK;
  const int jobs = s->o->jobs > 0 ? s->o->jobs : 1;
  signal(SIGINT, on_signal); /* the runs have handlers of their own */
  signal(SIGTERM, on_signal);
  while (running > 0 || (next < s->runs && !stop && !status)) {
    if (running < jobs && next < s->runs && !stop && !status) {
      status = start(s, &s->run[next++]);
      running += !status;
    } else {
      await(s);
      running--;
    }
  }
  return status;
}

static int outcome(const sweep *s)
{
  int failed = 0, missed = 0;
  for (int k = 0; k < s->runs; k++) {
    failed += !s->run[k].done || (s->run[k].status != 0 && s->run[k].status != PROG_BAR);
    missed += s->run[k].status == PROG_BAR;
  }
  if (stop) return 128 + (int)stop;
  if (failed)
    return sph_prog_error(PROG_FAILED, "%s: %d of %d runs failed", s->directory, failed, s->runs);
  return missed && !s->o->lenient ? PROG_BAR : PROG_OK;
}

/* --output, or the name of the case file and "-sweep". */
static void name_directory(sweep *s)
{
  const char *slash = strrchr(s->o->what, '/'), *name = slash ? slash + 1 : s->o->what;
  const char *dot = strrchr(name, '.');
  const int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
  if (s->o->output)
    snprintf(s->directory, sizeof s->directory, "%s", s->o->output);
  else
    snprintf(s->directory, sizeof s->directory, "%.*s-sweep", length, name);
}

int sph_prog_sweep(const prog_options *o)
{
  sweep *s = calloc(1, sizeof *s);
  if (!s) return sph_prog_error(PROG_FAILED, "out of memory");
  s->o = o;
  name_directory(s);
  int status = take_keys(s), held = -1;
  if (!status) status = make_runs(s);
  if (!status) status = check(s);
  if (!status && (held = sph_prog_directory_take(s->directory, o->force)) < 0) status = PROG_FAILED;
  if (!status) status = run_all(s);
  if (held >= 0) {
    const int written = sph_prog_sweep_write(s);
    if (!o->quiet) sph_prog_sweep_print(s);
    if (!status) status = written;
    if (!status) status = outcome(s);
    close(held);
  }
  free(s);
  return status;
}
