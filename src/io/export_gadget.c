#include <stdio.h>
#include <string.h>

#include "export_format.h"
#include "h5.h"
#include "memory.h"
#include "snapshot.h"

static const char *dataset_of(const sph_table_field *field)
{
  static const char *const more[][2] = {{"id", "ParticleIDs"},
                                        {"group", "Group"},
                                        {"smoothing_length", "SmoothingLength"}};
  for (size_t k = 0; k < sizeof more / sizeof *more; k++)
    if (!strcmp(field->name, more[k][0])) return more[k][1];
  return sph_snapshot_dataset(field->name);
}

static void write_part(sph_h5 *h5, hid_t file, int number, const sph_table *table, int single)
{
  char name[32];
  snprintf(name, sizeof name, "PartType%d", number);
  hid_t part = sph_h5_group(h5, file, name);
  for (int k = 0; k < table->fields; k++) {
    const sph_table_field *f = &table->field[k];
    const char *as = dataset_of(f);
    hid_t stored = f->whole ? H5T_STD_I64LE : single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    sph_h5_array(h5, part, as, stored, H5T_NATIVE_DOUBLE, (hsize_t)table->n,
                 f->columns == 3 ? 3 : 0, f->data);
    hid_t set = h5->failed ? -1 : H5Dopen2(part, as, H5P_DEFAULT);
    if (set < 0) continue;
    if (f->unit[0]) sph_h5_string(h5, set, "unit", f->unit);
    H5Dclose(set);
  }
  if (part >= 0) H5Gclose(part);
}

/* What tells about the particles, as it is; then the precision. */
static void copy_head(sph_h5 *h5, hid_t from, hid_t file, int single)
{
  static const char *const names[] = {"Header", "Units", "Groups", "Code"};
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    if (!h5->failed && H5Lexists(from, names[k], H5P_DEFAULT) > 0)
      h5->failed |= H5Ocopy(from, names[k], file, names[k], H5P_DEFAULT, H5P_DEFAULT) < 0;
  hid_t header = h5->failed ? -1 : H5Gopen2(file, "Header", H5P_DEFAULT);
  const int twice = !single;
  if (header < 0) return;
  H5Adelete(header, "Flag_DoublePrecision");
  sph_h5_integer(h5, header, "Flag_DoublePrecision", 0, &twice);
  H5Gclose(header);
}

void *sph_export_gadget(const char *source, const sph_table part[2], int single, size_t *size,
                        sph_error *error)
{
  sph_h5 h5;
  void *image = NULL;
  sph_h5_enter(&h5);
  hid_t from = H5Fopen(source, H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t file = from >= 0 ? sph_h5_create(&h5, "export") : -1;
  if (file >= 0) {
    copy_head(&h5, from, file, single);
    for (int k = 0; k < 2; k++)
      if (part[k].n > 0) write_part(&h5, file, k, &part[k], single);
    image = sph_h5_close(&h5, file, size);
  }
  if (from >= 0) H5Fclose(from);
  sph_h5_leave(&h5);
  if (!image)
    sph_error_set(error, SPH_ERR_MEMORY, "%s: HDF5 could not make the copy for GADGET", source);
  return image;
}
