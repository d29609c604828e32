/* prog_job.h -- a run of a case, from its start (prog_run.c) or a checkpoint (prog_restart.c). */
#ifndef SPH_PROG_JOB_H
#define SPH_PROG_JOB_H
#include "prog.h"

typedef struct prog_job {
  const prog_options *o;
  sph_case *c;
  sph_sim *sim;
  char directory[4000];
  const char *command; /* the line that made the run, for what it writes */
  char line[4100];
  double end;             /* [s] */
  int held;               /* the directory, -1: not */
  char *before;           /* the case.yml that this one replaced, owned; NULL: there was none */
  struct prog_live *page; /* prog_live.h; NULL: none */
  sph_balance start;      /* of the fluids */
  sph_comparison *comparison;
  int comparisons;
} prog_job;

/* The simulation of j->c at its start, with j->start, which checkpoints keep; an exit status. */
int sph_prog_run_build(prog_job *j);
/* The page, where one is wanted, before anything is written: its port may be taken. */
int sph_prog_run_listen(prog_job *j);
/* Its outputs and checkpoints. */
void sph_prog_run_outputs(prog_job *j);
/* case.yml; the one before comes back where the run does not begin. */
int sph_prog_run_keep(prog_job *j);
/* Runs to j->end, compares, tells, draws; frees all of the job.  status: of what came before. */
int sph_prog_run_finish(prog_job *j, int status);

#endif
