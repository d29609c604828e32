/* snapshot.h -- one frame as an HDF5 file: write it, read it back. */
#ifndef SPH_SNAPSHOT_H
#define SPH_SNAPSHOT_H
#include <stddef.h>

#include "sphode/base.h"
#include "sphode/sim.h"

enum { SPH_FLUIDS, SPH_WALLS, SPH_PARTS }; /* GADGET's particle types 0 and 1 */

/* The bytes of a snapshot of the state that sim shows (sph_memory_free), or NULL.  name tells whose
 * file it will be, for messages; of def what is kept in it and how. */
void *sph_snapshot_image(const char *name, sph_sim *sim, const sph_hdf5_def *def, size_t *size,
                         sph_error *error);
/* Does a snapshot hold the field, where these are asked for (sph_hdf5_def)?  NULL: all are. */
int sph_snapshot_holds(const char *fields, const char *field);
/* Are the names in def->fields those of fields?  NULL: yes. */
int sph_snapshot_check_fields(const sph_sim *sim, const char *fields, sph_error *error);
/* The bytes of a file whose /VTKHDF is the walls of the snapshot `target` in the same directory. */
void *sph_snapshot_image_walls(const char *target, size_t *size, sph_error *error);

/* What a picture needs of a snapshot. */
typedef struct sph_snapshot {
  int dim;
  double time, spacing;     /* [s], [m] */
  long n[SPH_PARTS];        /* particles */
  double *x[SPH_PARTS];     /* [n][3] [m] */
  double *value[SPH_PARTS]; /* [n] of the field asked for; NULL: this part has none */
  char unit[64];            /* of the field */
} sph_snapshot;

/* field: a name of the field table, with _x, _y, _z for one component of a vector (else its
 * magnitude). */
int sph_snapshot_read(const char *path, const char *field, sph_snapshot *snapshot,
                      sph_error *error);
void sph_snapshot_read_free(sph_snapshot *snapshot);
/* The field that is drawn where none is named: velocity, or density where it was not written. */
const char *sph_snapshot_read_default(const char *path);

/* Its time alone [s]. */
int sph_snapshot_read_time(const char *path, double *time, sph_error *error);

/* The dataset that holds a field of the table ("velocity": "Velocities"). */
const char *sph_snapshot_dataset(const char *field);
/* And back. */
const char *sph_snapshot_field(const char *dataset);

#endif
