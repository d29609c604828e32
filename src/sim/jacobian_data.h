/* jacobian_data.h -- what a Jacobian is made of. */
#ifndef SPH_JACOBIAN_DATA_H
#define SPH_JACOBIAN_DATA_H
#include "jacobian_pattern.h"
#include "sphode/jacobian.h"

typedef struct jacobian {
  sph_jacobian open; /* first: the user has a pointer to it */
  sph_sim *sim;
  int lagged;
  long *place;             /* [n] */
  long *segment_row;       /* [segments]: first row of each segment */
  long base[SPH_SETS_MAX]; /* numbers of fluid particles */
  long particles;
  sph_sets set;         /* on which particles those of each depend */
  int *colour, colours; /* [particles] */
  long *first;          /* [n + 1] */
  int *column;
  double *value;
  /* Product p of f' with a vector, one for each segment and colour, fills entries filled[p] to
   * filled[p + 1] - 1 of entry[], which lie in the rows row[]. */
  long *filled, *entry;
  int *row;
  double *s, *out; /* [layout.length] */
} jacobian;

#endif
