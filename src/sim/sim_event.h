/* sim_event.h -- events and modifiers at work (sphode/event.h). */
#ifndef SPH_SIM_EVENT_H
#define SPH_SIM_EVENT_H
#include "sim_data.h"

/* ---- event.c: what each type measures ---- */

/* Checks a definition and takes it in. */
int sph_event_take(sph_watch *watch, const sph_event *event, const sph_sim *sim, sph_error *error);
/* Its quantity in the state shown; NaN: undefined there, as a front of nothing. */
int sph_event_measure(sph_sim *sim, const sph_watch *watch, double *quantity);
/* The value at which it passes. */
double sph_event_threshold(const sph_watch *watch);
/* Does its moment need no search?  Does it look at rates? */
int sph_event_known(const sph_watch *watch);
int sph_event_steady(const sph_watch *watch);

/* ---- sim_event.c: when, and what then ---- */

/* Before a step: on which side of zero are those that are new? */
int sph_sim_event_start(sph_sim *sim);
/* A step was made, from that time to the present, and has not been looked at. */
void sph_sim_event_stepped(sph_sim *sim, double from);
/* The next moment of the last step not handled yet, INFINITY: none; the state shown is any. */
int sph_sim_event_next(sph_sim *sim, double *t);
/* All events of that moment: counted, told, their frames written.  *cut: the step ends here. */
int sph_sim_event_happen(sph_sim *sim, double t, int *cut);
/* The step ends at t: the state there becomes the state of the simulation. */
int sph_sim_event_cut(sph_sim *sim, double t);
/* Changes of the events that happened there, and the stop. */
int sph_sim_event_act(sph_sim *sim);

/* ---- sim_modifier.c ---- */

/* At the end of a step: those that are due. */
int sph_sim_modifier_run(sph_sim *sim);

#endif
