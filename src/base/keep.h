/* keep.h -- one walk over all that is remembered, for writing and for reading it.
 *
 * What layers above do with the items is theirs (io/checkpoint_file.c): here they have names. */
#ifndef SPH_KEEP_H
#define SPH_KEEP_H
#include "sphode/checkpoint.h"

enum { SPH_KEEP_PATH = 400 };

enum sph_keep_kind { SPH_KEEP_REAL, SPH_KEEP_INTEGER, SPH_KEEP_WORD };

struct sph_keep {
  int reading;
  char path[SPH_KEEP_PATH]; /* of the present group: "", "integrator/", ... */
  /* Stores or fills n values at path; of a word n is its length, or when reading its room. */
  int (*item)(sph_keep *keep, const char *path, int kind, long n, void *value);
  int (*has)(sph_keep *keep, const char *path);
  void *ctx; /* theirs */
  sph_error *error;
  char *told; /* [told_size], what a reader should know, lines; NULL: nobody asks */
  size_t told_size;
};

/* Items between them belong to a group of that name. */
void sph_keep_enter(sph_keep *keep, const char *name);
void sph_keep_leave(sph_keep *keep);
/* One that must be the same when it is read: a failure that tells both, if it is not. */
int sph_keep_match(sph_keep *keep, const char *name, long value);
/* Writes a word of at most 63 letters, or reads it: is it this one? */
int sph_keep_word(sph_keep *keep, const char *name, const char *word);
/* When reading: a line of what went on differently than it was, as a table that is gone. */
void sph_keep_tell(sph_keep *keep, const char *format, ...) SPH_PRINTF(2, 3);
int sph_keep_int(sph_keep *keep, const char *name, int *value);

#endif
