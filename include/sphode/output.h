/* sphode/output.h -- what is written while a simulation runs, and what is made of it afterwards.
 *
 * A built-in output and a user's own are the same struct.  While a callback runs, the simulation
 * shows the state at sph_sim_time(sim): dense output, so that no frame shortens a step.
 *
 * Every file but the growing time series is written under a temporary name (.tmp), synchronised
 * and renamed: a killed run or a full disk leaves whole files only. */
#ifndef SPHODE_OUTPUT_H
#define SPHODE_OUTPUT_H
#include <stddef.h>

#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

struct sph_sim;
struct sph_keep;         /* sphode/checkpoint.h */
struct sph_balance;      /* sphode/sim.h */
struct sph_event_record; /* sphode/event.h */

typedef struct sph_output {
  const char *name;
  double interval; /* [s] between frames, from the start; 0: every step; INFINITY: start and end */
  /* Each returns 0 or < 0 with the reason in error.  open: before the first frame; NULL is fine. */
  int (*open)(void *ctx, struct sph_sim *sim, sph_error *error);
  int (*frame)(void *ctx, struct sph_sim *sim, sph_error *error);
  /* After the last frame: when the simulation is freed or a run fails, not when sph_sim_run
   * returns, after which it may go on.  What close writes is read back after sph_sim_free. */
  int (*close)(void *ctx, struct sph_sim *sim, sph_error *error);
  void *ctx;
  void (*free)(void *ctx); /* called once */
  /* An event happened (sphode/event.h), in the state that sim shows; NULL is fine. */
  int (*event)(void *ctx, struct sph_sim *sim, const struct sph_event_record *record,
               sph_error *error);
  /* Of an open output: its place, for checkpoints.  When one is read it is called in place of open,
   * and goes on from there.  NULL: the output is opened anew there. */
  int (*keep)(void *ctx, struct sph_sim *sim, struct sph_keep *keep, sph_error *error);
} sph_output;

/* ---- snapshots -------------------------------------------------------------------------------
 * directory/snapshot_0000.hdf, ...: HDF5, one file a frame; the directory is made.
 *   /Header /PartType0 (fluids, group after group) /PartType1 (walls): as GADGET's; SI units
 *              (coordinates inside the box in periodic directions)
 *   /VTKHDF    the fluids for ParaView: hard links to the data of /PartType0, named with units
 *              ("Velocities [m per s]": no name in HDF5 has a "/")
 *   /Groups    names and kinds; the dataset "Group" of a particle counts them from 0
 *   /Code /Parameters /Units   where the numbers come from
 * walls_0000.hdf: the walls for ParaView, a link into the snapshot.  ParaView opens
 * snapshot.hdf.series and walls.hdf.series, which know the times.
 *
 * Files of the same names are replaced; of an older, longer run in the same directory the last
 * ones stay, which the .series do not list. */
typedef struct sph_hdf5_def {
  const char *directory;
  double interval;       /* [s]; see sph_output */
  const char *case_text; /* kept word for word in /Parameters; NULL: none */
  const char *command;   /* the command line, kept in /Code; NULL: none */
  int single;            /* 1: fields of single precision, about half the size; 0: double */
  int compression;       /* 1 (quick) to 9 (small); 0: 1; -1: none */
  /* Names of fields with spaces or commas between them ("velocity pressure"), besides position,
   * mass, density, smoothing length, number and group, which are in all snapshots: without them no
   * reader can place or weigh particles.  Walls have those of them that they have.  NULL: all. */
  const char *fields;
} sph_hdf5_def;

SPH_API sph_output sph_output_hdf5(const char *directory, double interval);
SPH_API sph_output sph_output_hdf5_def(const sph_hdf5_def *def); /* strings are copied */
/* Bytes of the files of a frame, as the state is now, without writing them; < 0: a status. */
SPH_API long sph_output_hdf5_size(struct sph_sim *sim, const sph_hdf5_def *def, sph_error *error);

