/* plot.c -- frames of a run on a sheet. */
#include <sys/stat.h>

#include "file.h"
#include "frames.h"
#include "memory.h"
#include "picture.h"
#include "sphode/output.h"

enum { FRAMES_MAX = 16 };

/* The snapshots that can be read; frame[n], returns how many. */
static int read_frames(const sph_sheet_def *def, const long *number, const char **field,
                       sph_snapshot *frame, sph_error *error)
{
  char path[SPH_PATH];
  int status = SPH_OK, read = 0;
  double time;
  for (int k = 0; k < def->n && !status; k++) {
    sph_error own = {0};
    status = sph_frames_path(path, def->directory, number[k], error);
    if (status) break;
    if (!*field && !sph_snapshot_read_time(path, &time, NULL))
      *field = sph_snapshot_read_default(path);
    if (sph_snapshot_read(path, *field ? *field : "velocity", &frame[read], &own))
      status = sph_frames_leave(&def->left_out, &own, error);
    else
      read++;
  }
  while (status && read > 0) sph_snapshot_read_free(&frame[--read]);
  return status ? status : read;
}

static int draw_frames(const char *field, sph_snapshot *frame, int n, const char *png,
                       sph_error *error)
{
  sph_picture p = {.field = field, .width = 1200, .height = 1500};
  const int status = sph_picture_sheet(&p, frame, n, png, error);
  for (int k = 0; k < n; k++) sph_snapshot_read_free(&frame[k]);
  return status;
}

static int draw_sheet(const sph_sheet_def *def, const long *number, const char *png,
                      sph_error *error)
{
  sph_snapshot frame[FRAMES_MAX];
  const char *field = def->field;
  const int read = read_frames(def, number, &field, frame, error);
  if (read == 0)
    return sph_error_set(error, SPH_ERR_FILE, "%s: none of its snapshots can be read",
                         def->directory);
  return read < 0 ? read : draw_frames(field, frame, read, png, error);
}

int sph_plot_sheet(const sph_sheet_def *def, const char *png, sph_error *error)
{
  long *number = NULL, chosen[FRAMES_MAX] = {0};
  if (!def) return sph_error_set(error, SPH_ERR_ARGUMENT, "a sheet of no definition (NULL)");
  sph_sheet_def sheet = *def;
  if (sheet.n < 1 || sheet.n > FRAMES_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%d frames in a picture; 1 to %d are right",
                         sheet.n, FRAMES_MAX);
  if (sheet.number) return draw_sheet(&sheet, sheet.number, png, error);
  const int count = sph_frames_list(sheet.directory, &number, error);
  int status = count < 0 ? count : SPH_OK;
  if (count == 0)
    status = sph_error_set(error, SPH_ERR_FILE, "%s holds no snapshots", sheet.directory);
  const int n = sheet.n = sheet.n > count ? count : sheet.n;
  for (int k = 0; k < n; k++)
    chosen[k] = number[n == 1 ? count - 1 : (2 * k * (count - 1) + n - 1) / (2 * (n - 1))];
  if (!status) status = draw_sheet(&sheet, chosen, png, error);
  sph_memory_free(number);
  return status;
}

int sph_plot_frames(const char *directory, const char *field, int n, const char *png,
                    sph_error *error)
{
  const sph_sheet_def def = {.directory = directory, .field = field, .n = n};
  return sph_plot_sheet(&def, png, error);
}

int sph_plot_nearest(const char *directory, const double *time, int n, long *number,
                     const sph_left_out *left_out, sph_error *error)
{
  if (!time || !number || n < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%d times of snapshots at NULL", n);
  return sph_frames_nearest(directory, time, n, number, left_out, error);
}

int sph_plot_particles(const char *path, const char *field, const char *png, sph_error *error)
{
  struct stat info;
  sph_snapshot frame;
  if (!path) return sph_error_set(error, SPH_ERR_ARGUMENT, "a picture of no path (NULL)");
  if (stat(path, &info) != 0)
    return sph_error_set(error, SPH_ERR_FILE, "%s: no such file or directory", path);
  if (S_ISDIR(info.st_mode)) return sph_plot_frames(path, field, 1, png, error);
  if (!field) field = sph_snapshot_read_default(path);
  const int status = sph_snapshot_read(path, field, &frame, error);
  return status ? status : draw_frames(field, &frame, 1, png, error);
}

int sph_plot_count(const char *directory, sph_error *error)
{
  long *number = NULL;
  int count = sph_frames_list(directory, &number, error);
  sph_memory_free(number);
  return count;
}
