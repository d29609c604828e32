/* sphode/term.h -- the terms of the right-hand side; docs/theory.md, Terms.
 *
 * sph_term_*() return small definitions by value; they are checked where they are attached
 * (sph_sim_add_term). */
#ifndef SPHODE_TERM_H
#define SPHODE_TERM_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a body term reads and adds to: all particles of one fluid group. */
typedef struct sph_particles {
  int dim;
  long n;
  double t;           /* time [s] */
  const char *group;  /* its name */
  const double *x[3]; /* [n] positions [m]; NULL for d >= dim */
  const double *v[3]; /* [n] velocities [m/s] */
  const double *rho;  /* [n] density [kg/m^3] */
  const double *u;    /* [n] internal energy [J/kg], NULL unless the group has an energy */
  const double *p;    /* [n] pressure [Pa] */
  const double *c;    /* [n] sound speed [m/s] */
  const double *m;    /* [n] mass [kg, kg/m, kg/m^2 in 3D, 2D, 1D] */
  const double *s;    /* [n] the term's own scalar; NULL without one */
  double *a[3];       /* [n] add accelerations [m/s^2] */
  double *drho;       /* [n] add density rates [kg/m^3/s]; NULL where density is a sum */
  double *du;         /* [n] add heating [W/kg], NULL unless the group has an energy */
  double *ds;         /* [n] add rates of the term's own scalar [its unit/s]; NULL without one */
} sph_particles;

enum { SPH_TILE_READS = 8, SPH_SCALARS_MAX = 8 };

/* Some pairs of particles of one group (i) with particles of another or the same (j): what a pair
 * term reads and adds to.  Every array is [n], one entry a pair; loop over k = 0 .. n - 1.  Some
 * pairs lie outside the support: F is zero there, and what is added must be too, as it is if it is
 * proportional to F.  A particle also meets itself, with r = v = 0.  The loop over k is all there
 * is to vectorise: compile it with -O3 -march=native. */
typedef struct sph_tile {
  int dim;
  /* The sources are a wall: its scalars, energy and temperature mirror those of i, so that nothing
   * flows; with a temperature of its own it has 2 T - <T of the fluid>. */
  int wall;
  long n;
  double t, h;                 /* time [s], smoothing length [m] */
  const char *target, *source; /* names of the groups of i, of j */
  /* Of the pair; NULL for what no term's `reads` names, where it names any of these: */
  const double *r[3], *v[3]; /* x_i - x_j [m], v_i - v_j [m/s]; NULL for d >= dim */
  const double *r2, *rv;     /* r.r [m^2], r.v [m^2/s] */
  /* The same as viscous terms see them: other ones at no-slip walls. */
  const double *v_viscous[3], *rv_viscous;
  const double *F;                 /* F = (dW/dr)/r <= 0: grad_i W = F r [m^-(d+2)] */
  const double *V;                 /* volume of j [m^d] */
  const double *m;                 /* mass of j [kg/m^(3-d)] */
  const double *i[SPH_TILE_READS]; /* the fields that term->reads names, of i, */
  const double *j[SPH_TILE_READS]; /* and of j */
  const double *s_i, *s_j;         /* the term's own scalar; NULL without one */
  /* Add; NULL for what no term's `adds` names: */
  double *push;    /* [1/s^2] acceleration push * r of i: a conservative force, heats nothing */
  double *along_r; /* [1/s^2] acceleration along_r * r: dissipative, half of its work heats i */
  double *along_v; /* [1/s] acceleration along_v * v_viscous: likewise */
  double *drho;    /* [kg/m^3/s] of i; lost where density is a sum */
  double *du;      /* [W/kg] heating of i; lost where it has no energy */
  double *ds;      /* [unit/s] of the term's own scalar of i; NULL without one */
} sph_tile;

/* A scalar that a term brings along: integrated with the state of every fluid particle, from
 * `initial` on; read and written as a field of its name, saved in snapshots, in series.csv. */
