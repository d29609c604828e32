/* csv.h -- one column of a table: comma separated, # lines are comments, one header line. */
#ifndef SPH_CSV_H
#define SPH_CSV_H
#include "sphode/base.h"

/* Rows of a table: those whose column `column` holds the word `is`; column NULL: all. */
typedef struct sph_csv_rows {
  const char *column, *is;
} sph_csv_rows;

/* Column by name, where a unit in brackets is not part of it ("front" finds "front [m]"), or, name
 * NULL, number `column` from 0.  *values[*n] (sph_memory_free); title: the header's word, with its
 * unit.  What is no number is an error with its line. */
int sph_csv_read(const char *path, const char *name, int column, double **values, long *n,
                 char title[128], sph_error *error);
int sph_csv_read_rows(const char *path, sph_csv_rows rows, const char *name, int column,
                      double **values, long *n, char title[128], sph_error *error);

/* The name of column k = 0, 1, ..., without its unit: 1; 0 behind the last one; or < 0. */
int sph_csv_name(const char *path, int k, char name[128], sph_error *error);

#endif
