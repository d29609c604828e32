/* plot_curve.h -- the points of a curve, from a table or a snapshot. */
#ifndef SPH_PLOT_CURVE_H
#define SPH_PLOT_CURVE_H
#include "sphode/output.h"

enum { SPH_PLOT_TITLE = 128 };

typedef struct sph_plot_points {
  double *x, *y; /* [n] as they are drawn: shifted and scaled; NaN: a gap */
  long n;
  double time;                                           /* [s]; NaN: of no single time */
  char x_title[SPH_PLOT_TITLE], y_title[SPH_PLOT_TITLE]; /* columns, with units */
} sph_plot_points;

int sph_plot_curve_read(const sph_plot_curve *curve, sph_plot_points *points, sph_error *error);
void sph_plot_curve_free(sph_plot_points *points);
/* "J/m" of "kinetic [J/m]"; "": it has none. */
void sph_plot_curve_unit(const char *title, char unit[SPH_PLOT_TITLE]);

#endif
