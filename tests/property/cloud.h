/* cloud.h -- points on a lattice of the unit box, shaken, for tests of operators. */
#ifndef CLOUD_H
#define CLOUD_H
#include "sphode.h"

typedef struct cloud {
  int dim, periodic;   /* in all directions */
  long n;              /* across^dim */
  double dx;           /* 1/across [m] */
  double *x[3];        /* [n] [m] */
  double *volume;      /* [n] dx^dim, or, with uneven, up to 30 % off */
  double *density;     /* [n] 1, or, with uneven, 0.5 to 1.5 */
  unsigned long state; /* of its noise */
} cloud;

/* Each coordinate is off by up to jitter dx.  Memory that fails ends the program. */
cloud cloud_make(int dim, int across, double jitter, int periodic, int uneven);
void cloud_free(cloud *c);
double cloud_noise(cloud *c); /* -1 to 1 */

/* Operators on it; def: kernel, h, threads and so on.  A failure ends the test. */
sph_operator *cloud_operator(const cloud *c, sph_operator_def def);

/* [n] zeros, freed by free(). */
double *cloud_array(long n);

#endif