typedef struct sph_scalar {
  const char *name; /* [a-z][A-Za-z0-9_]*, no other field's; NULL: none; copied */
  const char *unit; /* "kg/m^3"; NULL: "1"; copied */
  double scale;     /* of its error weights: a change that matters, > 0 */
  double initial;   /* value at the start */
  int per_volume;   /* implicit pairs exchange 0: amounts per mass; 1: amounts per volume */
} sph_scalar;

/* A number of one group, see sph_term_scalar_diffusion. */
typedef struct sph_group_value {
  const char *group; /* its name */
  double value;
} sph_group_value;

/* How the rates of a term change with what they act on, where the term is implicit: add to those
 * that are not NULL, [n] of the particles or of the tile.  Rates that decay, and exchange between
 * pairs:
 *
 *   body  v = - da/dv,  T = - d(heating)/dT,  s = - d(ds)/ds,  each >= 0
 *   pair  v, T, s >= 0 with a_i = - sum v (v_i - v_j) + ..., heating and ds likewise by T and s;
 *         m_i v, m_i T and m_i s (or V_i s: scalar.per_volume) are the same for both ends
 *
 * They decide how fast a stage converges, not to what: leave out what is small or has the other
 * sign.  The velocity, temperature and scalar that the particles have are those of the iterate. */
typedef struct sph_term_jacobian {
  double *v; /* [1/s] the same in all directions */
  double *T; /* [W/(kg K)] */
  double *s; /* [1/s] of the term's own scalar */
} sph_term_jacobian;

typedef struct sph_term sph_term;
struct sph_term {
  const char *name; /* "pressure", ... or the user's own; copied when attached */
  /* Parameters of the built-in terms; each constructor says which it reads. */
  /* continuity: "c2" (NULL), "c1", "phi"; pressure: "c2" (NULL), "s", "phi"; delta: "molteni",
   * "antuono", "fourtakas"; viscosity-laminar: "morris" (NULL), "mcg"; drag: "K" (NULL), "time";
   * shifting: "delta-plus" (NULL), "fick" */
  const char *form;
  /* continuity: "none" (NULL), "one-sided"; pressure, viscosity-laminar: and "mean" */
  const char *correction;
  double alpha,
      beta; /* artificial viscosities, artificial stress; alpha: artificial conductivity */
  const char *switches; /* of artificial viscosities, see sph_term_switched; NULL: none; copied */
  double alpha_min;     /* where a switch varies alpha */
  double delta;         /* density diffusion */
  double epsilon;       /* xsph */
  double drag;          /* drag: K [kg/m^3/s], or the stopping time [s] */
  double exponent;      /* continuity of form phi: phi = rho^exponent */
  int calibrate;        /* summation */
  double g[3];          /* uniform body force [m/s^2] */
  double omega;         /* harmonic body force [1/s] */
  double speed, strength, crowding; /* shifting: U [m/s], s, R; */
  int surface, advection;  /* 1: particles at a free surface move along it; rates follow dv, also of
                             transport-velocity: */
  double background, time; /* p_b [Pa], tau [s] */
  long steps;              /* shifting: between steps, every so many; 0: a rate */
  double diffusivity; /* scalar-diffusion: D >= 0 [m^2/s] of fluids without one of their own; */
  /* D of fluids [m^2/s], the scalar at the surface of walls, [by_groups]; copied */
  const sph_group_value *by_group;
  int by_groups;
  /* continuity of form phi: fills phi[n] > 0 instead of rho^exponent, of fluids and walls (whose
   * rates are NULL). */
  void (*phi)(const sph_term *term, const sph_particles *particles, double *phi);
  /* heat-source: power [W/kg] at x [m], t [s]. */
  double (*power)(void *ctx, const double x[3], double t);
  /* A user's own (NULL in built-in pair terms): */
  int (*body)(const sph_term *term, const sph_particles *particles); /* 0, SPH_RETRY or < 0 */
  /* Pairs of fluid particles with fluid and wall ones, but none with dust, tile by tile, beside the
   * built-in terms.  Called from several threads at once: read ctx, do not write to it. */
  void (*pair)(const sph_term *term, const sph_tile *tile);
  /* What pair reads: fields of both ends, as "density sound_speed", in the order of tile->i and j;
   * and of the pair, as "r2 rv F": where any of these is named only they are filled in, which is
   * much of what a tile costs, else all.  Of a term without pair: ""
   * where body and dt_max read nothing that is not integrated (p, c, u beside another energy, a
   * summed density): a part of f with it then costs no more.  Copied. */
  const char *reads;
  const char *adds; /* what pair adds to, as "along_r ds": only that is summed; NULL: all; copied */
  sph_scalar scalar; /* what it integrates besides; scalar.name NULL: nothing */
  double (*dt_max)(const sph_term *term, const sph_particles *particles); /* [s]; NULL: no limit */
  /* A term that may be implicit: what it changes, of "velocity energy scalar"; NULL: it may not;
   * copied.  Stages are iterated until they are met by body and pair; one or both of these make
   * that fast.  jacobian_pair is called from several threads at once. */
  const char *implicit;
  void (*jacobian_body)(const sph_term *term, const sph_particles *particles,
                        const sph_term_jacobian *jacobian);
  void (*jacobian_pair)(const sph_term *term, const sph_tile *tile,
                        const sph_term_jacobian *jacobian);
  /* [J/kg] for the energy balance; NULL: none */
  double (*potential)(const sph_term *term, const double x[3]);
  void *ctx;            /* the user's; borrowed unless free is given */
  void (*free)(void *); /* called once with ctx when the simulation lets go of it; may be NULL */
};

