/* gnuplot.h -- runs gnuplot, without a shell, on a script that stays beside its picture. */
#ifndef SPH_GNUPLOT_H
#define SPH_GNUPLOT_H
#include "text.h"

/* Names of the files of one picture: png "dir/x.png" has the script x.gp and the data x.dat. */
typedef struct sph_gnuplot {
  char directory[4096];
  char png[300], script[300],
      data[300]; /* in the directory; "./" first: gnuplot takes | and < as commands */
} sph_gnuplot;

int sph_gnuplot_names(sph_gnuplot *names, const char *png, sph_error *error);
/* Head of a script: terminal of width x height [pixels], output, looks. */
void sph_gnuplot_begin(const sph_gnuplot *names, sph_text *script, int width, int height);
/* Writes script and data (both freed), runs gnuplot.  None: SPH_ERR_UNBUILT, what to install. */
int sph_gnuplot_run(const sph_gnuplot *names, sph_text *script, sph_text *data, sph_error *error);

#endif
