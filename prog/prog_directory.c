/* The directory of a run. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "prog.h"

/* What a run writes; nothing else is ever removed. */
static const char *const ours[] = {
    "case.yml",           "summary.json",        "summary.txt",           "series.csv",
    "events.csv",         "probe_*.csv",         "checkpoint_[0-9]*.hdf", "snapshot_[0-9]*.hdf",
    "walls_[0-9]*.hdf",   "snapshot.hdf.series", "walls.hdf.series",      "frames.png",
    "frames.gp",          "frames.dat",          "compare_[0-9]*.png",    "compare_[0-9]*.gp",
    "compare_[0-9]*.dat", "compare_[0-9]*.csv",  "work-precision.csv",    "work-precision.txt",
    "evaluations.png",    "evaluations.gp",      "evaluations.dat",       "seconds.png",
    "seconds.gp",         "seconds.dat",         "spectrum.csv",          "spectrum.txt",
    "regions.csv",        "spectrum.png",        "spectrum.gp",           "spectrum.dat",
    "sweep.csv",          "convergence.csv",     "convergence.png",       "convergence.gp",
    "convergence.dat",    "failure.csv",
};

static int is_ours(const char *name)
{
  for (size_t k = 0; k < sizeof ours / sizeof *ours; k++)
    if (!fnmatch(ours[k], name, 0)) return 1;
  return 0;
}

static int make(const char *directory)
{
  char path[4096];
  if (snprintf(path, sizeof path, "%s/", directory) >= (int)sizeof path)
    return sph_prog_error(PROG_FAILED, "%.60s...: path too long", directory);
  for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
    *slash = 0;
    if (mkdir(path, 0777) && errno != EEXIST)
      return sph_prog_error(PROG_FAILED, "cannot make the directory %s: %s", path, strerror(errno));
    *slash = '/';
  }
  return PROG_OK;
}

static int remove_old(int at, const char *directory)
{
  int again = dup(at), status = PROG_OK;
  DIR *list = again < 0 ? NULL : fdopendir(again);
  if (!list) {
    if (again >= 0) close(again);
    return sph_prog_error(PROG_FAILED, "cannot read the directory %s: %s", directory,
                          strerror(errno));
  }
  for (struct dirent *entry; !status && (entry = readdir(list));)
    if (is_ours(entry->d_name) && unlinkat(at, entry->d_name, 0))
      status = sph_prog_error(PROG_FAILED, "cannot remove %s/%s: %s", directory, entry->d_name,
                              strerror(errno));
  closedir(list);
  return status;
}

int sph_prog_directory_hold(const char *directory)
{
  int at = open(directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (at < 0)
    sph_prog_error(PROG_FAILED, "cannot open the directory %s: %s", directory, strerror(errno));
  else if (!flock(at, LOCK_EX | LOCK_NB))
    return at;
  else
    sph_prog_error(PROG_FAILED, "another run is writing to %s now", directory);
  if (at >= 0) close(at);
  return -1;
}

int sph_prog_directory_take(const char *directory, int force)
{
  if (make(directory)) return -1;
  int at = sph_prog_directory_hold(directory);
  if (at < 0) return -1;
  const int ended = !faccessat(at, "summary.json", F_OK, 0) ||
                    !faccessat(at, "work-precision.csv", F_OK, 0) ||
                    !faccessat(at, "spectrum.txt", F_OK, 0) || !faccessat(at, "sweep.csv", F_OK, 0);
  const int goes_on = sph_checkpoint_find(directory, 0, NULL, 0);
  if (!force && goes_on)
    sph_prog_error(PROG_FAILED,
                   "%s holds a run that %s; sphode restart %s goes on with it%s, --output DIR goes "
                   "elsewhere, --force writes over it",
                   directory, ended ? "ended or was stopped" : "was interrupted", directory,
                   ended ? " (--until TIME: further)" : "");
  else if (!force && ended)
    sph_prog_error(PROG_FAILED,
                   "%s holds a run that ended or was stopped; --output DIR goes elsewhere, --force "
                   "writes over it",
                   directory);
  else if (faccessat(at, "case.yml", F_OK, 0) || !remove_old(at, directory))
    return at;
  close(at);
  return -1;
}
