#include "rows.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

int sph_rows_open(sph_rows *rows, const char *directory, const char *name, sph_error *error)
{
  int status = sph_file_make_directory(directory, error);
  if (status == SPH_OK) status = sph_file_path(rows->path, directory, name, error);
  if (status != SPH_OK) return status;
  rows->fd = open(rows->path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (rows->fd >= 0) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "cannot write %s: %s", rows->path, strerror(errno));
}

int sph_rows_append(sph_rows *rows, sph_text *row, sph_error *error)
{
  int status = sph_error_set(error, row->error.status, "%s", row->error.text);
  off_t end = lseek(rows->fd, 0, SEEK_END);
  ssize_t done = status == SPH_OK ? write(rows->fd, row->data, row->length) : 0;
  if (status == SPH_OK && done != (ssize_t)row->length) {
    int why = done < 0 ? errno : ENOSPC;
    if (ftruncate(rows->fd, end) != 0) errno = why; /* a device; told is why it did not fit */
    status =
        sph_error_set(error, SPH_ERR_FILE, "cannot write to %s: %s", rows->path, strerror(why));
  }
  sph_text_free(row);
  return status;
}

int sph_rows_close(sph_rows *rows, sph_error *error)
{
  if (rows->fd < 0) return SPH_OK;
  int why = fsync(rows->fd) != 0 ? errno : 0;
  if (close(rows->fd) != 0 && !why) why = errno;
  rows->fd = -1;
  if (!why) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "cannot write %s: %s", rows->path, strerror(why));
}
