/* sphode/checkpoint.h -- a run in a file, from which it goes on with the same bits.
 *
 * A checkpoint is made between steps and changes nothing: a run with checkpoints takes the same
 * course as one without, and one that goes on from any of them the same as one that was never
 * interrupted, to the last bit, for every integrator and any number of threads (on the same
 * instruction set, with the same SUNDIALS and this version of the library; relaxed steps agree to
 * what their Newton's method leaves, which starts from a factor that ARKODE does not tell).  To
 * that end it holds all that the simulation remembers: the state, positions and order of the last
 * list build, what the integrator, its controller and its linear solvers know of the steps so far,
 * sides of events, counts of modifiers, places in the output files, and what sph_keep functions
 * add.
 *
 * To go on: make the simulation as it was made for its start (the same groups, terms, integrator,
 * outputs, events, modifiers), then sph_checkpoint_read, then sph_sim_run.
 *
 * The file is HDF5 behind a header of 512 bytes with its version, length and checksum.  It is
 * written under a temporary name, synchronised and renamed: there are whole files only, and one
 * with a damaged byte is refused. */
#ifndef SPHODE_CHECKPOINT_H
#define SPHODE_CHECKPOINT_H
#include <stddef.h>

#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

struct sph_sim;

/* When: the conditions that are given, each by itself; and always at the end of sph_sim_run, also
 * where the progress callback or an event stops it. */
typedef struct sph_checkpoint_def {
  const char *directory; /* of checkpoint_00000123.hdf (steps so far); made if need be; copied */
  long steps;            /* every so many accepted steps; 0: not by steps */
  double interval;       /* [s] of simulated time, from the start of the run; 0: not by it */
  double wall;           /* [s] of wall time; 0: not by it */
  int keep;              /* the last so many stay; 0: 2 */
  /* Of a case file, for sphode restart; all copied. */
  const char *case_path, *case_text; /* NULL: none */
  const char *command;               /* the command line that made the run; NULL: none */
  int sets;                          /* --set texts, */
  const char *const *set;            /* [sets] */
} sph_checkpoint_def;

/* Checkpoints are written while sph_sim_run goes on.  After the outputs were added, before or
 * between runs; a later call takes the place of the one before. */
SPH_API void sph_checkpoint_set(struct sph_sim *sim, const sph_checkpoint_def *def);
/* One now, between steps; sph_checkpoint_set told where. */
SPH_API int sph_checkpoint_write(struct sph_sim *sim);
/* Bytes of one now, which is not written; likewise.  < 0: a status. */
SPH_API long sph_checkpoint_size(struct sph_sim *sim);

/* The simulation goes on from that file.  A status: SPH_ERR_FILE where the file is damaged, of
 * another version, of another simulation, or where a table of an output has other columns; the
 * simulation is then of no use any more.  A table that is gone, or shorter than it was, is no
 * failure: it begins anew, or goes on behind the last frame that is whole. */
SPH_API int sph_checkpoint_read(struct sph_sim *sim, const char *path);
/* The same; told[size]: what is not as it was then, as such a table, a line each; "": all is. */
SPH_API int sph_checkpoint_read_told(struct sph_sim *sim, const char *path, char *told,
                                     size_t size);

/* What a file says of itself. */
typedef struct sph_checkpoint_info {
  double time; /* [s] */
  long step;
  char version[32], sundials[32], isa[32]; /* that wrote it */
  int same;                                /* version and SUNDIALS are those of this library */
  char *case_path, *case_text, *command;   /* NULL: none */
  int sets;
  char **set; /* [sets] */
} sph_checkpoint_info;

/* Checks the whole file, too; a status.  To be freed, unless it failed. */
SPH_API int sph_checkpoint_info_read(const char *path, sph_checkpoint_info *info, sph_error *error);
SPH_API void sph_checkpoint_info_free(sph_checkpoint_info *info);
/* The path of the checkpoint with the k-th most steps, k = 0, 1, ..., in path[size] (NULL: not
 * wanted); 0: there is none, or no such directory. */
SPH_API int sph_checkpoint_find(const char *directory, int k, char *path, size_t size);

/* ---- what callbacks remember ----
 * A keep function names what is to be kept, and is called both ways: when a checkpoint is written
 * it tells these numbers, when one is read it gets them back. */
typedef struct sph_keep sph_keep;

SPH_API int sph_keep_reading(const sph_keep *keep); /* 1: values are set; 0: they are stored */
/* When reading: is there such an item? */
SPH_API int sph_keep_has(sph_keep *keep, const char *name);
/* n numbers of that name, [A-Za-z0-9_.-]; the status of the first failure, after which they do
 * nothing. */
SPH_API int sph_keep_real(sph_keep *keep, const char *name, long n, double *value);
SPH_API int sph_keep_integer(sph_keep *keep, const char *name, long n, long *value);

/* Of a modifier, an integrator of your own, a term, a motion: what its ctx remembers from step to
 * step. */
typedef struct sph_kept {
  const char *name; /* [A-Za-z0-9_.-], at most 95, no other one's; copied */
  int (*keep)(void *ctx, struct sph_sim *sim, sph_keep *keep, sph_error *error);
  void *ctx;            /* borrowed unless free is given */
  void (*free)(void *); /* called once; may be NULL */
} sph_kept;

SPH_API void sph_sim_keep_add(struct sph_sim *sim, sph_kept kept);

#ifdef __cplusplus
}
#endif
#endif
