/* sim_tangent.h -- the derivative of the right-hand side, phase by phase:
 *
 *   out = (df/dy) s + df/dtheta            a tangent
 *   z   = (df/dy)^T w                      its transpose
 *
 * Pair loops differentiate themselves (tangent_loops.h), what happens to each particle alone has
 * its formulas in sim_tangent_map.c, equations of state in eos_slopes.c; only callbacks of the
 * user and what depends on a parameter outside of pair loops are differenced
 * (sim_tangent_call.c).  Positions of walls and the lists are data: they do not depend on y. */
#ifndef SPH_SIM_TANGENT_H
#define SPH_SIM_TANGENT_H
#include "sim_parameter.h"
#include "sim_rhs.h"

/* A vanishing change of a particle, or of what a functional does with it. */
typedef struct sph_point {
  double x[3], v[3], rho, energy, s[SPH_SCALARS_MAX]; /* of the state, */
  double u, T, p, c, phi, m;                          /* what follows, */
  double extra[3]; /* <grad rho> of a fluid, the velocity that viscous terms see of a wall */
} sph_point;
enum { SPH_POINT = sizeof(sph_point) / sizeof(double) };

typedef struct sph_tangent_group {
  double *record_d;             /* [room * stride + SPH_PAIR_SLOTS], as sph_sorted.record */
  double *sum_d[SPH_PAIR_SUMS]; /* [room], as sph_sorted.sum */
  sph_point *point;             /* [capacity] */
  /* Of the equation of state of fluids, [capacity]. */
  double *p_rho, *p_u, *c_rho, *c_u, *T_rho, *T_u;
  double *matrix[6]; /* sums of the gradient matrix, [room]; NULL where there is none */
} sph_tangent_group;

typedef struct sph_tangent {
  sph_sim *sim;
  sph_evaluation e;           /* of f itself; its rates go to `rate` */
  const double *y;            /* the state, [layout.length] */
  double *rate;               /* [layout.length] */
  const double *s;            /* [layout.length]; NULL: zero */
  const sph_parameter *theta; /* NULL: none */
  int lagged;                 /* walls and <grad rho> are taken as constant: no two-hop terms */
  sph_tangent_group group[SPH_SETS_MAX];
  sph_wall_motion motion[SPH_SETS_MAX]; /* of walls */
  /* Work of differences, made where there are callbacks or parameters. */
  double *beside[SPH_SETS_MAX]; /* values beside those of a group: [SPH_POINT][capacity] */
  double *beside_rate;          /* rates there, [layout.length] */
  double *body;                 /* changes of the rates by body terms and drag, [layout.length] */
  double *drag;                 /* the rates by drag, [layout.length] */
  double *record[SPH_SETS_MAX]; /* copies of the records */
  struct sph_transposed *transposed; /* sim_transposed.c; NULL until asked for */
} sph_tangent;

/* The workspace of a simulation, made at its first use.  NULL: recorded. */
sph_tangent *sph_sim_tangent_get(sph_sim *sim);
/* Are there derivatives with these walls?  Else that is told. */
int sph_sim_tangent_fit(sph_sim *sim);
void sph_sim_tangent_free(sph_tangent *tangent); /* NULL is fine */

/* out[length] = (df/dy) s + df/dtheta at (t, y): arrays as the entries of the ODE vector, padding
 * included; s NULL: 0, theta NULL: none.  f of a part: enum sph_piece or SPH_WHOLE.  lagged: the
 * extrapolation to walls and Antuono's gradients are kept fixed.  0, SPH_RETRY or a failure. */
int sph_sim_tangent(sph_sim *sim, int part, double t, const double *y, const double *s,
                    const sph_parameter *theta, int lagged, double *out);

/* The phases of f itself, and what the maps below read: then no tangent is taken, points are
 * free. */
int sph_sim_tangent_base(sph_sim *sim, int part, double t, const double *y, int lagged);

/* ---- its files ---- */

/* sim_tangent_map.c: changes of what belongs to one particle alone; linear, so that they can be
 * transposed. */
typedef struct sph_local {
  const sph_tangent *tangent;
  const sph_group *group;
  const sph_view *view;
  long i, s; /* the particle, its sorted place */
} sph_local;
/* out[] += L in[] */
typedef void sph_local_map(const sph_local *k, const double *in, double *out);
/* bar_in[n] += L^T bar_out[m] */
void sph_sim_tangent_map_transposed(sph_local_map *map, const sph_local *k, int n, int m,
                                    const double *bar_out, double *bar_in);
enum { SPH_RATES_IN = SPH_PAIR_SUMS + SPH_POINT + 4, SPH_RATES_OUT = 8 + SPH_SCALARS_MAX };
sph_local_map sph_sim_tangent_map_eos;      /* point -> u, T, p, c, phi of the point */
sph_local_map sph_sim_tangent_map_pack;     /* point -> record */
sph_local_map sph_sim_tangent_map_wall;     /* wall sums -> point */
sph_local_map sph_sim_tangent_map_gradient; /* gradient sums -> extra of the point */
/* fluid sums, point, heating and acceleration by body terms -> rates: dx[3] dv[3] drho du ds[] */
sph_local_map sph_sim_tangent_map_rates;
int sph_sim_tangent_map_record(const sph_sim *sim, int g); /* slots of a record */

/* sim_tangent_loop.c: the constants of a pass (enum sph_tangent_pass); its derivative, added to
 * the sums of the target. */
fluid_constants sph_sim_tangent_loop_constants(const sph_tangent *tangent, int pass, int target,
                                               int source);
void sph_sim_tangent_loop(sph_tangent *tangent, int pass, int target, int source);

/* sim_tangent_call.c: differences.  Along s and theta: */
int sph_sim_tangent_call_bodies(sph_tangent *tangent); /* rates by body terms, to body */
int sph_sim_tangent_call_has_bodies(const sph_tangent *tangent);
/* ... along one member of sph_point alone, of all particles by its scale: that is put in points. */
int sph_sim_tangent_call_field(sph_tangent *tangent, int member);
void sph_sim_tangent_call_phi(sph_tangent *tangent, int walls); /* the user's phi, to the points */
void sph_sim_tangent_call_tiles(sph_tangent *tangent); /* registered pair terms, to the sums */
/* Along theta, at fixed state and sums: */
void sph_sim_tangent_call_heat(sph_tangent *tangent, int g);   /* of its surface, to the points */
void sph_sim_tangent_call_motion(sph_tangent *tangent, int g); /* of a wall, to the points */
int sph_sim_tangent_call_eos(sph_tangent *tangent); /* p, c, u, T of fluids, to the points */
void sph_sim_tangent_call_walls(sph_tangent *tangent, int g); /* p, rho, m, c of a wall, likewise */
int sph_sim_tangent_call_rates(sph_tangent *tangent, double *out); /* rates, to out */
double sph_sim_tangent_call_number(sph_tangent *tangent, const double *number);
fluid_constants sph_sim_tangent_call_constants(sph_tangent *tangent, int pass, int target,
                                               int source);

#endif
