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
  int process, pipe;                    /* 0, -1: not running */
  int done, status;                     /* exit status; 128 + its number: a signal */
  int unlogged;                         /* its .log is not all there */
  double spacing, seconds;              /* [m], [s] */
  long particles, steps;
  int compared;
  struct {
    char name[80], norm[20];
    double value, bar; /* bar NaN: none */
  } of[SWEEP_COMPARED];
} sweep_run;

typedef struct sweep {
  const prog_options *o;
  char directory[3000];
  int keys, runs;
  sweep_key key[SWEEP_KEYS];
  sweep_run run[SWEEP_RUNS];
} sweep;

/* For people; sweep.csv, and convergence.csv and .png where errors fall: exit statuses. */
void sph_prog_sweep_print(const sweep *s);
int sph_prog_sweep_write(const sweep *s);

#endif
