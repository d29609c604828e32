/* rows.h -- a table that grows by whole rows, each in the file before the run goes on. */
#ifndef SPH_ROWS_H
#define SPH_ROWS_H
#include "file.h"
#include "keep.h"
#include "text.h"

typedef struct sph_rows {
  char path[SPH_PATH];
  int fd;     /* -1: closed */
  int framed; /* frames end with an empty line */
} sph_rows;

/* A new file directory/name, empty; the directory is made. */
int sph_rows_open(sph_rows *rows, const char *directory, const char *name, sph_error *error);
/* One write; what does not fit on the disk is taken back.  Frees the row. */
int sph_rows_append(sph_rows *rows, sph_text *row, sph_error *error);
/* For a checkpoint: what is in the file is on disk.  When one is read: opens the file, which begins
 * with `header`, and cuts off the rows that came after the checkpoint.  One that is gone or shorter
 * begins anew, or goes on behind its last whole frame, told. */
int sph_rows_keep(sph_rows *rows, const char *directory, const char *name, const char *header,
                  sph_keep *keep);
/* Synchronises and closes it, if it is open. */
int sph_rows_close(sph_rows *rows, sph_error *error);

#endif
