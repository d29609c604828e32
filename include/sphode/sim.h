/* sphode/sim.h -- a simulation: owns everything attached to it, evaluates the right-hand side,
 * runs.
 *
 * The first error sticks: setters return nothing, later calls do nothing, sph_sim_run returns it,
 * sph_sim_error tells it.  A NULL simulation flows through.  Calls on one simulation must not
 * overlap; two simulations may run in two threads. */
#ifndef SPHODE_SIM_H
#define SPHODE_SIM_H
#include <stddef.h>

#include "sphode/base.h"
#include "sphode/group.h"
#include "sphode/integrator.h"
#include "sphode/output.h"
#include "sphode/term.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_sim_def {
  int dim;            /* 1, 2, 3 */
  double dx;          /* particle spacing [m], > 0 */
  const char *kernel; /* NULL: "wendland-c2" */
  double h_over_dx;   /* smoothing length / dx; 0: the kernel's recommended value */
  int threads;        /* 0: 1 */
  int periodic[3];    /* direction is periodic */
  double origin[3];   /* lower corner of the periodic box [m] */
  double length[3];   /* its lengths [m] */
  /* Least speed V of the error weights [m/s]; V is the largest of it, sqrt(g height), |v| at the
   * start and 0.01 c0 (gas: the mean sound speed). */
  double speed;
  double skin;        /* of the neighbour lists, in h; < 0: none; 0: 0.2 */
  const char *search; /* of neighbours: "grid" (NULL), "hash", "tree", "brute-force" */
  /* One of your own (sphode/neighbors.h), where search is NULL; copied, and ctx freed with the
   * simulation. */
  const struct sph_search *own_search;
  const char *isa; /* NULL: what the CPU has (or SPHODE_ISA); "reference": one lane, plain loops */
  /* "double" (NULL) or "mixed": pairs in single precision, eight at a time, all else in double.
   * Rates are within some 1e-6 of their terms.  Needs AVX2; knows continuity, pressure (c2, s),
   * viscosity-artificial, conductivity-artificial, delta (Molteni, Antuono), walls, mirrors,
   * energies, body terms; no other pair terms, implicit parts, derivatives, density resets;
   * tolerances from 1e-5. */
  const char *precision;
} sph_sim_def;

SPH_API sph_sim *sph_sim_create(const sph_sim_def *def);
SPH_API void sph_sim_free(sph_sim *sim);
SPH_API const char *sph_sim_error(const sph_sim *sim); /* "" without one; NULL sim: out of memory */
SPH_API int sph_sim_status(const sph_sim *sim);
/* Records a failure in the simulation (for code built on it); the first one sticks. */
SPH_API int sph_sim_fail(sph_sim *sim, int status, const char *format, ...) SPH_PRINTF(3, 4);

SPH_API void sph_sim_add_term(sph_sim *sim, sph_term term);
/* The terms of that name belong to a part of f: "explicit" or "slow" (the same; all terms at
 * first), "implicit" for integrators imex:<table>, "fast" for mri:<coupling>.  After the terms were
 * added, before the run.  Implicit can be viscosity-laminar, viscosity-artificial, conduction,
 * delta and drag; where no part is set, viscosity-laminar, conduction and drag are, with imex.
 * dx/dt = v belongs to the part of the pressure force.  Term NULL, part "explicit": all terms, as
 * if none was set. */
SPH_API void sph_sim_set_part(sph_sim *sim, const char *term, const char *part);
/* New parameters of a built-in term that the simulation has, between steps or in the change of an
 * event: gravity (of all that were added), harmonic, viscosity-artificial, viscosity-signal,
 * conductivity-artificial, xsph, delta (its model stays), drag.  The integrator starts anew. */
SPH_API void sph_sim_change_term(sph_sim *sim, sph_term term);
/* Scale of the error weights of a field that a fluid integrates, in its unit: a step's error is
 * tolerance times it, where the physical scales of sph_sim_def.speed do not fit; the other fields
 * keep theirs.  Before the run; of a scalar: after its term was added.  group NULL: all fluids. */
SPH_API void sph_sim_set_scale(sph_sim *sim, const sph_group *group, const char *field,
                               double scale);
SPH_API void sph_sim_set_integrator(sph_sim *sim, const sph_integrator_def *def); /* copied */
SPH_API void sph_sim_add_output(sph_sim *sim, sph_output output);
/* Called after every accepted step; a return != 0 before the end stops the run with
 * SPH_ERR_STOPPED, outputs closed. */
