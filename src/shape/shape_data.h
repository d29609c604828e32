/* shape_data.h -- what a shape is.  Internal: files of shape/ share it. */
#ifndef SPH_SHAPE_DATA_H
#define SPH_SHAPE_DATA_H
#include <stddef.h>

#include "sphode/shape.h"

struct sph_shape {
  int dim;
  /* Where its distance is the distance, not only a bound of it: behind its surface, before it. */
  int exact_inside, exact_outside;
  double lower[3], upper[3]; /* a box around it; infinite: none */
  double (*distance)(const sph_shape *s, const double x[3]);
  void (*release)(void *ctx); /* what ctx holds besides itself; NULL: nothing */
  void *ctx;                  /* of the file that made it; owned */
  int parts;
  sph_shape **part; /* [parts] owned */
};

/* One without parts, exact, endless; ctx zeroed, of these bytes.  NULL: told. */
sph_shape *sph_shape_data_new(int dim, size_t bytes, sph_error *error);
/* The same of parts, which it owns, also where it fails; `what` stands in messages. */
sph_shape *sph_shape_data_of(int n, sph_shape *const *part, size_t bytes, const char *what,
                             sph_error *error);
/* Are these finite?  Else told. */
int sph_shape_data_finite(const char *what, int n, const double *x, sph_error *error);
double sph_shape_data_dot(const double a[3], const double b[3]);
/* Distance of p from the segment a b in the plane. */
double sph_shape_data_segment(const double p[2], const double a[2], const double b[2]);

#endif