/* d rho_i/dt: "c2": rho_i sum V_j v_ij.grad W;  "c1": sum m_j v_ij.grad W;
 *      "phi": phi_i sum m_j/phi_j v_ij.grad W, phi = rho^exponent (Price 2012): 0 is c1, 1 is c2 */
SPH_API sph_term sph_term_continuity(void);
SPH_API sph_term sph_term_continuity_form(const char *form);
SPH_API sph_term sph_term_continuity_phi(double exponent);
/* Instead of continuity: rho_i = sum m_j W_ij, itself included; density is then no part of the
 * state.  calibrate = 1 divides the masses of liquids once, at the start, by the sum of W dx^d over
 * the lattice: else a lattice at rest has up to 1 % more than its reference density, and the
 * pressure of that.  Under-estimates at free surfaces.  Walls count with their reference density.
 * Its pressure force is "s". */
SPH_API sph_term sph_term_summation(int calibrate);
/* a_i: "c2":  - sum m_j (p_i + p_j)/(rho_i rho_j) grad W;
 *      "s":   - sum m_j (p_i/rho_i^2 + p_j/rho_j^2) grad W;
 *      "phi": - sum m_j (p_i/rho_i^2 phi_i/phi_j + p_j/rho_j^2 phi_j/phi_i) grad W, phi that of
 *             continuity;
 * thermal fluids are heated by the partner of the same row. */
SPH_API sph_term sph_term_pressure(void);
SPH_API sph_term sph_term_pressure_form(const char *form);
/* A continuity, pressure or viscosity-laminar whose kernel gradients are corrected by the inverse B
 * of the gradient matrix M_i = - sum V_j r_ij r_ij F, over neighbours of its species (Randles &
 * Libersky 1996; Bonet & Lok 1999); B = 1 where the least eigenvalue of M is below 0.2, B of i at
 * walls.
 *
 *   "one-sided"  B_i grad W: continuity of form c2 is exact for a linear velocity, also at
 *                surfaces; pressure is -1/rho_i sum V_j (p_j - p_i) B_i grad W, exact for a linear
 *                pressure, whatever its form, and conserves nothing
 *   "mean"       pressure: p_i/rho_i^2 B_i + p_j/rho_j^2 B_j, conserves linear momentum, with
 *                continuity "one-sided" energy, but angular momentum in form c2 only
 *   viscosity-laminar: e.B e F with e = r_ij/r and B of i, or ("mean") of both, which conserves
 *                linear momentum
 *
 * Matched: pressure "mean" with continuity "one-sided", "none" with "none", pressure "one-sided"
 * with any.  Not with an implicit viscosity-laminar, nor where derivatives of f are asked for
 * (sphode/jacobian.h, sensitivity.h, adjoint.h), nor with pair terms that have a scalar. */
