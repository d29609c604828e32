/* What a run tells while it goes, and how it is stopped. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "prog.h"
#include "prog_live.h"

/* Before a queue ends the job: for the checkpoint, the summary and pictures [s]. */
static const double QUEUE_MARGIN = 60;

static volatile sig_atomic_t stopped_by, patient;
static struct timespec interrupted; /* by the first Ctrl-C */

/* Queues and timeout send SIGTERM twice, to the program and to its group: only a person's second
 * Ctrl-C, a second or more behind the first, ends the program without a checkpoint. */
static void on_signal(int number)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double since = (double)(now.tv_sec - interrupted.tv_sec) +
                       1e-9 * (double)(now.tv_nsec - interrupted.tv_nsec);
  if (number == SIGINT && stopped_by == SIGINT && !patient && since >= 1) {
    signal(number, SIG_DFL);
    raise(number);
  }
  if (number == SIGINT && stopped_by != SIGINT) interrupted = now;
  stopped_by = number;
}

double sph_prog_progress_now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* What bound most of the steps since the last line. */
static const char *bound(prog_progress *p, const sph_sim *sim, const sph_step_stats *s)
{
  int most = 0;
  for (int k = 1; k < SPH_BOUND_COUNT; k++)
    if (s->bound_by[k] - p->bound_by[k] > s->bound_by[most] - p->bound_by[most]) most = k;
  memcpy(p->bound_by, s->bound_by, sizeof p->bound_by);
  return sph_sim_bound_name(sim, most);
}

static long fluids(const sph_sim *sim)
{
  const sph_group *group;
  long n = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    if (!strcmp(sph_group_kind(group), "fluid")) n += sph_group_count(group);
  return n;
}

/* Of the terminal: a line that wraps could not be written over. */
static int columns(void)
{
  struct winsize size;
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

static void tell(prog_progress *p, sph_sim *sim)
{
  sph_sim_stats s;
  sph_sim_get_stats(sim, &s);
  double t = sph_sim_time(sim), used = sph_prog_progress_now() - p->start, left = 0;
  if (t > p->from) left = used * (p->end - t) / (t - p->from);
  char line[200];
  snprintf(line, sizeof line,
           "t %.4g/%.4g s %3.0f %%  step %ld, dt %.3g s (%s)  %ld particles  %.3g Mpairs/s  "
           "%.0f:%02.0f left",
           t, p->end, 100 * t / p->end, s.step.steps, s.step.dt_last, bound(p, sim, &s.step),
           fluids(sim), used > 0 ? 1e-6 * (s.pairs - p->pairs) / used : 0, floor(left / 60),
           floor(fmod(left, 60)));
  if (p->live)
    fprintf(stderr, "\r\033[K%.*s", columns() - 1, line);
  else
    fprintf(stderr, "%s\n", line);
  fflush(stderr);
}

/* On a terminal five times a second, else after each tenth of the run. */
static int is_due(prog_progress *p, const sph_sim *sim)
{
  if (p->live) {
    double t = sph_prog_progress_now();
    if (t - p->shown < 0.2) return 0;
    p->shown = t;
    return 1;
  }
  double tenth = floor(10 * sph_sim_time(sim) / p->end * (1 + 1e-12));
  if (tenth <= p->tenth) return 0;
  p->tenth = tenth;
  return 1;
}

static int is_stopped(void *ctx)
{
  const prog_progress *p = ctx;
  return stopped_by || (p->deadline > 0 && sph_prog_progress_now() > p->deadline);
}

/* What time there is no more of; NULL: there is. */
static const char *over(const prog_progress *p)
{
  const double then = p->stepped + 2 * p->longest;
  if (p->limit > 0 && then > p->limit) return "before run.time_limit is over";
  return p->queue != 0 && then + QUEUE_MARGIN > p->queue ? "before the queue ends the job" : NULL;
}

static int progress(void *ctx, sph_sim *sim)
{
  prog_progress *p = ctx;
  const double now = sph_prog_progress_now();
  p->longest = fmax(p->longest, now - p->stepped);
  p->stepped = now;
  if (!p->quiet && is_due(p, sim)) tell(p, sim);
  if (p->page && sph_prog_live_step(p->page, sim, p->end, is_stopped, p)) return 1;
  if (is_stopped(p)) return 1;
  sph_sim_set_stop(sim, over(p));
  return sph_prog_progress_over(p);
}

int sph_prog_progress_over(const prog_progress *p) { return over(p) != NULL; }

/* Seconds until a queue ends this job, by what Slurm says in the environment; INFINITY: it does
 * not. */
static double queue_left(void)
{
  const char *text = getenv("SLURM_JOB_END_TIME");
  char *rest = NULL;
  const double end = text ? strtod(text, &rest) : 0; /* seconds since 1970 */
  return rest && rest > text && !*rest && end > 0 ? end - (double)time(NULL) : INFINITY;
}

void sph_prog_progress_catch(int once)
{
  static int caught;
  struct sigaction action = {.sa_handler = on_signal};
  if (caught++) return;
  patient = !once;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

void sph_prog_progress_release(void)
{
  if (patient) return;
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
}

void sph_prog_progress_start(prog_progress *p, sph_sim *sim, double end, int quiet)
{
  *p = (prog_progress){.end = end,
                       .start = sph_prog_progress_now(),
                       .from = sph_sim_time(sim),
                       .quiet = quiet,
                       .live = isatty(STDERR_FILENO)};
  p->stepped = p->start;
  const double left = queue_left();
  p->queue = left < INFINITY ? p->start + left : 0;
  sph_sim_stats before;
  sph_sim_get_stats(sim, &before);
  p->pairs = before.pairs;
  p->tenth = floor(10 * p->from / end);
  sph_prog_progress_catch(1);
  sph_sim_set_progress(sim, progress, p);
}

void sph_prog_progress_end(prog_progress *p)
{
  if (p->live && !p->quiet) fputs("\r\033[K", stderr);
}

int sph_prog_progress_signal(void) { return stopped_by; }
