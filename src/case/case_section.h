/* case_section.h -- a field along a line through the fluid, mean over time, beside a table. */
#ifndef SPH_CASE_SECTION_H
#define SPH_CASE_SECTION_H
#include "case_profile.h"

/* Is its reference a table along a line? */
int sph_case_section_known(const sph_case_comparer *a);
/* The distance.  Leaves directory/compare_NUMBER.csv with the columns at, run, reference. */
int sph_case_section_compare(const sph_case_comparer *a, sph_case_distance *d,
                             char note[SPH_CASE_NOTE]);
/* Draws that table. */
int sph_case_section_plot(const sph_case_comparer *a, const char *png);

#endif
