/* sphode/case.h -- case files: a simulation, its outputs and what it is compared with, as a
 * text.
 *
 * docs/case-files.md tells every key.  Errors read "file:line:column: what was found; what is
 * right".  A case is read only once made: simulations of one case may be made and run in several
 * threads. */
#ifndef SPHODE_CASE_H
#define SPHODE_CASE_H
#include <stddef.h>

#include "sphode/base.h"
#include "sphode/output.h"
#include "sphode/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_case sph_case;

/* Reads and checks a case file; set[n]: "key=value", as "spacing=1 cm" or
 * "groups.0.density=900", put in place of what the file says.  NULL: the reason is in error. */
SPH_API sph_case *sph_case_read(const char *path, int n, const char *const *set, sph_error *error);
/* The same of a text of `size` bytes; path stands in messages, and files are searched beside it. */
SPH_API sph_case *sph_case_read_text(const char *path, const char *text, size_t size, int n,
                                     const char *const *set, sph_error *error);
SPH_API void sph_case_free(sph_case *c);

/* The simulation of the case, without outputs; threads: 0 takes what the case says.  NULL: see
 * error. */
SPH_API sph_sim *sph_case_build(const sph_case *c, int threads, sph_error *error);
/* Do the parts of terms fit the integrator that the case names?  Else a run of that simulation
 * fails; here the place in the file is told.  Another integrator may be set for it. */
SPH_API int sph_case_check_parts(const sph_case *c, sph_error *error);
/* Keys that do nothing without their partner, as heat_flux without conduction, events behind the
 * end of the run, periods longer than it: warning k = 0, 1, ... written to text[size]; 0: none. */
SPH_API int sph_case_warning(const sph_case *c, int k, char *text, size_t size);
/* Monitors, probes, events that look far outside of all particles of the simulation; likewise. */
SPH_API int sph_case_warning_places(const sph_case *c, const sph_sim *sim, int k, char *text,
                                    size_t size);
/* What event k = 0, 1, ... of the case waits for, does and changes, in one line; 0: none. */
SPH_API int sph_case_event_text(const sph_case *c, int k, char *text, size_t size);
/* The integrator that the case names, as its simulation has it; its strings live as long as c. */
SPH_API void sph_case_build_integrator(const sph_case *c, sph_integrator_def *def);
/* The outputs of the case, into a directory; command: the command line, kept in the snapshots;
 * NULL: none. */
SPH_API void sph_case_build_outputs(const sph_case *c, sph_sim *sim, const char *directory,
                                    const char *command);

/* Those of them that are small: all but snapshots. */
SPH_API void sph_case_build_series(const sph_case *c, sph_sim *sim, const char *directory);
/* The same for a trial: a frame where a run starts and one where it ends. */
SPH_API void sph_case_build_output_trial(const sph_case *c, sph_sim *sim, const char *directory);

/* What the run of a case will write, as bytes that are really made. */
typedef struct sph_case_size {
  char name[80];   /* "snapshots", a table, as "series.csv", "checkpoints" */
  double interval; /* [s]; of checkpoints 0 */
  double frames;   /* of the whole run; of checkpoints: so many stay */
  double bytes;    /* of one; of a table: of the rows of a frame */
} sph_case_size;
/* Entry k = 0, 1, ... of it, behind a trial in directory (sph_case_build_output_trial,
 * sph_sim_run) and in the state that sim shows, checkpoints last; directory NULL: counts alone,
 * bytes NaN.  1; 0: there is none; < 0: a status, also where steps as long as the largest so far
 * would have more frames in them than a run takes. */
SPH_API int sph_case_size_get(const sph_case *c, sph_sim *sim, const char *directory, int k,
                              sph_case_size *size, sph_error *error);

/* Checkpoints of the case (sphode/checkpoint.h) into a directory, which hold its text; behind its
 * outputs. */
SPH_API void sph_case_build_checkpoints(const sph_case *c, sph_sim *sim, const char *directory,
                                        const char *command);

/* May a run of case `before` go on as one of case `now`?  What its state was made with, what its
 * tables have columns and rows of must stay: what is another there is told by its key. */
SPH_API int sph_case_restart_check(const sph_case *before, const sph_case *now, sph_error *error);

/* Copies of the files that the case names (tables, surfaces, particles) to directory/files, where a
 * case in that directory finds them before any others; of those above 64 MB symbolic links.  A
 * status. */
SPH_API int sph_case_files_keep(const sph_case *c, const char *directory, sph_error *error);

/* What a finished run in a directory says against the references of the case: *list[*n],
 * sph_case_compare_free.  Comparisons k with solutions in space leave directory/compare_k.csv. */
SPH_API int sph_case_compare(const sph_case *c, sph_sim *sim, const char *directory,
                             sph_comparison **list, int *n, sph_error *error);
SPH_API void sph_case_compare_free(sph_comparison *list, int n);
/* Before the run: are the tables of all comparisons there, are their quantities fields of the
 * fluids or columns of directory/series.csv (NULL: not looked at)?  A status, the reason in error.
 */
SPH_API int sph_case_compare_check(const sph_case *c, sph_sim *sim, const char *directory,
                                   sph_error *error);
/* Before the run: will snapshots have the field of the picture (plot)?  Of a simulation that is
 * evaluated. */
SPH_API int sph_case_plot_check(const sph_case *c, sph_sim *sim, sph_error *error);
/* Draws comparison k = 0, 1, ..., of a time series with a table or of particles with a solution in
 * space, as directory/compare_k.png, whose path is written to png[size].  SPH_ERR_ARGUMENT: not
 * such a comparison. */
SPH_API int sph_case_compare_plot(const sph_case *c, int k, const char *directory, char *png,
                                  size_t size, sph_error *error);

/* "file:line:column" of the probe, monitor, event or group that an error of the simulation names,
 * in place[size]; 0: it names none that the file has. */
SPH_API int sph_case_place(const sph_case *c, const char *message, char *place, size_t size);

SPH_API const char *sph_case_title(const sph_case *c);
/* Read again, both give a case: text this one, as it is with what was set (which stands in comments
 * in front, too); source as it was without.  Of several files they are joined; where something was
 * set, text has no other comments of the file. */
SPH_API const char *sph_case_text(const sph_case *c);
SPH_API const char *sph_case_source(const sph_case *c);
SPH_API const char *sph_case_set(const sph_case *c, int k); /* what was set; NULL behind the last */
SPH_API double sph_case_end(const sph_case *c);             /* [s] */
SPH_API double sph_case_time_limit(const sph_case *c);      /* wall time [s]; 0: none */
SPH_API const char *sph_case_plot_field(const sph_case *c);
SPH_API int sph_case_plot_frames(const sph_case *c);

/* The manual of the format as Markdown, made from the same table that checks case files.  As
 * snprintf. */
SPH_API int sph_case_manual(char *buffer, size_t size);
/* The same as a JSON Schema, for editors.  As snprintf. */
SPH_API int sph_case_schema_json(char *buffer, size_t size);

#ifdef __cplusplus
}
#endif
#endif