SPH_API void sph_sim_set_progress(sph_sim *sim, int (*progress)(void *ctx, sph_sim *sim),
                                  void *ctx);
/* Why it will: "stopped WHY at t = ..." instead of "stopped on request at t = ..."; borrowed. */
SPH_API void sph_sim_set_stop(sph_sim *sim, const char *why);

/* Warning k = 0, 1, ... about terms and materials that do nothing together, or are missing, as one
 * line in text[size]; 0 behind the last.  All groups and terms should be there; once it was
 * evaluated, also about what bounds steps, resolution, speeds, bodies that overlap, gape or are far
 * from each other, uneven packings, events that have passed. */
SPH_API int sph_sim_warning(const sph_sim *sim, int k, char *text, size_t size);

/* Runs to time t_end [s], writing outputs; or one step.  Callbacks (terms, outputs, events,
 * modifiers, progress) begin no other.  Returns a status. */
SPH_API int sph_sim_run(sph_sim *sim, double t_end);
SPH_API int sph_sim_step(sph_sim *sim);
/* Fields were written between steps: the integrator starts anew from them, with a step no longer
 * than error control would have taken next. */
SPH_API void sph_sim_changed(sph_sim *sim);
/* Evaluates the right-hand side of the present state: pressure, sound speed, walls, rates
 * (sph_group_rate). */
SPH_API int sph_sim_evaluate(sph_sim *sim);

SPH_API double sph_sim_time(const sph_sim *sim); /* of the state shown [s] */
SPH_API int sph_sim_dim(const sph_sim *sim);
SPH_API double sph_sim_dx(const sph_sim *sim);
SPH_API double sph_sim_h(const sph_sim *sim);
/* Is direction d periodic?  Then from origin over length [m] (NULL: not wanted).  Positions in the
 * state may lie whole lengths outside. */
SPH_API int sph_sim_periodic(const sph_sim *sim, int d, double *origin, double *length);
SPH_API const char *sph_sim_kernel(const sph_sim *sim);
SPH_API const char *sph_sim_isa(const sph_sim *sim);
SPH_API const char *sph_sim_integrator(const sph_sim *sim);
SPH_API int sph_sim_threads(const sph_sim *sim);
SPH_API sph_group *sph_sim_group(const sph_sim *sim, const char *name); /* NULL: no such group */
SPH_API sph_group *sph_sim_group_get(const sph_sim *sim, int k);        /* NULL behind the last */
/* Rises when particles move house: pointers end. */
SPH_API long sph_sim_revision(const sph_sim *sim);

/* Conserved quantities of the fluids in the state shown. */
typedef struct sph_balance {
  double mass;                         /* [kg/m^(3-dim)], likewise below */
  double momentum[3];                  /* sum m v */
  double angular_momentum[3];          /* sum m x cross v */
  double kinetic, internal, potential; /* [J]; internal: thermal or elastic */
  double total;
} sph_balance;
SPH_API void sph_sim_balance(const sph_sim *sim, sph_balance *balance);

typedef struct sph_sim_stats {
  sph_step_stats step;
  double
      pairs; /* directed pairs inside the support, summed over right-hand sides (estimated: counted
                     at every sixteenth list build) */
  double seconds;       /* wall time inside sph_sim_run and sph_sim_step */
  double rhs_seconds;   /* of these, inside the right-hand side, and inside implicit stages, */
  double solve_seconds; /* which evaluate it, too */
  long matrices;        /* filled for them */
  long list_builds;
  long near;    /* particles nearer than 0.1 dx to another, when pairs were counted last */
  double bytes; /* memory held */
  double mach;  /* of liquids (an equation of state with c0, not thermal): the largest |v|/c0 at */
  double density;    /* steps so far, and the largest |rho/rho0 - 1| */
  long strayed;      /* of their particles, those now outside of where all particles were at the */
  double strayed_by; /* start by more than that is long, and how far the farthest [m]; counted where
                        there are walls, none of which moves or is a mirror */
} sph_sim_stats;
SPH_API void sph_sim_get_stats(const sph_sim *sim, sph_sim_stats *stats);
/* sph_bound_name, but dt_fixed where the integrator has one. */
SPH_API const char *sph_sim_bound_name(const sph_sim *sim, int bound);

#ifdef __cplusplus
}
#endif
#endif