/* ---- time series -----------------------------------------------------------------------------
 * directory/series.csv: a line with the names and units of the columns, "front [m]", then a row a
 * frame, in the file before the run goes on.  Columns: time, step, dt, kinetic, potential,
 * internal, total, momentum_x ..., angular_momentum_z ..., NAME_mean (by mass), NAME_min, NAME_max
 * of each scalar of a term, and one for each monitor.
 *
 * Monitors look at one fluid group or at all fluids; periodic images are not seen.
 *   front      largest coordinate along `axis` of a particle with >= 3 neighbours within 2 dx,
 *              + dx/2: spray does not count; NaN where there is none [m]
 *   height     the same along the last direction (y in 2D, z in 3D) [m]
 *   gauge      a wave gauge: the highest place on the line through x along the last direction where
 *              sum V W = 1/2, as it is on a flat surface; NaN where there is none.  Nearer than the
 *              kernel's support to a wall beside it, it reads too low; lone particles of spray are
 *              not seen in 2D and 3D [m] (docs/theory.md)
 *   pressure   at x: sum V p W / sum V W, and 0 where sum V W < 0.15 (dry: an immersed point has
 *              1, a point on an immersed wall 1/2) [Pa].  With an extent: the mean over the
 *              ellipsoid (disc, segment) with these half lengths, sampled every dx or finer
 *   semi-axis  sqrt((dim + 2) mean (x - mean x)^2) along `axis`: of an ellipse or ellipsoid [m] */
typedef struct sph_monitor {
  const char *name;  /* of the column: [A-Za-z0-9_.-], at most 63 */
  const char *type;  /* "front", "height", "gauge", "pressure", "semi-axis" */
  const char *group; /* NULL: all fluids */
  int axis;          /* 0, 1, 2 */
  double x[3];       /* [m] */
  double extent[3];  /* half lengths [m]; all 0: a point */
} sph_monitor;

SPH_API const char *sph_monitor_type(int k);            /* NULL behind the last */
SPH_API const char *sph_monitor_unit(const char *type); /* "m", "Pa"; NULL: unknown type */
/* Its value in the state that the simulation shows. */
SPH_API int sph_monitor_value(const sph_monitor *monitor, struct sph_sim *sim, double *value,
                              sph_error *error);

SPH_API sph_output sph_output_series(const char *directory, double interval,
                                     const sph_monitor *monitors, int n); /* copied */

/* A wall of which the force is wanted, and the point that its torque is about. */
typedef struct sph_series_force {
  const char *wall;
  double about[3]; /* [m] */
} sph_series_force;

/* The same, with more columns behind the monitors:
 *   of each wall in `force`: NAME_force_x ... [N/m in 2D], NAME_pressure_x ..., NAME_viscous_x ...,
 *              and NAME_torque_z (3D: _x, _y, _z): sph_sim_force
 *   where walls move, without being asked for: work [J/m in 2D]: sph_sim_work
 *   powers     TERM_kinetic [W/m in 2D], TERM_internal of each term: sph_sim_power */
typedef struct sph_series_def {
  const char *directory;
  double interval; /* [s]; see sph_output */
  int monitors;
  const sph_monitor *monitor; /* [monitors] */
  int forces;
  const sph_series_force *force; /* [forces] */
  int powers;                    /* 1: yes */
} sph_series_def;
SPH_API sph_output sph_output_series_def(const sph_series_def *def); /* all is copied */

/* ---- probes ----------------------------------------------------------------------------------
 * directory/probe_NAME.csv: fields of the fluids at places, interpolated,
 *
 *   f(x) = sum_j V_j f_j W(x - x_j) / sum_j V_j W(x - x_j)   (Shepard 1968: exact for constants)
 *
 * over the fluid particles alone.  A row a place and frame: time, x, y, z, cover = sum V W, then
 * the fields; "nan" where cover < 0.15: no fluid is near (an immersed place has 1, one on an
 * immersed wall 1/2).  Behind each frame of more than one place stands an empty line.  Vectors have
 * a column for each direction. */
