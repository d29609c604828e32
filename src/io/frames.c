#include "frames.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "memory.h"
#include "snapshot.h"

long sph_frames_number(const char *path)
{
  char back[64];
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
  if (strncmp(name, "snapshot_", 9) != 0) return -1;
  long number = strtol(name + 9, NULL, 10);
  snprintf(back, sizeof back, "snapshot_%04ld.hdf", number);
  return number >= 0 && !strcmp(name, back) ? number : -1;
}

static int rising(const void *a, const void *b)
{
  long x = *(const long *)a, y = *(const long *)b;
  return (x > y) - (x < y);
}

static int count_or_fill(const char *directory, long *number, int room, sph_error *error)
{
  DIR *entries = directory ? opendir(directory) : NULL;
  if (!entries)
    return sph_error_set(error, SPH_ERR_FILE, "cannot read directory %s: %s",
                         directory ? directory : "(none)", strerror(directory ? errno : ENOENT));
  int count = 0;
  for (struct dirent *entry; (entry = readdir(entries));) {
    long found = sph_frames_number(entry->d_name);
    if (found < 0 || (number && count >= room)) continue;
    if (number) number[count] = found;
    count++;
  }
  closedir(entries);
  return count;
}

int sph_frames_list(const char *directory, long **number, sph_error *error)
{
  int count = count_or_fill(directory, NULL, 0, error);
  *number = count >= 0 ? SPH_NEW(long, count, "a list of snapshots", error) : NULL;
  if (!*number) return count < 0 ? count : SPH_ERR_MEMORY;
  count = count_or_fill(directory, *number, count, error);
  if (count > 0) qsort(*number, (size_t)count, sizeof **number, rising);
  return count;
}

int sph_frames_path(char path[SPH_PATH], const char *directory, long number, sph_error *error)
{
  char name[64];
  snprintf(name, sizeof name, "snapshot_%04ld.hdf", number);
  return sph_file_path(path, directory, name, error);
}

int sph_frames_leave(const sph_left_out *left_out, const sph_error *why, sph_error *error)
{
  if (!left_out || !left_out->tell || why->status != SPH_ERR_FILE)
    return sph_error_set(error, why->status, "%s", why->text);
  left_out->tell(left_out->ctx, why->text);
  return SPH_OK;
}

int sph_frames_missing(const char *directory, const long *number, int count,
                       const sph_left_out *left_out, sph_error *error)
{
  char path[SPH_PATH];
  int status = SPH_OK;
  for (int k = 1; left_out && left_out->tell && k < count; k++)
    for (long missing = number[k - 1] + 1; missing < number[k] && !status; missing++) {
      sph_error why = {0};
      status = sph_frames_path(path, directory, missing, error);
      if (status) break;
      sph_error_set(&why, SPH_ERR_FILE, "%s: it is missing", path);
      status = sph_frames_leave(left_out, &why, error);
    }
  return status;
}

int sph_frames_nearest(const char *directory, const double *time, int n, long *nearest,
                       const sph_left_out *left_out, sph_error *error)
{
  long *number = NULL;
  char path[SPH_PATH];
  const int count = sph_frames_list(directory, &number, error);
  double *off = count < 0 ? NULL : SPH_NEW(double, n + 1, "times of snapshots", error);
  int status = count < 0 ? count : off ? SPH_OK : SPH_ERR_MEMORY, read = 0;
  for (int j = 0; j < n && !status; j++) off[j] = INFINITY;
  for (int k = 0; k < count && !status; k++) {
    double t = 0;
    sph_error own = {0};
    status = sph_frames_path(path, directory, number[k], error);
    if (!status && sph_snapshot_read_time(path, &t, &own)) {
      status = sph_frames_leave(left_out, &own, error);
      continue;
    }
    for (int j = 0; j < n && !status; j++)
      if (fabs(t - time[j]) < off[j]) off[j] = fabs(t - time[j]), nearest[j] = number[k];
    read++;
  }
  if (!status && read == 0)
    status = sph_error_set(error, SPH_ERR_FILE, "%s holds no snapshots%s", directory,
                           count ? " that can be read" : "");
  sph_memory_free(off);
  sph_memory_free(number);
  return status;
}
