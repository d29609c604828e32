#include <math.h>
#include <stdio.h>
#include <string.h>

#include "h5.h"
#include "memory.h"
#include "snapshot.h"
#include "table.h"

static const char *const part_names[SPH_PARTS] = {"PartType0", "PartType1"};

typedef struct reader {
  hid_t file;
  const char *path;
  sph_error *error;
} reader;

/* Field name without _x, _y, _z; component 0, 1, 2, or -1. */
static int split(const char *field, char name[64])
{
  size_t length = strlen(field);
  snprintf(name, 64, "%s", field);
  if (length < 3 || length > 63 || field[length - 2] != '_') return -1;
  const char *letter = strchr("xyz", field[length - 1]);
  if (!letter) return -1;
  name[length - 2] = '\0';
  return (int)(letter - "xyz");
}

/* Dataset [n] or [n][columns] as doubles; NULL without an error where there is none. */
static double *read_array(reader *r, hid_t group, const char *name, long n, int *columns)
{
  double *values = NULL;
  hsize_t size[2] = {0, 1};
  if (H5Lexists(group, name, H5P_DEFAULT) <= 0) return NULL;
  hid_t set = H5Dopen2(group, name, H5P_DEFAULT);
  hid_t space = set >= 0 ? H5Dget_space(set) : -1;
  int rank = space >= 0 ? H5Sget_simple_extent_ndims(space) : 0;
  if ((rank == 1 || rank == 2) && H5Sget_simple_extent_dims(space, size, NULL) >= 0 &&
      size[0] == (hsize_t)n && size[1] >= 1 && size[1] <= 3) {
    values = sph_memory_new((size_t)(size[0] * size[1]), sizeof *values, name, r->error);
    if (values && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
      sph_memory_free(values);
      values = NULL;
    }
  }
  *columns = (int)size[1];
  if (space >= 0) H5Sclose(space);
  if (set >= 0) H5Dclose(set);
  if (!values) sph_error_set(r->error, SPH_ERR_FILE, "%s: cannot read %s", r->path, name);
  return values;
}

/* The unit that stands at a dataset; "" where none does. */
static void read_unit(hid_t group, const char *name, char *unit, size_t size)
{
  char found[64] = "";
  if (H5Lexists(group, name, H5P_DEFAULT) <= 0) return;
  hid_t attribute = H5Aopen_by_name(group, name, "unit", H5P_DEFAULT, H5P_DEFAULT);
  hid_t type = attribute >= 0 ? H5Aget_type(attribute) : -1;
  if (type >= 0 && H5Tget_class(type) == H5T_STRING && !H5Tis_variable_str(type) &&
      H5Tget_size(type) < sizeof found && H5Aread(attribute, type, found) >= 0)
    snprintf(unit, size, "%s", found);
  if (type >= 0) H5Tclose(type);
  if (attribute >= 0) H5Aclose(attribute);
}

/* One component or the magnitude of values[n][columns], in place. */
static void reduce(double *values, long n, int columns, int component)
{
  for (long i = 0; i < n && columns > 1; i++) {
    const double *v = values + i * columns;
    double sum = 0;
    for (int d = 0; d < columns; d++) sum += v[d] * v[d];
    values[i] = component >= 0 && component < columns ? v[component] : sqrt(sum);
  }
}

static void read_part(reader *r, int part, const char *field, sph_snapshot *s)
{
  char name[64];
  int columns = 1, component = split(field, name);
  hid_t group = s->n[part] > 0 ? H5Gopen2(r->file, part_names[part], H5P_DEFAULT) : -1;
  if (group < 0) return;
  s->x[part] = read_array(r, group, "Coordinates", s->n[part], &columns);
  if (!s->x[part] || columns != 3)
    sph_error_set(r->error, SPH_ERR_FILE, "%s: %s has no coordinates", r->path, part_names[part]);
  s->value[part] = read_array(r, group, sph_snapshot_dataset(name), s->n[part], &columns);
  read_unit(group, sph_snapshot_dataset(name), s->unit, sizeof s->unit);
  if (s->dim == 1 && component < 0) component = 0; /* its sign says more than its magnitude */
  if (s->value[part]) reduce(s->value[part], s->n[part], columns, component);
  H5Gclose(group);
}

