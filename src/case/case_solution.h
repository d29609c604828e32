/* case_solution.h -- exact solutions in space that a case may name as the reference of a field. */
#ifndef SPH_CASE_SOLUTION_H
#define SPH_CASE_SOLUTION_H
#include "case_reader.h"
#include "sphode/sim.h"

/* Particles of one group at one time. */
typedef struct sph_case_moment {
  const sph_case_node *reference; /* the solution's parameters */
  const sph_sim *sim;             /* whose groups tell the equations of state */
  const sph_group *group;
  double time; /* [s] */
  int dim;
  long n;
  const double *x[3]; /* [n] each, [dim] [m] */
} sph_case_moment;

enum { SPH_CASE_ALONG_LAST = -1, SPH_CASE_ALONG_NONE = -2, SPH_CASE_NO_FIELD = 1 };

typedef struct sph_case_solution {
  const char *reference; /* its key */
  const char *about;     /* the fields that it has, as the end of a message */
  int along;             /* the coordinate that it depends on: 0, the last one, or more than one */
  /* Component c of a field to to[n]; SPH_CASE_NO_FIELD: it has no such field. */
  int (*at)(const sph_case_moment *moment, const char *field, int c, double *to, sph_error *error);
} sph_case_solution;

/* NULL: no reference of that name is a solution in space. */
const sph_case_solution *sph_case_solution_find(const char *reference);

#endif
