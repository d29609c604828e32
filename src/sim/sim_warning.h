/* sim_warning.h -- warnings are found one after another, in files by subject. */
#ifndef SPH_SIM_WARNING_H
#define SPH_SIM_WARNING_H
#include "sim_data.h"

/* Warning number `wanted` of those that are found. */
typedef struct sph_finder {
  int wanted, found;
  char *text;
  size_t size;
} sph_finder;

void sph_sim_warning_found(sph_finder *f, const char *format, ...) SPH_PRINTF(2, 3);

/* Of an evaluated simulation: what bounds steps; speeds and pressures of liquids against their
 * sound speed; the resolution of kernel, bodies and walls; bodies in each other, beside or far from
 * each other; events that have passed. */
void sph_sim_warning_steps(sph_finder *f, const sph_sim *sim);
void sph_sim_warning_places(sph_finder *f, const sph_sim *sim);
void sph_sim_warning_speeds(sph_finder *f, const sph_sim *sim);
void sph_sim_warning_resolution(sph_finder *f, const sph_sim *sim);
void sph_sim_warning_overlap(sph_finder *f, const sph_sim *sim);
void sph_sim_warning_events(sph_finder *f, const sph_sim *sim);

#endif
