#include "file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "memory.h"

int sph_file_path(char path[SPH_PATH], const char *directory, const char *name, sph_error *error)
{
  if (!directory || !*directory)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "no directory given for %s", name);
  int length = snprintf(path, SPH_PATH, "%s/%s", directory, name);
  if (length >= SPH_PATH)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "path of %d bytes: at most %d (%.60s...)", length,
                         SPH_PATH - 1, directory);
  return SPH_OK;
}

static int make_one(const char *path, sph_error *error)
{
  struct stat info;
  if (mkdir(path, 0777) == 0) return SPH_OK;
  int why = errno;
  if (why == EEXIST && stat(path, &info) == 0 && S_ISDIR(info.st_mode)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "cannot make directory %s: %s", path,
                       why == EEXIST ? "a file has this name" : strerror(why));
}

int sph_file_make_directory(const char *path, sph_error *error)
{
  char part[SPH_PATH];
  int status = sph_file_path(part, path, "", error); /* ends in "/", so that the last is made too */
  for (char *slash = part + 1; status == SPH_OK && (slash = strchr(slash, '/')); slash++) {
    *slash = '\0';
    status = make_one(part, error);
    *slash = '/';
  }
  return status;
}

int sph_file_write(int fd, const void *data, size_t size)
{
  const char *at = data;
  while (size) {
    ssize_t done = write(fd, at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return -1;
    at += done;
    size -= (size_t)done;
  }
  return 0;
}

/* The name of a renamed file is safe on disk only when its directory is. */
static void sync_directory(const char *path)
{
  char directory[SPH_PATH];
  snprintf(directory, sizeof directory, "%s", path);
  char *slash = strrchr(directory, '/');
  snprintf(slash ? slash + 1 : directory, 2, ".");
  int fd = open(directory, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

int sph_file_replace(const char *path, const void *data, size_t size, sph_error *error)
{
  char temporary[SPH_PATH + 8];
  snprintf(temporary, sizeof temporary, "%s.tmp", path);
  int why = 0, fd = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) {
    why = errno;
  } else {
    if (sph_file_write(fd, data, size) != 0 || fsync(fd) != 0) why = errno;
    if (close(fd) != 0 && !why) why = errno;
    if (!why && rename(temporary, path) != 0) why = errno;
    if (why) unlink(temporary);
  }
  if (why)
    return sph_error_set(error, SPH_ERR_FILE, "cannot write %s (%zu bytes): %s", path, size,
                         strerror(why));
  sync_directory(path);
  return SPH_OK;
}

int sph_file_read(const char *path, char **text, size_t *size, sph_error *error)
{
  struct stat info;
  FILE *file = fopen(path, "rb");
  if (!file) return sph_error_set(error, SPH_ERR_FILE, "cannot read %s: %s", path, strerror(errno));
  int status = SPH_OK;
  if (fstat(fileno(file), &info) != 0 || !S_ISREG(info.st_mode))
    status = sph_error_set(error, SPH_ERR_FILE, "cannot read %s: it is no file", path);
  if (!status) {
    *size = (size_t)info.st_size;
    *text = sph_memory_new(*size + 1, 1, path, error);
    if (!*text) status = SPH_ERR_MEMORY;
  }
  if (!status && fread(*text, 1, *size, file) != *size)
    status = sph_error_set(error, SPH_ERR_FILE, "cannot read %s: it became shorter", path);
  fclose(file);
  return status;
}

void sph_file_remove_stale(const char *directory, const char *prefix)
{
  char path[SPH_PATH];
  size_t head = strlen(prefix);
  DIR *entries = opendir(directory);
  if (!entries) return;
  for (struct dirent *entry; (entry = readdir(entries));) {
    size_t length = strlen(entry->d_name);
    if (length < head + 4 || strncmp(entry->d_name, prefix, head) != 0) continue;
    if (strcmp(entry->d_name + length - 4, ".tmp") != 0) continue;
    if (sph_file_path(path, directory, entry->d_name, NULL) == SPH_OK) unlink(path);
  }
  closedir(entries);
}
