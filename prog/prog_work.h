/* prog_work.h -- sphode work-precision: integrators, their runs, and what is told of them. */
#ifndef SPH_PROG_WORK_H
#define SPH_PROG_WORK_H
#include "prog.h"

enum { WORK_METHODS = 40, WORK_VALUES = 24, WORK_RUNS = 640, WORK_FIELDS = 16, WORK_COLUMNS = 24 };

/* What is compared: integrated fields, the columns of a state are their components. */
typedef struct work_fields {
  int n;                         /* fields */
  char name[WORK_FIELDS][64];    /* "position", "velocity", ... */
  int columns;                   /* components of all */
  int field[WORK_COLUMNS];       /* of a column */
  int component[WORK_COLUMNS];   /* of the field */
  long particles;                /* of all fluids */
  double scale[WORK_FIELDS];     /* of the first fluid, to be told */
  const char *unit[WORK_FIELDS]; /* of the scales */
} work_fields;

/* An integrator as it was named: "imex:ark324l2sa-4-2-3+linear=cholmod". */
typedef struct work_method {
  char label[120];
  char method[64];
  sph_case *c;              /* with the keys behind the + set */
  int error_control, wants; /* sph_integrator_info */
  double dt; /* the smallest step that its limits allowed by default [s]; 0: not run yet */
} work_method;

/* What a run is asked for: a tolerance, or fixed steps as a fraction of the stability limit. */
typedef struct work_run {
  int method;          /* number in work.method; < 0: a reference */
  const char *setting; /* "tolerance", "cfl" */
  double value;
  double dt_fixed; /* [s]; 0: none */
  int status;
  char reason[400]; /* of a run that failed */
  sph_sim_stats stats;
  double cpu, wall;          /* [s] */
  double *state;             /* [columns][particles] by particle number, in scales; NULL: failed */
  double error[WORK_FIELDS]; /* rms over particles; NaN: none */
} work_run;

typedef struct work {
  const prog_options *o;
  char directory[4000];
  double end; /* [s] */
  int methods, runs;
  work_method method[WORK_METHODS];
  work_run run[WORK_RUNS];
  work_fields fields;
  int shown; /* field of the pictures and of the summary */
  /* The reference. */
  work_method reference;
  work_run best;                /* the finest */
  int halvings;                 /* of its first step */
  double floor_of[WORK_FIELDS]; /* its own error, estimated */
  int poor;                     /* that is more than a tenth of the least error */
} work;

/* The fields of a prepared simulation that are compared. */
void sph_prog_work_state_fields(const sph_sim *sim, work_fields *fields);
/* The state shown, in scales, by particle number: [columns][particles], free(); NULL: no memory. */
double *sph_prog_work_state_take(const sph_sim *sim, const work_fields *fields);
/* Root mean square over particles of the distance in each field. */
void sph_prog_work_state_distance(const work_fields *fields, const double *a, const double *b,
                                  double distance[WORK_FIELDS]);

/* work-precision.csv, .txt (also to standard output) and the pictures; an exit status. */
int sph_prog_work_report(work *w);

#endif
