/* case_motion.h -- the steady motion of a wall, which an event may change. */
#ifndef SPH_CASE_MOTION_H
#define SPH_CASE_MOTION_H
#include "sphode/boundary.h"

typedef struct sph_case_motion {
  double since;                        /* [s] the velocity is this one; */
  double displacement[3], velocity[3]; /* the displacement there [m], [m/s] */
  int slide;                           /* in its own plane: no displacement */
} sph_case_motion;

/* Takes a boundary along; motion: freed with it. */
void sph_case_motion_set(sph_boundary *boundary, sph_case_motion *motion);
/* From t on it moves as `next` says, from where it is. */
void sph_case_motion_change(sph_case_motion *motion, double t, const sph_case_motion *next);

#endif
