/* h5.h -- HDF5 under one lock, silent, with failures that stick.
 *
 * Debian's HDF5 is not thread-safe and prints its error stack; between sph_h5_enter and
 * sph_h5_leave a thread has the library for itself, and its error handler is put aside. */
#ifndef SPH_H5_H
#define SPH_H5_H
#include <hdf5.h>

#include "sphode/base.h"

typedef struct sph_h5 {
  H5E_auto2_t handler; /* the caller's, and its argument */
  void *handler_data;
  int compression; /* of arrays: 1 to 9, as zlib's; 0: 1; -1: none */
  int failed;      /* some write since sph_h5_enter failed; later ones do nothing */
} sph_h5;

void sph_h5_enter(sph_h5 *h5);
void sph_h5_leave(sph_h5 *h5);

/* A file to read; < 0: there is none of that name, or it is none of HDF5, as error says. */
hid_t sph_h5_open(const char *path, sph_error *error);
/* A new group of that name; close it with H5Gclose. */
hid_t sph_h5_group(sph_h5 *h5, hid_t where, const char *name);
/* Attributes; count == 0: a scalar. */
void sph_h5_real(sph_h5 *h5, hid_t where, const char *name, hsize_t count, const double *value);
void sph_h5_integer(sph_h5 *h5, hid_t where, const char *name, hsize_t count, const int *value);
void sph_h5_string(sph_h5 *h5, hid_t where, const char *name, const char *value);
/* Dataset [rows][columns], columns == 0: [rows]; chunked, shuffled, deflated. */
void sph_h5_array(sph_h5 *h5, hid_t where, const char *name, hid_t stored, hid_t given,
                  hsize_t rows, hsize_t columns, const void *data);
/* A text of any length as a scalar dataset. */
void sph_h5_text(sph_h5 *h5, hid_t where, const char *name, const char *value);
void sph_h5_link(sph_h5 *h5, hid_t from, const char *name, hid_t to, const char *as);

/* Dataset [n], as it is, its groups made on the way.  Values in it, < 0: there is none. */
void sph_h5_plain(sph_h5 *h5, hid_t where, const char *path, hid_t stored, hid_t given, hsize_t n,
                  const void *data);
long sph_h5_count(hid_t where, const char *path);
/* All of them; an attribute, a string of at most size - 1 bytes: 0, or it is not there. */
int sph_h5_read(hid_t where, const char *path, hid_t given, void *data);
int sph_h5_read_real(hid_t where, const char *name, double *value);
int sph_h5_read_string(hid_t where, const char *name, char *value, size_t size);
/* What sph_h5_text wrote (sph_memory_free), or NULL. */
char *sph_h5_read_text(hid_t where, const char *name, sph_error *error);

/* A file in memory: HDF5 never meets a full disk (after which 1.10 may not close). */
hid_t sph_h5_create(sph_h5 *h5, const char *name);
/* Its bytes (sph_memory_free), then closes it; NULL: failed. */
void *sph_h5_close(sph_h5 *h5, hid_t file, size_t *size);
/* The same behind `front` zero bytes, which count. */
void *sph_h5_close_behind(sph_h5 *h5, hid_t file, size_t front, size_t *size);
/* A file from its bytes, to be read; name: of no file that exists. */
hid_t sph_h5_open_image(const char *name, const void *data, size_t size);

#endif
