/* monitor.h -- numbers read off the particles; the definitions are in sphode/output.h. */
#ifndef SPH_MONITOR_H
#define SPH_MONITOR_H
#include "sphode/output.h"
#include "sphode/sim.h"

/* Is this monitor possible in sim?  Says what is wrong and what would be right. */
int sph_monitor_check(const sph_monitor *monitor, const sph_sim *sim, sph_error *error);
/* 1 to 63 letters that need no quotes in a table; what: "monitor", ... */
int sph_monitor_check_name(const char *what, const char *name, sph_error *error);

extern const double sph_monitor_wet; /* smallest sum V W of a wet point */
/* sum V W of the monitor's groups at its x, whatever its type and extent. */
int sph_monitor_cover(const sph_monitor *monitor, const sph_sim *sim, double *sum,
                      sph_error *error);

#endif
