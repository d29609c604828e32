/* sim_unknown.h -- one unknown of an implicit stage: its rows, its right-hand side, its solution.
 * Internal: files of implicit stages share it. */
#ifndef SPH_SIM_UNKNOWN_H
#define SPH_SIM_UNKNOWN_H
#include "linear.h"
#include "sim_matrix.h"

/* Fields that are solved for, one after the other. */
enum sph_unknown_number {
  SPH_UNKNOWN_DENSITY,
  SPH_UNKNOWN_VELOCITY,
  SPH_UNKNOWN_ENERGY,
  SPH_UNKNOWN_SCALAR, /* + number of the scalar */
  SPH_UNKNOWNS = SPH_UNKNOWN_SCALAR + SPH_SCALARS_MAX
};

/* What one of them is solved with. */
typedef struct sph_unknown {
  int there, number;    /* terms of it are implicit; enum sph_unknown_number */
  unsigned called;      /* bit k: terms.call[k] is among them */
  int per_volume;       /* scalars */
  int drags;            /* by drag, too: then dust takes part */
  int components;       /* columns of the scalar matrix; dim with the vector matrix, too */
  int direct;           /* f is linear: what the matrix has, what walls add, and the heating */
  int meets_walls;      /* walls add to it */
  sph_part part, walls; /* its terms; they between fluids and walls alone */
  int coupling;         /* enum sph_coupling */
  sph_matrix *matrix;
  sph_linear *solver;
} sph_unknown;

struct sph_implicit {
  sph_unknown unknown[SPH_UNKNOWNS];
  int heats;        /* implicit terms of the velocity heat an energy */
  int loops;        /* what comes later acts back on what comes before */
  sph_part heating; /* the terms that do */
  sph_pattern pattern;
  sph_matrix scalar, vector;
  sph_linear *solver[2];     /* of these */
  N_Vector rate, last, norm; /* the last two where it loops */
  long rows;                 /* room */
  /* Row by row, [rows * dim]: the unknown, before and after; right-hand side; 1 / scale. */
  double *x, *old, *b, *weight;
  double *heat; /* [rows] rate of the energy by terms of the velocity */
};

/* One stage at work: views of its vectors. */
typedef struct sph_solving {
  sph_sim *sim;
  struct sph_implicit *own;
  sph_stage *stage;
  sph_view z[SPH_SETS_MAX], known[SPH_SETS_MAX], rate[SPH_SETS_MAX];
} sph_solving;

/* Of walls nothing is solved for, of dust only what drag and registered terms act on. */
int sph_sim_unknown_takes_part(const sph_group *group, const sph_unknown *u);
/* What the phases before pairs see of the iterate z. */
sph_evaluation sph_sim_unknown_evaluation(const sph_solving *s, const sph_part *part);
/* Is an iterate near enough, after changes that shrink like these? */
int sph_sim_unknown_near(double change, double last, double tolerance);
/* Solves for one; for the energies also the heating by terms of the velocity. */
int sph_sim_unknown_solve(const sph_solving *s, const sph_unknown *u);
int sph_sim_unknown_solve_energy(const sph_solving *s);

#endif
