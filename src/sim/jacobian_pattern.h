/* jacobian_pattern.h -- which particles the rates of a particle depend on, and colours of particles
 * that no rate depends on together. */
#ifndef SPH_JACOBIAN_PATTERN_H
#define SPH_JACOBIAN_PATTERN_H
#include "sim_rhs.h"

/* For each of n items a set of numbers: set k is item[first[k]] ... item[first[k + 1] - 1],
 * rising. */
typedef struct sph_sets {
  long n;
  long *first; /* [n + 1] */
  int *item;   /* [first[n]] */
} sph_sets;
void sph_jacobian_pattern_free(sph_sets *sets);

/* Fluid particles are numbered group after group: particle i of group g is base[g] + i. */
long sph_jacobian_pattern_base(const sph_sim *sim, long base[SPH_SETS_MAX]);

/* On which fluid particles the rates of each depend, itself included; records and lists are those
 * of the last evaluation.  The sets are symmetric unless walls and gradients act together. */
int sph_jacobian_pattern_make(sph_sim *sim, int lagged, sph_sets *rows);
/* colour[n]: particles of one colour are in no set together.  Returns their number, < 0: a
 * status. */
int sph_jacobian_pattern_colour(const sph_sets *rows, int *colour, sph_error *error);

#endif
