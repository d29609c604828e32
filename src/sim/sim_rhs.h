/* sim_rhs.h -- the right-hand side, by phases.  Each phase returns 0, SPH_RETRY or a failure
 * (recorded). */
#ifndef SPH_SIM_RHS_H
#define SPH_SIM_RHS_H
#include "sim_data.h"
#include "sphode/sundials.h"

/* One evaluation: the views of all groups and what its phases hand on. */
typedef struct sph_evaluation {
  sph_sim *sim;
  double t;
  const sph_part *part; /* which is evaluated */
  int still;            /* the rates of positions are not written */
  int sums;             /* those of pairs are wanted afterwards, not their rates alone */
  double limit_user;    /* step limit of body terms [s] */
  sph_view view[SPH_SETS_MAX];
  double drag_rate[2]; /* largest of fluids, of dust [1/s] */
  double switch_rate;  /* largest of an alpha that rises [1/s] */
} sph_evaluation;

/* The views of all groups of an evaluation; ydot NULL: no rates. */
void sph_sim_rhs_views(sph_evaluation *e, N_Vector y, N_Vector ydot);
/* Pressure, sound speed and walls of the state (t, y), with the lists as they are. */
int sph_sim_rhs_show(sph_sim *sim, double t, N_Vector y);
/* ... with the lists brought up to date. */
int sph_sim_rhs_show_anew(sph_sim *sim, double t, N_Vector y);
/* Any part of f; lists, records, pressures and walls are then those of (t, y). */
int sph_sim_rhs_part(sph_sim *sim, const sph_part *part, double t, N_Vector y, N_Vector ydot);
/* A part of f: enum sph_piece, or SPH_WHOLE. */
int sph_sim_rhs_piece(int piece, double t, N_Vector y, N_Vector ydot, void *sim);
/* f, but for the rates of positions: these stay as they are (sph_problem.rhs_still). */
int sph_sim_rhs_still(double t, N_Vector y, N_Vector ydot, void *sim);
/* Are these two of the simulation, or longer?  Else recorded. */
int sph_sim_rhs_vectors(sph_sim *sim, N_Vector y, N_Vector other);

int sph_sim_lists_update(sph_evaluation *e);           /* neighbors */
int sph_sim_lists_keep(sph_sim *sim, sph_keep *keep);  /* they, for checkpoints */
int sph_sim_density(sph_evaluation *e);                /* density */
int sph_sim_material_eos(sph_evaluation *e);           /* eos */
int sph_sim_bodies_add(sph_evaluation *e);             /* bodies: starts all rates */
int sph_sim_walls_move(sph_evaluation *e);             /* walls: prescribed motion */
int sph_sim_walls_fill(sph_evaluation *e);             /* walls: extrapolation */
int sph_sim_gradients(sph_evaluation *e);              /* prepare */
int sph_sim_switches(sph_evaluation *e);               /* switches: of artificial viscosity, */
int sph_sim_switches_rates(sph_evaluation *e);         /* and what follows from accelerations */
void sph_sim_pairs_pack(sph_evaluation *e, int walls); /* sorted copies of fluids, or of walls */
int sph_sim_shift_add(sph_evaluation *e);              /* shift */
int sph_sim_drag_add(sph_evaluation *e);               /* drag */
int sph_sim_pairs_add(sph_evaluation *e);              /* pairs */
int sph_sim_admit(sph_evaluation *e);                  /* admit */

/* Rates of the particles of group g from its sums, where these were wanted. */
void sph_sim_pairs_rates(sph_evaluation *e, int g);
/* p, rho, m, c of the particles of wall g from its sums. */
void sph_sim_walls_finish(const sph_evaluation *e, int g);
/* d rho/dt of dynamic boundary particles: all of it. */
void sph_sim_walls_rates(sph_evaluation *e, int g);

/* What a wall does at one time: sph_motion, sph_rotation. */
typedef struct sph_wall_motion {
  double displacement[3], velocity[3], acceleration[3];
  int turns; /* else there is nothing below */
  double centre[3], axis[3], turn[3];
} sph_wall_motion;
int sph_sim_walls_moves(const sph_boundary *boundary);
sph_wall_motion sph_sim_walls_motion(const sph_boundary *boundary, double t);
/* Of the loop wall <- fluid of an adami wall. */
fluid_constants sph_sim_walls_constants(const sph_sim *sim, const sph_group *wall, double t);
/* Place and velocity of what is at `start` where nothing has moved. */
void sph_sim_walls_at(const sph_wall_motion *motion, int dim, const double *start, double *x,
                      double *v);
/* g - a_w at x, without body terms but g: the force that a wall particle there feels. */
void sph_sim_walls_force(const sph_wall_motion *motion, int dim, const double *g, const double *x,
                         double *force);
/* Temperatures of surfaces that change. */
int sph_sim_walls_heat(sph_evaluation *e);
/* Is that a temperature [K], or (heats) a flux [W/m^2], of the surface of a wall at x[3]?  Else
 * SPH_RETRY, with it as the reason. */
