/* monitor.h -- numbers read off the particles; the definitions are in sphode/output.h. */
#ifndef SPH_MONITOR_H
#define SPH_MONITOR_H
#include "sphode/output.h"
#include "sphode/sim.h"

/* Is this monitor possible in sim?  Says what is wrong and what would be right. */
int sph_monitor_check(const sph_monitor *monitor, const sph_sim *sim, sph_error *error);

#endif