SPH_API sph_term sph_term_corrected(sph_term term, const char *correction);
/* Monaghan (1992) artificial viscosity with heating; alpha, beta >= 0. */
SPH_API sph_term sph_term_viscosity_artificial(double alpha, double beta);
/* Artificial viscosity with a signal velocity (Monaghan 1997) and heating: alpha 0.5 to 1, beta
 * usually 3; both >= 0. */
SPH_API sph_term sph_term_viscosity_signal(double alpha, double beta);
/* An artificial viscosity that acts where it is needed.  switches: words of "none", "balsara"
 * (1995: not in shear) and one of those that make alpha a field of each particle, integrated with
 * the state, between alpha_min and the alpha of the term: "morris-monaghan" (1997, alpha_min
 * usually 0.1 of alpha) or "cullen-dehnen" (2010, alpha_min usually 0).  As "balsara
 * morris-monaghan".  beta scales with alpha.  One artificial viscosity of a simulation may have
 * them; it is explicit.  The field "alpha" starts with alpha_min. */
SPH_API sph_term sph_term_switched(sph_term viscosity, const char *switches, double alpha_min);
/* Laminar viscosity with heating, eta that of the groups (sph_group_set_viscosity): "morris"
 * (Morris, Fox & Zhu 1997) or "mcg" (Monaghan, Cleary & Gingold: central, keeps angular momentum).
 * Walls take part where they are no-slip. */
SPH_API sph_term sph_term_viscosity_laminar(const char *form);
/* Heat conduction (Cleary & Monaghan 1999) between groups with conductivity and specific heat;
 * walls take part where they have a temperature. */
SPH_API sph_term sph_term_conduction(void);
/* Heating [W/kg] of all groups with an energy: power(ctx, x, t). */
SPH_API sph_term sph_term_heat_source(double (*power)(void *ctx, const double x[3], double t),
                                      void *ctx);
/* A scalar s per mass that is carried along and diffuses, one a term:
 *
 *   ds_i/dt = sum m_j/(rho_i rho_j) 4 k_i k_j/(k_i + k_j) (s_i - s_j) F,  k = rho D,
 *
 * which keeps sum m s and never makes an extreme (Brookshaw 1985; Cleary & Monaghan 1999).  D =
 * diffusivity >= 0 [m^2/s], 0: only carried along.  Set in what it returns: by_group, other D of
 * fluids and the s of surfaces of walls (s_j = 2 s_wall - s_i; other walls let nothing through);
 * body and ctx, a source that adds to ds.  The term has the name of its scalar. */
SPH_API sph_term sph_term_scalar_diffusion(sph_scalar scalar, double diffusivity);
/* XSPH (Monaghan 1989): dx_i/dt = v_i - epsilon sum m_j/rho_ij v_ij W_ij; 0 <= epsilon <= 1,
 * usually up to 0.5. */
