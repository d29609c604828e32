#include "checkpoint_file.h"
#include "keep.h"
#include "sim_keep.h"

static int read_item(sph_keep *keep, const char *name, int kind, long n, void *value)
{
  const hid_t state = *(const hid_t *)keep->ctx;
  const hid_t here[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_LONG, H5T_NATIVE_UCHAR};
  long found = sph_h5_count(state, name);
  int right = kind == SPH_KEEP_WORD ? found < n : found == n;
  if (found < 0)
    return sph_error_set(keep->error, SPH_ERR_FILE, "it is of another simulation: it has no %s",
                         name);
  if (!right)
    return sph_error_set(keep->error, SPH_ERR_FILE,
                         "it is of another simulation: %s has %ld values, %ld are right here", name,
                         found, n);
  if (sph_h5_read(state, name, here[kind], value))
    return sph_error_set(keep->error, SPH_ERR_FILE, "%s cannot be read", name);
  if (kind == SPH_KEEP_WORD) ((char *)value)[found] = '\0';
  return SPH_OK;
}

static int has_item(sph_keep *keep, const char *name)
{
  return sph_h5_count(*(const hid_t *)keep->ctx, name) >= 0;
}

int sph_checkpoint_read(sph_sim *sim, const char *path)
{
  return sph_checkpoint_read_told(sim, path, NULL, 0);
}

int sph_checkpoint_read_told(sph_sim *sim, const char *path, char *told, size_t size)
{
  sph_error own = {0}, walk = {0};
  sph_h5 h5;
  if (told && size) told[0] = '\0';
  int status = sph_sim_evaluate(sim);
  if (status) return status;
  hid_t file = sph_checkpoint_file_open(path, &h5, &own);
  hid_t state = file >= 0 ? H5Gopen2(file, "State", H5P_DEFAULT) : -1;
  sph_keep keep = {.reading = 1,
                   .item = read_item,
                   .has = has_item,
                   .ctx = &state,
                   .error = &walk,
                   .told = size ? told : NULL,
                   .told_size = size};
  if (!own.status) sph_sim_keep(sim, &keep);
  if (walk.status) sph_error_set(&own, walk.status, "checkpoint %s: %s", path, walk.text);
  if (state >= 0) H5Gclose(state);
  sph_checkpoint_file_close(file, &h5);
  return own.status ? sph_sim_fail(sim, own.status, "%s", own.text) : SPH_OK;
}
