/* table.h -- the particles of a file, field by field: what export writes and import reads. */
#ifndef SPH_TABLE_H
#define SPH_TABLE_H
#include "h5.h"

enum { SPH_TABLE_FIELDS = 48, SPH_TABLE_NAME = 64 };

typedef struct sph_table_field {
  char name[SPH_TABLE_NAME]; /* of the field table, or what the file says; "id", "group" */
  char unit[SPH_TABLE_NAME]; /* "" where the file tells none */
  int columns;               /* 1; a vector: 3 */
  int whole;                 /* integers */
  double *data;              /* [n][columns] */
} sph_table_field;

typedef struct sph_table {
  int dim; /* 0: the file does not tell */
  double time;
  double mass; /* of each particle, where the header tells it, not a field; 0 */
  long n;
  int fields;
  sph_table_field field[SPH_TABLE_FIELDS];
} sph_table;

/* Part 0 (fluids) or 1 (walls) of an HDF5 file in GADGET's layout, fields in the order position,
 * velocity, others by name; n 0: there are none.  wanted: names with spaces or commas between
 * them, and what position needs; NULL: all. */
int sph_table_read(sph_table *table, const char *path, int part, const char *wanted,
                   sph_error *error);
/* The same of VTK's XML (.vtu, .vtp): their points and the wanted of the data at these.  Without
 * Expat and zlib: SPH_ERR_UNBUILT, what to install. */
int sph_table_vtu_read(sph_table *table, const char *path, const char *wanted, sph_error *error);
/* The error about a field that is not among those of an open group of particles (< 0: it has none).
 */
int sph_table_unknown(hid_t part, const char *path, const char *field, sph_error *error);
/* Is the name among the words of the list? */
int sph_table_listed(const char *list, const char *name);
/* NULL: there is none. */
const sph_table_field *sph_table_find(const sph_table *table, const char *name);
void sph_table_free(sph_table *table);

#endif
