/* picture.h -- particles coloured by a field, one frame or several on a sheet, by gnuplot. */
#ifndef SPH_PICTURE_H
#define SPH_PICTURE_H
#include "snapshot.h"

typedef struct sph_picture {
  const char *field;
  double width, height;           /* of the sheet, at most [pixels] */
  double cell[2];                 /* of places on a grid instead of particles [m]; 0: particles */
  char axis[2];                   /* names of the directions drawn; 0: x, y, z */
  long frames, particles, values; /* that were shown; of fluids, in all of them; of `value` */
  double *value;                  /* some of the values that will be seen, SI */
  double from, to;                /* of the colours, SI */
  int dim, across, up;            /* the directions drawn */
  int slice;                      /* the direction looked along in 3D, or -1 */
  double slice_at, spacing;       /* [m] */
  double box_lo[SPH_PARTS][3], box_hi[SPH_PARTS][3]; /* of all particles [m] */
  double lo[2], hi[2];                               /* of what is drawn [m] */
  char field_unit[64];
  double unit;   /* SI value of the unit that is drawn: 1000 for kPa */
  double length; /* and that of the axes: 0.001 for mm */
  const char *length_unit;
  char label[120];      /* "pressure [kPa]" */
  int decimals;         /* of the time; 0: as many as it needs */
  int n, columns, rows; /* panels */
  double panel[2];      /* size of one [pixels] */
} sph_picture;

/* All frames that will be drawn are shown to it in turn: for the bounds; behind sph_picture_view,
 * unless the range of colours is given, for their values, of which that is made: it leaves out half
 * a percent of all at either end, so that one splash does not bleach the rest (in 1D none).  Then
 * any of them are drawn, n of them in a sheet. */
void sph_picture_bound(sph_picture *p, const sph_snapshot *frame);
void sph_picture_view(sph_picture *p);
int sph_picture_take(sph_picture *p, const sph_snapshot *frame, sph_error *error);
void sph_picture_range(sph_picture *p); /* also frees the values */
/* All of this, for frames of one dimension. */
int sph_picture_sheet(sph_picture *p, const sph_snapshot *frame, int n, const char *png,
                      sph_error *error);
int sph_picture_draw(sph_picture *p, const sph_snapshot *frame, int n, const char *png,
                     sph_error *error);

#endif
