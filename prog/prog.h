/* prog.h -- the commands of the program sphode. */
#ifndef SPH_PROG_H
#define SPH_PROG_H
#include <sphode.h>

enum { PROG_OK = 0, PROG_FAILED = 1, PROG_USAGE = 2, PROG_BAR = 3, PROG_LIMIT = 4 };
enum {
  PROG_SETS = 64,
  PROG_THREADS = 1024,
  PROG_FRAMES = 16,
  PROG_REPEATS = 100,
  PROG_SECONDS = 1000000,
  PROG_VARIED = 4,
  PROG_JOBS = 256,
  PROG_PORTS = 65535,
  PROG_RATE = 1000
}; /* at most, as in the library */

typedef struct prog_options {
  const char *what;   /* the case file, the directory, the list; NULL: not given */
  const char *output; /* NULL: by the name of the case */
  const char *set[PROG_SETS];
  int sets;
  int threads; /* 0: what the case says */
  int quiet, force, lenient, json, csv;
  int live, port;      /* a page; port 0: a free one */
  const char *q;       /* "0,0.25,1.3" */
  const char *spacing; /* info kernels: "0.01", "1cm"; NULL: not asked for */
  int dim;             /* 0: 2 and 3 */
  const char *field;   /* NULL: that of the case */
  int frames;          /* 0: that of the case */
  /* Curves instead: columns, the table in DIR (NULL: series.csv), what over (NULL: the first). */
  const char *series, *table, *over;
  const char *at; /* times of pictures and profiles, "0.1,0.2 s"; NULL: not chosen */
  /* movie: NULL, 0: the defaults */
  const char *range, *size;
  int rate;
  /* export */
  int vtu, gadget, splash, single;
  const char *format; /* "csv,vtu"; NULL: not given */
  const char *fields; /* NULL: all */
  /* work-precision: lists with commas between; NULL: the defaults. */
  const char *integrators, *tolerances, *cfl, *reference;
  const char *until;             /* NULL: the end of the case */
  int repeat;                    /* 0: 1 */
  int timeout;                   /* of a run [s]; 0: none */
  int fixed;                     /* no error control */
  int frozen;                    /* spectrum: positions are held */
  const char *vary[PROG_VARIED]; /* sweep: "dx=0.02,0.01" */
  int varied, jobs;              /* jobs 0: 1 */
  const char *picture;           /* check: of the geometry; NULL: none */
  char command[2000];
} prog_options;

/* Cases to begin with, made of prog/templates; behind the last: NULL. */
typedef struct prog_template {
  const char *name, *text;
} prog_template;
extern const prog_template sph_prog_templates[];

/* Each returns the exit status of the program. */
int sph_prog_run(const prog_options *o);
int sph_prog_restart(const prog_options *o);
int sph_prog_check(const prog_options *o);
int sph_prog_info(const prog_options *o);
int sph_prog_plot(const prog_options *o);
int sph_prog_movie(const prog_options *o);
int sph_prog_export(const prog_options *o);
int sph_prog_work_precision(const prog_options *o);
int sph_prog_spectrum(const prog_options *o);
int sph_prog_sweep(const prog_options *o);
int sph_prog_new(const prog_options *o);
int sph_prog_schema(const prog_options *o);

/* sphode info kernels: for people; --csv --q, which returns the exit status. */
void sph_prog_kernels_table(void);
int sph_prog_kernels_values(const prog_options *o);
/* --spacing, --dim: likewise. */
int sph_prog_advice(const prog_options *o);

/* "sphode: ..." on stderr; returns status. */
int sph_prog_error(int status, const char *format, ...) SPH_PRINTF(2, 3);

/* Snapshots that cannot be read are told as they come, and counted. */
sph_left_out sph_prog_left_out(int *count);
/* Tells how many of `all` there were; PROG_FAILED where there was one, else status. */
int sph_prog_left_out_end(int count, int all, int status);

/* The error of a simulation of the case, with its place in the file, else behind `what`. */
int sph_prog_sim_error(const sph_case *c, const sph_sim *sim, const char *what);

/* Warning k of a case and of its simulation, evaluated; 0: there is none. */
int sph_prog_warning(const sph_case *c, const sph_sim *sim, int k, char *text, size_t size);

/* Prints what the run of a case will write, by frames of sim, which has made steps with the outputs
 * of a trial in stage; adds to the warnings where it has no room here.  A status. */
int sph_prog_sizes(const sph_case *c, sph_sim *sim, const char *stage, int *warnings,
                   sph_error *error);

/* Where a run begins: will its snapshots have room in the directory, small as the first one is? */
void sph_prog_sizes_warn(const sph_case *c, sph_sim *sim, const char *directory);

/* Makes a directory ready for a run and holds it (nobody else writes there); a file descriptor, or
 * -1, told.  A run that ended stays unless force, and so does one that can go on from a
 * checkpoint. */
int sph_prog_directory_take(const char *directory, int force);
/* Holds the directory of a run as it is; likewise. */
int sph_prog_directory_hold(const char *directory);

typedef struct prog_progress {
  double end;                     /* [s] */
  double start, shown;            /* wall time [s] */
  double tenth;                   /* of the run, told last */
  double deadline;                /* the run is stopped then [s]; 0: never */
  double limit;                   /* the run is stopped before it [s]; 0: never */
  double queue;                   /* when the queue ends the job [s]; 0: it does not tell */
  double stepped, longest;        /* wall time of the last step, longest step so far [s] */
  double from;                    /* where the run began, or goes on [s] */
  double pairs;                   /* there */
  int quiet, live;                /* live: one line that is written over */
  struct prog_live *page;         /* prog_live.h; NULL: none */
  long bound_by[SPH_BOUND_COUNT]; /* at the last line */
} prog_progress;

/* From the first call on SIGINT and SIGTERM are noted; once: a second Ctrl-C, a second or more
 * later, ends the program. */
void sph_prog_progress_catch(int once);
/* All is written that a run goes on from: signals end the program again, if `once`. */
void sph_prog_progress_release(void);
/* Reports a run that is to go to time `end`; SIGINT and SIGTERM stop it. */
void sph_prog_progress_start(prog_progress *p, sph_sim *sim, double end, int quiet);
void sph_prog_progress_end(prog_progress *p);
/* The signal that stopped the run; 0: none. */
int sph_prog_progress_signal(void);
/* Would two steps as long as the longest go beyond the limit? */
int sph_prog_progress_over(const prog_progress *p);
double sph_prog_progress_now(void); /* wall time [s] */

/* The case of a run; NULL: a run without one, and the defaults. */
sph_case *sph_prog_plot_of(const char *directory);
/* Draws the pictures of a finished run with n comparisons, and prints their paths. */
void sph_prog_plot_case(const sph_case *c, const char *directory, int n);

#endif
