#include "case_path.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* directory/files/NAME with + in place of /, and in front of a dot, which would hide it; the
 * directory is `length` letters long. */
static int kept_path(const char *directory, int length, const char *name, char path[SPH_CASE_PATH])
{
  const int n =
      snprintf(path, SPH_CASE_PATH, "%.*sfiles/%s", length, directory, name[0] == '.' ? "+" : "");
  const size_t left = strlen(name);
  if (n + (int)left >= SPH_CASE_PATH) return 0;
  for (size_t k = 0; k <= left; k++) path[(size_t)n + k] = (char)(name[k] == '/' ? '+' : name[k]);
  return 1;
}

int sph_case_path_kept(const char *directory, const char *name, char path[SPH_CASE_PATH],
                       sph_error *error)
{
  char with[SPH_CASE_PATH];
  const int n = snprintf(with, sizeof with, "%s/", directory);
  if (n < SPH_CASE_PATH && kept_path(with, n, name, path)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "%.100s...: path too long", name);
}

int sph_case_path(const sph_case *c, const char *name, char path[SPH_CASE_PATH], sph_error *error)
{
  const char *slash = strrchr(c->path, '/');
  const int directory = slash ? (int)(slash - c->path) + 1 : 0;
  if (kept_path(c->path, directory, name, path) && !access(path, F_OK)) return SPH_OK;
  const int n =
      snprintf(path, SPH_CASE_PATH, "%.*s%s", name[0] != '/' ? directory : 0, c->path, name);
  if (n < SPH_CASE_PATH) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "%.100s...: path too long", name);
}
