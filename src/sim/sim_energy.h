/* sim_energy.h -- the energies of a group: the one that is integrated, and those that follow. */
#ifndef SPH_SIM_ENERGY_H
#define SPH_SIM_ENERGY_H
#include "sim_data.h"

/* Before the run: does the equation of state fit?  Then the integrated energy from u. */
int sph_sim_energy_start(sph_group *group);
/* u (and T where a term needs it) of particles begin .. end - 1, or of all of them, from the
 * integrated energy. */
void sph_sim_energy_internal_of(const sph_group *group, const sph_view *view, long begin, long end);
void sph_sim_energy_internal(const sph_sim *sim, const sph_group *group, const sph_view *view);
/* The rate of the integrated energy of particle i: heat [W/kg]; compression: the rate of density by
 * continuity [kg/m^3/s].  Accelerations must be final. */
double sph_sim_energy_rate(const sph_group *group, const sph_view *view, long i, double heat,
                           double compression);
/* Has the group that energy (a field number), integrated or not?  u apart. */
int sph_sim_energy_has(const sph_group *group, int field);
/* Fills the group's own array of an energy that is not integrated, from the state y. */
int sph_sim_energy_derive(sph_group *group, const double *y, int field);

#endif
