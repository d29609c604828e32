#include <stdio.h>
#include <string.h>

#include "checkpoint_file.h"
#include "memory.h"
#include "versions.h"

enum { SETS_MAX = 1000 };

/* Texts: NULL where there is none. */
static void read_about(hid_t about, sph_checkpoint_info *info, sph_error *error)
{
  double step = 0;
  sph_h5_read_real(about, "Time", &info->time);
  sph_h5_read_real(about, "Step", &step);
  info->step = (long)step;
  sph_h5_read_string(about, "Version", info->version, sizeof info->version);
  sph_h5_read_string(about, "SUNDIALS", info->sundials, sizeof info->sundials);
  sph_h5_read_string(about, "InstructionSet", info->isa, sizeof info->isa);
  info->same =
      !strcmp(info->version, sph_version()) && !strcmp(info->sundials, sph_versions_sundials());
  info->case_path = sph_h5_read_text(about, "CasePath", error);
  info->case_text = sph_h5_read_text(about, "Case", error);
  info->command = sph_h5_read_text(about, "Command", error);
  info->set = SPH_NEW(char *, SETS_MAX, "settings", error);
  for (int k = 0; info->set && !error->status && k < SETS_MAX; k++) {
    char name[32];
    snprintf(name, sizeof name, "Set%d", k);
    info->set[k] = sph_h5_read_text(about, name, error);
    if (!info->set[k]) break;
    info->sets = k + 1;
  }
}

int sph_checkpoint_info_read(const char *path, sph_checkpoint_info *info, sph_error *error)
{
  sph_error own = {0};
  sph_h5 h5;
  if (!info)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "checkpoint %s: no place for what it says (NULL)",
                         path ? path : "(NULL)");
  *info = (sph_checkpoint_info){0};
  hid_t file = sph_checkpoint_file_open(path, &h5, &own);
  hid_t about = file >= 0 ? H5Gopen2(file, "Checkpoint", H5P_DEFAULT) : -1;
  if (about >= 0)
    read_about(about, info, &own);
  else if (!own.status)
    sph_checkpoint_file_refuse(&own, path, "HDF5 cannot read it");
  if (about >= 0) H5Gclose(about);
  sph_checkpoint_file_close(file, &h5);
  if (!own.status) return SPH_OK;
  sph_checkpoint_info_free(info);
  return sph_error_set(error, own.status, "%s", own.text);
}

void sph_checkpoint_info_free(sph_checkpoint_info *info)
{
  if (!info) return;
  for (int k = 0; info->set && k < info->sets; k++) sph_memory_free(info->set[k]);
  sph_memory_free(info->set);
  sph_memory_free(info->case_path);
  sph_memory_free(info->case_text);
  sph_memory_free(info->command);
  *info = (sph_checkpoint_info){0};
}
