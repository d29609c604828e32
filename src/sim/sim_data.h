/* sim_data.h -- what a simulation owns.  Internal: files of sim/ share it. */
#ifndef SPH_SIM_DATA_H
#define SPH_SIM_DATA_H
#include "group_data.h"
#include "integrator.h"
#include "nvector.h"
#include "sphode/checkpoint.h"
#include "sphode/event.h"
#include "sphode/kernel.h"
#include "sphode/neighbors.h"
#include "sphode/pair_loop.h"
#include "sphode/sim.h"
#include "term_set.h"
#include "tile_pair.h"

enum {
  SPH_OUTPUTS_MAX = 64,
  SPH_METHOD_MAX = 64,
  SPH_KEPT_MAX = 32 + SPH_SETS_MAX,
  SPH_KEPT_NAME = SPH_NAME_MAX + 32,
  /* Parameters that events change: of terms, two of each group. */
  SPH_CHANGEABLE = 12 + SPH_CALLED_TERMS_MAX + 2 * SPH_SETS_MAX
};

/* Part SPH_WHOLE is f; the others are enum sph_piece. */
enum { SPH_WHOLE = SPH_PIECE_COUNT, SPH_PARTS };

/* Bits of terms, not of how they are added up. */
enum {
  SPH_PAIR_TERMS = SPH_CONTINUITY | SPH_PRESSURE_FORCE | SPH_VISCOUS | SPH_DIFFUSION |
                   SPH_CONDUCTIVITY | SPH_CONDUCTION | SPH_XSPH | SPH_STRESS
};

/* A part of f: its terms, and the phases that an evaluation of them needs (sim_parts.c). */
typedef struct sph_part {
  unsigned terms;  /* bits of its fluid <- fluid loop; continuity also where its sum is wanted */
  unsigned rates;  /* bits of the terms whose rates it adds */
  unsigned called; /* bit k: terms.call[k] */
  int positions, gravity; /* has dx/dt = v; dv/dt = g */
  /* What its evaluations limit: steps by waves and motion, and these terms. */
  int acoustic, motion;
  unsigned limit_terms, limit_called;
  int lists, density, eos, walls, gradients, switches, shift, drag, pairs; /* phases */
  int only_walls; /* pairs: of fluids with walls alone */
  /* Registered pair terms, the fields that they read, what they add to. */
  int tiles;
  unsigned tile_fields, tile_adds, tile_show;
  sph_tile_term tile[SPH_TILE_TERMS];
} sph_part;

/* A group's sorted copy: what the pair loops read, and the sums that they make. */
typedef struct sph_sorted {
  long room;                  /* particles: a multiple of 8 */
  long stride;                /* doubles in a record */
  double *record;             /* [room * stride + SPH_PAIR_SLOTS] */
  float *single;              /* the same in single precision (sim_single.c), or NULL */
  double *sum[SPH_PAIR_SUMS]; /* [room]; NULL for those that no loop makes */
  double *phi;                /* of the row phi, not sorted, [room]; NULL: another row */
  double *built[3];           /* positions at the last list build, not sorted, [capacity] */
  int *place; /* of a fluid that mirrors show: sorted place of each particle, [room]; else NULL */
  double *shifted; /* records of shift_pair.h, as many; NULL: nothing shifts */
  double *shock;   /* records of Cullen & Dehnen's second pass (switch_pair.h), or NULL */
} sph_sorted;

typedef struct sph_outlet {
  sph_output output;
  long frames;  /* due so far: the next one is due at start + frames * interval */
  double start; /* when it was opened [s] */
  double last;  /* time of its last frame [s]; NaN: none */
  int open;
} sph_outlet;

/* An event at work. */
typedef struct sph_watch {
  sph_event event; /* name and group are those here */
  char name[SPH_NAME_MAX], group[SPH_NAME_MAX];
  int type;            /* of the table in event.c; -1: own */
  int direction;       /* 1: rising, -1: falling, 0: both */
  int known;           /* `side` is that of the state so far */
  int side;            /* of zero, where it was looked at last: 1, -1; 0: on it, or undefined */
  int piece;           /* of the last step: the next to look at, of samples + 1 */
  double root;         /* its next moment in that step [s]; INFINITY: none so far */
  int behind;          /* its side behind that */
  int happened;        /* at the moment that is handled */
  int over;            /* it comes once, and did */
  sph_event_info info; /* what is told of it */
} sph_watch;

/* A modifier at work. */
typedef struct sph_modifying {
  sph_modifier modifier;
  char name[SPH_NAME_MAX];
  double start; /* intervals count from here [s] */
  double done;  /* steps since it ran; or intervals so far */
} sph_modifying;

/* The particle at which a step failed. */
typedef struct sph_suspect {
  int known, group;
  long i; /* its place in the group */
} sph_suspect;

/* What a user's callbacks remember. */
typedef struct sph_keeping {
  sph_kept kept; /* its name is the one here */
  char name[SPH_KEPT_NAME];
} sph_keeping;

/* Who writes checkpoints: asked behind each step, and where a run ends. */
typedef struct sph_saver {
  int (*save)(void *ctx, sph_sim *sim, int last, sph_error *error);
  void *ctx;
  void (*free)(void *ctx);
} sph_saver;

