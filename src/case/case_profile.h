/* case_profile.h -- a field of all fluid particles beside an exact solution in space: the distance,
 * and a table of both. */
#ifndef SPH_CASE_PROFILE_H
#define SPH_CASE_PROFILE_H
#include "case_curve.h"
#include "case_schema.h"

typedef struct sph_case_comparer {
  const sph_case *c;
  sph_sim *sim; /* NULL: series only */
  const char *directory;
  const sph_case_node *node; /* the comparison */
  const sph_case_node *kind; /* of its reference */
  int number;                /* of the comparison, from 0 */
  sph_error *error;
} sph_case_comparer;

enum { SPH_CASE_NOTE = 240 };

/* Is its reference a solution in space? */
int sph_case_profile_known(const sph_case_comparer *a);
/* The distance, the largest of all times asked for; what each time gave, if several, to note.
 * Leaves directory/compare_NUMBER.csv (directory NULL: none). */
int sph_case_profile_compare(const sph_case_comparer *a, sph_case_distance *d,
                             char note[SPH_CASE_NOTE]);
/* Before the run: has the solution that quantity, of these groups? */
int sph_case_profile_check(const sph_case_comparer *a);
/* Draws that table. */
int sph_case_profile_plot(const sph_case_comparer *a, const char *png);

#endif
