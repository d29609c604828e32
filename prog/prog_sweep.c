/* sphode sweep: a case with several values of some keys, each run in a process and a directory of
 * its own; one that fails does not end the others. */
#include "prog_sweep.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { UNLOGGED = 5 }; /* exit status of a run that failed and could not tell why */

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

/* Signals come only where await() waits, so that none falls between a look and a wait.  Of Ctrl-C
 * each process is told by the terminal, and again by the sweep: its runs do not mind. */

static void on_child(int number) { (void)number; }

static void hold_signals(sigset_t *before)
{
  struct sigaction action = {.sa_handler = on_child};
  sigset_t held;
  sph_prog_progress_catch(0);
  sigemptyset(&action.sa_mask);
  sigaction(SIGCHLD, &action, NULL);
  sigemptyset(&held);
  sigaddset(&held, SIGINT);
  sigaddset(&held, SIGTERM);
  sigaddset(&held, SIGCHLD);
  sigprocmask(SIG_BLOCK, &held, before);
}

static void release_signals(const sigset_t *before)
{
  struct sigaction action = {.sa_handler = SIG_DFL};
  sigemptyset(&action.sa_mask);
  sigaction(SIGCHLD, &action, NULL);
  sigprocmask(SIG_SETMASK, before, NULL);
}

static void child(const sweep *s, const sweep_run *r)
{
  char directory[4000], log[4010];
  prog_options o = options_of(s, r);
  snprintf(directory, sizeof directory, "%s/%s", s->directory, r->name);
  snprintf(log, sizeof log, "%s.log", directory);
  o.output = directory;
  o.lenient = 0;
  o.force = 1; /* what was there was looked at */
  if (r->goes_on) o.what = directory, o.sets = 0;
  int status = PROG_FAILED;
  const int logged = freopen(log, r->goes_on ? "a" : "w", stdout) && dup2(fileno(stdout), 2) >= 0;
  if (logged) status = r->goes_on ? sph_prog_restart(&o) : sph_prog_run(&o);
  if ((!logged || fflush(stdout) || ferror(stdout) || ferror(stderr)) && status == PROG_FAILED)
    status = UNLOGGED;
  fflush(NULL);
  _exit(status);
}

static int start(sweep_run *r, const sweep *s, const sigset_t *signals)
{
  fflush(NULL);
  r->process = fork();
  if (r->process == 0) {
    release_signals(signals);
    child(s, r);
  }
  if (r->process > 0) return PROG_OK;
  return sph_prog_error(PROG_FAILED, "cannot make a process: %s", strerror(errno));
}

static void stop_runs(sweep *s)
{
  int told = 0;
  s->stopping = 1;
  for (int k = 0; k < s->runs; k++)
    if (s->run[k].process > 0) told += !kill(s->run[k].process, sph_prog_progress_signal());
  if (!s->o->quiet)
    fprintf(stderr, "stopping: %d run%s a checkpoint first\n", told,
            told == 1 ? " writes" : "s write");
}

static void tell(const sweep *s, const sweep_run *r)
{
  if (s->o->quiet) return;
  fprintf(stderr, "%s: %s\n", r->name,
          r->status == 0              ? "done"
          : r->status == PROG_BAR     ? "done, misses a bar"
          : sph_prog_sweep_stopped(r) ? "stopped"
          : r->unlogged ? "failed, and its .log cannot be written; is there space left?"
                        : "failed, see its .log");
}

/* Waits for one to end. */
static void await(sweep *s, const sigset_t *signals)
{
  int how = 0;
  pid_t process;
  while ((process = waitpid(-1, &how, WNOHANG)) == 0) {
    if (sph_prog_progress_signal() && !s->stopping) stop_runs(s);
    sigsuspend(signals);
  }
  for (int k = 0; k < s->runs && process > 0; k++) {
    sweep_run *r = &s->run[k];
    if (r->process != process) continue;
    r->process = 0;
    r->done = 1;
    r->status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    r->unlogged = r->status == UNLOGGED;
    if (r->unlogged) r->status = PROG_FAILED;
    sph_prog_sweep_left_read(s, r);
    tell(s, r);
  }
}

static int run_all(sweep *s)
{
  const int jobs = s->o->jobs > 0 ? s->o->jobs : 1;
  int running = 0, next = 0, more, status = PROG_OK;
  sigset_t signals;
  hold_signals(&signals);
  do {
    while (next < s->runs && s->run[next].done) next++; /* by an earlier sweep */
    more = next < s->runs && !sph_prog_progress_signal() && !status;
    if (more && running < jobs) {
      status = start(&s->run[next++], s, &signals);
      running += !status;
    } else if (running > 0) {
      await(s, &signals);
      running--;
    }
  } while (running > 0 || more);
  release_signals(&signals);
  return status;
}

static int outcome(const sweep *s)
{
  const int number = sph_prog_progress_signal();
  int failed = 0, missed = 0, stopped = 0;
  for (int k = 0; k < s->runs; k++) {
    const sweep_run *r = &s->run[k];
    stopped += r->done && sph_prog_sweep_stopped(r);
    missed += r->done && r->status == PROG_BAR;
    failed += r->done && r->status && r->status != PROG_BAR && !sph_prog_sweep_stopped(r);
  }
  if (failed) sph_prog_error(0, "%s: %d of %d runs failed", s->directory, failed, s->runs);
  if (number || stopped)
    sph_prog_error(0, "%s: stopped; the same command goes on from there", s->directory);
  if (number) return 128 + number;
  if (failed) return PROG_FAILED;
  return stopped ? PROG_LIMIT : missed && !s->o->lenient ? PROG_BAR : PROG_OK;
}

/* The runs, and what is told of them. */
static int go(sweep *s)
{
  const int started = run_all(s), written = sph_prog_sweep_write(s);
  if (!s->o->quiet) sph_prog_sweep_print(s);
  return started ? started : written ? written : outcome(s);
}

/* What an earlier sweep with this command left. */
static int look(sweep *s)
{
  int status = PROG_OK;
  for (int k = 0; !status && !s->o->force && k < s->runs; k++) {
    sweep_run *r = &s->run[k];
    const prog_options o = options_of(s, r);
    sph_error error = {0};
    sph_case *c = sph_case_read(o.what, o.sets, o.set, &error);
    status = c ? sph_prog_sweep_left(s, r, sph_case_text(c))
               : sph_prog_error(PROG_FAILED, "%s", error.text);
    sph_case_free(c);
    if (!status && r->done && !s->o->quiet) fprintf(stderr, "%s: done before\n", r->name);
  }
  return status;
}

/* ---- the command */

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

/* That of an earlier sweep is gone on with. */
static int take_directory(const sweep *s)
{
  char table[3100];
  snprintf(table, sizeof table, "%s/sweep.csv", s->directory);
  if (!s->o->force && !access(table, F_OK)) return sph_prog_directory_hold(s->directory);
  return sph_prog_directory_take(s->directory, s->o->force);
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
  if (!status && (held = take_directory(s)) < 0) status = PROG_FAILED;
  if (!status) status = look(s);
  if (!status) status = go(s);
  if (held >= 0) close(held);
  free(s);
  return status;
}
