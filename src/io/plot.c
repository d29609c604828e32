/* plot.c -- frames of a run on a sheet. */
#include <sys/stat.h>

#include "file.h"
#include "frames.h"
#include "memory.h"
#include "picture.h"
#include "sphode/output.h"

enum { FRAMES_MAX = 16 };

/* Draws the snapshots of these numbers (of `directory`), or the one file `path` if given. */
static int draw_files(const char *path, const char *directory, const long *number, int n,
                      const char *field, const char *png, sph_error *error)
{
  char name[SPH_PATH];
  sph_snapshot frame[FRAMES_MAX];
  int status = SPH_OK, read = 0;
  for (int k = 0; status == SPH_OK && k < n; k++) {
    if (number) status = sph_frames_path(name, directory, number[k], error);
    if (status == SPH_OK && !field) field = sph_snapshot_read_default(path ? path : name);
    if (status == SPH_OK) status = sph_snapshot_read(path ? path : name, field, &frame[k], error);
    if (status == SPH_OK) read++;
  }
  sph_picture p = {.field = field, .width = 1200, .height = 1500};
  if (status == SPH_OK) status = sph_picture_sheet(&p, frame, n, png, error);
  for (int k = 0; k < read; k++) sph_snapshot_read_free(&frame[k]);
  return status;
}

int sph_plot_frames(const char *directory, const char *field, int n, const char *png,
                    sph_error *error)
{
  long *number = NULL, chosen[FRAMES_MAX];
  if (n < 1 || n > FRAMES_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%d frames in a picture; 1 to %d are right", n,
                         FRAMES_MAX);
  int count = sph_frames_list(directory, &number, error), status = count;
  if (count == 0) status = sph_error_set(error, SPH_ERR_FILE, "%s holds no snapshots", directory);
  if (n > count) n = count;
  for (int k = 0; k < n; k++)
    chosen[k] = number[n == 1 ? count - 1 : (2 * k * (count - 1) + n - 1) / (2 * (n - 1))];
  if (status > 0) status = draw_files(NULL, directory, chosen, n, field, png, error);
  sph_memory_free(number);
  return status;
}

int sph_plot_particles(const char *path, const char *field, const char *png, sph_error *error)
{
  struct stat info;
  if (!path) return sph_error_set(error, SPH_ERR_ARGUMENT, "a picture of no path (NULL)");
  if (stat(path, &info) != 0)
    return sph_error_set(error, SPH_ERR_FILE, "%s: no such file or directory", path);
  if (S_ISDIR(info.st_mode)) return sph_plot_frames(path, field, 1, png, error);
  return draw_files(path, NULL, NULL, 1, field, png, error);
}

int sph_plot_count(const char *directory, sph_error *error)
{
  long *number = NULL;
  int count = sph_frames_list(directory, &number, error);
  sph_memory_free(number);
  return count;
}
