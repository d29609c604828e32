/* layout.h -- what the entries of the ODE vector are: one segment per group, field and
 * component (sph_segment, sphode/integrator.h). */
#ifndef SPH_LAYOUT_H
#define SPH_LAYOUT_H
#include "sphode/integrator.h"

typedef struct sph_layout {
  long length;  /* doubles in the block, padding included; a multiple of 8 */
  long entries; /* sum of n */
  int segments;
  sph_segment *segment; /* [segments], offsets rising */
} sph_layout;

#endif
