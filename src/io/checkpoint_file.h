/* checkpoint_file.h -- the file of a checkpoint: HDF5 behind a header with version and checksum. */
#ifndef SPH_CHECKPOINT_FILE_H
#define SPH_CHECKPOINT_FILE_H
#include "h5.h"
#include "sphode/checkpoint.h"
#include "sphode/sim.h"

enum { SPH_CHECKPOINT_HEADER = 512 };

/* Writes the header to the first bytes of an image, and it to a file: the whole of it or none. */
int sph_checkpoint_file_write(const char *path, unsigned char *image, size_t size,
                              sph_error *error);
/* A checked file, < 0: recorded.  Also then HDF5 is entered, until it is closed. */
hid_t sph_checkpoint_file_open(const char *path, sph_h5 *h5, sph_error *error);
void sph_checkpoint_file_close(hid_t file, sph_h5 *h5);
/* Records SPH_ERR_FILE: "checkpoint path: why". */
int sph_checkpoint_file_refuse(sph_error *error, const char *path, const char *why);

/* What a simulation remembers, behind room for the header (sph_memory_free); NULL: recorded. */
unsigned char *sph_checkpoint_image(const char *path, sph_sim *sim, const sph_checkpoint_def *def,
                                    size_t *size, sph_error *error);

#endif
