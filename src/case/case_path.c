#include "case_path.h"

#include <stdio.h>
#include <string.h>

int sph_case_path(const sph_case *c, const char *name, char path[SPH_CASE_PATH], sph_error *error)
{
  const char *slash = strrchr(c->path, '/');
  const int beside = slash && name[0] != '/' ? (int)(slash - c->path) + 1 : 0;
  const int n = snprintf(path, SPH_CASE_PATH, "%.*s%s", beside, c->path, name);
  if (n < SPH_CASE_PATH) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "%.100s...: path too long", name);
}
