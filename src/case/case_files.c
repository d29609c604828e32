/* The files that a case names, kept beside its text: results can be run again, and go on, when the
 * originals have moved. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "case_path.h"
#include "file.h"
#include "memory.h"
#include "sphode/case.h"

static const long LARGEST = 64L << 20; /* larger ones are linked to [bytes] */

static int copy(const char *from, const char *to, long size, sph_error *error)
{
  char *data = sph_memory_new((size_t)size + 1, 1, "a copy of a file", error);
  FILE *file = data ? fopen(from, "rb") : NULL;
  const size_t got = file ? fread(data, 1, (size_t)size, file) : 0;
  if (data && (!file || ferror(file)))
    sph_error_set(error, SPH_ERR_FILE, "cannot read %s: %s", from, strerror(errno));
  if (file) fclose(file);
  if (data && !error->status) sph_file_replace(to, data, got, error);
  sph_memory_free(data);
  return error->status;
}

static int keep_one(const sph_case *c, const char *name, const char *directory, sph_error *error)
{
  char from[SPH_CASE_PATH], to[SPH_CASE_PATH], real[PATH_MAX], there[PATH_MAX];
  struct stat file;
  if (sph_case_path(c, name, from, error) || sph_case_path_kept(directory, name, to, error))
    return error->status;
  if (stat(from, &file) || !S_ISREG(file.st_mode) || !realpath(from, real)) return SPH_OK;
  if (realpath(to, there) && !strcmp(real, there)) return SPH_OK; /* it goes on */
  *strrchr(to, '/') = '\0';
  if (sph_file_make_directory(to, error)) return error->status;
  to[strlen(to)] = '/';
  if (file.st_size <= LARGEST) return copy(from, to, (long)file.st_size, error);
  unlink(to);
  if (!symlink(real, to)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "cannot link %s to %s: %s", to, real, strerror(errno));
}

static int keep_all(const sph_case *c, const sph_case_node *node, const char *directory,
                    sph_error *error)
{
  int status = SPH_OK;
  if (node->kind == SPH_CASE_SCALAR && node->key && node->text[0] &&
      (!strcmp(node->key, "file") || !strcmp(node->key, "path")))
    status = keep_one(c, node->text, directory, error);
  for (const sph_case_node *child = node->first; child && !status; child = child->next)
    status = keep_all(c, child, directory, error);
  return status;
}

int sph_case_files_keep(const sph_case *c, const char *directory, sph_error *error)
{
  sph_error own = {0};
  if (!error) error = &own;
  if (!c || !directory)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "files of a case: no %s (NULL)",
                         c ? "directory" : "case");
  return keep_all(c, c->root, directory, error);
}
