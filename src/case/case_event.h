/* case_event.h -- the events of a case. */
#ifndef SPH_CASE_EVENT_H
#define SPH_CASE_EVENT_H
#include "case_build.h"

/* Checks what no key of an event alone can tell; a status, the reason in c->error. */
int sph_case_event_check(const sph_case *c);
/* Adds them to the simulation of the case; a status, the reason in error. */
int sph_case_event_add(const sph_case *c, sph_sim *sim, const sph_case_motions *motions,
                       sph_error *error);

#endif
