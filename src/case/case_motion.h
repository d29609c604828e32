/* case_motion.h -- the steady motion of a wall, which an event may change. */
#ifndef SPH_CASE_MOTION_H
#define SPH_CASE_MOTION_H
#include "sphode/boundary.h"
#include "sphode/checkpoint.h"
#include "sphode/sim.h"

typedef struct sph_case_motion {
  double since;                        /* [s] the velocity is this one; */
  double displacement[3], velocity[3]; /* the displacement there [m], [m/s] */
  int slide;                           /* in its own plane: no displacement */
  int changed;                         /* by an event */
} sph_case_motion;

/* Takes a boundary along; motion: freed with it. */
void sph_case_motion_set(sph_boundary *boundary, sph_case_motion *motion);
/* For checkpoints: what an event made of it (sph_kept.keep). */
int sph_case_motion_keep(void *motion, sph_sim *sim, sph_keep *keep, sph_error *error);
/* From t on it moves as `next` says, from where it is. */
void sph_case_motion_change(sph_case_motion *motion, double t, const sph_case_motion *next);

#endif
