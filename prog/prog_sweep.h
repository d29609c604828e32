/* prog_sweep.h -- runs of a case that differ in some keys: what is varied, what each run told. */
#ifndef SPH_PROG_SWEEP_H
#define SPH_PROG_SWEEP_H
#include "prog.h"

enum { SWEEP_KEYS = 4, SWEEP_VALUES = 32, SWEEP_RUNS = 256, SWEEP_COMPARED = 32, SWEEP_NAME = 200 };

typedef struct sweep_key {
  char key[100];
  int n;
  char value[SWEEP_VALUES][100];
} sweep_key;

typedef struct sweep_run {
  char set[SWEEP_KEYS][SWEEP_NAME + 1]; /* "dx=0.02" */
  char name[SWEEP_NAME];                /* of its directory, in that of the sweep */
  int process;                          /* 0: not running */
  int goes_on;                          /* from the checkpoint of an earlier sweep */
  int done, status;                     /* exit status; 128 + its number: a signal */
  int unlogged;                         /* its .log is not all there */
  double spacing, seconds;              /* [m], [s] */
  long particles, steps;
  int compared, missed; /* comparisons, and bars among them */
  struct {
    char name[80], norm[20];
    double value;
  } of[SWEEP_COMPARED];
} sweep_run;

typedef struct sweep {
  const prog_options *o;
  char directory[3000];
  int keys, runs;
  int stopping; /* the runs were told to */
  sweep_key key[SWEEP_KEYS];
  sweep_run run[SWEEP_RUNS];
} sweep;

/* The numbers of its summary; the status of its simulation, -1: there is no summary. */
int sph_prog_sweep_left_read(const sweep *s, sweep_run *r);
/* What an earlier sweep left of a run whose case is `text` now: it is done, goes on or begins anew;
 * an exit status, told, where it is of another case. */
int sph_prog_sweep_left(const sweep *s, sweep_run *r, const char *text);

/* Was it stopped by a signal, or a limit of time? */
int sph_prog_sweep_stopped(const sweep_run *r);
/* For people; sweep.csv, and convergence.csv and .png where errors fall: exit statuses. */
void sph_prog_sweep_print(const sweep *s);
int sph_prog_sweep_write(const sweep *s);

#endif
