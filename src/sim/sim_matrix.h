/* sim_matrix.h -- matrices of implicit stages: (M + gamma L) x = b over all fluid particles in
 * sorted order, group by group, or over the components of their velocities. */
#ifndef SPH_SIM_MATRIX_H
#define SPH_SIM_MATRIX_H
#include "csr.h"
#include "matrix_loops.h"
#include "sim_rhs.h"

/* Neighbours of an interaction by bits (mask_loops.h). */
typedef struct sph_masks {
  long *first;         /* [blocks + 1] */
  unsigned char *mask; /* [first[blocks]] */
  long room_first, room;
} sph_masks;

/* Who is coupled to whom: all pairs nearer than H + skin at the last list build, so that it lasts
 * as long as the lists. */
typedef struct sph_pattern {
  int groups;
  long builds;             /* of the lists that it belongs to */
  long number;             /* rises with each new pattern */
  int again;               /* it is that of a checkpoint, and to be made again under its number */
  long rows;               /* fluid particles */
  long base[SPH_SETS_MAX]; /* row of a group's first sorted particle */
  long *start;             /* [rows + 1] of the couplings of each */
  int *column;             /* [start[rows]] */
  int *filled;             /* [rows] scratch */
  sph_masks *masks;        /* [groups * groups] */
  long room_rows, room;
} sph_pattern;

/* Which coupling a matrix holds. */
enum sph_coupling {
  SPH_COUPLING_VISCOSITY,
  SPH_COUPLING_CONDUCTION,
  SPH_COUPLING_DIFFUSION,
  SPH_COUPLING_NONE /* of built-in terms */
};

typedef struct sph_matrix {
  int vector;                         /* of velocities whose components are coupled */
  int components;                     /* rows of a particle: 1, or dim of a vector */
  sph_csr A;                          /* its floor is M, to be set before it is filled */
  double *wall[SPH_MATRIX_WALL_SUMS]; /* [rows of the pattern] what walls add to the diagonal: one
                                         array, or the upper triangle of dim x dim by rows */
  long room;                          /* of wall */
  long pattern, values;               /* of the pattern that A has; rises whenever A is filled */
  /* What A was filled from, all that it depends on: where that is the same, A is. */
  double *from;
  long from_room, from_pattern; /* from_pattern 0: A depends on more, or is not filled */
  int from_coupling;
} sph_matrix;

/* Makes the pattern that of the present lists, if it is not; records hold positions, and do so
 * after it. */
int sph_sim_matrix_pattern(sph_evaluation *e, sph_pattern *pattern);
/* Gives a matrix that pattern; then A.floor has room. */
int sph_sim_matrix_shape(sph_sim *sim, const sph_pattern *pattern, sph_matrix *matrix);
/* Is it filled already, with the same gamma and coupling, from the same positions, densities,
 * masses and materials?  Else notes them for the next time; for couplings that depend on nothing
 * else. */
int sph_sim_matrix_same(sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                        double gamma, int coupling);
/* Fills it, given its floor, with gamma times the coupling of the terms of e->part; records are
 * packed.  No-slip or isothermal walls count as if what viscosity or conduction sees of them were
 * 2 x_wall - x_i: that makes 2 gamma sum_w k_iw on the diagonal. */
void sph_sim_matrix_fill(sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                         double gamma, int coupling);

/* Adds gamma times what the jacobian_pair of the registered terms of e->part give for an unknown,
 * enum tile_unknown; a scalar may be exchanged per volume. */
void sph_sim_matrix_add_tiles(sph_evaluation *e, const sph_pattern *pattern, sph_matrix *matrix,
                              double gamma, int unknown, int per_volume);
/* Of each target of group g the sum of the coupling with all neighbours, walls too: into the sums
 * of its sorted copy, of velocities the upper triangle by rows.  Returns the rows of a block. */
int sph_sim_matrix_sums(sph_evaluation *e, int g, int coupling);

double sph_sim_matrix_pattern_bytes(const sph_pattern *pattern);
double sph_sim_matrix_bytes(const sph_matrix *matrix);
void sph_sim_matrix_pattern_free(sph_pattern *pattern);
void sph_sim_matrix_free(sph_matrix *matrix);

#endif
