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
  if (status == SPH_OK && sph_file_write(rows->fd, row->data, row->length) != 0) {
    const int why = errno;
    if (ftruncate(rows->fd, end) != 0) errno = why; /* a device; told is why it did not fit */
    status =
        sph_error_set(error, SPH_ERR_FILE, "cannot write to %s: %s", rows->path, strerror(why));
  }
  sph_text_free(row);
  return status;
}

static int cannot(const sph_rows *rows, sph_error *error)
{
  return sph_error_set(error, SPH_ERR_FILE, "cannot go on with %s: %s", rows->path,
                       strerror(errno));
}

/* Does the file begin with the first n letters of the header? */
static int begins(int fd, const char *header, size_t n)
{
  char part[256];
  for (size_t at = 0; at < n;) {
    size_t wanted = n - at < sizeof part ? n - at : sizeof part;
    ssize_t got = pread(fd, part, wanted, (off_t)at);
    if (got <= 0 || memcmp(part, header + at, (size_t)got) != 0) return 0;
    at += (size_t)got;
  }
  return 1;
}

/* Where the last whole frame ends, at `least` or behind it. */
static off_t whole(const sph_rows *rows, off_t size, off_t least)
{
  char end[2];
  for (; size > least; size--) {
    if (pread(rows->fd, end, 2, size - 2) != 2) break;
    if (end[1] == '\n' && (!rows->framed || end[0] == '\n')) return size;
  }
  return least;
}

/* A file that has not all that was in it then. */
static int mend(sph_rows *rows, const char *header, off_t size, long bytes, sph_keep *keep)
{
  const off_t least = (off_t)strlen(header);
  const off_t stays = size < least ? 0 : whole(rows, size, least);
  if (ftruncate(rows->fd, stays) != 0) return cannot(rows, keep->error);
  if (stays)
    sph_keep_tell(keep, "%s has %ld bytes, had %ld then: rows are missing, it goes on from there",
                  rows->path, (long)size, bytes);
  else
    sph_keep_tell(keep, "%s is %s: it begins anew", rows->path,
                  size ? "cut short" : "gone or empty");
  if (stays || sph_file_write(rows->fd, header, (size_t)least) == 0) return SPH_OK;
  return cannot(rows, keep->error);
}

static int reopen(sph_rows *rows, const char *header, long bytes, sph_keep *keep)
{
  rows->fd = open(rows->path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (rows->fd < 0) return cannot(rows, keep->error);
  const off_t size = lseek(rows->fd, 0, SEEK_END), length = (off_t)strlen(header);
  if (!begins(rows->fd, header, (size_t)(size < length ? size : length)))
    return sph_error_set(keep->error, SPH_ERR_FILE, "%s has other columns", rows->path);
  if (size < bytes) return mend(rows, header, size, bytes, keep);
  return ftruncate(rows->fd, bytes) == 0 ? SPH_OK : cannot(rows, keep->error);
}

int sph_rows_keep(sph_rows *rows, const char *directory, const char *name, const char *header,
                  sph_keep *keep)
{
  long bytes = 0;
  if (!sph_keep_reading(keep)) {
    if (fsync(rows->fd) != 0)
      return sph_error_set(keep->error, SPH_ERR_FILE, "cannot write %s: %s", rows->path,
                           strerror(errno));
    bytes = (long)lseek(rows->fd, 0, SEEK_END);
    return sph_keep_integer(keep, "bytes", 1, &bytes);
  }
  int status = sph_file_path(rows->path, directory, name, keep->error);
  if (!status) status = sph_keep_integer(keep, "bytes", 1, &bytes);
  return status ? status : reopen(rows, header, bytes, keep);
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
