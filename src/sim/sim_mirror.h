/* sim_mirror.h -- ghosts: images of the fluid behind the planes of mirror walls. */
#ifndef SPH_SIM_MIRROR_H
#define SPH_SIM_MIRROR_H
#include "sim_rhs.h"

/* Normals of length 1; else what is wrong with the planes of a boundary is told. */
int sph_sim_mirror_take(sph_sim *sim, const sph_group *group, sph_boundary *boundary);
/* Before the run: do the planes of all mirrors fit each other, the box and the fluids? */
int sph_sim_mirror_check(sph_sim *sim);
/* An error where fluids differ and images of all are in one set. */
int sph_sim_mirror_one_liquid(sph_sim *sim);
/* At a list build: the ghosts of the positions in `built`, theirs too; with room for them. */
int sph_sim_mirror_make(sph_sim *sim);
/* Behind the sort: where the particles that have images stand. */
void sph_sim_mirror_find(sph_sim *sim);
/* A mirror along which fluids slip, so that behind it is their own reflection. */
int sph_sim_mirror_slips(const sph_group *group);
/* Sorted place of the particle that it is an image of. */
long sph_sim_mirror_parent(const sph_sim *sim, const sph_ghost *ghost);
/* a, a direction of the particle, as its ghost has it. */
void sph_sim_mirror_turn(const sph_sim *sim, const sph_ghost *ghost, double *a);
/* Slots from .. to - 1 of the records of all ghosts: as those of their particles. */
void sph_sim_mirror_copy(const sph_sim *sim, int from, int to);
/* B, the inverse gradient matrices of their particles, as ghosts have it: R B R. */
void sph_sim_mirror_matrices(const sph_sim *sim);
/* Has a mirror moved so far since the build that fluid without an image may be near it? */
int sph_sim_mirror_moved(const sph_sim *sim, double t);
/* Where the mirrors stand: part of what lists depend on. */
void sph_sim_mirror_stand(sph_sim *sim, double t);
/* Positions, masses, velocities of the ghosts of mirror g; then, behind eos, all the rest, which
 * may be SPH_RETRY. */
void sph_sim_mirror_place(const sph_evaluation *e, int g);
int sph_sim_mirror_fill(const sph_evaluation *e, int g);
/* Between steps: have mirrors face to face come nearer than their images may?  Then an error. */
int sph_sim_mirror_apart(sph_sim *sim);
/* Between steps: what is behind a mirror comes back, with its velocity reflected: by the symmetry
 * of images the same state, but for gravity.  Returns how many. */
long sph_sim_mirror_bounce(sph_sim *sim);

#endif
