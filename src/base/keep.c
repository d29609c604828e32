#include "keep.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int sph_keep_reading(const sph_keep *keep) { return keep && keep->reading; }

static int item(sph_keep *keep, const char *name, int kind, long n, void *value)
{
  char path[SPH_KEEP_PATH];
  if (!keep) return SPH_ERR_ARGUMENT;
  if (keep->error->status) return keep->error->status;
  if (!name || !*name || n < 0 || (n > 0 && !value))
    return sph_error_set(keep->error, SPH_ERR_ARGUMENT, "keep: %ld values of \"%.60s\" at %s", n,
                         name ? name : "", value ? "an array" : "NULL");
  if (snprintf(path, sizeof path, "%s%s", keep->path, name) >= (int)sizeof path)
    return sph_error_set(keep->error, SPH_ERR_ARGUMENT, "keep: the name %.60s... is too long",
                         path);
  return n ? keep->item(keep, path, kind, n, value) : SPH_OK;
}

int sph_keep_has(sph_keep *keep, const char *name)
{
  char path[SPH_KEEP_PATH];
  if (!keep || keep->error->status || !keep->reading || !name) return 0;
  snprintf(path, sizeof path, "%s%s", keep->path, name);
  return keep->has(keep, path);
}

int sph_keep_real(sph_keep *keep, const char *name, long n, double *value)
{
  return item(keep, name, SPH_KEEP_REAL, n, value);
}

int sph_keep_integer(sph_keep *keep, const char *name, long n, long *value)
{
  return item(keep, name, SPH_KEEP_INTEGER, n, value);
}

int sph_keep_int(sph_keep *keep, const char *name, int *value)
{
  long wide = *value;
  int status = sph_keep_integer(keep, name, 1, &wide);
  *value = (int)wide;
  return status;
}

void sph_keep_enter(sph_keep *keep, const char *name)
{
  size_t used = strlen(keep->path);
  if (snprintf(keep->path + used, sizeof keep->path - used, "%s/", name) >=
      (int)(sizeof keep->path - used))
    sph_error_set(keep->error, SPH_ERR_ARGUMENT, "keep: the name %.60s... is too long", keep->path);
}

void sph_keep_leave(sph_keep *keep)
{
  size_t used = strlen(keep->path);
  if (used) keep->path[used - 1] = '\0';
  char *slash = strrchr(keep->path, '/');
  *(slash ? slash + 1 : keep->path) = '\0';
}

void sph_keep_tell(sph_keep *keep, const char *format, ...)
{
  va_list arguments;
  if (!keep->told) return;
  const size_t used = strlen(keep->told);
  if (used + 2 >= keep->told_size) return;
  if (used) memcpy(keep->told + used, "\n", 2);
  char *to = keep->told + strlen(keep->told);
  va_start(arguments, format);
  vsnprintf(to, keep->told_size - (size_t)(to - keep->told), format, arguments);
  va_end(arguments);
}

int sph_keep_match(sph_keep *keep, const char *name, long value)
{
  long found = value;
  int status = sph_keep_integer(keep, name, 1, &found);
  if (status || found == value) return status;
  return sph_error_set(keep->error, SPH_ERR_FILE,
                       "it is of another simulation: %s%s is %ld there, %ld here", keep->path, name,
                       found, value);
}

int sph_keep_word(sph_keep *keep, const char *name, const char *word)
{
  char found[64];
  snprintf(found, sizeof found, "%s", word);
  long n = keep->reading ? (long)sizeof found : (long)strlen(found);
  int status = item(keep, name, SPH_KEEP_WORD, n, found);
  return !status && !strcmp(found, word);
}
