#include "frames.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "memory.h"

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
