/* When checkpoints are written, and which stay. */
#include "sphode/checkpoint.h"

#include <dirent.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "checkpoint_file.h"
#include "clock.h"
#include "file.h"
#include "memory.h"
#include "sim_keep.h"

typedef struct writer {
  sph_checkpoint_def def;
  char **set;        /* [def.sets] */
  long written;      /* steps at the last one; -1: none */
  double passed;     /* multiples of def.interval so far; -1: not known yet */
  double written_at; /* wall time [s] */
} writer;

/* ---- the directory ---- */

/* The number in a file name checkpoint_00000123.hdf, or -1. */
static long number_of(const char *name)
{
  char back[64];
  if (strncmp(name, "checkpoint_", 11) != 0) return -1;
  long number = strtol(name + 11, NULL, 10);
  snprintf(back, sizeof back, "checkpoint_%08ld.hdf", number);
  return number >= 0 && !strcmp(name, back) ? number : -1;
}

static void path_of(char path[SPH_PATH], const char *directory, long number)
{
  snprintf(path, SPH_PATH, "%s/checkpoint_%08ld.hdf", directory, number);
}

/* The largest number below `limit`, or -1. */
static long largest_below(const char *directory, long limit)
{
  DIR *entries = directory ? opendir(directory) : NULL;
  long largest = -1;
  if (!entries) return -1;
  for (struct dirent *entry; (entry = readdir(entries));) {
    long number = number_of(entry->d_name);
    if (number < limit && number > largest) largest = number;
  }
  closedir(entries);
  return largest;
}

int sph_checkpoint_find(const char *directory, int k, char *path, size_t size)
{
  char found[SPH_PATH];
  long number = largest_below(directory, LONG_MAX);
  for (; number >= 0 && k > 0; k--) number = largest_below(directory, number);
  if (number < 0 || k < 0) return 0;
  path_of(found, directory, number);
  return !path || snprintf(path, size, "%s", found) < (int)size;
}

/* Those beyond the last one are of another future, those before the last few are done with. */
static void prune(const writer *w)
{
  char path[SPH_PATH];
  int stay = w->def.keep;
  long number = largest_below(w->def.directory, LONG_MAX), next;
  for (; number >= 0; number = next) {
    next = largest_below(w->def.directory, number);
    if (number <= w->written && stay-- > 0) continue;
    path_of(path, w->def.directory, number);
    unlink(path);
  }
}

/* ---- when ---- */

static long steps_of(const sph_sim *sim)
{
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  return stats.step.steps;
}

static int write_now(writer *w, sph_sim *sim, sph_error *error)
{
  char path[SPH_PATH];
  size_t size = 0;
  long step = steps_of(sim);
  path_of(path, w->def.directory, step);
  int status = sph_file_make_directory(w->def.directory, error);
  unsigned char *image = status ? NULL : sph_checkpoint_image(path, sim, &w->def, &size, error);
  if (!status) status = image ? sph_checkpoint_file_write(path, image, size, error) : error->status;
  sph_memory_free(image);
  if (status) return status;
  w->written = step;
  w->written_at = sph_clock();
  prune(w);
  return SPH_OK;
}

/* Did the last step reach or pass a multiple of the interval? */
static int passes(writer *w, const sph_sim *sim)
{
  sph_sim_stats stats;
  const double interval = w->def.interval, before = w->passed;
  if (!(interval > 0)) return 0;
  sph_sim_get_stats(sim, &stats);
  const double slack = 1e-9, t = sph_sim_time(sim);
  w->passed = floor(t / interval + slack);
  return w->passed > (before >= 0 ? before : floor((t - stats.step.dt_last) / interval + slack));
}

static int save(void *ctx, sph_sim *sim, int last, sph_error *error)
{
  writer *w = ctx;
  const long step = steps_of(sim);
  int due = passes(w, sim);
  due |= w->def.steps > 0 && step % w->def.steps == 0;
  due |= w->def.wall > 0 && sph_clock() - w->written_at >= w->def.wall;
  due |= last;
  return due && step != w->written ? write_now(w, sim, error) : SPH_OK;
}

