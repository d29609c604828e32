/* shape_sample.h -- points of a surface, and how far the nearest of them is. */
#ifndef SPH_SHAPE_SAMPLE_H
#define SPH_SHAPE_SAMPLE_H
#include "shape_data.h"

typedef struct sph_shape_sample sph_shape_sample;

/* Points on the surface of a shape that ends somewhere, at most `apart` from each other along it
 * [m], found again up to the distance `reach` [m].  NULL: told. */
sph_shape_sample *sph_shape_sample_create(const sph_shape *shape, double apart, double reach,
                                          sph_error *error);
/* Distance of the nearest one; where it is more than reach, some number above reach. */
double sph_shape_sample_nearest(const sph_shape_sample *sample, const double x[3]);
void sph_shape_sample_free(sph_shape_sample *sample);

#endif