int sph_sim_walls_surface(const sph_evaluation *e, const sph_group *wall, int heats, double value,
                          const double x[3]);
/* Cholesky of the dim x dim matrix A - shift I; 0 where it is not positive definite. */
int sph_sim_gradients_cholesky(int dim, double A[3][3], double shift, double L[3][3]);
/* Cholesky factor of the gradient matrix at sorted place s, of its sums; 0: the gradient is left
 * out there.  x = (L L^T)^-1 x. */
int sph_sim_gradients_factor(const sph_sim *sim, double *const *matrix, long s, double L[3][3]);
void sph_sim_gradients_solve(int dim, double L[3][3], double x[3]);

/* Positions, and masses in the slot of V. */
void sph_sim_pairs_pack_positions(const sph_evaluation *e, int g);
void sph_sim_pairs_clear(sph_sim *sim, int g, int sums);

/* Some blocks of a group as targets, and where their sums go: what a thread does at once. */
enum { SPH_SHARE_BLOCKS = 64 };
typedef struct sph_share {
  long begin, end;            /* blocks */
  double *sum[SPH_PAIR_SUMS]; /* [(end - begin) * lanes] */
} sph_share;

/* Calls work for all shares of group g, by several threads, and returns their number; sums: how
 * many there are, zero at first.  They are the group's own, or (scratch) of the moment. */
typedef void sph_share_work(void *ctx, const sph_share *share);
long sph_sim_pairs_share(sph_sim *sim, int g, int sums, int scratch, sph_share_work *work,
                         void *ctx);
long sph_sim_pairs_targets(const sph_sim *sim, int g, const sph_share *share); /* particles of it */
void sph_sim_pairs_loop_share(const sph_sim *sim, const sph_share *share, sph_pair_function *loop,
                              int target, int source, const void *constants);

/* Runs one loop over all target blocks of (target <- source). */
void sph_sim_pairs_loop(sph_sim *sim, sph_pair_function *loop, int target, int source,
                        const void *constants);
/* The same over other records of both, of that stride; NULL: their own. */
void sph_sim_pairs_loop_records(sph_sim *sim, sph_pair_function *loop, int target, int source,
                                const double *record, const double *source_record, long stride,
                                const void *constants);

/* The modifier that shifts between steps. */
int sph_sim_shift_step(void *ctx, sph_sim *sim);
/* What shifts a group: dv = -2 h speed grad C, about [m/s]; 0: nothing. */
double sph_sim_shift_speed(const sph_sim *sim, const sph_group *group);

/* phi of all fluids, or of all walls, for the row of that name. */
void sph_sim_material_phi(sph_evaluation *e, int walls);
/* What body terms and phi see of a group. */
sph_particles sph_sim_bodies_particles(const sph_evaluation *e, int g);

/* The pair terms of (target <- source), added to the sums of a share of the target. */
void sph_sim_interaction_add(const sph_evaluation *e, const sph_share *share, int target,
                             int source);
/* Of them the registered ones alone. */
void sph_sim_interaction_tiles(const sph_evaluation *e, const sph_share *share, int target,
                               int source);
fluid_constants sph_sim_interaction_constants(const sph_sim *sim, const sph_part *part,
                                              const sph_group *target, const sph_group *source);
/* What tiles of (target <- source) hold, beside built-in terms with these constants. */
tile_constants sph_sim_interaction_tile(const sph_evaluation *e, const fluid_constants *fluid,
                                        int target, int source);
/* Does density diffuse between them?  Not between a fluid and another, or a wall, of different
 * reference density or sound speed. */
int sph_sim_interaction_same_fluid(const sph_group *target, const sph_group *source);
/* Each dust is a species of its own, all fluids and walls are one: density, its diffusion,
 * pressure, viscosity, conduction act within a species only. */
int sph_sim_interaction_same_species(const sph_group *target, const sph_group *source);
/* Has target a list of neighbours in source? */
int sph_sim_interaction_listed(const sph_sim *sim, const sph_group *target,
                               const sph_group *source);
/* Is there drag between them?  Its constants. */
int sph_sim_drag_acts(const sph_sim *sim, const sph_group *target, const sph_group *source);
fluid_constants sph_sim_drag_constants(const sph_sim *sim, int target, int source);
/* Which terms of a part use tiles, and what these hold. */
int sph_sim_interaction_prepare(sph_sim *sim, sph_part *part);
/* Before the run: masses that make the lattice sum the reference density. */
void sph_sim_density_calibrate(sph_sim *sim);
/* Does a density reset fit the terms? */
int sph_sim_reset_check(sph_sim *sim);
/* The simulation asks for a smaller step, for this reason. */
int sph_sim_admit_retry(sph_sim *sim, const char *format, ...) SPH_PRINTF(2, 3);

#endif
