/* rows.h -- a table that grows by whole rows, each in the file before the run goes on. */
#ifndef SPH_ROWS_H
#define SPH_ROWS_H
#include "file.h"
#include "text.h"

typedef struct sph_rows {
  char path[SPH_PATH];
  int fd; /* -1: closed */
} sph_rows;

/* A new file directory/name, empty; the directory is made. */
int sph_rows_open(sph_rows *rows, const char *directory, const char *name, sph_error *error);
/* One write; what does not fit on the disk is taken back.  Frees the row. */
int sph_rows_append(sph_rows *rows, sph_text *row, sph_error *error);
/* Synchronises and closes it, if it is open. */
int sph_rows_close(sph_rows *rows, sph_error *error);

#endif
