#include "case_path.h"

#include <stdio.h>
#include <string.h>

int sph_case_path(const sph_case *c, const sph_case_node *node, const char *name,
                  char path[SPH_CASE_PATH], sph_error *error)
{
  const char *from = node && node->file ? node->file : c->path, *slash = strrchr(from, '/');
  const int beside = slash && name[0] != '/' ? (int)(slash - from) + 1 : 0;
  const int n = snprintf(path, SPH_CASE_PATH, "%.*s%s", beside, from, name);
  if (n < SPH_CASE_PATH) return SPH_OK;
  return sph_error_set(error, SPH_ERR_FILE, "%.100s...: path too long", name);
}
