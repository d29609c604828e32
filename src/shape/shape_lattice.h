/* shape_lattice.h -- lattices: a cell of some points, repeated.  Of each, a point has the volume
 * dx^dim. */
#ifndef SPH_SHAPE_LATTICE_H
#define SPH_SHAPE_LATTICE_H
#include "sphode/base.h"

enum { SPH_SHAPE_LATTICE_POINTS = 4 };

typedef struct sph_shape_lattice {
  const char *name;
  int dim; /* 0: any */
  int points;
  double cell[3];                            /* its sides, over dx */
  double point[SPH_SHAPE_LATTICE_POINTS][3]; /* over its sides */
} sph_shape_lattice;

/* The lattice of a name (NULL: the simple one) in so many dimensions, or NULL, told. */
const sph_shape_lattice *sph_shape_lattice_find(const char *name, int dim, sph_error *error);

#endif