typedef struct sph_probe_def {
  const char *directory;
  const char *name; /* of the file: [A-Za-z0-9_.-], at most 63 */
  double interval;  /* [s]; see sph_output */
  /* Names of the field table and of scalars of terms, with spaces between them; NULL: "pressure
   * velocity density". */
  const char *fields;
  const char *group; /* a fluid; NULL: all fluids, which must have these fields */
  /* The places: x[points][3] [m], or, with points 0, a grid: from + i/(n[0] - 1) along +
   * j/(n[1] - 1) across, i = 0 .. n[0] - 1, j = 0 .. n[1] - 1.  n 0: 1.  A line has n[1] 1. */
  long points;
  const double *x;
  double from[3], along[3], across[3]; /* [m] */
  long n[2];
} sph_probe_def;
SPH_API sph_output sph_output_probe(const sph_probe_def *def); /* all is copied */

/* ---- events ----------------------------------------------------------------------------------
 * directory/events.csv: time, step, event (its name), value: a row for each moment of each event
 * (sphode/event.h), in the file before the run goes on. */
SPH_API sph_output sph_output_events(const char *directory);

/* ---- a failed run ----------------------------------------------------------------------------
 * Where sph_sim_run or sph_sim_step returned SPH_ERR_STEP, the error tells the particle at which
 * the step failed, and all outputs have a frame of the last good state.  This writes, as a CSV, the
 * particles within two supports of it: group, id, distance [m], all fields, and the acceleration by
 * each term.  SPH_ERR_STATE: no step has failed. */
SPH_API int sph_failure_write(struct sph_sim *sim, const char *path, sph_error *error);

/* ---- summary ---------------------------------------------------------------------------------*/
/* A measured distance from something outside the code. */
typedef struct sph_comparison {
  const char *name;      /* "front, a = 2.25 in" */
  const char *reference; /* "Martin & Moyce (1952)" */
  const char *quantity;  /* "front" */
  const char *norm;      /* "rms", "l1", ... */
  double value;          /* the distance */
  double bar;            /* value <= bar passes; NaN: reported, not judged */
  int pass;              /* read where bar is a number */
  const char *note;      /* "offset 0.31; 0.045 without"; NULL: none */
} sph_comparison;

/* directory/summary.json and summary.txt, after a run (also a failed one).  start: sph_sim_balance
 * at the start, for the drifts, of the energy besides the work of walls that move (sph_sim_work);
 * NULL: none are told. */
SPH_API int sph_summary_write(const char *directory, struct sph_sim *sim,
                              const struct sph_balance *start, const sph_comparison *comparison,
                              int n, sph_error *error);
/* The same for people.  As snprintf: fills at most size bytes, returns the length needed. */
SPH_API int sph_summary_text(char *buffer, size_t size, struct sph_sim *sim,
                             const struct sph_balance *start, const sph_comparison *comparison,
                             int n);

/* ---- pictures --------------------------------------------------------------------------------
 * Drawn by gnuplot (SPH_ERR_UNBUILT, with what to install, where there is none).  Beside x.png stay
 * x.gp and x.dat, the script and its data: edit the script, run `gnuplot x.gp`. */

/* The particles of a simulation, each group in a colour: what a case is, before it runs.  3D: a
 * slice through the middle of the thinner horizontal direction.  title: NULL: none. */
SPH_API int sph_plot_geometry(const struct sph_sim *sim, const char *title, const char *png,
                              sph_error *error);

/* Particles coloured by a field ("pressure", "velocity": its magnitude, "velocity_x", "density",
 * "energy", ...; NULL: "velocity"), walls grey, axes equal.  path: a snapshot, or a directory (its
 * last one).  3D: a slice through the middle of the fluid's thinner horizontal direction.
 * 1D: the field over x. */
SPH_API int sph_plot_particles(const char *path, const char *field, const char *png,
                               sph_error *error);
/* n snapshots of a directory, evenly from the first to the last, one above the other, one colour
 * scale. */
SPH_API int sph_plot_frames(const char *directory, const char *field, int n, const char *png,
                            sph_error *error);
