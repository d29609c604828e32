/* case_motion.h -- what a wall does over time: a steady velocity, or a displacement by expressions
 * in t, which an event may change into another steady one; a rotation; the heat of its surface. */
#ifndef SPH_CASE_MOTION_H
#define SPH_CASE_MOTION_H
#include "case_value.h"
#include "sphode/boundary.h"
#include "sphode/checkpoint.h"
#include "sphode/sim.h"

enum { SPH_CASE_WHAT = 300 };

typedef struct sph_case_motion {
  double since;                        /* [s] the velocity is this one; */
  double displacement[3], velocity[3]; /* the displacement there [m], [m/s] */
  int slide;                           /* in its own plane: no displacement */
  int changed;                         /* by an event */
  /* Owned; NULL: a steady velocity.  What they say at t = 0; the step of differences [s]. */
  sph_case_formula *formula[3];
  double start[3], step;
  sph_case_formula *angle; /* owned; NULL: a steady rate [1/s] */
  double angle_start, rate;
  char what[4][SPH_CASE_WHAT];               /* of the formulas and the angle, for messages */
  sph_case_formula *temperature, *heat_flux; /* owned; NULL: not by these */
} sph_case_motion;

/* Takes a boundary along, which moves and turns where asked; motion: freed with it. */
void sph_case_motion_set(sph_boundary *boundary, sph_case_motion *motion, int moves, int turns);
void sph_case_motion_free(void *motion);
/* From here on by its formulas; 0 or a status where one is not finite at t = 0. */
int sph_case_motion_begin(sph_case_motion *motion, double step);
/* For checkpoints: what an event made of it (sph_kept.keep). */
int sph_case_motion_keep(void *motion, sph_sim *sim, sph_keep *keep, sph_error *error);
/* From t on it moves as `next` says, from where it is. */
void sph_case_motion_change(sph_case_motion *motion, double t, const sph_case_motion *next);

#endif
