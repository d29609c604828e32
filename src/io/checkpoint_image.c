/* A checkpoint in memory: /Checkpoint tells what it is of, /State holds each item under the name of
 * the part that remembers it. */
#include <stdio.h>

#include "checkpoint_file.h"
#include "keep.h"
#include "memory.h"
#include "sim_keep.h"
#include "versions.h"

typedef struct items {
  sph_h5 h5;
  hid_t state; /* the group of all items */
} items;

static int write_item(sph_keep *keep, const char *name, int kind, long n, void *value)
{
  items *all = keep->ctx;
  const hid_t stored[] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_U8LE};
  const hid_t given[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_LONG, H5T_NATIVE_UCHAR};
  sph_h5_plain(&all->h5, all->state, name, stored[kind], given[kind], (hsize_t)n, value);
  return SPH_OK; /* h5.failed tells */
}

static int has_item(sph_keep *keep, const char *name)
{
  (void)keep, (void)name;
  return 0;
}

static void describe(sph_h5 *h5, hid_t file, const sph_sim *sim, const sph_checkpoint_def *def)
{
  sph_sim_stats stats;
  char name[32];
  sph_sim_get_stats(sim, &stats);
  hid_t about = sph_h5_group(h5, file, "Checkpoint");
  const double time = sph_sim_time(sim), step = (double)stats.step.steps;
  sph_h5_real(h5, about, "Time", 0, &time);
  sph_h5_real(h5, about, "Step", 0, &step);
  sph_h5_string(h5, about, "Version", sph_version());
  sph_h5_string(h5, about, "SUNDIALS", sph_versions_sundials());
  sph_h5_string(h5, about, "InstructionSet", sph_sim_isa(sim));
  if (def->case_path) sph_h5_text(h5, about, "CasePath", def->case_path);
  if (def->case_text) sph_h5_text(h5, about, "Case", def->case_text);
  if (def->command) sph_h5_text(h5, about, "Command", def->command);
  for (int k = 0; k < def->sets; k++) {
    snprintf(name, sizeof name, "Set%d", k);
    sph_h5_text(h5, about, name, def->set[k]);
  }
  if (about >= 0) H5Gclose(about);
}

unsigned char *sph_checkpoint_image(const char *path, sph_sim *sim, const sph_checkpoint_def *def,
                                    size_t *size, sph_error *error)
{
  sph_error own = {0};
  items all = {.state = -1};
  sph_h5_enter(&all.h5);
  hid_t file = sph_h5_create(&all.h5, path);
  if (file >= 0) describe(&all.h5, file, sim, def);
  all.state = sph_h5_group(&all.h5, file, "State");
  sph_keep keep = {.item = write_item, .has = has_item, .ctx = &all, .error = &own};
  if (!all.h5.failed) sph_sim_keep(sim, &keep);
  if (all.state >= 0) H5Gclose(all.state);
  unsigned char *image = sph_h5_close_behind(&all.h5, file, SPH_CHECKPOINT_HEADER, size);
  sph_h5_leave(&all.h5);
  if (own.status)
    sph_error_set(error, own.status, "checkpoint %s: %s", path, own.text);
  else if (!image)
    sph_error_set(error, SPH_ERR_MEMORY, "checkpoint %s: out of memory, or HDF5 failed", path);
  if (!own.status) return image;
  sph_memory_free(image);
  return NULL;
}
