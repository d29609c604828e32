/* vtu_array.h -- the numbers of one DataArray of VTK's XML files. */
#ifndef SPH_VTU_ARRAY_H
#define SPH_VTU_ARRAY_H
#include <stddef.h>

#include "sphode/base.h"

/* How they stand there: as text; as bytes; as bytes in base64. */
enum { SPH_VTU_ASCII, SPH_VTU_RAW, SPH_VTU_BASE64 };

/* What the head of a file says of the bytes of all its arrays. */
typedef struct sph_vtu_head {
  int swap; /* they have the other byte order */
  int wide; /* lengths are UInt64, else UInt32 */
  int zlib; /* they are compressed */
} sph_vtu_head;

/* The number of a type ("Float64"), or -1; its name, NULL behind the last. */
int sph_vtu_array_type(const char *name);
const char *sph_vtu_array_type_name(int type);

/* to[n] of the array that begins at data and ends somewhere before data[size], of text at it; text
 * has a character behind it that is no part of a number.  Errors say what is wrong, not where. */
int sph_vtu_array_read(const sph_vtu_head *head, int coding, int type, const char *data,
                       size_t size, double *to, size_t n, sph_error *error);

#endif
