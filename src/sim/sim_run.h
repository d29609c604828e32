/* sim_run.h */
#ifndef SPH_SIM_RUN_H
#define SPH_SIM_RUN_H
#include "sim_data.h"

/* Makes pressure, sound speed and walls those of the state shown, if they are not. */
int sph_sim_run_derived(sph_sim *sim);
/* Shows the state at t: the present one, or one inside the last step. */
int sph_sim_run_show(sph_sim *sim, double t);
/* A frame of the state shown in every open output, unless it has one of that moment. */
int sph_sim_run_frame_all(sph_sim *sim);
/* One accepted step, not past t_stop, of a prepared simulation, its events, modifiers and, if
 * framed, its frames. */
int sph_sim_run_step(sph_sim *sim, double t_stop, int framed);
/* Around what makes steps: callbacks of one begin no other (recorded). */
int sph_sim_run_enter(sph_sim *sim); /* NULL is fine */
void sph_sim_run_leave(sph_sim *sim);
/* Closes all outputs: after a failure, or when the simulation ends. */
void sph_sim_run_close(sph_sim *sim);

/* A term brought a scalar along: room for it in a group, filled with its initial value. */
void sph_group_scalars_added(sph_group *group);

#endif
