/* file.h -- whole files or none: temporary name, fsync, rename, fsync of the directory. */
#ifndef SPH_FILE_H
#define SPH_FILE_H
#include <stddef.h>

#include "sphode/base.h"

enum { SPH_PATH = 4096 }; /* bytes of a path, with its NUL */

/* path = directory/name; a status (too long, directory NULL or empty). */
int sph_file_path(char path[SPH_PATH], const char *directory, const char *name, sph_error *error);
/* Makes a directory and those above it; existing ones are fine. */
int sph_file_make_directory(const char *path, sph_error *error);
/* All of these bytes; not 0: errno says why not. */
int sph_file_write(int fd, const void *data, size_t size);
/* Makes path hold these bytes, or leaves it as it was and records why. */
int sph_file_replace(const char *path, const void *data, size_t size, sph_error *error);
/* A whole file: *text[*size] with a NUL behind (sph_memory_free). */
int sph_file_read(const char *path, char **text, size_t *size, sph_error *error);
/* Removes directory/prefix*.tmp: what a killed run left. */
void sph_file_remove_stale(const char *directory, const char *prefix);

#endif