/* ---- making ---- */

static void release(void *ctx)
{
  writer *w = ctx;
  if (!w) return;
  for (int k = 0; w->set && k < w->def.sets; k++) sph_memory_free(w->set[k]);
  sph_memory_free(w->set);
  sph_memory_free((void *)w->def.directory);
  sph_memory_free((void *)w->def.case_path);
  sph_memory_free((void *)w->def.case_text);
  sph_memory_free((void *)w->def.command);
  sph_memory_free(w);
}

static char *copy(const char *text, sph_error *error)
{
  return text ? sph_memory_string(text, error) : NULL;
}

static int check(const sph_checkpoint_def *def, sph_error *error)
{
  const char *wrong = NULL;
  if (!def)
    wrong = "no definition (NULL)";
  else if (!def->directory || !*def->directory)
    wrong = "no directory";
  else if (def->steps < 0 || def->keep < 0 || def->sets < 0)
    wrong = "steps, keep and sets are 0 or more";
  else if (!(def->interval >= 0 && def->interval < INFINITY))
    wrong = "interval is 0 or more and finite [s]";
  else if (!(def->wall >= 0 && def->wall < INFINITY))
    wrong = "wall is 0 or more and finite [s]";
  else if (def->sets > 0 && !def->set)
    wrong = "settings at NULL";
  if (!wrong) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "checkpoints: %s", wrong);
}

static writer *make(const sph_checkpoint_def *def, sph_error *error)
{
  writer *w = SPH_NEW(writer, 1, "checkpoints", error);
  if (!w) return NULL;
  w->def = *def;
  w->def.directory = copy(def->directory, error);
  w->def.case_path = copy(def->case_path, error);
  w->def.case_text = copy(def->case_text, error);
  w->def.command = copy(def->command, error);
  w->def.sets = 0;
  if (w->def.keep == 0) w->def.keep = 2;
  w->set = SPH_NEW(char *, def->sets, "settings", error);
  for (int k = 0; w->set && k < def->sets; k++) {
    w->set[k] = copy(def->set[k], error);
    w->def.sets = k + 1;
  }
  w->def.set = (const char *const *)w->set;
  w->written = -1;
  w->passed = -1;
  w->written_at = sph_clock();
  if (!error->status) return w;
  release(w);
  return NULL;
}

void sph_checkpoint_set(sph_sim *sim, const sph_checkpoint_def *def)
{
  sph_error error = {0};
  if (sph_sim_status(sim)) return;
  writer *w = check(def, &error) ? NULL : make(def, &error);
  if (!w) {
    sph_sim_fail(sim, error.status, "%s", error.text);
    return;
  }
  sph_file_remove_stale(def->directory, "checkpoint_");
  sph_sim_keep_saver(sim, (sph_saver){.save = save, .ctx = w, .free = release});
}

static int ready(sph_sim *sim, const char *what)
{
  if (sph_sim_status(sim)) return sph_sim_status(sim);
  if (sim->saver.save != save)
    return sph_sim_fail(sim, SPH_ERR_STATE, "%s: sph_checkpoint_set comes first", what);
  if (!sim->prepared || sim->shown != sim->y)
    return sph_sim_fail(sim, SPH_ERR_STATE, "%s: right is between steps", what);
  return SPH_OK;
}

int sph_checkpoint_write(sph_sim *sim)
{
  sph_error error = {0};
  int status = ready(sim, "sph_checkpoint_write");
  if (status) return status;
  status = write_now(sim->saver.ctx, sim, &error);
  return status ? sph_sim_fail(sim, status, "%s", error.text) : SPH_OK;
}

long sph_checkpoint_size(sph_sim *sim)
{
  sph_error error = {0};
  size_t size = 0;
  int status = ready(sim, "sph_checkpoint_size");
  if (status) return status;
  const writer *w = sim->saver.ctx;
  unsigned char *image = sph_checkpoint_image("(its size)", sim, &w->def, &size, &error);
  sph_memory_free(image);
  return image ? (long)size : sph_sim_fail(sim, error.status, "%s", error.text);
}