static void read_header(reader *r, sph_snapshot *s)
{
  static const char *const names[] = {"Time", "Spacing", "Dimension", "NumPart_ThisFile"};
  double time = 0, spacing = 0;
  int dim = 0, count[6] = {0}, bad = 0;
  void *to[] = {&time, &spacing, &dim, count};
  for (int k = 0; k < 4; k++) {
    hid_t attribute = H5Aopen_by_name(r->file, "Header", names[k], H5P_DEFAULT, H5P_DEFAULT);
    hid_t space = attribute >= 0 ? H5Aget_space(attribute) : -1;
    hssize_t found = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
    bad |= found != (k == 3 ? 6 : 1) ||
           H5Aread(attribute, k < 2 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT, to[k]) < 0;
    if (space >= 0) H5Sclose(space);
    if (attribute >= 0) H5Aclose(attribute);
  }
  if (bad || dim < 1 || dim > 3 || !(spacing > 0) || count[0] < 0 || count[1] < 0) {
    sph_error_set(r->error, SPH_ERR_FILE, "%s: not a snapshot of sphode", r->path);
    return;
  }
  s->time = time;
  s->spacing = spacing;
  s->dim = dim;
  for (int part = 0; part < SPH_PARTS; part++) s->n[part] = count[part];
}

static void check_field(reader *r, const char *field, const sph_snapshot *s)
{
  if (s->value[SPH_FLUIDS] || s->value[SPH_WALLS]) return;
  hid_t part =
      H5Gopen2(r->file, part_names[s->n[SPH_FLUIDS] > 0 ? SPH_FLUIDS : SPH_WALLS], H5P_DEFAULT);
  sph_table_unknown(part, r->path, field, r->error);
  if (part >= 0) H5Gclose(part);
}

int sph_snapshot_read(const char *path, const char *field, sph_snapshot *snapshot, sph_error *error)
{
  sph_h5 h5;
  sph_error own = {0};
  reader r = {.path = path, .error = &own};
  *snapshot = (sph_snapshot){0};
  sph_h5_enter(&h5);
  r.file = sph_h5_open(path, &own);
  if (own.status == SPH_OK) read_header(&r, snapshot);
  for (int part = 0; own.status == SPH_OK && part < SPH_PARTS; part++)
    read_part(&r, part, field, snapshot);
  if (own.status == SPH_OK) check_field(&r, field, snapshot);
  if (r.file >= 0) H5Fclose(r.file);
  sph_h5_leave(&h5);
  if (own.status == SPH_OK) return SPH_OK;
  sph_snapshot_read_free(snapshot);
  return sph_error_set(error, own.status, "%s", own.text);
}

const char *sph_snapshot_read_default(const char *path)
{
  const char *dataset = sph_snapshot_dataset("velocity");
  sph_h5 h5;
  sph_error own = {0};
  int found = 0;
  sph_h5_enter(&h5);
  const hid_t file = sph_h5_open(path, &own);
  for (int part = 0; file >= 0 && part < SPH_PARTS; part++)
    if (H5Lexists(file, part_names[part], H5P_DEFAULT) > 0) {
      const hid_t group = H5Gopen2(file, part_names[part], H5P_DEFAULT);
      found |= group >= 0 && H5Lexists(group, dataset, H5P_DEFAULT) > 0;
      if (group >= 0) H5Gclose(group);
    }
  if (file >= 0) H5Fclose(file);
  sph_h5_leave(&h5);
  return found || file < 0 ? "velocity" : "density";
}

int sph_snapshot_read_time(const char *path, double *time, sph_error *error)
{
  sph_h5 h5;
  sph_error own = {0};
  sph_snapshot snapshot = {0};
  reader r = {.path = path, .error = &own};
  sph_h5_enter(&h5);
  r.file = sph_h5_open(path, &own);
  if (own.status == SPH_OK) read_header(&r, &snapshot);
  if (r.file >= 0) H5Fclose(r.file);
  sph_h5_leave(&h5);
  *time = snapshot.time;
  return own.status == SPH_OK ? SPH_OK : sph_error_set(error, own.status, "%s", own.text);
}

void sph_snapshot_read_free(sph_snapshot *snapshot)
{
  for (int part = 0; part < SPH_PARTS; part++) {
    sph_memory_free(snapshot->x[part]);
    sph_memory_free(snapshot->value[part]);
  }
  *snapshot = (sph_snapshot){0};
}