/* The same of chosen snapshots. */
typedef struct sph_sheet_def {
  const char *directory;
  const char *field;     /* NULL: as above */
  int n;                 /* panels, 1 to 16 */
  const long *number;    /* [n] of the snapshots (12: snapshot_0012.hdf); NULL: evenly, as above */
  sph_left_out left_out; /* of snapshots that cannot be read */
} sph_sheet_def;
SPH_API int sph_plot_sheet(const sph_sheet_def *def, const char *png, sph_error *error);
/* number[n] of the snapshots nearest to n times [s]; of two as near the earlier one. */
SPH_API int sph_plot_nearest(const char *directory, const double *time, int n, long *number,
                             const sph_left_out *left_out, sph_error *error);
/* A plane of places, as a probe writes it (probe_NAME.csv): n of its times, evenly from the first
 * to the last, as maps of a column, one colour scale. */
SPH_API int sph_plot_plane(const char *csv, const char *column, int n, const char *png,
                           sph_error *error);
/* Those of its times that are nearest to time[n] [s]. */
SPH_API int sph_plot_plane_at(const char *csv, const char *column, const double *time, int n,
                              const char *png, sph_error *error);
/* All snapshots of a directory as a movie, by gnuplot and ffmpeg (SPH_ERR_UNBUILT where one is not
 * there): each as sph_plot_particles draws it, all with the same colours and axes.  Its frames are
 * drawn into the folder PATH.frames, which is removed in the end. */
typedef struct sph_movie_def {
  const char *directory;
  const char *field;      /* NULL: "velocity" */
  const char *path;       /* of the movie: .mp4, or .png, .apng: animated PNG */
  double from, to;        /* of the colours [SI]; from == to: what the field has in all frames */
  int width, height;      /* [pixels]; 0: at most 1200, what the picture needs */
  double rate;            /* frames a second; 0: 25 */
  sph_left_out left_out;  /* of snapshots that cannot be read, or are missing between others */
  int (*stop)(void *ctx); /* asked between frames, and ten times a second of ffmpeg; not 0: the */
  void *stop_ctx;         /* movie is given up, SPH_ERR_STOPPED.  NULL: never */
} sph_movie_def;
/* Returns the number of frames, or < 0; a movie that was there stays until the new one is whole. */
SPH_API int sph_movie_write(const sph_movie_def *def, sph_error *error);
/* Snapshots in a directory; < 0: a status. */
SPH_API int sph_plot_count(const char *directory, sph_error *error);

/* A curve: two columns of a CSV file (comma separated, lines with # are comments, one header line
 * where a unit in brackets is not part of the name), or, where `csv` ends in .hdf, of the fluid
 * particles of a snapshot: x, y, z, and its fields.
 * Drawn: ((x - x_offset)/x_scale, y/y_scale). */
typedef struct sph_plot_curve {
  const char *csv;
  const char *x, *y;       /* column names; x NULL: the first, y NULL: the second */
  double x_scale, y_scale; /* 0: 1 */
  double x_offset;         /* in the unit of the column */
  const char *label;       /* in the key; NULL: the column's name, and the time of at, snapshots */
  int points;              /* 1: points, 0: a line, 2: both */
  int colour;              /* of the palette, from 1 to 8; 0: by its place among the curves */
  const char *where, *is;  /* of the rows whose column `where` holds the word `is`; NULL: of all */
  const double *at;        /* [s]: of the rows whose `time` is nearest to it; NULL: of all */
} sph_plot_curve;

typedef struct sph_plot_def {
  const char *title;                 /* NULL: none */
  const char *x_label, *y_label;     /* NULL: the column's name and unit of the first curve */
  double x_min, x_max, y_min, y_max; /* min == max: what the curves need */
  int log_x, log_y;                  /* logarithmic axes */
  int panels; /* 1: one above the other for each unit of y, over one axis of x; y_label NULL */
} sph_plot_def;

SPH_API int sph_plot_series(const sph_plot_curve *curve, int n, const sph_plot_def *def,
                            const char *png, sph_error *error);

#ifdef __cplusplus
}
#endif
#endif
