/* sphode/event.h -- events: moments at which a function of time and state passes zero; and what
 * changes a simulation between steps.
 *
 * In each step the function is looked at where the step begins and ends (and at `samples` points
 * between); where it changes its sign, the moment is found in the dense output of the step, by
 * Brent's method, to 1e-12 of the step.  It is the same for every integrator: no step is shortened
 * to look.  What is zero at the start, or touches zero and goes back, passes once or not at all,
 * never twice; two passages between two looks are not seen.
 *
 * The order of one moment: frames that are due, then the events' rows and frames, all of the state
 * before; then changes, in the order in which events were added; then the stop.  Frames behind an
 * event that changes or stops are those of the steps that follow it.  At the end of a step, cut
 * short or not, come the modifiers, then the progress callback. */
#ifndef SPHODE_EVENT_H
#define SPHODE_EVENT_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

struct sph_sim;

enum { SPH_EVENTS_MAX = 32, SPH_EVENT_SAMPLES_MAX = 64, SPH_MODIFIERS_MAX = 16 };

/* Types, and the quantity q that passes `threshold`:
 *   front    the front of a fluid as that monitor measures it (sphode/output.h) [m]; no front: no
 *            event; rising
 *   wet      sum V W at x passes 0.15, as for a pressure monitor; threshold is not read; rising
 *   dry      the same, falling
 *   energy   an energy of all fluids (sph_balance) [J]; in both directions
 *   steady   rms of the rates of all integrated fields but the position, each over its scale of
 *            the error weights: 1/(time in which a field changes by its scale) [1/s]; falling.  Of
 *            particles, not of places: a fluid that turns is accelerated
 *   time     the time [s]; rising */
typedef struct sph_event {
  const char *name; /* [A-Za-z0-9_.-], at most 63, no other event's; copied, like all strings */
  const char *type; /* NULL: value is given */
  double threshold;
  const char *group;    /* of front: NULL: all fluids */
  int axis;             /* of front: 0, 1, 2 */
  double x[3];          /* of wet, dry [m] */
  const char *quantity; /* of energy: "kinetic", "potential", "internal", "total" (NULL) */
  /* A type of your own: its value in the state that sim shows, finite.  It reads, and may
   * sph_sim_fail; it writes no field and makes no step. */
  double (*value)(void *ctx, struct sph_sim *sim);
  const char *direction; /* "rising", "falling", "both"; NULL: that of the type, of an own "both" */
  int samples;           /* looks inside each step, 0 to 64 */
  /* What it does besides being counted and told to the outputs (sph_output.event). */
  int once;     /* at its first moment only */
  int snapshot; /* every open output writes a frame of exactly that moment */
  int stop;     /* sph_sim_run ends there with SPH_OK; it may go on from there */
  /* Writes fields, changes parameters (sph_sim_change_term or those of a term, an equation of
   * state, a motion of your own): the integrator starts anew from there.  0 or a status < 0. */
  int (*change)(void *ctx, struct sph_sim *sim);
  void *ctx;            /* of value and change; borrowed unless free is given */
  void (*free)(void *); /* called once; may be NULL */
} sph_event;

/* Before the run or between steps. */
SPH_API void sph_sim_add_event(struct sph_sim *sim, const sph_event *event);

SPH_API const char *sph_event_type(int k);            /* NULL behind the last */
SPH_API const char *sph_event_unit(const char *type); /* of the threshold, "m"; NULL: unknown */

/* One moment, as outputs are told of it. */
typedef struct sph_event_record {
  const char *name;
  double t;     /* [s] */
  double value; /* q, or what an own function gave, there */
  long step;    /* accepted steps, the one it lies in included */
} sph_event_record;

/* Event k = 0, 1, ... in the order in which they were added. */
typedef struct sph_event_info {
  const char *name;
  long count;         /* moments so far */
  double first, last; /* the first and the last of them [s]; NaN: none */
} sph_event_info;
SPH_API int sph_sim_event_get(const struct sph_sim *sim, int k, sph_event_info *info); /* 0: none */
/* The event that ended the last sph_sim_run or sph_sim_step; NULL: none did. */
SPH_API const char *sph_sim_stopped_by(const struct sph_sim *sim);

/* What writes fields between steps: particle shifting, density filters, ...  It runs at the ends
 * of steps, behind frames and events there. */
typedef struct sph_modifier {
  const char *name; /* copied */
  long steps;       /* after every so many accepted steps, > 0; or 0 and */
  double interval;  /* at the first end of a step at or behind each multiple of it [s] */
  /* Returns > 0: it wrote to fields, and the integrator starts anew from them, once for all
   * modifiers of a step; 0: it did not; < 0: a failure (sph_sim_fail tells why). */
  int (*modify)(void *ctx, struct sph_sim *sim);
  void *ctx;            /* borrowed unless free is given */
  void (*free)(void *); /* called once; may be NULL */
} sph_modifier;

SPH_API void sph_sim_add_modifier(struct sph_sim *sim, sph_modifier modifier);

#ifdef __cplusplus
}
#endif
#endif