/* Of walls that move, so far (sim_work.c). */
typedef struct sph_work {
  int known;            /* 1: t and power are */
  double t, power, sum; /* last measured at [s], [W/m^(3-dim)], [J/m^(3-dim)] */
} sph_work;

/* How far liquids went from what they are meant for. */
typedef struct sph_extremes {
  double mach, density;         /* the largest |v|/c0 and |rho/rho0 - 1| of all steps, */
  double mach_now, density_now; /* and of the last evaluation */
  double low[3], high[3];       /* of all particles at the start [m] */
} sph_extremes;

struct sph_sim {
  sph_error error;
  char retry[300]; /* why the last evaluation asked for a smaller step */
  sph_suspect suspect;

  /* Fixed when created. */
  int dim, threads, isa, kernel_number, periodic[3];
  const sph_kernel *kernel;
  int single; /* of mixed precision: isa is one of those, records have copies in floats */
  int uses_own_search;
  char search[SPH_METHOD_MAX];                        /* or the name of the user's own */
  sph_search own_search;                              /* the user's */
  double dx, h, H, skin, speed, origin[3], length[3]; /* H: support radius; skin [m] */
  double h_sound;             /* of the acoustic step limit, at most h [m] */
  double volume, wall_volume; /* of a particle: dx^dim, unless calibrated [m^dim] */

  /* Attached. */
  int groups, outlets, watches, modifiers, has_integrator;
  sph_group *group[SPH_SETS_MAX];
  sph_term_set terms;
  sph_outlet outlet[SPH_OUTPUTS_MAX];
  sph_watch watch[SPH_EVENTS_MAX];
  sph_modifying modifier[SPH_MODIFIERS_MAX];
  double set_scale[SPH_SETS_MAX + 1][SPH_FIELDS]; /* the user's, 0: none; last: of all fluids */
  sph_integrator_def integrator_def;
  char method[SPH_METHOD_MAX], linear[SPH_METHOD_MAX], fast[SPH_METHOD_MAX];
  sph_scheme scheme; /* the user's own, copied; its name is method */
  int (*progress)(void *ctx, sph_sim *sim);
  const char *why; /* it stops the run; NULL: "on request"; borrowed */
  void *progress_ctx;
  int kepts;
  sph_keeping kept[SPH_KEPT_MAX];
  sph_saver saver;

  /* Made by sph_sim_prepare. */
  int prepared;
  SUNContext context;
  sph_layout layout;
  N_Vector y, ydot, frame; /* state; rates of sph_sim_evaluate; state between steps, for outputs */
  N_Vector shown;          /* y or frame */
  N_Vector slope[2];       /* rates for events of type steady, and work; NULL without */
  sph_integrator *integrator;
  sph_neighbors *neighbors;
  struct sph_tangent *tangent; /* of its derivatives; NULL until one is asked for */
  sph_sorted sorted[SPH_SETS_MAX];
  unsigned loop_terms; /* bits of the fluid <- fluid loop, and SPH_DRAG */
  int fluid_sums;      /* sums that its loops make */
  int needs_temperature;
  sph_part part[SPH_PARTS];
  struct sph_implicit *implicit; /* solves stages of the implicit part; NULL without one */
  fluid_constants constants;     /* of no interaction: for walls and gradients */
  double quantum, centre[3];     /* of positions in single precision [m] (sim_single.c) */
  long surface;                  /* fluid particles at a free surface, in the last evaluation
                                             of what shifts */
  double F_scale, W_scale;       /* sigma/h^(d+2), sigma/h^d */
  double scale[SPH_SETS_MAX][SPH_FIELDS]; /* error weights: scale of each field */
  double step_scale_v;                    /* V of the error weights [m/s] */
  double given[SPH_CHANGEABLE];           /* parameters at the start (sim_keep.c) */

  /* Moving. */
  int inside;    /* of a step, a run, a sensitivity's, an adjoint's: callbacks begin no other */
  double time;   /* of the state shown */
  double looked; /* for events, up to here [s] */
  sph_work work;
  const char *stopped_by; /* the event that ended the last run or step; NULL: none */
  double start;           /* of the run: frames count from here */
  double begun;           /* sph_clock when the present sph_sim_run began; 0: none goes on */
  int listed;             /* neighbour lists exist */
  int fresh;              /* ... and have not been counted yet */
  int derived;            /* pressure etc. are those of the state shown */
  double
      limit[SPH_BOUND_COUNT]; /* step limits of the last evaluation, but not by fast terms, [s] */
  double limit_fast[SPH_BOUND_COUNT]; /* ... of the fast part */
  sph_extremes extremes;
  long near;        /* particles nearer than 0.1 dx to another, */
  double pairs_now; /* directed pairs inside the support, both when they were counted last */
  double pairs, seconds, rhs_seconds, solve_seconds; /* solve: implicit stages, with f in them */
  long list_builds, revision, matrices;              /* matrices: that implicit stages filled */
};

/* Any call on a simulation without an error?  NULL: no. */
int sph_sim_data_ok(const sph_sim *sim);

#endif