SPH_API sph_term sph_term_xsph(double epsilon);
/* Particle shifting: dx_i/dt = v_i + dv_i, v itself stays.
 *
 *      "fick"        dv_i = -D grad C_i, grad C_i = sum V_j grad W (Lind et al. 2012)
 *      "delta-plus"  dv_i = -D sum V_j (1 + R (W_ij/W(dx))^4) grad W (Sun et al. 2017)
 *
 * D = 2 s h U, |dv_i| at most U/2; U = speed > 0, the largest that is expected [m/s].  The
 * constructor sets s = strength = 1, the whole coefficient of Sun et al. (in steps of h/U, s = 1/4
 * is Lind's largest, D dt = h^2/2), R = crowding = 0.2, and
 *
 *      surface = 1    particles in reach of a free surface ("cone", sph_operator_surface) move
 *                     along it only, lone ones not at all; 0: internal flows, two passes less
 *      advection = 1  density and velocity follow: drho_i/dt and dv_i/dt gain dv_i . grad (Sun et
 *                     al. 2019; velocities by differences, which leave a uniform flow alone); 0: as
 *                     in 2017, an error of the order of dv
 *      steps = n > 0  between steps instead, every n accepted ones: x += tau dv, rho and v by tau
 *                     times their rates, tau the time since the last one, at most h/(8 s U); the
 *                     integrator then starts anew.  0: a rate of f
 *
 * Walls take part as neighbours.  Of one liquid; of energies and scalars, or of several liquids,
 * with advection = 0. */
SPH_API sph_term sph_term_shifting(const char *form, double speed);
/* Transport velocity (Adami, Hu & Adams 2013) with a fixed time, so that it is a rate:
 *      dx_i/dt = v_i + dv_i, dv_i = -tau p_b/m_i sum (V_i^2 + V_j^2) grad W,
 *      a_i += 1/m_i sum (V_i^2 + V_j^2)/2 (A_i + A_j) . grad W, A = rho v dv,
 * and the density follows as in shifting.  p_b = background [Pa], 0: rho0 c0^2; tau = time [s], 0:
 * 0.1 h/c0.  Of flows without a free surface: a start with one is an error. */
SPH_API sph_term sph_term_transport_velocity(double background, double time);
/* Artificial stress (Monaghan 2000) against clumping under tension: a repulsion alpha |p|/rho^2
 * (W_ij/W(dx))^4 of negative pressures, usually alpha = 0.2, and beta (p_i/rho_i^2 + p_j/rho_j^2)
 * (...)^4 of positive ones, usually 0.01; both >= 0.  A background pressure of the equation of
 * state (eos.p_background) is the other remedy. */
SPH_API sph_term sph_term_stress_artificial(double alpha, double beta);
/* Price (2008) artificial conductivity of thermal fluids; alpha_u >= 0, usually 1. */
SPH_API sph_term sph_term_conductivity_artificial(double alpha_u);
/* Density diffusion of the delta-SPH family: model "molteni", "antuono" or "fourtakas" (which
 * takes the hydrostatic density of the uniform body force out); delta >= 0, usually 0.1. */
SPH_API sph_term sph_term_delta(const char *model, double delta);
/* Drag between dust (sph_eos_dust) and fluids, a force per volume K (v_fluid - v_dust) on the dust
 * (Monaghan & Kocharyan 1995; Laibe & Price 2012), whose heat goes to the fluid: K >= 0
 * [kg/m^3/s], or K = rho_dust/t_s by the stopping time t_s > 0 [s] of a grain in a fluid at rest.
 * The relative velocity of both decays with t = rho_f rho_d/(K (rho_f + rho_d)). */
SPH_API sph_term sph_term_drag(double K);
SPH_API sph_term sph_term_drag_time(double t_s);
/* Uniform body force g[3] [m/s^2]; several add up. */
SPH_API sph_term sph_term_gravity(const double g[3]);
/* Central harmonic body force a = -omega^2 x [1/s]: the oscillating drop. */
SPH_API sph_term sph_term_harmonic(double omega);

SPH_API const char *sph_term_name(int k);               /* built-in names, NULL behind the last */
SPH_API const char *sph_term_formula(const char *name); /* one line; NULL for an unknown name */

#ifdef __cplusplus
}
#endif
#endif
