#include "h5.h"

#include <pthread.h>
#include <string.h>
#include <unistd.h>

#include "memory.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; /* HDF5's state is the process's */

void sph_h5_enter(sph_h5 *h5)
{
  pthread_mutex_lock(&lock);
  *h5 = (sph_h5){0};
  H5Eget_auto2(H5E_DEFAULT, &h5->handler, &h5->handler_data);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

void sph_h5_leave(sph_h5 *h5)
{
  H5Eclear2(H5E_DEFAULT);
  H5Eset_auto2(H5E_DEFAULT, h5->handler, h5->handler_data);
  pthread_mutex_unlock(&lock);
}

static void check(sph_h5 *h5, int ok)
{
  if (!ok) h5->failed = 1;
}

hid_t sph_h5_open(const char *path, sph_error *error)
{
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    sph_error_set(error, SPH_ERR_FILE,
                  access(path, F_OK) ? "%s: no such HDF5 file"
                                     : "%s: is no HDF5 file, or is cut short, or may not be read",
                  path);
  return file;
}

hid_t sph_h5_group(sph_h5 *h5, hid_t where, const char *name)
{
  if (h5->failed) return H5I_INVALID_HID;
  hid_t group = H5Gcreate2(where, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  check(h5, group >= 0);
  return group;
}

static void attribute(sph_h5 *h5, hid_t where, const char *name, hid_t stored, hid_t given,
                      hsize_t count, const void *value)
{
  if (h5->failed) return;
  hid_t space = count ? H5Screate_simple(1, &count, NULL) : H5Screate(H5S_SCALAR);
  hid_t made = H5Acreate2(where, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
  check(h5, made >= 0 && H5Awrite(made, given, value) >= 0);
  if (made >= 0) H5Aclose(made);
  H5Sclose(space);
}

void sph_h5_real(sph_h5 *h5, hid_t where, const char *name, hsize_t count, const double *value)
{
  attribute(h5, where, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, value);
}

void sph_h5_integer(sph_h5 *h5, hid_t where, const char *name, hsize_t count, const int *value)
{
  attribute(h5, where, name, H5T_STD_I32LE, H5T_NATIVE_INT, count, value);
}

/* The type of exactly this string, without its NUL; ASCII where it is, as VTK wants it. */
static hid_t string_type(const char *value)
{
  int ascii = 1;
  for (const char *c = value; *c; c++) ascii = ascii && (unsigned char)*c < 0x80;
  hid_t type = H5Tcopy(H5T_C_S1);
  size_t length = strlen(value);
  H5Tset_size(type, length ? length : 1);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  return type;
}

void sph_h5_string(sph_h5 *h5, hid_t where, const char *name, const char *value)
{
  hid_t type = string_type(value);
  attribute(h5, where, name, type, type, 0, value);
  H5Tclose(type);
}

void sph_h5_text(sph_h5 *h5, hid_t where, const char *name, const char *value)
{
  if (h5->failed) return;
  hid_t type = string_type(value), space = H5Screate(H5S_SCALAR);
  hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(list, 0);
  hid_t made = H5Dcreate2(where, name, type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  check(h5, made >= 0 && H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
  if (made >= 0) H5Dclose(made);
  H5Pclose(list);
  H5Sclose(space);
  H5Tclose(type);
}

/* Chunks of at most 16384 rows, shuffled and deflated where the library can; none for no rows. */
static hid_t layout(int rank, const hsize_t *size, int compression)
{
  hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(list, 0); /* the same run gives the same bytes */
  if (size[0] == 0) return list;
  hsize_t chunk[2] = {size[0] < 16384 ? size[0] : 16384, size[1]};
  H5Pset_chunk(list, rank, chunk);
  if (compression >= 0 && H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) {
    H5Pset_shuffle(list);
    H5Pset_deflate(list, compression ? (unsigned)compression : 1);
  }
  return list;
}

void sph_h5_array(sph_h5 *h5, hid_t where, const char *name, hid_t stored, hid_t given,
                  hsize_t rows, hsize_t columns, const void *data)
{
  if (h5->failed) return;
  int rank = columns ? 2 : 1;
  hsize_t size[2] = {rows, columns};
  hid_t space = H5Screate_simple(rank, size, NULL), list = layout(rank, size, h5->compression);
  hid_t made = H5Dcreate2(where, name, stored, space, H5P_DEFAULT, list, H5P_DEFAULT);
  check(h5,
        made >= 0 && (!rows || H5Dwrite(made, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0));
  if (made >= 0) H5Dclose(made);
  H5Pclose(list);
  H5Sclose(space);
}

void sph_h5_link(sph_h5 *h5, hid_t from, const char *name, hid_t to, const char *as)
{
  if (h5->failed) return;
  check(h5, H5Lcreate_hard(from, name, to, as, H5P_DEFAULT, H5P_DEFAULT) >= 0);
}

hid_t sph_h5_create(sph_h5 *h5, const char *name)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, (size_t)1 << 22, 0);
  hid_t file = H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Pclose(access);
  check(h5, file >= 0);
  return file;
}

void sph_h5_plain(sph_h5 *h5, hid_t where, const char *path, hid_t stored, hid_t given, hsize_t n,
                  const void *data)
{
  if (h5->failed) return;
  hid_t space = H5Screate_simple(1, &n, NULL), list = H5Pcreate(H5P_DATASET_CREATE);
  hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_obj_track_times(list, 0);
  hid_t made = H5Dcreate2(where, path, stored, space, links, list, H5P_DEFAULT);
  check(h5, made >= 0 && H5Dwrite(made, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  if (made >= 0) H5Dclose(made);
  H5Pclose(links);
  H5Pclose(list);
  H5Sclose(space);
}

long sph_h5_count(hid_t where, const char *path)
{
  hid_t set = H5Dopen2(where, path, H5P_DEFAULT), space = set >= 0 ? H5Dget_space(set) : -1;
  hssize_t n = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  if (space >= 0) H5Sclose(space);
  if (set >= 0) H5Dclose(set);
  return (long)n;
}

int sph_h5_read(hid_t where, const char *path, hid_t given, void *data)
{
  hid_t set = H5Dopen2(where, path, H5P_DEFAULT);
  int bad = set < 0 || H5Dread(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0;
  if (set >= 0) H5Dclose(set);
  return bad;
}

/* Room for one is all that its readers have. */
static int is_one(hid_t space)
{
  const int one = space >= 0 && H5Sget_simple_extent_npoints(space) == 1;
  if (space >= 0) H5Sclose(space);
  return one;
}

int sph_h5_read_real(hid_t where, const char *name, double *value)
{
  hid_t attribute = H5Aopen(where, name, H5P_DEFAULT);
  int bad = attribute < 0 || !is_one(H5Aget_space(attribute)) ||
            H5Aread(attribute, H5T_NATIVE_DOUBLE, value) < 0;
  if (attribute >= 0) H5Aclose(attribute);
  return bad;
}

int sph_h5_read_string(hid_t where, const char *name, char *value, size_t size)
{
  hid_t attribute = H5Aopen(where, name, H5P_DEFAULT);
  hid_t type = attribute >= 0 ? H5Aget_type(attribute) : -1;
  int bad = type < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) ||
            H5Tget_size(type) >= size || !is_one(H5Aget_space(attribute));
  memset(value, 0, size);
  if (!bad) bad = H5Aread(attribute, type, value) < 0;
  if (type >= 0) H5Tclose(type);
  if (attribute >= 0) H5Aclose(attribute);
  return bad;
}

char *sph_h5_read_text(hid_t where, const char *name, sph_error *error)
{
  hid_t set = H5Dopen2(where, name, H5P_DEFAULT), type = set >= 0 ? H5Dget_type(set) : -1;
  char *text = NULL;
  if (type >= 0 && H5Tget_class(type) == H5T_STRING && !H5Tis_variable_str(type) &&
      is_one(H5Dget_space(set)))
    text = sph_memory_new(H5Tget_size(type) + 1, 1, name, error);
  if (text && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0) text[0] = '\0';
  if (type >= 0) H5Tclose(type);
  if (set >= 0) H5Dclose(set);
  return text;
}

hid_t sph_h5_open_image(const char *name, const void *data, size_t size)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, (size_t)1 << 22, 0);
  hid_t file = H5Pset_file_image(access, (void *)data, size) < 0
                   ? H5I_INVALID_HID
                   : H5Fopen(name, H5F_ACC_RDONLY, access);
  H5Pclose(access);
  return file;
}

void *sph_h5_close(sph_h5 *h5, hid_t file, size_t *size)
{
  return sph_h5_close_behind(h5, file, 0, size);
}

void *sph_h5_close_behind(sph_h5 *h5, hid_t file, size_t front, size_t *size)
{
  char *image = NULL;
  if (file < 0) return NULL;
  check(h5, H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0);
  ssize_t bytes = h5->failed ? -1 : H5Fget_file_image(file, NULL, 0);
  if (bytes > 0) image = sph_memory_take(front + (size_t)bytes, 1);
  check(h5, image && H5Fget_file_image(file, image + front, (size_t)bytes) == bytes);
  H5Fclose(file);
  *size = bytes > 0 ? front + (size_t)bytes : 0;
  if (!h5->failed) return image;
  sph_memory_free(image);
  return NULL;
}
